"""Messages of the robot as Foxglove shows them. One call a message of LCM; to every sink of the context: a live server, a file.

    scene = Scene(context)                # Scene(context, Names("rover1")): topics and frames of one robot among several
    scene.take("ALE_POSE", data)          # what is no such message is counted: scene.malformed

Frames as in ROS (REP 105): map -> odom -> base_link -> laser. Times are the robot's.
"""
import math
import struct

import ale
from foxglove import Channel, channels
from foxglove.messages import (Color, Duration, FrameTransform, FrameTransforms, LaserScan, LinePrimitive, LinePrimitiveLineType, Log,
                               LogLevel, Point3, Pose, PoseInFrame, Quaternion, SceneEntity, SceneUpdate, SpherePrimitive, Timestamp,
                               Vector3)

from .names import Names

STATES = ("lost", "weak", "good")
NO_RETURN, TOO_NEAR = 0x81, 0x85  # codes of beams without a range
LINE, CORNER, WALL, APART, PLAN, KEYFRAME, LOOP = (Color(r=r, g=g, b=b, a=1.0) for r, g, b in (
    (0.1, 0.5, 1.0), (1.0, 0.4, 0.1), (0.9, 0.9, 0.9), (0.7, 0.3, 1.0), (0.2, 0.9, 0.4), (0.7, 0.85, 0.3), (1.0, 0.35, 0.25)))
RECOGNISED, JOINS = 0, 2  # kinds of loops: of the least and the greatest weight


def turn(theta):
    return Quaternion(x=0.0, y=0.0, z=math.sin(theta / 2), w=math.cos(theta / 2))


def pose_of(x, y, theta):
    return Pose(position=Vector3(x=x, y=y, z=0.0), orientation=turn(theta))


