#include "lcm/bus.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <lcmtypes_ale_drive_t.h>
#include <lcmtypes_ale_odometry_exact_t.h>
#include <lcmtypes_ale_speaker_t.h>
#include <lcmtypes_bot_core_planar_lidar_t.h>
#include <lcmtypes_bot_core_pose_t.h>

#include "lcm/convert.h"
#include "lcm/vouch.h"

/* What may wait in the kernel between two looks at the bus is looked at in one go. */
enum { MAX_DATAGRAMS = 256, MESSAGE_BYTES = 16384, FARTHEST_UM = 2000000000 };

struct ale_bus {
    ale_wire_t *wire;
    ale_bus_refused_t refused;
    uint64_t unsent;
    ale_bus_odometry_t take_odometry;
    void *odometry_user;
    int64_t exact_utime; /* of the last sample that came exactly */
    ale_bus_speaker_t take_speaker;
    void *speaker_user;
    ale_bus_command_t take_command;
    void *command_user;
    ale_vouch_t vouch;
    ale_features_buffer_t features;
    ale_scan_buffer_t scan;
    ale_map_buffer_t map;
    ale_pieces_buffer_t pieces;
    ale_plan_buffer_t plan;
    ale_graph_buffer_t graph;
    ale_status_buffer_t status;
    float bot_ranges[ALE_MAX_BEAMS];
    uint8_t bytes[MESSAGE_BYTES];
};

_Static_assert(ALE_MAX_BEAMS * 4 + 64 <= MESSAGE_BYTES, "a scan fits the message");
_Static_assert(ALE_MAX_LINES * 48 + ALE_MAX_CORNERS * 29 + 64 <= MESSAGE_BYTES, "features fit the message");
_Static_assert(ALE_GRAPH_KEYFRAMES * 21 + ALE_GRAPH_LOOPS * 5 + 64 <= MESSAGE_BYTES,
               "a graph fits the message");

static ale_bus_t *open_by(ale_wire_t *(*open_wire)(const char *, char *), const char *url,
                          char error[ALE_BUS_ERROR])
{
    ale_bus_t *bus = calloc(1, sizeof *bus);
    if (!bus) {
        snprintf(error, ALE_BUS_ERROR, "LCM: out of memory");
        return NULL;
    }
    bus->wire = open_wire(url, error);
    if (!bus->wire) {
        free(bus);
        return NULL;
    }
    return bus;
}

ale_bus_t *ale_bus_open(const char *url, char error[ALE_BUS_ERROR])
{
    return open_by(ale_wire_open, url, error);
}

ale_bus_t *ale_bus_open_early(const char *url, const char *prefix, char error[ALE_BUS_ERROR])
{
    ale_bus_t *bus = open_by(ale_wire_open_early, url, error);
    if (bus && prefix[0] != '\0' && ale_wire_set_prefix(bus->wire, prefix) < 0) {
        snprintf(error, ALE_BUS_ERROR, "LCM: no channel may begin with \"%.40s\"", prefix);
        ale_bus_close(bus);
        return NULL;
    }
    return bus;
}

bool ale_bus_tend(ale_bus_t *bus)
{
    return ale_wire_tend(bus->wire);
}

void ale_bus_close(ale_bus_t *bus)
{
    if (bus) {
        ale_wire_close(bus->wire);
        free(bus);
    }
}

/* `length` is what the encoder returned: negative when the message did not fit. */
static int send_bytes(ale_bus_t *bus, const char *channel, int length)
{
    if (length < 0 || ale_wire_send(bus->wire, channel, bus->bytes, (size_t)length) < 0) {
        bus->unsent++;
        return -1;
    }
    return 0;
}

void ale_bus_vouch(ale_bus_t *bus, const ale_secret_key_t *key, int32_t clock_ppm)
{
    bus->vouch = (ale_vouch_t){.key = key, .clock_ppm = clock_ppm};
}

int ale_bus_send_pose(ale_bus_t *bus, const ale_pose_report_t *report)
{
    lcmtypes_ale_pose_t message;
    ale_convert_pose(report, &message);
    const int length = lcmtypes_ale_pose_t_encode(bus->bytes, 0, MESSAGE_BYTES, &message);
    const int sent = send_bytes(bus, ALE_CHANNEL_POSE, length);
    if (bus->vouch.key && sent == 0) {
        ale_vouch_pose(&bus->vouch, message.scan, bus->bytes, (size_t)length);
    }
    return sent;
}

