/* Where the scans of drives lie in the map that they have become: kept, so that a later merge goes on from
 * there.
 *
 *   ALE-SLAM places 1
 *   drive 470644706 593                 (checksum, scans)
 *   0 1200345 -800000 4294000000        (a scan: frame x_um y_um theta_bam)
 *
 * Frame 0 is that of the building; what lies in others is not joined. */
#ifndef ALE_LAB_MERGE_SCAN_PLACES_H
#define ALE_LAB_MERGE_SCAN_PLACES_H

#include <map>
#include <string>
#include <vector>

#include "lab/merge/drive.h"

namespace merge
{

using ScanPlaces = std::map<uint32_t, std::vector<ScanPlace>>; /* by checksum of the drive */

/* Of the drives from `first` on; frames numbered anew, without gaps. */
ScanPlaces places_of(const std::vector<Drive> &drives, size_t first);

std::string text_of(const ScanPlaces &places);

/* Throws std::runtime_error: not such a text. */
ScanPlaces places_from(const std::string &text);

/* The building's frame stays where it was: moves all that is in frame 0 rigidly, such that the scans that
 * were in it before lie where they lay, by least squares. */
void hold_frame(const ScanPlaces &before, std::vector<Drive> *drives);

} // namespace merge

#endif
