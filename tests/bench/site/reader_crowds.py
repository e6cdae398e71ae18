"""What one delivery to one of many readers costs a server: our event stream, nats-server, mosquitto, and nginx with nchan where they are installed.

All deliver as many bytes: those of a frame of ours.
"""
import json
import math
import pathlib
import selectors
import shutil
import socket
import struct
import subprocess
import tempfile
import time

from real_hall import SERVER, RealHall, cpu_seconds, get, wait_for
from ports import free_port

PATH = "/usr/sbin:/usr/bin:/sbin:/bin"
MOSQUITTO = shutil.which("mosquitto", path=PATH)
NGINX = shutil.which("nginx", path=PATH)
NCHAN = pathlib.Path("/usr/lib/nginx/modules/ngx_nchan_module.so")  # libnginx-mod-nchan
HZ = 30
MARK = b"@one@"


def connected(port):
    made = socket.create_connection(("127.0.0.1", port), 10)
    made.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    return made


class Crowd:
    """Reads what comes on all its sockets and counts a mark in it."""

    def __init__(self, mark):
        self.mark, self.chooser, self.counts, self.bytes = mark, selectors.DefaultSelector(), {}, 0

    def add(self, made):
        made.setblocking(False)
        self.counts[made] = 0
        self.chooser.register(made, selectors.EVENT_READ)

    def read(self, seconds):
        for key, _ in self.chooser.select(seconds):
            piece = key.fileobj.recv(1 << 18)
            self.counts[key.fileobj] += piece.count(self.mark)
            self.bytes += len(piece)

    def close(self):
        for made in self.counts:
            made.close()
        self.chooser.close()

    def run(self, seconds, publish=None):
        """(deliveries, fewest of one reader) in this time; publish() is called at 30 Hz."""
        self.counts, self.bytes = dict.fromkeys(self.counts, 0), 0
        begin = due = time.monotonic()
        while (now := time.monotonic()) < begin + seconds:
            if publish and now >= due:
                publish()
                due = max(due + 1 / HZ, now - 1)
            self.read(min(0.01, max(0.0, due - now)) if publish else 0.05)
        return sum(self.counts.values()), min(self.counts.values())


def cost(pid, crowd, seconds, publish=None, idle=0.0):
    """(microseconds of the server a delivery, deliveries a second of the reader that got fewest)."""
    crowd.run(2, publish)
    begin = cpu_seconds(pid)
    deliveries, fewest = crowd.run(seconds, publish)
    return 1e6 * (cpu_seconds(pid) - begin - idle * seconds) / max(1, deliveries), fewest / seconds


def our_streams(bin_folder, count, seconds):
    with RealHall(bin_folder, 1, 3) as hall:
        hall.start_cell(0, hall.start_sensors(0), in_site=False)
        wait_for("somebody is seen", lambda: get(hall.urls["a"] + "frame")["bodies"])
        pid, port = hall.fusion_pid("a"), int(hall.urls["a"].rsplit(":", 1)[1].rstrip("/"))
        begin = cpu_seconds(pid)
        time.sleep(seconds)
        idle = (cpu_seconds(pid) - begin) / seconds  # it also fuses
        crowd = Crowd(b"\ndata:")
        for _ in range(count):
            made = connected(port)
            made.sendall(b"GET /frame HTTP/1.1\r\nHost: 127.0.0.1\r\nAccept: text/event-stream\r\n\r\n")
            crowd.add(made)
        try:
            found = cost(pid, crowd, seconds, idle=idle)
            return found, crowd.bytes // max(1, sum(crowd.counts.values()))
        finally:
            crowd.close()


class Broker:
    def __init__(self, *command):
        self.child = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.child.kill()
        self.child.wait()


def nats(count, seconds, size):
    port, payload = free_port(), MARK + b"x" * (size - len(MARK))
    with Broker(SERVER, "-a", "127.0.0.1", "-p", str(port)) as broker:
        wait_for("nats-server answers", lambda: connected(port).close() or True)
        crowd, hello = Crowd(MARK), b'CONNECT {"verbose":false}\r\n'
        for _ in range(count):
            made = connected(port)
            made.sendall(hello + b"SUB people 1\r\n")
            crowd.add(made)
        publisher = connected(port)
        publisher.sendall(hello)
        try:
            return cost(broker.child.pid, crowd, seconds, lambda: publisher.sendall(b"PUB people %d\r\n%s\r\n" % (len(payload), payload)))
        finally:
            crowd.close()
            publisher.close()


def mqtt_text(text):
    return struct.pack("!H", len(text)) + text


def mqtt_packet(kind, body):
    length, size = len(body), b""
    while True:
        length, digit = divmod(length, 128)
        size += bytes([digit | (0x80 if length else 0)])
        if not length:
            return bytes([kind]) + size + body


def mqtt_hello(name):
    return mqtt_packet(0x10, mqtt_text(b"MQTT") + b"\x04\x02" + struct.pack("!H", 0) + mqtt_text(name))


def mosquitto(count, seconds, size):
    port = free_port()
    with tempfile.TemporaryDirectory() as folder:
        config = pathlib.Path(folder) / "mosquitto.conf"
        config.write_text(f"listener {port} 127.0.0.1\nallow_anonymous true\nset_tcp_nodelay true\n")
        with Broker(MOSQUITTO, "-c", str(config)) as broker:
            wait_for("mosquitto answers", lambda: connected(port).close() or True)
            crowd = Crowd(MARK)
            for i in range(count):
                made = connected(port)
                made.sendall(mqtt_hello(b"r%d" % i) + mqtt_packet(0x82, b"\x00\x01" + mqtt_text(b"people") + b"\x00"))
                crowd.add(made)
            publisher = connected(port)
            publisher.sendall(mqtt_hello(b"p"))
            message = mqtt_packet(0x30, mqtt_text(b"people") + MARK + b"x" * (size - len(MARK)))
            try:
                return cost(broker.child.pid, crowd, seconds, lambda: publisher.sendall(message))
            finally:
                crowd.close()
                publisher.close()


