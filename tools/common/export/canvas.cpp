#include "common/export/canvas.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include <png.h>

extern "C" {
#include "base/fixed.h"
}

namespace ale
{

namespace
{

constexpr int32_t pixel_centre = sub_pixels / 2;
/* Long strokes are drawn in pieces, so that the boxes looked at stay slim. */
constexpr int32_t piece_length = 24 * sub_pixels;

/* Square of 16 times the distance of p from the stroke's spine, in sub-pixels. */
uint64_t distance_squared_q8(Spot p, Spot a, Spot b)
{
    const int64_t dx = b.x - a.x;
    const int64_t dy = b.y - a.y;
    const int64_t px = p.x - a.x;
    const int64_t py = p.y - a.y;
    const int64_t length_squared = dx * dx + dy * dy;
    const int64_t along = px * dx + py * dy;
    if (length_squared == 0 || along <= 0) {
        return static_cast<uint64_t>(px * px + py * py) << 8U;
    }
    if (along >= length_squared) {
        const int64_t qx = p.x - b.x;
        const int64_t qy = p.y - b.y;
        return static_cast<uint64_t>(qx * qx + qy * qy) << 8U;
    }
    const int64_t across = px * dy - py * dx;
    return static_cast<uint64_t>(ale_round_div(across * across * 256, length_squared));
}

/* Coverage of the pixel at p by the stroke: a ramp of one pixel's width at its edge. */
uint8_t coverage_at(Spot p, Spot a, Spot b, int32_t radius)
{
    const auto distance_q4 = static_cast<int32_t>(ale_isqrt(distance_squared_q8(p, a, b)));
    const int32_t inside = (radius + pixel_centre) * sub_pixels - distance_q4;
    return static_cast<uint8_t>(std::clamp(inside, 0, 255));
}

/* Strokes of the characters on a raster 4 wide and 6 high: pairs of digits x, y; a blank lifts the pen. */
const char *glyph(char c)
{
    static const char *const digits[] = {
        "103041453616050110",       "042620 1030", "0516364544 440040",
        "064623334241301001",       "3036020242",  "460603334241301001",
        "453616050110304142330302", "064610",      "130405163645443313 130201103041423323",
        "0110304145361605041343"};
    if (c >= '0' && c <= '9') {
        return digits[c - '0'];
    }
    switch (c) {
    case '.':
        return "1010";
    case 'd':
        return "3630 3324140301102031";
    case 'e':
        return "02323324140301102030";
    case 'g':
        return "34312010 3324140302112132";
    case 'm':
        return "0004 03142320 23344340";
    case 'n':
        return "0004 0314243330";
    case 'o':
        return "100103142433312010";
    case 'v':
        return "041034";
    case 'w':
        return "0410233044";
    default:
        return "";
    }
}

constexpr int32_t glyph_height = 6;
constexpr int32_t glyph_advance = 6;

} // namespace

Layer::Layer(int32_t width, int32_t height)
    : width_(width), height_(height), coverage_(static_cast<size_t>(width) * static_cast<size_t>(height))
{
}

void Layer::stroke(Spot from, Spot to, int32_t radius)
{
    const int32_t dx = to.x - from.x;
    const int32_t dy = to.y - from.y;
    const int32_t pieces = 1 + std::max(std::abs(dx), std::abs(dy)) / piece_length;
    const auto at = [&](int32_t i) {
        return Spot{from.x + static_cast<int32_t>(int64_t{dx} * i / pieces),
                    from.y + static_cast<int32_t>(int64_t{dy} * i / pieces)};
    };
    for (int32_t i = 0; i < pieces; i++) {
        piece(at(i), at(i + 1), radius);
    }
}

void Layer::piece(Spot from, Spot to, int32_t radius)
{
    const int32_t reach = radius + sub_pixels;
    const int32_t left = std::max((std::min(from.x, to.x) - reach) / sub_pixels, 0);
    const int32_t right = std::min((std::max(from.x, to.x) + reach) / sub_pixels, width_ - 1);
    const int32_t top = std::max((std::min(from.y, to.y) - reach) / sub_pixels, 0);
    const int32_t bottom = std::min((std::max(from.y, to.y) + reach) / sub_pixels, height_ - 1);
    for (int32_t y = top; y <= bottom; y++) {
        for (int32_t x = left; x <= right; x++) {
            const Spot centre = {x * sub_pixels + pixel_centre, y * sub_pixels + pixel_centre};
            uint8_t &covered =
                coverage_[static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x)];
            covered = std::max(covered, coverage_at(centre, from, to, radius));
        }
    }
}

int32_t Layer::text(Spot at, std::string_view text, int32_t height, int32_t radius)
{
    const int32_t begin = at.x;
    for (const char c : text) {
        const char *pen = glyph(c);
        const auto spot = [&](const char *pair) {
            return Spot{at.x + (pair[0] - '0') * height / glyph_height,
                        at.y - (pair[1] - '0') * height / glyph_height};
        };
        for (; *pen; pen += pen[2] == ' ' ? 3 : 2) {
            if (pen[2] && pen[2] != ' ') {
                stroke(spot(pen), spot(pen + 2), radius);
            }
        }
        at.x += glyph_advance * height / glyph_height;
    }
    return at.x - begin;
}

Canvas::Canvas(int32_t width, int32_t height)
    : width_(width), height_(height), rgb_(3 * static_cast<size_t>(width) * static_cast<size_t>(height), 255)
{
}

void Canvas::paint(const Layer &layer, Colour colour, uint8_t opacity)
{
    const uint8_t channel[3] = {colour.red, colour.green, colour.blue};
    for (size_t i = 0; i < layer.coverage_.size(); i++) {
        const int32_t weight = layer.coverage_[i] * opacity;
        for (size_t c = 0; weight > 0 && c < 3; c++) {
            const int32_t below = rgb_[3 * i + c];
            const int32_t mixed = below * (255 * 255 - weight) + channel[c] * weight;
            rgb_[3 * i + c] = static_cast<uint8_t>((mixed + 255 * 255 / 2) / (255 * 255));
        }
    }
}

void Canvas::write_png(const std::string &path) const
{
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = static_cast<png_uint_32>(width_);
    image.height = static_cast<png_uint_32>(height_);
    image.format = PNG_FORMAT_RGB;
    if (!png_image_write_to_file(&image, path.c_str(), 0, rgb_.data(), 0, nullptr)) {
        throw std::runtime_error(path + ": " + (errno ? std::strerror(errno) : image.message));
    }
}

} // namespace ale
