"""A switch between network namespaces that delays, loses and reorders Ethernet frames, in user space, because not every kernel has netem.
As root: bad_switch.py DELAY_MS JITTER_MS LOSS_PERCENT PID...  gives the network namespace of each process a device eth0.

Each frame waits for the delay and a random part of the jitter of its own, so frames overtake each other.  Says "ready" once all devices are
there, and when it is ended, what it did, as JSON.
"""

import ctypes
import fcntl
import heapq
import json
import os
import random
import select
import signal
import struct
import sys
import time

TUNSETIFF, IFF_TAP, IFF_NO_PI = 0x400454CA, 0x0002, 0x1000
CLONE_NEWNET = 0x40000000
MOST_BYTES = 65536


def enter_network_of(pid):
    with open(f"/proc/{pid}/ns/net", "rb") as namespace:
        if ctypes.CDLL(None, use_errno=True).setns(namespace.fileno(), CLONE_NEWNET) != 0:
            raise OSError(ctypes.get_errno(), f"cannot enter the network of {pid}")


def device_in(pid):
    """Opens a device eth0 in that namespace; it stays there, wherever we go."""
    enter_network_of(pid)
    port = os.open("/dev/net/tun", os.O_RDWR | os.O_NONBLOCK)
    fcntl.ioctl(port, TUNSETIFF, struct.pack("16sH22x", b"eth0", IFF_TAP | IFF_NO_PI))
    return port


class Switch:
    def __init__(self, ports, delay, jitter, loss):
        self.ports, self.delay, self.jitter, self.loss = ports, delay, jitter, loss
        self.known = {}  # address of a host: its port
        self.waiting = []  # heap of due time, number, port, frame
        self.newest = dict.fromkeys(ports, -1)  # number of the newest frame that was handed over
        self.done = {"carried": 0, "lost": 0, "overtaken": 0}
        self.dice = random.Random(1)

    def take(self, port):
        """Reads one frame and decides what becomes of it."""
        try:
            frame = os.read(port, MOST_BYTES)
        except OSError:
            return  # the device is down
        to, sender = frame[:6], frame[6:12]
        self.known[sender] = port
        for out in [self.known[to]] if to in self.known else [each for each in self.ports if each != port]:
            if self.dice.random() < self.loss:
                self.done["lost"] += 1
                continue
            due = time.monotonic() + self.delay + self.dice.random() * self.jitter
            heapq.heappush(self.waiting, (due, self.done["carried"], out, frame))
            self.done["carried"] += 1

    def hand_over(self):
        """Writes the frames that are due; returns how long the next one has to wait [s]."""
        while self.waiting and self.waiting[0][0] <= time.monotonic():
            _, number, out, frame = heapq.heappop(self.waiting)
            self.done["overtaken"] += number < self.newest[out]
            self.newest[out] = max(number, self.newest[out])
            try:
                os.write(out, frame)
            except OSError:
                pass  # the device is down: a cable that is out
        return max(0.0, self.waiting[0][0] - time.monotonic()) if self.waiting else None

    def run(self):
        poll = select.poll()
        for port in self.ports:
            poll.register(port, select.POLLIN)
        while True:
            rest = self.hand_over()
            for port, _ in poll.poll(None if rest is None else 1000 * rest):
                self.take(port)


def main():
    delay, jitter, loss = (float(word) for word in sys.argv[1:4])
    switch = Switch([device_in(pid) for pid in sys.argv[4:]], delay / 1e3, jitter / 1e3, loss / 100)

    def end(*_):
        print(json.dumps(switch.done), flush=True)
        os._exit(0)

    signal.signal(signal.SIGTERM, end)
    print("ready", flush=True)
    switch.run()


if __name__ == "__main__":
    main()