int ale_bus_send_tracking(ale_bus_t *bus, const ale_estimate_t *estimate)
{
    lcmtypes_ale_tracking_t message;
    ale_convert_tracking(estimate, &message);
    return send_bytes(bus, ALE_CHANNEL_TRACKING,
                      lcmtypes_ale_tracking_t_encode(bus->bytes, 0, MESSAGE_BYTES, &message));
}

int ale_bus_send_features(ale_bus_t *bus, const ale_features_t *features, int64_t utime, uint32_t scan,
                          ale_pose_t sensor)
{
    lcmtypes_ale_features_t message;
    ale_convert_features(features, utime, scan, sensor, &bus->features, &message);
    return send_bytes(bus, ALE_CHANNEL_FEATURES,
                      lcmtypes_ale_features_t_encode(bus->bytes, 0, MESSAGE_BYTES, &message));
}

int ale_bus_send_scan(ale_bus_t *bus, const ale_scan_t *scan, int64_t utime, uint32_t number,
                      ale_pose_t sensor)
{
    lcmtypes_ale_scan_t message;
    ale_convert_scan(scan, utime, number, sensor, &bus->scan, &message);
    return send_bytes(bus, ALE_CHANNEL_SCAN,
                      lcmtypes_ale_scan_t_encode(bus->bytes, 0, MESSAGE_BYTES, &message));
}

int ale_bus_send_map_part(ale_bus_t *bus, const ale_map_t *map, int64_t utime, int16_t part)
{
    lcmtypes_ale_map_t message;
    ale_convert_map(map, utime, part, &bus->map, &message);
    return send_bytes(bus, ALE_CHANNEL_MAP,
                      lcmtypes_ale_map_t_encode(bus->bytes, 0, MESSAGE_BYTES, &message));
}

int ale_bus_send_map_pieces(ale_bus_t *bus, const ale_map_t *map, int64_t utime, int16_t part)
{
    lcmtypes_ale_map_pieces_t message;
    ale_convert_map_pieces(map, utime, part, &bus->pieces, &message);
    return send_bytes(bus, ALE_CHANNEL_MAP_PIECES,
                      lcmtypes_ale_map_pieces_t_encode(bus->bytes, 0, MESSAGE_BYTES, &message));
}

int ale_bus_send_plan(ale_bus_t *bus, const ale_plan_report_t *report)
{
    lcmtypes_ale_plan_t message;
    ale_convert_plan(report, &bus->plan, &message);
    return send_bytes(bus, ALE_CHANNEL_PLAN,
                      lcmtypes_ale_plan_t_encode(bus->bytes, 0, MESSAGE_BYTES, &message));
}

int ale_bus_send_graph(ale_bus_t *bus, const ale_mapper_graph_t *graph, int64_t utime, uint32_t version)
{
    lcmtypes_ale_graph_t message;
    ale_convert_graph(graph, utime, version, &bus->graph, &message);
    return send_bytes(bus, ALE_CHANNEL_GRAPH,
                      lcmtypes_ale_graph_t_encode(bus->bytes, 0, MESSAGE_BYTES, &message));
}

int ale_bus_send_status(ale_bus_t *bus, const ale_status_report_t *report)
{
    lcmtypes_ale_status_t message;
    ale_convert_status(report, &bus->status, &message);
    const int sent = send_bytes(bus, ALE_CHANNEL_STATUS,
                                lcmtypes_ale_status_t_encode(bus->bytes, 0, MESSAGE_BYTES, &message));
    return bus->vouch.key ? send_bytes(bus, ALE_CHANNEL_VOUCHED,
                                       ale_vouch_encode(&bus->vouch, &message, bus->bytes, MESSAGE_BYTES))
                          : sent;
}

int ale_bus_send_speaker(ale_bus_t *bus, const ale_speaker_t *speaker)
{
    lcmtypes_ale_speaker_t message = {
        .utime = speaker->now_us, .boot = speaker->boot, .process = speaker->process};
    _Static_assert(sizeof speaker->host == sizeof message.host, "as long here as there");
    _Static_assert(sizeof speaker->robot == sizeof message.robot, "as long here as there");
    memcpy(message.host, speaker->host, sizeof message.host);
    memcpy(message.robot, speaker->robot, sizeof message.robot);
    return send_bytes(bus, ALE_CHANNEL_SPEAKER,
                      lcmtypes_ale_speaker_t_encode(bus->bytes, 0, MESSAGE_BYTES, &message));
}

int ale_bus_send_odometry(ale_bus_t *bus, const ale_odometry_t *sample)
{
    lcmtypes_ale_odometry_t message;
    ale_convert_odometry(sample, &message);
    return send_bytes(bus, ALE_CHANNEL_ODOMETRY,
                      lcmtypes_ale_odometry_t_encode(bus->bytes, 0, MESSAGE_BYTES, &message));
}

