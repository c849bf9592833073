// The web socket to ale-console: opens it, opens it again, tells it what has been drawn, and knows how old
// the news is. Pacing: the console keeps at most a few messages on their way, so a slow page sees the newest.

const PROTOCOL = 6;
const SILENCE_MS = 800; // the console speaks four times a second
const POSE_SILENCE_MS = 700; // a pose comes with every scan, ten a second from a URG
const STATUS_SILENCE_MS = 1600; // a status comes every second
const RETRY_MS = 400;
const PATIENCE_MS = 1000; // with a console that does not answer

export class Link {
  constructor(onMessage) {
    this.onMessage = onMessage;
    this.#forget();
    // A page that comes to the front again asks at once for what it missed.
    document.addEventListener("visibilitychange", () => this.drawn());
  }

  #forget() {
    this.heardAt = -Infinity; // anything from the console
    this.poseAt = -Infinity; // a pose, by this page's clock
    this.statusAt = -Infinity;
    this.scansCome = true; // as the status says
    this.past = false; // poses and statuses that come are old ones
    this.opened = false;
  }

  // Another robot of the console: what comes from now on is of that one, and so is all that the page's address is handed on
  // to. What was known of this one is forgotten at once, whenever the console answers; nothing can be sent until then.
  choose(robot) {
    const query = new URLSearchParams(location.search);
    query.set("robot", robot);
    history.replaceState(null, "", `?${query.toString().replaceAll("+", "%20")}`);
    this.socket.onmessage = this.socket.onclose = null;
    this.socket.close();
    this.#forget();
    this.open();
    this.onMessage({ ...this.hello, robot });
  }

  open() {
    clearTimeout(this.retry);
    const scheme = location.protocol === "https:" ? "wss" : "ws";
    this.socket = new WebSocket(`${scheme}://${location.host}/${location.search}`);
    this.received = 0;
    this.told = 0;
    this.posesSinceOpened = 0;
    this.socket.onmessage = (event) => this.#take(JSON.parse(event.data));
    this.socket.onclose = () => {
      this.heardAt = -Infinity; // nothing more can come
      this.retry = setTimeout(() => this.#openAgain(), RETRY_MS);
    };
  }

  // A console that was started anew without this robot says so on its page, and to no web socket.
  #openAgain() {
    const { socket } = this;
    const again = () => socket === this.socket && this.open();
    fetch(location.href, { cache: "no-store", signal: AbortSignal.timeout(PATIENCE_MS) })
      .then((answer) => (answer.status === 404 ? location.reload() : again()), again);
  }

  send(message) {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }

  // Everything received so far is on the screen.
  drawn() {
    if (this.received !== this.told && this.socket.readyState === WebSocket.OPEN) {
      this.told = this.received;
      this.send({ type: "got", count: this.told });
    }
  }

  // "connecting" before the first word, "gone" without the console, "waiting" for a robot's first pose,
  // "blind" when poses stopped and the robot says that no scan comes, "lost" when they just stopped, else "up".
  get state() {
    const now = performance.now();
    if (now - this.heardAt > SILENCE_MS) {
      return this.opened ? "gone" : "connecting";
    }
    if (this.poseAt === -Infinity) {
      return "waiting";
    }
    if (now - this.poseAt <= POSE_SILENCE_MS) {
      return "up";
    }
    return !this.scansCome && this.hasStatus ? "blind" : "lost";
  }

  // The robot has reported itself lately.
  get hasStatus() {
    return performance.now() - this.statusAt <= STATUS_SILENCE_MS;
  }

  get poseAgeMs() {
    return performance.now() - this.poseAt;
  }

  #take(message) {
    const now = performance.now();
    this.received++;
    this.heardAt = now;
    this.opened = true;
    if (message.type === "hello") {
      if (message.protocol !== PROTOCOL) {
        location.reload(); // the console was replaced by another version
      }
      this.hello = message;
      this.poseAt = -Infinity;
      this.past = false;
    } else if (message.type === "past") {
      this.past = message.at !== null;
      this.posesSinceOpened = 0;
    } else if (!this.past && message.type === "pose" && this.posesSinceOpened++ > 0) {
      this.poseAt = now; // the first may be an old one, kept for newcomers: the link report tells its age
    } else if (message.type === "link" && message.pose_age_ms !== null) {
      this.poseAt = now - message.pose_age_ms;
    } else if (!this.past && message.type === "status") {
      this.statusAt = now;
      this.scansCome = /^(streaming|asking scan by scan)/.test(message.driver);
    }
    this.onMessage(message);
  }
}
