/* The exploration thread between the exchange's snapshots, with scans of a room. */
#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "comes_true.hpp"
#include "firmware/room.hpp"
#include "firmware/surroundings.hpp"

extern "C" {
#include "operator/explore_thread.h"
}

namespace
{

class ExploreThread : public surroundings::WithExchange
{
  protected:
    void SetUp() override
    {
        config = ale_config_default();
        explore = ale_explore_start(&config, &exchange);
        ASSERT_NE(explore, nullptr);
    }
    void TearDown() override
    {
        ale_explore_stop(explore);
    }

    void give_scan(uint8_t state = ALE_STATE_GOOD)
    {
        const auto scan = std::make_unique<ale_scan_t>();
        ale_estimate_t estimate{};
        estimate.stamp_us = ale_clock_now_us(&exchange.clock);
        estimate.state = state;
        estimate.corrections = corrections;
        room::fill(*scan, 0, 0, estimate.stamp_us);
        ale_explore_take(explore, scan.get(), &estimate);
    }
    ale_velocity_request_t request()
    {
        bool fresh = false;
        return *static_cast<const ale_velocity_request_t *>(
            ale_snapshot_newest(exchange.exploration, &fresh));
    }
    bool asks_to_move()
    {
        const ale_velocity_request_t newest = request();
        return newest.v_um_s != 0 || newest.w_urad_s != 0;
    }
    std::string words()
    {
        char text[ALE_ANSWER_BYTES];
        ale_explore_words(explore, text);
        return text;
    }
    /* Gives scans until the condition holds. */
    bool comes(const std::function<bool()> &condition, uint8_t state = ALE_STATE_GOOD)
    {
        return comes_true([&] {
            const bool there = condition();
            if (!there) {
                give_scan(state);
                std::this_thread::sleep_for(std::chrono::milliseconds(20));
            }
            return there;
        });
    }

    void hand_out_correction(uint32_t number)
    {
        auto *slot = static_cast<ale_correction_t *>(ale_ring_reserve(exchange.grid_corrections));
        ASSERT_NE(slot, nullptr);
        slot->epoch = 0;
        slot->number = number;
        slot->count = 0;
        ale_ring_commit(exchange.grid_corrections);
    }

