/* Lines drawn with the dots of braille characters: two by four to a cell of the terminal. */
#ifndef WATCH_BRAILLE_H
#define WATCH_BRAILLE_H

#include <cstdint>
#include <string>
#include <vector>

namespace watch
{

class Braille
{
  public:
    static constexpr int dots_across = 2;
    static constexpr int dots_down = 4;

    /* columns, rows in cells; not negative. */
    Braille(int columns, int rows);

    /* From dot to dot, right and down from the upper left one; what lies outside is left out. */
    void line(double x1, double y1, double x2, double y2);

    /* A character of its own in the cell of this dot. */
    void mark(double x, double y, const std::string &character);

    /* One row of cells as UTF-8. */
    std::string row(int row) const;

  private:
    void dot(int x, int y);
    bool inside(int column, int row) const;
    size_t cell(int column, int row) const;

    int columns_;
    int rows_;
    std::vector<uint8_t> dots_;
    std::vector<std::string> marks_;
};

} // namespace watch

#endif
