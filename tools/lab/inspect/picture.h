/* One scan as a picture: its points by segment, lines, corners, curves, what was refused, and the search. */
#ifndef ALE_LAB_INSPECT_PICTURE_H
#define ALE_LAB_INSPECT_PICTURE_H

#include <string>

extern "C" {
#include "lab/inspect/trace.h"
}

namespace inspect
{

/* Draws to an SVG file, "-" for the standard output. Throws std::runtime_error that names the file. */
void draw(const ale_scan_t &scan, const inspect_trace_t &trace, const std::string &title,
          const std::string &path);

} // namespace inspect

#endif
