// What is drawn and what is not: the legend's entries are its switches. The operator's choice is remembered.

const KEPT = "layers";
const OFF_AT_FIRST = ["occupancy", "graph"];

export class Layers {
  constructor(changed) {
    this.changed = changed;
    this.chosen = JSON.parse(localStorage.getItem(KEPT) ?? "{}"); // layer -> on; of those that were ever switched
    this.legend = document.getElementById("legend");
    this.button = document.getElementById("layers");
    for (const entry of this.#entries()) entry.addEventListener("click", () => this.#toggle(entry.dataset.layer));
    this.button.addEventListener("click", () => this.#open(!this.legend.classList.contains("open")));
    addEventListener("keydown", (event) => event.key === "Escape" && this.#open(false));
    this.#show();
  }

  isOn(layer) {
    return this.chosen[layer] ?? !OFF_AT_FIRST.includes(layer);
  }

  // There is nothing of it now.
  tellEmpty(layer, empty) {
    this.legend.querySelector(`[data-layer="${layer}"]`).toggleAttribute("data-empty", empty);
  }

  #entries() {
    return this.legend.querySelectorAll("[data-layer]");
  }

  #toggle(layer) {
    this.chosen[layer] = !this.isOn(layer);
    localStorage.setItem(KEPT, JSON.stringify(this.chosen));
    this.#show();
    this.changed();
  }

  #open(open) {
    this.legend.classList.toggle("open", open);
    this.button.setAttribute("aria-expanded", String(open));
  }

  #show() {
    for (const entry of this.#entries()) entry.setAttribute("aria-pressed", String(this.isOn(entry.dataset.layer)));
  }
}
