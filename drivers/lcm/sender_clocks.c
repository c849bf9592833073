#include "lcm/sender_clocks.h"

/* The sender's place, or that of who was heard of the longest ago. */
static ale_sender_clock_t *clock_of(ale_sender_clocks_t *clocks, uint64_t sender)
{
    ale_known_sender_t *place = &clocks->known[0];
    for (int k = 0; k < ALE_MOST_SENDERS; k++) {
        ale_known_sender_t *other = &clocks->known[k];
        if (other->clock.started && other->sender == sender) {
            return &other->clock;
        }
        const bool longer = !other->clock.started || other->clock.arrival_us < place->clock.arrival_us;
        place = place->clock.started && longer ? other : place;
    }
    place->sender = sender;
    ale_sender_clock_init(&place->clock, clocks->scale_ppm);
    return &place->clock;
}

bool ale_sender_clocks_take(ale_sender_clocks_t *clocks, uint64_t sender, int64_t stamp_us,
                            int64_t arrival_us, int64_t *time_us)
{
    ale_sender_clock_t *clock = clock_of(clocks, sender);
    const uint32_t steps = clock->steps;
    if (!ale_sender_clock_take(clock, stamp_us, arrival_us, time_us)) {
        clocks->refused++;
        return false;
    }
    if (clock->steps != steps) {
        clocks->steps++;
        clocks->step_us = clock->step_us;
    }
    return true;
}

uint32_t ale_sender_clocks_heard_since(const ale_sender_clocks_t *clocks, int64_t moment_us)
{
    uint32_t heard = 0;
    for (int k = 0; k < ALE_MOST_SENDERS; k++) {
        const ale_sender_clock_t *clock = &clocks->known[k].clock;
        heard += clock->started && clock->arrival_us > moment_us;
    }
    return heard;
}
