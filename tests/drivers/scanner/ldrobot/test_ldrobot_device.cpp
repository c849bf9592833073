// An LD06 on its line, in virtual time: what works, and what is said of what does not.
#include <cmath>
#include <functional>

#include "drivers/scanner/ldrobot/ldrobot_packet.hpp"
#include "drivers/scanner/rotary/rotary_on_line.hpp"

namespace
{

class FakeLd06 : public ale_test::FakeRotary
{
  public:
    double turns_a_second = 10;
    int64_t stalled_from_us = -1, stalled_to_us = -1;
    std::function<std::string(const std::string &, int64_t)> garble; // packet and its number
    int64_t delay_us = 0;

    static double time_us(int64_t point)
    {
        return static_cast<double>(point) * 1e6 / 4500;
    }

  protected:
    int64_t next_us() const override
    {
        return std::llround(time_us(12 * packet_ + 11)) + 2040 + delay_us;
    }
    void go_on() override
    {
        while (next_us() <= now_us) {
            send();
        }
    }
    void power_up() override
    {
        clock_zero_us_ = now_us;
    }

  private:
    int64_t packet_ = 1875; // at now_us
    int64_t clock_zero_us_ = 0;
    double degrees_ = 0;

    void send()
    {
        const bool stalled = now_us >= stalled_from_us && now_us < stalled_to_us;
        const double step = stalled ? 0 : turns_a_second * 360 / 4500;
        const auto end_us = std::llround(time_us(12 * packet_ + 11));
        ale_test::LdrobotPacket packet;
        packet.speed_deg_s = stalled ? 0 : static_cast<unsigned>(std::lround(turns_a_second * 360));
        packet.start = static_cast<unsigned>(std::lround(degrees_ * 100)) % 36000;
        packet.end = static_cast<unsigned>(std::lround((degrees_ + 11 * step) * 100)) % 36000;
        packet.stamp_ms = static_cast<unsigned>((end_us - clock_zero_us_) / 1000 % 30000);
        const std::string bytes = packet.bytes();
        say(garble ? garble(bytes, packet_) : bytes);
        degrees_ = std::fmod(degrees_ + 12 * step, 360);
        packet_++;
    }
};

class LdrobotDevice : public ale_test::RotaryOnLine
{
  protected:
    FakeLd06 sensor;

