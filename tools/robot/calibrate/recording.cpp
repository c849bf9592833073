#include "robot/calibrate/recording.h"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "common/log/log_reader.h"

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
        recording.time_s.push_back(static_cast<double>(event->scan.stamp_us) * 1e-6);
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
    return recording;
}

} // namespace calibrate
