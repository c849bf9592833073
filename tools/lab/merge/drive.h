/* A drive as merging needs it: every scan with its pose, the keyframes, and what was observed. */
#ifndef ALE_LAB_MERGE_DRIVE_H
#define ALE_LAB_MERGE_DRIVE_H

#include <cstdint>
#include <string>
#include <vector>

#include "graph/loops/join_decision.h"
#include "graph/optimise/node.h"
#include "graph/walls/observation_record.h"

namespace merge
{

struct DriveScan {
    int64_t stamp_us; /* of the log */
    ale::Pose pose;   /* of the robot, in its frame */
    uint32_t frame;   /* poses of two frames have nothing to do with each other */
    bool follows;     /* tracked from the scan before without a break */
    std::vector<ale::SurfacePoint>
        points; /* robot's frame; none: nothing was seen, or from nobody knows where */
};

/* Where a scan was when its drive was merged before. */
struct ScanPlace {
    ale_pose_t pose;
    uint32_t frame;
};

struct Drive {
    std::string name;  /* of the log, without its folder */
    int64_t date_s;    /* when it began, seconds since 1970 */
    uint32_t checksum; /* of the log, CRC-32: a drive is known by it */
    ale_pose_t sensor; /* on the robot */
    std::vector<DriveScan> scans;
    std::vector<ale::Node> nodes;  /* `scan` is an index of scans, map_id its frame */
    ale::ObservationRecord record; /* `scan` likewise */
};

/* Drives whose places in one another have been looked for, as they were before that: frames that are joined
 * have ids of their own. A drive that has just been read is a group by itself. */
struct DriveGroup {
    std::vector<Drive> drives;
    std::vector<ale::FoundJoin>
        joins; /* in the order in which they are made; nodes counted through the group */
};

/* Ids of frames are below this. */
uint32_t frames_of(const std::vector<Drive> &drives);

/* Frames of the group get ids from `first` on. */
void number_frames(uint32_t first, DriveGroup *group);

/* Exchanges the ids of this frame and the first. */
void make_first(uint32_t frame, std::vector<Drive> *drives);

/* By date: what a later one shows decides. */
bool is_earlier(const Drive &a, const Drive &b);

} // namespace merge

#endif
