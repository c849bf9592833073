/* What a recording begins with: the map, which the robot sends seldom. Kept as it came, the newest that is
 * whole. Not thread-safe. */
#ifndef CONSOLE_PREFACE_H
#define CONSOLE_PREFACE_H

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "common/feed/parts.h"

namespace console
{

class Preface
{
  public:
    /* Of other channels than ALE_MAP and ALE_MAP_PIECES nothing is kept. */
    void take(const std::string &channel, const uint8_t *bytes, size_t count);

    struct Message {
        std::string channel;
        std::vector<uint8_t> bytes;
    };
    /* In the order in which the robot sends them. */
    std::vector<Message> messages() const;

  private:
    struct Part {
        int32_t version;
        int16_t part;
        int16_t parts;
        std::vector<uint8_t> bytes;
    };
    /* Of one channel: what is on its way, and the newest that is whole. */
    struct Kept {
        feed::Parts<Part> coming;
        std::vector<Part> whole;
    };

    template <class Map> void keep(Kept &kept, std::vector<uint8_t> bytes);

    Kept pieces_;
    Kept map_;
};

} // namespace console

#endif
