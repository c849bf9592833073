#include "operator/console/recordings/flight_summary.h"

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <vector>

#include <sys/stat.h>
#include <unistd.h>

extern "C" {
#include "store/recording.h"
}

namespace console
{

namespace
{

constexpr size_t looked_at = size_t{1} << 18;

std::vector<uint8_t> bytes_at(const Descriptor &file, off_t at)
{
    std::vector<uint8_t> bytes(looked_at);
    const ssize_t count = pread(file.number(), bytes.data(), bytes.size(), at);
    bytes.resize(static_cast<size_t>(std::max<ssize_t>(count, 0)));
    return bytes;
}

/* Takes the stamps of what passed on the line: what else there is may have none. */
template <class Take> void for_line(const std::vector<uint8_t> &bytes, const Take &take)
{
    ale_chunk_reader_t reader = ale_chunk_reader(bytes.data(), bytes.size());
    ale_chunk_t chunk;
    while (ale_chunk_next(&reader, &chunk)) {
        if (chunk.kind == ALE_CHUNK_RECEIVED || chunk.kind == ALE_CHUNK_SENT) {
            take(chunk.stamp_us);
        }
    }
}

/* flight-NUMBER-TIME-REASON.scip */
void read_name(const std::string &name, FlightSummary &summary)
{
    std::tm time{};
    int ms = 0;
    char reason[16] = "";
    const int found =
        std::sscanf(name.c_str(), "flight-%*8d-%4d%2d%2dT%2d%2d%2d.%3dZ-%15[a-z].scip", &time.tm_year,
                    &time.tm_mon, &time.tm_mday, &time.tm_hour, &time.tm_min, &time.tm_sec, &ms, reason);
    constexpr int all = 8;
    if (found == all) {
        time.tm_year -= 1900;
        time.tm_mon -= 1;
        summary.written_ms = static_cast<int64_t>(timegm(&time)) * 1000 + ms;
        summary.reason = reason;
    }
}

} // namespace

FlightSummary summary_of_flight(const Descriptor &file, const std::string &name)
{
    FlightSummary summary;
    read_name(name, summary);
    const std::vector<uint8_t> head = bytes_at(file, 0);
    struct stat status;
    if (!ale_recording_claims(head.data(), head.size()) || fstat(file.number(), &status) != 0) {
        return summary;
    }
    for_line(head, [&](int64_t stamp_us) {
        summary.from_us = summary.from_us == 0 ? stamp_us : summary.from_us;
        summary.to_us = stamp_us;
    });
    const off_t tail = status.st_size - static_cast<off_t>(looked_at);
    if (tail > 0) {
        for_line(bytes_at(file, tail), [&](int64_t stamp_us) { summary.to_us = stamp_us; });
    }
    return summary;
}

} // namespace console
