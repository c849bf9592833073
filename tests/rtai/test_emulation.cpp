/* The emulation keeps what is odd about RTAI: a test over it would lie otherwise. */
#include <gtest/gtest.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <string>
#include <thread>

extern "C" {
#include "rtai/emulation.h"
#include "rtai/include/rtai_mbx.h"
#include "rtai/include/rtai_serial.h"
}

namespace
{

constexpr RTIME kMillisecond = 1000000;

class Emulation : public testing::Test
{
  protected:
    void SetUp() override
    {
        rtai_emulated_timer(true);
        task = rt_task_init_schmod(nam2num("MAIN"), 10, 0, 0, SCHED_OTHER, 0);
        ASSERT_NE(task, nullptr);
    }
    void TearDown() override
    {
        rt_task_delete(task);
    }
    RT_TASK *task = nullptr;
};

TEST_F(Emulation, NamesAreOfSixLettersWithoutCaseAndOfAllKindsTogether)
{
    EXPECT_EQ(nam2num("alpha"), nam2num("ALPHA"));
    EXPECT_EQ(nam2num("ABCDEFG"), nam2num("ABCDEF"));
    EXPECT_EQ(rt_get_adr(nam2num("MAIN")), task);
    EXPECT_EQ(rt_typed_mbx_init(nam2num("MAIN"), 64, FIFO_Q), nullptr) << "the name is a task's";
    SEM *semaphore = rt_typed_sem_init(nam2num("SEM"), 0, BIN_SEM);
    ASSERT_NE(semaphore, nullptr);
    EXPECT_EQ(rt_typed_sem_init(nam2num("SEM"), 0, BIN_SEM), nullptr);
    EXPECT_EQ(rt_sem_delete(semaphore), 0);
    EXPECT_EQ(rt_get_adr(nam2num("SEM")), nullptr);
    EXPECT_NE(rt_get_name(nullptr), rt_get_name(nullptr));
}

TEST_F(Emulation, ASecondInitialisationGivesTheFirstTask)
{
    EXPECT_EQ(rt_task_init(nam2num("OTHER"), 1, 0, 0), task);
    EXPECT_EQ(rt_buddy(), task);
}

TEST_F(Emulation, ATaskCanDeleteOnlyItself)
{
    int result = 0;
    std::thread([&] { result = rt_task_delete(task); }).join();
    EXPECT_EQ(result, -EPERM);
}

TEST_F(Emulation, CountsAreNotNanosecondsAndItsTimeIsNotLinuxs)
{
    EXPECT_EQ(nano2count(1000), 2400);
    EXPECT_EQ(count2nano(2400), 1000);
    EXPECT_EQ(nano2count(1), 2) << "cut off";
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    EXPECT_GT(rt_get_time_ns(), (now.tv_sec + 500) * 1000000000LL);
}

TEST_F(Emulation, MakePeriodicComesBackAtTheFirstReleaseAndNotBefore)
{
    const RTIME start = rt_get_time() + nano2count(20 * kMillisecond);
    ASSERT_EQ(rt_task_make_periodic(task, start, nano2count(kMillisecond)), 0);
    EXPECT_GE(rt_get_time(), start);
    EXPECT_EQ(rt_task_make_periodic(task, start, 0), -EINVAL);
}

TEST_F(Emulation, WaitPeriodCatchesUpOnePeriodACall)
{
    const RTIME period = nano2count(50 * kMillisecond);
    const RTIME start = rt_get_time();
    ASSERT_EQ(rt_task_make_periodic(task, start, period), 0);
    rt_sleep(3 * period + period / 2);
    int overruns = 0;
    while (rt_task_wait_period() == RTE_TMROVRN) {
        overruns++;
    }
    EXPECT_GE(overruns, 3) << "three releases had passed";
    EXPECT_GE(rt_get_time(), start + (overruns + 1) * period) << "and it is on its grid again";
}

TEST_F(Emulation, TheModeIsMinusOneWhileASignalPutsItOff)
{
    EXPECT_EQ(rt_is_hard_real_time(task), 0);
    rtai_emulated_signal();
    rt_make_hard_real_time();
    const int first = rt_is_hard_real_time(task);
    const int second = rt_is_hard_real_time(nullptr);
    rt_make_soft_real_time();
    EXPECT_EQ(first, -1);
    EXPECT_EQ(second, 1) << "the call before took it back";
}

TEST_F(Emulation, ASemaphoreThatHadToBeWaitedForGivesZeroAndOneThatHadNotGivesItsCount)
{
    SEM *semaphore = rt_typed_sem_init(nam2num("SEM"), 0, BIN_SEM | FIFO_Q);
    rt_sem_signal(semaphore);
    rt_sem_signal(semaphore);
    EXPECT_EQ(rt_sem_wait_timed(semaphore, nano2count(1000 * kMillisecond)), 1);
    EXPECT_EQ(rt_sem_wait_if(semaphore), 0) << "a binary one keeps one signal";
    EXPECT_EQ(rt_sem_wait_timed(semaphore, nano2count(kMillisecond)), RTE_TIMOUT);
    std::thread other([&] {
        while (rt_sem_wait_if(semaphore) >= 0) { /* until somebody waits */
            std::this_thread::yield();
        }
        rt_sem_signal(semaphore);
    });
    EXPECT_EQ(rt_sem_wait(semaphore), 0);
    other.join();
    rt_sem_delete(semaphore);
    EXPECT_EQ(rt_sem_wait(semaphore), RTE_OBJINV);
}

TEST_F(Emulation, AMailboxGivesBackTheBytesItDidNotTakeAndKnowsNoMessages)
{
    MBX *mailbox = rt_typed_mbx_init(nam2num("BOX"), 10, FIFO_Q);
    char text[] = "abcdefgh";
    EXPECT_EQ(rt_mbx_send_if(mailbox, text, 8), 0);
    EXPECT_EQ(rt_mbx_send_if(mailbox, text, 8), 8) << "all or nothing";
    EXPECT_EQ(rt_mbx_send_wp(mailbox, text, 8), 6) << "as much as fits";
    char got[11] = {};
    EXPECT_EQ(rt_mbx_receive_if(mailbox, got, 11), 11);
    EXPECT_EQ(rt_mbx_receive_wp(mailbox, got, 11), 1);
    EXPECT_STREQ(got, "abcdefghab");
    rt_mbx_delete(mailbox);
}

TEST_F(Emulation, TheSerialDriverKnowsItsRatesAndItsPorts)
{
    EXPECT_EQ(rt_spopen(0, 250000, 8, 1, RT_SP_PARITY_NONE, 0, 0), -EINVAL);
    EXPECT_EQ(rt_spopen(7, 115200, 8, 1, RT_SP_PARITY_NONE, 0, 0), -ENODEV);
    EXPECT_EQ(rt_spget_rxavbs(0), -ENODEV);
}

using EmulationDeathTest = Emulation;

TEST_F(EmulationDeathTest, AHandleIsNothingThatCanBeLookedInto)
{
    EXPECT_DEATH(std::memset(static_cast<void *>(task), 0, 1), "");
}

TEST_F(EmulationDeathTest, AWaitWithoutTheTimerNeverEnds)
{
    rtai_emulated_timer(false);
    EXPECT_DEATH(rt_sleep(1000), "timer does not run");
}

} // namespace
