// The operator's page: wires the link, the scene, the view on it and the health strip together.
import { Link } from "./link.js";
import { Scene } from "./scene.js";
import { View } from "./view.js";
import { Painter } from "./paint.js";
import { Fleet } from "./fleet.js";
import { Health } from "./health.js";
import { Layers } from "./layers.js";
import { Pointing } from "./pointing.js";
import { Control } from "./control.js";
import { Plots } from "./plots.js";
import { Recordings } from "./recordings.js";
import { Timeline } from "./timeline.js";

const canvas = document.getElementById("map");
const scene = new Scene();
const view = new View(canvas, scene, () => painter.wanted());
const layers = new Layers(() => painter.wanted());
const pointing = new Pointing(canvas, view, () => painter.wanted());
const painter = new Painter(canvas, scene, view, pointing, layers);
const health = new Health(layers);
const link = new Link((message) => {
  fleet.take(message);
  timeline.take(message);
  scene.take(message);
  control.take(message, timeline.isPast);
  health.take(message, scene);
  plots.take(message, timeline.isPast);
  recordings.take(message);
  painter.wanted();
});
const control = new Control(link, pointing);
const timeline = new Timeline(link);
const plots = new Plots(link);
const recordings = new Recordings(link);
const fleet = new Fleet(link, () => {
  for (const part of [view, pointing, control, health, recordings]) part.leave();
});

for (const [id, action] of Object.entries({
  "zoom-in": () => view.zoom(1.4),
  "zoom-out": () => view.zoom(1 / 1.4),
  follow: () => view.follow(),
  whole: () => view.whole(),
  theme: () => changeTheme(),
})) {
  document.getElementById(id).addEventListener("click", action);
}

const lightPreferred = matchMedia("(prefers-color-scheme: light)");

// The operator's choice stays; until he makes one, the system's preference rules.
function showTheme() {
  const preferred = lightPreferred.matches ? "light" : "dark";
  document.documentElement.dataset.theme = localStorage.getItem("theme") ?? preferred;
  painter.themeChanged();
  plots.due = true;
}

function changeTheme() {
  localStorage.setItem("theme", document.documentElement.dataset.theme === "light" ? "dark" : "light");
  showTheme();
}

// A lost link must show within one second: it is looked at ten times a second, whatever arrives.
setInterval(() => {
  health.showLink(link, scene);
  control.showLink(link.state);
  fleet.showLink(link.state);
  timeline.showLink(link.state);
  recordings.showLink(link.state);
}, 100);

function frame(now) {
  view.step(now);
  painter.frame();
  health.frame();
  plots.frame();
  link.drawn();
  requestAnimationFrame(frame);
}

lightPreferred.addEventListener("change", showTheme);
showTheme();
link.open();
requestAnimationFrame(frame);
