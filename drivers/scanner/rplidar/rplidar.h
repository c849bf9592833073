/* SLAMTEC RPLIDAR A1, A2, A3, C1, S1, S2, S3 over a serial line: its conversation.
 *
 *   STOP -> INFO -> HEALTH -> [RESET] -> [TYPICAL -> TYPE -> SAMPLE | RATES] -> [MOTOR] -> SCAN
 *
 * The scan that the model itself calls typical is taken, where its coding is one of the three that are read:
 * standard, express, dense. Source: SLAMTEC's rplidar_sdk (sl_lidar_driver.cpp). Pure. */
#ifndef ALE_SCANNER_RPLIDAR_RPLIDAR_H
#define ALE_SCANNER_RPLIDAR_RPLIDAR_H

#include <stdbool.h>
#include <stdint.h>

#include "scanner/rplidar/rplidar_parse.h"

typedef enum {
    ALE_RPLIDAR_PHASE_STOP, /* what an earlier client left running */
    ALE_RPLIDAR_PHASE_INFO,
    ALE_RPLIDAR_PHASE_HEALTH,
    ALE_RPLIDAR_PHASE_RESET,   /* after an error, once */
    ALE_RPLIDAR_PHASE_RATES,   /* before firmware 1.24: time of a sample */
    ALE_RPLIDAR_PHASE_TYPICAL, /* since: its usual mode, */
    ALE_RPLIDAR_PHASE_TYPE,    /* that mode's coding, */
    ALE_RPLIDAR_PHASE_SAMPLE,  /* and time of a sample */
    ALE_RPLIDAR_PHASE_MOTOR,
    ALE_RPLIDAR_PHASE_SCAN
} ale_rplidar_phase_t;

enum { ALE_RPLIDAR_ERROR = 2 }; /* of health: it does not scan */

/* Fields are private, but for reading. Begins zeroed. */
typedef struct {
    ale_rplidar_parser_t parser;
    ale_rplidar_phase_t phase;
    bool begun;
    uint32_t tries;
    bool known; /* the following were told */
    uint8_t model;
    uint16_t firmware; /* 0x0118: 1.24 */
    uint8_t hardware;
    uint8_t serial[16];
    uint8_t health; /* 0 fine, 1 warning, 2 error */
    uint16_t error;
    bool was_reset;
    bool gives_up;
    uint64_t faults;
    uint16_t mode;
    uint8_t scan_type;
} ale_rplidar_t;

#endif
