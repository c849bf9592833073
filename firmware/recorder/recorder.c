#include "recorder/recorder.h"

#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "config/config_model.h"
#include "exchange/snapshot.h"
#include "exchange/wake.h"
#include "file/little_endian.h"
#include "recorder/flight_file.h"
#include "recorder/flight_order.h"
#include "recorder/flight_pause.h"
#include "recorder/flight_ring.h"
#include "recorder/flight_words.h"
#include "system/background.h"
#include "system/log_line.h"

#define NS_PER_MS 1000000LL
#define LOOK_NS 50000000
#define AFTERMATH_NS (3000 * NS_PER_MS) /* recorded on after a fault */

enum { MEGABYTE = 1 << 20 };

/* Of a recording that was asked for: whose turn it is; that side alone touches wake and outcome. */
typedef enum { IDLE, ASKED, DONE } turn_t;

struct ale_recorder {
    const ale_config_t *config;
    char *config_text;
    ale_snapshot_t *preset; /* of the noise, by its name, as acquire tells it */
    ale_flight_ring_t *flight;
    ale_flight_order_t *order; /* of what comes to the flight ring */
    ale_background_t thread;
    atomic_uint wanted; /* a bit a reason */
    atomic_uint written;
    int64_t write_ns;           /* when the recording that is due is to be written; 0: none is */
    ale_flight_pause_t pause;   /* of recordings that nobody asks for */
    ale_record_reason_t reason; /* of the one that is due */
    bool asked;                 /* the one that is due, or another that goes with it, is to be answered */
    atomic_int turn;
    int wake;
    ale_record_outcome_t outcome;
};

static const ale_flight_kind_t kinds[] = {[ALE_RECORD_COMMAND] = {"command", ALE_FLIGHTS_ASKED},
                                          [ALE_RECORD_FAULT] = {"fault", ALE_FLIGHTS_OF_FAULTS},
                                          [ALE_RECORD_DEADLINE] = {"deadline", ALE_FLIGHTS_LATE}};

/* ---- what the writers call ---- */

static void tell(ale_recorder_t *recorder, ale_chunk_kind_t kind, int64_t stamp_us, const void *bytes,
                 size_t length)
{
    const ale_flight_head_t head = {
        .type = ALE_FLIGHT_CHUNK, .kind = kind, .stamp_us = stamp_us, .length = (uint32_t)length};
    ale_flight_order_told(recorder->order, &head, bytes);
}

void ale_recorder_preset(ale_recorder_t *recorder, const char name[ALE_PRESET_NAME])
{
    if (recorder) {
        memcpy(ale_snapshot_back(recorder->preset), name, ALE_PRESET_NAME);
        ale_snapshot_publish(recorder->preset);
    }
}

void ale_recorder_bytes(ale_recorder_t *recorder, bool sent, const uint8_t *bytes, uint32_t count,
                        int64_t now_us)
{
    while (recorder && count > 0) {
        const uint32_t part = count < ALE_FLIGHT_ITEM_BYTES ? count : ALE_FLIGHT_ITEM_BYTES;
        const ale_flight_head_t head = {.type = ALE_FLIGHT_CHUNK,
                                        .kind = sent ? ALE_CHUNK_SENT : ALE_CHUNK_RECEIVED,
                                        .stamp_us = now_us,
                                        .length = part};
        ale_flight_order_acquired(recorder->order, &head, bytes);
        bytes += part;
        count -= part;
    }
}

void ale_recorder_scan(ale_recorder_t *recorder, uint32_t number)
{
    if (recorder) {
        const ale_flight_head_t head = {.type = ALE_FLIGHT_SCAN, .number = number};
        ale_flight_order_acquired(recorder->order, &head, "");
    }
}

