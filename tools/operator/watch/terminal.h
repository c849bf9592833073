/* The terminal in ncurses' hands while this lives; given back on its end, whatever happens. */
#ifndef WATCH_TERMINAL_H
#define WATCH_TERMINAL_H

#include <vector>

#include "operator/watch/text_screen.h"

namespace watch
{

class Terminal
{
  public:
    /* Throws std::runtime_error when this is no terminal, or one that ncurses does not know. */
    Terminal();
    ~Terminal();
    Terminal(const Terminal &) = delete;
    Terminal &operator=(const Terminal &) = delete;

    int columns() const;
    int rows() const;
    void show(const std::vector<Row> &rows);
    /* The key pressed since the last call, or -1. */
    int key();
};

} // namespace watch

#endif
