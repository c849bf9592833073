// Draws the scene. Strokes are in screen pixels at every zoom and the canvas has the screen's own
// resolution, so the picture stays crisp.

import { drawGraph } from "./graph.js";

const ROBOT_RADIUS_M = 0.17;
const ROBOT_LEAST_PX = 9;
const ELLIPSE_SIGMAS = 3;
const ELLIPSE_MAGNIFIED = 10; // millimetres would not be seen; the legend says so
const HEADING_LENGTH = 3; // radii of the robot
const SURE_AFTER_SCANS = 5; // a tenth of a metre apart, as a rule; a wall seen less often is drawn paler
const APART_DASH = [8, 5]; // walls of a map that the robot's is not joined with: told by shape as well as by colour
const PATH_DASH = [2, 7];
const FRESH_TRAIL_POINTS = 250;
const GRID_LEAST_PX = 44;
const BAND_LEAST_PX = 2.5;
const FAR_PX = 1e4; // an ellipse far beyond the screen is as good as this one

const shown = (variance) => ELLIPSE_SIGMAS * ELLIPSE_MAGNIFIED * Math.sqrt(Math.max(0, variance));

// The path of a covariance around the origin, drawn from least pixels outwards.
function ellipse(context, [xx, xy, yy], least, scale) {
  const middle = (xx + yy) / 2;
  const spread = Math.hypot((xx - yy) / 2, xy);
  const axis = (variance) => Math.min(FAR_PX, least + shown(variance) * scale);
  context.beginPath();
  context.ellipse(0, 0, axis(middle + spread), axis(middle - spread), -Math.atan2(2 * xy, xx - yy) / 2, 0, 2 * Math.PI);
}

export class Painter {
  constructor(canvas, scene, view, pointing, layers) {
    this.canvas = canvas;
    this.scene = scene;
    this.view = view;
    this.pointing = pointing;
    this.layers = layers;
    this.context = canvas.getContext("2d");
    this.due = true;
  }

  wanted() {
    this.due = true;
  }

  themeChanged() {
    const style = getComputedStyle(document.documentElement);
    this.colour = (name) => style.getPropertyValue(`--${name}`);
    this.due = true;
  }

  frame() {
    if (!this.due) return;
    this.due = false;
    this.#fitToScreen();
    const c = this.context;
    c.fillStyle = this.colour("ground");
    c.fillRect(0, 0, this.view.width, this.view.height);
    c.lineCap = "round";
    c.lineJoin = "round";
    this.#grid();
    this.#layer("occupancy", () => this.scene.occupancy.draw(c, this.view, this.#numbers("sight"), this.#numbers("wall")));
    this.#layer("scan", () => this.#sight());
    this.#layer("trail", () => this.#trail());
    this.#layer("path", () => this.#plan());
    this.#layer("scan", () => this.#points());
    this.#layer("lines", () => this.#uncertain() && this.#lineBands());
    this.#walls();
    this.#layer("graph", () => this.#graph());
    this.#layer("lines", () => this.#currentLines());
    this.#layer("corners", () => this.#corners());
    this.#robot();
    this.#pointedAt();
    this.#scaleBar();
  }

