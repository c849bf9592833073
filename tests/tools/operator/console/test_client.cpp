// What one browser is sent: everything once, the newest when it is slow, never more than it can draw.
#include "operator/console/client.h"

#include <map>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "files.hpp"
#include "operator/console/recordings/event_file.h"

using console::Board;
using console::Client;
using console::Topic;
using nlohmann::json;

namespace
{

/* A page that may not command. */
Client watcher(const Board &board)
{
    return {board, "", [](const auto &) { return console::Sent{0, "no key"}; }};
}

std::optional<json> next(Client &client)
{
    const auto text = client.next(Board::Clock::now());
    return text ? std::optional(json::parse(*text)) : std::nullopt;
}

/* All that is sent until nothing more is, counted by type. */
std::map<std::string, int> drain(Client &client)
{
    std::map<std::string, int> counts;
    while (const auto message = next(client)) {
        counts[message->value("type", "?")]++;
    }
    return counts;
}

std::string message_of(const char *type, int k)
{
    return json{{"type", type}, {"k", k}}.dump();
}

bool got(Client &client, uint64_t count)
{
    return client.heard(json{{"type", "got"}, {"count", count}}.dump());
}

} // namespace

TEST(Client, GreetingAndLinkComeFirst)
{
    Board board;
    board.pin(Topic::pose, message_of("pose", 1));
    Client client = watcher(board);
    EXPECT_EQ(next(client)->value("type", ""), "hello");
    EXPECT_EQ(next(client)->value("type", ""), "link");
    EXPECT_EQ(next(client)->value("type", ""), "trail");
    EXPECT_EQ(next(client)->value("type", ""), "pose");
    EXPECT_FALSE(next(client));
}

TEST(Client, NothingIsSentTwice)
{
    Board board;
    board.pin(Topic::pose, message_of("pose", 1));
    Client client = watcher(board);
    EXPECT_EQ(drain(client)["pose"], 1);
    EXPECT_TRUE(drain(client).empty());
    board.pin(Topic::pose, message_of("pose", 2));
    EXPECT_EQ(drain(client)["pose"], 1);
    EXPECT_EQ(client.skipped(), 0U);
}

TEST(Client, ASlowClientGetsTheNewestAndWhatItMissedIsCounted)
{
    Board board;
    Client client = watcher(board);
    board.pin(Topic::pose, message_of("pose", 1));
    drain(client);
    for (int k = 2; k <= 11; k++) {
        board.pin(Topic::pose, message_of("pose", k));
    }
    const auto message = next(client);
    EXPECT_EQ(message->value("k", 0), 11);
    EXPECT_EQ(client.skipped(), 9U);
}

TEST(Client, WhatWasThereBeforeItCameIsNotMissed)
{
    Board board;
    for (int k = 0; k < 100; k++) {
        board.pin(Topic::pose, message_of("pose", k));
    }
    Client client = watcher(board);
    drain(client);
    EXPECT_EQ(client.skipped(), 0U);
}

TEST(Client, NoTopicStarvesAnother)
{
    Board board;
    Client client = watcher(board);
    drain(client);
    std::map<std::string, int> counts;
    for (int k = 0; k < 30; k++) { // each time all are new, and one message gets through
        board.pin(Topic::pose, message_of("pose", k));
        board.pin(Topic::map, message_of("map", k));
        board.pin(Topic::status, message_of("status", k));
        counts[next(client)->value("type", "?")]++;
        EXPECT_TRUE(got(client, static_cast<uint64_t>(k) + 3));
    }
    EXPECT_EQ(counts["pose"], 10);
    EXPECT_EQ(counts["map"], 10);
    EXPECT_EQ(counts["status"], 10);
}

TEST(Client, NeverMoreThanTheWindowIsOnTheWay)
{
    Board board;
    Client client = watcher(board);
    uint64_t sent = 0;
    for (int k = 0; k < 1000; k++) {
        board.pin(Topic::pose, message_of("pose", k));
        sent += next(client) ? 1U : 0U;
    }
    EXPECT_EQ(sent, Client::window);
    EXPECT_TRUE(got(client, 5));
    for (int k = 0; k < 1000; k++) {
        board.pin(Topic::pose, message_of("pose", k));
        sent += next(client) ? 1U : 0U;
    }
    EXPECT_EQ(sent, Client::window + 5);
}

