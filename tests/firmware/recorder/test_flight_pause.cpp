#include <gtest/gtest.h>

extern "C" {
#include "recorder/flight_pause.h"
}

namespace
{

constexpr int64_t kMinute = 60000000000;

/* Recordings of a fault that comes every so often, for some hours; each ends with how many were written. */
int written(ale_flight_pause_t &pause, int64_t &now_ns, int64_t every_ns, int64_t hours)
{
    int count = 0;
    for (const int64_t end_ns = now_ns + hours * 60 * kMinute; now_ns < end_ns; now_ns += every_ns) {
        if (ale_flight_pause_is_over(&pause, now_ns)) {
            ale_flight_pause_begin(&pause, now_ns);
            count++;
        }
    }
    return count;
}

TEST(FlightPause, AFaultThatComesAgainAndAgainIsRecordedEverMoreRarely)
{
    ale_flight_pause_t pause{};
    int64_t now_ns = 1;
    EXPECT_EQ(written(pause, now_ns, kMinute / 6, 1), 6) << "after 1, 2, 4, 8, 16, 32 minutes";
    EXPECT_LE(written(pause, now_ns, kMinute / 6, 23), 24) << "one an hour";
}

TEST(FlightPause, ThreeFaultsInADayAreAllRecorded)
{
    ale_flight_pause_t pause{};
    for (int64_t hour = 1; hour < 24; hour += 8) {
        EXPECT_TRUE(ale_flight_pause_is_over(&pause, hour * 60 * kMinute));
        ale_flight_pause_begin(&pause, hour * 60 * kMinute);
        EXPECT_FALSE(ale_flight_pause_is_over(&pause, hour * 60 * kMinute + kMinute - 1));
        EXPECT_TRUE(ale_flight_pause_is_over(&pause, hour * 60 * kMinute + kMinute));
    }
}

TEST(FlightPause, AnHourWithoutMakesItShortAgain)
{
    ale_flight_pause_t pause{};
    int64_t now_ns = 1;
    written(pause, now_ns, kMinute, 12);
    now_ns = pause.until_ns + 60 * kMinute;
    ale_flight_pause_begin(&pause, now_ns);
    EXPECT_TRUE(ale_flight_pause_is_over(&pause, now_ns + kMinute));
}

} // namespace
