#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <random>
#include <set>
#include <string>
#include <vector>

extern "C" {
#include "base/trig.h"
#include "lcm/convert.h"
#include "lcm/wheel_words.h"
}

namespace
{

constexpr double kTurn = 4294967296.0;

ale_pose_t pose(double x, double y, double theta)
{
    return {static_cast<int32_t>(std::lround(x * 1e6)), static_cast<int32_t>(std::lround(y * 1e6)),
            static_cast<uint32_t>(std::llround(std::remainder(theta, 2 * M_PI) / (2 * M_PI) * kTurn))};
}

TEST(Convert, APoseGoesOutInMetresRadiansAndTheirVariances)
{
    ale_pose_report_t report{};
    report.estimate.stamp_us = 1700000000000000;
    report.estimate.scan = 77;
    report.estimate.smooth = pose(1.5, -2.25, 3.0);
    report.estimate.map = pose(-0.001, 0.002, -3.0);
    const int64_t cov[9] = {4000000, 1, 500000000, 1, 9000000, 2, 500000000, 2, 1000000000000};
    std::memcpy(report.estimate.cov, cov, sizeof cov);
    report.estimate.information[0] = 1 << 20; // 1/mm^2
    report.estimate.velocity_x_um_s = 500000;
    report.estimate.velocity_theta_urad_s = -900000;
    report.estimate.state = ALE_STATE_WEAK;
    report.estimate.predicted = true;
    report.estimate.lag_us = 155000;
    report.first_beam_us = report.estimate.stamp_us + 4297;
    report.arrival_us = report.estimate.stamp_us + 100000;
    report.sent_us = report.estimate.stamp_us + 101000;
    report.stage_ns[ALE_STAGE_MATCH] = 12345;
    report.stage_start_ns[ALE_STAGE_MATCH] = 54321;
    report.stage_end_ns[ALE_STAGE_MATCH] = 66666;

    lcmtypes_ale_pose_t message;
    ale_convert_pose(&report, &message);
    EXPECT_EQ(message.utime, report.estimate.stamp_us);
    EXPECT_EQ(message.scan, 77);
    EXPECT_FLOAT_EQ(message.x, 1.5f);
    EXPECT_FLOAT_EQ(message.y, -2.25f);
    EXPECT_FLOAT_EQ(message.theta, 3.0f);
    EXPECT_FLOAT_EQ(message.map_x, -0.001f);
    EXPECT_FLOAT_EQ(message.map_theta, -3.0f);
    EXPECT_FLOAT_EQ(message.cov[0], 4e-6f); // 2 mm
    EXPECT_FLOAT_EQ(message.cov[2], 5e-7f); // 500 um * 1 mrad
    EXPECT_FLOAT_EQ(message.cov[8], 1e-6f); // 1 mrad
    EXPECT_FLOAT_EQ(message.observability[0], 1e6f);
    EXPECT_FLOAT_EQ(message.vx, 0.5f);
    EXPECT_FLOAT_EQ(message.omega, -0.9f);
    EXPECT_EQ(message.state, ALE_STATE_WEAK);
    EXPECT_TRUE(message.predicted);
    EXPECT_EQ(message.lag_us, 155000);
    EXPECT_EQ(message.age_us, 101000);
    EXPECT_EQ(message.arrival_utime - message.first_beam_utime, 95703);
    EXPECT_EQ(message.stage_ns[ALE_STAGE_MATCH], 12345);
    EXPECT_EQ(message.stage_start_ns[ALE_STAGE_MATCH], 54321);
    EXPECT_EQ(message.stage_end_ns[ALE_STAGE_MATCH], 66666);
}

TEST(Convert, WhichMapAPoseIsInAndWhatTheWheelsDoAreTold)
{
    ale_estimate_t estimate{};
    estimate.stamp_us = 12345678901234;
    estimate.scan = 42;
    estimate.map_id = 3;
    estimate.maps = 2;
    estimate.wheel_fault = ALE_WHEELS_REVERSED;
    estimate.wheel_faults = 5;
    lcmtypes_ale_tracking_t message;
    ale_convert_tracking(&estimate, &message);
    EXPECT_EQ(message.utime, 12345678901234);
    EXPECT_EQ(message.scan, 42);
    EXPECT_EQ(message.map_id, 3);
    EXPECT_EQ(message.maps, 2);
    EXPECT_EQ(message.wheel_fault, 3);
    EXPECT_STREQ(message.wheel_word, "reversed");
    EXPECT_EQ(message.wheel_faults, 5);
    EXPECT_LT(lcmtypes_ale_tracking_t_encoded_size(&message), 64);
}

TEST(Convert, EveryFaultOfTheWheelsHasAWordOfItsOwn)
{
    std::set<std::string> words;
    for (const auto fault : {ALE_WHEELS_FINE, ALE_WHEELS_CONTRADICT, ALE_WHEELS_STALLED, ALE_WHEELS_REVERSED,
                             ALE_WHEELS_LATE, ALE_WHEELS_SCALE}) {
        words.insert(ale_wheel_fault_word(static_cast<uint8_t>(fault)));
    }
    EXPECT_EQ(words, (std::set<std::string>{"fine", "contradict", "stalled", "reversed", "late", "scale"}));
    EXPECT_STREQ(ale_wheel_fault_word(200), "unknown");
}

TEST(Convert, LinesAndCornersKeepTheirOrderAndCovariance)
{
    auto features = std::make_unique<ale_features_t>();
    auto buffer = std::make_unique<ale_features_buffer_t>();
    features->line_count = ALE_MAX_LINES;
    features->corner_count = ALE_MAX_CORNERS;
    for (int k = 0; k < ALE_MAX_LINES; k++) {
        ale_line_t &line = features->line[k];
        line.first = static_cast<uint16_t>(k * 7);
        line.last = static_cast<uint16_t>(k * 7 + 6);
        line.start = {k * 1000, -k * 1000};
        line.rho_um = 2000000;
        line.alpha_bam = ALE_BAM_QUARTER_TURN;
        line.var_alpha_nrad2 = 1000000000000;
        line.cov_alpha_rho = -1000000000;
        line.var_rho_um2 = 1000000;
        line.rmse_um = 3500;
        line.last_end = ALE_END_OCCLUDED;
        features->corner[k].p = {k, 2 * k};
        features->corner[k].angle_bam = ALE_BAM_HALF_TURN; // half a turn is pi, not minus pi
        features->corner[k].kind = ALE_CORNER_CONCAVE;
        features->corner[k].second_line = static_cast<uint16_t>(k + 1);
    }
    lcmtypes_ale_features_t message;
    ale_convert_features(features.get(), 5, 9, pose(0.145, 0, 0.1), buffer.get(), &message);
    ASSERT_EQ(message.num_lines, ALE_MAX_LINES);
    ASSERT_EQ(message.num_corners, ALE_MAX_CORNERS);
    EXPECT_FLOAT_EQ(message.sensor_x, 0.145f);
    EXPECT_FLOAT_EQ(message.sensor_theta, 0.1f);
    EXPECT_EQ(message.lines[135].first, 945);
    EXPECT_FLOAT_EQ(message.lines[135].x1, 0.135f);
    EXPECT_FLOAT_EQ(message.lines[1].alpha, static_cast<float>(M_PI / 2));
    EXPECT_FLOAT_EQ(message.lines[1].cov[0], 1e-6f);
    EXPECT_FLOAT_EQ(message.lines[1].cov[1], -1e-6f);
    EXPECT_FLOAT_EQ(message.lines[1].cov[2], 1e-6f);
    EXPECT_FLOAT_EQ(message.lines[1].rmse, 0.0035f);
    EXPECT_EQ(message.lines[1].last_end, 1);
    EXPECT_FLOAT_EQ(message.corners[1].angle, static_cast<float>(M_PI));
    EXPECT_EQ(message.corners[1].kind, 1);
    EXPECT_EQ(message.corners[4].second_line, 5);
    std::vector<uint8_t> bytes(16384);
    EXPECT_GT(lcmtypes_ale_features_t_encode(bytes.data(), 0, 16384, &message), 0)
        << "the fullest scan fits the buffer";
}

TEST(Convert, AScanKeepsRangesCodesAndTimes)
{
    auto scan = std::make_unique<ale_scan_t>();
    auto buffer = std::make_unique<ale_scan_buffer_t>();
    scan->beams = 682;
    scan->stamp_beam = -44;
    scan->beam_time_ns = 97656;
    scan->first_bearing_bam = static_cast<uint32_t>(-340) << 22;
    scan->step_bam = 1 << 22;
    scan->range_min_um = 20000;
    scan->range_max_um = 5600000;
    scan->range_um[5] = 1234499;
    scan->flag[6] = ALE_BEAM_UNKNOWN;
    scan->code[6] = 16;
    scan->flag[7] = ALE_BEAM_BLIND;
    scan->range_um[7] = 999000;
    lcmtypes_ale_scan_t message;
    ale_convert_scan(scan.get(), 11, 3, pose(0, 0, 0), buffer.get(), &message);
    EXPECT_EQ(message.num_ranges, 682);
    EXPECT_EQ(message.range_unit_mm, 1);
    EXPECT_EQ(message.range_mm[5], 1234);
    EXPECT_EQ(message.codes[5], 0);
    EXPECT_EQ(message.codes[6], 16);
    EXPECT_EQ(message.range_mm[7], 0);
    EXPECT_EQ(message.codes[7], 0x80 | ALE_BEAM_BLIND);
    EXPECT_EQ(message.stamp_beam, -44);
    EXPECT_NEAR(static_cast<double>(message.beam_time_us), 97.656, 1e-4);
    EXPECT_NEAR(static_cast<double>(message.first_bearing), -340 * 2 * M_PI / 1024, 1e-6);
    EXPECT_NEAR(static_cast<double>(message.step), 2 * M_PI / 1024, 1e-9);
}

TEST(Convert, FarRangesUseALargerUnitInsteadOfWrapping)
{
    auto scan = std::make_unique<ale_scan_t>();
    auto buffer = std::make_unique<ale_scan_buffer_t>();
    scan->beams = 1;
    scan->range_max_um = ALE_MAX_RANGE_UM;
    scan->range_um[0] = 79999000;
    lcmtypes_ale_scan_t message;
    ale_convert_scan(scan.get(), 1, 0, pose(0, 0, 0), buffer.get(), &message);
    EXPECT_NEAR(message.range_mm[0] * message.range_unit_mm, 79999, message.range_unit_mm);
}

/* Every wall and corner once, in order, and no part above the size of one frame on the air. */
TEST(Convert, AMapInPartsIsComplete)
{
    auto map = std::make_unique<ale_map_t>();
    auto buffer = std::make_unique<ale_map_buffer_t>();
    std::mt19937 random(3);
    for (int trial = 0; trial < 60; trial++) {
        map->version = static_cast<uint32_t>(random());
        map->line_count = static_cast<uint16_t>(trial == 0 ? 0 : random() % (ALE_MAP_MAX_LINES + 1));
        map->corner_count = static_cast<uint16_t>(trial < 2 ? 0 : random() % (ALE_MAP_MAX_CORNERS + 1));
        for (int k = 0; k < map->line_count; k++) {
            map->line[k].id = static_cast<uint32_t>(k) + 100;
        }
        for (int k = 0; k < map->corner_count; k++) {
            map->corner[k].p = {k * 1000, 0};
        }
        const int16_t parts = ale_map_parts(map.get());
        ASSERT_GE(parts, 1);
        int lines = 0;
        int corners = 0;
        for (int16_t part = 0; part < parts; part++) {
            lcmtypes_ale_map_t message;
            ale_convert_map(map.get(), 1, part, buffer.get(), &message);
            EXPECT_EQ(message.part, part);
            EXPECT_EQ(message.parts, parts);
            EXPECT_EQ(message.version, static_cast<int32_t>(map->version));
            EXPECT_LT(lcmtypes_ale_map_t_encoded_size(&message), 1400);
            for (int k = 0; k < message.num_lines; k++) {
                EXPECT_EQ(message.lines[k].id, 100 + lines++);
            }
            for (int k = 0; k < message.num_corners; k++) {
                EXPECT_FLOAT_EQ(message.corners[k].x, static_cast<float>(corners++) * 1e-3f);
            }
        }
        EXPECT_EQ(lines, map->line_count);
        EXPECT_EQ(corners, map->corner_count);
    }
}

/* Every wall of another map than the first once, in order, and no part above the size of one frame on the
 * air. */
TEST(Convert, ThePiecesOfAMapAreToldWhole)
{
    auto map = std::make_unique<ale_map_t>();
    auto buffer = std::make_unique<ale_pieces_buffer_t>();
    map->version = 9;
    map->line_count = ALE_MAP_MAX_LINES;
    for (const uint32_t every : {0U, 1U, 2U, 7U}) { // so many walls are in another map; 0: none is
        std::vector<int32_t> wanted;
        for (uint32_t k = 0; k < ALE_MAP_MAX_LINES; k++) {
            const bool apart = every > 0 && k % every == 0;
            map->line[k].id = k + 100;
            map->line[k].map_id = apart ? 4 : 0;
            if (apart) {
                wanted.push_back(static_cast<int32_t>(k + 100));
            }
        }
        const int16_t parts = ale_map_pieces_parts(map.get());
        ASSERT_GE(parts, 1) << "none is told, too: what was apart may have been joined";
        std::vector<int32_t> told;
        for (int16_t part = 0; part < parts; part++) {
            lcmtypes_ale_map_pieces_t message;
            ale_convert_map_pieces(map.get(), 1, part, buffer.get(), &message);
            EXPECT_EQ(message.version, 9);
            EXPECT_EQ(message.part, part);
            EXPECT_EQ(message.parts, parts);
            EXPECT_LT(lcmtypes_ale_map_pieces_t_encoded_size(&message), 1400);
            for (int k = 0; k < message.num_lines; k++) {
                told.push_back(message.line_id[k]);
                EXPECT_EQ(message.map_id[k], 4);
            }
        }
        EXPECT_EQ(told, wanted);
    }
}

TEST(Convert, AFullGraphIsToldInOneMessageThatFits)
{
    const auto graph = std::make_unique<ale_mapper_graph_t>();
    const auto buffer = std::make_unique<ale_graph_buffer_t>();
    graph->keyframes = ALE_GRAPH_KEYFRAMES;
    graph->loops = ALE_GRAPH_LOOPS;
    graph->keyframes_left_out = 1536;
    graph->loops_left_out = 7;
    for (uint32_t k = 0; k < ALE_GRAPH_KEYFRAMES; k++) {
        graph->keyframe[k] = {10 * k, k / 300, pose(0.1 * k, -1, 0.5), k != 0 && k != 300};
    }
    for (uint16_t k = 0; k < ALE_GRAPH_LOOPS; k++) {
        graph->loop[k] = {k, 511, static_cast<uint8_t>(k % 3)};
    }
    lcmtypes_ale_graph_t message;
    ale_convert_graph(graph.get(), 12, 34, buffer.get(), &message);
    EXPECT_EQ(message.utime, 12);
    EXPECT_EQ(message.version, 34);
    EXPECT_EQ(message.keyframes_left_out, 1536);
    EXPECT_EQ(message.loops_left_out, 7);
    ASSERT_EQ(message.num_keyframes, ALE_GRAPH_KEYFRAMES);
    ASSERT_EQ(message.num_loops, ALE_GRAPH_LOOPS);
    for (int k = 0; k < ALE_GRAPH_KEYFRAMES; k++) {
        EXPECT_EQ(message.scan[k], 10 * k);
        EXPECT_FLOAT_EQ(message.x[k], 0.1f * static_cast<float>(k));
        EXPECT_FLOAT_EQ(message.y[k], -1);
        EXPECT_FLOAT_EQ(message.theta[k], 0.5f);
        EXPECT_EQ(message.map_id[k], k / 300);
        EXPECT_EQ(message.tied[k], k == 0 || k == 300 ? 0 : 1);
    }
    for (int k = 0; k < ALE_GRAPH_LOOPS; k++) {
        EXPECT_EQ(message.loop_from[k], k);
        EXPECT_EQ(message.loop_to[k], 511);
        EXPECT_EQ(message.loop_kind[k], k % 3);
    }
    EXPECT_LE(lcmtypes_ale_graph_t_encoded_size(&message), 13400);
}

TEST(Convert, AFullStatusFitsItsMessage)
{
    ale_status_report_t report{};
    ale_status_buffer_t buffer;
    report.scan_period_us = 100000;
    report.latency_p50_ns = 1500000;
    report.stage_worst_ns[ALE_STAGE_MATCH] = 2000;
    std::memset(report.realtime_detail, 'r', sizeof report.realtime_detail - 1);
    std::memset(report.driver_state, 'd', sizeof report.driver_state - 1);
    std::memset(report.device, 'u', sizeof report.device - 1);
    report.counters = ALE_STATUS_COUNTERS;
    for (auto &counter : report.counter) {
        counter = {"dropped_because_the_ring_was_full", 1234567890123};
    }
    std::snprintf(report.operation.robot, sizeof report.operation.robot, "rover");
    std::snprintf(report.operation.who_drives, sizeof report.operation.who_drives, "alice");
    std::memset(report.operation.command_result, 'c', sizeof report.operation.command_result - 1);
    report.operation.takes_commands = report.operation.command_obeyed = true;
    report.operation.command_counter = 77;
    lcmtypes_ale_status_t message;
    ale_convert_status(&report, &buffer, &message);
    EXPECT_FLOAT_EQ(message.scan_rate_hz, 10);
    EXPECT_FLOAT_EQ(message.latency_p50_us, 1500);
    EXPECT_FLOAT_EQ(message.stage_worst_us[ALE_STAGE_MATCH], 2);
    EXPECT_EQ(message.counter_value[31], 1234567890123);
    EXPECT_STREQ(message.counter_name[31], "dropped_because_the_ring_was_full");
    EXPECT_STREQ(message.robot, "rover");
    EXPECT_STREQ(message.who_drives, "alice");
    EXPECT_STREQ(message.exploration, "");
    EXPECT_STREQ(message.command_operator, "");
    EXPECT_EQ(std::strlen(message.command_result), ALE_ANSWER_BYTES - 1U);
    EXPECT_EQ(message.command_counter, 77);
    EXPECT_TRUE(message.takes_commands && message.command_obeyed && !message.map_frozen);
    EXPECT_LT(lcmtypes_ale_status_t_encoded_size(&message), 4096);
}

TEST(Convert, OdometryComesBackAsItWentOut)
{
    std::mt19937 random(4);
    std::uniform_int_distribution<int32_t> place(-8000000, 8000000);
    for (int k = 0; k < 10000; k++) {
        const ale_odometry_t sample = {1700000000000000 + k,
                                       {place(random), place(random), static_cast<uint32_t>(random())}};
        lcmtypes_ale_odometry_t message;
        ale_odometry_t again;
        ale_convert_odometry(&sample, &message);
        ASSERT_EQ(ale_take_odometry(&message, &again), 0);
        EXPECT_EQ(again.stamp_us, sample.stamp_us);
        EXPECT_NEAR(again.pose.x_um, sample.pose.x_um, 1);
        EXPECT_NEAR(again.pose.y_um, sample.pose.y_um, 1);
        EXPECT_NEAR(ale_bam_diff(again.pose.theta_bam, sample.pose.theta_bam), 0,
                    100); // a float's angle: 0.15 urad
    }
}

TEST(Convert, HeadingsOfManyTurnsWrap)
{
    const lcmtypes_ale_odometry_t message = {1, 0, 0, static_cast<float>(2 * M_PI * 3 + 1)};
    ale_odometry_t sample;
    ASSERT_EQ(ale_take_odometry(&message, &sample), 0);
    EXPECT_NEAR(static_cast<double>(sample.pose.theta_bam) / kTurn * 2 * M_PI, 1, 1e-5);
}

TEST(Convert, HostileOdometryIsRefused)
{
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float inf = std::numeric_limits<float>::infinity();
    const lcmtypes_ale_odometry_t bad[] = {
        {1, nan, 0, 0},  {1, 0, nan, 0},    {1, 0, 0, nan},  {1, inf, 0, 0}, {1, 0, -inf, 0}, {1, 0, 0, inf},
        {1, 2001, 0, 0}, {1, 0, -3e38f, 0}, {1, 0, 0, 2e6f}, {0, 0, 0, 0},   {-5, 0, 0, 0}};
    for (const auto &message : bad) {
        ale_odometry_t sample = {42, {1, 2, 3}};
        EXPECT_EQ(ale_take_odometry(&message, &sample), -1);
        EXPECT_EQ(sample.stamp_us, 42);
    }
}

} // namespace
