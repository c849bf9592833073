#include <gtest/gtest.h>
#include <lcm/lcm.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <sys/eventfd.h>
#include <vector>

#include "ale/features_t.hpp"
#include "ale/graph_t.hpp"
#include "ale/map_pieces_t.hpp"
#include "ale/map_t.hpp"
#include "ale/odometry_t.hpp"
#include "ale/pose_t.hpp"
#include "ale/scan_t.hpp"
#include "ale/status_t.hpp"
#include "ale/tracking_t.hpp"
#include "bot_core/planar_lidar_t.hpp"
#include "bot_core/pose_t.hpp"
#include "drivers/lcm/own_port.hpp"
#include "files.hpp"
#include "firmware/surroundings.hpp"

extern "C" {
#include "mapping/persistence.h"
#include "recorder/recorder.h"
#include "scanner/scanner.h"
#include "telemetry/telemetry.h"
}

/* LCM makes this mutex of GLib's at its first use; GLib orders that by means that the sanitizer does not see.
 */
extern "C" const char *__tsan_default_suppressions()
{
    return "race:g_static_rec_mutex_lock";
}

namespace
{

/* All that arrives on one channel. */
template <class Message> struct Channel {
    std::vector<Message> messages;
    static void take(const lcm_recv_buf_t *buffer, const char *, void *user)
    {
        Message message;
        ASSERT_GT(message.decode(buffer->data, 0, static_cast<int>(buffer->data_size)), 0);
        static_cast<Channel *>(user)->messages.push_back(message);
    }
    void subscribe(lcm_t *lcm, const char *name)
    {
        lcm_subscription_set_queue_capacity(lcm_subscribe(lcm, name, take, this), 0);
    }
};

/* The thread between rings of the test and an LCM port of this process. Skipped without a multicast route. */
class Telemetry : public surroundings::WithExchange
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
        poses.subscribe(lcm, "ALE_POSE");
        features.subscribe(lcm, "ALE_FEATURES");
        scans.subscribe(lcm, "ALE_SCAN");
        maps.subscribe(lcm, "ALE_MAP");
        states.subscribe(lcm, "ALE_STATUS");
        tracking.subscribe(lcm, "ALE_TRACKING");
        pieces.subscribe(lcm, "ALE_MAP_PIECES");
        graphs.subscribe(lcm, "ALE_GRAPH");
        lidars.subscribe(lcm, "LASER");
        bot_poses.subscribe(lcm, "POSE");
        config = ale_config_default();
    }
    void TearDown() override
    {
        ale_telemetry_stop(telemetry);
        if (lcm) {
            lcm_destroy(lcm);
        }
        ale_bus_close(bus);
    }
    const ale_keys_t keys{}; /* nobody's */
    void start()
    {
        telemetry = ale_telemetry_start(&config, &keys, &exchange, bus, &port_report);
        ASSERT_NE(telemetry, nullptr);
    }
    void stop()
    {
        ale_telemetry_stop(telemetry);
        telemetry = nullptr;
    }
    void receive_until(const std::function<bool()> &condition)
    {
        for (int k = 0; !condition(); k++) {
            ASSERT_GT(lcm_handle_timeout(lcm, 180000), 0) << "nothing came for three minutes";
            ASSERT_LT(k, 1000) << "of all that came, nothing was it";
        }
    }
    /* By the robot's own stamps. A busy machine may hold up one; of some one is in time, and none is early.
     */
    void expect_a_status_a_second(int64_t start_utime)
    {
        int64_t before_utime = start_utime;
        int64_t shortest_us = INT64_MAX;
        for (size_t k = 0; k < 20 && shortest_us > 1100000; k++) {
            receive_until([&] { return states.messages.size() > k; });
            const int64_t utime = states.messages[k].utime;
            EXPECT_GT(utime, start_utime + static_cast<int64_t>(k + 1) * 1000000 - 1000);
            shortest_us = std::min(shortest_us, utime - before_utime);
            before_utime = utime;
        }
        EXPECT_LE(shortest_us, 1100000);
    }
    static int64_t counter(const ale::status_t &status, const std::string &name)
    {
        const auto &names = status.counter_name;
        const auto found = std::find(names.begin(), names.end(), name);
        return found == names.end() ? -1 : status.counter_value[static_cast<size_t>(found - names.begin())];
    }
    /* A result as the estimate task would leave it. */
    void push_result(uint32_t number, bool has_scan)
    {
        auto *result = static_cast<ale_result_t *>(ale_ring_reserve(exchange.results));
        ASSERT_NE(result, nullptr);
        std::memset(result, 0, sizeof *result);
        result->arrival_us = ale_clock_now_us(&exchange.clock);
        result->estimate.stamp_us = result->arrival_us - 100000;
        result->estimate.scan = number;
        result->estimate.state = ALE_STATE_GOOD;
        result->estimate.predicted = !has_scan;
        result->has_scan = has_scan;
        result->features.line_count = 2;
        result->scan.beams = 10;
        result->scan.range_max_um = 5600000;
        result->total_ns = 1000 * static_cast<int32_t>(number + 1);
        result->map_moves = map_moves;
        result->estimate.map_id = map_id;
        result->estimate.maps = static_cast<uint8_t>(map_id + 1);
        result->estimate.wheel_fault = wheel_fault;
        result->estimate.wheel_faults = wheel_fault == ALE_WHEELS_FINE ? 0 : 1;
        ale_ring_commit(exchange.results);
        eventfd_write(exchange.under_way, 1);
    }

    uint32_t map_id = 0; /* of the results that are pushed */
    uint32_t map_moves = 0;
    uint8_t wheel_fault = ALE_WHEELS_FINE;
    ale_config_t config{};
    ale_bus_t *bus = nullptr;
    lcm_t *lcm = nullptr;
    ale_telemetry_t *telemetry = nullptr;
    Channel<ale::pose_t> poses;
    Channel<ale::features_t> features;
    Channel<ale::scan_t> scans;
    Channel<ale::map_t> maps;
    Channel<ale::status_t> states;
    Channel<ale::tracking_t> tracking;
    Channel<ale::map_pieces_t> pieces;
    Channel<ale::graph_t> graphs;
    Channel<bot_core::planar_lidar_t> lidars;
    Channel<bot_core::pose_t> bot_poses;
};

