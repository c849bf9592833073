/* Anti-aliased drawing in integers: shapes go as coverage into a layer, the layer as one colour onto the
 * canvas, so that shapes of a layer join without seams. Coordinates in 1/16 pixel, y down, pixel centres at
 * odd eighths. What lies outside is cut off. */
#ifndef ALE_COMMON_EXPORT_CANVAS_H
#define ALE_COMMON_EXPORT_CANVAS_H

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace ale
{

struct Spot {
    int32_t x;
    int32_t y;
};

struct Colour {
    uint8_t red;
    uint8_t green;
    uint8_t blue;
};

constexpr int32_t sub_pixels = 16;

class Layer
{
  public:
    Layer(int32_t width, int32_t height);
    /* A stroke with round ends; radius is half its width. Work: its area in pixels. */
    void stroke(Spot from, Spot to, int32_t radius);
    void disc(Spot centre, int32_t radius)
    {
        stroke(centre, centre, radius);
    }
    /* Digits, ".", blanks and the letters of "new", "moved", "gone"; baseline starts at `at`; height of a
     * digit. Returns the width. */
    int32_t text(Spot at, std::string_view text, int32_t height, int32_t radius);

  private:
    friend class Canvas;
    void piece(Spot from, Spot to, int32_t radius);

    int32_t width_;
    int32_t height_;
    std::vector<uint8_t> coverage_;
};

class Canvas
{
  public:
    Canvas(int32_t width, int32_t height);
    int32_t width() const
    {
        return width_;
    }
    int32_t height() const
    {
        return height_;
    }
    Layer layer() const
    {
        return {width_, height_};
    }
    /* opacity 0..255 */
    void paint(const Layer &layer, Colour colour, uint8_t opacity = 255);
    /* Throws std::runtime_error when the file cannot be written. */
    void write_png(const std::string &path) const;

  private:
    int32_t width_;
    int32_t height_;
    std::vector<uint8_t> rgb_;
};

} // namespace ale

#endif
