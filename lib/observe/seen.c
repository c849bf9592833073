#include "observe/seen.h"

#include <stddef.h>
#include <string.h>

#include "base/fixed.h"

void ale_seen_copy(ale_seen_copy_t *copy, const ale_seen_t *seen)
{
    const ale_posed_scan_t *from = &seen->posed;
    copy->scan = *from->scan;
    copy->straightened = from->bearing_bam != NULL;
    if (copy->straightened) {
        memcpy(copy->bearing_bam, from->bearing_bam, from->scan->beams * sizeof copy->bearing_bam[0]);
    }
    copy->robot = seen->robot;
    copy->sensor = from->sensor;
}

ale_posed_scan_t ale_seen_copy_posed(const ale_seen_copy_t *copy)
{
    return (ale_posed_scan_t){&copy->scan, copy->straightened ? copy->bearing_bam : NULL, copy->sensor};
}

bool ale_are_near(ale_pose_t a, ale_pose_t b, int32_t within_um, int32_t within_bam)
{
    const ale_pose_t way = ale_pose_between(a, b);
    return ale_abs64(way.x_um) < within_um && ale_abs64(way.y_um) < within_um &&
           ale_abs64((int32_t)way.theta_bam) < within_bam;
}
