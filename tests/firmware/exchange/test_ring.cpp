#include <gtest/gtest.h>

#include <cstring>
#include <deque>
#include <memory>
#include <random>
#include <thread>

extern "C" {
#include "exchange/ring.h"
}

namespace
{

using Ring = std::unique_ptr<ale_ring_t, decltype(&ale_ring_destroy)>;

Ring make(uint32_t bytes, uint32_t slots)
{
    return {ale_ring_create(bytes, slots), ale_ring_destroy};
}

TEST(Ring, AnEmptyRingHasNothingReady)
{
    const Ring ring = make(8, 4);
    EXPECT_EQ(ale_ring_ready(ring.get()), 0u);
    EXPECT_EQ(ale_ring_refused(ring.get()), 0u);
}

TEST(Ring, AFullRingRefusesTheNewestAndCountsIt)
{
    const Ring ring = make(sizeof(int), 4);
    for (int k = 0; k < 4; k++) {
        *static_cast<int *>(ale_ring_reserve(ring.get())) = k;
        ale_ring_commit(ring.get());
    }
    EXPECT_EQ(ale_ring_reserve(ring.get()), nullptr);
    EXPECT_EQ(ale_ring_reserve(ring.get()), nullptr);
    EXPECT_EQ(ale_ring_refused(ring.get()), 2u);
    EXPECT_EQ(ale_ring_committed(ring.get()), 4u);
    EXPECT_EQ(*static_cast<int *>(ale_ring_at(ring.get(), 0)), 0);
    EXPECT_EQ(*static_cast<int *>(ale_ring_at(ring.get(), 3)), 3);
    ale_ring_release(ring.get());
    EXPECT_NE(ale_ring_reserve(ring.get()), nullptr);
}

TEST(Ring, AReservedSlotIsNotReadyBeforeItIsCommitted)
{
    const Ring ring = make(8, 2);
    void *slot = ale_ring_reserve(ring.get());
    EXPECT_EQ(ale_ring_ready(ring.get()), 0u);
    EXPECT_EQ(ale_ring_reserve(ring.get()), slot) << "asking twice gives the same slot";
    ale_ring_commit(ring.get());
    EXPECT_EQ(ale_ring_ready(ring.get()), 1u);
}

TEST(Ring, ItBehavesLikeAQueueOfBoundedLength)
{
    const Ring ring = make(sizeof(uint32_t), 8);
    std::deque<uint32_t> model;
    std::mt19937 random(1);
    for (uint32_t k = 0; k < 100000; k++) {
        if (random() % 2) {
            auto *slot = static_cast<uint32_t *>(ale_ring_reserve(ring.get()));
            ASSERT_EQ(slot == nullptr, model.size() == 8);
            if (slot) {
                *slot = k;
                ale_ring_commit(ring.get());
                model.push_back(k);
            }
        } else if (!model.empty()) {
            ASSERT_EQ(*static_cast<uint32_t *>(ale_ring_at(ring.get(), 0)), model.front());
            ale_ring_release(ring.get());
            model.pop_front();
        }
        ASSERT_EQ(ale_ring_ready(ring.get()), model.size());
    }
}

/* Under the thread sanitizer this also proves that a slot's content is ordered by the counters alone. */
TEST(Ring, NothingIsTornOrReorderedBetweenTwoThreads)
{
    struct Slot {
        uint32_t words[64];
    };
    constexpr uint32_t kCount = 60000;
    const Ring ring = make(sizeof(Slot), 16);
    std::thread producer([&] {
        for (uint32_t k = 0; k < kCount;) {
            auto *slot = static_cast<Slot *>(ale_ring_reserve(ring.get()));
            if (!slot) {
                std::this_thread::yield();
                continue;
            }
            for (uint32_t &word : slot->words) {
                word = k;
            }
            ale_ring_commit(ring.get());
            k++;
        }
    });
    uint32_t expected = 0;
    uint32_t torn = 0;
    while (expected < kCount) {
        if (ale_ring_ready(ring.get()) == 0) {
            std::this_thread::yield();
            continue;
        }
        const auto *slot = static_cast<const Slot *>(ale_ring_at(ring.get(), 0));
        for (const uint32_t word : slot->words) {
            torn += word != expected;
        }
        ale_ring_release(ring.get());
        expected++;
    }
    producer.join();
    EXPECT_EQ(torn, 0u);
    EXPECT_EQ(ale_ring_committed(ring.get()), kCount);
}

} // namespace
