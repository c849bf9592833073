// drivers/scanner: the one interface, whatever the family behind it.
#include <memory>

#include <gtest/gtest.h>

extern "C" {
#include "scanner/scanner.h"
}

namespace
{

TEST(Scanner, NoFamilyNamedIsTheUrg)
{
    ale_scanner_config_t config{};
    config.path = "/no/such/device";
    config.step_ms = 1;
    ale_scanner_t *scanner = ale_scanner_open(&config);
    ASSERT_NE(scanner, nullptr);
    auto scan = std::make_unique<ale_scan_t>();
    EXPECT_EQ(ale_scanner_step(scanner, scan.get()), ALE_SCANNER_CHANGED);
    const ale_scanner_health_t *health = ale_scanner_health(scanner);
    EXPECT_EQ(health->state, ALE_SCANNER_CLOSED);
    EXPECT_STREQ(health->status, "/no/such/device: no such serial device");
    EXPECT_EQ(health->scans, 0U);
    ale_scanner_close(scanner);
}

TEST(Scanner, AnUnknownFamilyIsRefused)
{
    ale_scanner_config_t config{};
    config.family = "no such family";
    EXPECT_EQ(ale_scanner_open(&config), nullptr);
    ale_scanner_close(nullptr);
}

TEST(Scanner, FamiliesAndTheirRatesAreKnown)
{
    char names[ALE_SCANNER_NAMES];
    ale_scanner_families(names);
    EXPECT_STREQ(names, "urg, ldrobot, rplidar, auto");
    for (const char *name : {"urg", "ldrobot", "rplidar", "auto"}) {
        EXPECT_TRUE(ale_scanner_has_family(name)) << name;
    }
    EXPECT_FALSE(ale_scanner_has_family("sick"));
    for (const int32_t baud : {19200, 115200, 230400, 256000, 460800, 750000, 1000000}) {
        EXPECT_TRUE(ale_scanner_has_baud(baud)) << baud;
    }
    EXPECT_FALSE(ale_scanner_has_baud(230401));
}

// Nothing is there: each family says so, and waits.
TEST(Scanner, EveryFamilyWaitsForItsPort)
{
    for (const char *name : {"ldrobot", "rplidar", "auto"}) {
        ale_scanner_config_t config{};
        config.family = name;
        config.path = "/no/such/device";
        config.step_ms = 1;
        ale_scanner_t *scanner = ale_scanner_open(&config);
        ASSERT_NE(scanner, nullptr) << name;
        auto scan = std::make_unique<ale_scan_t>();
        EXPECT_EQ(ale_scanner_step(scanner, scan.get()), ALE_SCANNER_CHANGED) << name;
        EXPECT_STREQ(ale_scanner_health(scanner)->status, "/no/such/device: no such serial device");
        ale_scanner_close(scanner);
    }
}

} // namespace
