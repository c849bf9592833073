#include <gtest/gtest.h>

#include <atomic>
#include <cstring>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>

#include "comes_true.hpp"

extern "C" {
#include "acquire/acquire.h"
#include "config/config_keys.h"
#include "scanner/scanner.h"
}

/* A driver that does what the test says, in place of the one that speaks to a port. */
struct ale_scanner {
    ale_scanner_config_t config;
    ale_scanner_health_t health;
};

namespace
{

struct Script {
    std::mutex lock;
    std::deque<ale_scanner_event_t> events;
    int64_t next_stamp_us = 1000;
    ale_scanner_config_t config{};
    std::atomic<int> destroyed{0};
    std::atomic<bool> refuse{false};
    const char *model = ""; // that it tells
} script;

} // namespace

extern "C" ale_scanner_t *ale_scanner_open(const ale_scanner_config_t *config)
{
    if (script.refuse) {
        return nullptr;
    }
    script.config = *config;
    auto *scanner = new ale_scanner{};
    scanner->config = *config;
    return scanner;
}

extern "C" ale_scanner_event_t ale_scanner_step(ale_scanner_t *scanner, ale_scan_t *scan)
{
    const std::lock_guard<std::mutex> guard(script.lock);
    if (script.events.empty()) {
        std::this_thread::yield();
        return ALE_SCANNER_IDLE;
    }
    const ale_scanner_event_t event = script.events.front();
    script.events.pop_front();
    if (event == ALE_SCANNER_SCAN || event == ALE_SCANNER_SCAN_LOST) {
        scan->stamp_us = script.next_stamp_us++;
        scan->beams = 682;
        scanner->health.scans += event == ALE_SCANNER_SCAN;
        scanner->health.scans_lost += event == ALE_SCANNER_SCAN_LOST;
        scanner->health.arrival_us = scanner->config.now_us(scanner->config.now_user);
    } else {
        scanner->health.state = ALE_SCANNER_STREAMING;
        std::strcpy(scanner->health.identity.model, script.model);
    }
    return event;
}

extern "C" const ale_scanner_health_t *ale_scanner_health(const ale_scanner_t *scanner)
{
    return &scanner->health;
}

extern "C" void ale_scanner_close(ale_scanner_t *scanner)
{
    script.destroyed++;
    delete scanner;
}

