/* What the path of a request asks for. */
#include "operator/console/recordings/wanted.h"

#include <gtest/gtest.h>

using console::Wanted;
using console::wanted_of;

TEST(Wanted, RecordingsMapsAndTheMapOfNow)
{
    const auto log = wanted_of("/recordings/2026-11-25-233907.lcm");
    ASSERT_TRUE(log);
    EXPECT_EQ(log->kind, Wanted::Kind::recording);
    EXPECT_EQ(log->file_name(), "2026-11-25-233907.lcm");
    EXPECT_EQ(wanted_of("/recordings/a.png")->kind, Wanted::Kind::recorded_map);
    EXPECT_EQ(wanted_of("/maps/a.b.geojson")->kind, Wanted::Kind::saved_map);
    EXPECT_EQ(wanted_of("/maps/a.b.geojson")->stem, "a.b");
    EXPECT_EQ(wanted_of("/live/map.zip")->kind, Wanted::Kind::live_map);
    EXPECT_EQ(wanted_of("/flights/a.scip")->kind, Wanted::Kind::flight);
    EXPECT_EQ(wanted_of("/flights/a.zip")->kind, Wanted::Kind::flight_map);
    EXPECT_TRUE(wanted_of("/flights/a.svg")->takes_long());
    EXPECT_FALSE(wanted_of("/recordings/a.svg")->takes_long());
}

TEST(Wanted, NothingElse)
{
    for (const char *path : {"", "/", "/index.html", "/console.js", "/recordings", "/recordings/",
                             "/recordings/a", "/recordings/.lcm", "/recordings/a.exe", "/recordings/a.scip",
                             "/flights/a.lcm", "/maps/a.lcm", "/maps/a.map", "/live/other.png",
                             "/live/map.lcm", "recordings/a.lcm", "//recordings/a.lcm", "/recordings.lcm"}) {
        EXPECT_FALSE(wanted_of(path)) << path;
    }
    EXPECT_EQ(wanted_of("/recordings/../x.lcm")->stem, "../x") << "which is no name of a file";
}