TEST(Client, APageThatSpeaksNonsenseIsNotBelieved)
{
    Board board;
    Client client = watcher(board);
    drain(client); // three messages
    EXPECT_TRUE(got(client, 2));
    EXPECT_FALSE(got(client, 1)) << "fewer than before";
    EXPECT_FALSE(got(client, 4)) << "more than were sent";
    for (const char *text : {"", "{", "null", "[]", "{\"type\":\"got\"}", "{\"type\":\"got\",\"count\":2.5}",
                             "{\"type\":\"got\",\"count\":\"3\"}", "{\"type\":5,\"count\":3}", "\xff\xfe"}) {
        EXPECT_FALSE(client.heard(text)) << text;
    }
    EXPECT_TRUE(got(client, 3));
}

TEST(Client, ARestartedRobotIsAnnouncedBeforeItsFirstNews)
{
    Board board;
    board.extend_trail({1, 1, true});
    Client client = watcher(board);
    drain(client);
    board.clear();
    board.pin(Topic::pose, message_of("pose", 0));
    EXPECT_EQ(next(client)->value("type", ""), "hello");
    const auto trail = next(client);
    EXPECT_EQ(trail->value("type", ""), "trail");
    EXPECT_TRUE(trail->value("anew", false));
    EXPECT_TRUE(trail->at("points").empty());
}

TEST(Client, ALongTrailComesInPieces)
{
    Board board;
    for (int k = 0; k < 5000; k++) {
        board.extend_trail({static_cast<float>(k), 0, k == 0});
    }
    Client client = watcher(board);
    size_t values = 0;
    int pieces = 0;
    while (const auto message = next(client)) {
        if (message->value("type", "") == "trail") {
            EXPECT_EQ(message->value("anew", false), pieces == 0);
            values += message->at("points").size();
            pieces++;
        }
    }
    EXPECT_EQ(pieces, 3);
    EXPECT_EQ(values, 2U * (5000 + 1)); // the jump at the start is a pair of nulls
}

TEST(Client, GreetingNamesTheOperatorOfTheConsole)
{
    Board board;
    Client nobody = watcher(board);
    EXPECT_TRUE(next(nobody)->at("operator").is_null());
    Client alice(board, "alice", nullptr);
    EXPECT_EQ(next(alice)->at("operator"), "alice");
}

TEST(Client, CommandIsHandedOnWordByWordAndAnsweredOnce)
{
    Board board;
    std::vector<std::string> heard;
    Client client(board, "alice", [&](const auto &words) {
        heard = words;
        return console::Sent{42, ""};
    });
    drain(client);
    ASSERT_TRUE(client.heard(R"({"type":"command","words":["drive","0.2","0"]})"));
    EXPECT_EQ(heard, (std::vector<std::string>{"drive", "0.2", "0"}));
    const auto answer = next(client);
    EXPECT_EQ(answer->value("type", ""), "sent");
    EXPECT_EQ(answer->at("verb"), "drive");
    EXPECT_EQ(answer->at("number"), 42);
    EXPECT_TRUE(answer->at("refusal").is_null());
    EXPECT_FALSE(next(client));
}

TEST(Client, RefusedCommandIsAnsweredWithTheReason)
{
    Board board;
    Client client = watcher(board);
    drain(client);
    ASSERT_TRUE(client.heard(R"({"type":"command","words":["stop"]})"));
    const auto answer = next(client);
    EXPECT_EQ(answer->at("refusal"), "no key");
    EXPECT_TRUE(answer->at("number").is_null());
}

TEST(Client, CommandThatIsNoneAndAFloodOfCommandsEndTheConnection)
{
    Board board;
    Client client = watcher(board);
    for (const char *text :
         {R"({"type":"command"})", R"({"type":"command","words":[]})",
          R"({"type":"command","words":["drive",1]})", R"({"type":"command","words":"stop"})",
          R"({"type":["command"],"words":["stop"]})"}) {
        EXPECT_FALSE(client.heard(text)) << text;
    }
    bool taken = true;
    for (int k = 0; k < 1000 && taken; k++) {
        taken = client.heard(R"({"type":"command","words":["stop"]})");
    }
    EXPECT_FALSE(taken);
}

