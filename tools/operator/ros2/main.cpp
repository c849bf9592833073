/* ale-ros2: the robot as ROS 2 knows robots, on DDS and without an installation of ROS. */
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <string>

#include "common/command_line/command_line.h"
#include "common/command_line/interrupt.h"
#include "common/feed/checks.h"
#include "common/feed/lcm_feed.h"
#include "common/feed/map_parts.h"
#include "common/feed/map_pieces.h"
#include "common/feed/occupancy.h"
#include "operator/ros2/commander.h"
#include "operator/ros2/dds.h"
#include "operator/ros2/diagnostics.h"
#include "operator/ros2/robot_topics.h"
#include "operator/ros2/ros_commands.h"

namespace
{

constexpr char usage[] =
    "usage: ale-ros2 [--lcm-url URL] [--domain N] [--local] [--namespace NAME] [--stamped]\n"
    "                [--keys FILE [--robots FILE] [--robot NAME]]\n"
    "The robot on topics of ROS 2, over DDS: RViz2 and nav2 see it; ROS is not needed on this computer.\n"
    "Out: /scan /odom /pose /tf /tf_static /map /ale/lines /ale/walls /ale/graph /ale/plan /diagnostics;\n"
    "frames map, odom, base_link, laser.\n"
    "In, with a key: /initialpose /cmd_vel /goal_pose; whoever is on the DDS domain then commands with it.\n"
    "  --lcm-url URL     where the robot is (default: LCM_DEFAULT_URL, else LCM's own default)\n"
    "  --domain N        DDS domain (default: ROS_DOMAIN_ID, else 0)\n"
    "  --local           on this computer only (default where ROS_LOCALHOST_ONLY=1)\n"
    "  --namespace NAME  before the names of all topics: /NAME/scan\n"
    "  --stamped         /cmd_vel is a TwistStamped (nav2 from Kilted on) and no Twist\n"
    "  --keys FILE       the operator's secret key that commands are signed with (ale-keys makes it);\n"
    "                    without it they are refused\n"
    "  --robots FILE     the robots whose word is believed (default: the file of --keys with .robots "
    "behind)\n"
    "  --robot NAME      which robot is commanded; needed where more than one is heard\n"
    "  --help, --version\n"
    "Runs until Ctrl-C or SIGTERM. Exit status: 0 ended, 1 failed, 2 wrong use.\n";

struct Options {
    std::string lcm_url;
    uint32_t domain = 0;
    bool local = false;
    std::string space;
    bool stamped = false;
    std::string keys;
    std::string robots;
    std::string robot;
};

constexpr uint32_t highest_domain = 232;

/* What ROS's own environment says is the default. */
void take_environment(Options &options)
{
    if (const char *domain = std::getenv("ROS_DOMAIN_ID"); domain && *domain) {
        options.domain = cli::number_of<uint32_t>("ROS_DOMAIN_ID", domain, 0, highest_domain);
    }
    const char *local = std::getenv("ROS_LOCALHOST_ONLY");
    options.local = local && std::string(local) == "1";
}

/* Letters, digits, _ and / between them: as ROS names things. */
void check_space(const std::string &space)
{
    constexpr char allowed[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_/";
    if (space.find_first_not_of(allowed) != std::string::npos || space.front() == '/' ||
        space.back() == '/') {
        throw cli::WrongUse("--namespace " + space + ": letters, digits, _, and / between them");
    }
}

class Bridge
{
  public:
    explicit Bridge(const Options &options)
        : feed_(options.lcm_url), commander_({options.lcm_url, options.keys, options.robots, options.robot}),
          participant_(options.domain, options.local, options.space), topics_(participant_),
          commands_(participant_, commander_, options.stamped), diagnostics_(participant_)
    {
        subscribe();
        subscribe_to_map();
        subscribe_to_status();
    }

    void run()
    {
        constexpr int look_ms = 10;
        while (!cli::interrupted()) {
            feed_.wait(look_ms);
            at(next_commands_, std::chrono::milliseconds(40), [this] { commands_.poll(); });
            at(next_diagnostics_, std::chrono::seconds(1),
               [this] { diagnostics_.send(commands_, commander_.has_key()); });
            at(next_map_, std::chrono::seconds(2), [this] { send_map(); });
        }
    }

    void say_counts() const
    {
        std::fprintf(stderr,
                     "ale-ros2: %llu messages of the robot were malformed, %llu lost to slow readers\n",
                     static_cast<unsigned long long>(feed_.refused()),
                     static_cast<unsigned long long>(topics_.lost()));
    }

  private:
    using Clock = std::chrono::steady_clock;

    template <class Work> static void at(Clock::time_point &due, Clock::duration period, Work work)
    {
        const Clock::time_point now = Clock::now();
        if (now >= due) {
            due = now + period;
            work();
        }
    }

    void subscribe()
    {
        feed_.on<ale::scan_t>("ALE_SCAN", [this](const ale::scan_t &message) {
            feed::check(message);
            newest_utime_ = message.utime;
            topics_.send(message);
            occupancy_.take(message);
        });
        feed_.on<ale::pose_t>("ALE_POSE", [this](const ale::pose_t &message) {
            feed::check(message);
            newest_utime_ = message.utime;
            topics_.send(message);
            occupancy_.take(message);
        });
        feed_.on<ale::tracking_t>("ALE_TRACKING", [this](const ale::tracking_t &message) {
            feed::check(message);
            topics_.send(message);
            occupancy_.take(message);
            diagnostics_.take(message);
        });
        feed_.on<ale::features_t>("ALE_FEATURES", [this](const ale::features_t &message) {
            feed::check(message);
            topics_.send(message);
        });
    }

    void subscribe_to_map()
    {
        feed_.on<ale::map_pieces_t>("ALE_MAP_PIECES", [this](const ale::map_pieces_t &message) {
            feed::check(message);
            pieces_.add(message);
        });
        feed_.on<ale::map_t>("ALE_MAP", [this](const ale::map_t &message) {
            feed::check(message);
            if (parts_.add(message)) {
                occupancy_.take(parts_.whole(), pieces_);
                topics_.send(parts_.whole(), pieces_);
            }
        });
        feed_.on<ale::graph_t>("ALE_GRAPH", [this](const ale::graph_t &message) {
            feed::check(message);
            topics_.send(message);
            occupancy_.take(message);
        });
        feed_.on<ale::plan_t>("ALE_PLAN", [this](const ale::plan_t &message) {
            feed::check(message);
            topics_.send(message);
        });
    }

    void subscribe_to_status()
    {
        feed_.on<ale::status_t>("ALE_STATUS", [this](const ale::status_t &message) {
            if (commander_.saw(message)) {
                diagnostics_.take(message);
            }
        });
        feed_.on_bytes("ALE_VOUCHED", [this](const uint8_t *bytes, size_t count) {
            const std::optional<ale::status_t> status = commander_.saw_vouched(bytes, count);
            if (status) {
                diagnostics_.take(*status);
            }
        });
    }

    void send_map()
    {
        if (!occupancy_.has_changed()) {
            return;
        }
        try {
            topics_.send(occupancy_.grid(), newest_utime_);
        } catch (const std::runtime_error &error) {
            std::fprintf(stderr, "ale-ros2: /map: %s\n", error.what());
        }
    }

    feed::LcmFeed feed_;
    feed::MapParts parts_;
    feed::MapPieces pieces_;
    feed::Occupancy occupancy_;
    ros2::Commander commander_;
    ros2::Participant participant_;
    ros2::RobotTopics topics_;
    ros2::RosCommands commands_;
    ros2::Diagnostics diagnostics_;
    int64_t newest_utime_ = 0;
    Clock::time_point next_commands_{};
    Clock::time_point next_diagnostics_{};
    Clock::time_point next_map_{};
};

} // namespace

int main(int argc, char **argv)
{
    Options options;
    cli::CommandLine line("ale-ros2", usage);
    std::optional<uint32_t> domain;
    bool local = false;
    line.text("lcm-url", options.lcm_url);
    line.option("domain", [&](const std::string &word) {
        domain = cli::number_of<uint32_t>("--domain", word, 0, highest_domain);
    });
    line.flag("local", local);
    line.text("namespace", options.space);
    line.flag("stamped", options.stamped);
    line.text("keys", options.keys);
    line.text("robots", options.robots);
    line.text("robot", options.robot);
    return line.run(argc, argv, [&] {
        take_environment(options);
        options.domain = domain.value_or(options.domain);
        options.local = local || options.local;
        if (!options.space.empty()) {
            check_space(options.space);
        }
        cli::catch_interrupts();
        Bridge bridge(options);
        std::fprintf(stderr, "ale-ros2: on DDS domain %u%s\n", options.domain,
                     options.local ? ", this computer only" : "");
        bridge.run();
        bridge.say_counts();
    });
}
