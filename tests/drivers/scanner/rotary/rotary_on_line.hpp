// A driver on a fake rotary scanner, in virtual time.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "drivers/scanner/rotary/fake_rotary.hpp"

extern "C" {
#include "scanner/scanner.h"
}

namespace ale_test
{

class RotaryOnLine : public testing::Test
{
  protected:
    struct Answer {
        bool lost;
        int64_t at_us; // when it came out
        ale_scan_t scan;
    };
    ale_scanner_config_t config{};
    std::vector<Answer> answers;
    std::string received, transmitted;
    std::vector<std::string> said; // every status, once
    std::unique_ptr<ale_scanner_t, decltype(&ale_scanner_close)> scanner{nullptr, ale_scanner_close};

    void TearDown() override
    {
        scanner.reset(); // while what is on the line is there
    }
    void put_on_line(FakeRotary &rotary, const char *family)
    {
        on_the_line = &rotary;
        config.family = family;
        config.path = "fake";
        config.now_us = time_on_the_line;
        config.tap_user = this;
        config.tap = [](void *user, bool out, const uint8_t *bytes, uint32_t count, int64_t) {
            auto *self = static_cast<RotaryOnLine *>(user);
            (out ? self->transmitted : self->received).append(bytes, bytes + count);
        };
    }
    const ale_scanner_health_t &health() const
    {
        return *ale_scanner_health(scanner.get());
    }
    bool was_said(const std::string &words) const
    {
        return std::any_of(said.begin(), said.end(),
                           [&](const std::string &s) { return s.find(words) != std::string::npos; });
    }
    void run_for(double seconds)
    {
        if (!scanner) {
            scanner.reset(ale_scanner_open(&config));
        }
        auto scan = std::make_unique<ale_scan_t>();
        const int64_t until_us = on_the_line->now_us + static_cast<int64_t>(seconds * 1e6);
        while (on_the_line->now_us < until_us) {
            const int64_t before_us = on_the_line->now_us;
            const ale_scanner_event_t event = ale_scanner_step(scanner.get(), scan.get());
            ASSERT_LE(on_the_line->now_us - before_us, 51000) << "a step blocks no longer than 50 ms";
            if (event == ALE_SCANNER_SCAN || event == ALE_SCANNER_SCAN_LOST) {
                answers.push_back({event == ALE_SCANNER_SCAN_LOST, on_the_line->now_us, *scan});
            }
            if (said.empty() || said.back() != health().status) {
                said.emplace_back(health().status);
            }
        }
    }
    // Runs until a scan comes; the time that took.
    double seconds_to_scan(double most)
    {
        const int64_t begin_us = on_the_line->now_us;
        const size_t before = answers.size();
        while (on_the_line->now_us < begin_us + static_cast<int64_t>(most * 1e6)) {
            run_for(0.01);
            if (answers.size() > before && !answers.back().lost) {
                break;
            }
        }
        return static_cast<double>(on_the_line->now_us - begin_us) * 1e-6;
    }
    int lost() const
    {
        return static_cast<int>(
            std::count_if(answers.begin(), answers.end(), [](auto &a) { return a.lost; }));
    }
    size_t scans() const
    {
        return answers.size() - static_cast<size_t>(lost());
    }
};

} // namespace ale_test
