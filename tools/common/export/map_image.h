/* Maps for people and for other programs, by the name's extension:
 *
 *   .png   picture: walls, trajectory with start and end, metre grid, scale bar
 *   .svg   the same as vectors, in metres
 *   .dxf   drawing for CAD: R12, metres, layers WALLS, CORNERS, TRAJECTORY
 *   .pgm   occupancy grid of the cloud's cells (5 cm without one), with a .yaml beside it: what ROS's
 * map_server reads
 *   .geojson   walls, corners and way as features, in metres of the map
 *
 *   MapScene scene;  scene.map = &map;  scene.trajectory = ...;
 *   write_map_image("map.png", scene);       throws std::runtime_error with one line for people
 *
 * Walls of maps that are not joined with the first are violet (.png, .svg) or magenta (.dxf). Where a map is
 * compared with an earlier one (.png, .svg): new walls green, moved ones amber, gone ones red and thin, with
 * the metres of each.
 *
 * The same scene gives the same bytes on every machine: all drawing is in integers. */
#ifndef ALE_COMMON_EXPORT_MAP_IMAGE_H
#define ALE_COMMON_EXPORT_MAP_IMAGE_H

#include <array>
#include <string>
#include <vector>

#include "common/export/extent.h"
#include "common/export/scan_cloud.h"
#include "common/export/trajectory.h"

extern "C" {
#include "track/pipeline.h"
}

namespace ale
{

/* Part of a wall that is not as it was in an earlier map; a moved one where it stands now. */
enum class WallChange { added, moved, gone };
struct ChangedWall {
    WallChange what;
    ale_point_t start;
    ale_point_t end;
};

/* Length of all that changed so, rounded to whole millimetres one by one. */
int64_t changed_um(const std::vector<ChangedWall> &changes, WallChange what);

/* What there is to draw. Pointers are borrowed; all but `map` may be left out. */
struct MapScene {
    const ale_map_t *map = nullptr;
    Trajectory trajectory; /* of the robot, in the map */
    const ScanCloud *cloud = nullptr;
    bool draw_points = false; /* the cloud's points faintly behind the walls (.png, .svg) */
    std::vector<ChangedWall> changes = {};
};

/* The wall is in a map that is not joined with the first: where it is drawn says nothing. */
inline bool is_apart(const ale_map_line_t &line)
{
    return line.map_id != 0;
}
bool has_walls_apart(const ale_map_t &map);

/* Whether the name ends in one of the extensions. */
bool is_map_image_name(const std::string &path);

/* Draws the tidied map (map_tidy.h): one line for one wall. */
void write_map_image(const std::string &path, const MapScene &scene);

/* Smallest rectangle of all that is drawn; a metre square about the origin when there is nothing. */
Extent extent_of(const MapScene &scene);

/* The same for pictures: the last half per cent of the points on each side, glimpses far away, widens
 * nothing. */
Extent picture_of(const MapScene &scene);

/* The points of the cloud that lie in it, border included. */
std::vector<ale_point_t> points_in(const Extent &extent, const ScanCloud &cloud);

/* Length of the grid's mesh and of the scale bar that suit a map of this size. */
struct Scale {
    int32_t mesh_um;
    int32_t bar_um;
};
Scale scale_of(const Extent &extent);

/* "5 m", "0.5 m". */
std::string length_label(int32_t length_um);

/* The legend of changes, in the order in which it is drawn: "new 3.2 m". */
std::string change_label(const MapScene &scene, WallChange what);
constexpr std::array<WallChange, 3> all_changes = {WallChange::added, WallChange::moved, WallChange::gone};

/* The kinds one by one. */
void write_png(const std::string &path, const MapScene &scene);
void write_svg(const std::string &path, const MapScene &scene);
void write_dxf(const std::string &path, const MapScene &scene);
void write_pgm(const std::string &path, const MapScene &scene);
void write_geojson(const std::string &path, const MapScene &scene);

} // namespace ale

#endif
