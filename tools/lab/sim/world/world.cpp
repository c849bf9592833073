#include "lab/sim/world/world.h"

#include <charconv>
#include <sstream>
#include <stdexcept>

extern "C" {
#include "file/bytes.h"
}

namespace sim
{

namespace
{

/* Farther away nothing is meant: a slip of the pen, or millimetres. */
constexpr double largest_coordinate = 10000;
constexpr double shortest_wall = 1e-6;
/* Bytes of a file: a hundred thousand walls. */
constexpr size_t most_bytes = 16 << 20;

[[noreturn]] void fail(const std::string &name, size_t line, const std::string &what)
{
    throw std::runtime_error(name + ":" + std::to_string(line) + ": " + what);
}

std::vector<std::string> split(const std::string &text)
{
    std::istringstream words(text);
    std::vector<std::string> out;
    for (std::string word; words >> word;) {
        out.push_back(word);
    }
    return out;
}

/* Words first.. as exactly `count` numbers. */
std::vector<double> numbers(const std::vector<std::string> &words, size_t first, size_t count,
                            const std::string &form, const std::string &name, size_t line)
{
    if (words.size() != first + count) {
        fail(name, line, "expected \"" + form + "\"");
    }
    std::vector<double> out;
    for (size_t k = first; k < words.size(); k++) {
        double value = 0;
        const char *end = words[k].data() + words[k].size();
        const auto [stop, error] = std::from_chars(words[k].data(), end, value);
        if (error != std::errc() || stop != end || !std::isfinite(value)) {
            fail(name, line, "\"" + words[k] + "\" is not a number");
        }
        if (std::fabs(value) > largest_coordinate) {
            fail(name, line, "\"" + words[k] + "\" is too large (metres are meant)");
        }
        out.push_back(value);
    }
    return out;
}

Pose pose_of(const std::vector<double> &v)
{
    return {v[0], v[1], v[2]};
}

Walker read_walker(const std::vector<std::string> &words, const std::string &name, size_t line)
{
    const std::string form = "# walker speed rest x1 y1 x2 y2 ..";
    const size_t points = words.size() < 8 ? 2 : (words.size() - 4) / 2;
    const auto v = numbers(words, 2, 2 + 2 * points, form, name, line);
    Walker walker = {v[0], v[1], {}};
    if (walker.speed_m_s <= 0 || walker.rest_s < 0) {
        fail(name, line, "a walker's speed is above 0, the rest not below 0");
    }
    for (size_t k = 2; k < v.size(); k += 2) {
        walker.path.push_back({v[k], v[k + 1]});
    }
    for (size_t k = 1; k < walker.path.size(); k++) {
        if (distance(walker.path[k - 1], walker.path[k]) < shortest_wall) {
            fail(name, line, "two points of the walker's way are the same");
        }
    }
    return walker;
}

void read_directive(const std::vector<std::string> &words, World &world, const std::string &name, size_t line)
{
    if (words.size() < 2) {
        return;
    }
    if (words[1] == "start") {
        world.start = pose_of(numbers(words, 2, 3, "# start x y theta", name, line));
    } else if (words[1] == "sensor") {
        world.sensor = pose_of(numbers(words, 2, 3, "# sensor x y theta", name, line));
    } else if (words[1] == "via") {
        const auto v = numbers(words, 2, 2, "# via x y", name, line);
        world.via.push_back({v[0], v[1]});
    } else if (words[1] == "walker") {
        world.walkers.push_back(read_walker(words, name, line));
    }
}

void read_wall(const std::vector<std::string> &words, World &world, const std::string &name, size_t line)
{
    const auto v = numbers(words, 0, 4, "x1 y1 x2 y2", name, line);
    const Wall wall = {{v[0], v[1]}, {v[2], v[3]}};
    if (distance(wall.a, wall.b) < shortest_wall) {
        fail(name, line, "the wall has no length");
    }
    world.walls.push_back(wall);
}

} // namespace

World parse_world(std::istream &in, const std::string &name)
{
    World world;
    std::string text;
    for (size_t line = 1; std::getline(in, text); line++) {
        const auto words = split(text);
        if (words.empty()) {
            continue;
        }
        if (words[0] == "#") {
            read_directive(words, world, name, line);
        } else if (words[0][0] != '#') {
            read_wall(words, world, name, line);
        }
    }
    if (world.walls.empty()) {
        throw std::runtime_error(name + ": no wall in it");
    }
    return world;
}

World load_world(const std::string &path)
{
    const ale_bytes_rule_t rule = {most_bytes, true};
    struct stat status = {};
    ale_bytes_t bytes = {};
    if (const char *wrong = ale_bytes_read_regular(&bytes, path.c_str(), &rule, &status)) {
        throw std::runtime_error(path + ": " + wrong);
    }
    std::istringstream in(std::string(bytes.at, bytes.at + bytes.count));
    ale_bytes_free(&bytes);
    return parse_world(in, path);
}

} // namespace sim
