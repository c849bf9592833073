/* What is kept of the board, and found again. */
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "operator/console/history.h"

using console::History;
using console::Topic;

namespace
{

History::Text text(const std::string &words)
{
    return std::make_shared<const std::string>(words);
}

std::vector<std::string> words(const std::vector<History::Text> &texts)
{
    std::vector<std::string> all;
    for (const auto &entry : texts) {
        all.push_back(*entry);
    }
    return all;
}

} // namespace

TEST(History, EmptyThereIsNothingToLookAt)
{
    const History history;
    EXPECT_EQ(history.span().from_ms, history.span().to_ms);
    EXPECT_TRUE(history.at(1000).empty());
    EXPECT_TRUE(history.trail(1000).empty());
    EXPECT_TRUE(history.sample(Topic::pose, 10).empty());
}

TEST(History, ShowsTheNewestOfEachTopicWithWhatBelongsToThatPose)
{
    History history;
    history.keep(Topic::map, 900, text("map"));
    for (int scan = 0; scan < 5; scan++) {
        history.keep(Topic::pose, 1000 + 100 * scan, text("pose " + std::to_string(scan)));
        history.keep(Topic::scan, 1004 + 100 * scan, text("scan " + std::to_string(scan)));
    }
    EXPECT_EQ(words(history.at(1200)), (std::vector<std::string>{"pose 2", "scan 2", "map"}))
        << "its scan came later";
    EXPECT_EQ(words(history.at(1299)), (std::vector<std::string>{"pose 2", "scan 2", "map"}));
    EXPECT_EQ(words(history.at(99999)), (std::vector<std::string>{"pose 4", "scan 4", "map"}));
    EXPECT_EQ(words(history.at(950)), (std::vector<std::string>{"map"})) << "no pose yet";
    EXPECT_EQ(history.span().from_ms, 1000);
    EXPECT_EQ(history.span().to_ms, 1400);
}

TEST(History, ASampleIsInBriefWhatIsLookedAtWhole)
{
    History history;
    history.keep(Topic::pose, 1000, text("pose"));
    history.keep(Topic::features, 1001, text("features"), text("five"));
    EXPECT_EQ(words(history.sample(Topic::features, 10)), std::vector<std::string>{"five"});
    EXPECT_EQ(words(history.sample(Topic::pose, 10)), std::vector<std::string>{"pose"});
    EXPECT_EQ(words(history.at(1000)), (std::vector<std::string>{"pose", "features"}));
}

TEST(History, KeepsTenMinutesAndOfSlowTopicsTheOneThatWasToBeSeenThen)
{
    History history;
    history.keep(Topic::status, 0, text("status"));
    for (int64_t at_ms = 0; at_ms <= 20 * 60 * 1000; at_ms += 1000) {
        history.keep(Topic::pose, at_ms, text("pose"));
        history.keep_point(at_ms, {0, 0, false});
    }
    EXPECT_EQ(history.span().to_ms - history.span().from_ms, History::longest_ms);
    EXPECT_EQ(words(history.at(history.span().from_ms)), (std::vector<std::string>{"pose", "status"}));
    EXPECT_EQ(history.trail(history.span().to_ms).size(), 120U) << "two minutes of way";
}

TEST(History, ManyBytesAreBoundedTheOldestGoFirst)
{
    History history;
    const std::string large(1024 * 1024, 'x');
    for (int k = 0; k < 200; k++) {
        history.keep(Topic::scan, k, text(large));
        history.keep(Topic::pose, k, text("pose " + std::to_string(k)));
    }
    EXPECT_EQ(words(history.at(199))[0], "pose 199");
    EXPECT_LE(History::most_bytes / large.size(), 64U);
    EXPECT_LE(history.sample(Topic::scan, 1000).size(), 64U);
    EXPECT_GE(history.sample(Topic::scan, 1000).size(), 62U) << "and no fewer than there is room for";
    EXPECT_GT(history.span().from_ms, 130);
}

TEST(History, MapsAreKeptFarApartButForTheNewest)
{
    History history;
    for (int64_t at_ms = 0; at_ms <= 60000; at_ms += 1000) {
        history.keep(Topic::map, at_ms, text(std::to_string(at_ms)));
    }
    EXPECT_EQ(history.sample(Topic::map, 1000).size(), 13U);
    EXPECT_EQ(words(history.at(60000)).back(), "60000");
    EXPECT_EQ(words(history.at(32000)).back(), "30000");
}

TEST(History, OfGraphsAsOfMapsOneInFiveSecondsIsKept)
{
    for (const Topic topic : {Topic::map, Topic::graph, Topic::plan}) {
        History history;
        for (int second = 0; second <= 20; second++) {
            history.keep(topic, 1000 * second, text(std::to_string(second)));
        }
        EXPECT_EQ(history.sample(topic, 100).size(), topic == Topic::plan ? 21U : 5U);
        EXPECT_EQ(words(history.at(99999)), std::vector<std::string>{"20"}) << "and the newest";
    }
}

TEST(History, ASampleIsEvenAndHasTheFirst)
{
    History history;
    for (int k = 0; k < 100; k++) {
        history.keep(Topic::pose, k, text(std::to_string(k)));
    }
    EXPECT_EQ(words(history.sample(Topic::pose, 4)), (std::vector<std::string>{"0", "25", "50", "75"}));
    EXPECT_EQ(history.sample(Topic::pose, 1000).size(), 100U);
    history.clear();
    EXPECT_TRUE(history.sample(Topic::pose, 4).empty());
}
