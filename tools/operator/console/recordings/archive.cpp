#include "operator/console/recordings/archive.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include <sys/stat.h>

#include "common/feed/core_types.h"
#include "operator/console/recordings/flight_summary.h"
#include "operator/console/recordings/map_copy.h"
#include "operator/console/recordings/recorded_space.h"
#include "operator/console/recordings/replayed.h"

extern "C" {
#include "store/map_file.h"
}

namespace console
{

namespace
{

std::string stem_of(const std::string &name)
{
    return name.substr(0, name.rfind('.'));
}

void describe_map(Piece &piece, const ale_map_t &map)
{
    piece.walls = map.line_count;
    piece.thumbnail = thumbnail_of(map);
}

uint64_t size_of(const Descriptor &file)
{
    struct stat status;
    return fstat(file.number(), &status) == 0 ? static_cast<uint64_t>(status.st_size) : 0;
}

std::string full_name(const std::string &folder, const std::string &name)
{
    return folder + "/" + name;
}

Content text_of(std::string text)
{
    const uint64_t bytes = text.size();
    return {Descriptor(), std::move(text), bytes};
}

ale::Trajectory way_of(const std::vector<TrailPoint> &points)
{
    ale::Trajectory way;
    std::transform(points.begin(), points.end(), std::back_inserter(way), [](const TrailPoint &point) {
        return ale::StampedPose{0, feed::core_pose(point.x, point.y, 0)};
    });
    return way;
}

bool has(const Contents &contents, const std::string &stem)
{
    return std::any_of(contents.pieces.begin(), contents.pieces.end(),
                       [&](const Piece &piece) { return piece.name == stem; });
}

constexpr char flight_ending[] = ".scip";
constexpr int64_t first_date_ms =
    946684800000;                 /* 2000: before it a clock counts from when it was switched on */
constexpr size_t most_opened = 8; /* some fifty megabytes of memory each, if they are long */

int64_t change_of(const Descriptor &file)
{
    struct stat status;
    return fstat(file.number(), &status) == 0 ? status.st_mtim.tv_sec * 1000000000 + status.st_mtim.tv_nsec
                                              : 0;
}

} // namespace

template <class Describe>
void Archive::list(Contents &contents, const Shelf &shelf, const std::string &left_out, Describe describe)
{
    if (!shelf.is_there()) {
        return;
    }
    const std::lock_guard<std::mutex> lock(listing_);
    contents.folder = shelf.folder();
    std::vector<Listed> files;
    try {
        files = shelf.list();
    } catch (const std::runtime_error &error) {
        contents.trouble = error.what();
    }
    for (const Listed &file : files) {
        if (file.name == left_out || has(contents, stem_of(file.name))) {
            continue;
        }
        if (contents.pieces.size() == most_listed) {
            contents.more++;
            continue;
        }
        Known &known = known_[full_name(shelf.folder(), file.name)];
        if (known.changed_ms != file.changed_ms || known.bytes != file.bytes) {
            known = {file.changed_ms, file.bytes, {}};
            known.piece.name = stem_of(file.name);
            known.piece.at_ms = file.changed_ms;
            known.piece.bytes = file.bytes;
            describe(known.piece, file.name);
        }
        contents.pieces.push_back(known.piece);
    }
}

Contents Archive::recordings(const std::string &making)
{
    Contents contents;
    list(contents, shelves_.recordings, making, [this](Piece &piece, const std::string &name) {
        try {
            const RecordingSummary summary = summary_of(shelves_.recordings.open(name));
            piece.length_ms = (summary.to_us - summary.from_us) / 1000;
            piece.at_ms = summary.from_us != 0 ? summary.from_us / 1000 : piece.at_ms;
            piece.has_scans = summary.has_scans;
            if (summary.map) {
                describe_map(piece, *summary.map);
            }
        } catch (const std::runtime_error &) {
            /* it is listed all the same, with what is known of it */
        }
    });
    return contents;
}

Contents Archive::flights()
{
    Contents contents;
    for (const Shelf *shelf : {&shelves_.flights_beside, &shelves_.flights}) {
        list(contents, *shelf, "", [shelf](Piece &piece, const std::string &name) {
            try {
                const FlightSummary summary = summary_of_flight(shelf->open(name), name);
                piece.length_ms = (summary.to_us - summary.from_us) / 1000;
                piece.at_ms = (summary.written_ms != 0 ? summary.written_ms : piece.at_ms) - piece.length_ms;
                piece.has_scans = true;
                piece.reason = summary.reason;
            } catch (const std::runtime_error &) {
                /* as above */
            }
        });
    }
    return contents;
}

Contents Archive::maps()
{
    Contents contents;
    list(contents, shelves_.maps, "", [this](Piece &piece, const std::string &name) {
        try {
            describe_map(piece, *saved_map(name));
        } catch (const std::runtime_error &) {
            /* as above */
        }
    });
    return contents;
}

std::shared_ptr<const ale_map_t> Archive::saved_map(const std::string &name) const
{
    auto map = std::make_shared<ale_map_t>();
    char error[ALE_MAP_FILE_ERROR];
    if (ale_map_file_load(full_name(shelves_.maps.folder(), name).c_str(), map.get(), error) < 0) {
        throw std::runtime_error(error);
    }
    return map;
}

std::optional<Content> Archive::recording(const Wanted &wanted) const
{
    Descriptor file = open_file(wanted.file_name());
    if (file.number() < 0) {
        return std::nullopt;
    }
    const uint64_t bytes = size_of(file);
    return Content{std::move(file), {}, bytes};
}

/* The map of what is wanted, and what scans saw there where its file says what is free. A map that was saved
 * tells of walls alone. */
Archive::Drawn Archive::drawn(const Wanted &wanted)
{
    const bool cells = wanted.ending == "zip";
    const auto of_log = [cells](const Descriptor &log) {
        return Drawn{summary_of(log).map, cells ? seen_in(log) : ale::ScanCloud()};
    };
    switch (wanted.kind) {
    case Wanted::Kind::live_map:
        return {board_.map(), cells ? board_.seen() : ale::ScanCloud(),
                way_of(board_.trail(0, 0, SIZE_MAX).points)};
    case Wanted::Kind::saved_map: {
        const std::string name = wanted.stem + ".map";
        return {shelves_.maps.open(name).number() < 0 ? nullptr : saved_map(name)};
    }
    case Wanted::Kind::flight_map: {
        const std::string name = wanted.stem + flight_ending;
        return open_file(name).number() < 0 ? Drawn{} : of_log(open(name)->file());
    }
    default: {
        const Descriptor log = shelves_.recordings.open(wanted.stem + ".lcm");
        return log.number() < 0 ? Drawn{} : of_log(log);
    }
    }
}

std::optional<Content> Archive::map(const Wanted &wanted)
{
    const Drawn drawing = drawn(wanted);
    if (!drawing.map) {
        return std::nullopt;
    }
    ale::MapScene scene;
    scene.map = drawing.map.get();
    scene.cloud = &drawing.seen;
    scene.trajectory = drawing.way;
    return text_of(map_copy(scene, wanted.stem, wanted.ending));
}

bool Archive::is_flight(const std::string &name)
{
    const std::string ending = flight_ending;
    return name.size() > ending.size() &&
           name.compare(name.size() - ending.size(), ending.size(), ending) == 0;
}

/* A recording or a flight. None: there is none of that name. */
Descriptor Archive::open_file(const std::string &name) const
{
    if (!is_flight(name)) {
        return shelves_.recordings.open(name);
    }
    Descriptor beside = shelves_.flights_beside.open(name);
    return beside.number() >= 0 ? std::move(beside) : shelves_.flights.open(name);
}

/* nullptr: nobody looks at it yet, and there is room for one more. */
std::shared_ptr<const OpenRecording> Archive::known(const std::string &name, int64_t changed_ns)
{
    const std::lock_guard<std::mutex> lock(opening_);
    for (auto entry = opened_.begin(); entry != opened_.end();) {
        entry = entry->second.recording.expired() ? opened_.erase(entry) : std::next(entry);
    }
    const auto found = opened_.find(name);
    auto recording = found != opened_.end() && found->second.changed_ns == changed_ns
                         ? found->second.recording.lock()
                         : nullptr;
    if (!recording && opened_.size() >= most_opened) {
        throw std::runtime_error("too many recordings are looked at: close one of the others");
    }
    return recording;
}

/* Times of a clock that knows no date are counted from when the file was written. */
std::shared_ptr<const OpenRecording> Archive::replay(const Descriptor &file, const std::string &name) const
{
    Replay made = replayed(file, name, stopping_);
    const int64_t end_ms = summary_of(made.log).to_us / 1000;
    const int64_t named_ms = summary_of_flight(file, name).written_ms;
    const int64_t written_ms = named_ms != 0 ? named_ms : change_of(file) / 1000000;
    return std::make_shared<const OpenRecording>(
        std::move(made.log), end_ms < first_date_ms ? written_ms - end_ms : 0, std::move(made.damage));
}

std::shared_ptr<const OpenRecording> Archive::open(const std::string &name)
{
    Descriptor file = open_file(name);
    if (file.number() < 0) {
        throw std::runtime_error("there is no recording of that name");
    }
    const int64_t changed_ns = change_of(file);
    auto recording = known(name, changed_ns);
    if (!recording) {
        recording =
            is_flight(name) ? replay(file, name) : std::make_shared<const OpenRecording>(std::move(file));
        const std::lock_guard<std::mutex> lock(opening_);
        opened_[name] = {changed_ns, recording};
    }
    return recording;
}

std::optional<Content> Archive::fetch(const Wanted &wanted)
{
    const bool whole = wanted.kind == Wanted::Kind::recording || wanted.kind == Wanted::Kind::flight;
    return whole ? recording(wanted) : map(wanted);
}

} // namespace console
