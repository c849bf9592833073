/* Files that are there whole or not at all: written beside, flushed to the disk, renamed.
 *
 *   ale_whole_file_t file;
 *   if (ale_whole_file_begin(&file, path, 0640) == 0) { write to file.out ...; ale_whole_file_commit(&file);
 * }
 *
 * Whatever happens in between, power cuts included, the path holds what it held or the new content. Regular
 * files only: what else bears the name, a link, a pipe or a device, is refused and stays as it is. May block
 * for as long as the disk takes. One thread a path. */
#ifndef ALE_FILE_WHOLE_FILE_H
#define ALE_FILE_WHOLE_FILE_H

#include <stdio.h>

enum { ALE_WHOLE_FILE_PATH = 4096 };

typedef struct {
    FILE *out;
    const char *path; /* the caller's, until committed */
    char beside[ALE_WHOLE_FILE_PATH];
    int descriptor;
    int reason; /* errno of the first thing that failed; 0: nothing has */
} ale_whole_file_t;

/* Opens PATH.new for writing, a file of its own with these rights less the umask. path and *file must stay
 * where they are until commit. 0, or -1 with errno set (ELOOP: a symbolic link is there; EINVAL: a pipe, a
 * device or a socket; ENAMETOOLONG: no room for the suffix; else as lstat and open): nothing is left
 * behind. */
int ale_whole_file_begin(ale_whole_file_t *file, const char *path, unsigned rights);

/* Closes, and puts the file in its place. 0, or -1 with errno set, of the first that failed of write, fsync,
 * close and rename: the path is as it was. */
int ale_whole_file_commit(ale_whole_file_t *file);

/* The same for a file that must not be there yet: EEXIST when it is, and then it stays as it is. */
int ale_whole_file_commit_new(ale_whole_file_t *file);

/* What an errno of these means, in words. */
const char *ale_whole_file_words(int error);

#endif
