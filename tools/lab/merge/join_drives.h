/* Drives become one: the mapper's own search for maps that meet, its loops and its refinement, over the
 * keyframes of all drives; then every scan is laid on what all have seen. */
#ifndef ALE_LAB_MERGE_JOIN_DRIVES_H
#define ALE_LAB_MERGE_JOIN_DRIVES_H

#include <vector>

#include "graph/loops/loop_closer.h"
#include "lab/merge/drive.h"

namespace merge
{

/* All drives one after the other, and the graph in which their frames are joined. */
struct SearchedDrives {
    DriveGroup group;
    ale::LoopCloser closer; /* a node for each of the group's */
    uint32_t scans;         /* of the group */
};

/* Looks for the place of each group among those before it; what a group knows to be joined is not looked for
 * again. Frames that meet become one, that of the larger piece or of the first frame; frames that are only
 * alike stay apart. Frames of a group are numbered from 0; its drives may share one, if they stand where they
 * have been put before, to a few centimetres. Time and memory grow with the number of keyframes, that of the
 * search for places with its square. */
SearchedDrives search_joins(std::vector<DriveGroup> groups);

/* Closes all loops, refines, and lays every scan on what all have seen: the drives of the group, in the
 * frames that they have become. Beyond what the search has found nothing is joined. */
std::vector<Drive> join_drives(SearchedDrives searched);

} // namespace merge

#endif
