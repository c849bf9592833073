// A driver on a fake rotary scanner, in virtual time.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "drivers/scanner/rotary/fake_rotary.hpp"

extern "C" {
#include "log/log.h"
#include "scanner/scanner.h"
#include "store/recording.h"
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
    std::string recording = "ALESCIP1"; // of all that passed
    std::vector<std::string> said;      // every status, once
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
        config.tap = [](void *user, bool out, const uint8_t *bytes, uint32_t count, int64_t host_us) {
            auto *self = static_cast<RotaryOnLine *>(user);
            self->record(out ? ALE_CHUNK_SENT : ALE_CHUNK_RECEIVED, host_us, bytes, count);
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
    void record(ale_chunk_kind_t kind, int64_t host_us, const uint8_t *bytes, uint32_t count)
    {
        std::string chunk(count + ALE_CHUNK_FRAME_BYTES, '\0');
        ale_chunk_put(reinterpret_cast<uint8_t *>(chunk.data()), kind, host_us, bytes, count);
        recording += chunk;
    }
    void start_recording_anew()
    {
        recording = "ALESCIP1";
    }
    std::string why_the_recording_is_refused() const
    {
        ale_log_t *log = nullptr;
        ale_log_error_t error{};
        if (ale_log_open_memory(&log, reinterpret_cast<const uint8_t *>(recording.data()), recording.size(),
                                &error) == 0) {
            ale_log_close(log);
        }
        return error.message;
    }
    int scans_in_the_recording() const
    {
        ale_log_t *log = nullptr;
        ale_log_error_t error{};
        EXPECT_EQ(ale_log_open_memory(&log, reinterpret_cast<const uint8_t *>(recording.data()),
                                      recording.size(), &error),
                  0)
            << error.message;
        auto event = std::make_unique<ale_log_event_t>();
        int scans = 0;
        while (log && ale_log_next(log, event.get()) > 0) {
            scans += event->kind == ALE_LOG_SCAN;
        }
        ale_log_close(log);
        return scans;
    }
    // A reader of recordings makes the same scans and losses of what passed.
    void expect_the_recording_replays()
    {
        ale_log_t *log = nullptr;
        ale_log_error_t error;
        ASSERT_EQ(ale_log_open_memory(&log, reinterpret_cast<const uint8_t *>(recording.data()),
                                      recording.size(), &error),
                  0)
            << error.message;
        EXPECT_FALSE(ale_log_info(log)->urg_noise);
        EXPECT_STREQ(ale_log_info(log)->scanner, health().identity.model);
        auto event = std::make_unique<ale_log_event_t>();
        for (const Answer &answer : answers) {
            ASSERT_EQ(ale_log_next(log, event.get()), 1);
            ASSERT_EQ(event->kind, answer.lost ? ALE_LOG_SCAN_LOST : ALE_LOG_SCAN);
            ASSERT_EQ(event->stamp_us, answer.scan.stamp_us);
            ASSERT_EQ(event->scan.beams, answer.scan.beams);
            ASSERT_EQ(event->scan.beam_time_ns, answer.scan.beam_time_ns);
            for (int k = 0; k < answer.scan.beams; k++) {
                ASSERT_EQ(event->scan.range_um[k], answer.scan.range_um[k]);
                ASSERT_EQ(event->scan.flag[k], answer.scan.flag[k]);
                ASSERT_EQ(event->scan.bearing_bam[k], answer.scan.bearing_bam[k]);
            }
        }
        EXPECT_EQ(ale_log_next(log, event.get()), 0);
        ale_log_close(log);
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
