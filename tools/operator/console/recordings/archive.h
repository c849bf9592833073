/* The console's folders as its pages see them: recordings that it made, recordings of the scanner's bytes
 * (flights, .scip), maps that the robot saved, and the map of now. It may wait for the disk: for errands
 * (errands.h), of any thread.
 *
 * What a file is, is looked up once for as long as it does not change. A flight is replayed to be looked at
 * (replayed.h). */
#ifndef CONSOLE_ARCHIVE_H
#define CONSOLE_ARCHIVE_H

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "common/export/map_image.h"
#include "operator/console/board.h"
#include "operator/console/recordings/descriptor.h"
#include "operator/console/recordings/open_recording.h"
#include "operator/console/recordings/recording_summary.h"
#include "operator/console/recordings/shelf.h"
#include "operator/console/recordings/thumbnail.h"
#include "operator/console/recordings/wanted.h"

namespace console
{

/* A recording, a flight or a saved map in the list. */
struct Piece {
    std::string name; /* without its ending */
    int64_t at_ms = 0;
    int64_t length_ms = 0;
    uint64_t bytes = 0;
    bool has_scans = false;
    int walls = -1;     /* of its map; -1: there is none that can be read, or it is a flight */
    std::string reason; /* why the robot wrote a flight; empty: its name does not tell */
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

    /* Flights lie in two folders: beside the recordings, and where the robot writes them. */
    struct Shelves {
        Shelf recordings;
        Shelf flights_beside;
        Shelf flights;
        Shelf maps;
    };
    /* The board and the shelves must outlive it. */
    Archive(const Board &board, const Shelves &shelves) : board_(board), shelves_(shelves)
    {
    }

    /* making: a recording that is being made, which is not listed. */
    Contents recordings(const std::string &making);
    /* One that lies in both folders is listed once. */
    Contents flights();
    Contents maps();

    /* Nothing: there is no such thing. Throws std::runtime_error in words for people. */
    std::optional<Content> fetch(const Wanted &wanted);

    /* For looking at; one for all who look at the same. name: with its ending. Throws as fetch(); also where
     * there is none, or eight are looked at. A flight takes as long as its replay, a name one thread at a
     * time. */
    std::shared_ptr<const OpenRecording> open(const std::string &name);
    static bool is_flight(const std::string &name);

    /* Replays that are under way end, with words. */
    void stop_replays()
    {
        stopping_ = true;
    }

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
    struct Drawn {
        std::shared_ptr<const ale_map_t> map; /* nullptr: there is none */
        ale::ScanCloud seen = ale::ScanCloud();
        ale::Trajectory way = {};
    };
    template <class Describe>
    void list(Contents &contents, const Shelf &shelf, const std::string &left_out, Describe describe);
    Descriptor open_file(const std::string &name) const;
    std::shared_ptr<const OpenRecording> known(const std::string &name, int64_t changed_ns);
    std::shared_ptr<const OpenRecording> replay(const Descriptor &file, const std::string &name) const;
    std::optional<Content> recording(const Wanted &wanted) const;
    Drawn drawn(const Wanted &wanted);
    std::optional<Content> map(const Wanted &wanted);
    std::shared_ptr<const ale_map_t> saved_map(const std::string &name) const;

    const Board &board_;
    const Shelves &shelves_;
    std::mutex listing_;
    std::map<std::string, Known> known_; /* by folder and name; who lists has it */
    std::mutex opening_;
    std::map<std::string, Opened> opened_; /* by name */
    std::atomic<bool> stopping_{false};
};

} // namespace console

#endif
