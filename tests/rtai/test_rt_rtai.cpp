/* The real-time port over RTAI, on the emulation. */
#include <gtest/gtest.h>

#include <fcntl.h>
#include <pthread.h>
#include <stdlib.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "firmware/realtime/release.hpp"

extern "C" {
#include "realtime/rt.h"
#include "rtai/emulation.h"
#include "rtai/include/rtai_lxrt.h"
#include "serial/port.h"
}

namespace
{

constexpr int64_t kSecond = 1000000000;

cpu_set_t all_cpus()
{
    cpu_set_t cpus;
    sched_getaffinity(0, sizeof cpus, &cpus);
    return cpus;
}

const cpu_set_t kCpus = all_cpus(); /* of the program, before the first test */

class RtRtai : public testing::Test
{
  protected:
    void SetUp() override
    {
        rtai_emulated_timer(false);
        start();
    }
    void TearDown() override
    {
        ale_rt_stop();
    }
    void start(int cpu = -1, int priority = 80)
    {
        const ale_rt_config_t config = {priority, cpu, false};
        ASSERT_EQ(ale_rt_start(&config, &report), 0) << report.text;
    }
    void restart(int cpu, int priority = 80)
    {
        ale_rt_stop();
        start(cpu, priority);
    }
    std::string said()
    {
        ale_rt_report(&report);
        return report.text;
    }
    ale_rt_report_t report{};
};

template <typename Work> struct Job {
    Work work;
    static void body(ale_rt_task_t *self, void *user)
    {
        static_cast<Job *>(user)->work(self);
    }
};

template <typename Work> void run(ale_rt_kind_t kind, Work work)
{
    Job<Work> job{work};
    const ale_rt_task_config_t config = {"job", kind, Job<Work>::body, &job, 0};
    ale_rt_task_t *task = ale_rt_task_start(&config);
    ASSERT_NE(task, nullptr);
    ale_rt_task_join(task);
}

TEST_F(RtRtai, WithoutRtaiItSaysSoInOneLineAndDoesNotStart)
{
    rtai_emulated_absent(true);
    const ale_rt_config_t config = {80, -1, false};
    ale_rt_report_t refused{};
    EXPECT_EQ(ale_rt_start(&config, &refused), -1);
    EXPECT_NE(std::string(refused.text).find("no RTAI"), std::string::npos);
    EXPECT_EQ(std::string(refused.text).find('\n'), std::string::npos);
    rtai_emulated_absent(false);
    start();
}

TEST_F(RtRtai, TheTimerIsStartedOnceAndStoppedOnlyByWhoStartedIt)
{
    EXPECT_TRUE(rt_is_hard_timer_running());
    ale_rt_stop();
    EXPECT_FALSE(rt_is_hard_timer_running());
    rtai_emulated_timer(true); /* another program's */
    start();
    ale_rt_stop();
    EXPECT_TRUE(rt_is_hard_timer_running());
    start();
}

TEST_F(RtRtai, EachKindOfTaskIsWhatItIsCalled)
{
    std::atomic<int> hard{0};
    std::atomic<int> soft{1};
    std::atomic<bool> known{true};
    run(ALE_RT_HARD, [&](ale_rt_task_t *) { hard = rt_is_hard_real_time(nullptr); });
    run(ALE_RT_SOFT, [&](ale_rt_task_t *) { soft = rt_buddy() ? rt_is_hard_real_time(nullptr) : -5; });
    run(ALE_RT_ORDINARY, [&](ale_rt_task_t *) { known = rt_buddy() != nullptr; });
    EXPECT_EQ(hard, 1);
    EXPECT_EQ(soft, 0);
    EXPECT_FALSE(known);
    EXPECT_NE(said().find("RTAI hard task"), std::string::npos);
}

TEST_F(RtRtai, WithoutAPriorityTheTaskStaysSoftAndTheReportSaysSo)
{
    restart(-1, 0);
    std::atomic<int> hard{5};
    run(ALE_RT_HARD, [&](ale_rt_task_t *) { hard = rt_is_hard_real_time(nullptr); });
    EXPECT_EQ(hard, 0);
    EXPECT_NE(said().find("missing: RTAI hard task"), std::string::npos) << report.text;
}

TEST_F(RtRtai, TheHardTaskHasItsProcessorAndOrdinaryThreadsKeepAllOfThem)
{
    const int cpu = sched_getcpu();
    ale_rt_stop();
    sched_setaffinity(0, sizeof kCpus, &kCpus); /* as before RTAI bound this thread to one */
    start(cpu);
    std::atomic<int> on{-1};
    std::atomic<int> count{0};
    run(ALE_RT_HARD, [&](ale_rt_task_t *) {
        rt_make_soft_real_time();
        cpu_set_t own;
        sched_getaffinity(0, sizeof own, &own);
        on = CPU_COUNT(&own) == 1 && CPU_ISSET(static_cast<size_t>(cpu), &own) ? cpu : -1;
    });
    run(ALE_RT_ORDINARY, [&](ale_rt_task_t *) {
        cpu_set_t own;
        sched_getaffinity(0, sizeof own, &own);
        count = CPU_COUNT(&own);
    });
    EXPECT_EQ(on, cpu);
    EXPECT_EQ(count, CPU_COUNT(&kCpus));
}

TEST_F(RtRtai, APostEndsAWaitThatBlocksAndOneThatComesLater)
{
    const Release release = make_release();
    std::atomic<int> rounds{0};
    Job<std::function<void(ale_rt_task_t *)>> loop{[&](ale_rt_task_t *self) {
        while (!ale_rt_task_stopping(self)) {
            rounds += ale_rt_release_wait(release.get(), ale_rt_now_ns() + 10 * kSecond);
        }
    }};
    const ale_rt_task_config_t config = {"loop", ALE_RT_HARD, decltype(loop)::body, &loop, 0};
    ale_rt_task_t *task = ale_rt_task_start(&config);
    ASSERT_NE(task, nullptr);
    for (int k = 0; k < 1000; k++) {
        ale_rt_release_post(release.get());
        while (rounds == k) {
            std::this_thread::yield();
        }
    }
    ale_rt_task_stop(task);
    ale_rt_release_post(release.get());
    ale_rt_task_join(task);
    EXPECT_EQ(rounds, 1001);
}

TEST_F(RtRtai, AWaitEndsAtItsMomentAndAMomentThatHasPassedDoesNotBlock)
{
    const Release release = make_release();
    const int64_t until = ale_rt_now_ns() + 3000000;
    EXPECT_FALSE(ale_rt_release_wait(release.get(), until));
    EXPECT_GE(ale_rt_now_ns(), until);
    EXPECT_FALSE(ale_rt_release_wait(release.get(), until));
    ale_rt_release_post(release.get());
    ale_rt_release_post(release.get());
    EXPECT_TRUE(ale_rt_release_wait(release.get(), until));
    EXPECT_FALSE(ale_rt_release_wait(release.get(), 0)) << "posts before a wait count as one";
}

TEST_F(RtRtai, ATaskThatRtaiRefusesIsNotStarted)
{
    rtai_emulated_refuse();
    const ale_rt_task_config_t config = {"refused", ALE_RT_HARD, [](ale_rt_task_t *, void *) {}, nullptr, 0};
    EXPECT_EQ(ale_rt_task_start(&config), nullptr);
}

TEST_F(RtRtai, WhatRtaiCountedAsLeftToLinuxSinceTheStartIsReported)
{
    rtai_emulated_forced(2, 5);
    restart(-1);
    EXPECT_EQ(said().find("left to Linux"), std::string::npos) << report.text;
    rtai_emulated_forced(2, 8);
    EXPECT_NE(said().find("hard tasks left to Linux 3 times"), std::string::npos) << report.text;
    EXPECT_FALSE(report.realtime);
    rtai_emulated_forced(0, 0);
}

TEST_F(RtRtai, ItsSerialDriverIsAPortLikeAnyOther)
{
    const int far_end = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
    ASSERT_GE(far_end, 0);
    ASSERT_EQ(grantpt(far_end) | unlockpt(far_end), 0);
    setenv("ALE_RTAI_TTY1", ptsname(far_end), 1);
    ale_port_t *port = nullptr;
    EXPECT_EQ(ale_port_open(&port, "rtai:9", 115200), ALE_PORT_ABSENT);
    EXPECT_EQ(ale_port_open(&port, "rtai:1x", 115200), ALE_PORT_ABSENT);
    EXPECT_EQ(ale_port_open(&port, "rtai:1", 750000), ALE_PORT_BAUD);
    ASSERT_EQ(ale_port_open(&port, "rtai:1", 115200), ALE_PORT_OK);
    ale_port_t *second = nullptr;
    EXPECT_EQ(ale_port_open(&second, "rtai:1", 115200), ALE_PORT_BUSY);
    EXPECT_TRUE(ale_port_has_baud(port));
    EXPECT_EQ(ale_port_wait(port, 5), 0) << "nothing there";
    const std::array<uint8_t, 3> sent = {'V', 'V', '\n'};
    EXPECT_EQ(ale_port_write(port, sent.data(), sent.size(), 100), ALE_PORT_OK);
    std::array<uint8_t, 8> got{};
    EXPECT_EQ(read(far_end, got.data(), got.size()), 3);
    EXPECT_EQ(write(far_end, "0\n", 2), 2);
    EXPECT_EQ(ale_port_wait(port, 1000), 1);
    EXPECT_EQ(ale_port_read(port, got.data(), got.size()), 2);
    EXPECT_EQ(ale_port_set_baud(port, 19200), ALE_PORT_OK);
    ale_port_close(port);
    close(far_end);
}

/* The faults that the emulation must find in a hard task. */
using RtRtaiDeathTest = RtRtai;

TEST_F(RtRtaiDeathTest, AHardTaskThatAllocatesIsFound)
{
    EXPECT_DEATH(run(ALE_RT_HARD, [](ale_rt_task_t *) { free(malloc(10)); }), "allocates");
}

TEST_F(RtRtaiDeathTest, AHardTaskThatTakesALockIsFound)
{
    static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
    EXPECT_DEATH(run(ALE_RT_HARD, [](ale_rt_task_t *) { pthread_mutex_lock(&mutex); }), "takes a lock");
}

TEST_F(RtRtaiDeathTest, AHardTaskThatMakesASystemCallIsFound)
{
    EXPECT_DEATH(run(ALE_RT_HARD, [](ale_rt_task_t *) { getppid(); }), "makes the system call");
}

TEST_F(RtRtaiDeathTest, AHardTaskThatAsksLinuxForTheTimeIsFound)
{
    EXPECT_DEATH(run(ALE_RT_HARD,
                     [](ale_rt_task_t *) {
                         timespec now{};
                         clock_gettime(CLOCK_MONOTONIC, &now);
                     }),
                 "asks Linux for the time");
}

TEST_F(RtRtaiDeathTest, ASoftTaskMayDoAllOfThat)
{
    run(ALE_RT_SOFT, [](ale_rt_task_t *) {
        free(malloc(10));
        timespec now{};
        clock_gettime(CLOCK_MONOTONIC, &now);
        getppid();
    });
}

} // namespace
