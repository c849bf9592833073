/* What every fuzzer of a log reader does: opens the bytes behind a beginning that leads to its format, and
 * reads to the end. Each scan must keep the promises that the core rests on. */
#ifndef ALE_TESTS_FUZZ_READ_LOG_HPP
#define ALE_TESTS_FUZZ_READ_LOG_HPP

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>

extern "C" {
#include "log/log.h"
}

namespace ale_test
{

inline void require(bool promise)
{
    if (!promise) {
        std::abort();
    }
}

inline void check(const ale_log_event_t &event)
{
    if (event.kind == ALE_LOG_COMMAND || event.kind == ALE_LOG_CONFIG) {
        require(std::strlen(event.text) <= 65536);
    }
    if (event.kind != ALE_LOG_SCAN) {
        return;
    }
    const ale_scan_t &scan = event.scan;
    require(scan.beams <= ALE_MAX_BEAMS && scan.stamp_us == event.stamp_us);
    require(scan.range_max_um > 0 && scan.range_max_um <= ALE_MAX_RANGE_UM);
    for (int k = 0; k < scan.beams; k++) {
        require(scan.flag[k] <= ALE_BEAM_TOO_NEAR);
        require((scan.flag[k] == ALE_BEAM_VALID) == (scan.range_um[k] > 0));
        require(scan.range_um[k] < scan.range_max_um);
    }
}

inline void read_log(const std::string &beginning, const uint8_t *data, size_t size)
{
    const std::string bytes = beginning + std::string(reinterpret_cast<const char *>(data), size);
    ale_log_t *log = nullptr;
    ale_log_error_t error{};
    if (ale_log_open_memory(&log, reinterpret_cast<const uint8_t *>(bytes.data()), bytes.size(), &error) <
        0) {
        require(error.message[0] != '\0' && std::strchr(error.message, '\n') == nullptr);
        return;
    }
    const auto event = std::make_unique<ale_log_event_t>();
    uint64_t scans = 0;
    while (ale_log_next(log, event.get()) > 0) {
        check(*event);
        scans += event->kind == ALE_LOG_SCAN;
    }
    const ale_log_statistics_t statistics = ale_log_statistics(log);
    require(statistics.scans == scans && statistics.bytes_read == statistics.bytes_total);
    ale_log_close(log);
}

/* `count` numbers, a blank after each. */
inline std::string numbers(int count)
{
    std::string line;
    for (int i = 0; i < count; i++) {
        line += "1 ";
    }
    return line;
}

} // namespace ale_test

#endif
