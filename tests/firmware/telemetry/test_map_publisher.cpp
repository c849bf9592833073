// firmware/map_publisher: whose map is shown, and when. Skipped without a multicast route.
#include <gtest/gtest.h>

#include <memory>
#include <set>

#include "drivers/lcm/own_port.hpp"
#include "firmware/surroundings.hpp"

extern "C" {
#include "telemetry/map_publisher.h"
}

namespace
{

constexpr uint32_t epoch = 3;
constexpr int64_t ten_seconds_ns = 10000000000;

class MapPublisher : public surroundings::WithExchange
{
  protected:
    void SetUp() override
    {
        char error[ALE_BUS_ERROR] = "";
        bus = ale_bus_open(own_lcm_url().c_str(), error);
        if (!bus) {
            GTEST_SKIP() << error;
        }
        ale_map_publisher_init(publisher.get(), &exchange, bus);
    }
    void TearDown() override
    {
        ale_bus_close(bus);
    }
    void track(uint16_t lines)
    {
        static_cast<ale_map_t *>(ale_snapshot_back(exchange.map))->line_count = lines;
        ale_snapshot_publish(exchange.map);
    }
    void draw(uint16_t lines, uint32_t of_epoch = epoch)
    {
        auto *drawn = static_cast<ale_drawn_map_t *>(ale_snapshot_back(exchange.drawn_map));
        drawn->epoch = of_epoch;
        drawn->map.line_count = lines;
        ale_snapshot_publish(exchange.drawn_map);
    }
    /* Sends all that is due now and, unless that is too early, what follows from it. */
    void work(uint32_t of_epoch = epoch)
    {
        do {
            ale_map_publisher_work(publisher.get(), of_epoch, now_ns);
        } while (ale_map_publisher_is_busy(publisher.get()));
    }
    void later(int64_t ns = ALE_MAP_PERIOD_NS, uint32_t of_epoch = epoch)
    {
        now_ns += ns;
        work(of_epoch);
    }
    int lines() const
    {
        return ale_map_publisher_map(publisher.get())->line_count;
    }
    uint32_t version() const
    {
        return ale_map_publisher_map(publisher.get())->version;
    }

    std::unique_ptr<ale_map_publisher_t> publisher = std::make_unique<ale_map_publisher_t>();
    ale_bus_t *bus = nullptr;
    int64_t now_ns = 1;
};

TEST_F(MapPublisher, WithoutAMapNothingIsShown)
{
    work();
    EXPECT_EQ(ale_map_publisher_map(publisher.get()), nullptr);
}

TEST_F(MapPublisher, TheTrackersMapIsShownUntilThereIsADrawing)
{
    track(4);
    work();
    EXPECT_EQ(lines(), 4);
    const uint32_t first = version();
    draw(3);
    track(5);
    later();
    EXPECT_EQ(lines(), 3);
    EXPECT_GT(version(), first);
    track(6);
    later();
    EXPECT_EQ(lines(), 3) << "whatever the tracker's does meanwhile";
    EXPECT_EQ(ale_map_publisher_tracked(publisher.get())->map.line_count, 6)
        << "which is there, too, for those who go on from it";
    draw(2);
    later();
    EXPECT_EQ(lines(), 2);
}

TEST_F(MapPublisher, TheTrackersNewestMapIsThereBeforeItIsItsTurnToBeShown)
{
    track(4);
    work();
    track(5);
    EXPECT_EQ(ale_map_publisher_tracked(publisher.get())->map.line_count, 5);
    EXPECT_EQ(lines(), 4);
    later();
    EXPECT_EQ(lines(), 5) << "although somebody had asked for it before";
}

TEST_F(MapPublisher, ADrawingOfAMapThatWasLeftIsNotShown)
{
    draw(3);
    work();
    EXPECT_EQ(lines(), 3);
    const uint32_t drawn = version();
    track(7); // loaded, while the newest pose known here is still of the map before
    later();
    EXPECT_EQ(lines(), 3);
    later(ALE_MAP_PERIOD_NS, epoch + 1);
    EXPECT_EQ(lines(), 7);
    EXPECT_GT(version(), drawn);
    draw(2, epoch + 1);
    later(ALE_MAP_PERIOD_NS, epoch + 1);
    EXPECT_EQ(lines(), 2);
}

TEST_F(MapPublisher, OneASecondAtMostGoesOutAndTheSameAgainEveryTenSeconds)
{
    draw(3);
    work();
    draw(4);
    later(ALE_MAP_PERIOD_NS - 1);
    EXPECT_EQ(lines(), 3);
    later(1);
    EXPECT_EQ(lines(), 4);
    const uint32_t sent = version();
    later(ten_seconds_ns - 1);
    EXPECT_FALSE(ale_map_publisher_is_busy(publisher.get()));
    now_ns += 1;
    ale_map_publisher_work(publisher.get(), epoch, now_ns);
    EXPECT_EQ(publisher->next_whole_ns, now_ns + ten_seconds_ns) << "it goes out again";
    EXPECT_EQ(version(), sent) << "as the map that it is";
}

/* Three walls are drawn, of the robot's map; the tracker knows four of it, and two of another one. */
TEST_F(MapPublisher, WallsOfMapsThatAreNotJoinedGoOutWithTheDrawingOfTheRobots)
{
    const auto name = [](ale_map_t *map, uint16_t first, uint16_t last, uint32_t map_id) {
        for (uint16_t k = first; k < last; k++) {
            map->line[k].id = k;
            map->line[k].map_id = map_id;
        }
    };
    auto *tracked = static_cast<ale_map_t *>(ale_snapshot_back(exchange.map));
    name(tracked, 0, 4, 5);
    name(tracked, 4, 6, 0);
    track(6);
    name(&static_cast<ale_drawn_map_t *>(ale_snapshot_back(exchange.drawn_map))->map, 0, 3, 5);
    draw(3);
    work();
    const ale_map_t &sent = publisher->sent;
    ASSERT_EQ(sent.line_count, 5);
    EXPECT_EQ(sent.version, version());
    std::set<uint32_t> ids;
    for (int k = 0; k < 5; k++) {
        EXPECT_EQ(sent.line[k].map_id, k < 3 ? 5U : 0U);
        ids.insert(sent.line[k].id);
    }
    EXPECT_EQ(ids.size(), 5U) << "no number twice";
    EXPECT_EQ(lines(), 3) << "what is saved is the robot's map alone";
}

TEST_F(MapPublisher, InTheEndTheNewestGoesOutAtOnce)
{
    draw(3);
    work();
    draw(ALE_MAP_MAX_LINES);
    ale_map_publisher_finish(publisher.get(), epoch);
    EXPECT_EQ(lines(), ALE_MAP_MAX_LINES);
    EXPECT_FALSE(ale_map_publisher_is_busy(publisher.get()));
}

} // namespace
