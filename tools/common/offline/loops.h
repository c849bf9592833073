/* The mapper beside a replay: what the firmware's mapper thread does, at fixed scans instead of when it is
 * done. */
#ifndef ALE_COMMON_OFFLINE_LOOPS_H
#define ALE_COMMON_OFFLINE_LOOPS_H

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <vector>

#include "graph/optimise/node.h"

extern "C" {
#include "graph/mapper.h"
#include "track/pipeline.h"
}

namespace ale
{

class Loops
{
  public:
    Loops();

    // Before the first scan: the drive begins in this map.
    void know(const ale_map_t &map)
    {
        known_ = std::make_unique<ale_map_t>(map);
    }

    /* A piece of the tiles around the robot: see ale_mapper_change_tiles. */
    void change_tiles(const ale_tile_change_t &change);

    using Taken = std::function<void(const ale_correction_t &)>;

    /* Before a scan is handed to the pipeline: corrections that are due take effect, and `taken` hears of
     * each. */
    void before_scan(ale_pipeline_t *pipeline, const Taken &taken = {});

    /* After the pipeline has answered it. */
    void after_scan(ale_pipeline_t *pipeline, const ale_estimate_t &estimate);

    /* The last scan, if the pipeline has taken it for a keyframe, else nullptr; until the next scan. */
    const ale_keyframe_t *keyframe() const
    {
        return is_keyframe_ ? keyframe_.get() : nullptr;
    }

    /* After the last scan: the graph is drawn tight, what is still under way takes effect, every scan is laid
     * on what all have seen, and its pose is known. */
    void finish(ale_pipeline_t *pipeline);

    /* Map pose of a scan, corrected by all loops and laid on what all scans have seen; after finish(). */
    ale_pose_t corrected(uint32_t scan) const
    {
        return corrected_[scan];
    }

    /* The map that it is in, after all joins: that of the last keyframe at or before the scan; after
     * finish(). */
    uint32_t map_of(uint32_t scan) const;

    /* The graph as others are told it. False: out of memory; *out may then hold anything. */
    bool copy_graph(ale_mapper_graph_t *out) const
    {
        return ale_mapper_graph(mapper_.get(), out);
    }
    /* Grows whenever the graph may have changed; 0: there is none yet. */
    uint32_t graph_version() const
    {
        return graph_version_;
    }

    ale_mapper_statistics_t statistics() const
    {
        return ale_mapper_statistics(mapper_.get());
    }
    int64_t longest_ns() const
    {
        return longest_ns_;
    }

  private:
    struct Tracked {
        ale_pose_t smooth;
        ale_pose_t map;
    };
    struct Destroy {
        void operator()(ale_mapper_t *mapper) const
        {
            ale_mapper_destroy(mapper);
        }
    };

    ale_pose_t bent(uint32_t scan) const;
    void align();
    void align_map(uint32_t map_id);
    bool tied(uint32_t scan, uint32_t later) const;
    void take_correction();
    void refine();

    std::unique_ptr<ale_mapper_t, Destroy> mapper_;
    std::unique_ptr<ale_keyframe_t> keyframe_;
    bool is_keyframe_ = false;
    std::unique_ptr<ale_map_t> known_; /* until the mapper knows it */
    std::deque<std::unique_ptr<ale_correction_t>> due_;
    std::vector<Tracked> tracked_;             /* by scan */
    std::vector<ale_mapper_pose_t> keyframes_; /* after finish() */
    std::vector<std::vector<SurfacePoint>>
        seen_; /* by scan; until finish(); none: nothing, or from nobody knows where */
    std::vector<ale_pose_t> corrected_; /* by scan; after finish() */
    std::vector<uint32_t> breaks_;      /* scans that nothing ties to those before them */
    int64_t longest_ns_ = 0;
    uint32_t graph_version_ = 0;
};

} // namespace ale

#endif