TEST_F(Telemetry, EveryResultGivesOnePoseAndScansTheirFeatures)
{
    start();
    for (uint32_t k = 0; k < 40; k++) {
        push_result(k, k % 4 != 3);
    }
    receive_until([&] { return poses.messages.size() == 40 && features.messages.size() == 30; });
    for (size_t k = 0; k < 40; k++) {
        EXPECT_EQ(poses.messages[k].scan, static_cast<int32_t>(k));
        EXPECT_EQ(poses.messages[k].predicted, k % 4 == 3);
        EXPECT_GE(poses.messages[k].age_us, 100000);
        EXPECT_EQ(poses.messages[k].arrival_utime - poses.messages[k].utime, 100000);
    }
    EXPECT_EQ(features.messages[0].num_lines, 2);
    EXPECT_TRUE(scans.messages.empty()) << "scans are sent only when asked for";
    EXPECT_TRUE(lidars.messages.empty());
}

TEST_F(Telemetry, WithEveryPoseItIsToldWhichMapItIsInAndWhatTheWheelsDo)
{
    auto *health = static_cast<ale_scanner_health_t *>(ale_snapshot_back(exchange.health));
    health->state = ALE_SCANNER_STREAMING;
    ale_snapshot_publish(exchange.health);
    start();
    push_result(0, true);
    map_id = 1;
    wheel_fault = ALE_WHEELS_LATE;
    push_result(1, false);
    receive_until([&] { return tracking.messages.size() == 2 && poses.messages.size() == 2; });
    EXPECT_EQ(tracking.messages[0].map_id, 0);
    EXPECT_EQ(tracking.messages[0].maps, 1);
    EXPECT_EQ(tracking.messages[0].wheel_word, "fine");
    EXPECT_EQ(tracking.messages[1].scan, 1);
    EXPECT_EQ(tracking.messages[1].utime, poses.messages[1].utime);
    EXPECT_EQ(tracking.messages[1].map_id, 1);
    EXPECT_EQ(tracking.messages[1].maps, 2);
    EXPECT_EQ(tracking.messages[1].wheel_fault, ALE_WHEELS_LATE);
    EXPECT_EQ(tracking.messages[1].wheel_word, "late");
    stop();
    receive_until([&] { return !states.messages.empty() && states.messages.back().poses == 2; });
    const ale::status_t &status = states.messages.back();
    EXPECT_EQ(status.driver_state, "streaming; wheels: late");
    EXPECT_EQ(counter(status, "maps"), 2);
    EXPECT_EQ(counter(status, "wheel_faults"), 1);
}

