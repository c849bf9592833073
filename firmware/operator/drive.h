/* The drive thread: the only one that publishes ALE_DRIVE, 25 times a second and at once when something
 * changes.
 *
 *   stop  >  operator (300 ms dead-man)  >  exploration  >  stand still
 *                    └── slowed down to what can be stopped before anything the scanner sees ──► ALE_DRIVE
 *
 * Without a scan of the last half second nothing moves. Where no way is left ahead the robot may still turn
 * in place. */
#ifndef ALE_FIRMWARE_OPERATOR_DRIVE_H
#define ALE_FIRMWARE_OPERATOR_DRIVE_H

#include "base/scan.h"
#include "command/keys.h"
#include "config/config.h"
#include "exchange/exchange.h"

enum { ALE_DRIVE_PERIOD_US = 40000, ALE_DRIVE_SCAN_LIFE_US = 500000 };

typedef struct {
    int32_t v_um_s;
    int32_t w_urad_s;
} ale_set_point_t;

/* What the motors are told at now_us. Pure. scan: the newest; its stamp is of the clock inside. */
ale_set_point_t ale_drive_choose(const ale_drive_orders_t *orders, const ale_velocity_request_t *exploration,
                                 const ale_scan_t *scan, const ale_config_t *config, int64_t now_us);

/* How long to wait at now_us for the next turn: a period, or less where a request runs out before. 1 us at
 * the least. Pure. */
int64_t ale_drive_wait_us(const ale_drive_orders_t *orders, const ale_velocity_request_t *exploration,
                          int64_t now_us);

typedef struct ale_drive ale_drive_t;

/* Starts the thread with ways of its own to the motors (motor_link.h). key: shared with the motor controller;
 * NULL: none. NULL: no memory, threads or bus. config, key and exchange must outlive it. */
ale_drive_t *ale_drive_start(const ale_config_t *config, const ale_drive_key_t *key,
                             ale_exchange_t *exchange);

/* Publishes that the robot stands still, then stops. NULL: nothing. */
void ale_drive_stop(ale_drive_t *drive);

#endif
