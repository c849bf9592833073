"""Pictures of the console for its README: the real programs, a robot that a press on the map has sent through the arena, and the flight that
it recorded. `make screenshots` writes them anew; whoever does looks at each."""
import subprocess

import pytest

import browser
from at_hand import BINARIES, ROOT, WORLDS
from console_page import let_the_camera_glide
from test_console_explores import BEHIND_TWO_CORNERS, LONGEST_S, WALLS, WORD, press_goal
from waiting import wait_until

FOLDER = ROOT / "tools/operator/console"
SPEED = 1  # at which the robot gets there on a busy machine, too
SCANS_SEEN = 80  # at least, so that plots and cells have something to show
TIME = "document.body.dataset.time"


@pytest.fixture
def page(chain):
    secret, listed = chain.folder / "operator.key", chain.folder / "robot.keys"
    subprocess.run([BINARIES / "ale-keys", "operator", "--secret", secret, "--robot", listed], check=True, timeout=180)
    flights, recordings, maps = (chain.folder / name for name in ("flights", "recordings", "maps"))
    flights.mkdir()
    maps.mkdir()
    chain.sim = chain.simulator("--world", WORLDS / "arena.world", "--drive", "--truth", chain.truth_path, speed=SPEED)
    chain.firmware(f"[lcm]\npublish_scan = yes\n[recorder]\nfolder = {flights}\n[map]\nfolder = {maps}\n", "--keys", listed, speed=SPEED)
    console = chain.start("ale-console", "--lcm-url", chain.url, "--http", "127.0.0.1:0", "--keys", secret, "--recordings", recordings,
                          "--flights", flights, "--maps", maps)
    wait_until(console.out, 180, "the console's address")
    watching = browser.Browser()
    try:
        watching.open(console.out().strip())
        yield watching
    finally:
        watching.close()


def command(chain, *words):
    subprocess.run([BINARIES / "ale-send", "--keys", chain.folder / "operator.key", "--lcm-url", chain.url, *words], check=True, timeout=180)


def test_pictures_of_the_console(page, chain):
    page.wait_for(f"document.body.dataset.control === 'yes' && {WALLS} > 3")
    page.run("document.querySelector('[data-layer=occupancy]').click(); document.getElementById('record').click()")
    press_goal(page, BEHIND_TWO_CORNERS)
    page.wait_for(f"{WORD}.startsWith('is at')", LONGEST_S / SPEED)
    command(chain, "save_map", "arena")
    command(chain, "record")
    page.run("document.getElementById('record').click()")
    page.wait_for("[...document.querySelectorAll('#shelf button')].some((e) => e.id.endsWith('.scip'))", 60)
    press_goal(page, (0.0, 0.0))
    page.wait_for(f"{WORD}.startsWith('drives to') && Number(document.getElementById('scan').textContent) > {SCANS_SEEN}")
    let_the_camera_glide(page)
    page.screenshot(FOLDER / "screenshot.png")
    for size, name in (((844, 390), "phone.png"), ((390, 844), "phone_upright.png")):
        page.be_a_phone(*size)
        let_the_camera_glide(page)
        page.screenshot(FOLDER / name)
        page.be_a_window()
    page.run("[...document.querySelectorAll('#shelf button')].find((e) => e.id.endsWith('.scip')).click()")
    page.wait_for(f"{TIME} === 'recording'")
    page.click("play")
    page.wait_for("document.getElementById('play').ariaPressed === 'false'", 180)
    page.run("document.getElementById('recordings').scrollIntoView()")
    let_the_camera_glide(page)
    page.screenshot(FOLDER / "flight.png")
    assert page.errors() == []
