#include "lab/merge/join_drives.h"

#include <utility>

#include "graph/optimise/scan_alignment.h"

namespace merge
{

namespace
{

using ale::Pose;

/* Where drives began relative to each other nobody knows: frames lie so far apart that no wheels can have
 * led from one to the other. */
constexpr double apart_m = 10000;
/* Between two drives: enough for a loop between the end of the one and the beginning of the next. */
constexpr double path_between_m = 1000;

Pose set_apart(const Pose &pose, uint32_t frame)
{
    return {pose.x + apart_m * frame, pose.y, pose.theta};
}

Pose set_back(const Pose &pose, uint32_t frame)
{
    return {pose.x - apart_m * frame, pose.y, pose.theta};
}

/* The same join of frames that are set apart, and back. */
ale::MapJoin set_apart(ale::MapJoin join)
{
    const Pose back = set_back({0, 0, 0}, join.map_id);
    join.shift = set_apart(compose(join.shift, back), join.into_map_id);
    return join;
}

ale::MapJoin set_back(ale::MapJoin join)
{
    const Pose apart = set_apart({0, 0, 0}, join.map_id);
    join.shift = set_back(compose(join.shift, apart), join.into_map_id);
    return join;
}

size_t nodes_of(const std::vector<DriveGroup> &groups)
{
    size_t count = 0;
    for (const DriveGroup &group : groups) {
        for (const Drive &drive : group.drives) {
            count += drive.nodes.size();
        }
    }
    return count;
}

/* The nodes of a drive, on the way after all before them. */
void append(const Drive &drive, uint32_t first_scan, ale::LoopCloser *closer)
{
    for (size_t k = 0; k < drive.nodes.size(); k++) {
        ale::Node node = drive.nodes[k];
        node.scan += first_scan;
        node.tracked = set_apart(node.tracked, node.map_id);
        Pose motion = node.tracked;
        if (!closer->nodes().empty()) {
            const ale::Node &before = closer->nodes().back();
            const bool is_beside = before.map_id == node.map_id; /* known to be where they are */
            const bool follows = k > 0 && is_beside;
            motion = ale::between(is_beside ? before.tracked : closer->poses().back(), node.tracked);
            node.path_m = before.path_m + (follows ? ale::length(motion.x, motion.y) : path_between_m);
            node.broken = node.broken || (k == 0 && !is_beside);
            node.weak = node.weak || k == 0;
        }
        closer->append(std::move(node), motion);
    }
}

/* The drives of a group, joined as they are known to be. */
void append(DriveGroup group, SearchedDrives *all)
{
    const int first_node = static_cast<int>(all->closer.nodes().size());
    number_frames(frames_of(all->group.drives), &group);
    for (Drive &drive : group.drives) {
        append(drive, all->scans, &all->closer);
        all->scans += static_cast<uint32_t>(drive.scans.size());
        all->group.drives.push_back(std::move(drive));
    }
    for (ale::FoundJoin &found : group.joins) {
        for (ale::Loop &loop : found.loops) {
            loop.from += first_node;
            loop.to += first_node;
        }
        all->closer.make_join({set_apart(found.join), found.loops});
        all->group.joins.push_back(std::move(found));
    }
}

/* What lies among the drives so far. */
void search(SearchedDrives *all)
{
    std::vector<ale::FoundJoin> made;
    while (all->closer.join_maps(&made)) {
    }
    for (ale::FoundJoin &found : made) {
        all->group.joins.push_back({set_back(found.join), std::move(found.loops)});
    }
}

/* From a, `part` of the way to b. */
Pose blend(const Pose &a, const Pose &b, double part)
{
    return {a.x + part * (b.x - a.x), a.y + part * (b.y - a.y),
            a.theta + part * ale::wrapped(b.theta - a.theta)};
}

/* What has become of a node. */
struct Moved {
    Pose shift; /* of what it saw, from its frame as it was */
    uint32_t frame;
};

/* The same for all scans between two breaks. */
std::vector<size_t> stretches_of(const Drive &drive)
{
    std::vector<size_t> stretch; /* by scan */
    for (const DriveScan &scan : drive.scans) {
        stretch.push_back(stretch.empty() ? 0 : stretch.back() + (scan.follows ? 0 : 1));
    }
    return stretch;
}

/* The nodes that a scan lies between, both the same where the way leads to one only. `next`: the first at or
 * after the scan. */
std::pair<size_t, size_t> nodes_beside(const Drive &drive, const std::vector<size_t> &stretch, size_t scan,
                                       size_t next)
{
    const auto is_tied = [&](size_t node) { return stretch[drive.nodes[node].scan] == stretch[scan]; };
    const bool by_later = next < drive.nodes.size() && (next == 0 || is_tied(next));
    const bool by_earlier = next > 0 && (!by_later || is_tied(next - 1));
    return {by_earlier ? next - 1 : next, by_later ? next : next - 1};
}

/* The scans of a drive follow the nodes before and after them, as far as the way leads there. */
void bend(Drive *drive, const std::vector<Moved> &moved)
{
    const std::vector<size_t> stretch = stretches_of(*drive);
    size_t next = 0;
    for (size_t k = 0; k < drive->scans.size(); k++) {
        next += next < drive->nodes.size() && drive->nodes[next].scan < k;
        const auto [first, last] = nodes_beside(*drive, stretch, k, next);
        const uint32_t from = drive->nodes[first].scan;
        const double part =
            first == last ? 0 : (static_cast<double>(k) - from) / (drive->nodes[last].scan - from);
        DriveScan &scan = drive->scans[k];
        scan.pose =
            blend(compose(moved[first].shift, scan.pose), compose(moved[last].shift, scan.pose), part);
        scan.frame = moved[first].frame;
    }
}

void take_over(const ale::LoopCloser &closer, std::vector<Drive> *drives)
{
    size_t k = 0; /* of the closer's nodes */
    for (Drive &drive : *drives) {
        std::vector<Moved> moved;
        for (ale::Node &node : drive.nodes) {
            const uint32_t frame = closer.nodes()[k].map_id;
            const Pose pose = set_back(closer.poses()[k], frame);
            moved.push_back({compose(pose, ale::inverse(node.tracked)), frame});
            node.tracked = pose;
            node.map_id = frame;
            k++;
        }
        bend(&drive, moved);
    }
}

/* Every scan of a frame, and not the keyframes alone, laid on what all have seen. */
void align(uint32_t frame, std::vector<Drive> *drives)
{
    std::vector<ale::AlignedScan> scans;
    std::vector<DriveScan *> aligned;
    for (Drive &drive : *drives) {
        const DriveScan *before = nullptr;
        for (DriveScan &scan : drive.scans) {
            if (scan.frame == frame) {
                const bool is_tied = scan.follows && before && before + 1 == &scan;
                scans.push_back({scan.pose, is_tied, scan.points});
                aligned.push_back(&scan);
                before = &scan;
            }
        }
    }
    ale::ScanAlignment alignment(std::move(scans));
    while (alignment.step()) {
    }
    for (size_t k = 0; k < aligned.size(); k++) {
        aligned[k]->pose = alignment.poses()[k];
    }
}

} // namespace

SearchedDrives search_joins(std::vector<DriveGroup> groups)
{
    SearchedDrives all{{}, ale::LoopCloser(nodes_of(groups)), 0};
    for (DriveGroup &group : groups) {
        append(std::move(group), &all);
        search(&all);
    }
    return all;
}

std::vector<Drive> join_drives(SearchedDrives searched)
{
    std::vector<Drive> drives = std::move(searched.group.drives);
    while (searched.closer.refine()) {
    }
    take_over(searched.closer, &drives);
    for (uint32_t frame = 0; frame < frames_of(drives); frame++) {
        align(frame, &drives);
    }
    for (Drive &drive : drives) {
        for (ale::Node &node : drive.nodes) {
            node.tracked = drive.scans[node.scan].pose;
        }
    }
    return drives;
}

} // namespace merge
