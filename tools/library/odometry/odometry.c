/* Sends odometry: reads metres of the left and the right wheel since the line before, a line each time.
 *
 *   cc odometry.c ale_odometry_t.c -llcm -lm -o odometry && your-wheels | ./odometry TRACK_METRES */
#include <lcm/lcm.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "ale_odometry_t.h"

static int64_t now_us(void)
{
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    return (int64_t)now.tv_sec * 1000000 + now.tv_nsec / 1000;
}

int main(int argc, char **argv)
{
    const double track_m = argc == 2 ? atof(argv[1]) : 0;
    lcm_t *lcm = lcm_create(NULL); /* NULL: LCM_DEFAULT_URL, else LCM's own default */
    if (track_m <= 0 || !lcm) {
        fprintf(stderr, "usage: odometry TRACK_METRES < METRES_OF_LEFT_AND_RIGHT (and LCM must be there)\n");
        return 2;
    }
    double x = 0, y = 0, theta = 0, left = 0, right = 0;
    while (scanf("%lf %lf", &left, &right) == 2) {
        const double turn = (right - left) / track_m;
        x += (left + right) / 2 * cos(theta + turn / 2);
        y += (left + right) / 2 * sin(theta + turn / 2);
        theta += turn;
        const ale_odometry_t message = {now_us(), (float)x, (float)y, (float)remainder(theta, 2 * M_PI)};
        ale_odometry_t_publish(lcm, "ALE_ODOMETRY", &message);
    }
    lcm_destroy(lcm);
    return 0;
}
