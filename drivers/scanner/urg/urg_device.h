/* The URG-04LX as a state machine over a serial port: it opens, finds rate and protocol, switches to
 * SCIP 2.0, asks who it is, streams, follows its clock, and recovers by itself from whatever happens on
 * the line, step by step: bad frame -> restart the stream -> reset -> reopen.
 *
 *   ale_urg_t *urg = ale_urg_create(&config);
 *   for (;;) switch (ale_urg_step(urg, &scan)) { case ALE_URG_SCAN: ...; case ALE_URG_SCAN_LOST: ... }
 *
 * One owner thread (acquire). ale_urg_step blocks for at most step_ms. */
#ifndef ALE_SCANNER_URG_URG_DEVICE_H
#define ALE_SCANNER_URG_URG_DEVICE_H

#include <stdbool.h>
#include <stdint.h>

#include "base/scan.h"

typedef struct ale_urg ale_urg_t;

typedef struct {
    const char *path;             /* device, or NULL: look for `serial` on every candidate port */
    const char *device_directory; /* where candidates are looked for; NULL: /dev */
    const char *serial;           /* serial number (SERI line) that must match, or NULL: any */
    int32_t baud;                 /* 0: detect */
    bool reversed;                /* mounted upside down: bearings are negated */
    uint16_t first_step;          /* 0, 0: what PP says */
    uint16_t last_step;
    bool two_character; /* MS instead of MD */
    uint8_t cluster;
    uint8_t skip;
    int32_t step_ms;   /* longest time a step may block; 0: 50 */
    double time_scale; /* device seconds per host second (a simulator that runs faster); 0: 1 */
    /* Called for every run of bytes as it passes: sent (true), or received (false) and about to be used; such
     * a run ends where a scan does. NULL: nobody. */
    void (*tap)(void *user, bool sent, const uint8_t *bytes, uint32_t count, int64_t host_us);
    void *tap_user;
    /* The clock of all stamps, microseconds, running time_scale as fast as the host's; NULL: CLOCK_MONOTONIC
     * times time_scale. */
    int64_t (*now_us)(void *user);
    void *now_user;
} ale_urg_config_t;

typedef enum {
    ALE_URG_IDLE,      /* nothing new */
    ALE_URG_SCAN,      /* *scan filled; stamp in host time (monotonic clock of now_us) */
    ALE_URG_SCAN_LOST, /* the device sent a scan that cannot be used; scan->stamp_us is its best known time,
                        * scan->beams 0 */
    ALE_URG_CHANGED    /* state or health changed: see ale_urg_health */
} ale_urg_event_t;

typedef enum {
    ALE_URG_CLOSED,
    ALE_URG_DETECTING,
    ALE_URG_STARTING,
    ALE_URG_STREAMING,
    ALE_URG_POLLING /* SCIP 1.1 firmware that cannot switch: G commands */
} ale_urg_state_t;

typedef struct {
    ale_urg_state_t state;
    char port[128];
    int32_t baud;
    int32_t protocol; /* 0 unknown, 1, 2 */
    char model[64];
    char firmware[64];
    char serial[32];
    char status[128]; /* the STAT line, or the last fault in plain words */
    uint64_t scans;
    uint64_t scans_lost; /* seen on the line and unusable, or missing by their stamps */
    uint64_t bad_checksum;
    uint64_t bad_frame;
    uint64_t repeated; /* replies with a stamp that was there before */
    uint64_t garbage_bytes;
    uint64_t stream_restarts;
    uint64_t resets;
    uint64_t reopens;
    uint64_t hardware_faults;
    uint64_t identity_warnings; /* VV, PP, II lines with wrong sums or shape: tolerated */
    int64_t last_scan_us;
    int64_t arrival_us; /* host time of the last byte of the last scan */
    int64_t clock_offset_us;
    int32_t clock_rate_ppb; /* device clock against host clock */
    int32_t scan_period_us; /* measured */
} ale_urg_health_t;

ale_urg_t *ale_urg_create(const ale_urg_config_t *config); /* NULL: out of memory */
ale_urg_event_t ale_urg_step(ale_urg_t *urg, ale_scan_t *scan);
const ale_urg_health_t *ale_urg_health(const ale_urg_t *urg);
void ale_urg_destroy(ale_urg_t *urg); /* QT, laser off, close */

#endif
