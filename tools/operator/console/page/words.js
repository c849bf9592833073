// Numbers and codes in an operator's words.

// Adding zero turns a negative zero into zero.
const fixed = (v, digits) => (Number(v.toFixed(digits)) + 0).toFixed(digits);
export const metres = (v) => (v === null ? "–" : `${fixed(v, 3)} m`);
export const degrees = (rad, digits = 1) => (rad === null ? "–" : `${fixed((rad * 180) / Math.PI, digits)}°`);
export const millimetres = (m) => (Number.isFinite(m) ? `${(m * 1000).toFixed(1)} mm` : "–");

export function duration(us) {
  if (us === null || us === undefined) return "–";
  if (us < 995) return `${us.toFixed(0)} µs`;
  if (us < 995e3) return `${(us / 1e3).toPrecision(3)} ms`;
  return `${(us / 1e6).toFixed(1)} s`;
}

export function bytesInWords(bytes) {
  return bytes < 1e6 ? `${Math.ceil(bytes / 1e3)} kB` : `${(bytes / 1e6).toFixed(bytes < 1e7 ? 1 : 0)} MB`;
}

const two = (n) => String(n).padStart(2, "0");

// Milliseconds as 1:02, or 1:00:02.
export function lengthInWords(ms) {
  const seconds = Math.max(0, Math.round(ms / 1000));
  const [hours, minutes] = [Math.floor(seconds / 3600), Math.floor(seconds / 60) % 60];
  return hours ? `${hours}:${two(minutes)}:${two(seconds % 60)}` : `${minutes}:${two(seconds % 60)}`;
}

const FLIGHTS = { fault: "flight, written at a fault", deadline: "flight, a deadline was missed", command: "flight, as asked for" };

// What a recording of the scanner's bytes is, by the reason for which the robot wrote it.
export function flightInWords(reason) {
  return FLIGHTS[reason] ?? "bytes of the scanner";
}

// Milliseconds since 1970, by the clock on the wall.
export function dateInWords(ms) {
  const time = new Date(ms);
  return `${time.getFullYear()}-${two(time.getMonth() + 1)}-${two(time.getDate())} ${two(time.getHours())}:${two(time.getMinutes())}`;
}

export const heading = (rad) => {
  const turn = 2 * Math.PI;
  return degrees(((((rad + Math.PI) % turn) + turn) % turn) - Math.PI);
};

// What a beam without a range says: the scanner's own code, or (from 128) what the driver made of it.
const CODES = {
  0: "nothing in reach", 6: "nothing in reach", 7: "beside a disturbed beam", 18: "dazzled by something shiny",
  19: "no beam there", 129: "nothing in reach", 130: "unusable", 131: "masked", 133: "too near",
};
const codeInWords = (code) => CODES[code] ?? (code < 6 ? "too weak" : "disturbed");

// [[code, count], ...] as "12 nothing in reach, 3 too weak".
export function codesInWords(codes) {
  const counts = new Map();
  for (const [code, count] of codes) {
    const words = codeInWords(code);
    counts.set(words, (counts.get(words) ?? 0) + count);
  }
  return [...counts].map(([words, count]) => `${count} ${words}`).join(", ") || "none";
}

// Counters of the firmware. Those in DROPS are scans that did not reach the estimate; those in TRAFFIC count
// what is no trouble at all.
const COUNTERS = {
  scans_lost: "scans lost on the line", overloaded: "scans skipped, too busy", scan_ring_full: "scans, no room",
  corrections_late: "map corrections, late", result_ring_full: "results, no room", bad_checksum: "wrong checksums", bad_frame: "broken replies",
  repeated: "repeated replies", losses_too_fast: "beginnings of frames too fast to be scans",
  garbage_bytes: "garbage bytes", stream_restarts: "stream restarted",
  resets: "scanner reset", reopens: "port opened again", hardware_faults: "scanner faults",
  identity_warnings: "odd identity lines", odometry: "odometry received", odometry_ring_full: "odometry, no room",
  odometry_refused: "odometry refused", odometry_malformed: "odometry, malformed", odometry_unstamped: "odometry without a time",
  odometry_misdated: "odometry whose time agrees with no clock", odometry_clock_steps: "odometry's clock was set",
  odometry_senders: "senders of odometry", other_speakers: "other robots on the same channels", messages_unsent: "messages not sent",
  datagrams_refused: "datagrams that are no messages", datagrams_unheard: "datagrams kept off, or too many",
  command_malformed: "commands, malformed", command_unsigned: "commands, unsigned",
  command_stranger: "commands, of a stranger", command_forged: "commands, forged",
  command_other_robot: "commands for another robot", command_replayed: "commands, replayed",
  maps: "maps, not joined", wheel_faults: "faults of the wheels",
  command_late: "commands, too late", command_lasting: "commands, lasting too long",
};
const DROPS = ["scans_lost", "overloaded", "scan_ring_full", "result_ring_full"];
const TRAFFIC = ["odometry", "identity_warnings", "datagrams_unheard"];
const USUAL = { maps: 1, odometry_senders: 1 }; // what is no trouble unless there is more of it

