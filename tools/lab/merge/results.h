/* What a merge writes: maps, trajectories, pictures. Throws std::runtime_error with one line. */
#ifndef ALE_LAB_MERGE_RESULTS_H
#define ALE_LAB_MERGE_RESULTS_H

#include <vector>

#include "lab/merge/building.h"
#include "lab/merge/options.h"

namespace merge
{

void save_map(const std::string &path, const ale_map_t &map);

/* By tiles, where that is asked for. */
void save_tiles(const Options &options, const Building &building);

/* Where they are asked for: NAME.tum of what is in this frame, and where several logs are called that,
 * NAME-2.tum ... in the order of their dates. */
void write_trajectories(const Options &options, const std::vector<Drive> &drives, uint32_t frame);

/* Where they are asked for. */
void draw_maps(const Options &options, const ale_map_t &map, const Building &building);

} // namespace merge

#endif
