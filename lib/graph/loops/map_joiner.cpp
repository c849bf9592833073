#include "graph/loops/map_joiner.h"

#include <algorithm>

namespace ale
{

namespace
{

constexpr int most_rounds = 4; // after the drive: each finds what the one before has brought together

} // namespace

void MapJoiner::drive(const std::vector<Node> &nodes, const std::vector<Pose> &poses)
{
    if (!driving_) {
        restart();
        driving_ = true;
    }
    if (found_ || count_maps(nodes) < 2) {
        return;
    }
    const uint32_t present = nodes.back().map_id;
    unknown_.erase(std::remove(unknown_.begin(), unknown_.end(), present), unknown_.end());
    if (!search_ || present_ != present) {
        search_.emplace(tasks_while_driving(nodes, poses, unknown_));
        present_ = present;
    }
    for (int k = 0; k < places_a_node; k++) {
        if (!search_->step(nodes, poses)) {
            found_ = search_->decide(nodes, poses);
            search_.reset();
            return;
        }
    }
}

bool MapJoiner::refine(const std::vector<Node> &nodes, const std::vector<Pose> &poses, MapKind kind)
{
    if (driving_) {
        restart();
        found_.reset();
        driving_ = false;
    }
    if (rounds_ == most_rounds || count_maps(nodes) < 2) {
        return false;
    }
    if (!search_) {
        search_.emplace(tasks_after_drive(nodes, poses));
        joined_ = false;
    }
    if (search_->step(nodes, poses)) {
        return true;
    }
    found_ = search_->decide(nodes, poses, kind);
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
    }
}

void MapJoiner::reset()
{
    restart();
    found_.reset();
    unknown_.clear();
}

} // namespace ale
