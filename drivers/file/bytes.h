/* A whole file in memory, unpacked: every reader works on bytes and none on files. */
#ifndef ALE_FILE_BYTES_H
#define ALE_FILE_BYTES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/stat.h>

/* Largest file, unpacked: above, the file is refused (a damaged or hostile packed file can claim anything). A
 * machine of 32 bits has no room for more than a quarter of what it can address. */
#define ALE_BYTES_MOST (SIZE_MAX > UINT32_MAX ? (size_t)((uint64_t)4 << 30) : (size_t)1 << 30)

/* A packed file may unpack to a hundred times its size, or to this: logs of scans do to ten or twenty times,
 * and a few megabytes that are meant to fill the memory to a thousand. */
#define ALE_BYTES_RATIO ((size_t)100)
#define ALE_BYTES_ANY_RATIO ((size_t)256 << 20)

typedef struct {
    const uint8_t *at;
    size_t count;
    uint8_t *owned; /* to be freed, or NULL when the bytes are the caller's */
    bool cut_short; /* a packed stream that ends early or is damaged: what came before it is here */
} ale_bytes_t;

/* Reads the file (or pipe), unpacking gzip and bzip2 by content. NULL and *out, the caller's to give back
 * with ale_bytes_free; or what is wrong in a few words: the system's (not there, no rights, ...), "is a
 * directory", "too large", "unpacks to more than ...", "not enough memory". Damage is no error: see
 * cut_short. */
const char *ale_bytes_read_file(ale_bytes_t *out, const char *path);

/* The same for bytes in memory, which must outlive *out: "unpacks to more than ..." or "not enough memory".
 */
const char *ale_bytes_from_memory(ale_bytes_t *out, const uint8_t *bytes, size_t count);

/* Which files are taken. */
typedef struct {
    size_t most; /* bytes */
    bool follow_links;
} ale_bytes_rule_t;

/* Opens a regular file to be read, and *status says whose the very file is. NULL and *file, the caller's to
 * close; or what is wrong: the system's words, "is a directory", "no regular file" (a pipe, a device), "a
 * symbolic link, ..." (the last part of the path, where links are not followed), "too large". Never waits for
 * a pipe. */
const char *ale_bytes_open_regular(int *file, const char *path, const ale_bytes_rule_t *rule,
                                   struct stat *status);

/* Reads it as it is. NULL and *out, the caller's to give back; or what is wrong: as above, or "not enough
 * memory". */
const char *ale_bytes_read_regular(ale_bytes_t *out, const char *path, const ale_bytes_rule_t *rule,
                                   struct stat *status);

/* Zeroed bytes: nothing. */
void ale_bytes_free(ale_bytes_t *bytes);

#endif
