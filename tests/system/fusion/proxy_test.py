"""The server behind a real nginx on the same host, in its simplest configuration: the token is still required."""
import http.client
import json
import os
import pathlib
import shutil
import subprocess
import threading
import time
import unittest

from rig import BIN, Rig, free_port, get, wait_for

NGINX = shutil.which("nginx") or shutil.which("nginx", path="/usr/sbin")
TOKEN = "open sesame 1"
CONFIG = """
{user} daemon off; worker_processes 1; pid {folder}/pid; error_log {folder}/error.log;
events {{}}
http {{
  access_log off; client_body_temp_path {folder}/a; proxy_temp_path {folder}/b;
  fastcgi_temp_path {folder}/c; uwsgi_temp_path {folder}/d; scgi_temp_path {folder}/e;
  {server}
}}
"""
AS_US = "user root;" if os.getuid() == 0 else ""  # else its worker may not enter our folder
PLAIN = "server {{ listen 127.0.0.1:{port}; location / {{ proxy_pass http://127.0.0.1:{behind}; {more} }} }}"
MANY_READERS = pathlib.Path(__file__).resolve().parents[3] / "docs/guide/examples/nginx-readers.conf"


def ask(port, method, path, token=None, body=b"", host=None):
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=10)
    try:
        headers = {"Authorization": f"Bearer {token}"} if token else {}
        if host:
            headers["Host"] = host
        connection.request(method, path, body=body or None, headers=headers)
        answer = connection.getresponse()
        return answer.status, answer.read()
    finally:
        connection.close()


