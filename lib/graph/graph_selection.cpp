#include "graph/graph_selection.h"

#include <algorithm>
#include <iterator>
#include <tuple>

namespace ale
{

namespace
{

constexpr size_t most_loop_ends = ALE_GRAPH_KEYFRAMES / 2; // where keyframes do not all fit

ale_loop_kind_t kind_of(const GraphEdge &edge)
{
    return edge.joins ? ALE_LOOP_JOINS : edge.recognised ? ALE_LOOP_RECOGNISED : ALE_LOOP_CLOSED;
}

std::vector<GraphEdge> loops_by_rank(const std::vector<GraphEdge> &edges)
{
    std::vector<GraphEdge> loops;
    std::copy_if(edges.begin(), edges.end(), std::back_inserter(loops),
                 [](const GraphEdge &edge) { return edge.robust; });
    const auto rank = [](const GraphEdge &edge) { return std::tuple(kind_of(edge), edge.to, edge.from); };
    std::sort(loops.begin(), loops.end(),
              [&rank](const GraphEdge &a, const GraphEdge &b) { return rank(a) > rank(b); });
    return loops;
}

// By node: how the robot moved ties it to the one before.
std::vector<bool> ties(size_t nodes, const std::vector<GraphEdge> &edges)
{
    std::vector<bool> tied(nodes, false);
    for (const GraphEdge &edge : edges) {
        if (!edge.robust && edge.guess == ale::Guess::none) {
            tied[static_cast<size_t>(edge.to)] = true;
        }
    }
    return tied;
}

// Which nodes are told.
class Selection
{
  public:
    explicit Selection(size_t nodes) : kept_(nodes, nodes <= ALE_GRAPH_KEYFRAMES)
    {
        if (!kept_.empty()) {
            kept_.front() = kept_.back() = true;
        }
    }

    // Both ends of the loop; false: there is no room for them.
    bool keep_ends(const GraphEdge &loop)
    {
        const auto from = static_cast<size_t>(loop.from);
        const auto to = static_cast<size_t>(loop.to);
        const size_t more = (kept_[from] ? 0U : 1U) + (kept_[to] ? 0U : 1U);
        if (ends_ + more > most_loop_ends) {
            return false;
        }
        ends_ += more;
        kept_[from] = kept_[to] = true;
        return true;
    }

    // Of those that are not kept yet as many as there is room for, in equal steps of their number.
    void fill()
    {
        const auto kept = static_cast<size_t>(std::count(kept_.begin(), kept_.end(), true));
        const size_t others = kept_.size() - kept;
        const size_t room = std::min(others, ALE_GRAPH_KEYFRAMES - kept);
        size_t number = 0;
        for (size_t k = 0; k < kept_.size(); k++) {
            if (!kept_[k]) {
                kept_[k] = (number + 1) * room / others > number * room / others;
                number++;
            }
        }
    }

    bool operator[](size_t node) const
    {
        return kept_[node];
    }

  private:
    std::vector<bool> kept_;
    size_t ends_ = 0; // of loops, kept for them alone
};

// By node: its index in the list, if it is told.
std::vector<uint16_t> list_keyframes(const std::vector<Node> &nodes, const std::vector<Pose> &poses,
                                     const std::vector<bool> &tied, const Selection &selection,
                                     ale_mapper_graph_t *out)
{
    std::vector<uint16_t> index(nodes.size());
    bool is_tied = true; // so far, since the last one in the list
    out->keyframes = 0;
    for (size_t k = 0; k < nodes.size(); k++) {
        is_tied = is_tied && tied[k];
        if (selection[k]) {
            index[k] = static_cast<uint16_t>(out->keyframes);
            out->keyframe[out->keyframes++] = {nodes[k].scan, nodes[k].map_id, to_core(poses[k]), is_tied};
            is_tied = true;
        }
    }
    out->keyframes_left_out = static_cast<uint32_t>(nodes.size()) - out->keyframes;
    return index;
}

} // namespace

void select_graph(const std::vector<Node> &nodes, const std::vector<Pose> &poses,
                  const std::vector<GraphEdge> &edges, ale_mapper_graph_t *out)
{
    const std::vector<GraphEdge> loops = loops_by_rank(edges);
    Selection selection(nodes.size());
    std::vector<const GraphEdge *> told;
    for (const GraphEdge &loop : loops) {
        if (told.size() < ALE_GRAPH_LOOPS && selection.keep_ends(loop)) {
            told.push_back(&loop);
        }
    }
    selection.fill();
    const std::vector<uint16_t> index =
        list_keyframes(nodes, poses, ties(nodes.size(), edges), selection, out);
    out->loops = 0;
    for (const GraphEdge *loop : told) {
        out->loop[out->loops++] = {index[static_cast<size_t>(loop->from)],
                                   index[static_cast<size_t>(loop->to)],
                                   static_cast<uint8_t>(kind_of(*loop))};
    }
    out->loops_left_out = static_cast<uint32_t>(loops.size() - told.size());
}

} // namespace ale
