// firmware/graph_publisher: when the pose graph goes out.
#include <gtest/gtest.h>

#include "firmware/surroundings.hpp"

extern "C" {
#include "telemetry/graph_publisher.h"
}

namespace
{

constexpr int64_t second_ns = 1000000000;

/* On a bus in memory. */
class GraphPublisher : public surroundings::WithExchange
{
  protected:
    void SetUp() override
    {
        char error[ALE_BUS_ERROR] = "";
        bus = ale_bus_open("memq://", error);
        ASSERT_NE(bus, nullptr) << error;
        publisher.exchange = &exchange;
        publisher.bus = bus;
    }
    void TearDown() override
    {
        ale_bus_close(bus);
    }
    void change()
    {
        static_cast<ale_mapper_graph_t *>(ale_snapshot_back(exchange.graph))->keyframes++;
        ale_snapshot_publish(exchange.graph);
    }
    /* Works once at that time. Whether something was sent. */
    bool sends_at(int64_t now_ns)
    {
        const int64_t before = publisher.next_again_ns;
        ale_graph_publisher_work(&publisher, now_ns);
        return publisher.next_again_ns != before;
    }

    ale_bus_t *bus = nullptr;
    ale_graph_publisher_t publisher{};
};

TEST_F(GraphPublisher, NothingBeforeThereIsAGraph)
{
    EXPECT_FALSE(sends_at(second_ns));
    EXPECT_FALSE(sends_at(100 * second_ns));
    ale_graph_publisher_finish(&publisher);
    EXPECT_EQ(publisher.version, 0U);
}

TEST_F(GraphPublisher, AChangeIsToldASecondAfterTheLastAtTheEarliest)
{
    change();
    EXPECT_TRUE(sends_at(second_ns));
    EXPECT_EQ(publisher.version, 1U);
    EXPECT_FALSE(sends_at(5 * second_ns)) << "the same";
    change();
    EXPECT_TRUE(sends_at(6 * second_ns));
    change();
    EXPECT_FALSE(sends_at(6 * second_ns + second_ns / 2));
    EXPECT_TRUE(sends_at(7 * second_ns)) << "what changed meanwhile";
    EXPECT_EQ(publisher.version, 3U);
}

TEST_F(GraphPublisher, TheSameIsToldAgainAfterTenSeconds)
{
    change();
    EXPECT_TRUE(sends_at(second_ns));
    EXPECT_FALSE(sends_at(10 * second_ns));
    EXPECT_TRUE(sends_at(11 * second_ns));
    EXPECT_EQ(publisher.version, 1U) << "as the same";
}

TEST_F(GraphPublisher, InTheEndWhatHasChangedIsToldAtOnce)
{
    change();
    EXPECT_TRUE(sends_at(second_ns));
    ale_graph_publisher_finish(&publisher);
    EXPECT_EQ(publisher.version, 1U);
    change();
    ale_graph_publisher_finish(&publisher);
    EXPECT_EQ(publisher.version, 2U);
    EXPECT_EQ(ale_bus_unsent(bus), 0U);
}

} // namespace
