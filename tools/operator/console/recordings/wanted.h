/* What a browser asks for beside the page, by the path of its request:
 *
 *   /recordings/NAME.lcm      a recording
 *   /recordings/NAME.png      its last map (.svg .dxf .geojson; .zip: PGM and YAML)
 *   /flights/NAME.scip        a recording of a scanner's bytes
 *   /flights/NAME.png         its last map
 *   /maps/NAME.png            a saved map
 *   /live/map.png             the map that the robot has now */
#ifndef CONSOLE_WANTED_H
#define CONSOLE_WANTED_H

#include <optional>
#include <string>
#include <string_view>

namespace console
{

struct Wanted {
    enum class Kind {
        recording,
        recorded_map,
        flight,
        flight_map,
        saved_map,
        live_map
    } kind = Kind::live_map;
    std::string stem;   /* NAME, as it came: Shelf says whether it is one */
    std::string ending; /* of what goes out, without the dot */

    std::string file_name() const
    {
        return stem + "." + ending;
    }

    /* The drive is run or read through for it. */
    bool takes_long() const
    {
        return kind == Kind::flight_map || (kind == Kind::recorded_map && ending == "zip");
    }
};

/* Nothing: none of these. */
std::optional<Wanted> wanted_of(std::string_view path);

} // namespace console

#endif
