/* A recording shows what was to be seen at each time of it, whoever wrote it. */
#include "operator/console/recordings/open_recording.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include <fcntl.h>
#include <nlohmann/json.hpp>

#include "ale/features_t.hpp"
#include "ale/graph_t.hpp"
#include "ale/map_pieces_t.hpp"
#include "ale/map_t.hpp"
#include "ale/odometry_t.hpp"
#include "ale/status_t.hpp"
#include "files.hpp"

using console::Descriptor;
using console::EventWriter;
using console::OpenRecording;
using console::Past;
using console::Topic;
using nlohmann::json;

namespace
{

constexpr int64_t begin_us = 1700000000000000;
constexpr int64_t begin_ms = begin_us / 1000;

class Recording : public testing::Test
{
  protected:
    template <class Message> void put(int64_t after_us, const char *channel, const Message &message)
    {
        std::vector<uint8_t> bytes(static_cast<size_t>(message.getEncodedSize()));
        message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
        writer_.put(begin_us + after_us, channel, bytes.data(), bytes.size());
    }

    void put_pose(int64_t after_us, int32_t scan, float x)
    {
        ale::pose_t pose{};
        pose.scan = scan;
        pose.map_x = x;
        pose.state = 2;
        put(after_us, "ALE_POSE", pose);
    }

    void put_map(int64_t after_us, int32_t version, int16_t part, int16_t parts)
    {
        ale::map_t map{};
        map.version = version;
        map.part = part;
        map.parts = parts;
        map.num_lines = 1;
        map.lines.resize(1);
        map.lines[0].id = part;
        put(after_us, "ALE_MAP", map);
    }

    OpenRecording opened()
    {
        EXPECT_EQ(writer_.flush(), 0);
        return OpenRecording(Descriptor(open(path_.c_str(), O_RDONLY)));
    }

    const files::TemporaryFolder folder_;
    const std::string path_ = (folder_ / "a.lcm").string();
    EventWriter writer_{Descriptor(open(path_.c_str(), O_WRONLY | O_CREAT, 0600))};
};

json message_of(const Past &past, const std::string &type)
{
    for (const auto &text : past.texts) {
        json message = json::parse(*text);
        if (message["type"] == type) {
            return message;
        }
    }
    return nullptr;
}

} // namespace

TEST_F(Recording, ShowsWhatWasToBeSeenThen)
{
    ale::map_pieces_t pieces{};
    pieces.version = pieces.parts = pieces.num_lines = 1;
    pieces.line_id = {1};
    pieces.map_id = {7};
    put(0, "ALE_MAP_PIECES", pieces);
    put_map(0, 1, 0, 2);
    put_map(1000, 1, 1, 2);
    for (int k = 0; k < 10; k++) {
        put_pose(100000 + 100000 * k, k, 0.1F * static_cast<float>(k));
        ale::features_t features{};
        features.scan = k;
        put(105000 + 100000 * k, "ALE_FEATURES", features);
        if (k % 5 == 0) {
            ale::graph_t graph{};
            graph.version = 1 + k;
            put(106000 + 100000 * k, "ALE_GRAPH", graph);
        }
    }
    put_map(620000, 2, 0, 2); /* its other part is lost */
    const OpenRecording recording = opened();
    EXPECT_EQ(recording.span().from_ms, begin_ms + 100);
    EXPECT_EQ(recording.span().to_ms, begin_ms + 1000);
    const Past past = recording.look_back(begin_ms + 650);
    EXPECT_EQ(message_of(past, "pose")["scan"], 5);
    EXPECT_EQ(message_of(past, "features")["scan"], 5) << "which came after its pose";
    const json map = message_of(past, "map");
    EXPECT_EQ(map["version"], 1);
    EXPECT_EQ(map["lines"].size(), 2U);
    EXPECT_EQ(map["lines"][1]["map_id"], 7);
    EXPECT_EQ(message_of(past, "graph")["version"], 6);
    EXPECT_EQ(past.way.size(), 6U);
    EXPECT_TRUE(past.way[0].first);
    EXPECT_FALSE(past.way[1].first);
    EXPECT_EQ(message_of(recording.look_back(begin_ms), "pose"), nullptr) << "none had come";
    EXPECT_EQ(recording.look_back(begin_ms + 99999).way.size(), 10U);
    const auto sample = recording.sample(Topic::pose, 5);
    ASSERT_EQ(sample.size(), 5U);
    EXPECT_EQ(json::parse(*sample[1])["scan"], 2);
}

TEST_F(Recording, OfWhichAllIsShownHasNoDamage)
{
    put_pose(0, 0, 0);
    EXPECT_EQ(opened().damage(), "");
}

