#include "lab/bench/simulate.hpp"

#include <limits>

#include "common/command_line/wrong_use.h"

namespace bench
{
namespace
{

constexpr double depth_edge = 0.05; // neighbouring ranges that differ by more lie at an edge
constexpr double bam_per_radian = 4294967296.0 / (2 * pi);

double hit_wall(const Wall &wall, const Point &from, const Point &ray)
{
    const Point along = wall.b - wall.a;
    const double determinant = cross(ray, along);
    if (std::abs(determinant) < 1e-12) {
        return 0;
    }
    const double range = cross(wall.a - from, along) / determinant;
    const double position = cross(wall.a - from, ray) / determinant;
    return position >= 0 && position <= 1 ? range : 0;
}

double hit_arc(const Arc &arc, const Point &from, const Point &ray)
{
    const Point to_centre = arc.centre - from;
    const double along = to_centre.dot(ray);
    const double squared = arc.radius * arc.radius - to_centre.squaredNorm() + along * along;
    if (squared <= 0) {
        return 0;
    }
    for (const double range : {along - std::sqrt(squared), along + std::sqrt(squared)}) {
        const Point p = from + range * ray - arc.centre;
        const double turned = std::atan2(p.y(), p.x()) - arc.from;
        if (range > 1e-6 && turned - 2 * pi * std::floor(turned / (2 * pi)) <= arc.sweep) {
            return range;
        }
    }
    return 0;
}

std::unique_ptr<ale_scan_t> empty_scan(const Sensor &sensor)
{
    auto scan = std::make_unique<ale_scan_t>();
    scan->first_bearing_bam = static_cast<std::uint32_t>(std::llround(sensor.bearing(0) * bam_per_radian));
    scan->step_bam = static_cast<std::int32_t>(std::lround(sensor.step * bam_per_radian));
    scan->range_min_um = 20000;
    scan->range_max_um = static_cast<std::int32_t>(sensor.reach * 1e6);
    scan->beams = static_cast<std::uint16_t>(sensor.beams);
    return scan;
}

// The error that neighbouring beams share wanders over the scan: a first-order process of variance 1.
std::vector<double> wandering(const Noise &noise, Random &random, std::size_t beams)
{
    std::vector<double> error(beams);
    const double keep = std::exp(-1 / noise.shared_beams);
    double now = random.normal();
    for (double &e : error) {
        e = now;
        now = keep * now + std::sqrt(1 - keep * keep) * random.normal();
    }
    return error;
}

bool at_depth_edge(const Hit &a, const Hit &b)
{
    return a.surface >= 0 && b.surface >= 0 && a.surface != b.surface &&
           std::abs(a.range - b.range) > depth_edge;
}

// What lies beyond the reach sends no echo back, whatever the noise of its range would be.
Hit within_reach(const Hit &hit, double reach)
{
    return hit.range < reach ? hit : Hit{};
}

} // namespace

double Noise::own_sigma(double range) const
{
    return own_in_square ? std::hypot(own_floor, own_proportional * range)
                         : std::max(own_floor, own_proportional * range);
}

double Noise::shared_sigma(double range) const
{
    return std::hypot(shared_constant, shared_proportional * range);
}

double Noise::sigma(double range) const
{
    return std::hypot(own_sigma(range), shared_sigma(range), surface);
}

const std::vector<Noise> &noise_kinds()
{
    static const std::vector<Noise> all = [] {
        Noise base;
        base.bearing = radians(0.05);
        base.mixed = 0.3;
        Noise urg = base;
        urg.name = "urg";
        urg.own_floor = 0.003;
        urg.own_proportional = 0.007;
        Noise dirty = urg;
        dirty.name = "dirty";
        dirty.dropout = 0.02;
        dirty.gross = 0.01;
        std::vector<Noise> list{urg, dirty};
        for (const int mm : {3, 10, 20}) {
            Noise constant = base;
            constant.name = std::to_string(mm) + "mm";
            constant.own_floor = mm * 1e-3;
            list.push_back(constant);
        }
        Noise real = base;
        real.name = "real";
        real.own_floor = 0.0015;
        real.own_proportional = 0.0008;
        real.own_in_square = true;
        real.shared_constant = 0.002;
        real.shared_proportional = 0.002;
        real.surface = 0.006;
        real.dropout = 0.01;
        list.push_back(real);
        return list;
    }();
    return all;
}

const Noise &noise_kind(const std::string &name)
{
    for (const Noise &noise : noise_kinds()) {
        if (noise.name == name) {
            return noise;
        }
    }
    throw cli::WrongUse("no kind of noise is called " + name);
}

double urg_bearing(int beam)
{
    return Sensor{}.bearing(beam);
}

Hit cast(const World &world, double bearing)
{
    const Point ray = direction(world.heading + bearing);
    Hit nearest;
    double range = std::numeric_limits<double>::max();
    int surface = 0;
    const auto consider = [&](double candidate) {
        if (candidate > 1e-6 && candidate < range) {
            range = candidate;
            nearest = {surface, candidate};
        }
        surface++;
    };
    for (const Wall &wall : world.walls) {
        consider(hit_wall(wall, world.sensor, ray));
    }
    for (const Arc &arc : world.arcs) {
        consider(hit_arc(arc, world.sensor, ray));
    }
    return nearest;
}

namespace
{

// Ranges with the noise of beams and surfaces; 0 where nothing is met.
std::vector<double> noisy_ranges(const World &world, const Noise &noise, Random &random, SimulatedScan &out)
{
    std::vector<double> bias(world.walls.size() + world.arcs.size());
    for (double &b : bias) {
        b = noise.surface * random.normal();
    }
    const std::vector<double> shared = wandering(noise, random, out.hits.size());
    std::vector<double> range(out.hits.size());
    for (std::size_t k = 0; k < range.size(); k++) {
        const double bearing = out.sensor.bearing(static_cast<int>(k));
        out.hits[k] = cast(world, bearing);
        const Hit met =
            within_reach(cast(world, bearing + noise.bearing * random.normal()), out.sensor.reach);
        const double own = noise.own_sigma(met.range) * random.normal();
        const double of_surface = met.surface < 0 ? 0 : bias[static_cast<std::size_t>(met.surface)];
        out.clean[k] = met.surface >= 0 && met.surface == out.hits[k].surface;
        range[k] =
            met.surface < 0 ? 0 : met.range + own + noise.shared_sigma(met.range) * shared[k] + of_surface;
    }
    return range;
}

void mix_pixels(const Noise &noise, Random &random, std::vector<double> &range, SimulatedScan &out)
{
    for (std::size_t k = 0; k + 1 < range.size(); k++) {
        if (at_depth_edge(out.hits[k], out.hits[k + 1]) && random.chance(noise.mixed)) {
            const std::size_t mixed = k + (random.chance(0.5) ? 1 : 0);
            range[mixed] = random.uniform(out.hits[k].range, out.hits[k + 1].range);
            out.clean[mixed] = false;
        }
    }
}

void spoil_ranges(const Noise &noise, Random &random, std::vector<double> &range, SimulatedScan &out)
{
    for (std::size_t k = 0; k < range.size(); k++) {
        if (random.chance(noise.gross)) {
            range[k] = random.uniform(0.1, out.sensor.reach);
            out.clean[k] = false;
        }
        if (random.chance(noise.dropout)) {
            range[k] = 0;
        }
    }
}

} // namespace

Sensor whole_turn(const World &world, int beams, double reach)
{
    Sensor sensor{beams, beams / 2, 2 * pi / beams, reach};
    const auto surface = [&](int k) { return within_reach(cast(world, sensor.bearing(k)), reach).surface; };
    int first = 0;
    while (first + 1 < beams && surface(first) == surface(first - 1)) {
        first++;
    }
    sensor.front -= first;
    return sensor;
}

SimulatedScan simulate(const World &world, const Noise &noise, Random &random, const Sensor &sensor)
{
    const auto beams = static_cast<std::size_t>(sensor.beams);
    SimulatedScan out{sensor, empty_scan(sensor), std::vector<Hit>(beams), std::vector<bool>(beams)};
    std::vector<double> range = noisy_ranges(world, noise, random, out);
    mix_pixels(noise, random, range, out);
    spoil_ranges(noise, random, range, out);
    for (std::size_t k = 0; k < beams; k++) {
        ale_scan_set_range(out.scan.get(), static_cast<std::uint16_t>(k),
                           static_cast<std::int32_t>(std::lround(range[k] * 1e3)) * 1000);
        out.clean[k] = out.clean[k] && out.scan->flag[k] == ALE_BEAM_VALID;
    }
    return out;
}

std::unique_ptr<ale_scan_t> turned(const ale_scan_t &scan, int seam, bool clockwise)
{
    auto out = std::make_unique<ale_scan_t>(scan);
    out->step_bam = clockwise ? -scan.step_bam : scan.step_bam;
    out->first_bearing_bam = ale_scan_bearing(&scan, seam);
    for (int k = 0; k < scan.beams; k++) {
        const int from = (seam + (clockwise ? scan.beams - k : k)) % scan.beams;
        out->range_um[k] = scan.range_um[from];
        out->flag[k] = scan.flag[from];
    }
    return out;
}

} // namespace bench
