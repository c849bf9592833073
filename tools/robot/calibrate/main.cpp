/* ale-calibrate: noise, mounting and wheels of a robot from recordings, as configuration for ale-slamd. */
#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "common/command_line/command_line.h"
#include "common/command_line/files.h"
#include "common/command_line/interrupt.h"
#include "common/command_line/robot_files.h"
#include "common/export/text_file.h"
#include "robot/calibrate/configuration.h"
#include "robot/calibrate/live.h"
#include "robot/calibrate/mounting_report.h"
#include "robot/calibrate/noise_plot.h"

namespace
{

constexpr char usage[] =
    "usage: ale-calibrate [noise] LOG [--out FILE] [--plot F.svg]\n"
    "       ale-calibrate mounting LOG [--out FILE] [--config FILE]\n"
    "       ale-calibrate wheels LOG [--out FILE] [--config FILE]\n"
    "       ale-calibrate wheels --live [--lcm-url URL] [--seconds N]\n"
    "Finds what a robot's configuration needs from a recording in any format that ale-replay reads.\n"
    "  noise     [noise]: noise model of the scanner. Half a minute at rest, at a flat wall or anywhere "
    "with\n"
    "            walls at several distances and angles; a recording in which the scanner moves is refused\n"
    "  mounting  [sensor]: where the scanner sits. A minute's drive among walls with odometry: straight ways "
    "of\n"
    "            a few metres, turns in both directions, also on the spot\n"
    "  wheels    [odometry]: systematic errors of the wheels and their lag. The same drive\n"
    "  --out FILE     where the section goes (default: standard output)\n"
    "  --plot F.svg   noise: the fit as a plot\n"
    "  --config FILE  mounting, wheels: configuration, as for ale-slamd: noise of the scanner, blind "
    "sectors,\n"
    "                 upside down\n"
    "  --live         wheels: no recording; listens while somebody drives, and says whether the odometry has "
    "the\n"
    "                 right sign, axes, units, scale and time\n"
    "  --lcm-url URL  --live: where the robot publishes (default: LCM_DEFAULT_URL, else LCM's own default)\n"
    "  --seconds N    --live: gives up after so long (default 120)\n"
    "  --help, --version\n"
    "Exit 0 fine, 1 failed or something is wrong, 2 wrong use.\n";

constexpr char mounting_usage[] =
    "usage: ale-mounting LOG [--out FILE] [--config FILE]\n"
    "The older name of \"ale-calibrate mounting\" and \"ale-calibrate wheels\": writes what both find.\n"
    "  --out FILE     where the [sensor] and [odometry] sections go (default: standard output)\n"
    "  --config FILE  configuration, as for ale-slamd: noise of the scanner, blind sectors, upside down\n"
    "  --help, --version\n"
    "Exit 0 fine, 1 failed, 2 wrong use.\n";

enum class Subject { noise, mounting, wheels, mounting_and_wheels };

struct Options {
    Subject subject = Subject::noise;
    std::string log;
    std::string out = "-";
    std::string plot;
    std::string config;
    bool live = false;
    std::string lcm_url;
    int seconds = 120;
};

/* What fails names the log. */
template <class Work> auto of_log(const Options &options, Work work)
{
    try {
        return work();
    } catch (const std::runtime_error &error) {
        throw std::runtime_error(options.log + ": " + error.what());
    }
}

void write(const Options &options, const std::string &configuration)
{
    ale::TextFile file(options.out);
    file.put(configuration);
    file.close();
}

void calibrate_noise(const Options &options)
{
    const calibrate::Recording recording = calibrate::read_recording(options.log);
    const std::string source = calibrate::name_of_log(options.log);
    const calibrate::Calibration found = of_log(options, [&] { return calibrate::calibrate(recording); });
    write(options,
          of_log(options, [&] { return calibrate::accepted(calibrate::configuration(found, source)); }));
    if (!options.plot.empty()) {
        calibrate::plot(found, source, options.plot);
    }
}

mounting::Part part_of(Subject subject)
{
    switch (subject) {
    case Subject::mounting:
        return mounting::Part::mounting;
    case Subject::wheels:
        return mounting::Part::wheels;
    default:
        return mounting::Part::both;
    }
}

void calibrate_mounting(const Options &options)
{
    const mounting::Drive drive = mounting::read_drive(options.log, options.config);
    const std::string source = calibrate::name_of_log(options.log);
    write(options, of_log(options, [&] {
              return calibrate::accepted(
                  mounting::configuration(mounting::fit(drive), source, part_of(options.subject)));
          }));
}

void check(const Options &options)
{
    const bool noise = options.subject == Subject::noise;
    if (noise ? !options.config.empty() : !options.plot.empty()) {
        throw cli::WrongUse(noise ? "--config is for mounting and wheels" : "--plot is for noise");
    }
    cli::Files files;
    files.reads("LOG", options.log);
    files.reads("--config", options.config);
    files.writes("--out", options.out);
    files.writes("--plot", options.plot);
}

/* "wheels --live" */
int check_live(const Options &options, const std::string &first, const std::string &second)
{
    if (first != "wheels" || !second.empty() || options.out != "-" || !options.config.empty() ||
        !options.plot.empty()) {
        throw cli::WrongUse("--live is for wheels, and takes no recording and no file");
    }
    cli::catch_interrupts();
    return calibrate::check_first_drive(options.lcm_url, options.seconds) ? 0 : 1;
}

/* "[SUBJECT] LOG" */
void take_words(const std::string &first, const std::string &second, Options &options)
{
    const cli::Choices<Subject> subjects = {
        {"noise", Subject::noise}, {"mounting", Subject::mounting}, {"wheels", Subject::wheels}};
    const bool named =
        std::any_of(subjects.begin(), subjects.end(), [&](const auto &s) { return s.first == first; });
    if (named && second.empty()) {
        throw cli::WrongUse("LOG is missing");
    }
    if (!second.empty()) {
        options.subject = cli::choice_of("SUBJECT", first, subjects);
    }
    options.log = second.empty() ? first : second;
}

} // namespace

int main(int argc, char **argv)
{
    Options options;
    std::string first;
    std::string second;
    const bool older = std::filesystem::path(argv[0]).filename() == "ale-mounting";
    cli::CommandLine line(older ? "ale-mounting" : "ale-calibrate", older ? mounting_usage : usage);
    line.argument("LOG", first);
    if (!older) {
        line.possible_argument("LOG", second);
        cli::drawing(line, "plot", options.plot);
        line.flag("live", options.live);
        line.text("lcm-url", options.lcm_url);
        line.number("seconds", options.seconds, 1, 600);
    }
    line.text("out", options.out);
    line.text("config", options.config);
    return line.run(argc, argv, [&] {
        if (options.live) {
            return check_live(options, first, second);
        }
        if (older) {
            options.subject = Subject::mounting_and_wheels;
            options.log = first;
        } else {
            take_words(first, second, options);
        }
        check(options);
        options.subject == Subject::noise ? calibrate_noise(options) : calibrate_mounting(options);
        return 0;
    });
}
