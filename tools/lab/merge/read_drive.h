/* From a log to a drive: the firmware's code and its mapper, as ale-replay runs them. */
#ifndef ALE_LAB_MERGE_READ_DRIVE_H
#define ALE_LAB_MERGE_READ_DRIVE_H

#include <string>

#include "common/log/robot_config.h"
#include "lab/merge/drive.h"

namespace merge
{

/* Frames are numbered from 0. Its date is the stamp of the first scan where that is a time of day, else the
 * time of the file. `places`: where its scans have been put before, one for each; then its own mapper need
 * not put them anywhere. Throws std::runtime_error with one line: not readable, no scan, other scans than
 * places. */
Drive read_drive(const std::string &path, const ale::RobotOptions &robot,
                 const std::vector<ScanPlace> *places = nullptr);

} // namespace merge

#endif
