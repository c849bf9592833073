#include "lab/bench/truth.hpp"

#include <algorithm>

namespace bench
{
namespace
{

constexpr int corner_gap_beams = 5;
constexpr double least_corner_angle = radians(15);

Point in_sensor_frame(const World &world, const Point &p)
{
    const Point d = p - world.sensor;
    const Point x = direction(world.heading);
    return {x.dot(d), cross(x, d)};
}

Wall wall_in_sensor_frame(const World &world, int wall)
{
    const Wall &w = world.walls[static_cast<std::size_t>(wall)];
    return {in_sensor_frame(world, w.a), in_sensor_frame(world, w.b)};
}

// Where a ray crosses the line, as a position along its tangent; limit where it never does.
double crossing(const NormalForm &line, double bearing, double limit)
{
    const double turned = wrapped(bearing - line.alpha);
    if (std::abs(turned) >= pi / 2) {
        return limit;
    }
    const double t = line.rho * std::tan(turned);
    return limit > 0 ? std::min(t, limit) : std::max(t, limit);
}

// The share of one beam in the information about (alpha, rho): its variance along the normal is (26).
void add_information(TrueLine &line, const Noise &noise, const Hit &hit, double bearing)
{
    const double s_range = noise.sigma(hit.range);
    const double s_bearing = hit.range * noise.bearing;
    const double turned = bearing - line.form.alpha;
    const double variance =
        std::pow(s_range * std::cos(turned), 2) + std::pow(s_bearing * std::sin(turned), 2);
    const double t = hit.range * std::sin(turned);
    line.information[0] += t * t / variance;
    line.information[1] -= t / variance;
    line.information[2] += 1 / variance;
}

TrueLine make_line(const World &world, const Noise &noise, const SimulatedScan &scan, int first, int last)
{
    TrueLine line;
    line.wall = scan.hits[static_cast<std::size_t>(first)].surface;
    line.first = first;
    line.last = last;
    const Wall wall = wall_in_sensor_frame(world, line.wall);
    line.form = line_through(wall.a, wall.b);
    for (int k = first; k <= last; k++) {
        const auto beam = static_cast<std::size_t>(k);
        if (scan.clean[beam]) {
            line.points++;
            add_information(line, noise, scan.hits[beam], scan.sensor.bearing(k));
        }
    }
    const auto met = [&](int k) {
        return Point(scan.hits[static_cast<std::size_t>(k)].range * direction(scan.sensor.bearing(k)));
    };
    line.start = met(first);
    line.end = met(last);
    const Point tangent = line.form.tangent();
    const double low = std::min(tangent.dot(wall.a), tangent.dot(wall.b));
    const double high = std::max(tangent.dot(wall.a), tangent.dot(wall.b));
    const auto outwards = [&](int beam, double limit) {
        return std::clamp(crossing(line.form, scan.sensor.bearing(beam), limit), low, high);
    };
    line.start_between = {tangent.dot(line.start), outwards(first - 1, low)};
    line.end_between = {tangent.dot(line.end), outwards(last + 1, high)};
    line.counts = line.points >= least_true_beams && (line.end - line.start).norm() >= least_true_length;
    return line;
}

void add_run(Truth &truth, const World &world, const Noise &noise, const SimulatedScan &scan, int first,
             int last)
{
    const auto clean = [&](int k) { return scan.clean[static_cast<std::size_t>(k)]; };
    while (first <= last && !clean(first)) {
        first++;
    }
    while (last >= first && !clean(last)) {
        last--;
    }
    if (first < last) {
        truth.lines.push_back(make_line(world, noise, scan, first, last));
    }
}

void find_lines(Truth &truth, const World &world, const Noise &noise, const SimulatedScan &scan)
{
    const auto wall_of = [&](int k) {
        const Hit &hit = scan.hits[static_cast<std::size_t>(k)];
        const bool seen = hit.surface < static_cast<int>(world.walls.size()) && hit.range < scan.sensor.reach;
        return seen ? hit.surface : -1;
    };
    for (int first = 0, k = 1; k <= scan.sensor.beams; k++) {
        if (k == scan.sensor.beams || wall_of(k) != wall_of(first)) {
            if (wall_of(first) >= 0) {
                add_run(truth, world, noise, scan, first, k - 1);
            }
            first = k;
        }
    }
}

bool shared_end(const Wall &a, const Wall &b, Point &where)
{
    for (const Point &p : {a.a, a.b}) {
        for (const Point &q : {b.a, b.b}) {
            if ((p - q).norm() < 1e-9) {
                where = p;
                return true;
            }
        }
    }
    return false;
}

// Pieces of one wall share its corners: each is listed once.
void add_corner(Truth &truth, const TrueCorner &corner)
{
    for (TrueCorner &known : truth.corners) {
        if ((known.p - corner.p).norm() < 1e-9) {
            known.counts = known.counts || corner.counts;
            return;
        }
    }
    truth.corners.push_back(corner);
}

// A corner counts where both of its walls do and adjoin in the scan. Others may be found, but need not.
void find_corners(Truth &truth, const World &world)
{
    for (std::size_t i = 0; i < truth.lines.size(); i++) {
        for (std::size_t j = i + 1; j < truth.lines.size(); j++) {
            const TrueLine &a = truth.lines[i];
            const TrueLine &b = truth.lines[j];
            TrueCorner corner;
            if (a.wall == b.wall || !shared_end(wall_in_sensor_frame(world, a.wall),
                                                wall_in_sensor_frame(world, b.wall), corner.p)) {
                continue;
            }
            const double turn = std::abs(wrapped(a.form.alpha - b.form.alpha));
            corner.angle = pi - turn;
            const bool adjoining = b.first - a.last <= corner_gap_beams && b.first > a.last;
            const bool clear = turn > least_corner_angle && turn < pi - least_corner_angle;
            corner.counts = a.counts && b.counts && adjoining && clear;
            add_corner(truth, corner);
        }
    }
}

} // namespace

Truth make_truth(const World &world, const Noise &noise, const SimulatedScan &scan)
{
    Truth truth;
    truth.kind = world.kind;
    find_lines(truth, world, noise, scan);
    find_corners(truth, world);
    return truth;
}

} // namespace bench
