# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""What a worker does: runs a program for one item, and puts the result in its place."""
import datetime
import importlib.util
import json
import os
import re
import select
import shutil
import signal
import subprocess
import sys
from dataclasses import dataclass
from typing import Any, Callable

from pcl_cosection_batch import measures, pictures
from pcl_cosection_batch.errors import BatchError
from pcl_cosection_batch.programs import command_line, on_this_host
from pcl_cosection_batch.store import COMPLETE, Record, Store

POLL_S = 0.1
LOG_TAIL_BYTES = 65536
INTERRUPTED = 130


@dataclass(frozen=True)
class Task:
    """All that a worker has to know."""

    output: str
    run: str  # of which batch
    name: str
    kind: str
    inputs: tuple[str, ...]
    options: tuple[str, ...]
    key: str  # fingerprint
    program: str
    version: str
    folder: str  # the current one
    threads: int  # 0: a share of the host's cores
    sharers: int  # how many workers share them
    time_limit_s: float
    memory_limit: int
    attempt: int
    redo: bool  # even if it is done


def now() -> str:
    """The time, as it is written to files."""
    return datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="milliseconds")


def run_item(task: Task) -> Record:
    """Runs one item. Returns what is known of it; "again" says whether another attempt may help."""
    store = Store(task.output)
    record = new_record(task)
    there = store.done(task.name)
    if there.get("key") == task.key and not (task.redo and there.get("run") != task.run):
        return there  # by an attempt whose end nobody heard of
    try:
        staging = store.new_staging(task.run)
    except OSError as error:
        return failed(record, f"{task.output}: cannot be written: {error.strerror}")
    try:
        return attempt(task, store, record, staging)
    except OSError as error:
        return failed(record, f"{error.filename or task.output}: cannot be written: {error.strerror}")
    except BatchError as error:
        return failed(record, str(error))
    finally:
        shutil.rmtree(staging, ignore_errors=True)


def new_record(task: Task) -> Record:
    """What is known before."""
    return {
        "name": task.name, "kind": task.kind, "inputs": list(task.inputs), "options": list(task.options),
        "key": task.key, "run": task.run, "status": "failed", "reason": "", "again": False, "attempts": task.attempt,
        "program": os.path.basename(task.program), "version": task.version, "host": os.uname().nodename,
        "started": now(), "finished": now(), "seconds": 0.0, "cpu_seconds": 0.0, "peak_memory_bytes": 0,
        "exit_status": None, **measures.nothing()}


def failed(record: Record, reason: str, again: bool = False) -> Record:
    """The record of a failure."""
    return {**record, "status": "failed", "reason": reason, "again": again, "finished": now()}


def attempt(task: Task, store: Store, record: Record, staging: str) -> Record:
    """Runs the program in a staging folder, and commits what comes out."""
    made = os.path.join(staging, "result")
    log = os.path.join(staging, "log.txt")
    threads = task.threads or share_of_cores(task.sharers)
    program = on_this_host(task.program, task.version)
    working_folder = task.folder if os.path.isdir(task.folder) else "/"
    spec = {
        "command": command_line(program, task.inputs, task.options, threads, made), "log": log,
        "folder": working_folder,
        "environment": {"OMP_NUM_THREADS": str(threads), "OMP_WAIT_POLICY": "passive"},
        "time_limit_s": task.time_limit_s, "memory_limit": task.memory_limit}
    ended = guarded(spec, watch_for_stop(store, task.run))
    if ended["how"] == "stopped":
        return {**failed(record, "stopped"), "status": "stopped"}
    hide_staging(log, made, store.result(task.name))
    for value in ("seconds", "cpu_seconds", "peak_memory_bytes", "exit_status"):
        record[value] = ended.get(value, record[value])
    record.update(measures.of_result(made))
    record.update(verdict(task, ended, record, log))
    record["finished"] = now()
    if record["status"] in COMPLETE and store.is_foreign(task.name):
        record = failed(record, f"{store.result(task.name)}: is there already, and no batch has written it")
    if record["status"] not in COMPLETE:
        reasons = os.path.join(staging, "reason")
        os.mkdir(reasons)
        os.rename(log, os.path.join(reasons, "log.txt"))
        return store.commit_failed(reasons, record)
    record["pictures"], remarks = pictures.draw_result(program, made, staging, working_folder)
    record["notes"] = [*(record.get("notes") or []), *remarks]
    os.rename(log, os.path.join(made, "log.txt"))
    return store.commit_done(made, record, replace=task.redo)


