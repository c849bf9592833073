#include "lab/merge/merge.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <stdexcept>

#include "lab/merge/building.h"
#include "lab/merge/drive_file.h"
#include "lab/merge/join_drives.h"
#include "lab/merge/read_drive.h"
#include "lab/merge/report.h"
#include "lab/merge/results.h"

namespace merge
{

namespace
{

void refuse_twins(const std::vector<DriveGroup> &groups)
{
    std::map<uint32_t, std::string> names;
    for (const DriveGroup &group : groups) {
        for (const Drive &drive : group.drives) {
            const auto [other, is_new] = names.emplace(drive.checksum, drive.name);
            if (!is_new) {
                throw std::runtime_error(other->second + " and " + drive.name + " are the same drive");
            }
        }
    }
}

/* By date of the earliest drive of each. */
std::vector<DriveGroup> read_groups(const Options &options)
{
    std::vector<DriveGroup> groups;
    for (const std::string &path : options.drives) {
        if (is_drive_file(path)) {
            groups.push_back(read_drive_file(path));
        } else {
            groups.emplace_back().drives.push_back(read_drive(path, options));
        }
    }
    const auto earliest = [](const DriveGroup &group) {
        return std::min_element(group.drives.begin(), group.drives.end(), is_earlier);
    };
    std::stable_sort(groups.begin(), groups.end(), [&](const DriveGroup &a, const DriveGroup &b) {
        return is_earlier(*earliest(a), *earliest(b));
    });
    refuse_twins(groups);
    return groups;
}

/* Of drives that another merge will go on from, none is out of place yet. */
int keep(const Options &options, const SearchedDrives &searched)
{
    write_drive_file(options.keep_drives, searched.group);
    std::fprintf(stderr, "ale-merge: drives: %zu, joins: %zu\n", searched.group.drives.size(),
                 searched.group.joins.size());
    return 0;
}

int draw(const Options &options, SearchedDrives searched)
{
    std::vector<Drive> drives = join_drives(std::move(searched));
    std::stable_sort(drives.begin(), drives.end(), is_earlier);
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

} // namespace

int merge(const Options &options)
{
    SearchedDrives searched = search_joins(read_groups(options));
    return options.keep_drives.empty() ? draw(options, std::move(searched)) : keep(options, searched);
}

} // namespace merge
