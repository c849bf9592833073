#include <gtest/gtest.h>
#include <lcm/lcm.h>

#include <cmath>
#include <cstdlib>

#include <memory>
#include <string>
#include <vector>

#include "ale/drive_t.hpp"
#include "ale/features_t.hpp"
#include "ale/graph_t.hpp"
#include "ale/map_pieces_t.hpp"
#include "ale/map_t.hpp"
#include "ale/plan_t.hpp"
#include "ale/pose_t.hpp"
#include "ale/scan_t.hpp"
#include "ale/status_t.hpp"
#include "ale/tracking_t.hpp"
#include "bot_core/planar_lidar_t.hpp"
#include "bot_core/pose_t.hpp"
#include "drivers/lcm/own_port.hpp"

extern "C" {
#include "lcm/bus.h"
}

namespace
{

/* A bus of its own in memory: what is sent is received by the same bus. */
class Bus : public testing::Test
{
  protected:
    void SetUp() override
    {
        char error[ALE_BUS_ERROR] = "";
        bus = ale_bus_open("memq://", error);
        ASSERT_NE(bus, nullptr) << error;
    }
    void TearDown() override
    {
        ale_bus_close(bus);
    }
    ale_bus_t *bus = nullptr;
};

void collect(void *user, const ale_odometry_t *sample, uint64_t)
{
    static_cast<std::vector<ale_odometry_t> *>(user)->push_back(*sample);
}

TEST_F(Bus, OdometrySentIsReceivedInOrder)
{
    std::vector<ale_odometry_t> received;
    ASSERT_EQ(ale_bus_on_odometry(bus, collect, &received), 0);
    for (int k = 1; k <= 10; k++) {
        const ale_odometry_t sample = {k, {k * 1000, 0, 0}};
        ASSERT_EQ(ale_bus_send_odometry(bus, &sample), 0);
    }
    EXPECT_EQ(ale_bus_receive(bus, 1000), 10);
    ASSERT_EQ(received.size(), 10u);
    EXPECT_EQ(received[9].stamp_us, 10);
    EXPECT_EQ(received[9].pose.x_um, 10000);
    EXPECT_EQ(ale_bus_receive(bus, 0), 0);
    EXPECT_GE(ale_bus_descriptor(bus), 0);
}

TEST_F(Bus, ExactOdometryArrivesToTheLastBitAndOnce)
{
    std::vector<ale_odometry_t> received;
    ASSERT_EQ(ale_bus_on_odometry(bus, collect, &received), 0);
    const ale_odometry_t sample = {5, {123456789, -87654321, 3000000001}};
    const ale_odometry_t next = {6, {1, 2, 0}};
    ASSERT_EQ(ale_bus_send_exact_odometry(bus, &sample), 0);
    ASSERT_EQ(ale_bus_send_odometry(bus, &sample), 0);
    ASSERT_EQ(ale_bus_send_odometry(bus, &next), 0);
    EXPECT_EQ(ale_bus_receive(bus, 1000), 3);
    ASSERT_EQ(received.size(), 2u);
    EXPECT_EQ(received[0].stamp_us, 5);
    EXPECT_EQ(received[0].pose.x_um, 123456789);
    EXPECT_EQ(received[0].pose.y_um, -87654321);
    EXPECT_EQ(received[0].pose.theta_bam, 3000000001);
    EXPECT_EQ(received[1].stamp_us, 6);
}

TEST(BusOpening, ErrorsAreOneLineThatSaysWhatIsWrong)
{
    char error[ALE_BUS_ERROR] = "";
    EXPECT_EQ(ale_bus_open("carrier-pigeon://x", error), nullptr);
    EXPECT_NE(std::string(error).find("carrier-pigeon"), std::string::npos);
    EXPECT_EQ(ale_bus_open("udpm://not-an-address:7667", error), nullptr);
    EXPECT_NE(std::string(error).find("not-an-address"), std::string::npos);
    EXPECT_EQ(std::string(error).find('\n'), std::string::npos);
    EXPECT_EQ(ale_bus_open("udpm://1.2.3.4:7667", error), nullptr);
    EXPECT_STREQ(error, "LCM: 1.2.3.4 is not a multicast address (224.0.0.0 to 239.255.255.255)");
    for (const char *port : {"99999", "0", "x", "-1"}) {
        EXPECT_EQ(ale_bus_open((std::string("udpm://239.255.76.67:") + port + "?ttl=0").c_str(), error),
                  nullptr);
        EXPECT_EQ(std::string(error), std::string("LCM: ") + port + " is not a port");
    }
}

TEST(BusOpening, AnEmptyUrlMeansTheEnvironment)
{
    char error[ALE_BUS_ERROR] = "";
    setenv("LCM_DEFAULT_URL", "memq://", 1);
    ale_bus_t *bus = ale_bus_open("", error);
    unsetenv("LCM_DEFAULT_URL");
    ASSERT_NE(bus, nullptr) << error;
    ale_bus_close(bus);
}

/* What the C++ side of the generated types decodes from a real transport. */
struct Received {
    std::vector<std::pair<std::string, std::vector<uint8_t>>> messages;
    static void take(const lcm_recv_buf_t *buffer, const char *channel, void *user)
    {
        const auto *bytes = static_cast<const uint8_t *>(buffer->data);
        static_cast<Received *>(user)->messages.emplace_back(
            channel, std::vector<uint8_t>(bytes, bytes + buffer->data_size));
    }
    template <class Message> Message only(const std::string &channel) const
    {
        Message message{};
        int found = 0;
        for (const auto &[name, bytes] : messages) {
            if (name == channel) {
                found++;
                EXPECT_EQ(message.decode(bytes.data(), 0, static_cast<int>(bytes.size())),
                          static_cast<int>(bytes.size()));
            }
        }
        EXPECT_EQ(found, 1) << channel;
        return message;
    }
};

/* Over udpm, with a port of this process: sender and receiver are separate. Skipped without a multicast
 * route. */
class Wire : public testing::Test
{
  protected:
    void SetUp() override
    {
        const std::string url = own_lcm_url();
        char error[ALE_BUS_ERROR] = "";
        bus = ale_bus_open(url.c_str(), error);
        if (!bus) {
            GTEST_SKIP() << error;
        }
        lcm = lcm_create(url.c_str());
        ASSERT_NE(lcm, nullptr);
        lcm_subscribe(lcm, ".*", Received::take, &received);
    }
    void TearDown() override
    {
        ale_bus_close(bus);
        if (lcm) {
            lcm_destroy(lcm);
        }
    }
    void receive(size_t count)
    {
        while (received.messages.size() < count && lcm_handle_timeout(lcm, 60000) > 0) {
        }
        ASSERT_EQ(received.messages.size(), count);
    }
    ale_bus_t *bus = nullptr;
    lcm_t *lcm = nullptr;
    Received received;
};

TEST_F(Wire, EveryMessageIsReadByAnotherLanguageBinding)
{
    ale_pose_report_t pose{};
    pose.estimate.map = {1000000, 2000000, 1u << 30};
    pose.estimate.velocity_x_um_s = 1000000;
    pose.estimate.wheel_fault = ALE_WHEELS_STALLED;
    auto features = std::make_unique<ale_features_t>();
    features->line_count = 2;
    features->line[1].rho_um = 3000000;
    features->corner_count = 1;
    auto scan = std::make_unique<ale_scan_t>();
    scan->beams = 682;
    scan->range_max_um = 5600000;
    scan->range_um[681] = 4000000;
    auto map = std::make_unique<ale_map_t>();
    map->line_count = 40;
    map->line[39].seen = 5;
    map->line[39].id = 77;
    map->line[39].map_id = 2;
    ale_status_report_t status{};
    status.counters = 1;
    status.counter[0] = {"bad_checksum", 3};
    std::snprintf(status.device, sizeof status.device, "URG-04LX");

    ale_plan_report_t plan{};
    plan.state = ALE_PLAN_GOES;
    plan.has_place = true;
    plan.place = {1500000, -250000};
    plan.points = 2;
    plan.point[1] = plan.place;
    std::snprintf(plan.words, sizeof plan.words, "drives to 1.50 -0.25: 2 m to go");

    const auto graph = std::make_unique<ale_mapper_graph_t>();
    graph->keyframes = ALE_GRAPH_KEYFRAMES; // more than one datagram
    graph->keyframe[511].pose.x_um = 4500000;
    graph->loops = 1;
    graph->loop[0] = {3, 511, ALE_LOOP_JOINS};

    const ale_pose_t mounting = {145000, 0, 0};
    EXPECT_EQ(ale_bus_send_graph(bus, graph.get(), 12, 8), 0);
    EXPECT_EQ(ale_bus_send_pose(bus, &pose), 0);
    EXPECT_EQ(ale_bus_send_plan(bus, &plan), 0);
    EXPECT_EQ(ale_bus_send_tracking(bus, &pose.estimate), 0);
    EXPECT_EQ(ale_bus_send_features(bus, features.get(), 12, 7, mounting), 0);
    EXPECT_EQ(ale_bus_send_scan(bus, scan.get(), 12, 7, mounting), 0);
    EXPECT_EQ(ale_bus_send_map_part(bus, map.get(), 12, 1), 0);
    EXPECT_EQ(ale_bus_send_map_pieces(bus, map.get(), 12, 0), 0);
    EXPECT_EQ(ale_bus_send_status(bus, &status), 0);
    EXPECT_EQ(ale_bus_send_bot_lidar(bus, scan.get(), 12), 0);
    EXPECT_EQ(ale_bus_send_bot_pose(bus, &pose), 0);
    EXPECT_EQ(ale_bus_send_drive(bus, 12, 250000, -1500000), 0);
    receive(12);

    const auto told = received.only<ale::graph_t>("ALE_GRAPH");
    EXPECT_EQ(told.version, 8);
    EXPECT_FLOAT_EQ(told.x.at(511), 4.5f);
    EXPECT_EQ(told.loop_to, std::vector<int16_t>{511});
    EXPECT_EQ(told.loop_kind, std::vector<int8_t>{2});
    EXPECT_FLOAT_EQ(received.only<ale::pose_t>("ALE_POSE").map_y, 2);
    EXPECT_FLOAT_EQ(received.only<ale::features_t>("ALE_FEATURES").lines.at(1).rho, 3);
    EXPECT_EQ(received.only<ale::scan_t>("ALE_SCAN").range_mm.at(681), 4000);
    EXPECT_EQ(received.only<ale::map_t>("ALE_MAP").lines.at(3).seen, 5);
    EXPECT_EQ(received.only<ale::tracking_t>("ALE_TRACKING").wheel_word, "stalled");
    const auto pieces = received.only<ale::map_pieces_t>("ALE_MAP_PIECES");
    EXPECT_EQ(pieces.line_id, std::vector<int32_t>{77});
    EXPECT_EQ(pieces.map_id, std::vector<int32_t>{2});
    const auto way = received.only<ale::plan_t>("ALE_PLAN");
    EXPECT_EQ(way.state, 3);
    EXPECT_EQ(way.words, "drives to 1.50 -0.25: 2 m to go");
    EXPECT_FLOAT_EQ(way.place_y, -0.25f);
    EXPECT_EQ(way.x, (std::vector<float>{0, 1.5f}));
    EXPECT_EQ(way.y, (std::vector<float>{0, -0.25f}));
    const auto health = received.only<ale::status_t>("ALE_STATUS");
    EXPECT_EQ(health.device, "URG-04LX");
    EXPECT_EQ(health.counter_name.at(0), "bad_checksum");
    EXPECT_EQ(health.counter_value.at(0), 3);
    EXPECT_FLOAT_EQ(received.only<bot_core::planar_lidar_t>("LASER").ranges.at(681), 4);
    const auto bot = received.only<bot_core::pose_t>("POSE");
    EXPECT_NEAR(bot.vel[1], 1, 1e-6) << "a quarter turn to the left: forward is +y";
    EXPECT_NEAR(bot.orientation[0], std::sqrt(0.5), 1e-6);
    const auto drive = received.only<ale::drive_t>("ALE_DRIVE");
    EXPECT_EQ(drive.utime, 12);
    EXPECT_FLOAT_EQ(drive.v, 0.25f);
    EXPECT_FLOAT_EQ(drive.w, -1.5f);
    EXPECT_EQ(ale_bus_unsent(bus), 0u);
}

TEST_F(Wire, CommandsArriveAsTheBytesThatWereSent)
{
    std::vector<std::vector<uint8_t>> heard;
    const ale_bus_command_t take = [](void *user, const uint8_t *bytes, size_t count) {
        static_cast<std::vector<std::vector<uint8_t>> *>(user)->emplace_back(bytes, bytes + count);
    };
    ASSERT_EQ(ale_bus_on_command(bus, take, &heard), 0);
    const uint8_t bytes[] = {3, 1, 4, 1, 5};
    ASSERT_EQ(ale_bus_send_command(bus, bytes, 5), 0);
    ASSERT_EQ(ale_bus_send_command(bus, bytes, 0), 0);
    while (heard.size() < 2 && ale_bus_receive(bus, 60000) > 0) {
    }
    ASSERT_EQ(heard.size(), 2U);
    EXPECT_EQ(heard[0], std::vector<uint8_t>(bytes, bytes + 5));
    EXPECT_TRUE(heard[1].empty());
    EXPECT_LT(ale_bus_send_command(bus, bytes, 1 << 20), 0);
    EXPECT_EQ(ale_bus_unsent(bus), 1U);
}

TEST_F(Wire, JunkOnTheOdometryChannelIsCountedAndOtherwiseIgnored)
{
    std::vector<ale_odometry_t> samples;
    ASSERT_EQ(ale_bus_on_odometry(bus, collect, &samples), 0);
    const uint8_t junk[40] = {1, 2, 3};
    for (unsigned length : {0u, 7u, 8u, 40u}) {
        lcm_publish(lcm, "ALE_ODOMETRY", junk, length);
    }
    const ale_odometry_t good = {5, {0, 0, 0}};
    ASSERT_EQ(ale_bus_send_odometry(bus, &good), 0);
    while (samples.empty() && ale_bus_receive(bus, 60000) > 0) {
    }
    ASSERT_EQ(samples.size(), 1u);
    EXPECT_EQ(ale_bus_refused(bus).malformed, 4u);
    EXPECT_EQ(ale_bus_refused(bus).unstamped, 0u);
}

} // namespace