export const counterInWords = (name) => COUNTERS[name] ?? name.replaceAll("_", " ");
export const isTrouble = ({ name, value }) => value > (USUAL[name] ?? 0) && !TRAFFIC.includes(name);
export const countersThatDrop = (counters) => counters.filter((counter) => DROPS.includes(counter.name));
export const countDrops = (counters) => countersThatDrop(counters).reduce((sum, counter) => sum + counter.value, 0);

// What an operator can do about the scanner, for what it or its driver says; null when there is nothing.
const ADVICE = [
  [/hardware fault of the sensor: status (\w+)/, "The scanner reports a fault of its hardware (status $1). Switch it off and on; if it comes back, it needs service."],
  [/Trouble/, "The scanner says that it is broken. Switch it off and on; if it comes back, it needs service."],
  [/what speaks there is (.*)/, "Something else than the scanner is on its port: $1. Choose the scanner's port in the configuration."],
  [/not a byte comes from it/, "The device on the scanner's port says nothing. Look at its power and its cable; or it is another device."],
  [/checks itself/, "The scanner checks itself; this takes some seconds."],
  [/^silent/, "The scanner has fallen silent. Look at its cable and its power."],
  [/in use by another program:? ?(.*)/, "Another program holds the scanner's port $1. End one of the two."],
  [/^(?:no scanner|asking who is there|starting): (.+)/, "No scanner ($1). Look at its cable and its power; it is tried again until it is there."],
];

export function adviceOnScanner(driver, stain) {
  for (const [words, advice] of ADVICE) {
    const said = driver?.match(words);
    if (said) return advice.replace("$1", () => said[1] ?? "");
  }
  return stain ? adviceOnWindow(...stain) : null;
}

function adviceOnWindow(beams, bearing) {
  const side = Math.round((Math.abs(bearing) * 180) / Math.PI);
  const where = side < 5 ? "straight ahead" : `${side}° to the ${bearing > 0 ? "left" : "right"}`;
  return `The scanner's window may be dirty: ${beams} beams ${where} give no range, wherever the robot turns. Wipe it with a soft, dry cloth.`;
}

// What scans say of the wheels, by the word of ALE_TRACKING.
const WHEELS = {
  contradict: "they contradict what the scanner sees", stalled: "they tell nothing while the robot moves",
  reversed: "they tell ahead as back, or left as right", late: "they tell what was a while ago",
  scale: "they tell much too much, or too little",
};

export function wheelsInWords(word, times) {
  const said = word === "fine" ? "fine" : `${word}: ${WHEELS[word] ?? "they are not believed"}`;
  return times ? `${said} (${times === 1 ? "once" : `${times} times`} so far)` : said;
}

// Few words for the strip, and a line over the map; both empty when there is one map, and the robot is in it.
export function mapsInWords(tracking) {
  if (!tracking || (tracking.maps <= 1 && tracking.map_id === 0)) return ["", ""];
  return tracking.map_id !== 0
    ? ["new map, not joined yet", `New map, not joined until the robot knows a place again (${tracking.maps} in all).`]
    : [`${tracking.maps} maps, not joined`, `${tracking.maps} maps: the robot is in the first one, the rest is not joined yet.`];
}

export function adviceOnTracking(tracking) {
  const wheels = WHEELS[tracking?.wheels];
  return [mapsInWords(tracking)[1], wheels && `Wheels not believed: ${wheels}.`].filter(Boolean);
}

// A place that the robot could not drive to, in the robot's words.
export function adviceOnPlan(plan) {
  return plan?.state === "given up" ? `The robot ${plan.words}. Choose another place, or take the stick.` : null;
}

export const STATES = {
  good: ["good", ""],
  weak: ["weak", "position uncertain"],
  lost: ["lost", "position unknown"],
};

// In the list of robots: those that are not shown are known by a word.
const ROBOTS = { waiting: "not heard yet" };
export const robotInWords = ({ name, state }) => `${name}: ${ROBOTS[state] ?? state}`;

// While no robot has been heard: what a robot sends stays on it unless it is fetched.
export const ADVICE_ON_HEARING =
  "A robot's messages stay on the robot. For this computer to hear it, run here: ale-bridge --connect ROBOT:7700 --keys KEY (on the robot: ale-bridge --listen 7700, see its --help).";