def verdict(task: Task, ended: dict[str, Any], record: Record, log: str) -> dict[str, Any]:
    """Status and reason of an item, and whether another attempt may help."""
    how, status = ended["how"], ended.get("exit_status")
    if how == "not started":
        return {"status": "failed", "reason": ended["reason"], "again": False}
    if how == "lost":
        return {"status": "failed", "reason": "the process that watches the program was lost", "again": True}
    if how == "time":
        return {"status": "failed", "reason": f"took longer than {task.time_limit_s:g} s", "again": True}
    if how == "memory":
        used, limit = (f"{value / 2**20:.0f} MiB" for value in (record["peak_memory_bytes"], task.memory_limit))
        return {"status": "failed", "reason": f"needed {used} of memory, more than {limit}", "again": False}
    if status is not None and status < 0:
        return {"status": "failed", "reason": f"ended by signal {-status} ({signal_name(-status)})", "again": True}
    said = last_message(log) or f"exit status {status}"
    if status == INTERRUPTED:
        return {"status": "failed", "reason": said, "again": True}
    if status == 0 and not record["summary"]:
        return {"status": "failed", "reason": "the program wrote no summary.json", "again": False}
    if status == 0:
        return {"status": "done", "reason": "", "again": False}
    if status == 1 and record["objects"] and record["objects_failed"]:
        return {"status": "partial", "reason": record["first_failure"] or said, "again": False}
    return {"status": "failed", "reason": said, "again": False}


def signal_name(number: int) -> str:
    """What a signal means, such as Segmentation fault."""
    try:
        return signal.strsignal(number) or "unknown"
    except ValueError:
        return "unknown"


def last_message(log: str) -> str:
    """The last line of a log that is no warning, without the name of the program."""
    with open(log, "rb") as file:
        file.seek(max(0, os.path.getsize(log) - LOG_TAIL_BYTES))
        lines = file.read().decode(errors="replace").splitlines()
    lines = [line.strip() for line in lines if line.strip() and not re.match(r"[\w-]+: warning: ", line)]
    errors = [line for line in lines if re.match(r"pcl_cosection\w*: ", line)]
    return re.sub(r"^pcl_cosection\w*: (error: )?", "", (errors or lines or [""])[-1])[:1000]


def hide_staging(log: str, made: str, place: str) -> None:
    """Names the place of the result in the log, not that where it was made."""
    with open(log, "rb") as file:
        data = file.read()
    named = data.replace(os.fsencode(made), os.fsencode(place))
    if named != data:
        with open(log, "wb") as file:
            file.write(named)


def watch_for_stop(store: Store, run: str) -> Callable[[], bool]:
    """A function that says whether the batch still wants the result: it is asked to stop by a file, or its connection
    to the scheduler ends."""
    try:
        from distributed import get_worker

        worker = get_worker()
        key = worker.get_current_task()
    except (ImportError, ValueError, KeyError, AttributeError):
        worker, key = None, ""
    stop = store.path("stop", run)

    def wanted() -> bool:
        if os.path.exists(stop):
            return False
        if worker is None:
            return True
        state = worker.state.tasks.get(key)
        return state is not None and state.state != "cancelled"

    return wanted


def share_of_cores(sharers: int) -> int:
    """The threads for one program, if the batch does not say: the host's cores, shared by its workers."""
    return max(1, len(os.sched_getaffinity(0)) // sharers)


def guard_command() -> list[str]:
    """How to start the guard: its text, as this package may be in an archive."""
    spec = importlib.util.find_spec("pcl_cosection_batch.guard")
    assert spec is not None and spec.loader is not None
    if spec.origin and os.path.isfile(spec.origin):
        return [sys.executable, "-I", spec.origin]
    source = spec.loader.get_source("pcl_cosection_batch.guard")  # type: ignore[attr-defined]
    return [sys.executable, "-I", "-c", source]


def guarded(spec: dict[str, Any], wanted: Callable[[], bool]) -> dict[str, Any]:
    """Runs a program under the guard, until it ends or is no longer wanted. Returns what the guard says."""
    with subprocess.Popen(guard_command(), stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                          start_new_session=True) as guard:
        assert guard.stdin is not None and guard.stdout is not None
        try:
            guard.stdin.write(json.dumps(spec).encode() + b"\n")
            guard.stdin.flush()
            while not select.select([guard.stdout], [], [], POLL_S)[0] and wanted():
                pass
        except BrokenPipeError:
            pass
        finally:
            try:
                guard.stdin.close()
            except BrokenPipeError:
                pass
        lines = guard.stdout.read().splitlines()
    try:
        result = json.loads(lines[-1])
    except (IndexError, ValueError):
        return {"how": "lost"}
    return result if isinstance(result, dict) else {"how": "lost"}
