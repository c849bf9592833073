#include "proofs/wcet/scans.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace bench
{

namespace
{

constexpr double um_per_m = 1e6;
constexpr double bam_per_rad = 4294967296.0 / (2 * M_PI);
constexpr double reach_m = 30;
constexpr double period_s = 0.1;
constexpr int wheel_samples = 10; /* in a period */
constexpr int64_t first_stamp_us = 1000000;
constexpr int jump_at = 10; /* the scan after the gap, from which on the scene has turned */

struct Gene {
    double Costly::*value;
    double least;
    double most;
};

const std::array<Gene, 10> genes = {{{&Costly::base_m, 0.5, 20},
                                     {&Costly::tooth_m, 0, 3},
                                     {&Costly::tooth_beams, 6, 400},
                                     {&Costly::square, 0, 1},
                                     {&Costly::noise_m, 0.0005, 0.03},
                                     {&Costly::dropped, 0, 0.7},
                                     {&Costly::turn_rad_s, 0, 2},
                                     {&Costly::map_walls, 0, ALE_MAP_MAX_LINES},
                                     {&Costly::jump_rad, 0, 3},
                                     {&Costly::gap_s, 0, 4}}};

double tooth(double phase, double square)
{
    const double part = phase - std::floor(phase);
    const double ramp = std::fabs(2 * part - 1);
    return (1 - square) * ramp + square * (part < 0.5 ? 0 : 1);
}

double range_m(const Costly &costly, double bearing_beams)
{
    return costly.base_m + costly.tooth_m * tooth(bearing_beams / costly.tooth_beams, costly.square);
}

double seconds_to(const Costly &costly, int k)
{
    return period_s * k + (k >= jump_at ? costly.gap_s : 0);
}

double step_rad(const Costly &costly)
{
    return (costly.beams > 682 ? 1.5 * M_PI : 682 * 2 * M_PI / 1024) / costly.beams;
}

} // namespace

int32_t micrometres(double metres)
{
    return static_cast<int32_t>(std::lround(metres * um_per_m));
}

std::string Costly::words() const
{
    char text[200];
    std::snprintf(text, sizeof text,
                  "%d beams, walls %.2f m off, teeth %.2f m every %.0f beams (%.0f %% steps), noise %.1f mm, "
                  "%.0f %% dropped, %.1f rad/s, map of %.0f walls, jump %.1f rad after %.1f s",
                  beams, base_m, tooth_m, tooth_beams, 100 * square, 1e3 * noise_m, 100 * dropped, turn_rad_s,
                  map_walls, jump_rad, gap_s);
    return text;
}

Costly changed(const Costly &from, Random &random)
{
    Costly to = from;
    const int changes = random.integer(1, 3);
    for (int k = 0; k < changes; k++) {
        const Gene &gene = genes[static_cast<size_t>(random.integer(0, static_cast<int>(genes.size()) - 1))];
        double &value = to.*gene.value;
        const double factor = std::exp(0.4 * random.normal());
        const double more = 0.05 * (gene.most - gene.least) * random.normal();
        value = std::clamp(value * factor + more, gene.least, gene.most);
    }
    return to;
}

std::vector<ale_odometry_t> wheels_before(const Costly &costly, int k)
{
    std::vector<ale_odometry_t> samples;
    for (int n = 1; n <= wheel_samples; n++) {
        const double after = seconds_to(costly, k) - (1 - n / static_cast<double>(wheel_samples)) * period_s;
        const double turned = std::remainder(costly.turn_rad_s * after, 2 * M_PI);
        samples.push_back({first_stamp_us + std::llround(after * 1e6),
                           {0, 0, static_cast<uint32_t>(std::llround(turned * bam_per_rad))}});
    }
    return samples;
}

ale_scan_t scan_of(const Costly &costly, int k, Random &random)
{
    const double step = step_rad(costly);
    const double turned = costly.turn_rad_s * seconds_to(costly, k) + (k >= jump_at ? costly.jump_rad : 0);
    ale_scan_t scan{};
    scan.beams = static_cast<uint16_t>(costly.beams);
    scan.stamp_us = first_stamp_us + std::llround(seconds_to(costly, k) * 1e6);
    scan.beam_time_ns = static_cast<int32_t>(1e9 * period_s * step / (2 * M_PI));
    scan.step_bam = static_cast<int32_t>(step * bam_per_rad);
    scan.first_bearing_bam = static_cast<uint32_t>(-costly.beams / 2 * int64_t{scan.step_bam});
    scan.range_min_um = 20000;
    scan.range_max_um = micrometres(reach_m);
    for (uint16_t beam = 0; beam < scan.beams; beam++) {
        const double range = range_m(costly, beam + turned / step) + costly.noise_m * random.normal();
        ale_scan_set_range(&scan, beam, random.chance(costly.dropped) ? 0 : micrometres(range));
    }
    return scan;
}

std::unique_ptr<ale_map_t> map_of(const Costly &costly, Random &random)
{
    auto map = std::make_unique<ale_map_t>();
    map->version = 1;
    map->line_count = static_cast<uint16_t>(costly.map_walls);
    for (uint16_t k = 0; k < map->line_count; k++) {
        const double normal = random.uniform(0, 2 * M_PI);
        const double rho = random.uniform(0.3, 1.5 * (costly.base_m + costly.tooth_m));
        const double x = rho * std::cos(normal);
        const double y = rho * std::sin(normal);
        const double half = 0.3;
        ale_map_line_t &wall = map->line[k];
        wall.id = k + 1U;
        wall.start = {micrometres(x + half * std::sin(normal)), micrometres(y - half * std::cos(normal))};
        wall.end = {micrometres(x - half * std::sin(normal)), micrometres(y + half * std::cos(normal))};
        wall.var_alpha_nrad2 = 4000000000000;
        wall.var_rho_um2 = 9000000;
        wall.seen = 20;
    }
    return map;
}

ale_scan_t any_scan(Random &random)
{
    Costly costly;
    for (int k = 0; k < 12; k++) {
        costly = changed(costly, random);
    }
    return scan_of(costly, 0, random);
}

ale_scan_t far_scan(Random &random)
{
    ale_scan_t scan = any_scan(random);
    for (uint16_t k = 0; k < scan.beams; k++) {
        ale_scan_set_range(&scan, k, 25000000);
    }
    return scan;
}

} // namespace bench
