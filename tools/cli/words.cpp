#include "cli/words.h"

namespace cli
{

Mounting mounting_of(const std::string &what, const std::string &word)
{
    constexpr double most_m = 100;
    constexpr double most_rad = 3.141592654;
    const size_t first = word.find(',');
    const size_t second = first == std::string::npos ? first : word.find(',', first + 1);
    if (second == std::string::npos) {
        throw WrongUse(what + " " + word + ": expected X,Y,THETA");
    }
    const std::string where = what + " " + word + ":";
    return {number_of(where, word.substr(0, first), -most_m, most_m),
            number_of(where, word.substr(first + 1, second - first - 1), -most_m, most_m),
            number_of(where, word.substr(second + 1), -most_rad, most_rad)};
}

} // namespace cli
