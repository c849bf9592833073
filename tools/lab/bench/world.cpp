#include "lab/bench/world.hpp"

#include <algorithm>
#include <functional>
#include <utility>

#include "common/command_line/wrong_use.h"

namespace bench
{
namespace
{

constexpr double clearance = 0.35; // of the scanner from everything

void add_chain(World &world, const std::vector<Point> &chain)
{
    for (std::size_t k = 0; k + 1 < chain.size(); k++) {
        world.walls.push_back({chain[k], chain[k + 1]});
    }
}

void add_polygon(World &world, std::vector<Point> corners)
{
    corners.push_back(corners.front());
    add_chain(world, corners);
}

std::vector<Point> rectangle(const Point &centre, double width, double height, double turn)
{
    const Point u = direction(turn) * (width / 2);
    const Point v = direction(turn + pi / 2) * (height / 2);
    return {centre - u - v, centre + u - v, centre + u + v, centre - u + v};
}

double distance_to(const Wall &wall, const Point &p)
{
    const Point d = wall.b - wall.a;
    const double t = std::clamp((p - wall.a).dot(d) / d.squaredNorm(), 0.0, 1.0);
    return (wall.a + t * d - p).norm();
}

bool is_free(const World &world, const Point &p, double distance)
{
    const auto far_wall = [&](const Wall &wall) { return distance_to(wall, p) > distance; };
    const auto far_arc = [&](const Arc &arc) {
        return std::abs((p - arc.centre).norm() - arc.radius) > distance &&
               (arc.sweep < 2 * pi - 0.01 || (p - arc.centre).norm() > arc.radius);
    };
    return std::all_of(world.walls.begin(), world.walls.end(), far_wall) &&
           std::all_of(world.arcs.begin(), world.arcs.end(), far_arc);
}

// A free place in the rectangle of half sizes (hx, hy) about the origin.
Point free_place(const World &world, Random &random, double hx, double hy, double distance)
{
    for (int attempt = 0; attempt < 200; attempt++) {
        Point p(random.uniform(-hx, hx), random.uniform(-hy, hy));
        if (is_free(world, p, distance)) {
            return p;
        }
    }
    return Point::Zero();
}

struct Room {
    double hx;
    double hy;
};

Room random_room(Random &random, double low, double high)
{
    return {random.uniform(low, high) / 2, random.uniform(low, high) / 2};
}

std::vector<Point> corners_of(const Room &room)
{
    return rectangle(Point::Zero(), 2 * room.hx, 2 * room.hy, 0);
}

// From corner to corner, in their order.
std::vector<std::pair<Point, Point>> sides_of(const Room &room)
{
    const std::vector<Point> corners = corners_of(room);
    std::vector<std::pair<Point, Point>> sides;
    for (std::size_t k = 0; k < corners.size(); k++) {
        sides.emplace_back(corners[k], corners[(k + 1) % corners.size()]);
    }
    return sides;
}

void put_sensor(World &world, Random &random, const Room &room)
{
    world.sensor = free_place(world, random, room.hx - clearance, room.hy - clearance, clearance);
    world.heading = random.uniform(-pi, pi);
}

World plain_room(Random &random)
{
    World world;
    const Room room = random_room(random, 2.2, 5.5);
    add_polygon(world, corners_of(room));
    put_sensor(world, random, room);
    return world;
}

World l_shaped_room(Random &random)
{
    World world;
    const Room room = random_room(random, 3, 6);
    const double nx = random.uniform(0.2, 0.6) * room.hx;
    const double ny = random.uniform(0.2, 0.6) * room.hy;
    add_polygon(world, {{-room.hx, -room.hy},
                        {room.hx, -room.hy},
                        {room.hx, ny},
                        {nx, ny},
                        {nx, room.hy},
                        {-room.hx, room.hy}});
    world.sensor = {random.uniform(-room.hx + clearance, nx - clearance),
                    random.uniform(-room.hy + clearance, ny - clearance)};
    world.heading = random.uniform(-pi, pi);
    return world;
}

// One long side from (x0, y) to (x1, y) with offsets of `depth` towards +y or -y here and there.
std::vector<Point> stepped_side(Random &random, double x0, double x1, double y, double outward,
                                const std::function<double()> &depth)
{
    std::vector<Point> chain{{x0, y}};
    const double step = x1 > x0 ? 1 : -1;
    double x = x0 + step * random.uniform(0.4, 1.2);
    while (step * (x1 - x) > 1.5) {
        const double width = random.uniform(0.7, 1.1);
        const double offset = outward * depth();
        chain.insert(chain.end(), {Point(x, y), Point(x, y + offset), Point(x + step * width, y + offset),
                                   Point(x + step * width, y)});
        x += step * (width + random.uniform(0.5, 1.6));
    }
    chain.emplace_back(x1, y);
    return chain;
}

World with_stepped_sides(Random &random, const Room &room, const std::function<double()> &step)
{
    World world;
    add_chain(world, stepped_side(random, -room.hx, room.hx, -room.hy, -1, step));
    add_chain(world, stepped_side(random, room.hx, -room.hx, room.hy, 1, step));
    add_chain(world, {{room.hx, -room.hy}, {room.hx, room.hy}});
    add_chain(world, {{-room.hx, room.hy}, {-room.hx, -room.hy}});
    put_sensor(world, random, room);
    return world;
}

World corridor(Random &random)
{
    const Room room{random.uniform(6, 12) / 2, random.uniform(1.2, 2.4) / 2};
    return with_stepped_sides(random, room, [&] { return random.uniform(0.08, 0.25); });
}

// Walls that step back or forth by 20 to 100 mm.
World stepped_room(Random &random)
{
    const Room room = random_room(random, 3, 5.5);
    return with_stepped_sides(random, room, [&] { return random.sign() * random.uniform(0.02, 0.1); });
}

// Long walls bent by 5 to 30 degrees: each side of the room bulges at one place.
World bent_room(Random &random)
{
    World world;
    const Room room = random_room(random, 2.5, 5);
    for (const auto &[a, b] : sides_of(room)) {
        const double along = random.uniform(0.35, 0.65);
        const double bend = radians(random.uniform(5, 30));
        // Deflection h at `along` of a length L turns the wall by h/(along L) + h/((1 - along) L).
        const double height = bend * (b - a).norm() * along * (1 - along);
        const Point outward = Point((b - a).y(), -(b - a).x()).normalized();
        add_chain(world, {a, a + along * (b - a) + random.sign() * height * outward, b});
    }
    put_sensor(world, random, room);
    return world;
}

// A room with one bowed wall and one or two thick columns.
World curved_room(Random &random)
{
    World world;
    const Room room = random_room(random, 3, 5.5);
    add_chain(world, {{room.hx, -room.hy}, {-room.hx, -room.hy}, {-room.hx, room.hy}, {room.hx, room.hy}});
    const double half_sweep = radians(random.uniform(25, 80));
    const double radius = room.hy / std::sin(half_sweep);
    const double middle = room.hx - radius * std::cos(half_sweep);
    world.arcs.push_back({{middle, 0}, radius, -half_sweep, 2 * half_sweep});
    for (int k = random.integer(1, 2); k > 0; k--) {
        const double column = random.uniform(0.15, 0.5);
        const Point place = free_place(world, random, room.hx - 0.6, room.hy - 0.6, column + 0.2);
        world.arcs.push_back({place, column, 0, 2 * pi});
    }
    put_sensor(world, random, room);
    return world;
}

World room_with_boxes(Random &random)
{
    World world;
    const Room room = random_room(random, 3.5, 6);
    add_polygon(world, corners_of(room));
    put_sensor(world, random, room);
    for (int k = random.integer(2, 5); k > 0; k--) {
        const double width = random.uniform(0.25, 0.9);
        const double height = random.uniform(0.25, 0.9);
        const double reach = std::hypot(width, height) / 2;
        const Point place = free_place(world, random, room.hx - reach, room.hy - reach, reach + 0.1);
        if ((place - world.sensor).norm() > reach + clearance && is_free(world, place, reach)) {
            add_polygon(world, rectangle(place, width, height, random.uniform(-pi, pi)));
        }
    }
    return world;
}

// Thin poles hide pieces of the walls.
World room_with_poles(Random &random)
{
    World world = plain_room(random);
    for (int k = random.integer(3, 8); k > 0; k--) {
        const Point place = world.sensor + random.uniform(0.4, 1.6) * direction(random.uniform(-pi, pi));
        world.arcs.push_back({place, random.uniform(0.01, 0.05), 0, 2 * pi});
    }
    return world;
}

// Small things of every shape lie about.
World cluttered_room(Random &random)
{
    World world = plain_room(random);
    for (int k = random.integer(8, 16); k > 0; k--) {
        const Point place = world.sensor + random.uniform(0.5, 2.2) * direction(random.uniform(-pi, pi));
        if (random.chance(0.5)) {
            world.arcs.push_back({place, random.uniform(0.02, 0.12), 0, 2 * pi});
        } else {
            const Point half = random.uniform(0.02, 0.12) * direction(random.uniform(-pi, pi));
            world.walls.push_back({place - half, place + half});
        }
    }
    return world;
}

// Open doorways with a second room behind: the pieces of wall beside a door are walls of their own.
World room_with_doors(Random &random)
{
    World world;
    const Room room = random_room(random, 3, 4.5);
    for (const auto &[a, b] : sides_of(room)) {
        const double length = (b - a).norm();
        const double at = random.uniform(0.5, length - 1.5);
        const Point u = (b - a) / length;
        if (random.chance(0.6)) {
            add_chain(world, {a, a + at * u});
            add_chain(world, {a + (at + random.uniform(0.7, 1)) * u, b});
        } else {
            add_chain(world, {a, b});
        }
    }
    add_polygon(world, rectangle(Point::Zero(), 2 * room.hx + 2.5, 2 * room.hy + 2.5, 0));
    put_sensor(world, random, room);
    return world;
}

struct Kind {
    const char *name;
    World (*make)(Random &random);
};

constexpr Kind kinds[] = {
    {"room", plain_room},       {"lroom", l_shaped_room},   {"corridor", corridor},
    {"doors", room_with_doors}, {"boxes", room_with_boxes}, {"steps", stepped_room},
    {"bends", bent_room},       {"curves", curved_room},    {"clutter", cluttered_room},
    {"poles", room_with_poles},
};

} // namespace

const std::vector<std::string> &world_kinds()
{
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        for (const Kind &kind : kinds) {
            all.emplace_back(kind.name);
        }
        return all;
    }();
    return names;
}

bool is_curved(const std::string &kind)
{
    return kind == "curves";
}

World make_world(const std::string &kind, Random &random)
{
    for (const Kind &candidate : kinds) {
        if (kind == candidate.name) {
            World world = candidate.make(random);
            world.kind = kind;
            return world;
        }
    }
    throw cli::WrongUse("no kind of world is called " + kind);
}

} // namespace bench
