/* ale-latency: where the time from a scan's first beam to its pose goes, live or from an LCM log. */
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>

#include <lcm/lcm.h>

#include "common/command_line/command_line.h"
#include "common/command_line/interrupt.h"
#include "common/feed/lcm_feed.h"
#include "robot/latency/latencies.h"
#include "robot/latency/report.h"

namespace
{

constexpr char usage[] =
    "usage: ale-latency [--lcm-url URL] [--seconds N | --poses N]\n"
    "       ale-latency LOG\n"
    "Reads the poses of ale-slamd and prints where the time of their scans went: sweep (first beam to last\n"
    "byte), wait (for the estimate task), its five stages, send (to the message on the wire), and in all\n"
    "(last byte to message): median, p99 and worst case, and a histogram. LOG is an LCM event log\n"
    "(lcm-logger's). Without LOG it listens until Ctrl-C or SIGTERM.\n"
    "  --lcm-url URL  where the robot publishes (default: LCM_DEFAULT_URL, else LCM's own default)\n"
    "  --seconds N    ends after N seconds\n"
    "  --poses N      ends after N poses\n"
    "  --help, --version\n"
    "Exit 1 when no pose came or the log cannot be read.\n";

constexpr char channel[] = "ALE_POSE";

struct Options {
    std::string log;
    std::string lcm_url;
    long seconds = 0;
    long poses = 0;
};

void check(const Options &options)
{
    if (!options.log.empty() && (!options.lcm_url.empty() || options.seconds + options.poses > 0)) {
        throw cli::WrongUse("one log, or the robot itself");
    }
}

/* Returns how many messages made no sense. */
uint64_t listen(const Options &options, latency::Latencies &latencies)
{
    feed::LcmFeed feed(options.lcm_url);
    feed.on<ale::pose_t>(channel, [&](const ale::pose_t &pose) { latencies.add(pose); });
    std::fputs("ale-latency: listening\n", stderr);
    const std::time_t end = std::time(nullptr) + options.seconds;
    while (!cli::interrupted() && (options.seconds == 0 || std::time(nullptr) < end) &&
           (options.poses == 0 || latencies.poses() < options.poses)) {
        feed.wait(50);
    }
    return feed.malformed();
}

uint64_t read(const Options &options, latency::Latencies &latencies)
{
    if (std::filesystem::is_directory(options.log)) {
        throw std::runtime_error(options.log + ": is a directory");
    }
    const std::unique_ptr<lcm_eventlog_t, decltype(&lcm_eventlog_destroy)> log(
        lcm_eventlog_create(options.log.c_str(), "r"), lcm_eventlog_destroy);
    if (!log) {
        throw std::runtime_error(options.log + ": " + std::strerror(errno));
    }
    uint64_t malformed = 0;
    for (lcm_eventlog_event_t *event; (event = lcm_eventlog_read_next_event(log.get())) != nullptr;) {
        const std::unique_ptr<lcm_eventlog_event_t, decltype(&lcm_eventlog_free_event)> owned(
            event, lcm_eventlog_free_event);
        if (std::strcmp(event->channel, channel) != 0) {
            continue;
        }
        try {
            ale::pose_t pose;
            if (pose.decode(event->data, 0, event->datalen) < 0) {
                throw std::runtime_error("truncated, or of another type");
            }
            latencies.add(pose);
        } catch (const std::runtime_error &) {
            malformed++;
        }
    }
    return malformed;
}

void run(const Options &options)
{
    latency::Latencies latencies;
    const uint64_t malformed = options.log.empty() ? listen(options, latencies) : read(options, latencies);
    if (malformed > 0) {
        std::fprintf(stderr, "ale-latency: %llu messages on %s made no sense and were left out\n",
                     static_cast<unsigned long long>(malformed), channel);
    }
    if (latencies.poses() == 0) {
        throw std::runtime_error(options.log.empty()
                                     ? "no pose came: is ale-slamd running, and on the same LCM URL?"
                                     : options.log + ": no " + channel + " in it: is it an LCM event log?");
    }
    std::fputs(latency::report(latencies).c_str(), stdout);
}

} // namespace

int main(int argc, char **argv)
{
    Options options;
    cli::CommandLine line("ale-latency", usage);
    line.text("lcm-url", options.lcm_url);
    line.number("seconds", options.seconds, 1L, 1000000000L);
    line.number("poses", options.poses, 1L, 1000000000L);
    line.possible_argument("LOG", options.log);
    return line.run(argc, argv, [&] {
        check(options);
        cli::catch_interrupts();
        run(options);
    });
}
