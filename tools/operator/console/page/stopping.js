// A button that stops a robot acts as it is touched, not as it is let go. A browser makes no click of a tap that ends a fling: of a list or
// a slider, say, that was let go in motion.
export function whenPressed(button, action) {
  button.addEventListener("pointerdown", (event) => event.button === 0 && !button.disabled && action());
  button.addEventListener("click", (event) => event.detail === 0 && action()); // by keys, or what reads the screen
}
