/* Drives become one: the mapper's own search for maps that meet, its loops and its refinement, over the
 * keyframes of all drives; then every scan is laid on what all have seen. */
#ifndef ALE_LAB_MERGE_JOIN_DRIVES_H
#define ALE_LAB_MERGE_JOIN_DRIVES_H

#include <vector>

#include "lab/merge/drive.h"

namespace merge
{

/* Frames that meet become one, that of the larger piece or of the first frame, and all poses move with it.
 * Frames that are only alike stay apart. Ids of frames unique among drives, but for drives that have been
 * joined before: these begin with the first frame, stand one after the other, and are where they were to a
 * few centimetres. Time and memory
 * grow with the number of keyframes, that of the search for places with its square. */
void join_drives(std::vector<Drive> *drives);

} // namespace merge

#endif
