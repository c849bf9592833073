/* The messages between ale-console and its page: JSON, one object each; WEB_SOCKET.md lists the fields.
 * Metres, radians and microseconds, rounded to what an eye or a map can use (0.1 mm, 0.1 mrad). */
#ifndef CONSOLE_MESSAGES_H
#define CONSOLE_MESSAGES_H

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ale/features_t.hpp"
#include "ale/graph_t.hpp"
#include "ale/map_t.hpp"
#include "ale/plan_t.hpp"
#include "ale/pose_t.hpp"
#include "ale/scan_t.hpp"
#include "ale/status_t.hpp"
#include "ale/tracking_t.hpp"
#include "common/feed/map_pieces.h"
#include "operator/console/board.h"
#include "operator/console/commander.h"
#include "operator/console/recordings/recorder.h"
#include "operator/console/wheel_watch.h"
#include "operator/console/window_watch.h"

namespace console
{

/* good, weak or lost: a pose's state in a word. */
const char *state_name(int state);

/* A robot of the console in the list of them. */
struct RobotTold {
    std::string name;
    std::string state; /* state_name; silent: no pose comes any more; waiting: none has come yet */
};

/* operator_name empty: no command can be given here. robot: that the page shows, one of the list. */
std::string hello_message(const std::string &operator_name, const std::string &robot,
                          const std::vector<RobotTold> &robots);
/* Some are in another state than before. */
std::string robots_message(const std::vector<RobotTold> &robots);
std::string pose_message(const ale::pose_t &pose);
std::string tracking_message(const ale::tracking_t &tracking);
std::string plan_message(const ale::plan_t &plan);
std::string graph_message(const ale::graph_t &graph);
std::string odometry_message(const WheelWay &way);
std::string features_message(const ale::features_t &features);
std::string scan_message(const ale::scan_t &scan, const std::optional<Stain> &stain = {});
/* Of these two only how much there is in them, for charts. */
std::string features_brief(const ale::features_t &features);
std::string scan_brief(const ale::scan_t &scan);
std::string map_message(const ale::map_t &map, const feed::MapPieces &pieces = {});
/* Whether the robot vouches for a status, and what an operator must know of whom he hears. */
struct Trust {
    bool vouched = false;
    std::vector<std::string> warnings;
};
std::string status_message(const ale::status_t &status, const Trust &trust = {});
std::string trail_message(const TrailPiece &piece);
std::string link_message(const LinkHealth &link, uint64_t skipped, const History::Span &span = {},
                         const RecorderState &recorder = {});

/* What follows is of the past, as it was at that time; nothing when it is of now again. The span of what is
 * kept; recording: whose past it is, empty: that of the robot that is heard; damage: what of that is left
 * out.
 */
std::string past_message(std::optional<int64_t> at_ms, const History::Span &span,
                         const std::string &recording = "", const std::string &damage = "");

/* Messages of the past, for charts. */
struct Series {
    std::vector<History::Text> poses;
    std::vector<History::Text> trackings;
    std::vector<History::Text> features; /* in brief */
    std::vector<History::Text> scans;    /* in brief */
    std::vector<History::Text> odometry;
    std::vector<History::Text> statuses;
};
std::string series_message(const Series &series);

/* What became of a page's command: on its way to the robot under that number, or not and why. */
std::string sent_message(const std::string &verb, const Sent &sent);

/* What a page says: {"type":"got","count":n}; {"type":"command","words":["drive","0.2","0"]};
 * {"type":"look","at":ms}, null for now; {"type":"series"}; {"type":"shelf"}; {"type":"record","on":true};
 * {"type":"open","name":"..."}, the file of a recording; {"type":"stop_all"}.
 * Nothing when the text is anything else. */
struct PageMessage {
    enum class Kind { got, command, stop_all, look, series, shelf, record, open } kind = Kind::got;
    uint64_t drawn = 0;
    std::vector<std::string> words{};
    std::optional<int64_t> at_ms{};
    bool on = false;
    std::string name{};
};
std::optional<PageMessage> page_message(const std::string &text);

} // namespace console

#endif
