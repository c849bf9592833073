#include "file/whole_file.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* What the stream writes with: it keeps the first reason, which stdio forgets. */
static ssize_t write_bytes(void *cookie, const char *bytes, size_t count)
{
    ale_whole_file_t *file = cookie;
    size_t done = 0;
    while (file->reason == 0 && done < count) {
        const ssize_t written = write(file->descriptor, bytes + done, count - done);
        if (written >= 0) {
            done += (size_t)written;
        } else if (errno != EINTR) {
            file->reason = errno;
        }
    }
    return (ssize_t)done;
}

/* 0 when nothing or a regular file is there, else an errno. */
static int check_place(const char *path)
{
    struct stat there;
    if (lstat(path, &there) < 0) {
        return errno == ENOENT ? 0 : errno;
    }
    if (S_ISLNK(there.st_mode)) {
        return ELOOP;
    }
    if (S_ISDIR(there.st_mode)) {
        return EISDIR;
    }
    return S_ISREG(there.st_mode) ? 0 : EINVAL;
}

/* A file of our own in any case: what a power cut has left, or a link that somebody has put there, goes. */
static int open_beside(const char *beside, unsigned rights)
{
    unlink(beside);
    return open(beside, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, rights);
}

int ale_whole_file_begin(ale_whole_file_t *file, const char *path, unsigned rights)
{
    file->path = path;
    file->reason = check_place(path);
    const int length = snprintf(file->beside, sizeof file->beside, "%s.new", path);
    if (file->reason == 0 && length >= (int)sizeof file->beside) {
        file->reason = ENAMETOOLONG;
    }
    if (file->reason != 0) {
        errno = file->reason;
        return -1;
    }
    file->descriptor = open_beside(file->beside, rights);
    if (file->descriptor < 0) {
        return -1;
    }
    file->out = fopencookie(file, "wb", (cookie_io_functions_t){.write = write_bytes});
    if (!file->out) {
        close(file->descriptor);
        unlink(file->beside);
        errno = ENOMEM;
        return -1;
    }
    return 0;
}

const char *ale_whole_file_words(int error)
{
    switch (error) {
    case ELOOP:
        return "a symbolic link, which is not followed";
    case EINVAL:
        return "no regular file";
    default:
        return strerror(error);
    }
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

/* Closes the file once its bytes are on the disk. */
static void write_out(ale_whole_file_t *file)
{
    if (fclose(file->out) != 0 && file->reason == 0) {
        file->reason = EIO;
    }
    if (fsync(file->descriptor) < 0 && file->reason == 0) {
        file->reason = errno;
    }
    if (close(file->descriptor) < 0 && file->reason == 0) {
        file->reason = errno;
    }
}

/* Gives the file its name; flags: of renameat2. */
static int commit(ale_whole_file_t *file, unsigned flags)
{
    write_out(file);
    if (file->reason == 0 && renameat2(AT_FDCWD, file->beside, AT_FDCWD, file->path, flags) < 0) {
        file->reason = errno;
    }
    if (file->reason == 0) {
        sync_folder(file->path);
        return 0;
    }
    unlink(file->beside);
    errno = file->reason;
    return -1;
}

int ale_whole_file_commit(ale_whole_file_t *file)
{
    return commit(file, 0);
}

int ale_whole_file_commit_new(ale_whole_file_t *file)
{
    return commit(file, RENAME_NOREPLACE);
}
