/* What the scans of a robot saw, laid out in its first map as they come over LCM.
 *
 *   space.take(scan); space.take(pose); space.take(tracking); space.take(graph);   (as they come, checked)
 *   scene.cloud = &space.cloud();
 *
 * A scan is laid out at its own map pose. When the map pose takes a step (a loop was closed, another map, one
 * that was forgotten) what was seen before lies wrong, and is begun anew; so it is when the map begins with
 * another scan: a robot that stands where its map began takes no step when it forgets it. Of a place where
 * the robot stands a few scans tell all. */
#ifndef ALE_COMMON_FEED_SEEN_SPACE_H
#define ALE_COMMON_FEED_SEEN_SPACE_H

#include <optional>

#include "ale/graph_t.hpp"
#include "ale/pose_t.hpp"
#include "ale/scan_t.hpp"
#include "ale/tracking_t.hpp"
#include "common/export/scan_cloud.h"

namespace feed
{

class SeenSpace
{
  public:
    /* True: something was laid out. */
    bool take(const ale::scan_t &scan);
    bool take(const ale::pose_t &pose);
    bool take(const ale::tracking_t &tracking);
    /* True: something was forgotten. */
    bool take(const ale::graph_t &graph);

    const ale::ScanCloud &cloud() const
    {
        return cloud_;
    }
    void forget()
    {
        cloud_ = without_points();
        scans_here_ = 0;
    }

  private:
    static ale::ScanCloud without_points()
    {
        return ale::ScanCloud(ale::ScanCloud::usual_cell_um, ale::ScanCloud::Points::left_out);
    }

    bool lay_out();
    bool is_new_here();

    std::optional<ale::scan_t> scan_; /* waits for its pose and its map, or these for it */
    std::optional<ale::pose_t> pose_;
    std::optional<ale::tracking_t> tracking_;
    ale::pose_t here_{}; /* where the robot stands, or last stood */
    int scans_here_ = 0;
    std::optional<int32_t> first_scan_; /* that the map began with */
    ale::ScanCloud cloud_ = without_points();
};

} // namespace feed

#endif
