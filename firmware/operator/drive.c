#include "operator/drive.h"

#include <stdlib.h>

#include "base/fixed.h"
#include "exchange/wake.h"
#include "operator/motor_link.h"
#include "plan/safe_speed.h"

struct ale_drive {
    const ale_config_t *config;
    ale_exchange_t *exchange;
    ale_motor_link_t motors;
    int told; /* of the line to the motors, to telemetry */
    ale_rt_task_t *task;
};

/* Along the same arc, as fast as is safe. */
static ale_set_point_t slowed(const ale_velocity_request_t *request, const ale_scan_t *scan,
                              const ale_config_t *config)
{
    const int32_t v_um_s = ale_safe_speed_um_s(scan, &config->pipeline.sensor, &config->robot,
                                               request->v_um_s, request->w_urad_s);
    if (v_um_s == 0) {
        return (ale_set_point_t){.w_urad_s = request->w_urad_s};
    }
    return (ale_set_point_t){.v_um_s = v_um_s,
                             .w_urad_s = (int32_t)ale_mul_div(request->w_urad_s, v_um_s, request->v_um_s)};
}

ale_set_point_t ale_drive_choose(const ale_drive_orders_t *orders, const ale_velocity_request_t *exploration,
                                 const ale_scan_t *scan, const ale_config_t *config, int64_t now_us)
{
    const ale_velocity_request_t *request = NULL;
    if (now_us < orders->operator_request.valid_until_us) {
        request = &orders->operator_request;
    } else if (orders->exploring && now_us < exploration->valid_until_us) {
        request = exploration;
    }
    const bool sees = scan->beams > 0 && now_us - scan->stamp_us <= ALE_DRIVE_SCAN_LIFE_US;
    return request && sees ? slowed(request, scan, config) : (ale_set_point_t){0};
}

int64_t ale_drive_wait_us(const ale_drive_orders_t *orders, const ale_velocity_request_t *exploration,
                          int64_t now_us)
{
    int64_t wait_us = ALE_DRIVE_PERIOD_US;
    const ale_velocity_request_t *const requests[] = {&orders->operator_request, exploration};
    for (int k = 0; k < 2; k++) {
        const int64_t left_us = requests[k]->valid_until_us - now_us;
        wait_us = left_us > 0 ? ale_min64(wait_us, left_us) : wait_us;
    }
    return wait_us;
}

/* now_us: the moment that the set point was chosen for. */
static void publish(ale_drive_t *drive, int64_t now_us, ale_set_point_t set_point)
{
    ale_motor_link_send(&drive->motors, ale_clock_to_utime(&drive->exchange->clock, now_us), set_point.v_um_s,
                        set_point.w_urad_s);
    if (drive->motors.status != drive->told) {
        drive->told = drive->motors.status;
        *(int *)ale_snapshot_back(drive->exchange->motor_line) = drive->told;
        ale_snapshot_publish(drive->exchange->motor_line);
    }
}

static void run(ale_rt_task_t *self, void *user)
{
    ale_drive_t *drive = user;
    ale_exchange_t *exchange = drive->exchange;
    const ale_clock_t *clock = &exchange->clock;
    while (!ale_rt_task_stopping(self)) {
        bool fresh = false;
        const ale_drive_orders_t *orders = ale_snapshot_newest(exchange->drive_orders, &fresh);
        const ale_velocity_request_t *exploration = ale_snapshot_newest(exchange->exploration, &fresh);
        const ale_scan_t *scan = ale_snapshot_newest(exchange->drive_scan, &fresh);
        const int64_t now_us = ale_clock_now_us(clock);
        publish(drive, now_us, ale_drive_choose(orders, exploration, scan, drive->config, now_us));
        const int64_t wait_us = ale_drive_wait_us(orders, exploration, ale_clock_now_us(clock));
        ale_wake_wait(exchange->drive_again, ale_clock_real_ns(clock, wait_us));
    }
    publish(drive, ale_clock_now_us(clock), (ale_set_point_t){0});
}

ale_drive_t *ale_drive_start(const ale_config_t *config, const ale_drive_key_t *key, ale_exchange_t *exchange)
{
    ale_drive_t *drive = calloc(1, sizeof *drive);
    if (!drive) {
        return NULL;
    }
    drive->config = config;
    drive->exchange = exchange;
    const bool linked = ale_motor_link_open(&drive->motors, config, key) == 0;
    if (linked) {
        drive->task = ale_rt_task_start(&(ale_rt_task_config_t){
            .name = "ale-drive", .kind = ALE_RT_ORDINARY, .body = run, .user = drive});
    }
    if (!drive->task) {
        if (linked) {
            ale_motor_link_close(&drive->motors);
        }
        free(drive);
        return NULL;
    }
    return drive;
}

void ale_drive_stop(ale_drive_t *drive)
{
    if (!drive) {
        return;
    }
    ale_rt_task_stop(drive->task);
    ale_wake_post(drive->exchange->drive_again);
    ale_rt_task_join(drive->task);
    ale_motor_link_close(&drive->motors);
    free(drive);
}
