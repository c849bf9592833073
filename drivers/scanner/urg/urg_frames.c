#include "scanner/urg/urg_frames.h"

#include <stdio.h>
#include <string.h>

#include "base/fixed.h"

enum { SILENT_TURNS = 5, SILENT_MS = 400, BAD_FRAMES = 3, FROZEN_FRAMES = 3, GOOD_SERIES = 10, RESTARTS = 3 };

/* Least status of a stream frame that says why it has no ranges; smaller ones acknowledge or refuse MD. */
#define CHECKING "21"

void ale_urg_frames_open(ale_urg_frames_t *f)
{
    f->failures = 0;
}

void ale_urg_frames_close(ale_urg_frames_t *f)
{
    f->good_frames = 0;
}

void ale_urg_frames_begin(ale_urg_frames_t *f)
{
    f->bad_frames = 0;
    f->frozen = 0;
}

ale_urg_action_t ale_urg_frames_fail(ale_urg_frames_t *f, const char *reason)
{
    ale_urg_action_t action = {.deed = ALE_URG_RESTART, .reason = reason};
    ale_urg_frames_begin(f);
    f->good_frames = 0;
    f->failures++;
    if (f->failures > RESTARTS) {
        action.deed = f->failures > RESTARTS + 1 ? ALE_URG_REOPEN : ALE_URG_RESET;
    }
    return action;
}

ale_urg_action_t ale_urg_frames_status(ale_urg_frames_t *f, const char *status, int32_t first_scan_ms)
{
    if (strcmp(status, CHECKING) < 0) {
        return (ale_urg_action_t){0};
    }
    if (status[0] >= '5' && strcmp(status, "98") < 0) {
        f->hardware_faults++;
        f->failures = (uint32_t)ale_max64(f->failures, RESTARTS);
        snprintf(f->reason, sizeof f->reason, "hardware fault of the sensor: status %s", status);
        return ale_urg_frames_fail(f, f->reason);
    }
    snprintf(f->reason, sizeof f->reason, "the sensor checks itself: status %s", status);
    return (ale_urg_action_t){.reason = f->reason, .wait_ms = first_scan_ms};
}

int32_t ale_urg_frames_silence_ms(int64_t turn_us)
{
    return (int32_t)ale_max64(SILENT_TURNS * turn_us / 1000, SILENT_MS);
}

bool ale_urg_frames_proved(const ale_urg_frames_t *f)
{
    return f->good_frames >= GOOD_SERIES;
}

static void on_good_frame(ale_urg_frames_t *f)
{
    ale_urg_frames_begin(f);
    f->good_frames++;
    if (ale_urg_frames_proved(f)) {
        f->failures = 0;
    }
}

static ale_urg_action_t on_bad_frame(ale_urg_frames_t *f, ale_scip_loss_t loss, bool streams)
{
    f->bad_checksum += loss == ALE_SCIP_BAD_SUM;
    f->bad_frame += loss != ALE_SCIP_BAD_SUM;
    f->good_frames = 0;
    f->bad_frames++;
    const bool dead = f->bad_frames >= BAD_FRAMES && streams;
    return dead ? ale_urg_frames_fail(f, "three damaged scans in a row") : (ale_urg_action_t){0};
}

static ale_urg_action_t on_repeated_frame(ale_urg_frames_t *f, bool streams)
{
    f->repeated++;
    f->frozen++;
    const bool dead = f->frozen >= FROZEN_FRAMES && streams;
    return dead ? ale_urg_frames_fail(f, "the sensor's clock stands still") : (ale_urg_action_t){0};
}

ale_urg_action_t ale_urg_frames_take(ale_urg_frames_t *f, ale_frame_t frame, ale_scip_loss_t loss,
                                     bool streams)
{
    switch (frame) {
    case ALE_FRAME_LOST:
        return on_bad_frame(f, loss, streams);
    case ALE_FRAME_REPEATED:
        return on_repeated_frame(f, streams);
    case ALE_FRAME_FOREIGN:
        f->bad_frame++;
        break;
    case ALE_FRAME_SCAN:
        on_good_frame(f);
        break;
    }
    return (ale_urg_action_t){0};
}
