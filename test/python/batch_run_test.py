# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""Batches with a program that stands in for pcl_cosection: results, limits, resumption, locks."""
import contextlib
import csv
import html.parser
import os
import shutil
import subprocess
import unittest
import urllib.parse

from batch_stand_in import BatchTest, is_alive, wait_for

MIB = 1 << 20


class Page(html.parser.HTMLParser):
    """Tags, links and text of a page."""

    def __init__(self, text):
        super().__init__()
        self.tags, self.links, self.texts = [], [], []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.links += [value for name, value in attrs if name in ("href", "src")]

    def handle_data(self, data):
        self.texts.append(data)


class Results(BatchTest):
    """What comes out of good and bad items."""

    def test_good_and_bad_items(self):
        self.view("good.pcd")
        self.view("broken.pcd", error="the header is damaged", half=True)
        self.view("usage.pcd", error="no such option", status=2)
        self.view("partly.pcd", failed=[{"id": 7, "error": "too few points"}])
        self.view("large.pcd", memory=400 * MIB, sleep=100)
        self.view("crashes.pcd", crash=True)
        self.view("crashes_once.pcd", crash_until=str(self.folder / "counter"), times=2)
        self.view("worry.pcd", warnings=["labels may count from 0"])
        self.view("seq/associations.txt", name="seq")
        printed, _ = self.batch("--memory-limit", "200M", "--retries", "1", self.inputs, self.output, status=1)
        self.assertIn("4 of 9 items done", printed)
        rows = self.summary()
        status = {name: row["status"] for name, row in rows.items()}
        self.assertEqual({name for name, value in status.items() if value == "done"},
                         {"good", "crashes_once", "worry", "seq"})
        self.assertEqual(status["partly"], "partial")
        for name, reason, attempts in (
                ("broken", "the header is damaged", 1), ("usage", "no such option", 1),
                ("large", "of memory, more than 200 MiB", 1), ("crashes", "signal 11", 2),
                ("partly", "object 7: too few points", 1)):
            self.assertIn(reason, rows[name]["reason"])
            self.assertEqual(rows[name]["attempts"], attempts, name)
        self.assertEqual(rows["crashes_once"]["attempts"], 2)
        self.assertGreater(rows["large"]["peak_memory_bytes"], 200 * MIB)
        self.assertEqual({path.name for path in self.output.iterdir() if path.is_dir()},
                         {".batch", "good", "crashes_once", "worry", "seq", "partly"})
        self.check_whole()
        self.assertEqual(os.listdir(self.output / ".batch" / "staging"), [])
        self.check_overview()

    def test_time_limit(self):
        """In a batch of its own: on a busy machine any item may be over a short limit."""
        self.view("slow.pcd", sleep=100, child=True)
        self.batch("--time-limit", "1.5", "--retries", "1", self.inputs, self.output, status=1)
        row = self.summary()["slow"]
        self.assertEqual((row["status"], row["attempts"]), ("failed", 2))
        self.assertIn("longer than 1.5 s", row["reason"])
        self.check_whole()
        self.assertEqual(os.listdir(self.output / ".batch" / "staging"), [])
        sleeping = subprocess.run(["pgrep", "-fx", "/bin/sleep 300"], capture_output=True, text=True,
                                  check=False).stdout
        self.assertFalse([process for process in sleeping.split() if is_alive(process)])

    def check_overview(self):
        page = Page((self.output / "index.html").read_text())
        names = [text for text in page.texts if text in self.summary()]
        self.assertEqual(set(names[:4]), {"broken", "usage", "large", "crashes"})
        self.assertEqual(names[4:6], ["partly", "worry"])
        for link in page.links:
            self.assertTrue((self.output / urllib.parse.unquote(link)).exists(), link)

    def test_pictures(self):
        """Two for each result, by the viewer; if it fails, the result stays, and a remark says why there are none."""
        self.view("a.pcd")
        self.batch(self.inputs, self.output)
        for name, view in (("picture.png", "overview"), ("picture_behind.png", "behind")):
            words = (self.output / "a" / name).read_bytes().decode(errors="replace").split()
            self.assertEqual(words[words.index("--view") + 1], view)
            self.assertIn(f"a/{name}", Page((self.output / "index.html").read_text()).links)
        for how, remark in (("error", "it is dark"), ("no file", "no picture"), ("no picture", "no picture")):
            (self.bin / "viewing").write_text(how)
            self.batch("--force", self.inputs, self.output)
            row = self.summary()["a"]
            self.assertEqual(row["status"], "done")
            self.assertIn(remark, str(row["remarks"]))
            self.assertFalse(list(self.output.glob("a/*.png")))
            self.assertNotIn("img", Page((self.output / "index.html").read_text()).tags)
        (self.bin / "pcl_cosection_viewer").unlink()
        self.batch("--force", self.inputs, self.output)
        self.assertEqual(self.summary()["a"]["status"], "done")

    def test_names_of_all_kinds(self):
        names = ["a b.pcd", "it's.pcd", 'say "x".pcd', "line\nbreak.pcd", "größe 画.pcd", "<b>&amp;.pcd",
                 "$(touch x).pcd",
                 "{name}.pcd", "-rf.pcd", "same.pcd", "other/same.pcd", "same.ply", "x.ply.pcd", "100%25#?.pcd"]
        for name in names:
            self.view(name)
        raw = os.fsencode(self.inputs) + b"/not\xffutf8.pcd"
        with open(raw, "wb") as file:
            file.write(b"{}\n")
        self.batch("--subfolders", "views", self.inputs, self.output)
        self.assertEqual(len(self.calls()), len(names) + 1)
        rows = self.summary()
        self.assertEqual(len(rows), len(names) + 1)
        self.assertLessEqual({"a b", "line_break", "_rf", "same", "other-same", "same-2", "x.ply"}, set(rows))
        for name in rows:
            self.assertTrue((self.output / name / "batch.json").exists())
        page = Page((self.output / "index.html").read_text())
        self.assertNotIn("b", page.tags)
        self.assertIn("<b>&amp;", page.texts)
        for link in page.links:
            self.assertTrue(os.path.exists(os.path.join(os.fsencode(self.output), urllib.parse.unquote_to_bytes(link))))
        with open(self.output / "summary.csv", newline="", encoding="utf-8", errors="surrogateescape") as file:
            self.assertEqual({row["name"] for row in csv.DictReader(file)}, set(rows))
        self.assertFalse((self.folder / "x").exists())

    def test_options_and_threads(self):
        self.view("a.pcd")
        self.view("seq/depth/x.png")
        self.view("seq/associations.txt", name="seq")
        (self.folder / "list").write_text("in/a.pcd -- --own 'x y'\nin/seq\n")
        self.batch("--workers", "1", "--threads", "3", "--options", "--first", "--fusion-options=--masks {input}/mask",
                   self.folder / "list", self.output, "--", "--json", "{folder}/{name}.json")
        calls = {call["name"]: call for call in self.calls()}
        self.assertEqual(calls["a.pcd"]["arguments"][:-2],
                         ["--threads", "3", "--first", "--json", f"{self.inputs}/in-a.json", "--own", "x y"])
        self.assertEqual(calls["seq"]["arguments"][:-2],
                         ["--threads", "3", "--masks", f"{self.inputs}/seq/mask", "--json",
                          f"{self.inputs}/seq/in-seq.json"])
        self.assertEqual({call["threads"] for call in self.calls()}, {"3"})

    def test_closed_output(self):
        self.view("a.pcd")
        with open("/dev/full", "wb") as full:
            process = self.start(self.inputs, self.output)
            process.communicate()
            self.assertEqual(process.returncode, 0)
            shutil.rmtree(self.output)
            from batch_stand_in import COMMAND
            ended = subprocess.run([*COMMAND, "--programs", self.bin, self.inputs, self.output], stdout=full,
                                   stderr=subprocess.PIPE, env=self.environment(), check=False)
        self.assertEqual(ended.returncode, 1)
        self.assertTrue((self.output / "index.html").exists())
        shutil.rmtree(self.output)
        closed = subprocess.run(["sh", "-c", 'exec "$@" >&-', "sh", *COMMAND, "--programs", self.bin, self.inputs,
                                 self.output], stderr=subprocess.PIPE, env=self.environment(), check=False)
        self.assertEqual(closed.returncode, 1)
        self.assertTrue((self.output / "index.html").exists())

    def test_the_current_folder_is_gone(self):
        self.view("a.pcd")
        from batch_stand_in import COMMAND
        ended = subprocess.run(["sh", "-c", 'mkdir gone && cd gone && rmdir ../gone && exec "$@"', "sh", *COMMAND,
                                "--programs", self.bin, self.inputs, self.output], stderr=subprocess.PIPE,
                               env=self.environment(), cwd=self.folder, text=True, check=False)
        self.assertEqual(ended.returncode, 2)
        self.assertIn("the current folder was removed", ended.stderr)


