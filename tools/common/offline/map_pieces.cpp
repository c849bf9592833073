#include "common/offline/map_pieces.h"

#include <memory>
#include <set>

namespace ale
{

namespace
{

constexpr uint32_t first_map = 0; /* the one that was loaded, if one was */

void append(ale_map_t *out, const ale_map_t &piece, uint32_t map_id)
{
    out->refused += piece.refused;
    for (int k = 0; k < piece.line_count; k++) {
        if (out->line_count == ALE_MAP_MAX_LINES) {
            out->refused++;
            continue;
        }
        ale_map_line_t &line = out->line[out->line_count];
        line = piece.line[k];
        line.id = out->line_count++;
        line.map_id = map_id;
    }
    for (int k = 0; k < piece.corner_count; k++) {
        if (out->corner_count == ALE_MAP_MAX_CORNERS) {
            out->refused++;
            continue;
        }
        out->corner[out->corner_count++] = piece.corner[k];
    }
}

} // namespace

void rebuild_pieces(const ObservationRecord &record, const PoseOfScan &pose_of, const MapOfScan &map_of,
                    ale_map_t *out)
{
    std::set<uint32_t> maps = {first_map};
    for (const RecordedScan &scan : record.scans()) {
        maps.insert(map_of(scan.scan));
    }
    const auto piece = std::make_unique<ale_map_t>();
    *out = {};
    for (const uint32_t map_id : maps) {
        const auto pose_in_map = [&](const RecordedScan &scan) {
            return map_of(scan.scan) == map_id ? pose_of(scan) : std::nullopt;
        };
        rebuild_map(record, pose_in_map, piece.get(),
                    map_id == first_map ? PriorWalls::counted : PriorWalls::left_out);
        append(out, *piece, map_id);
        out->version = piece->version;
    }
}

} // namespace ale
