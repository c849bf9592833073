#include "graph/loops/map_joiner.h"

#include <algorithm>

namespace ale
{

namespace
{

constexpr int most_rounds = 4; // after the drive: each finds what the one before has brought together

bool is_one_map(const SearchedMaps &maps)
{
    return count_maps(maps.nodes) < 2 && maps.first() == 0;
}

} // namespace

void MapJoiner::drive(const SearchedMaps &maps)
{
    if (!driving_) {
        restart();
        driving_ = true;
    }
    if (found_ || is_one_map(maps)) {
        return;
    }
    const uint32_t present = maps.nodes.back().map_id;
    unknown_.erase(std::remove(unknown_.begin(), unknown_.end(), present), unknown_.end());
    if (!search_ || present_ != present) {
        search_.emplace(tasks_while_driving(maps, unknown_));
        present_ = present;
    }
    for (int k = 0; k < places_a_node; k++) {
        if (!search_->step(maps)) {
            found_ = search_->decide(maps, MapKind::growing);
            search_.reset();
            return;
        }
    }
}

bool MapJoiner::refine(const SearchedMaps &maps, MapKind kind)
{
    if (driving_) {
        restart();
        found_.reset();
        driving_ = false;
    }
    if (rounds_ == most_rounds || is_one_map(maps)) {
        return false;
    }
    if (!search_) {
        search_.emplace(tasks_after_drive(maps, kind));
        joined_ = false;
    }
    if (search_->step(maps)) {
        return true;
    }
    found_ = search_->decide(maps, kind);
    joined_ = joined_ || found_;
    if (!found_) {
        search_.reset();
        rounds_ = joined_ ? rounds_ + 1 : most_rounds;
    }
    return true;
}

void MapJoiner::lose_track(const std::vector<Node> &nodes, uint32_t present)
{
    unknown_.clear();
    for (const Node &node : nodes) {
        const bool is_known = node.map_id == present || node.map_id == ALE_FIRST_MAP;
        if (!is_known && std::find(unknown_.begin(), unknown_.end(), node.map_id) == unknown_.end()) {
            unknown_.push_back(node.map_id);
        }
    }
    restart();
}

void MapJoiner::restart()
{
    search_.reset();
    rounds_ = 0;
}

void MapJoiner::remove_node(int k)
{
    if (search_) {
        search_->remove_node(k);
    }
    if (found_) {
        const auto refers = [k](const Loop &loop) { return loop.from == k || loop.to == k; };
        std::vector<Loop> &loops = found_->loops;
        loops.erase(std::remove_if(loops.begin(), loops.end(), refers), loops.end());
        for (Loop &loop : loops) {
            loop.from -= loop.from > k ? 1 : 0;
            loop.to -= loop.to > k ? 1 : 0;
        }
        const auto is_of_it = [k](const PosePrior &prior) { return prior.pose == k; };
        std::vector<PosePrior> &priors = found_->on_prior;
        priors.erase(std::remove_if(priors.begin(), priors.end(), is_of_it), priors.end());
        for (PosePrior &prior : priors) {
            prior.pose -= prior.pose > k ? 1 : 0;
        }
    }
}

void MapJoiner::reset()
{
    restart();
    found_.reset();
    unknown_.clear();
}

} // namespace ale
