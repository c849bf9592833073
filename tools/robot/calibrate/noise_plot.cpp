#include "robot/calibrate/noise_plot.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "common/export/svg_drawing.h"

namespace calibrate
{

namespace
{

constexpr char measured_colour[] = "#7a9cc6";
constexpr char fitted_colour[] = "#c0392b";
constexpr double panel_width = 330;
constexpr double panel_height = 260;
constexpr double margin = 60;
constexpr double top = 88;

ale::SvgPoint panel_corner(int column)
{
    return {margin + column * (panel_width + margin), top};
}

const Beam &beam_of(const Calibration &c, const Product &p)
{
    return c.beams[static_cast<size_t>(p.beam)];
}

double farthest_range(const Calibration &c)
{
    double farthest = 0.5;
    for (const Beam &b : c.beams) {
        farthest = std::max(farthest, b.usable ? b.mean : 0);
    }
    return farthest * 1.02;
}

/* Scatter of every beam over the scans, without what its bearing does to it. */
void plot_range(ale::SvgDrawing &drawing, const Calibration &c)
{
    const TemporalFit &fit = c.temporal;
    std::vector<ale::SvgPoint> own;
    std::vector<ale::SvgPoint> all;
    const double far = farthest_range(c);
    for (int k = 0; k <= 100; k++) {
        const double d = far * k / 100;
        const double own_variance = fit.own + fit.own_relative * d * d;
        own.push_back({d, 1e3 * std::sqrt(own_variance)});
        all.push_back({d, 1e3 * std::sqrt(own_variance + fit.shared_between(d, d))});
    }
    ale::SvgPanel panel(drawing, panel_corner(0), panel_width, panel_height, {0, far, "range, m"},
                        {0, 2.2 * all.back().y, "standard deviation over the scans, mm"});
    for (const Product &p : c.products) {
        const Beam &beam = beam_of(c, p);
        const double variance = p.mean - fit.bearing * beam.slope * beam.slope;
        if (p.lag == 0 && variance > 0) {
            panel.dot(beam.mean, 1e3 * std::sqrt(variance), 1.6, measured_colour);
        }
    }
    panel.curve(all, fitted_colour, 2);
    panel.curve(own, "#27ae60", 2);
    panel.legend("one beam each, less its bearing error", measured_colour);
    panel.legend("fit: own and shared", fitted_colour);
    panel.legend("fit: own", "#27ae60");
}

/* Correlation, between beams so many apart, of the shared part that changes from scan to scan. */
void plot_correlation(ale::SvgDrawing &drawing, const Calibration &c)
{
    const TemporalFit &fit = c.temporal;
    std::map<int, std::pair<double, double>> by_lag;
    for (const Product &p : c.products) {
        const Beam &a = beam_of(c, p);
        const Beam &b = c.beams[static_cast<size_t>(p.beam) + static_cast<size_t>(p.lag)];
        const double own = p.lag == 0 ? fit.own_of(a) : 0;
        auto &[product, shared] = by_lag[p.lag];
        product += p.mean - own;
        shared += fit.shared_between(a.mean, b.mean);
    }
    ale::SvgPanel panel(drawing, panel_corner(1), panel_width, panel_height, {0, longest_lag, "beams apart"},
                        {-0.2, 1.3, "correlation over the scans, less own errors"});
    std::vector<ale::SvgPoint> curve;
    for (const auto &[lag, sums] : by_lag) {
        if (sums.second > 0) {
            panel.dot(lag, sums.first / sums.second, 3, measured_colour);
        }
        curve.push_back({static_cast<double>(lag), std::exp(-lag / fit.length)});
    }
    panel.curve(curve, fitted_colour, 2);
    panel.legend("measured, all pairs of one surface", measured_colour);
    char words[64];
    std::snprintf(words, sizeof words, "fit: exp(-beams / %.1f)", fit.length);
    panel.legend(words, fitted_colour);
}

/* What the error of the bearing adds on slanted walls. */
void plot_slope(ale::SvgDrawing &drawing, const Calibration &c)
{
    const TemporalFit &fit = c.temporal;
    std::vector<std::pair<double, double>> values;
    for (const Product &p : c.products) {
        const Beam &beam = beam_of(c, p);
        const double rest = p.mean - fit.own - fit.own_relative * beam.mean * beam.mean -
                            fit.shared_between(beam.mean, beam.mean);
        if (p.lag == 0) {
            values.emplace_back(std::abs(beam.slope), 1e6 * rest);
        }
    }
    if (values.empty()) {
        return;
    }
    std::sort(values.begin(), values.end());
    const double steepest = std::max(0.5, values[values.size() * 98 / 100].first);
    std::vector<ale::SvgPoint> curve;
    for (int k = 0; k <= 100; k++) {
        const double slope = steepest * k / 100;
        curve.push_back({slope, 1e6 * fit.bearing * slope * slope});
    }
    const double high = std::max(2.5 * curve.back().y, 1.0);
    ale::SvgPanel panel(drawing, panel_corner(2), panel_width, panel_height,
                        {0, steepest, "slope |dr/dphi|, m/rad"},
                        {-high / 2, high, "variance beyond own and shared, mm^2"});
    for (const auto &[slope, variance] : values) {
        panel.dot(slope, variance, 1.6, measured_colour);
    }
    panel.curve(curve, fitted_colour, 2);
    panel.legend("one beam each", measured_colour);
    panel.legend("fit: bearing error", fitted_colour);
}

} // namespace

void plot(const Calibration &c, const std::string &source, const std::string &path)
{
    ale::SvgDrawing drawing(3 * (panel_width + margin) + margin / 2, panel_height + top + margin);
    const ale_noise_t &n = c.noise;
    char words[240];
    std::snprintf(words, sizeof words,
                  "own %.2f mm + %.3f %%, shared %.2f mm + %.3f %% over %d beams, bearing %.4f deg, "
                  "surface %.1f mm%s",
                  n.own_um * 1e-3, n.own_ppm * 1e-4, n.shared_um * 1e-3, n.shared_ppm * 1e-4, n.shared_beams,
                  n.bearing_nrad * 1e-9 * 57.29578, n.surface_um * 1e-3, c.surface_known ? "" : " (default)");
    drawing.text({margin, 22}, source, 14);
    drawing.text({margin, 42}, words, 13);
    drawing.text({margin, 60}, shared_in_words(c), 13);
    plot_range(drawing, c);
    plot_correlation(drawing, c);
    plot_slope(drawing, c);
    drawing.save(path);
}

} // namespace calibrate