namespace
{

bool look(Client &client, const json &at)
{
    return client.heard(json{{"type", "look"}, {"at", at}}.dump());
}

std::vector<std::string> types_of(Client &client)
{
    std::vector<std::string> types;
    while (const auto message = next(client)) {
        types.push_back(message->value("type", "?"));
    }
    return types;
}

} // namespace

TEST(Client, WhoLooksBackGetsWhatHeAskedForAndOfNowTheLinkAlone)
{
    Board board;
    board.pin(Topic::pose, message_of("pose", 1));
    board.pin(Topic::map, message_of("map", 1));
    Client client = watcher(board);
    drain(client);
    ASSERT_TRUE(look(client, board.span().to_ms));
    EXPECT_EQ(types_of(client), (std::vector<std::string>{"past", "trail", "pose", "map"}));
    board.pin(Topic::pose, message_of("pose", 2));
    EXPECT_TRUE(drain(client).empty()) << "nothing of now";
    client.link_due();
    const auto link = next(client);
    EXPECT_EQ(link->value("type", ""), "link");
    EXPECT_EQ((*link)["kept"], json({board.span().from_ms, board.span().to_ms}));
    ASSERT_TRUE(look(client, nullptr));
    const auto now = next(client);
    EXPECT_EQ(now->value("type", ""), "past");
    EXPECT_TRUE((*now)["at"].is_null());
    std::map<std::string, int> counts = drain(client);
    EXPECT_EQ(counts["pose"], 1);
    EXPECT_EQ(counts["map"], 1) << "all of it anew";
    EXPECT_EQ(counts["trail"], 1);
    EXPECT_EQ(client.skipped(), 0U);
}

TEST(Client, AnotherWishTakesThePlaceOfWhatIsStillToBeSentOfTheFormerOne)
{
    Board board;
    board.pin(Topic::pose, message_of("pose", 1));
    Client client = watcher(board);
    drain(client);
    for (int k = 0; k < 50; k++) {
        ASSERT_TRUE(look(client, board.span().to_ms));
    }
    EXPECT_EQ(types_of(client), (std::vector<std::string>{"past", "trail", "pose"}));
}

TEST(Client, TheSeriesHasWhatIsKeptForCharts)
{
    Board board;
    board.pin(Topic::pose, message_of("pose", 1));
    board.pin(Topic::status, message_of("status", 7));
    board.pin(Topic::odometry, message_of("odometry", 3));
    board.pin(Topic::features, message_of("features", 4), message_of("features", 5));
    Client client = watcher(board);
    drain(client);
    ASSERT_TRUE(client.heard(R"({"type":"series"})"));
    const auto series = next(client);
    EXPECT_EQ((*series)["poses"][0]["k"], 1);
    EXPECT_EQ((*series)["odometry"][0]["k"], 3);
    EXPECT_EQ((*series)["features"][0]["k"], 5) << "in brief";
    EXPECT_EQ((*series)["scans"].size() + (*series)["trackings"].size(), 0U);
    EXPECT_EQ((*series)["statuses"][0]["k"], 7);
}

TEST(Client, WhatIsNoTimeEndsTheConnection)
{
    Board board;
    Client client = watcher(board);
    EXPECT_FALSE(look(client, "yesterday"));
    EXPECT_FALSE(look(client, 1.5));
    EXPECT_FALSE(client.heard(R"({"type":"look"})"));
}

