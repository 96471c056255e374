# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""Batches whose workers, scheduler or own process are killed, and batches on a cluster. A program stands in for
pcl_cosection."""
import collections
import json
import os
import pathlib
import signal
import socket
import stat
import subprocess
import sys
import time
import unittest

from batch_stand_in import BatchTest, descendants, is_alive, wait_for

SBATCH = r"""#!/usr/bin/python3
# Stands in for Slurm's sbatch: starts the tasks of the array here.
import os, re, subprocess, sys
folder = os.path.dirname(os.path.abspath(__file__))
script = sys.argv[-1]
count = int(re.search(r"^#SBATCH --array=1-(\d+)$", open(script).read(), re.M).group(1))
with open(folder + "/submitted", "a") as file:
    file.write(" ".join(sys.argv[1:-1]) + "\n")
for task in range(1, count + 1):
    process = subprocess.Popen(["sh", script], start_new_session=True, stdin=subprocess.DEVNULL,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    with open(folder + "/jobs", "a") as file:
        file.write(f"{process.pid}\n")
print("42;here")
"""
SCANCEL = r"""#!/usr/bin/python3
import os, signal, sys
folder = os.path.dirname(os.path.abspath(__file__))
assert sys.argv[1:] == ["42"]
for line in open(folder + "/jobs"):
    try:
        os.killpg(int(line), signal.SIGTERM)
    except OSError:
        pass
open(folder + "/cancelled", "w").close()
"""
SQUEUE = r"""#!/usr/bin/python3
import os
folder = os.path.dirname(os.path.abspath(__file__))
def runs(process):
    try:
        return open(f"/proc/{process}/stat").read().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False
if any(runs(int(line)) for line in open(folder + "/jobs")):
    print("42_1")
"""


def free_port():
    """A port of this machine that nobody uses."""
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


class Killed(BatchTest):
    """Whatever is killed: what is done stays, and nothing is done twice."""

    def running_programs(self):
        """Processes of the stand-in that run."""
        return [call["pid"] for call in self.calls() if is_alive(call["pid"])]

    def test_a_killed_worker(self):
        for number in range(6):
            self.view(f"{number}.pcd", sleep=1.0)
        batch = self.start("--workers", "2", self.inputs, self.output)
        wait_for(lambda: len(self.running_programs()) == 2, "items are being done")
        program = self.running_programs()[-1]
        guard = next(number for number, command in descendants(batch.pid)
                     if b"guard" in command and program in [child for child, _ in descendants(number)])
        worker = int(pathlib.Path(f"/proc/{guard}/stat").read_text().rpartition(")")[2].split()[1])
        os.kill(worker, signal.SIGKILL)
        wait_for(lambda: not is_alive(program), "the program of the killed worker ends", 5)
        printed, errors = batch.communicate()
        self.assertEqual(batch.returncode, 0, errors)
        self.assertIn("the worker was lost; attempt 2 of 3", errors)
        self.assertIn("6 of 6 items done", printed)
        times = collections.Counter(self.called())
        self.assertEqual(sorted(times.values()), [1] * 5 + [2])
        self.check_whole()

    def test_a_killed_batch(self):
        for number in range(6):
            self.view(f"{number}.pcd", sleep=0.5, child=True)
        batch = self.start("--workers", "2", self.inputs, self.output)
        wait_for(lambda: len(self.calls()) >= 4, "items are being done")
        processes = [number for number, _ in descendants(batch.pid)] + self.running_programs()
        batch.kill()
        wait_for(lambda left=processes: not any(map(is_alive, left)), "all processes of the batch end", 10)
        done = {path.parent.name for path in self.output.glob("*/batch.json")}
        self.assertTrue(done)
        self.check_whole()
        self.batch("--workers", "2", self.inputs, self.output)
        times = collections.Counter(self.called())
        self.assertEqual({times[name + ".pcd"] for name in done}, {1})
        self.assertEqual(len(times), 6)
        self.assertEqual(os.listdir(self.output / ".batch" / "staging"), [])

    def interrupted(self, number, status):
        batch = self.start("--workers", "1", self.inputs, self.output)
        wait_for(lambda: "slow.pcd" in self.called(), "the slow item begins")
        processes = [process for process, _ in descendants(batch.pid)]
        batch.send_signal(number)
        _, errors = batch.communicate(timeout=30)
        self.assertEqual(batch.returncode, status, errors)
        self.assertIn("the same command goes on from there", errors.splitlines()[-1])
        self.assertNotIn("Traceback", errors)
        wait_for(lambda: not any(map(is_alive, processes)), "all processes of the batch end", 5)

    def test_interruptions(self):
        self.view("done.pcd")
        self.view("slow.pcd", sleep=100, child=True)
        self.interrupted(signal.SIGINT, 130)
        self.assertEqual(self.summary()["slow"]["status"], "missing")
        (self.bin / "calls").rename(self.bin / "calls_before")
        self.interrupted(signal.SIGTERM, 143)
        self.assertEqual(self.called(), ["slow.pcd"])
        self.check_whole()


    def test_an_early_interruption(self):
        """While the cluster is being started."""
        self.view("a.pcd", sleep=100)
        for number, status in ((signal.SIGTERM, 143), (signal.SIGINT, 130)):
            output = self.output / str(status)
            batch = self.start(self.inputs, output)
            wait_for(lambda place=output: list(place.glob(".batch/staging/*")), "the batch begins")
            processes = [process for process, _ in descendants(batch.pid)]
            batch.send_signal(number)
            _, errors = batch.communicate(timeout=30)
            self.assertEqual(batch.returncode, status, errors)
            self.assertNotIn("Traceback", errors)
            wait_for(lambda left=processes: not any(map(is_alive, left)), "all processes of the batch end", 10)


class Clusters(BatchTest):
    """Workers that the batch did not start."""

    def dask(self, program, *arguments):
        """Starts a part of a cluster."""
        process = subprocess.Popen(
            [sys.executable, "-m", f"distributed.cli.{program}", *map(str, arguments), "--no-dashboard"],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, cwd=self.folder)
        self.addCleanup(self.end, process)
        return process

    @staticmethod
    def end(process):
        """Kills a process with all below it."""
        for number, _ in descendants(process.pid):
            try:
                os.kill(number, signal.SIGKILL)
            except OSError:
                pass
        process.kill()
        process.wait()

    def worker(self, port):
        """Starts a worker, which does not have the batch's package."""
        return self.dask("dask_worker", f"tcp://127.0.0.1:{port}", "--nthreads", "1", "--no-nanny",
                         "--memory-limit", "0")

    def test_a_scheduler_is_restarted(self):
        for number in range(6):
            self.view(f"{number}.pcd", sleep=0.5)
        port = free_port()
        scheduler, worker = self.dask("dask_scheduler", "--port", port, "--host", "127.0.0.1"), self.worker(port)
        batch = self.start("--scheduler", f"127.0.0.1:{port}", self.inputs, self.output)
        wait_for(lambda: len(self.calls()) >= 2, "items are being done")
        scheduler.kill()
        scheduler.wait()
        worker.kill()
        self.dask("dask_scheduler", "--port", port, "--host", "127.0.0.1")
        self.worker(port)
        printed, errors = batch.communicate(timeout=60)
        self.assertEqual(batch.returncode, 0, errors)
        self.assertIn("trying to connect again", errors)
        self.assertIn("6 of 6 items done", printed)
        times = collections.Counter(self.called())
        self.assertEqual(len(times), 6)
        self.assertLessEqual(sum(times.values()), 7)  # the one that was being done may be done again
        self.assertTrue(all(row["attempts"] == 1 for row in self.summary().values()))
        # The same workers, and a batch that is asked to end.
        self.view("slow.pcd", sleep=100)
        batch = self.start("--scheduler", f"127.0.0.1:{port}", self.inputs, self.output)
        wait_for(lambda: "slow.pcd" in self.called(), "the slow item begins")
        batch.terminate()
        self.assertEqual(batch.wait(timeout=30), 143)
        wait_for(lambda: not is_alive(self.calls()[-1]["pid"]), "the program elsewhere ends", 5)
        # And one that is killed.
        batch = self.start("--scheduler", f"127.0.0.1:{port}", self.inputs, self.output)
        wait_for(lambda: self.called().count("slow.pcd") == 2, "the slow item begins again")
        batch.kill()
        wait_for(lambda: not is_alive(self.calls()[-1]["pid"]), "the program elsewhere ends", 20)

    def test_no_scheduler_and_no_workers(self):
        self.view("a.pcd")
        port = free_port()
        _, errors = self.batch("--scheduler", f"127.0.0.1:{port}", "--wait", "1", self.inputs, self.output, status=1)
        self.assertIn("there is no scheduler", errors.splitlines()[-1])
        self.dask("dask_scheduler", "--port", port, "--host", "127.0.0.1")
        _, errors = self.batch("--scheduler", f"127.0.0.1:{port}", "--wait", "3", self.inputs, self.output, status=1)
        self.assertIn("no worker came in 3 s", errors.splitlines()[-1])

    def test_slurm(self):
        for name, text in (("sbatch", SBATCH), ("scancel", SCANCEL), ("squeue", SQUEUE)):
            (self.bin / name).write_text(text)
            (self.bin / name).chmod(stat.S_IRWXU)
        self.addCleanup(self.end_jobs)
        for number in range(4):
            self.view(f"{number}.pcd", sleep=1.0)
        batch = self.start("--slurm", "--workers", "2", "--slurm-partition", "short", "--slurm-options", "--account=me",
                           "--listen", "127.0.0.1", self.inputs, self.output)
        wait_for(lambda: len(self.calls()) >= 3, "items are being done")
        for line in (self.bin / "jobs").read_text().splitlines():
            os.killpg(int(line), signal.SIGKILL)  # the job's time is over
        printed, errors = batch.communicate(timeout=60)
        self.assertEqual(batch.returncode, 0, errors)
        self.assertIn("4 of 4 items done", printed)
        self.assertEqual((self.bin / "submitted").read_text(), "--parsable --account=me\n" * 2)
        self.assertTrue((self.bin / "cancelled").exists())
        jobs = [int(line) for line in (self.bin / "jobs").read_text().splitlines()]
        wait_for(lambda: not any(map(is_alive, jobs)), "the workers end", 10)
        self.assertLessEqual(len(self.calls()), 6)

    def end_jobs(self):
        for line in (self.bin / "jobs").read_text().splitlines():
            try:
                os.killpg(int(line), signal.SIGKILL)
            except OSError:
                pass

    def environment(self):
        """Slurm's commands are found, and looked at often."""
        return {**super().environment(), "PATH": f"{self.bin}:{os.environ['PATH']}",
                "PCL_COSECTION_BATCH_SLURM_LOOK_S": "1"}

    def test_missing_packages_and_programs(self):
        self.view("a.pcd")
        hidden = self.folder / "hidden"
        hidden.mkdir()
        (hidden / "sitecustomize.py").write_text(
            "import importlib.util\nfind = importlib.util.find_spec\n"
            "importlib.util.find_spec = lambda name, *more: None if name in ('asyncssh',) else find(name, *more)\n")
        from batch_stand_in import COMMAND
        environment = self.environment()
        environment["PYTHONPATH"] += f":{hidden}"
        ended = subprocess.run([*COMMAND, "--programs", self.bin, "--ssh", "host", self.inputs, self.output],
                               capture_output=True, text=True, env=environment, check=False)
        self.assertEqual(ended.returncode, 1)
        self.assertIn("--ssh needs the Python package asyncssh, which is not installed (Debian: python3-asyncssh)",
                      ended.stderr.splitlines()[-1])
        _, errors = self.batch("--slurm", "--listen", "127.0.0.1", self.inputs, self.output, status=1)
        self.assertIn("sbatch: cannot be run", errors.splitlines()[-1])

    def test_another_version_elsewhere(self):
        """Results of another version of the program do not come into a batch."""
        self.view("a.pcd")
        text = (self.bin / "pcl_cosection").read_text()
        (self.bin / "pcl_cosection").write_text(text.replace('"stand-in "', '"%f " % time.time()'))
        self.batch(self.inputs, self.output, status=1)
        self.assertRegex(self.summary()["a"]["reason"], "pcl_cosection on .* is .*, not ")


class Guard(BatchTest):
    """The process that watches a program, alone."""

    def test_nothing_is_left(self):
        """A program whose children leave its group, and that ignores signals, ends when the guard's input does."""
        from batch_stand_in import SOURCE
        script = self.folder / "program"
        script.write_text("#!/bin/sh\ntrap '' TERM INT HUP\n"
                          "setsid sh -c 'echo $$ >> pids; setsid sleep 200 & sleep 200' &\n"
                          "echo $$ >> pids\nwhile true; do sleep 1; done\n")
        script.chmod(stat.S_IRWXU)
        guard = subprocess.Popen([sys.executable, SOURCE / "python" / "pcl_cosection_batch" / "guard.py"],
                                 stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        guard.stdin.write(json.dumps({"command": [str(script)], "log": str(self.folder / "log"),
                                      "folder": str(self.folder),
                                      "environment": {}}).encode() + b"\n")
        guard.stdin.flush()
        pids = self.folder / "pids"
        wait_for(lambda: pids.exists() and len(pids.read_text().split()) == 2, "the program runs")
        time.sleep(0.2)
        processes = [process for process, _ in descendants(guard.pid)]
        self.assertGreaterEqual(len(processes), 4)
        printed, _ = guard.communicate(timeout=10)  # closes its input
        self.assertEqual(json.loads(printed)["how"], "stopped")
        self.assertFalse([process for process in processes if is_alive(process)])


if __name__ == "__main__":
    unittest.main()
