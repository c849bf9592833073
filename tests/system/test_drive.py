"""A whole drive through the bundled home: pose, features and map against the simulated truth."""
import math
import statistics

import pytest

from chain import Truth, distance_to_wall, trajectory_error, walls_of

SPEEDS = (4, 2, 1, 1)  # slower where the machine is too busy to send or to hear all of it
ATE_M = 0.030
ATE_RAD = math.radians(0.5)
ON_A_WALL_M = 0.060  # noise, mixed pixels and the end of a wall together


@pytest.fixture(scope="module", params=["odometry", "no odometry"])
def drive(request, long_chain):
    """The chain after the drive, all answers received."""
    config = f"[odometry]\nuse = {'yes' if request.param == 'odometry' else 'no'}\n[lcm]\npublish_scan = yes\n"
    for speed in SPEEDS:
        long_chain.listener.forget()
        firmware = long_chain.firmware(config, speed=speed)
        counted = long_chain.play_to_the_end(long_chain.drive("home", speed=speed), firmware)
        if long_chain.all_went_well(counted):
            break
    long_chain.sent = counted["sent"]
    return long_chain


def test_every_scan_sent_is_answered_by_one_pose(drive):
    poses = drive.listener.poses
    assert len(poses) == drive.sent
    assert [pose.scan for pose in poses] == list(range(drive.sent))
    assert all(later.utime > earlier.utime for earlier, later in zip(poses, poses[1:]))


def test_every_pose_is_told_to_be_in_the_first_map_with_wheels_that_are_right(drive):
    told = drive.listener.messages["ALE_TRACKING"]
    assert [(one.scan, one.utime) for one in told] == [(pose.scan, pose.utime) for pose in drive.listener.poses]
    assert {(one.map_id, one.maps, one.wheel_fault, one.wheel_word) for one in told} == {(0, 1, 0, "fine")}
    assert drive.listener.counters()["maps"] == 1 and drive.listener.counters()["wheel_faults"] == 0
    pieces = drive.listener.messages["ALE_MAP_PIECES"]
    assert {piece.version for piece in pieces} == {part.version for part in drive.listener.map_parts}
    assert sum(piece.num_lines for piece in pieces) == 0


def test_the_pose_follows_the_truth(drive):
    metres, radians, count = trajectory_error(drive.listener.poses, Truth(drive.truth_path))
    print(f"error {metres * 1000:.1f} mm, {math.degrees(radians):.2f} degrees over {count} scans")
    assert count > 0.95 * drive.sent
    assert metres <= ATE_M
    assert radians <= ATE_RAD


def test_lines_and_corners_lie_on_true_walls(drive):
    truth = Truth(drive.truth_path)
    walls = walls_of("home")
    distances = []
    corners = []
    for message in drive.listener.features[::5]:
        pose = truth.world_at(message.utime * 1e-6)
        if pose is None:
            continue
        c, s = math.cos(pose[2]), math.sin(pose[2])
        to_world = lambda x, y: (pose[0] + c * x - s * y, pose[1] + s * x + c * y)  # noqa: E731
        for line in message.lines:
            for x, y in ((line.x1, line.y1), (line.x2, line.y2)):
                distances.append(min(distance_to_wall(wall, *to_world(x, y)) for wall in walls))
        for corner in message.corners:
            corners.append(min(distance_to_wall(wall, *to_world(corner.x, corner.y)) for wall in walls))
    on_walls = sum(distance < ON_A_WALL_M for distance in distances) / len(distances)
    print(f"{len(distances)} line ends, {100 * on_walls:.1f} % on walls, median "
          f"{1000 * statistics.median(distances):.1f} mm; {len(corners)} corners")
    assert len(distances) > 10 * drive.sent / 5
    assert on_walls > 0.97
    assert sum(distance < ON_A_WALL_M for distance in corners) > 0.95 * len(corners)
    assert len(corners) > drive.sent / 5


def test_scans_are_published_as_they_were_received(drive):
    scans = drive.listener.messages["ALE_SCAN"]
    assert len(scans) == drive.sent
    assert all(scan.num_ranges == 682 and scan.stamp_beam == -44 for scan in scans)
    assert all(abs(scan.beam_time_us - 97.656) < 0.5 for scan in scans)


def test_the_map_comes_whole(drive):
    parts = drive.listener.map_parts
    version = max(part.version for part in parts)
    newest = [part for part in parts if part.version == version]
    assert {part.part for part in newest} == set(range(newest[0].parts))
    assert sum(part.num_lines for part in newest) >= 30
    assert sum(part.num_corners for part in newest) >= 10


def test_the_graph_has_keyframes_along_the_drive_and_the_loops_that_it_closed(drive):
    graphs = drive.listener.messages["ALE_GRAPH"]
    versions = [graph.version for graph in graphs]
    assert versions == sorted(versions) and versions[0] == 1
    assert all(later.utime - graph.utime > 0.9e6 for graph, later in zip(graphs[:-2], graphs[1:]))
    last = graphs[-1]
    assert last.num_keyframes > 20 and (last.keyframes_left_out, last.loops_left_out) == (0, 0)
    assert list(last.scan) == sorted(set(last.scan)) and set(last.scan) <= {pose.scan for pose in drive.listener.poses}
    assert set(last.map_id) == {0} and list(last.tied) == [0] + [1] * (last.num_keyframes - 1)
    poses = {pose.scan: pose for pose in drive.listener.poses}
    for scan, x, y in zip(last.scan, last.x, last.y):
        assert math.hypot(x - poses[scan].map_x, y - poses[scan].map_y) < 3 * ATE_M, "as published, but for what loops have moved"
    print(f"{last.num_keyframes} keyframes, {last.num_loops} loops")
    assert last.num_loops >= 1
    for a, b in zip(last.loop_from, last.loop_to):
        assert a < b and math.hypot(last.x[a] - last.x[b], last.y[a] - last.y[b]) < 4


def test_nothing_was_dropped_and_the_status_says_so(drive):
    statuses = drive.listener.statuses
    assert len(statuses) >= 10
    counters = drive.listener.counters()
    for name in ("bad_checksum", "bad_frame", "repeated", "scan_ring_full", "result_ring_full", "overloaded",
                 "odometry_ring_full", "odometry_refused", "messages_unsent"):
        assert counters[name] == 0, name
    assert counters["odometry"] > 100
    assert statuses[-1].scans == statuses[-1].poses == drive.sent
    assert "H0" in statuses[-1].device


def test_stage_times_are_reported(drive):
    status = drive.listener.statuses[-1]
    assert all(0 < p99 <= worst for p99, worst in zip(status.stage_p99_us, status.stage_worst_us))
    assert all(sum(pose.stage_ns) > 0 for pose in drive.listener.poses)
