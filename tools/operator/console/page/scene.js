// What is known of the robot and its world, in map coordinates (metres, x right, y up on the screen).

import { Occupancy } from "./occupancy.js";

const RECENT_POSES = 40;

export function compose(a, b) {
  const [c, s] = [Math.cos(a[2]), Math.sin(a[2])];
  return [a[0] + c * b[0] - s * b[1], a[1] + s * b[0] + c * b[1], a[2] + b[2]];
}

function inverse([x, y, turn]) {
  const [c, s] = [Math.cos(turn), Math.sin(turn)];
  return [-c * x - s * y, s * x - c * y, -turn];
}

export function apply(pose, x, y) {
  const [c, s] = [Math.cos(pose[2]), Math.sin(pose[2])];
  return [pose[0] + c * x - s * y, pose[1] + s * x + c * y];
}

export class Scene {
  constructor() {
    this.live = new Occupancy();
    this.replayed = new Occupancy(); // of the past or the recording that is looked at
    this.at = null; // what is shown is of then, milliseconds since 1970; null: of now
    this.recording = null; // the name of what is shown, unless it is the robot
    this.#forget();
  }

  #forget() {
    this.pose = null; // newest pose message
    this.plan = null; // newest: where the robot drives by itself
    this.tracking = null; // newest: which map the pose is in, what the wheels do
    this.recent = new Map(); // scan number -> pose message: features and scans are drawn where they were taken
    this.features = null;
    this.lines = []; // of the newest scan, [x1, y1, x2, y2]
    this.lineSigmas = []; // across the line at its ends, metres
    this.corners = []; // [x, y]
    this.cornerCovs = []; // [xx, xy, yy] in the map
    this.scan = null;
    this.points = []; // [x, y, ...] of the newest scan
    this.sight = []; // outline of what the scanner sees, [x, y, ...], sensor first
    this.map = null;
    this.mapBounds = null;
    this.graph = null; // newest: keyframes of the mapper, and loops between them
    this.trail = []; // [x, y, ...], null between stretches
    this.status = null;
  }

  take(message) {
    switch (message.type) {
      case "hello": this.#look(null, null); this.live.forget(); break;
      case "past": this.#look(message.at, message.recording); break;
      case "pose": this.#takePose(message); break;
      case "plan": this.plan = message; break;
      case "tracking": this.tracking = message; break;
      case "features": this.#takeFeatures(message); break;
      case "scan": this.#takeScan(message); break;
      case "map": this.map = message; this.mapBounds = bounds(message.lines); break;
      case "graph": this.graph = message; break;
      case "trail": this.trail = message.anew ? message.points : this.trail.concat(message.points); break;
      case "status": this.status = message; break;
    }
  }

  get occupancy() {
    return this.at === null ? this.live : this.replayed;
  }

  // Cells stay as long as time goes on.
  #look(at, recording) {
    if (at === null || at < this.at || recording !== this.recording) this.replayed.forget();
    this.#forget();
    [this.at, this.recording] = [at, recording];
  }

  #takePose(message) {
    this.pose = message;
    this.recent.set(message.scan, message);
    if (this.recent.size > RECENT_POSES) {
      this.recent.delete(this.recent.keys().next().value);
    }
    // A scan may have come before its pose.
    if (this.features?.scan === message.scan) this.#takeFeatures(this.features);
    if (this.scan?.scan === message.scan) this.#takeScan(this.scan);
  }

  #poseOf(scan) {
    return this.recent.get(scan) ?? this.pose;
  }

  #takeFeatures(message) {
    this.features = message;
    const pose = this.#poseOf(message.scan);
    if (!pose) return;
    const sensor = compose(pose.map, message.sensor);
    this.lines = message.lines.map((l) => [...apply(sensor, l.x1, l.y1), ...apply(sensor, l.x2, l.y2)]);
    this.lineSigmas = message.lines.map(endSigmas);
    this.corners = message.corners.map((c) => apply(sensor, c.x, c.y));
    this.cornerCovs = message.corners.map((c) => turned(c.cov, sensor[2]));
  }

  // Each beam is placed from where the robot was at the beam's own time: the scan of a turning robot is bent.
  #takeScan(message) {
    this.scan = message;
    const pose = this.#poseOf(message.scan);
    if (!pose) return;
    const [vx, vy, omega] = pose.velocity;
    const points = [];
    const sensorNow = compose(pose.map, message.sensor);
    const sight = [sensorNow[0], sensorNow[1]];
    for (let k = 0; k < message.ranges_mm.length; k++) {
      const range = message.ranges_mm[k] / 1000;
      if (range <= 0) continue;
      const dt = (k - message.stamp_beam) * message.beam_time_us * 1e-6;
      const robot = compose(pose.map, [vx * dt, vy * dt, omega * dt]);
      const bearing = message.first_bearing + k * message.step;
      const [x, y] = apply(compose(robot, message.sensor), range * Math.cos(bearing), range * Math.sin(bearing));
      points.push(x, y);
      sight.push(x, y);
    }
    this.points = points;
    this.sight = sight;
    if (pose.scan === message.scan && pose.state === "good") {
      this.occupancy.add(message.scan, points, sensorNow, this.tracking?.map_id ?? 0, compose(pose.map, inverse(pose.smooth)));
    }
  }

  // The wall or keyframe is in another map than the robot: where it is drawn says nothing.
  isApart(thing) {
    return (thing.map_id ?? 0) !== (this.tracking?.map_id ?? 0);
  }

  get hasWallsApart() {
    return this.map?.lines.some((line) => this.isApart(line)) ?? false;
  }

  // [left, bottom, right, top] of all there is to see; null when there is nothing.
  get bounds() {
    const robot = this.pose && [this.pose.map[0] - 1, this.pose.map[1] - 1, this.pose.map[0] + 1, this.pose.map[1] + 1];
    let all = join(this.mapBounds, robot);
    for (let k = 0; k < this.lines.length; k++) {
      const [x1, y1, x2, y2] = this.lines[k];
      all = join(all, [Math.min(x1, x2), Math.min(y1, y2), Math.max(x1, x2), Math.max(y1, y2)]);
    }
    return all;
  }
}

// How far the line may lie to the side at its two ends: rho and alpha are uncertain together.
function endSigmas(line) {
  const [aa, ar, rr] = line.cov;
  return [[line.x1, line.y1], [line.x2, line.y2]].map(([x, y]) => {
    const along = -x * Math.sin(line.alpha) + y * Math.cos(line.alpha);
    return Math.sqrt(Math.max(0, rr - 2 * along * ar + along * along * aa)) || 0;
  });
}

// A covariance seen from a frame that is turned by theta.
function turned([xx, xy, yy], theta) {
  const [c, s] = [Math.cos(theta), Math.sin(theta)];
  return [c * c * xx - 2 * c * s * xy + s * s * yy, c * s * (xx - yy) + (c * c - s * s) * xy,
          s * s * xx + 2 * c * s * xy + c * c * yy];
}

function join(a, b) {
  if (!a || !b) return a ?? b;
  return [Math.min(a[0], b[0]), Math.min(a[1], b[1]), Math.max(a[2], b[2]), Math.max(a[3], b[3])];
}

function bounds(lines) {
  return lines.reduce((all, l) =>
    join(all, [Math.min(l.x1, l.x2), Math.min(l.y1, l.y2), Math.max(l.x1, l.x2), Math.max(l.y1, l.y2)]), null);
}
