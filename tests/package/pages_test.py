"""Manual pages and completions are generated from the options that --help shows."""

import os
import re
import shutil
import subprocess
import unittest
from pathlib import Path

BIN = Path(os.environ["CHORUS_BIN"])
PROGRAMS = ("chorus", "chorus-sensor", "chorus-fusion", "chorus-ergonomics", "chorus-evaluation")


def said(program, *arguments):
    return subprocess.run([str(BIN / program), *arguments], capture_output=True, text=True, check=True).stdout


def completions(program, *words):
    """The words that bash suggests after these words; the last one may be incomplete."""
    script = (f"{said(program, '--print', 'completion')}\n"
              f"COMP_WORDS=({program} {' '.join(repr(word) for word in words)}); COMP_CWORD={len(words)}\n"
              f"_{program.replace('-', '_')}; printf '%s\\n' \"${{COMPREPLY[@]}}\"")
    return subprocess.run(["bash", "-c", script], capture_output=True, text=True, check=True).stdout.split()


class Pages(unittest.TestCase):
    def test_every_option_of_the_help_is_in_the_manual(self):
        for program in PROGRAMS:
            page = said(program, "--print", "manual").replace("\\-", "-")
            for option in set(re.findall(r"--[a-z][a-z-]+", said(program, "--help").split("Examples:")[0])) - {"--help"}:
                with self.subTest(program=program, option=option):
                    self.assertIn(option, page)

    @unittest.skipUnless(shutil.which("groff"), "runs where groff is installed (Debian: groff-base)")
    def test_roff_has_nothing_to_complain_of(self):
        for program in PROGRAMS:
            done = subprocess.run(["groff", "-man", "-ww", "-Tutf8"], input=said(program, "--print", "manual"),
                                  capture_output=True, text=True, check=True)
            self.assertEqual(done.stderr, "", program)
            self.assertIn("Print this help message", done.stdout)

    def test_completion_offers_commands_then_options(self):
        self.assertIn("doctor", completions("chorus", "do"))
        self.assertEqual(completions("chorus", "register", "--can"), ["--cancel"])
        self.assertEqual(completions("chorus", "status", "--can"), [])
        self.assertIn("--config", completions("chorus-sensor", "--con"))


if __name__ == "__main__":
    unittest.main()
