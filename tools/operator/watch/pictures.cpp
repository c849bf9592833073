#include "operator/watch/pictures.h"

#include "common/export/map_image.h"
#include "operator/watch/core_types.h"

namespace watch
{

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
