// SCIP bytes made by hand for the tests, and a parser run over them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

extern "C" {
#include "scanner/urg/scip_encode.h"
#include "scanner/urg/scip_parse.h"
}

namespace ale_test
{

// An event with its pointers' contents kept.
struct Parsed {
    ale_scip_event_t event;
    std::vector<int32_t> values;
    std::string text;
};

inline std::vector<Parsed> parse_into(ale_scip_parser_t &parser, const std::string &bytes,
                                      int64_t arrival_us = 0)
{
    std::vector<Parsed> out;
    const auto *at = reinterpret_cast<const uint8_t *>(bytes.data());
    size_t count = bytes.size();
    while (count > 0) {
        Parsed p{};
        const size_t used = ale_scip_parse(&parser, at, count, arrival_us, &p.event);
        at += used;
        count -= used;
        if (p.event.kind == ALE_SCIP_NONE) {
            break;
        }
        if (p.event.values != nullptr) {
            p.values.assign(p.event.values, p.event.values + p.event.value_count);
        }
        if (p.event.text != nullptr) {
            p.text = p.event.text;
        }
        out.push_back(p);
    }
    return out;
}

inline std::vector<Parsed> parse(const std::string &bytes)
{
    static ale_scip_parser_t parser;
    ale_scip_parser_init(&parser);
    return parse_into(parser, bytes);
}

// What a writer function puts, as text.
template <typename Put> std::string written(Put put)
{
    std::vector<uint8_t> bytes(8192);
    ale_scip_writer_t out = {bytes.data(), bytes.size(), 0, false};
    put(&out);
    return {bytes.begin(), bytes.begin() + static_cast<long>(out.used)};
}

inline std::string frame(const std::string &echo, const std::string &status, uint32_t stamp_ms,
                         const std::vector<int32_t> &values, unsigned characters)
{
    return written([&](ale_scip_writer_t *out) {
        ale_scip_put_echo(out, echo.c_str());
        ale_scip_put_status(out, status.c_str());
        ale_scip_put_stamp(out, stamp_ms);
        ale_scip_put_values(out, ALE_SCIP_2, values.data(), static_cast<uint32_t>(values.size()), characters);
        ale_scip_put_end(out);
    });
}

} // namespace ale_test
