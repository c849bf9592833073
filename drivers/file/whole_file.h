/* Files that are there whole or not at all: written beside, flushed to the disk, renamed.
 *
 *   ale_whole_file_t file;
 *   if (ale_whole_file_begin(&file, path) == 0) { write to file.out ...; ale_whole_file_commit(&file); }
 *
 * Whatever happens in between, power cuts included, the path holds what it held or the new content. A device
 * or a pipe (/dev/stdout) stays what it is: it is written as it comes. May block for as long as the disk
 * takes. One thread a path. */
#ifndef ALE_FILE_WHOLE_FILE_H
#define ALE_FILE_WHOLE_FILE_H

#include <stdio.h>

enum { ALE_WHOLE_FILE_PATH = 4096 };

typedef struct {
    FILE *out;
    const char *path;                 /* the caller's, until committed */
    char beside[ALE_WHOLE_FILE_PATH]; /* empty: a device or a pipe */
} ale_whole_file_t;

/* Opens PATH.new for writing; path must stay until commit. 0, or -1 with errno set (ENAMETOOLONG: no room for
 * the suffix; else as fopen): nothing is left behind. */
int ale_whole_file_begin(ale_whole_file_t *file, const char *path);

/* Closes, and puts the file in its place. 0, or -1 with errno set (as fwrite, fsync, fclose, rename; EIO when
 * a write failed before): the path is as it was. */
int ale_whole_file_commit(ale_whole_file_t *file);

#endif
