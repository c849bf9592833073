"""What tests of the console's page share: headless Chromium with the page of a console that watches or commands, and what is drawn on it."""
import re

import pytest

import browser

COUNT_PIXELS = """
const [name, tolerance] = arguments;
const canvas = document.getElementById("map");
const copy = document.createElement("canvas");
[copy.width, copy.height] = [canvas.width, canvas.height];
const probe = copy.getContext("2d", {willReadFrequently: true});
probe.fillStyle = getComputedStyle(document.documentElement).getPropertyValue("--" + name);
probe.fillRect(0, 0, 1, 1);
const wanted = probe.getImageData(0, 0, 1, 1).data;
probe.drawImage(canvas, 0, 0);
const pixels = probe.getImageData(0, 0, canvas.width, canvas.height).data;
let count = 0, x = 0, y = 0;
for (let k = 0; k < pixels.length; k += 4) {
  if ([0, 1, 2].every((c) => Math.abs(pixels[k + c] - wanted[c]) <= tolerance)) {
    count++; x += (k / 4) % canvas.width; y += Math.floor(k / 4 / canvas.width);
  }
}
return {count, x: x / count / canvas.width, y: y / count / canvas.height};
"""
# Of the layer of cells: how many pixels are free and occupied, mixed with the ground as the layer mixes them.
COUNT_CELLS = """
const canvas = document.getElementById("map");
const style = getComputedStyle(document.documentElement);
const rgb = (name) => { const text = style.getPropertyValue("--" + name).trim(); return [1, 3, 5].map((k) => parseInt(text.slice(k, k + 2), 16)); };
const mixed = (name, alpha) => rgb(name).map((value, k) => (value * alpha + rgb("ground")[k] * (255 - alpha)) / 255);
const pixels = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
return [["sight", 70], ["wall", 200]].map(([name, alpha]) => {
  const wanted = mixed(name, alpha);
  let count = 0;
  for (let k = 0; k < pixels.length; k += 4) count += [0, 1, 2].every((c) => Math.abs(pixels[k + c] - wanted[c]) <= 3);
  return count;
});
"""
STATE = "document.body.dataset.state"
LINK = "document.body.dataset.link"
ALARM = "!document.getElementById('alarm').hidden && document.getElementById('alarm-word').textContent"


@pytest.fixture(scope="module")
def chromium():
    running = browser.Browser()
    yield running
    running.close()


@pytest.fixture
def page(chromium, console):
    chromium.open(console.url)
    chromium.run("localStorage.clear()")
    chromium.errors()
    yield chromium
    assert chromium.errors() == []  # of scripts, or resources refused


def pixels(page, colour, tolerance=12):
    return page.run(COUNT_PIXELS, colour, tolerance)


def cells(page):
    """Pixels of free and of occupied cells."""
    let_the_camera_glide(page)
    return page.run(COUNT_CELLS)


def show_only(page, layer):
    page.run("for (const each of document.querySelectorAll('[data-layer]')) if ((each.ariaPressed === 'true') !== (each.dataset.layer === arguments[0])) each.click()",
             layer)


def let_the_camera_glide(page):
    """For a second of frames: of what is longer than a tenth between two of them it takes no notice."""
    page.run("""
        return new Promise((there) => {
          let before = performance.now(), glided = 0;
          const frame = (now) => {
            glided += Math.min(100, now - before);
            before = now;
            glided < 1000 ? requestAnimationFrame(frame) : there();
          };
          requestAnimationFrame(frame);
        });""")


def number(text):
    return float(re.search(r"-?[\d.]+", text)[0])


@pytest.fixture
def cockpit(chromium, alice, pulse):
    """The page of a console that may command a robot."""
    chromium.open(alice.url)
    chromium.wait_for("document.body.dataset.control === 'yes'")
    chromium.errors()  # of the page before, whose console has ended
    yield chromium
    assert chromium.errors() == []


def middle(page, element_id):
    return page.run("const r = document.getElementById(arguments[0]).getBoundingClientRect();"
                    "return [r.x + r.width / 2, r.y + r.height / 2].map(Math.round)", element_id)
