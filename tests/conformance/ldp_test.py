"""Linked Data Platform 1.0, read-only: what the W3C suite requires of a read-only server, and our own HTTP rules."""

import json
import unittest

from chorus_processes import URLS, get

LDP = "http://www.w3.org/ns/ldp#"
DOCUMENTS = ["/", "/frame", "/skeletons/", "/floor-plane", "/clock", "/recordings/"]
SCHEMAS = ["/ns", "/shapes"]  # Turtle files served as they are; there is no other format
FUSION_ONLY = ["/registration", "/sensors/"]
TURTLE = "text/turtle"


def links(answer, rel):
    found = []
    for part in ", ".join(answer.headers.get_all("Link") or []).split(","):
        if f'rel="{rel}"' in part or f"rel={rel}" in part:
            found.append(part[part.find("<") + 1 : part.find(">")])
    return found


def documents(schemas=False):
    return [base + path for base in URLS.values()
            for path in DOCUMENTS + (FUSION_ONLY if base == URLS["fusion"] else []) + (SCHEMAS if schemas else [])]


def turtle_types(text):
    return " a " in text or "\ta " in text


class LdpReadOnly(unittest.TestCase):
    def test_get_and_head_have_an_etag_and_allow(self):
        for url in documents(schemas=True):
            for method in ("GET", "HEAD"):
                answer = get(url, method=method)
                self.assertEqual(answer.status, 200)
                self.assertRegex(answer.headers["ETag"], r'^"[^"]+"$')
                for needed in ("GET", "HEAD", "OPTIONS"):
                    self.assertIn(needed, answer.headers["Allow"])

    def test_every_answer_is_typed_as_ldp_resource(self):
        for url in documents(schemas=True):
            self.assertIn(LDP + "Resource", links(get(url), "type"))

    def test_containers_say_so(self):
        for base in URLS.values():
            answer = get(base + "/skeletons/")
            self.assertIn(LDP + "BasicContainer", links(answer, "type"), base)

    def test_turtle_is_the_default_and_is_negotiated(self):
        for url in documents(schemas=True):
            for accept in (None, "*/*", "text/turtle", "text/turtle;q=0.9,application/json;q=0.8", "text/*"):
                answer = get(url, accept=accept)
                self.assertEqual(answer.type, TURTLE, (url, accept))

    def test_json_ld_is_negotiated(self):
        for url in documents():
            answer = get(url, accept="application/ld+json, application/json;q=0.5")
            self.assertEqual(answer.type, "application/ld+json", url)
            json.loads(answer.body)

    def test_options(self):
        for url in documents(schemas=True):
            answer = get(url, method="OPTIONS")
            self.assertIn(answer.status, (200, 204))
            self.assertIn("GET", answer.headers["Allow"])

    def test_no_writing_is_promised_where_there_is_none(self):
        for base in URLS.values():
            answer = get(base + "/frame")
            for header in ("Accept-Post", "Accept-Patch"):
                self.assertIsNone(answer.headers.get(header))
            for method in ("PUT", "DELETE", "PATCH", "POST"):
                refused = get(base + "/frame", method=method)
                self.assertEqual(refused.status, 405)
                self.assertIn("GET", refused.headers["Allow"])

    def test_nothing_acceptable_is_406_with_the_list(self):
        for url in documents(schemas=True):
            answer = get(url, accept="image/x-nothing")
            self.assertEqual(answer.status, 406)
            self.assertIn("text/turtle", answer.body)

    def test_head_says_what_get_says(self):
        for base in URLS.values():
            head, whole = get(base + "/floor-plane", method="HEAD"), get(base + "/floor-plane")
            self.assertEqual(head.body, "")
            self.assertEqual(head.headers["Content-Type"], whole.headers["Content-Type"])
            self.assertIn("Content-Length", head.headers)

    def test_conditional_get(self):
        for url in documents(schemas=True):
            if url.endswith("/clock"):
                continue  # its body is never the same twice
            for _ in range(50):  # a live resource may change between the two requests
                etag = get(url).headers["ETag"]
                again = get(url, headers={"If-None-Match": etag})
                if again.status == 304:
                    break
            self.assertEqual(again.status, 304, url)
            self.assertEqual(again.body, "")
            self.assertEqual(again.headers["ETag"], etag)

    def test_representations_have_their_own_etags(self):
        for base in URLS.values():
            version = get(base + "/skeletons/").headers
            other = get(base + "/skeletons/", accept="application/json").headers
            self.assertNotEqual(version["ETag"], other["ETag"])
            self.assertIn("Accept", version["Vary"])

    def test_explicit_types(self):
        for url in documents(schemas=True):
            self.assertTrue(turtle_types(get(url).body), url)

    def test_missing_is_a_problem_document(self):
        for base in URLS.values():
            for path in ("/nothing", "/skeletons/999999999", "/frames/999999999999999999"):
                answer = get(base + path)
                self.assertEqual(answer.status, 404, path)
                self.assertEqual(answer.type, "application/problem+json")
                self.assertTrue(json.loads(answer.body)["detail"])

    def test_long_poll_gives_the_next_frame(self):
        for base in URLS.values():
            first = get(base + "/frame", accept="application/json")
            after = get(base + "/frame", accept="application/json",
                        headers={"If-None-Match": first.headers["ETag"], "Prefer": "wait=5"})
            self.assertEqual(after.status, 200)
            self.assertIn("wait", after.headers["Preference-Applied"])
            self.assertGreater(json.loads(after.body)["sequence"], json.loads(first.body)["sequence"])

    def test_a_cited_frame_can_be_fetched_again(self):
        for base in URLS.values():
            live = get(base + "/frame", accept="application/json")
            cited = get(base + "/" + live.headers["Content-Location"].lstrip("/"), accept="application/json")
            one, two = json.loads(live.body), json.loads(cited.body)
            self.assertEqual(one["sequence"], two["sequence"])
            coordinates = lambda frame: [[j.get("x") for j in b["joints"].values()] for b in frame["bodies"]]
            self.assertEqual(coordinates(one), coordinates(two))
            self.assertIn("immutable", cited.headers["Cache-Control"])


if __name__ == "__main__":
    unittest.main()
