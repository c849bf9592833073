/* Whatever comes over the line of a rotary scanner: any pieces give the same packets, all bytes are used, and
 * turns made of them keep the promises of a scan. */
#pragma once

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>

extern "C" {
#include "scanner/rotary/turns.h"
}

namespace fuzz
{

inline void require(bool holds)
{
    if (!holds) {
        std::abort();
    }
}

class RotaryReader
{
  public:
    RotaryReader()
    {
        ale_turns_init(turns_.get(), true, false);
        ale_turns_range(turns_.get(), 20000, 12000000);
        ale_turns_begin(turns_.get());
    }
    /* parse(bytes, count, packet): the bytes used. */
    template <class Parse> void read(const std::string &bytes, size_t piece, Parse parse)
    {
        for (size_t at = 0; at < bytes.size();) {
            const size_t count = std::min(piece, bytes.size() - at);
            ale_rotary_packet_t packet;
            const uint32_t used = parse(reinterpret_cast<const uint8_t *>(bytes.data()) + at,
                                        static_cast<uint32_t>(count), &packet);
            require(used > 0 && used <= count && (packet.kind != ALE_PACKET_NONE || used == count));
            at += used;
            take(packet);
        }
        require(garbage_ <= bytes.size());
    }
    uint64_t seen() const
    {
        return seen_;
    }

  private:
    std::unique_ptr<ale_turns_t> turns_ = std::make_unique<ale_turns_t>();
    std::unique_ptr<ale_scan_t> scan_ = std::make_unique<ale_scan_t>();
    uint64_t seen_ = 0;
    uint64_t garbage_ = 0;
    int64_t sensor_us_ = INT64_MIN;

    void take(const ale_rotary_packet_t &packet)
    {
        garbage_ += packet.garbage;
        if (packet.kind == ALE_PACKET_NONE) {
            return;
        }
        seen_ = seen_ * 31 + packet.kind;
        if (packet.kind != ALE_PACKET_POINTS) {
            return;
        }
        require(packet.count > 0 && packet.count <= ALE_PACKET_POINTS_MOST);
        sensor_us_ = packet.sensor_us;
        for (uint32_t k = 0; k < packet.count; k++) {
            require(packet.points[k].range_um >= 0);
            seen_ = (seen_ * 31 + packet.points[k].bearing_bam) * 31 +
                    static_cast<uint32_t>(packet.points[k].range_um);
        }
        ale_turns_take(turns_.get(), &packet, packet.sensor_us);
        for (int k = 0; ale_turns_next(turns_.get(), scan_.get()) != ALE_SCANNER_IDLE; k++) {
            require(k < 64 && scan_->beams <= ALE_MAX_BEAMS);
        }
    }
};

} // namespace fuzz
