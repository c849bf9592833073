#include "lab/merge/kept_building.h"

#include <algorithm>
#include <cerrno>
#include <cinttypes>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <regex>
#include <set>
#include <stdexcept>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "common/export/formatted.h"
#include "lab/merge/read_drive.h"
#include "lab/merge/results.h"
#include "lab/merge/whole_text.h"

extern "C" {
#include "store/map_file.h"
}

namespace merge
{

namespace
{

namespace fs = std::filesystem;

/* One merge at a time writes into a folder. */
class Lock
{
  public:
    explicit Lock(const std::string &folder)
        : descriptor_(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC))
    {
        if (descriptor_ < 0 || flock(descriptor_, LOCK_EX) < 0) {
            throw std::runtime_error(folder + ": " + std::strerror(errno));
        }
    }
    ~Lock()
    {
        close(descriptor_);
    }
    Lock(const Lock &) = delete;
    Lock &operator=(const Lock &) = delete;

  private:
    int descriptor_;
};

std::unique_ptr<ale_map_t> loaded(const std::string &path)
{
    auto map = std::make_unique<ale_map_t>();
    char error[ALE_MAP_FILE_ERROR];
    if (ale_map_file_load(path.c_str(), map.get(), error) < 0) {
        throw std::runtime_error(error);
    }
    return map;
}

/* Of the files that are called so. */
void remove_others(const fs::path &folder, const std::regex &ours, const std::set<std::string> &wanted)
{
    std::error_code unknown;
    for (const fs::directory_entry &entry : fs::directory_iterator(folder, unknown)) {
        const std::string name = entry.path().filename();
        if (std::regex_match(name, ours) && wanted.count(name) == 0) {
            fs::remove(entry.path(), unknown);
        }
    }
}

} // namespace

KeptBuilding::KeptBuilding(const std::string &path)
    : path_(path), folder_(path + ".d"), history_(read_history(folder_ + "/versions"))
{
    check_map();
}

std::string KeptBuilding::file(uint32_t version, const char *ending) const
{
    return folder_ + ale::formatted("/%04" PRIu32 "%s", version, ending);
}

std::string KeptBuilding::log_file(uint32_t checksum, const char *ending) const
{
    return folder_ + ale::formatted("/drives/%08" PRIx32 "%s", checksum, ending);
}

std::string KeptBuilding::picture() const
{
    return file(newest(), ".png");
}

/* The map is that of the newest version, or, where a merge was interrupted, the one before or not there. */
void KeptBuilding::check_map() const
{
    const bool is_there = fs::exists(path_);
    if (fs::is_symlink(path_)) {
        throw std::runtime_error(path_ + ": a symbolic link, which is not followed");
    }
    if (history_.versions.empty()) {
        if (is_there) {
            throw std::runtime_error(path_ + ": no drives are kept for it in " + folder_ +
                                     ": begin a new file with the logs that it was made of");
        }
        return;
    }
    const uint32_t checksum = is_there ? checksum_of_file(path_) : 0;
    const auto is_version = [&](size_t back) {
        const size_t count = history_.versions.size();
        return back < count && history_.versions[count - 1 - back].map_checksum == checksum;
    };
    if (is_there && is_version(0)) {
        return;
    }
    if (is_there && !is_version(1)) {
        throw std::runtime_error(path_ + ": is not the map of version " + std::to_string(newest()) +
                                 ": another program has written it; that map is " + file(newest(), ".map"));
    }
    put_in_place();
}

void KeptBuilding::put_in_place() const
{
    write_whole(path_, read_whole(file(newest(), ".map")));
}

std::unique_ptr<ale_map_t> KeptBuilding::map() const
{
    return history_.versions.empty() ? std::make_unique<ale_map_t>() : loaded(file(newest(), ".map"));
}

std::unique_ptr<ale_map_t> KeptBuilding::earlier() const
{
    const std::string path = file(newest(), ".earlier.map");
    return fs::exists(path) ? loaded(path) : nullptr;
}

