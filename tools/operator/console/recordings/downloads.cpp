#include "operator/console/recordings/downloads.h"

#include <algorithm>
#include <cstring>
#include <string_view>
#include <vector>

#include <libwebsockets.h>
#include <unistd.h>

namespace console
{

namespace
{

constexpr size_t piece_bytes = size_t{1} << 16;
constexpr int patience_s = 60; /* for a browser that takes nothing */

const char *type_of(const std::string &ending)
{
    return ending == "png"       ? "image/png"
           : ending == "svg"     ? "image/svg+xml"
           : ending == "zip"     ? "application/zip"
           : ending == "geojson" ? "application/geo+json"
                                 : "application/octet-stream";
}

bool add_header(lws *connection, const char *name, std::string_view value, unsigned char **at,
                unsigned char *end)
{
    return lws_add_http_header_by_name(connection, reinterpret_cast<const unsigned char *>(name),
                                       reinterpret_cast<const unsigned char *>(value.data()),
                                       static_cast<int>(value.size()), at, end) == 0;
}

} // namespace

uint64_t Downloads::expect(lws *connection)
{
    UnderWay &download = under_way_[connection] = UnderWay();
    download.ticket = ++tickets_;
    lws_set_timeout(connection, PENDING_TIMEOUT_HTTP_CONTENT, patience_s);
    return download.ticket;
}

Downloads::UnderWay *Downloads::of(uint64_t ticket)
{
    const auto entry = std::find_if(under_way_.begin(), under_way_.end(),
                                    [&](const auto &one) { return one.second.ticket == ticket; });
    if (entry == under_way_.end()) {
        return nullptr; /* gone meanwhile */
    }
    lws_callback_on_writable(entry->first);
    return &entry->second;
}

void Downloads::found(uint64_t ticket, const Wanted &wanted, Content content)
{
    if (UnderWay *download = of(ticket)) {
        download->status = HTTP_STATUS_OK;
        download->name = wanted.file_name();
        download->type = type_of(wanted.ending);
        download->content = std::move(content);
    }
}

void Downloads::missing(uint64_t ticket, unsigned status, const std::string &words)
{
    if (UnderWay *download = of(ticket)) {
        download->status = status;
        download->type = "text/plain; charset=utf-8";
        download->content.text = words + "\n";
        download->content.bytes = download->content.text.size();
    }
}

void Downloads::left(lws *connection)
{
    under_way_.erase(connection);
}

int Downloads::begin(lws *connection, UnderWay &download)
{
    std::vector<unsigned char> buffer(LWS_PRE + 1024);
    unsigned char *start = buffer.data() + LWS_PRE;
    unsigned char *at = start;
    unsigned char *end = buffer.data() + buffer.size();
    download.begun = true;
    const std::string disposition =
        download.name.empty() ? "inline" : "attachment; filename=\"" + download.name + "\"";
    if (lws_add_http_common_headers(connection, download.status, download.type, download.content.bytes, &at,
                                    end) != 0 ||
        !add_header(connection, "content-disposition:", disposition, &at, end) ||
        !add_header(connection, "content-security-policy:", "default-src 'none'; sandbox", &at, end) ||
        !add_header(connection, "x-content-type-options:", "nosniff", &at, end) ||
        !add_header(connection, "referrer-policy:", "no-referrer", &at, end) ||
        !add_header(connection, "cache-control:", "no-store", &at, end) ||
        lws_finalize_write_http_header(connection, start, &at, end) != 0) {
        return -1;
    }
    if (download.content.bytes == 0) {
        under_way_.erase(connection);
        return lws_http_transaction_completed(connection) != 0 ? -1 : 0;
    }
    lws_callback_on_writable(connection);
    return 0;
}

/* A file that has become shorter meanwhile ends the connection: the browser must not take it for whole. */
int Downloads::send_piece(lws *connection, UnderWay &download)
{
    const Content &content = download.content;
    const size_t count = static_cast<size_t>(std::min<uint64_t>(piece_bytes, content.bytes - download.sent));
    std::vector<unsigned char> buffer(LWS_PRE + count);
    unsigned char *piece = buffer.data() + LWS_PRE;
    if (content.file.number() < 0) {
        std::memcpy(piece, content.text.data() + download.sent, count);
    } else if (pread(content.file.number(), piece, count, static_cast<off_t>(download.sent)) !=
               static_cast<ssize_t>(count)) {
        return -1;
    }
    download.sent += count;
    const bool last = download.sent == content.bytes;
    lws_set_timeout(connection, PENDING_TIMEOUT_HTTP_CONTENT, patience_s);
    if (lws_write(connection, piece, count, last ? LWS_WRITE_HTTP_FINAL : LWS_WRITE_HTTP) < 0) {
        return -1;
    }
    if (last) {
        under_way_.erase(connection);
        return lws_http_transaction_completed(connection) != 0 ? -1 : 0;
    }
    lws_callback_on_writable(connection);
    return 0;
}

int Downloads::send_next(lws *connection)
{
    const auto entry = under_way_.find(connection);
    if (entry == under_way_.end() || entry->second.status == 0) {
        return 0;
    }
    UnderWay &download = entry->second;
    return download.begun ? send_piece(connection, download) : begin(connection, download);
}

} // namespace console
