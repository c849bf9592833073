#include "lab/inspect/sizes.h"

#include "common/export/formatted.h"

extern "C" {
#include "extract/extract.h"
#include "map/line_map.h"
#include "plan/explorer.h"
#include "track/correction.h"
#include "track/keyframe.h"
#include "track/pipeline.h"
#include "track/scan_observation.h"
}

namespace inspect
{

std::string table_of_sizes()
{
    const struct {
        const char *type;
        size_t bytes;
        const char *by;
        const char *purpose;
    } rows[] = {
        {"ale_scan_t", sizeof(ale_scan_t), "sizeof", "one scan, in"},
        {"ale_features_t", sizeof(ale_features_t), "sizeof", "lines, corners and curves of a scan, out"},
        {"ale_extractor_t", ale_extractor_size(), "ale_extractor_size()", "working memory of the extractor"},
        {"ale_pipeline_t", ale_pipeline_size(), "ale_pipeline_size()",
         "the tracker with its map and an extractor"},
        {"ale_estimate_t", sizeof(ale_estimate_t), "sizeof", "pose and state after a scan, out"},
        {"ale_map_t", sizeof(ale_map_t), "sizeof", "walls and corners of the map, in and out"},
        {"ale_keyframe_t", sizeof(ale_keyframe_t), "sizeof", "a keyframe for the mapper, out"},
        {"ale_scan_observation_t", sizeof(ale_scan_observation_t), "sizeof",
         "what a scan shows of the map, for the mapper, out"},
        {"ale_correction_t", sizeof(ale_correction_t), "sizeof", "a correction by the mapper, in"},
        {"ale_explorer_t", sizeof(ale_explorer_t), "sizeof", "exploration: grid, planner and kept scans"},
    };
    std::string table = "| type | bytes | known by | what |\n|---|---:|---|---|\n";
    for (const auto &row : rows) {
        table += ale::formatted("| `%s` | %zu | `%s` | %s |\n", row.type, row.bytes, row.by, row.purpose);
    }
    return table;
}

} // namespace inspect
