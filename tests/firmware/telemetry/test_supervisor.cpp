#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <string>

extern "C" {
#include "serial/port_status.h"
#include "telemetry/supervisor.h"
}

namespace
{

ale_scanner_health_t health_in(ale_scanner_state_t state, const char *status = "", uint64_t scans = 0)
{
    ale_scanner_health_t health{};
    health.state = state;
    health.scans = scans;
    std::strcpy(health.status, status);
    std::strcpy(health.port, "/dev/ttyACM0");
    std::strcpy(health.identity.model, "URG-04LX");
    std::strcpy(health.identity.serial, "H0508486");
    return health;
}

/* What is said when the scanner's health is this; empty: nothing. */
std::string said(ale_supervisor_t &supervisor, const ale_scanner_health_t &health, int64_t now_us = 0)
{
    char line[ALE_SUPERVISOR_LINE] = "";
    return ale_supervisor_watch(&supervisor, &health, now_us, line) ? line : "";
}

TEST(Supervisor, AMissingScannerIsSaidOnceInPlainWords)
{
    ale_supervisor_t supervisor{};
    const ale_scanner_health_t absent = health_in(ALE_SCANNER_CLOSED, "/dev/ttyACM0: no such device");
    EXPECT_EQ(said(supervisor, absent),
              "no scanner: /dev/ttyACM0: no such device; trying again until it is there");
    EXPECT_EQ(said(supervisor, absent), "");
    EXPECT_EQ(said(supervisor, health_in(ALE_SCANNER_DETECTING)), "");
    EXPECT_EQ(said(supervisor, absent), "");
}

TEST(Supervisor, AnotherCauseIsSaidAndNotEveryOneOfMany)
{
    ale_supervisor_t supervisor{};
    const ale_scanner_health_t absent = health_in(ALE_SCANNER_CLOSED, "no such device");
    const ale_scanner_health_t denied = health_in(ALE_SCANNER_CLOSED, "permission is missing");
    EXPECT_NE(said(supervisor, absent, 1000000), "");
    EXPECT_EQ(said(supervisor, denied, 2000000), "") << "a cause that comes and goes fills no log";
    EXPECT_EQ(said(supervisor, denied, 31000000),
              "no scanner: permission is missing; trying again until it is there");
    EXPECT_EQ(said(supervisor, denied, 90000000), "");
    EXPECT_EQ(said(supervisor, health_in(ALE_SCANNER_DETECTING, "asking"), 91000000), "");
}

TEST(Supervisor, ComingAndGoingAreSaid)
{
    ale_supervisor_t supervisor{};
    EXPECT_EQ(said(supervisor, health_in(ALE_SCANNER_STARTING)), "");
    EXPECT_EQ(said(supervisor, health_in(ALE_SCANNER_STREAMING)), "")
        << "streaming is believed with the first scan";
    EXPECT_EQ(said(supervisor, health_in(ALE_SCANNER_STREAMING, "", 1)),
              "scanner URG-04LX, serial number H0508486, at /dev/ttyACM0: streaming");
    EXPECT_EQ(said(supervisor, health_in(ALE_SCANNER_STREAMING, "", 2)), "");
    EXPECT_EQ(said(supervisor, health_in(ALE_SCANNER_STARTING, "restart", 2)), "")
        << "a short fault is only counted";
    EXPECT_EQ(said(supervisor, health_in(ALE_SCANNER_CLOSED, "unplugged", 2)),
              "scanner lost: unplugged; trying again until it is there");
    EXPECT_EQ(said(supervisor, health_in(ALE_SCANNER_STREAMING, "", 3)),
              "scanner URG-04LX, serial number H0508486, at /dev/ttyACM0: streaming");
}

TEST(Supervisor, TheStatusSaysWhatTheDriverDoes)
{
    auto report = std::make_unique<ale_status_report_t>();
    ale_scanner_health_t health = health_in(ALE_SCANNER_STREAMING, "", 100);
    health.scans_lost = 3;
    health.scan_period_us = 100000;
    health.last_scan_us = 5000000;
    ale_supervisor_report(&health, 5100000, ALE_WHEELS_FINE, report.get());
    EXPECT_STREQ(report->driver_state, "streaming");
    EXPECT_STREQ(report->device, "URG-04LX H0508486");
    EXPECT_EQ(report->scans, 103u);
    EXPECT_EQ(report->scan_period_us, 100000);
    health.silence_ms = 2000;
    ale_supervisor_report(&health, 6500000, ALE_WHEELS_FINE, report.get());
    EXPECT_STREQ(report->driver_state, "streaming") << "a recording may pause";
    health.silence_ms = 400;
    ale_supervisor_report(&health, 6500000, ALE_WHEELS_STALLED, report.get());
    EXPECT_EQ(std::string(report->driver_state).rfind("silent", 0), 0u)
        << "streaming, but no scan for over a second";
    EXPECT_EQ(std::string(report->driver_state).find("wheels"), std::string::npos) << "only scans tell";
    EXPECT_EQ(report->scan_period_us, 0);
    const ale_scanner_health_t absent = health_in(ALE_SCANNER_CLOSED, "/dev/ttyACM0: permission denied");
    ale_supervisor_report(&absent, 0, ALE_WHEELS_FINE, report.get());
    EXPECT_STREQ(report->driver_state, "no scanner: /dev/ttyACM0: permission denied");
}

TEST(Supervisor, AMotorLineThatGoesAndComesIsSaidOnceEach)
{
    ale_supervisor_t supervisor{};
    const auto said_of = [&](int status) -> std::string {
        char line[ALE_SUPERVISOR_LINE] = "";
        return ale_supervisor_watch_motors(&supervisor, "/dev/motors", status, line) ? line : "";
    };
    EXPECT_EQ(said_of(ALE_PORT_OK), "");
    EXPECT_EQ(
        said_of(ALE_PORT_ABSENT),
        "motor controller: /dev/motors: no such serial device: nothing drives by this line; trying again");
    EXPECT_EQ(said_of(ALE_PORT_GONE), "") << "another cause of the same";
    EXPECT_EQ(said_of(ALE_PORT_OK), "motor controller: /dev/motors: there again");
    EXPECT_EQ(said_of(ALE_PORT_OK), "");
}

TEST(Supervisor, ANetworkThatIsMissingIsSaidOnceAndItsComingToo)
{
    ale_supervisor_t supervisor{};
    const auto heard = [&](bool has_route) -> std::string {
        char line[ALE_SUPERVISOR_LINE] = "";
        return ale_supervisor_watch_network(&supervisor, has_route, line) ? line : "";
    };
    EXPECT_EQ(heard(true), "") << "all is as it should be";
    EXPECT_EQ(heard(false).rfind("LCM: no route for multicast: going on without", 0), 0U);
    EXPECT_EQ(heard(false), "");
    EXPECT_EQ(heard(true), "LCM: there is a route for multicast: joined");
    EXPECT_EQ(heard(true), "");
}

TEST(Supervisor, WhatTheWheelsDoWrongIsSaidOnceAndStandsInTheStatus)
{
    ale_supervisor_t supervisor{};
    const auto heard = [&](uint8_t fault) -> std::string {
        char line[ALE_SUPERVISOR_LINE] = "";
        return ale_supervisor_watch_wheels(&supervisor, fault, line) ? line : "";
    };
    EXPECT_EQ(heard(ALE_WHEELS_FINE), "");
    EXPECT_EQ(heard(ALE_WHEELS_STALLED), "wheels: stalled");
    EXPECT_EQ(heard(ALE_WHEELS_STALLED), "");
    EXPECT_EQ(heard(ALE_WHEELS_SCALE), "wheels: scale");
    EXPECT_EQ(heard(ALE_WHEELS_FINE), "wheels: fine");

    auto report = std::make_unique<ale_status_report_t>();
    ale_scanner_health_t health = health_in(ALE_SCANNER_STREAMING, "", 100);
    ale_supervisor_report(&health, 0, ALE_WHEELS_STALLED, report.get());
    EXPECT_STREQ(report->driver_state, "streaming; wheels: stalled");
}

TEST(Supervisor, OverlongTextsAreCutNotOverrun)
{
    auto report = std::make_unique<ale_status_report_t>();
    ale_supervisor_t supervisor{};
    ale_scanner_health_t health{};
    std::memset(health.status, 's', sizeof health.status - 1);
    std::memset(health.identity.model, 'm', sizeof health.identity.model - 1);
    std::memset(health.identity.serial, 'n', sizeof health.identity.serial - 1);
    std::memset(health.port, 'p', sizeof health.port - 1);
    ale_supervisor_report(&health, 0, ALE_WHEELS_STALLED, report.get());
    EXPECT_LT(std::strlen(report->driver_state), sizeof report->driver_state);
    EXPECT_FALSE(said(supervisor, health).empty());
}

} // namespace
