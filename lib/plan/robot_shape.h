/* What a planner must know of the robot's body: its width and how fast it comes to rest.
 *
 * The robot is a disc around the point it turns about (the origin of its frame), wide enough to hold all of
 * it: turning in place then never touches anything. */
#ifndef ALE_PLAN_ROBOT_SHAPE_H
#define ALE_PLAN_ROBOT_SHAPE_H

#include <stdint.h>

typedef struct {
    int32_t width_um;           /* diameter of the disc */
    int32_t margin_um;          /* room left between the disc and what is seen when the robot has stopped */
    int32_t deceleration_um_s2; /* of braking, positive */
    int32_t reaction_us;        /* from the measurement of a scan to the first effect of braking */
    int32_t blind_um_s;         /* most speed towards where the scanner does not look */
} ale_robot_shape_t;

/* A small robot, 40 cm wide, that brakes with 0.5 m/s^2 a quarter of a second after the scan. */
ale_robot_shape_t ale_robot_shape_default(void);

#endif
