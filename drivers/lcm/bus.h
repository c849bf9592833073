/* The LCM bus: the robot's messages over wire.h. Own buffers; nothing is allocated per message.
 *
 *   char error[ALE_BUS_ERROR];
 *   ale_bus_t *bus = ale_bus_open(url, error);
 *   if (!bus) ... error says in one line what is missing ...
 *   ale_bus_on_odometry(bus, take, user);          (only who receives)
 *   ale_bus_send_odometry(bus, &sample);
 *   ale_bus_receive(bus, 50);                      (calls `take` for what has come)
 *   ale_bus_close(bus);
 *
 * One owner thread. Sending is a system call: never from the estimate task. */
#ifndef ALE_LCM_BUS_H
#define ALE_LCM_BUS_H

#include <stddef.h>
#include <stdint.h>

#include "command/keys.h"
#include "lcm/report.h"
#include "lcm/wire.h"

#define ALE_CHANNEL_POSE "ALE_POSE"
#define ALE_CHANNEL_TRACKING "ALE_TRACKING"
#define ALE_CHANNEL_FEATURES "ALE_FEATURES"
#define ALE_CHANNEL_SCAN "ALE_SCAN"
#define ALE_CHANNEL_MAP "ALE_MAP"
#define ALE_CHANNEL_MAP_PIECES "ALE_MAP_PIECES"
#define ALE_CHANNEL_PLAN "ALE_PLAN"
#define ALE_CHANNEL_GRAPH "ALE_GRAPH"
#define ALE_CHANNEL_STATUS "ALE_STATUS"
#define ALE_CHANNEL_SPEAKER "ALE_SPEAKER"
#define ALE_CHANNEL_VOUCHED "ALE_VOUCHED"
#define ALE_CHANNEL_ODOMETRY "ALE_ODOMETRY"
#define ALE_CHANNEL_ODOMETRY_EXACT "ALE_ODOMETRY_EXACT"
#define ALE_CHANNEL_COMMAND "ALE_COMMAND"
#define ALE_CHANNEL_DRIVE "ALE_DRIVE"
#define ALE_CHANNEL_DRIVE_KEYED "ALE_DRIVE_KEYED"
#define ALE_CHANNEL_DRIVE_READY "ALE_DRIVE_READY"
#define ALE_CHANNEL_BOT_LIDAR "LASER" /* bot_core, when asked for */
#define ALE_CHANNEL_BOT_POSE "POSE"

enum { ALE_BUS_ERROR = ALE_LCM_URL_ERROR };

typedef struct ale_bus ale_bus_t;

/* Joins the bus. url NULL or empty: the environment's LCM_DEFAULT_URL, else LCM's default. The bus is the
 * caller's to close. NULL and one line for people in error, as ale_wire_open. */
ale_bus_t *ale_bus_open(const char *url, char error[ALE_BUS_ERROR]);

/* The same before there is a network, as ale_wire_open_early. prefix: of all channels, as
 * ale_wire_set_prefix; empty: what the URL says of it. */
ale_bus_t *ale_bus_open_early(const char *url, const char *prefix, char error[ALE_BUS_ERROR]);

/* Joins the bus again where the network has changed, as ale_wire_tend. Whether there is a route. */
bool ale_bus_tend(ale_bus_t *bus);

/* NULL: nothing. */
void ale_bus_close(ale_bus_t *bus);

/* From here on every status goes out a second time, signed with the robot's own key and with the digests of
 * the newest poses (ALE_VOUCHED). The key must outlive the bus. clock_ppm: how fast the clock of utime runs.
 */
void ale_bus_vouch(ale_bus_t *bus, const ale_secret_key_t *key, int32_t clock_ppm);

/* Sends one message; reports as in report.h. Each: 0, or -1 when the message was too long for the bus or the
 * system refused it (counted: ale_bus_unsent). Nobody hears: no error. */
int ale_bus_send_pose(ale_bus_t *bus, const ale_pose_report_t *report);
int ale_bus_send_tracking(ale_bus_t *bus, const ale_estimate_t *estimate);
int ale_bus_send_features(ale_bus_t *bus, const ale_features_t *features, int64_t utime, uint32_t scan,
                          ale_pose_t sensor);
