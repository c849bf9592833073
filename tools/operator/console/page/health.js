// The health strip and panel: everything that is not the map.
import { Cause } from "./cause.js";
import {
  ADVICE_ON_HEARING, adviceOnPlan, adviceOnScanner, adviceOnTracking, codesInWords, counterInWords, countDrops, degrees, duration, heading, isTrouble, mapsInWords, metres, millimetres, STATES,
  wheelsInWords,
} from "./words.js";

const STAGES = ["deskew", "smooth", "extract", "match", "map", "total"];
const STAGE_COLOURS = ["#7c8cff", "#38bdf8", "#22d3b6", "#ffb84d", "#f472b6"];
const HISTORY = 150; // scans in the chart of times
const MUTE = ["gone", "connecting"]; // links on which a recording cannot be shown, either

export class Health {
  constructor(layers) {
    this.layers = layers;
    this.cause = new Cause();
    this.times = []; // stages_us of the last scans
    this.chart = document.getElementById("times");
    this.chartDue = true;
    this.#buildStages();
    new ResizeObserver(() => (this.chartDue = true)).observe(this.chart);
  }

  take(message, scene) {
    this.cause.take(message);
    switch (message.type) {
      case "hello": case "past": this.times = []; this.layers.tellEmpty("graph", true); break;
      case "pose": this.#pose(message); break;
      case "tracking":
        show("maps", mapsInWords(message)[0] || "one", message.maps > 1 ? "fair" : "");
        this.layers.tellEmpty("apart", !scene.hasWallsApart);
        show("wheels", wheelsInWords(message.wheels, message.wheel_faults), message.wheels === "fine" ? "" : "fair");
        break;
      case "features":
        show("lines", message.lines.length);
        show("corners", message.corners.length);
        break;
      case "scan": this.#scan(message); break;
      case "map":
        show("map-lines", message.lines.length);
        show("map-corners", message.corners.length);
        show("map-version", message.version);
        this.layers.tellEmpty("apart", !scene.hasWallsApart);
        break;
      case "graph": this.#graph(message); break;
      case "status": this.#status(message); break;
      case "link": this.#link(message, scene); break;
    }
  }

  // Another robot is shown, of which nothing is known yet.
  leave() {
    for (const { id } of document.querySelectorAll("dd[id]:not(#control dd)")) show(id, "–", "");
    for (const id of ["seen-note", "stage-note"]) show(id, "");
    for (const row of this.stageRows) [...row.cells].slice(1).forEach((time) => (time.textContent = "–"));
    document.querySelector("#counters tbody").replaceChildren();
    this.layers.tellEmpty("apart", true);
    this.chartDue = true;
  }

  // State and age, and the alarm when they are bad: called ten times a second.
  showLink(link, scene) {
    const state = scene.recording && !MUTE.includes(link.state) ? "recording" : link.state;
    document.body.dataset.link = state;
    const heard = ["up", "blind", "lost", "recording"].includes(state);
    document.body.dataset.state = heard ? (scene.pose?.state ?? "none") : "none";
    const age = link.poseAgeMs;
    show("age", Number.isFinite(age) ? ageInWords(age) : "–", link.state === "up" ? "fine" : "bad");
    const [word, text] = stateInWords(state, scene, age);
    show("state-word", word);
    show("state-text", text);
    showAlarm(state, scene, word, text);
    show("alarm-cause", this.cause.words(state, scene, link.hasStatus));
    const advice = [...(scene.status?.warnings ?? []), adviceOnScanner(scene.status?.driver, scene.scan?.stain), ...adviceOnTracking(scene.tracking), adviceOnPlan(scene.plan)];
    showAdvice(heard ? advice.filter(Boolean) : state === "waiting" ? [ADVICE_ON_HEARING] : []);
  }

  frame() {
    if (this.chartDue) {
      this.chartDue = false;
      drawTimes(this.chart, this.times);
    }
  }

  #pose(pose) {
    const sigma = (variance) => (variance === null ? NaN : Math.sqrt(Math.max(0, variance)));
    show("x", metres(pose.map[0]));
    show("y", metres(pose.map[1]));
    show("heading", heading(pose.map[2]));
    show("sigma-x", millimetres(sigma(pose.cov[0])));
    show("sigma-y", millimetres(sigma(pose.cov[4])));
    show("sigma-heading", degrees(sigma(pose.cov[8]), 2));
    show("speed", `${Math.hypot(pose.velocity[0], pose.velocity[1]).toFixed(2)} m/s`);
    show("turn", `${degrees(pose.velocity[2], 0)}/s`);
    show("scan", pose.scan);
    show("seen-note", pose.predicted ? "predicted, no scan" : "");
    show("latency", duration(pose.latency_us));
    const total = pose.stages_us.reduce((sum, t) => sum + (t ?? 0), 0);
    show("total", duration(total));
    this.times.push(pose.stages_us);
    if (this.times.length > HISTORY) this.times.shift();
    this.chartDue = true;
    [...pose.stages_us, total].forEach((time, k) => this.#stageCell(k, 0, time));
  }

