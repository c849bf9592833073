#include "motion/wheel_monitor.h"

#include <stdbool.h>
#include <string.h>

#include "base/fixed.h"
#include "base/trig.h"

enum {
    FORGETS = 16,            /* scans */
    HALF_TRACK_MM = 200,     /* way of a wheel for a turn of a radian, of a small robot */
    MOVED_LEAST_UM = 150000, /* that can be judged */
    BEGINS_PERCENT = 50,     /* of what the robot moved that wheels are off when a fault begins, */
    ENDS_PERCENT = 25,       /* and ends */
    NOTHING_PERCENT = 20,
    SAME_PERCENT = 80
};

void ale_wheel_monitor_init(ale_wheel_monitor_t *monitor)
{
    memset(monitor, 0, sizeof *monitor);
}

static int64_t turn_um(uint32_t theta_bam)
{
    return ale_bam_to_nrad((int32_t)theta_bam) * HALF_TRACK_MM / 1000000;
}

static int64_t size_um(ale_pose_t d)
{
    return ale_abs64(d.x_um) + ale_abs64(turn_um(d.theta_bam));
}

/* How far two displacements are apart, the second one taken `sign` times. */
static int64_t apart_um(ale_pose_t a, ale_pose_t b, int64_t sign)
{
    return ale_abs64(a.x_um - sign * b.x_um) + ale_abs64(turn_um(a.theta_bam) - sign * turn_um(b.theta_bam));
}

static void add(int64_t *sum_um, int64_t more_um)
{
    *sum_um += more_um - *sum_um / FORGETS;
}

static bool is_late(const ale_wheel_monitor_t *m)
{
    int64_t least_um = m->apart_um;
    for (int k = 0; k < ALE_WHEEL_MONITOR_DELAYS; k++) {
        least_um = ale_min64(least_um, m->delayed_um[k]);
    }
    return least_um * 100 < m->apart_um * BEGINS_PERCENT;
}

static ale_wheel_fault_t named(const ale_wheel_monitor_t *m)
{
    if (m->counted_um * 100 < m->found_um * NOTHING_PERCENT) {
        return ALE_WHEELS_STALLED;
    }
    if (m->against_um * 100 < m->apart_um * BEGINS_PERCENT) {
        return ALE_WHEELS_REVERSED;
    }
    if (ale_abs64(m->counted_um - m->found_um) * 100 > m->apart_um * SAME_PERCENT) {
        return ALE_WHEELS_SCALE;
    }
    return is_late(m) ? ALE_WHEELS_LATE : ALE_WHEELS_CONTRADICT;
}

static void judge(ale_wheel_monitor_t *m)
{
    const int64_t moved_um = ale_max64(m->counted_um, m->found_um);
    if (moved_um < MOVED_LEAST_UM) {
        return;
    }
    if (m->apart_um * 100 > moved_um * BEGINS_PERCENT) {
        m->faults += m->fault == ALE_WHEELS_FINE;
        m->fault = named(m);
    } else if (m->apart_um * 100 < moved_um * ENDS_PERCENT) {
        m->fault = ALE_WHEELS_FINE;
    }
}

void ale_wheel_monitor_compare(ale_wheel_monitor_t *monitor, ale_pose_t counted, ale_pose_t found)
{
    add(&monitor->counted_um, size_um(counted));
    add(&monitor->found_um, size_um(found));
    add(&monitor->apart_um, apart_um(found, counted, 1));
    add(&monitor->against_um, apart_um(found, counted, -1));
    for (int k = 0; k < ALE_WHEEL_MONITOR_DELAYS; k++) {
        add(&monitor->delayed_um[k], apart_um(monitor->found[k], counted, 1));
    }
    memmove(&monitor->found[1], &monitor->found[0], (ALE_WHEEL_MONITOR_DELAYS - 1) * sizeof found);
    monitor->found[0] = found;
    judge(monitor);
}
