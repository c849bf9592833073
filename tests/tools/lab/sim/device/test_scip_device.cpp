// The simulated device byte by byte: what a client sends, and exactly what must come back.
#include <gtest/gtest.h>

#include <string>

#include "lab/sim/device/scip_device.h"

namespace
{

using sim::Protocol;
using sim::Reply;
using sim::ScipDevice;

std::string joined(const std::vector<Reply> &replies)
{
    std::string out;
    for (const Reply &reply : replies) {
        out += reply.bytes;
    }
    return out;
}

sim::Turn turn_of(int32_t value, uint32_t number = 0)
{
    sim::Turn turn;
    turn.number = number;
    turn.start_us = number * 100000;
    turn.value_mm.assign(769, sim::not_a_step);
    std::fill(turn.value_mm.begin() + 44, turn.value_mm.begin() + 726, value);
    return turn;
}

class Device : public ::testing::Test
{
  protected:
    ScipDevice make(Protocol protocol, int64_t interval_us = 0)
    {
        return ScipDevice(sim::Scanner{}, {protocol, interval_us, std::nullopt});
    }
    std::string ask(ScipDevice &device, const std::string &command)
    {
        device.receive(command + "\n", now_us);
        return joined(device.answer(now_us));
    }
    std::string turn(ScipDevice &device, const sim::Turn &turn)
    {
        return joined(device.turn(turn, now_us + turn.start_us));
    }

