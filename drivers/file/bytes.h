/* A whole file in memory, unpacked: every reader works on bytes and none on files. */
#ifndef ALE_FILE_BYTES_H
#define ALE_FILE_BYTES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Largest file, unpacked: above, the file is refused (a damaged or hostile packed file can claim anything). A
 * machine of 32 bits has no room for more than a quarter of what it can address. */
#define ALE_BYTES_MOST (SIZE_MAX > UINT32_MAX ? (size_t)((uint64_t)4 << 30) : (size_t)1 << 30)

typedef struct {
    const uint8_t *at;
    size_t count;
    uint8_t *owned; /* to be freed, or NULL when the bytes are the caller's */
    bool cut_short; /* a packed stream that ends early or is damaged: what came before it is here */
} ale_bytes_t;

/* Reads the file (or pipe), unpacking gzip and bzip2 by content. NULL and *out, the caller's to give back
 * with ale_bytes_free; or what is wrong in a few words: the system's (not there, no rights, ...), "is a
 * directory", "too large", "not enough memory". Damage is no error: see cut_short. */
const char *ale_bytes_read_file(ale_bytes_t *out, const char *path);

/* The same for bytes in memory, which must outlive *out: "too large" or "not enough memory". */
const char *ale_bytes_from_memory(ale_bytes_t *out, const uint8_t *bytes, size_t count);

/* Zeroed bytes: nothing. */
void ale_bytes_free(ale_bytes_t *bytes);

#endif
