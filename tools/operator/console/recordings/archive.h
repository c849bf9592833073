/* The console's folders as its pages see them: recordings that it made, maps that the robot saved, and the
 * map of now. One thread at a time (errands.h); it may wait for the disk.
 *
 * What a file is, is looked up once for as long as it does not change. */
#ifndef CONSOLE_ARCHIVE_H
#define CONSOLE_ARCHIVE_H

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "operator/console/board.h"
#include "operator/console/recordings/descriptor.h"
#include "operator/console/recordings/open_recording.h"
#include "operator/console/recordings/recording_summary.h"
#include "operator/console/recordings/shelf.h"
#include "operator/console/recordings/thumbnail.h"
#include "operator/console/recordings/wanted.h"

namespace console
{

/* A recording or a saved map in the list. */
struct Piece {
    std::string name; /* without its ending */
    int64_t at_ms = 0;
    int64_t length_ms = 0;
    uint64_t bytes = 0;
    bool has_scans = false;
    int walls = -1; /* of its map; -1: there is none that can be read */
    Thumbnail thumbnail;
};

/* One folder's pieces, newest first. */
struct Contents {
    std::string folder; /* empty: there is none */
    std::string trouble;
    std::vector<Piece> pieces;
    size_t more = 0; /* older ones that are not in the list */
};

/* What is sent to a browser: a file, or a text. */
struct Content {
    Descriptor file;
    std::string text;
    uint64_t bytes = 0;
};

class Archive
{
  public:
    /* Of older ones a list tells the number. */
    static constexpr size_t most_listed = 100;

    /* Empty folders: there are none. The board must outlive it. */
    Archive(const Board &board, const Shelf &recordings, const Shelf &maps)
        : board_(board), recordings_(recordings), maps_(maps)
    {
    }

    /* making: a recording that is being made, which is not listed. */
    Contents recordings(const std::string &making);
    Contents maps();

    /* Nothing: there is no such thing. Throws std::runtime_error in words for people. */
    std::optional<Content> fetch(const Wanted &wanted) const;

    /* For looking at; one for all who look at the same. Throws as fetch(); also where there is none, or eight
     * are looked at. */
    std::shared_ptr<const OpenRecording> open(const std::string &stem);

  private:
    struct Opened {
        int64_t changed_ns;
        std::weak_ptr<const OpenRecording> recording;
    };
    struct Known {
        int64_t changed_ms;
        uint64_t bytes;
        Piece piece;
    };
    template <class Describe>
    Contents list(const Shelf &shelf, const std::string &left_out, Describe describe);
    std::optional<Content> recording(const Wanted &wanted) const;
    std::optional<Content> map(const Wanted &wanted) const;
    std::shared_ptr<const ale_map_t> saved_map(const std::string &name) const;

    const Board &board_;
    const Shelf &recordings_;
    const Shelf &maps_;
    std::map<std::string, Known> known_; /* by folder and name */
    std::map<std::string, Opened> opened_;
};

} // namespace console

#endif
