/* What came of a merge, for people and for the exit code. */
#ifndef ALE_LAB_MERGE_REPORT_H
#define ALE_LAB_MERGE_REPORT_H

#include <vector>

#include "lab/merge/drive.h"

namespace merge
{

/* Says on stderr where the drive, or pieces of it, are not in this frame. Whether it is in it, with most of
 * its scans. */
bool report_drive(const Drive &drive, uint32_t frame);

/* Says on stderr which drives, and which pieces of drives, are not in this frame. Whether all drives are in
 * it, with most of their scans. */
bool report(const std::vector<Drive> &drives, uint32_t frame);

} // namespace merge

#endif
