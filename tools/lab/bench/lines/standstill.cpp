#include "lab/bench/lines/standstill.hpp"

#include <optional>
#include <utility>

#include "common/log/log_reader.h"

namespace bench
{
namespace
{

bool is_same(const ale_odometry_t &a, const ale_odometry_t &b)
{
    return a.pose.x_um == b.pose.x_um && a.pose.y_um == b.pose.y_um && a.pose.theta_bam == b.pose.theta_bam;
}

void copy_beam(ale_scan_t *to, int k, const ale_scan_t &from, int of)
{
    to->range_um[k] = from.range_um[of];
    to->flag[k] = from.flag[of];
    to->code[k] = from.code[of];
}

} // namespace

std::vector<Standstill> standstills(const std::string &path, std::size_t least_scans)
{
    ale::LogReader log(path);
    const auto event = std::make_unique<ale_log_event_t>();
    std::vector<Standstill> all;
    std::optional<ale_odometry_t> before;
    Standstill here;
    int scans = 0;
    bool moved = false; // since the last scan
    const auto end_stretch = [&] {
        if (here.scans.size() >= least_scans) {
            all.push_back(std::move(here));
        }
        here = {};
    };
    while (log.next(*event)) {
        if (event->kind == ALE_LOG_ODOMETRY) {
            moved = moved || (before && !is_same(*before, event->odometry));
            before = event->odometry;
        } else if (event->kind == ALE_LOG_SCAN) {
            if (moved) {
                end_stretch();
            } else {
                here.first_scan = here.scans.empty() ? scans : here.first_scan;
                here.scans.push_back(std::make_unique<ale_scan_t>(event->scan));
            }
            moved = false;
            scans++;
        }
    }
    end_stretch();
    return all;
}

std::unique_ptr<ale_scan_t> mirrored(const ale_scan_t &scan)
{
    auto out = std::make_unique<ale_scan_t>(scan);
    out->first_bearing_bam = 0u - ale_scan_bearing(&scan, scan.beams - 1);
    for (int k = 0; k < scan.beams; k++) {
        copy_beam(out.get(), k, scan, scan.beams - 1 - k);
    }
    return out;
}

std::unique_ptr<ale_scan_t> thinned(const ale_scan_t &scan, int stride)
{
    auto out = std::make_unique<ale_scan_t>(scan);
    out->step_bam = scan.step_bam * stride;
    out->beam_time_ns = scan.beam_time_ns * stride;
    out->beams = static_cast<uint16_t>((scan.beams + stride - 1) / stride);
    for (int k = 0; k < out->beams; k++) {
        copy_beam(out.get(), k, scan, k * stride);
    }
    return out;
}

} // namespace bench
