// Faults: the grammar, when they strike, and what they do to a frame.
#include <gtest/gtest.h>

#include "common/command_line/wrong_use.h"
#include "lab/sim/faults.h"

namespace
{

using sim::FaultKind;
using sim::Faults;

const std::string frame = "MD0044072501000\n99b\n0000 and the ranges\n\n";

TEST(Faults, the_grammar_is_read)
{
    const auto faults = sim::parse_faults("flip@5,garbage:40@1.5,silence@#20,unplug:0.5@9");
    ASSERT_EQ(faults.size(), 4u);
    EXPECT_EQ(faults[0].at_us, 5000000);
    EXPECT_EQ(faults[1].argument, 40);
    EXPECT_EQ(faults[2].at_scan, 20);
    EXPECT_EQ(faults[2].argument, 2);
    EXPECT_EQ(faults[3].argument, 0.5);
    EXPECT_TRUE(sim::parse_faults("").empty());
}

TEST(Faults, wrong_grammar_is_wrong_use)
{
    for (const char *wrong :
         {"flip", "flap@3", "flip@", "flip@x", "flip@-1", "flip:3@1", "garbage:@1", "garbage:x@1", "wrap@#5",
          "@4", "silence:99999@1", "hardware:98@1", ",", "flip@1,,cut@2"}) {
        EXPECT_THROW(sim::parse_faults(wrong), cli::WrongUse) << wrong;
    }
}

TEST(Faults, a_flip_changes_one_bit_once)
{
    Faults faults("flip@#3", 1);
    EXPECT_EQ(faults.damage(frame, 0, 2), frame);
    const std::string damaged = faults.damage(frame, 0, 3);
    ASSERT_EQ(damaged.size(), frame.size());
    int bits = 0;
    for (size_t k = 0; k < frame.size(); k++) {
        bits += __builtin_popcount(static_cast<unsigned char>(damaged[k] ^ frame[k]));
    }
    EXPECT_EQ(bits, 1);
    EXPECT_EQ(faults.damage(frame, 0, 4), frame);
}

TEST(Faults, the_other_faults_of_a_frame)
{
    EXPECT_EQ(Faults("cut@1", 1).damage(frame, 1000000, 0), frame.substr(0, frame.size() / 2));
    EXPECT_EQ(Faults("repeat@1", 1).damage(frame, 1000000, 0), frame + frame);
    const std::string noisy = Faults("garbage:300@1", 1).damage(frame, 1000000, 0);
    EXPECT_EQ(noisy.size(), frame.size() + 300);
    EXPECT_EQ(noisy.substr(300), frame);
    EXPECT_EQ(Faults("cut@1", 1).damage(frame, 999999, 0), frame) << "not yet";
}

TEST(Faults, the_same_seed_flips_the_same_bit)
{
    EXPECT_EQ(Faults("flip@1", 7).damage(frame, 1000000, 0), Faults("flip@1", 7).damage(frame, 1000000, 0));
}

TEST(Faults, those_of_the_link_are_handed_out_once_at_their_time)
{
    Faults faults("unplug@2,silence@1,reset11@#7,flip@0", 1);
    EXPECT_EQ(faults.next_due_us(), 1000000);
    EXPECT_TRUE(faults.due(999999, 0).empty());
    ASSERT_EQ(faults.due(1000000, 0).size(), 1u);
    EXPECT_EQ(faults.next_due_us(), 2000000);
    const auto both = faults.due(3000000, 7);
    ASSERT_EQ(both.size(), 2u);
    EXPECT_EQ(both[0].kind, FaultKind::unplug);
    EXPECT_EQ(both[1].kind, FaultKind::reset11);
    EXPECT_TRUE(faults.due(9000000, 9).empty());
    EXPECT_EQ(faults.next_due_us(), INT64_MAX);
}

TEST(Faults, the_wrap_is_known_from_the_start)
{
    EXPECT_EQ(Faults("flip@1,wrap@12.5", 1).wrap_us(), 12500000);
    EXPECT_EQ(Faults("flip@1", 1).wrap_us(), std::nullopt);
}

} // namespace
