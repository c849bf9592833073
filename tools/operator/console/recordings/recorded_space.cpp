#include "operator/console/recordings/recorded_space.h"

#include "common/feed/seen_space.h"
#include "operator/console/recordings/event_file.h"
#include "operator/console/recordings/recorded_message.h"

namespace console
{

namespace
{

template <class Message> void take(feed::SeenSpace &space, const Descriptor &file, const EventPlace &event)
{
    if (const auto message = recorded_message<Message>(data_of(file, event))) {
        space.take(*message);
    }
}

} // namespace

ale::ScanCloud seen_in(const Descriptor &file)
{
    feed::SeenSpace space;
    EventReader reader(file);
    EventPlace event;
    while (reader.next(event)) {
        if (event.channel == "ALE_POSE") {
            take<ale::pose_t>(space, file, event);
        } else if (event.channel == "ALE_TRACKING") {
            take<ale::tracking_t>(space, file, event);
        } else if (event.channel == "ALE_GRAPH") {
            take<ale::graph_t>(space, file, event);
        } else if (event.channel == "ALE_SCAN") {
            take<ale::scan_t>(space, file, event);
        }
    }
    return space.cloud();
}

} // namespace console
