#include "operator/console/recordings/recording_summary.h"

#include "common/feed/core_types.h"
#include "common/feed/map_parts.h"
#include "common/feed/map_pieces.h"
#include "operator/console/recordings/event_file.h"
#include "operator/console/recordings/recorded_message.h"

namespace console
{

namespace
{

constexpr uint64_t tail_bytes = uint64_t{16} << 20;

/* The last map whose parts are all there. */
class LastMap
{
  public:
    void take(const Descriptor &file, const EventPlace &event)
    {
        if (event.channel == "ALE_MAP") {
            const auto part = recorded_message<ale::map_t>(data_of(file, event));
            found_ = (part && parts_.add(*part)) || found_;
        } else if (event.channel == "ALE_MAP_PIECES") {
            if (const auto part = recorded_message<ale::map_pieces_t>(data_of(file, event))) {
                pieces_.add(*part);
            }
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
