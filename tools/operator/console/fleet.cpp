#include "operator/console/fleet.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <stdexcept>

#include "common/command_line/wrong_use.h"

extern "C" {
#include "lcm/url.h"
}

namespace console
{

namespace
{

/* A pose comes with every scan; the page, too, calls a link lost after that time. */
constexpr int64_t silence_ms = 700;

/* Where a robot speaks. */
struct Channels {
    std::string network;
    std::string prefix;
};

std::string words_of(const ale_lcm_group_t &group)
{
    std::string words;
    for (unsigned shift = 24; shift < 32; shift -= 8) {
        words += std::to_string((group.address >> shift) & 0xff) + (shift > 0 ? "." : ":");
    }
    return words + std::to_string(group.port);
}

Channels channels_of(const std::string &url)
{
    char error[ALE_LCM_URL_ERROR];
    const char *chosen = ale_lcm_url(url.c_str(), error);
    ale_lcm_group_t group;
    if (chosen == nullptr || (ale_lcm_is_group(chosen) && ale_lcm_group(chosen, &group, error) < 0)) {
        throw std::runtime_error(error);
    }
    return ale_lcm_is_group(chosen) ? Channels{words_of(group), group.prefix} : Channels{chosen, ""};
}

std::string name_of(const Channels &channels, const std::string &robot)
{
    const std::string of_prefix = channels.prefix.substr(0, channels.prefix.find_last_not_of("._-/") + 1);
    return !robot.empty() ? robot : !of_prefix.empty() ? of_prefix : channels.network;
}

/* The word for this robot; empty: none was given. */
std::string word_of(const std::vector<std::string> &words, size_t robot)
{
    return words.empty() ? "" : words[robot];
}

void check_count(const char *option, const std::vector<std::string> &words, size_t robots)
{
    if (!words.empty() && words.size() != robots) {
        throw cli::WrongUse(std::string(option) +
                            " is wanted once for each robot (--lcm-url), in their order: " +
                            std::to_string(words.size()) + " for " + std::to_string(robots));
    }
}

/* What no two robots may have. */
class Taken
{
  public:
    void take(const std::string &what, const std::string &complaint)
    {
        if (!what.empty() && !taken_.insert(what).second) {
            throw cli::WrongUse(complaint);
        }
    }

  private:
    std::set<std::string> taken_;
};

std::string state_of(const LinkHealth &link)
{
    return link.pose_age_ms < 0            ? "waiting"
           : link.pose_age_ms > silence_ms ? "silent"
                                           : state_name(link.state);
}

} // namespace

std::vector<RobotSettings> settings_of(const FleetOptions &options)
{
    const size_t count = std::max<size_t>(1, options.lcm_urls.size());
    check_count("--robot", options.robots, count);
    check_count("--recordings", options.recordings, count);
    check_count("--flights", options.flights, count);
    check_count("--maps", options.maps, count);
    std::vector<RobotSettings> settings;
    Taken places;
    Taken names;
    Taken folders;
    for (size_t k = 0; k < count; k++) {
        const std::string url = word_of(options.lcm_urls, k);
        const std::string robot = word_of(options.robots, k);
        const Channels channels = channels_of(url);
        const std::string name = name_of(channels, robot);
        const std::string recordings = word_of(options.recordings, k);
        places.take(channels.network + "/" + channels.prefix,
                    "two robots on the same channels, " + url +
                        ": each wants its own ([lcm] prefix, prefix= in the URL)");
        names.take(name, "two robots are called " + name + ": name each (--robot)");
        folders.take(recordings,
                     "two robots record into " + recordings + ": each wants its own --recordings");
        settings.push_back({name,
                            {url, options.key_file, options.robots_file, robot},
                            recordings,
                            word_of(options.flights, k),
                            word_of(options.maps, k)});
    }
    return settings;
}

Fleet::Fleet(const std::vector<RobotSettings> &settings)
{
    for (const RobotSettings &robot : settings) {
        robots_.emplace_back(robot);
    }
}

void Fleet::open(const std::function<void()> &wake)
{
    for (Robot &robot : robots_) {
        robot.board().on_change(wake);
        robot.desk().open(wake);
    }
}

void Fleet::close()
{
    for (Robot &robot : robots_) {
        robot.board().on_change(nullptr);
        robot.desk().close();
    }
}

Robot *Fleet::find(std::string_view name)
{
    const auto found = name.empty() ? robots_.begin()
                                    : std::find_if(robots_.begin(), robots_.end(),
                                                   [&](const Robot &robot) { return robot.name() == name; });
    return found == robots_.end() ? nullptr : &*found;
}

std::vector<RobotTold> Fleet::told() const
{
    const auto now = Board::Clock::now();
    std::vector<RobotTold> told;
    std::transform(robots_.begin(), robots_.end(), std::back_inserter(told), [&](const Robot &robot) {
        return RobotTold{robot.name(), state_of(robot.board().link(now))};
    });
    return told;
}

Sent Fleet::stop_all(uint64_t page, const Robot &shown)
{
    Sent all;
    for (Robot &robot : robots_) {
        const Sent sent = robot.commander().send(page, {"stop"});
        if (&robot == &shown) {
            all.number = sent.number;
        }
        if (!sent.refusal.empty()) {
            all.refusal += (all.refusal.empty() ? "" : "; ") + robot.name() + ": " + sent.refusal;
        }
    }
    return all;
}

} // namespace console
