#include "serial/port_candidates.h"

#include <glob.h>
#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool same_device(const char *a, const char *b)
{
    char real_a[PATH_MAX];
    char real_b[PATH_MAX];
    return realpath(a, real_a) != NULL && realpath(b, real_b) != NULL && strcmp(real_a, real_b) == 0;
}

static bool listed(char out[][ALE_PORT_PATH], uint32_t count, const char *path)
{
    for (uint32_t k = 0; k < count; k++) {
        if (same_device(out[k], path)) {
            return true;
        }
    }
    return false;
}

static uint32_t add_matches(char out[][ALE_PORT_PATH], uint32_t count, const char *pattern)
{
    glob_t found;
    if (glob(pattern, 0, NULL, &found) == 0) {
        for (size_t k = 0; k < found.gl_pathc && count < ALE_PORT_CANDIDATES; k++) {
            const char *path = found.gl_pathv[k];
            if (strlen(path) < ALE_PORT_PATH && !listed(out, count, path)) {
                memcpy(out[count++], path, strlen(path) + 1);
            }
        }
    }
    globfree(&found);
    return count;
}

uint32_t ale_port_candidates(const char *directory, char out[ALE_PORT_CANDIDATES][ALE_PORT_PATH])
{
    static const char *const patterns[] = {"serial/by-id/*", "ttyACM*", "ttyUSB*"};
    uint32_t count = 0;
    for (unsigned k = 0; k < sizeof patterns / sizeof patterns[0]; k++) {
        char pattern[PATH_MAX];
        snprintf(pattern, sizeof pattern, "%s/%s", directory, patterns[k]);
        count = add_matches(out, count, pattern);
    }
    return count;
}
