/* Verbs, between rings and snapshots of the test; the commands are signed as an operator signs them. */
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/eventfd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <string>
#include <vector>

#include "drivers/command/signed_command.hpp"
#include "files.hpp"
#include "firmware/surroundings.hpp"

extern "C" {
#include "command/operator.h"
#include "operator/commands.h"
#include "operator/drive_arbiter.h"
#include "operator/explore_thread.h"
#include "recorder/recorder.h"
}

using signed_command::boot;
using signed_command::Operator;

namespace
{

/* On a slow clock: between two commands of a test nobody's time is over, however busy the machine is. */
class Commands : public surroundings::WithExchange
{
  protected:
    Commands() : WithExchange(ALE_CLOCK_REAL / 100)
    {
    }
    void SetUp() override
    {
        config = ale_config_default();
        std::snprintf(config.map_folder, sizeof config.map_folder, "%s/maps", folder.path().c_str());
        storage = ale_map_storage_start(&config, &exchange);
        ASSERT_NE(storage, nullptr);
        const ale_keys_t keys = signed_command::keys_of({alice, bob});
        commands = ale_commands_create(&config, &keys, boot, &exchange, storage);
        ASSERT_NE(commands, nullptr);
        map->line_count = 3;
        map->line[0].end = {4000000, 0};
    }
    void TearDown() override
    {
        ale_map_storage_stop(storage);
        ale_commands_destroy(commands);
    }

    /* The answer, "+" before it when the command was obeyed. */
    std::string answer() const
    {
        ale_operation_report_t report;
        ale_commands_report(commands, &report);
        return std::string(report.command_obeyed ? "+" : "-") + report.command_result;
    }
    void send(const Operator &who, std::initializer_list<const char *> words, bool with_map = true)
    {
        const std::vector<const char *> list(words);
        ale_operator_t end{};
        end.key = who.secret;
        const int64_t now = ale_clock_now_us(&exchange.clock);
        ale_operator_saw(&end, config.name, boot, ale_clock_to_utime(&exchange.clock, now), now);
        end.counter = counter++;
        ale_command_t command;
        uint8_t bytes[ALE_COMMAND_BYTES];
        ASSERT_EQ(ale_command_from_words(list.data(), static_cast<uint32_t>(list.size()), &command), 0);
        const size_t count = ale_operator_command(&end, now, 1000000, &command, bytes);
        counter = std::max(counter, command.counter);
        ale_commands_take(commands, bytes, count, with_map ? map.get() : nullptr);
    }
    std::string ask(const Operator &who, std::initializer_list<const char *> words)
    {
        send(who, words);
        return answer();
    }
    /* The answer of a job that another thread does. */
    std::string job(std::initializer_list<const char *> words)
    {
        send(alice, words);
        pollfd woken = {exchange.under_way, POLLIN, 0};
        EXPECT_EQ(poll(&woken, 1, 180000), 1);
        eventfd_t number = 0;
        eventfd_read(exchange.under_way, &number);
        ale_commands_work(commands);
        return answer();
    }
    ale_drive_orders_t orders()
    {
        bool fresh = false;
        return *static_cast<const ale_drive_orders_t *>(ale_snapshot_newest(exchange.drive_orders, &fresh));
    }
    std::vector<ale_request_t> requests()
    {
        std::vector<ale_request_t> all;
        for (; ale_ring_ready(exchange.requests) > 0; ale_ring_release(exchange.requests)) {
            all.push_back(*static_cast<ale_request_t *>(ale_ring_at(exchange.requests, 0)));
        }
        return all;
    }
    uint64_t counted(const std::string &name)
    {
        ale_status_report_t report{};
        ale_commands_counters(commands, &report);
        for (uint32_t k = 0; k < report.counters; k++) {
            if (name == report.counter[k].name) {
                return report.counter[k].value;
            }
        }
        return UINT64_MAX;
    }

