/* What stands behind the parser: identity, played recordings, rates, frames' health, strangers on the line.
 *
 * proves: drivers/scanner/urg/identity.c drivers/scanner/urg/played.c drivers/scanner/urg/baud.c
 *  drivers/scanner/urg/urg_frames.c drivers/scanner/urg/scan_fill.c drivers/scanner/urg/stranger.c
 * with: drivers/scanner/urg/scip_request.c lib/base/scan.c lib/base/fixed.c
 * options: -eva-split-return full -eva-slevel 20 -eva-auto-loop-unroll 20 */
#include "unknown.h"
#include "unknown_scan.h"
#include "unknown_urg.h"

#include "scanner/urg/baud.h"
#include "scanner/urg/identity.h"
#include "scanner/urg/played.h"
#include "scanner/urg/scan_fill.h"
#include "scanner/urg/stranger.h"
#include "scanner/urg/urg_frames.h"

static ale_urg_identity_t told(void)
{
    ale_urg_identity_t identity;
    ale_urg_identity_init(&identity);
    while (unknown(0, 1)) {
        char text[ALE_SCIP_LINE + 1];
        Frama_C_make_unknown(text, sizeof text);
        text[sizeof text - 1] = '\0';
        ale_urg_identity_line(&identity, text, unknown(0, 1));
    }
    return identity;
}

static void scans(void)
{
    static ale_scan_t scan;
    static int32_t values[ALE_MAX_BEAMS];
    //@ loop unroll 1;
    for (uint32_t k = 0; k < ALE_MAX_BEAMS; k++) {
        values[k] = (int32_t)unknown(0, 262143);
    }
    ale_scip_event_t event = {.values = values, .value_count = (uint32_t)unknown(0, ALE_MAX_BEAMS)};
    event.request = unknown_request();
    const ale_urg_geometry_t geometry = unknown_geometry();
    const int64_t stamp_us = unknown(-ALE_MAX_STAMP_US, ALE_MAX_STAMP_US);
    const int32_t period_us = ale_urg_period_us(&geometry);
    ale_urg_fill_scan(&geometry, &event, stamp_us, period_us, unknown(0, 1), &scan);
    char text[ALE_SCIP_LINE + 1];
    ale_urg_played_t played;
    Frama_C_make_unknown(text, sizeof text);
    text[sizeof text - 1] = '\0';
    if (ale_urg_played_parse(text, &played)) {
        ale_urg_played_us(&played, (uint32_t)unknown(0, (1 << 24) - 1), stamp_us / 2);
        ale_urg_played_place(&played, &event.request, stamp_us, unknown(0, 1), &scan);
        ale_urg_played_format(&played, text);
    }
}

static void rates(void)
{
    ale_scip_request_t request = unknown_request();
    const int32_t baud = (int32_t)unknown(0, INT32_MAX);
    ale_baud_candidate(baud, (uint32_t)unknown(0, UINT32_MAX));
    ale_baud_is_known(baud);
    ale_baud_fit(&request, baud, (int32_t)unknown(0, 60000000));
}

static void health(void)
{
    ale_urg_frames_t frames = {0};
    ale_urg_frames_open(&frames);
    while (unknown(0, 1)) {
        char status[3];
        Frama_C_make_unknown(status, sizeof status);
        status[2] = '\0';
        if (unknown(0, 1)) {
            ale_urg_frames_begin(&frames);
        }
        ale_urg_frames_take(&frames, (ale_frame_t)unknown(0, 3), (ale_scip_loss_t)unknown(0, 4),
                            unknown(0, 1));
        ale_urg_frames_status(&frames, status, (int32_t)unknown(0, INT32_MAX));
        ale_urg_frames_silence_ms(unknown(0, INT32_MAX));
        ale_urg_frames_close(&frames);
    }
}

static void strangers(void)
{
    ale_stranger_t stranger = {0};
    char words[ALE_STRANGER_WORDS];
    uint8_t bytes[300];
    while (unknown(0, 1)) {
        Frama_C_make_unknown((char *)bytes, sizeof bytes);
        //@ loop unroll 129;
        for (uint32_t count = 0; count <= ALE_STRANGER_BYTES; count++) {
            if (unknown(0, 1)) {
                ale_stranger_hear(&stranger, bytes, count);
            }
        }
        ale_stranger_hear(&stranger, bytes, (uint32_t)unknown(ALE_STRANGER_BYTES + 1, sizeof bytes));
        ale_stranger_judge(&stranger);
        ale_stranger_words(&stranger, words);
    }
}

void main(void)
{
    const ale_urg_identity_t identity = told();
    ale_urg_geometry_valid(&identity.geometry);
    scans();
    rates();
    health();
    strangers();
}
