#include "graph/loops/join_decision.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <Eigen/LU>

#include "graph/loops/loop_match.h"
#include "graph/loops/odometry.h"

namespace ale
{

namespace
{

// Matches of one hypothesis agree this well where they are: both maps may have drifted between them.
constexpr double alike_m = 0.30;
constexpr double alike_rad = 0.08;
// What a hypothesis must rest on: nodes, how far apart two of them are at least, and the part of all near
// them that must agree: what only looks alike does so here and there. Ground that no map knows may look like
// known one; what contradicts the wheels by more than they ever lose must be long.
using Support = JoinDecision::Support;
constexpr Support as_predicted{JoinDecision::least_nodes, 1.0, 0.75};
constexpr Support within_reach{JoinDecision::least_nodes + 1, 2.0, 0.75};
constexpr Support unrivalled{JoinDecision::least_nodes + 3, 2.5, 0.9};
constexpr Support elsewhere{JoinDecision::least_elsewhere, 8.0, 0.75};
constexpr double predicted_m = 3.0;
constexpr double predicted_rad = 0.8;
constexpr double reach_most_m = 10.0; // farther off it may be anywhere
// Of a drive that is smaller than that: the part of its extent, and of what can be compared.
constexpr double least_extent = 0.6;
constexpr double least_of_drive = 0.75;
constexpr double least_drive_m = 2.0;  // across; what saw less may be anywhere
constexpr size_t most_compared = 12;   // hypotheses
constexpr double least_strength = 0.4; // of a rival, as part of that of the hypothesis
constexpr double least_in_view = 1.0 / 3;
constexpr double agrees_at_least = 0.85; // as loops do
constexpr double denies = 0.75;
constexpr double most_denied = 0.2; // part of the nodes that are compared
constexpr double clearly_worse = 0.08;
constexpr size_t refuting_nodes = 3;
constexpr double compared_m = 8.0; // of a node that lies on the other map; farther off both may have drifted
constexpr double place_reach_m = 3.0;
constexpr double held_m = 0.03; // in the direction that is held least

Eigen::Matrix2d position_covariance(const Eigen::Matrix3d &information)
{
    const Eigen::Matrix3d regular = information + Eigen::Matrix3d::Identity() * 1e-3;
    return regular.inverse().topLeftCorner<2, 2>();
}

double largest_deviation_m(const Eigen::Matrix2d &covariance)
{
    const double mean = (covariance(0, 0) + covariance(1, 1)) / 2;
    return std::sqrt(mean + length((covariance(0, 0) - covariance(1, 1)) / 2, covariance(0, 1)));
}

bool is_held_everywhere(const Eigen::Matrix3d &information)
{
    return largest_deviation_m(position_covariance(information)) < held_m;
}

// Where the match lies if it moves from the guess only as far as it is held: along a corridor it slides.
Pose without_sliding(const LoopMatch &match, const Pose &guess)
{
    const Eigen::Matrix2d covariance = position_covariance(match.information);
    if (largest_deviation_m(covariance) < held_m) {
        return match.pose;
    }
    const double slope = angle_of({covariance(0, 0) - covariance(1, 1), 2 * covariance(0, 1)}) / 2;
    const Eigen::Vector2d held = rotation(match.pose.theta + slope).col(1);
    const double off = held.dot(Eigen::Vector2d(match.pose.x - guess.x, match.pose.y - guess.y));
    return {guess.x + off * held.x(), guess.y + off * held.y(), match.pose.theta};
}

double distance(const Pose &a, const Pose &b)
{
    return length(a.x - b.x, a.y - b.y);
}

bool is_near(const Pose &a, const Pose &b, double m, double rad)
{
    return distance(a, b) < m && std::abs(wrapped(a.theta - b.theta)) < rad;
}

Loop reversed(const Loop &loop)
{
    const Eigen::Matrix3d forth = displacement_jacobian(loop.measured);
    return {loop.to, loop.from, inverse(loop.measured), forth.transpose() * loop.information * forth,
            loop.overlap};
}

} // namespace

JoinDecision::JoinDecision(const SearchedMaps &maps, std::vector<Loop> matches, std::vector<int> queries,
                           MapKind kind)
    : maps_(maps), matches_(std::move(matches)), queries_(std::move(queries)), kind_(kind)
{
    const auto within_a_map = [this](const Loop &loop) { return map_of(loop.from) == map_of(loop.to); };
    matches_.erase(std::remove_if(matches_.begin(), matches_.end(), within_a_map), matches_.end());
    std::stable_sort(matches_.begin(), matches_.end(),
                     [](const Loop &a, const Loop &b) { return a.overlap > b.overlap; });
    std::copy_if(maps.edges.begin(), maps.edges.end(), std::back_inserter(guesses_),
                 [](const GraphEdge &edge) { return edge.guess != Guess::none; });
}

std::optional<FoundJoin> JoinDecision::find()
{
    std::vector<Hypothesis> all = hypotheses();
    for (size_t k = 0; k < std::min(all.size(), most_compared); k++) {
        Hypothesis &best = all[k];
        if (is_denied(best) || !is_sound(best, support_of(best, all)) || !is_unique(best, all)) {
            continue;
        }
        FoundJoin found{{best.map_id, best.into_map_id, best.shift}, {}, {}};
        if (best.map_id == ALE_FIRST_MAP) {
            found.join = {best.into_map_id, best.map_id, inverse(best.shift)};
        }
        for (const Loop &loop : best.loops) {
            if (loop.from < 0) {
                const Pose there = compose(maps_.pose_of(loop.from), loop.measured);
                found.on_prior.push_back({loop.to, there, loop.information});
            } else {
                found.loops.push_back(loop.from < loop.to ? loop : reversed(loop));
            }
        }
        return found;
    }
    return std::nullopt;
}

// How the map of the node must move to lie as this match has it.
Pose JoinDecision::shift_of(const Loop &loop) const
{
    return compose(compose(maps_.pose_of(loop.from), loop.measured), inverse(maps_.pose_of(loop.to)));
}

// How the map moves at this node. Drives are long, and either may be bent: as the nearest node that is
// matched says.
Pose JoinDecision::shift_at(const Hypothesis &hypothesis, int node) const
{
    if (kind_ != MapKind::drives || hypothesis.loops.empty()) {
        return hypothesis.shift;
    }
    const auto distance_to = [&](const Loop &loop) {
        return distance(maps_.pose_of(loop.to), maps_.pose_of(node));
    };
    return shift_of(
        *std::min_element(hypothesis.loops.begin(), hypothesis.loops.end(),
                          [&](const Loop &a, const Loop &b) { return distance_to(a) < distance_to(b); }));
}

bool JoinDecision::puts_alike(const Hypothesis &hypothesis, const Pose &shift, int node) const
{
    return is_near(compose(shift_at(hypothesis, node), maps_.pose_of(node)),
                   compose(shift, maps_.pose_of(node)), alike_m, alike_rad);
}

// Takes the matches that agree with the seed out of those left, from node to node.
JoinDecision::Hypothesis JoinDecision::hypothesis_of(const Loop &seed, std::vector<Loop> *left) const
{
    Hypothesis hypothesis{map_of(seed.to),
                          map_of(seed.from),
                          shift_of(seed),
                          {},
                          0,
                          predicted(map_of(seed.to), map_of(seed.from))};
    const auto agrees = [&](const Loop &loop) {
        return map_of(loop.to) == hypothesis.map_id && map_of(loop.from) == hypothesis.into_map_id &&
               puts_alike(hypothesis, shift_of(loop), loop.to);
    };
    const auto is_known = [&](const Loop &loop) {
        return std::any_of(hypothesis.loops.begin(), hypothesis.loops.end(),
                           [&loop](const Loop &other) { return other.to == loop.to; });
    };
    size_t before = 0;
    do {
        before = hypothesis.loops.size();
        for (const Loop &loop : *left) {
            if (!is_known(loop) && agrees(loop)) {
                hypothesis.loops.push_back(loop);
                hypothesis.strength += loop.overlap;
            }
        }
    } while (hypothesis.loops.size() > before);
    left->erase(std::remove_if(left->begin(), left->end(), agrees), left->end());
    return hypothesis;
}

// The strongest first.
std::vector<JoinDecision::Hypothesis> JoinDecision::hypotheses() const
{
    std::vector<Loop> left = matches_;
    std::vector<Hypothesis> all;
    while (!left.empty()) {
        const Loop seed = left.front();
        all.push_back(hypothesis_of(seed, &left));
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const Hypothesis &a, const Hypothesis &b) { return a.strength > b.strength; });
    return all;
}