    int64_t now_us = 1000000;
    ScipDevice two = make(Protocol::scip2);
    ScipDevice one = make(Protocol::scip1);
};

TEST_F(Device, says_who_it_is_as_the_recorded_one)
{
    EXPECT_EQ(ask(two, "VV"), "VV\n00P\nVEND:Hokuyo Automatic Co.,Ltd.;[\nPROD:SOKUIKI Sensor URG-04LX;[\n"
                              "FIRM:3.1.04(02/Aug./2007);a\nPROT:SCIP 2.0;N\nSERI:H0706400;F\n\n");
    EXPECT_EQ(ask(two, "PP"), "PP\n00P\nMODL:URG-04LX(Hokuyo Automatic Co.,Ltd.);N\nDMIN:20;4\nDMAX:5600;_\n"
                              "ARES:1024;\\\nAMIN:44;7\nAMAX:725;o\nAFRT:384;6\nSCAN:600;e\n\n");
}

TEST_F(Device, tells_its_condition_with_laser_on_as_the_recorded_one)
{
    now_us = 0x6A5404LL * 1000;
    EXPECT_EQ(ask(two, "BM"), "BM\n00P\n\n");
    EXPECT_EQ(ask(two, "II"), "II\n00P\nMODL:URG-04LX(Hokuyo Automatic Co.,Ltd.);N\nLASR:ON;9\n"
                              "SCSP:Initial(600[rpm])<-Default setting by user;A\nMESM:CLASSIC;^\n"
                              "SBPS:19200[bps]<-Default setting by user;A\nTIME:6A5404;]\n"
                              "STAT:Sensor works well.;8\n\n");
}

TEST_F(Device, tells_its_condition_with_laser_off)
{
    const std::string reply = ask(two, "II");
    EXPECT_NE(reply.find("LASR:OFF;7\n"), std::string::npos);
    EXPECT_NE(reply.find("MESM:IDLE;:\n"), std::string::npos);
}

TEST_F(Device, ends_of_lines_may_be_lf_or_cr_or_both_and_empty_lines_mean_nothing)
{
    two.receive("\nQT\r\n\r\rQT\rQT\n\n", now_us);
    EXPECT_EQ(joined(two.answer(now_us)), "QT\n00P\n\nQT\n00P\n\nQT\n00P\n\n");
}

TEST_F(Device, a_command_may_come_in_pieces)
{
    two.receive("Q", now_us);
    EXPECT_EQ(joined(two.answer(now_us)), "");
    two.receive("T", now_us);
    EXPECT_EQ(joined(two.answer(now_us)), "");
    two.receive("\n", now_us);
    EXPECT_EQ(joined(two.answer(now_us)), "QT\n00P\n\n");
}

TEST_F(Device, echoes_the_string_of_a_command_and_refuses_bad_ones)
{
    EXPECT_EQ(ask(two, "QT;count_12@3"), "QT;count_12@3\n00P\n\n");
    EXPECT_EQ(ask(two, "QT;0123456789abcdef"), "QT;0123456789abcdef\n00P\n\n");
    EXPECT_EQ(ask(two, "QT;0123456789abcdefg"), "QT;0123456789abcdefg\n0Gg\n\n");
    EXPECT_EQ(ask(two, "QT;a-b"), "QT;a-b\n0Hh\n\n");
}

TEST_F(Device, answers_what_it_does_not_know_with_an_error)
{
    EXPECT_EQ(ask(two, "AR00"), "AR00\n0Ee\n\n");
    EXPECT_EQ(ask(two, "%ST"), "%ST\n0Ee\n\n");
    EXPECT_EQ(ask(two, "SCIP2.0"), "SCIP2.0\n0Ee\n\n");
    EXPECT_EQ(ask(two, "G04472501"), "G04472501\n0Ee\n\n");
    EXPECT_EQ(ask(two, "X"), "X\n0Ee\n\n");
}

TEST_F(Device, survives_long_garbage)
{
    const std::string reply = ask(two, std::string(100000, '\x85'));
    EXPECT_LT(reply.size(), 200u);
    EXPECT_EQ(ask(two, "QT"), "QT\n00P\n\n");
}

TEST_F(Device, laser_on_twice_says_already)
{
    EXPECT_EQ(ask(two, "BM"), "BM\n00P\n\n");
    EXPECT_EQ(ask(two, "BM"), "BM\n02R\n\n");
    EXPECT_EQ(ask(two, "QT"), "QT\n00P\n\n");
    EXPECT_EQ(ask(two, "BM"), "BM\n00P\n\n");
}

TEST_F(Device, time_mode_lets_only_itself_through)
{
    EXPECT_EQ(ask(two, "TM1"), "TM1\n04T\n\n");
    EXPECT_EQ(ask(two, "TM2"), "TM2\n03S\n\n");
    EXPECT_EQ(ask(two, "TM0"), "TM0\n00P\n\n");
    EXPECT_EQ(ask(two, "TM0"), "TM0\n02R\n\n");
    now_us = 16000000LL * 1000;
    EXPECT_EQ(ask(two, "TM1"), "TM1\n00P\nm2@0?\n\n");
    EXPECT_EQ(ask(two, "QT"), "QT\n0Ee\n\n");
    EXPECT_EQ(ask(two, "TM3"), "TM3\n01Q\n\n");
    EXPECT_EQ(ask(two, "TM"), "TM\n0Cc\n\n");
    EXPECT_EQ(ask(two, "TM2"), "TM2\n00P\n\n");
    EXPECT_EQ(ask(two, "QT"), "QT\n00P\n\n");
}

TEST_F(Device, settings_answer_by_the_table)
{
    EXPECT_EQ(ask(two, "SS115200"), "SS115200\n00P\n\n");
    EXPECT_EQ(ask(two, "SS115200"), "SS115200\n03S\n\n");
    EXPECT_EQ(ask(two, "SS123456"), "SS123456\n02R\n\n");
    EXPECT_EQ(ask(two, "SS11520x"), "SS11520x\n01Q\n\n");
    EXPECT_EQ(ask(two, "SS9600"), "SS9600\n0Cc\n\n");
    EXPECT_EQ(ask(two, "CR00"), "CR00\n03S\n\n");
    EXPECT_EQ(ask(two, "CR05"), "CR05\n04T\n\n");
    EXPECT_EQ(ask(two, "CR55"), "CR55\n02R\n\n");
    EXPECT_EQ(ask(two, "CRxx"), "CRxx\n01Q\n\n");
    EXPECT_EQ(ask(two, "HS1"), "HS1\n03S\n\n");
    EXPECT_EQ(ask(two, "DB01"), "DB01\n0Ee\n\n");
}

TEST_F(Device, refuses_wrong_requests_for_ranges)
{
    EXPECT_EQ(ask(two, "GD0044072501"), "GD0044072501\n10Q\n\n") << "the laser is off";
    EXPECT_EQ(ask(two, "MDx044072501000"), "MDx044072501000\n01Q\n\n");
    EXPECT_EQ(ask(two, "MD0044x72501000"), "MD0044x72501000\n02R\n\n");
    EXPECT_EQ(ask(two, "MD00440725x1000"), "MD00440725x1000\n03S\n\n");
    EXPECT_EQ(ask(two, "MD0044076901000"), "MD0044076901000\n04T\n\n");
    EXPECT_EQ(ask(two, "MD0725004401000"), "MD0725004401000\n05U\n\n");
    EXPECT_EQ(ask(two, "MD0044072501x00"), "MD0044072501x00\n06V\n\n");
    EXPECT_EQ(ask(two, "MD00440725010x0"), "MD00440725010x0\n07W\n\n");
    EXPECT_EQ(ask(two, "MD004407250100"), "MD004407250100\n0Cc\n\n");
    EXPECT_EQ(ask(two, "GD00440725010"), "GD00440725010\n0Ee\n\n");
    EXPECT_FALSE(two.wanted());
}

TEST_F(Device, streams_the_asked_number_and_turns_the_laser_off)
{
    EXPECT_EQ(ask(two, "MD0380038201002;x"), "MD0380038201002;x\n00P\n\n");
    EXPECT_TRUE(two.wanted());
    // 1234 is "CB" in two characters, "0CB" in three; the stamp 1000 ms is "00?X".
    EXPECT_EQ(turn(two, turn_of(1234)), "MD0380038201001;x\n99b\n00?Xg\n0CB0CB0CBO\n\n");
    EXPECT_EQ(turn(two, turn_of(1234, 1)), "MD0380038201000;x\n99b\n00A<M\n0CB0CB0CBO\n\n");
    EXPECT_EQ(turn(two, turn_of(1234, 2)), "");
    EXPECT_EQ(ask(two, "GD0380038201"), "GD0380038201\n10Q\n\n");
}

TEST_F(Device, streams_until_it_is_told_to_stop)
{
    ask(two, "MS0380038100000");
    for (uint32_t k = 0; k < 150; k++) {
        EXPECT_EQ(turn(two, turn_of(1234, k)).substr(0, 20), "MS0380038100000\n99b\n");
    }
    EXPECT_EQ(ask(two, "MD0044072501000"), "MD0044072501000\n0Bb\n\n") << "one stream at a time";
    EXPECT_EQ(ask(two, "QT"), "QT\n00P\n\n");
    EXPECT_EQ(turn(two, turn_of(1234, 150)), "");
}

TEST_F(Device, leaves_out_the_turns_it_is_told_to_skip)
{
    ask(two, "MD0380038001200");
    std::string sent;
    for (uint32_t k = 0; k < 7; k++) {
        sent += turn(two, turn_of(1234, k)).empty() ? '-' : 'x';
    }
    EXPECT_EQ(sent, "x--x--x");
}

TEST_F(Device, a_cluster_gives_its_nearest_valid_distance)
{
    sim::Turn scan = turn_of(1000);
    scan.value_mm[380] = 7;
    scan.value_mm[382] = 900;
    scan.value_mm[383] = 6;
    scan.value_mm[384] = 0;
    scan.value_mm[385] = 0;
    ask(two, "MD0380038603001");
    // 380..382: 900 = "0>4"; 383..385 all codes: the first, 6 = "006"; 386 alone: 1000 = "0?X".
    EXPECT_EQ(turn(two, scan), "MD0380038603000\n99b\n00?Xg\n0>40060?Xo\n\n");
}

TEST_F(Device, two_characters_saturate)
{
    ask(two, "MS0380038001001");
    EXPECT_EQ(turn(two, turn_of(5000)), "MS0380038001000\n99b\n00?Xg\nooN\n\n");
}

TEST_F(Device, a_whole_scan_has_the_size_the_document_says)
{
    ask(two, "MD0044072501000");
    EXPECT_EQ(turn(two, turn_of(1234)).size(), 2137u);
    ask(two, "QT");
    ask(two, "MS0044072501000");
    EXPECT_EQ(turn(two, turn_of(1234)).size(), 1435u);
}

TEST_F(Device, get_waits_for_the_first_whole_turn)
{
    ask(two, "BM");
    EXPECT_EQ(ask(two, "GD0380038001"), "");
    EXPECT_EQ(joined(two.turn(turn_of(1234), now_us - 50000)), "")
        << "this turn began before the laser was on";
    EXPECT_EQ(turn(two, turn_of(1234)), "GD0380038001\n00P\n00?Xg\n0CBe\n\n");
    EXPECT_EQ(ask(two, "GS0380038001"), "GS0380038001\n00P\n00?Xg\nCB5\n\n");
}

TEST_F(Device, reset_sets_the_clock_to_zero_and_stays_in_scip2)
{
    ask(two, "MD0044072501000");
    ask(two, "SS115200");
    EXPECT_EQ(ask(two, "RS"), "RS\n00P\n\n");
    EXPECT_EQ(turn(two, turn_of(1)), "");
    const std::string condition = ask(two, "II");
    EXPECT_NE(condition.find("TIME:000000;"), std::string::npos);
    EXPECT_NE(condition.find("SBPS:19200"), std::string::npos);
    ask(one, "SCIP2.0");
    EXPECT_EQ(ask(one, "RS"), "RS\n00P\n\n");
    EXPECT_EQ(ask(one, "VV").substr(0, 7), "VV\n00P\n");
}

TEST_F(Device, commands_sent_together_are_answered_in_order_even_after_a_reset)
{
    two.receive("BM\nRS\nBM\nQT\n", now_us);
    EXPECT_EQ(joined(two.answer(now_us)), "BM\n00P\n\nRS\n00P\n\nBM\n00P\n\nQT\n00P\n\n");
}

TEST_F(Device, slow_firmware_serves_a_command_a_turn)
{
    ScipDevice slow = make(Protocol::scip2, 100000);
    slow.receive("QT\nQT\n", now_us);
    EXPECT_EQ(joined(slow.answer(now_us)), "QT\n00P\n\n");
    EXPECT_EQ(joined(slow.answer(now_us + 99000)), "");
    EXPECT_EQ(slow.answer_due_us(), now_us + 100000);
    EXPECT_EQ(joined(slow.answer(now_us + 100000)), "QT\n00P\n\n");
    EXPECT_EQ(slow.answer_due_us(), std::nullopt);
}

TEST_F(Device, a_fault_in_the_stream_is_a_status_without_data)
{
    ask(two, "MD0044072501000");
    two.break_stream("50");
    EXPECT_EQ(turn(two, turn_of(1234)), "MD0044072501000\n50U\n\n");
    EXPECT_EQ(turn(two, turn_of(1234, 1)), "");
}

TEST_F(Device, the_clock_wraps_at_24_bits)
{
    ScipDevice device(sim::Scanner{}, {Protocol::scip2, 0, 2000000});
    ask(device, "TM0");
    now_us = 1999000;
    EXPECT_EQ(ask(device, "TM1"), "TM1\n00P\nooool\n\n");
    now_us = 2000000;
    EXPECT_EQ(ask(device, "TM1"), "TM1\n00P\n00000\n\n");
}

TEST_F(Device, power_up_in_scip1_answers_without_sums)
{
    EXPECT_EQ(ask(one, "V"), "V\n0\nVEND:Hokuyo Automatic Co.,Ltd.\nPROD:SOKUIKI Sensor URG-04LX\n"
                             "FIRM:3.1.04(02/Aug./2007)(20-5600[mm],240[deg],44-725[step],600[rpm])\n"
                             "PROT:SCIP 1.1\nSERI:H0706400\n\n");
    EXPECT_EQ(ask(one, "QT"), "QT\nE\n\n");
    EXPECT_EQ(ask(one, "VV"), "VV\nE\n\n");
    EXPECT_EQ(ask(one, "L1"), "L1\n2\n\n");
    EXPECT_EQ(ask(one, "L0"), "L0\n0\n\n");
    EXPECT_EQ(ask(one, "L1"), "L1\n0\n\n");
    EXPECT_EQ(ask(one, "S1152000000000"), "S1152000000000\n0\n\n");
    EXPECT_EQ(ask(one, "S1152000000000x"), "S1152000000000x\nE\n\n");
    EXPECT_EQ(ask(one, "S1234560000000"), "S1234560000000\n1\n\n");
}

TEST_F(Device, scip1_gives_all_steps_with_the_dead_ones_as_code_19)
{
    EXPECT_EQ(ask(one, "G00076801"), "");
    const std::string reply = turn(one, turn_of(1234));
    EXPECT_EQ(reply.size(), std::string("G00076801\n0\n").size() + 1538 + 25 + 1);
    EXPECT_EQ(reply.substr(0, 12 + 64),
              "G00076801\n0\n0C0C0C0C0C0C0C0C0C0C0C0C0C0C0C0C0C0C0C0C0C0C0C0C0C0C0C0C0C0C0C0C");
    EXPECT_EQ(ask(one, "G38438401"), "G38438401\n0\nCB\n\n");
    EXPECT_EQ(ask(one, "G38438301"), "G38438301\nE\n\n");
    EXPECT_EQ(ask(one, "G384x8401"), "G384x8401\nE\n\n");
}

TEST_F(Device, switches_from_scip1_to_2_unless_its_firmware_is_too_old)
{
    EXPECT_EQ(ask(one, "SCIP2.0"), "SCIP2.0\n0\n\n");
    EXPECT_EQ(ask(one, "QT"), "QT\n00P\n\n");
    ScipDevice old = make(Protocol::scip1_only);
    EXPECT_EQ(ask(old, "SCIP2.0"), "SCIP2.0\nE\n\n");
    EXPECT_EQ(ask(old, "V").substr(0, 4), "V\n0\n");
}

TEST_F(Device, a_power_cycle_forgets_everything)
{
    ask(two, "MD0044072501000");
    two.power_up_in_scip1(now_us);
    EXPECT_EQ(turn(two, turn_of(1)), "");
    EXPECT_EQ(ask(two, "QT"), "QT\nE\n\n");
    two.power_up(now_us);
    EXPECT_EQ(ask(two, "QT"), "QT\n00P\n\n");
}

} // namespace
