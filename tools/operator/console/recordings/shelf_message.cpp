#include "operator/console/recordings/shelf_message.h"

#include <nlohmann/json.hpp>

namespace console
{

namespace
{

using nlohmann::json;

json text_or_null(const std::string &text)
{
    return text.empty() ? json(nullptr) : json(text);
}

json contents_of(const Contents &contents)
{
    json pieces = json::array();
    for (const Piece &piece : contents.pieces) {
        pieces.push_back({{"name", piece.name},
                          {"at", piece.at_ms},
                          {"length_ms", piece.length_ms},
                          {"bytes", piece.bytes},
                          {"scans", piece.has_scans},
                          {"walls", piece.walls < 0 ? json(nullptr) : json(piece.walls)},
                          {"reason", text_or_null(piece.reason)},
                          {"drawing", piece.thumbnail}});
    }
    return {{"folder", text_or_null(contents.folder)},
            {"trouble", text_or_null(contents.trouble)},
            {"pieces", pieces},
            {"more", contents.more}};
}

} // namespace

std::string shelf_message(const Contents &recordings, const Contents &flights, const Contents &maps,
                          const std::string &refusal)
{
    const json message = {{"type", "shelf"},
                          {"recordings", contents_of(recordings)},
                          {"flights", contents_of(flights)},
                          {"maps", contents_of(maps)},
                          {"refusal", text_or_null(refusal)}};
    return message.dump(-1, ' ', false, json::error_handler_t::replace);
}

} // namespace console