int ale_bus_send_scan(ale_bus_t *bus, const ale_scan_t *scan, int64_t utime, uint32_t number,
                      ale_pose_t sensor);
int ale_bus_send_map_part(ale_bus_t *bus, const ale_map_t *map, int64_t utime, int16_t part);
int ale_bus_send_map_pieces(ale_bus_t *bus, const ale_map_t *map, int64_t utime, int16_t part);
int ale_bus_send_plan(ale_bus_t *bus, const ale_plan_report_t *report);
int ale_bus_send_graph(ale_bus_t *bus, const ale_mapper_graph_t *graph, int64_t utime, uint32_t version);
int ale_bus_send_status(ale_bus_t *bus, const ale_status_report_t *report);
int ale_bus_send_speaker(ale_bus_t *bus, const ale_speaker_t *speaker);
int ale_bus_send_odometry(ale_bus_t *bus, const ale_odometry_t *sample);
int ale_bus_send_exact_odometry(ale_bus_t *bus, const ale_odometry_t *sample); /* then the other, for all */
int ale_bus_send_drive(ale_bus_t *bus, int64_t utime, int32_t v_um_s, int32_t w_urad_s);

/* A signed command (command/operator.h makes it). */
int ale_bus_send_command(ale_bus_t *bus, const uint8_t *bytes, size_t count);

/* A set point with a tag (motor/set_point.h makes it). */
int ale_bus_send_keyed_drive(ale_bus_t *bus, const uint8_t *bytes, size_t count);

/* The same scan and pose for viewers that know bot_core's types. */
int ale_bus_send_bot_lidar(ale_bus_t *bus, const ale_scan_t *scan, int64_t utime);
int ale_bus_send_bot_pose(ale_bus_t *bus, const ale_pose_report_t *report);

/* Odometry as it arrives, checked; of a sample that came exactly, too, only that. sample->stamp_us is the
 * message's utime: of the sender's clock (sender_clock.h); `sender` as ale_wire_sender. What is not what it
 * should be is refused and counted. 0, or -1: the bus cannot be listened to (errno). */
typedef void (*ale_bus_odometry_t)(void *user, const ale_odometry_t *sample, uint64_t sender);
int ale_bus_on_odometry(ale_bus_t *bus, ale_bus_odometry_t take, void *user);

/* Who speaks on these channels, itself among them: names are printable ASCII. 0, or -1 as above. */
typedef void (*ale_bus_speaker_t)(void *user, const ale_speaker_t *speaker);
int ale_bus_on_speaker(ale_bus_t *bus, ale_bus_speaker_t take, void *user);

/* Commands as they arrive: bytes that nobody has looked at yet (command/verify.h does). What comes
 * between two calls of ale_bus_receive waits in the kernel. 0, or -1 as above. */
typedef void (*ale_bus_command_t)(void *user, const uint8_t *bytes, size_t count);
int ale_bus_on_command(ale_bus_t *bus, ale_bus_command_t take, void *user);

/* What a motor controller says (ALE_DRIVE_READY): bytes that nobody has looked at yet. On a bus that takes no
 * commands. 0, or -1 as above. */
int ale_bus_on_ready(ale_bus_t *bus, ale_bus_command_t take, void *user);

/* A descriptor for poll that is readable while messages wait. -1 when there is none. */
int ale_bus_descriptor(ale_bus_t *bus);

/* Waits up to timeout_ms for a message (0: looks only), then handles what has come, 256 datagrams at most.
 * The number handled (a signal ends the wait early), or -1 when the bus can no longer be received. */
int ale_bus_receive(ale_bus_t *bus, int timeout_ms);

/* Whether what this machine sends arrives on it (wire.h). After one of the subscriptions. */
bool ale_bus_hears_itself(ale_bus_t *bus, int timeout_ms);

/* Odometry that was not what it should be. */
typedef struct {
    uint64_t malformed; /* no such message, or no number, or a place farther than 2000 m */
    uint64_t unstamped; /* of before 1970, or of no time that a clock shows */
} ale_bus_refused_t;

ale_bus_refused_t ale_bus_refused(const ale_bus_t *bus);
uint64_t ale_bus_unsent(const ale_bus_t *bus);           /* messages that did not go out */
ale_lcm_dropped_t ale_bus_dropped(const ale_bus_t *bus); /* datagrams that no message came of */

#endif
