/* Logs made in memory, and the events they yield. */
#ifndef ALE_TESTS_LOG_TEXT_HPP
#define ALE_TESTS_LOG_TEXT_HPP

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <bzlib.h>
#include <zlib.h>

extern "C" {
#include "log/log.h"
}

namespace ale_test
{

struct Read {
    std::vector<ale_log_event_t> events; /* their `text` is in `texts` */
    std::vector<std::string> texts;
    ale_log_info_t info{};
    ale_log_statistics_t statistics{};
    std::string last_error;

    std::vector<ale_scan_t> scans() const
    {
        std::vector<ale_scan_t> out;
        for (const ale_log_event_t &event : events) {
            if (event.kind == ALE_LOG_SCAN) {
                out.push_back(event.scan);
            }
        }
        return out;
    }
    std::vector<ale_odometry_t> odometry() const
    {
        std::vector<ale_odometry_t> out;
        for (const ale_log_event_t &event : events) {
            if (event.kind == ALE_LOG_ODOMETRY) {
                out.push_back(event.odometry);
            }
        }
        return out;
    }
};

inline Read drain(ale_log_t *log)
{
    Read read;
    const auto event = std::make_unique<ale_log_event_t>();
    while (ale_log_next(log, event.get()) > 0) {
        const bool has_text = event->kind == ALE_LOG_COMMAND || event->kind == ALE_LOG_CONFIG;
        read.texts.emplace_back(has_text ? event->text : "");
        read.events.push_back(*event);
    }
    read.info = *ale_log_info(log);
    read.statistics = ale_log_statistics(log);
    read.last_error = ale_log_last_error(log);
    ale_log_close(log);
    return read;
}

/* Throws std::runtime_error with the message of the log when it cannot be opened. */
inline Read read_bytes(const std::string &bytes)
{
    ale_log_t *log = nullptr;
    ale_log_error_t error{};
    if (ale_log_open_memory(&log, reinterpret_cast<const uint8_t *>(bytes.data()), bytes.size(), &error) <
        0) {
        throw std::runtime_error(error.message);
    }
    return drain(log);
}

inline Read read_file(const std::string &path)
{
    ale_log_t *log = nullptr;
    ale_log_error_t error{};
    if (ale_log_open(&log, path.c_str(), &error) < 0) {
        throw std::runtime_error(error.message);
    }
    return drain(log);
}

inline std::string error_of(const std::string &bytes)
{
    try {
        read_bytes(bytes);
        return "";
    } catch (const std::runtime_error &error) {
        return error.what();
    }
}

/* `word` n times, a blank before each. */
inline std::string repeated(const std::string &word, int n)
{
    std::string out;
    for (int i = 0; i < n; i++) {
        out += " " + word;
    }
    return out;
}

inline std::string gzip(const std::string &plain)
{
    z_stream stream{};
    deflateInit2(&stream, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY);
    std::string out(deflateBound(&stream, plain.size()) + 64, '\0');
    stream.next_in = reinterpret_cast<Bytef *>(const_cast<char *>(plain.data()));
    stream.avail_in = static_cast<uInt>(plain.size());
    stream.next_out = reinterpret_cast<Bytef *>(out.data());
    stream.avail_out = static_cast<uInt>(out.size());
    deflate(&stream, Z_FINISH);
    out.resize(stream.total_out);
    deflateEnd(&stream);
    return out;
}

inline std::string bzip2(const std::string &plain)
{
    std::string out(plain.size() + plain.size() / 100 + 700, '\0');
    auto size = static_cast<unsigned>(out.size());
    BZ2_bzBuffToBuffCompress(out.data(), &size, const_cast<char *>(plain.data()),
                             static_cast<unsigned>(plain.size()), 1, 0, 0);
    out.resize(size);
    return out;
}

} // namespace ale_test

#endif
