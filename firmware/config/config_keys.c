#include "config/config_keys.h"

#include <string.h>

#include "config/config.h"

#define FIELD(member) offsetof(ale_config_t, member), sizeof(((ale_config_t *)0)->member)
#define TEXT(member) ALE_KEY_TEXT, 0, FIELD(member), 0, 0
#define FAMILY(member) ALE_KEY_FAMILY, 0, FIELD(member), 0, 0
#define MODEL(member) ALE_KEY_MODEL, 0, FIELD(member), 0, 0
#define URL(member) ALE_KEY_URL, 0, FIELD(member), 0, 0
#define PREFIX(member) ALE_KEY_PREFIX, 0, FIELD(member), 0, 0
#define BOOL(member) ALE_KEY_BOOL, 0, FIELD(member), 0, 0
#define NUMBER(member, digits, min, max) ALE_KEY_NUMBER, digits, FIELD(member), min, max
#define RATE(member, min, max) ALE_KEY_RATE, 0, FIELD(member), min, max
#define ODD(member, min, max) ALE_KEY_ODD, 0, FIELD(member), min, max
#define ANGLE(member) ALE_KEY_ANGLE, 9, FIELD(member), -3141592653, 3141592653
#define SECTORS ALE_KEY_SECTORS, 0, FIELD(pipeline.blind), 0, 0

