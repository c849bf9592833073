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

/* Closes the file once its bytes are on the disk. 0, or the errno of the first thing that failed. */
static int write_out(ale_whole_file_t *file)
{
    errno = EIO;
    const bool written =
        fflush(file->out) == 0 && !ferror(file->out) && (!is_beside(file) || fsync(fileno(file->out)) == 0);
    const int reason = written ? 0 : errno;
    return fclose(file->out) == 0 || !written ? reason : errno;
}

/* Puts the written file in the place of the old one, or removes it. 0, or an errno. */
static int take_its_place(const ale_whole_file_t *file, int reason)
{
    if (reason == 0 && rename(file->beside, file->path) < 0) {
        reason = errno;
    }
    if (reason == 0) {
        sync_folder(file->path);
    } else {
        unlink(file->beside);
    }
    return reason;
}

int ale_whole_file_commit(ale_whole_file_t *file)
{
    int reason = write_out(file);
    if (is_beside(file)) {
        reason = take_its_place(file, reason);
    }
    errno = reason;
    return reason == 0 ? 0 : -1;
}
