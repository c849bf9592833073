#include "common/command_line/words.h"

namespace cli
{

std::array<std::string, 3> three_of(const std::string &what, const std::string &word,
                                    const std::string &titles)
{
    const size_t first = word.find(',');
    const size_t second = first == std::string::npos ? first : word.find(',', first + 1);
    if (second == std::string::npos) {
        throw WrongUse(what + " " + word + ": expected " + titles);
    }
    return {word.substr(0, first), word.substr(first + 1, second - first - 1), word.substr(second + 1)};
}

Mounting mounting_of(const std::string &what, const std::string &word, double most_m)
{
    constexpr double most_rad = 3.141592654;
    const auto [x, y, theta] = three_of(what, word, "X,Y,THETA");
    const std::string where = what + " " + word + ":";
    return {number_of(where, x, -most_m, most_m), number_of(where, y, -most_m, most_m),
            number_of(where, theta, -most_rad, most_rad)};
}

} // namespace cli
