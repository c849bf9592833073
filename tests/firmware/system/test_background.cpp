// firmware/background: a thread that waits until it is woken.
#include <gtest/gtest.h>

#include <atomic>

#include "comes_true.hpp"
#include "firmware/surroundings.hpp"

extern "C" {
#include "system/background.h"
}

namespace
{

constexpr int64_t for_ever_ns = 3600LL * 1000000000;

class Background : public surroundings::WithPort
{
  protected:
    // Counts how often its wait has ended.
    static void count(ale_rt_task_t *self, void *user)
    {
        auto *test = static_cast<Background *>(user);
        while (!ale_rt_task_stopping(self)) {
            ale_background_wait(&test->thread, for_ever_ns);
            test->waits++;
        }
    }

    ale_background_t thread{};
    std::atomic<int> waits{0};
};

TEST_F(Background, AWakeEndsTheWait)
{
    ASSERT_EQ(ale_background_start(&thread, "woken", count, this, 0), 0);
    ale_background_wake(&thread);
    EXPECT_TRUE(comes_true([&] { return waits == 1; }));
    ale_background_wake(&thread);
    EXPECT_TRUE(comes_true([&] { return waits == 2; }));
    ale_background_stop(&thread);
}

TEST_F(Background, AStopEndsAWaitOfAnHour)
{
    ASSERT_EQ(ale_background_start(&thread, "stopped", count, this, 0), 0);
    ale_background_stop(&thread);
    EXPECT_LE(waits, 1);
}

TEST_F(Background, OneThatWasNeverStartedOrHasEndedCanBeStopped)
{
    ale_background_stop(&thread);
    ASSERT_EQ(ale_background_start(&thread, "twice", count, this, 0), 0);
    ale_background_stop(&thread);
    ale_background_stop(&thread);
    EXPECT_EQ(thread.task, nullptr);
}

} // namespace
