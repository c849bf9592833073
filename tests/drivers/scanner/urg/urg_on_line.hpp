// A driver on a fake sensor, in virtual time.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "drivers/scanner/urg/fake_sensor.hpp"

extern "C" {
#include "scanner/scanner.h"
}

namespace ale_test
{

constexpr int64_t second_us = 1000000;

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
    ale_scanner_config_t config{};
    std::vector<Answer> answers;
    std::string received, transmitted;
    std::unique_ptr<ale_scanner_t, decltype(&ale_scanner_close)> urg{nullptr, ale_scanner_close};

    void SetUp() override
    {
        on_the_line = &sensor;
        config.path = "fake";
        config.now_us = time_on_the_line;
        config.tap_user = this;
        config.tap = [](void *user, bool out, const uint8_t *bytes, uint32_t count, int64_t) {
            auto *self = static_cast<UrgDevice *>(user);
            (out ? self->transmitted : self->received).append(bytes, bytes + count);
        };
    }
    const ale_scanner_health_t &health() const
    {
        return *ale_scanner_health(urg.get());
    }
    void run_until(int64_t until_us)
    {
        if (!urg) {
            urg.reset(ale_scanner_open(&config));
        }
        auto scan = std::make_unique<ale_scan_t>();
        while (sensor.now_us < until_us) {
            const int64_t before_us = sensor.now_us;
            const ale_scanner_event_t event = ale_scanner_step(urg.get(), scan.get());
            ASSERT_LE(sensor.now_us - before_us, 51000) << "a step blocks no longer than 50 ms";
            if (event == ALE_SCANNER_SCAN) {
                const int64_t step_0_us =
                    scan->stamp_us + int64_t{44 + scan->stamp_beam} * scan->beam_time_ns / 1000;
                answers.push_back(
                    {scan->range_um[0] / 1000 - sensor.value_base, sensor.now_us, step_0_us, *scan});
            } else if (event == ALE_SCANNER_SCAN_LOST) {
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

} // namespace ale_test
