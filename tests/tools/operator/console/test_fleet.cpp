// Which robots a console has: what belongs to which, what they are called, and what cannot be told apart.
#include "operator/console/fleet.h"

#include <gtest/gtest.h>

#include "common/command_line/wrong_use.h"

using console::FleetOptions;
using console::settings_of;

namespace
{

std::vector<std::string> names_of(const FleetOptions &options)
{
    std::vector<std::string> names;
    for (const auto &robot : settings_of(options)) {
        names.push_back(robot.name);
    }
    return names;
}

/* What is said against them; empty: nothing. */
std::string wrong_with(const FleetOptions &options)
{
    try {
        settings_of(options);
    } catch (const cli::WrongUse &wrong) {
        return wrong.what();
    }
    return "";
}

} // namespace

TEST(Fleet, WithoutAnOptionItIsOneRobot)
{
    setenv("LCM_DEFAULT_URL", "udpm://239.1.2.3:7000", 1);
    const auto settings = settings_of({});
    unsetenv("LCM_DEFAULT_URL");
    ASSERT_EQ(settings.size(), 1U);
    EXPECT_EQ(settings[0].name, "239.1.2.3:7000");
    EXPECT_EQ(settings[0].credentials.lcm_url, "");
    EXPECT_EQ(settings[0].recordings + settings[0].maps + settings[0].credentials.robot, "");
}

TEST(Fleet, ARobotIsCalledByItsOwnNameOrItsPrefixOrItsGroup)
{
    FleetOptions options;
    options.lcm_urls = {"udpm://?prefix=rover1.", "udpm://239.255.76.68:7700?ttl=0", "udpm://?prefix=a/b_"};
    EXPECT_EQ(names_of(options), (std::vector<std::string>{"rover1", "239.255.76.68:7700", "a/b"}));
    options.robots = {"one", "two", "three"};
    EXPECT_EQ(names_of(options), options.robots);
}

TEST(Fleet, WhatIsGivenForEachGoesByTheOrder)
{
    FleetOptions options;
    options.lcm_urls = {"udpm://?prefix=rover1.", "udpm://?prefix=rover2."};
    options.recordings = {"r1", "r2"};
    options.maps = {"m1", "m2"};
    options.key_file = "alice.key";
    options.robots_file = "known";
    const auto settings = settings_of(options);
    ASSERT_EQ(settings.size(), 2U);
    EXPECT_EQ(settings[1].credentials.lcm_url, options.lcm_urls[1]);
    EXPECT_EQ(settings[0].recordings + settings[0].maps, "r1m1");
    EXPECT_EQ(settings[1].recordings + settings[1].maps, "r2m2");
    for (const auto &robot : settings) {
        EXPECT_EQ(robot.credentials.key_file, "alice.key");
        EXPECT_EQ(robot.credentials.robots_file, "known");
    }
}

TEST(Fleet, OptionsThatDoNotGoRoundAreWrongUse)
{
    FleetOptions options;
    options.robots = {"a", "b"};
    EXPECT_EQ(wrong_with(options),
              "--robot is wanted once for each robot (--lcm-url), in their order: 2 for 1");
    options.robots.clear();
    options.lcm_urls = {"udpm://?prefix=rover1.", "udpm://?prefix=rover2."};
    options.maps = {"m"};
    EXPECT_EQ(wrong_with(options),
              "--maps is wanted once for each robot (--lcm-url), in their order: 1 for 2");
    options.maps.clear();
    options.recordings = {"r", "s", "t"};
    EXPECT_NE(wrong_with(options).find("--recordings"), std::string::npos);
}

TEST(Fleet, TwoThatCannotBeToldApartAreWrongUse)
{
    FleetOptions options;
    options.lcm_urls = {"udpm://239.255.76.67:7667?ttl=1&prefix=rover1.", "udpm://?prefix=rover1."};
    options.robots = {"a", "b"};
    EXPECT_NE(wrong_with(options).find("two robots on the same channels, udpm://?prefix=rover1."),
              std::string::npos);
    options.lcm_urls[1] = "udpm://?prefix=rover2.";
    EXPECT_EQ(wrong_with(options), "");
    options.robots = {"a", "a"};
    EXPECT_NE(wrong_with(options).find("two robots are called a"), std::string::npos);
    options.robots.clear();
    options.recordings = {"r", "r"};
    EXPECT_NE(wrong_with(options).find("two robots record into r"), std::string::npos);
}

TEST(Fleet, AUrlThatIsNoneIsToldInItsWords)
{
    FleetOptions options;
    options.lcm_urls = {"udpm://?prefix=rover1.", "udpm://10.0.0.1"};
    EXPECT_THROW(settings_of(options), std::runtime_error);
}
