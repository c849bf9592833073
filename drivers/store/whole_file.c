#include "store/whole_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <string.h>
#include <unistd.h>

int ale_whole_file_begin(ale_whole_file_t *file, const char *path)
{
    const int length = snprintf(file->beside, sizeof file->beside, "%s.new", path);
    if (length >= (int)sizeof file->beside) {
        errno = ENAMETOOLONG;
        return -1;
    }
    file->path = path;
    file->out = fopen(file->beside, "wbe");
    return file->out ? 0 : -1;
}

/* The renaming itself is on the disk only when the folder is. */
static void sync_folder(const char *path)
{
    char folder[ALE_WHOLE_FILE_PATH];
    const char *slash = strrchr(path, '/');
    const int length = slash ? (int)(slash - path) + 1 : 1;
    snprintf(folder, sizeof folder, "%.*s", length, slash ? path : ".");
    const int descriptor = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor >= 0) {
        fsync(descriptor);
        close(descriptor);
    }
}

int ale_whole_file_commit(ale_whole_file_t *file)
{
    errno = EIO;
    const bool written = !ferror(file->out) && fflush(file->out) == 0 && fsync(fileno(file->out)) == 0;
    int reason = errno;
    bool whole = fclose(file->out) == 0 && written;
    reason = written ? errno : reason;
    if (whole && rename(file->beside, file->path) < 0) {
        whole = false;
        reason = errno;
    }
    if (!whole) {
        unlink(file->beside);
        errno = reason;
        return -1;
    }
    sync_folder(file->path);
    return 0;
}
