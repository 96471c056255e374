# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""Runs one program, and ends it with all its children: when it takes too long, needs too much memory, or when whoever
waits for it has gone.

This file runs as a process of its own, with nothing but the standard library. The first line of standard input is a
JSON object with what to run. When standard input ends, the program is killed. The last line of standard output is a
JSON object with what happened.
"""
import ctypes
import json
import os
import select
import signal
import subprocess
import sys
import time
from typing import Any, Iterator

PR_SET_PDEATHSIG = 1
PR_SET_CHILD_SUBREAPER = 36
SHORT_INTERVAL_S = 0.02
LONG_INTERVAL_S = 0.05
PAGE_BYTES = os.sysconf("SC_PAGE_SIZE")


def control_process(what: int, value: int) -> None:
    """The system's prctl."""
    ctypes.CDLL(None, use_errno=True).prctl(what, value, 0, 0, 0)


def children_of(process: int) -> list[int]:
    """The processes that a process has started and that have not been waited for."""
    found: list[int] = []
    try:
        for thread in os.listdir(f"/proc/{process}/task"):
            with open(f"/proc/{process}/task/{thread}/children", encoding="ascii") as file:
                found += [int(word) for word in file.read().split()]
    except (OSError, ValueError):
        pass  # it has ended meanwhile
    return found


def descendants(process: int) -> Iterator[int]:
    """All processes below a process. Those whose parent has ended belong to this process, as a subreaper."""
    waiting = children_of(process)
    while waiting:
        child = waiting.pop()
        yield child
        waiting += children_of(child)


def resident_bytes(process: int) -> int:
    """The memory that a process really has."""
    try:
        with open(f"/proc/{process}/statm", encoding="ascii") as file:
            return int(file.read().split()[1]) * PAGE_BYTES
    except (OSError, ValueError, IndexError):
        return 0


def kill_everything() -> None:
    """Kills all descendants, and those that they start meanwhile, until there is no process left."""
    while True:
        for process in list(descendants(os.getpid())):
            try:
                os.kill(process, signal.SIGKILL)
            except OSError:
                pass
        try:
            while os.waitpid(-1, os.WNOHANG)[0]:
                pass
        except ChildProcessError:
            return
        time.sleep(0.005)


class Watch:
    """The program that runs, and what is known of it."""

    def __init__(self, task: dict[str, Any]) -> None:
        self.time_limit_s = float(task.get("time_limit_s") or 0)
        self.memory_limit = int(task.get("memory_limit") or 0)
        self.peak_bytes = 0
        self.start = time.monotonic()
        guard = os.getpid()
        environment = {**os.environ, **task["environment"]}
        environment.pop("MALLOC_TRIM_THRESHOLD_", None)  # Dask sets it for its workers; it slows programs down

        def before_program() -> None:
            control_process(PR_SET_PDEATHSIG, signal.SIGKILL)
            for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
                signal.signal(number, signal.SIG_DFL)
            signal.pthread_sigmask(signal.SIG_SETMASK, ())
            if os.getppid() != guard:
                os._exit(127)

        with open(task["log"], "ab") as log:
            self.program = subprocess.Popen(
                task["command"], stdin=subprocess.DEVNULL, stdout=log, stderr=log, cwd=task["folder"],
                env=environment, start_new_session=True, preexec_fn=before_program)

    def reason_to_end(self) -> str:
        """Why the program must not go on; empty if it may."""
        used = sum(resident_bytes(process) for process in descendants(os.getpid()))
        self.peak_bytes = max(self.peak_bytes, used)
        if self.memory_limit and used > self.memory_limit:
            return "memory"
        if self.time_limit_s and time.monotonic() - self.start > self.time_limit_s:
            return "time"
        return ""

    def follow(self) -> dict[str, Any]:
        """Waits for the end of the program. Returns what happened."""
        interval = SHORT_INTERVAL_S
        reason = ""
        while not reason:
            process, status, usage = os.wait4(self.program.pid, os.WNOHANG)
            if process:
                return self._ended("exit", status, usage)
            if select.select([0], [], [], interval)[0] and not os.read(0, 4096):
                reason = "stopped"
            else:
                reason = self.reason_to_end()
            if time.monotonic() - self.start > 1:
                interval = LONG_INTERVAL_S
        os.kill(self.program.pid, signal.SIGKILL)
        _, status, usage = os.wait4(self.program.pid, 0)
        return self._ended(reason, status, usage)

    def _ended(self, how: str, status: int, usage: Any) -> dict[str, Any]:
        self.program.returncode = os.waitstatus_to_exitcode(status)  # so that nobody waits for it again
        return {
            "how": how,
            "exit_status": self.program.returncode,
            "seconds": round(time.monotonic() - self.start, 3),
            "cpu_seconds": round(usage.ru_utime + usage.ru_stime, 3),
            "peak_memory_bytes": max(self.peak_bytes, usage.ru_maxrss * 1024)}


def main() -> int:
    """Runs what standard input says."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_IGN)
    control_process(PR_SET_CHILD_SUBREAPER, 1)
    line = b""
    while not line.endswith(b"\n"):  # not by a buffered file, as select would not see what it holds
        data = os.read(0, 1 << 16)
        if not data:
            return 1
        line += data
    try:
        result = Watch(json.loads(line)).follow()
    except OSError as error:
        result = {"how": "not started", "reason": f"{error.filename}: {error.strerror}"}
    kill_everything()
    print(json.dumps(result), flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
