// The last ten minutes, as the console keeps them, or a recording: looked at by a slider, or played. While the past is
// looked at, what the page shows is of then; the link is still that of now, and STOP still stops.

import { dateInWords, lengthInWords } from "./words.js";

const PLAY_STEP_MS = 200;

const element = (id) => document.getElementById(id);

export class Timeline {
  constructor(link) {
    this.link = link;
    this.at = null; // what is shown is of then, milliseconds since 1970; null: of now
    this.recording = null; // its name, while one is looked at
    this.damage = null; // what of it is left out, in words
    this.wanted = null; // asked for while an answer is on its way
    this.asked = false;
    this.kept = [0, 0];
    element("when").addEventListener("input", () => this.#scrub());
    element("live").addEventListener("click", () => this.#now());
    element("play").addEventListener("click", () => this.#play(!this.playing));
    addEventListener("keydown", (event) => this.#key(event));
    setInterval(() => this.#step(), PLAY_STEP_MS);
    this.#show();
  }

  get isPast() {
    return this.at !== null;
  }

  take(message) {
    switch (message.type) {
      case "hello": this.at = this.wanted = this.recording = this.damage = null; this.asked = false; this.kept = [0, 0]; this.#play(false); break;
      case "link": this.kept = message.kept; break;
      case "past": this.#answered(message); break;
      default: return;
    }
    this.#show();
  }

  showLink(state) {
    const mute = ["gone", "connecting"].includes(state) || this.kept[0] === this.kept[1];
    for (const id of ["when", "play", "live"]) element(id).disabled = mute;
  }

  #answered(message) {
    this.asked = false;
    this.at = message.at;
    this.damage = message.damage;
    if (message.recording !== this.recording) {
      this.recording = message.recording;
      this.wanted = null;
      this.kept = message.kept;
      this.#play(false);
      if (this.recording !== null) this.#fitSlider(this.at);
    }
    if (this.wanted !== null) this.#look(this.wanted);
  }

  // One question at a time; the newest wish takes the place of those before.
  #look(at) {
    this.wanted = null;
    if (this.asked) {
      this.wanted = at;
      return;
    }
    this.asked = true;
    this.link.send({ type: "look", at });
  }

  #scrub() {
    this.#play(false);
    const at = Number(element("when").value);
    at >= Number(element("when").max) && !this.recording ? this.#now() : this.#look(at);
  }

  #now() {
    this.#play(false);
    this.wanted = null;
    this.link.send({ type: "look", at: null });
  }

  // From where he looks; from the beginning where he looks at now, or at the end of a recording.
  #play(playing) {
    this.playing = playing;
    if (playing && (!this.isPast || (this.recording && this.at >= this.kept[1]))) this.#look(this.kept[0]);
    element("play").setAttribute("aria-pressed", String(playing));
  }

  #step() {
    if (!this.playing || this.asked || !this.isPast) return;
    const next = this.at + PLAY_STEP_MS;
    if (next < this.kept[1]) this.#look(next);
    else if (this.recording) this.#end();
    else this.#now();
  }

  #end() {
    this.#look(this.kept[1]);
    this.#play(false);
  }

  #fitSlider(at) {
    const slider = element("when");
    [slider.min, slider.max] = this.kept;
    slider.value = at;
  }

  #key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.matches("input, select") || element("play").disabled) return;
    if (event.key === "p") this.#play(!this.playing);
    else if (event.key === "n") this.#now();
  }

  // While the past is looked at, the slider's ends stay where they are: nothing moves under a finger.
  #show() {
    const slider = element("when");
    if (!this.isPast && !this.asked) this.#fitSlider(this.kept[1]);
    else if (this.playing) slider.value = this.at;
    document.body.dataset.time = this.recording ? "recording" : this.isPast ? "past" : "now";
    element("past-word").textContent = this.recording ? "recording" : "past";
    element("live").setAttribute("aria-pressed", String(!this.isPast));
    element("past").hidden = !this.isPast;
    const words = this.#words();
    if (element("past-text").textContent !== words) element("past-text").textContent = words;
    if (element("past-damage").textContent !== (this.damage ?? "")) element("past-damage").textContent = this.damage ?? "";
    element("when-text").textContent = this.recording ? lengthInWords(this.at - this.kept[0]) : this.isPast ? `-${lengthInWords(this.kept[1] - this.at)}` : lengthInWords(this.kept[1] - this.kept[0]);
    slider.setAttribute("aria-valuetext", this.isPast ? words : "now");
    element("timeline").setAttribute("aria-label", this.recording ? `The recording ${this.recording}` : "The last ten minutes");
  }

  #words() {
    if (!this.isPast) return "";
    if (!this.recording) return `${clockTime(this.at)}, ${lengthInWords(this.kept[1] - this.at)} ago`;
    const [at, whole] = [this.at - this.kept[0], this.kept[1] - this.kept[0]].map(lengthInWords);
    return `${dateInWords(this.at).slice(0, 10)} ${clockTime(this.at)}, ${at} of ${whole}`;
  }
}

function clockTime(ms) {
  const time = new Date(ms);
  return [time.getHours(), time.getMinutes(), time.getSeconds()].map((n) => String(n).padStart(2, "0")).join(":");
}
