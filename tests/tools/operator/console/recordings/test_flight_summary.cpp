/* What a flight is, by its two ends and its name. */
#include "operator/console/recordings/flight_summary.h"

#include <gtest/gtest.h>

#include <fcntl.h>

#include "files.hpp"

extern "C" {
#include "store/recording.h"
}

using console::Descriptor;
using console::FlightSummary;
using console::summary_of_flight;

namespace
{

constexpr char name[] = "flight-00000007-20261126T225141.834Z-fault.scip";

FlightSummary summary_at(const std::string &path, const std::string &called)
{
    return summary_of_flight(Descriptor(open(path.c_str(), O_RDONLY)), called);
}

/* Its configuration has no time; so many seconds of bytes. */
void record(const std::string &path, int seconds)
{
    ale_recording_t recording;
    const std::string payload(20000, 'x');
    ASSERT_EQ(ale_recording_create(&recording, path.c_str()), 0);
    ale_recording_write(&recording, ALE_CHUNK_CONFIG, 0, "config", 6);
    for (int k = 0; k <= seconds; k++) {
        ale_recording_write(&recording, ALE_CHUNK_RECEIVED, 5000000 + 1000000 * int64_t{k}, payload.data(),
                            static_cast<uint32_t>(payload.size()));
    }
    ASSERT_EQ(ale_recording_close(&recording), 0);
}

} // namespace

TEST(FlightSummary, LengthIsThatOfWhatPassedOnTheLineHoweverLongItIs)
{
    const files::TemporaryFolder folder;
    const std::string path = (folder / name).string();
    for (const int seconds : {0, 5, 100}) {
        record(path, seconds);
        const FlightSummary summary = summary_at(path, name);
        EXPECT_EQ(summary.from_us, 5000000);
        EXPECT_EQ(summary.to_us, 5000000 + 1000000 * int64_t{seconds});
    }
}

TEST(FlightSummary, TheNameTellsWhenAndWhyItWasWritten)
{
    const files::TemporaryFolder folder;
    const std::string path = (folder / "a").string();
    record(path, 1);
    EXPECT_EQ(summary_at(path, name).written_ms, 1795733501834);
    EXPECT_EQ(summary_at(path, name).reason, "fault");
    for (const char *other :
         {"drive.scip", "flight-1-x.scip", "flight-00000007-20261126T225141.834Z-.scip"}) {
        EXPECT_EQ(summary_at(path, other).written_ms, 0) << other;
        EXPECT_EQ(summary_at(path, other).reason, "") << other;
    }
}

TEST(FlightSummary, WhatIsNoRecordingHasNoLength)
{
    const files::TemporaryFolder folder;
    const std::string path = (folder / "a").string();
    for (const std::string &text :
         {std::string(), std::string("ALE"), std::string("ALESCIP1"), std::string(300000, 'x')}) {
        files::write(path, text);
        EXPECT_EQ(summary_at(path, name).to_us, 0);
    }
}
