#include "operator/console/messages.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <nlohmann/json.hpp>

namespace console
{

namespace
{

using nlohmann::json;

/* JSON has no NaN: what is not a number leaves as null. */
json number(double value, double per_unit = 1e4)
{
    return std::isfinite(value) ? json(std::round(value * per_unit) / per_unit) : json(nullptr);
}

json microseconds(double value)
{
    return number(value, 10);
}

template <class Values> json numbers(const Values &values, size_t count, double per_unit)
{
    json list = json::array();
    for (size_t k = 0; k < count; k++) {
        list.push_back(number(static_cast<double>(values[k]), per_unit));
    }
    return list;
}

/* Variances are small: seven significant digits instead of a fixed step. */
template <class Values> json variances(const Values &values, size_t count)
{
    json list = json::array();
    for (size_t k = 0; k < count; k++) {
        const auto value = static_cast<double>(values[k]);
        const double unit = value == 0 ? 1 : std::pow(10.0, 6 - std::floor(std::log10(std::fabs(value))));
        list.push_back(number(value, unit));
    }
    return list;
}

json pose_of(float x, float y, float theta)
{
    return json::array({number(x), number(y), number(theta)});
}

json corner_of(const ale::corner_t &corner)
{
    return {{"x", number(corner.x)},
            {"y", number(corner.y)},
            {"angle", number(corner.angle)},
            {"cov", variances(corner.cov, 3)},
            {"kind", corner.kind == 0 ? "convex" : "concave"}};
}

json corners_of(const std::vector<ale::corner_t> &corners)
{
    json list = json::array();
    for (const auto &corner : corners) {
        list.push_back(corner_of(corner));
    }
    return list;
}

json found_of(const ale::features_t &features)
{
    return json::array({features.lines.size(), features.corners.size()});
}

json beams_of(const ale::scan_t &scan)
{
    const auto good = std::count(scan.codes.begin(), scan.codes.end(), 0);
    return json::array({good, scan.range_mm.size()});
}

/* A corrupted string must not keep the rest of the message from the operator. */
std::string text_of(const json &message)
{
    return message.dump(-1, ' ', false, json::error_handler_t::replace);
}

json list_of(const std::vector<RobotTold> &robots)
{
    json list = json::array();
    for (const RobotTold &robot : robots) {
        list.push_back({{"name", robot.name}, {"state", robot.state}});
    }
    return list;
}

} // namespace

const char *state_name(int state)
{
    return state == 2 ? "good" : state == 1 ? "weak" : "lost";
}

std::string hello_message(const std::string &operator_name, const std::string &robot,
                          const std::vector<RobotTold> &robots)
{
    return text_of({{"type", "hello"},
                    {"protocol", 6},
                    {"operator", operator_name.empty() ? json(nullptr) : json(operator_name)},
                    {"robot", robot},
                    {"robots", list_of(robots)}});
}

std::string robots_message(const std::vector<RobotTold> &robots)
{
    return text_of({{"type", "robots"}, {"robots", list_of(robots)}});
}

std::string pose_message(const ale::pose_t &pose)
{
    json stages = json::array();
    for (const int32_t stage_ns : pose.stage_ns) {
        stages.push_back(microseconds(stage_ns / 1e3));
    }
    const int64_t sent_utime = pose.utime + pose.age_us;
    return text_of(
        {{"type", "pose"},
         {"utime", pose.utime},
         {"scan", pose.scan},
         {"smooth", pose_of(pose.x, pose.y, pose.theta)},
         {"map", pose_of(pose.map_x, pose.map_y, pose.map_theta)},
         {"cov", variances(pose.cov, 9)},
         {"observability", variances(pose.observability, 6)},
         {"velocity", pose_of(pose.vx, pose.vy, pose.omega)},
         {"state", state_name(pose.state)},
         {"predicted", pose.predicted != 0},
         {"lag_us", pose.lag_us},
         {"age_us", pose.age_us},
         {"latency_us", pose.arrival_utime > 0 ? json(sent_utime - pose.arrival_utime) : json(nullptr)},
         {"stages_us", stages}});
}

std::string tracking_message(const ale::tracking_t &tracking)
{
    return text_of({{"type", "tracking"},
                    {"utime", tracking.utime},
                    {"scan", tracking.scan},
                    {"map_id", tracking.map_id},
                    {"maps", tracking.maps},
                    {"wheels", tracking.wheel_word},
                    {"wheel_faults", tracking.wheel_faults}});
}

std::string plan_message(const ale::plan_t &plan)
{
    static const char *const states[] = {"off", "explores", "returns", "goes", "arrived", "given up"};
    json path = json::array();
    for (size_t k = 0; k < plan.x.size(); k++) {
        path.push_back(number(plan.x[k], 1e3));
        path.push_back(number(plan.y[k], 1e3));
    }
    return text_of(
        {{"type", "plan"},
         {"utime", plan.utime},
         {"state", states[plan.state]},
         {"words", plan.words},
         {"place", plan.has_place != 0 ? json::array({number(plan.place_x, 1e3), number(plan.place_y, 1e3)})
                                       : json(nullptr)},
         {"path", path}});
}

std::string graph_message(const ale::graph_t &graph)
{
    static const char *const kinds[] = {"recognised", "closed", "joins"};
    json keyframes = json::array();
    for (size_t k = 0; k < graph.x.size(); k++) {
        keyframes.push_back({{"at", json::array({number(graph.x[k], 1e3), number(graph.y[k], 1e3),
                                                 number(graph.theta[k], 1e3)})},
                             {"map_id", graph.map_id[k]},
                             {"tied", k > 0 && graph.tied[k] != 0}});
    }
    json loops = json::array();
    for (size_t k = 0; k < graph.loop_from.size(); k++) {
        loops.push_back(
            {{"from", graph.loop_from[k]}, {"to", graph.loop_to[k]}, {"kind", kinds[graph.loop_kind[k]]}});
    }
    return text_of({{"type", "graph"},
                    {"utime", graph.utime},
                    {"version", graph.version},
                    {"keyframes", keyframes},
                    {"loops", loops},
                    {"left_out", json::array({graph.keyframes_left_out, graph.loops_left_out})}});
}

std::string odometry_message(const WheelWay &way)
{
    const auto speed_of = [](const Speed &speed) {
        return json::array({number(speed.ahead_m_s), number(speed.turn_rad_s)});
    };
    return text_of({{"type", "odometry"},
                    {"utime", way.utime},
                    {"scan", way.scan},
                    {"wheels", speed_of(way.wheels)},
                    {"scans", speed_of(way.scans)}});
}

std::string features_brief(const ale::features_t &features)
{
    return text_of({{"type", "features"}, {"utime", features.utime}, {"found", found_of(features)}});
}

std::string scan_brief(const ale::scan_t &scan)
{
    return text_of({{"type", "scan"}, {"utime", scan.utime}, {"beams", beams_of(scan)}});
}

std::string features_message(const ale::features_t &features)
{
    json lines = json::array();
    for (const auto &line : features.lines) {
        lines.push_back({{"x1", number(line.x1)},
                         {"y1", number(line.y1)},
                         {"x2", number(line.x2)},
                         {"y2", number(line.y2)},
                         {"alpha", number(line.alpha)},
                         {"cov", variances(line.cov, 3)},
                         {"rmse", number(line.rmse, 1e5)},
                         {"ends", json::array({line.first_end, line.last_end})}});
    }
    return text_of({{"type", "features"},
                    {"utime", features.utime},
                    {"scan", features.scan},
                    {"sensor", pose_of(features.sensor_x, features.sensor_y, features.sensor_theta)},
                    {"found", found_of(features)},
                    {"lines", lines},
                    {"corners", corners_of(features.corners)}});
}

std::string scan_message(const ale::scan_t &scan, const std::optional<Stain> &stain)
{
    json ranges = json::array();
    std::map<int, int> codes;
    for (size_t k = 0; k < scan.range_mm.size(); k++) {
        const int code = k < scan.codes.size() ? scan.codes[k] : 0;
        if (code != 0) {
            codes[code]++;
        }
        ranges.push_back(code == 0 ? scan.range_mm[k] * scan.range_unit_mm : 0);
    }
    json counts = json::array();
    for (const auto &[code, count] : codes) {
        counts.push_back(json::array({code, count}));
    }
    return text_of({{"type", "scan"},
                    {"utime", scan.utime},
                    {"scan", scan.scan},
                    {"stamp_beam", scan.stamp_beam},
                    {"beam_time_us", number(scan.beam_time_us, 1e3)},
                    {"first_bearing", number(scan.first_bearing, 1e6)},
                    {"step", number(scan.step, 1e9)},
                    {"range_max", number(scan.range_max)},
                    {"sensor", pose_of(scan.sensor_x, scan.sensor_y, scan.sensor_theta)},
                    {"beams", beams_of(scan)},
                    {"ranges_mm", ranges},
                    {"codes", counts},
                    {"stain", stain ? json::array({stain->beams, stain->bearing}) : json(nullptr)}});
}

/* Of the few walls in other maps than the first it is said; a big map stays small on the wire. */
std::string map_message(const ale::map_t &map, const feed::MapPieces &pieces)
{
    json lines = json::array();
    for (const auto &line : map.lines) {
        lines.push_back({{"id", line.id},
                         {"x1", number(line.x1)},
                         {"y1", number(line.y1)},
                         {"x2", number(line.x2)},
                         {"y2", number(line.y2)},
                         {"seen", line.seen}});
        const int32_t map_id = pieces.map_of(map.version, line.id);
        if (map_id != 0) {
            lines.back()["map_id"] = map_id;
        }
    }
    return text_of({{"type", "map"},
                    {"utime", map.utime},
                    {"version", map.version},
                    {"lines", lines},
                    {"corners", corners_of(map.corners)}});
}

std::string status_message(const ale::status_t &status, const Trust &trust)
{
    json counters = json::array();
    const size_t count = std::min(status.counter_name.size(), status.counter_value.size());
    for (size_t k = 0; k < count; k++) {
        counters.push_back({{"name", status.counter_name[k]}, {"value", status.counter_value[k]}});
    }
    return text_of({{"type", "status"},
                    {"utime", status.utime},
                    {"boot", std::to_string(status.boot)},
                    {"scans", status.scans},
                    {"poses", status.poses},
                    {"state", state_name(status.state)},
                    {"stages_last_us", numbers(status.stage_last_us, 6, 10)},
                    {"stages_p99_us", numbers(status.stage_p99_us, 6, 10)},
                    {"stages_worst_us", numbers(status.stage_worst_us, 6, 10)},
                    {"latency_p50_us", microseconds(status.latency_p50_us)},
                    {"latency_p99_us", microseconds(status.latency_p99_us)},
                    {"latency_worst_us", microseconds(status.latency_worst_us)},
                    {"deadline_misses", status.deadline_misses},
                    {"realtime", status.realtime != 0},
                    {"realtime_detail", status.realtime_detail},
                    {"driver", status.driver_state},
                    {"device", status.device},
                    {"scan_rate_hz", number(status.scan_rate_hz, 100)},
                    {"counters", counters},
                    {"robot", status.robot},
                    {"vouched", trust.vouched},
                    {"warnings", trust.warnings},
                    {"takes_commands", status.takes_commands != 0},
                    {"who_drives", status.who_drives},
                    {"exploration", status.exploration},
                    {"map_frozen", status.map_frozen != 0},
                    {"command",
                     {{"operator", status.command_operator},
                      {"number", status.command_counter},
                      {"obeyed", status.command_obeyed != 0},
                      {"result", status.command_result}}}});
}

std::string trail_message(const TrailPiece &piece)
{
    json points = json::array();
    for (const TrailPoint &point : piece.points) {
        if (point.first) {
            points.push_back(nullptr);
            points.push_back(nullptr);
        }
        points.push_back(number(point.x, 1e3));
        points.push_back(number(point.y, 1e3));
    }
    return text_of({{"type", "trail"}, {"anew", piece.first == 0}, {"points", points}});
}

namespace
{

json recorder_of(const RecorderState &recorder)
{
    return {{"name", recorder.name.empty() ? json(nullptr) : json(recorder.name)},
            {"begun", recorder.begun_ms},
            {"messages", recorder.messages},
            {"bytes", recorder.bytes},
            {"dropped", recorder.dropped},
            {"trouble", recorder.trouble.empty() ? json(nullptr) : json(recorder.trouble)}};
}

} // namespace

std::string link_message(const LinkHealth &link, uint64_t skipped, const History::Span &span,
                         const RecorderState &recorder)
{
    return text_of({{"type", "link"},
                    {"pose_age_ms", link.pose_age_ms < 0 ? json(nullptr) : json(link.pose_age_ms)},
                    {"pose_rate_hz", number(link.pose_rate_hz, 100)},
                    {"poses", link.poses},
                    {"lost_poses", link.lost_poses},
                    {"malformed", link.malformed},
                    {"skipped", skipped},
                    {"kept", json::array({span.from_ms, span.to_ms})},
                    {"recorder", recorder_of(recorder)}});
}

std::string past_message(std::optional<int64_t> at_ms, const History::Span &span,
                         const std::string &recording, const std::string &damage)
{
    return text_of({{"type", "past"},
                    {"at", at_ms ? json(*at_ms) : json(nullptr)},
                    {"recording", recording.empty() ? json(nullptr) : json(recording)},
                    {"damage", damage.empty() ? json(nullptr) : json(damage)},
                    {"kept", json::array({span.from_ms, span.to_ms})}});
}

namespace
{

/* They are JSON already. */
std::string list_of(const std::vector<History::Text> &texts)
{
    std::string list = "[";
    for (const History::Text &text : texts) {
        list += (list.size() > 1 ? "," : "") + *text;
    }
    return list + "]";
}

} // namespace

std::string series_message(const Series &series)
{
    return R"({"type":"series","poses":)" + list_of(series.poses) + R"(,"trackings":)" +
           list_of(series.trackings) + R"(,"features":)" + list_of(series.features) + R"(,"scans":)" +
           list_of(series.scans) + R"(,"odometry":)" + list_of(series.odometry) + R"(,"statuses":)" +
           list_of(series.statuses) + "}";
}

std::string sent_message(const std::string &verb, const Sent &sent)
{
    const bool refused = !sent.refusal.empty();
    return text_of({{"type", "sent"},
                    {"verb", verb},
                    {"number", refused ? json(nullptr) : json(sent.number)},
                    {"refusal", refused ? json(sent.refusal) : json(nullptr)}});
}

namespace
{

/* A list of texts, or nothing. */
std::optional<std::vector<std::string>> words_of(const json &list)
{
    const bool texts =
        list.is_array() && !list.empty() &&
        std::all_of(list.begin(), list.end(), [](const json &word) { return word.is_string(); });
    return texts ? std::optional(list.get<std::vector<std::string>>()) : std::nullopt;
}

/* A time, or null for now. */
std::optional<PageMessage> look_of(const json &at)
{
    if (at.is_null()) {
        return PageMessage{PageMessage::Kind::look};
    }
    return at.is_number_integer()
               ? std::optional(PageMessage{PageMessage::Kind::look, 0, {}, at.get<int64_t>()})
               : std::nullopt;
}

/* What is asked of the console's recordings; nothing when it is anything else. */
std::optional<PageMessage> recordings_wish(const json &type, const json &message)
{
    using Kind = PageMessage::Kind;
    const json on = message.value("on", json());
    const json name = message.value("name", json());
    if (type == "shelf") {
        return PageMessage{Kind::shelf};
    }
    if (type == "record" && on.is_boolean()) {
        return PageMessage{Kind::record, 0, {}, {}, on.get<bool>()};
    }
    if (type == "open" && name.is_string()) {
        return PageMessage{Kind::open, 0, {}, {}, false, name.get<std::string>()};
    }
    return std::nullopt;
}

} // namespace

std::optional<PageMessage> page_message(const std::string &text)
{
    const json message = json::parse(text, nullptr, false);
    if (!message.is_object()) {
        return std::nullopt;
    }
    using Kind = PageMessage::Kind;
    const json type = message.value("type", json());
    if (type == "got" && message.contains("count") && message["count"].is_number_unsigned()) {
        return PageMessage{Kind::got, message["count"].get<uint64_t>()};
    }
    if (type == "series") {
        return PageMessage{Kind::series};
    }
    if (type == "stop_all") {
        return PageMessage{Kind::stop_all};
    }
    if (auto wish = recordings_wish(type, message)) {
        return wish;
    }
    if (type == "look" && message.contains("at")) {
        return look_of(message["at"]);
    }
    const auto words = type == "command" ? words_of(message.value("words", json())) : std::nullopt;
    return words ? std::optional(PageMessage{Kind::command, 0, *words}) : std::nullopt;
}

} // namespace console
