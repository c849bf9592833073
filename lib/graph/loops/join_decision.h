// Decides which map joins which, by matches of nodes of the one with places of the other.
//
// Matches that put a map to the same place of another are a hypothesis; of drives, which may be bent, from
// each node to the nearest that is matched. One is accepted if
// - at least three nodes, a metre apart, lie on what the other map saw, held in every direction; twelve, over
//   eight metres, if that is not where the prediction has put them, or nobody watched the robot on the way
//   from the one to the other; none elsewhere where wheels have told of that way. When all is known, four
//   over two metres where nobody watched, if the robot can have got there in the time, and not far, and six
//   over two and a half if it has no rival: a building whose places look alike shows some. Of a map that is a
//   drive of its own, and smaller, twelve over most of it, if nearly all of it lies there;
// - wherever the two overlap they agree: neither looks through what the other saw (a match that slides along
//   what does not hold it says nothing of that direction). One node in five may be denied, where things were
//   moved. Of pieces of one way three in four agree besides, nine in ten where the way is short: what only
//   looks alike does so here and there;
// - every rival is refuted: another place of any map that explains the same nodes must fail at three of them
//   where this one does not. A place that cannot be compared is not refuted. Not a rival is what fits
//   together: a place of a third map that lies at the same place of this one; nor what is not where the
//   wheels have led to, nor farther off than the robot can have got.
#ifndef ALE_GRAPH_LOOPS_JOIN_DECISION_H
#define ALE_GRAPH_LOOPS_JOIN_DECISION_H

#include <map>
#include <optional>
#include <vector>

#include "graph/loops/loop.h"
#include "graph/loops/map_table.h"
#include "graph/loops/place.h"

namespace ale
{

// What the maps are: pieces of one way that goes on, pieces that are known as a whole, or drives that are.
enum class MapKind { growing, pieces, drives };

struct FoundJoin {
    MapJoin join;
    std::vector<Loop> loops;           // that hold it; from the earlier to the later node
    std::vector<PosePrior> on_prior{}; // those that hold it on a map from before the drive
};

class JoinDecision
{
  public:
    // What a hypothesis must rest on.
    struct Support {
        size_t nodes;
        double apart_m; // two of them at least
        double agreed;  // part of all nodes near them that can be compared
    };
    // Of a map that may join another.
    static constexpr size_t least_nodes = 3;
    // That must agree where wheels have not put it there.
    static constexpr size_t least_elsewhere = 12;

    // matches: from a place of one map to a node of another, each with its overlap; queries: the nodes to
    // compare: those that were searched for, of drives all.
    JoinDecision(const SearchedMaps &maps, std::vector<Loop> matches, std::vector<int> queries, MapKind kind);

    // The strongest join that may be accepted. The first map (map/atlas.h) does not move. O(matches^2), and
    // at most most_compared hypotheses compared at every query; may throw std::bad_alloc.
    std::optional<FoundJoin> find();

  private:
    // How one map must move to lie in the other where the prediction has put it, and how that is known.
    struct Prediction {
        Guess guess;
        Pose shift;
        int node; // of the map, where the path goes from the one to the other
        double reach_m;
    };
    // What a hypothesis makes of one node.
    struct Account {
        bool known;    // the place could show enough of the view
        double agreed; // see Explanation; 0 if nothing fits
        double told;
        double undenied; // of drives also where nothing fits, but neither looks through what the other saw
    };
    struct Hypothesis {
        uint32_t map_id;
        uint32_t into_map_id;
        Pose shift;              // of the first, into the frame of the second, at the best match
        std::vector<Loop> loops; // the best of each node
        double strength;         // sum of overlaps
        Prediction prediction;
        std::map<int, Account> accounts{}; // by node
    };

    struct Tally {
        size_t known = 0;
        size_t agreed = 0;
        size_t denied = 0;
    };

    Hypothesis hypothesis_of(const Loop &seed, std::vector<Loop> *left) const;
    std::vector<Hypothesis> hypotheses() const;
    Pose shift_at(const Hypothesis &hypothesis, int node) const;
    bool puts_alike(const Hypothesis &hypothesis, const Pose &shift, int node) const;
    bool is_far_enough(const Hypothesis &hypothesis, double least_m) const;
    Prediction predicted(uint32_t map_id, uint32_t into_map_id) const;
    bool is_as_predicted(const Hypothesis &hypothesis) const;
    bool is_denied(const Hypothesis &hypothesis) const;
    bool is_within_reach(const Hypothesis &hypothesis) const;
    Support support_of(const Hypothesis &hypothesis, const std::vector<Hypothesis> &all) const;
    bool is_held(const Hypothesis &hypothesis, const Support &least) const;
    template <class Chosen> Tally tally(Hypothesis &hypothesis, Chosen is_chosen);
    bool holds_all_of_it(Hypothesis &hypothesis);
    bool is_sound(Hypothesis &hypothesis, const Support &support);
    bool is_rival(const Hypothesis &hypothesis, const Hypothesis &other) const;
    bool is_refuted(Hypothesis &rival, Hypothesis &hypothesis);
    bool fits_together(const Hypothesis &hypothesis, const Hypothesis &other,
                       const std::vector<Hypothesis> &all) const;
    bool is_unique(Hypothesis &hypothesis, std::vector<Hypothesis> &all);
    Account account(Hypothesis &hypothesis, int node);
    Account compared(const Hypothesis &hypothesis, int node);
    std::optional<int> place_near(const Pose &pose, uint32_t map_id) const;
    Pose shift_of(const Loop &loop) const;
    uint32_t map_of(int node) const
    {
        return maps_.map_of(node);
    }

    SearchedMaps maps_;
    std::vector<Loop> matches_;
    std::vector<int> queries_;
    std::vector<GraphEdge> guesses_; // between two maps
    MapKind kind_;
    std::optional<Place> place_; // the last that was compared with
};

} // namespace ale

#endif
