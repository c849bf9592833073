// What libale does with one simulated scan, as JSON for the figures 2, 5, 6 and 7: two walls that meet at a
// blunt corner and a third, 3 mm of noise, seen by a URG-04LX.
#include <iostream>
#include <nlohmann/json.hpp>

#include "lab/bench/lines/extractors.hpp"
#include "lab/bench/lines/textbook/textbook.hpp"
#include "lab/bench/simulate.hpp"

extern "C" {
#include "extract/lowess.h"
#include "lab/figures/growth.h"
#include "lab/inspect/trace.h"
}

namespace
{

using nlohmann::json;
using namespace bench;

constexpr double low_threshold = 0.0025; // the paper's bounds
constexpr double high_threshold = 0.008;

World blunt_corner()
{
    World world;
    world.walls = {{{1.2, -1.5}, {1.75, -0.1}}, {{1.75, -0.1}, {1.8, 1.1}}, {{1.8, 1.1}, {0.4, 1.5}}};
    return world;
}

Noise three_millimetres()
{
    Noise noise;
    noise.name = "3 mm";
    noise.own_floor = 0.003;
    return noise;
}

ale_extract_config_t own_noise_only()
{
    ale_extract_config_t config = ale_extract_default_config();
    config.noise = {3000, 0, 0, 0, 1, 0, 0};
    return config;
}

json as_json(const Point &p)
{
    return {p.x(), p.y()};
}

json static_lines(const ale_scan_t &scan, double threshold)
{
    textbook::Setting setting;
    setting.threshold = threshold;
    json lines = json::array();
    for (const Line &line : textbook::static_ale(scan, setting)) {
        lines.push_back(
            {{"first", line.first}, {"last", line.last}, {"ends", {as_json(line.start), as_json(line.end)}}});
    }
    return lines;
}

json metres(const ale_point_t &p)
{
    return {p.x_um * 1e-6, p.y_um * 1e-6};
}

json extracted(const inspect_trace_t &trace)
{
    json lines = json::array();
    for (int k = 0; k < trace.features.line_count; k++) {
        const ale_line_t &line = trace.features.line[k];
        lines.push_back({{"first", line.first},
                         {"last", line.last},
                         {"rmse_mm", line.rmse_um * 1e-3},
                         {"ends", {metres(line.start), metres(line.end)}}});
    }
    return lines;
}

json corners(const inspect_trace_t &trace)
{
    json points = json::array();
    for (int k = 0; k < trace.features.corner_count; k++) {
        points.push_back(metres(trace.features.corner[k].p));
    }
    return points;
}

json points_of(const inspect_trace_t &trace)
{
    json points = json::array();
    for (int k = 0; k < trace.points; k++) {
        points.push_back({trace.beam[k], trace.x_um[k] * 1e-6, trace.y_um[k] * 1e-6});
    }
    return points;
}

json steps_of(const inspect_trace_t &trace)
{
    json steps = json::array();
    for (int k = 0; k < trace.steps; k++) {
        const inspect_step_t &s = trace.step[k];
        const auto beam = [&](int offset) {
            return trace.beam[std::clamp(s.line_first + s.direction * offset, 0, trace.points - 1)];
        };
        steps.push_back({{"first", beam(0)},
                         {"left", beam(s.left)},
                         {"right", beam(s.right)},
                         {"guess", beam(s.guess)},
                         {"accepted", s.accepted}});
    }
    return steps;
}

json growth_of(const ale_scan_t &scan)
{
    const ale_extract_config_t config = own_noise_only();
    std::vector<figures_growth_t> growth(ALE_MAX_BEAMS);
    const int entries = figures_growth(&scan, &config, growth.data());
    json all = json::array();
    for (int k = 0; k < entries; k++) {
        const figures_growth_t &g = growth[static_cast<std::size_t>(k)];
        all.push_back(
            {{"beam", g.beam}, {"rmse_mm", g.rmse_mm}, {"low_mm", g.low_mm}, {"high_mm", g.high_mm}});
    }
    return all;
}

constexpr int smoothed_beams = 41;
constexpr int stray_beam = 20;
constexpr double stray_by = 0.06;
constexpr double inverse_unit = 17592186.044416; // 2^44 / um, as the extractor has 1 / range

std::vector<double> smoothed(const std::vector<double> &ranges, std::uint8_t passes)
{
    constexpr ale_lowess_config_t one_pass{11, 0, 400};
    ale_lowess_config_t config = one_pass;
    config.passes = passes;
    std::vector<std::uint16_t> beams(ranges.size());
    std::vector<std::int32_t> values(ranges.size());
    std::vector<std::int32_t> smooth(ranges.size());
    for (std::size_t k = 0; k < ranges.size(); k++) {
        beams[k] = static_cast<std::uint16_t>(k);
        values[k] = static_cast<std::int32_t>(std::lround(inverse_unit / ranges[k]));
    }
    const auto work = std::make_unique<ale_lowess_work_t>();
    ale_lowess(&config, beams.data(), values.data(), static_cast<std::int32_t>(values.size()), smooth.data(),
               work.get());
    std::vector<double> result;
    result.reserve(smooth.size());
    for (const std::int32_t s : smooth) {
        result.push_back(inverse_unit / s);
    }
    return result;
}

// A slanted wall with one stray value.
json smoothing()
{
    Random random(4);
    std::vector<double> wall;
    std::vector<double> measured;
    wall.reserve(smoothed_beams);
    measured.reserve(smoothed_beams);
    for (int k = 0; k < smoothed_beams; k++) {
        wall.push_back(2.0 / std::cos(k * urg_step - radians(20)));
        measured.push_back(wall.back() + 0.003 * random.normal() + (k == stray_beam ? stray_by : 0));
    }
    return {{"wall", wall},
            {"measured", measured},
            {"plain", smoothed(measured, 0)},
            {"robust", smoothed(measured, 3)},
            {"stray_by", stray_by},
            {"stray_beam", stray_beam}};
}

// The beam at which the true walls change.
json true_breaks(const SimulatedScan &simulated)
{
    json breaks = json::array();
    for (int k = 0; k + 1 < urg_beams; k++) {
        const int here = simulated.hits[static_cast<std::size_t>(k)].surface;
        const int next = simulated.hits[static_cast<std::size_t>(k) + 1].surface;
        if (here != next && here >= 0 && next >= 0) {
            breaks.push_back(k);
        }
    }
    return breaks;
}

} // namespace

int main()
{
    Random random(20);
    const SimulatedScan simulated = simulate(blunt_corner(), three_millimetres(), random);
    const ale_extract_config_t config = own_noise_only();
    const auto trace = std::make_unique<inspect_trace_t>();
    if (inspect_trace(simulated.scan.get(), &config, trace.get()) < 0) {
        std::cerr << "figure_data: the extractor does not take its configuration\n";
        return 1;
    }
    std::cout << json{{"smoothing", smoothing()},
                      {"points", points_of(*trace)},
                      {"true_breaks", true_breaks(simulated)},
                      {"steps", steps_of(*trace)},
                      {"growth", growth_of(*simulated.scan)},
                      {"lines", extracted(*trace)},
                      {"corners", corners(*trace)},
                      {"low_threshold", low_threshold},
                      {"high_threshold", high_threshold},
                      {"static_low", static_lines(*simulated.scan, low_threshold)},
                      {"static_high", static_lines(*simulated.scan, high_threshold)}}
              << std::endl;
    return 0;
}
