// drivers/scanner/urg: damage on the line, silence, resets, and what they cost.
#include <random>

#include "drivers/scanner/urg/urg_on_line.hpp"

namespace
{

using ale_test::second_us;

class UrgRecovery : public ale_test::UrgDevice
{
};

TEST_F(UrgRecovery, flipped_byte_costs_its_scan_and_nothing_else)
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

TEST_F(UrgRecovery, every_bit_of_the_lines_that_frame_a_scan_may_flip)
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

TEST_F(UrgRecovery, reply_cut_anywhere_costs_one_scan)
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

TEST_F(UrgRecovery, garbage_before_within_and_behind_a_scan_costs_two_scans_at_most)
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

TEST_F(UrgRecovery, repeated_reply_is_dropped_and_counted)
{
    sensor.garble = [](const std::string &frame, int k) { return k % 10 == 0 ? frame + frame : frame; };
    run_for(10);
    EXPECT_GT(health().repeated, 6U);
    EXPECT_EQ(lost(), 0);
    expect_every_scan_answered();
    EXPECT_EQ(health().stream_restarts, 0U);
}

TEST_F(UrgRecovery, clock_that_stands_still_restarts_the_stream)
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
    EXPECT_EQ(health().state, ALE_SCANNER_STREAMING);
}

TEST_F(UrgRecovery, scans_come_again_within_a_second_of_two_seconds_of_silence)
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

TEST_F(UrgRecovery, unplugged_sensor_streams_again_within_three_seconds_of_its_return)
{
    for (const bool slow : {false, true}) {
        sensor.serves_once_a_turn = slow;
        run_for(3);
        sensor.absent_from_us = sensor.now_us;
        sensor.absent_to_us = sensor.now_us + 2 * second_us;
        run_until(sensor.absent_to_us);
        EXPECT_EQ(health().state, ALE_SCANNER_CLOSED);
        EXPECT_LT(seconds_to_scan(6), 2.0);
        EXPECT_GE(sensor.opened, 2);
    }
    EXPECT_GE(health().reopens, 2U);
}

TEST_F(UrgRecovery, reset_into_scip_1_is_recovered_within_three_seconds)
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

TEST_F(UrgRecovery, reset_of_a_sensor_that_wakes_in_scip_2_is_recovered)
{
    sensor.powers_up_in_1 = false;
    run_for(4);
    sensor.power_cycle();
    EXPECT_LT(seconds_to_scan(6), 1.6);
    const int64_t stamp_us = answers.back().stamp_us;
    EXPECT_NEAR(static_cast<double>(stamp_us - sensor.truth_us[answers.back().number]), 0.0, 3000.0);
}

TEST_F(UrgRecovery, wrap_of_the_24_bit_clock_goes_unnoticed)
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

TEST_F(UrgRecovery, scans_that_vanish_on_the_line_are_counted_by_their_stamps)
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

TEST_F(UrgRecovery, damage_that_stays_climbs_the_ladder_and_is_survived)
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

TEST_F(UrgRecovery, hardware_fault_is_counted_and_followed_by_one_reset)
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
    EXPECT_EQ(health().state, ALE_SCANNER_STREAMING);
}

} // namespace
