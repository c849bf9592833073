/* What a protocol of a rotary scanner makes of the bytes that came: packets of points, each with its own
 * bearing.
 */
#ifndef ALE_SCANNER_ROTARY_PACKET_H
#define ALE_SCANNER_ROTARY_PACKET_H

#include <stdint.h>

enum { ALE_PACKET_POINTS_MOST = 96 };

typedef struct {
    uint32_t bearing_bam; /* counter-clockwise from straight ahead, whichever way the head turns */
    int32_t range_um;     /* 0: nothing came back */
} ale_rotary_point_t;

typedef enum {
    ALE_PACKET_NONE,    /* all bytes are used, and nothing is whole yet */
    ALE_PACKET_POINTS,  /* measurements */
    ALE_PACKET_DAMAGED, /* a packet whose sum is wrong, or that makes no sense */
    ALE_PACKET_ANSWER   /* an answer to a request: the protocol says what comes next */
} ale_packet_kind_t;

typedef struct {
    ale_packet_kind_t kind;
    uint32_t garbage; /* bytes passed over, told once */

    /* Of POINTS, in the order in which they were measured: */
    uint32_t count;
    int64_t sensor_us;   /* when the last of them was, on the sensor's own clock, which never steps back */
    int32_t behind_us;   /* by which the last byte read is ahead of that point, but for its way on the line */
    uint32_t line_bytes; /* that were on the line together, and so late */
    int32_t
        speed_mdeg_s; /* of the head as the sensor says, thousandths of a degree a second; -1: it does not */
    ale_rotary_point_t points[ALE_PACKET_POINTS_MOST];
} ale_rotary_packet_t;

#endif
