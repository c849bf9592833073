#include "lab/merge/results.h"

#include <filesystem>
#include <set>
#include <stdexcept>

#include "common/export/map_image.h"
#include "common/export/text_file.h"

extern "C" {
#include "store/map_file.h"
#include "store/tile_file.h"
}

namespace merge
{

void save_map(const std::string &path, const ale_map_t &map)
{
    char error[ALE_MAP_FILE_ERROR];
    if (ale_map_file_save(path.c_str(), &map, error) < 0) {
        throw std::runtime_error(error);
    }
}

void save_tiles(const Options &options, const Building &building)
{
    if (options.tiles.empty()) {
        return;
    }
    const ale::WallMap map = building.draw_all();
    const ale_whole_map_t whole = {map.lines.data(), map.lines.size(), map.corners.data(),
                                   map.corners.size()};
    char error[ALE_MAP_FILE_ERROR];
    if (ale_tile_file_save(options.tiles.c_str(), &whole, options.tile_side_um, error) < 0) {
        throw std::runtime_error(error);
    }
}

void write_trajectories(const Options &options, const std::vector<Drive> &drives, uint32_t frame)
{
    if (options.trajectories.empty()) {
        return;
    }
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

void draw_maps(const Options &options, const ale_map_t &map, const Building &building)
{
    if (options.maps.empty()) {
        return;
    }
    const ale::ScanCloud cloud = building.cloud();
    ale::MapScene scene;
    scene.map = &map;
    scene.cloud = &cloud;
    scene.draw_points = options.points;
    for (const std::string &path : options.maps) {
        ale::write_map_image(path, scene);
    }
}

} // namespace merge