  #layer(name, draw) {
    if (this.layers.isOn(name)) draw();
  }

  // A colour as [r, g, b].
  #numbers(name) {
    const text = this.colour(name).trim();
    return [1, 3, 5].map((k) => parseInt(text.slice(k, k + 2), 16));
  }

  #uncertain() {
    return this.layers.isOn("uncertainty");
  }

  #fitToScreen() {
    const ratio = devicePixelRatio || 1;
    const [w, h] = [Math.round(this.view.width * ratio), Math.round(this.view.height * ratio)];
    if (this.canvas.width !== w || this.canvas.height !== h) {
      this.canvas.width = w;
      this.canvas.height = h;
    }
    this.context.setTransform(ratio, 0, 0, ratio, 0, 0);
  }

  // Smallest step of 1, 2, 5, 10 .. metres (or parts) whose lines stay apart.
  #gridStep(leastPx) {
    const least = leastPx / this.view.scale;
    const power = 10 ** Math.floor(Math.log10(least));
    return power * [1, 2, 5, 10].find((k) => k * power >= least);
  }

  #grid() {
    const step = this.#gridStep(GRID_LEAST_PX);
    const [left, top] = this.view.toMap(0, 0);
    const [right, bottom] = this.view.toMap(this.view.width, this.view.height);
    const c = this.context;
    c.lineWidth = 1;
    const strong = (k) => k % 5 === 0;
    for (const bold of [false, true]) {
      c.strokeStyle = this.colour(bold ? "grid-strong" : "grid");
      c.beginPath();
      for (let k = Math.ceil(left / step); k <= right / step; k++) {
        if (strong(k) !== bold) continue;
        const px = Math.round(this.view.toScreen(k * step, 0)[0]) + 0.5;
        c.moveTo(px, 0);
        c.lineTo(px, this.view.height);
      }
      for (let k = Math.ceil(bottom / step); k <= top / step; k++) {
        if (strong(k) !== bold) continue;
        const py = Math.round(this.view.toScreen(0, k * step)[1]) + 0.5;
        c.moveTo(0, py);
        c.lineTo(this.view.width, py);
      }
      c.stroke();
    }
  }

  #path(points, from = 0) {
    const c = this.context;
    c.beginPath();
    let pen = false;
    for (let k = from; k < points.length; k += 2) {
      if (points[k] === null) {
        pen = false;
        continue;
      }
      const [px, py] = this.view.toScreen(points[k], points[k + 1]);
      pen ? c.lineTo(px, py) : c.moveTo(px, py);
      pen = true;
    }
  }

  #sight() {
    const c = this.context;
    this.#path(this.scene.sight);
    c.globalAlpha = 0.1;
    c.fillStyle = this.colour("sight");
    c.fill();
    c.globalAlpha = 1;
  }

  #trail() {
    const c = this.context;
    const trail = this.scene.trail;
    c.strokeStyle = this.colour("trail");
    c.lineWidth = 2;
    this.#path(trail);
    c.globalAlpha = 0.42;
    c.stroke();
    this.#path(trail, Math.max(0, trail.length - 2 * FRESH_TRAIL_POINTS));
    if (this.scene.pose) c.lineTo(...this.view.toScreen(...this.scene.pose.map.slice(0, 2)));
    c.globalAlpha = 0.75;
    c.stroke();
    c.globalAlpha = 1;
  }

  // Where the robot drives by itself, and the place that it was told to drive to.
  #plan() {
    const plan = this.scene.plan;
    if (!plan || plan.state === "off") return;
    const c = this.context;
    c.strokeStyle = c.fillStyle = this.colour("path");
    c.lineWidth = 3;
    c.setLineDash(PATH_DASH);
    this.#path(plan.path);
    c.stroke();
    c.setLineDash([]);
    if (!plan.place) return;
    const [px, py] = this.view.toScreen(...plan.place);
    c.beginPath();
    c.arc(px, py, 9, 0, 2 * Math.PI);
    c.stroke();
    c.beginPath();
    if (plan.state === "given up") {
      for (const d of [-1, 1]) {
        c.moveTo(px - 5, py - 5 * d);
        c.lineTo(px + 5, py + 5 * d);
      }
      c.stroke();
    } else {
      c.arc(px, py, 3.5, 0, 2 * Math.PI);
      c.fill();
    }
  }

  #walls() {
    const lines = this.scene.map?.lines ?? [];
    const here = lines.filter((l) => !this.scene.isApart(l));
    this.#layer("apart", () => this.#strokeWalls(lines.filter((l) => this.scene.isApart(l)), "apart", 1, APART_DASH));
    this.#layer("map", () => {
      this.#strokeWalls(here.filter((l) => l.seen < SURE_AFTER_SCANS), "wall", 0.45);
      this.#strokeWalls(here.filter((l) => l.seen >= SURE_AFTER_SCANS), "wall", 1);
    });
  }

  #strokeWalls(lines, colour, alpha, dash = []) {
    const c = this.context;
    c.strokeStyle = this.colour(colour);
    c.lineWidth = 2.5;
    c.globalAlpha = alpha;
    c.lineCap = dash.length ? "butt" : "round";
    c.setLineDash(dash);
    c.beginPath();
    for (const l of lines) {
      c.moveTo(...this.view.toScreen(l.x1, l.y1));
      c.lineTo(...this.view.toScreen(l.x2, l.y2));
    }
    c.stroke();
    c.setLineDash([]);
    c.lineCap = "round";
    c.globalAlpha = 1;
  }

  #graph() {
    if (this.scene.graph) drawGraph(this.context, this.view, this.scene, this.colour);
  }

  #currentLines() {
    const c = this.context;
    c.strokeStyle = this.colour("line");
    c.lineWidth = 1.75;
    c.beginPath();
    for (const [x1, y1, x2, y2] of this.scene.lines) {
      c.moveTo(...this.view.toScreen(x1, y1));
      c.lineTo(...this.view.toScreen(x2, y2));
    }
    c.stroke();
  }

  // Three sigma to either side, magnified like the robot's.
  #lineBands() {
    const c = this.context;
    c.fillStyle = this.colour("line");
    c.globalAlpha = 0.25;
    this.scene.lines.forEach(([x1, y1, x2, y2], k) => {
      const [px, py] = this.view.toScreen(x1, y1);
      const [qx, qy] = this.view.toScreen(x2, y2);
      const length = Math.hypot(qx - px, qy - py) || 1;
      const [nx, ny] = [-(qy - py) / length, (qx - px) / length];
      const [a, b] = this.scene.lineSigmas[k].map((sigma) => BAND_LEAST_PX + shown(sigma * sigma) * this.view.scale);
      c.beginPath();
      for (const [x, y, w] of [[px, py, a], [qx, qy, b], [qx, qy, -b], [px, py, -a]]) c.lineTo(x + w * nx, y + w * ny);
      c.closePath();
      c.fill();
    });
    c.globalAlpha = 1;
  }

  #points() {
    const c = this.context;
    c.fillStyle = this.colour("scan");
    const size = Math.min(4, Math.max(2, this.view.scale / 60));
    for (let k = 0; k < this.scene.points.length; k += 2) {
      const [px, py] = this.view.toScreen(this.scene.points[k], this.scene.points[k + 1]);
      c.fillRect(px - size / 2, py - size / 2, size, size);
    }
  }

  #corners() {
    const c = this.context;
    c.fillStyle = this.colour("corner");
    c.strokeStyle = this.colour("ground");
    c.lineWidth = 1.5;
    this.scene.corners.forEach(([x, y], k) => {
      const [px, py] = this.view.toScreen(x, y);
      this.#cornerEllipse(px, py, this.scene.cornerCovs[k]);
      c.beginPath();
      for (const [dx, dy] of [[0, -6], [6, 0], [0, 6], [-6, 0]]) c.lineTo(px + dx, py + dy);
      c.closePath();
      c.fill();
      c.stroke();
    });
  }

  #cornerEllipse(px, py, cov) {
    if (!this.#uncertain() || cov.some((v) => !Number.isFinite(v))) return;
    const c = this.context;
    c.save();
    c.translate(px, py);
    c.strokeStyle = this.colour("corner");
    ellipse(c, cov, 6, this.view.scale);
    c.stroke();
    c.restore();
  }

  // What the operator measures, or where he says the robot is; and the cross that his keys move.
  #pointedAt() {
    const { mode, from, to, cross } = this.pointing;
    const c = this.context;
    if (mode && cross) this.#cross(...this.view.toScreen(...cross));
    if (!from) return;
    const [px, py] = this.view.toScreen(...from);
    const [qx, qy] = this.view.toScreen(...to);
    c.strokeStyle = c.fillStyle = this.colour("pointed");
    c.lineWidth = 2;
    c.beginPath();
    c.moveTo(px, py);
    c.lineTo(qx, qy);
    c.stroke();
    for (const [x, y] of mode === "pose" ? [[px, py]] : [[px, py], [qx, qy]]) {
      c.beginPath();
      c.arc(x, y, 5, 0, 2 * Math.PI);
      c.fill();
    }
    if (mode !== "measure") return;
    this.canvas.dataset.measured = this.pointing.metres.toFixed(3);
    this.#label(`${this.pointing.metres.toFixed(3)} m`, (px + qx) / 2, (py + qy) / 2);
  }

  #cross(px, py) {
    const c = this.context;
    c.strokeStyle = this.colour("pointed");
    c.lineWidth = 2;
    c.beginPath();
    for (const [dx, dy] of [[14, 0], [0, 14]]) {
      c.moveTo(px - dx, py - dy);
      c.lineTo(px + dx, py + dy);
    }
    c.stroke();
  }

  #label(text, x, y) {
    const c = this.context;
    c.font = "600 15px system-ui, sans-serif";
    const width = c.measureText(text).width + 16;
    c.fillStyle = this.colour("pointed");
    c.beginPath();
    c.roundRect(x - width / 2, y - 34, width, 24, 6);
    c.fill();
    c.fillStyle = this.colour("on");
    c.textAlign = "center";
    c.fillText(text, x, y - 17);
  }

  #robot() {
    const pose = this.scene.pose;
    if (!pose) return;
    const c = this.context;
    const [px, py] = this.view.toScreen(pose.map[0], pose.map[1]);
    const radius = Math.max(ROBOT_LEAST_PX, ROBOT_RADIUS_M * this.view.scale);
    c.save();
    c.translate(px, py);
    c.strokeStyle = c.fillStyle = this.colour("robot");
    this.#uncertainty(pose, radius);
    c.rotate(-pose.map[2]);
    c.beginPath();
    c.arc(0, 0, radius, 0, 2 * Math.PI);
    c.fill();
    c.lineWidth = 2;
    c.strokeStyle = this.colour("robot-edge");
    c.stroke();
    c.fillStyle = this.colour("robot-edge");
    c.beginPath();
    for (const [f, l] of [[0.72, 0], [-0.42, 0.5], [-0.2, 0], [-0.42, -0.5]]) c.lineTo(f * radius, l * radius);
    c.closePath();
    c.fill();
    c.restore();
  }

  // Three sigma, magnified: how far the robot's edge may lie from where it is drawn, and the wedge of its heading.
  #uncertainty(pose, radius) {
    const [xx, xy, , , yy, , , , tt] = pose.cov;
    if (!this.#uncertain() || [xx, xy, yy, tt].some((v) => v === null)) return;
    const c = this.context;
    ellipse(c, [xx, xy, yy], radius + 1.5, this.view.scale);
    c.globalAlpha = 0.14;
    c.fill();
    c.globalAlpha = 0.9;
    c.setLineDash([5, 4]);
    c.lineWidth = 1.5;
    c.stroke();
    c.setLineDash([]);
    const half = Math.min(Math.PI, shown(tt));
    c.beginPath();
    c.moveTo(0, 0);
    c.arc(0, 0, radius * HEADING_LENGTH, -pose.map[2] - half, -pose.map[2] + half);
    c.closePath();
    c.globalAlpha = 0.22;
    c.fill();
    c.globalAlpha = 1;
  }

  // Written only when it is another: the page is laid out anew for it.
  #scaleBar() {
    if (this.view.scale === this.barScale) return;
    this.barScale = this.view.scale;
    const step = this.#gridStep(70);
    document.getElementById("scale-text").textContent = step >= 1 ? `${step} m` : step >= 0.01 ? `${Math.round(step * 100)} cm` : `${Math.round(step * 1000)} mm`;
    document.getElementById("scale-bar").style.width = `${step * this.view.scale}px`;
  }
}
