"""A robot that is not there: publishes over LCM what the firmware would, driving a circle in two rooms.

    robot = RobotDouble(url)
    robot.step()          # one scan: pose, tracking, features, scan; the map and the status with the first one
    robot.drive(scans)    # so many
"""
import math
import time

import ale
import lcm

from signing import Key, digest, signed

WALLS = [  # x1 y1 x2 y2: two rooms with a door between them, and a pillar
    (-2.0, -1.6, 3.0, -1.6), (3.0, -1.6, 3.0, -0.4), (3.0, 0.5, 3.0, 2.0), (3.0, 2.0, -2.0, 2.0),
    (-2.0, 2.0, -2.0, -1.6), (3.0, -1.6, 6.0, -1.6), (6.0, -1.6, 6.0, 2.0), (6.0, 2.0, 3.0, 2.0),
    (-0.2, 0.7, 0.3, 0.7), (0.3, 0.7, 0.3, 1.2), (0.3, 1.2, -0.2, 1.2), (-0.2, 1.2, -0.2, 0.7),
]
BEAMS = 682
STEP = 2 * math.pi / 1024
FIRST_BEARING = -340 * STEP
RANGE_MAX = 4.0
BEAM_TIME = 97.656e-6
STAMP_BEAM = -44
RADIUS, OMEGA, SCANS_A_SECOND = 0.7, 0.3, 10  # of its circle
MAP_LINES_A_PART = 7
GRAPH = [(0.5 + r * math.sin(a), 0.1 - r * math.cos(a), a) for a, r in ((k * 0.3, 0.9 + 0.03 * k) for k in range(22))]  # keyframes: a spiral
WHEELS = ["fine", "contradict", "stalled", "reversed", "late", "scale"]


def cast(x, y, bearing):
    """Distance to the nearest wall, or None beyond the scanner's reach."""
    dx, dy = math.cos(bearing), math.sin(bearing)
    nearest = RANGE_MAX
    for x1, y1, x2, y2 in WALLS:
        ex, ey = x2 - x1, y2 - y1
        det = ex * dy - ey * dx
        if abs(det) < 1e-9:
            continue
        along = ((x - x1) * dy - (y - y1) * dx) / det
        reach = ((x - x1) * ey - (y - y1) * ex) / det
        if 0 <= along <= 1 and 0 < reach < nearest:
            nearest = reach
    return nearest if nearest < RANGE_MAX else None


def to_robot(pose, x, y):
    dx, dy = x - pose[0], y - pose[1]
    c, s = math.cos(pose[2]), math.sin(pose[2])
    return c * dx + s * dy, -s * dx + c * dy


