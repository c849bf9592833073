// Recordings of what the console hears, and saved maps: made, listed with a drawing of their map, and downloaded. The
// files lie with the console; the page only asks for them.

import { bytesInWords, dateInWords, flightInWords, lengthInWords } from "./words.js";

const ENDINGS = { recordings: ".lcm", flights: ".scip", maps: ".map" };
const KINDS = Object.keys(ENDINGS);
const FEW = 3; // what is shown of a long list at first
const DUMB = ["gone", "connecting"]; // links on which nothing can be asked
const SVG = "http://www.w3.org/2000/svg";

const element = (id) => document.getElementById(id);

function made(tag, properties = {}, ...children) {
  const node = Object.assign(document.createElement(tag), properties);
  node.append(...children);
  return node;
}

// The walls of a map, [x1, y1, x2, y2, ...], y up.
function drawing(walls, words) {
  const svg = document.createElementNS(SVG, "svg");
  const of = (axis) => walls.filter((_, k) => k % 2 === axis);
  const least = (values) => values.reduce((a, b) => Math.min(a, b), Infinity);
  const [left, bottom, width, height] = walls.length ? [least(of(0)), least(of(1)), -least(of(0).map((x) => -x)) - least(of(0)),
    -least(of(1).map((y) => -y)) - least(of(1))] : [0, 0, 1, 1];
  svg.setAttribute("viewBox", `0 0 ${width || 1} ${height || 1}`);
  svg.setAttribute("role", "img");
  svg.setAttribute("aria-label", words);
  svg.setAttribute("class", "thumbnail");
  const path = document.createElementNS(SVG, "path");
  const strokes = [];
  for (let k = 0; k < walls.length; k += 4) {
    const [x1, y1, x2, y2] = walls.slice(k, k + 4);
    strokes.push(`M${x1 - left} ${bottom + height - y1}L${x2 - left} ${bottom + height - y2}`);
  }
  path.setAttribute("d", strokes.join(""));
  svg.append(path);
  return svg;
}

export class Recordings {
  constructor(link) {
    this.link = link;
    this.shelf = null;
    this.recorder = null;
    this.hasMap = false;
    this.opened = null; // the file of the recording that is shown
    this.awaited = null; // of one that was asked for, and is being replayed
    this.all = false; // of a long list
    this.mute = true;
    element("record").addEventListener("click", () => this.#record());
    element("map-ending").addEventListener("change", () => this.#showLinks());
    element("shelf-more").addEventListener("click", () => {
      this.all = !this.all;
      this.#showShelf();
    });
    this.#showLinks();
  }

  take(message) {
    switch (message.type) {
      case "hello":
        this.opened = this.awaited = null;
        this.hasMap = false;
        this.known = undefined;
        this.#ask();
        this.#showLinks();
        break;
      case "past":
        this.opened = message.recording;
        if (message.recording || message.at === null) this.#await(null);
        this.#showOpened();
        break;
      case "map": if (!this.opened) this.#mapCame(message.lines); break;
      case "link": this.#recorderTold(message.recorder); break;
      case "shelf":
        this.shelf = message;
        if (message.refusal) this.awaited = null;
        this.#showShelf();
        this.#showRecorder();
        break;
      case "status": this.#lookForNew(message); break;
    }
  }

  // Another robot is shown, which has recordings and a map of its own.
  leave() {
    this.shelf = this.recorder = this.awaited = null;
    this.hasMap = this.all = false;
    document.querySelector("#shelf .thumbnail").replaceWith(made("span", { className: "thumbnail" }));
    element("shelf").replaceChildren(element("shelf").firstElementChild);
    element("shelf-more").hidden = true;
    this.#showRecorder();
    this.#showLinks();
  }

  // The state of the link, as link.js has it.
  showLink(state) {
    const mute = DUMB.includes(state);
    if (mute === this.mute) return;
    this.mute = mute;
    this.#showRecorder();
    this.#showLinks();
  }

  // A flight is replayed before it can be shown: that takes its time.
  #await(file) {
    this.awaited = file;
    this.#showRecorder();
  }

  #ask() {
    this.link.send({ type: "shelf" });
  }