void ale_recorder_odometry(ale_recorder_t *recorder, uint32_t number, const ale_odometry_t *sample)
{
    if (recorder) {
        uint8_t payload[ALE_CHUNK_ODOMETRY_BYTES];
        ale_chunk_put_odometry(payload, sample);
        const ale_flight_head_t head = {.type = ALE_FLIGHT_CHUNK,
                                        .kind = ALE_CHUNK_ODOMETRY,
                                        .number = number,
                                        .stamp_us = sample->stamp_us,
                                        .length = sizeof payload};
        ale_flight_order_told(recorder->order, &head, payload);
    }
}

void ale_recorder_command(ale_recorder_t *recorder, int64_t now_us, const char *text)
{
    if (recorder) {
        tell(recorder, ALE_CHUNK_COMMAND, now_us, text, strnlen(text, ALE_FLIGHT_ITEM_BYTES));
    }
}

void ale_recorder_correction(ale_recorder_t *recorder, int64_t now_us, uint32_t scan, ale_pose_t pose)
{
    if (recorder) {
        uint8_t payload[16];
        ale_put_u32(payload, scan);
        ale_put_u32(payload + 4, (uint32_t)pose.x_um);
        ale_put_u32(payload + 8, (uint32_t)pose.y_um);
        ale_put_u32(payload + 12, pose.theta_bam);
        tell(recorder, ALE_CHUNK_CORRECTION, now_us, payload, sizeof payload);
    }
}

void ale_recorder_result(ale_recorder_t *recorder, const ale_result_t *result)
{
    if (recorder) {
        const ale_flight_result_t kept = ale_flight_result(result);
        const ale_flight_head_t head = {
            .type = ALE_FLIGHT_RESULT, .number = result->answered, .length = sizeof kept};
        ale_flight_order_told(recorder->order, &head, &kept);
    }
}

void ale_recorder_trigger(ale_recorder_t *recorder, ale_record_reason_t reason)
{
    if (recorder) {
        atomic_fetch_or(&recorder->wanted, 1U << reason);
        ale_background_wake(&recorder->thread);
    }
}

bool ale_recorder_ask(ale_recorder_t *recorder, int wake)
{
    if (!recorder || atomic_load(&recorder->turn) != IDLE) {
        return false;
    }
    recorder->wake = wake;
    atomic_store(&recorder->turn, ASKED);
    ale_recorder_trigger(recorder, ALE_RECORD_COMMAND);
    return true;
}

bool ale_recorder_done(ale_recorder_t *recorder, ale_record_outcome_t *outcome)
{
    if (!recorder || atomic_load(&recorder->turn) != DONE) {
        return false;
    }
    *outcome = recorder->outcome;
    atomic_store(&recorder->turn, IDLE);
    return true;
}

uint32_t ale_recorder_written(const ale_recorder_t *recorder)
{
    return recorder ? atomic_load(&recorder->written) : 0;
}

uint32_t ale_recorder_refused(const ale_recorder_t *recorder)
{
    return recorder ? ale_flight_order_refused(recorder->order) : 0;
}

/* ---- the recorder's thread ---- */

/* A command does not wait, and does not take the place of a fault that is being recorded. */
static void plan(ale_recorder_t *recorder, int64_t now_ns)
{
    const unsigned wanted = atomic_exchange(&recorder->wanted, 0);
    const unsigned by_itself = wanted & ~(1U << ALE_RECORD_COMMAND);
    if (recorder->write_ns == 0 && by_itself != 0 && ale_flight_pause_is_over(&recorder->pause, now_ns)) {
        recorder->reason = by_itself & (1U << ALE_RECORD_FAULT) ? ALE_RECORD_FAULT : ALE_RECORD_DEADLINE;
        recorder->write_ns = now_ns + AFTERMATH_NS;
        ale_flight_pause_begin(&recorder->pause, now_ns);
    }
    if (wanted & (1U << ALE_RECORD_COMMAND)) {
        recorder->reason = recorder->write_ns == 0 ? ALE_RECORD_COMMAND : recorder->reason;
        recorder->write_ns = now_ns;
        recorder->asked = atomic_load(&recorder->turn) == ASKED;
    }
}

