/* What a laser scanner is told and what it tells, whatever its make. */
#ifndef ALE_SCANNER_SCANNER_TYPES_H
#define ALE_SCANNER_SCANNER_TYPES_H

#include <stdbool.h>
#include <stdint.h>

typedef struct {
    const char *family;  /* name of the family, "urg"; NULL: that one */
    const char *path;    /* device, or NULL: look for `serial` on every candidate port */
    const char *serial;  /* serial number that must match, or NULL: any */
    int32_t baud;        /* bit/s; 0: detect */
    bool reversed;       /* mounted upside down: bearings are negated */
    uint16_t first_step; /* window in the sensor's own numbering, both inclusive; 0, 0: all it measures */
    uint16_t last_step;
    uint8_t cluster;   /* neighbouring beams that are merged into one; 0: none */
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
    int64_t utime_offset_us; /* by which the clock of messages is ahead of now_us */
} ale_scanner_config_t;

typedef enum {
    ALE_SCANNER_IDLE,      /* nothing new */
    ALE_SCANNER_SCAN,      /* *scan filled; stamp in the clock of now_us */
    ALE_SCANNER_SCAN_LOST, /* the sensor sent a scan that cannot be used; scan->stamp_us is its best known
                            * time, scan->beams 0 */
    ALE_SCANNER_CHANGED    /* state or health changed */
} ale_scanner_event_t;

typedef enum {
    ALE_SCANNER_CLOSED,
    ALE_SCANNER_DETECTING,
    ALE_SCANNER_STARTING,
    ALE_SCANNER_STREAMING,
    ALE_SCANNER_POLLING /* the sensor cannot stream: each scan is asked for */
} ale_scanner_state_t;

/* Empty texts: not known. */
typedef struct {
    char model[64];
    char firmware[64];
    char serial[40];
} ale_scanner_identity_t;

typedef struct {
    ale_scanner_state_t state;
    ale_scanner_identity_t identity;
    char port[128];
    int32_t baud;     /* bit/s */
    int32_t protocol; /* version of the protocol spoken; 0: unknown */
    char status[168]; /* what the sensor says of itself, or the last fault, in plain words */
    uint64_t scans;
    uint64_t scans_lost; /* seen on the line and unusable, or missing by their stamps */
    uint64_t bad_checksum;
    uint64_t bad_frame;
    uint64_t repeated;        /* replies with a stamp that was there before */
    uint64_t losses_too_fast; /* damaged frames beyond what it can send: not scans, and not lost */
    uint64_t garbage_bytes;
    uint64_t stream_restarts;
    uint64_t resets;
    uint64_t reopens;
    uint64_t hardware_faults;
    uint64_t identity_warnings; /* lines of identity with wrong sums or shape: tolerated */
    int64_t last_scan_us;       /* stamp of the last scan */
    int64_t arrival_us;         /* host time of the last byte of the last scan */
    int64_t clock_offset_us;    /* sensor's clock to host's, at the last scan */
    int32_t clock_rate_ppb;     /* sensor's clock against host's */
    int32_t scan_period_us;     /* measured */
    int32_t silence_ms;         /* time without a scan after which the sensor counts as silent */
} ale_scanner_health_t;

#endif
