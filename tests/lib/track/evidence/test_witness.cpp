// lib/track/evidence/witness.c: what one scan says of the next.
#include "lib/observe/look.h"

extern "C" {
#include "track/evidence/witness.h"
}

using room::Look;

namespace
{
ale_testimony_t hear(const Look &first, const Look &second)
{
    const auto witness = std::make_unique<ale_witness_t>();
    ale_witness_clear(witness.get());
    EXPECT_EQ(ale_witness_hear(witness.get(), &second.seen, {0, 0, false}).denied_um, 0);
    ale_witness_keep(witness.get(), &first.seen);
    return ale_witness_hear(witness.get(), &second.seen, {0, 0, false});
}
} // namespace

TEST(Witness, ConfirmsWhatIsSeenAgainFromElsewhere)
{
    const reference::Pose a(0, 0, 0.2);
    const reference::Pose b(0.4, 0.3, 0.9);
    const ale_testimony_t t = hear(Look(room::l_shape(), a, a), Look(room::l_shape(), b, b));
    EXPECT_GT(t.confirmed_um, 10000000);
    EXPECT_LT(t.denied_um, 1000000);
}

TEST(Witness, SaysNothingOfWhatItCouldNotSee)
{
    const std::vector<room::Wall> ahead_and_behind = {{3, -4, 3, 4}, {-3, -0.5, -3, 0.5}};
    const reference::Pose a(0, 0, 0);
    const reference::Pose b(0, 0, reference::pi);
    const Look behind({ahead_and_behind[1]}, b, b);
    const ale_testimony_t t = hear(Look({ahead_and_behind[0]}, a, a), behind);
    EXPECT_EQ(t.confirmed_um, 0);
    EXPECT_EQ(t.denied_um, 0);
}

TEST(Witness, DeniesASceneThatChangedAllAtOnce)
{
    const reference::Pose a(0, 0, 0);
    const ale_testimony_t t = hear(Look(room::l_shape(), a, a), Look(room::l_shape(), {3.2, -0.5, 2.4}, a));
    EXPECT_GT(t.denied_um, t.confirmed_um);
    EXPECT_GT(t.denied_um, 1000000);
}
