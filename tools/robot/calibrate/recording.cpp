#include "robot/calibrate/recording.h"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "lab/replay/log_reader.h"
#include "robot/calibrate/statistics.h"

namespace calibrate
{

namespace
{

constexpr double radians_per_bam = 6.283185307179586 / 4294967296.0;
constexpr double not_a_value = std::numeric_limits<double>::quiet_NaN();

bool same_geometry(const ale_scan_t &a, const ale_scan_t &b)
{
    return a.beams == b.beams && a.first_bearing_bam == b.first_bearing_bam && a.step_bam == b.step_bam;
}

std::vector<double> ranges_of(const ale_scan_t &scan)
{
    std::vector<double> ranges(scan.beams, not_a_value);
    for (size_t k = 0; k < scan.beams; k++) {
        if (scan.flag[k] == ALE_BEAM_VALID) {
            ranges[k] = scan.range_um[k] * 1e-6;
        }
    }
    return ranges;
}

/* Beams whose median differs between the first and the last third of the recording by more than noise. */
double share_of_moved_beams(const Eigen::MatrixXd &range)
{
    constexpr double noticeable = 0.03;
    const Eigen::Index third = range.rows() / 3;
    int compared = 0;
    int moved = 0;
    for (Eigen::Index beam = 0; beam < range.cols(); beam++) {
        const Spread before = robust_spread(range.col(beam).head(third));
        const Spread after = robust_spread(range.col(beam).tail(third));
        if (before.count < third / 2 || after.count < third / 2) {
            continue;
        }
        compared++;
        moved += std::abs(before.median - after.median) > std::max(noticeable, 4 * before.sigma);
    }
    return compared > 0 ? static_cast<double>(moved) / compared : 0;
}

} // namespace

Recording read_recording(const std::string &path)
{
    ale::LogReader log(path);
    Recording recording;
    std::vector<std::vector<double>> rows;
    const auto event = std::make_unique<ale_log_event_t>();
    while (rows.size() < most_scans && log.next(*event)) {
        if (event->kind != ALE_LOG_SCAN) {
            continue;
        }
        if (!recording.geometry) {
            recording.geometry = std::make_unique<ale_scan_t>(event->scan);
        } else if (!same_geometry(*recording.geometry, event->scan)) {
            throw std::runtime_error(path + ": scans of different geometry");
        }
        rows.push_back(ranges_of(event->scan));
    }
    if (rows.size() < least_scans) {
        throw std::runtime_error(path + ": " + std::to_string(rows.size()) + " scans, at least " +
                                 std::to_string(least_scans) + " are needed");
    }
    recording.range.resize(static_cast<Eigen::Index>(rows.size()), recording.geometry->beams);
    for (size_t k = 0; k < rows.size(); k++) {
        recording.range.row(static_cast<Eigen::Index>(k)) =
            Eigen::Map<Eigen::RowVectorXd>(rows[k].data(), recording.range.cols());
    }
    recording.first_bearing = static_cast<int32_t>(recording.geometry->first_bearing_bam) * radians_per_bam;
    recording.step = recording.geometry->step_bam * radians_per_bam;
    if (share_of_moved_beams(recording.range) > 0.2) {
        throw std::runtime_error(path + ": the scanner moves; a recording at rest is needed");
    }
    return recording;
}

} // namespace calibrate
