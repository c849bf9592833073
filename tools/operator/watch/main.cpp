/* ale-watch: what the robot publishes, as one line a second and as files at the end. */
#include <chrono>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/command_line/files.h"
#include "common/command_line/interrupt.h"
#include "common/command_line/robot_files.h"
#include "operator/console/lcm_feed.h"
#include "operator/watch/pictures.h"
#include "operator/watch/record.h"
#include "operator/watch/report.h"

namespace
{

constexpr char usage[] =
    "usage: ale-watch [--lcm-url URL] [--map FILE]... [--trajectory F.tum] [--csv F.csv]\n"
    "                 [--seconds N] [--until-silent S]\n"
    "Watches the robot over LCM: one status line a second on stdout, files when it ends.\n"
    "  --lcm-url URL     where the robot publishes (default: LCM_DEFAULT_URL, else LCM's own default)\n"
    "  --map FILE        map and trajectory as a picture: .png or .svg; may be given several times\n"
    "  --trajectory F    map pose of every scan as it was published, TUM format\n"
    "  --csv F           one row a pose: state, poses, features, times\n"
    "  --seconds N       ends after N seconds\n"
    "  --until-silent S  ends when no pose has come for S seconds (after the first one)\n"
    "  --help, --version\n"
    "Ends also with Ctrl-C or SIGTERM. Exit 1 when no pose came or a file could not be written.\n";

using Clock = std::chrono::steady_clock;

struct Options {
    std::string lcm_url;
    std::vector<std::string> maps;
    std::string trajectory;
    std::string csv;
    double seconds = 0;
    double until_silent_s = 0;
};

double seconds_between(Clock::time_point from, Clock::time_point to)
{
    return std::chrono::duration<double>(to - from).count();
}

/* Until one of the ends that the options name, or a signal. */
void watch_robot(const Options &options, console::LcmFeed &feed, watch::Record &record)
{
    const Clock::time_point start = Clock::now();
    Clock::time_point last_pose = start;
    size_t poses = 0;
    for (int lines = 0; !cli::interrupted();) {
        feed.wait(50);
        const Clock::time_point now = Clock::now();
        if (record.poses().size() != poses) {
            poses = record.poses().size();
            last_pose = now;
        }
        const double elapsed_s = seconds_between(start, now);
        const double silent_s = seconds_between(last_pose, now);
        if (elapsed_s >= lines + 1) {
            lines = static_cast<int>(elapsed_s);
            std::printf("%s\n", status_line(record, elapsed_s, silent_s).c_str());
            std::fflush(stdout);
        }
        const bool over = options.seconds > 0 && elapsed_s >= options.seconds;
        const bool ended = options.until_silent_s > 0 && poses > 0 && silent_s >= options.until_silent_s;
        if (over || ended) {
            return;
        }
    }
    /* What is already here is taken along. */
    while (feed.wait(0)) {
    }
}

void check_files(const Options &options)
{
    cli::Files files;
    files.writes("--trajectory", options.trajectory);
    files.writes("--csv", options.csv);
    for (const std::string &path : options.maps) {
        files.writes("--map", path);
    }
}

void write_files(const Options &options, const watch::Record &record)
{
    if (!options.trajectory.empty()) {
        write_trajectory(record, options.trajectory);
    }
    if (!options.csv.empty()) {
        write_csv(record, options.csv);
    }
    for (const std::string &path : options.maps) {
        watch::write_picture(record, path);
    }
}

void run(const Options &options)
{
    check_files(options);
    console::LcmFeed feed(options.lcm_url);
    watch::Record record;
    record.subscribe(feed);
    std::fputs("ale-watch: listening\n", stderr);
    watch_robot(options, feed, record);
    std::printf("%s\n", summary_line(record, feed.malformed()).c_str());
    if (record.poses().empty()) {
        throw std::runtime_error("no pose came: is ale-slamd running, and on the same LCM URL?");
    }
    write_files(options, record);
}

} // namespace

int main(int argc, char **argv)
{
    constexpr double shortest_s = 0.001;
    constexpr double longest_s = 1e9;
    Options options;
    cli::CommandLine line("ale-watch", usage);
    line.text("lcm-url", options.lcm_url);
    cli::map_images(line, options.maps);
    line.text("trajectory", options.trajectory);
    line.text("csv", options.csv);
    line.number("seconds", options.seconds, shortest_s, longest_s);
    line.number("until-silent", options.until_silent_s, shortest_s, longest_s);
    return line.run(argc, argv, [&] {
        cli::catch_interrupts();
        run(options);
    });
}
