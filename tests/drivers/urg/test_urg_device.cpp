#include <gtest/gtest.h>

#include <memory>
#include <random>

#include "drivers/urg/fake_sensor.hpp"

extern "C" {
#include "urg/urg_device.h"
}

using ale_test::FakeSensor;

namespace
{

constexpr int64_t second_us = 1000000;

int64_t virtual_now(void *)
{
    return ale_test::sensor_on_the_line->now_us;
}

// A driver on a fake sensor, and what came out of it.
class UrgDevice : public testing::Test
{
  protected:
    struct Answer {
        int number;       // of the frame, by its ranges; -1: lost
        int64_t at_us;    // when it came out
        int64_t stamp_us; // that it carries, moved back to step 0
        ale_scan_t scan;
    };
    FakeSensor sensor;
    ale_urg_config_t config{};
    std::vector<Answer> answers;
    std::string received, transmitted;
    std::unique_ptr<ale_urg_t, decltype(&ale_urg_destroy)> urg{nullptr, ale_urg_destroy};

    void SetUp() override
    {
        ale_test::sensor_on_the_line = &sensor;
        config.path = "fake";
        config.now_us = virtual_now;
        config.tap_user = this;
        config.tap = [](void *user, bool out, const uint8_t *bytes, uint32_t count, int64_t) {
            auto *self = static_cast<UrgDevice *>(user);
            (out ? self->transmitted : self->received).append(bytes, bytes + count);
        };
    }
    const ale_urg_health_t &health() const
    {
        return *ale_urg_health(urg.get());
    }
    void run_until(int64_t until_us)
    {
        if (!urg) {
            urg.reset(ale_urg_create(&config));
        }
        auto scan = std::make_unique<ale_scan_t>();
        while (sensor.now_us < until_us) {
            const int64_t before_us = sensor.now_us;
            const ale_urg_event_t event = ale_urg_step(urg.get(), scan.get());
            ASSERT_LE(sensor.now_us - before_us, 51000) << "a step blocks no longer than 50 ms";
            if (event == ALE_URG_SCAN) {
                const int64_t step_0_us =
                    scan->stamp_us + int64_t{44 + scan->stamp_beam} * scan->beam_time_ns / 1000;
                answers.push_back(
                    {scan->range_um[0] / 1000 - sensor.value_base, sensor.now_us, step_0_us, *scan});
            } else if (event == ALE_URG_SCAN_LOST) {
                answers.push_back({-1, sensor.now_us, scan->stamp_us, *scan});
            }
        }
    }
    void run_for(double seconds)
    {
        run_until(sensor.now_us + static_cast<int64_t>(seconds * 1e6));
    }
    // Runs until scans come; the time that took.
    double seconds_to_scan(double most)
    {
        const int64_t begin_us = sensor.now_us;
        const size_t before = answers.size();
        while (sensor.now_us < begin_us + static_cast<int64_t>(most * 1e6)) {
            run_for(0.01);
            if (answers.size() > before && answers.back().number >= 0) {
                break;
            }
        }
        return static_cast<double>(sensor.now_us - begin_us) * 1e-6;
    }
    int lost() const
    {
        return static_cast<int>(
            std::count_if(answers.begin(), answers.end(), [](auto &a) { return a.number < 0; }));
    }
    // Every frame that left the sensor is answered by one event, in order; the good ones by themselves.
    void expect_every_scan_answered(int in_flight = 1)
    {
        EXPECT_NEAR(static_cast<double>(answers.size()), static_cast<double>(sensor.sent.size()), in_flight);
        size_t k = 0;
        for (const Answer &a : answers) {
            ASSERT_LT(k, sensor.sent.size());
            if (a.number >= 0) {
                EXPECT_EQ(a.number, sensor.sent[k]) << "answer " << k;
            }
            k++;
        }
    }
};

TEST_F(UrgDevice, classic_sensor_is_switched_to_scip_2_and_streams)
{
    run_for(5);
    EXPECT_EQ(health().state, ALE_URG_STREAMING);
    EXPECT_EQ(health().protocol, 2);
    EXPECT_STREQ(health().serial, "H0706400");
    EXPECT_STREQ(health().firmware, "3.1.04(02/Aug./2007)");
    EXPECT_STREQ(health().status, "Sensor works well.");
    EXPECT_GT(answers.size(), 40U);
    EXPECT_EQ(lost(), 0);
    expect_every_scan_answered();
}

TEST_F(UrgDevice, sensor_that_serves_one_command_a_turn_streams_within_three_seconds)
{
    sensor.serves_once_a_turn = true;
    EXPECT_LT(seconds_to_scan(5), 3.0);
}

TEST_F(UrgDevice, no_command_of_newer_models_is_ever_sent)
{
    sensor.garble = [](const std::string &frame, int k) { return k % 3 == 0 ? frame.substr(0, 700) : frame; };
    run_for(20);
    for (const std::string &command : sensor.commands) {
        const std::string symbol = command.substr(0, 2);
        EXPECT_TRUE(command.empty() || symbol == "QT" || symbol == "SC" || symbol == "RS" || symbol == "PP" ||
                    symbol == "VV" || symbol == "II" || symbol == "MD")
            << command;
    }
}

TEST_F(UrgDevice, sensor_left_streaming_by_another_program_is_taken_over)
{
    sensor.leave_streaming("MD0000076801000");
    EXPECT_LT(seconds_to_scan(5), 2.0);
    EXPECT_EQ(answers.back().scan.beams, 682);
    EXPECT_EQ(lost(), 0);
}

TEST_F(UrgDevice, sensor_left_in_time_mode_is_led_out)
{
    sensor.protocol = 2;
    sensor.time_mode = true;
    EXPECT_LT(seconds_to_scan(5), 2.0);
}

TEST_F(UrgDevice, firmware_without_scip_2_is_polled)
{
    sensor.can_switch = false;
    run_for(5);
    EXPECT_EQ(health().state, ALE_URG_POLLING);
    EXPECT_EQ(health().protocol, 1);
    EXPECT_GT(answers.size(), 35U);
    EXPECT_LT(answers.size(), 51U) << "never more often than it turns";
    const ale_scan_t &scan = answers.back().scan;
    EXPECT_EQ(scan.beams, 682);
    EXPECT_EQ(scan.range_max_um, 4095000) << "by the brackets of its FIRM line";
}

TEST_F(UrgDevice, wrong_lines_of_identity_are_tolerated_and_counted)
{
    sensor.wrong_lines = "ODD:line;?\nNothing at all\n";
    run_for(4);
    EXPECT_EQ(health().state, ALE_URG_STREAMING);
    EXPECT_EQ(health().identity_warnings, 2U);
}

TEST_F(UrgDevice, sensor_without_parameters_gets_those_of_the_data_sheet)
{
    sensor.has_parameters = false;
    EXPECT_LT(seconds_to_scan(5), 3.0);
    EXPECT_EQ(answers.back().scan.beams, 682);
}

TEST_F(UrgDevice, beams_carry_the_geometry_and_the_times_of_the_sensor)
{
    run_for(4);
    const ale_scan_t &scan = answers.back().scan;
    ASSERT_EQ(scan.beams, 682);
    EXPECT_EQ(static_cast<int32_t>(scan.first_bearing_bam), (44 - 384) * (1 << 22));
    EXPECT_EQ(scan.step_bam, 1 << 22);
    EXPECT_EQ(scan.stamp_beam, -44);
    EXPECT_NEAR(scan.beam_time_ns, 97656, 300);
    EXPECT_EQ(scan.range_min_um, 20000);
    EXPECT_EQ(scan.range_max_um, 5600000);
}

TEST_F(UrgDevice, reversed_mounting_negates_the_bearings)
{
    config.reversed = true;
    run_for(3);
    EXPECT_EQ(static_cast<int32_t>(answers.back().scan.first_bearing_bam), -(44 - 384) * (1 << 22));
    EXPECT_EQ(answers.back().scan.step_bam, -(1 << 22));
}

TEST_F(UrgDevice, cluster_is_seen_from_its_middle_step)
{
    config.cluster = 3;
    run_for(3);
    const ale_scan_t &scan = answers.back().scan;
    EXPECT_EQ(scan.beams, 228);
    EXPECT_EQ(static_cast<int32_t>(scan.first_bearing_bam), (45 - 384) * (1 << 22));
    EXPECT_EQ(scan.step_bam, 3 * (1 << 22));
    EXPECT_EQ(scan.stamp_beam, -15);
    EXPECT_EQ(scan.beam_time_ns / 1000, 292);
}

TEST_F(UrgDevice, stamps_are_the_moments_of_step_0_within_two_milliseconds)
{
    std::mt19937 random(7);
    sensor.delay_us = [&](int) { return static_cast<int64_t>(random() % 8000); };
    run_for(30);
    for (size_t k = 40; k < answers.size(); k++) {
        EXPECT_NEAR(static_cast<double>(answers[k].stamp_us - sensor.truth_us[answers[k].number]), 0.0,
                    2000.0);
    }
}

TEST_F(UrgDevice, flipped_byte_costs_its_scan_and_nothing_else)
{
    std::mt19937 random(11);
    for (int round = 0; round < 200; round++) {
        answers.clear();
        sensor.sent.clear();
        const size_t where = random() % 2137;
        const unsigned bit = random() % 8;
        int damaged = 0;
        sensor.garble = [&](const std::string &frame, int) {
            std::string bytes = frame;
            if (++damaged == 5) {
                bytes[where] = static_cast<char>(static_cast<unsigned char>(bytes[where]) ^ (1U << bit));
            }
            return bytes;
        };
        run_for(round == 0 ? 4.0 : 1.5);
        SCOPED_TRACE("byte " + std::to_string(where) + " bit " + std::to_string(bit));
        expect_every_scan_answered();
        EXPECT_LE(lost(), 2);
        ASSERT_FALSE(HasFailure());
    }
    EXPECT_EQ(health().reopens, 0U);
    EXPECT_EQ(health().stream_restarts, 0U);
}

TEST_F(UrgDevice, every_bit_of_the_lines_that_frame_a_scan_may_flip)
{
    for (size_t where = 0; where < 30; where++) {
        for (unsigned bit = 0; bit < 8; bit++) {
            answers.clear();
            sensor.sent.clear();
            int damaged = 0;
            sensor.garble = [&](const std::string &frame, int) {
                std::string bytes = frame;
                if (++damaged == 3) {
                    bytes[where] = static_cast<char>(static_cast<unsigned char>(bytes[where]) ^ (1U << bit));
                }
                return bytes;
            };
            run_for(where + bit == 0 ? 4.0 : 1.0);
            SCOPED_TRACE("byte " + std::to_string(where) + " bit " + std::to_string(bit));
            expect_every_scan_answered();
            EXPECT_LE(lost(), 1);
            ASSERT_FALSE(HasFailure());
        }
    }
}

TEST_F(UrgDevice, reply_cut_anywhere_costs_one_scan)
{
    for (size_t cut = 1; cut < 2137; cut += 61) {
        answers.clear();
        sensor.sent.clear();
        int damaged = 0;
        sensor.garble = [&](const std::string &frame, int) {
            return ++damaged == 5 ? frame.substr(0, cut) : frame;
        };
        run_for(cut == 1 ? 4.0 : 1.5);
        SCOPED_TRACE("cut at " + std::to_string(cut));
        expect_every_scan_answered();
        EXPECT_EQ(lost(), 1);
        ASSERT_FALSE(HasFailure());
    }
    EXPECT_EQ(health().stream_restarts, 0U);
}

TEST_F(UrgDevice, garbage_before_within_and_behind_a_scan_costs_two_scans_at_most)
{
    std::mt19937 random(13);
    for (int round = 0; round < 60; round++) {
        answers.clear();
        sensor.sent.clear();
        std::string garbage;
        for (int k = 0; k < 300; k++) {
            garbage += static_cast<char>(random());
        }
        int damaged = 0;
        sensor.garble = [&](const std::string &frame, int) {
            const size_t at = round % 3 == 0 ? 0 : (round % 3 == 1 ? random() % frame.size() : frame.size());
            return ++damaged == 5 ? frame.substr(0, at) + garbage + frame.substr(at) : frame;
        };
        run_for(round == 0 ? 4.0 : 1.5);
        SCOPED_TRACE("round " + std::to_string(round));
        expect_every_scan_answered();
        EXPECT_LE(lost(), 2);
        ASSERT_FALSE(HasFailure());
    }
    EXPECT_GT(health().garbage_bytes, 3000U);
}

TEST_F(UrgDevice, repeated_reply_is_dropped_and_counted)
{
    sensor.garble = [](const std::string &frame, int k) { return k % 10 == 0 ? frame + frame : frame; };
    run_for(10);
    EXPECT_GT(health().repeated, 6U);
    EXPECT_EQ(lost(), 0);
    expect_every_scan_answered();
    EXPECT_EQ(health().stream_restarts, 0U);
}

TEST_F(UrgDevice, clock_that_stands_still_restarts_the_stream)
{
    std::string first;
    sensor.garble = [&](const std::string &frame, int k) {
        if (k < 40 || k > 50) {
            return frame;
        }
        first = first.empty() ? frame : first;
        return first;
    };
    run_for(10);
    EXPECT_GE(health().stream_restarts, 1U);
    EXPECT_EQ(health().state, ALE_URG_STREAMING);
}

TEST_F(UrgDevice, scans_come_again_within_a_second_of_two_seconds_of_silence)
{
    for (const bool slow : {false, true}) {
        sensor.serves_once_a_turn = slow;
        run_for(4);
        sensor.silent_from_us = sensor.now_us;
        sensor.silent_to_us = sensor.now_us + 2 * second_us;
        run_until(sensor.silent_to_us);
        EXPECT_LT(seconds_to_scan(6), 1.0);
        run_for(1);
        EXPECT_EQ(lost(), 0) << "in silence nothing was sent, so nothing was lost";
        expect_every_scan_answered();
    }
    EXPECT_GE(health().stream_restarts, 2U);
}

TEST_F(UrgDevice, unplugged_sensor_streams_again_within_three_seconds_of_its_return)
{
    for (const bool slow : {false, true}) {
        sensor.serves_once_a_turn = slow;
        run_for(3);
        sensor.absent_from_us = sensor.now_us;
        sensor.absent_to_us = sensor.now_us + 2 * second_us;
        run_until(sensor.absent_to_us);
        EXPECT_EQ(health().state, ALE_URG_CLOSED);
        EXPECT_LT(seconds_to_scan(6), 2.0);
        EXPECT_GE(sensor.opened, 2);
    }
    EXPECT_GE(health().reopens, 2U);
}

TEST_F(UrgDevice, reset_into_scip_1_is_recovered_within_three_seconds)
{
    for (const bool slow : {false, true}) {
        sensor.serves_once_a_turn = slow;
        run_for(4);
        sensor.power_cycle();
        EXPECT_LT(seconds_to_scan(6), 1.6);
    }
    EXPECT_EQ(health().reopens, 0U);
    run_for(2);
    EXPECT_EQ(lost(), 0);
}

TEST_F(UrgDevice, reset_of_a_sensor_that_wakes_in_scip_2_is_recovered)
{
    sensor.powers_up_in_1 = false;
    run_for(4);
    sensor.power_cycle();
    EXPECT_LT(seconds_to_scan(6), 1.6);
    const int64_t stamp_us = answers.back().stamp_us;
    EXPECT_NEAR(static_cast<double>(stamp_us - sensor.truth_us[answers.back().number]), 0.0, 3000.0);
}

TEST_F(UrgDevice, wrap_of_the_24_bit_clock_goes_unnoticed)
{
    run_for(3);
    sensor.set_clock((1 << 24) - 1500);
    run_for(5);
    EXPECT_EQ(lost(), 0);
    expect_every_scan_answered();
    for (size_t k = 1; k < answers.size(); k++) {
        EXPECT_NEAR(static_cast<double>(answers[k].stamp_us - answers[k - 1].stamp_us), 100000.0, 3000.0)
            << k;
    }
}

TEST_F(UrgDevice, scans_that_vanish_on_the_line_are_counted_by_their_stamps)
{
    sensor.garble = [](const std::string &frame, int k) {
        return k > 40 && k % 7 < 2 ? std::string() : frame;
    };
    run_for(12);
    expect_every_scan_answered(2);
    EXPECT_GT(lost(), 15);
    for (size_t k = 1; k < answers.size(); k++) {
        EXPECT_NEAR(static_cast<double>(answers[k].stamp_us - answers[k - 1].stamp_us), 100000.0, 3000.0)
            << k;
    }
}

TEST_F(UrgDevice, damage_that_stays_climbs_the_ladder_and_is_survived)
{
    run_for(4);
    const int64_t begin_us = sensor.now_us;
    sensor.garble = [&](const std::string &frame, int) {
        return sensor.now_us < begin_us + 8 * second_us ? frame.substr(0, 900) : frame;
    };
    run_until(begin_us + 8 * second_us);
    EXPECT_GE(health().stream_restarts, 3U);
    EXPECT_GE(health().resets, 2U) << "one at the beginning, one of the ladder";
    EXPECT_GE(health().reopens, 1U);
    EXPECT_LT(seconds_to_scan(5), 3.0);
}

TEST_F(UrgDevice, hardware_fault_is_counted_and_followed_by_one_reset)
{
    run_for(4);
    bool done = false;
    sensor.garble = [&](const std::string &frame, int) {
        if (done) {
            return frame;
        }
        done = true;
        return frame.substr(0, 16) + ale_test::summed("55") + "\n\n";
    };
    run_for(3);
    EXPECT_EQ(health().hardware_faults, 1U);
    EXPECT_EQ(health().resets, 2U);
    EXPECT_EQ(health().state, ALE_URG_STREAMING);
}

TEST_F(UrgDevice, sensor_that_is_not_there_is_waited_for)
{
    sensor.absent_from_us = 0;
    sensor.absent_to_us = sensor.now_us + 20 * second_us;
    run_until(sensor.absent_to_us);
    EXPECT_EQ(health().state, ALE_URG_CLOSED);
    EXPECT_STREQ(health().status, "fake: absent");
    EXPECT_LT(seconds_to_scan(5), 2.0);
}

TEST_F(UrgDevice, another_serial_number_is_refused)
{
    config.serial = "H9999999";
    run_for(5);
    EXPECT_NE(health().state, ALE_URG_STREAMING);
    EXPECT_TRUE(answers.empty());
    EXPECT_NE(std::string(health().status).find("serial"), std::string::npos);
}

TEST_F(UrgDevice, baud_rate_of_a_real_line_is_found_and_raised)
{
    for (const int32_t baud : {19200, 57600, 750000}) {
        FakeSensor other;
        sensor = other;
        sensor.is_rs232 = true;
        sensor.sensor_baud = baud;
        urg.reset();
        answers.clear();
        EXPECT_LT(seconds_to_scan(40), 30.0) << baud;
        EXPECT_EQ(health().baud, std::max(baud, 115200));
        EXPECT_EQ(answers.back().scan.beams, baud < 115200 ? 341 : 682) << "what fits at 10 Hz";
    }
}

TEST_F(UrgDevice, everything_on_the_line_passes_the_tap)
{
    run_for(3);
    EXPECT_NE(received.find("SERI:H0706400"), std::string::npos);
    EXPECT_NE(transmitted.find("MD0044072501000\n"), std::string::npos);
    urg.reset();
    EXPECT_EQ(transmitted.substr(transmitted.size() - 3), "QT\n") << "the sensor is left quiet";
}

} // namespace
