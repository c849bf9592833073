/* What waits for the disk is done elsewhere, in its order, and what comes of it is handed back. */
#include "operator/console/recordings/errands.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <thread>

using console::Errands;

TEST(Errands, AreDoneInTheirOrderByAnotherThreadAndHandedBack)
{
    std::atomic<int> woken{0};
    Errands errands([&] { woken++; });
    std::vector<int> handed;
    std::atomic<bool> elsewhere{true};
    const auto here = std::this_thread::get_id();
    for (int k = 0; k < 20; k++) {
        ASSERT_TRUE(errands.run([&, k] {
            elsewhere = elsewhere && std::this_thread::get_id() != here;
            return [&, k] { handed.push_back(k); };
        }));
    }
    while (handed.size() < 20) {
        for (const auto &done : errands.done()) {
            done();
        }
    }
    EXPECT_TRUE(elsewhere);
    EXPECT_TRUE(std::is_sorted(handed.begin(), handed.end()));
    EXPECT_TRUE(errands.done().empty()) << "each once";
    EXPECT_LE(woken, 20);
}

TEST(Errands, MoreThanCanWaitAreRefusedAndEndingWaitsForOneAlone)
{
    std::promise<void> gate;
    const std::shared_future<void> open(gate.get_future());
    int done = 0;
    {
        Errands errands([] {});
        size_t taken = 0;
        while (errands.run([&, open] {
            open.wait();
            done++;
            return [] {};
        })) {
            taken++;
            ASSERT_LE(taken, Errands::most_waiting + 1);
        }
        EXPECT_GE(taken, Errands::most_waiting);
        std::thread([&gate] {
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
            gate.set_value();
        }).detach();
    }
    EXPECT_LE(done, 2);
}
