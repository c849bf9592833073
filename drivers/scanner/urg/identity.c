#include "scanner/urg/identity.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Fewer steps a turn would let the step of a cluster of 99 leave its number format. */
enum { LEAST_STEPS = 200 };

enum {
    KEY = 4,
    VALUE_LIMIT = 1000000,
    STEP_LIMIT = 10000,
    MICROSECONDS_PER_MINUTE = 60000000,
    MOST_RPM = 60000
};

static const ale_urg_geometry_t urg_04lx = {
    .range_min_mm = 20,
    .range_max_mm = 5600,
    .steps_per_turn = 1024,
    .first_step = 44,
    .last_step = 725,
    .front_step = 384,
    .rpm = 600,
};

void ale_urg_identity_init(ale_urg_identity_t *identity)
{
    memset(identity, 0, sizeof *identity);
    identity->geometry = urg_04lx;
}

static bool read_number(const char *text, int32_t *out)
{
    char *end = NULL;
    const long value = strtol(text, &end, 10);
    if (end == text || *end != '\0' || value < 0 || value >= VALUE_LIMIT) {
        return false;
    }
    *out = (int32_t)value;
    return true;
}

/* The first firmware states its geometry in brackets behind its version:
 * (20-4095[mm],240[deg],44-725[step],600[rpm]). */
static void read_firmware_geometry(ale_urg_geometry_t *geometry, const char *text)
{
    const char *bracket = strchr(text, '(');
    ale_urg_geometry_t stated = *geometry;
    int32_t degrees = 0;
    while (bracket != NULL) {
        const int fields =
            sscanf(bracket, "(%6d-%6d[mm],%6d[deg],%6d-%6d[step],%6d[rpm]", &stated.range_min_mm,
                   &stated.range_max_mm, &degrees, &stated.first_step, &stated.last_step, &stated.rpm);
        if (fields == 6 && ale_urg_geometry_valid(&stated)) {
            *geometry = stated;
            return;
        }
        stated = *geometry;
        bracket = strchr(bracket + 1, '(');
    }
}

static int32_t *number_of(ale_urg_geometry_t *geometry, const char *key)
{
    const struct {
        const char *key;
        int32_t *number;
    } numbers[] = {
        {"DMIN", &geometry->range_min_mm},
        {"DMAX", &geometry->range_max_mm},
        {"ARES", &geometry->steps_per_turn},
        {"AMIN", &geometry->first_step},
        {"AMAX", &geometry->last_step},
        {"AFRT", &geometry->front_step},
        {"SCAN", &geometry->rpm},
    };
    for (unsigned k = 0; k < sizeof numbers / sizeof numbers[0]; k++) {
        if (strncmp(key, numbers[k].key, KEY) == 0) {
            return numbers[k].number;
        }
    }
    return NULL;
}

/* A number of the geometry. DMIN begins the parameters: what was said before of a recording no longer holds.
 */
static void take_number(ale_urg_identity_t *identity, int32_t *number, const char *value)
{
    if (number == &identity->geometry.range_min_mm) {
        identity->played = (ale_urg_played_t){0};
    }
    identity->warnings += !read_number(value, number);
}

/* What is shown even under a wrong sum. */
static void take_text(ale_urg_identity_t *identity, const char *text, const char *value)
{
    if (strncmp(text, "MODL", KEY) == 0 ||
        (strncmp(text, "PROD", KEY) == 0 && identity->device.model[0] == '\0')) {
        snprintf(identity->device.model, sizeof identity->device.model, "%s", value);
    } else if (strncmp(text, "FIRM", KEY) == 0) {
        snprintf(identity->device.firmware, sizeof identity->device.firmware, "%s", value);
        read_firmware_geometry(&identity->geometry, value);
    } else if (strncmp(text, "SERI", KEY) == 0) {
        snprintf(identity->device.serial, sizeof identity->device.serial, "%s", value);
    } else if (strncmp(text, "STAT", KEY) == 0) {
        snprintf(identity->status, sizeof identity->status, "%s", value);
    }
}

void ale_urg_identity_line(ale_urg_identity_t *identity, const char *text, bool sum_right)
{
    identity->warnings += !sum_right;
    if (strlen(text) <= KEY || text[KEY] != ':') {
        return;
    }
    const char *value = text + KEY + 1;
    int32_t *number = number_of(&identity->geometry, text);
    if (number == NULL && strncmp(text, "PLAY", KEY) != 0) {
        take_text(identity, text, value);
    } else if (sum_right && number != NULL) {
        take_number(identity, number, value);
    } else if (sum_right) {
        identity->warnings += !ale_urg_played_parse(value, &identity->played);
    }
}

bool ale_urg_geometry_valid(const ale_urg_geometry_t *g)
{
    return g->range_min_mm >= 0 && g->range_min_mm < g->range_max_mm && g->steps_per_turn >= LEAST_STEPS &&
           g->steps_per_turn < STEP_LIMIT && g->first_step >= 0 && g->first_step <= g->last_step &&
           g->last_step < STEP_LIMIT && g->front_step >= 0 && g->front_step < STEP_LIMIT && g->rpm > 0 &&
           g->rpm <= MOST_RPM;
}

int32_t ale_urg_period_us(const ale_urg_geometry_t *geometry)
{
    return MICROSECONDS_PER_MINUTE / geometry->rpm;
}
