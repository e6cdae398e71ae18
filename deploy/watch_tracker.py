"""Watches a fusion server from outside, as a client: what its registration says, how many bodies it tracks, and
whether frames keep coming.  With --seconds it ends by itself and the exit code says whether it delivered."""

import argparse
import json
import sys
import time
import urllib.error
import urllib.request
from collections import deque

SAMPLE_EVERY_S = 0.2
REQUEST_TIMEOUT_S = 5.0
WINDOW_S = 10.0        # period that the final verdict covers; half the run if that is shorter
RATE_TOLERANCE = 0.1   # as a fraction of the nominal rate
LEAST_WITH_BODY = 0.8  # least fraction of samples with a body
BAR_WIDTH = 30


def get(url):
    request = urllib.request.Request(url, headers={"Accept": "application/json"})
    with urllib.request.urlopen(request, timeout=REQUEST_TIMEOUT_S) as answer:
        return json.load(answer)


class Screen:
    """A bar that is redrawn on a terminal; plain lines, only when something changed, elsewhere."""

    def __init__(self, started):
        self.started = started
        self.terminal = sys.stdout.isatty()
        self.last = None

    def say(self, text):
        self.clear()
        print(f"[{time.monotonic() - self.started:5.1f} s] {text}", flush=True)

    def say_once(self, text):
        if text != self.last:
            self.last = text
            self.say(text)

    def bar(self, share, text):
        if self.terminal:
            full = round(BAR_WIDTH * min(1.0, max(0.0, share)))
            print(f"\r\033[K  [{'#' * full}{'.' * (BAR_WIDTH - full)}] {text}", end="", flush=True)

    def clear(self):
        if self.terminal:
            print("\r\033[K", end="", flush=True)


def describe(registration):
    radii = [place["presentRadius"] for place in registration.get("sensors", {}).values() if "presentRadius" in place]
    worst = f", every place known to within {1000 * max(radii):.0f} mm (95 %)" if radii else ""
    text = f"registration: {registration['verdict'].lower()}, {len(registration.get('sensors', {}))} sensors{worst}"
    if registration["verdict"] != "Good" and registration.get("reasons"):
        text += f" ({registration['reasons'][0]})"
    return text


def stable_part(text):
    """Numbers change all the time; words are news."""
    return "".join(c for c in text if not c.isdigit())


def watch(base, seconds, rate, until_good=False):
    started = time.monotonic()
    screen = Screen(started)
    samples = deque()
    window = WINDOW_S if seconds is None else min(WINDOW_S, seconds / 2)
    first_body = None
    last_news = None
    while seconds is None or time.monotonic() - started < seconds:
        try:
            frame = get(base + "/frame")
            registration = get(base + "/registration")
        except (urllib.error.URLError, OSError, ValueError) as error:
            screen.say_once(f"no answer yet: {error}")
            time.sleep(SAMPLE_EVERY_S)
            continue
        now = time.monotonic()
        samples.append((now, frame["sequence"], len(frame["bodies"])))
        while samples and samples[0][0] < now - window:
            samples.popleft()
        if frame["bodies"] and first_body is None:
            first_body = now - started
            screen.say("first fused body")
        news = describe(registration)
        if stable_part(news) != last_news:
            last_news = stable_part(news)
            screen.say(news)
        show_progress(screen, registration, samples)
        whole = samples[-1][0] - samples[0][0] > 0.8 * window
        if until_good and whole and registration["verdict"] == "Good" and delivers(samples, rate):
            break
        time.sleep(SAMPLE_EVERY_S)
    screen.clear()
    return judge(samples, rate, first_body)


def show_progress(screen, registration, samples):
    session = registration.get("session", {})
    (t0, s0, _), (t1, s1, bodies) = samples[0], samples[-1]
    rate = (s1 - s0) / (t1 - t0) if t1 > t0 else 0.0
    live = f"{bodies} bodies, {rate:4.1f} frames/s"
    if session.get("state") == "collecting" and session.get("targetSeconds"):
        share = session["elapsedSeconds"] / session["targetSeconds"]
        screen.bar(share, f"walking {session['elapsedSeconds']:.0f} of {session['targetSeconds']:.0f} s; {live}")
    else:
        screen.bar(1.0, live)


def measured(samples):
    """Fused frames per second, and the share of the samples with a body."""
    (t0, s0, _), (t1, s1, _) = samples[0], samples[-1]
    return (s1 - s0) / (t1 - t0), sum(1 for _, _, bodies in samples if bodies > 0) / len(samples)


def delivers(samples, rate):
    if len(samples) < 3:
        return False
    frames_per_second, with_body = measured(samples)
    return abs(frames_per_second - rate) <= RATE_TOLERANCE * rate and with_body >= LEAST_WITH_BODY


def judge(samples, rate, first_body):
    """The exit code: 0 only when fused frames with a body came at the nominal rate."""
    if len(samples) < 3:
        print("FAILED: the tracker did not answer")
        return 1
    good = delivers(samples, rate)
    frames_per_second, with_body = measured(samples)
    since = f", first after {first_body:.1f} s" if first_body is not None else ""
    print(f"{'delivered' if good else 'FAILED'}: {frames_per_second:.1f} fused frames/s over the last "
          f"{samples[-1][0] - samples[0][0]:.0f} s "
          f"(expected {rate:g}), a body in {100 * with_body:.0f} % of them{since}")
    return 0 if good else 1


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--base", default="http://127.0.0.1:8080", help="the fusion server")
    parser.add_argument("--seconds", type=float, help="stop and judge after so long")
    parser.add_argument("--until-good", action="store_true", help="stop as soon as the places are good and it delivers")
    parser.add_argument("--rate", type=float, default=30.0, help="fused frames per second to expect")
    arguments = parser.parse_args()
    try:
        return watch(arguments.base.rstrip("/"), arguments.seconds, arguments.rate, arguments.until_good)
    except KeyboardInterrupt:
        return 130


if __name__ == "__main__":
    sys.exit(main())
