// Why the state is not good, and what to do about it: a sentence or two beside the state, made of what the robot reports
// of itself. Where nothing it reports explains the state, what mostly helps is said.

import { countersThatDrop } from "./words.js";

const LATELY_US = 10e6; // counters that grew within that time are a cause
const FEW_BEAMS = 0.15; // part of the beams that see something; with fewer there is little to match
const ONE_WAY = 0.02; // what scans tell along the walls, as part of what they tell across them: next to nothing

// What a growing counter says, and what to do.
const DROPS = {
  scans_lost: "Scans get lost on the way from the scanner. Look at its cable and its plug.",
  overloaded: "The robot's computer is too busy: scans are left out. End other programs on it.",
  scan_ring_full: "The robot's computer is too busy: scans find no room. End other programs on it.",
  result_ring_full: "The robot's computer is too busy: results find no room. End other programs on it.",
};

const LINKS = {
  gone: "The program ale-console has ended, or this device has lost its network. Start it again; the page finds it by itself.",
  reports: "The robot reports itself, but sends no poses. See what it says of its scanner under Robot; if nothing, restart ale-slamd.",
  lost: "Nothing comes from the robot any more. It stands still by itself. Look at its power, its Wi-Fi and the bridge (ale-bridge).",
};

const HELPS = {
  weak: "What the scans show fits more than one place. Drive on slowly to where corners are in sight.",
  lost: "No place in the map agrees with the scans: the robot was carried, or much has changed. Drive to a place that it knows, or press “you are here”.",
};

export class Cause {
  constructor() {
    this.#forget();
  }

  #forget() {
    this.counts = []; // [utime, Map of what was dropped], of the last seconds
  }

  take(message) {
    if (message.type === "hello" || message.type === "past") this.#forget();
    if (message.type !== "status") return;
    this.counts.push([message.utime, new Map(countersThatDrop(message.counters).map(({ name, value }) => [name, value]))]);
    while (this.counts[0][0] < message.utime - LATELY_US) this.counts.shift();
  }

  // state: of the link, as it is shown; reports: a status came lately. Empty: all is well, or it is said elsewhere.
  words(state, scene, reports) {
    if (state === "gone") return LINKS.gone;
    if (state === "lost") return reports ? LINKS.reports : LINKS.lost;
    const pose = scene.pose?.state;
    if (!["up", "recording"].includes(state) || !(pose in HELPS)) return "";
    return this.#ofScans(scene) ?? (pose === "lost" ? ofMaps(scene) : null) ?? this.#ofWay(scene, pose) ?? HELPS[pose];
  }

  #ofScans(scene) {
    const [first, last] = [this.counts[0]?.[1], this.counts.at(-1)?.[1]];
    const grown = Object.keys(DROPS).find((name) => (last?.get(name) ?? 0) > (first?.get(name) ?? 0));
    if (grown) return DROPS[grown];
    const ranges = scene.scan?.ranges_mm ?? [];
    const used = ranges.filter((range) => range > 0).length;
    return ranges.length && used < FEW_BEAMS * ranges.length
      ? `Only ${used} of ${ranges.length} beams see anything: the robot is far from all walls, or its scanner is covered. Look at it, or drive nearer to walls.` : null;
  }

  #ofWay(scene, pose) {
    if (pose === "weak" && seesOneWay(scene.pose.observability)) {
      return "The scans show walls in one direction only, as in a corridor: where along them is open. Drive to where an end or a corner is in sight.";
    }
    const wheels = scene.tracking?.wheels ?? "fine";
    return pose === "weak" && wheels !== "fine" ? "The wheels contradict the scans: they slip, or are told wrongly. Drive slowly until the scans have found the way." : null;
  }
}

// It goes on in a map of its own.
function ofMaps({ tracking, status }) {
  if (/^looks for its place/.test(status?.exploration ?? "")) return "The robot looks for its place by itself. Wait, or press “you are here”.";
  return tracking && tracking.map_id !== 0
    ? "The robot knows no place of its map again, and goes on in a new one. Drive to a place that it knows, or press “you are here”." : null;
}

// The information of the scan about the place, [xx, xy, xt, yy, yt, tt]: its smaller principal value beside the larger one.
function seesOneWay([xx, xy, , yy]) {
  const [middle, spread] = [(xx + yy) / 2, Math.hypot((xx - yy) / 2, xy)];
  return middle > 0 && middle - spread < ONE_WAY * (middle + spread);
}
