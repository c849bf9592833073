/* The tiles of a large map beside a replay: what the firmware's tile loader does, at the scans that it names.
 */
#ifndef ALE_COMMON_OFFLINE_TILES_H
#define ALE_COMMON_OFFLINE_TILES_H

#include <deque>
#include <memory>
#include <string>

#include "common/offline/loops.h"

extern "C" {
#include "store/tile_loader.h"
#include "track/pipeline.h"
}

namespace ale
{

class Tiles
{
  public:
    /* Throws std::runtime_error with one line. */
    explicit Tiles(const std::string &path);

    /* Before a scan is handed to the pipeline: a piece that is due takes effect. */
    void before_scan(ale_pipeline_t *pipeline);

    /* After the pipeline has answered it. The mapper, if there is one, hears of what comes; what the robot
     * leaves behind it keeps, since the whole drive is laid on the map in the end. Says on stderr what could
     * not be read. */
    void after_scan(ale_pipeline_t *pipeline, Loops *loops);

  private:
    struct Close {
        void operator()(ale_tile_loader_t *loader) const
        {
            ale_tile_loader_close(loader);
        }
    };

    void tell_unread();

    std::unique_ptr<ale_tile_loader_t, Close> loader_;
    std::deque<ale_tile_change_t> due_;
    uint32_t unread_ = 0; /* told so far */
};

} // namespace ale

#endif
