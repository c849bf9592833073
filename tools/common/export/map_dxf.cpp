#include "common/export/map_image.h"

namespace ale
{

namespace
{

/* A DXF is pairs of lines: group code, value. */
class DxfFile
{
  public:
    explicit DxfFile(const std::string &path) : file_(path)
    {
    }
    DxfFile &put(int code, std::string_view value)
    {
        file_.put_integer(code).put("\n").put(value).put("\n");
        return *this;
    }
    DxfFile &put_metres(int code, int32_t um)
    {
        file_.put_integer(code).put("\n").put_decimal(um, 6).put("\n");
        return *this;
    }
    /* Codes x, x + 10 and x + 20 are the coordinates of one point. */
    DxfFile &put_point(int code, const ale_point_t &p)
    {
        return put_metres(code, p.x_um).put_metres(code + 10, p.y_um).put_metres(code + 20, 0);
    }
    void close()
    {
        file_.close();
    }

  private:
    TextFile file_;
};

void put_header(DxfFile &dxf, const Extent &extent)
{
    dxf.put(0, "SECTION").put(2, "HEADER").put(9, "$ACADVER").put(1, "AC1009");
    dxf.put(9, "$EXTMIN").put_point(10, {extent.left_um, extent.bottom_um});
    dxf.put(9, "$EXTMAX").put_point(10, {extent.right_um, extent.top_um});
    dxf.put(9, "$LUNITS").put(70, "2").put(9, "$LUPREC").put(70, "4").put(0, "ENDSEC");
}

void put_layer(DxfFile &dxf, const char *name, const char *colour)
{
    dxf.put(0, "LAYER").put(2, name).put(70, "0").put(62, colour).put(6, "CONTINUOUS");
}

void put_tables(DxfFile &dxf)
{
    dxf.put(0, "SECTION").put(2, "TABLES");
    dxf.put(0, "TABLE").put(2, "LTYPE").put(70, "1");
    dxf.put(0, "LTYPE").put(2, "CONTINUOUS").put(70, "0").put(3, "Solid line").put(72, "65").put(73, "0");
    dxf.put(40, "0").put(0, "ENDTAB");
    dxf.put(0, "TABLE").put(2, "LAYER").put(70, "3");
    put_layer(dxf, "WALLS", "7");
    put_layer(dxf, "CORNERS", "5");
    put_layer(dxf, "TRAJECTORY", "1");
    dxf.put(0, "ENDTAB").put(0, "ENDSEC");
}

/* All walls lie on one layer, for those who read them; apart is told by a colour that is not the layer's. */
void put_wall(DxfFile &dxf, const ale_map_line_t &wall)
{
    dxf.put(0, "LINE").put(8, "WALLS");
    if (is_apart(wall)) {
        dxf.put(62, "6");
    }
    dxf.put_point(10, wall.start).put_point(11, wall.end);
}

/* One polyline: a thousand short lines are of no use to who draws on. A robot that stands adds nothing. */
void put_trajectory(DxfFile &dxf, const Trajectory &trajectory)
{
    if (trajectory.size() < 2) {
        return;
    }
    dxf.put(0, "POLYLINE").put(8, "TRAJECTORY").put(66, "1").put_point(10, {0, 0}).put(70, "0");
    for (size_t i = 0; i < trajectory.size(); i++) {
        const ale_pose_t &pose = trajectory[i].pose;
        const ale_pose_t &before = trajectory[i > 0 ? i - 1 : 0].pose;
        if (i == 0 || i == trajectory.size() - 1 || pose.x_um != before.x_um || pose.y_um != before.y_um) {
            dxf.put(0, "VERTEX").put(8, "TRAJECTORY").put_point(10, {pose.x_um, pose.y_um});
        }
    }
    dxf.put(0, "SEQEND").put(8, "TRAJECTORY");
}

void put_entities(DxfFile &dxf, const MapScene &scene)
{
    dxf.put(0, "SECTION").put(2, "ENTITIES");
    for (int i = 0; i < scene.map->line_count; i++) {
        put_wall(dxf, scene.map->line[i]);
    }
    for (int i = 0; i < scene.map->corner_count; i++) {
        dxf.put(0, "POINT").put(8, "CORNERS").put_point(10, scene.map->corner[i].p);
    }
    put_trajectory(dxf, scene.trajectory);
    dxf.put(0, "ENDSEC").put(0, "EOF");
}

} // namespace

void write_dxf(const std::string &path, const MapScene &scene)
{
    DxfFile dxf(path);
    put_header(dxf, extent_of(scene));
    put_tables(dxf);
    put_entities(dxf, scene);
    dxf.close();
}

} // namespace ale
