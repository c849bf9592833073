/* A message that travels in parts. Parts of one version belong together; it is whole only when all are there.
 */
#ifndef ALE_COMMON_FEED_PARTS_H
#define ALE_COMMON_FEED_PARTS_H

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace feed
{

/* Message: with version, part and parts. */
template <class Message> class Parts
{
  public:
    /* True when this part was the last that was missing: take() has all of them. */
    bool add(const Message &part)
    {
        if (part.parts <= 0 || part.part < 0 || part.part >= part.parts) {
            return false;
        }
        if (parts_.size() != static_cast<size_t>(part.parts) || version_ != part.version) {
            parts_.assign(static_cast<size_t>(part.parts), std::nullopt);
            version_ = part.version;
        }
        parts_[static_cast<size_t>(part.part)] = part;
        return std::all_of(parts_.begin(), parts_.end(), [](const auto &known) { return known.has_value(); });
    }

    /* All parts in order; after add() has returned true. The next ones are collected from nothing. */
    std::vector<Message> take()
    {
        std::vector<Message> whole;
        for (auto &part : parts_) {
            whole.push_back(std::move(*part));
            part.reset();
        }
        return whole;
    }

  private:
    int32_t version_ = 0;
    std::vector<std::optional<Message>> parts_;
};

} // namespace feed

#endif
