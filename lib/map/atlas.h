/* Which maps there are. A robot that no longer knows where it is begins a new map and goes on in it; when it
 * recognises a place of an older map, the new one joins that.
 *
 * Every wall, landmark and corner belongs to one map, by its number here (`map`). The frame of a map that is
 * not joined has nothing to do with that of another. Bounded: of more maps than there is room for the oldest
 * but the first is given up. Source of the word: Bosse et al., "An Atlas framework", ICRA 2003. One owner. */
#ifndef ALE_MAP_ATLAS_H
#define ALE_MAP_ATLAS_H

#include <stdbool.h>
#include <stdint.h>

#include "base/pose.h"

enum { ALE_ATLAS_MAPS = 8, ALE_FIRST_MAP = 0, ALE_NO_MAP = -1 };

/* What is claimed of where a robot is that begins a new map. */
typedef enum {
    ALE_CLAIM_NONE,    /* it may be anywhere */
    ALE_CLAIM_REACHED, /* around there, so far as it can have got while nobody watched */
    ALE_CLAIM_NEAR,    /* around where its pose says */
    ALE_CLAIM_DRIVEN,  /* where its wheels have led it, and nowhere else */
    ALE_CLAIM_SAID     /* there, as somebody says: one scan that fits is enough */
} ale_claim_t;

/* One map has become part of another. */
typedef struct {
    uint32_t number;      /* of joins so far, from 1; 0: none yet */
    uint32_t map_id;      /* that is no more */
    uint32_t into_map_id; /* that it is part of */
    ale_pose_t shift;     /* by which all of it moved: new place = shift applied to the old one */
} ale_map_join_t;

typedef struct {
    uint32_t id[ALE_ATLAS_MAPS]; /* of the maps that there are; the first one is 0 */
    bool used[ALE_ATLAS_MAPS];
    uint32_t next_id;
    uint8_t current;     /* that the robot is in */
    ale_map_join_t join; /* the last */
} ale_atlas_t;

/* One map, the first, and the robot is in it. */
void ale_atlas_init(ale_atlas_t *atlas);

/* A new map, and the robot is in it. Returns the number whose walls must go first: that of the map given up,
 * which is the new one's now, or of a free place, which has none. */
uint8_t ale_atlas_begin(ale_atlas_t *atlas);

/* The robot's map joins another one that there is, moved by `shift`; the robot is in that one. */
void ale_atlas_join(ale_atlas_t *atlas, uint8_t into, ale_pose_t shift);

/* A map is part of another one from now on, and so is the robot if it is in it. */
void ale_atlas_absorb(ale_atlas_t *atlas, uint8_t from, uint8_t into);

/* The number by which others know the robot's map: 0 the first, never used twice. */
uint32_t ale_atlas_map_id(const ale_atlas_t *atlas);

/* The number here of a map that others know by its id, or ALE_NO_MAP. */
int32_t ale_atlas_find(const ale_atlas_t *atlas, uint32_t map_id);

/* How many maps there are. */
uint32_t ale_atlas_maps(const ale_atlas_t *atlas);

#endif
