#include "operator/console/recordings/event_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <stdexcept>

#include <sys/stat.h>

extern "C" {
#include "lcm/event.h"
}

namespace console
{

namespace
{

constexpr size_t longest_channel = 255; /* LCM's own limit is 63 */
constexpr uint32_t largest_message = 1U << 24;
constexpr size_t window_bytes = size_t{1} << 17;

/* So many bytes from there, or as many as there are. */
size_t read_at(int file, uint64_t at, uint8_t *into, size_t count)
{
    size_t have = 0;
    while (have < count) {
        const ssize_t got = pread(file, into + have, count - have, static_cast<off_t>(at + have));
        if (got <= 0) {
            break;
        }
        have += static_cast<size_t>(got);
    }
    return have;
}

std::string bytes_in_words(uint64_t bytes)
{
    constexpr double kilo = 1000;
    char words[32];
    if (static_cast<double>(bytes) < kilo) {
        std::snprintf(words, sizeof words, "%llu bytes", static_cast<unsigned long long>(bytes));
    } else if (static_cast<double>(bytes) < kilo * kilo) {
        std::snprintf(words, sizeof words, "%.1f kB", static_cast<double>(bytes) / kilo);
    } else {
        std::snprintf(words, sizeof words, "%.1f MB", static_cast<double>(bytes) / kilo / kilo);
    }
    return words;
}

} // namespace

std::string damage_words(const Damage &damage)
{
    if (damage.places == 0) {
        return "";
    }
    const std::string places =
        std::to_string(damage.places) + (damage.places == 1 ? " damaged place" : " damaged places");
    return places + (damage.bytes > 0 ? ", " + bytes_in_words(damage.bytes) + "," : "") + " left out";
}

void EventWriter::put(int64_t received_us, const std::string &channel, const uint8_t *bytes, size_t count)
{
    std::array<uint8_t, ALE_LCM_EVENT_HEAD> head{};
    const ale_lcm_event_t event = {number_++, received_us, static_cast<uint32_t>(channel.size()),
                                   static_cast<uint32_t>(count)};
    ale_lcm_event_write(&event, head.data());
    waiting_.insert(waiting_.end(), head.begin(), head.end());
    waiting_.insert(waiting_.end(), channel.begin(), channel.end());
    waiting_.insert(waiting_.end(), bytes, bytes + count);
    ends_.push_back(waiting_.size());
}

size_t EventWriter::with(const std::string &channel, size_t count) const
{
    return waiting_.size() + ALE_LCM_EVENT_HEAD + channel.size() + count;
}

int EventWriter::flush()
{
    size_t written = 0;
    int error = 0;
    while (written < waiting_.size() && error == 0) {
        const ssize_t done = write(file_.number(), waiting_.data() + written, waiting_.size() - written);
        if (done >= 0) {
            written += static_cast<size_t>(done);
        } else if (errno != EINTR) {
            error = errno;
        }
    }
    keep_whole(written);
    return error;
}

/* Of what was written, the events that are whole. */
void EventWriter::keep_whole(size_t written)
{
    const auto cut = std::upper_bound(ends_.begin(), ends_.end(), written);
    const size_t whole = cut == ends_.begin() ? 0 : *(cut - 1);
    events_ += static_cast<uint64_t>(cut - ends_.begin());
    bytes_ += whole;
    if (whole < written && ftruncate(file_.number(), static_cast<off_t>(bytes_)) != 0) {
        bytes_ += written - whole; /* who reads it finds an event that is cut, and leaves it out */
    }
    waiting_.clear();
    ends_.clear();
}

EventReader::EventReader(const Descriptor &file, uint64_t from) : file_(file.number()), at_(from)
{
    struct stat status;
    if (fstat(file_, &status) != 0) {
        throw std::runtime_error(std::strerror(errno));
    }
    size_ = static_cast<uint64_t>(status.st_size);
}

/* Bytes of the file; nullptr where it ends before. Valid until the next look. */
const uint8_t *EventReader::look(uint64_t at, size_t count)
{
    if (at < window_at_ || at + count > window_at_ + window_.size()) {
        window_.resize(window_bytes);
        window_.resize(read_at(file_, at, window_.data(), window_.size()));
        window_at_ = at;
    }
    return count <= window_.size() - static_cast<size_t>(at - window_at_) ? window_.data() + (at - window_at_)
                                                                          : nullptr;
}

/* The event that begins where we are. */
bool EventReader::take(EventPlace &event)
{
    const uint8_t *bytes = look(at_, ALE_LCM_EVENT_HEAD);
    ale_lcm_event_t head;
    if (bytes == nullptr || !ale_lcm_event_read(bytes, &head)) {
        return false;
    }
    event.received_us = head.received_us;
    event.data_bytes = head.data_bytes;
    event.data_at = at_ + ALE_LCM_EVENT_HEAD + head.channel_bytes;
    if (head.channel_bytes > longest_channel || event.data_bytes > largest_message ||
        event.data_at + event.data_bytes > size_) {
        return false;
    }
    const uint8_t *channel = look(at_ + ALE_LCM_EVENT_HEAD, head.channel_bytes);
    if (channel == nullptr) {
        return false;
    }
    event.channel.assign(channel, channel + head.channel_bytes);
    at_ = event.data_at + event.data_bytes;
    return true;
}

/* From there on; the end of the file when there is none. */
uint64_t EventReader::next_sync(uint64_t at)
{
    while (at + ALE_LCM_EVENT_HEAD <= size_ && look(at, ALE_LCM_EVENT_HEAD) != nullptr) {
        const auto begin = window_.begin() + static_cast<std::ptrdiff_t>(at - window_at_);
        const auto found =
            std::search(begin, window_.end(), std::begin(ale_lcm_event_sync), std::end(ale_lcm_event_sync));
        if (found != window_.end()) {
            return at + static_cast<uint64_t>(found - begin);
        }
        at = window_at_ + window_.size() - (ALE_LCM_EVENT_SYNC - 1);
    }
    return size_;
}

/* A sync word in it that begins no event makes no other place of it. */
void EventReader::skip_damage()
{
    const uint64_t from = at_;
    at_ = next_sync(at_ + 1);
    damage_.places += from != damage_end_;
    damage_.bytes += at_ - from;
    damage_end_ = at_;
}

bool EventReader::next(EventPlace &event)
{
    while (at_ < size_) {
        if (take(event)) {
            return true;
        }
        skip_damage();
    }
    return false;
}

std::vector<uint8_t> data_of(const Descriptor &file, const EventPlace &event)
{
    std::vector<uint8_t> bytes(event.data_bytes);
    bytes.resize(read_at(file.number(), event.data_at, bytes.data(), bytes.size()));
    return bytes;
}

} // namespace console
