/* The maps of a drive: a robot that does not know where it is begins a new one, and joins it to an older one
 * when it recognises a place there. */
#ifndef ALE_TRACK_MAPS_H
#define ALE_TRACK_MAPS_H

#include <stdbool.h>

#include "track/pipeline_state.h"

/* The robot is in the first map, or the loaded one: others call it lost elsewhere. */
bool ale_maps_is_home(const ale_pipeline_t *p);

/* Nothing is known of where the robot is from here on, but what is claimed of its pose. */
void ale_maps_lose(ale_pipeline_t *p, ale_claim_t claim);

/* Whether the scan at hand shows enough to begin a map with. */
bool ale_maps_may_begin(const ale_pipeline_t *p);

/* Begins a new map at the robot's pose; the scan at hand is to be its first. O(map). */
void ale_maps_begin(ale_pipeline_t *p);

/* The robot's map joins another one, in which the robot is at fit->motion. O(map). */
void ale_maps_join(ale_pipeline_t *p, uint8_t into, const ale_fit_t *fit);

/* The mapper has found that one map is part of another; all of it has moved already. Whichever is given up
 * meanwhile, nothing is done. */
void ale_maps_joined(ale_pipeline_t *p, uint32_t map_id, uint32_t into_map_id);

#endif
