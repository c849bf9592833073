#include "graph/loops/map_table.h"

#include <algorithm>
#include <map>

namespace ale
{

uint32_t MapTable::now(uint32_t map_id) const
{
    for (size_t k = 0; k < std::min(count_, most_joins); k++) {
        if (joined_[k].map_id == map_id) {
            return joined_[k].part_of;
        }
    }
    return map_id;
}

void MapTable::join(uint32_t map_id, uint32_t into_map_id)
{
    for (Joined &joined : joined_) {
        joined.part_of = joined.part_of == map_id ? into_map_id : joined.part_of;
    }
    joined_[count_ % most_joins] = {map_id, into_map_id};
    count_++;
}

size_t count_maps(const std::vector<Node> &nodes)
{
    size_t count = 0;
    for (auto node = nodes.begin(); node != nodes.end(); ++node) {
        const auto same_map = [&node](const Node &other) { return other.map_id == node->map_id; };
        const bool goes_on = node != nodes.begin() && same_map(*(node - 1));
        count += goes_on || std::any_of(nodes.begin(), node, same_map) ? 0 : 1;
    }
    return count;
}

uint32_t largest_map(const std::vector<Node> &nodes)
{
    std::map<uint32_t, size_t> counts;
    for (const Node &node : nodes) {
        counts[node.map_id]++;
    }
    return std::max_element(counts.begin(), counts.end(),
                            [](const auto &a, const auto &b) { return a.second < b.second; })
        ->first;
}

} // namespace ale
