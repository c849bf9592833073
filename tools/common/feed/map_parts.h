/* The line map, put together from the parts in which it travels.
 *
 * Parts of one version belong together. A map is shown only when all its parts are there: a part lost on
 * the way leaves the former map standing until the robot sends the whole again. */
#ifndef ALE_COMMON_FEED_MAP_PARTS_H
#define ALE_COMMON_FEED_MAP_PARTS_H

#include <cstddef>
#include <optional>
#include <vector>

#include "ale/map_t.hpp"

namespace feed
{

class MapParts
{
  public:
    /* True when this part completed a map: whole() is new. */
    bool add(const ale::map_t &part)
    {
        if (part.parts <= 0 || part.part < 0 || part.part >= part.parts) {
            return false;
        }
        if (parts_.size() != static_cast<size_t>(part.parts) || version_ != part.version) {
            parts_.assign(static_cast<size_t>(part.parts), std::nullopt);
            version_ = part.version;
        }
        parts_[static_cast<size_t>(part.part)] = part;
        for (const auto &known : parts_) {
            if (!known) {
                return false;
            }
        }
        join();
        return true;
    }

    /* The newest complete map, as one part. Valid from the first add() that returned true. */
    const ale::map_t &whole() const
    {
        return whole_;
    }

  private:
    void join()
    {
        whole_ = *parts_.front();
        for (size_t k = 1; k < parts_.size(); k++) {
            whole_.lines.insert(whole_.lines.end(), parts_[k]->lines.begin(), parts_[k]->lines.end());
            whole_.corners.insert(whole_.corners.end(), parts_[k]->corners.begin(), parts_[k]->corners.end());
        }
        whole_.part = 0;
        whole_.parts = 1;
        whole_.num_lines = static_cast<int32_t>(whole_.lines.size());
        whole_.num_corners = static_cast<int32_t>(whole_.corners.size());
        parts_.assign(parts_.size(), std::nullopt);
    }

    int32_t version_ = 0;
    std::vector<std::optional<ale::map_t>> parts_;
    ale::map_t whole_{};
};

} // namespace feed

#endif
