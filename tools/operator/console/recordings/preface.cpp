#include "operator/console/recordings/preface.h"

namespace console
{

namespace
{

/* Both types: fingerprint, utime, version, part, parts; big endian. */
constexpr size_t version_at = 16;
constexpr size_t part_at = 20;
constexpr size_t parts_at = 22;
constexpr size_t head_bytes = 24;
constexpr int most_parts = 256; /* of the largest map there are some hundred */

int32_t number_at(const uint8_t *bytes, size_t size)
{
    uint32_t value = 0;
    for (size_t k = 0; k < size; k++) {
        value = value << 8 | bytes[k];
    }
    return static_cast<int32_t>(value);
}

} // namespace

void Preface::take(const std::string &channel, const uint8_t *bytes, size_t count)
{
    const bool map = channel == "ALE_MAP";
    if ((!map && channel != "ALE_MAP_PIECES") || count < head_bytes ||
        number_at(bytes + parts_at, 2) > most_parts) {
        return;
    }
    Kept &kept = map ? map_ : pieces_;
    if (kept.coming.add({number_at(bytes + version_at, 4),
                         static_cast<int16_t>(number_at(bytes + part_at, 2)),
                         static_cast<int16_t>(number_at(bytes + parts_at, 2)),
                         {bytes, bytes + count}})) {
        kept.whole = kept.coming.take();
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
