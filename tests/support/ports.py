"""Ports for our test processes, below those that the kernel uses for outgoing connections."""

import os
import socket

FIRST, LAST = 16000, 32000
next_tried = FIRST + os.getpid() * 64 % (LAST - FIRST)  # different processes start at different ports


def free_ports(count):
    """The first of `count` neighbouring ports where nobody listens; others at every call, until all have been tried."""
    global next_tried
    for _ in range((LAST - FIRST) // count):
        first = next_tried if next_tried + count <= LAST else FIRST
        next_tried = first + count
        if not any(taken(port) for port in range(first, first + count)):
            return first
    raise RuntimeError("no free ports")


def free_port():
    return free_ports(1)


def taken(port):
    for kind in (socket.SOCK_STREAM, socket.SOCK_DGRAM):
        with socket.socket(type=kind) as probe:
            try:
                probe.bind(("127.0.0.1", port))
            except OSError:
                return True
    return False


def is_listening(port):
    with socket.socket() as probe:
        return probe.connect_ex(("127.0.0.1", port)) == 0
