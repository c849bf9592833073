"""Headless Chromium over the W3C WebDriver protocol, with nothing but the standard library."""
import base64
import json
import shutil
import subprocess
import tempfile
import urllib.error
import urllib.request

from waiting import wait_until

FLAGS = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-dev-shm-usage",
         "--disable-background-networking", "--disable-component-update", "--disable-sync", "--hide-scrollbars"]
# Looks for a second whether a condition comes true.
COMES_TRUE = """
const isTrue = () => CONDITION;
const end = performance.now() + 1000;
return new Promise((there, failed) => {
  const look = () => {
    try {
      if (isTrue()) there(true);
      else if (performance.now() > end) there(false);
      else setTimeout(look, 20);
    } catch (error) { failed(error); }
  };
  look();
});
"""


def missing():
    """What stands in the way of a browser test, or an empty text."""
    absent = [name for name in ("chromium", "chromedriver") if shutil.which(name) is None]
    return f"no {' and no '.join(absent)}" if absent else ""


class Browser:
    def __init__(self, *flags, width=1280, height=800, light=False):
        self.profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        self.driver = subprocess.Popen(["chromedriver", "--port=0"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                                       text=True)
        try:
            self.base = f"http://127.0.0.1:{self._driver_port()}"
            arguments = [*FLAGS, *flags, f"--user-data-dir={self.profile.name}", f"--window-size={width},{height}"]
            if not light:
                arguments.append("--blink-settings=preferredColorScheme=0")
            options = {"browserName": "chrome", "goog:chromeOptions": {"args": arguments},
                       "goog:loggingPrefs": {"browser": "ALL"}}
            session = self._call("POST", "/session", {"capabilities": {"alwaysMatch": options}})
            self.session = f"/session/{session['sessionId']}"
        except BaseException:
            self.close()
            raise

    def _driver_port(self):
        for line in self.driver.stdout:
            if "successfully on port" in line:
                return int(line.rstrip(". \n").split()[-1])
        raise RuntimeError("chromedriver did not start")

    def _call(self, method, path, body=None):
        data = None if method != "POST" else json.dumps(body or {}).encode()
        request = urllib.request.Request(self.base + path, data, {"Content-Type": "application/json"}, method=method)
        try:
            with urllib.request.urlopen(request, timeout=180) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            raise RuntimeError(json.load(error)["value"]["message"]) from None

    def open(self, url):
        self._call("POST", f"{self.session}/url", {"url": url})

    def reload(self):
        """Comes back when the page is there again."""
        self._call("POST", f"{self.session}/refresh")

    def run(self, script, *arguments):
        return self._call("POST", f"{self.session}/execute/sync", {"script": script, "args": list(arguments)})

    def text(self, element_id):
        return self.run("return document.getElementById(arguments[0]).textContent", element_id)

    def errors(self):
        """What the page and the browser complained about since the last call."""
        entries = self._call("POST", f"{self.session}/se/log", {"type": "browser"})
        return [entry["message"] for entry in entries if entry["level"] == "SEVERE"]

    def wait_for(self, condition, seconds=180, *arguments):
        """Until an expression of the page gives something true; the time is only there to fail when it never does. Looked at within the page,
        which takes less of a processor than a question for each look."""
        look = COMES_TRUE.replace("CONDITION", condition)
        wait_until(lambda: self.run(look, *arguments), seconds, f"{condition} of {arguments}" if arguments else condition)

    def drag(self, x1, y1, x2, y2, held_ms=200):
        self._pointer([self._to(x1, y1), {"type": "pointerDown", "button": 0}, self._to(x2, y2),
                       {"type": "pause", "duration": held_ms}, {"type": "pointerUp", "button": 0}])

    def click(self, element_id):
        x, y = self._middle(element_id)
        self._pointer([self._to(x, y), {"type": "pointerDown", "button": 0}, {"type": "pointerUp", "button": 0}])

    def hold(self, key, seconds):
        """Presses a key for so long."""
        self._call("POST", f"{self.session}/actions", {"actions": [
            {"type": "key", "id": "keyboard", "actions": [{"type": "keyDown", "value": key},
                                                          {"type": "pause", "duration": round(seconds * 1000)},
                                                          {"type": "keyUp", "value": key}]}]})

    def _middle(self, element_id):
        return self.run("const e = document.getElementById(arguments[0]); e.scrollIntoViewIfNeeded();"
                        "const r = e.getBoundingClientRect();"
                        "return [Math.round(r.x + r.width / 2), Math.round(r.y + r.height / 2)]", element_id)

    @staticmethod
    def _to(x, y):
        return {"type": "pointerMove", "duration": 20, "x": x, "y": y}

    def _pointer(self, actions, kind="mouse"):
        self._call("POST", f"{self.session}/actions", {"actions": [
            {"type": "pointer", "id": kind, "parameters": {"pointerType": kind}, "actions": actions}]})

    def devtools(self, command, **parameters):
        """A command of the DevTools protocol, for what WebDriver has no word for."""
        return self._call("POST", f"{self.session}/goog/cdp/execute", {"cmd": command, "params": parameters})

    def be_a_phone(self, width, height):
        """A touch screen of that many CSS pixels, until be_a_window."""
        self.devtools("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=2, mobile=True)
        self.devtools("Emulation.setTouchEmulationEnabled", enabled=True)

    def be_a_window(self):
        self.devtools("Emulation.clearDeviceMetricsOverride")
        self.devtools("Emulation.setTouchEmulationEnabled", enabled=False)

    def tap(self, element_id):
        x, y = self._middle(element_id)
        self._pointer([self._to(x, y), {"type": "pointerDown", "button": 0}, {"type": "pointerUp", "button": 0}], "touch")

    def fingers(self, *paths, held_ms=0):
        """So many fingers at once, each along its path of [x, y]; they rest for so long before they are lifted."""
        def actions(path):
            moves = [{"type": "pointerMove", "duration": 40, "x": round(x), "y": round(y)} for x, y in path]
            return [moves[0], {"type": "pointerDown", "button": 0}, *moves[1:], {"type": "pause", "duration": held_ms}, {"type": "pointerUp", "button": 0}]
        self._call("POST", f"{self.session}/actions", {"actions": [
            {"type": "pointer", "id": f"finger {k}", "parameters": {"pointerType": "touch"}, "actions": actions(path)} for k, path in enumerate(paths)]})

    def turn_wheel(self, x, y, by):
        self._call("POST", f"{self.session}/actions", {"actions": [
            {"type": "wheel", "id": "wheel", "actions": [{"type": "scroll", "x": x, "y": y, "deltaX": 0, "deltaY": by}]}]})

    def press(self, *keys):
        """One key after the other; names of keys as the browser has them."""
        codes = {"Enter": "\ue007", "Escape": "\ue00c", "Tab": "\ue004", "Backspace": "\ue003", "Home": "\ue011", "End": "\ue010", "ArrowLeft": "\ue012", "ArrowUp": "\ue013",
                 "ArrowRight": "\ue014", "ArrowDown": "\ue015"}
        actions = [{"type": way, "value": codes.get(key, key)} for key in keys for way in ("keyDown", "keyUp")]
        self._call("POST", f"{self.session}/actions", {"actions": [{"type": "key", "id": "keyboard", "actions": actions}]})

    def elements(self, selector):
        """References to all elements that a CSS selector finds."""
        found = self._call("POST", f"{self.session}/elements", {"using": "css selector", "value": selector})
        return [next(iter(reference.values())) for reference in found]

    def select(self, option):
        """As a hand does in the list that a <select> opens, which is none of the page's."""
        self._call("POST", f"{self.session}/element/{option}/click")

    def spoken_name(self, element):
        """The name by which a screen reader knows an element, as the browser computes it."""
        return self._call("GET", f"{self.session}/element/{element}/computedlabel")

    def resize(self, width, height):
        self._call("POST", f"{self.session}/window/rect", {"width": width, "height": height})

    def screenshot(self, path):
        with open(path, "wb") as picture:
            picture.write(base64.b64decode(self._call("GET", f"{self.session}/screenshot")))

    def close(self):
        try:
            if hasattr(self, "session"):
                self._call("DELETE", self.session)
        finally:
            self.driver.terminate()
            self.driver.wait(10)
            self.driver.stdout.close()
            self.profile.cleanup()
