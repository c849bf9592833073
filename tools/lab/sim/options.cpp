#include "lab/sim/options.h"

#include <cmath>

#include "common/command_line/command_line.h"
#include "common/command_line/files.h"

namespace sim
{

namespace
{

const char usage[] =
    "usage: ale-sim (--log LOG | --world WORLD) (--pty LINK | --tcp PORT) [options]\n"
    "       ale-sim --world WORLD --write-log FILE [--truth FILE]\n"
    "       ale-sim (--log LOG | --world WORLD) --describe\n"
    "A laser scanner on a pseudo terminal, seeing a recorded log or a simulated world. It plays from the "
    "moment "
    "a\n"
    "client first asks for ranges.\n"
    "  --sensor NAME        urg-04lx (default), utm-30lx, utm-30lx-ew, ust-10lx, ld06, ld19, stl-19p,\n"
    "                       rplidar-a1, rplidar-a2, rplidar-c1, rplidar-s2\n"
    "  --log LOG            play a recording (any format that ale-replay reads)\n"
    "  --world WORLD        drive through a plan of walls: x1 y1 x2 y2, # start x y theta, # via x y\n"
    "  --pty LINK           symbolic link to the pseudo terminal; removed at the end\n"
    "  --tcp PORT           a TCP port of this computer in its place, as of a scanner on Ethernet\n"
    "  --protocol P         scip2 (default); scip1: powers up in 1.1, can be switched; scip1-only\n"
    "  --speed X            time runs X times as fast (default 1); ale-slamd wants the same --time-scale\n"
    "  --baud-limit N       the line carries N bytes a second (default: no limit)\n"
    "  --command-interval MS  commands are served at most so often (real firmware: 100; default 0)\n"
    "  --once               end when the log or the way is over; else the robot stands and the scans go on\n"
    "  --seed N             another run of noise and wheel errors (default 1)\n"
    "  --faults SPEC        e.g. flip@5,garbage:300@8,silence:2@12,unplug:2@#200: NAME[:ARGUMENT]@SECONDS "
    "or\n"
    "                       @#SCAN; flip cut garbage:N repeat silence:S unplug:S reset11 hardware:NN wrap "
    "stall:S\n"
    "  --lcm-url URL        where ALE_ODOMETRY goes (default: LCM_DEFAULT_URL, else LCM's own)\n"
    "  --no-odometry        send none\n"
    "  --truth FILE         the robot's true pose at the stamp of every scan sent (TUM); worlds only\n"
    "  --describe           print what is known of mounting and odometry as configuration of ale-slamd\n"
    "For worlds:\n"
    "  --drive              obey ALE_DRIVE (inertia, slip, collisions) instead of following the way\n"
    "  --drive-key FILE     with --drive: obey only who has this key (ale-keys --drive), by ALE_DRIVE_KEYED\n"
    "  --noise NAME         real, white, none, ld06, rplidar-a1, ust-10lx, utm-30lx (default: the sensor's "
    "own)\n"
    "  --sensor X,Y,THETA   mounting of the laser, metres and radians (default: as the world says)\n"
    "  --odometry-lag S     odometry is so much younger than its stamp says (default 0)\n"
    "  --wheels WAY,TURN,BIAS  what the wheels count of a metre and of a radian, and radians counted for a\n"
    "                       metre counted (default: drawn from the seed, 3 % each, no bias)\n"
    "  --max-speed V        m/s (default 0.5)\n"
    "  --max-turn W         rad/s (default 0.9)\n"
    "  --write-log FILE     write the drive as a log instead of playing it: CARMEN, of scanners of a whole\n"
    "                       turn a .scip recording of their line\n"
    "  --help, --version\n"
    "At the end, on stdout: scans, sent, damaged, swallowed (and collisions), one a line.\n"
    "Exit: 0 fine, 1 failed, 2 wrong use.\n";

/* A client of a scanner of a whole turn misses the beginning of the first one: the robot stands meanwhile. */
constexpr int64_t first_turns_us = 1000000;

void bind_scanner(cli::CommandLine &line, SimulatorOptions &o)
{
    line.text("pty", o.link);
    line.number("tcp", o.tcp_port, int32_t{1}, int32_t{65535});
    line.choice("protocol", o.protocol,
                cli::Choices<Protocol>{{"scip1", Protocol::scip1},
                                       {"scip1-only", Protocol::scip1_only},
                                       {"scip2", Protocol::scip2}});
    line.number("speed", o.speed, 0.01, 1000.0);
    line.number("baud-limit", o.baud_limit, int64_t{100}, int64_t{1000000000});
    line.option("command-interval", [&o](const std::string &word) {
        o.command_interval_us = std::llround(cli::number_of("--command-interval", word, 0.0, 10000.0) * 1000);
    });
    line.number("seed", o.seed, uint64_t{0}, uint64_t{4000000000});
    line.text("faults", o.faults);
}

WheelGains gains_of(const std::string &word)
{
    const std::string what = "--wheels " + word + ":";
    const auto [way, turn, bias] = cli::three_of("--wheels", word, "WAY,TURN,BIAS");
    return {cli::number_of(what, way, 0.1, 10.0), cli::number_of(what, turn, 0.1, 10.0),
            cli::number_of(what, bias, -1.0, 1.0)};
}

/* Where it sits, or which one it is. */
void take_sensor(const std::string &word, Options &o)
{
    if (word.find(',') != std::string::npos) {
        const cli::Mounting at = cli::mounting_of("--sensor", word);
        o.mounting = {at.x_m, at.y_m, at.theta_rad};
        return;
    }
    const std::optional<Sensor> sensor = sensor_named(word);
    if (!sensor) {
        throw cli::WrongUse("--sensor " + word + ": there are " + sensor_names() +
                            ", or X,Y,THETA for its mounting");
    }
    o.sensor = *sensor;
}

void bind_world(cli::CommandLine &line, Options &o)
{
    line.text("world", o.world);
    line.flag("drive", o.drive);
    line.text("drive-key", o.drive_key);
    line.text("noise", o.noise);
    line.option("sensor", [&o](const std::string &word) { take_sensor(word, o); });
    line.option("odometry-lag", [&o](const std::string &word) {
        o.world_source.odometry_lag_us = std::llround(cli::number_of("--odometry-lag", word, 0.0, 1.0) * 1e6);
    });
    line.option("wheels",
                [&o](const std::string &word) { o.world_source.journey.odometry.gains = gains_of(word); });
    line.number("max-speed", o.world_source.journey.limits.speed, 0.01, 5.0);
    line.number("max-turn", o.world_source.journey.limits.turn_rate, 0.01, 10.0);
    line.text("write-log", o.write_log);
}

void bind(cli::CommandLine &line, Options &o)
{
    bind_scanner(line, o.simulator);
    bind_world(line, o);
    line.text("log", o.log);
    line.flag("once", o.once);
    line.text("lcm-url", o.lcm_url);
    line.flag("no-odometry", o.odometry, false);
    line.text("truth", o.truth);
    line.flag("describe", o.describe);
}

void require(bool condition, const char *message)
{
    if (!condition) {
        throw cli::WrongUse(message);
    }
}

void check(const Options &o)
{
    const bool play = o.write_log.empty() && !o.describe;
    require(o.log.empty() != o.world.empty(), "give either --log LOG or --world WORLD");
    require(!play || o.simulator.link.empty() != (o.simulator.tcp_port == 0),
            "give either --pty LINK or --tcp PORT");
    require(o.truth.empty() || !o.world.empty(),
            "--truth: nobody knows the truth of a log, only of a --world");
    require(o.write_log.empty() || !o.world.empty(), "--write-log needs a --world");
    require(!o.drive || !o.world.empty(), "--drive needs a --world: a log cannot be steered");
    require(o.drive_key.empty() || o.drive, "--drive-key is for --drive");
    require(!o.drive || play, "--drive needs somebody who drives: not with --write-log or --describe");
    cli::Files files;
    files.reads("--log", o.log);
    files.reads("--world", o.world);
    files.writes("--write-log", o.write_log);
    files.writes("--truth", o.truth);
    parse_faults(o.simulator.faults);
    require(!o.sensor.is_rotary() || o.log.empty(),
            "--log is for scanners that speak SCIP: no --sensor of a whole turn");
    noise_model(o.noise.empty() ? o.sensor.noise : o.noise);
    require(!o.drive || o.world_source.odometry_lag_us == 0, "--drive and --odometry-lag do not go together");
}

} // namespace

int with_options(int argc, char **argv, const std::function<int(const Options &)> &work)
{
    Options options;
    cli::CommandLine line("ale-sim", usage);
    bind(line, options);
    return line.run(argc, argv, [&] {
        check(options);
        options.world_source.once = options.once || !options.write_log.empty();
        options.world_source.journey.seed = options.simulator.seed;
        options.world_source.scanner = options.sensor.scanner;
        if (options.sensor.is_rotary()) {
            options.world_source.rotary = options.sensor.rotary;
            options.world_source.rest_us = first_turns_us;
        }
        options.world_source.noise = options.noise.empty() ? options.sensor.noise : options.noise;
        options.simulator.family = options.sensor.family;
        options.simulator.rplidar = options.sensor.rplidar;
        return work(options);
    });
}

} // namespace sim
