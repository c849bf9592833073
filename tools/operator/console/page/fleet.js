// The robots of this console: the one that the page shows, how each of them is, and STOP for all. Another one is chosen by
// a list in the strip; with one robot there is no list.

import { whenPressed } from "./touch.js";
import { robotInWords } from "./words.js";

const TROUBLE = ["weak", "lost", "silent"];
const DUMB = ["gone", "connecting"]; // links on which nothing can be said

export class Fleet {
  // left: called when the page shows another robot than before; what is known of that one is to be forgotten.
  constructor(link, left) {
    this.link = link;
    this.left = left;
    this.robot = null; // the name of the one that is shown
    this.choice = Object.assign(document.createElement("select"), { id: "robot" });
    this.stopAll = document.getElementById("stop-all");
    this.choice.addEventListener("change", () => link.choose(this.choice.value));
    whenPressed(this.stopAll, () => link.send({ type: "stop_all" }));
  }

  take(message) {
    switch (message.type) {
      case "hello":
        this.hasKey = message.operator !== null;
        if (message.robot !== this.robot) this.left();
        this.robot = message.robot;
        this.#show(message.robots);
        break;
      case "robots": this.#show(message.robots); break;
    }
  }

  showLink(state) {
    this.stopAll.disabled = !this.hasKey || DUMB.includes(state);
    this.choice.disabled = state === "gone";
  }

  // Of those that are not shown: seen while the list is closed, too.
  #warn(troubles) {
    this.choice.toggleAttribute("data-trouble", troubles.length > 0);
    this.choice.setAttribute("aria-label", ["robot that is shown", ...troubles].join("; "));
    this.choice.title = ["the robot that is shown", ...troubles].join("; ");
  }

  // What is written is changed in its place: the list may be open.
  #show(robots) {
    this.stopAll.hidden = robots.length === 1;
    if (this.stopAll.hidden) this.choice.remove();
    else if (!this.choice.isConnected) document.getElementById("state").before(this.choice);
    if ([...this.choice.options].map((option) => option.value).join() !== robots.map((robot) => robot.name).join()) {
      this.choice.replaceChildren(...robots.map((robot) => new Option("", robot.name)));
    }
    robots.forEach((robot, k) => {
      const words = robotInWords(robot);
      if (this.choice.options[k].text !== words) this.choice.options[k].text = words;
    });
    this.choice.value = this.robot;
    this.#warn(robots.filter(({ name, state }) => name !== this.robot && TROUBLE.includes(state)).map(robotInWords));
  }
}