class Resumption(BatchTest):
    """What is done is not done again."""

    def test_unchanged_items_are_not_done_again(self):
        for name in ("a.pcd", "b.pcd", "c.pcd"):
            self.view(name)
        self.view("bad.pcd", error="no")
        arguments = ("--workers", "2", self.inputs, self.output)
        self.batch(*arguments, status=1)
        self.assertEqual(self.called(), ["a.pcd", "b.pcd", "bad.pcd", "c.pcd"])
        before = (self.output / "c" / "batch.json").read_bytes()
        self.view("a.pcd", error="now bad")
        self.view("b.pcd", sigma=0.002)
        self.view("bad.pcd")
        self.batch(*arguments, status=1)
        self.assertEqual(self.called(), sorted(["a.pcd", "b.pcd", "bad.pcd"] * 2 + ["c.pcd"]))
        self.assertEqual((self.output / "c" / "batch.json").read_bytes(), before)
        self.assertFalse((self.output / "a").exists())
        self.assertTrue((self.output / "bad").exists())
        self.assertFalse((self.output / ".batch" / "failed" / "bad").exists())
        self.assertAlmostEqual(self.summary()["b"]["relative_error"], 0.02, places=9)
        self.view("c.pcd", error="there is no option --resolutoin", status=2)
        self.batch(*arguments, status=1)
        self.assertEqual((self.output / "c" / "batch.json").read_bytes(), before)  # nothing was tried
        self.view("c.pcd")
        os.unlink(self.inputs / "a.pcd")
        self.batch(*arguments)
        self.assertEqual(len(self.calls()), 10)
        self.assertEqual(set(self.summary()), {"b", "bad", "c"})

    def test_options_version_and_force(self):
        self.view("a.pcd")
        mask = self.folder / "mask"
        mask.mkdir()
        arguments = ("--workers", "1", self.inputs, self.output)
        self.batch(*arguments)
        self.batch(*arguments)
        self.assertEqual(len(self.calls()), 1)
        self.batch("--force", *arguments)
        self.assertEqual(len(self.calls()), 2)
        self.batch(*arguments, "--", "--masks", mask)
        self.assertEqual(len(self.calls()), 3)
        (mask / "1.png").write_text("x")
        self.batch(*arguments, "--", "--masks", mask)
        self.assertEqual(len(self.calls()), 4)
        (self.bin / "version").write_text("2.0")
        self.batch("--collect", self.inputs, self.output, "--", "--masks", mask, status=1)
        self.assertEqual(self.summary()["a"]["status"], "outdated")
        self.assertEqual(len(self.calls()), 4)
        self.batch(*arguments, "--", "--masks", mask)
        self.assertEqual(len(self.calls()), 5)

    def test_a_completed_result_is_adopted(self):
        self.view("a.pcd")
        self.view("b.pcd")
        self.batch(self.inputs, self.output)
        staging = self.output / ".batch" / "staging" / "dead" / "x"
        staging.mkdir(parents=True)
        os.rename(self.output / "a", staging / "result")  # killed before the last renaming
        half = self.output / ".batch" / "staging" / "dead" / "y"
        os.rename(self.output / "b", half)
        os.unlink(half / "batch.json")  # killed before
        self.batch(self.inputs, self.output)
        self.assertEqual(self.called(), ["a.pcd", "b.pcd", "b.pcd"])
        self.assertEqual(os.listdir(self.output / ".batch" / "staging"), [])

    def test_parts_of_a_batch(self):
        for name in "abcde":
            self.view(name + ".pcd")
        self.batch("--share", "2/3", self.inputs, self.output)
        self.assertEqual(self.called(), ["b.pcd", "e.pcd"])
        self.assertFalse((self.output / "index.html").exists())
        self.batch("--collect", self.inputs, self.output, status=1)
        self.assertEqual({name for name, row in self.summary().items() if row["status"] == "missing"}, {"a", "c", "d"})
        self.batch("--only", "a", "--only", "b", self.inputs, self.output)
        self.assertEqual(self.called(), ["a.pcd", "b.pcd", "e.pcd"])