// The node of a map nearest to a pose in its frame.
std::optional<int> JoinDecision::place_near(const Pose &pose, uint32_t map_id) const
{
    std::optional<int> nearest;
    double least_m = place_reach_m;
    for (int k = maps_.first(); k < maps_.end(); k++) {
        if (map_of(k) == map_id && distance(maps_.pose_of(k), pose) < least_m) {
            least_m = distance(maps_.pose_of(k), pose);
            nearest = k;
        }
    }
    return nearest;
}

// Each is asked for many times.
JoinDecision::Account JoinDecision::account(Hypothesis &hypothesis, int node)
{
    const auto known = hypothesis.accounts.find(node);
    return known != hypothesis.accounts.end()
               ? known->second
               : hypothesis.accounts.emplace(node, compared(hypothesis, node)).first->second;
}

JoinDecision::Account JoinDecision::compared(const Hypothesis &hypothesis, int node)
{
    const Pose there = compose(shift_at(hypothesis, node), maps_.pose_of(node));
    const std::optional<int> anchor = place_near(there, hypothesis.into_map_id);
    if (!anchor) {
        return {false, 0, 0, 0};
    }
    if (!place_ || place_->anchor() != *anchor) {
        place_.emplace(maps_, *anchor);
    }
    const View view(maps_.nodes, maps_.poses, node);
    const Pose guess = between(maps_.pose_of(*anchor), there);
    const LoopMatch match = match_locally(view.points, place_->field(), guess);
    const Pose found = without_sliding(match, guess);
    const bool stays = is_near(found, guess, alike_m, alike_rad);
    const Explanation seen = place_->explain(view, stays ? found : guess);
    if (seen.in_view < least_in_view) {
        return {false, 0, 0, 0};
    }
    const bool fits = stays && match.overlap >= least_overlap * seen.in_view;
    const double agreed = fits ? seen.agreed : 0;
    return {true, agreed, fits ? seen.told : 0, kind_ == MapKind::drives ? seen.agreed : agreed};
}

