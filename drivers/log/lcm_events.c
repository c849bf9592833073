/* LCM event logs (lcm-logger): ALE_SCAN and ALE_ODOMETRY, by the time in the message.
 *
 * The container is read here and not by liblcm, which reads plain files by path only: a log may be gzip or
 * lie in memory, and is cut or damaged when a robot has lost power. A reader finds its feet at the next sync
 * word. */
#include <endian.h>
#include <lcmtypes_ale_odometry_t.h>
#include <lcmtypes_ale_scan_t.h>
#include <math.h>
#include <string.h>

#include "base/fixed.h"
#include "lcm/convert.h"
#include "lcm/event.h"
#include "log/format.h"
#include "log/geometry.h"

enum {
    SCAN_COUNT_AT = 56, /* num_ranges in an encoded ale.scan_t */
    SCAN_FIXED_BYTES = 66,
    MOST_CODE = 19 /* of the URG; above, values are ranges */
};

typedef struct {
    ale_span_t channel;
    const char *data;
    uint32_t length;
} message_t;

static int32_t big_endian(const char *at)
{
    uint32_t value;
    memcpy(&value, at, sizeof value);
    return (int32_t)be32toh(value);
}

static bool claims_file(const uint8_t *bytes, size_t count)
{
    return count >= ALE_LCM_EVENT_HEAD && memcmp(bytes, ale_lcm_event_sync, ALE_LCM_EVENT_SYNC) == 0;
}

/* The event that begins at text->at, or false. */
static bool take_event(ale_text_t *text, message_t *message)
{
    const size_t left = (size_t)(text->end - text->at);
    ale_lcm_event_t event;
    if (left < ALE_LCM_EVENT_HEAD || !ale_lcm_event_read((const uint8_t *)text->at, &event) ||
        (uint64_t)ALE_LCM_EVENT_HEAD + event.channel_bytes + event.data_bytes > left) {
        return false;
    }
    const char *channel = text->at + ALE_LCM_EVENT_HEAD;
    message->channel = (ale_span_t){channel, channel + event.channel_bytes};
    message->data = message->channel.end;
    message->length = event.data_bytes;
    text->at = message->data + event.data_bytes;
    return true;
}

static void skip_damage(ale_log_t *log)
{
    ale_text_t *text = &log->text;
    const char *found =
        memmem(text->at + 1, (size_t)(text->end - text->at - 1), ale_lcm_event_sync, ALE_LCM_EVENT_SYNC);
    text->at = found ? found : text->end;
    ale_log_bad_chunk(log, "damaged or cut event");
}

/* The generated decoder allocates what a message claims to hold; this one holds it. */
static bool has_right_length(const message_t *message)
{
    if (message->length < SCAN_FIXED_BYTES) {
        return false;
    }
    const int32_t ranges = big_endian(message->data + SCAN_COUNT_AT);
    if (ranges < 0 || (uint32_t)ranges > (message->length - SCAN_FIXED_BYTES) / 2) {
        return false;
    }
    const uint32_t codes_at = SCAN_FIXED_BYTES - 4 + 2 * (uint32_t)ranges;
    const int32_t codes = big_endian(message->data + codes_at);
    return codes >= 0 && (uint64_t)codes + codes_at + 4 == message->length;
}

static bool all_finite(const lcmtypes_ale_scan_t *message)
{
    const float values[] = {message->beam_time_us, message->first_bearing, message->step,
                            message->range_min,    message->range_max,     message->sensor_x,
                            message->sensor_y,     message->sensor_theta};
    for (size_t i = 0; i < sizeof values / sizeof values[0]; i++) {
        if (!isfinite(values[i]) || fabsf(values[i]) > 1e6F) {
            return false;
        }
    }
    return message->step <= (float)M_PI && message->step >= -(float)M_PI;
}

static void set_beam(ale_scan_t *scan, uint16_t beam, int64_t range_um, uint8_t code)
{
    if (code == 0) {
        ale_scan_set_range(scan, beam, (int32_t)ale_clamp64(range_um, 0, INT32_MAX));
    } else if (code & 0x80) {
        scan->range_um[beam] = 0;
        scan->code[beam] = 0;
        scan->flag[beam] = (code & 0x7F) <= ALE_BEAM_TOO_NEAR ? code & 0x7F : ALE_BEAM_UNKNOWN;
    } else {
        ale_scan_set_urg(scan, beam, code <= MOST_CODE ? code : 1);
    }
}

