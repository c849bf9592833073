// Line ids that persist from one rebuilt map to the next.
#ifndef ALE_GRAPH_WALLS_LINE_IDS_H
#define ALE_GRAPH_WALLS_LINE_IDS_H

#include <cstdint>
#include <vector>

extern "C" {
#include "map/line_map.h"
}

namespace ale
{

class LineIds
{
  public:
    // Sets the id of every line. The line that overlaps most with one of the last map takes its id, within
    // 0.15 m and 10 degrees; others get new ids. O(lines^2); may throw std::bad_alloc.
    void assign(ale_map_t *map);

  private:
    struct Line {
        ale_map_line_t line;
        uint32_t along_bam;
    };
    static Line line_of(const ale_map_line_t &line);
    static int64_t overlap_um(const Line &last, const Line &line);

    std::vector<Line> last_;
    uint32_t next_ = 0;
};

} // namespace ale

#endif