bool JoinDecision::is_far_enough(const Hypothesis &hypothesis, double least_m) const
{
    const std::vector<Loop> &loops = hypothesis.loops;
    return std::any_of(loops.begin(), loops.end(), [&](const Loop &one) {
        return std::any_of(loops.begin(), loops.end(), [&](const Loop &other) {
            return distance(maps_.pose_of(one.to), maps_.pose_of(other.to)) > least_m;
        });
    });
}

// The best guess where the path goes from the one map to the other; what wheels have told stays as it was
// when either map has moved since.
JoinDecision::Prediction JoinDecision::predicted(uint32_t map_id, uint32_t into_map_id) const
{
    Prediction found{Guess::anywhere, {}, 0, Pace::endless_m};
    for (const GraphEdge &edge : guesses_) {
        const bool forth = map_of(edge.from) == into_map_id && map_of(edge.to) == map_id;
        const bool back = map_of(edge.from) == map_id && map_of(edge.to) == into_map_id;
        if ((forth || back) && edge.guess <= found.guess) {
            const Pose there = compose(maps_.pose_of(edge.from), edge.measured);
            const Pose shift = compose(there, inverse(maps_.pose_of(edge.to)));
            found = {edge.guess, forth ? shift : inverse(shift), forth ? edge.to : edge.from, edge.reach_m};
        }
    }
    return found;
}

