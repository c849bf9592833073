// Any signal of the robot over the last minutes, as a line. What came before the page was opened is fetched once.

const LONGEST_S = 600;
const LEAST_STEP_S = 0.15; // samples closer than that are left out: ten a second for ten minutes would not be seen

const sigma = (variance) => (variance === null ? null : Math.sqrt(Math.max(0, variance)));
const degrees = (rad) => (rad * 180) / Math.PI;
const wrapped = (rad) => Math.atan2(Math.sin(rad), Math.cos(rad));
const milliseconds = (us) => (us === null ? null : us / 1000);

const STAGES = ["deskew", "smooth", "extract", "match", "map", "all stages"]; // as a status has them; a pose has the first five

// The least that the scan alone says of the place, whatever the direction: the smaller eigenvalue of [xx, xy; xy, yy].
function weakest([xx, xy, , yy]) {
  return (xx + yy) / 2 - Math.hypot((xx - yy) / 2, xy);
}

// Signals by the message that they are of, in the groups in which they are offered: [name, unit, value].
const SIGNALS = {
  pose: [
    ["x", "m", (p) => p.map[0]], ["y", "m", (p) => p.map[1]], ["heading", "°", (p) => degrees(wrapped(p.map[2]))],
    ["speed", "m/s", (p) => Math.hypot(p.velocity[0], p.velocity[1])], ["turn", "°/s", (p) => degrees(p.velocity[2])],
    ["sigma x", "mm", (p) => 1000 * sigma(p.cov[0])], ["sigma y", "mm", (p) => 1000 * sigma(p.cov[4])],
    ["sigma heading", "°", (p) => degrees(sigma(p.cov[8]))],
    ["state (2 good, 0 lost)", "", (p) => ["lost", "weak", "good"].indexOf(p.state)],
    ["map pose from smooth pose", "m", (p) => Math.hypot(p.map[0] - p.smooth[0], p.map[1] - p.smooth[1])],
    ["observability ahead", "/m²", (p) => p.observability[0]], ["observability aside", "/m²", (p) => p.observability[3]],
    ["observability at its weakest", "/m²", (p) => weakest(p.observability)], ["observability of the heading", "/rad²", (p) => p.observability[5]],
    ["scan takes", "ms", (p) => milliseconds(p.stages_us.reduce((sum, t) => sum + (t ?? 0), 0))],
    ...STAGES.slice(0, 5).map((name, k) => [`${name} takes`, "ms", (p) => milliseconds(p.stages_us[k])]),
    ["latency", "ms", (p) => milliseconds(p.latency_us)], ["age", "ms", (p) => milliseconds(p.age_us)],
    ["odometry's lag", "ms", (p) => milliseconds(p.lag_us)],
  ],
  odometry: [
    ["wheels: speed", "m/s", (o) => o.wheels[0]], ["wheels: turn", "°/s", (o) => degrees(o.wheels[1])],
    ["wheels minus scans: speed", "m/s", (o) => o.wheels[0] - o.scans[0]],
    ["wheels minus scans: turn", "°/s", (o) => degrees(o.wheels[1] - o.scans[1])],
  ],
  tracking: [["maps that are not joined", "", (t) => t.maps], ["faults of the wheels", "", (t) => t.wheel_faults]],
  features: [["lines seen", "", (f) => f.found[0]], ["corners seen", "", (f) => f.found[1]]],
  scan: [["beams with a range", "", (s) => s.beams[0]], ["beams without", "", (s) => s.beams[1] - s.beams[0]]],
  status: [
    ["scans a second", "/s", (s) => s.scan_rate_hz], ["latency p99", "ms", (s) => milliseconds(s.latency_p99_us)],
    ["deadline misses", "", (s) => s.deadline_misses],
    ...STAGES.flatMap((name, k) => [[`${name} p99`, "ms", (s) => milliseconds(s.stages_p99_us[k])],
                                    [`${name} worst`, "ms", (s) => milliseconds(s.stages_worst_us[k])]]),
  ],
};
const GROUPS = { pose: "pose", odometry: "wheels against scans", tracking: "maps", features: "seen", scan: "seen", status: "health" };
const COUNTS = "counts";

export class Plots {
  constructor(link) {
    this.link = link;
    this.recording = null; // whose signals they are, unless they are the robot's
    this.series = new Map(); // name -> {unit, times, values}
    this.plots = [...document.querySelectorAll("#plots figure")].map((figure) => ({
      choice: figure.querySelector("select"), canvas: figure.querySelector("canvas"), text: figure.querySelector("output"),
    }));
    this.span = document.getElementById("plot-span");
    for (const { choice } of this.plots) choice.addEventListener("change", () => (this.due = true));
    this.span.addEventListener("change", () => (this.due = true));
    new ResizeObserver(() => (this.due = true)).observe(document.getElementById("plots"));
    for (const [type, signals] of Object.entries(SIGNALS)) {
      for (const [name, unit] of signals) this.#seriesOf(name, unit, GROUPS[type]);
    }
    this.plots[0].choice.value = "speed";
    this.plots[1].choice.value = "scan takes";
  }

