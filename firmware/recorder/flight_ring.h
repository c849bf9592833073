/* The last minutes as chunks of a recording, in memory of fixed size: the oldest make room for the newest.
 *
 * What a reader needs to understand the rest, the scanner's answers until its stream was asked for, is kept
 * apart and written first once the ring has lost it. One thread. */
#ifndef ALE_FIRMWARE_RECORDER_FLIGHT_RING_H
#define ALE_FIRMWARE_RECORDER_FLIGHT_RING_H

#include <stdint.h>

#include "store/recording.h"

enum { ALE_FLIGHT_MAX_PAYLOAD = 1024 };

typedef struct ale_flight_ring ale_flight_ring_t;

/* `bytes` of room, all touched. NULL: out of memory. */
ale_flight_ring_t *ale_flight_ring_create(uint32_t bytes);
void ale_flight_ring_destroy(ale_flight_ring_t *ring);

/* Constant time but for the chunks that make room. length: at most ALE_FLIGHT_MAX_PAYLOAD. */
void ale_flight_ring_put(ale_flight_ring_t *ring, ale_chunk_kind_t kind, int64_t stamp_us,
                         const void *payload, uint32_t length);

/* The whole content behind what the recording holds already, oldest first; errors show in its file. */
void ale_flight_ring_write(const ale_flight_ring_t *ring, ale_recording_t *recording);

#endif
