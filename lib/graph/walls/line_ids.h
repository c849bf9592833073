// Names of walls that last from one drawing of the map to the next.
#ifndef ALE_GRAPH_WALLS_LINE_IDS_H
#define ALE_GRAPH_WALLS_LINE_IDS_H

#include <cstdint>
#include <vector>

extern "C" {
#include "track/pipeline.h"
}

namespace ale
{

class LineIds
{
  public:
    // A line that lies where one of the last drawing lay, and has most in common with it, takes its id;
    // others get new ones. O(lines^2).
    void name(ale_map_t *map);

  private:
    struct Line {
        ale_map_line_t line;
        uint32_t along_bam;
    };
    static Line line_of(const ale_map_line_t &line);
    static int64_t common_um(const Line &last, const Line &line);

    std::vector<Line> last_;
    uint32_t next_ = 0;
};

} // namespace ale

#endif
