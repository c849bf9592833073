#include "recorder/flight_file.h"

#include <dirent.h>
#include <errno.h>
#include <fnmatch.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "base/fixed.h"
#include "file/whole_file.h"

enum { RIGHTS = 0640, NUMBER_DIGITS = 8, NUMBER_MOST = 99999999 };

static const char NAME_HEAD[] = "flight-";

/* The recordings of a folder, in the order in which they were written. */
typedef struct {
    struct dirent **entry;
    int count;
} flights_t;

static int is_flight(const struct dirent *entry)
{
    return fnmatch("flight-*Z-*.scip", entry->d_name, 0) == 0;
}

/* 0 where none stands in the name. */
static int64_t number_of(const char *name)
{
    const char *digits = name + strlen(NAME_HEAD);
    char *end = NULL;
    const long number = strtol(digits, &end, 10);
    return end == digits + NUMBER_DIGITS && *end == '-' ? number : 0;
}

/* By their numbers: clocks are set back. */
static int by_number(const struct dirent **one, const struct dirent **other)
{
    const int64_t difference = number_of((*one)->d_name) - number_of((*other)->d_name);
    return difference == 0 ? strcmp((*one)->d_name, (*other)->d_name) : (difference > 0) - (difference < 0);
}

static flights_t list_flights(const char *folder)
{
    flights_t flights = {0};
    flights.count = scandir(folder, &flights.entry, is_flight, by_number);
    flights.count = flights.count < 0 ? 0 : flights.count;
    return flights;
}

static void free_flights(flights_t *flights)
{
    for (int k = 0; k < flights->count; k++) {
        free(flights->entry[k]);
    }
    free(flights->entry);
}

static void name_file(char path[ALE_WHOLE_FILE_PATH], const char *folder, const char *reason,
                      const flights_t *before)
{
    struct timespec now;
    struct tm parts;
    char moment[32];
    const int64_t newest = before->count > 0 ? number_of(before->entry[before->count - 1]->d_name) : 0;
    clock_gettime(CLOCK_REALTIME, &now);
    gmtime_r(&now.tv_sec, &parts);
    strftime(moment, sizeof moment, "%Y%m%dT%H%M%S", &parts);
    snprintf(path, ALE_WHOLE_FILE_PATH, "%s/%s%0*d-%s.%03ldZ-%s.scip", folder, NAME_HEAD, NUMBER_DIGITS,
             (int)ale_min64(newest + 1, NUMBER_MOST), moment, now.tv_nsec / 1000000, reason);
}

/* Of one reason only: what is asked for takes no fault's place. */
static void remove_oldest(const char *folder, const char *reason, int kept, const flights_t *before)
{
    char pattern[64];
    snprintf(pattern, sizeof pattern, "*Z-%s.scip", reason);
    for (int k = before->count - 1; k >= 0; k--) {
        const char *name = before->entry[k]->d_name;
        char path[ALE_WHOLE_FILE_PATH];
        if (fnmatch(pattern, name, 0) == 0 && --kept <= 0 &&
            snprintf(path, sizeof path, "%s/%s", folder, name) < (int)sizeof path) {
            unlink(path);
        }
    }
}

static int write_file(const char *path, const char *config, const ale_flight_ring_t *ring)
{
    ale_whole_file_t file;
    if (ale_whole_file_begin(&file, path, RIGHTS) < 0) {
        return -1;
    }
    ale_recording_t recording;
    ale_recording_begin(&recording, file.out);
    ale_recording_write(&recording, ALE_CHUNK_CONFIG, 0, config, (uint32_t)strlen(config));
    ale_flight_ring_write(ring, &recording);
    return ale_whole_file_commit(&file);
}

int ale_flight_file_write(const char *folder, const ale_flight_kind_t *kind, const char *config,
                          const ale_flight_ring_t *ring, char message[ALE_FLIGHT_MESSAGE])
{
    char path[ALE_WHOLE_FILE_PATH];
    flights_t before = list_flights(folder);
    name_file(path, folder, kind->reason, &before);
    const int error = write_file(path, config, ring) < 0 ? errno : 0;
    if (error != 0) {
        snprintf(message, ALE_FLIGHT_MESSAGE, "flight recording not written: %.200s: %s", path,
                 strerror(error));
    } else {
        snprintf(message, ALE_FLIGHT_MESSAGE, "flight recording written: %.400s", path);
        remove_oldest(folder, kind->reason, kind->kept, &before);
    }
    free_flights(&before);
    return error;
}
