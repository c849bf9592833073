// Where the operator looks: centre (metres) and scale (CSS pixels a metre), by mouse, touch and keys.
// Three ways of looking: "whole" keeps all in sight, "follow" keeps the robot in the middle, "free" is his own.

import { leavesNoFling } from "./touch.js";

const NEAREST = 3000; // pixels a metre
const FARTHEST = 2;
const MARGIN_PX = 48;
const TOOLS_PX = 60; // the buttons at the left
const CLEAR_LEAST = 0.75; // the whole map keeps clear of stick and stop unless that makes it smaller than this part
const SETTLE_MS = 140; // time constant of the camera's glide

export class View {
  constructor(canvas, scene, changed) {
    this.canvas = canvas;
    this.scene = scene;
    this.changed = changed;
    this.mode = "whole";
    this.#measure();
    this.#rest();
    this.pointers = new Map();
    this.#listen();
  }

  // Where one looks before there is something to see.
  #rest() {
    this.x = 0;
    this.y = 0;
    this.scale = 60;
    this.settled = undefined;
  }

  // Another robot is shown, somewhere else.
  leave() {
    this.#rest();
    this.whole();
  }

  toScreen(x, y) {
    return [this.width / 2 + (x - this.x) * this.scale, this.height / 2 - (y - this.y) * this.scale];
  }

  toMap(px, py) {
    return [this.x + (px - this.width / 2) / this.scale, this.y - (py - this.height / 2) / this.scale];
  }

  // Asked of the page for every point that is drawn, it would be laid out anew each time that something was written into it.
  #measure() {
    this.width = this.canvas.clientWidth;
    this.height = this.canvas.clientHeight;
  }

  whole() {
    this.#look("whole");
  }

  follow() {
    this.#look(this.mode === "follow" ? "free" : "follow");
  }

  // Zooms by a factor about a point of the screen; about the robot while following, else about the middle.
  zoom(factor, px = this.width / 2, py = this.height / 2) {
    if (this.mode === "whole") this.#look("free");
    const [x, y] = this.toMap(px, py);
    const scale = Math.min(NEAREST, Math.max(FARTHEST, this.scale * factor));
    if (this.mode !== "follow") {
      this.x = x + ((this.x - x) * this.scale) / scale;
      this.y = y + ((this.y - y) * this.scale) / scale;
    }
    this.scale = scale;
    this.changed();
  }

  pan(dx, dy) {
    this.#look("free");
    this.x -= dx / this.scale;
    this.y += dy / this.scale;
    this.changed();
  }

  // Glides towards what the mode wants; called once a frame.
  step(now) {
    const dt = Math.min(100, now - (this.steppedAt ?? now));
    this.steppedAt = now;
    const want = this.#wanted();
    if (!want) return;
    const part = this.settled === undefined ? 1 : 1 - Math.exp(-dt / SETTLE_MS);
    const shift = Math.hypot(want.x - this.x, want.y - this.y) * this.scale;
    const stretch = Math.abs(Math.log(want.scale / this.scale));
    if (shift < 0.05 && stretch < 1e-4) return;
    this.settled = true;
    this.x += (want.x - this.x) * part;
    this.y += (want.y - this.y) * part;
    this.scale *= (want.scale / this.scale) ** part;
    this.changed();
  }

  #wanted() {
    if (this.mode === "follow" && this.scene.pose) {
      return { x: this.scene.pose.map[0], y: this.scene.pose.map[1], scale: this.scale };
    }
    const box = this.mode === "whole" && this.scene.bounds;
    if (!box || !this.width || !this.height) return null;
    const [all, ...clear] = this.#areas().map((area) => this.#fit(box, area));
    return clear.filter((fit) => fit.scale > CLEAR_LEAST * all.scale).sort((a, b) => b.scale - a.scale)[0] ?? all;
  }

  // Parts of the canvas that the map may fill, [left, right, bottom]: all of it, or what stick and stop leave free.
  #areas() {
    const all = [TOOLS_PX, this.width, this.height];
    const hands = document.getElementById("driving");
    if (!hands.offsetParent) return [all];
    return [all, [TOOLS_PX, hands.offsetLeft, this.height], [TOOLS_PX, this.width, hands.offsetTop]];
  }

  #fit(box, [left, right, bottom]) {
    const scale = Math.min((right - left - 2 * MARGIN_PX) / Math.max(2, box[2] - box[0]),
                           (bottom - 2 * MARGIN_PX) / Math.max(2, box[3] - box[1]), NEAREST);
    const kept = Math.max(FARTHEST, scale);
    return { x: (box[0] + box[2]) / 2 - ((left + right) / 2 - this.width / 2) / kept,
             y: (box[1] + box[3]) / 2 + (bottom / 2 - this.height / 2) / kept, scale: kept };
  }

  #look(mode) {
    this.mode = mode;
    for (const name of ["follow", "whole"]) {
      document.getElementById(name).setAttribute("aria-pressed", String(mode === name));
    }
    this.changed();
  }

  #listen() {
    const canvas = this.canvas;
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      this.pointers.set(event.pointerId, [event.offsetX, event.offsetY]);
      canvas.classList.add("held");
    });
    canvas.addEventListener("pointermove", (event) => this.#moved(event));
    leavesNoFling(canvas);
    for (const end of ["pointerup", "pointercancel"]) {
      canvas.addEventListener(end, (event) => {
        this.pointers.delete(event.pointerId);
        canvas.classList.toggle("held", this.pointers.size > 0);
      });
    }
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 16 : 1;
      this.zoom(Math.exp(-event.deltaY * lines * 0.0016), event.offsetX, event.offsetY);
    }, { passive: false });
    canvas.addEventListener("dblclick", (event) => this.zoom(2, event.offsetX, event.offsetY));
    addEventListener("keydown", (event) => this.#key(event));
    new ResizeObserver(() => {
      this.#measure();
      this.changed();
    }).observe(canvas);
  }

  // One finger or the mouse pans; two fingers pan and zoom about the point between them.
  #moved(event) {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const other = [...this.pointers.entries()].find(([id]) => id !== event.pointerId)?.[1];
    const now = [event.offsetX, event.offsetY];
    this.pointers.set(event.pointerId, now);
    if (!other) {
      this.pan(now[0] - before[0], now[1] - before[1]);
      return;
    }
    const spread = (p) => Math.max(1, Math.hypot(p[0] - other[0], p[1] - other[1]));
    this.pan((now[0] - before[0]) / 2, (now[1] - before[1]) / 2);
    this.zoom(spread(now) / spread(before), (now[0] + other[0]) / 2, (now[1] + other[1]) / 2);
  }

  #key(event) {
    if (event.defaultPrevented || event.ctrlKey || event.metaKey || event.altKey || event.target.matches("input, select, #stick")) return;
    const step = 60;
    const action = {
      "+": () => this.zoom(1.25), "=": () => this.zoom(1.25), "-": () => this.zoom(0.8),
      0: () => this.whole(), f: () => this.follow(),
      m: () => document.getElementById("measure").click(), l: () => document.getElementById("layers").click(),
      g: () => document.getElementById("goal").click(),
      ArrowLeft: () => this.pan(step, 0), ArrowRight: () => this.pan(-step, 0),
      ArrowUp: () => this.pan(0, step), ArrowDown: () => this.pan(0, -step),
    }[event.key];
    if (action) {
      event.preventDefault();
      action();
    }
  }
}
