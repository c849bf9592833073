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
    publisher->pieces_parts = 0;
    publisher->next_part = 0;
    publisher->next_ns = 0;
    publisher->next_whole_ns = 0;
}

static int16_t parts_of(const ale_map_publisher_t *publisher)
{
    return (int16_t)(publisher->pieces_parts + ale_map_parts(&publisher->sent));
}

bool ale_map_publisher_is_busy(const ale_map_publisher_t *publisher)
{
    return publisher->begun && publisher->next_part < parts_of(publisher);
}

const ale_map_t *ale_map_publisher_map(const ale_map_publisher_t *publisher)
{
    return publisher->begun ? &publisher->shown : NULL;
}

const ale_tracked_map_t *ale_map_publisher_tracked(ale_map_publisher_t *publisher)
{
    bool fresh = false;
    const ale_tracked_map_t *tracked = ale_snapshot_newest(publisher->exchange->map, &fresh);
    publisher->tracked_is_new = publisher->tracked_is_new || fresh;
    return tracked;
}

/* The map to be shown, when it is another than before. */
static const ale_map_t *another_map(ale_map_publisher_t *publisher, uint32_t epoch)
{
    bool fresh_drawing = false;
    const ale_drawn_map_t *drawing = ale_snapshot_newest(publisher->exchange->drawn_map, &fresh_drawing);
    const ale_map_t *tracked = &ale_map_publisher_tracked(publisher)->map;
    const bool drawn = drawing->epoch != 0 && drawing->epoch == epoch;
    const bool other = drawn != publisher->drawn || (drawn ? fresh_drawing : publisher->tracked_is_new);
    publisher->drawn = drawn;
    publisher->tracked_is_new = false;
    return !other ? NULL : drawn ? &drawing->map : tracked;
}

/* So that no wall of the tracker's has the number of one that was drawn. */
#define OF_TRACKER 0x40000000U

/* The drawing has no wall of the other maps, and the tracker no other of this one. */
static void add_other_maps(ale_map_t *drawing, const ale_map_t *tracked)
{
    const uint32_t drawn_map = drawing->line_count > 0 ? drawing->line[0].map_id : 0;
    for (uint16_t k = 0; k < tracked->line_count && drawing->line_count < ALE_MAP_MAX_LINES; k++) {
        if (tracked->line[k].map_id != drawn_map) {
            ale_map_line_t *line = &drawing->line[drawing->line_count++];
            *line = tracked->line[k];
            line->id |= OF_TRACKER;
        }
    }
}

static void show(ale_map_publisher_t *publisher, const ale_map_t *map)
{
    const uint32_t version = publisher->shown.version + 1;
    publisher->shown = *map;
    publisher->shown.version = version;
    publisher->sent = publisher->shown;
    if (publisher->drawn) {
        add_other_maps(&publisher->sent, &ale_map_publisher_tracked(publisher)->map);
    }
    publisher->pieces_parts = ale_map_pieces_parts(&publisher->sent);
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

/* The pieces first: who has the whole map knows by then which walls are apart. */
static void send_part(ale_map_publisher_t *publisher, int64_t utime)
{
    const int16_t part = publisher->next_part++;
    if (part < publisher->pieces_parts) {
        ale_bus_send_map_pieces(publisher->bus, &publisher->sent, utime, part);
    } else {
        ale_bus_send_map_part(publisher->bus, &publisher->sent, utime,
                              (int16_t)(part - publisher->pieces_parts));
    }
}

static void send_burst(ale_map_publisher_t *publisher)
{
    const ale_clock_t *clock = &publisher->exchange->clock;
    const int64_t utime = ale_clock_to_utime(clock, ale_clock_now_us(clock));
    for (int k = 0; k < PARTS_AT_ONCE && ale_map_publisher_is_busy(publisher); k++) {
        send_part(publisher, utime);
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