    ale_config_t config;
    uint32_t corrections = 0; /* that the pose given next knows */
    ale_explore_t *explore = nullptr;
};

TEST_F(ExploreThread, DoesNothingUntilAskedThenAsksToMoveForThreeScansAtATime)
{
    give_scan();
    EXPECT_FALSE(ale_explore_is_on(explore));
    EXPECT_EQ(words(), "");
    EXPECT_FALSE(asks_to_move());
    ale_explore_request(explore, true);
    EXPECT_TRUE(ale_explore_is_on(explore)) << "at once, for those who report it";
    const int64_t before_us = ale_clock_now_us(&exchange.clock);
    ASSERT_TRUE(comes([&] { return asks_to_move(); }));
    EXPECT_GT(request().valid_until_us, before_us);
    EXPECT_LE(request().valid_until_us, ale_clock_now_us(&exchange.clock) + ALE_EXPLORE_REQUEST_LIFE_US);
    EXPECT_TRUE(comes([&] { return words().find("explores: ") == 0; })) << words();
}

TEST_F(ExploreThread, OffTakesTheRequestBack)
{
    ale_explore_request(explore, true);
    ASSERT_TRUE(comes([&] { return asks_to_move(); }));
    ale_explore_request(explore, false);
    EXPECT_FALSE(ale_explore_is_on(explore));
    EXPECT_TRUE(comes([&] { return !asks_to_move() && words().empty(); }));
    EXPECT_EQ(request().valid_until_us, 0);
}

TEST_F(ExploreThread, SaysThatThePoseIsLostAndStandsAtFirst)
{
    ale_explore_request(explore, true);
    ASSERT_TRUE(comes([&] { return words() == "looks for its place: the pose is lost"; }, ALE_STATE_LOST));
    EXPECT_FALSE(asks_to_move());
}

TEST_F(ExploreThread, ACorrectionIsTakenWithTheFirstPoseThatKnowsIt)
{
    ale_explore_request(explore, true);
    ASSERT_TRUE(comes([&] { return asks_to_move(); }));
    hand_out_correction(1);
    const int64_t before_us = ale_clock_now_us(&exchange.clock);
    ASSERT_TRUE(
        comes([&] { return request().valid_until_us > before_us + 2 * ALE_EXPLORE_REQUEST_LIFE_US; }));
    EXPECT_EQ(ale_ring_ready(exchange.grid_corrections), 1U) << "poses go by that do not know it";
    corrections = 1;
    EXPECT_TRUE(comes([&] { return ale_ring_ready(exchange.grid_corrections) == 0; }));
}

TEST_F(ExploreThread, WhileItIsOffCorrectionsDoNotPileUp)
{
    hand_out_correction(1);
    corrections = 1;
    EXPECT_TRUE(comes([&] { return ale_ring_ready(exchange.grid_corrections) == 0; }));
}

TEST_F(ExploreThread, AskedTwiceItGoesOn)
{
    ale_explore_request(explore, true);
    ASSERT_TRUE(comes([&] { return asks_to_move(); }));
    ale_explore_request(explore, true);
    EXPECT_TRUE(ale_explore_is_on(explore));
    EXPECT_TRUE(comes([&] { return asks_to_move(); }));
}

TEST_F(ExploreThread, DrivesToAPlaceAndTellsTheWayThere)
{
    EXPECT_FALSE(ale_explore_is_going(explore));
    ale_explore_go(explore, {500000, 300000}, nullptr);
    EXPECT_TRUE(ale_explore_is_going(explore)) << "at once, for those who report it";
    char text[ALE_ANSWER_BYTES];
    EXPECT_EQ(ale_explore_goal_answer(explore, text), ALE_GOAL_PENDING);
    ASSERT_TRUE(comes([&] { return ale_explore_goal_answer(explore, text) == ALE_GOAL_TAKEN; }));
    EXPECT_EQ(std::string(text), "drives to 0.50 0.30: 1 m to go");
    EXPECT_TRUE(comes([&] { return asks_to_move(); }));
    ale_plan_report_t plan = {};
    const uint32_t number = ale_explore_plan(explore, &plan);
    EXPECT_EQ(plan.state, ALE_PLAN_GOES);
    EXPECT_TRUE(plan.has_place);
    EXPECT_EQ(plan.place.x_um, 500000);
    ASSERT_GE(plan.points, 2U);
    EXPECT_NEAR(plan.point[0].x_um, 0, 100000);
    EXPECT_NEAR(plan.point[plan.points - 1].x_um, 500000, 30000);
    EXPECT_NEAR(plan.point[plan.points - 1].y_um, 300000, 30000);
    EXPECT_TRUE(comes([&] { return ale_explore_plan(explore, &plan) != number; })) << "it is planned anew";
}

TEST_F(ExploreThread, AnotherWishCallsTheGoalOff)
{
    ale_explore_go(explore, {500000, 300000}, nullptr);
    ale_explore_request(explore, false);
    char text[ALE_ANSWER_BYTES];
    EXPECT_EQ(ale_explore_goal_answer(explore, text), ALE_GOAL_REFUSED);
    EXPECT_EQ(std::string(text), "called off");
    EXPECT_FALSE(ale_explore_is_going(explore));
    ale_explore_go(explore, {500000, 300000}, nullptr);
    ale_explore_request(explore, true);
    EXPECT_FALSE(ale_explore_is_going(explore));
    EXPECT_TRUE(comes([&] { return words().find("explores: ") == 0; })) << words();
    ale_plan_report_t plan = {};
    ale_explore_plan(explore, &plan);
    EXPECT_EQ(plan.state, ALE_PLAN_EXPLORES);
    EXPECT_FALSE(plan.has_place);
}

TEST_F(ExploreThread, APlaceThatCannotBeReachedIsRefusedWithTheReason)
{
    ale_explore_go(explore, {-80000000, 1234000}, nullptr);
    char text[ALE_ANSWER_BYTES];
    ASSERT_TRUE(comes([&] { return ale_explore_goal_answer(explore, text) == ALE_GOAL_REFUSED; }));
    EXPECT_EQ(std::string(text), "gave up -80.00 1.23: too far away to plan a way there");
    EXPECT_TRUE(comes([&] { return !ale_explore_is_on(explore); }));
    EXPECT_EQ(words(), text);
    ale_explore_go(explore, {500000, 300000}, nullptr);
    ASSERT_TRUE(
        comes([&] { return ale_explore_goal_answer(explore, text) == ALE_GOAL_REFUSED; }, ALE_STATE_LOST));
    EXPECT_EQ(std::string(text), "gave up 0.50 0.30: the pose is lost");
}

} // namespace