    void SetUp() override
    {
        put_on_line(sensor, "ldrobot");
    }
};

TEST_F(LdrobotDevice, EveryTurnIsAScan)
{
    run_for(10);
    EXPECT_NEAR(static_cast<double>(answers.size()), 98, 2);
    EXPECT_EQ(lost(), 0);
    EXPECT_EQ(health().state, ALE_SCANNER_STREAMING);
    EXPECT_STREQ(health().identity.model, "LDROBOT LD06, LD19 or STL-19P");
    EXPECT_EQ(health().baud, 230400);
    EXPECT_EQ(health().scans, answers.size());
    EXPECT_EQ(health().garbage_bytes + health().bad_checksum, 0U);
    EXPECT_NEAR(health().scan_period_us, 100000, 300);
    EXPECT_STREQ(health().status, "");
    EXPECT_TRUE(transmitted.empty()) << "it hears nothing";
    EXPECT_EQ(received.size() % 47, 0U);
}

TEST_F(LdrobotDevice, TheTimeOfABeamIsThatAtWhichTheHeadLookedThere)
{
    run_for(20);
    for (size_t k = 20; k < answers.size(); k++) {
        const ale_scan_t &scan = answers[k].scan;
        const double ahead_us = static_cast<double>(scan.stamp_us + ale_scan_beam_offset_us(&scan, 0)) +
                                static_cast<double>(0U - scan.first_bearing_bam) / 4294967296.0 * -100000;
        EXPECT_LT(std::fabs(std::remainder(ahead_us, 100000)), 1300) << "stamps count in whole milliseconds";
    }
}

TEST_F(LdrobotDevice, AWrongRateIsNamed)
{
    config.baud = 115200;
    run_for(5);
    EXPECT_TRUE(answers.empty());
    EXPECT_TRUE(was_said("bytes at 115200 bit/s and no packet among them: a wrong rate")) << health().status;
}

TEST_F(LdrobotDevice, SilenceIsNamed)
{
    sensor.silent_from_us = 0;
    sensor.silent_to_us = 100000000;
    run_for(5);
    EXPECT_TRUE(was_said("not a byte comes from it: is it supplied with 5 V"));
}

TEST_F(LdrobotDevice, AMotorThatDoesNotTurnIsNamedAndComesBack)
{
    run_for(3);
    sensor.stalled_from_us = sensor.now_us;
    sensor.stalled_to_us = sensor.now_us + 4000000;
    run_for(4);
    EXPECT_TRUE(was_said("its motor does not turn")) << health().status;
    EXPECT_LT(seconds_to_scan(3), 0.5);
    EXPECT_STREQ(health().status, "");
}

TEST_F(LdrobotDevice, ASupplyThatSagsIsNamed)
{
    run_for(3);
    sensor.turns_a_second = 7;
    run_for(5);
    EXPECT_TRUE(was_said("its head turns 7.1 times a second instead of 10: its 5 V supply sags"))
        << health().status;
    EXPECT_EQ(health().state, ALE_SCANNER_STREAMING);
    sensor.turns_a_second = 10;
    run_for(5);
    EXPECT_STREQ(health().status, "");
    EXPECT_LE(lost(), 2);
}

TEST_F(LdrobotDevice, ItComesBackAfterAnyUnpluggingInTime)
{
    for (const double seconds : {0.2, 1.0, 5.0, 60.0}) {
        seconds_to_scan(5);
        sensor.absent_from_us = sensor.now_us;
        sensor.absent_to_us = sensor.now_us + static_cast<int64_t>(seconds * 1e6);
        run_for(seconds);
        EXPECT_LT(seconds_to_scan(5), 1) << seconds;
    }
    EXPECT_GE(health().reopens, 4U);
    EXPECT_EQ(lost(), 0) << "what nobody sent is no loss";
}

TEST_F(LdrobotDevice, ASilenceIsOverAtOnce)
{
    run_for(2);
    sensor.silent_from_us = sensor.now_us;
    sensor.silent_to_us = sensor.now_us + 2000000;
    run_for(2);
    EXPECT_LT(seconds_to_scan(3), 1);
}

TEST_F(LdrobotDevice, OneDamagedPacketCostsNoScan)
{
    run_for(2);
    sensor.garble = [](const std::string &packet, int64_t number) {
        std::string bad = packet;
        bad[20] = static_cast<char>(number % 38 == 0 ? bad[20] + 1 : bad[20]);
        return bad;
    };
    const size_t before = answers.size();
    run_for(10);
    EXPECT_EQ(lost(), 0);
    EXPECT_NEAR(static_cast<double>(answers.size() - before), 100, 1);
    EXPECT_NEAR(static_cast<double>(health().bad_checksum), 99, 2);
}

TEST_F(LdrobotDevice, GarbageIsCountedAndTheTurnsGoOn)
{
    sensor.garble = [](const std::string &packet, int64_t number) {
        return number % 100 == 0 ? std::string(300, '\x54') + packet : packet;
    };
    run_for(10);
    EXPECT_EQ(lost(), 0);
    EXPECT_GT(health().garbage_bytes, 8000U);
    EXPECT_NEAR(static_cast<double>(answers.size()), 98, 2);
}

TEST_F(LdrobotDevice, ASerialNumberThatIsAskedForIsNotMadeUp)
{
    config.serial = "H0706400";
    run_for(3);
    EXPECT_TRUE(answers.empty());
    EXPECT_TRUE(was_said("has the serial number \"\", not H0706400"));
}

TEST_F(LdrobotDevice, ARecordingReplaysAsTheRobotSawIt)
{
    sensor.garble = [](const std::string &packet, int64_t number) {
        return number % 400 == 0 ? packet.substr(0, 20) : number % 300 == 0 ? "" : packet;
    };
    run_for(4);
    sensor.silent_from_us = sensor.now_us;
    sensor.silent_to_us = sensor.now_us + 1500000;
    run_for(6);
    EXPECT_GT(scans(), 60U);
    expect_the_recording_replays();
}

TEST_F(LdrobotDevice, ARecordingFromTheMiddleReplaysFromItsFirstWholeTurn)
{
    run_for(4);
    start_recording_anew();
    run_for(4);
    EXPECT_NEAR(scans_in_the_recording(), 39, 2);
}

TEST_F(LdrobotDevice, AutoFindsIt)
{
    config.family = "auto";
    EXPECT_LT(seconds_to_scan(5), 1);
    EXPECT_STREQ(health().identity.model, "LDROBOT LD06, LD19 or STL-19P");
}

} // namespace