NGINX_CONF = """load_module {module};
pid {folder}/nginx.pid;
daemon off;
master_process off;
error_log {folder}/error.log;
events {{ worker_connections 2000; }}
http {{
  access_log off;
  client_body_temp_path {folder}/body;
  client_max_body_size 1m;
  client_body_buffer_size 64k;
  server {{
    listen 127.0.0.1:{port};
    keepalive_requests 1000000;
    location /pub {{ nchan_publisher; nchan_channel_id people; nchan_message_buffer_length 2; }}
    location /sub {{ nchan_subscriber eventsource; nchan_channel_id people; nchan_subscriber_first_message newest; }}
  }}
}}
"""


def nchan(count, seconds, size):
    port, body = free_port(), MARK + b"x" * (size - len(MARK))
    with tempfile.TemporaryDirectory() as folder:
        config = pathlib.Path(folder) / "nginx.conf"
        config.write_text(NGINX_CONF.format(module=NCHAN, folder=folder, port=port))
        with Broker(NGINX, "-p", folder, "-c", str(config), "-e", f"{folder}/error.log") as broker:
            wait_for("nginx answers", lambda: connected(port).close() or True)
            crowd = Crowd(MARK)
            for _ in range(count):
                made = connected(port)
                made.sendall(b"GET /sub HTTP/1.1\r\nHost: x\r\nAccept: text/event-stream\r\n\r\n")
                crowd.add(made)
            publisher = connected(port)
            head = b"POST /pub HTTP/1.1\r\nHost: x\r\nContent-Length: %d\r\n\r\n" % len(body)

            def publish():
                publisher.sendall(head + body)
                publisher.recv(1 << 16)  # its answer

            try:
                return cost(broker.child.pid, crowd, seconds, publish)
            finally:
                crowd.close()
                publisher.close()


def readers(bin_folder, quick):
    count, seconds = (50, 5) if quick else (200, 15)
    ours, size = our_streams(bin_folder, count, seconds)
    found = {"ours": ours}
    notes = [f"{count} readers of {size} bytes at {HZ} Hz; the readers are one process beside the server"]
    for name, there, measure in (("nats", SERVER, nats), ("mosquitto", MOSQUITTO, mosquitto), ("nchan", NGINX and NCHAN.exists(), nchan)):
        if there:
            found[name] = measure(count, seconds, size)
        else:
            notes.append(f"{name} is not installed")
    best = min((cost_us for name, (cost_us, _) in found.items() if name != "ours"), default=math.nan)
    rows = [[f"us_per_delivery_{name}", cost_us, "us"] for name, (cost_us, _) in found.items()]
    rows += [[f"slowest_reader_{name}", hz, "Hz"] for name, (_, hz) in found.items()]
    return rows + [["ours_over_best", found["ours"][0] / best, ""]], notes


def streams(bin_folder, quick):
    """Event streams of the lean frame, as many as one core carries; the readers are a program without an interpreter."""
    rows, notes = [], []
    for count in (200, 500) if quick else (200, 1000, 3000, 5000):
        with RealHall(bin_folder, 1, 3) as hall:
            hall.start_cell(0, hall.start_sensors(0), in_site=False, more=("http.max_connections=6000",))
            wait_for("somebody is seen", lambda: get(hall.urls["a"] + "frame")["bodies"])
            pid, port, seconds = hall.fusion_pid("a"), hall.urls["a"].rsplit(":", 1)[1].rstrip("/"), 5 if quick else 20
            begin = cpu_seconds(pid)
            time.sleep(seconds)
            idle = cpu_seconds(pid) - begin  # it also fuses
            crowd = subprocess.Popen([hall.bin / "chorus-stream-crowd", port, "/frame?form=pose", str(count), str(seconds)], stdout=subprocess.PIPE, text=True)
            try:
                crowd.stdout.readline()  # all are connected, and have what came at first
                begin, load = cpu_seconds(pid), cpu_seconds(crowd.pid)
                said = json.loads(crowd.stdout.readline())
                used, load = cpu_seconds(pid) - begin, cpu_seconds(crowd.pid) - load
            finally:
                crowd.kill()
                crowd.wait()
        case = f"{count}_streams"
        rows += [[f"{case}_us_per_delivery", 1e6 * (used - idle) / max(1, said["deliveries"]), "us"],
                 [f"{case}_server_core", 100 * used / seconds, "%"], [f"{case}_readers_core", 100 * load / seconds, "%"],
                 [f"{case}_published", said["events"] / seconds, "Hz"], [f"{case}_slowest_reader", said["fewest"] / seconds, "Hz"],
                 [f"{case}_behind_first_p50", said["late_p50_ms"], "ms"], [f"{case}_behind_first_p99", said["late_p99_ms"], "ms"],
                 [f"{case}_lost", said["lost"], ""]]
        notes.append(f"{count} streams: {said['bytes'] // max(1, said['deliveries'])} bytes each delivery")
    return rows, notes + ["three simulated sensors run on the same cores"]