bool JoinDecision::is_as_predicted(const Hypothesis &hypothesis) const
{
    const Pose &first = maps_.pose_of(hypothesis.loops.front().to);
    const Prediction &prediction = hypothesis.prediction;
    return prediction.guess != Guess::anywhere &&
           is_near(compose(hypothesis.shift, first), compose(prediction.shift, first), predicted_m,
                   predicted_rad);
}

// Whether wheels have told of the way from the one map to the other, and it leads to another place, or nobody
// can have got there in the time. The robot may be on ground that no map holds, and then nothing that is
// known must be seen there.
bool JoinDecision::is_denied(const Hypothesis &hypothesis) const
{
    const Prediction &prediction = hypothesis.prediction;
    if (prediction.guess != Guess::anywhere) {
        return prediction.guess == Guess::led && !is_as_predicted(hypothesis);
    }
    const Pose &node = maps_.pose_of(prediction.node);
    return distance(compose(hypothesis.shift, node), compose(prediction.shift, node)) > prediction.reach_m;
}

// Whether all is known, and the robot, which nobody watched, cannot have got far.
bool JoinDecision::is_within_reach(const Hypothesis &hypothesis) const
{
    const Prediction &prediction = hypothesis.prediction;
    return kind_ == MapKind::pieces && prediction.guess == Guess::anywhere &&
           prediction.reach_m < reach_most_m;
}

JoinDecision::Support JoinDecision::support_of(const Hypothesis &hypothesis,
                                               const std::vector<Hypothesis> &all) const
{
    if (kind_ == MapKind::drives || is_as_predicted(hypothesis)) {
        return as_predicted;
    }
    if (is_within_reach(hypothesis)) {
        return within_reach;
    }
    const bool is_long =
        hypothesis.loops.size() >= elsewhere.nodes && is_far_enough(hypothesis, elsewhere.apart_m);
    const auto rivals = [&](const Hypothesis &other) { return is_rival(hypothesis, other); };
    if (is_long || kind_ != MapKind::pieces || std::any_of(all.begin(), all.end(), rivals)) {
        return elsewhere;
    }
    return unrivalled;
}

// Nodes enough, apart, and held in every direction. Of a drive some were searched for alone.
bool JoinDecision::is_held(const Hypothesis &hypothesis, const Support &least) const
{
    const auto holds = [](const Loop &loop) { return is_held_everywhere(loop.information); };
    return hypothesis.loops.size() >= least.nodes &&
           (kind_ == MapKind::drives || is_far_enough(hypothesis, least.apart_m)) &&
           std::any_of(hypothesis.loops.begin(), hypothesis.loops.end(), holds);
}

// What the hypothesis makes of those of its nodes that are chosen.
template <class Chosen> JoinDecision::Tally JoinDecision::tally(Hypothesis &hypothesis, Chosen is_chosen)
{
    Tally sum;
    for (const int query : queries_) {
        if (map_of(query) == hypothesis.map_id && is_chosen(query)) {
            const Account made = account(hypothesis, query);
            sum.known += made.known;
            sum.agreed += made.known && made.agreed >= agrees_at_least;
            sum.denied += made.known && made.undenied < denies;
        }
    }
    return sum;
}

// Of a drive that is too small for nodes so far apart: nearly all of it lies there, and most of its extent.
bool JoinDecision::holds_all_of_it(Hypothesis &hypothesis)
{
    const Pose &first = maps_.pose_of(hypothesis.loops.front().to);
    double extent_m = least_drive_m;
    const Tally all = tally(hypothesis, [&](int query) {
        extent_m = std::max(extent_m, distance(maps_.pose_of(query), first));
        return true;
    });
    return is_far_enough(hypothesis, least_extent * extent_m) &&
           static_cast<double>(all.agreed) >= least_of_drive * static_cast<double>(all.known);
}

