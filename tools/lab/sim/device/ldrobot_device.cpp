#include "lab/sim/device/ldrobot_device.h"

#include <cmath>

namespace sim
{

namespace
{

constexpr unsigned header = 0x54;
constexpr unsigned version_and_points = 0x2c;
constexpr unsigned polynomial = 0x4d;
constexpr int64_t stamp_end_ms = 30000;
constexpr int32_t bright = 200; /* intensity of what came back */

uint8_t sum_of(const std::string &bytes)
{
    unsigned sum = 0;
    for (const char c : bytes) {
        sum ^= static_cast<uint8_t>(c);
        for (int bit = 0; bit < 8; bit++) {
            sum = (sum & 0x80U) != 0 ? ((sum << 1U) ^ polynomial) & 0xffU : (sum << 1U) & 0xffU;
        }
    }
    return static_cast<uint8_t>(sum);
}

void put(std::string &bytes, int64_t value, int count)
{
    for (int k = 0; k < count; k++) {
        bytes += static_cast<char>(static_cast<uint64_t>(value) >> (8 * k));
    }
}

/* Hundredths of a degree, as the device counts them. */
int64_t hundredths(double degrees)
{
    return std::llround(degrees * 100) % 36000;
}

} // namespace

void LdrobotDevice::power_up(int64_t now_us)
{
    clock_origin_us_ = now_us;
    stalled_until_us_ = now_us;
}

std::vector<Reply> LdrobotDevice::sweep(const Sweep &sweep, int64_t device_start_us)
{
    const auto device_end_us = device_start_us + std::llround(sweep.end_us - sweep.start_us);
    const bool stalled = device_start_us < stalled_until_us_;
    stalled_at_ = stalled ? stalled_at_ : sweep.echoes.back().clockwise;
    std::string bytes;
    put(bytes, header, 1);
    put(bytes, version_and_points, 1);
    put(bytes, stalled ? 0 : std::llround(sweep.degrees_a_second), 2);
    put(bytes, hundredths(stalled ? stalled_at_ : sweep.echoes.front().clockwise), 2);
    for (const Echo &echo : sweep.echoes) {
        put(bytes, echo.mm, 2);
        put(bytes, echo.mm > 0 ? bright : 0, 1);
    }
    put(bytes, hundredths(stalled ? stalled_at_ : sweep.echoes.back().clockwise), 2);
    put(bytes, (device_end_us - clock_origin_us_) / 1000 % stamp_end_ms, 2);
    put(bytes, sum_of(bytes), 1);
    Reply reply = {bytes, std::nullopt, true};
    if (sweep.begins_turn && !stalled) {
        reply.turn_start_us = std::llround(sweep.start_us);
    }
    return {reply};
}

} // namespace sim
