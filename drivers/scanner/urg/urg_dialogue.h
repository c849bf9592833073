/* The conversation with a URG: what is asked, what an answer or its absence leads to.
 *
 *   CLOSED -> PROBE -> [LEAVE_TM] -> [SWITCH] -> [RESET] -> [SPEED] -> [PARAMETERS] -> [VERSION] -> [STATUS]
 *                                       |                                     -> START -> WARM_UP -> STREAM
 *                                       +-> refused: [VERSION_1] -> POLL
 *
 * Trouble leads back: to PROBE (the stream is restarted), with a RESET due, or to CLOSED (reopened).
 *
 * Pure: every function returns what is to be done on port and stream, and does nothing of it. No clock is
 * read. */
#ifndef ALE_SCANNER_URG_URG_DIALOGUE_H
#define ALE_SCANNER_URG_URG_DIALOGUE_H

#include <stdbool.h>
#include <stdint.h>

#include "scanner/scanner_types.h"
#include "scanner/urg/identity.h"
#include "scanner/urg/scip_parse.h"
#include "scanner/urg/scip_request.h"
#include "scanner/urg/stranger.h"
#include "scanner/urg/urg_action.h"

enum {
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
    ALE_PHASE_START,      /* MD: acknowledged? */
    ALE_PHASE_WARM_UP,    /* acknowledged: the first scan is waited for */
    ALE_PHASE_STREAM,
    ALE_PHASE_POLL /* G, again and again */
} ale_urg_phase_t;

/* Fields are private, but for reading. */
typedef struct {
    const ale_scanner_config_t *config;
    bool has_baud; /* of the port */
    int32_t baud;

    ale_urg_phase_t phase;
    uint32_t due;                  /* what is still to be asked before the stream starts */
    char command[ALE_URG_COMMAND]; /* that an answer is waited for */
    uint32_t tries;
    bool poll_due;              /* G is to be sent at the deadline */
    ale_scip_request_t request; /* of the stream */

    bool led_out;            /* TM2 was tried on a sensor that refuses QT */
    bool port_proved;        /* a scan came since the port was opened */
    bool identified;         /* VV was answered once */
    uint32_t baud_attempt;   /* rates tried on this port */
    ale_stranger_t stranger; /* what was heard there, while no answer came */
    int32_t good_baud;       /* the last rate that worked */
    uint32_t speed_attempts; /* SS sent since the last series of good scans */

    ale_urg_geometry_t geometry;  /* the last one that was complete, and valid */
    int32_t protocol;             /* 0 unknown, 1, 2 */
    ale_urg_identity_t identity;  /* as it is read */
    ale_scanner_identity_t known; /* the last one that was complete */
    uint64_t identity_warnings;
    uint64_t hardware_faults;
    uint64_t resets;
    char reason[ALE_URG_REASON]; /* of an action, where it is no fixed text */
} ale_urg_dialogue_t;

/* config must outlive the dialogue. */
void ale_urg_dialogue_init(ale_urg_dialogue_t *dialogue, const ale_scanner_config_t *config);

/* The rate to open the port with. */
int32_t ale_urg_dialogue_first_baud(const ale_urg_dialogue_t *dialogue);

/* The port was opened with this rate; has_baud: a rate has an effect there. */
ale_urg_action_t ale_urg_dialogue_open(ale_urg_dialogue_t *dialogue, int32_t baud, bool has_baud);

/* The port was closed. */
void ale_urg_dialogue_close(ale_urg_dialogue_t *dialogue);

/* Bytes came, of which any that are an answer are handed to ale_urg_dialogue_hear. O(count). */
void ale_urg_dialogue_overhear(ale_urg_dialogue_t *dialogue, const uint8_t *bytes, uint32_t count);

/* A LINE_READ or REPLY of the parser. */
ale_urg_action_t ale_urg_dialogue_hear(ale_urg_dialogue_t *dialogue, const ale_scip_event_t *event);

/* The deadline passed. */
ale_urg_action_t ale_urg_dialogue_time_out(ale_urg_dialogue_t *dialogue);

/* SET_BAUD was done, or the port refused. */
ale_urg_action_t ale_urg_dialogue_baud_set(ale_urg_dialogue_t *dialogue, int32_t baud, bool set);

/* The stream is stopped and what is due asked again; reset: the sensor is reset first. */
ale_urg_action_t ale_urg_dialogue_restart(ale_urg_dialogue_t *dialogue, bool reset);

/* A good scan came. True: it belongs to a stream that runs. */
bool ale_urg_dialogue_scan(ale_urg_dialogue_t *dialogue);

/* A long series of good scans came: SS may be tried again. */
void ale_urg_dialogue_proved(ale_urg_dialogue_t *dialogue);

/* The scan that was asked for came, good or not: the next one is asked for at the deadline. False: no scan
 * is. */
bool ale_urg_dialogue_polled(ale_urg_dialogue_t *dialogue);

/* The stream was acknowledged. */
bool ale_urg_dialogue_streams(const ale_urg_dialogue_t *dialogue);

ale_scanner_state_t ale_urg_dialogue_state(const ale_urg_dialogue_t *dialogue);

#endif
