#include "graph/loops/place_candidates.h"

#include <algorithm>
#include <cstdlib>

namespace ale
{

std::vector<int> nearest_of_each_visit(std::vector<PlaceCandidate> places, int same_visit_nodes, size_t most)
{
    std::stable_sort(places.begin(), places.end(), [](const PlaceCandidate &a, const PlaceCandidate &b) {
        return a.distance < b.distance;
    });
    std::vector<int> chosen;
    for (const PlaceCandidate &place : places) {
        const bool same_visit = std::any_of(chosen.begin(), chosen.end(), [&](int k) {
            return std::abs(k - place.node) <= same_visit_nodes;
        });
        if (!same_visit && chosen.size() < most) {
            chosen.push_back(place.node);
        }
    }
    return chosen;
}

} // namespace ale
