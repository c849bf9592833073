#include "operator/watch/terminal.h"

#include <clocale>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#include <ncurses.h>
#include <unistd.h>

namespace watch
{

namespace
{

chtype attributes(Mood mood, bool banner)
{
    const chtype strong = banner ? A_REVERSE | A_BOLD : A_NORMAL;
    switch (mood) {
    case Mood::good:
        return strong | COLOR_PAIR(1);
    case Mood::weak:
        return strong | COLOR_PAIR(2) | A_BOLD;
    case Mood::lost:
        return strong | COLOR_PAIR(3) | A_BOLD;
    case Mood::dim:
        return banner ? A_REVERSE : A_DIM;
    case Mood::plain:
        break;
    }
    return strong;
}

} // namespace

Terminal::Terminal()
{
    std::setlocale(LC_CTYPE, "");
    if (isatty(STDIN_FILENO) == 0 || isatty(STDOUT_FILENO) == 0) {
        throw std::runtime_error("this is no terminal; --once prints one picture anywhere");
    }
    if (newterm(nullptr, stdout, stdin) == nullptr) {
        const char *name = std::getenv("TERM");
        throw std::runtime_error(std::string("no such terminal: TERM=") + (name == nullptr ? "" : name));
    }
    cbreak();
    noecho();
    nodelay(stdscr, TRUE);
    keypad(stdscr, TRUE);
    curs_set(0);
    start_color();
    use_default_colors();
    init_pair(1, COLOR_GREEN, -1);
    init_pair(2, COLOR_YELLOW, -1);
    init_pair(3, COLOR_RED, -1);
}

Terminal::~Terminal()
{
    endwin();
}

int Terminal::columns() const
{
    return COLS;
}

int Terminal::rows() const
{
    return LINES;
}

void Terminal::show(const std::vector<Row> &rows)
{
    erase();
    int y = 0;
    for (const Row &row : rows) {
        move(y++, 0);
        for (const Span &span : row.spans) {
            attrset(static_cast<int>(attributes(span.mood, row.banner)));
            addstr(span.text.c_str());
        }
    }
    refresh();
}

int Terminal::key()
{
    return getch();
}

} // namespace watch