class Places(BatchTest):
    """Locks, and outputs that cannot be written."""

    def one_line(self, *arguments, expected, status=1, **settings):
        """A call that fails with one line."""
        _, errors = self.batch(*arguments, status=status, **settings)
        self.assertEqual(len(errors.splitlines()), 1, errors)
        self.assertIn(expected, errors)

    def test_two_batches(self):
        self.view("a.pcd", sleep=100)
        self.view("b.pcd")
        first = self.start("--workers", "1", self.inputs, self.output)
        wait_for(lambda: self.called() == ["a.pcd"], "the first batch works")
        self.one_line(self.inputs, self.output, expected=f"another batch is writing to it (process {first.pid} on ")
        self.one_line("--only", "a", self.inputs, self.output, expected="another batch is working on a")
        first.kill()
        first.wait()
        self.view("a.pcd")
        self.batch(self.inputs, self.output)

    def test_two_parts(self):
        self.view("a.pcd", sleep=100)
        self.view("b.pcd")
        first = self.start("--only", "a", self.inputs, self.output)
        wait_for(lambda: self.called() == ["a.pcd"], "the first part works")
        self.batch("--only", "b", self.inputs, self.output)
        self.one_line("--only", "a", self.inputs, self.output, expected="another batch is working on a")
        self.one_line(self.inputs, self.output, expected="another batch is writing to it")
        self.assertIsNone(first.poll())

    def test_things_of_others_stay(self):
        self.view("a.pcd")
        (self.output / "a").mkdir(parents=True)
        (self.output / "a" / "mine").write_text("x")
        self.batch(self.inputs, self.output, status=1)
        self.assertIn("is there already", self.summary()["a"]["reason"])
        self.assertTrue((self.output / "a" / "mine").exists())

    @unittest.skipIf(shutil.which("setpriv") is None or os.geteuid() != 0, "needs root, to give up its rights")
    def test_read_only_output(self):
        self.view("a.pcd")
        self.output.mkdir(mode=0o555)
        self.folder.chmod(0o755)
        from batch_stand_in import COMMAND
        ended = subprocess.run(
            ["setpriv", "--reuid=65534", "--regid=65534", "--clear-groups", *COMMAND, "--programs", self.bin,
             self.inputs, self.output], capture_output=True, text=True, env=self.environment(), check=False)
        self.assertEqual(ended.returncode, 1, ended)
        self.assertEqual(len(ended.stderr.splitlines()), 1, ended.stderr)
        self.assertIn("cannot be created: Permission denied", ended.stderr)

    @unittest.skipIf(os.geteuid() != 0, "needs root, to mount a small disk")
    def test_full_disk(self):
        self.view("a.pcd")
        self.output.mkdir()
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=2M,nr_inodes=200", "none", self.output],
                                 capture_output=True, check=False)
        if mounted.returncode:
            self.skipTest("no disk can be mounted")
        self.addCleanup(subprocess.run, ["umount", "-l", self.output], check=False)
        filler = self.output / "filler"
        with open(filler, "wb", buffering=0) as file, contextlib.suppress(OSError):
            while file.write(b"x" * 4096):
                pass
        _, errors = self.batch(self.inputs, self.output, status=1)
        self.assertIn("No space left on device", errors)
        self.assertFalse((self.output / "a").exists())
        filler.unlink()
        self.batch(self.inputs, self.output)
        self.assertTrue((self.output / "a" / "batch.json").exists())


if __name__ == "__main__":
    unittest.main()
