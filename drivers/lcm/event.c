#include "lcm/event.h"

#include <endian.h>
#include <string.h>

enum { NUMBER_AT = 4, RECEIVED_AT = 12, CHANNEL_LENGTH_AT = 20, DATA_LENGTH_AT = 24, MOST_CHANNEL = 1000 };

const uint8_t ale_lcm_event_sync[ALE_LCM_EVENT_SYNC] = {0xED, 0xA1, 0xDA, 0x01};

static uint32_t get32(const uint8_t *at)
{
    uint32_t value;
    memcpy(&value, at, sizeof value);
    return be32toh(value);
}

static int64_t get64(const uint8_t *at)
{
    uint64_t value;
    memcpy(&value, at, sizeof value);
    return (int64_t)be64toh(value);
}

static void put32(uint8_t *at, uint32_t value)
{
    value = htobe32(value);
    memcpy(at, &value, sizeof value);
}

static void put64(uint8_t *at, int64_t value)
{
    const uint64_t turned = htobe64((uint64_t)value);
    memcpy(at, &turned, sizeof turned);
}

bool ale_lcm_event_read(const uint8_t head[ALE_LCM_EVENT_HEAD], ale_lcm_event_t *event)
{
    event->number = get64(head + NUMBER_AT);
    event->received_us = get64(head + RECEIVED_AT);
    event->channel_bytes = get32(head + CHANNEL_LENGTH_AT);
    event->data_bytes = get32(head + DATA_LENGTH_AT);
    return memcmp(head, ale_lcm_event_sync, sizeof ale_lcm_event_sync) == 0 && event->channel_bytes >= 1 &&
           event->channel_bytes <= MOST_CHANNEL && event->data_bytes <= INT32_MAX;
}

void ale_lcm_event_write(const ale_lcm_event_t *event, uint8_t head[ALE_LCM_EVENT_HEAD])
{
    memcpy(head, ale_lcm_event_sync, sizeof ale_lcm_event_sync);
    put64(head + NUMBER_AT, event->number);
    put64(head + RECEIVED_AT, event->received_us);
    put32(head + CHANNEL_LENGTH_AT, event->channel_bytes);
    put32(head + DATA_LENGTH_AT, event->data_bytes);
}
