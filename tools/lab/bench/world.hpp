// Worlds of walls and discs with a scanner in them: the truth the extractors are held against.
#pragma once

#include <string>
#include <vector>

#include "lab/bench/geometry.hpp"
#include "lab/bench/random.hpp"

namespace bench
{

struct Wall {
    Point a;
    Point b;
};

// A curved surface: the arc of a circle, from `from` counter-clockwise over `sweep` radians.
struct Arc {
    Point centre;
    double radius;
    double from;
    double sweep;
};

struct World {
    std::string kind;
    std::vector<Wall> walls;
    std::vector<Arc> arcs;
    Point sensor = Point::Zero();
    double heading = 0;
};

// The kinds of world, in the order in which a suite goes through them.
const std::vector<std::string> &world_kinds();

// Worlds of this kind hold curved walls: what is found on them is false.
bool is_curved(const std::string &kind);

World make_world(const std::string &kind, Random &random);

} // namespace bench