    const Operator alice{"alice"};
    const Operator bob{"bob"};
    const files::TemporaryFolder folder;
    ale_config_t config{};
    ale_map_storage_t *storage = nullptr;
    ale_commands_t *commands = nullptr;
    int64_t counter = 1;
    std::unique_ptr<ale_map_t> map = std::make_unique<ale_map_t>();
};

TEST_F(Commands, DrivingIsAVelocityRequestWithinTheLimits)
{
    EXPECT_EQ(ask(alice, {"drive", "0.25", "-0.5"}), "+alice drives");
    EXPECT_EQ(orders().operator_request.v_um_s, 250000);
    EXPECT_EQ(orders().operator_request.w_urad_s, -500000);
    const int64_t left_us = orders().operator_request.valid_until_us - ale_clock_now_us(&exchange.clock);
    EXPECT_GT(left_us, 0);
    EXPECT_LE(left_us, ALE_DEAD_MAN_US);
    EXPECT_EQ(ask(alice, {"drive", "-99", "99"}), "+alice drives");
    EXPECT_EQ(orders().operator_request.v_um_s, -config.drive_um_s);
    EXPECT_EQ(orders().operator_request.w_urad_s, config.drive_urad_s);
}

TEST_F(Commands, OneDrivesAndEveryoneSeesWhoButAnyoneMayStop)
{
    ask(alice, {"drive", "0.25", "0"});
    ale_operation_report_t report;
    ale_commands_report(commands, &report);
    EXPECT_STREQ(report.who_drives, "alice");
    EXPECT_EQ(ask(bob, {"drive", "0.1", "0"}), "-alice drives");
    EXPECT_EQ(orders().operator_request.v_um_s, 250000);
    EXPECT_EQ(ask(bob, {"stop"}), "+stopped by bob");
    EXPECT_EQ(orders().operator_request.valid_until_us, 0);
    EXPECT_EQ(ask(alice, {"drive", "0.25", "0"}), "-stopped: let go first");
    EXPECT_EQ(orders().operator_request.valid_until_us, 0);
    EXPECT_EQ(counted("command_refused"), 2U);
}

TEST_F(Commands, NewsAreToldAtOnceButNotForEveryMoveOfTheStick)
{
    EXPECT_FALSE(ale_commands_news(commands));
    ask(alice, {"drive", "0.25", "0"});
    EXPECT_TRUE(ale_commands_news(commands)) << "somebody drives";
    EXPECT_FALSE(ale_commands_news(commands));
    ask(alice, {"drive", "0.2", "0"});
    EXPECT_FALSE(ale_commands_news(commands));
    ask(bob, {"drive", "0.2", "0"});
    EXPECT_TRUE(ale_commands_news(commands));
    ask(bob, {"stop"});
    EXPECT_TRUE(ale_commands_news(commands));
}

TEST_F(Commands, ResetIsARequestToTheEstimateTask)
{
    EXPECT_EQ(ask(alice, {"reset"}), "+map and pose forgotten");
    const auto all = requests();
    ASSERT_EQ(all.size(), 1U);
    EXPECT_EQ(all[0].kind, ALE_REQUEST_RESET);
    for (int k = 0; k < ALE_REQUEST_SLOTS; k++) {
        EXPECT_EQ(ask(alice, {"reset"})[0], '+');
    }
    EXPECT_EQ(ask(alice, {"reset"}), "-too much at once: try again");
}

TEST_F(Commands, RelocatingAndFreezingAreRequestsToo)
{
    EXPECT_EQ(ask(alice, {"relocate", "1", "-2.5", "-1.5"}), "+put there: weak until scans agree");
    EXPECT_EQ(ask(alice, {"relocate", "1", "far", "0"})[0], '-');
    EXPECT_EQ(ask(alice, {"set", "freeze_map", "yes"}), "+freeze_map is yes");
    EXPECT_EQ(ask(alice, {"set", "freeze_map", "maybe"}), "-freeze_map is yes or no");
    const auto all = requests();
    ASSERT_EQ(all.size(), 2U);
    EXPECT_EQ(all[0].kind, ALE_REQUEST_RELOCATE);
    EXPECT_EQ(all[0].pose.y_um, -2500000);
    EXPECT_NEAR(static_cast<int32_t>(all[0].pose.theta_bam) * (M_PI / 2147483648.0), -1.5, 1e-8);
    EXPECT_EQ(all[1].kind, ALE_REQUEST_FREEZE);
    EXPECT_TRUE(all[1].on);
    ale_operation_report_t report;
    ale_commands_report(commands, &report);
    EXPECT_TRUE(report.map_frozen);
}

TEST_F(Commands, AMapIsSavedAndLoadedByName)
{
    EXPECT_EQ(job({"save_map", "kitchen"}), "+saved kitchen: 3 lines, 0 corners");
    EXPECT_TRUE(requests().empty());
    EXPECT_EQ(job({"load_map", "kitchen"}), "+loaded kitchen: 3 lines, 0 corners");
    auto all = requests();
    ASSERT_EQ(all.size(), 1U);
    EXPECT_EQ(all[0].kind, ALE_REQUEST_LOAD_MAP);
    EXPECT_FALSE(all[0].pose_known);
    bool fresh = false;
    const auto *loaded =
        &static_cast<const ale_loaded_map_t *>(ale_snapshot_newest(exchange.loaded_map, &fresh))->map;
    EXPECT_TRUE(fresh);
    EXPECT_EQ(loaded->line_count, 3);
    EXPECT_EQ(loaded->line[0].end.x_um, 4000000);
    EXPECT_EQ(job({"load_map", "kitchen", "1.5", "-2", "3.0"}), "+loaded kitchen: 3 lines, 0 corners");
    all = requests();
    ASSERT_EQ(all.size(), 1U);
    EXPECT_TRUE(all[0].pose_known);
    EXPECT_EQ(all[0].pose.x_um, 1500000);
    EXPECT_EQ(all[0].pose.y_um, -2000000);
    EXPECT_NEAR(static_cast<int32_t>(all[0].pose.theta_bam) * (M_PI / 2147483648.0), 3.0, 1e-8);
}

TEST_F(Commands, WhatCannotBeSavedOrLoadedSaysWhy)
{
    EXPECT_EQ(job({"load_map", "nowhere"}).substr(0, 12), "-not loaded:");
    EXPECT_TRUE(requests().empty());
    for (const char *name : {"../../etc/passwd", "a b", ""}) {
        EXPECT_EQ(ask(alice, {"save_map", name})[0], '-') << name;
        EXPECT_EQ(ask(alice, {"load_map", name})[0], '-') << name;
    }
    EXPECT_EQ(ask(alice, {"load_map", "kitchen", "1", "2"})[0], '-');
    EXPECT_EQ(ask(alice, {"load_map", "kitchen", "1", "2", "far"})[0], '-');
    send(alice, {"save_map", "kitchen"}, false);
    EXPECT_EQ(answer(), "-no map yet");
}

TEST_F(Commands, ASecondMapWaitsForTheFirst)
{
    send(alice, {"save_map", "kitchen"});
    EXPECT_EQ(ask(bob, {"save_map", "cellar"}), "-busy with another map: try again");
    EXPECT_EQ(job({"load_map", "kitchen"}).substr(0, 6), "+saved")
        << "the answer of the first comes when it is done";
}

TEST_F(Commands, ShortListOfSettings)
{
    EXPECT_EQ(ask(alice, {"set", "drive_speed", "0.1"}), "+drive_speed is 0.1");
    EXPECT_EQ(ask(alice, {"set", "drive_turn", "0.2"}), "+drive_turn is 0.2");
    ask(alice, {"drive", "5", "5"});
    EXPECT_EQ(orders().operator_request.v_um_s, 100000);
    EXPECT_EQ(orders().operator_request.w_urad_s, 200000);
    EXPECT_EQ(ask(alice, {"set", "drive_speed", "-1"})[0], '-');
    EXPECT_EQ(ask(alice, {"set", "drive_speed", "1000"})[0], '-');
    EXPECT_FALSE(ale_commands_publish_scan(commands));
    EXPECT_EQ(ask(alice, {"set", "publish_scan", "yes"}), "+publish_scan is yes");
    EXPECT_TRUE(ale_commands_publish_scan(commands));
    EXPECT_EQ(ask(alice, {"set", "publish_scan", "perhaps"})[0], '-');
    EXPECT_TRUE(ale_commands_publish_scan(commands)) << "a refused value changes nothing";
    EXPECT_EQ(ask(alice, {"set", "colour", "blue"}), "-no setting colour");
}

TEST_F(Commands, NobodyRaisesALimitAboveWhatTheConfigurationCallsTheMost)
{
    EXPECT_EQ(ask(alice, {"set", "drive_speed", "0.500001"}), "-drive_speed is a number from 0 to 0.5");
    EXPECT_EQ(ask(alice, {"set", "drive_turn", "6"}), "-drive_turn is a number from 0 to 1");
    ask(alice, {"drive", "1.7", "6"});
    EXPECT_EQ(orders().operator_request.v_um_s, config.drive_um_s);
    EXPECT_EQ(orders().operator_request.w_urad_s, config.drive_urad_s);
    EXPECT_EQ(ask(alice, {"set", "drive_speed", "0.1"})[0], '+');
    EXPECT_EQ(ask(alice, {"set", "drive_speed", "0.5"})[0], '+') << "down, and up again";
}

TEST_F(Commands, ExplorationIsSwitchedOnAndOffAndEndedByAStop)
{
    EXPECT_EQ(ask(alice, {"explore", "on"}), "-this robot does not explore");
    exchange.explore = ale_explore_start(&config, &exchange);
    ASSERT_NE(exchange.explore, nullptr);
    EXPECT_EQ(ask(alice, {"explore", "round"}), "-explore on, or off");
    EXPECT_FALSE(ale_explore_is_on(exchange.explore));

    EXPECT_EQ(ask(alice, {"explore", "on"}), "+explores");
    EXPECT_TRUE(ale_explore_is_on(exchange.explore));
    EXPECT_TRUE(orders().exploring);
    ale_operation_report_t report;
    ale_commands_report(commands, &report);
    EXPECT_STREQ(report.who_drives, "exploration");
    EXPECT_EQ(ask(bob, {"drive", "0.1", "0"}), "+bob drives");
    ale_commands_report(commands, &report);
    EXPECT_STREQ(report.who_drives, "bob") << "an operator goes before it";
    EXPECT_TRUE(orders().exploring) << "which goes on when he lets go";

    EXPECT_EQ(ask(alice, {"explore", "off"}), "+exploration is off");
    EXPECT_FALSE(ale_explore_is_on(exchange.explore));
    EXPECT_FALSE(orders().exploring);
    EXPECT_EQ(ask(alice, {"explore", "on"}), "-bob drives") << "one drives at a time";
    EXPECT_EQ(ask(bob, {"explore", "on"}), "+explores");
    EXPECT_EQ(ask(bob, {"stop"}), "+stopped by bob");
    EXPECT_FALSE(ale_explore_is_on(exchange.explore));
    EXPECT_FALSE(orders().exploring);
    ale_explore_stop(exchange.explore);
}

TEST_F(Commands, AGoalIsAnsweredWhenAWayIsPlannedAndTheStickTakesItsPlace)
{
    EXPECT_EQ(ask(alice, {"goto", "1", "2"}), "-this robot does not explore");
    exchange.explore = ale_explore_start(&config, &exchange);
    ASSERT_NE(exchange.explore, nullptr);
    EXPECT_EQ(ask(alice, {"goto", "1", "there"}), "-goto wants x y, metres");
    EXPECT_EQ(ask(alice, {"goto", "1"}), "-goto takes 2 arguments, not 1");
    send(alice, {"goto", "1", "2"});
    EXPECT_TRUE(ale_explore_is_going(exchange.explore));
    EXPECT_TRUE(orders().exploring) << "the drive thread follows it";
    EXPECT_EQ(answer(), "-goto takes 2 arguments, not 1") << "the answer comes later";
    EXPECT_EQ(ask(alice, {"goto", "2", "2"}), "-busy with another goal: try again");
    ale_operation_report_t report;
    ale_commands_report(commands, &report);
    EXPECT_STREQ(report.who_drives, "goal");
    EXPECT_EQ(ask(bob, {"drive", "0", "0"}), "+bob drives");
    EXPECT_FALSE(ale_explore_is_going(exchange.explore));
    EXPECT_FALSE(orders().exploring);
    ale_commands_work(commands);
    EXPECT_EQ(answer(), "-called off");
    EXPECT_EQ(ask(alice, {"goto", "1", "2"}), "-bob drives") << "one drives at a time";
    send(bob, {"goto", "1", "2"});
    EXPECT_TRUE(ale_explore_is_going(exchange.explore));
    EXPECT_EQ(ask(alice, {"stop"}), "+stopped by alice");
    EXPECT_FALSE(ale_explore_is_going(exchange.explore));
    ale_explore_stop(exchange.explore);
    exchange.explore = nullptr;
}

TEST_F(Commands, AFlightRecordingIsWrittenWhereThereIsARecorder)
{
    EXPECT_EQ(ask(alice, {"record"}), "-this robot records no flights");
    std::snprintf(config.recorder_folder, sizeof config.recorder_folder, "%s", folder.path().c_str());
    exchange.recorder = ale_recorder_start(&config);
    ASSERT_NE(exchange.recorder, nullptr);
    EXPECT_EQ(job({"record"}), "+a flight recording is written");
    ale_recorder_stop(exchange.recorder);
    exchange.recorder = nullptr;
    int recordings = 0;
    for (const auto &entry : std::filesystem::directory_iterator(folder.path())) {
        recordings += entry.path().extension() == ".scip";
    }
    EXPECT_EQ(recordings, 1);
}

TEST_F(Commands, ARecordingThatCannotBeWrittenIsRefusedAndCalledSo)
{
    std::snprintf(config.recorder_folder, sizeof config.recorder_folder, "%s/absent", folder.path().c_str());
    exchange.recorder = ale_recorder_start(&config);
    ASSERT_NE(exchange.recorder, nullptr);
    EXPECT_EQ(job({"record"}), "-not recorded: No such file or directory");
    EXPECT_EQ(counted("command_refused"), 1U);
    EXPECT_EQ(job({"record"}), "-not recorded: No such file or directory") << "the next one is answered, too";
    send(alice, {"record"});
    EXPECT_EQ(ask(bob, {"save_map", "cellar"}), "-busy with another recording: try again");
    ale_recorder_stop(exchange.recorder);
    exchange.recorder = nullptr;
}

TEST_F(Commands, NonsenseIsAnsweredInWords)
{
    EXPECT_EQ(ask(alice, {"fly"}), "-no verb fly");
    EXPECT_EQ(ask(alice, {"drive", "1"}), "-drive takes 2 arguments, not 1");
    EXPECT_EQ(ask(alice, {"stop", "now"}), "-stop takes 0 arguments, not 1");
    EXPECT_EQ(ask(alice, {"drive", "fast", "0"}), "-drive wants m/s and rad/s");
    EXPECT_EQ(ask(alice, {"drive", "9999999", "0"}), "-drive wants m/s and rad/s");
    EXPECT_EQ(counted("command_genuine"), 5U);
    EXPECT_EQ(counted("command_refused"), 5U);
}

TEST_F(Commands, WhatIsNotGenuineLeavesNoTraceButACount)
{
    const uint8_t junk[] = {1, 2, 3};
    ale_commands_take(commands, junk, sizeof junk, map.get());
    EXPECT_EQ(ask(Operator("alice"), {"stop"}), "-");
    EXPECT_EQ(ask(Operator("mallory"), {"stop"}), "-");
    EXPECT_FALSE(ale_commands_news(commands));
    EXPECT_EQ(counted("command_malformed"), 1U);
    EXPECT_EQ(counted("command_forged"), 1U);
    EXPECT_EQ(counted("command_stranger"), 1U);
}

} // namespace
