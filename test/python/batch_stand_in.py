# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""A program that stands in for pcl_cosection and does what its input says, and what tests of the batch share."""
import json
import os
import pathlib
import shutil
import signal
import stat
import subprocess
import sys
import tempfile
import time
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
LAUNCHER = os.environ.get("PCL_COSECTION_BATCH")  # an installed program, else that of the sources
COMMAND = [LAUNCHER] if LAUNCHER else [sys.executable, "-m", "pcl_cosection_batch"]
TIMEOUT_S = 60

# The first line of a view says what happens: a JSON object. Each call leaves a line in the file CALLS.
PROGRAM = r'''#!/usr/bin/python3 -SE
import json, os, signal, subprocess, sys, time
arguments = sys.argv[1:]
if arguments == ["--version"]:
    print("stand-in " + open(os.path.dirname(os.path.abspath(__file__)) + "/version").read().strip())
    sys.exit(0)
output, view = arguments[-1], arguments[-2]
if os.path.isdir(view):
    view += "/associations.txt"
wish = json.loads(open(view).readline() or "{}")
calls = os.path.dirname(os.path.abspath(__file__)) + "/calls"
with open(calls, "a") as file:
    file.write(json.dumps({"name": wish.get("name", os.path.basename(view)), "pid": os.getpid(),
                           "threads": os.environ.get("OMP_NUM_THREADS"), "arguments": arguments}) + "\n")
if wish.get("child"):
    subprocess.Popen(["/bin/sleep", "300"], start_new_session=True)
if wish.get("crash_until"):
    with open(wish["crash_until"], "a+") as file:
        file.write("x")
        file.seek(0)
        if len(file.read()) < wish["times"]:
            os.kill(os.getpid(), signal.SIGSEGV)
if wish.get("crash"):
    os.kill(os.getpid(), signal.SIGSEGV)
os.makedirs(output + "/half" if wish.get("half") else output)
if wish.get("memory"):
    block = b"x" * wish["memory"]
time.sleep(wish.get("sleep", 0))
if "error" in wish:
    sys.stderr.write("pcl_cosection: warning: first this\npcl_cosection: " + wish["error"] + "\n")
    sys.exit(wish.get("status", 1))
objects = [{"id": n, "closed": True, "mean_sigma_m": wish.get("sigma", 0.001), "volume_m3": 0.001,
            "provenance": {"observed": 0.4}, "contradicted_share": 0.0} for n in range(1, 3)]
with open(output + "/summary.json", "w") as file:
    json.dump({"objects": objects, "failed": wish.get("failed", []), "warnings": wish.get("warnings", [])}, file)
print("completed", output)
sys.exit(1 if wish.get("failed") else 0)
'''


def is_alive(process):
    """Whether a process runs."""
    try:
        return pathlib.Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def wait_for(condition, what, seconds=30):
    """Waits until a condition holds."""
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            raise AssertionError(f"waited {seconds} s for: {what}")
        time.sleep(0.02)


def descendants(process):
    """All processes below a process: number and command line."""
    parents = {}
    for folder in pathlib.Path("/proc").iterdir():
        if folder.name.isdigit():
            try:
                parent = int((folder / "stat").read_text().rpartition(")")[2].split()[1])
                parents.setdefault(parent, []).append((int(folder.name), (folder / "cmdline").read_bytes()))
            except OSError:
                continue
    found, waiting = [], [process]
    while waiting:
        for child in parents.get(waiting.pop(), []):
            found.append(child)
            waiting.append(child[0])
    return found


# Stands in for the viewer: its picture lists its arguments. The file VIEWING says how it fails.
VIEWER = r'''#!/usr/bin/python3 -SE
import os, sys
viewing = os.path.dirname(os.path.abspath(__file__)) + "/viewing"
how = open(viewing).read() if os.path.exists(viewing) else ""
if how != "no file":
    with open(sys.argv[sys.argv.index("--screenshot") + 1], "wb") as file:
        file.write((b"" if how == "no picture" else b"\x89PNG\r\n\x1a\n ") + " ".join(sys.argv[1:]).encode())
if how == "error":
    sys.exit("pcl_cosection_viewer: error: it is dark")
'''


class BatchTest(unittest.TestCase):
    """A folder with the stand-in, inputs and an output."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="batch_test_"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.bin = self.folder / "bin"
        self.inputs = self.folder / "in"
        self.output = self.folder / "out"
        self.bin.mkdir()
        self.inputs.mkdir()
        (self.bin / "version").write_text("1.0")
        for name, text in {"pcl_cosection": PROGRAM, "pcl_cosection_fusion": PROGRAM,
                           "pcl_cosection_viewer": VIEWER}.items():
            (self.bin / name).write_text(text)
            (self.bin / name).chmod(stat.S_IRWXU | stat.S_IRWXG | stat.S_IRWXO)

    def view(self, path, /, **wish):
        """Makes a view that makes the stand-in do something."""
        name, path = path, self.inputs / path
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps({"name": name, **wish}) + "\n")
        return path

    def environment(self):
        """The sources are found."""
        return {**os.environ, "PYTHONPATH": str(SOURCE / "python"), "PYTHONDONTWRITEBYTECODE": "1"}

    def start(self, *arguments):
        """Starts a batch."""
        process = subprocess.Popen(
            [*COMMAND, "--programs", str(self.bin), *map(str, arguments)], stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=self.environment(), cwd=self.folder)
        self.addCleanup(self.stop, process)
        return process

    @staticmethod
    def stop(process):
        """Ends a process that still runs, and closes its pipes."""
        if process.poll() is None:
            process.kill()
        process.communicate()

    def batch(self, *arguments, status=0):
        """Runs a batch to its end. Returns what it printed: standard output, standard error."""
        process = self.start(*arguments)
        try:
            printed = process.communicate(timeout=TIMEOUT_S)
        except subprocess.TimeoutExpired:
            process.send_signal(signal.SIGKILL)
            raise
        self.assertEqual(process.returncode, status, printed)
        self.assertNotIn("Traceback", "".join(printed))
        return printed

    def calls(self):
        """The calls of the stand-in so far."""
        path = self.bin / "calls"
        return [json.loads(line) for line in path.read_text().splitlines()] if path.exists() else []

    def called(self):
        """The names of the views of all calls, sorted."""
        return sorted(call["name"] for call in self.calls())

    def summary(self):
        """The rows of summary.json by name."""
        rows = json.loads((self.output / "summary.json").read_text())["items"]
        return {row["name"]: row for row in rows}

    def check_whole(self):
        """Each result in OUTPUT is complete, and nothing else is there but the batch's own files."""
        for path in self.output.iterdir():
            if path.is_dir() and path.name != ".batch":
                self.assertTrue((path / "batch.json").exists(), path)
                self.assertTrue((path / "summary.json").exists(), path)
