// The directions in which a building's walls run. Most buildings are right-angled, and then every keyframe
// that sees walls tells its own heading, but for quarter turns: a compass against slow drift.
//
// Only for a building that is one (most of what was seen agrees), while driving only where headings have
// drifted by more than walls stray from the right angle, so that nothing moves where the tracker is right,
// and only where what neighbouring views show of each other bears it: in a bent building they do not.
#ifndef ALE_GRAPH_WALLS_BUILDING_AXES_H
#define ALE_GRAPH_WALLS_BUILDING_AXES_H

#include <vector>

#include "graph/optimise/node.h"
#include "graph/optimise/pose_graph.h"

namespace ale
{

// Which walls are asked: those of the keyframes' own scans, or those of the scans after them too, whose
// noise then averages out.
enum class Witnesses { keyframes, all_scans };

// Headings that the walls suggest, for every node that sees enough of them; none when the building is
// not right-angled. Poses and nodes correspond. O(n).
BuildingHeadings headings_by_walls(const std::vector<Node> &nodes, const std::vector<Pose> &poses,
                                   Witnesses witnesses = Witnesses::keyframes);

// Whether several suggestions in a row lie to the same side, farther than walls stray. O(n).
bool have_drifted(const BuildingHeadings &headings, const std::vector<Pose> &poses);

// Whether it was no drift, but the building that bends: what matches of views miss the poses by, turned to
// the walls' headings and not turned (PoseGraph::misfit, summed over so many matches). Where nothing had
// drifted farther than walls stray, matches decide sooner.
bool are_torn(double misfit_turned, double misfit_free, size_t matches, bool drifted);

} // namespace ale

#endif
