/* The line map, put together from the parts in which it travels.
 *
 * A map is shown only when all its parts are there: a part lost on the way leaves the former map standing
 * until the robot sends the whole again. */
#ifndef ALE_COMMON_FEED_MAP_PARTS_H
#define ALE_COMMON_FEED_MAP_PARTS_H

#include <cstddef>
#include <vector>

#include "ale/map_t.hpp"
#include "common/feed/parts.h"

namespace feed
{

class MapParts
{
  public:
    /* True when this part completed a map: whole() is new. */
    bool add(const ale::map_t &part)
    {
        if (!parts_.add(part)) {
            return false;
        }
        join(parts_.take());
        return true;
    }

    /* The newest complete map, as one part. Valid from the first add() that returned true. */
    const ale::map_t &whole() const
    {
        return whole_;
    }

  private:
    void join(const std::vector<ale::map_t> &parts)
    {
        whole_ = parts.front();
        for (size_t k = 1; k < parts.size(); k++) {
            whole_.lines.insert(whole_.lines.end(), parts[k].lines.begin(), parts[k].lines.end());
            whole_.corners.insert(whole_.corners.end(), parts[k].corners.begin(), parts[k].corners.end());
        }
        whole_.part = 0;
        whole_.parts = 1;
        whole_.num_lines = static_cast<int32_t>(whole_.lines.size());
        whole_.num_corners = static_cast<int32_t>(whole_.corners.size());
    }

    Parts<ale::map_t> parts_;
    ale::map_t whole_{};
};

} // namespace feed

#endif