@unittest.skipUnless(NGINX, "runs where nginx is installed (Debian: nginx)")
class BehindAProxy(Rig):
    def proxy(self, behind, more="", server=None):
        folder = pathlib.Path(self.folder.name) / f"nginx-{behind}"
        folder.mkdir()
        port = free_port()
        config = folder / "nginx.conf"
        if server is None:
            server = PLAIN.format(port=port, behind=behind, more=more)
        server = server.replace("listen 80;", f"listen 127.0.0.1:{port};").replace("127.0.0.1:8080", f"127.0.0.1:{behind}")
        server = server.replace("/var/cache/nginx/chorus", f"{folder}/cache")
        config.write_text(CONFIG.format(folder=folder, server=server, user=AS_US))
        child = subprocess.Popen([NGINX, "-e", str(folder / "error.log"), "-p", str(folder), "-c", str(config)],
                                 stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(child.wait)
        self.addCleanup(child.terminate)
        wait_for("nginx answers", lambda: ask(port, "GET", "/clock")[0] in (200, 401, 421))
        return port

    def tracker(self, wait=True, **settings):
        recordings = pathlib.Path(self.folder.name) / "recordings"
        return self.fusion({"gone": "http://127.0.0.1:1/"}, wait, **{"recording.folder": recordings, **settings})

    def test_writing_needs_the_token_whatever_the_proxy_says_of_itself(self):
        fusion = self.tracker(**{"http.bearer_token": TOKEN})
        port = self.proxy(fusion.port)
        for way in (port, fusion.port):
            self.assertEqual(ask(way, "GET", "/frame")[0], 200)
            for method, path in (("POST", "/registration"), ("DELETE", "/registration"), ("POST", "/recordings/"),
                                 ("DELETE", "/recordings/x")):
                self.assertEqual(ask(way, method, path)[0], 401, f"{method} {path} on {way}")
                self.assertEqual(ask(way, method, path, "wrong")[0], 401, f"{method} {path} on {way}")
        self.assertEqual(list(pathlib.Path(self.folder.name).glob("recordings/*")), [])
        self.assertEqual(ask(port, "POST", "/registration", TOKEN, b'{"seconds": 30}')[0], 202)
        wait_for("the session is cancelled", lambda: ask(port, "DELETE", "/registration", TOKEN)[0] in (200, 202, 204))
        self.assertEqual(ask(port, "POST", "/recordings/", TOKEN, b'{"name": "walk"}')[0], 201)
        metrics = get(fusion.url + "metrics", accept="*/*")[2].decode()
        self.assertRegex(metrics, r"chorus_http_unauthorized_total 16\b")
        self.assertIn("wrong bearer token", fusion.text())

    def test_guesses_through_the_proxy_are_slowed(self):
        fusion = self.tracker(**{"http.bearer_token": TOKEN})
        port = self.proxy(fusion.port)
        for i in range(10):
            self.assertEqual(ask(port, "DELETE", "/registration", f"guess {i}")[0], 401)
        begun = time.monotonic()
        self.assertEqual(ask(port, "DELETE", "/registration", "one more")[0], 401)
        self.assertGreater(time.monotonic() - begun, 0.7, "a wrong guess waits")
        guesser = threading.Thread(target=ask, args=(port, "DELETE", "/registration", "and another"))
        guesser.start()
        self.assertIn(ask(port, "DELETE", "/registration", TOKEN)[0], (200, 202, 204), "the right token is let in all the while")
        guesser.join()

    def test_a_listed_proxy_is_nobody_on_this_host(self):
        fusion = self.tracker(**{"http.trusted_proxies": '["127.0.0.1"]'})
        port = self.proxy(fusion.port, "proxy_set_header X-Forwarded-For $proxy_add_x_forwarded_for;")
        self.assertEqual(ask(port, "GET", "/frame")[0], 200)
        self.assertEqual(ask(port, "POST", "/registration")[0], 403)

    def test_a_listed_proxy_says_by_what_address_it_was_asked(self):
        more = "proxy_set_header Host $http_host; proxy_set_header X-Forwarded-Proto https;"
        for proxies, scheme in (('["127.0.0.1"]', "https"), ("[]", "http")):
            fusion = self.tracker(**{"http.trusted_proxies": proxies})
            port = self.proxy(fusion.port, more)
            thing = json.loads(ask(port, "GET", "/.well-known/wot")[1])
            self.assertEqual(thing["base"], f"{scheme}://127.0.0.1:{port}/", "only a listed proxy is believed")

    def headers(self, port, **headers):
        connection = http.client.HTTPConnection("127.0.0.1", port, timeout=10)
        self.addCleanup(connection.close)
        connection.request("GET", "/frame", headers=headers)
        return connection.getresponse()

    def test_many_readers_are_served_from_a_cache_and_streams_as_they_come(self):
        fusion = self.tracker()
        port = self.proxy(fusion.port, server=MANY_READERS.read_text())
        asked = [self.headers(port, Accept="application/json") for _ in range(20)]
        self.assertEqual({each.status for each in asked}, {200})
        self.assertGreaterEqual([each.headers["X-Cache"] for each in asked].count("HIT"), 15)
        other = self.headers(port, Accept="text/turtle")
        self.assertIn("turtle", other.headers["Content-Type"], "another form is another answer")
        stream = self.headers(port, Accept="text/event-stream")
        self.assertIsNone(stream.headers["X-Cache"])
        began = time.monotonic()
        events = sum(stream.readline().startswith(b"data:") for _ in range(60))
        self.assertGreater(events, 5)
        self.assertLess(time.monotonic() - began, 8, "frames come as they are made")

    def test_a_cache_shows_nothing_to_whom_the_server_would_not(self):
        tokens = json.dumps([{"token": TOKEN, "role": "read"}])
        fusion = self.tracker(False, **{"http.address": "0.0.0.0", "http.tokens": tokens, "http.trusted_proxies": '["127.0.0.1"]'})
        port = self.proxy(fusion.port, server=MANY_READERS.read_text())
        wait_for("the reader is served", lambda: self.headers(port, Authorization=f"Bearer {TOKEN}").status == 200)
        self.assertIn(self.headers(port).status, (401, 403))
        self.assertIn(self.headers(port, Authorization="Bearer wrong").status, (401, 403))

    def test_the_name_that_a_proxy_hands_on_has_to_be_ours(self):
        fusion = self.tracker(**{"http.hosts": '["tracker.example"]'})
        port = self.proxy(fusion.port, "proxy_set_header Host $host;")
        self.assertEqual(ask(port, "GET", "/frame", host="tracker.example")[0], 200)
        status, body = ask(port, "GET", "/frame", host="evil.example")
        self.assertEqual(status, 421)
        self.assertIn(b"http.hosts", body)


if __name__ == "__main__":
    assert BIN.exists(), f"build chorus-fusion first ({BIN})"
    unittest.main(verbosity=2)
