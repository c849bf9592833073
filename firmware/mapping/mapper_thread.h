/* The mapper thread: keyframes from the estimate task in, corrections of its map back; like any program.
 *
 * It looks for keyframes fifty times a second, since the estimate task wakes nobody. A correction waits in
 * its ring until the scan that the mapper names, which is what ale-replay does too: the same recording gives
 * the same poses, unless the mapper comes later than that; then the correction is taken on arrival. */
#ifndef ALE_FIRMWARE_MAPPING_MAPPER_THREAD_H
#define ALE_FIRMWARE_MAPPING_MAPPER_THREAD_H

#include "exchange/exchange.h"

typedef struct ale_mapper_thread ale_mapper_thread_t;

/* exchange must outlive it. NULL: out of memory or threads. */
ale_mapper_thread_t *ale_mapper_thread_start(ale_exchange_t *exchange);

/* Waits for the keyframe that is being worked on. NULL: nothing. */
void ale_mapper_thread_stop(ale_mapper_thread_t *thread);

#endif
