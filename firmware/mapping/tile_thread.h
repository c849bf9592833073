/* The thread that reads the tiles of a large map from disk, as the robot goes on; like any program.
 *
 *   estimate ── whereabouts ──► here ── pieces ──► estimate, mapper
 *
 * It looks fifty times a second, since the estimate task wakes nobody. A piece waits in its ring until the
 * scan that it names, as corrections do: the same recording gives the same poses, unless a disk takes longer
 * than that; then it is taken on arrival. Tiles that cannot be read are told, and the rest goes on. */
#ifndef ALE_FIRMWARE_MAPPING_TILE_THREAD_H
#define ALE_FIRMWARE_MAPPING_TILE_THREAD_H

#include "exchange/exchange.h"
#include "store/tile_loader.h"

typedef struct ale_tile_thread ale_tile_thread_t;

/* exchange and loader must outlive it. NULL: out of memory or threads. */
ale_tile_thread_t *ale_tile_thread_start(ale_exchange_t *exchange, ale_tile_loader_t *loader);

/* Waits for the tile that is being read. NULL: nothing. */
void ale_tile_thread_stop(ale_tile_thread_t *thread);

#endif
