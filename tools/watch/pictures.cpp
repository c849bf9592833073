#include "watch/pictures.h"

#include <stdexcept>

#include "export/map_image.h"
#include "watch/core_types.h"

namespace watch
{

void require_picture_kind(const std::string &path)
{
    if (!ale::is_map_image_name(path)) {
        throw std::invalid_argument("--map " + path + ": the name must end in .png, .svg, .dxf or .pgm");
    }
}

void write_picture(const Record &record, const std::string &path)
{
    const auto map = core_map(record.map().value_or(ale::map_t{}));
    ale::MapScene scene;
    scene.map = map.get();
    scene.trajectory = record.trajectory();
    scene.cloud = &record.cloud();
    scene.draw_points = true;
    write_map_image(path, scene);
}

} // namespace watch
