// What is drawn and what is not: the legend's entries are its switches. The operator's choice is remembered.

const KEPT = "layers off";
const OFF_AT_FIRST = '["occupancy"]';

export class Layers {
  constructor(changed) {
    this.changed = changed;
    this.off = new Set(JSON.parse(localStorage.getItem(KEPT) ?? OFF_AT_FIRST));
    this.legend = document.getElementById("legend");
    this.button = document.getElementById("layers");
    for (const entry of this.#entries()) entry.addEventListener("click", () => this.#toggle(entry.dataset.layer));
    this.button.addEventListener("click", () => this.#open(!this.legend.classList.contains("open")));
    addEventListener("keydown", (event) => event.key === "Escape" && this.#open(false));
    this.#show();
  }

  isOn(layer) {
    return !this.off.has(layer);
  }

  // There is nothing of it now.
  tellEmpty(layer, empty) {
    this.legend.querySelector(`[data-layer="${layer}"]`).toggleAttribute("data-empty", empty);
  }

  #entries() {
    return this.legend.querySelectorAll("[data-layer]");
  }

  #toggle(layer) {
    this.isOn(layer) ? this.off.add(layer) : this.off.delete(layer);
    localStorage.setItem(KEPT, JSON.stringify([...this.off]));
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
