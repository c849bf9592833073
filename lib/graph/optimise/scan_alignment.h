// Every scan of a drive laid on what all scans together saw, when the poses of the keyframes are known.
//
//   ScanAlignment alignment(std::move(scans));
//   while (alignment.step()) {
//   }
//   alignment.poses()
//
// Keyframes are half a metre apart; between them the way is as the tracker knew it at the time, each scan's
// pose with its own error of a centimetre. Here all scans make the map, the mean of what they saw of each
// surface; each scan is drawn to it, point to line, to its neighbours along the way as it lay to them, and to
// the heading that it was given; then the map is made anew.
#ifndef ALE_GRAPH_OPTIMISE_SCAN_ALIGNMENT_H
#define ALE_GRAPH_OPTIMISE_SCAN_ALIGNMENT_H

#include <vector>

#include "graph/optimise/node.h"
#include "graph/optimise/pose_graph.h"

namespace ale
{

struct AlignedScan {
    Pose pose;                        // where the graph has it
    bool tied;                        // the way as tracked leads here from the scan before
    std::vector<SurfacePoint> points; // robot's frame; none: nothing was seen, or it was lost
};

class ScanAlignment
{
  public:
    explicit ScanAlignment(std::vector<AlignedScan> scans);

    // Once over all scans. False: nothing is left to do.
    bool step();

    const std::vector<Pose> &poses() const
    {
        return graph_.poses();
    }

  private:
    std::vector<AlignedScan> scans_;
    PoseGraph graph_;
    int sweep_ = 0;
};

} // namespace ale

#endif
