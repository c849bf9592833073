#include "operator/grid/event_stream.h"

#include <array>
#include <stdexcept>

extern "C" {
#include "lcm/event.h"
}

namespace grid
{

bool EventStream::read(void *into, size_t count)
{
    return std::fread(into, 1, count, file_) == count;
}

bool EventStream::next(Event &event)
{
    constexpr uint32_t largest_message = 1U << 24;
    std::array<uint8_t, ALE_LCM_EVENT_HEAD> head{};
    if (!read(head.data(), head.size())) {
        return false;
    }
    ale_lcm_event_t read_head;
    if (!ale_lcm_event_read(head.data(), &read_head) || read_head.data_bytes > largest_message) {
        throw std::runtime_error("standard input: no event of LCM");
    }
    event.channel.resize(read_head.channel_bytes);
    event.data.resize(read_head.data_bytes);
    return read(event.channel.data(), event.channel.size()) && read(event.data.data(), event.data.size());
}

} // namespace grid