/* error: an errno, or 0 when it is written. */
static void tell_who_asked(ale_recorder_t *recorder, int error)
{
    ale_record_outcome_t *outcome = &recorder->outcome;
    if (!recorder->asked) {
        return;
    }
    recorder->asked = false;
    outcome->fine = error == 0;
    if (error == 0) {
        snprintf(outcome->text, sizeof outcome->text, "a flight recording is written");
    } else {
        snprintf(outcome->text, sizeof outcome->text, "not recorded: %s", strerror(error));
    }
    atomic_store(&recorder->turn, DONE);
    ale_wake_post(recorder->wake);
}

static char *print_config(const ale_config_t *config)
{
    char *text = NULL;
    size_t count = 0;
    FILE *out = open_memstream(&text, &count);
    if (!out) {
        return NULL;
    }
    ale_config_print(config, out);
    if (fclose(out) != 0) {
        free(text);
        return NULL;
    }
    return text;
}

/* The configuration in force: with the preset of the scanner that was found. */
static void follow_preset(ale_recorder_t *recorder)
{
    bool fresh = false;
    ale_config_t config = *recorder->config;
    const char *name = ale_snapshot_newest(recorder->preset, &fresh);
    if (!fresh || !ale_config_use_preset(&config, name)) {
        return;
    }
    snprintf(config.model, sizeof config.model, "%s", name);
    char *text = print_config(&config);
    if (text) {
        free(recorder->config_text);
        recorder->config_text = text;
    }
}

static void write_if_due(ale_recorder_t *recorder, int64_t now_ns)
{
    if (recorder->write_ns == 0 || now_ns < recorder->write_ns) {
        return;
    }
    char message[ALE_FLIGHT_MESSAGE];
    recorder->write_ns = 0;
    follow_preset(recorder);
    const int error = ale_flight_file_write(recorder->config->recorder_folder, &kinds[recorder->reason],
                                            recorder->config_text, recorder->flight, message);
    if (error == 0) {
        atomic_fetch_add(&recorder->written, 1);
    }
    ale_log_line("%s", message);
    tell_who_asked(recorder, error);
}

static void run(ale_rt_task_t *self, void *user)
{
    ale_recorder_t *recorder = user;
    while (!ale_rt_task_stopping(self)) {
        ale_background_wait(&recorder->thread, LOOK_NS);
        const int64_t now_ns = ale_rt_now_ns();
        ale_flight_order_move(recorder->order, now_ns);
        plan(recorder, now_ns);
        write_if_due(recorder, now_ns);
    }
    ale_flight_order_move(recorder->order, ale_rt_now_ns());
    ale_flight_order_flush(recorder->order);
    plan(recorder, ale_rt_now_ns());
    write_if_due(recorder, INT64_MAX);
}

ale_recorder_t *ale_recorder_start(const ale_config_t *config)
{
    ale_recorder_t *recorder = calloc(1, sizeof *recorder);
    if (!recorder) {
        return NULL;
    }
    recorder->config = config;
    recorder->config_text = print_config(config);
    recorder->flight = ale_flight_ring_create((uint32_t)config->recorder_megabytes * MEGABYTE);
    recorder->order = ale_flight_order_create(recorder->flight);
    recorder->preset = ale_snapshot_create(ALE_PRESET_NAME);
    if (!recorder->config_text || !recorder->preset || !recorder->flight || !recorder->order ||
        ale_background_start(&recorder->thread, "ale-recorder", run, recorder, 0) < 0) {
        ale_recorder_stop(recorder);
        return NULL;
    }
    return recorder;
}

void ale_recorder_stop(ale_recorder_t *recorder)
{
    if (recorder) {
        ale_background_stop(&recorder->thread);
        ale_flight_order_destroy(recorder->order);
        ale_flight_ring_destroy(recorder->flight);
        ale_snapshot_destroy(recorder->preset);
        free(recorder->config_text);
        free(recorder);
    }
}