TEST(Client, AnOpenedRecordingIsShownUntilNowIsAskedForWhateverTheRobotDoes)
{
    const files::TemporaryFolder folder;
    const std::string path = (folder / "a.lcm").string();
    console::EventWriter writer(console::Descriptor(open(path.c_str(), O_WRONLY | O_CREAT, 0600)));
    ale::pose_t pose{};
    std::vector<uint8_t> bytes(static_cast<size_t>(pose.getEncodedSize()));
    for (; pose.scan < 3; pose.scan++) {
        pose.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
        writer.put(1000000 * (1 + pose.scan), "ALE_POSE", bytes.data(), bytes.size());
    }
    ASSERT_EQ(writer.flush(), 0);
    Board board;
    board.pin(Topic::pose, message_of("pose", 1));
    std::vector<std::string> asked;
    Client client(board, "", nullptr,
                  {[] { return console::RecorderState(); },
                   [&](const auto &message) {
                       asked.push_back(message.name);
                       return true;
                   }});
    drain(client);
    ASSERT_TRUE(client.heard(R"({"type":"open","name":"a"})"));
    EXPECT_EQ(asked, std::vector<std::string>{"a"});
    client.show(std::make_shared<console::OpenRecording>(console::Descriptor(open(path.c_str(), O_RDONLY))),
                "a");
    client.show(std::make_shared<console::OpenRecording>(console::Descriptor(open(path.c_str(), O_RDONLY))),
                "asked for before");
    const auto past = next(client);
    EXPECT_EQ((*past)["recording"], "a");
    EXPECT_EQ((*past)["at"], 1000);
    EXPECT_EQ(types_of(client), (std::vector<std::string>{"trail", "pose"}));
    board.clear();
    board.pin(Topic::pose, message_of("pose", 2));
    client.link_due();
    EXPECT_EQ((*next(client))["kept"], json({1000, 3000}));
    EXPECT_TRUE(drain(client).empty()) << "the robot has started anew, which is told later";
    ASSERT_TRUE(look(client, 3000));
    drain(client);
    ASSERT_TRUE(look(client, nullptr));
    EXPECT_EQ(next(client)->value("type", ""), "hello");
    EXPECT_EQ(drain(client)["pose"], 1);
}

TEST(Client, WhoAsksAndTakesNoAnswersEndsHisConnection)
{
    const Board board;
    Client client(board, "", nullptr,
                  {[] { return console::RecorderState(); }, [](const auto &) { return true; }});
    size_t taken = 0;
    while (client.heard(R"({"type":"shelf"})") && taken < 1000) {
        taken++;
    }
    EXPECT_EQ(taken, 64U);
    client.answer(R"({"type":"shelf"})");
    EXPECT_FALSE(client.heard(R"({"type":"shelf"})")) << "it has not been fetched";
    drain(client);
    EXPECT_TRUE(client.heard(R"({"type":"shelf"})"));
    EXPECT_FALSE(watcher(board).heard(R"({"type":"record","on":true})")) << "where there is nobody to ask";
}

TEST(Client, HowTheRobotsAreIsToldFirstAndBehindTheLinkWhenOneOfThemHasChanged)
{
    const Board board;
    std::vector<console::RobotTold> robots = {{"rover1", "good"}, {"rover2", "waiting"}};
    Client client(board, "", nullptr, {}, {"rover2", [&] { return robots; }, [] { return console::Sent(); }});
    const auto hello = next(client);
    EXPECT_EQ((*hello)["robot"], "rover2");
    EXPECT_EQ((*hello)["robots"],
              json::parse(R"([{"name":"rover1","state":"good"},{"name":"rover2","state":"waiting"}])"));
    EXPECT_EQ(types_of(client), (std::vector<std::string>{"link", "trail"}));
    robots[1].state = "weak";
    EXPECT_FALSE(next(client)) << "not before the link is told of";
    client.link_due();
    EXPECT_EQ(next(client)->value("type", ""), "link");
    EXPECT_EQ((*next(client))["robots"][1]["state"], "weak");
    client.link_due();
    EXPECT_EQ(types_of(client), std::vector<std::string>{"link"}) << "nothing has changed";
}

TEST(Client, AStopForAllIsAnsweredAsACommand)
{
    const Board board;
    int stops = 0;
    Client client(board, "", nullptr, {},
                  {"rover1", [] { return std::vector<console::RobotTold>(); },
                   [&] {
                       stops++;
                       return console::Sent{7, stops == 1 ? "" : "rover2: no robot has been heard yet"};
                   }});
    drain(client);
    ASSERT_TRUE(client.heard(R"({"type":"stop_all"})"));
    EXPECT_EQ(*next(client), json::parse(R"({"type":"sent","verb":"stop","number":7,"refusal":null})"));
    ASSERT_TRUE(client.heard(R"({"type":"stop_all"})"));
    EXPECT_EQ((*next(client))["refusal"], "rover2: no robot has been heard yet");
    while (stops < 100 && client.heard(R"({"type":"stop_all"})")) {
    }
    EXPECT_EQ(stops, 66) << "64 that the page has not fetched";
}
