/* .scip recordings: typed, stamped, checksummed chunks of everything that went in and out.
 *
 * File: 8 bytes "ALESCIP1", then chunks. Chunk, little endian:
 *   u32 magic 0x4b4e4843 ("CHNK") | u8 kind | 3 bytes 0 | u32 length | i64 stamp_us | payload | u32 crc32
 * The CRC (zlib's) covers kind to payload. A reader that meets a bad chunk looks for the next magic.
 * Payloads: RECEIVED, SENT raw serial bytes; ODOMETRY i32 x_um, i32 y_um, u32 theta_bam, i64 stamp_us;
 * COMMAND, CONFIG text; CORRECTION u32 scan, i32 x_um, i32 y_um, u32 theta_bam; DECISION, STAGES free. */
#ifndef ALE_STORE_RECORDING_H
#define ALE_STORE_RECORDING_H

#include <stdint.h>
#include <stdio.h>

#include "track/odometry_sample.h"

typedef enum {
    ALE_CHUNK_RECEIVED = 1,
    ALE_CHUNK_SENT = 2,
    ALE_CHUNK_ODOMETRY = 3,
    ALE_CHUNK_COMMAND = 4,
    ALE_CHUNK_CORRECTION = 5,
    ALE_CHUNK_CONFIG = 6,
    ALE_CHUNK_DECISION = 7,
    ALE_CHUNK_STAGES = 8
} ale_chunk_kind_t;

enum { ALE_CHUNK_MAX_PAYLOAD = 65536 };

typedef struct {
    FILE *file;
} ale_recording_t;

/* Each: 0, or -1 with errno set. */
int ale_recording_create(ale_recording_t *recording, const char *path);
int ale_recording_write(ale_recording_t *recording, ale_chunk_kind_t kind, int64_t stamp_us,
                        const void *payload, uint32_t length);
int ale_recording_odometry(ale_recording_t *recording, int64_t stamp_us, const ale_odometry_t *sample);
int ale_recording_close(ale_recording_t *recording);

#endif
