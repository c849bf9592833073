#include "common/export/map_image.h"
#include "common/export/text_file.h"

namespace ale
{

namespace
{

void put_position(TextFile &file, const ale_point_t &p)
{
    file.put("[").put_decimal(p.x_um, 6).put(",").put_decimal(p.y_um, 6).put("]");
}

/* One line a feature: readable, and easy to compare. */
class FeatureList
{
  public:
    explicit FeatureList(TextFile &file) : file_(file)
    {
    }
    TextFile &begin(const char *geometry)
    {
        file_.put(first_ ? "\n" : ",\n").put(R"({"type":"Feature","geometry":{"type":")").put(geometry);
        first_ = false;
        return file_.put(R"(","coordinates":)");
    }

  private:
    TextFile &file_;
    bool first_ = true;
};

void put_wall(TextFile &file, FeatureList &features, const ale_map_line_t &wall)
{
    features.begin("LineString").put("[");
    put_position(file, wall.start);
    file.put(",");
    put_position(file, wall.end);
    file.put(R"(]},"properties":{"kind":"wall","id":)").put_integer(wall.id);
    file.put(R"(,"seen":)").put_integer(wall.seen);
    file.put(R"(,"map_id":)").put_integer(wall.map_id).put("}}");
}

void put_corner(TextFile &file, FeatureList &features, const ale_map_corner_t &corner)
{
    features.begin("Point");
    put_position(file, corner.p);
    file.put(R"(},"properties":{"kind":"corner"}})");
}

void put_way(TextFile &file, FeatureList &features, const Trajectory &trajectory)
{
    if (trajectory.size() < 2) {
        return;
    }
    features.begin("LineString").put("[");
    for (size_t k = 0; k < trajectory.size(); k++) {
        file.put(k > 0 ? "," : "");
        put_position(file, {trajectory[k].pose.x_um, trajectory[k].pose.y_um});
    }
    file.put(R"(]},"properties":{"kind":"way"}})");
}

} // namespace

void write_geojson(const std::string &path, const MapScene &scene)
{
    TextFile file(path);
    FeatureList features(file);
    file.put(R"({"type":"FeatureCollection","features":[)");
    for (int k = 0; k < scene.map->line_count; k++) {
        put_wall(file, features, scene.map->line[k]);
    }
    for (int k = 0; k < scene.map->corner_count; k++) {
        put_corner(file, features, scene.map->corner[k]);
    }
    put_way(file, features, scene.trajectory);
    file.put("\n]}\n");
    file.close();
}

} // namespace ale
