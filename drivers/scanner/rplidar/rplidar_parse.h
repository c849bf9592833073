/* SLAMTEC RPLIDAR: bytes to answers and points. Little endian.
 *
 *   descriptor   A5 5A  length (30 bits) and mode (2 bits)  type      7 bytes; mode 1: what follows is
 * repeated node         standard scan, type 81, 5 bytes: quality (6 bits), not start, start; angle in 1/64
 * degree (15 bits), 1; distance in 1/4 mm (16 bits) capsule      express scan, type 82, 84 bytes: A and low
 * half of the sum; 5 and its upper half; start, angle of the first point in 1/64 degree (15 bits); 16 x (2 x
 * (distance in mm (14 bits), upper 2 bits of an angle), lower 4 bits of the two angles). The sum is the XOR
 * of all after its own two bytes. Points lie evenly up to the next capsule's first, less their own angle in
 * 1/8 degree. dense        express scan, type 85, 84 bytes: the same head, 40 x distance in mm (16 bits)
 *
 * All angles clockwise from straight ahead. Source: SLAMTEC's rplidar_sdk (sl_lidar_cmd.h,
 * sl_lidar_protocol.h, its unpackers). Pure. */
#ifndef ALE_SCANNER_RPLIDAR_PARSE_H
#define ALE_SCANNER_RPLIDAR_PARSE_H

#include <stdbool.h>
#include <stdint.h>

#include "scanner/rotary/packet.h"

enum {
    ALE_RPLIDAR_DESCRIPTOR = 7,
    ALE_RPLIDAR_ANSWER = 64, /* longest answer that is read; a longer one is none */
    ALE_RPLIDAR_NODE = 5,
    ALE_RPLIDAR_NODES = 8, /* that are read as one packet */
    ALE_RPLIDAR_CAPSULE = 84,
    ALE_RPLIDAR_CAPSULE_POINTS = 32,
    ALE_RPLIDAR_DENSE_POINTS = 40
};

/* Types of answers. */
enum {
    ALE_RPLIDAR_INFO = 0x04,
    ALE_RPLIDAR_HEALTH = 0x06,
    ALE_RPLIDAR_RATES = 0x15,
    ALE_RPLIDAR_CONF = 0x20,
    ALE_RPLIDAR_STANDARD = 0x81,
    ALE_RPLIDAR_EXPRESS = 0x82,
    ALE_RPLIDAR_DENSE = 0x85
};

/* Fields are private, but for reading. Begins zeroed. */
typedef struct {
    uint8_t stream; /* type of the measurements that come; 0: a descriptor is looked for */
    uint8_t bytes[ALE_RPLIDAR_CAPSULE];
    uint32_t have;
    uint32_t garbage;
    bool in_step;                        /* the last piece of the stream was whole */
    uint8_t before[ALE_RPLIDAR_CAPSULE]; /* the capsule before, whose points end where the next begins */
    bool has_before;
    uint64_t stream_bytes; /* since it began: the time on the sensor's clock */

    int32_t point_ns; /* from point to point, as the sensor said; told by the owner */

    uint8_t answer_type; /* of the last ANSWER */
    uint8_t answer[ALE_RPLIDAR_ANSWER];
    uint32_t answer_bytes;
} ale_rplidar_parser_t;

/* Forgets what was half read, and looks for a descriptor. */
void ale_rplidar_parser_begin(ale_rplidar_parser_t *parser);

/* As parse of ale_rotary_protocol_t. */
uint32_t ale_rplidar_parse(ale_rplidar_parser_t *parser, const uint8_t *bytes, uint32_t count,
                           ale_rotary_packet_t *packet);

#endif
