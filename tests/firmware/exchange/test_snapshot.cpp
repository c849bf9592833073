#include <gtest/gtest.h>

#include <memory>
#include <thread>

extern "C" {
#include "exchange/snapshot.h"
}

namespace
{

using Snapshot = std::unique_ptr<ale_snapshot_t, decltype(&ale_snapshot_destroy)>;

struct Value {
    uint32_t words[128];
};

Snapshot make()
{
    return {ale_snapshot_create(sizeof(Value)), ale_snapshot_destroy};
}

void publish(ale_snapshot_t *snapshot, uint32_t number)
{
    for (uint32_t &word : static_cast<Value *>(ale_snapshot_back(snapshot))->words) {
        word = number;
    }
    ale_snapshot_publish(snapshot);
}

uint32_t newest(ale_snapshot_t *snapshot, bool *fresh)
{
    return static_cast<const Value *>(ale_snapshot_newest(snapshot, fresh))->words[0];
}

TEST(Snapshot, BeforeTheFirstItIsZeroAndNotFresh)
{
    const Snapshot snapshot = make();
    bool fresh = true;
    EXPECT_EQ(newest(snapshot.get(), &fresh), 0u);
    EXPECT_FALSE(fresh);
}

TEST(Snapshot, TheNewestCountsAndIsFreshOnce)
{
    const Snapshot snapshot = make();
    publish(snapshot.get(), 1);
    publish(snapshot.get(), 2);
    publish(snapshot.get(), 3);
    bool fresh = false;
    EXPECT_EQ(newest(snapshot.get(), &fresh), 3u);
    EXPECT_TRUE(fresh);
    EXPECT_EQ(newest(snapshot.get(), &fresh), 3u);
    EXPECT_FALSE(fresh);
    publish(snapshot.get(), 4);
    EXPECT_EQ(newest(snapshot.get(), &fresh), 4u);
    EXPECT_TRUE(fresh);
}

TEST(Snapshot, TheReadersValueStaysWhileTheWriterGoesOn)
{
    const Snapshot snapshot = make();
    publish(snapshot.get(), 1);
    bool fresh = false;
    const auto *held = static_cast<const Value *>(ale_snapshot_newest(snapshot.get(), &fresh));
    for (uint32_t k = 2; k < 10; k++) {
        publish(snapshot.get(), k);
        EXPECT_EQ(held->words[0], 1u);
        EXPECT_EQ(held->words[127], 1u);
    }
}

TEST(Snapshot, TwoThreadsNeverSeeATornOrAnOlderValue)
{
    constexpr uint32_t kCount = 60000;
    const Snapshot snapshot = make();
    std::thread writer([&] {
        for (uint32_t k = 1; k <= kCount; k++) {
            publish(snapshot.get(), k);
        }
    });
    uint32_t last = 0;
    while (last < kCount) {
        bool fresh = false;
        const auto *value = static_cast<const Value *>(ale_snapshot_newest(snapshot.get(), &fresh));
        for (const uint32_t word : value->words) {
            ASSERT_EQ(word, value->words[0]);
        }
        ASSERT_TRUE(fresh ? value->words[0] > last : value->words[0] == last);
        last = value->words[0];
        if (!fresh) {
            std::this_thread::yield();
        }
    }
    writer.join();
}

} // namespace
