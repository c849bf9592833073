// drivers/lcm/event: the head of an event of a log, byte by byte, and which heads are none.
#include <array>
#include <climits>
#include <cstdint>

#include <gtest/gtest.h>

extern "C" {
#include "lcm/event.h"
}

namespace
{

using Head = std::array<uint8_t, ALE_LCM_EVENT_HEAD>;

Head written(uint32_t channel_bytes, uint32_t data_bytes)
{
    const ale_lcm_event_t event = {0x0102030405060708, -2, channel_bytes, data_bytes};
    Head head{};
    ale_lcm_event_write(&event, head.data());
    return head;
}

bool is_event(const Head &head)
{
    ale_lcm_event_t event;
    return ale_lcm_event_read(head.data(), &event);
}

TEST(Event, IsWrittenBigEndian)
{
    EXPECT_EQ(written(8, 0x01020304), (Head{0xED, 0xA1, 0xDA, 0x01, 1,    2,    3, 4, 5, 6, 7, 8, 0xFF, 0xFF,
                                            0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFE, 0, 0, 0, 8, 1, 2, 3,    4}));
}

TEST(Event, IsReadAsItWasWritten)
{
    ale_lcm_event_t event;
    ASSERT_TRUE(ale_lcm_event_read(written(1000, INT_MAX).data(), &event));
    EXPECT_EQ(event.number, 0x0102030405060708);
    EXPECT_EQ(event.received_us, -2);
    EXPECT_EQ(event.channel_bytes, 1000U);
    EXPECT_EQ(event.data_bytes, static_cast<uint32_t>(INT_MAX));
}

TEST(Event, OfImpossibleLengthsIsNone)
{
    EXPECT_TRUE(is_event(written(1, 0)));
    EXPECT_FALSE(is_event(written(0, 0)));
    EXPECT_FALSE(is_event(written(1001, 0)));
    EXPECT_FALSE(is_event(written(8, 0x80000000U)));
}

TEST(Event, BeginsWithItsSyncWord)
{
    for (size_t k = 0; k < ALE_LCM_EVENT_SYNC; k++) {
        Head head = written(8, 8);
        head[k] ^= 1;
        EXPECT_FALSE(is_event(head));
    }
}

} // namespace
