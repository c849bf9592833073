// lib/track/witness.c: what one scan says of the next.
#include <gtest/gtest.h>

#include "room.h"

extern "C" {
#include "extract/extract.h"
#include "track/witness.h"
}

namespace
{
struct Look {
    std::unique_ptr<ale_scan_t> scan = std::make_unique<ale_scan_t>();
    std::vector<ale_view_t> views = std::vector<ale_view_t>(ALE_MAX_VIEWS);
    ale_seen_t seen = {};

    // What the scanner shows at `from`, for a robot that believes to be at `believed`.
    Look(const std::vector<room::Wall> &walls, const reference::Pose &from, const reference::Pose &believed)
    {
        std::mt19937 rng(3);
        room::Sensor sensor;
        sensor.beam_time_ns = 0;
        sensor.noise = 0.003;
        *scan = room::scan_at(
            walls, sensor, [&](double) { return from; }, 1, rng);
        std::unique_ptr<ale_extractor_t, void (*)(void *)> extractor(
            static_cast<ale_extractor_t *>(::operator new(ale_extractor_size())),
            [](void *p) { ::operator delete(p); });
        const ale_extract_config_t config = ale_extract_default_config();
        EXPECT_EQ(ale_extractor_init(extractor.get(), &config), 0);
        const auto features = std::make_unique<ale_features_t>();
        ale_extract_scan(extractor.get(), scan.get(), nullptr, features.get());
        const ale_pose_t pose = convert::pose(believed);
        const uint32_t count = ale_views_of(features.get(), scan.get(), {0, 0, 0}, 0, views.data());
        seen = {scan.get(), nullptr, pose, pose, views.data(), count};
    }
};

ale_testimony_t hear(const Look &first, const Look &second)
{
    const auto witness = std::make_unique<ale_witness_t>();
    ale_witness_clear(witness.get());
    EXPECT_EQ(ale_witness_hear(witness.get(), &second.seen).denied_um, 0);
    ale_witness_keep(witness.get(), &first.seen);
    return ale_witness_hear(witness.get(), &second.seen);
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