  #record() {
    this.link.send({ type: "record", on: !this.recorder?.name });
  }

  #mapCame(lines) {
    const walls = lines.filter((l) => !l.map_id).flatMap((l) => [l.x1, l.y1, l.x2, l.y2]);
    document.querySelector("#shelf .thumbnail").replaceWith(drawing(walls, "map of now"));
    if (this.hasMap) return;
    this.hasMap = true;
    this.#showLinks();
  }

  // A map that the robot has saved, or a flight that it has written, may lie in the console's folders.
  #lookForNew({ command, counters }) {
    if (this.opened) return;
    const saved = /^saved /.test(command.result) ? command.number : null;
    const flights = counters.find(({ name }) => name === "flight_recordings")?.value ?? 0;
    const known = this.known;
    if (known && ((saved !== null && saved !== known.saved) || flights !== known.flights)) this.#ask();
    this.known = { saved, flights };
  }

  #recorderTold(recorder) {
    const before = this.recorder;
    this.recorder = recorder;
    if (before && (before.name !== recorder.name || before.trouble !== recorder.trouble)) this.#ask();
    this.#showRecorder();
  }

  // What is told to a screen reader changes only when something happens; the seconds run beside it.
  #showRecorder() {
    const recorder = this.recorder ?? {};
    const on = Boolean(recorder.name);
    const button = element("record");
    button.disabled = this.mute || !this.shelf?.recordings.folder;
    button.setAttribute("aria-pressed", String(on));
    button.textContent = on ? "stop recording" : "record";
    element("recorder-text").textContent = on
      ? `${lengthInWords(Date.now() - recorder.begun)}, ${bytesInWords(recorder.bytes)}${recorder.dropped ? `, ${recorder.dropped} dropped` : ""}` : "";
    const note = element("recordings-note");
    const [words, mood] = this.#words(recorder);
    if (note.textContent !== words) note.textContent = words;
    note.className = mood;
  }

  #words(recorder) {
    if (!this.shelf) return ["", ""];
    const { recordings, flights, maps, refusal } = this.shelf;
    if (this.awaited) return [`replaying ${this.awaited}: it is shown when that is done`, ""];
    if (recorder.name) return [`recording ${recorder.name}`, ""];
    const trouble = refusal ?? recorder.trouble ?? recordings.trouble ?? flights.trouble ?? maps.trouble;
    if (trouble) return [`${trouble[0].toUpperCase()}${trouble.slice(1)}.`, "bad"];
    if (!recordings.folder) return ["No folder for recordings: start ale-console with --recordings DIR.", ""];
    if (recorder.messages) return [`${recorder.messages} messages recorded${recorder.dropped ? `, ${recorder.dropped} dropped` : ""}`, ""];
    return [recordings.pieces.length ? "" : "nothing recorded yet", ""];
  }

  #showShelf() {
    const pieces = KINDS.flatMap((kind) => this.shelf[kind].pieces.map((piece) => ({ ...piece, kind }))).sort((a, b) => b.at - a.at);
    const shown = this.all ? pieces : pieces.slice(0, FEW);
    const list = element("shelf");
    list.replaceChildren(list.firstElementChild, ...shown.map((piece) => this.#row(piece)));
    const more = element("shelf-more");
    const left = pieces.length - FEW;
    const older = KINDS.reduce((sum, kind) => sum + this.shelf[kind].more, 0);
    more.hidden = left <= 0;
    more.textContent = this.all ? `fewer${older ? ` (${older} older ones in the folders)` : ""}` : `${left} more`;
    more.setAttribute("aria-expanded", String(this.all));
    this.#showLinks();
  }

  #row({ kind, name, at, length_ms: length, bytes, scans, walls, reason, drawing: lines }) {
    const file = `${name}${ENDINGS[kind]}`;
    const recorded = kind !== "maps";
    const flight = kind === "flights";
    const what = flight ? "flight" : recorded ? "recording" : "saved map";
    const facts = [recorded ? lengthInWords(length) : name, bytesInWords(bytes), recorded && !scans ? "no scans" : "",
                   flight ? flightInWords(reason) : walls === null ? "no map" : `${walls} walls`];
    const buttons = made("span", { className: "buttons" });
    if (recorded) buttons.append(this.#link(`log-${file}`, "log", `download the ${what} ${name}`, `/${kind}/${file}`));
    if (flight || walls !== null) {
      const link = this.#link(`map-${kind}-${name}`, "map", `download the map of the ${what} ${name}`);
      link.dataset.path = `/${kind}/${name}`;
      buttons.append(link);
    }
    const picture = drawing(lines, `map of the ${what} ${name}`);
    const text = [made("strong", { textContent: recorded ? dateInWords(at) : `map ${dateInWords(at)}` }),
                  made("span", { textContent: facts.filter(Boolean).join(", ") })];
    return recorded ? made("li", {}, this.#opener(what, file, picture, text), buttons)
      : made("li", {}, picture, made("span", { className: "piece" }, ...text), buttons);
  }

  // A press on a recording shows it.
  #opener(what, file, picture, text) {
    const opener = made("button", { id: `open-${file}`, type: "button", className: "piece", title: "show this recording" }, picture,
                        made("span", {}, ...text));
    opener.setAttribute("aria-label", `show the ${what} ${file}, ${text.map((part) => part.textContent).join(", ")}`);
    opener.addEventListener("click", () => {
      this.#await(what === "flight" && file !== this.opened ? file : null);
      this.link.send({ type: "open", name: file });
    });
    return opener;
  }

  #showOpened() {
    for (const opener of document.querySelectorAll("#shelf button")) {
      opener.setAttribute("aria-pressed", String(opener.id === `open-${this.opened}`));
      opener.disabled = this.mute;
    }
  }

  #link(id, text, name, path) {
    const link = made("a", { id, className: "button", textContent: text, download: "" });
    link.setAttribute("aria-label", name);
    if (path) link.dataset.file = path;
    return link;
  }

  // Where the links lead: nowhere without a console, and maps to the chosen kind of file.
  #showLinks() {
    this.#showOpened();
    const ending = element("map-ending").value;
    const live = element("live-map");
    live.dataset.path = this.hasMap ? "/live/map" : "";
    live.setAttribute("aria-label", "download the map of now");
    element("live-map-text").textContent = this.hasMap ? "as the robot has it" : "none heard yet";
    for (const link of document.querySelectorAll("#shelf a")) {
      const path = link.dataset.file ?? (link.dataset.path && `${link.dataset.path}.${ending}`);
      if (path && !this.mute) link.href = path + location.search;
      else link.removeAttribute("href");
      link.setAttribute("aria-disabled", String(!link.hasAttribute("href")));
    }
  }
}
