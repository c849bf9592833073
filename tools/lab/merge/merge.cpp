#include "lab/merge/merge.h"

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "lab/merge/building.h"
#include "lab/merge/join_drives.h"
#include "lab/merge/read_drive.h"
#include "lab/merge/report.h"
#include "lab/merge/results.h"

namespace merge
{

namespace
{

/* By date. */
std::vector<Drive> read_drives(const Options &options)
{
    std::vector<Drive> drives;
    for (const std::string &path : options.drives) {
        drives.push_back(read_drive(path, options));
    }
    std::stable_sort(drives.begin(), drives.end(), is_earlier);
    for (size_t k = 1; k < drives.size(); k++) {
        if (drives[k].checksum == drives[k - 1].checksum) {
            throw std::runtime_error(drives[k - 1].name + " and " + drives[k].name + " are the same drive");
        }
    }
    number_frames(&drives);
    return drives;
}

} // namespace

int merge(const Options &options)
{
    std::vector<Drive> drives = read_drives(options);
    join_drives(&drives);
    const uint32_t frame = largest_frame(drives);
    const bool all = report(drives, frame);
    write_trajectories(options, drives, frame);
    const Building building(&drives, frame);
    auto map = std::make_unique<ale_map_t>();
    building.draw(map.get());
    if (!options.out.empty()) {
        save_map(options.out, *map);
    }
    save_tiles(options, building);
    draw_maps(options, *map, building);
    return all ? 0 : 1;
}

} // namespace merge
