// A scan laid on the map by its corner, as JSON for figure 8: corner_data LOG REFERENCE LAST
//
// The map is what the first REFERENCE scans of the log made. Of the scans up to LAST the most instructive one
// is taken: the place that explains it best explains nearly all, and the next best place as much as possible.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <vector>

#include "common/log/log_reader.h"
#include "common/log/robot_config.h"
#include "common/offline/core_object.h"

extern "C" {
#include "map/map_exchange.h"
#include "relocate/hypothesis.h"
}

namespace
{

using nlohmann::json;

constexpr int32_t all_um = 1000000000;
constexpr double apart_m = 0.5; /* places nearer than this, and turned by less, are one */
constexpr double apart_rad = 0.3;
constexpr double nearly_all = 0.8;

double radians(uint32_t bam)
{
    return static_cast<int32_t>(bam) * (3.14159265358979323846 / 2147483648.0);
}

double part(const ale_hypothesis_t &h)
{
    return static_cast<double>(h.score_um) / static_cast<double>(h.shown_um);
}

bool is_other_place(const ale_pose_t &a, const ale_pose_t &b)
{
    return std::hypot(a.x_um - b.x_um, a.y_um - b.y_um) * 1e-6 > apart_m ||
           std::fabs(radians(a.theta_bam - b.theta_bam)) > apart_rad;
}

/* The two best places of a scan. */
struct Places {
    std::vector<ale_observation_t> views;
    ale_hypothesis_t best;
    ale_hypothesis_t second;
};

class Finder
{
  public:
    Finder(const ale_config_t &config, const ale_map_t &map)
        : sensor_(config.pipeline.sensor), systematic_um_(config.pipeline.extract.noise.surface_um / 2),
          extractor_(ale::core_object<ale_extractor_t>(ale_extractor_size()))
    {
        if (ale_extractor_init(extractor_.get(), &config.pipeline.extract) < 0) {
            throw std::runtime_error("the extractor refuses the configuration");
        }
        ale_local_map_clear(map_.get());
        ale_map_import(map_.get(), &map);
        ale_local_map_approach(map_.get(), {0, 0}, all_um);
    }

    /* Nothing when fewer than two places explain a part of the scan. */
    std::optional<Places> places(const ale_scan_t &scan)
    {
        ale_extract_scan(extractor_.get(), &scan, nullptr, features_.get());
        Places found{std::vector<ale_observation_t>(ALE_MAX_LINES), {}, {}};
        found.views.resize(
            ale_observe_lines(features_.get(), &scan, sensor_, systematic_um_, found.views.data()));
        const std::vector<ale_hypothesis_t> all = search(found.views);
        const auto by_part = [](const auto &a, const auto &b) { return part(a) < part(b); };
        const auto best = std::max_element(all.begin(), all.end(), by_part);
        std::vector<ale_hypothesis_t> others;
        std::copy_if(all.begin(), all.end(), std::back_inserter(others),
                     [&](const auto &h) { return is_other_place(h.pose, best->pose); });
        if (others.empty()) {
            return std::nullopt;
        }
        found.best = *best;
        found.second = *std::max_element(others.begin(), others.end(), by_part);
        return found;
    }

  private:
    /* All pairs of walls once. */
    std::vector<ale_hypothesis_t> search(const std::vector<ale_observation_t> &views)
    {
        std::vector<ale_hypothesis_t> all;
        ale_search_t search{};
        while (search.rounds == 0) {
            const ale_search_t before = search;
            ale_hypothesis_t some[ALE_MAX_HYPOTHESES];
            const uint32_t count =
                ale_search(&search, map_.get(), views.data(), static_cast<uint32_t>(views.size()), some);
            all.insert(all.end(), some, some + count);
            if (search.first == before.first && search.second == before.second && search.rounds == 0) {
                break; /* no corner in this scan */
            }
        }
        return all;
    }

