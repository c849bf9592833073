/* ale-send: one signed command from a shell, and what came of it. */
#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/command_line/command_line.h"
#include "common/command_line/interrupt.h"
#include "common/feed/vouched.h"
#include "operator/send/dictation.h"
#include "operator/send/robot_link.h"

extern "C" {
#include "command/verb.h"
#include "command/verify.h"
}

namespace
{

constexpr char usage[] =
    "usage: ale-send --keys FILE [--robots FILE] [--robot NAME] [--lcm-url URL] [--seconds S] VERB "
    "[ARGUMENT]...\n"
    "Sends the robot a signed command and says what came of it.\n"
    "  --keys FILE    the operator's secret key (ale-keys makes it)\n"
    "  --robots FILE  the robots whose word is believed (default: the file of --keys with .robots behind);\n"
    "                 where there is none, every robot's, and that is said\n"
    "  --robot NAME   which robot; needed where more than one is heard, but for stop, which goes to all\n"
    "  --lcm-url URL  where the robot is (default: LCM_DEFAULT_URL, else LCM's own default)\n"
    "  --seconds S    goes on driving for S seconds (drive only; without it the robot moves for 300 ms)\n"
    "  --help, --version\n"
    "Verbs:\n"
    "  drive V W               m/s forward, rad/s counter-clockwise\n"
    "  stop                    stands still at once; exploration and goal end\n"
    "  explore on|off\n"
    "  goto X Y                drives to that place of the map, in metres\n"
    "  reset                   forgets map and pose\n"
    "  record                  writes a flight recording\n"
    "  relocate X Y THETA      the robot is there, in metres and radians of the map\n"
    "  save_map NAME, load_map NAME [X Y THETA]\n"
    "  set drive_speed V, set drive_turn W, set publish_scan yes|no, set freeze_map yes|no\n"
    "  -                       commands from the standard input, one a line; each is answered by a line\n"
    "Options come before the verb. Exit status: 0 obeyed, 1 not, 2 wrong use.\n";

constexpr int first_status_ms = 4000;
constexpr int answer_ms = 4000;
constexpr int settle_ms = 1500; /* a robot says its status once a second */
constexpr int drive_period_ms = 100;
constexpr int64_t drive_life_us = 1000000;
constexpr int64_t life_us = 5000000;

struct Options {
    std::string keys;
    std::string robots;
    std::string robot;
    std::string lcm_url;
    double seconds = 0;
    std::vector<std::string> words;
};

ale_command_t command_of(const std::vector<std::string> &words)
{
    std::vector<const char *> texts(words.size());
    std::transform(words.begin(), words.end(), texts.begin(),
                   [](const std::string &word) { return word.c_str(); });
    ale_command_t command;
    if (ale_command_from_words(texts.data(), static_cast<uint32_t>(texts.size()), &command) < 0) {
        throw cli::WrongUse("too many words, or one that is too long");
    }
    return command;
}

/* Words after the verb are its own: a robot may be driven backwards. */
void check_order(const std::vector<std::string> &words)
{
    const auto option = std::find_if(words.begin(), words.end(),
                                     [](const std::string &word) { return word.rfind("--", 0) == 0; });
    if (option != words.end()) {
        throw cli::WrongUse("options come before the verb: " + *option);
    }
}

bool is_dictated(const Options &options)
{
    return options.words == std::vector<std::string>{"-"};
}

/* A command that no robot could obey is told before one is looked for. */
void check(const Options &options)
{
    check_order(options.words);
    if (options.keys.empty() || options.words.empty()) {
        throw cli::WrongUse(options.keys.empty() ? "--keys is missing" : "which verb?");
    }
    if (is_dictated(options)) {
        return;
    }
    const ale_command_t command = command_of(options.words);
    char error[ALE_VERB_ERROR];
    const int verb = ale_verb_of(&command, error);
    if (verb < 0) {
        throw cli::WrongUse(error);
    }
    if (options.seconds > 0 && verb != ALE_VERB_DRIVE) {
        throw cli::WrongUse("--seconds is for drive only");
    }
}

int64_t counter_of(const ale::status_t &status, const std::string &name)
{
    for (size_t k = 0; k < status.counter_name.size(); k++) {
        if (status.counter_name[k] == name) {
            return status.counter_value[k];
        }
    }
    return 0;
}

/* Why there is no answer, as far as the counters tell. */
std::string refusal(const ale::status_t &before, const ale::status_t &after)
{
    for (int verdict = ALE_GENUINE + 1; verdict < ALE_VERDICTS; verdict++) {
        const char *name = ale_verdict_name(static_cast<ale_verdict_t>(verdict));
        if (counter_of(after, name) > counter_of(before, name)) {
            return std::string("refused (") + name + ")";
        }
    }
    return "no answer";
}

void keep_driving(send::RobotLink &link, const Options &options)
{
    const int turns = static_cast<int>(options.seconds * 1000 / drive_period_ms);
    for (int k = 0; k < turns && !cli::interrupted(); k++) {
        link.wait(drive_period_ms, cli::interrupted);
        link.command(command_of(options.words), drive_life_us);
    }
    if (turns > 0) {
        link.command(command_of({"drive", "0", "0"}), drive_life_us);
    }
}

ale_secret_key_t key_of(const Options &options)
{
    ale_secret_key_t key;
    char error[ALE_KEYS_ERROR];
    if (ale_secret_key_load(options.keys.c_str(), &key, error) < 0) {
        throw std::runtime_error(error);
    }
    return key;
}

std::string nobody(const send::RobotLink &link, const Options &options)
{
    const std::string name = options.robot.empty() ? "" : " " + options.robot;
    if (!link.unbelieved()) {
        return "no robot" + name + " is heard";
    }
    const std::string &heard = link.unbelieved()->robot;
    if (!link.unbelieved()->takes_commands) {
        return heard + " takes no commands (ale-slamd --keys), as far as it can be believed";
    }
    return heard + " is heard, but nothing that a robot of " +
           (options.robots.empty() ? options.keys + ALE_ROBOTS_ENDING : options.robots) +
           " vouches for (ale-keys --own, --know)";
}

void wait_for_robot(send::RobotLink &link, const Options &options)
{
    if (!link.wait(first_status_ms, [&] { return link.status().has_value(); })) {
        throw std::runtime_error(nobody(link, options));
    }
    if (!link.is_vouched()) {
        std::fprintf(stderr,
                     "ale-send: nobody vouches for what %s says: no robot's key is known (ale-keys --know)\n",
                     link.status()->robot.c_str());
    }
}

/* One robot that is believed, or wanted by its name: no other one is listened for. */
bool is_alone(const Options &options, size_t believed)
{
    return !options.robot.empty() || believed == 1;
}

std::string takes_none(const std::string &robot)
{
    return robot + " takes no commands (ale-slamd --keys)";
}

/* Waits until it is known which robot is meant; says why it is not. */
void find_robot(send::RobotLink &link, bool alone)
{
    if (!alone) {
        link.wait(settle_ms, [&] { return !link.rival().empty() || cli::interrupted(); });
    }
    const std::string &name = link.status()->robot;
    const std::string rival = link.rival();
    if (!rival.empty()) {
        throw std::runtime_error(rival == name
                                     ? "two robots call themselves " + name +
                                           ": give them names (commands.robot); they obey stop alone"
                                     : "two robots are heard, " + name + " and " + rival +
                                           ": which one is meant? (--robot NAME; stop goes to all)");
    }
    if (!link.status()->takes_commands) {
        throw std::runtime_error(takes_none(name));
    }
}

/* What robots have said to it, and who of those that are heard has said nothing. */
int report(const send::RobotLink &link, const ale::status_t &before)
{
    bool obeyed = true;
    for (const auto &[robot, answer] : link.answers()) {
        std::printf("%s: %s\n", robot.c_str(), answer.command_result.c_str());
        obeyed = obeyed && answer.command_obeyed;
    }
    std::fflush(stdout);
    std::string silent;
    for (const std::string &robot : link.unanswered()) {
        const bool known = robot == before.robot;
        silent += silent.empty() ? "" : "; ";
        silent += known && !before.takes_commands
                      ? takes_none(robot)
                      : robot + ": " + (known ? refusal(before, *link.status()) : "no answer");
    }
    if (!silent.empty()) {
        throw std::runtime_error(silent);
    }
    return obeyed ? 0 : 1;
}

/* Goes out at once, to all that are heard and to whom is heard soon after: one robot that stands too many
 * does no harm, and a name that somebody has forged keeps no robot from standing. */
int stop(send::RobotLink &link, bool alone)
{
    const ale::status_t before = *link.status();
    const ale_command_t command = command_of({"stop"});
    const auto again = [&] {
        if (link.was_misled()) {
            link.command(command, life_us);
        }
        return cli::interrupted();
    };
    link.command(command, life_us);
    if (!alone) {
        link.wait(settle_ms, again);
    }
    link.wait(answer_ms, [&] { return again() || link.unanswered().empty(); });
    return report(link, before);
}

int command(send::RobotLink &link, const Options &options)
{
    const ale::status_t before = *link.status();
    const bool driving = options.words[0] == "drive";
    const auto send = [&] { link.command(command_of(options.words), driving ? drive_life_us : life_us); };
    const auto answered = [&] {
        if (link.was_misled()) {
            send();
        }
        return link.answered() || (driving && link.drives_since()) || cli::interrupted();
    };
    send();
    if (!link.wait(answer_ms, answered) || cli::interrupted()) {
        throw std::runtime_error(before.robot + ": " + refusal(before, *link.status()));
    }
    const ale::status_t &answer = *link.status();
    std::printf("%s: %s\n", answer.robot.c_str(), answer.command_result.c_str());
    std::fflush(stdout);
    if (answer.command_obeyed) {
        keep_driving(link, options);
    }
    return answer.command_obeyed ? 0 : 1;
}

int run(const Options &options)
{
    const ale_keys_t robots = feed::believed(options.robots, options.keys);
    send::RobotLink link(options.lcm_url, options.robot, key_of(options), robots);
    const bool alone = is_alone(options, robots.count);
    if (is_dictated(options)) {
        send::obey_dictation(link, alone);
        return 0;
    }
    wait_for_robot(link, options);
    if (options.words[0] == "stop") {
        return stop(link, alone);
    }
    find_robot(link, alone);
    return command(link, options);
}

} // namespace

int main(int argc, char **argv)
{
    Options options;
    cli::CommandLine line("ale-send", usage);
    line.text("keys", options.keys);
    line.text("robots", options.robots);
    line.text("robot", options.robot);
    line.text("lcm-url", options.lcm_url);
    line.number("seconds", options.seconds, 0.001, 3600.0);
    line.rest(options.words);
    return line.run(argc, argv, [&] {
        check(options);
        cli::catch_interrupts();
        return run(options);
    });
}
