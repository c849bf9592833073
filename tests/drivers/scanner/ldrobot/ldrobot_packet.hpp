// Packets of an LDROBOT as its manual describes them, written apart from the driver.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace ale_test
{

// A real one, from the LD06 development manual.
inline std::string packet_of_the_manual()
{
    const uint8_t bytes[] = {0x54, 0x2c, 0x68, 0x08, 0xab, 0x7e, 0xe0, 0x00, 0xe4, 0xdc, 0x00, 0xe2,
                             0xd9, 0x00, 0xe5, 0xd5, 0x00, 0xe3, 0xd3, 0x00, 0xe4, 0xd0, 0x00, 0xe9,
                             0xcd, 0x00, 0xe4, 0xca, 0x00, 0xe2, 0xc7, 0x00, 0xe9, 0xc5, 0x00, 0xe5,
                             0xc2, 0x00, 0xe5, 0xc0, 0x00, 0xe5, 0xbe, 0x82, 0x3a, 0x1a, 0x50};
    return {std::begin(bytes), std::end(bytes)};
}

inline void put_16(std::string &out, unsigned value)
{
    out += static_cast<char>(value & 0xffU);
    out += static_cast<char>(value >> 8U);
}

// CRC-8, polynomial 0x4D, most significant bit first: division of the message by the polynomial, bit by bit.
inline char crc_8_4d(const std::string &message)
{
    unsigned rest = 0;
    for (const char byte : message + std::string(1, '\0')) {
        for (int bit = 7; bit >= 0; bit--) {
            const bool out = (rest & 0x80U) != 0;
            rest = ((rest << 1U) | ((static_cast<unsigned char>(byte) >> bit) & 1U)) & 0xffU;
            rest ^= out ? 0x4dU : 0U;
        }
    }
    return static_cast<char>(rest);
}

struct LdrobotPacket {
    unsigned speed_deg_s = 3600;
    unsigned start = 0; // hundredths of a degree, clockwise
    unsigned end = 880;
    unsigned stamp_ms = 0;
    std::vector<unsigned> mm = std::vector<unsigned>(12, 1000);

    std::string bytes() const
    {
        std::string out = "\x54\x2c";
        put_16(out, speed_deg_s);
        put_16(out, start);
        for (const unsigned distance : mm) {
            put_16(out, distance);
            out += '\xc8';
        }
        put_16(out, end);
        put_16(out, stamp_ms);
        return out + crc_8_4d(out);
    }
};

} // namespace ale_test
