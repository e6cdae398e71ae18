"""Ports for a demo of our own."""

import os
import socket

FIRST_TRIED, LAST_TRIED = 20000, 60000


def free_ports(count):
    """The first of `count` neighbouring ports that nobody listens on; another process starts to look elsewhere."""
    start = FIRST_TRIED + os.getpid() * 16 % (LAST_TRIED - FIRST_TRIED)
    for first in [*range(start, LAST_TRIED, count), *range(FIRST_TRIED, start, count)]:
        if not any(taken(port) for port in range(first, first + count)):
            return first
    raise RuntimeError("no free ports")


def taken(port):
    with socket.socket() as probe:
        try:
            probe.bind(("127.0.0.1", port))
        except OSError:
            return True
    return False


def is_listening(port):
    with socket.socket() as probe:
        return probe.connect_ex(("127.0.0.1", port)) == 0
