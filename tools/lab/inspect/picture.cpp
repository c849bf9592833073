#include "lab/inspect/picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "common/export/svg_drawing.h"

extern "C" {
#include "base/trig.h"
}

namespace inspect
{

namespace
{

using ale::SvgDrawing;
using ale::SvgPoint;

constexpr double map_size = 760;
constexpr double side_width = 520;
constexpr double border = 30;
constexpr double head = 50;

constexpr char raw_colour[] = "#c8c8c8";
constexpr char line_colour[] = "#1a1a1a";
constexpr char refused_colour[] = "#d62728";
constexpr char curve_colour[] = "#9467bd";
constexpr char corner_colour[] = "#d95f02";
constexpr char accepted_colour[] = "#2ca02c";
constexpr std::array<const char *, 4> segment_colours{"#1f77b4", "#17becf", "#4c9f70", "#8c8c3c"};

constexpr std::array<const char *, ALE_REFUSALS> refusal_names{
    "too few points",         "too short", "of no sure direction",
    "rougher than the noise", "curved",    "no room left"};

SvgPoint place_of(const ale_scan_t &scan, int beam)
{
    const double turn = static_cast<int32_t>(ale_scan_bearing(&scan, beam)) * 3.14159265358979 / 0x1p31;
    const double range = scan.range_um[beam] * 1e-6;
    return {range * std::cos(turn), range * std::sin(turn)};
}

/* From the sensor's frame in metres to pixels: x forward is up, y left is left. All that was measured fits.
 */
class View
{
  public:
    explicit View(const ale_scan_t &scan)
    {
        double reach = 0.5;
        double low_x = 0;
        double high_x = 0;
        double low_y = 0;
        double high_y = 0;
        for (int k = 0; k < scan.beams; k++) {
            if (scan.flag[k] == ALE_BEAM_VALID) {
                const SvgPoint p = place_of(scan, k);
                low_x = std::min(low_x, p.x);
                high_x = std::max(high_x, p.x);
                low_y = std::min(low_y, p.y);
                high_y = std::max(high_y, p.y);
            }
        }
        reach = std::max({reach, high_x - low_x, high_y - low_y});
        scale_ = map_size / (reach * 1.06);
        middle_ = {(low_x + high_x) / 2, (low_y + high_y) / 2};
    }
    SvgPoint operator()(double x, double y) const
    {
        return {border + map_size / 2 - (y - middle_.y) * scale_,
                head + map_size / 2 - (x - middle_.x) * scale_};
    }
    SvgPoint operator()(const ale_point_t &p) const
    {
        return (*this)(p.x_um * 1e-6, p.y_um * 1e-6);
    }
    double scale() const
    {
        return scale_;
    }

