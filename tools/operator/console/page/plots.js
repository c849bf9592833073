// Any signal of the robot over the last minutes, as a line. What came before the page was opened is fetched once.

const LONGEST_S = 600;
const LEAST_STEP_S = 0.15; // samples closer than that are left out: ten a second for ten minutes would not be seen

const sigma = (variance) => (variance === null ? null : Math.sqrt(Math.max(0, variance)));
const degrees = (rad) => (rad * 180) / Math.PI;
const wrapped = (rad) => Math.atan2(Math.sin(rad), Math.cos(rad));
const milliseconds = (us) => (us === null ? null : us / 1000);

// Of a pose: [name, unit, value].
const OF_POSE = [
  ["x", "m", (p) => p.map[0]], ["y", "m", (p) => p.map[1]], ["heading", "°", (p) => degrees(wrapped(p.map[2]))],
  ["speed", "m/s", (p) => Math.hypot(p.velocity[0], p.velocity[1])], ["turn", "°/s", (p) => degrees(p.velocity[2])],
  ["sigma x", "mm", (p) => 1000 * sigma(p.cov[0])], ["sigma y", "mm", (p) => 1000 * sigma(p.cov[4])],
  ["sigma heading", "°", (p) => degrees(sigma(p.cov[8]))],
  ["state (2 good, 0 lost)", "", (p) => ["lost", "weak", "good"].indexOf(p.state)],
  ["map pose from smooth pose", "m", (p) => Math.hypot(p.map[0] - p.smooth[0], p.map[1] - p.smooth[1])],
  ["scan takes", "ms", (p) => milliseconds(p.stages_us.reduce((sum, t) => sum + (t ?? 0), 0))],
  ...["deskew", "smooth", "extract", "match", "map"].map((name, k) => [`${name} takes`, "ms", (p) => milliseconds(p.stages_us[k])]),
  ["latency", "ms", (p) => milliseconds(p.latency_us)], ["age", "ms", (p) => milliseconds(p.age_us)],
  ["odometry's lag", "ms", (p) => milliseconds(p.lag_us)],
];
const OF_STATUS = [["scans a second", "/s", (s) => s.scan_rate_hz], ["latency p99", "ms", (s) => milliseconds(s.latency_p99_us)]];

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
    for (const [name, unit] of [...OF_POSE, ...OF_STATUS]) this.#seriesOf(name, unit);
    this.plots[0].choice.value = "speed";
    this.plots[1].choice.value = "scan takes";
  }

  take(message, isPast) {
    switch (message.type) {
      case "hello": this.recording = null; this.#forget(); this.link.send({ type: "series" }); break;
      case "series": this.#takeSeries(message); break;
      case "pose": this.marked = isPast ? message.utime / 1e6 : null; isPast || this.#takePose(message); break;
      case "status": isPast || this.#takeStatus(message); break;
      case "past": this.#looksElsewhere(message); break;
      default: return;
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
    message.poses.forEach((pose) => this.#takePose(pose));
    message.statuses.forEach((status) => this.#takeStatus(status));
  }

  #takePose(pose) {
    for (const [name, unit, value] of OF_POSE) this.#add(this.#seriesOf(name, unit), pose.utime / 1e6, value(pose));
  }

  #takeStatus(status) {
    for (const [name, unit, value] of OF_STATUS) this.#add(this.#seriesOf(name, unit), status.utime / 1e6, value(status));
    for (const { name, value } of status.counters) this.#add(this.#seriesOf(`count of ${name.replaceAll("_", " ")}`, ""), status.utime / 1e6, value);
  }

  #seriesOf(name, unit) {
    if (!this.series.has(name)) {
      this.series.set(name, { unit, times: [], values: [] });
      for (const { choice } of this.plots) choice.add(new Option(name));
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
