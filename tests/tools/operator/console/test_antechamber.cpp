// Who waits for how long before he has shown the token.
#include "operator/console/antechamber.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

using console::Antechamber;

namespace
{

class Waiting : public testing::Test
{
  protected:
    Antechamber::Id id(size_t number)
    {
        return &places_[number];
    }
    std::optional<Antechamber::Id> enter(size_t number, const std::string &peer)
    {
        now_ += std::chrono::milliseconds(1);
        return room_.enter(id(number), peer, now_);
    }

    Antechamber room_;
    Antechamber::Clock::time_point now_{};

  private:
    std::vector<char> places_ = std::vector<char>(1000);
};

TEST_F(Waiting, NobodyGoesWhileThereIsRoom)
{
    for (size_t k = 0; k < Antechamber::most; k++) {
        EXPECT_FALSE(enter(k, "a"));
    }
}

TEST_F(Waiting, TheOldestOfThePeerThatHasMostMakesRoom)
{
    enter(0, "quiet");
    for (size_t k = 1; k < Antechamber::most; k++) {
        enter(k, "greedy");
    }
    EXPECT_EQ(enter(100, "newcomer"), id(1));
    EXPECT_EQ(enter(101, "greedy"), id(2));
    EXPECT_EQ(enter(102, "greedy"), id(3)) << "and never the quiet one";
}

TEST_F(Waiting, WhoIsInOrGoneTakesNoRoom)
{
    for (size_t k = 0; k < Antechamber::most; k++) {
        enter(k, "a");
        room_.leave(id(k));
    }
    EXPECT_FALSE(enter(100, "a"));
    room_.leave(id(500));
}

TEST_F(Waiting, ItLastsForAWhileOnly)
{
    enter(0, "a");
    enter(1, "a");
    now_ += Antechamber::patience - std::chrono::seconds(1);
    EXPECT_TRUE(room_.overdue(now_).empty());
    room_.renew(id(1), now_);
    now_ += std::chrono::seconds(2);
    EXPECT_EQ(room_.overdue(now_), std::vector<Antechamber::Id>{id(0)});
    now_ += Antechamber::patience;
    EXPECT_EQ(room_.overdue(now_).size(), 2U);
}

} // namespace
