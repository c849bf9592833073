#include "lab/merge/drive_file.h"

#include <algorithm>
#include <fstream>

#include "lab/merge/number_file.h"
#include "lab/merge/whole_text.h"

namespace merge
{

namespace
{

constexpr std::string_view head = "ALE-SLAM drives 1\n";
constexpr size_t checksum_bytes = 4;

/* One description of what is passed serves both ways: File is a NumberWriter or a NumberReader. */
template <class File, class T> using Passed = typename File::template Passed<T>;

template <class File, class List> void pass_list(File &file, List &list);

template <class File> void pass(File &file, Passed<File, uint8_t> &number)
{
    file.numbers(number);
}

template <class File> void pass(File &file, Passed<File, char> &letter)
{
    file.numbers(letter);
}

template <class File> void pass(File &file, Passed<File, Eigen::Vector2d> &p)
{
    file.numbers(p.x(), p.y());
}

template <class File> void pass(File &file, Passed<File, ale::Pose> &pose)
{
    file.numbers(pose.x, pose.y, pose.theta);
}

template <class File> void pass(File &file, Passed<File, ale_pose_t> &pose)
{
    file.numbers(pose.x_um, pose.y_um, pose.theta_bam);
}

template <class File> void pass(File &file, Passed<File, ale::SurfacePoint> &point)
{
    pass(file, point.p);
    pass(file, point.normal);
}

template <class File> void pass(File &file, Passed<File, ale::WallDirection> &wall)
{
    file.numbers(wall.direction_rad, wall.length_m);
}

template <class File> void pass(File &file, Passed<File, ale::CornerFeature> &corner)
{
    pass(file, corner.p);
    file.numbers(corner.bisector_rad, corner.angle_rad, corner.convex);
}

template <class File> void pass(File &file, Passed<File, DriveScan> &scan)
{
    file.numbers(scan.stamp_us, scan.frame, scan.follows);
    pass(file, scan.pose);
    pass_list(file, scan.points);
}

template <class File> void pass(File &file, Passed<File, std::vector<bool>> &flags)
{
    std::vector<uint8_t> bytes(flags.begin(), flags.end());
    pass_list(file, bytes);
    if constexpr (!std::is_const_v<Passed<File, int>>) {
        flags.assign(bytes.begin(), bytes.end());
    }
}

template <class File> void pass(File &file, Passed<File, ale::Node> &node)
{
    file.numbers(node.scan, node.path_m, node.broken, node.weak, node.later_scans, node.map_id);
    pass(file, node.smooth);
    pass(file, node.tracked);
    pass(file, node.sensor);
    pass_list(file, node.walls);
    pass_list(file, node.points);
    pass(file, node.coarse_normal);
    pass_list(file, node.corners);
    pass_list(file, node.later_walls);
}

template <class File> void pass(File &file, Passed<File, ale_observation_t> &seen)
{
    file.numbers(seen.centre.x_um, seen.centre.y_um, seen.normal_bam, seen.start_um, seen.end_um,
                 seen.var_offset_um2, seen.var_angle_urad2, seen.start_time_us, seen.end_time_us,
                 seen.first_beam, seen.last_beam, seen.start_end, seen.end_end, seen.kind);
}

template <class File> void pass(File &file, Passed<File, ale_corner_t> &corner)
{
    file.numbers(corner.p.x_um, corner.p.y_um, corner.cov_um2[0], corner.cov_um2[1], corner.cov_um2[2],
                 corner.angle_bam, corner.bisector_bam, corner.first_line, corner.second_line, corner.kind);
}

template <class File> void pass(File &file, Passed<File, ale_scan_t> &scan)
{
    file.numbers(scan.stamp_us, scan.stamp_beam, scan.beam_time_ns, scan.first_bearing_bam, scan.step_bam,
                 scan.range_min_um, scan.range_max_um, scan.beams, scan.own_bearings);
    NumberReader::require(scan.beams <= ALE_MAX_BEAMS);
    for (size_t k = 0; k < scan.beams; k++) {
        file.numbers(scan.range_um[k], scan.flag[k], scan.code[k], scan.bearing_bam[k]);
    }
}

template <class File> void pass(File &file, Passed<File, ale_seen_copy_t> &seen)
{
    pass(file, seen.scan);
    pass(file, seen.robot);
    pass(file, seen.sensor);
    file.numbers(seen.straightened);
    for (size_t k = 0; k < seen.scan.beams; k++) {
        file.numbers(seen.bearing_bam[k]);
    }
}

template <class File> void pass(File &file, Passed<File, ale::RecordedScan> &scan)
{
    bool has_beams = scan.beams != nullptr;
    file.numbers(scan.scan, scan.keyframe, has_beams);
    pass(file, scan.smooth);
    pass(file, scan.tracked);
    pass_list(file, scan.lines);
    pass_list(file, scan.corners);
    if constexpr (!std::is_const_v<Passed<File, int>>) {
        scan.beams = has_beams ? std::make_unique<ale_seen_copy_t>() : nullptr;
    }
    if (has_beams) {
        pass(file, *scan.beams);
    }
}

void pass_record(NumberWriter &file, const ale::ObservationRecord &record)
{
    const std::vector<ale::RecordedScan> &scans = record.scans();
    file.numbers(record.epoch());
    pass(file, scans.empty() ? ale_pose_t{} : record.sensor(scans.front()));
    pass_list(file, scans);
}

void pass_record(NumberReader &file, ale::ObservationRecord &record)
{
    uint32_t epoch = 0;
    ale_pose_t sensor{};
    std::vector<ale::RecordedScan> scans;
    file.numbers(epoch);
    pass(file, sensor);
    pass_list(file, scans);
    record = ale::ObservationRecord(epoch, sensor, std::move(scans));
}

template <class File> void pass(File &file, Passed<File, Drive> &drive)
{
    pass_list(file, drive.name);
    file.numbers(drive.date_s, drive.checksum);
    pass(file, drive.sensor);
    pass_list(file, drive.scans);
    pass_list(file, drive.nodes);
    pass_record(file, drive.record);
}

template <class File> void pass(File &file, Passed<File, ale::Loop> &loop)
{
    file.numbers(loop.from, loop.to, loop.overlap);
    pass(file, loop.measured);
    for (int k = 0; k < loop.information.size(); k++) {
        file.numbers(loop.information.data()[k]);
    }
}

template <class File> void pass(File &file, Passed<File, ale::FoundJoin> &found)
{
    file.numbers(found.join.map_id, found.join.into_map_id);
    pass(file, found.join.shift);
    pass_list(file, found.loops);
}

template <class File, class List> void pass_list(File &file, List &list)
{
    file.count(list);
    for (auto &item : list) {
        pass(file, item);
    }
}

template <class File> void pass(File &file, Passed<File, DriveGroup> &group)
{
    pass_list(file, group.drives);
    pass_list(file, group.joins);
}

/* What is referred to is there. */
void check(const Drive &drive, uint32_t most_frames)
{
    const auto require = NumberReader::require;
    require(!drive.nodes.empty());
    for (const DriveScan &scan : drive.scans) {
        require(scan.frame < most_frames);
    }
    for (const ale::Node &node : drive.nodes) {
        require(node.scan < drive.scans.size() && node.map_id == drive.scans[node.scan].frame);
        require(node.points.size() == node.coarse_normal.size());
    }
    for (const ale::RecordedScan &scan : drive.record.scans()) {
        require(scan.scan < drive.scans.size());
    }
}

void check(const DriveGroup &group)
{
    size_t nodes = 0;
    uint32_t scans = 0;
    for (const Drive &drive : group.drives) {
        nodes += drive.nodes.size();
        scans += static_cast<uint32_t>(drive.scans.size());
    }
    NumberReader::require(!group.drives.empty());
    for (const Drive &drive : group.drives) {
        check(drive, scans);
    }
    const uint32_t frames = frames_of(group.drives);
    const auto is_node = [nodes](int k) { return k >= 0 && static_cast<size_t>(k) < nodes; };
    for (const ale::FoundJoin &found : group.joins) {
        NumberReader::require(found.join.map_id < frames && found.join.into_map_id < frames);
        for (const ale::Loop &loop : found.loops) {
            NumberReader::require(is_node(loop.from) && is_node(loop.to));
        }
    }
}

/* Without head and checksum. */
std::string_view body_of(std::string_view bytes)
{
    NumberReader::require(bytes.size() > head.size() + checksum_bytes &&
                          bytes.substr(0, head.size()) == head);
    const std::string_view checked = bytes.substr(0, bytes.size() - checksum_bytes);
    NumberReader end(bytes.substr(checked.size()));
    uint32_t checksum = 0;
    end.numbers(checksum);
    NumberReader::require(checksum == checksum_of(checked));
    return checked.substr(head.size());
}

DriveGroup parsed(std::string_view bytes)
{
    DriveGroup group;
    NumberReader file(body_of(bytes));
    pass(file, group);
    NumberReader::require(file.is_at_end());
    check(group);
    return group;
}

} // namespace

bool is_drive_file(const std::string &path)
{
    std::string start(head.size(), '\0');
    std::ifstream(path, std::ios::binary).read(start.data(), static_cast<std::streamsize>(start.size()));
    return start == head;
}

DriveGroup read_drive_file(const std::string &path)
{
    const std::string bytes = read_whole(path);
    try {
        return parsed(bytes);
    } catch (const std::runtime_error &wrong) {
        throw std::runtime_error(path + ": " + wrong.what());
    }
}

void write_drive_file(const std::string &path, const DriveGroup &group)
{
    NumberWriter body;
    pass(body, group);
    const std::string checked = std::string(head) + body.bytes();
    NumberWriter end;
    end.numbers(checksum_of(checked));
    write_whole(path, checked + end.bytes());
}

} // namespace merge
