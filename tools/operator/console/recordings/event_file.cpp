#include "operator/console/recordings/event_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include <endian.h>
#include <sys/stat.h>

namespace console
{

namespace
{

constexpr std::array<uint8_t, 4> sync_word = {0xED, 0xA1, 0xDA, 0x01};
constexpr size_t header_bytes = 28;
constexpr size_t stamp_at = 12;
constexpr size_t channel_length_at = 20;
constexpr size_t data_length_at = 24;
constexpr size_t longest_channel = 255; /* LCM's own limit is 63 */
constexpr uint32_t largest_message = 1U << 24;
constexpr size_t window_bytes = size_t{1} << 17;

void put_be32(std::vector<uint8_t> &out, uint32_t value)
{
    for (int shift = 24; shift >= 0; shift -= 8) {
        out.push_back(static_cast<uint8_t>(value >> shift));
    }
}

void put_be64(std::vector<uint8_t> &out, uint64_t value)
{
    put_be32(out, static_cast<uint32_t>(value >> 32));
    put_be32(out, static_cast<uint32_t>(value));
}

uint32_t be32_at(const uint8_t *bytes)
{
    uint32_t value;
    std::memcpy(&value, bytes, sizeof value);
    return be32toh(value);
}

int64_t be64_at(const uint8_t *bytes)
{
    uint64_t value;
    std::memcpy(&value, bytes, sizeof value);
    return static_cast<int64_t>(be64toh(value));
}

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

} // namespace

void EventWriter::put(int64_t received_us, const std::string &channel, const uint8_t *bytes, size_t count)
{
    waiting_.insert(waiting_.end(), sync_word.begin(), sync_word.end());
    put_be64(waiting_, number_++);
    put_be64(waiting_, static_cast<uint64_t>(received_us));
    put_be32(waiting_, static_cast<uint32_t>(channel.size()));
    put_be32(waiting_, static_cast<uint32_t>(count));
    waiting_.insert(waiting_.end(), channel.begin(), channel.end());
    waiting_.insert(waiting_.end(), bytes, bytes + count);
    ends_.push_back(waiting_.size());
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
    const uint8_t *header = look(at_, header_bytes);
    if (header == nullptr || std::memcmp(header, sync_word.data(), sync_word.size()) != 0) {
        return false;
    }
    event.received_us = be64_at(header + stamp_at);
    const uint32_t channel_bytes = be32_at(header + channel_length_at);
    event.data_bytes = be32_at(header + data_length_at);
    event.data_at = at_ + header_bytes + channel_bytes;
    if (channel_bytes < 1 || channel_bytes > longest_channel || event.data_bytes > largest_message ||
        event.data_at + event.data_bytes > size_) {
        return false;
    }
    const uint8_t *channel = look(at_ + header_bytes, channel_bytes);
    if (channel == nullptr) {
        return false;
    }
    event.channel.assign(channel, channel + channel_bytes);
    at_ = event.data_at + event.data_bytes;
    return true;
}

/* To the next sync word, or the end. */
void EventReader::skip_damage()
{
    at_++;
    while (at_ + header_bytes <= size_) {
        if (look(at_, header_bytes) == nullptr) {
            break;
        }
        const auto begin = window_.begin() + static_cast<std::ptrdiff_t>(at_ - window_at_);
        const auto found = std::search(begin, window_.end(), sync_word.begin(), sync_word.end());
        if (found != window_.end()) {
            at_ += static_cast<uint64_t>(found - begin);
            return;
        }
        at_ = window_at_ + window_.size() - (sync_word.size() - 1);
    }
    at_ = size_;
}

bool EventReader::next(EventPlace &event)
{
    while (at_ + header_bytes <= size_) {
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
