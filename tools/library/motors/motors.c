/* Listens to ALE_DRIVE for a motor board: prints what both wheels are to do, metres a second, a line whenever
 * that changes. When nothing has come for 300 ms they stand: whoever has sent set points may have died.
 *
 *   cc motors.c ale_drive_t.c -llcm -o motors && ./motors TRACK_METRES | your-motors */
#include <lcm/lcm.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "ale_drive_t.h"

enum { DEAD_MAN_MS = 300 };

static ale_drive_t now; /* begins as zero: they stand */

static void take(const lcm_recv_buf_t *bytes, const char *channel, const ale_drive_t *set_point, void *user)
{
    (void)bytes, (void)channel, (void)user;
    const int fine = isfinite(set_point->v) && isfinite(set_point->w);
    now = fine ? *set_point : (ale_drive_t){0};
}

int main(int argc, char **argv)
{
    const double track_m = argc == 2 ? atof(argv[1]) : 0;
    lcm_t *lcm = lcm_create(NULL); /* NULL: LCM_DEFAULT_URL, else LCM's own default */
    if (track_m <= 0 || !lcm || !ale_drive_t_subscribe(lcm, "ALE_DRIVE", take, NULL)) {
        fprintf(stderr, "usage: motors TRACK_METRES (and LCM must be there)\n");
        return 2;
    }
    double told_v = NAN, told_w = NAN;
    for (int heard = 0; heard >= 0; heard = lcm_handle_timeout(lcm, DEAD_MAN_MS)) {
        now = heard > 0 ? now : (ale_drive_t){0};
        if (now.v != told_v || now.w != told_w) {
            printf("%.3f %.3f\n", now.v - now.w * track_m / 2, now.v + now.w * track_m / 2);
            fflush(stdout);
            told_v = now.v, told_w = now.w;
        }
    }
    return 1;
}