// Whether the two maps agree wherever they overlap near these nodes.
bool JoinDecision::is_sound(Hypothesis &hypothesis, const Support &support)
{
    if (!is_held(hypothesis, support) ||
        (kind_ == MapKind::drives && !is_far_enough(hypothesis, elsewhere.apart_m) &&
         !holds_all_of_it(hypothesis))) {
        return false;
    }
    const Tally near = tally(hypothesis, [&](int query) {
        return std::any_of(hypothesis.loops.begin(), hypothesis.loops.end(), [&](const Loop &loop) {
            return distance(maps_.pose_of(query), maps_.pose_of(loop.to)) < compared_m;
        });
    });
    const bool few = kind_ != MapKind::drives || is_as_predicted(hypothesis);
    const Support &least = few ? as_predicted : elsewhere;
    const auto known = static_cast<double>(near.known);
    return near.agreed >= least.nodes && static_cast<double>(near.denied) <= most_denied * known &&
           (kind_ == MapKind::drives || static_cast<double>(near.agreed) >= support.agreed * known);
}

// Whether the other explains enough of the same nodes, or puts other nodes to another place of the same map.
bool JoinDecision::is_rival(const Hypothesis &hypothesis, const Hypothesis &other) const
{
    if (&hypothesis == &other || other.map_id != hypothesis.map_id || is_denied(other)) {
        return false;
    }
    double strength = 0;
    for (const Loop &loop : other.loops) {
        const bool shared = std::any_of(hypothesis.loops.begin(), hypothesis.loops.end(),
                                        [&loop](const Loop &own) { return own.to == loop.to; });
        strength += shared || other.into_map_id == hypothesis.into_map_id ? loop.overlap : 0;
    }
    return strength >= least_strength * hypothesis.strength;
}

bool JoinDecision::is_refuted(Hypothesis &rival, Hypothesis &hypothesis)
{
    std::vector<Account> own;
    for (const Loop &loop : hypothesis.loops) {
        own.push_back(account(hypothesis, loop.to));
    }
    size_t against = 0;
    for (size_t k = 0; k < own.size(); k++) {
        const Account other = account(rival, hypothesis.loops[k].to);
        if (!own[k].known || !other.known) {
            continue;
        }
        if (own[k].agreed < other.agreed - clearly_worse) {
            return false;
        }
        against += other.told < own[k].told - clearly_worse;
    }
    return against >= refuting_nodes;
}

// Whether the places that two maps offer are one: a third hypothesis says so.
bool JoinDecision::fits_together(const Hypothesis &hypothesis, const Hypothesis &other,
                                 const std::vector<Hypothesis> &all) const
{
    const uint32_t here = hypothesis.into_map_id;
    const uint32_t there = other.into_map_id;
    const Pose there_to_here = compose(hypothesis.shift, inverse(other.shift));
    return std::any_of(all.begin(), all.end(), [&](const Hypothesis &third) {
        if (third.map_id == there && third.into_map_id == here) {
            return puts_alike(third, there_to_here, other.loops.front().from);
        }
        return third.map_id == here && third.into_map_id == there &&
               puts_alike(third, inverse(there_to_here), hypothesis.loops.front().from);
    });
}

bool JoinDecision::is_unique(Hypothesis &hypothesis, std::vector<Hypothesis> &all)
{
    return std::all_of(all.begin(), all.end(), [&](Hypothesis &other) {
        if (!is_rival(hypothesis, other)) {
            return true;
        }
        const bool may_be_one =
            other.into_map_id != hypothesis.into_map_id && fits_together(hypothesis, other, all);
        return may_be_one || is_refuted(other, hypothesis);
    });
}

} // namespace ale
