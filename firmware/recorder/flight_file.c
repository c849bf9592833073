#include "recorder/flight_file.h"

#include <dirent.h>
#include <errno.h>
#include <fnmatch.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "file/whole_file.h"

static void name_file(char path[ALE_WHOLE_FILE_PATH], const char *folder, const char *reason)
{
    struct timespec now;
    struct tm parts;
    char moment[32];
    clock_gettime(CLOCK_REALTIME, &now);
    gmtime_r(&now.tv_sec, &parts);
    strftime(moment, sizeof moment, "%Y%m%dT%H%M%S", &parts);
    snprintf(path, ALE_WHOLE_FILE_PATH, "%s/flight-%s.%03ldZ-%s.scip", folder, moment, now.tv_nsec / 1000000,
             reason);
}

static int is_flight(const struct dirent *entry)
{
    return fnmatch("flight-*Z-*.scip", entry->d_name, 0) == 0;
}

/* Names begin with the time: the order of the alphabet is that of age. */
static void remove_oldest(const char *folder)
{
    struct dirent **found = NULL;
    const int count = scandir(folder, &found, is_flight, alphasort);
    for (int k = 0; k < count; k++) {
        char path[ALE_WHOLE_FILE_PATH];
        const int length = snprintf(path, sizeof path, "%s/%s", folder, found[k]->d_name);
        if (k < count - ALE_FLIGHT_FILES && length < (int)sizeof path) {
            unlink(path);
        }
        free(found[k]);
    }
    free(found);
}

static int write_file(const char *path, const char *config, const ale_flight_ring_t *ring)
{
    ale_whole_file_t file;
    if (ale_whole_file_begin(&file, path) < 0) {
        return -1;
    }
    ale_recording_t recording;
    ale_recording_begin(&recording, file.out);
    ale_recording_write(&recording, ALE_CHUNK_CONFIG, 0, config, (uint32_t)strlen(config));
    ale_flight_ring_write(ring, &recording);
    return ale_whole_file_commit(&file);
}

int ale_flight_file_write(const char *folder, const char *reason, const char *config,
                          const ale_flight_ring_t *ring, char message[ALE_FLIGHT_MESSAGE])
{
    char path[ALE_WHOLE_FILE_PATH];
    name_file(path, folder, reason);
    if (write_file(path, config, ring) < 0) {
        snprintf(message, ALE_FLIGHT_MESSAGE, "flight recording not written: %.200s: %s", path,
                 strerror(errno));
        return -1;
    }
    snprintf(message, ALE_FLIGHT_MESSAGE, "flight recording written: %.400s", path);
    remove_oldest(folder);
    return 0;
}