class RobotDouble:
    def __init__(self, url, boot=1, own_key=None):
        """own_key: the file of its secret key; it vouches as soon as that is there."""
        self.bus = lcm.LCM(url)
        self.name = "double"
        self.own_key = own_key
        self.vouched = 0
        self.sent = []  # (scan, digest) of poses
        self.boot = boot
        self.scan = 0
        self.state = 2
        self.driver = "streaming"
        self.map_id, self.maps, self.wheels = 0, 1, "fine"
        self.who_drives = self.exploration = ""
        self.refused = False
        self.lost_scans = 1
        self.observability = [0.0] * 6
        self.blind_beams = 0  # so many from the first on see nothing
        self.wheel_scale = None  # what the wheels say of the way, 1: the truth; None: there are none
        self.flights = 0  # that it has written
        self.answer = ("", 0, "")  # operator, counter and result of the last command

    @property
    def where(self):
        return self.where_after(0)

    def where_after(self, seconds):
        """Pose of the robot so long after the stamp of the scan now due."""
        turn = OMEGA * (self.scan / SCANS_A_SECOND + seconds)
        return (0.5 + RADIUS * math.sin(turn), -0.6 + RADIUS * (1 - math.cos(turn)), turn)

    def step(self):
        """Everything that goes out for one scan."""
        if self.scan == 0:
            self.publish_map()
            self.publish_status()
        elif self.scan % 10 == 0:
            self.publish_status()
        self.publish_pose()
        self.publish_tracking()
        self.publish_features()
        self.publish_scan()
        self.scan += 1

    def drive(self, scans):
        """Not faster than who listens gets a processor on a busy machine: the kernel keeps 200 kB for him."""
        for _ in range(scans):
            self.step()
            time.sleep(0.02)

    def pose(self):
        x, y, theta = self.where
        now = time.time_ns() // 1000
        sigma = (0.004, 0.006, 0.003)
        pose = ale.pose_t()
        pose.utime, pose.scan, pose.state = now - 70000, self.scan, self.state
        pose.x, pose.y, pose.theta = x, y, theta
        pose.map_x, pose.map_y, pose.map_theta = x, y, theta
        pose.cov = [sigma[k // 4] ** 2 if k % 4 == 0 else 0.0 for k in range(9)]
        pose.observability = self.observability
        pose.vx, pose.omega = RADIUS * OMEGA, OMEGA
        pose.first_beam_utime, pose.arrival_utime, pose.age_us = now - 66000, now - 1400, 70000
        pose.stage_ns = [41000, 180000 + 9000 * (self.scan % 7), 240000, 310000, 60000]
        begin = 20000
        for k, spent in enumerate(pose.stage_ns):
            pose.stage_start_ns[k], pose.stage_end_ns[k] = begin, begin + spent
            begin += spent
        return pose

    def publish_pose(self):
        pose = self.pose()
        if self.wheel_scale is not None:
            self.publish_odometry(pose)
        data = pose.encode()
        self.bus.publish("ALE_POSE", data)
        self.sent = self.sent[-31:] + [(self.scan, digest(data))]

    def publish_odometry(self, pose):
        sample = ale.odometry_t()
        sample.utime, sample.theta = pose.utime, pose.theta
        sample.x, sample.y = self.wheel_scale * pose.x, self.wheel_scale * pose.y
        self.bus.publish("ALE_ODOMETRY", sample.encode())

    def publish_tracking(self):
        tracking = ale.tracking_t()
        tracking.utime = time.time_ns() // 1000 - 70000
        tracking.scan, tracking.map_id, tracking.maps = self.scan, self.map_id, self.maps
        tracking.wheel_word, tracking.wheel_fault = self.wheels, WHEELS.index(self.wheels)
        tracking.wheel_faults = 0 if self.wheels == "fine" else 1
        self.bus.publish("ALE_TRACKING", tracking.encode())

    def publish_features(self):
        features = ale.features_t()
        features.utime, features.scan = time.time_ns() // 1000 - 70000, self.scan
        for x1, y1, x2, y2 in WALLS[:5]:
            line = ale.line_t()
            line.x1, line.y1 = to_robot(self.where, x1, y1)
            line.x2, line.y2 = to_robot(self.where, x2, y2)
            line.alpha = math.atan2(line.y2 - line.y1, line.x2 - line.x1) + math.pi / 2
            line.cov = [1e-6, 0.0, 4e-6]
            features.lines.append(line)
        for x, y in ((-2.0, -1.6), (-2.0, 2.0), (3.0, 2.0)):
            corner = ale.corner_t()
            corner.x, corner.y = to_robot(self.where, x, y)
            corner.kind, corner.cov = 1, [9e-6, 2e-6, 4e-6]
            features.corners.append(corner)
        features.num_lines, features.num_corners = len(features.lines), len(features.corners)
        self.bus.publish("ALE_FEATURES", features.encode())

    def publish_scan(self):
        scan = ale.scan_t()
        scan.utime = time.time_ns() // 1000 - 70000
        scan.scan, scan.stamp_beam, scan.beam_time_us = self.scan, STAMP_BEAM, BEAM_TIME * 1e6
        scan.first_bearing, scan.step, scan.range_max = FIRST_BEARING, STEP, RANGE_MAX
        scan.range_unit_mm = 1
        ranges = [None if k < self.blind_beams else self.range_of(k) for k in range(BEAMS)]
        scan.range_mm = [0 if r is None else round(r * 1000) for r in ranges]
        codes = [0x81 if r is None else 0 for r in ranges]
        codes[100] = 7
        scan.codes = bytes(codes)
        scan.num_ranges = scan.num_codes = BEAMS
        self.bus.publish("ALE_SCAN", scan.encode())

    def range_of(self, beam):
        x, y, theta = self.where_after((beam - STAMP_BEAM) * BEAM_TIME)
        return cast(x, y, theta + FIRST_BEARING + beam * STEP)

    def map_parts(self, version=1):
        parts = [WALLS[k:k + MAP_LINES_A_PART] for k in range(0, len(WALLS), MAP_LINES_A_PART)]
        for number, walls in enumerate(parts):
            part = ale.map_t()
            part.version, part.part, part.parts = version, number, len(parts)
            for wall in walls:
                line = ale.map_line_t()
                line.id, line.seen = WALLS.index(wall), 40
                line.x1, line.y1, line.x2, line.y2 = wall
                part.lines.append(line)
            part.num_lines = len(part.lines)
            yield part

    def publish_map(self, version=1):
        for part in self.map_parts(version):
            self.bus.publish("ALE_MAP", part.encode())

    def publish_pieces(self, walls, map_id=1, version=1):
        """Those walls are in another map, not joined."""
        pieces = ale.map_pieces_t()
        pieces.version, pieces.part, pieces.parts = version, 0, 1
        pieces.line_id, pieces.map_id = list(walls), [map_id] * len(walls)
        pieces.num_lines = len(walls)
        self.bus.publish("ALE_MAP_PIECES", pieces.encode())

    def publish_graph(self, apart=0, loops=((0, 20, 1), (1, 18, 0)), left_out=0, first_scan=0):
        """Keyframes around its circle, the last `apart` of them in another map; loops as (from, to, kind)."""
        graph = ale.graph_t()
        graph.version, graph.keyframes_left_out = 1, left_out
        graph.num_keyframes = len(GRAPH)
        graph.scan = [first_scan + 10 * k for k in range(len(GRAPH))]
        graph.x, graph.y, graph.theta = ([place[k] for place in GRAPH] for k in range(3))
        graph.map_id = [0] * (len(GRAPH) - apart) + [1] * apart
        graph.tied = [int(k > 0 and k != len(GRAPH) - apart) for k in range(len(GRAPH))]
        graph.num_loops = len(loops)
        graph.loop_from, graph.loop_to, graph.loop_kind = ([loop[k] for loop in loops] for k in range(3))
        self.bus.publish("ALE_GRAPH", graph.encode())

    def publish_plan(self, state, words="", place=None, path=()):
        """state: 3 drives to a place, 4 is there, 5 has given it up."""
        plan = ale.plan_t()
        plan.state, plan.words, plan.has_place = state, words, place is not None
        plan.place_x, plan.place_y = place or (0, 0)
        plan.x, plan.y = [x for x, _ in path], [y for _, y in path]
        plan.num_points = len(path)
        self.bus.publish("ALE_PLAN", plan.encode())

    def publish_status(self):
        status = self.status()
        self.bus.publish("ALE_STATUS", status.encode())
        if self.own_key and self.own_key.exists():
            self.bus.publish("ALE_VOUCHED", self.vouch(status))

    def vouch(self, status):
        key = Key(self.own_key)
        self.vouched += 1
        message = ale.vouched_t()
        message.utime, message.key, message.boot, message.counter = status.utime, key.number, status.boot, self.vouched
        message.clock_ppm, message.status = 1000000, status
        message.num_poses = len(self.sent)
        message.pose_scan, message.pose_digest = [scan for scan, _ in self.sent], [number for _, number in self.sent]
        return signed(message, key)

    def status(self):
        status = ale.status_t()
        status.utime = time.time_ns() // 1000
        status.boot, status.scans, status.poses, status.state = self.boot, self.scan, self.scan, self.state
        status.stage_last_us = [41, 190, 240, 310, 60, 841]
        status.stage_p99_us = [55, 260, 330, 480, 110, 1170]
        status.stage_worst_us = [80, 390, 520, 700, 160, 1690]
        status.latency_p50_us, status.latency_p99_us, status.latency_worst_us = 1400, 2300, 4100
        status.realtime_detail = "SCHED_FIFO 60, memory locked"
        status.realtime = True
        status.driver_state = self.driver
        status.device = "URG-04LX H0000001"
        status.scan_rate_hz = 10.0
        status.counter_name = ["bad_checksum", "scans_lost", "odometry", "resets", "flight_recordings"]
        status.counter_value = [3, self.lost_scans, 200, 0, self.flights]
        status.num_counters = 5
        status.robot, status.takes_commands = self.name, True
        status.who_drives, status.exploration, status.command_obeyed = self.who_drives, self.exploration, not self.refused
        status.command_operator, status.command_counter, status.command_result = self.answer
        return status