/* Single precision carries the exact steps of the URG; so does the first bearing then, to half a step. */
static void set_geometry(ale_scan_t *scan, const lcmtypes_ale_scan_t *message)
{
    scan->step_bam = ale_geometry_whole_step((int32_t)ale_from_radians((double)message->step));
    scan->first_bearing_bam = ale_from_radians((double)message->first_bearing);
    if (scan->step_bam == ALE_URG_STEP_BAM || scan->step_bam == -ALE_URG_STEP_BAM) {
        const uint32_t half_step_bam = ALE_URG_STEP_BAM / 2;
        scan->first_bearing_bam =
            (scan->first_bearing_bam + half_step_bam / 2) / half_step_bam * half_step_bam;
    }
    scan->stamp_us = message->utime;
    scan->stamp_beam = message->stamp_beam;
    scan->beam_time_ns = ale_from_metres((double)message->beam_time_us * 1e-3);
    scan->range_min_um = ale_from_metres((double)message->range_min);
    scan->range_max_um =
        (int32_t)ale_clamp64(ale_from_metres((double)message->range_max), 1, ALE_MAX_RANGE_UM);
}

static bool convert_scan(ale_log_t *log, const lcmtypes_ale_scan_t *message, ale_log_record_t *record)
{
    if (message->num_ranges > ALE_MAX_BEAMS) {
        ale_log_too_many_beams(log, message->num_ranges);
        return false;
    }
    if (!all_finite(message) || message->range_unit_mm < 1 || message->num_codes != message->num_ranges) {
        ale_log_bad_chunk(log, "ALE_SCAN with impossible values");
        return false;
    }
    ale_scan_t *scan = &record->event.scan;
    set_geometry(scan, message);
    scan->beams = (uint16_t)message->num_ranges;
    for (uint16_t k = 0; k < scan->beams; k++) {
        const int64_t range_um = (int64_t)message->range_mm[k] * message->range_unit_mm * 1000;
        set_beam(scan, k, range_um, message->codes[k]);
    }
    log->info.has_sensor = true;
    log->info.sensor = (ale_pose_t){.x_um = ale_from_metres((double)message->sensor_x),
                                    .y_um = ale_from_metres((double)message->sensor_y),
                                    .theta_bam = ale_from_radians((double)message->sensor_theta)};
    log->info.urg_noise = ale_abs64(scan->step_bam) == ALE_URG_STEP_BAM;
    record->event.kind = ALE_LOG_SCAN;
    record->event.stamp_us = scan->stamp_us;
    record->with_odometry = false;
    return true;
}

static bool take_scan(ale_log_t *log, const message_t *message, ale_log_record_t *record)
{
    lcmtypes_ale_scan_t scan;
    if (!has_right_length(message) ||
        lcmtypes_ale_scan_t_decode(message->data, 0, (int)message->length, &scan) < 0) {
        ale_log_bad_chunk(log, "unreadable ALE_SCAN");
        return false;
    }
    const bool taken = convert_scan(log, &scan, record);
    lcmtypes_ale_scan_t_decode_cleanup(&scan);
    return taken;
}

static bool take_odometry(ale_log_t *log, const message_t *message, ale_log_record_t *record)
{
    lcmtypes_ale_odometry_t odometry;
    ale_log_event_t *event = &record->event;
    if (lcmtypes_ale_odometry_t_decode(message->data, 0, (int)message->length, &odometry) < 0 ||
        ale_take_odometry(&odometry, &event->odometry) < 0) {
        ale_log_bad_chunk(log, "unreadable ALE_ODOMETRY");
        return false;
    }
    event->kind = ALE_LOG_ODOMETRY;
    event->stamp_us = event->odometry.stamp_us;
    record->with_odometry = false;
    return true;
}

static bool take_message(ale_log_t *log, const message_t *message, ale_log_record_t *record)
{
    if (ale_text_is(message->channel, "ALE_SCAN")) {
        return take_scan(log, message, record);
    }
    return ale_text_is(message->channel, "ALE_ODOMETRY") && take_odometry(log, message, record);
}

static bool next(ale_log_t *log, ale_log_record_t *record)
{
    while (log->text.at < log->text.end) {
        message_t message;
        if (!take_event(&log->text, &message)) {
            skip_damage(log);
        } else if (take_message(log, &message, record)) {
            return true;
        }
    }
    return false;
}

const ale_log_format_t ale_log_lcm_events = {
    .name = "LCM events",
    .claims_file = claims_file,
    .state_size = 1,
    .stamped = true,
    .constant_odometry = true,
    .next = next,
};
