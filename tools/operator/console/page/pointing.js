// What the operator points at on the map: two points to measure between, or a place and a heading ("you are here").
// While he points, the map does not pan; Escape ends it.

export class Pointing {
  constructor(canvas, view, changed) {
    this.canvas = canvas;
    this.view = view;
    this.changed = changed;
    this.mode = null; // "measure", "pose"
    this.from = null; // [x, y] in the map
    this.to = null;
    canvas.addEventListener("pointerdown", (event) => this.#down(event), { capture: true });
    canvas.addEventListener("pointermove", (event) => this.#move(event), { capture: true });
    canvas.addEventListener("pointerup", (event) => this.#up(event), { capture: true });
    addEventListener("keydown", (event) => event.key === "Escape" && this.#end());
    document.getElementById("measure").addEventListener("click", () =>
      this.mode === "measure" ? this.#end() : this.#begin("measure"));
  }

  // The next press on the map is the robot's place, dragging from there its heading.
  pose(found) {
    this.found = found;
    this.#begin("pose");
  }

  get metres() {
    return Math.hypot(this.to[0] - this.from[0], this.to[1] - this.from[1]);
  }

  get heading() {
    return Math.atan2(this.to[1] - this.from[1], this.to[0] - this.from[0]);
  }

  #begin(mode) {
    this.mode = mode;
    this.from = this.to = null;
    this.#show();
  }

  #end() {
    this.mode = this.from = this.to = null;
    this.#show();
  }

  #show() {
    this.canvas.dataset.pointing = this.mode ?? "";
    document.getElementById("measure").setAttribute("aria-pressed", String(this.mode === "measure"));
    const hint = document.getElementById("hint");
    hint.hidden = !this.mode;
    hint.textContent = this.mode === "pose" ? "press where the robot is, drag to where it looks (Esc: leave it)"
                                            : "press and drag, or click two points (Esc: done)";
    this.changed();
  }

  #down(event) {
    if (!this.mode) return;
    event.stopImmediatePropagation();
    const point = this.view.toMap(event.offsetX, event.offsetY);
    this.second = this.mode === "measure" && this.open;
    if (!this.second) this.from = point;
    this.to = point;
    this.pressed = true;
    this.canvas.setPointerCapture(event.pointerId);
    this.changed();
  }

  #move(event) {
    if (!this.mode) return;
    event.stopImmediatePropagation();
    if (!this.from || !(this.pressed || this.open)) return;
    this.to = this.view.toMap(event.offsetX, event.offsetY);
    this.changed();
  }

  // A click sets the first point and leaves the second open; a drag sets both.
  #up(event) {
    if (!this.mode || !this.pressed) return;
    event.stopImmediatePropagation();
    this.pressed = false;
    const dragged = this.metres * this.view.scale > 6;
    this.open = this.mode === "measure" && !dragged && !this.second;
    if (this.mode === "pose") {
      const [x, y] = this.from;
      const theta = dragged ? this.heading : 0;
      this.#end();
      this.found(x, y, theta);
    }
  }
}
