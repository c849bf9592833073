/* Marks: where the map has no walls, the places of surfaces and small things, with normals.
 *
 * A table of cells (100 mm) by hash, four marks a set: bounded memory, bounded look-up. A set that is full
 * gives up its least seen mark. A mark is the running mean of the pieces that met it. One owner. */
#ifndef ALE_MAP_LANDMARKS_H
#define ALE_MAP_LANDMARKS_H

#include <stdbool.h>
#include <stdint.h>

#include "base/pose.h"

enum { ALE_MARK_SETS = 2048, ALE_MARK_WAYS = 4, ALE_NO_MARK = -1 };

typedef struct {
    ale_point_t p; /* map frame */
    uint32_t normal_bam;
    uint32_t last_scan;
    int64_t var_um2; /* along the normal; of a spot in every direction */
    uint16_t seen;   /* 0: the place is free */
    uint8_t spot;
    uint8_t missed;
    uint32_t born; /* scan that saw it first */
} ale_mark_t;

typedef struct {
    ale_mark_t mark[ALE_MARK_SETS * ALE_MARK_WAYS];
} ale_marks_t;

void ale_marks_clear(ale_marks_t *marks);

/* The nearest mark within reach_um (100 mm at most) of a place that faces about as `normal_bam` does (spots
 * face everywhere): its index, or ALE_NO_MARK. 36 marks are looked at. */
int32_t ale_marks_find(const ale_marks_t *marks, ale_point_t p, uint32_t normal_bam, bool spot,
                       int32_t reach_um);

/* Enters a new mark. */
void ale_marks_add(ale_marks_t *marks, const ale_mark_t *mark);

/* Takes an independent view of the mark, with its variance, into its mean. */
void ale_mark_observe(ale_mark_t *mark, ale_point_t p, uint32_t normal_bam, int64_t var_um2, uint32_t scan);

#endif