/* What a flight recording is called after results of this kind, one after another. */
TEST_F(Telemetry, ANewMapAndWheelsThatBeginToLieAreWorthAFlightRecording)
{
    const auto recordings = [&](uint32_t next_map, uint8_t next_fault) {
        const files::TemporaryFolder folder;
        std::strncpy(config.recorder_folder, folder.path().c_str(), sizeof config.recorder_folder - 1);
        config.recorder_megabytes = 1;
        exchange.recorder = ale_recorder_start(&config);
        map_id = 0;
        wheel_fault = ALE_WHEELS_FINE;
        push_result(0, true);
        map_id = next_map;
        wheel_fault = next_fault;
        push_result(1, true);
        start();
        stop();
        ale_recorder_stop(exchange.recorder);
        exchange.recorder = nullptr;
        const std::filesystem::directory_iterator found(folder.path());
        return std::count_if(begin(found), end(found), [](const auto &entry) {
            return entry.path().string().find("fault.scip") != std::string::npos;
        });
    };
    EXPECT_EQ(recordings(0, ALE_WHEELS_FINE), 0);
    EXPECT_EQ(recordings(1, ALE_WHEELS_FINE), 1);
    EXPECT_EQ(recordings(0, ALE_WHEELS_STALLED), 1);
}

TEST_F(Telemetry, ScansAndTheWorldsUsualMessagesGoOutWhenAskedFor)
{
    config.publish_scan = true;
    config.publish_bot_core = true;
    start();
    push_result(0, true);
    receive_until(
        [&] { return !scans.messages.empty() && !lidars.messages.empty() && !bot_poses.messages.empty(); });
    EXPECT_EQ(scans.messages[0].num_ranges, 10);
    EXPECT_EQ(scans.messages[0].utime, poses.messages.at(0).utime);
    EXPECT_EQ(lidars.messages[0].nranges, 10);
}

TEST_F(Telemetry, WhatStillWaitsIsSentBeforeItEnds)
{
    for (uint32_t k = 0; k < 5; k++) {
        push_result(k, true);
    }
    start();
    stop();
    receive_until([&] { return poses.messages.size() == 5 && !states.messages.empty(); });
    EXPECT_EQ(states.messages.back().poses, 5) << "the last status counts all of them";
}

TEST_F(Telemetry, TheStatusComesOnceASecondAndCountsWhatWasLostAndWhy)
{
    auto *health = static_cast<ale_scanner_health_t *>(ale_snapshot_back(exchange.health));
    health->state = ALE_SCANNER_CLOSED;
    health->bad_checksum = 3;
    health->scans = 7;
    health->scans_lost = 2;
    std::strcpy(health->status, "/dev/ttyACM0: no such device");
    ale_snapshot_publish(exchange.health);
    std::strcpy(port_report.text, "nothing at all");
    push_result(0, true);
    const int64_t start_utime = ale_clock_to_utime(&exchange.clock, ale_clock_now_us(&exchange.clock));
    start();
    receive_until([&] { return states.messages.size() == 2; });
    const ale::status_t status = states.messages[1];
    EXPECT_EQ(status.driver_state, "no scanner: /dev/ttyACM0: no such device");
    EXPECT_EQ(status.realtime_detail, "nothing at all");
    EXPECT_EQ(status.scans, 9);
    EXPECT_EQ(status.poses, 1);
    EXPECT_EQ(status.state, ALE_STATE_GOOD);
    EXPECT_FLOAT_EQ(status.stage_worst_us[5], 1);
    EXPECT_GT(status.latency_worst_us, 0);
    EXPECT_NE(status.boot, 0);
    EXPECT_EQ(status.boot, states.messages[0].boot);
    for (int k = 0; k < status.num_counters; k++) {
        const std::string &name = status.counter_name[static_cast<size_t>(k)];
        const int64_t value = status.counter_value[static_cast<size_t>(k)];
        EXPECT_EQ(value, name == "bad_checksum" ? 3 : (name == "scans_lost" ? 2 : (name == "maps" ? 1 : 0)))
            << name;
    }
    expect_a_status_a_second(start_utime);
}

