/* LDROBOT LD06, LD19 and STL-19P: bytes to points. They send unasked, one way, 230400 bit/s:
 *
 *   54 2C  speed  start  12 x (distance, intensity)  end  stamp  sum       47 bytes, little endian
 *
 *   speed u16      degrees a second
 *   start, end u16 bearing of the first and the last point, 0.01 degree, clockwise from straight ahead
 *   distance u16   mm, 0: nothing came back; intensity u8
 *   stamp u16      ms, from 0 to 29999 and again
 *   sum u8         CRC-8 of all before it: polynomial 0x4D, begun with 0, not reflected
 *
 * Source: LDROBOT's LD06 development manual, and its driver ldlidar_stl_ros2 (lipkg), which has the sum's
 * table. The models cannot be told apart by their bytes. Pure. */
#ifndef ALE_SCANNER_LDROBOT_LDROBOT_H
#define ALE_SCANNER_LDROBOT_LDROBOT_H

#include <stdbool.h>
#include <stdint.h>

#include "scanner/rotary/packet.h"

enum { ALE_LDROBOT_PACKET = 47, ALE_LDROBOT_POINTS = 12 };

/* Fields are private. Begins zeroed. */
typedef struct {
    uint8_t bytes[ALE_LDROBOT_PACKET]; /* of the packet that is coming in */
    uint32_t have;
    uint32_t garbage;
    bool stamped;
    uint16_t stamp_ms; /* of the last packet */
    int64_t sensor_us;
} ale_ldrobot_t;

uint8_t ale_ldrobot_sum(const uint8_t *bytes, uint32_t count);

/* As ale_rotary_protocol_t has it. */
uint32_t ale_ldrobot_parse(void *state, const uint8_t *bytes, uint32_t count, ale_rotary_packet_t *packet);

#endif
