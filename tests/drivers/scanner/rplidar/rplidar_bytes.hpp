// What an RPLIDAR sends, after SLAMTEC's rplidar_sdk; written apart from the driver and the simulator.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace ale_test
{

inline std::string little(uint64_t value, int count)
{
    std::string out;
    for (int k = 0; k < count; k++) {
        out += static_cast<char>(value >> (8 * k));
    }
    return out;
}

inline std::string descriptor(unsigned length, unsigned type, bool repeated)
{
    return "\xa5\x5a" + little(length | (repeated ? 0x40000000U : 0U), 4) + little(type, 1);
}

inline std::string answer(unsigned type, const std::string &payload)
{
    return descriptor(static_cast<unsigned>(payload.size()), type, false) + payload;
}

inline uint64_t q6(double degrees)
{
    return static_cast<uint64_t>(std::llround(std::fmod(degrees, 360) * 64)) % 23040;
}

inline std::string node(double degrees, double mm, bool start)
{
    return little((start ? 1U : 2U) | 20U << 2U, 1) + little(q6(degrees) << 1U | 1U, 2) +
           little(static_cast<uint64_t>(std::llround(mm * 4)), 2);
}

inline std::string capsule_of(double degrees, bool first, const std::string &rest)
{
    const std::string body = little(q6(degrees) | (first ? 0x8000U : 0U), 2) + rest;
    unsigned sum = 0;
    for (const char c : body) {
        sum ^= static_cast<uint8_t>(c);
    }
    return little(0xa0U | (sum & 15U), 1) + little(0x50U | sum >> 4U, 1) + body;
}

// 32 points; each lies `less` eighths of a degree before its even place.
inline std::string express_capsule(double degrees, bool first, const std::vector<unsigned> &mm, unsigned less)
{
    std::string cabins;
    for (size_t k = 0; k < 32; k += 2) {
        cabins += little(mm[k] << 2U | less >> 4U, 2) + little(mm[k + 1] << 2U | less >> 4U, 2) +
                  little((less & 15U) | (less & 15U) << 4U, 1);
    }
    return capsule_of(degrees, first, cabins);
}

inline std::string dense_capsule(double degrees, bool first, const std::vector<unsigned> &mm)
{
    std::string distances;
    for (size_t k = 0; k < 40; k++) {
        distances += little(mm[k], 2);
    }
    return capsule_of(degrees, first, distances);
}

} // namespace ale_test
