#include "operator/watch/braille.h"

#include <cmath>

#include <gtest/gtest.h>

using watch::Braille;

TEST(Braille, EmptyCanvasIsBlankCells)
{
    EXPECT_EQ(Braille(3, 1).row(0), "\u2800\u2800\u2800");
}

TEST(Braille, EveryDotHasItsPlaceInTheCell)
{
    const char *cells[4][2] = {
        {"\u2801", "\u2808"}, {"\u2802", "\u2810"}, {"\u2804", "\u2820"}, {"\u2840", "\u2880"}};
    for (int y = 0; y < 4; y++) {
        for (int x = 0; x < 2; x++) {
            Braille canvas(1, 1);
            canvas.line(x + 0.5, y + 0.5, x + 0.5, y + 0.5);
            EXPECT_EQ(canvas.row(0), cells[y][x]) << x << ' ' << y;
        }
    }
}

TEST(Braille, LineFillsEveryCellBetweenItsEnds)
{
    Braille canvas(4, 1);
    canvas.line(0.5, 0.5, 7.5, 0.5);
    EXPECT_EQ(canvas.row(0), "\u2809\u2809\u2809\u2809");
}

TEST(Braille, OnlyThePartInsideIsDrawnHoweverFarTheLineGoes)
{
    Braille canvas(2, 2);
    canvas.line(-1e9, 0.5, 1e9, 0.5);
    EXPECT_EQ(canvas.row(0), "\u2809\u2809");
    EXPECT_EQ(canvas.row(1), "\u2800\u2800");
    canvas.line(-5, -5, -1, -1);
    canvas.line(std::nan(""), 0, 1, 1);
    EXPECT_EQ(canvas.row(1), "\u2800\u2800");
}

TEST(Braille, MarkReplacesItsCellAndIsLeftOutBesideTheCanvas)
{
    Braille canvas(2, 1);
    canvas.mark(2, 1, "X");
    canvas.mark(-1, 0, "Y");
    canvas.mark(1e12, 0, "Y");
    EXPECT_EQ(canvas.row(0), "\u2800X");
}
