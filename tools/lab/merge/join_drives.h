/* Drives become one: the mapper's own search for maps that meet, its loops and its refinement, over the
 * keyframes of all drives; then every scan is laid on what all have seen. */
#ifndef ALE_LAB_MERGE_JOIN_DRIVES_H
#define ALE_LAB_MERGE_JOIN_DRIVES_H

#include <vector>

#include "lab/merge/drive.h"

namespace merge
{

/* Frames that meet become one, that of the larger piece or of the first frame, and all poses move with it.
 * Frames that are only alike stay apart. Drives by date, ids of frames unique among them. Time and memory
 * grow with the number of keyframes, that of the search for places with its square. */
void join_drives(std::vector<Drive> *drives);

} // namespace merge

#endif
