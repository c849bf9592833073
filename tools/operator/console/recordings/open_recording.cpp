#include "operator/console/recordings/open_recording.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "common/feed/map_parts.h"
#include "common/feed/map_pieces.h"
#include "operator/console/messages.h"
#include "operator/console/recordings/recorded_message.h"

namespace console
{

namespace
{

constexpr int64_t trail_ms = int64_t{2} * 60 * 1000;
constexpr int64_t scan_ms = 200; /* what belongs to the newest pose has come by then */

constexpr std::pair<const char *, Topic> single_messages[] = {
    {"ALE_TRACKING", Topic::tracking}, {"ALE_FEATURES", Topic::features}, {"ALE_SCAN", Topic::scan},
    {"ALE_GRAPH", Topic::graph},       {"ALE_PLAN", Topic::plan},         {"ALE_STATUS", Topic::status}};

std::string scan_words(const ale::scan_t &scan)
{
    return scan_message(scan);
}

std::string status_words(const ale::status_t &status)
{
    return status_message(status);
}

History::Text shared(const std::string &text)
{
    return text.empty() ? nullptr : std::make_shared<const std::string>(text);
}

/* The last entry that is not later; nullptr: all are. */
template <class Entry> const Entry *newest(const std::vector<Entry> &entries, int64_t at_ms)
{
    const auto after = std::upper_bound(entries.begin(), entries.end(), at_ms,
                                        [](int64_t time, const Entry &entry) { return time < entry.at_ms; });
    return after == entries.begin() ? nullptr : &*std::prev(after);
}

} // namespace

OpenRecording::OpenRecording(Descriptor file, int64_t later_ms, std::string damage)
    : file_(std::move(file)), damage_(std::move(damage))
{
    EventReader reader(file_);
    EventPlace event;
    size_t messages = 0;
    int64_t at_ms = INT64_MIN; /* a clock that is set back must not bring times out of order */
    while (reader.next(event)) {
        if (++messages > most_messages) {
            throw std::runtime_error("the recording is too long to be shown: more than " +
                                     std::to_string(most_messages) + " messages");
        }
        at_ms = std::max(at_ms, event.received_us / 1000 + later_ms);
        take(event, at_ms);
    }
    if (to_ms_ == 0) {
        throw std::runtime_error("there is no message of a robot in this recording");
    }
    note_damage(reader.damage());
}

void OpenRecording::note_damage(const Damage &damage)
{
    const auto add = [this](const std::string &words) {
        damage_ += (damage_.empty() || words.empty() ? "" : ", ") + words;
    };
    add(damage_words(damage));
    if (senseless_ > 0) {
        add(std::to_string(senseless_) + (senseless_ == 1 ? " message makes" : " messages make") +
            " no sense");
    }
}

void OpenRecording::take(const EventPlace &event, int64_t at_ms)
{
    const Place place = {at_ms, event.data_at, event.data_bytes};
    const auto *single = std::find_if(std::begin(single_messages), std::end(single_messages),
                                      [&](const auto &entry) { return event.channel == entry.first; });
    if (single != std::end(single_messages)) {
        places_[static_cast<size_t>(single->second)].push_back(place);
    } else if (event.channel == "ALE_POSE") {
        take_pose(place);
    } else if (event.channel == "ALE_MAP") {
        take_map(place);
    } else if (event.channel == "ALE_MAP_PIECES") {
        take_pieces(place);
    } else {
        if (event.channel == "ALE_ODOMETRY") {
            take_odometry(place); /* of the robot's wheels, and not of the robot itself */
        }
        return;
    }
    from_ms_ = to_ms_ == 0 ? at_ms : from_ms_;
    to_ms_ = at_ms;
}

template <class Message> std::optional<Message> OpenRecording::message_of(const Place &place) const
{
    return recorded_message<Message>(data_of(file_, {0, {}, place.data_at, place.data_bytes}));
}

/* The same, and one that makes no sense is counted. */
template <class Message> std::optional<Message> OpenRecording::taken(const Place &place)
{
    auto message = message_of<Message>(place);
    senseless_ += !message;
    return message;
}

template <class Message>
std::string OpenRecording::json_of(const Place &place, std::string (*words)(const Message &)) const
{
    const std::optional<Message> message = message_of<Message>(place);
    return message ? words(*message) : "";
}

void OpenRecording::take_pose(const Place &place)
{
    const auto pose = taken<ale::pose_t>(place);
    if (!pose) {
        return;
    }
    const bool first =
        !last_pose_ || pose->scan <= last_pose_->scan ||
        std::hypot(pose->map_x - last_pose_->map_x, pose->map_y - last_pose_->map_y) > trail_jump_m;
    places_[static_cast<size_t>(Topic::pose)].push_back(place);
    way_.push_back({place.at_ms, {pose->map_x, pose->map_y, first}});
    last_pose_ = pose;
    wheels_.pose(*pose);
    take_wheels(place.at_ms);
}

void OpenRecording::take_odometry(const Place &place)
{
    if (const auto sample = taken<ale::odometry_t>(place)) {
        wheels_.odometry(*sample);
        take_wheels(place.at_ms);
    }
}

void OpenRecording::take_wheels(int64_t at_ms)
{
    while (const auto way = wheels_.next()) {
        driven_.push_back({at_ms, *way});
    }
}

void OpenRecording::take_map(const Place &place)
{
    const auto map = taken<ale::map_t>(place);
    if (map && map_parts_.add({map->version, map->part, map->parts, place})) {
        maps_.push_back({place.at_ms, map_parts_.take(), pieces_});
    }
}

void OpenRecording::take_pieces(const Place &place)
{
    const auto pieces = taken<ale::map_pieces_t>(place);
    if (pieces && piece_parts_.add({pieces->version, pieces->part, pieces->parts, place})) {
        pieces_ = piece_parts_.take();
    }
}

/* Of the poses; of all of it where there are none. */
History::Span OpenRecording::span() const
{
    const std::vector<Place> &poses = of(Topic::pose);
    return poses.size() < 2 ? History::Span{from_ms_, to_ms_}
                            : History::Span{poses.front().at_ms, poses.back().at_ms};
}

/* The last moment before the pose that follows. */
int64_t OpenRecording::end_of_scan(int64_t at_ms) const
{
    const std::vector<Place> &poses = of(Topic::pose);
    const auto next = std::upper_bound(poses.begin(), poses.end(), at_ms,
                                       [](int64_t time, const Place &pose) { return time < pose.at_ms; });
    return next == poses.end() ? at_ms + scan_ms : next->at_ms - 1;
}

/* nullptr: nothing that makes sense. */
History::Text OpenRecording::text_of(Topic topic, const Place &place) const
{
    const auto text = [&] {
        switch (topic) {
        case Topic::pose:
            return json_of<ale::pose_t>(place, pose_message);
        case Topic::tracking:
            return json_of<ale::tracking_t>(place, tracking_message);
        case Topic::features:
            return json_of<ale::features_t>(place, features_message);
        case Topic::scan:
            return json_of<ale::scan_t>(place, scan_words);
        case Topic::graph:
            return json_of<ale::graph_t>(place, graph_message);
        case Topic::plan:
            return json_of<ale::plan_t>(place, plan_message);
        case Topic::status:
            return json_of<ale::status_t>(place, status_words);
        case Topic::map:
        case Topic::odometry: /* neither is a message of its own */
            break;
        }
        return std::string();
    }();
    return shared(text);
}

History::Text OpenRecording::text_of(const Driven &driven)
{
    return std::make_shared<const std::string>(odometry_message(driven.way));
}

History::Text OpenRecording::brief_of(Topic topic, const Place &place) const
{
    if (topic == Topic::features) {
        return shared(json_of<ale::features_t>(place, features_brief));
    }
    return topic == Topic::scan ? shared(json_of<ale::scan_t>(place, scan_brief)) : text_of(topic, place);
}

History::Text OpenRecording::map_text(int64_t at_ms) const
{
    const Map *map = newest(maps_, at_ms);
    feed::MapParts parts;
    feed::MapPieces pieces;
    bool whole = false;
    for (const Part &piece : map ? map->pieces : std::vector<Part>()) {
        if (const auto message = message_of<ale::map_pieces_t>(piece.place)) {
            pieces.add(*message);
        }
    }
    for (const Part &part : map ? map->parts : std::vector<Part>()) {
        const auto message = message_of<ale::map_t>(part.place);
        whole = message && parts.add(*message);
    }
    return whole ? std::make_shared<const std::string>(map_message(parts.whole(), pieces)) : nullptr;
}

/* The newest of a topic then; nullptr: none was, or it makes no sense. */
History::Text OpenRecording::text_at(Topic topic, int64_t at_ms) const
{
    if (topic == Topic::map) {
        return map_text(at_ms);
    }
    if (topic == Topic::odometry) {
        const Driven *driven = newest(driven_, at_ms);
        return driven ? text_of(*driven) : nullptr;
    }
    const Place *place = newest(of(topic), at_ms);
    return place ? text_of(topic, *place) : nullptr;
}

Past OpenRecording::look_back(int64_t at_ms) const
{
    Past past;
    past.span = span();
    const int64_t end_ms = end_of_scan(at_ms);
    for (size_t k = 0; k < topic_count; k++) {
        const auto topic = static_cast<Topic>(k);
        if (History::Text text = topic == Topic::pose ? text_at(topic, at_ms) : text_at(topic, end_ms)) {
            past.texts.push_back(std::move(text));
        }
    }
    for (auto point =
             std::upper_bound(way_.begin(), way_.end(), at_ms - trail_ms,
                              [](int64_t time, const WayPoint &entry) { return time < entry.at_ms; });
         point != way_.end() && point->at_ms <= at_ms; ++point) {
        past.way.push_back(point->point);
    }
    return past;
}

namespace
{

/* At most so many of a list, in equal steps. */
template <class Entry, class Words>
std::vector<History::Text> sample_of(const std::vector<Entry> &entries, size_t most, const Words &words)
{
    const size_t count = std::min(most, entries.size());
    std::vector<History::Text> texts;
    for (size_t k = 0; k < count; k++) {
        if (History::Text text = words(entries[k * entries.size() / count])) {
            texts.push_back(std::move(text));
        }
    }
    return texts;
}

} // namespace

std::vector<History::Text> OpenRecording::sample(Topic topic, size_t most) const
{
    if (topic == Topic::odometry) {
        return sample_of(driven_, most, [](const Driven &driven) { return text_of(driven); });
    }
    return sample_of(of(topic), most, [&](const Place &place) { return brief_of(topic, place); });
}

} // namespace console
