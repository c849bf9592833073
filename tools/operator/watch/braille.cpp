#include "operator/watch/braille.h"

#include <algorithm>
#include <cmath>

namespace watch
{

namespace
{

constexpr unsigned blank = 0x2800; /* U+2800, braille pattern without a dot */

/* Bits of the dots of a cell, by row and column. */
constexpr uint8_t bit[Braille::dots_down][Braille::dots_across] = {
    {0x01, 0x08}, {0x02, 0x10}, {0x04, 0x20}, {0x40, 0x80}};

/* The part of a line that lies between low and high in one coordinate: false when there is none. */
bool clip(double a, double b, double low, double high, double &from, double &to)
{
    if (a == b) {
        return a >= low && a <= high;
    }
    const double t1 = (low - a) / (b - a);
    const double t2 = (high - a) / (b - a);
    from = std::max(from, std::min(t1, t2));
    to = std::min(to, std::max(t1, t2));
    return from <= to;
}

std::string utf8(unsigned code)
{
    return {static_cast<char>(0xE0U | (code >> 12U)), static_cast<char>(0x80U | ((code >> 6U) & 0x3FU)),
            static_cast<char>(0x80U | (code & 0x3FU))};
}

} // namespace

Braille::Braille(int columns, int rows)
    : columns_(columns), rows_(rows), dots_(static_cast<size_t>(columns) * static_cast<size_t>(rows)),
      marks_(dots_.size())
{
}

bool Braille::inside(int column, int row) const
{
    return column >= 0 && column < columns_ && row >= 0 && row < rows_;
}

size_t Braille::cell(int column, int row) const
{
    return static_cast<size_t>(row) * static_cast<size_t>(columns_) + static_cast<size_t>(column);
}

void Braille::dot(int x, int y)
{
    const int column = x / dots_across;
    const int row = y / dots_down;
    if (x >= 0 && y >= 0 && inside(column, row)) {
        uint8_t &dots = dots_[cell(column, row)];
        dots = static_cast<uint8_t>(dots | bit[y % dots_down][x % dots_across]);
    }
}

void Braille::line(double x1, double y1, double x2, double y2)
{
    double from = 0;
    double to = 1;
    if (!std::isfinite(x1 + y1 + x2 + y2) || !clip(x1, x2, 0, columns_ * dots_across, from, to) ||
        !clip(y1, y2, 0, rows_ * dots_down, from, to)) {
        return;
    }
    const double length = std::max(std::fabs(x2 - x1), std::fabs(y2 - y1)) * (to - from);
    const int steps = static_cast<int>(std::ceil(length)) + 1;
    for (int k = 0; k <= steps; k++) {
        const double t = from + (to - from) * k / steps;
        dot(static_cast<int>(std::floor(x1 + t * (x2 - x1))),
            static_cast<int>(std::floor(y1 + t * (y2 - y1))));
    }
}

void Braille::mark(double x, double y, const std::string &character)
{
    const double column = std::floor(x / dots_across);
    const double row = std::floor(y / dots_down);
    if (column >= 0 && column < columns_ && row >= 0 && row < rows_) {
        marks_[cell(static_cast<int>(column), static_cast<int>(row))] = character;
    }
}

std::string Braille::row(int row) const
{
    std::string text;
    for (int column = 0; column < columns_; column++) {
        const size_t k = cell(column, row);
        text += marks_[k].empty() ? utf8(blank + dots_[k]) : marks_[k];
    }
    return text;
}

} // namespace watch
