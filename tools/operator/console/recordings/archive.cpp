#include "operator/console/recordings/archive.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include <sys/stat.h>

#include "common/feed/core_types.h"
#include "operator/console/recordings/map_copy.h"

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

constexpr size_t most_opened = 8; /* some fifty megabytes of memory each, if they are long */

int64_t change_of(const Descriptor &file)
{
    struct stat status;
    return fstat(file.number(), &status) == 0 ? status.st_mtim.tv_sec * 1000000000 + status.st_mtim.tv_nsec
                                              : 0;
}

} // namespace

template <class Describe>
Contents Archive::list(const Shelf &shelf, const std::string &left_out, Describe describe)
{
    Contents contents;
    contents.folder = shelf.folder();
    if (!shelf.is_there()) {
        return contents;
    }
    std::vector<Listed> files;
    try {
        files = shelf.list();
    } catch (const std::runtime_error &error) {
        contents.trouble = error.what();
    }
    for (const Listed &file : files) {
        if (file.name == left_out) {
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
    return contents;
}

Contents Archive::recordings(const std::string &making)
{
    return list(recordings_, making, [this](Piece &piece, const std::string &name) {
        try {
            const RecordingSummary summary = summary_of(recordings_.open(name));
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
}

Contents Archive::maps()
{
    return list(maps_, "", [this](Piece &piece, const std::string &name) {
        try {
            describe_map(piece, *saved_map(name));
        } catch (const std::runtime_error &) {
            /* as above */
        }
    });
}

std::shared_ptr<const ale_map_t> Archive::saved_map(const std::string &name) const
{
    auto map = std::make_shared<ale_map_t>();
    char error[ALE_MAP_FILE_ERROR];
    if (ale_map_file_load(full_name(maps_.folder(), name).c_str(), map.get(), error) < 0) {
        throw std::runtime_error(error);
    }
    return map;
}

std::optional<Content> Archive::recording(const Wanted &wanted) const
{
    Descriptor file = recordings_.open(wanted.file_name());
    if (file.number() < 0) {
        return std::nullopt;
    }
    const uint64_t bytes = size_of(file);
    return Content{std::move(file), {}, bytes};
}

std::optional<Content> Archive::map(const Wanted &wanted) const
{
    ale::MapScene scene;
    std::shared_ptr<const ale_map_t> map;
    if (wanted.kind == Wanted::Kind::live_map) {
        map = board_.map();
        scene.trajectory = way_of(board_.trail(0, 0, SIZE_MAX).points);
    } else if (wanted.kind == Wanted::Kind::recorded_map) {
        const Descriptor file = recordings_.open(wanted.stem + ".lcm");
        map = file.number() < 0 ? nullptr : summary_of(file).map;
    } else if (maps_.open(wanted.stem + ".map").number() >= 0) {
        map = saved_map(wanted.stem + ".map");
    }
    if (!map) {
        return std::nullopt;
    }
    scene.map = map.get();
    return text_of(map_copy(scene, wanted.stem, wanted.ending));
}

std::shared_ptr<const OpenRecording> Archive::open(const std::string &stem)
{
    Descriptor file = recordings_.open(stem + ".lcm");
    if (file.number() < 0) {
        throw std::runtime_error("there is no recording of that name");
    }
    for (auto entry = opened_.begin(); entry != opened_.end();) {
        entry = entry->second.recording.expired() ? opened_.erase(entry) : std::next(entry);
    }
    const int64_t changed_ns = change_of(file);
    const auto known = opened_.find(stem);
    auto recording = known != opened_.end() && known->second.changed_ns == changed_ns
                         ? known->second.recording.lock()
                         : nullptr;
    if (!recording) {
        if (opened_.size() >= most_opened) {
            throw std::runtime_error("too many recordings are looked at: close one of the others");
        }
        recording = std::make_shared<const OpenRecording>(std::move(file));
        opened_[stem] = {changed_ns, recording};
    }
    return recording;
}

std::optional<Content> Archive::fetch(const Wanted &wanted) const
{
    return wanted.kind == Wanted::Kind::recording ? recording(wanted) : map(wanted);
}

} // namespace console