TEST_F(Recording, TellsWhatOfItIsLeftOut)
{
    put_pose(0, 0, 0);
    writer_.put(begin_us + 50000, "ALE_POSE", nullptr, 0);
    put_pose(100000, 1, 0);
    put_pose(200000, 2, 0);
    EXPECT_EQ(opened().damage(), "1 message makes no sense");
    std::string bytes = files::content(path_);
    const size_t whole = bytes.size();
    const size_t second = whole - 2 * (28 + 8 + static_cast<size_t>(ale::pose_t().getEncodedSize()));
    bytes[second] = static_cast<char>(bytes[second] ^ 1); /* in its sync word; the third is cut */
    bytes.resize(whole - 5);
    files::write(path_, bytes);
    const OpenRecording damaged(Descriptor(open(path_.c_str(), O_RDONLY)), 0, "3 scans left out");
    EXPECT_EQ(damaged.damage(), "3 scans left out, 1 damaged place, " + std::to_string(whole - 5 - second) +
                                    " bytes, left out, 1 message makes no sense");
}

TEST_F(Recording, ChartsGetWheelsAndHowMuchWasSeen)
{
    for (int k = 0; k < 10; k++) {
        ale::odometry_t sample{};
        sample.utime = begin_us + 100000 * k;
        sample.x = 0.05F * static_cast<float>(k);
        put(100000 * k, "ALE_ODOMETRY", sample);
        ale::pose_t pose{};
        pose.utime = sample.utime;
        pose.scan = k;
        put(100000 * k + 1, "ALE_POSE", pose);
        ale::features_t features{};
        features.num_lines = k;
        features.lines.resize(static_cast<size_t>(k));
        put(100000 * k + 2, "ALE_FEATURES", features);
        writer_.put(begin_us + 100000 * k + 3, "ALE_SCAN", nullptr, 0);
    }
    const OpenRecording recording = opened();
    const auto wheels = recording.sample(Topic::odometry, 100);
    ASSERT_EQ(wheels.size(), 9U);
    EXPECT_NEAR(json::parse(*wheels[4])["wheels"][0].get<double>(), 0.5, 1e-3);
    EXPECT_EQ(json::parse(*wheels[4])["scans"][0], 0);
    EXPECT_EQ(message_of(recording.look_back(begin_ms + 550), "odometry")["scan"], 5);
    const auto features = recording.sample(Topic::features, 5);
    ASSERT_EQ(features.size(), 5U);
    EXPECT_EQ(json::parse(*features[2])["found"], json({4, 0}));
    EXPECT_TRUE(recording.sample(Topic::scan, 5).empty()) << "they make no sense";
}

TEST_F(Recording, AClockThatIsSetBackKeepsTheOrder)
{
    put_pose(0, 0, 0);
    put_pose(-5000000, 1, 0);
    put_pose(100000, 2, 0);
    const OpenRecording recording = opened();
    EXPECT_EQ(recording.span().from_ms, begin_ms);
    EXPECT_EQ(recording.span().to_ms, begin_ms + 100);
    EXPECT_EQ(message_of(recording.look_back(begin_ms), "pose")["scan"], 1);
}

TEST_F(Recording, WhatMakesNoSenseIsLeftOut)
{
    put_pose(0, 0, 0);
    put_pose(100000, 1, std::numeric_limits<float>::quiet_NaN());
    const std::vector<uint8_t> noise(200, 0xA5);
    for (const char *channel :
         {"ALE_POSE", "ALE_SCAN", "ALE_FEATURES", "ALE_MAP", "ALE_MAP_PIECES", "ALE_STATUS", "ALE_PLAN",
          "ALE_GRAPH", "ALE_TRACKING", "ALE_ODOMETRY", "SOMETHING"}) {
        writer_.put(begin_us + 150000, channel, noise.data(), noise.size());
    }
    put_pose(200000, 2, 0);
    const OpenRecording recording = opened();
    const Past past = recording.look_back(begin_ms + 180);
    ASSERT_EQ(past.texts.size(), 1U);
    EXPECT_EQ(message_of(past, "pose")["scan"], 0);
    EXPECT_EQ(recording.sample(Topic::pose, 10).size(), 2U);
}

TEST_F(Recording, WhereThereIsNothingOfARobotItIsSaid)
{
    put_pose(0, 0, 0);
    EXPECT_NO_THROW(opened());
    files::write(path_, "no log at all, but long enough to look like one");
    EXPECT_THROW(OpenRecording(Descriptor(open(path_.c_str(), O_RDONLY))), std::runtime_error);
}