  take(message, isPast) {
    switch (message.type) {
      case "hello": this.recording = null; this.#forget(); this.link.send({ type: "series" }); break;
      case "series": this.#takeSeries(message); break;
      case "past": this.#looksElsewhere(message); break;
      default:
        if (!(message.type in SIGNALS)) return;
        if (message.type === "pose") this.marked = isPast ? message.utime / 1e6 : null;
        isPast || this.#takeSignals(message);
    }
    this.due = true;
  }

  frame() {
    if (!this.due || performance.now() - (this.drawnAt ?? -Infinity) < 200) return;
    this.due = false;
    this.drawnAt = performance.now();
    for (const plot of this.plots) this.#draw(plot);
  }

  // Of a recording all is drawn that there is; afterwards the robot's last minutes again.
  #looksElsewhere({ at, recording }) {
    if (at === null) this.marked = null;
    if (recording === this.recording) return;
    this.recording = recording;
    this.#forget();
    this.link.send({ type: "series" });
  }

  #forget() {
    for (const series of this.series.values()) series.times.length = series.values.length = 0;
  }

  // What comes late is of before what came meanwhile.
  #takeSeries(message) {
    this.#forget();
    Object.values(message).filter(Array.isArray).flat().forEach((each) => this.#takeSignals(each));
  }

  #takeSignals(message) {
    const time = message.utime / 1e6;
    for (const [name, unit, value] of SIGNALS[message.type]) this.#add(this.#seriesOf(name, unit, GROUPS[message.type]), time, value(message));
    for (const { name, value } of message.counters ?? []) this.#add(this.#seriesOf(`count of ${name.replaceAll("_", " ")}`, "", COUNTS), time, value);
  }

  #seriesOf(name, unit, group) {
    if (!this.series.has(name)) {
      this.series.set(name, { unit, times: [], values: [] });
      for (const { choice } of this.plots) groupIn(choice, group).append(new Option(name));
    }
    return this.series.get(name);
  }

  #add({ times, values }, time, value) {
    if (time - (times.at(-1) ?? -Infinity) < LEAST_STEP_S) return;
    times.push(time);
    values.push(value);
    if (!this.recording && times[0] < time - LONGEST_S) {
      times.shift();
      values.shift();
    }
  }

  #draw({ choice, canvas, text }) {
    const { unit, times, values } = this.series.get(choice.value);
    const span = Number(this.span.value);
    const end = Math.min(times.at(-1) ?? 0, this.recording ? Math.max((times[0] ?? 0) + span, (this.marked ?? 0) + span / 2) : Infinity);
    const begin = end - span;
    const shown = times.map((time, k) => [time, values[k]]).filter(([time, value]) => time >= begin && time <= end && Number.isFinite(value));
    const [low, high] = shown.reduce(([a, b], [, value]) => [Math.min(a, value), Math.max(b, value)], [Infinity, -Infinity]);
    const last = shown.at(-1)?.[1];
    text.textContent = shown.length ? `${inShort(last)} ${unit} (${inShort(low)} to ${inShort(high)})` : "nothing yet";
    paint(canvas, shown, { begin, end, low, high, marked: this.marked });
  }
}

function groupIn(choice, label) {
  const found = [...choice.children].find((group) => group.label === label);
  if (found) return found;
  const made = document.createElement("optgroup");
  made.label = label;
  choice.append(made);
  return made;
}

const inShort = (value) => (Math.abs(value) >= 1000 ? value.toFixed(0) : Number(value.toPrecision(3)).toString());

function paint(canvas, points, { begin, end, low, high, marked }) {
  const ratio = devicePixelRatio || 1;
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  canvas.width = Math.round(width * ratio);
  canvas.height = Math.round(height * ratio);
  const c = canvas.getContext("2d");
  c.setTransform(ratio, 0, 0, ratio, 0, 0);
  const style = getComputedStyle(document.documentElement);
  c.strokeStyle = style.getPropertyValue("--edge");
  c.strokeRect(0.5, 0.5, width - 1, height - 1);
  if (!points.length) return;
  const range = high - low || 1;
  const px = (time) => ((time - begin) / (end - begin)) * width;
  c.strokeStyle = style.getPropertyValue("--line");
  c.lineWidth = 1.5;
  c.beginPath();
  for (const [time, value] of points) c.lineTo(px(time), height - 4 - ((value - low) / range) * (height - 8));
  c.stroke();
  if (!marked) return;
  c.strokeStyle = style.getPropertyValue("--pointed");
  c.strokeRect(px(marked), 0, 0, height);
}
