/* The projection of the plane onto a direction: what of a vector points along it. */
#ifndef ALE_MOTION_PROJECTION_H
#define ALE_MOTION_PROJECTION_H

#include <stdint.h>

/* n n^T of the direction n. */
typedef struct {
    int64_t xx_q20;
    int64_t xy_q20;
    int64_t yy_q20;
} ale_projection_t;

ale_projection_t ale_projection(uint32_t direction_bam);

#endif
