#include "file/bytes.h"

#include <bzlib.h>
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

enum { FIRST_CAPACITY = 1 << 16, GZIP_WINDOW = 15 + 16 };

static const char TOO_LARGE[] = "too large";
static const char IS_DIRECTORY[] = "is a directory";
static const char SWELLS[] =
    "unpacks to more than 256 MiB and a hundred times its size: not believed (unpack it "
    "first where it is meant so)";

typedef struct {
    uint8_t *at;
    size_t count;
    size_t capacity;
    size_t most;          /* capacity never exceeds it */
    const char *too_much; /* what is said then */
} buffer_t;

static const char *make_room(buffer_t *buffer)
{
    if (buffer->count < buffer->capacity) {
        return NULL;
    }
    if (buffer->capacity >= buffer->most) {
        return buffer->too_much;
    }
    const size_t wanted = buffer->capacity ? 2 * buffer->capacity : FIRST_CAPACITY;
    const size_t capacity = wanted < buffer->most ? wanted : buffer->most;
    uint8_t *grown = realloc(buffer->at, capacity);
    if (!grown) {
        return "not enough memory";
    }
    buffer->at = grown;
    buffer->capacity = capacity;
    return NULL;
}

static const char *read_all(int file, buffer_t *buffer)
{
    for (;;) {
        const char *wrong = make_room(buffer);
        if (wrong) {
            return wrong;
        }
        const ssize_t count = read(file, buffer->at + buffer->count, buffer->capacity - buffer->count);
        if (count < 0 && errno == EINTR) {
            continue;
        }
        if (count < 0) {
            return strerror(errno);
        }
        if (count == 0) {
            return NULL;
        }
        buffer->count += (size_t)count;
    }
}

static const char *read_path(const char *path, buffer_t *buffer)
{
    const int file = open(path, O_RDONLY | O_CLOEXEC);
    if (file < 0) {
        return strerror(errno);
    }
    struct stat status;
    const char *wrong = fstat(file, &status) == 0 && S_ISDIR(status.st_mode) ? IS_DIRECTORY : NULL;
    if (!wrong) {
        wrong = read_all(file, buffer);
    }
    close(file);
    return wrong;
}

static const char *check_regular(int file, size_t most, struct stat *status)
{
    if (fstat(file, status) < 0) {
        return strerror(errno);
    }
    if (S_ISDIR(status->st_mode)) {
        return IS_DIRECTORY;
    }
    if (!S_ISREG(status->st_mode)) {
        return "no regular file";
    }
    return (uint64_t)status->st_size > most ? TOO_LARGE : NULL;
}

/* The part of a buffer that a library with 32-bit counts takes in one step. */
static unsigned step_size(size_t left)
{
    return left < UINT32_MAX ? (unsigned)left : UINT32_MAX;
}

static bool is_bzip2(const uint8_t *bytes, size_t count)
{
    return count >= 4 && memcmp(bytes, "BZh", 3) == 0 && bytes[3] >= '1' && bytes[3] <= '9';
}

static bool is_gzip(const uint8_t *bytes, size_t count)
{
    return count >= 2 && bytes[0] == 0x1f && bytes[1] == 0x8b;
}

/* Takes one step of unpacking; *done when the last member has ended or nothing more can be had. */
static const char *inflate_step(z_stream *stream, const uint8_t *end, buffer_t *out, bool *done,
                                bool *cut_short)
{
    const char *wrong = make_room(out);
    if (wrong) {
        return wrong;
    }
    const size_t room = out->capacity - out->count;
    stream->next_out = out->at + out->count;
    stream->avail_out = step_size(room);
    const uInt before = stream->avail_out;
    if (stream->avail_in == 0) {
        stream->avail_in = step_size((size_t)(end - stream->next_in));
    }
    const int status = inflate(stream, Z_NO_FLUSH);
    out->count += before - stream->avail_out;
    if (status == Z_STREAM_END) {
        const size_t left = (size_t)(end - stream->next_in);
        *done = !is_gzip(stream->next_in, left) || inflateReset(stream) != Z_OK;
    } else if (status != Z_OK) {
        *done = true;
        *cut_short = true;
    }
    return NULL;
}

static const char *gunzip(const uint8_t *bytes, size_t count, buffer_t *out, bool *cut_short)
{
    z_stream stream = {.next_in = (z_const Bytef *)bytes};
    if (inflateInit2(&stream, GZIP_WINDOW) != Z_OK) {
        return "not enough memory";
    }
    const char *wrong = NULL;
    for (bool done = false; !wrong && !done;) {
        wrong = inflate_step(&stream, bytes + count, out, &done, cut_short);
    }
    inflateEnd(&stream);
    return wrong;
}

