#include "recorder/flight_pause.h"

#include "base/fixed.h"

bool ale_flight_pause_is_over(const ale_flight_pause_t *pause, int64_t now_ns)
{
    return now_ns >= pause->until_ns;
}

void ale_flight_pause_begin(ale_flight_pause_t *pause, int64_t now_ns)
{
    const bool calm = pause->next_ns == 0 || now_ns - pause->until_ns >= ALE_FLIGHT_LONGEST_PAUSE_NS;
    const int64_t length_ns = calm ? ALE_FLIGHT_PAUSE_NS : pause->next_ns;
    pause->until_ns = now_ns + length_ns;
    pause->next_ns = ale_min64(2 * length_ns, ALE_FLIGHT_LONGEST_PAUSE_NS);
}
