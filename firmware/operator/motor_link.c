#include "operator/motor_link.h"

#include <sys/random.h>

#include "motor/set_point.h"
#include "realtime/rt.h"

#define TRY_PERIOD_NS 1000000000

enum { LINE_TIMEOUT_MS = 5, STEADY_LINES = 25 };

static void take_ready(void *user, const uint8_t *bytes, size_t count)
{
    ale_motor_link_t *link = user;
    ale_set_point_ready(bytes, count, link->key, link->boot, &link->nonce);
}

static int open_line(ale_motor_link_t *link)
{
    const int status = ale_port_open(&link->port, link->path, link->baud);
    link->next_try_ns = ale_rt_now_ns() + TRY_PERIOD_NS;
    link->taken = 0;
    link->status = status != ALE_PORT_OK ? status : link->status;
    return status;
}

int ale_motor_link_open(ale_motor_link_t *link, const ale_config_t *config, const ale_drive_key_t *key)
{
    char error[ALE_BUS_ERROR];
    *link = (ale_motor_link_t){.key = key, .path = config->drive_port, .baud = config->drive_baud};
    link->bus = ale_bus_open_early(config->lcm_url, config->lcm_prefix, error);
    if (!link->bus) {
        return -1;
    }
    if (key && (getrandom(&link->boot, sizeof link->boot, 0) != (ssize_t)sizeof link->boot ||
                ale_bus_on_ready(link->bus, take_ready, link) < 0)) {
        ale_motor_link_close(link);
        return -1;
    }
    if (link->path[0] != '\0') {
        (void)open_line(link); /* tried again */
    }
    return 0;
}

static void send_keyed(ale_motor_link_t *link, int64_t utime, int32_t v_um_s, int32_t w_urad_s)
{
    uint8_t bytes[ALE_MOTOR_MESSAGE];
    const ale_keyed_set_point_t point = {.utime = utime,
                                         .boot = link->boot,
                                         .nonce = link->nonce,
                                         .counter = ++link->messages,
                                         .v_um_s = v_um_s,
                                         .w_urad_s = w_urad_s};
    ale_set_point_message(&point, link->key, bytes);
    ale_bus_send_keyed_drive(link->bus, bytes, sizeof bytes);
}

static void send_line(ale_motor_link_t *link, int32_t v_um_s, int32_t w_urad_s)
{
    if (!link->port && (ale_rt_now_ns() < link->next_try_ns || open_line(link) != ALE_PORT_OK)) {
        return;
    }
    char line[ALE_SET_POINT_LINE];
    const size_t length = ale_set_point_line(++link->lines, v_um_s, w_urad_s, line);
    const int status = ale_port_write(link->port, (const uint8_t *)line, length, LINE_TIMEOUT_MS);
    if (status != ALE_PORT_OK) {
        ale_port_close(link->port);
        link->port = NULL;
        link->status = status;
    } else if (++link->taken >= STEADY_LINES) {
        link->status = ALE_PORT_OK;
    }
}

void ale_motor_link_send(ale_motor_link_t *link, int64_t utime, int32_t v_um_s, int32_t w_urad_s)
{
    if (link->path[0] != '\0') {
        send_line(link, v_um_s, w_urad_s);
    }
    if (link->key) {
        ale_bus_receive(link->bus, 0);
        send_keyed(link, utime, v_um_s, w_urad_s);
    }
    ale_bus_send_drive(link->bus, utime, v_um_s, w_urad_s);
}

void ale_motor_link_close(ale_motor_link_t *link)
{
    ale_port_close(link->port);
    ale_bus_close(link->bus);
}