const ale_config_key_t ale_config_keys[] = {
    {"sensor", "type", FAMILY(type),
     "Family of the scanner: urg (Hokuyo, SCIP), ldrobot (LD06, LD19, STL-19P), rplidar (SLAMTEC A1"
     " to S3); auto: whichever answers."},
    {"sensor", "model", MODEL(model),
     "Preset of [noise]: urg-04lx, utm-30lx, utm-30lx-ew, ust-10lx, ld06, ld19, stl-19p, rplidar-a1, "
     "rplidar-a2,\n"
     "rplidar-c1, rplidar-s2, lms-200, lds-01. Empty: by what the scanner says it is, else that of its "
     "type."},
    {"sensor", "port", TEXT(port),
     "Serial device of the scanner, best a stable name under /dev/serial/by-id.\n"
     "Empty: every serial port is asked for the scanner with the serial number below.\n"
     "rtai:0, rtai:1: a 16550 port by RTAI's serial driver (builds for RTAI)."},
    {"sensor", "serial", TEXT(serial), "Serial number that the scanner must have. Empty: any."},
    {"sensor", "baud", RATE(baud, 0, 1000000), "Rate of an RS-232 port in bit/s. 0: found by trying."},
    {"sensor", "x", NUMBER(pipeline.sensor.x_um, 6, -10000000, 10000000),
     "Mounting: where the scanner sits in the robot's frame, metres forward ..."},
    {"sensor", "y", NUMBER(pipeline.sensor.y_um, 6, -10000000, 10000000), "... metres to the left ..."},
    {"sensor", "theta", ANGLE(pipeline.sensor.theta_bam),
     "... and which way it looks, radians counter-clockwise."},
    {"sensor", "reversed", BOOL(reversed), "Mounted upside down: its beams run clockwise."},
    {"sensor", "blind", SECTORS,
     "Sectors that see the robot itself, scanner's degrees counter-clockwise from:to, separated by commas:\n"
     "-120:-100, 100:120. At most 8."},
    {"sensor", "first_step", NUMBER(first_step, 0, 0, 4095), "First and last step to read."},
    {"sensor", "last_step", NUMBER(last_step, 0, 0, 4095), "Both 0: all that the scanner offers."},

    {"noise", "own_um", NUMBER(pipeline.extract.noise.own_um, 0, 0, 100000),
     "Noise of the scanner, one sigma, as ale-calibrate fits it; what is not said is the preset's "
     "(sensor.model).\n"
     "Error of each beam alone, micrometres"},
    {"noise", "own_ppm", NUMBER(pipeline.extract.noise.own_ppm, 0, 0, 100000),
     "and parts of a million of the range,"},
    {"noise", "own_ppm_per_m", NUMBER(pipeline.extract.noise.own_ppm_per_m, 0, 0, 10000),
     "of a scanner that triangulates also for each metre of the range,"},
    {"noise", "shared_um", NUMBER(pipeline.extract.noise.shared_um, 0, 0, 100000),
     "error that neighbouring beams share, micrometres"},
    {"noise", "shared_ppm", NUMBER(pipeline.extract.noise.shared_ppm, 0, 0, 100000),
     "and parts of a million of the range,"},
    {"noise", "shared_beams", NUMBER(pipeline.extract.noise.shared_beams, 0, 1, ALE_MAX_BEAMS),
     "over about so many beams,"},
    {"noise", "surface_um", NUMBER(pipeline.extract.noise.surface_um, 0, 0, 100000),
     "bias from surface to surface, micrometres,"},
    {"noise", "bearing_nrad", NUMBER(pipeline.extract.noise.bearing_nrad, 0, 0, 100000000),
     "error of a beam's bearing, nanoradians."},

    {"extract", "min_points", NUMBER(pipeline.extract.min_points, 0, 5, ALE_MAX_BEAMS),
     "Fewest beams of a line."},
    {"extract", "min_length", NUMBER(pipeline.extract.min_length_um, 6, 0, 100000000),
     "Shortest line, metres."},
    {"extract", "smooth_span", ODD(pipeline.extract.smooth_span, 1, 31),
     "Beams of the smoothing window, odd."},
    {"extract", "robust_passes", NUMBER(pipeline.extract.robust_passes, 0, 0, 8),
     "Most passes of robust weighting."},

    {"odometry", "use", BOOL(pipeline.use_odometry), "Use wheel odometry from ALE_ODOMETRY when it comes."},
    {"odometry", "lag_us", NUMBER(pipeline.odometry_lag_us, 0, -100000, 300000),
     "Odometry is younger than the scans by so many microseconds: a first guess, refined while running."},
    {"odometry", "distance_factor", NUMBER(pipeline.odometry_distance_factor_ppm, 6, 500000, 2000000),
     "Systematic errors of the wheels, as ale-calibrate wheels finds them: true way of a metre counted,"},
    {"odometry", "turn_factor", NUMBER(pipeline.odometry_turn_factor_ppm, 6, 500000, 2000000),
     "true turn of a radian counted,"},
    {"odometry", "turn_bias", NUMBER(pipeline.odometry_turn_bias_urad_m, 6, -1000000, 1000000),
     "and radians counted on a straight metre: one wheel is larger than the other."},
    {"odometry", "scale", NUMBER(pipeline.odometry_scale_ppm, 6, 0, 500000),
     "What is left of these errors, one sigma: of a distance as a part of it,"},
    {"odometry", "turn_per_metre", NUMBER(pipeline.odometry_turn_urad_m, 6, 0, 1000000),
     "heading error for a metre driven, radians,"},
    {"odometry", "turn_scale", NUMBER(pipeline.odometry_turn_ppm, 6, 0, 500000),
     "error of a turn as a part of it."},

    {"robot", "max_speed", NUMBER(pipeline.max_speed_mm_s, 3, 10, 20000),
     "The fastest the robot can drive, m/s: the smooth pose makes no step beyond it ..."},
    {"robot", "max_turn", NUMBER(pipeline.max_turn_mrad_s, 3, 10, 20000), "... and turn, rad/s."},
    {"robot", "width", NUMBER(robot.width_um, 6, 10000, 1000000),
     "Diameter of the disc around the point it turns about that holds all of it, metres."},
    {"robot", "margin", NUMBER(robot.margin_um, 6, 0, 300000),
     "Room left to what the scanner sees when the robot has stopped before it, metres."},
    {"robot", "deceleration", NUMBER(robot.deceleration_um_s2, 6, 10000, 20000000), "How it brakes, m/s^2."},
    {"robot", "reaction", NUMBER(robot.reaction_us, 6, 0, 5000000),
     "From the measurement of a scan until braking for it begins, seconds."},
    {"robot", "blind_speed", NUMBER(robot.blind_um_s, 6, 0, 20000000),
     "Most speed towards where the scanner does not look, m/s."},

    {"explore", "speed", NUMBER(explore_speed_um_s, 6, 10000, 5000000),
     "Exploration by itself: most speed, m/s,"},
    {"explore", "turn_rate", NUMBER(explore_turn_urad_s, 6, 100000, 10000000), "most turn rate, rad/s,"},
    {"explore", "clearance", NUMBER(explore_clearance_um, 6, 0, 500000),
     "and room that its ways keep beyond the robot's width and margin, metres."},

    {"lcm", "url", URL(lcm_url),
     "Where messages go. Empty: the environment's LCM_DEFAULT_URL, else udpm://239.255.76.67:7667?ttl=0,\n"
     "which stays on this computer. A laptop hears it by:  ale-bridge --connect ROBOT:7700 --keys KEY\n"
     "(with ale-bridge --listen 7700 here). ttl=1 lets everybody on the local network hear and be heard."},
    {"lcm", "prefix", PREFIX(lcm_prefix),
     "What the names of all channels begin with, where several robots share a network: rover1. makes\n"
     "rover1.ALE_POSE. Programs that watch it say so, too: --lcm-url 'udpm://?ttl=1&prefix=rover1.'"},
    {"lcm", "publish_scan", BOOL(publish_scan), "Send every scan's ranges as ALE_SCAN."},
    {"lcm", "publish_bot_core", BOOL(publish_bot_core),
     "Send scan and pose also as bot_core messages (LASER, POSE) for viewers that know those."},

    {"realtime", "priority", NUMBER(priority, 0, 0, 97),
     "Real-time priority of the estimate task; its helpers run just below. 0: an ordinary program."},
    {"realtime", "cpu", NUMBER(cpu, 0, -1, 1023), "Processor of the estimate task. -1: any."},
    {"realtime", "lock_memory", BOOL(lock_memory), "Keep all memory from being paged out."},

    {"map", "file", TEXT(map),
     "Map to start from, or one of tiles, which are loaded around the robot. Empty: none, the first scan\n"
     "is the origin."},
    {"map", "folder", TEXT(map_folder),
     "Where maps are saved and loaded by name; made when it is not there."},

    {"commands", "robot", TEXT(name), "The robot's name: a command is for one robot."},
    {"commands", "keys", TEXT(keys),
     "Public keys of those who may command it (ale-keys makes them). Empty: it takes no commands."},
    {"commands", "own_key", TEXT(own_key),
     "The robot's own secret key, with which it vouches for its status (ale-keys makes it).\n"
     "Empty: what keys says with .secret behind, if that is there."},
    {"commands", "drive_speed", NUMBER(drive_um_s, 6, 0, 20000000), "Most that an operator may drive, m/s,"},
    {"commands", "drive_turn", NUMBER(drive_urad_s, 6, 0, 20000000), "and turn, rad/s."},

    {"drive", "port", TEXT(drive_port),
     "Serial line to the motor controller, for set points that no bus can reach. Empty: none."},
    {"drive", "baud", NUMBER(drive_baud, 0, 1200, 4000000), "Its rate in bit/s."},
    {"drive", "key", TEXT(drive_key),
     "Key that the motor controller knows, for set points over LCM (ale-keys --drive makes it). Empty: "
     "none."},

    {"map", "keep", TEXT(keep),
     "Where map and pose are kept while running; the robot goes on from there at the next start,\n"
     "after a power cut too. Goes before file; in a map of tiles the pose alone counts. Empty: not kept."},
    {"map", "keep_seconds", NUMBER(keep_seconds, 0, 1, 3600), "How often, seconds."},

    {"recorder", "folder", TEXT(recorder_folder),
     "Where flight recordings are written: on a fault, a missed deadline or a command. Empty: none."},
    {"recorder", "megabytes", NUMBER(recorder_megabytes, 0, 1, 1024),
     "Memory for them: a URG-04LX fills 2 MB a minute."},
};

const size_t ale_config_key_count = sizeof ale_config_keys / sizeof ale_config_keys[0];

_Static_assert(sizeof ale_config_keys / sizeof ale_config_keys[0] <= ALE_CONFIG_MAX_KEYS,
               "the reader marks the keys it has seen in one table");

const ale_config_key_t *ale_config_key(const char *section, const char *name)
{
    for (size_t k = 0; k < ale_config_key_count; k++) {
        const ale_config_key_t *key = &ale_config_keys[k];
        if (strcmp(key->section, section) == 0 && strcmp(key->key, name) == 0) {
            return key;
        }
    }
    return NULL;
}

uint32_t ale_config_noise_bit(const ale_config_key_t *key)
{
    return strcmp(key->section, "noise") == 0 ? UINT32_C(1) << (key - ale_config_key("noise", "own_um")) : 0;
}
