// The operator's hands: stick and keys for driving, buttons for the rest. What he asks for goes to the console as
// words; the console signs them. Nothing here is trusted by the robot, and it stops by itself when nothing more comes.

import { leavesNoFling, whenPressed } from "./touch.js";

const DRIVE_PERIOD_MS = 80; // the robot stands still 300 ms after the last one
const STICK_DEAD = 0.12; // part of the stick's way that a thumb's rest covers
const SURE_MS = 3000; // a button that destroys something wants a second press within that time
const KEYS = { w: [1, 0], s: [-1, 0], a: [0, 1], d: [0, -1] };
const ARROWS = { arrowup: "w", arrowdown: "s", arrowleft: "a", arrowright: "d" }; // while the stick has the focus
const DUMB = ["gone", "connecting"]; // links on which nothing can be said
const CONTROLS = ["goal", "explore", "reset", "save-map", "load-map", "relocate", "set", "freeze"];

const WRITTEN_TO = "input:not([type=range]), select"; // keys are theirs

const EXPLORING = /^(explores|all seen|looks for its place)/; // of ALE_STATUS
const GOING = /^drives to/;

const element = (id) => document.getElementById(id);

function driveKey(event) {
  const key = event.key.toLowerCase();
  return event.target.id === "stick" ? (ARROWS[key] ?? key) : key;
}

export class Control {
  constructor(link, pointing) {
    this.link = link;
    this.pointing = pointing;
    this.keys = new Set();
    this.stick = [0, 0]; // forward, left: -1 .. 1
    this.driving = false;
    this.linkState = "connecting";
    this.operator = null;
    this.status = null;
    this.#listenToStick();
    this.#listenToKeys();
    this.#listenToButtons();
    setInterval(() => this.#drive(), DRIVE_PERIOD_MS);
    this.#show();
  }

  // isPast: what comes is of the past, which answers no commands.
  take(message, isPast) {
    switch (message.type) {
      case "hello":
        this.operator = message.operator;
        this.hasKey = message.operator !== null;
        this.status = null;
        break;
      case "past":
        this.past = isPast;
        this.recording = message.recording;
        break;
      case "status":
        if (isPast) return;
        this.status = message;
        this.#answer(message.command);
        break;
      case "sent":
        if (message.refusal) this.#say(message.refusal, "bad");
        else this.waitsFor = { number: message.number, verb: message.verb };
        break;
      default: return;
    }
    this.#show();
  }

  // Another robot is shown: nothing that was begun with this one may reach that one.
  leave() {
    this.#release();
    this.driving = false;
    this.held = undefined;
    this.waitsFor = null;
    this.#say("", "");
    for (const button of document.querySelectorAll("button[data-sure]")) this.#unsure(button);
  }

  // The state of the link, as link.js has it.
  showLink(state) {
    if (state === this.linkState) return;
    this.linkState = state;
    this.#show();
  }

  // Why not even STOP can be said, or an empty text.
  get silence() {
    if (DUMB.includes(this.linkState)) return "no link to the console: nothing can be sent";
    if (this.operator === null) return "watching only: ale-console has no key (--keys)";
    if (!this.status) return "no robot heard yet";
    return this.status.takes_commands ? "" : "the robot takes no commands (ale-slamd --keys)";
  }

  // Why nothing but STOP can be commanded, or an empty text. Who does not see the robot does not drive it.
  get obstacle() {
    if (this.past) return this.silence || `this is ${this.recording ? "a recording" : "the past"}: STOP alone is sent`;
    return this.silence || (this.linkState === "lost" ? "link lost: STOP alone is sent" : "");
  }

  get exploring() {
    return this.status?.who_drives === "exploration" || EXPLORING.test(this.status?.exploration ?? "");
  }

  // It has a place to drive to.
  get going() {
    return GOING.test(this.status?.exploration ?? "");
  }

  #command(...words) {
    this.link.send({ type: "command", words: words.map(String) });
  }

