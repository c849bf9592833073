/* The messages between ale-console and its page: JSON, one object each; README.md lists the fields.
 * Metres, radians and microseconds, rounded to what an eye or a map can use (0.1 mm, 0.1 mrad). */
#ifndef CONSOLE_MESSAGES_H
#define CONSOLE_MESSAGES_H

#include <cstdint>
#include <optional>
#include <string>

#include "ale/features_t.hpp"
#include "ale/map_t.hpp"
#include "ale/pose_t.hpp"
#include "ale/scan_t.hpp"
#include "ale/status_t.hpp"
#include "console/board.h"

namespace console
{

std::string hello_message();
std::string pose_message(const ale::pose_t &pose);
std::string features_message(const ale::features_t &features);
std::string scan_message(const ale::scan_t &scan);
std::string map_message(const ale::map_t &map);
std::string status_message(const ale::status_t &status);
std::string trail_message(const TrailPiece &piece);
std::string link_message(const LinkHealth &link, uint64_t skipped);

/* The count of {"type":"got","count":n} from a page; nothing when the text is anything else. */
std::optional<uint64_t> drawn_count(const std::string &text);

} // namespace console

#endif
