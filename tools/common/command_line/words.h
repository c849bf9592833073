/* Words of a command line as values; what they cannot be is WrongUse that names word and range. */
#ifndef ALE_COMMON_COMMAND_LINE_WORDS_H
#define ALE_COMMON_COMMAND_LINE_WORDS_H

#include <array>
#include <charconv>
#include <sstream>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "common/command_line/wrong_use.h"

namespace cli
{

/* A whole number for integers, any for floating point; both ends belong to the range. what: "--seconds". */
template <class Number>
Number number_of(const std::string &what, const std::string &word, Number low, Number high)
{
    Number value{};
    const char *end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, value);
    if (error != std::errc() || stop != end || !(value >= low && value <= high)) {
        std::ostringstream message;
        message << what << " " << word << ": expected a " << (std::is_integral_v<Number> ? "whole " : "")
                << "number from " << low << " to " << high;
        throw WrongUse(message.str());
    }
    return value;
}

template <class Value> using Choices = std::vector<std::pair<std::string, Value>>;

template <class Value>
Value choice_of(const std::string &what, const std::string &word, const Choices<Value> &choices)
{
    std::string names;
    for (const auto &[name, value] : choices) {
        if (name == word) {
            return value;
        }
        names += (names.empty() ? "" : ", ") + name;
    }
    throw WrongUse(what + " " + word + ": there are " + names);
}

/* Three words with commas between them; titles: "X,Y,THETA". */
std::array<std::string, 3> three_of(const std::string &what, const std::string &word,
                                    const std::string &titles);

struct Mounting {
    double x_m;
    double y_m;
    double theta_rad;
};

/* "X,Y,THETA" in metres and radians: at most 100 m, or what is given, and half a turn. */
Mounting mounting_of(const std::string &what, const std::string &word, double most_m = 100);

} // namespace cli

#endif
