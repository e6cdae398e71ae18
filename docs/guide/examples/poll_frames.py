#!/usr/bin/env python3
"""Every fused frame once, a millisecond after it is there: Python's standard library and nothing else.

usage: poll_frames.py [http://127.0.0.1:8080] [frames]

Prints, per frame and person, the UTC time of capture, the person's id and the height of the head.  Works on a chorus-sensor too.
"""
import json
import sys
import time
import urllib.error
import urllib.request


def frames(base):
    """Yields frames for ever.  A conditional request that asks the server to wait (RFC 7240) is answered with the next frame."""
    etag = None
    while True:
        request = urllib.request.Request(base + "/frame", headers={"Accept": "application/json"})
        if etag:
            request.add_header("If-None-Match", etag)
            request.add_header("Prefer", "wait=10")
        try:
            with urllib.request.urlopen(request, timeout=20) as answer:
                etag = answer.headers["ETag"]
                yield json.load(answer)
        except urllib.error.HTTPError as refusal:
            if refusal.code == 304:  # nothing new for ten seconds
                continue
            if refusal.code != 503:  # not ready yet
                raise
            time.sleep(float(refusal.headers.get("Retry-After", 1)))
        except (ConnectionError, TimeoutError, urllib.error.URLError) as trouble:
            print(f"{base}: {trouble}; trying again", file=sys.stderr)
            time.sleep(1)


def main(base="http://127.0.0.1:8080", count="0"):
    for number, frame in enumerate(frames(base), start=1):
        for body in frame["bodies"]:
            head = body["joints"].get("Head")
            if head and "y" in head:  # a joint that nobody sees has a state, and no place
                print(f"{frame['captured']}  person {body['bodyId']}: head at {head['y']:.2f} m", flush=True)
        if number == int(count):
            return


if __name__ == "__main__":
    main(*sys.argv[1:])