def stamp(utime):
    return Timestamp(sec=max(utime, 0) // 1000000, nsec=max(utime, 0) % 1000000 * 1000)


def transform(utime, parent, child, x, y, theta):
    return FrameTransform(timestamp=stamp(utime), parent_frame_id=parent, child_frame_id=child,
                          translation=Vector3(x=x, y=y, z=0.0), rotation=turn(theta))


def correction(pose):
    """odom as seen from map."""
    theta = pose.map_theta - pose.theta
    c, s = math.cos(theta), math.sin(theta)
    return pose.map_x - c * pose.x + s * pose.y, pose.map_y - s * pose.x - c * pose.y, theta


def ranges_of(scan):
    without = {NO_RETURN: math.inf, TOO_NEAR: 0.0}
    unit = max(scan.range_unit_mm, 1) / 1000
    return [r * unit if code == 0 else without.get(code, math.nan) for r, code in zip(scan.range_mm, scan.codes)]


def segments(lines, colour, width):
    points = [Point3(x=x, y=y, z=0.0) for line in lines for x, y in ((line.x1, line.y1), (line.x2, line.y2))]
    return LinePrimitive(type=LinePrimitiveLineType.LineList, thickness=width, color=colour, points=points)


def way(plan):
    points = [Point3(x=x, y=y, z=0.0) for x, y in zip(plan.x, plan.y)]
    return LinePrimitive(type=LinePrimitiveLineType.LineStrip, thickness=0.06, color=PLAN, points=points) if points else None


def edges(graph, ends, colour, width):
    """Between keyframes, as pairs of their indices."""
    points = [Point3(x=graph.x[k], y=graph.y[k], z=0.0) for pair in ends for k in pair]
    return LinePrimitive(type=LinePrimitiveLineType.LineList, thickness=width, color=colour, points=points) if points else None


def ball(x, y, size, colour):
    return SpherePrimitive(pose=pose_of(x, y, 0.0), size=Vector3(x=size, y=size, z=size), color=colour)


def entity(name, frame, utime, seconds, lines=(), spheres=()):
    """seconds: it is gone then; 0: it stays until the next one of that name."""
    return SceneUpdate(entities=[SceneEntity(
        id=name, frame_id=frame, timestamp=stamp(utime), lifetime=Duration(sec=int(seconds), nsec=int(seconds % 1 * 1e9)),
        lines=[line for line in lines if line], spheres=list(spheres))])


class Scene:
    def __init__(self, context, names=Names()):
        def made(kind, topic):
            return kind(names.topic(topic), context=context)
        self.frame = names.frame
        self.scan = made(channels.LaserScanChannel, "/scan")
        self.lines = made(channels.SceneUpdateChannel, "/lines")
        self.corners = made(channels.SceneUpdateChannel, "/corners")
        self.walls = made(channels.SceneUpdateChannel, "/map")
        self.plan = made(channels.SceneUpdateChannel, "/plan")
        self.graph = made(channels.SceneUpdateChannel, "/graph")
        self.pose = made(channels.PoseInFrameChannel, "/pose")
        self.wheels = made(channels.PoseInFrameChannel, "/odometry")
        self.tf = made(channels.FrameTransformsChannel, "/tf")
        self.log = made(channels.LogChannel, "/log")
        self.signals = Channel(names.topic("/signals"), schema={"type": "object", "title": "ale.signals"}, context=context)
        self.health = Channel(names.topic("/health"), schema={"type": "object", "title": "ale.health"}, context=context)
        self.takers = {"ALE_SCAN": (ale.scan_t, self.take_scan), "ALE_POSE": (ale.pose_t, self.take_pose),
                       "ALE_TRACKING": (ale.tracking_t, self.take_tracking), "ALE_FEATURES": (ale.features_t, self.take_features),
                       "ALE_MAP": (ale.map_t, self.take_map), "ALE_MAP_PIECES": (ale.map_pieces_t, self.take_pieces),
                       "ALE_STATUS": (ale.status_t, self.take_status), "ALE_ODOMETRY": (ale.odometry_t, self.take_odometry),
                       "ALE_PLAN": (ale.plan_t, self.take_plan), "ALE_GRAPH": (ale.graph_t, self.take_graph)}
        self.newest = None  # pose
        self.parts, self.pieces, self.apart = {}, {}, (0, frozenset())
        self.said = {}
        self.malformed = 0

    def take(self, channel, data):
        kind, taker = self.takers.get(channel, (None, None))
        if not kind:
            return
        try:
            taker(kind.decode(data))
        except (ValueError, OverflowError, struct.error, IndexError, MemoryError, UnicodeDecodeError):
            self.malformed += 1

    def take_scan(self, scan):
        if scan.num_ranges != scan.num_codes or scan.num_ranges == 0:
            raise ValueError
        first = scan.first_bearing
        self.scan.log(LaserScan(timestamp=stamp(scan.utime), frame_id=self.frame("laser"), pose=pose_of(0.0, 0.0, 0.0), start_angle=first,
                                end_angle=first + scan.step * (scan.num_ranges - 1), ranges=ranges_of(scan), intensities=[]),
                      log_time=scan.utime * 1000)
        self.mount(scan)

    def mount(self, message):
        self.link(message.utime, "base_link", "laser", message.sensor_x, message.sensor_y, message.sensor_theta)

    def link(self, utime, parent, child, x, y, theta):
        self.tf.log(FrameTransforms(transforms=[transform(utime, self.frame(parent), self.frame(child), x, y, theta)]), log_time=utime * 1000)

    def take_pose(self, pose):
        at = pose.utime * 1000
        self.newest = pose
        self.link(pose.utime, "odom", "base_link", pose.x, pose.y, pose.theta)
        self.signals.log({
            "scan": pose.scan, "state": pose.state, "predicted": bool(pose.predicted),
            "smooth": {"x": pose.x, "y": pose.y, "theta": pose.theta},
            "map": {"x": pose.map_x, "y": pose.map_y, "theta": pose.map_theta},
            "sigma": {"x": root(pose.cov[0]), "y": root(pose.cov[4]), "theta": root(pose.cov[8])},
            "velocity": {"x": pose.vx, "y": pose.vy, "omega": pose.omega},
            "lag_us": pose.lag_us, "latency_us": max(0, pose.age_us - (pose.arrival_utime - pose.utime)),
            "stage_us": dict(zip(("deskew", "smooth", "extract", "match", "map"), (ns / 1000 for ns in pose.stage_ns)))}, log_time=at)

    def take_tracking(self, tracking):
        """map -> odom only while it is known where in the first map the robot is."""
        pose = self.newest
        if pose is None or pose.scan != tracking.scan or tracking.map_id != 0:
            return
        self.link(pose.utime, "map", "odom", *correction(pose))
        self.pose.log(PoseInFrame(timestamp=stamp(pose.utime), frame_id=self.frame("map"), pose=pose_of(pose.map_x, pose.map_y, pose.map_theta)),
                      log_time=pose.utime * 1000)

    def take_odometry(self, sample):
        self.wheels.log(PoseInFrame(timestamp=stamp(sample.utime), frame_id=self.frame("wheels"), pose=pose_of(sample.x, sample.y, sample.theta)),
                        log_time=sample.utime * 1000)

    def take_features(self, features):
        at = features.utime * 1000
        self.lines.log(entity("lines", self.frame("laser"), features.utime, 0.5, [segments(features.lines, LINE, 0.03)]), log_time=at)
        spheres = [ball(corner.x, corner.y, 0.08, CORNER) for corner in features.corners]
        self.corners.log(entity("corners", self.frame("laser"), features.utime, 0.5, spheres=spheres), log_time=at)

    def take_map(self, part):
        whole = gathered(self.parts, part)
        if whole:
            version, apart = self.apart
            walls = [line for each in whole for line in each.lines]
            elsewhere = [line for line in walls if version == part.version and line.id in apart]
            here = [line for line in walls if line not in elsewhere]
            primitives = [segments(here, WALL, 0.05), segments(elsewhere, APART, 0.05) if elsewhere else None]
            self.walls.log(entity("walls", self.frame("map"), part.utime, 0, primitives), log_time=part.utime * 1000)

    def take_pieces(self, part):
        whole = gathered(self.pieces, part)
        if whole:
            self.apart = (part.version, frozenset(line for each in whole for line in each.line_id))

    def take_graph(self, graph):
        """The colours of keyframes are those of the maps that they are in; loops are the thinner the less they moved."""
        loops = list(zip(graph.loop_from, graph.loop_to, graph.loop_kind))
        if not all(0 <= a < b < graph.num_keyframes and RECOGNISED <= kind <= JOINS for a, b, kind in loops):
            raise ValueError
        colours = [APART if map_id else KEYFRAME for map_id in graph.map_id]
        ties = [(k - 1, k) for k in range(1, graph.num_keyframes) if graph.tied[k]]
        lines = [edges(graph, [tie for tie in ties if colours[tie[1]] is colour], colour, 0.02) for colour in (KEYFRAME, APART)]
        lines += [edges(graph, [(a, b) for a, b, of in loops if of == kind], LOOP, 0.01 * (1 + kind)) for kind in range(RECOGNISED, JOINS + 1)]
        dots = [ball(x, y, 0.08, colour) for x, y, colour in zip(graph.x, graph.y, colours)]
        self.graph.log(entity("graph", self.frame("map"), graph.utime, 0, lines, dots), log_time=graph.utime * 1000)

    def take_plan(self, plan):
        """The robot repeats it every second while there is one."""
        place = [ball(plan.place_x, plan.place_y, 0.2, PLAN)] if plan.has_place else []
        self.plan.log(entity("plan", self.frame("map"), plan.utime, 3, [way(plan)], place), log_time=plan.utime * 1000)

    def take_status(self, status):
        at = status.utime * 1000
        counters = dict(zip(status.counter_name, status.counter_value))
        self.health.log({
            "scans": status.scans, "poses": status.poses, "state": status.state, "scan_rate_hz": status.scan_rate_hz,
            "latency_us": {"p50": status.latency_p50_us, "p99": status.latency_p99_us, "worst": status.latency_worst_us},
            "stage_p99_us": dict(zip(("deskew", "smooth", "extract", "match", "map", "total"), status.stage_p99_us)),
            "deadline_misses": status.deadline_misses, "counters": counters}, log_time=at)
        good = status.driver_state.startswith("streaming")
        self.say("scanner", status, LogLevel.Info if good else LogLevel.Error, status.driver_state)
        self.say("tracking", status, (LogLevel.Error, LogLevel.Warning, LogLevel.Info)[min(max(status.state, 0), 2)],
                 STATES[min(max(status.state, 0), 2)])
        self.say("exploration", status, LogLevel.Info, status.exploration)
        self.say("commands", status, LogLevel.Info if status.command_obeyed else LogLevel.Warning,
                 f"{status.command_operator}: {status.command_result}" if status.command_operator else "")

    def say(self, name, status, level, message):
        """What has changed, and once a minute all again."""
        now = status.utime
        if message and (self.said.get(name, ("", 0))[0] != message or now - self.said[name][1] > 60000000):
            self.said[name] = (message, now)
            self.log.log(Log(timestamp=stamp(now), level=level, message=message, name=f"{status.robot} {name}", file="", line=0),
                         log_time=now * 1000)


def root(variance):
    return math.sqrt(max(variance, 0.0))


def gathered(kept, part):
    """All parts of this version when none is missing, else None."""
    if not 0 <= part.part < part.parts <= 1000:
        raise ValueError
    if next(iter(kept.values()), part).version != part.version or len(kept) >= part.parts:
        kept.clear()
    kept[part.part] = part
    return [kept[k] for k in sorted(kept)] if len(kept) == part.parts else None
