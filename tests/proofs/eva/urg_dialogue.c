/* One answer, none in time, or another rate, to the conversation with a URG, from any state that
 * `unknown_dialogue` allows; the state must be such a one again. The answer is any that the parser makes, the
 * configuration any. What urg_pure.c proves of strangers and of recordings is not proved again: they may
 * answer anything.
 *
 * proves: drivers/scanner/urg/urg_dialogue.c
 * with: drivers/scanner/urg/identity.c drivers/scanner/urg/baud.c drivers/scanner/urg/scip_request.c
 * options: -eva-precision 0 -eva-auto-loop-unroll 8 -eva-split-return full
 *  -eva-slevel-function ale_urg_geometry_valid:60,adopt_identity:60,on_parameters:60 */
#include "unknown.h"
#include "unknown_urg.h"

#include "scanner/urg/urg_dialogue.h"

bool ale_urg_played_parse(const char *text, ale_urg_played_t *out)
{
    (void)text;
    *out = unknown(0, 1) ? unknown_played() : *out;
    return unknown(0, 1);
}

void ale_stranger_hear(ale_stranger_t *stranger, const uint8_t *bytes, uint32_t count)
{
    (void)bytes;
    (void)count;
    stranger->count = (uint32_t)unknown(0, ALE_STRANGER_BYTES);
}

void ale_stranger_judge(ale_stranger_t *stranger)
{
    stranger->told_count = (uint32_t)unknown(0, ALE_STRANGER_BYTES);
    stranger->count = 0;
}

void ale_stranger_words(const ale_stranger_t *stranger, char words[ALE_STRANGER_WORDS])
{
    (void)stranger;
    Frama_C_make_unknown(words, ALE_STRANGER_WORDS);
    words[ALE_STRANGER_WORDS - 1] = '\0';
}

static char serial[40];
static ale_scanner_config_t config;
static ale_urg_dialogue_t dialogue;

static void unknown_text(char *text, size_t bytes)
{
    Frama_C_make_unknown(text, bytes);
    text[bytes - 1] = '\0';
}

static int32_t any(void)
{
    return (int32_t)unknown(INT32_MIN, INT32_MAX);
}

/* Numbers as they are read make sense or not. */
static void unknown_identity(ale_urg_identity_t *identity)
{
    Frama_C_make_unknown((char *)identity, sizeof *identity);
    unknown_text(identity->device.model, sizeof identity->device.model);
    unknown_text(identity->device.firmware, sizeof identity->device.firmware);
    unknown_text(identity->device.serial, sizeof identity->device.serial);
    unknown_text(identity->status, sizeof identity->status);
    identity->geometry = (ale_urg_geometry_t){.range_min_mm = any(),
                                              .range_max_mm = any(),
                                              .steps_per_turn = any(),
                                              .first_step = any(),
                                              .last_step = any(),
                                              .front_step = any(),
                                              .rpm = any()};
    identity->played = unknown_played();
}

static void unknown_dialogue(void)
{
    Frama_C_make_unknown((char *)&dialogue, sizeof dialogue);
    dialogue.config = &config;
    dialogue.has_baud = unknown(0, 1);
    dialogue.baud = (int32_t)unknown(0, INT32_MAX);
    dialogue.phase = (ale_urg_phase_t)unknown(ALE_PHASE_CLOSED, ALE_PHASE_POLL);
    unknown_text(dialogue.command, sizeof dialogue.command);
    dialogue.poll_due = unknown(0, 1);
    dialogue.request = unknown_request();
    dialogue.led_out = unknown(0, 1);
    dialogue.port_proved = unknown(0, 1);
    dialogue.identified = unknown(0, 1);
    dialogue.stranger.kind = (ale_stranger_kind_t)unknown(ALE_STRANGER_SILENT, ALE_STRANGER_RPLIDAR);
    dialogue.stranger.told_count = (uint32_t)unknown(0, ALE_STRANGER_BYTES);
    dialogue.stranger.count = (uint32_t)unknown(0, ALE_STRANGER_BYTES);
    dialogue.good_baud = (int32_t)unknown(0, INT32_MAX);
    dialogue.geometry = unknown_geometry();
    dialogue.geometry.first_step =
        (int32_t)unknown(0, INT32_MAX); /* Eva loses that it is not above the last */
    unknown_identity(&dialogue.identity);
    dialogue.protocol = (int32_t)unknown(0, 2);
}

