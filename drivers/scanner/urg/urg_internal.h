/* The inside of ale_urg_t, for drivers/urg only.
 *
 *   urg_device.c   life of the port: open, read, hand out
 *   urg_dialogue.c phases of the conversation: what is asked, what an answer or its absence leads to
 *   urg_frames.c   what comes of the stream, and the ladder of what is done when nothing good does
 *
 *   CLOSED -> PROBE -> [LEAVE_TM] -> [SWITCH] -> [RESET] -> [SPEED] -> [PARAMETERS] -> [VERSION] -> [STATUS]
 *                                       |                                                          -> START
 * -> STREAM
 *                                       +-> refused: [VERSION_1] -> POLL
 *
 * Trouble leads back: to PROBE (the stream is restarted), with a RESET due, or to CLOSED (reopened). */
#ifndef ALE_SCANNER_URG_URG_INTERNAL_H
#define ALE_SCANNER_URG_URG_INTERNAL_H

#include "scanner/urg/identity.h"
#include "scanner/urg/scip_parse.h"
#include "scanner/urg/urg_device.h"
#include "scanner/urg/urg_stream.h"
#include "serial/port.h"
#include "serial/port_candidates.h"

enum {
    ALE_URG_READ = 4096,
    ALE_URG_COMMAND = 24,
    ALE_URG_FIRST_SCAN_MS = 1500 /* from MD to the first scan: the laser is switched on */
};

typedef enum {
    ALE_PHASE_CLOSED,
    ALE_PHASE_PROBE,      /* QT: which protocol? */
    ALE_PHASE_LEAVE_TM,   /* TM2: left in its time-setting mode */
    ALE_PHASE_SWITCH,     /* SCIP2.0 */
    ALE_PHASE_VERSION_1,  /* V, of a device that stays in 1.1 */
    ALE_PHASE_RESET,      /* RS */
    ALE_PHASE_SPEED,      /* SS */
    ALE_PHASE_PARAMETERS, /* PP */
    ALE_PHASE_VERSION,    /* VV */
    ALE_PHASE_STATUS,     /* II */
    ALE_PHASE_START,      /* MD or MS: acknowledged? */
    ALE_PHASE_STREAM,
    ALE_PHASE_POLL /* G, again and again */
} ale_urg_phase_t;

/* What is still to be asked before the stream starts. */
enum { ALE_DUE_RESET = 1, ALE_DUE_PARAMETERS = 2, ALE_DUE_VERSION = 4, ALE_DUE_STATUS = 8 };

struct ale_urg {
    ale_urg_config_t config;
    ale_urg_health_t health;
    bool changed;

    ale_port_t *port;
    char candidates[ALE_PORT_CANDIDATES][ALE_PORT_PATH];
    uint32_t candidate_count;
    uint32_t candidate; /* next one to try */
    int64_t open_at_us;
    uint32_t open_failures;
    uint8_t bytes[ALE_URG_READ]; /* as read */
    uint32_t byte_count;
    uint32_t bytes_used;
    int64_t read_us;

    ale_scip_parser_t parser;
    ale_urg_identity_t identity;
    bool led_out;     /* TM2 was tried on a sensor that refuses QT */
    bool port_proved; /* a scan came since the port was opened */
    bool identified;  /* VV was answered once */
    ale_urg_stream_t stream;

    ale_urg_phase_t phase;
    uint32_t due;
    char command[ALE_URG_COMMAND]; /* that an answer is waited for */
    uint32_t tries;
    int64_t deadline_us;
    uint32_t baud_attempt;
    int32_t good_baud;       /* the last one that worked */
    uint32_t speed_attempts; /* SS sent since the last series of good scans */
    int64_t poll_at_us;      /* next G; 0: one is out */

    uint32_t failures;   /* restarts in a row without a series of good scans between */
    uint32_t bad_frames; /* in a row */
    uint32_t good_frames;
    uint32_t frozen; /* repeated stamps in a row */
};

int64_t ale_urg_now_us(const ale_urg_t *urg);
/* Span of the urg's clock for a time-out of so many milliseconds of the sensor. */
int64_t ale_urg_timeout_us(const ale_urg_t *urg, int32_t ms);

/* Bytes to the port, through the tap; trouble closes the port. */
void ale_urg_send(ale_urg_t *urg, const char *text);
void ale_urg_close_port(ale_urg_t *urg);
/* Status in plain words; tells the caller of ale_urg_step if it is news. */
void ale_urg_say(ale_urg_t *urg, const char *text);
void ale_urg_set_state(ale_urg_t *urg, ale_urg_state_t state);

/* urg_dialogue.c: a port was opened; an event of the parser; nothing is left to read: time-outs, polling. */
void ale_urg_dialogue_begin(ale_urg_t *urg);
void ale_urg_dialogue_event(ale_urg_t *urg, const ale_scip_event_t *event);
void ale_urg_dialogue_time(ale_urg_t *urg);
/* Next moment at which ale_urg_dialogue_time has something to do. */
int64_t ale_urg_dialogue_deadline(const ale_urg_t *urg);
/* The stream is stopped and everything that is due asked again. */
void ale_urg_probe(ale_urg_t *urg);
int64_t ale_urg_deadline(const ale_urg_t *urg, int32_t ms);

/* urg_frames.c: SCAN and LOST of the parser; a frame with a status instead of ranges (21..49 and 98 a
 * check, 50..97 a fault). */
void ale_urg_frame(ale_urg_t *urg, const ale_scip_event_t *event);
void ale_urg_stream_status(ale_urg_t *urg, const ale_scip_event_t *event);
/* The ladder: restart the stream, three times; reset; reopen. */
void ale_urg_fail(ale_urg_t *urg, const char *reason);

/* urg_device.c: closes the port; it is opened again after a pause. */
void ale_urg_reopen(ale_urg_t *urg, const char *reason);

#endif
