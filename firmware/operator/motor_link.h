/* The ways to the motor controller: ALE_DRIVE for whoever looks, ALE_DRIVE_KEYED for a controller that shares
 * a key with the robot, and a serial line that no bus reaches (drivers/motor). For the drive thread. */
#ifndef ALE_FIRMWARE_OPERATOR_MOTOR_LINK_H
#define ALE_FIRMWARE_OPERATOR_MOTOR_LINK_H

#include <stdbool.h>
#include <stdint.h>

#include "command/keys.h"
#include "config/config.h"
#include "lcm/bus.h"
#include "serial/port.h"

typedef struct {
    ale_bus_t *bus;
    const ale_drive_key_t *key; /* NULL: none is shared */
    int64_t boot;
    int64_t nonce;    /* of the motor side; 0: not heard of yet */
    int64_t messages; /* that were tagged so far */
    uint32_t lines;   /* that were written so far: each way counts its own, by one */
    const char *path; /* of the serial line; empty: none */
    int32_t baud;
    ale_port_t *port;
    int64_t next_try_ns;
    uint32_t taken; /* lines in a row that the port took */
    int status;     /* of the line, as ale_port_strerror knows it; ALE_PORT_OK also where there is none */
} ale_motor_link_t;

/* Joins the bus and opens the line. A line that cannot be opened is tried again every second. key NULL: none;
 * key and config must outlive the link. 0, or -1: no bus. */
int ale_motor_link_open(ale_motor_link_t *link, const ale_config_t *config, const ale_drive_key_t *key);

/* A set point, by all ways. A line that takes no bytes for 5 ms is closed; its status is fine again when it
 * has taken a second's lines. */
void ale_motor_link_send(ale_motor_link_t *link, int64_t utime, int32_t v_um_s, int32_t w_urad_s);

/* After ale_motor_link_open only. */
void ale_motor_link_close(ale_motor_link_t *link);

#endif
