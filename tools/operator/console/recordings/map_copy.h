/* A map in the format that somebody wants, in memory. */
#ifndef CONSOLE_MAP_COPY_H
#define CONSOLE_MAP_COPY_H

#include <string>

#include "common/export/map_image.h"

namespace console
{

/* ending: "png", "svg", "dxf", "geojson", or "zip" for a .pgm with its .yaml. */
bool is_map_ending(const std::string &ending);

/* stem: how the file is called, without its ending; a plain name. Throws std::runtime_error in words. For an
 * ordinary thread: some milliseconds, of a large map a second. */
std::string map_copy(const ale::MapScene &scene, const std::string &stem, const std::string &ending);

} // namespace console

#endif
