#include "common/offline/tiles.h"

#include <cstdio>
#include <stdexcept>

namespace ale
{

Tiles::Tiles(const std::string &path)
{
    char error[ALE_MAP_FILE_ERROR];
    loader_.reset(ale_tile_loader_open(path.c_str(), error));
    if (!loader_) {
        throw std::runtime_error(error);
    }
}

void Tiles::before_scan(ale_pipeline_t *pipeline)
{
    if (!due_.empty() && ale_pipeline_change_tiles(pipeline, &due_.front())) {
        due_.pop_front();
    }
}

void Tiles::after_scan(ale_pipeline_t *pipeline, Loops *loops)
{
    ale_whereabouts_t whereabouts;
    if (!ale_pipeline_whereabouts(pipeline, &whereabouts)) {
        return;
    }
    ale_tile_loader_follow(loader_.get(), &whereabouts);
    ale_tile_change_t piece;
    while (ale_tile_loader_next(loader_.get(), &piece)) {
        due_.push_back(piece);
        if (loops) {
            piece.gone_count = 0;
            loops->change_tiles(piece);
        }
    }
    tell_unread();
}

void Tiles::tell_unread()
{
    const ale_tile_trouble_t *trouble = ale_tile_loader_trouble(loader_.get());
    if (trouble->unread != unread_) {
        unread_ = trouble->unread;
        std::fprintf(stderr, "map of tiles: %u could not be read, and count as empty; the last: %s\n",
                     unread_, trouble->error);
    }
}

} // namespace ale
