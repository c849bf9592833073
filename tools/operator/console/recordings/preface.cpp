#include "operator/console/recordings/preface.h"

#include <utility>

#include "operator/console/recordings/recorded_message.h"

namespace console
{

namespace
{

constexpr int most_parts = 256; /* of the largest map there are some hundred */

} // namespace

template <class Map> void Preface::keep(Kept &kept, std::vector<uint8_t> bytes)
{
    const auto part = recorded_message<Map>(bytes);
    if (part && part->parts <= most_parts &&
        kept.coming.add({part->version, part->part, part->parts, std::move(bytes)})) {
        kept.whole = kept.coming.take();
    }
}

void Preface::take(const std::string &channel, const uint8_t *bytes, size_t count)
{
    if (channel == "ALE_MAP") {
        keep<ale::map_t>(map_, {bytes, bytes + count});
    } else if (channel == "ALE_MAP_PIECES") {
        keep<ale::map_pieces_t>(pieces_, {bytes, bytes + count});
    }
}

std::vector<Preface::Message> Preface::messages() const
{
    std::vector<Message> messages;
    for (const Part &part : pieces_.whole) {
        messages.push_back({"ALE_MAP_PIECES", part.bytes});
    }
    for (const Part &part : map_.whole) {
        messages.push_back({"ALE_MAP", part.bytes});
    }
    return messages;
}

} // namespace console