namespace
{

class Acquire : public testing::Test
{
  protected:
    void SetUp() override
    {
        script.events.clear();
        script.next_stamp_us = 1000;
        script.destroyed = 0;
        script.refuse = false;
        script.model = "";
        config = ale_config_default();
        ASSERT_EQ(ale_exchange_open(&exchange, ale_clock_start(ALE_CLOCK_REAL)), 0);
    }
    void TearDown() override
    {
        ale_exchange_close(&exchange);
    }
    void play(std::initializer_list<ale_scanner_event_t> events)
    {
        const std::lock_guard<std::mutex> guard(script.lock);
        script.events.insert(script.events.end(), events);
    }
    const ale_scan_record_t &record(uint32_t k)
    {
        return *static_cast<const ale_scan_record_t *>(ale_ring_at(exchange.scans, k));
    }
    ale_config_t config{};
    ale_exchange_t exchange{};
};

TEST_F(Acquire, EveryScanAndEveryLostScanIsHandedOverInOrder)
{
    ale_acquire_t *acquire = ale_acquire_start(&config, &exchange);
    ASSERT_NE(acquire, nullptr);
    play({ALE_SCANNER_CHANGED, ALE_SCANNER_SCAN, ALE_SCANNER_SCAN_LOST, ALE_SCANNER_SCAN});
    ASSERT_TRUE(comes_true([&] { return ale_ring_ready(exchange.scans) == 3; }));
    EXPECT_EQ(record(0).scan.stamp_us, 1000);
    EXPECT_EQ(record(0).scan.beams, 682);
    EXPECT_FALSE(record(0).lost);
    EXPECT_TRUE(record(1).lost);
    EXPECT_EQ(record(1).scan.stamp_us, 1001);
    EXPECT_EQ(record(1).scan.beams, 0);
    EXPECT_GT(record(1).arrival_us, 0);
    EXPECT_FALSE(record(2).lost);
    EXPECT_TRUE(ale_rt_release_wait(exchange.arrived, ale_rt_now_ns() + 30000000000))
        << "the estimate task is released";
    ale_acquire_stop(acquire);
    EXPECT_EQ(script.destroyed, 1);
    bool fresh = false;
    const auto *health =
        static_cast<const ale_scanner_health_t *>(ale_snapshot_newest(exchange.health, &fresh));
    EXPECT_EQ(health->scans, 2u);
    EXPECT_EQ(health->scans_lost, 1u);
    EXPECT_EQ(health->state, ALE_SCANNER_STREAMING);
}

TEST_F(Acquire, ScansHaveTheNoiseOfTheScannerThatSaysWhoItIs)
{
    config.pipeline.extract.noise.surface_um = 4321;
    config.noise_given = ale_config_noise_bit(ale_config_key("noise", "surface_um"));
    script.model = "UTM-30LX[Hokuyo Automatic Co.,Ltd.]";
    ale_acquire_t *acquire = ale_acquire_start(&config, &exchange);
    play({ALE_SCANNER_CHANGED, ALE_SCANNER_SCAN});
    ASSERT_TRUE(comes_true([&] { return ale_ring_ready(exchange.scans) == 1; }));
    ale_acquire_stop(acquire);
    EXPECT_EQ(record(0).noise.own_um, 10000);
    EXPECT_EQ(record(0).noise.surface_um, 4321) << "what is configured goes before it";
}

TEST_F(Acquire, OfAScannerThatSaysNothingTheNoiseIsAsConfigured)
{
    config.pipeline.extract.noise.own_um = 777;
    ale_acquire_t *acquire = ale_acquire_start(&config, &exchange);
    play({ALE_SCANNER_SCAN});
    ASSERT_TRUE(comes_true([&] { return ale_ring_ready(exchange.scans) == 1; }));
    ale_acquire_stop(acquire);
    EXPECT_EQ(record(0).noise.own_um, 777);
    EXPECT_EQ(record(0).noise.shared_beams, config.pipeline.extract.noise.shared_beams);
}

TEST_F(Acquire, AFullRingIsCountedAndTheThreadGoesOn)
{
    ale_acquire_t *acquire = ale_acquire_start(&config, &exchange);
    for (int k = 0; k < ALE_SCAN_SLOTS + 3; k++) {
        play({ALE_SCANNER_SCAN});
    }
    ASSERT_TRUE(comes_true([&] { return ale_ring_refused(exchange.scans) == 3; }));
    ale_ring_release(exchange.scans);
    play({ALE_SCANNER_SCAN});
    ASSERT_TRUE(comes_true([&] { return ale_ring_committed(exchange.scans) == ALE_SCAN_SLOTS + 1; }));
    ale_acquire_stop(acquire);
}

TEST_F(Acquire, TheDriverGetsTheConfigurationAndTheRobotsClock)
{
    std::strcpy(config.port, "/dev/ttyS7");
    std::strcpy(config.serial, "");
    config.baud = 115200;
    config.reversed = true;
    config.first_step = 44;
    config.last_step = 725;
    ale_acquire_t *acquire = ale_acquire_start(&config, &exchange);
    ASSERT_NE(acquire, nullptr);
    EXPECT_STREQ(script.config.path, "/dev/ttyS7");
    EXPECT_EQ(script.config.serial, nullptr);
    EXPECT_EQ(script.config.baud, 115200);
    EXPECT_TRUE(script.config.reversed);
    EXPECT_EQ(script.config.first_step, 44);
    EXPECT_EQ(script.config.last_step, 725);
    const int64_t before = ale_clock_now_us(&exchange.clock);
    const int64_t now = script.config.now_us(script.config.now_user);
    EXPECT_GE(now, before);
    EXPECT_LE(now, ale_clock_now_us(&exchange.clock));
    ale_acquire_stop(acquire);
}

TEST_F(Acquire, WithoutMemoryForTheDriverThereIsNoThread)
{
    script.refuse = true;
    EXPECT_EQ(ale_acquire_start(&config, &exchange), nullptr);
    ale_acquire_stop(nullptr);
}

} // namespace
