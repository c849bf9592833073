/* Drives as a file, so that a later merge goes on from them without their logs: scans, keyframes,
 * observations, and the joins that have been found.
 *
 *   ALE-SLAM drives 1
 *   (numbers: see number_file.h)
 *   (CRC-32, zlib's, of all before it)
 *
 * Some 10 MB a hundred seconds of driving. */
#ifndef ALE_LAB_MERGE_DRIVE_FILE_H
#define ALE_LAB_MERGE_DRIVE_FILE_H

#include <string>

#include "lab/merge/drive.h"

namespace merge
{

/* By its first bytes. False, too, of what cannot be read. */
bool is_drive_file(const std::string &path);

/* The group as it was written, to the bit. Throws std::runtime_error with one line. */
DriveGroup read_drive_file(const std::string &path);

/* Whole or not at all. Throws std::runtime_error with one line. */
void write_drive_file(const std::string &path, const DriveGroup &group);

} // namespace merge

#endif
