// Aligns every scan of a drive to the mean surface of all scans, once the keyframes are refined.
//
//   ScanAlignment alignment(std::move(scans));
//   while (alignment.step()) {
//   }
//   alignment.poses()
//
// Between keyframes each scan has the tracker's own error of a centimetre. Here all scans make the map, the
// mean of what they saw of each surface. Each scan is matched to it, point to line, and tied to its
// neighbours as tracked and to the heading it was given. Then the map is made again.
#ifndef ALE_GRAPH_OPTIMISE_SCAN_ALIGNMENT_H
#define ALE_GRAPH_OPTIMISE_SCAN_ALIGNMENT_H

#include <vector>

#include "graph/optimise/node.h"
#include "graph/optimise/pose_graph.h"

namespace ale
{

struct AlignedScan {
    Pose pose;                        // where the graph has it
    bool tied;                        // tracked from the scan before without a break
    std::vector<SurfacePoint> points; // robot's frame; empty: nothing was seen, or the robot was lost
};

class ScanAlignment
{
  public:
    // Takes the scans over, in the order of the drive. May throw std::bad_alloc.
    explicit ScanAlignment(std::vector<AlignedScan> scans);

    // One sweep over all scans; 24 in all. False: done. O(points) and one sparse solution; may throw
    // std::bad_alloc, after which the alignment must not be used.
    bool step();

    // One for each scan, in their order.
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
