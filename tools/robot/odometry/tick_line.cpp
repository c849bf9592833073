#include "robot/odometry/tick_line.h"

#include <charconv>

extern "C" {
#include "motor/line_receiver.h"
}

namespace odometry
{

namespace
{

constexpr char head[] = "$TICKS,";

/* A number from at on, with or without a sign, and what ends it; moves at behind that. */
bool number(const char *&at, const char *end, char stop, uint32_t &value)
{
    int64_t found = 0;
    const auto [rest, error] = std::from_chars(at, end, found);
    if (error != std::errc() || rest == end || *rest != stop) {
        return false;
    }
    value = static_cast<uint32_t>(found);
    at = rest + 1;
    return true;
}

bool has_right_sum(const std::string &line, size_t star)
{
    uint32_t sum = 0;
    const char *end = line.data() + line.size();
    const auto [rest, error] = std::from_chars(line.data() + star + 1, end, sum, 16);
    return error == std::errc() && rest == end && line.size() - star == 5 &&
           sum == ale_motor_crc(line.data() + 1, star - 1);
}

} // namespace

std::optional<Ticks> ticks_of(const std::string &line)
{
    const size_t star = line.find('*');
    if (line.compare(0, sizeof head - 1, head) != 0 || star == std::string::npos ||
        !has_right_sum(line, star)) {
        return std::nullopt;
    }
    Ticks ticks = {};
    const char *at = line.data() + sizeof head - 1;
    const char *end = line.data() + line.size();
    if (number(at, end, ',', ticks.left) && number(at, end, ',', ticks.right) &&
        number(at, end, '*', ticks.micros)) {
        return ticks;
    }
    return std::nullopt;
}

std::optional<Ticks> TickLines::take(char byte)
{
    const bool ends = byte == '\r' || byte == '\n';
    if (!ends) {
        text_ += byte;
        if (text_.size() < longest) {
            return std::nullopt;
        }
    }
    const std::string line = std::move(text_);
    text_.clear();
    const std::optional<Ticks> ticks = ticks_of(line);
    taken_ += ticks.has_value();
    if (!ticks && !line.empty()) {
        refused_++;
        strange_ = line;
        for (char &c : strange_) {
            c = c < ' ' || c > '~' ? '?' : c;
        }
    }
    return ticks;
}

} // namespace odometry