ScanPlaces KeptBuilding::places() const
{
    if (history_.versions.empty()) {
        return {};
    }
    const std::string path = file(newest(), ".places.gz");
    try {
        return places_from(read_whole(path));
    } catch (const std::runtime_error &wrong) {
        throw std::runtime_error(std::string(wrong.what()).find(path) == 0 ? wrong.what()
                                                                           : path + ": " + wrong.what());
    }
}

std::vector<Drive> KeptBuilding::read_drives() const
{
    const ScanPlaces all = places();
    std::vector<Drive> drives;
    for (const KnownDrive &known : history_.drives) {
        if (!known.is_kept) {
            continue;
        }
        const std::string path = log_file(known.checksum, ".gz");
        ale::RobotOptions robot;
        robot.config = known.has_config ? log_file(known.checksum, ".ini") : "";
        robot.use_odometry = known.use_odometry;
        const auto places = all.find(known.checksum);
        const std::vector<ScanPlace> nowhere;
        drives.push_back(read_drive(path, robot, places == all.end() ? &nowhere : &places->second));
        if (drives.back().checksum != known.checksum) {
            throw std::runtime_error(path + ": damaged");
        }
        drives.back().name = known.name;
        drives.back().date_s = known.date_s;
    }
    std::stable_sort(drives.begin(), drives.end(), is_earlier);
    return drives;
}

void KeptBuilding::write_files(const NextVersion &next, uint32_t number) const
{
    for (const NewDrive &drive : next.drives) {
        if (next.places.count(drive.known.checksum) == 0) {
            continue;
        }
        write_whole(log_file(drive.known.checksum, ".gz"), packed(read_whole(drive.log, Damage::cut_off)));
        if (!drive.config.empty()) {
            write_whole(log_file(drive.known.checksum, ".ini"), read_whole(drive.config));
        }
    }
    save_map(file(number, ".map"), *next.map);
    if (next.earlier) {
        save_map(file(number, ".earlier.map"), *next.earlier);
    }
    ale::write_map_image(file(number, ".png"), next.picture);
    write_whole(file(number, ".places.gz"), packed(text_of(next.places)));
}

void KeptBuilding::commit(const NextVersion &next)
{
    fs::create_directories(folder_ + "/drives");
    const Lock lock(folder_);
    const std::string versions = folder_ + "/versions";
    const uint32_t number = newest() + 1;
    if (const History now = read_history(versions);
        !now.versions.empty() && now.versions.back().number >= number) {
        throw std::runtime_error(path_ + ": another ale-merge has made version " +
                                 std::to_string(now.versions.back().number) + " meanwhile: try again");
    }
    write_files(next, number);
    History history = history_;
    history.versions.push_back(next.lengths);
    Version &version = history.versions.back();
    version.number = number;
    version.made_s = std::time(nullptr);
    version.map_checksum = checksum_of_file(file(number, ".map"));
    for (const NewDrive &drive : next.drives) {
        history.drives.push_back(drive.known);
        history.drives.back().version = number;
    }
    for (KnownDrive &drive : history.drives) {
        drive.is_kept = next.places.count(drive.checksum) != 0;
    }
    forget_old_versions(&history);
    write_history(versions, history);
    history_ = history;
    put_in_place();
    remove_superseded();
}

/* A file that cannot be removed costs nothing but room. */
void KeptBuilding::remove_superseded() const
{
    std::set<std::string> wanted;
    for (const Version &version : history_.versions) {
        for (const char *ending : {".map", ".png"}) {
            wanted.insert(fs::path(file(version.number, ending)).filename());
        }
    }
    for (const char *ending : {".places.gz", ".earlier.map"}) {
        wanted.insert(fs::path(file(newest(), ending)).filename());
    }
    remove_others(folder_, std::regex("[0-9]{4,}\\.(map|png|places\\.gz|earlier\\.map)(\\.new)?"), wanted);
    std::set<std::string> logs;
    for (const KnownDrive &drive : history_.drives) {
        for (const char *ending : {".gz", ".ini"}) {
            if (drive.is_kept) {
                logs.insert(fs::path(log_file(drive.checksum, ending)).filename());
            }
        }
    }
    remove_others(folder_ + "/drives", std::regex("[0-9a-f]{8}\\.(gz|ini)(\\.new)?"), logs);
}

} // namespace merge
