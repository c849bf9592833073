#include "operator/console/recordings/recording_summary.h"

#include <exception>
#include <limits>

#include "common/feed/checks.h"
#include "common/feed/core_types.h"
#include "common/feed/map_parts.h"
#include "common/feed/map_pieces.h"
#include "operator/console/recordings/event_file.h"

namespace console
{

namespace
{

constexpr uint64_t tail_bytes = uint64_t{16} << 20;

/* Throws for what makes no sense. */
template <class Message> Message message_of(const Descriptor &file, const EventPlace &event)
{
    const std::vector<uint8_t> bytes = data_of(file, event);
    Message message;
    feed::require(message.decode(bytes.data(), 0, static_cast<int>(bytes.size())) >= 0, "of another type");
    feed::check(message);
    return message;
}

/* The last map whose parts are all there. */
class LastMap
{
  public:
    void take(const Descriptor &file, const EventPlace &event)
    {
        try {
            if (event.channel == "ALE_MAP") {
                found_ = parts_.add(message_of<ale::map_t>(file, event)) || found_;
            } else if (event.channel == "ALE_MAP_PIECES") {
                pieces_.add(message_of<ale::map_pieces_t>(file, event));
            }
        } catch (const std::exception &) {
            /* what makes no sense is no part of a map */
        }
    }

    std::shared_ptr<const ale_map_t> map() const
    {
        return found_ ? feed::core_map(parts_.whole(), pieces_) : nullptr;
    }

  private:
    feed::MapParts parts_;
    feed::MapPieces pieces_;
    bool found_ = false;
};

} // namespace

RecordingSummary summary_of(const Descriptor &file)
{
    RecordingSummary summary;
    EventPlace event;
    EventReader first(file);
    if (!first.next(event)) {
        return summary;
    }
    summary.from_us = summary.to_us = event.received_us;
    EventReader last(file, first.size() > tail_bytes ? first.size() - tail_bytes : 0);
    LastMap map;
    while (last.next(event)) {
        summary.to_us = event.received_us > summary.to_us ? event.received_us : summary.to_us;
        summary.has_scans = summary.has_scans || event.channel == "ALE_SCAN";
        map.take(file, event);
    }
    summary.map = map.map();
    return summary;
}

} // namespace console
