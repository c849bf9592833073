/* What a recording of a scanner's line is read with, a family each: bytes in, scans out, as the driver made
 * them on the robot. Internal to drivers/log. */
#ifndef ALE_LOG_LINE_READER_H
#define ALE_LOG_LINE_READER_H

#include "base/scan.h"
#include "scanner/ldrobot/ldrobot.h"
#include "scanner/rotary/protocol.h"
#include "scanner/rotary/rotary_stream.h"
#include "scanner/rplidar/rplidar.h"
#include "scanner/urg/identity.h"
#include "scanner/urg/urg_stream.h"

typedef struct {
    ale_scip_parser_t parser;
    ale_urg_identity_t identity;
    ale_urg_stream_t stream;
} ale_urg_line_t;

typedef struct {
    const ale_rotary_protocol_t *protocol;
    ale_rotary_stream_t stream;
    ale_rotary_packet_t packet;
    ale_rotary_facts_t facts;
    int64_t arrival_us; /* of the bytes before */
    bool heard;         /* bytes came since the stream began */
    union {
        ale_ldrobot_t ldrobot;
        ale_rplidar_t rplidar;
    } state;
} ale_rotary_line_t;

typedef union {
    ale_urg_line_t urg;
    ale_rotary_line_t rotary;
} ale_line_state_t;

typedef struct {
    const char *family;
    const ale_rotary_protocol_t *protocol; /* of a rotary one */
    void (*begin)(ale_line_state_t *line, const ale_rotary_protocol_t *protocol);
    /* What the driver sent. */
    void (*send)(ale_line_state_t *line, const uint8_t *bytes, uint32_t count);
    /* Reads on in what came in at arrival_us. The number of bytes used, at least 1 of count > 0; it stops
     * where next may have something. */
    size_t (*receive)(ale_line_state_t *line, const uint8_t *bytes, size_t count, int64_t arrival_us);
    ale_scanner_event_t (*next)(ale_line_state_t *line, ale_scan_t *scan);
    const char *(*model)(const ale_line_state_t *line); /* that it told; empty: nothing yet */
} ale_line_reader_t;

extern const ale_line_reader_t ale_line_urg;
extern const ale_line_reader_t ale_line_ldrobot;
extern const ale_line_reader_t ale_line_rplidar;

#endif
