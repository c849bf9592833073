/* Which walls of a map are in maps that are not joined with the first: they travel apart from the map,
 * because its type has no room for it.
 *
 *   if (pieces.add(message)) ...                  (all of one version are there, and new)
 *   pieces.map_of(map.version, line.id)           0: in the first, or nothing is known of that version */
#ifndef ALE_COMMON_FEED_MAP_PIECES_H
#define ALE_COMMON_FEED_MAP_PIECES_H

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>

#include "ale/map_pieces_t.hpp"
#include "common/feed/parts.h"

namespace feed
{

class MapPieces
{
  public:
    /* True when this part completed what is known of a version, and that is something new. */
    bool add(const ale::map_pieces_t &part)
    {
        if (!parts_.add(part)) {
            return false;
        }
        std::map<int32_t, int32_t> map_of_line;
        for (const ale::map_pieces_t &piece : parts_.take()) {
            const size_t count = std::min(piece.line_id.size(), piece.map_id.size());
            for (size_t k = 0; k < count; k++) {
                map_of_line[piece.line_id[k]] = piece.map_id[k];
            }
        }
        const bool changed = version_ != part.version || map_of_line != map_of_line_;
        version_ = part.version;
        map_of_line_ = std::move(map_of_line);
        return changed;
    }

    int32_t map_of(int32_t version, int32_t line_id) const
    {
        const auto found = map_of_line_.find(line_id);
        return version == version_ && found != map_of_line_.end() ? found->second : 0;
    }

  private:
    Parts<ale::map_pieces_t> parts_;
    int32_t version_ = 0;
    std::map<int32_t, int32_t> map_of_line_;
};

} // namespace feed

#endif