  #stop() {
    if (this.silence) return;
    this.#release();
    this.driving = false;
    this.#command("stop");
  }

  #release() {
    this.keys.clear();
    this.stick = [0, 0];
    this.#placeKnob();
  }

  // The set point while somebody holds stick or keys; once zero when he lets go, and then silence.
  #drive() {
    const wish = [...this.keys].map((key) => KEYS[key]).reduce((sum, way) => [sum[0] + way[0], sum[1] + way[1]], this.stick);
    const held = wish[0] !== 0 || wish[1] !== 0;
    if (!held && !this.driving) return;
    this.driving = held;
    const part = (k) => Math.max(-1, Math.min(1, wish[k]));
    this.#command("drive", (part(0) * Number(element("speed-limit").value)).toFixed(3),
                  (part(1) * Number(element("turn-limit").value)).toFixed(3));
  }

  #listenToStick() {
    const stick = element("stick");
    const pointed = (event) => {
      const box = stick.getBoundingClientRect();
      const radius = box.width / 2;
      const [x, y] = [(event.clientX - box.left - radius) / radius, (event.clientY - box.top - radius) / radius];
      const length = Math.hypot(x, y);
      const shown = length > 1 ? 1 / length : 1;
      this.stick = length < STICK_DEAD ? [0, 0] : [-y * shown, -x * shown];
      this.#placeKnob();
    };
    stick.addEventListener("pointerdown", (event) => {
      if (this.obstacle) return;
      stick.setPointerCapture(event.pointerId);
      this.held = event.pointerId;
      pointed(event);
    });
    stick.addEventListener("pointermove", (event) => event.pointerId === this.held && pointed(event));
    leavesNoFling(stick);
    for (const end of ["pointerup", "pointercancel", "lostpointercapture"]) {
      stick.addEventListener(end, () => {
        this.held = undefined;
        this.#release();
      });
    }
  }

  #placeKnob() {
    element("knob").style.transform = `translate(${-this.stick[1] * 36}px, ${-this.stick[0] * 36}px)`;
  }

  #listenToKeys() {
    addEventListener("keydown", (event) => {
      const key = driveKey(event);
      const written = event.target.matches(WRITTEN_TO) && !(event.target.id === "robot" && key === " ");
      if (event.ctrlKey || event.metaKey || event.altKey || written) return;
      if (key === " " && !this.silence) {
        event.preventDefault();
        this.#stop();
      } else if (KEYS[key] && !this.obstacle) {
        event.preventDefault();
        this.keys.add(key);
      }
    });
    addEventListener("keyup", (event) => {
      this.keys.delete(event.key.toLowerCase());
      this.keys.delete(ARROWS[event.key.toLowerCase()]);
    });
    // Nobody drives from a page that nobody looks at.
    addEventListener("blur", () => this.#release());
    document.addEventListener("visibilitychange", () => document.hidden && this.#release());
  }

  #listenToButtons() {
    const name = () => element("map-name").value.trim();
    const actions = {
      explore: () => this.#command("explore", this.exploring ? "off" : "on"),
      reset: () => this.#whenSure("reset", () => this.#command("reset")),
      "save-map": () => this.#command("save_map", name()),
      "load-map": () => this.#whenSure("load-map", () => this.#command("load_map", name())),
      goal: () => this.going ? this.#stop() : this.pointing.goal((x, y) => this.#command("goto", x.toFixed(3), y.toFixed(3))),
      relocate: () => this.pointing.pose((x, y, theta) =>
        this.#command("relocate", x.toFixed(3), y.toFixed(3), theta.toFixed(4))),
      freeze: () => this.#command("set", "freeze_map", this.status?.map_frozen ? "no" : "yes"),
      set: () => this.#command("set", element("parameter").value, element("value").value.trim()),
    };
    for (const [id, action] of Object.entries(actions)) element(id).addEventListener("click", action);
    whenPressed(element("stop"), () => this.#stop());
  }

  #whenSure(id, action) {
    const button = element(id);
    if (button.dataset.sure) {
      this.#unsure(button);
      action();
      return;
    }
    button.dataset.words = button.textContent;
    button.textContent = "sure?";
    button.dataset.sure = setTimeout(() => this.#unsure(button), SURE_MS);
  }

  #unsure(button) {
    clearTimeout(Number(button.dataset.sure));
    button.textContent = button.dataset.words;
    delete button.dataset.sure;
  }

  // Each driver sees his own commands answered; drive is answered by moving.
  #answer(command) {
    if (!this.waitsFor || command.operator !== this.operator || command.number < this.waitsFor.number) return;
    if (this.waitsFor.verb !== "drive" || !command.obeyed) {
      this.#say(command.result, command.obeyed ? "fine" : "bad");
    }
    this.waitsFor = null;
  }

  #say(text, mood) {
    element("answer").textContent = text;
    element("answer").className = mood;
  }

  #show() {
    const obstacle = this.obstacle;
    document.body.dataset.control = this.hasKey ? (obstacle ? "off" : "yes") : "watching";
    element("control-note").textContent = obstacle;
    for (const id of CONTROLS) element(id).disabled = obstacle !== "";
    element("stop").disabled = this.silence !== "";
    element("stick").setAttribute("aria-disabled", String(obstacle !== ""));
    if (obstacle) this.#release();
    element("operator").textContent = this.operator ?? "nobody";
    element("who-drives").textContent = this.status?.who_drives || "nobody";
    element("goal").textContent = this.going ? "leave goal" : "drive there";
    element("exploration").textContent = (this.status?.exploration || "off").replace(/ m2\b/, " m²");
    element("explore").setAttribute("aria-pressed", String(this.exploring));
    element("freeze").setAttribute("aria-pressed", String(Boolean(this.status?.map_frozen)));
  }
}