static void hold(const ale_urg_action_t *action)
{
    //@ assert ALE_PHASE_CLOSED <= dialogue.phase <= ALE_PHASE_POLL && 0 <= dialogue.protocol <= 2;
    //@ assert 0 <= dialogue.baud && 0 <= dialogue.good_baud;
    //@ assert dialogue.stranger.told_count <= ALE_STRANGER_BYTES;
    //@ assert dialogue.stranger.count <= ALE_STRANGER_BYTES;
    //@ assert 200 <= dialogue.geometry.steps_per_turn <= 9999;
    //@ assert 1 <= dialogue.geometry.rpm <= 60000 && 0 <= dialogue.geometry.front_step <= 9999;
    //@ assert 0 <= dialogue.geometry.first_step;
    //@ assert 0 <= dialogue.geometry.last_step <= 9999;
    //@ assert dialogue.request.skip <= 9;
    //@ assert 0 <= action->wait_ms && 0 <= action->baud;
    //@ assert ALE_URG_REST <= action->deed <= ALE_URG_REOPEN;
    (void)action;
}

static void hear(void)
{
    ale_scip_event_t event;
    static char text[ALE_SCIP_LINE + 1];
    unknown_dialogue();
    Frama_C_make_unknown((char *)&event, sizeof event);
    event.kind = (ale_scip_kind_t)unknown(ALE_SCIP_LINE_READ, ALE_SCIP_REPLY);
    event.protocol = (uint8_t)unknown(1, 2);
    event.has_request = unknown(0, 1);
    event.sum_right = unknown(0, 1);
    event.echo[sizeof event.echo - 1] = '\0';
    event.status[sizeof event.status - 1] = '\0';
    unknown_text(text, sizeof text);
    event.text = text;
    const ale_urg_action_t action = ale_urg_dialogue_hear(&dialogue, &event);
    hold(&action);
}

static void overhear(void)
{
    static uint8_t bytes[300];
    unknown_dialogue();
    Frama_C_make_unknown((char *)bytes, sizeof bytes);
    ale_urg_dialogue_overhear(&dialogue, bytes, (uint32_t)unknown(0, sizeof bytes));
}

static void go_on(void)
{
    unknown_dialogue();
    ale_urg_action_t action = ale_urg_dialogue_time_out(&dialogue);
    hold(&action);
    unknown_dialogue();
    action = ale_urg_dialogue_restart(&dialogue, unknown(0, 1));
    hold(&action);
    unknown_dialogue();
    action = ale_urg_dialogue_baud_set(&dialogue, (int32_t)unknown(0, INT32_MAX), unknown(0, 1));
    hold(&action);
    unknown_dialogue();
    action = ale_urg_dialogue_open(&dialogue, (int32_t)unknown(0, INT32_MAX), unknown(0, 1));
    hold(&action);
}

static void tell(void)
{
    unknown_dialogue();
    ale_urg_dialogue_state(&dialogue);
    ale_urg_dialogue_first_baud(&dialogue);
    ale_urg_dialogue_scan(&dialogue);
    ale_urg_dialogue_proved(&dialogue);
    ale_urg_dialogue_polled(&dialogue);
    ale_urg_dialogue_streams(&dialogue);
    ale_urg_dialogue_close(&dialogue);
}

void main(void)
{
    unknown_text(serial, sizeof serial);
    config.serial = unknown(0, 1) ? serial : NULL;
    config.baud = (int32_t)unknown(0, INT32_MAX);
    config.first_step = (uint16_t)unknown(0, UINT16_MAX);
    config.last_step = (uint16_t)unknown(0, UINT16_MAX);
    config.cluster = (uint8_t)unknown(0, UINT8_MAX);
    ale_urg_dialogue_init(&dialogue, &config);
    hear();
    overhear();
    go_on();
    tell();
}
