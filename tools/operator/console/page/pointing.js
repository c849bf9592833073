// What the operator points at on the map: two points to measure between, a place to drive to, or a place and a heading
// ("you are here").
// By mouse and finger, or by a cross that the arrow keys move and Enter sets down. While he points, the map does not
// pan; Escape ends it. The place under the cursor is told in metres.

const HINTS = {
  measure: "press and drag, or click two points (arrows and Enter; Esc: done)",
  goal: "press where the robot is to drive (arrows and Enter; Esc: leave it)",
  pose: "press where the robot is, drag to where it looks (arrows and Enter; Esc: leave it)",
};
const CROSS_PX = 16; // a step of the cross; with shift
const CROSS_FINE_PX = 2;
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

export class Pointing {
  constructor(canvas, view, changed) {
    this.canvas = canvas;
    this.view = view;
    this.changed = changed;
    this.mode = null; // "measure", "goal", "pose"
    this.from = null; // [x, y] in the map
    this.to = null;
    this.cross = null; // [x, y] in the map, while keys point
    canvas.addEventListener("pointerdown", (event) => this.#down(event), { capture: true });
    canvas.addEventListener("pointermove", (event) => this.#move(event), { capture: true });
    canvas.addEventListener("pointerup", (event) => this.#up(event), { capture: true });
    canvas.addEventListener("pointerleave", () => this.#tellPlace(null));
    addEventListener("keydown", (event) => this.#key(event), { capture: true });
    document.getElementById("measure").addEventListener("click", () =>
      this.mode === "measure" ? this.#end() : this.#begin("measure"));
  }

  // The next press on the map is the robot's place, dragging from there its heading.
  pose(found) {
    this.found = found;
    this.#begin("pose");
  }

  // The next press on the map is where the robot is to drive; asked again: not any more.
  goal(found) {
    this.found = found;
    this.mode === "goal" ? this.#end() : this.#begin("goal");
  }

  // What is pointed at is on the map of a robot that is not shown any more.
  leave() {
    this.#end();
  }

  get metres() {
    return Math.hypot(this.to[0] - this.from[0], this.to[1] - this.from[1]);
  }

  get heading() {
    return Math.atan2(this.to[1] - this.from[1], this.to[0] - this.from[0]);
  }

  #begin(mode) {
    this.mode = mode;
    this.from = this.to = this.cross = null;
    this.open = false;
    this.#show();
  }

  #end() {
    this.mode = this.from = this.to = this.cross = null;
    this.pressed = this.headed = false;
    this.#show();
  }

  #show() {
    this.canvas.dataset.pointing = this.mode ?? "";
    for (const id of ["measure", "goal"]) document.getElementById(id).setAttribute("aria-pressed", String(this.mode === id));
    const hint = document.getElementById("hint");
    hint.hidden = !this.mode;
    hint.textContent = HINTS[this.mode] ?? "";
    this.changed();
  }

  #tellPlace(place) {
    document.getElementById("cursor").textContent = place ? place.map((v, k) => `${"xy"[k]} ${(v + 0).toFixed(2)}`).join("  ") + " m" : "";
  }

  #down(event) {
    if (!this.mode) return;
    event.stopImmediatePropagation();
    this.cross = null;
    this.headed = false;
    this.canvas.setPointerCapture(event.pointerId);
    this.#press(this.view.toMap(event.offsetX, event.offsetY));
  }

  #move(event) {
    const place = this.view.toMap(event.offsetX, event.offsetY);
    this.#tellPlace(place);
    if (!this.mode) return;
    event.stopImmediatePropagation();
    this.#drag(place);
  }

  #up(event) {
    if (!this.mode || !this.pressed) return;
    event.stopImmediatePropagation();
    this.#release();
  }

  #press(point) {
    this.second = this.mode === "measure" && this.open;
    if (!this.second) this.from = point;
    this.to = point;
    this.pressed = true;
    this.changed();
  }

  #drag(point) {
    if (!this.from || !(this.pressed || this.open)) return;
    this.to = point;
    this.changed();
  }

  // A click sets the first point and leaves the second open; a drag sets both.
  #release() {
    this.pressed = false;
    const dragged = this.metres * this.view.scale > 6;
    this.open = this.mode === "measure" && !dragged && !this.second;
    if (this.mode === "measure") return;
    const [x, y] = this.mode === "goal" ? this.to : this.from;
    const theta = dragged ? this.heading : 0;
    this.#end();
    this.found(x, y, theta);
  }

  #key(event) {
    if (!this.mode || event.ctrlKey || event.metaKey || event.altKey || event.target.matches("input, select, #stick")) return;
    const arrow = ARROWS[event.key];
    if (event.key === "Escape") this.#end();
    else if (arrow) this.#moveCross(arrow, event.shiftKey ? CROSS_FINE_PX : CROSS_PX);
    else if (event.key === "Enter") this.#setDown();
    else return;
    event.preventDefault();
    event.stopImmediatePropagation();
  }

  #moveCross([dx, dy], step) {
    const { width, height } = this.view;
    const [px, py] = this.cross ? this.view.toScreen(...this.cross) : [width / 2, height / 2];
    const within = (v, most) => Math.max(0, Math.min(most, v));
    this.cross = this.view.toMap(within(px + dx * step, width), within(py + dy * step, height));
    this.#tellPlace(this.cross);
    this.#drag(this.cross);
    this.changed();
  }

  // Enter is a press and, where a heading or a second point is asked for, the next one the release.
  #setDown() {
    this.cross ??= this.view.toMap(this.view.width / 2, this.view.height / 2);
    if (this.headed) this.#drag(this.cross);
    else this.#press(this.cross);
    if (this.mode !== "pose" || this.headed) this.#release();
    this.headed = this.mode === "pose" && this.pressed;
    this.changed();
  }
}