TEST_F(Telemetry, TheGraphGoesOutWhenItHasChanged)
{
    start();
    for (uint32_t count = 1; count <= 2; count++) {
        static_cast<ale_mapper_graph_t *>(ale_snapshot_back(exchange.graph))->keyframes = count;
        ale_snapshot_publish(exchange.graph);
        eventfd_write(exchange.under_way, 1);
        receive_until([&] { return graphs.messages.size() == count; });
        EXPECT_EQ(graphs.messages.back().num_keyframes, static_cast<int32_t>(count));
        EXPECT_EQ(graphs.messages.back().version, static_cast<int32_t>(count));
    }
    EXPECT_GE(graphs.messages[1].utime - graphs.messages[0].utime, 1000000);
    static_cast<ale_mapper_graph_t *>(ale_snapshot_back(exchange.graph))->keyframes = 3;
    ale_snapshot_publish(exchange.graph);
    stop();
    receive_until([&] { return graphs.messages.size() == 3; });
    EXPECT_EQ(graphs.messages[2].num_keyframes, 3) << "as it stood in the end";
}

TEST_F(Telemetry, AMapGoesOutWholeInPartsOfOneVersion)
{
    start();
    for (uint32_t version = 1; version <= 3; version++) {
        auto *map = static_cast<ale_map_t *>(ale_snapshot_back(exchange.map));
        std::memset(map, 0, sizeof *map);
        map->version = version;
        map->line_count = ALE_MAP_MAX_LINES;
        map->corner_count = ALE_MAP_MAX_CORNERS;
        for (uint32_t k = 0; k < ALE_MAP_MAX_LINES; k++) {
            map->line[k].id = k;
            map->line[k].map_id = k < 200 ? 1 : 0;
        }
        ale_snapshot_publish(exchange.map);
        eventfd_write(exchange.under_way, 1);
        maps.messages.clear();
        pieces.messages.clear();
        receive_until([&] {
            return !maps.messages.empty() && maps.messages.back().part + 1 == maps.messages.back().parts;
        });
        std::set<int32_t> walls;
        int corners = 0;
        for (const ale::map_t &part : maps.messages) {
            EXPECT_EQ(part.version, static_cast<int32_t>(version));
            corners += part.num_corners;
            for (const ale::map_line_t &line : part.lines) {
                walls.insert(line.id);
            }
        }
        EXPECT_EQ(walls.size(), static_cast<size_t>(ALE_MAP_MAX_LINES));
        EXPECT_EQ(corners, ALE_MAP_MAX_CORNERS);
        std::set<int32_t> apart;
        for (const ale::map_pieces_t &part : pieces.messages) {
            EXPECT_EQ(part.version, static_cast<int32_t>(version));
            apart.insert(part.line_id.begin(), part.line_id.end());
        }
        EXPECT_EQ(apart.size(), 200U) << "and has come before the map was whole";
    }
}

TEST_F(Telemetry, APoseIsKeptWithTheMapThatItWasFoundIn)
{
    const files::TemporaryFolder folder;
    const std::string path = (folder.path() / "kept.map").string();
    exchange.persistence = ale_persistence_start(path.c_str());
    config.keep_seconds = 1;
    auto *tracked = static_cast<ale_tracked_map_t *>(ale_snapshot_back(exchange.map));
    std::memset(tracked, 0, sizeof *tracked);
    tracked->map.line_count = 1;
    tracked->map.line[0].start = {0, 0};
    tracked->map.line[0].end = {3000000, 0};
    tracked->map.line[0].seen = 20;
    tracked->moves = 1;
    ale_snapshot_publish(exchange.map);
    start();
    push_result(1, true);
    receive_until([&] { return states.messages.size() >= 3; });
    EXPECT_FALSE(std::filesystem::exists(path)) << "the pose is of before the map was moved";
    map_moves = 1;
    push_result(2, true);
    receive_until([&] { return std::filesystem::exists(path); });
    stop();
    ale_persistence_stop(exchange.persistence);
    exchange.persistence = nullptr;
}

TEST_F(Telemetry, OdometryReachesTheRingInTheRobotsTime)
{
    start();
    const int64_t now = ale_clock_now_us(&exchange.clock);
    ale::odometry_t message{};
    message.utime = ale_clock_to_utime(&exchange.clock, now);
    message.x = 1.5f;
    std::vector<uint8_t> bytes(static_cast<size_t>(message.getEncodedSize()));
    message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
    while (ale_ring_ready(exchange.odometry) == 0) { /* sent again: the thread may not listen yet */
        lcm_publish(lcm, "ALE_ODOMETRY", bytes.data(), static_cast<unsigned>(bytes.size()));
        usleep(1000);
    }
    const auto *sample = static_cast<const ale_odometry_t *>(ale_ring_at(exchange.odometry, 0));
    EXPECT_EQ(sample->stamp_us, now);
    EXPECT_EQ(sample->pose.x_um, 1500000);
}

} // namespace