  #scan(scan) {
    const used = scan.ranges_mm.reduce((count, r) => count + (r > 0 ? 1 : 0), 0);
    show("beams", `${used} / ${scan.ranges_mm.length}`);
    show("codes", codesInWords(scan.codes));
  }

  #graph(message) {
    const [keyframes, loops] = message.left_out;
    this.layers.tellEmpty("graph", message.keyframes.length === 0);
    show("keyframes", message.keyframes.length);
    show("loops", message.loops.length);
    show("graph-left-out", keyframes + loops);
  }

  #status(status) {
    status.stages_p99_us.forEach((time, k) => this.#stageCell(k, 1, time));
    status.stages_worst_us.forEach((time, k) => this.#stageCell(k, 2, time));
    show("stage-note", status.deadline_misses ? `${status.deadline_misses} deadlines missed` : "no deadline missed");
    show("latency-p99", duration(status.latency_p99_us));
    show("latency-worst", duration(status.latency_worst_us));
    show("realtime", status.realtime ? "yes" : "no", status.realtime ? "fine" : "fair");
    show("realtime-detail", status.realtime_detail || "–");
    show("device", status.device || "–");
    show("driver", [status.driver, status.scan_rate_hz ? `${status.scan_rate_hz} scans/s` : ""].filter(Boolean).join(", ") || "–");
    this.#counters(status.counters);
  }

  #counters(counters) {
    const dropped = countDrops(counters);
    show("dropped", dropped, dropped ? "fair" : "fine");
    const rows = [...counters].sort((a, b) => isTrouble(b) - isTrouble(a)).map((counter) => {
      const row = document.createElement("tr");
      row.classList.toggle("trouble", isTrouble(counter));
      row.append(cell(counterInWords(counter.name)), cell(counter.value));
      return row;
    });
    document.querySelector("#counters tbody").replaceChildren(...rows);
  }

  #link(link) {
    show("rate", `${(link.pose_rate_hz ?? 0).toFixed(1)} /s`);
    show("lost", link.lost_poses, link.lost_poses ? "fair" : "");
    show("malformed", link.malformed, link.malformed ? "fair" : "");
    show("skipped", link.skipped);
  }

  #buildStages() {
    const rows = STAGES.map((name, k) => {
      const row = document.createElement("tr");
      const first = cell("");
      if (STAGE_COLOURS[k]) {
        const dot = document.createElement("i");
        dot.style.background = STAGE_COLOURS[k];
        first.append(dot);
      }
      first.append(name);
      row.append(first, cell("–"), cell("–"), cell("–"));
      return row;
    });
    document.querySelector("#stages tbody").append(...rows);
    this.stageRows = rows;
  }

  #stageCell(stage, column, time) {
    this.stageRows[stage].cells[column + 1].textContent = duration(time);
  }
}

function stateInWords(link, scene, age) {
  switch (link) {
    case "connecting": return ["…", "connecting to the console"];
    case "gone": return ["no console", "ale-console does not answer"];
    case "waiting": return ["waiting", "no robot heard yet"];
    case "blind": return ["no scans", `${scene.status.driver}; last pose ${duration(age * 1000)} ago`];
    case "lost": return ["link lost", `last pose ${duration(age * 1000)} ago`];
    default: return withMaps(STATES[scene.pose?.state] ?? ["waiting", ""], scene.tracking);
  }
}

const withMaps = ([word, text], tracking) => [word, [text, mapsInWords(tracking)[0]].filter(Boolean).join(", ")];

function showAlarm(link, scene, word, text) {
  const trouble = ["gone", "lost", "blind"].includes(link) || (["up", "recording"].includes(link) && scene.pose && scene.pose.state !== "good");
  document.getElementById("alarm").hidden = !trouble;
  if (trouble) {
    show("alarm-word", word);
    show("alarm-text", text);
  }
}

// To ten milliseconds: finer ones only flicker.
const ageInWords = (ms) => (ms < 1000 ? `${Math.round(ms / 10) * 10} ms` : duration(ms * 1e3));

function showAdvice(advice) {
  const box = document.getElementById("advice");
  box.hidden = advice.length === 0;
  const said = [...box.children].map((paragraph) => paragraph.textContent);
  if (said.join("\n") === advice.join("\n")) return;
  box.replaceChildren(...advice.map((text) => {
    const paragraph = document.createElement("p");
    paragraph.textContent = text;
    return paragraph;
  }));
}

function show(id, text, mood) {
  const element = document.getElementById(id);
  const value = String(text);
  if (element.textContent !== value) element.textContent = value;
  if (mood !== undefined && element.className !== mood) element.className = mood;
}

function cell(text) {
  const td = document.createElement("td");
  td.textContent = text;
  return td;
}

// Stacked stages of the last scans, newest at the right, on a scale of 1, 2, 5 .. ms.
function drawTimes(canvas, times) {
  const ratio = devicePixelRatio || 1;
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  canvas.width = Math.round(width * ratio);
  canvas.height = Math.round(height * ratio);
  const c = canvas.getContext("2d");
  c.setTransform(ratio, 0, 0, ratio, 0, 0);
  const worst = Math.max(100, ...times.map((stages) => stages.reduce((sum, t) => sum + (t ?? 0), 0)));
  const power = 10 ** Math.floor(Math.log10(worst));
  const top = power * [1, 2, 5, 10].find((k) => k * power >= worst);
  const step = width / HISTORY;
  times.forEach((stages, k) => {
    let y = height;
    stages.forEach((time, stage) => {
      const h = ((time ?? 0) / top) * (height - 14);
      c.fillStyle = STAGE_COLOURS[stage];
      c.fillRect(width - (times.length - k) * step, y - h, Math.max(1, step - 0.5), h);
      y -= h;
    });
  });
  const style = getComputedStyle(document.documentElement);
  c.strokeStyle = style.getPropertyValue("--edge");
  c.beginPath();
  c.moveTo(0, 14.5);
  c.lineTo(width, 14.5);
  c.stroke();
  c.fillStyle = style.getPropertyValue("--dim");
  c.font = "10px system-ui, sans-serif";
  c.fillText(duration(top), 0, 10);
}
