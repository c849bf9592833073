/* The head of an event in an LCM log, as lcm-logger writes them:
 *
 *   event: u32 sync 0xEDA1DA01 | i64 number | i64 received_us | i32 channel length | i32 data length |
 *          channel | data, all big endian
 *
 * Pure functions. */
#ifndef ALE_LCM_EVENT_H
#define ALE_LCM_EVENT_H

#include <stdbool.h>
#include <stdint.h>

enum { ALE_LCM_EVENT_SYNC = 4, ALE_LCM_EVENT_HEAD = 28 };

/* What an event begins with. */
extern const uint8_t ale_lcm_event_sync[ALE_LCM_EVENT_SYNC];

typedef struct {
    int64_t number;
    int64_t received_us;
    uint32_t channel_bytes; /* 1..1000 where it was read: liblcm's own limit is 63 */
    uint32_t data_bytes;    /* below 2^31 where it was read */
} ale_lcm_event_t;

/* False: no event begins there. */
bool ale_lcm_event_read(const uint8_t head[ALE_LCM_EVENT_HEAD], ale_lcm_event_t *event);

void ale_lcm_event_write(const ale_lcm_event_t *event, uint8_t head[ALE_LCM_EVENT_HEAD]);

#endif