int ale_bus_send_exact_odometry(ale_bus_t *bus, const ale_odometry_t *sample)
{
    const lcmtypes_ale_odometry_exact_t message = {.utime = sample->stamp_us,
                                                   .x_um = sample->pose.x_um,
                                                   .y_um = sample->pose.y_um,
                                                   .theta_bam = (int32_t)sample->pose.theta_bam};
    return send_bytes(bus, ALE_CHANNEL_ODOMETRY_EXACT,
                      lcmtypes_ale_odometry_exact_t_encode(bus->bytes, 0, MESSAGE_BYTES, &message));
}

int ale_bus_send_drive(ale_bus_t *bus, int64_t utime, int32_t v_um_s, int32_t w_urad_s)
{
    const lcmtypes_ale_drive_t message = {
        .utime = utime, .v = ale_to_metres(v_um_s), .w = ale_to_metres(w_urad_s)};
    return send_bytes(bus, ALE_CHANNEL_DRIVE,
                      lcmtypes_ale_drive_t_encode(bus->bytes, 0, MESSAGE_BYTES, &message));
}

static int send_made(ale_bus_t *bus, const char *channel, const uint8_t *bytes, size_t count)
{
    if (count > MESSAGE_BYTES) {
        bus->unsent++;
        return -1;
    }
    memcpy(bus->bytes, bytes, count);
    return send_bytes(bus, channel, (int)count);
}

int ale_bus_send_command(ale_bus_t *bus, const uint8_t *bytes, size_t count)
{
    return send_made(bus, ALE_CHANNEL_COMMAND, bytes, count);
}

int ale_bus_send_keyed_drive(ale_bus_t *bus, const uint8_t *bytes, size_t count)
{
    return send_made(bus, ALE_CHANNEL_DRIVE_KEYED, bytes, count);
}

int ale_bus_send_bot_lidar(ale_bus_t *bus, const ale_scan_t *scan, int64_t utime)
{
    for (int k = 0; k < scan->beams; k++) {
        bus->bot_ranges[k] = scan->flag[k] == ALE_BEAM_VALID ? ale_to_metres(scan->range_um[k]) : 0;
    }
    const lcmtypes_bot_core_planar_lidar_t message = {
        .utime = utime,
        .nranges = scan->beams,
        .ranges = bus->bot_ranges,
        .rad0 = ale_to_radians(scan->first_bearing_bam),
        .radstep = ale_to_radians((uint32_t)scan->step_bam),
    };
    return send_bytes(bus, ALE_CHANNEL_BOT_LIDAR,
                      lcmtypes_bot_core_planar_lidar_t_encode(bus->bytes, 0, MESSAGE_BYTES, &message));
}

int ale_bus_send_bot_pose(ale_bus_t *bus, const ale_pose_report_t *report)
{
    lcmtypes_ale_pose_t pose;
    ale_convert_pose(report, &pose);
    const double theta = (double)pose.map_theta;
    const double forward = (double)pose.vx;
    const double left = (double)pose.vy;
    const lcmtypes_bot_core_pose_t message = {
        .utime = pose.utime,
        .pos = {(double)pose.map_x, (double)pose.map_y, 0},
        .vel = {cos(theta) * forward - sin(theta) * left, sin(theta) * forward + cos(theta) * left, 0},
        .orientation = {cos(theta / 2), 0, 0, sin(theta / 2)},
        .rotation_rate = {0, 0, (double)pose.omega},
    };
    return send_bytes(bus, ALE_CHANNEL_BOT_POSE,
                      lcmtypes_bot_core_pose_t_encode(bus->bytes, 0, MESSAGE_BYTES, &message));
}

/* Whether a clock may have said so; otherwise counted. */
static bool is_stamped(ale_bus_t *bus, int64_t utime)
{
    const bool stamped = utime > 0 && utime <= ALE_MAX_STAMP_US;
    bus->refused.unstamped += !stamped;
    return stamped;
}

static void take_odometry(void *user, const char *channel, const uint8_t *bytes, size_t count)
{
    (void)channel;
    ale_bus_t *bus = user;
    lcmtypes_ale_odometry_t message;
    ale_odometry_t sample;
    if (lcmtypes_ale_odometry_t_decode(bytes, 0, (int)count, &message) < 0) {
        bus->refused.malformed++;
    } else if (is_stamped(bus, message.utime)) {
        if (ale_take_odometry(&message, &sample) < 0) {
            bus->refused.malformed++;
        } else if (sample.stamp_us != bus->exact_utime) {
            bus->take_odometry(bus->odometry_user, &sample, ale_wire_sender(bus->wire));
        }
    }
}

