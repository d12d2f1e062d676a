"""Print the figures of `ebac live` on this machine: python tests/live_figures.py [--pairs 6] [--window 20]."""

import argparse
import json
import os
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
from playwright.sync_api import sync_playwright

from ebac.live import serve

CHROMIUM = os.environ.get("EBAC_CHROMIUM", "/usr/bin/chromium")
DRAWN = "() => window.ebacServed && ebacServed.drawn > 0"
#: One drag of 6 mm in free air; resolves when the drawn handle has moved 0.1 mm [ms].
DRAG = """to => new Promise(done => {
  const from = ebacServed.drawnX, begun = performance.now();
  ebacServed.dragTo(to);
  const look = () => Math.abs(ebacServed.drawnX - from) > 1e-4 ? done(performance.now() - begun)
    : performance.now() - begun > 2000 ? done(NaN) : requestAnimationFrame(look);
  look();
})"""


def cpu(server: Any) -> float:
    """Return the CPU time of the server's threads so far [s]."""
    ticks = 0
    names = ("ebac-live",)
    for task in Path("/proc/self/task").iterdir():
        text = (task / "stat").read_text()
        if int(task.name) in {
            one.native_id for one in server_threads() if one.name.startswith(names)
        }:
            ticks += sum(map(int, text.rpartition(")")[2].split()[11:13]))
    return ticks / os.sysconf("SC_CLK_TCK")


def server_threads() -> list[Any]:
    import threading

    return threading.enumerate()


def lateness(server: Any, seconds: float) -> tuple[float, int, int]:
    """Return p99.9 [us], ticks skipped and ticks of the next seconds."""
    run = server.session.run
    first = run.ticks
    time.sleep(seconds)
    tail = run.tail(run.ticks - first)
    return 1e6 * float(np.percentile(tail["lateness"], 99.9)), int(tail["skipped"].sum()), len(tail)


def first_frame(browser: Any) -> tuple[float, float]:
    """Return the time from the command to its address, and to the first frame [s]."""
    begun = time.monotonic()
    command = [sys.executable, "-m", "ebac.cli", "live", "--no-browser", "--json"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as live:
        assert live.stdout is not None
        url = json.loads(live.stdout.readline())["url"]
        address = time.monotonic() - begun
        page = browser.new_page(viewport={"width": 1280, "height": 800}, bypass_csp=True)
        page.goto(url)
        page.wait_for_function(DRAWN)
        shown = time.monotonic() - begun
        page.close()
        live.terminate()
    return address, shown


def measured(pairs: int, window: float) -> dict[str, Any]:
    """Return all figures, units in the keys; windows [s] without a browser and with one take turns, in one run."""
    found: dict[str, Any] = {"load_before": os.getloadavg()[0]}
    with sync_playwright() as playwright:
        start = lambda: playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])  # noqa: E731
        browser = start()
        found["address_s"], found["first_frame_s"] = first_frame(browser)
        browser.close()
        with serve(folder="/tmp/ebac-live-figures") as server:
            without, attached, drags, frames, loads = [], [], [], [], []
            for _ in range(pairs):
                time.sleep(1)
                without.append(lateness(server, window))
                browser = start()
                page = browser.new_page(viewport={"width": 1280, "height": 800}, bypass_csp=True)
                page.goto(server.gate.url())
                page.wait_for_function(DRAWN)
                time.sleep(2)
                drawn, spent, begun = (
                    page.evaluate("ebacServed.drawn"),
                    cpu(server),
                    time.monotonic(),
                )
                attached.append(lateness(server, window))
                took = time.monotonic() - begun
                frames.append((page.evaluate("ebacServed.drawn") - drawn) / took)
                loads.append(100 * (cpu(server) - spent) / took)
                page.evaluate("ebacServed.dragTo([-0.02, 0])")
                time.sleep(0.8)
                for k in range(14):
                    drags.append(page.evaluate(DRAG, [-0.02 + 0.006 * (k % 2 == 0), 0]))
                    time.sleep(0.6 + 0.033 * (k * 0.618 % 1))  # the hand has come to rest
                browser.close()
    late = {"without": without, "attached": attached}
    for name, rows in late.items():
        found[f"late_p99_9_{name}_us"] = [round(one[0]) for one in rows]
        found[f"skipped_{name}_ticks"] = [one[1] for one in rows]
        found[f"ticks_{name}"] = [one[2] for one in rows]
    found["pairs_later_attached"] = sum(a[0] > b[0] for a, b in zip(attached, without, strict=True))
    found["load_after"] = os.getloadavg()[0]  # both beside all that is measured
    found["drags_missed"] = int(np.isnan(drags).sum())
    p50, p99 = np.nanpercentile(drags, [50, 99])
    return found | {
        "drag_p50_ms": float(p50),
        "drag_p99_ms": float(p99),
        "drags": len(drags),
        "frames_per_s": [round(one, 1) for one in frames],
        "server_cpu_percent": [round(one, 1) for one in loads],
    }


if __name__ == "__main__":
    words = argparse.ArgumentParser(description=__doc__)
    words.add_argument("--json", action="store_true")
    words.add_argument("--pairs", type=int, default=6)
    words.add_argument("--window", type=float, default=20.0, help="s")
    given = words.parse_args()
    figures = measured(given.pairs, given.window)
    if given.json:
        print(json.dumps(figures))
    else:
        for name, value in figures.items():
            print(f"{name:<26}{value:.3g}" if isinstance(value, float) else f"{name:<26}{value}")