    ale_pose_t sensor_;
    int32_t systematic_um_;
    ale::CoreObject<ale_extractor_t> extractor_;
    std::unique_ptr<ale_local_map_t> map_ = std::make_unique<ale_local_map_t>();
    std::unique_ptr<ale_features_t> features_ = std::make_unique<ale_features_t>();
};

json segment(const ale_point_t &a, const ale_point_t &b)
{
    return {a.x_um * 1e-6, a.y_um * 1e-6, b.x_um * 1e-6, b.y_um * 1e-6};
}

json as_json(const ale_hypothesis_t &h)
{
    return {{"pose", {h.pose.x_um * 1e-6, h.pose.y_um * 1e-6, radians(h.pose.theta_bam)}}, {"part", part(h)}};
}

json as_json(const ale_map_t &map)
{
    json walls = json::array();
    for (int k = 0; k < map.line_count; k++) {
        walls.push_back(segment(map.line[k].start, map.line[k].end));
    }
    return walls;
}

json as_json(const std::vector<ale_observation_t> &views)
{
    json lines = json::array();
    for (const ale_observation_t &view : views) {
        const uint32_t along = ale_tangent_bam(view.normal_bam);
        lines.push_back(segment(ale_plus(view.centre, ale_polar(view.start_um, along)),
                                ale_plus(view.centre, ale_polar(view.end_um, along))));
    }
    return lines;
}

/* Tracks a log, and from a scan on seeks each scan in the map of that moment. */
class Chooser
{
  public:
    Chooser(const ale_config_t &config, long reference)
        : config_(config), reference_(reference),
          pipeline_(ale::core_object<ale_pipeline_t>(ale_pipeline_size()))
    {
        ale_pipeline_init(pipeline_.get(), &config.pipeline);
    }

    void take(const ale_log_event_t &event)
    {
        if (event.kind == ALE_LOG_ODOMETRY) {
            ale_pipeline_odometry(pipeline_.get(), &event.odometry);
        } else if (event.kind == ALE_LOG_SCAN) {
            take_scan(event.scan);
        }
    }

    long scans() const
    {
        return scans_;
    }
    /* The most instructive scan; null: none. */
    const json &chosen() const
    {
        return chosen_;
    }

  private:
    void take_scan(const ale_scan_t &scan)
    {
        ale_estimate_t estimate;
        ale_pipeline_scan(pipeline_.get(), &scan, &estimate);
        if (++scans_ == reference_) {
            ale_pipeline_copy_map(pipeline_.get(), map_.get());
            finder_.emplace(config_, *map_);
        }
        if (const auto found = finder_ ? finder_->places(scan) : std::nullopt) {
            compare(*found, estimate);
        }
    }

    void compare(const Places &found, const ale_estimate_t &estimate)
    {
        const double so_far = chosen_.is_null() ? 0 : chosen_["second"]["part"].get<double>();
        if (part(found.best) > nearly_all && !is_other_place(found.best.pose, estimate.map) &&
            part(found.second) > so_far) {
            chosen_ = {{"scan", scans_ - 1},
                       {"map", as_json(*map_)},
                       {"lines", as_json(found.views)},
                       {"best", as_json(found.best)},
                       {"second", as_json(found.second)}};
        }
    }

    const ale_config_t &config_;
    long reference_;
    ale::CoreObject<ale_pipeline_t> pipeline_;
    std::unique_ptr<ale_map_t> map_ = std::make_unique<ale_map_t>();
    std::optional<Finder> finder_;
    long scans_ = 0;
    json chosen_;
};

json instructive(const std::string &path, long reference, long last)
{
    ale::LogReader log(path);
    const ale_config_t config = ale::robot_config({}, log.info(), nullptr);
    Chooser chooser(config, reference);
    const auto event = std::make_unique<ale_log_event_t>();
    while (chooser.scans() <= last && log.next(*event)) {
        chooser.take(*event);
    }
    if (chooser.chosen().is_null()) {
        throw std::runtime_error(path + ": no scan with two candidates");
    }
    return chooser.chosen();
}

} // namespace

int main(int argc, char **argv)
{
    if (argc != 4) {
        std::fputs("usage: corner_data LOG REFERENCE LAST\n", stderr);
        return 2;
    }
    try {
        std::cout << instructive(argv[1], std::atol(argv[2]), std::atol(argv[3])) << "\n";
        return 0;
    } catch (const std::exception &error) {
        std::fprintf(stderr, "corner_data: %s\n", error.what());
        return 1;
    }
}
