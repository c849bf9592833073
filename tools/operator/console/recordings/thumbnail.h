/* A line drawing of a map for a list: ends of its longest walls, x and y from 0 to 1000 on the longer side.
 */
#ifndef CONSOLE_THUMBNAIL_H
#define CONSOLE_THUMBNAIL_H

#include <vector>

extern "C" {
#include "track/pipeline.h"
}

namespace console
{

using Thumbnail = std::vector<int>;
Thumbnail thumbnail_of(const ale_map_t &map);

} // namespace console

#endif
