#include "lab/merge/into.h"

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "common/export/map_tidy.h"
#include "lab/merge/building.h"
#include "lab/merge/join_drives.h"
#include "lab/merge/kept_building.h"
#include "lab/merge/map_changes.h"
#include "lab/merge/read_drive.h"
#include "lab/merge/report.h"
#include "lab/merge/results.h"
#include "lab/merge/whole_text.h"

namespace merge
{

namespace
{

/* Those that the building does not know yet. */
std::vector<NewDrive> new_drives(const Options &options, const History &history)
{
    std::vector<NewDrive> drives;
    for (const std::string &path : options.drives) {
        const std::string name = std::filesystem::path(path).filename();
        const uint32_t checksum = checksum_of_file(path);
        for (const NewDrive &other : drives) {
            if (other.known.checksum == checksum) {
                throw std::runtime_error(other.known.name + " and " + name + " are the same drive");
            }
        }
        if (const KnownDrive *known = history.find(checksum)) {
            std::fprintf(stderr, "ale-merge: %s is in the map already, since version %u\n", name.c_str(),
                         known->version);
            continue;
        }
        drives.push_back({{checksum, 0, 0, true, options.use_odometry, !options.config.empty(), name},
                          path,
                          options.config});
    }
    return drives;
}

/* The drives that the building knows, where they lie in it, and after them the new ones, each for itself. */
std::vector<DriveGroup> read_all(const Options &options, const KeptBuilding &kept,
                                 std::vector<NewDrive> *added)
{
    std::vector<Drive> found;
    for (NewDrive &drive : *added) {
        found.push_back(read_drive(drive.log, options));
        drive.known.date_s = found.back().date_s;
    }
    std::stable_sort(found.begin(), found.end(), is_earlier);
    std::vector<DriveGroup> groups(1);
    groups.front().drives = kept.read_drives();
    for (Drive &drive : found) {
        groups.emplace_back().drives.push_back(std::move(drive));
    }
    return groups;
}

/* Leaves out what is not joined. False: nothing new is in the map. */
bool take_joined(size_t placed, std::vector<Drive> *drives, std::vector<NewDrive> *added)
{
    const auto first_new = drives->begin() + static_cast<std::ptrdiff_t>(placed);
    const auto refused = std::stable_partition(first_new, drives->end(),
                                               [](const Drive &drive) { return report_drive(drive, 0); });
    const auto is_refused = [&](const NewDrive &drive) {
        return std::any_of(refused, drives->end(),
                           [&](const Drive &other) { return other.checksum == drive.known.checksum; });
    };
    added->erase(std::remove_if(added->begin(), added->end(), is_refused), added->end());
    drives->erase(refused, drives->end());
    std::stable_sort(drives->begin(), drives->end(), is_earlier);
    return !added->empty();
}

Version lengths_of(const ale_map_t &map, const std::vector<ale::ChangedWall> &changes)
{
    constexpr int64_t um_per_mm = 1000;
    Version version{};
    version.walls_mm = walls_um(map) / um_per_mm;
    version.added_mm = ale::changed_um(changes, ale::WallChange::added) / um_per_mm;
    version.moved_mm = ale::changed_um(changes, ale::WallChange::moved) / um_per_mm;
    version.gone_mm = ale::changed_um(changes, ale::WallChange::gone) / um_per_mm;
    return version;
}

std::unique_ptr<ale_map_t> tidied(const ale_map_t &map)
{
    auto tidy = std::make_unique<ale_map_t>(map);
    ale_map_tidy(tidy.get());
    return tidy;
}

/* Draws the map of all drives and puts it, and what the latest have shown, into the building. */
void make_version(const Options &options, std::vector<Drive> drives, const std::vector<NewDrive> &added,
                  const ale_map_t &before, KeptBuilding *kept)
{
    NextVersion next{};
    const size_t too_many = drives.size() - std::min(drives.size(), options.keep);
    next.places = places_of(drives, too_many);
    write_trajectories(options, drives, 0);
    std::unique_ptr<ale_map_t> earlier = kept->earlier();
    const Building building(&drives, 0, earlier.get());
    auto map = std::make_unique<ale_map_t>();
    building.draw(map.get());
    if (too_many > 0) {
        earlier = std::make_unique<ale_map_t>();
        building.draw_first(too_many, earlier.get());
    }
    const auto shown = tidied(*map);
    next.picture.map = map.get();
    next.picture.changes = changes_between(*tidied(before), *shown);
    next.lengths = lengths_of(*shown, next.picture.changes);
    next.drives = added;
    next.map = map.get();
    next.earlier = earlier.get();
    draw_maps(options, *map, building);
    kept->commit(next);
    save_tiles(options, building);
}

} // namespace

int merge_into(const Options &options)
{
    KeptBuilding kept(options.into);
    std::vector<NewDrive> added = new_drives(options, kept.history());
    if (added.empty()) {
        return 0;
    }
    const size_t count = added.size();
    const ScanPlaces before = kept.places();
    const std::unique_ptr<ale_map_t> map_before = kept.map();
    std::vector<Drive> drives = join_drives(search_joins(read_all(options, kept, &added)));
    const size_t placed = drives.size() - count;
    if (placed == 0) {
        make_first(largest_frame(drives), &drives);
    }
    hold_frame(before, &drives);
    const bool is_better = take_joined(placed, &drives, &added);
    if (is_better) {
        make_version(options, std::move(drives), added, *map_before, &kept);
        std::fprintf(stderr, "ale-merge: %s: %s: %s\n", options.into.c_str(),
                     words_of(kept.history().versions.back()).c_str(), kept.picture().c_str());
    } else {
        std::fprintf(stderr, "ale-merge: %s stays as it is\n", options.into.c_str());
    }
    return added.size() == count ? 0 : 1;
}

int list_versions(const std::string &path)
{
    const History history = read_history(path + ".d/versions");
    if (history.versions.empty()) {
        throw std::runtime_error(path + ".d/versions: no map is kept there");
    }
    std::fputs(table_of(history).c_str(), stdout);
    return 0;
}

} // namespace merge
