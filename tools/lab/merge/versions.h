/* What a kept building has been through: its versions and the drives that they came of, as a file.
 *
 *   ALE-SLAM building 1
 *   # version: number made_s map_crc walls_mm added_mm moved_mm gone_mm
 *   version 2 1764130205 9f3c01aa 61210 0 2180 410
 *   # drive: crc date_s version kept odometry config name
 *   drive 1c0d77e2 1700086400 2 1 1 0 tuesday.log
 *   end 2 55aa01fe
 *
 * Seconds since 1970. The last line counts versions and drives and holds the CRC-32 (zlib's) of all lines
 * before it. Lines with # are for people. */
#ifndef ALE_LAB_MERGE_VERSIONS_H
#define ALE_LAB_MERGE_VERSIONS_H

#include <cstdint>
#include <string>
#include <vector>

namespace merge
{

struct Version {
    uint32_t number; /* from 1 */
    int64_t made_s;
    uint32_t map_checksum; /* CRC-32 of the map file */
    int64_t walls_mm;      /* length of all walls */
    int64_t added_mm;      /* and of those that were not as in the version before: see map_changes.h */
    int64_t moved_mm;
    int64_t gone_mm;
};

struct KnownDrive {
    uint32_t checksum; /* of its log, unpacked */
    int64_t date_s;
    uint32_t version;  /* that it came with */
    bool is_kept;      /* its log; else only what it has shown */
    bool use_odometry; /* as it was read */
    bool has_config;
    std::string name;
};

struct History {
    std::vector<Version> versions; /* the newest last; none: nothing is there yet */
    std::vector<KnownDrive> drives;

    const KnownDrive *find(uint32_t checksum) const;
};

/* Versions beyond the newest are forgotten, with their maps, pictures and the names of drives that are not
 * kept. */
constexpr size_t most_versions = 100;
void forget_old_versions(History *history);

/* Throws std::runtime_error with one line: not readable, damaged. A file that is not there: nothing yet. */
History read_history(const std::string &path);

/* Whole or not at all. Throws std::runtime_error. */
void write_history(const std::string &path, const History &history);

/* For people: one version, "version 2: new 0.1 m, ...", and a table with a line for each. */
std::string words_of(const Version &version);
std::string table_of(const History &history);

} // namespace merge

#endif
