/* ale-sim: wiring of the simulator. */
#include <cinttypes>
#include <csignal>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>

#include "common/command_line/interrupt.h"
#include "common/log/log_noise.h"
#include "lab/sim/bus.h"
#include "lab/sim/describe.h"
#include "lab/sim/log_source.h"
#include "lab/sim/options.h"
#include "lab/sim/out_file.h"
#include "lab/sim/simulator.h"
#include "lab/sim/units.h"
#include "lab/sim/world/world_source.h"
#include "lab/sim/write_log.h"
#include "lab/sim/write_recording.h"

namespace
{

sim::World world_of(const sim::Options &options)
{
    sim::World world = sim::load_world(options.world);
    if (options.mounting) {
        world.sensor = *options.mounting;
    }
    return world;
}

void describe(const sim::Options &options)
{
    sim::Description description;
    if (!options.world.empty()) {
        description.origin = "world " + options.world;
        description.has_sensor = true;
        description.sensor = world_of(options).sensor;
        description.has_odometry = options.odometry;
        description.lag_us = options.world_source.odometry_lag_us;
    } else {
        const sim::LogSource log(options.log, true);
        const ale_log_info_t &info = log.info();
        description.origin = std::string(info.format) + " log " + options.log;
        description.has_sensor = info.has_sensor;
        description.sensor = {sim::metres(info.sensor.x_um), sim::metres(info.sensor.y_um),
                              sim::radians(info.sensor.theta_bam)};
        if (!info.urg_noise || info.scanner[0] != '\0') {
            description.noise = ale::noise_of_log(info);
        }
        description.has_odometry = info.has_odometry && options.odometry;
        description.lag_us = info.lag_prior_us;
    }
    std::fputs(sim::configuration(description).c_str(), stdout);
}

void write_drive(const sim::Options &options)
{
    sim::OutFile truth(options.truth);
    sim::WorldSource source(world_of(options), options.world_source);
    uint32_t scans = 0;
    if (options.sensor.is_rotary()) {
        scans = sim::write_recording(source, options.sensor, options.write_log, truth.get());
    } else {
        sim::OutFile log(options.write_log);
        scans = sim::write_log(source, log.get(), truth.get());
        log.finish();
    }
    truth.finish();
    std::printf("scans %" PRIu32 "\n", scans);
}

void print_tally(const sim::Tally &tally)
{
    std::printf("scans %" PRIu64 "\nsent %" PRIu64 "\ndamaged %" PRIu64 "\nswallowed %" PRIu64 "\n",
                tally.scans, tally.sent, tally.damaged, tally.swallowed);
}

std::unique_ptr<sim::WorldSource> driven_world(sim::Options options, const sim::DriveIn &drive)
{
    constexpr double radius = 0.2;
    options.world_source.journey.slip = sim::driven_slip;
    options.world_source.journey.collision_radius = radius;
    return std::make_unique<sim::WorldSource>(
        world_of(options), options.world_source,
        [&drive](const sim::Robot &, int64_t play_us) { return std::optional(drive.command(play_us)); });
}

void play(const sim::Options &options)
{
    sim::OutFile truth(options.truth);
    std::unique_ptr<sim::DriveIn> drive;
    std::unique_ptr<sim::Source> source;
    const sim::WorldSource *driven = nullptr;
    if (options.drive) {
        drive = std::make_unique<sim::DriveIn>(options.lcm_url, options.drive_key);
        auto world = driven_world(options, *drive);
        driven = world.get();
        source = std::move(world);
    } else if (!options.world.empty()) {
        source = std::make_unique<sim::WorldSource>(world_of(options), options.world_source);
    } else {
        source = std::make_unique<sim::LogSource>(options.log, options.once, options.simulator.speed);
    }
    std::unique_ptr<sim::OdometryOut> odometry;
    if (options.odometry) {
        odometry = std::make_unique<sim::OdometryOut>(options.lcm_url);
    }
    sim::Simulator simulator(*source, options.simulator, odometry.get(), drive.get(), truth.get());
    simulator.run(cli::interrupted);
    truth.finish();
    print_tally(simulator.tally());
    if (driven) {
        std::printf("collisions %" PRIu32 "\n", driven->collisions());
    }
}

int run(const sim::Options &options)
{
    cli::catch_interrupts();
    std::signal(SIGHUP, SIG_IGN);
    if (options.describe) {
        describe(options);
    } else if (!options.write_log.empty()) {
        write_drive(options);
    } else {
        play(options);
    }
    return 0;
}

} // namespace

int main(int argc, char **argv)
{
    return sim::with_options(argc, argv, run);
}
