/* A recording that is looked at: what was to be seen at any time of it, as the board shows what is now.
 *
 *   const OpenRecording recording(shelf.open(name));
 *   const Past past = recording.look_back(at_ms);
 *
 * Where each message lies is kept, and the robot's way; the messages themselves stay in the file. Anybody may
 * have written it: what makes no sense is left out. Const functions may be called from any thread. */
#ifndef CONSOLE_OPEN_RECORDING_H
#define CONSOLE_OPEN_RECORDING_H

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ale/pose_t.hpp"
#include "common/feed/parts.h"
#include "operator/console/board.h"
#include "operator/console/recordings/event_file.h"
#include "operator/console/wheel_watch.h"

namespace console
{

class OpenRecording
{
  public:
    /* Nine hours of a robot that scans ten times a second. */
    static constexpr size_t most_messages = 2000000;

    /* Reads the file through. Throws std::runtime_error in words for people: the system's, no message of a
     * robot in it, too many. later_ms: added to its times, where its clock knows no date. damage: of what it
     * was made of, in words. */
    explicit OpenRecording(Descriptor file, int64_t later_ms = 0, std::string damage = "");

    const Descriptor &file() const
    {
        return file_;
    }

    History::Span span() const;

    /* What was left out, in words; empty: nothing. */
    const std::string &damage() const
    {
        return damage_;
    }

    /* As Board::look_back and Board::sample. */
    Past look_back(int64_t at_ms) const;
    std::vector<History::Text> sample(Topic topic, size_t most) const;

  private:
    struct Place {
        int64_t at_ms;
        uint64_t data_at;
        uint32_t data_bytes;
    };
    /* A message in parts, as feed::Parts wants it. */
    struct Part {
        int32_t version;
        int16_t part;
        int16_t parts;
        Place place;
    };
    struct Map {
        int64_t at_ms;
        std::vector<Part> parts;
        std::vector<Part> pieces;
    };
    struct Driven {
        int64_t at_ms;
        WheelWay way;
    };
    struct WayPoint {
        int64_t at_ms;
        TrailPoint point;
    };

    void take(const EventPlace &event, int64_t at_ms);
    void take_pose(const Place &place);
    void take_map(const Place &place);
    void take_pieces(const Place &place);
    void take_odometry(const Place &place);
    void take_wheels(int64_t at_ms);
    const std::vector<Place> &of(Topic topic) const
    {
        return places_[static_cast<size_t>(topic)];
    }
    int64_t end_of_scan(int64_t at_ms) const;
    History::Text text_of(Topic topic, const Place &place) const;
    History::Text brief_of(Topic topic, const Place &place) const;
    static History::Text text_of(const Driven &driven);
    History::Text text_at(Topic topic, int64_t at_ms) const;
    History::Text map_text(int64_t at_ms) const;
    void note_damage(const Damage &damage);
    template <class Message> std::optional<Message> message_of(const Place &place) const;
    template <class Message> std::optional<Message> taken(const Place &place);
    template <class Message>
    std::string json_of(const Place &place, std::string (*words)(const Message &)) const;

    Descriptor file_;
    std::string damage_;
    uint64_t senseless_ = 0; /* messages that the way, the map or the wheels would have been of */
    int64_t from_ms_ = 0;
    int64_t to_ms_ = 0;
    std::array<std::vector<Place>, topic_count> places_;
    std::vector<Map> maps_;
    std::vector<WayPoint> way_;
    feed::Parts<Part> map_parts_;
    feed::Parts<Part> piece_parts_;
    std::vector<Part> pieces_; /* the newest that are whole */
    std::optional<ale::pose_t> last_pose_;
    WheelWatch wheels_;
    std::vector<Driven> driven_;
};

} // namespace console

#endif