/* One bzip2 stream; *bytes and *count: what is behind it. */
static const char *bunzip2_stream(const uint8_t **bytes, size_t *count, buffer_t *out, bool *cut_short)
{
    bz_stream stream = {0};
    if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) {
        return "not enough memory";
    }
    const char *wrong = NULL;
    int status = BZ_OK;
    while (!wrong && status == BZ_OK && !(*count == 0 && stream.avail_out > 0)) {
        wrong = make_room(out);
        if (!wrong) {
            const unsigned room = step_size(out->capacity - out->count);
            const unsigned given = step_size(*count);
            stream.next_in = (char *)*bytes; /* the library reads it only */
            stream.avail_in = given;
            stream.next_out = (char *)out->at + out->count;
            stream.avail_out = room;
            status = BZ2_bzDecompress(&stream);
            out->count += room - stream.avail_out;
            *bytes += given - stream.avail_in;
            *count -= given - stream.avail_in;
        }
    }
    *cut_short = !wrong && status != BZ_STREAM_END;
    BZ2_bzDecompressEnd(&stream);
    return wrong;
}

static const char *bunzip2(const uint8_t *bytes, size_t count, buffer_t *out, bool *cut_short)
{
    const char *wrong = NULL;
    while (!wrong && !*cut_short && is_bzip2(bytes, count)) {
        wrong = bunzip2_stream(&bytes, &count, out, cut_short);
    }
    return wrong;
}

static size_t unpacked_most(size_t packed)
{
    if (packed >= ALE_BYTES_MOST / ALE_BYTES_RATIO) {
        return ALE_BYTES_MOST;
    }
    const size_t by_ratio = packed * ALE_BYTES_RATIO;
    return by_ratio > ALE_BYTES_ANY_RATIO ? by_ratio : ALE_BYTES_ANY_RATIO;
}

const char *ale_bytes_from_memory(ale_bytes_t *out, const uint8_t *bytes, size_t count)
{
    *out = (ale_bytes_t){.at = bytes, .count = count};
    if (!is_gzip(bytes, count) && !is_bzip2(bytes, count)) {
        return NULL;
    }
    buffer_t plain = {.most = unpacked_most(count), .too_much = SWELLS};
    const char *wrong = is_gzip(bytes, count) ? gunzip(bytes, count, &plain, &out->cut_short)
                                              : bunzip2(bytes, count, &plain, &out->cut_short);
    if (wrong) {
        free(plain.at);
        return wrong;
    }
    out->at = out->owned = plain.at;
    out->count = plain.count;
    return NULL;
}

const char *ale_bytes_read_file(ale_bytes_t *out, const char *path)
{
    buffer_t raw = {.most = ALE_BYTES_MOST, .too_much = TOO_LARGE};
    *out = (ale_bytes_t){0};
    const char *wrong = read_path(path, &raw);
    if (!wrong) {
        wrong = ale_bytes_from_memory(out, raw.at, raw.count);
    }
    if (!wrong && !out->owned) {
        out->owned = raw.at;
        return NULL;
    }
    free(raw.at);
    return wrong;
}

const char *ale_bytes_open_regular(int *file, const char *path, const ale_bytes_rule_t *rule,
                                   struct stat *status)
{
    /* What is opened is looked at before it is read: a pipe without a writer must not hold us up. */
    *file = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC | (rule->follow_links ? 0 : O_NOFOLLOW));
    if (*file < 0) {
        return errno == ELOOP && !rule->follow_links ? "a symbolic link, which is not followed"
                                                     : strerror(errno);
    }
    const char *wrong = check_regular(*file, rule->most, status);
    if (wrong) {
        close(*file);
    }
    return wrong;
}

const char *ale_bytes_read_regular(ale_bytes_t *out, const char *path, const ale_bytes_rule_t *rule,
                                   struct stat *status)
{
    int file;
    buffer_t raw = {.most = rule->most + 1, .too_much = TOO_LARGE};
    *out = (ale_bytes_t){0};
    const char *wrong = ale_bytes_open_regular(&file, path, rule, status);
    if (wrong) {
        return wrong;
    }
    wrong = read_all(file, &raw);
    close(file);
    if (wrong) {
        free(raw.at);
        return wrong;
    }
    *out = (ale_bytes_t){.at = raw.at, .count = raw.count, .owned = raw.at};
    return NULL;
}

void ale_bytes_free(ale_bytes_t *bytes)
{
    free(bytes->owned);
    *bytes = (ale_bytes_t){0};
}
