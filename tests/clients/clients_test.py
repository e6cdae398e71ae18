"""clients/chorus.py and clients/Chorus.cs against real processes, and against a stream recorded from them."""
import http.server
import json
import pathlib
import shutil
import signal
import subprocess
import sys
import threading
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parents[1] / "tests/system/fusion"), str(HERE.parents[1] / "clients")]
from rig import BIN, ROOT, Rig, wait_for  # noqa: E402

import chorus  # noqa: E402

COUNT = 3
# Good after a short walk: how good the registration is does not matter here.
QUICK = {"registration.auto": "false", "registration.good_duration_s": 3, "registration.good_position_m": 1.0, "registration.max_position_m": 1.0,
         "registration.good_rms_m": 1.0}


class Replay:
    """Serves recorded frames as an event stream, as the tracker does, until end()."""

    def __init__(self, frames):
        class Handler(http.server.BaseHTTPRequestHandler):
            def do_GET(self):
                replay.asked = self.path
                self.send_response(200)
                self.send_header("Content-Type", "text/event-stream")
                self.end_headers()
                try:
                    self.wfile.write(b"retry: 1000\n\n")
                    for frame in frames:
                        if replay.over.wait(0.03):
                            return
                        self.wfile.write(f"id: {frame['sequence']}\ndata: {json.dumps(frame)}\n\n".encode())
                    replay.over.wait(60)
                except OSError:
                    pass

            def log_message(self, *_):
                pass

        replay = self
        self.asked = None
        self.over = threading.Event()
        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.server.daemon_threads = True
        self.url = f"http://127.0.0.1:{self.server.server_port}/"
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    def end(self):
        self.over.set()
        self.server.shutdown()
        self.server.server_close()


class Clients(Rig):
    def setUp(self):
        super().setUp()
        self.sensors = [self.sensor(i, COUNT) for i in range(COUNT)]

    def start(self, **settings):
        server = self.fusion({f"s{i + 1}": s.url for i, s in enumerate(self.sensors)}, **settings)
        return server, chorus.Tracker(server.url)

    def given(self, **settings):
        return self.start(**{"registration.file": self.given_ring(COUNT), **settings})

    def test_python_follows_names_and_notices_silence(self):
        server, tracker = self.given()
        frames = tracker.frames(max_rate=20, stale=0.5)
        seen = wait_for("somebody", lambda: (f := next(frames)) and f.people and f)
        person = seen.people[0]
        self.assertIs(seen.by_slot(person.slot), person)
        self.assertIs(seen.by_id(person.id), person)
        self.assertGreater(person.joints["Head"].y, 1.0)
        self.assertEqual(person.joints["Head"].state, "Tracked")
        later = next(f for f in frames if f)
        self.assertGreater(later.sequence, seen.sequence)
        self.assertAlmostEqual(tracker.at(seen.time).time, seen.time, places=6)
        self.assertGreater(tracker.at("now").time, seen.time)
        # That instant may have been answered again with frames that came late: whoever was in it still is.
        whole, lean = (tracker.at(seen.time, form=form).people for form in (None, "pose"))
        self.assertIn("contributors", whole[0].raw["joints"]["Head"])
        self.assertNotIn("contributors", lean[0].raw["joints"]["Head"])
        tracker.name(person.id, "Anna")
        self.assertEqual(tracker.people()[person.id]["name"], "Anna")
        with self.assertRaises(chorus.Refused) as refused:
            tracker.name(person.id, "a/b")
        self.assertEqual(refused.exception.status, 400)
        self.assertIn("slash", str(refused.exception))
        tracker.forget(person.id)
        self.assertNotIn(person.id, tracker.people())
        events = tracker.follow_events()
        self.assertIn(next(events)["eventId"], [e["eventId"] for e in tracker.events()])
        server.child.send_signal(signal.SIGSTOP)
        try:
            while next(frames) is not None:
                pass
        finally:
            server.child.send_signal(signal.SIGCONT)
        while next(frames) is None:
            pass
        with self.assertRaises(chorus.Refused):
            next(chorus.Tracker(server.url).frames(form="prose"))

    def test_python_registers_and_records(self):
        folder = pathlib.Path(self.folder.name) / "recordings"
        folder.mkdir()
        _, tracker = self.start(**QUICK, **{"recording.folder": str(folder)})
        told = []
        session = tracker.register(8, told.append)
        self.assertEqual((session["state"], session["adopted"]), ("done", True), session)
        self.assertGreater(len(told), 2)
        self.assertEqual(tracker.registration()["verdict"], session["verdict"])
        name = tracker.record(name="walk")
        self.assertEqual(name, "walk")
        wait_for("frames are written", lambda: tracker._json("GET", "recordings/walk")["frames"] > 10)
        self.assertEqual(tracker.stop(name)["state"], "finished")
        copy = pathlib.Path(self.folder.name) / "copy.mcap"
        tracker.download(name, copy)
        self.assertTrue(copy.read_bytes().startswith(b"\x89MCAP0\r\n"))
        self.assertEqual(tracker.recorded(tracker.record(seconds=1))["state"], "finished")

    @unittest.skipUnless(shutil.which("mcs") and shutil.which("mono"), "runs where mcs and mono are installed (Debian: mono-mcs, mono-runtime)")
    def test_csharp_draws_a_recorded_stream_and_shows_that_it_ended(self):
        server, tracker = self.given()
        wait_for("somebody", lambda: tracker.frame().people)
        frames = []
        for frame in tracker.frames(max_rate=25):
            if frame:
                frames.append(frame.raw)
            if len(frames) == 60:
                break
        server.kill()
        program = pathlib.Path(self.folder.name) / "test.exe"
        own = [ROOT / "clients/Chorus.cs", HERE / "ChorusTest.cs"]
        subprocess.run(["mcs", "-langversion:7", "-warnaserror", f"-out:{program}", *own], check=True, timeout=120)
        library = pathlib.Path(self.folder.name) / "unity.dll"
        subprocess.run(["mcs", "-langversion:7", "-target:library", "-define:UNITY_5_3_OR_NEWER", f"-out:{library}", own[0], HERE / "UnityStub.cs"],
                       check=True, timeout=120)
        replay = Replay(frames)
        child = subprocess.Popen(["mono", program, replay.url], stdout=subprocess.PIPE, text=True)
        try:
            lines = iter(child.stdout.readline, "")
            for line in lines:
                if line.strip() == "streamed":
                    break
                print(line, end="")
            replay.end()
            said = "".join(lines)
            self.assertEqual((child.wait(timeout=60), said.strip()), (0, "ok"))
        finally:
            child.kill()
            child.wait()
            child.stdout.close()
        self.assertEqual(replay.asked, "/frame?form=pose")


if __name__ == "__main__":
    assert BIN.exists(), f"build chorus-fusion first ({BIN})"
    unittest.main(verbosity=2)
