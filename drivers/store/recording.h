/* .scip recordings: typed, stamped, checksummed chunks of everything that went in and out.
 *
 * File: 8 bytes "ALESCIP1", then chunks. Chunk, little endian:
 *   u32 magic 0x4b4e4843 ("CHNK") | u8 kind | 3 bytes 0 | u32 length | i64 stamp_us | payload | u32 crc32
 * The CRC (zlib's) covers kind to payload. A reader that meets a bad chunk looks for the next magic.
 * Payloads: RECEIVED, SENT raw serial bytes; ODOMETRY i32 x_um, i32 y_um, u32 theta_bam, i64 stamp_us;
 * COMMAND, CONFIG text; CORRECTION u32 scan, i32 x_um, i32 y_um, u32 theta_bam; DECISION, STAGES text, words
 * `name=value` (firmware/recorder/flight_words.h). */
#ifndef ALE_STORE_RECORDING_H
#define ALE_STORE_RECORDING_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "motion/odometry_sample.h"

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

enum {
    ALE_CHUNK_MAX_PAYLOAD = 65536,
    ALE_CHUNK_HEADER_BYTES = 20,
    ALE_CHUNK_FRAME_BYTES = ALE_CHUNK_HEADER_BYTES + 4, /* what a chunk needs beside its payload */
    ALE_CHUNK_ODOMETRY_BYTES = 20
};

typedef struct {
    FILE *file;
} ale_recording_t;

/* Writing. One owner thread; buffered, so a crash loses the last chunks and never the ones before. Each: 0,
 * or -1 with errno set as by fopen, fwrite and fclose. */

/* Begins a recording in an open file, which is the recording's until close, or in a new one. */
int ale_recording_begin(ale_recording_t *recording, FILE *file);
int ale_recording_create(ale_recording_t *recording, const char *path);

/* One chunk; EINVAL: a payload above ALE_CHUNK_MAX_PAYLOAD. stamp_us: when it happened. */
int ale_recording_write(ale_recording_t *recording, ale_chunk_kind_t kind, int64_t stamp_us,
                        const void *payload, uint32_t length);
int ale_recording_odometry(ale_recording_t *recording, int64_t stamp_us, const ale_odometry_t *sample);

/* Closed already: 0. EIO: an earlier write failed, the recording is not whole. */
int ale_recording_close(ale_recording_t *recording);

/* Chunks in memory, for those who keep them before they are written.
 *
 * ale_chunk_put: a whole chunk to `out`, which has ALE_CHUNK_FRAME_BYTES more room than the payload is long
 * (at most ALE_CHUNK_MAX_PAYLOAD). Returns its bytes. ale_chunk_bytes: the same of a chunk whose header is at
 * hand. ale_chunk_put_odometry: the payload of an ODOMETRY chunk. */
uint32_t ale_chunk_put(uint8_t *out, ale_chunk_kind_t kind, int64_t stamp_us, const void *payload,
                       uint32_t length);
uint32_t ale_chunk_bytes(const uint8_t header[ALE_CHUNK_HEADER_BYTES]);
void ale_chunk_put_odometry(uint8_t payload[ALE_CHUNK_ODOMETRY_BYTES], const ale_odometry_t *sample);

/* Reading back, from memory. */
typedef struct {
    ale_chunk_kind_t kind; /* as written; later versions may know more kinds than the enum */
    int64_t stamp_us;
    const uint8_t *payload; /* in the caller's bytes */
    uint32_t length;
} ale_chunk_t;

typedef struct {
    const uint8_t *at;
    const uint8_t *end;
    uint64_t bad_chunks; /* damaged or cut off at the end: skipped */
} ale_chunk_reader_t;

/* The bytes begin as a recording does. */
bool ale_recording_claims(const uint8_t *bytes, size_t count);

/* The bytes must begin as a recording does and outlive the reader. */
ale_chunk_reader_t ale_chunk_reader(const uint8_t *bytes, size_t count);

/* The next intact chunk; false at the end. Damage is skipped up to the next magic and counted once. */
bool ale_chunk_next(ale_chunk_reader_t *reader, ale_chunk_t *chunk);

/* The payload of an ODOMETRY chunk; false when its length is not that of one. */
bool ale_chunk_odometry(const ale_chunk_t *chunk, ale_odometry_t *sample);

#endif
