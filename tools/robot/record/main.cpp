/* ale-record: what passes on the scanner's serial line, and the odometry beside it, into a .scip file. */
#include <cmath>
#include <cstdint>
#include <string>

#include "common/command_line/command_line.h"
#include "common/command_line/interrupt.h"
#include "robot/record/recorder.h"

namespace
{

constexpr char usage[] =
    "usage: ale-record --port DEV --out FILE [--type NAME] [--seconds N] [--lcm-url URL | --no-lcm]\n"
    "                  [--serial S] [--baud N] [--time-scale X]\n"
    "\n"
    "Records a laser scanner: every byte on its line, both ways, and the wheel odometry from LCM,\n"
    "as a .scip recording that ale-replay reads, and ale-sim plays if it is a URG's.\n"
    "\n"
    "  --port DEV      serial device of the scanner; without it, --serial says which one to look for\n"
    "  --out FILE      the recording\n"
    "  --type NAME     urg (default), ldrobot, rplidar; auto: whichever answers\n"
    "  --seconds N     ends after N seconds; without it, Ctrl-C or SIGTERM ends it\n"
    "  --lcm-url URL   where ALE_ODOMETRY comes from\n"
    "  --no-lcm        records the scanner only\n"
    "  --serial S      only the scanner with this serial number\n"
    "  --baud N        baud rate of a real RS-232 line; without it the rate is detected\n"
    "  --time-scale X  the clock runs X times as fast (0.01 to 100), with a simulator's --speed X\n"
    "  --help, --version\n"
    "\n"
    "Exit status: 0 fine, 1 no scan came or the recording could not be written, 2 wrong use.\n";

const std::string &family_of(const std::string &word)
{
    if (!ale_scanner_has_family(word.c_str())) {
        char names[ALE_SCANNER_NAMES];
        ale_scanner_families(names);
        throw cli::WrongUse("--type " + word + ": there are " + names);
    }
    return word;
}

void bind(cli::CommandLine &line, record::Options &o)
{
    line.text("port", o.port);
    line.text("out", o.out);
    line.option("type", [&o](const std::string &word) { o.type = family_of(word); });
    line.number("seconds", o.seconds, int64_t{1}, int64_t{31536000});
    line.text("lcm-url", o.lcm_url);
    line.flag("no-lcm", o.lcm, false);
    line.text("serial", o.serial);
    line.number("baud", o.baud, 1, 4000000);
    line.number("time-scale", o.time_scale, 0.01, 100.0);
}

void check(const record::Options &o)
{
    if (o.out.empty()) {
        throw cli::WrongUse("--out FILE is missing");
    }
    if (o.port.empty() && o.serial.empty()) {
        throw cli::WrongUse("--port DEV (or --serial S) is missing");
    }
    if (!o.lcm && !o.lcm_url.empty()) {
        throw cli::WrongUse("--lcm-url and --no-lcm exclude each other");
    }
}

} // namespace

int main(int argc, char **argv)
{
    record::Options options;
    cli::CommandLine line("ale-record", usage);
    bind(line, options);
    return line.run(argc, argv, [&] {
        check(options);
        cli::catch_interrupts();
        record::Recorder recorder(options);
        recorder.run(cli::interrupted);
        recorder.finish();
    });
}
