/* ale-explore: how the robot explores a world of the simulator, minutes in seconds. */
#include <cstdio>

#include "common/export/map_image.h"
#include "lab/explore/closed_loop.h"
#include "lab/explore/options.h"
#include "lab/explore/score.h"

namespace
{

/* Whether it went as it should. */
bool report(const explore::ClosedLoop &loop, const sim::World &world, const explore::Options &options,
            uint64_t seed)
{
    const explore::Score score = explore::score(
        world, options.width(), [&](sim::Point p) { return explore::said_of(loop.explorer().grid, p); });
    const sim::Pose last = loop.truth().empty() ? world.start : loop.truth().back();
    const double off = sim::distance({last.x, last.y}, {world.start.x, world.start.y});
    std::printf(
        "seed %llu: %s after %.0f s and %.1f m, %.2f %% of %.1f m2 mapped, %.2f %% wrong, %u collisions, "
        "%.3f m from its start\n",
        static_cast<unsigned long long>(seed), loop.finished() ? "finished" : "NOT FINISHED", loop.seconds(),
        loop.driven(), score.mapped * 100, score.reachable_m2, score.wrong * 100, loop.collisions(), off);
    return loop.finished() && score.mapped >= explore::least_mapped && loop.collisions() == 0 &&
           off <= explore::farthest_off;
}

void write_map(const explore::ClosedLoop &loop, const ale::ScanCloud &cloud, const std::string &path)
{
    const auto map = loop.map();
    ale::MapScene scene;
    scene.map = map.get();
    scene.trajectory = loop.trajectory();
    scene.cloud = &cloud;
    ale::write_map_image(path, scene);
}

bool explore_once(const sim::World &world, const explore::Options &options, uint64_t seed)
{
    sim::WorldSource::Options source = options.source;
    source.journey.seed = seed;
    explore::ClosedLoop loop(world, source, options.config);
    ale::ScanCloud cloud;
    const bool draws = !options.map.empty();
    loop.run(options.longest_s, [&](const ale_scan_t &scan, const ale_estimate_t &estimate) {
        if (draws) {
            cloud.add(scan,
                      {estimate.stamp_us, estimate.map, estimate.velocity_x_um_s, estimate.velocity_y_um_s,
                       estimate.velocity_theta_urad_s, !estimate.predicted},
                      options.config.pipeline.sensor);
        }
    });
    if (draws) {
        write_map(loop, cloud, options.map);
    }
    return report(loop, world, options, seed);
}

int run(const explore::Options &options)
{
    const sim::World world = sim::load_world(options.world);
    bool well = true;
    for (uint64_t seed = options.first_seed; seed < options.first_seed + options.seeds; seed++) {
        well = explore_once(world, options, seed) && well;
    }
    return well ? 0 : 1;
}

} // namespace

int main(int argc, char **argv)
{
    return explore::with_options(argc, argv, run);
}
