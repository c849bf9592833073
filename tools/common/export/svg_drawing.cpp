#include "common/export/svg_drawing.h"

#include <cmath>
#include <cstdio>

#include "common/export/text_file.h"

namespace ale
{

namespace
{

std::string number(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.2f", value);
    return text;
}

std::string attribute(std::string_view name, std::string_view value)
{
    return " " + std::string(name) + "=\"" + std::string(value) + "\"";
}

std::string attribute(std::string_view name, double value)
{
    return attribute(name, number(value));
}

std::string stroke(std::string_view colour, double width)
{
    return attribute("stroke", colour) + attribute("stroke-width", width) + " fill=\"none\"/>\n";
}

std::string escaped(std::string_view words)
{
    std::string out;
    for (const char c : words) {
        switch (c) {
        case '&':
            out += "&amp;";
            break;
        case '<':
            out += "&lt;";
            break;
        case '>':
            out += "&gt;";
            break;
        default:
            out += c;
        }
    }
    return out;
}

/* A round step that cuts the axis into 4 to 8 parts. */
double tick_step(double span)
{
    const double rough = span / 5;
    const double decade = std::pow(10, std::floor(std::log10(rough)));
    const double share = rough / decade;
    return decade * (share < 1.5 ? 1 : share < 3.5 ? 2 : share < 7.5 ? 5 : 10);
}

std::string tick_label(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", std::fabs(value) < 1e-12 ? 0.0 : value);
    return text;
}

} // namespace

SvgDrawing::SvgDrawing(double width, double height)
    : body_("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + number(width) + " " +
            number(height) + "\"" + attribute("width", width) + attribute("height", height) +
            " font-family=\"sans-serif\">\n")
{
    rectangle({0, 0}, width, height, "white");
}

void SvgDrawing::line(SvgPoint a, SvgPoint b, std::string_view colour, double width)
{
    body_ += "<line" + attribute("x1", a.x) + attribute("y1", a.y) + attribute("x2", b.x) +
             attribute("y2", b.y) + stroke(colour, width);
}

void SvgDrawing::polyline(const std::vector<SvgPoint> &points, std::string_view colour, double width)
{
    std::string list;
    for (const SvgPoint &p : points) {
        list += number(p.x) + "," + number(p.y) + " ";
    }
    body_ += "<polyline" + attribute("points", list) + stroke(colour, width);
}

void SvgDrawing::dot(SvgPoint centre, double radius, std::string_view colour)
{
    body_ += "<circle" + attribute("cx", centre.x) + attribute("cy", centre.y) + attribute("r", radius) +
             attribute("fill", colour) + "/>\n";
}

void SvgDrawing::circle(SvgPoint centre, double radius, std::string_view colour, double width)
{
    body_ += "<circle" + attribute("cx", centre.x) + attribute("cy", centre.y) + attribute("r", radius) +
             stroke(colour, width);
}

void SvgDrawing::rectangle(SvgPoint corner, double width, double height, std::string_view fill)
{
    body_ += "<rect" + attribute("x", corner.x) + attribute("y", corner.y) + attribute("width", width) +
             attribute("height", height) + attribute("fill", fill) + "/>\n";
}

void SvgDrawing::text(SvgPoint at, std::string_view words, double size, std::string_view anchor,
                      std::string_view colour)
{
    body_ += "<text" + attribute("x", at.x) + attribute("y", at.y) + attribute("font-size", size) +
             attribute("text-anchor", anchor) + attribute("fill", colour) + ">" + escaped(words) +
             "</text>\n";
}

void SvgDrawing::save(const std::string &path) const
{
    TextFile file(path);
    file.put(body_).put("</svg>\n");
    file.close();
}

SvgPanel::SvgPanel(SvgDrawing &drawing, SvgPoint corner, double width, double height, const Axis &x,
                   const Axis &y)
    : drawing_(drawing), corner_(corner), width_(width), height_(height), x_(x), y_(y)
{
    const double right = corner.x + width;
    const double bottom = corner.y + height;
    for (double v = std::ceil(x.low / tick_step(x.high - x.low)) * tick_step(x.high - x.low); v <= x.high;
         v += tick_step(x.high - x.low)) {
        drawing.line({pixel(v, y.low).x, corner.y}, {pixel(v, y.low).x, bottom}, "#e4e4e4", 1);
        drawing.text({pixel(v, y.low).x, bottom + 15}, tick_label(v), 11, "middle");
    }
    for (double v = std::ceil(y.low / tick_step(y.high - y.low)) * tick_step(y.high - y.low); v <= y.high;
         v += tick_step(y.high - y.low)) {
        drawing.line({corner.x, pixel(x.low, v).y}, {right, pixel(x.low, v).y}, "#e4e4e4", 1);
        drawing.text({corner.x - 6, pixel(x.low, v).y + 4}, tick_label(v), 11, "end");
    }
    drawing.polyline({{corner.x, corner.y}, {corner.x, bottom}, {right, bottom}}, "#444", 1);
    drawing.text({corner.x + width / 2, bottom + 34}, x.title, 12, "middle");
    drawing.text({corner.x, corner.y - 8}, y.title, 12);
}

void SvgPanel::dot(double x, double y, double radius, std::string_view colour)
{
    if (inside(x, y)) {
        drawing_.dot(pixel(x, y), radius, colour);
    }
}

void SvgPanel::curve(const std::vector<SvgPoint> &values, std::string_view colour, double width)
{
    std::vector<SvgPoint> pixels;
    for (const SvgPoint &v : values) {
        if (inside(v.x, v.y)) {
            pixels.push_back(pixel(v.x, v.y));
        }
    }
    drawing_.polyline(pixels, colour, width);
}

void SvgPanel::legend(std::string_view words, std::string_view colour)
{
    drawing_.text({corner_.x + 12, corner_.y + 18 + 16 * legends_++}, words, 12, "start", colour);
}

SvgPoint SvgPanel::pixel(double x, double y) const
{
    return {corner_.x + width_ * (x - x_.low) / (x_.high - x_.low),
            corner_.y + height_ * (1 - (y - y_.low) / (y_.high - y_.low))};
}

bool SvgPanel::inside(double x, double y) const
{
    return x >= x_.low && x <= x_.high && y >= y_.low && y <= y_.high;
}

} // namespace ale
