#include "lab/merge/versions.h"

#include <algorithm>
#include <array>
#include <cinttypes>
#include <ctime>
#include <filesystem>
#include <stdexcept>

#include "common/export/formatted.h"
#include "lab/merge/whole_text.h"

extern "C" {
#include "file/text.h"
}

namespace merge
{

namespace
{

constexpr char head[] = "ALE-SLAM building 1";

std::string shown_name(std::string name)
{
    std::replace_if(
        name.begin(), name.end(), [](unsigned char c) { return c < ' ' || c == 0x7f; }, '?');
    return name;
}

std::string printed(const Version &v)
{
    return ale::formatted("version %" PRIu32 " %" PRId64 " %08" PRIx32 " %" PRId64 " %" PRId64 " %" PRId64
                          " %" PRId64 "\n",
                          v.number, v.made_s, v.map_checksum, v.walls_mm, v.added_mm, v.moved_mm, v.gone_mm);
}

std::string printed(const KnownDrive &d)
{
    return ale::formatted("drive %08" PRIx32 " %" PRId64 " %" PRIu32 " %d %d %d ", d.checksum, d.date_s,
                          d.version, d.is_kept, d.use_odometry, d.has_config) +
           shown_name(d.name) + "\n";
}

std::string last_line(const History &history, std::string_view before)
{
    return ale::formatted("end %zu %08" PRIx32 "\n", history.versions.size() + history.drives.size(),
                          checksum_of(before));
}

std::string text_of(const History &history)
{
    std::string text =
        std::string(head) + "\n# version: number made_s map_crc walls_mm added_mm moved_mm gone_mm\n";
    for (const Version &version : history.versions) {
        text += printed(version);
    }
    text += "# drive: crc date_s version kept odometry config name\n";
    for (const KnownDrive &drive : history.drives) {
        text += printed(drive);
    }
    return text + last_line(history, text);
}

/* Words of a line that the checksum vouches for: what they say was written here. */
int64_t take_number(ale_span_t *line)
{
    ale_span_t word;
    int64_t number = 0;
    if (!ale_text_word(line, &word) || !ale_text_decimal(word, 0, &number)) {
        throw std::runtime_error("no number");
    }
    return number;
}

uint32_t take_checksum(ale_span_t *line)
{
    ale_span_t word;
    if (!ale_text_word(line, &word)) {
        throw std::runtime_error("no checksum");
    }
    return static_cast<uint32_t>(std::stoul(std::string(word.at, word.end), nullptr, 16));
}

Version version_of(ale_span_t line)
{
    Version version{};
    version.number = static_cast<uint32_t>(take_number(&line));
    version.made_s = take_number(&line);
    version.map_checksum = take_checksum(&line);
    for (int64_t *mm : {&version.walls_mm, &version.added_mm, &version.moved_mm, &version.gone_mm}) {
        *mm = take_number(&line);
    }
    return version;
}

KnownDrive drive_of(ale_span_t line)
{
    KnownDrive drive{};
    drive.checksum = take_checksum(&line);
    drive.date_s = take_number(&line);
    drive.version = static_cast<uint32_t>(take_number(&line));
    for (bool *is : {&drive.is_kept, &drive.use_odometry, &drive.has_config}) {
        *is = take_number(&line) != 0;
    }
    drive.name = line.at < line.end ? std::string(line.at + 1, line.end) : "";
    return drive;
}

History parsed(const std::string &bytes)
{
    History history;
    ale_text_t text = ale_text(bytes.data(), bytes.size());
    ale_span_t line;
    if (!ale_text_line(&text, &line) || !ale_text_is(line, head)) {
        throw std::runtime_error("not a building of version 1");
    }
    while (ale_text_line(&text, &line)) {
        const std::string_view before(bytes.data(), static_cast<size_t>(line.at - bytes.data()));
        ale_span_t word;
        if (!ale_text_word(&line, &word) || *word.at == '#') {
            continue;
        }
        if (ale_text_is(word, "version")) {
            history.versions.push_back(version_of(line));
        } else if (ale_text_is(word, "drive")) {
            history.drives.push_back(drive_of(line));
        } else if (bytes == std::string(before) + last_line(history, before) && !history.versions.empty()) {
            return history;
        } else {
            break;
        }
    }
    throw std::runtime_error("damaged");
}

std::string moment(int64_t seconds)
{
    const std::time_t time = seconds;
    std::tm parts{};
    std::array<char, 32> text{};
    gmtime_r(&time, &parts);
    std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
    return text.data();
}

double metres(int64_t mm)
{
    return static_cast<double>(mm) * 1e-3;
}

} // namespace

const KnownDrive *History::find(uint32_t checksum) const
{
    const auto found = std::find_if(drives.begin(), drives.end(), [checksum](const KnownDrive &drive) {
        return drive.checksum == checksum;
    });
    return found == drives.end() ? nullptr : &*found;
}

void forget_old_versions(History *history)
{
    std::vector<Version> &versions = history->versions;
    if (versions.size() <= most_versions) {
        return;
    }
    versions.erase(versions.begin(), versions.end() - static_cast<std::ptrdiff_t>(most_versions));
    std::vector<KnownDrive> &drives = history->drives;
    const auto is_forgotten = [&](const KnownDrive &drive) {
        return !drive.is_kept && drive.version < versions.front().number;
    };
    drives.erase(std::remove_if(drives.begin(), drives.end(), is_forgotten), drives.end());
}

History read_history(const std::string &path)
{
    if (!std::filesystem::exists(path)) {
        return {};
    }
    const std::string bytes = read_whole(path);
    try {
        return parsed(bytes);
    } catch (const std::exception &wrong) {
        throw std::runtime_error(path + ": " + wrong.what());
    }
}

void write_history(const std::string &path, const History &history)
{
    write_whole(path, text_of(history));
}

std::string words_of(const Version &v)
{
    return ale::formatted("version %" PRIu32 ": new %.1f m, moved %.1f m, gone %.1f m of %.1f m of walls",
                          v.number, metres(v.added_mm), metres(v.moved_mm), metres(v.gone_mm),
                          metres(v.walls_mm));
}

std::string table_of(const History &history)
{
    std::string table = "version  made                  walls m    new m  moved m   gone m  drives\n";
    for (const Version &v : history.versions) {
        table +=
            ale::formatted("%7" PRIu32 "  %s %8.1f %8.1f %8.1f %8.1f ", v.number, moment(v.made_s).c_str(),
                           metres(v.walls_mm), metres(v.added_mm), metres(v.moved_mm), metres(v.gone_mm));
        for (const KnownDrive &drive : history.drives) {
            table += drive.version == v.number ? " " + drive.name : "";
        }
        table += "\n";
    }
    return table;
}

} // namespace merge
