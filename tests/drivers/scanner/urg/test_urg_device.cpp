// drivers/scanner/urg: from power-up to scans, whatever state the sensor was left in.
#include <random>

#include "drivers/scanner/urg/urg_on_line.hpp"

namespace
{

using ale_test::FakeSensor;
using ale_test::second_us;
using ale_test::UrgDevice;

TEST_F(UrgDevice, classic_sensor_is_switched_to_scip_2_and_streams)
{
    run_for(5);
    EXPECT_EQ(health().state, ALE_SCANNER_STREAMING);
    EXPECT_EQ(health().protocol, 2);
    EXPECT_STREQ(health().identity.serial, "H0706400");
    EXPECT_STREQ(health().identity.firmware, "3.1.04(02/Aug./2007)");
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
    EXPECT_EQ(health().state, ALE_SCANNER_POLLING);
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
    EXPECT_EQ(health().state, ALE_SCANNER_STREAMING);
    EXPECT_EQ(health().identity_warnings, 2U);
}

TEST_F(UrgDevice, numbers_that_make_no_sense_are_not_measured_by_whatever_answer_they_come_with)
{
    sensor.is_rs232 = true;
    sensor.wrong_lines = ale_test::info("SCAN:0") + ale_test::info("ARES:0");
    run_for(4);
    EXPECT_EQ(health().state, ALE_SCANNER_STREAMING);
    EXPECT_EQ(answers.back().scan.beams, 341) << "pairs, at the rate of this line";
    EXPECT_GT(health().identity_warnings, 0U);
}

TEST_F(UrgDevice, numbers_that_make_no_sense_of_a_firmware_without_scip_2_neither)
{
    sensor.can_switch = false;
    sensor.wrong_lines = "SCAN:0\n";
    run_for(4);
    EXPECT_EQ(health().state, ALE_SCANNER_POLLING);
    EXPECT_EQ(answers.back().scan.beams, 682);
    EXPECT_EQ(answers.back().scan.range_max_um, 4095000);
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

TEST_F(UrgDevice, sensor_that_is_not_there_is_waited_for)
{
    sensor.absent_from_us = 0;
    sensor.absent_to_us = sensor.now_us + 20 * second_us;
    run_until(sensor.absent_to_us);
    EXPECT_EQ(health().state, ALE_SCANNER_CLOSED);
    EXPECT_STREQ(health().status, "fake: absent");
    EXPECT_LT(seconds_to_scan(5), 2.0);
}

TEST_F(UrgDevice, another_serial_number_is_refused)
{
    config.serial = "H9999999";
    run_for(5);
    EXPECT_NE(health().state, ALE_SCANNER_STREAMING);
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
