#include "lab/merge/merge.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>
#include <stdexcept>
#include <tuple>

#include "common/export/map_image.h"
#include "lab/merge/building.h"
#include "lab/merge/join_drives.h"
#include "lab/merge/read_drive.h"
#include "lab/merge/report.h"

extern "C" {
#include "store/map_file.h"
}

namespace merge
{

namespace
{

bool is_earlier(const Drive &a, const Drive &b)
{
    return std::tie(a.date_s, a.checksum) < std::tie(b.date_s, b.checksum);
}

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

void save(const std::string &path, const ale_map_t &map)
{
    char error[ALE_MAP_FILE_ERROR];
    if (!path.empty() && ale_map_file_save(path.c_str(), &map, error) < 0) {
        throw std::runtime_error(error);
    }
}

/* NAME.tum, and where several logs are called that, NAME-2.tum ... in the order of their dates. */
void write_trajectories(const Options &options, const std::vector<Drive> &drives, uint32_t frame)
{
    const std::filesystem::path folder = options.trajectories;
    std::filesystem::create_directories(folder);
    std::multiset<std::string> names;
    for (const Drive &drive : drives) {
        std::string name = std::filesystem::path(drive.name).stem();
        names.insert(name);
        const size_t count = names.count(name);
        name += count > 1 ? "-" + std::to_string(count) : "";
        ale::TextFile file(folder / (name + ".tum"));
        for (const DriveScan &scan : drive.scans) {
            const ale_pose_t robot = ale::to_core(scan.pose);
            if (scan.frame == frame) {
                ale::put_tum_line(
                    file,
                    {scan.stamp_us, options.laser_frame ? ale_pose_compose(robot, drive.sensor) : robot});
            }
        }
        file.close();
    }
}

void draw(const Options &options, const ale_map_t &map, const Building &building)
{
    const ale::ScanCloud cloud = building.cloud();
    ale::MapScene scene;
    scene.map = &map;
    scene.cloud = &cloud;
    scene.draw_points = options.points;
    for (const std::string &path : options.maps) {
        ale::write_map_image(path, scene);
    }
}

} // namespace

int merge(const Options &options)
{
    std::vector<Drive> drives = read_drives(options);
    join_drives(&drives);
    const uint32_t frame = largest_frame(drives);
    const bool all = report(drives, frame);
    if (!options.trajectories.empty()) {
        write_trajectories(options, drives, frame);
    }
    const Building building(&drives, frame);
    auto map = std::make_unique<ale_map_t>();
    building.draw(map.get());
    save(options.out, *map);
    if (!options.maps.empty()) {
        draw(options, *map, building);
    }
    return all ? 0 : 1;
}

} // namespace merge
