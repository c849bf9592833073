#include "plan/robot_shape.h"

ale_robot_shape_t ale_robot_shape_default(void)
{
    const ale_robot_shape_t shape = {.width_um = 400000,
                                     .margin_um = 30000,
                                     .deceleration_um_s2 = 500000,
                                     .reaction_us = 250000,
                                     .blind_um_s = 100000};
    return shape;
}