  private:
    double scale_;
    SvgPoint middle_;
};

void draw_scale(SvgDrawing &drawing)
{
    drawing.text({border, head + map_size + 20}, "sensor at the cross, looking up; the bar is one metre", 12);
}

void draw_sensor(SvgDrawing &drawing, const View &view)
{
    const SvgPoint at = view(0, 0);
    drawing.line({at.x - 7, at.y}, {at.x + 7, at.y}, line_colour, 1.5);
    drawing.line({at.x, at.y - 7}, {at.x, at.y + 7}, line_colour, 1.5);
    const SvgPoint corner{border + map_size - 10, head + map_size + 16};
    drawing.line({corner.x - view.scale(), corner.y}, corner, line_colour, 3);
}

/* All values of the scan faintly, then the points that decisions rest on, a colour for each segment. */
void draw_points(SvgDrawing &drawing, const View &view, const ale_scan_t &scan, const inspect_trace_t &trace)
{
    for (int k = 0; k < scan.beams; k++) {
        if (scan.flag[k] == ALE_BEAM_VALID) {
            const SvgPoint p = place_of(scan, k);
            drawing.circle(view(p.x, p.y), 2.4, raw_colour, 0.8);
        }
    }
    size_t segment = 0;
    for (int k = 0; k < trace.points; k++) {
        drawing.dot(view(ale_point_t{trace.x_um[k], trace.y_um[k]}), 1.4,
                    segment_colours[segment % segment_colours.size()]);
        segment += trace.segment_ends[k];
    }
}

bool became_a_feature(const inspect_trace_t &trace, int first_beam, int last_beam)
{
    const ale_features_t &f = trace.features;
    const auto same = [&](const auto &feature) {
        return feature.first == first_beam && feature.last == last_beam;
    };
    return std::any_of(f.line, f.line + f.line_count, same) ||
           std::any_of(f.curve, f.curve + f.curve_count, same);
}

void draw_refused(SvgDrawing &drawing, const View &view, const inspect_trace_t &trace)
{
    for (int k = 0; k < trace.runs; k++) {
        const auto &run = trace.run[k];
        if (became_a_feature(trace, trace.beam[run.first], trace.beam[run.last])) {
            continue;
        }
        drawing.line(view(ale_point_t{trace.x_um[run.first], trace.y_um[run.first]}),
                     view(ale_point_t{trace.x_um[run.last], trace.y_um[run.last]}), refused_colour, 2);
    }
}

void draw_end(SvgDrawing &drawing, SvgPoint at, uint8_t kind)
{
    if (kind == ALE_END_OCCLUDED) {
        drawing.circle(at, 4, line_colour, 1.2);
    } else if (kind == ALE_END_EDGE) {
        drawing.dot(at, 3, line_colour);
    }
}

void draw_lines(SvgDrawing &drawing, const View &view, const ale_features_t &f)
{
    for (int k = 0; k < f.line_count; k++) {
        const ale_line_t &line = f.line[k];
        const SvgPoint a = view(line.start);
        const SvgPoint b = view(line.end);
        drawing.line(a, b, line_colour, 1.6);
        draw_end(drawing, a, line.first_end);
        draw_end(drawing, b, line.last_end);
        drawing.text({(a.x + b.x) / 2 + 6, (a.y + b.y) / 2 - 4}, std::to_string(k), 12);
    }
}

void draw_curves(SvgDrawing &drawing, const View &view, const inspect_trace_t &trace)
{
    for (int c = 0; c < trace.features.curve_count; c++) {
        const ale_curve_t &curve = trace.features.curve[c];
        std::vector<SvgPoint> along;
        for (int k = 0; k < trace.points; k++) {
            if (trace.beam[k] >= curve.first && trace.beam[k] <= curve.last) {
                along.push_back(view(ale_point_t{trace.x_um[k], trace.y_um[k]}));
            }
        }
        drawing.polyline(along, curve_colour, 2);
        if (curve.radius_um > 0 && curve.radius_um < 1000000) {
            drawing.circle(view(curve.centre), curve.radius_um * 1e-6 * view.scale(), curve_colour, 0.7);
        }
    }
}

void draw_corners(SvgDrawing &drawing, const View &view, const ale_features_t &f)
{
    for (int k = 0; k < f.corner_count; k++) {
        const SvgPoint at = view(f.corner[k].p);
        if (f.corner[k].kind == ALE_CORNER_CONVEX) {
            drawing.dot(at, 5, corner_colour);
        } else {
            drawing.circle(at, 5, corner_colour, 2);
        }
    }
}

std::string counted(int count, const std::string &noun)
{
    return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

/* Words in a column at the side; returns the next free height. */
double write_summary(SvgDrawing &drawing, const inspect_trace_t &trace, double left)
{
    const ale_features_t &f = trace.features;
    double y = head + 10;
    const auto put = [&](const std::string &words, const char *colour) {
        drawing.text({left, y}, words, 13, "start", colour);
        y += 18;
    };
    put(counted(f.line_count, "line") + " (dot: edge, ring: something hides the rest)", line_colour);
    put(counted(f.corner_count, "corner") + " (filled: convex, ring: concave)", corner_colour);
    put(counted(f.curve_count, "curve"), curve_colour);
    put(counted(f.outliers, "stray point") + " set aside; rings without a dot", "#888");
    put(trace.smoothed ? "points used, smoothed, one colour a segment" : "points used, one colour a segment",
        segment_colours[0]);
    put("candidates refused:", refused_colour);
    for (size_t k = 0; k < refusal_names.size(); k++) {
        if (f.refused[k] > 0) {
            put("    " + std::to_string(f.refused[k]) + " " + refusal_names[k], refused_colour);
        }
    }
    return y + 12;
}

/* The steps of the search as in fig. 2: a row a step, its span, its guess, green where the line up to the
 * guess was accepted. */
void draw_search(SvgDrawing &drawing, const inspect_trace_t &trace, double left, double top)
{
    drawing.text({left, top}, "binary search through the longest segment (beams; bar: span, dot: guess,", 13);
    drawing.text({left, top + 16}, "green: a line up to there is accepted, red: it is not)", 13);
    if (trace.steps == 0) {
        drawing.text({left, top + 36}, "no step: too few points", 12);
        return;
    }
    const auto point_at = [&](const inspect_step_t &s, int offset) {
        return std::clamp(s.line_first + s.direction * offset, 0, trace.points - 1);
    };
    int low = trace.points;
    int high = 0;
    for (int k = 0; k < trace.steps; k++) {
        const inspect_step_t &s = trace.step[k];
        low = std::min({low, point_at(s, 0), point_at(s, s.right)});
        high = std::max({high, point_at(s, 0), point_at(s, s.right)});
    }
    const double row = std::clamp((map_size - (top - head) - 60) / trace.steps, 2.0, 14.0);
    const auto x_of = [&](int point) {
        return left + (side_width - border) * (point - low) / std::max(1, high - low);
    };
    for (int k = 0; k < trace.steps; k++) {
        const inspect_step_t &s = trace.step[k];
        const double y = top + 34 + row * k;
        const char *colour = s.accepted ? accepted_colour : refused_colour;
        drawing.line({x_of(point_at(s, 0)), y}, {x_of(point_at(s, s.left)), y}, "#dddddd", row * 0.5);
        drawing.line({x_of(point_at(s, s.left)), y}, {x_of(point_at(s, s.right)), y}, "#7a9cc6", row * 0.5);
        drawing.dot({x_of(point_at(s, s.guess)), y}, std::min(4.0, row * 0.5), colour);
    }
    const double bottom = top + 34 + row * trace.steps + 12;
    drawing.text({left, bottom}, "beam " + std::to_string(trace.beam[low]), 11);
    drawing.text({left + side_width - border, bottom}, "beam " + std::to_string(trace.beam[high]), 11, "end");
}

} // namespace

void draw(const ale_scan_t &scan, const inspect_trace_t &trace, const std::string &title,
          const std::string &path)
{
    SvgDrawing drawing(2 * border + map_size + side_width, head + map_size + border);
    drawing.text({border, 28}, title, 16);
    const View view(scan);
    draw_points(drawing, view, scan, trace);
    draw_refused(drawing, view, trace);
    draw_curves(drawing, view, trace);
    draw_lines(drawing, view, trace.features);
    draw_corners(drawing, view, trace.features);
    draw_sensor(drawing, view);
    draw_scale(drawing);
    const double left = border + map_size + border;
    draw_search(drawing, trace, left, write_summary(drawing, trace, left));
    drawing.save(path);
}

} // namespace inspect
