// An RPLIDAR on its line, in virtual time: conversation, rates, health, motor, recovery.
#include <deque>

#include "drivers/scanner/rotary/rotary_on_line.hpp"
#include "drivers/scanner/rplidar/rplidar_bytes.hpp"

namespace
{

using namespace ale_test;

class FakeRplidar : public FakeRotary
{
  public:
    unsigned model = 0x18;
    unsigned firmware = 0x0114;
    unsigned typical_type = 0x82; // of GET_CONF
    double sample_us = 250;       // of the scan that runs
    unsigned health = 0, error = 0;
    bool recovers_by_reset = false;
    bool mute = false;
    std::vector<unsigned> commands;
    bool motor_needs_dtr_off = true;
    bool turns_by_command = false;
    bool measures = true;

    FakeRplidar()
    {
        sensor_baud = 115200;
    }
    void hear(const std::string &bytes) override
    {
        heard_ += port_baud == sensor_baud ? bytes : "";
        while (heard_.size() >= 2) {
            const bool loaded = (heard_[1] & 0x80) != 0;
            const size_t size = !loaded             ? 2
                                : heard_.size() < 3 ? SIZE_MAX
                                                    : 4U + static_cast<uint8_t>(heard_[2]);
            if (heard_.size() < size) {
                return;
            }
            obey(heard_.substr(0, size));
            heard_.erase(0, size);
        }
    }

  protected:
    int64_t next_us() const override
    {
        const int64_t answer_us = answers_.empty() ? INT64_MAX : answers_.front().first;
        return std::min(answer_us, type_ == 0 ? INT64_MAX : piece_us());
    }
    void go_on() override
    {
        while (!answers_.empty() && answers_.front().first <= now_us) {
            say(answers_.front().second);
            answers_.pop_front();
        }
        while (type_ != 0 && piece_us() <= now_us) {
            if (turning()) {
                say(piece());
            }
            number_++;
        }
    }
    void power_up() override
    {
        type_ = 0;
        turns_ = false;
        answers_.clear();
        heard_.clear();
    }

  private:
    std::string heard_;
    std::deque<std::pair<int64_t, std::string>> answers_;
    unsigned type_ = 0;
    bool turns_ = false;
    int64_t number_ = 0;
    int64_t begun_us_ = 0;

    bool turning() const
    {
        return measures && (turns_by_command ? turns_ : dtr == 0);
    }
    int points() const
    {
        return type_ == 0x81 ? 1 : type_ == 0x82 ? 32 : 40;
    }
    int64_t piece_us() const
    {
        const double bytes = type_ == 0x81 ? 5 : 84;
        const double last = static_cast<double>((number_ + 1) * points() - 1) * sample_us;
        return begun_us_ + std::llround(last + bytes * 1e7 / sensor_baud);
    }
    std::string piece() const
    {
        const double step = 3600e-6 * sample_us; // ten turns a second
        const double degrees = std::fmod(static_cast<double>(number_ * points()) * step, 360);
        const std::vector<unsigned> mm(40, 1500);
        switch (type_) {
        case 0x81:
            return node(degrees, 1500, degrees < step);
        case 0x82:
            return express_capsule(degrees, number_ == 0, mm, 0);
        default:
            return dense_capsule(degrees, number_ == 0, mm);
        }
    }
    void reply(const std::string &bytes)
    {
        if (!mute) {
            answers_.emplace_back(now_us + 2000, bytes);
        }
    }
    void begin(unsigned type)
    {
        if (health == 2) {
            return;
        }
        reply(descriptor(type == 0x81 ? 5 : 84, type, true));
        type_ = type;
        number_ = 0;
        begun_us_ = now_us + 4000;
    }
    void conf(const std::string &request)
    {
        const unsigned entry = static_cast<uint8_t>(request[3]);
        const std::string head = little(entry, 4);
        if (entry == 0x7c) {
            reply(answer(0x20, head + little(1, 2)));
        } else if (entry == 0x75) {
            reply(answer(0x20, head + little(typical_type, 1)));
        } else if (entry == 0x71) {
            reply(answer(0x20, head + little(static_cast<uint64_t>(256 * sample_us), 4)));
        }
    }
    void obey(const std::string &request)
    {
        commands.push_back(static_cast<uint8_t>(request[1]));
        switch (commands.back()) {
        case 0x25:
            type_ = 0;
            break;
        case 0x40:
            power_up();
            health = recovers_by_reset ? 0 : health;
            break;
        case 0x50:
            reply(answer(0x04,
                         little(model, 1) + little(firmware, 2) + little(7, 1) + std::string(16, '\x1f')));
            break;
        case 0x52:
            reply(answer(0x06, little(health, 1) + little(error, 2)));
            break;
        case 0x59:
            reply(answer(0x15, little(500, 2) + little(static_cast<uint64_t>(sample_us), 2)));
            break;
        case 0x84:
            conf(request);
            break;
        case 0xa8:
        case 0xf0:
            turns_ = true;
            break;
        case 0x20:
            begin(0x81);
            break;
        case 0x82:
            begin(model == 0x18 ? 0x82 : typical_type);
            break;
        default:
            break;
        }
    }
};

class RplidarDevice : public RotaryOnLine
{
  protected:
    FakeRplidar sensor;

