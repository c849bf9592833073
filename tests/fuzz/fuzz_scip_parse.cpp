/* Whatever comes over the serial line: parser, identity and stream. The first byte of an input chooses how
 * the rest is cut into pieces and whether each line gets its right sum, so that the fuzzer comes past the
 * sums. */
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

extern "C" {
#include "scanner/urg/identity.h"
#include "scanner/urg/scip_code.h"
#include "scanner/urg/scip_parse.h"
#include "scanner/urg/urg_stream.h"
}

namespace
{

void require(bool holds)
{
    if (!holds) {
        std::abort();
    }
}

std::string with_sums(const std::string &bytes)
{
    std::string out;
    std::string line;
    for (const char c : bytes) {
        if (c != '\n') {
            line += c;
            continue;
        }
        out += line;
        if (!line.empty() && line[0] != 'M' && line[0] != 'G') {
            out +=
                static_cast<char>(ale_scip_sum(reinterpret_cast<const uint8_t *>(line.data()), line.size()));
        }
        out += '\n';
        line.clear();
    }
    return out;
}

class Reader
{
  public:
    explicit Reader(size_t piece) : piece_(piece)
    {
        ale_scip_parser_init(&parser_);
        ale_urg_identity_init(&identity_);
        ale_urg_stream_init(&stream_, false);
    }
    void read(const std::string &bytes)
    {
        for (size_t at = 0; at < bytes.size(); at += piece_) {
            read_piece(bytes.substr(at, piece_));
        }
        require(ale_scip_counters(&parser_)->bytes == bytes.size());
        require(ale_scip_counters(&parser_)->garbage_bytes <= bytes.size());
    }
    uint64_t events() const
    {
        return events_;
    }

  private:
    ale_scip_parser_t parser_;
    ale_urg_identity_t identity_;
    ale_urg_stream_t stream_;
    size_t piece_;
    uint64_t events_ = 0;
    int64_t now_us_ = 0;

    void read_piece(const std::string &bytes)
    {
        now_us_ += 1000;
        const auto *at = reinterpret_cast<const uint8_t *>(bytes.data());
        for (size_t left = bytes.size(); left > 0;) {
            ale_scip_event_t event;
            const size_t used = ale_scip_parse(&parser_, at, left, now_us_, &event);
            require(used > 0 && used <= left && (event.kind != ALE_SCIP_NONE || used == left));
            at += used;
            left -= used;
            take(event);
        }
    }
    void take(const ale_scip_event_t &event)
    {
        if (event.kind == ALE_SCIP_NONE) {
            return;
        }
        events_ = events_ * 31 + event.kind;
        if (event.kind == ALE_SCIP_LINE_READ) {
            require(event.text[event.text_count] == '\0' && event.text_count <= ALE_SCIP_LINE);
            ale_urg_identity_line(&identity_, event.text, event.sum_right);
        } else if (event.kind == ALE_SCIP_SCAN) {
            require(event.value_count == ale_scip_request_values(&event.request));
            require(event.value_count > 0 && event.value_count <= ALE_MAX_BEAMS);
            for (uint32_t k = 0; k < event.value_count; k++) {
                require(event.values[k] >= 0 && event.values[k] < 1 << 18);
            }
        }
        if (event.kind == ALE_SCIP_SCAN || event.kind == ALE_SCIP_LOST) {
            follow(event);
        }
    }
    void follow(const ale_scip_event_t &event)
    {
        if (ale_urg_geometry_valid(&identity_.geometry)) {
            ale_urg_stream_describe(&stream_, &identity_.geometry, &identity_.played);
        }
        if (event.has_request && !ale_scip_request_same_ranges(&event.request, &stream_.request)) {
            ale_urg_stream_begin(&stream_, &event.request);
        }
        ale_urg_stream_take(&stream_, &event);
        static ale_scan_t scan;
        for (int k = 0; ale_urg_stream_next(&stream_, &scan) != ALE_SCANNER_IDLE; k++) {
            require(k < 64 && scan.beams <= ALE_MAX_BEAMS);
        }
    }
};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size < 1) {
        return 0;
    }
    std::string bytes(data + 1, data + size);
    if ((data[0] & 1U) != 0) {
        bytes = with_sums(bytes);
    }
    Reader pieces(1 + data[0] / 2U);
    Reader whole(bytes.size() + 1);
    pieces.read(bytes);
    whole.read(bytes);
    require(pieces.events() == whole.events());
    return 0;
}
