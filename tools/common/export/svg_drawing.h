/* A drawing made of lines, dots and words, as an SVG file. Coordinates in pixels, y downwards. */
#ifndef ALE_COMMON_EXPORT_SVG_DRAWING_H
#define ALE_COMMON_EXPORT_SVG_DRAWING_H

#include <string>
#include <string_view>
#include <vector>

namespace ale
{

struct SvgPoint {
    double x;
    double y;
};

class SvgDrawing
{
  public:
    SvgDrawing(double width, double height);

    /* Colours as CSS has them; widths and radii in pixels. */
    void line(SvgPoint a, SvgPoint b, std::string_view colour, double width);
    void polyline(const std::vector<SvgPoint> &points, std::string_view colour, double width);
    void dot(SvgPoint centre, double radius, std::string_view colour);
    void circle(SvgPoint centre, double radius, std::string_view colour, double width);
    void rectangle(SvgPoint corner, double width, double height, std::string_view fill);
    /* anchor: start, middle or end of the text lies at the point. */
    void text(SvgPoint at, std::string_view words, double size, std::string_view anchor = "start",
              std::string_view colour = "#222");

    /* Throws std::runtime_error that names the file. "-" is the standard output. */
    void save(const std::string &path) const;

  private:
    std::string body_;
};

/* One panel of a plot: a frame with axes, and the way from values to pixels. */
class SvgPanel
{
  public:
    struct Axis {
        double low;
        double high;
        std::string title;
    };

    SvgPanel(SvgDrawing &drawing, SvgPoint corner, double width, double height, const Axis &x, const Axis &y);

    void dot(double x, double y, double radius, std::string_view colour);
    void curve(const std::vector<SvgPoint> &values, std::string_view colour, double width);
    /* Words inside the frame, one line below the other. */
    void legend(std::string_view words, std::string_view colour);

  private:
    SvgPoint pixel(double x, double y) const;
    bool inside(double x, double y) const;

    SvgDrawing &drawing_;
    SvgPoint corner_;
    double width_;
    double height_;
    Axis x_;
    Axis y_;
    int legends_ = 0;
};

} // namespace ale

#endif
