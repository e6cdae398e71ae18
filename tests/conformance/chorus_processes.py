"""The addresses of the services under test, and a small HTTP client that hides nothing."""

import http.client
import os
from urllib.parse import urlsplit

URLS = {name: os.environ[f"CHORUS_{name.upper()}_URL"].rstrip("/") for name in ("fusion", "sensor")}
TIMEOUT_S = 15


class Answer:
    def __init__(self, response):
        self.status = response.status
        self.headers = response.headers
        self.body = response.read().decode("utf-8", "replace")
        self.type = (response.headers.get("Content-Type") or "").split(";")[0]


def get(url, accept=None, headers=None, method="GET"):
    """Sends one request on a new connection; without an Accept header unless one is given."""
    parts = urlsplit(url)
    connection = http.client.HTTPConnection(parts.hostname, parts.port, timeout=TIMEOUT_S)
    sent = dict(headers or {})
    if accept is not None:
        sent["Accept"] = accept
    target = parts.path + (f"?{parts.query}" if parts.query else "")
    try:
        connection.request(method, target, headers=sent)
        return Answer(connection.getresponse())
    finally:
        connection.close()
