#include "operator/console/recordings/damage_words.h"

#include <cstdio>

namespace console
{

namespace
{

std::string bytes_in_words(uint64_t bytes)
{
    constexpr double kilo = 1000;
    char words[32];
    if (static_cast<double>(bytes) < kilo) {
        std::snprintf(words, sizeof words, "%llu bytes", static_cast<unsigned long long>(bytes));
    } else if (static_cast<double>(bytes) < kilo * kilo) {
        std::snprintf(words, sizeof words, "%.1f kB", static_cast<double>(bytes) / kilo);
    } else {
        std::snprintf(words, sizeof words, "%.1f MB", static_cast<double>(bytes) / kilo / kilo);
    }
    return words;
}

} // namespace

std::string damage_words(const Damage &damage)
{
    if (damage.places == 0) {
        return "";
    }
    const std::string places = std::to_string(damage.places) + (damage.places == 1 ? " damaged place" : " damaged places");
    return places + (damage.bytes > 0 ? ", " + bytes_in_words(damage.bytes) + "," : "") + " left out";
}

} // namespace console
