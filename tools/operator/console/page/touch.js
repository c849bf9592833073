// What a browser makes of fingers. A quick move that ends in motion is a fling to it, and the next tap, wherever it is, the end of that
// fling, of which it makes no click.

// An element whose moves are the page's own: they end in no fling.
export function leavesNoFling(element) {
  element.addEventListener("touchmove", (event) => event.preventDefault(), { passive: false });
}

// A button that stops a robot acts as it is touched, not as it is let go: a list or a slider may have been flung just before. It acts by a
// click, too, that is not the end of such a touch: of keys, of what reads the screen, or of a browser that tells of nothing else.
export function whenPressed(button, action) {
  let touch = null; // that it acted on
  button.addEventListener("pointerdown", (event) => {
    if (event.button !== 0 || button.disabled) return;
    touch = event.pointerId;
    action();
  });
  button.addEventListener("click", (event) => event.pointerId === touch || action());
}
