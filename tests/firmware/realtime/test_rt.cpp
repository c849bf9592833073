#include <gtest/gtest.h>

#include <pthread.h>
#include <signal.h>

#include <atomic>
#include <cstring>
#include <memory>
#include <string>
#include <thread>

#include "firmware/realtime/release.hpp"
#include "firmware/surroundings.hpp"

extern "C" {
#include "realtime/rt.h"
}

namespace
{

class Rt : public surroundings::WithPort
{
};

TEST_F(Rt, TheReportNamesWhatIsMissing)
{
    EXPECT_FALSE(port_report.realtime);
    const std::string text = port_report.text;
    EXPECT_NE(text.find("missing: priority (none asked for), locked memory"), std::string::npos) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos);
}

TEST_F(Rt, APriorityThatIsRefusedOrGrantedIsReportedAsSuch)
{
    ale_rt_stop();
    const ale_rt_config_t config = {50, -1, false};
    ASSERT_EQ(ale_rt_start(&config, &port_report), 0);
    struct Policy {
        std::atomic<int> policy{-1};
        static void read(ale_rt_task_t *, void *user)
        {
            int policy = -1;
            sched_param parameter{};
            pthread_getschedparam(pthread_self(), &policy, &parameter);
            static_cast<Policy *>(user)->policy = policy;
        }
    } seen;
    const ale_rt_task_config_t task = {"policy", ALE_RT_HARD, Policy::read, &seen, 0};
    ale_rt_task_join(ale_rt_task_start(&task));
    ale_rt_report(&port_report);
    const std::string text = port_report.text;
    const bool granted = text.find("SCHED_FIFO 50") < text.find("missing");
    EXPECT_EQ(seen.policy, granted ? SCHED_FIFO : SCHED_OTHER) << text;
}

TEST_F(Rt, AWaitEndsAtItsMomentWhenNobodyPosts)
{
    const Release release = make_release();
    const int64_t until = ale_rt_now_ns() + 3000000;
    while (ale_rt_now_ns() < until) {
        EXPECT_FALSE(ale_rt_release_wait(release.get(), until));
    }
    EXPECT_FALSE(ale_rt_release_wait(release.get(), until)) << "a moment that has passed does not block";
}

TEST_F(Rt, PostsBeforeAWaitCountAsOne)
{
    const Release release = make_release();
    ale_rt_release_post(release.get());
    ale_rt_release_post(release.get());
    EXPECT_TRUE(ale_rt_release_wait(release.get(), ale_rt_now_ns() + 1000000000));
    EXPECT_FALSE(ale_rt_release_wait(release.get(), 0));
}

TEST_F(Rt, NoPostIsLostBetweenTwoThreads)
{
    constexpr int kCount = 20000;
    const Release ping = make_release();
    const Release pong = make_release();
    int shared = 0; /* ordered by the releases alone: the thread sanitizer watches */
    std::thread other([&] {
        for (int k = 0; k < kCount; k++) {
            while (!ale_rt_release_wait(ping.get(), ale_rt_now_ns() + 1000000000)) {
            }
            shared++;
            ale_rt_release_post(pong.get());
        }
    });
    for (int k = 0; k < kCount; k++) {
        ale_rt_release_post(ping.get());
        while (!ale_rt_release_wait(pong.get(), ale_rt_now_ns() + 1000000000)) {
        }
        ASSERT_EQ(shared, k + 1);
    }
    other.join();
}

struct Loop {
    ale_rt_release_t *release;
    std::atomic<int> rounds{0};
    std::atomic<bool> signals_blocked{false};
    static void body(ale_rt_task_t *self, void *user)
    {
        auto *loop = static_cast<Loop *>(user);
        sigset_t blocked;
        pthread_sigmask(SIG_SETMASK, nullptr, &blocked);
        loop->signals_blocked = sigismember(&blocked, SIGTERM) == 1 && sigismember(&blocked, SIGUSR1) == 1;
        while (!ale_rt_task_stopping(self)) {
            loop->rounds += ale_rt_release_wait(loop->release, ale_rt_now_ns() + 1000000000);
        }
    }
};

TEST_F(Rt, ATaskRunsUntilItIsStoppedWithAllSignalsBlocked)
{
    const Release release = make_release();
    Loop loop{release.get()};
    for (const ale_rt_kind_t kind : {ALE_RT_HARD, ALE_RT_SOFT, ALE_RT_ORDINARY}) {
        const ale_rt_task_config_t config = {"loop", kind, Loop::body, &loop, 0};
        ale_rt_task_t *task = ale_rt_task_start(&config);
        ASSERT_NE(task, nullptr);
        for (const int before = loop.rounds; loop.rounds == before;) {
            ale_rt_release_post(release.get());
            std::this_thread::yield();
        }
        ale_rt_task_stop(task);
        ale_rt_release_post(release.get());
        ale_rt_task_join(task);
        EXPECT_TRUE(loop.signals_blocked);
    }
    ale_rt_task_join(nullptr);
}

TEST_F(Rt, TimeNeverRunsBackwards)
{
    int64_t last = ale_rt_now_ns();
    for (int k = 0; k < 100000; k++) {
        const int64_t now = ale_rt_now_ns();
        ASSERT_GE(now, last);
        last = now;
    }
}

} // namespace