static bool is_beyond(int32_t um)
{
    return um < -FARTHEST_UM || um > FARTHEST_UM;
}

static void take_exact_odometry(void *user, const char *channel, const uint8_t *bytes, size_t count)
{
    (void)channel;
    ale_bus_t *bus = user;
    lcmtypes_ale_odometry_exact_t message;
    if (lcmtypes_ale_odometry_exact_t_decode(bytes, 0, (int)count, &message) < 0 || is_beyond(message.x_um) ||
        is_beyond(message.y_um)) {
        bus->refused.malformed++;
        return;
    }
    if (!is_stamped(bus, message.utime)) {
        return;
    }
    const ale_odometry_t sample = {
        .stamp_us = message.utime,
        .pose = {.x_um = message.x_um, .y_um = message.y_um, .theta_bam = (uint32_t)message.theta_bam}};
    bus->exact_utime = message.utime;
    bus->take_odometry(bus->odometry_user, &sample, ale_wire_sender(bus->wire));
}

int ale_bus_on_odometry(ale_bus_t *bus, ale_bus_odometry_t take, void *user)
{
    bus->take_odometry = take;
    bus->odometry_user = user;
    return ale_wire_subscribe(bus->wire, ALE_CHANNEL_ODOMETRY_EXACT, take_exact_odometry, bus) < 0
               ? -1
               : ale_wire_subscribe(bus->wire, ALE_CHANNEL_ODOMETRY, take_odometry, bus);
}

/* A name as others tell it: ends within its bytes, and nothing in it that a terminal would obey. */
static void take_name(const uint8_t *told, size_t size, char *name)
{
    memcpy(name, told, size);
    name[size - 1] = '\0';
    const size_t length = strlen(name);
    for (size_t k = 0; k < length; k++) {
        if (name[k] < ' ' || name[k] > '~') {
            name[k] = '?';
        }
    }
    memset(name + length, 0, size - length);
}

static void take_speaker(void *user, const char *channel, const uint8_t *bytes, size_t count)
{
    (void)channel;
    ale_bus_t *bus = user;
    lcmtypes_ale_speaker_t message;
    if (lcmtypes_ale_speaker_t_decode(bytes, 0, (int)count, &message) < 0) {
        return;
    }
    ale_speaker_t speaker = {.now_us = message.utime, .boot = message.boot, .process = message.process};
    take_name(message.host, sizeof speaker.host, speaker.host);
    take_name(message.robot, sizeof speaker.robot, speaker.robot);
    bus->take_speaker(bus->speaker_user, &speaker);
}

int ale_bus_on_speaker(ale_bus_t *bus, ale_bus_speaker_t take, void *user)
{
    bus->take_speaker = take;
    bus->speaker_user = user;
    return ale_wire_subscribe(bus->wire, ALE_CHANNEL_SPEAKER, take_speaker, bus);
}

static void take_command(void *user, const char *channel, const uint8_t *bytes, size_t count)
{
    (void)channel;
    ale_bus_t *bus = user;
    bus->take_command(bus->command_user, bytes, count);
}

int ale_bus_on_command(ale_bus_t *bus, ale_bus_command_t take, void *user)
{
    bus->take_command = take;
    bus->command_user = user;
    return ale_wire_subscribe(bus->wire, ALE_CHANNEL_COMMAND, take_command, bus);
}

int ale_bus_on_ready(ale_bus_t *bus, ale_bus_command_t take, void *user)
{
    bus->take_command = take;
    bus->command_user = user;
    return ale_wire_subscribe(bus->wire, ALE_CHANNEL_DRIVE_READY, take_command, bus);
}

int ale_bus_descriptor(ale_bus_t *bus)
{
    return ale_wire_descriptor(bus->wire);
}

int ale_bus_receive(ale_bus_t *bus, int timeout_ms)
{
    return ale_wire_receive(bus->wire, timeout_ms, MAX_DATAGRAMS);
}

bool ale_bus_hears_itself(ale_bus_t *bus, int timeout_ms)
{
    return ale_wire_hears_itself(bus->wire, timeout_ms);
}

ale_bus_refused_t ale_bus_refused(const ale_bus_t *bus)
{
    return bus->refused;
}

uint64_t ale_bus_unsent(const ale_bus_t *bus)
{
    return bus->unsent;
}

ale_lcm_dropped_t ale_bus_dropped(const ale_bus_t *bus)
{
    return ale_wire_dropped(bus->wire);
}
