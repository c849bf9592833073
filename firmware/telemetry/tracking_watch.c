#include "telemetry/tracking_watch.h"

#include <stdio.h>

#include "lcm/wheel_words.h"

enum {
    FOUND_US = 1000000,    /* so long a robot must know where it is to be told found */
    UNCERTAIN_US = 3000000 /* a shorter while is usual: a door, a turn */
};

static ale_tracking_situation_t situation_of(const ale_estimate_t *estimate)
{
    if (estimate->state == ALE_STATE_LOST || estimate->map_id != 0) {
        return ALE_TRACKING_ASTRAY;
    }
    return estimate->state == ALE_STATE_GOOD ? ALE_TRACKING_KNOWN : ALE_TRACKING_UNCERTAIN;
}

/* How long the situation must have lasted to be told. */
static int64_t patience_us(const ale_tracking_watch_t *watch)
{
    if (watch->at == ALE_TRACKING_ASTRAY) {
        return 0;
    }
    return watch->at == ALE_TRACKING_UNCERTAIN && watch->told == ALE_TRACKING_KNOWN ? UNCERTAIN_US : FOUND_US;
}

static void say_astray(const ale_estimate_t *estimate, uint32_t lines, char line[ALE_TRACKING_LINE])
{
    const char *cause = "nothing of what is seen is where the map has it";
    if (lines == 0) {
        cause = estimate->predicted ? "no scan comes" : "the scanner sees no walls";
    }
    snprintf(line, ALE_TRACKING_LINE,
             "lost at %.2f m, %.2f m: %s%s%s; the map stays, a new one is drawn until a place of it is known "
             "again: "
             "drive slowly to one, or say where the robot is",
             estimate->map.x_um * 1e-6, estimate->map.y_um * 1e-6, cause,
             estimate->wheel_fault == ALE_WHEELS_FINE ? "" : ", wheels: ",
             estimate->wheel_fault == ALE_WHEELS_FINE ? "" : ale_wheel_fault_word(estimate->wheel_fault));
}

static void say(const ale_tracking_watch_t *watch, const ale_estimate_t *estimate, uint32_t lines,
                char line[ALE_TRACKING_LINE])
{
    const double seconds = (double)(watch->at_us - watch->told_us) * 1e-6;
    switch (watch->at) {
    case ALE_TRACKING_ASTRAY:
        say_astray(estimate, lines, line);
        break;
    case ALE_TRACKING_UNCERTAIN:
        snprintf(line, ALE_TRACKING_LINE,
                 "%suncertain at %.2f m, %.2f m: what is seen leaves a direction open; drive to where walls "
                 "of two "
                 "directions are in sight",
                 watch->told == ALE_TRACKING_ASTRAY ? "found in the map, " : "", estimate->map.x_um * 1e-6,
                 estimate->map.y_um * 1e-6);
        break;
    case ALE_TRACKING_KNOWN:
        snprintf(line, ALE_TRACKING_LINE, "%s at %.2f m, %.2f m, after %.1f s",
                 watch->told == ALE_TRACKING_ASTRAY ? "found in the map" : "certain again",
                 estimate->map.x_um * 1e-6, estimate->map.y_um * 1e-6, seconds);
        break;
    }
}

bool ale_tracking_watch_take(ale_tracking_watch_t *watch, const ale_estimate_t *estimate, uint32_t lines,
                             char line[ALE_TRACKING_LINE])
{
    const ale_tracking_situation_t now = situation_of(estimate);
    if (now != watch->at) {
        watch->at = now;
        watch->at_us = estimate->stamp_us;
    }
    if (now == watch->told || estimate->stamp_us - watch->at_us < patience_us(watch)) {
        return false;
    }
    say(watch, estimate, lines, line);
    watch->told = now;
    watch->told_us = watch->at_us;
    return true;
}
