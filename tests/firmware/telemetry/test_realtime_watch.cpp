// firmware/telemetry/realtime_watch: what changes of real time after the start is told once.
#include <atomic>
#include <cstdio>

#include <gtest/gtest.h>

#include "comes_true.hpp"
#include "firmware/surroundings.hpp"

extern "C" {
#include "telemetry/realtime_watch.h"
}

namespace
{

std::atomic<int> governor{0};
std::atomic<int> looks{0};

void look(ale_rt_report_t *report)
{
    *report = {};
    report->realtime = governor == 0;
    std::snprintf(report->text, sizeof report->text, "governor %d", governor.load());
    looks++;
}

class RealtimeWatch : public surroundings::WithPort
{
  protected:
    void SetUp() override
    {
        governor = 0;
        looks = 0;
        ASSERT_EQ(ale_realtime_watch_start(&watch, look, 1000000), 0);
    }
    void TearDown() override
    {
        ale_realtime_watch_stop(&watch);
    }
    ale_realtime_watch_t watch = {};
    ale_rt_report_t report = {};
};

TEST_F(RealtimeWatch, what_stays_is_not_told)
{
    ASSERT_TRUE(comes_true([] { return looks > 20; }));
    EXPECT_FALSE(ale_realtime_watch_changed(&watch, &report));
}

TEST_F(RealtimeWatch, a_change_is_told_once_and_so_is_the_way_back)
{
    ASSERT_TRUE(comes_true([] { return looks > 2; }));
    governor = 1;
    ASSERT_TRUE(comes_true([this] { return ale_realtime_watch_changed(&watch, &report); }));
    EXPECT_FALSE(report.realtime);
    EXPECT_STREQ(report.text, "governor 1");
    const int seen = looks;
    ASSERT_TRUE(comes_true([seen] { return looks > seen + 10; }));
    EXPECT_FALSE(ale_realtime_watch_changed(&watch, &report));
    governor = 0;
    ASSERT_TRUE(comes_true([this] { return ale_realtime_watch_changed(&watch, &report); }));
    EXPECT_TRUE(report.realtime);
}

TEST(RealtimeWatchAlone, one_that_was_not_started_has_nothing_to_tell)
{
    ale_realtime_watch_t watch = {};
    ale_rt_report_t report = {};
    EXPECT_FALSE(ale_realtime_watch_changed(&watch, &report));
    ale_realtime_watch_stop(&watch);
}

} // namespace
