#include "telemetry/map_publisher.h"

#include "exchange/wake.h"

#define WHOLE_MAP_PERIOD_NS 10000000000

enum { PARTS_AT_ONCE = 8 };

void ale_map_publisher_init(ale_map_publisher_t *publisher, ale_exchange_t *exchange, ale_bus_t *bus)
{
    publisher->exchange = exchange;
    publisher->bus = bus;
    publisher->tracked_is_new = false;
    publisher->drawn = false;
    publisher->begun = false;
    publisher->shown.version = 0;
    publisher->next_part = 0;
    publisher->next_ns = 0;
    publisher->next_whole_ns = 0;
}

bool ale_map_publisher_is_busy(const ale_map_publisher_t *publisher)
{
    return publisher->begun && publisher->next_part < ale_map_parts(&publisher->shown);
}

const ale_map_t *ale_map_publisher_map(const ale_map_publisher_t *publisher)
{
    return publisher->begun ? &publisher->shown : NULL;
}

const ale_map_t *ale_map_publisher_tracked(ale_map_publisher_t *publisher)
{
    bool fresh = false;
    const ale_map_t *tracked = ale_snapshot_newest(publisher->exchange->map, &fresh);
    publisher->tracked_is_new = publisher->tracked_is_new || fresh;
    return tracked;
}

/* The map to be shown, when it is another than before. */
static const ale_map_t *another_map(ale_map_publisher_t *publisher, uint32_t epoch)
{
    bool fresh_drawing = false;
    const ale_drawn_map_t *drawing = ale_snapshot_newest(publisher->exchange->drawn_map, &fresh_drawing);
    const ale_map_t *tracked = ale_map_publisher_tracked(publisher);
    const bool drawn = drawing->epoch != 0 && drawing->epoch == epoch;
    const bool other = drawn != publisher->drawn || (drawn ? fresh_drawing : publisher->tracked_is_new);
    publisher->drawn = drawn;
    publisher->tracked_is_new = false;
    return !other ? NULL : drawn ? &drawing->map : tracked;
}

static void show(ale_map_publisher_t *publisher, const ale_map_t *map)
{
    const uint32_t version = publisher->shown.version + 1;
    publisher->shown = *map;
    publisher->shown.version = version;
    publisher->begun = true;
}

/* Another map, or the same again. */
static void begin(ale_map_publisher_t *publisher, uint32_t epoch, int64_t now_ns)
{
    const ale_map_t *other = now_ns >= publisher->next_ns ? another_map(publisher, epoch) : NULL;
    const bool again = publisher->begun && now_ns >= publisher->next_whole_ns;
    if (other) {
        show(publisher, other);
    }
    if (other || again) {
        publisher->next_part = 0;
        publisher->next_ns = now_ns + ALE_MAP_PERIOD_NS;
        publisher->next_whole_ns = now_ns + WHOLE_MAP_PERIOD_NS;
    }
}

static void send_burst(ale_map_publisher_t *publisher)
{
    const ale_clock_t *clock = &publisher->exchange->clock;
    const int64_t utime = ale_clock_to_utime(clock, ale_clock_now_us(clock));
    for (int k = 0; k < PARTS_AT_ONCE && ale_map_publisher_is_busy(publisher); k++) {
        ale_bus_send_map_part(publisher->bus, &publisher->shown, utime, publisher->next_part++);
    }
}

void ale_map_publisher_work(ale_map_publisher_t *publisher, uint32_t epoch, int64_t now_ns)
{
    if (!ale_map_publisher_is_busy(publisher)) {
        begin(publisher, epoch, now_ns);
    }
    send_burst(publisher);
}

static void send_rest(ale_map_publisher_t *publisher)
{
    for (send_burst(publisher); ale_map_publisher_is_busy(publisher); send_burst(publisher)) {
        ale_wake_wait(publisher->exchange->under_way, ALE_MAP_PART_NS);
    }
}

void ale_map_publisher_finish(ale_map_publisher_t *publisher, uint32_t epoch)
{
    send_rest(publisher);
    publisher->next_ns = 0;
    begin(publisher, epoch, ale_rt_now_ns());
    send_rest(publisher);
}
