#include "convert.h"

#include <algorithm>
#include <cmath>

#include "units.h"

extern "C" {
#include "base/fixed.h"
}

namespace ale::binding
{

namespace
{

void flag_beam(ale_scan_t &scan, uint16_t beam, ale_beam_flag_t flag)
{
    scan.range_um[beam] = 0;
    scan.flag[beam] = static_cast<uint8_t>(flag);
}

void set_beam(ale_scan_t &scan, uint16_t beam, double range_m)
{
    constexpr double farthest_m = 2000;
    scan.code[beam] = 0;
    if (std::isnan(range_m)) {
        flag_beam(scan, beam, ALE_BEAM_UNKNOWN);
    } else if (std::isinf(range_m)) {
        flag_beam(scan, beam, range_m > 0 ? ALE_BEAM_NO_RETURN : ALE_BEAM_TOO_NEAR);
    } else {
        ale_scan_set_range(&scan, beam, um_of(std::clamp(range_m, 0.0, farthest_m)));
    }
}

template <class Real> void set_beams(ale_scan_t &scan, const void *ranges)
{
    const auto *range = static_cast<const Real *>(ranges);
    for (uint16_t k = 0; k < scan.beams; k++) {
        set_beam(scan, k, static_cast<double>(range[k]));
    }
}

ale_line_record_t record_of(const ale_line_t &line)
{
    ale_line_record_t out{};
    out.x1 = metres(line.start.x_um);
    out.y1 = metres(line.start.y_um);
    out.x2 = metres(line.end.x_um);
    out.y2 = metres(line.end.y_um);
    out.alpha = radians(line.alpha_bam);
    out.rho = metres(line.rho_um);
    out.cov[0] = scaled(line.var_alpha_nrad2, 18);
    out.cov[1] = scaled(line.cov_alpha_rho, 15);
    out.cov[2] = scaled(line.var_rho_um2, 12);
    out.rmse = metres(line.rmse_um);
    out.var_start = scaled(line.var_start_um2, 12);
    out.var_end = scaled(line.var_end_um2, 12);
    out.first = line.first;
    out.last = line.last;
    out.points = line.points;
    out.first_end = line.first_end;
    out.last_end = line.last_end;
    return out;
}

ale_corner_record_t record_of(const ale_corner_t &corner)
{
    ale_corner_record_t out{};
    out.x = metres(corner.p.x_um);
    out.y = metres(corner.p.y_um);
    for (int i = 0; i < 3; i++) {
        out.cov[i] = scaled(corner.cov_um2[i], 12);
    }
    out.angle = opening_radians(corner.angle_bam);
    out.bisector = radians(corner.bisector_bam);
    out.first_line = corner.first_line;
    out.second_line = corner.second_line;
    out.kind = corner.kind;
    return out;
}

ale_curve_record_t record_of(const ale_curve_t &curve)
{
    ale_curve_record_t out{};
    out.x = metres(curve.centre.x_um);
    out.y = metres(curve.centre.y_um);
    out.radius = metres(curve.radius_um);
    out.first = curve.first;
    out.last = curve.last;
    return out;
}

} // namespace

void fill_scan(ale_scan_t &scan, const ale_binding_scan_t &asked)
{
    const ale_scanner_record_t &scanner = *asked.scanner;
    scan.stamp_us = us_of(asked.stamp_s);
    scan.stamp_beam = scanner.stamp_beam;
    scan.beam_time_ns = static_cast<int32_t>(std::llround(scanner.beam_time * nano));
    scan.first_bearing_bam = bam_of(scanner.first_bearing);
    scan.step_bam = static_cast<int32_t>(bam_of(scanner.step));
    scan.range_min_um = um_of(scanner.range_min);
    scan.range_max_um = um_of(scanner.range_max);
    scan.beams = static_cast<uint16_t>(asked.beams);
    asked.is_float32 ? set_beams<float>(scan, asked.ranges) : set_beams<double>(scan, asked.ranges);
}

void put_features(const ale_binding_features_t &out, const ale_features_t &features)
{
    const auto put = [](const auto *from, uint16_t count, auto *to) {
        std::transform(from, from + count, to, [](const auto &one) { return record_of(one); });
    };
    put(features.line, features.line_count, out.lines);
    put(features.corner, features.corner_count, out.corners);
    put(features.curve, features.curve_count, out.curves);
    out.counts[0] = features.line_count;
    out.counts[1] = features.corner_count;
    out.counts[2] = features.curve_count;
    out.counts[3] = features.outliers;
    std::copy(features.refused, features.refused + ALE_REFUSALS, out.counts + 4);
}

ale_estimate_record_t record_of(const ale_estimate_t &estimate)
{
    constexpr int64_t thousandths_per_si = 1000000000;
    ale_estimate_record_t out{};
    out.t = seconds(estimate.stamp_us);
    out.x = metres(estimate.smooth.x_um);
    out.y = metres(estimate.smooth.y_um);
    out.theta = radians(estimate.smooth.theta_bam);
    out.map_x = metres(estimate.map.x_um);
    out.map_y = metres(estimate.map.y_um);
    out.map_theta = radians(estimate.map.theta_bam);
    for (int i = 0; i < 9; i++) {
        const int angles = (i / 3 == 2) + (i % 3 == 2);
        out.cov[i] = scaled(estimate.cov[i], 12 + 3 * angles);
    }
    for (int i = 0; i < 6; i++) {
        const int64_t thousandths = ale_mul_shift(estimate.information[i], thousandths_per_si, 20);
        out.information[i] = static_cast<double>(thousandths) / 1000;
    }
    out.velocity[0] = metres(estimate.velocity_x_um_s);
    out.velocity[1] = metres(estimate.velocity_y_um_s);
    out.velocity[2] = static_cast<double>(estimate.velocity_theta_urad_s) / micro;
    out.scan = estimate.scan;
    out.map_id = estimate.map_id;
    out.lag_us = estimate.lag_us;
    out.matched_lines = estimate.matched_lines;
    out.matched_corners = estimate.matched_corners;
    out.state = estimate.state;
    out.predicted = estimate.predicted;
    out.maps = estimate.maps;
    out.wheel_fault = estimate.wheel_fault;
    return out;
}

ale_wall_record_t record_of(const ale_map_line_t &wall)
{
    ale_wall_record_t out{};
    out.x1 = metres(wall.start.x_um);
    out.y1 = metres(wall.start.y_um);
    out.x2 = metres(wall.end.x_um);
    out.y2 = metres(wall.end.y_um);
    out.cov[0] = scaled(wall.var_alpha_nrad2, 18);
    out.cov[1] = scaled(wall.cov_alpha_rho, 15);
    out.cov[2] = scaled(wall.var_rho_um2, 12);
    out.id = wall.id;
    out.seen = wall.seen;
    out.map_id = wall.map_id;
    return out;
}

ale_map_corner_record_t record_of(const ale_map_corner_t &corner)
{
    ale_map_corner_record_t out{};
    out.x = metres(corner.p.x_um);
    out.y = metres(corner.p.y_um);
    for (int i = 0; i < 3; i++) {
        out.cov[i] = scaled(corner.cov_um2[i], 12);
    }
    out.angle = opening_radians(corner.angle_bam);
    out.bisector = radians(corner.bisector_bam);
    out.seen = corner.seen;
    out.kind = corner.kind;
    return out;
}

} // namespace ale::binding
