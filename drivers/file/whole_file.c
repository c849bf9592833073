#include "file/whole_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static bool is_device_or_pipe(const char *path)
{
    struct stat there;
    return stat(path, &there) == 0 && !S_ISREG(there.st_mode);
}

static bool is_beside(const ale_whole_file_t *file)
{
    return file->beside[0] != '\0';
}

int ale_whole_file_begin(ale_whole_file_t *file, const char *path)
{
    file->path = path;
    if (is_device_or_pipe(path)) {
        file->beside[0] = '\0';
        file->out = fopen(path, "wbe");
        return file->out ? 0 : -1;
    }
    const int length = snprintf(file->beside, sizeof file->beside, "%s.new", path);
    if (length >= (int)sizeof file->beside) {
        errno = ENAMETOOLONG;
        return -1;
    }
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
    const bool written =
        fflush(file->out) == 0 && !ferror(file->out) && (!is_beside(file) || fsync(fileno(file->out)) == 0);
    int reason = errno;
    bool whole = fclose(file->out) == 0 && written;
    reason = written ? errno : reason;
    if (is_beside(file) && whole && rename(file->beside, file->path) < 0) {
        whole = false;
        reason = errno;
    }
    if (is_beside(file) && !whole) {
        unlink(file->beside);
    }
    if (is_beside(file) && whole) {
        sync_folder(file->path);
    }
    errno = reason;
    return whole ? 0 : -1;
}
