#include "store/recording.h"

#include <errno.h>
#include <string.h>
#include <zlib.h>

#include "file/little_endian.h"

static const char SIGNATURE[8] = {'A', 'L', 'E', 'S', 'C', 'I', 'P', '1'};
static const uint8_t MAGIC[4] = {'C', 'H', 'N', 'K'};

enum {
    KIND_AT = 4, /* the CRC covers from here to the end of the payload */
    LENGTH_AT = 8,
    STAMP_AT = 12,
    HEADER_BYTES = ALE_CHUNK_HEADER_BYTES,
    CRC_BYTES = ALE_CHUNK_FRAME_BYTES - ALE_CHUNK_HEADER_BYTES
};

int ale_recording_begin(ale_recording_t *recording, FILE *file)
{
    recording->file = file;
    return fwrite(SIGNATURE, sizeof SIGNATURE, 1, file) == 1 ? 0 : -1;
}

int ale_recording_create(ale_recording_t *recording, const char *path)
{
    recording->file = fopen(path, "wbe");
    if (!recording->file) {
        return -1;
    }
    if (ale_recording_begin(recording, recording->file) < 0) {
        fclose(recording->file);
        recording->file = NULL;
        return -1;
    }
    return 0;
}

static uint32_t checksum(const uint8_t *header, const void *payload, uint32_t length)
{
    const uLong head = crc32(0, header + KIND_AT, HEADER_BYTES - KIND_AT);
    return (uint32_t)(length ? crc32(head, payload, length) : head);
}

static void put_header(uint8_t header[HEADER_BYTES], ale_chunk_kind_t kind, int64_t stamp_us, uint32_t length)
{
    memset(header, 0, HEADER_BYTES);
    memcpy(header, MAGIC, sizeof MAGIC);
    header[KIND_AT] = (uint8_t)kind;
    ale_put_u32(header + LENGTH_AT, length);
    ale_put_u64(header + STAMP_AT, (uint64_t)stamp_us);
}

uint32_t ale_chunk_put(uint8_t *out, ale_chunk_kind_t kind, int64_t stamp_us, const void *payload,
                       uint32_t length)
{
    put_header(out, kind, stamp_us, length);
    memcpy(out + HEADER_BYTES, payload, length);
    ale_put_u32(out + HEADER_BYTES + length, checksum(out, payload, length));
    return ALE_CHUNK_FRAME_BYTES + length;
}

uint32_t ale_chunk_bytes(const uint8_t header[HEADER_BYTES])
{
    return ALE_CHUNK_FRAME_BYTES + ale_get_u32(header + LENGTH_AT);
}

void ale_chunk_put_odometry(uint8_t payload[ALE_CHUNK_ODOMETRY_BYTES], const ale_odometry_t *sample)
{
    ale_put_u32(payload, (uint32_t)sample->pose.x_um);
    ale_put_u32(payload + 4, (uint32_t)sample->pose.y_um);
    ale_put_u32(payload + 8, sample->pose.theta_bam);
    ale_put_u64(payload + 12, (uint64_t)sample->stamp_us);
}

int ale_recording_write(ale_recording_t *recording, ale_chunk_kind_t kind, int64_t stamp_us,
                        const void *payload, uint32_t length)
{
    if (length > ALE_CHUNK_MAX_PAYLOAD) {
        errno = EINVAL;
        return -1;
    }
    uint8_t header[HEADER_BYTES];
    uint8_t crc[CRC_BYTES];
    put_header(header, kind, stamp_us, length);
    ale_put_u32(crc, checksum(header, payload, length));
    const bool written = fwrite(header, sizeof header, 1, recording->file) == 1 &&
                         (length == 0 || fwrite(payload, length, 1, recording->file) == 1) &&
                         fwrite(crc, sizeof crc, 1, recording->file) == 1;
    return written ? 0 : -1;
}

int ale_recording_odometry(ale_recording_t *recording, int64_t stamp_us, const ale_odometry_t *sample)
{
    uint8_t payload[ALE_CHUNK_ODOMETRY_BYTES];
    ale_chunk_put_odometry(payload, sample);
    return ale_recording_write(recording, ALE_CHUNK_ODOMETRY, stamp_us, payload, sizeof payload);
}

int ale_recording_close(ale_recording_t *recording)
{
    FILE *file = recording->file;
    recording->file = NULL;
    if (!file) {
        return 0;
    }
    const bool incomplete = ferror(file) != 0;
    if (fclose(file) != 0) {
        return -1;
    }
    if (incomplete) {
        errno = EIO;
        return -1;
    }
    return 0;
}

bool ale_recording_claims(const uint8_t *bytes, size_t count)
{
    return count >= sizeof SIGNATURE && memcmp(bytes, SIGNATURE, sizeof SIGNATURE) == 0;
}

ale_chunk_reader_t ale_chunk_reader(const uint8_t *bytes, size_t count)
{
    return (ale_chunk_reader_t){.at = bytes + (count < sizeof SIGNATURE ? count : sizeof SIGNATURE),
                                .end = bytes + count};
}

/* Bytes of the intact chunk that begins at `at`, or 0. */
static size_t intact_chunk(const uint8_t *at, size_t left)
{
    if (left < HEADER_BYTES + CRC_BYTES || memcmp(at, MAGIC, sizeof MAGIC) != 0) {
        return 0;
    }
    const uint32_t length = ale_get_u32(at + LENGTH_AT);
    if (length > ALE_CHUNK_MAX_PAYLOAD || left < HEADER_BYTES + CRC_BYTES + length) {
        return 0;
    }
    const uint32_t crc = ale_get_u32(at + HEADER_BYTES + length);
    return crc == checksum(at, at + HEADER_BYTES, length) ? HEADER_BYTES + length + CRC_BYTES : 0;
}

/* Moves past damage: to the next magic behind `at`, or to the end. */
static const uint8_t *next_magic(const uint8_t *at, const uint8_t *end)
{
    const uint8_t *found = memmem(at + 1, (size_t)(end - at - 1), MAGIC, sizeof MAGIC);
    return found ? found : end;
}

bool ale_chunk_next(ale_chunk_reader_t *reader, ale_chunk_t *chunk)
{
    bool damage = false;
    while (reader->at < reader->end) {
        const uint8_t *at = reader->at;
        const size_t bytes = intact_chunk(at, (size_t)(reader->end - at));
        if (bytes == 0) {
            reader->bad_chunks += !damage;
            damage = true;
            reader->at = next_magic(at, reader->end);
            continue;
        }
        *chunk = (ale_chunk_t){.kind = (ale_chunk_kind_t)at[KIND_AT],
                               .stamp_us = (int64_t)ale_get_u64(at + STAMP_AT),
                               .payload = at + HEADER_BYTES,
                               .length = ale_get_u32(at + LENGTH_AT)};
        reader->at += bytes;
        return true;
    }
    return false;
}

bool ale_chunk_odometry(const ale_chunk_t *chunk, ale_odometry_t *sample)
{
    if (chunk->length != ALE_CHUNK_ODOMETRY_BYTES) {
        return false;
    }
    *sample = (ale_odometry_t){.stamp_us = (int64_t)ale_get_u64(chunk->payload + 12),
                               .pose = {.x_um = (int32_t)ale_get_u32(chunk->payload),
                                        .y_um = (int32_t)ale_get_u32(chunk->payload + 4),
                                        .theta_bam = ale_get_u32(chunk->payload + 8)}};
    return true;
}
