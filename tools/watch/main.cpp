/* ale-watch: what the robot publishes, as one line a second and as files at the end. */
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

#include <getopt.h>

#include "console/lcm_feed.h"
#include "watch/pictures.h"
#include "watch/record.h"
#include "watch/report.h"

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

std::atomic<bool> interrupted{false};

double positive_number(const char *name, const char *text)
{
    char *rest = nullptr;
    const double value = std::strtod(text, &rest);
    if (rest == text || *rest != '\0' || !(value > 0 && value < 1e9)) {
        throw std::invalid_argument(std::string(name) + " wants a number of seconds, not " + text);
    }
    return value;
}

/* The exit code when the command line has been answered already, else -1. */
int parse(int argc, char **argv, Options &options)
{
    static const option known[] = {{"lcm-url", required_argument, nullptr, 'l'},
                                   {"map", required_argument, nullptr, 'm'},
                                   {"trajectory", required_argument, nullptr, 't'},
                                   {"csv", required_argument, nullptr, 'c'},
                                   {"seconds", required_argument, nullptr, 's'},
                                   {"until-silent", required_argument, nullptr, 'u'},
                                   {"help", no_argument, nullptr, 'h'},
                                   {"version", no_argument, nullptr, 'v'},
                                   {nullptr, 0, nullptr, 0}};
    for (int choice; (choice = getopt_long(argc, argv, "", known, nullptr)) != -1;) {
        switch (choice) {
        case 'l':
            options.lcm_url = optarg;
            break;
        case 'm':
            watch::require_picture_kind(optarg);
            options.maps.emplace_back(optarg);
            break;
        case 't':
            options.trajectory = optarg;
            break;
        case 'c':
            options.csv = optarg;
            break;
        case 's':
            options.seconds = positive_number("--seconds", optarg);
            break;
        case 'u':
            options.until_silent_s = positive_number("--until-silent", optarg);
            break;
        case 'h':
            std::fputs(usage, stdout);
            return 0;
        case 'v':
            std::puts("ale-watch 0.1.0");
            return 0;
        default:
            return 2;
        }
    }
    if (optind < argc) {
        throw std::invalid_argument("what is \"" + std::string(argv[optind]) + "\"? (see --help)");
    }
    return -1;
}

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
    for (int lines = 0; !interrupted;) {
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
    Options options;
    try {
        const int answered = parse(argc, argv, options);
        if (answered >= 0) {
            return answered;
        }
        const auto interrupt = [](int) { interrupted = true; };
        std::signal(SIGINT, interrupt);
        std::signal(SIGTERM, interrupt);
        run(options);
    } catch (const std::invalid_argument &error) {
        std::fprintf(stderr, "ale-watch: %s\n", error.what());
        return 2;
    } catch (const std::exception &error) {
        std::fprintf(stderr, "ale-watch: %s\n", error.what());
        return 1;
    }
    return 0;
}