    void SetUp() override
    {
        put_on_line(sensor, "rplidar");
    }
    bool was_sent(unsigned command) const
    {
        return std::count(sensor.commands.begin(), sensor.commands.end(), command) > 0;
    }
};

TEST_F(RplidarDevice, AnA1GivesItsExpressScan)
{
    run_for(10);
    EXPECT_NEAR(static_cast<double>(scans()), 95, 4);
    EXPECT_EQ(lost(), 0);
    EXPECT_STREQ(health().identity.model, "RPLIDAR A1M8");
    EXPECT_STREQ(health().identity.firmware, "1.20");
    EXPECT_STREQ(health().identity.serial, "1F1F1F1F1F1F1F1F1F1F1F1F1F1F1F1F");
    EXPECT_EQ(sensor.dtr, 0) << "its motor turns while DTR is off";
    EXPECT_NEAR(answers.back().scan.beams, 400, 3);
    EXPECT_NEAR(health().scan_period_us, 100000, 300);
    EXPECT_STREQ(health().status, "");
    scanner.reset();
    EXPECT_EQ(sensor.commands.back(), 0x25U);
    EXPECT_EQ(sensor.dtr, 1) << "and stands afterwards";
}

TEST_F(RplidarDevice, FirmwareBeforeTheExpressScanGivesTheStandardOne)
{
    sensor.firmware = 0x010f;
    sensor.sample_us = 500;
    run_for(6);
    EXPECT_TRUE(was_sent(0x20));
    EXPECT_FALSE(was_sent(0x82));
    EXPECT_NEAR(answers.back().scan.beams, 200, 3);
    EXPECT_EQ(lost(), 0);
}

TEST_F(RplidarDevice, AnS2IsFoundAtItsRateAndTurnsByCommand)
{
    sensor.model = 0x71;
    sensor.typical_type = 0x85;
    sensor.sample_us = 31.25;
    sensor.sensor_baud = 1000000;
    sensor.turns_by_command = true;
    EXPECT_LT(seconds_to_scan(15), 8);
    EXPECT_EQ(health().baud, 1000000);
    run_for(5);
    EXPECT_TRUE(was_sent(0xa8));
    EXPECT_EQ(lost(), 0);
    EXPECT_GT(answers.back().scan.beams, 700);
    EXPECT_STREQ(health().identity.model, "RPLIDAR S2M1");
}

TEST_F(RplidarDevice, ACodingThatIsNotReadIsNotAskedFor)
{
    sensor.model = 0x28;
    sensor.firmware = 0x011d;
    sensor.typical_type = 0x84; // both modes, so the standard scan is left
    sensor.sample_us = 500;
    sensor.turns_by_command = true;
    run_for(6);
    EXPECT_FALSE(was_sent(0x82));
    EXPECT_TRUE(was_sent(0x20));
    EXPECT_GT(scans(), 20U);
}

TEST_F(RplidarDevice, AWarningIsToldAndTheScanGoesOn)
{
    sensor.health = 1;
    sensor.error = 77;
    run_for(5);
    EXPECT_GT(scans(), 20U);
    EXPECT_STREQ(health().status, "it says of itself: a warning, code 77");
}

TEST_F(RplidarDevice, AFaultThatAResetMendsIsMended)
{
    sensor.health = 2;
    sensor.recovers_by_reset = true;
    EXPECT_LT(seconds_to_scan(10), 5);
    EXPECT_EQ(health().hardware_faults, 1U);
    EXPECT_TRUE(was_sent(0x40));
}

TEST_F(RplidarDevice, AFaultThatStaysIsNamed)
{
    sensor.health = 2;
    sensor.error = 0x8001;
    run_for(10);
    EXPECT_TRUE(answers.empty());
    EXPECT_TRUE(was_said("it says of itself: a fault of its hardware, code 32769")) << health().status;
}

TEST_F(RplidarDevice, AMotorThatDoesNotTurnIsNamed)
{
    sensor.measures = false;
    run_for(8);
    EXPECT_TRUE(was_said("it answers, but measures nothing: its motor does not turn")) << health().status;
    sensor.measures = true;
    EXPECT_LT(seconds_to_scan(8), 5);
}

TEST_F(RplidarDevice, ALineWithoutAnswersIsNamed)
{
    sensor.mute = true;
    run_for(8);
    EXPECT_TRUE(was_said("not a byte comes from it")) << health().status;
}

TEST_F(RplidarDevice, ItComesBackWithinThreeSeconds)
{
    for (const double seconds : {0.2, 2.0, 20.0}) {
        seconds_to_scan(8);
        sensor.absent_from_us = sensor.now_us;
        sensor.absent_to_us = sensor.now_us + static_cast<int64_t>(seconds * 1e6);
        run_for(seconds);
        EXPECT_LT(seconds_to_scan(5), 3) << seconds;
    }
    EXPECT_EQ(lost(), 0);
}

TEST_F(RplidarDevice, WhatAnotherClientLeftRunningIsStopped)
{
    sensor.hear("\xa5\x20");
    sensor.dtr = 0;
    EXPECT_LT(seconds_to_scan(5), 2);
}

TEST_F(RplidarDevice, AnotherSerialNumberIsRefused)
{
    config.serial = "ABCD";
    run_for(5);
    EXPECT_TRUE(answers.empty());
    EXPECT_TRUE(was_said("has the serial number \"1F1F"));
}

TEST_F(RplidarDevice, ARecordingReplaysAsTheRobotSawIt)
{
    run_for(4);
    sensor.silent_from_us = sensor.now_us;
    sensor.silent_to_us = sensor.now_us + 1500000;
    run_for(8);
    EXPECT_GT(scans(), 60U);
    expect_the_recording_replays();
}

TEST_F(RplidarDevice, ARecordingOfADenseScanReplaysAtTheRateOfItsModel)
{
    sensor.model = 0x71;
    sensor.typical_type = 0x85;
    sensor.sample_us = 31.25;
    sensor.sensor_baud = config.baud = 1000000;
    sensor.turns_by_command = true;
    run_for(6);
    EXPECT_GT(scans(), 20U);
    expect_the_recording_replays();
}

TEST_F(RplidarDevice, ARecordingFromTheMiddleIsRefusedInWords)
{
    run_for(4);
    start_recording_anew();
    run_for(6);
    EXPECT_EQ(why_the_recording_is_refused(),
              "memory: no scan can be made of its bytes (one of an RPLIDAR must begin before its scan did)");
}

TEST_F(RplidarDevice, AutoFindsIt)
{
    config.family = "auto";
    EXPECT_LT(seconds_to_scan(20), 10);
    EXPECT_STREQ(health().identity.model, "RPLIDAR A1M8");
}

} // namespace
