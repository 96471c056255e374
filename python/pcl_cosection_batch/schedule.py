# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""Hands the items to workers, and tries again what was lost on the way."""
import asyncio
import collections
import concurrent.futures
import dataclasses
import os
import signal
import threading
import time
import uuid
from types import FrameType
from typing import Any

from pcl_cosection_batch.clusters import Cluster, dashboard_of
from pcl_cosection_batch.errors import BatchError, Stopped
from pcl_cosection_batch.run_item import Task, failed, new_record, run_item
from pcl_cosection_batch.store import COMPLETE, Record, Store
from pcl_cosection_batch.terminal import Progress, Terminal, counted, duration_text

POLL_S = 0.1
LOOK_AT_WORKERS_S = 0.5
RECONNECT_S = 1.0
ANSWER_TIMEOUT_S = 30


class Signals:
    """Remembers the signal that asks the batch to end."""

    def __init__(self) -> None:
        self.number = 0
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, self._remember)

    def _remember(self, number: int, frame: FrameType | None) -> None:
        if self.number:
            os._exit(128 + number)  # the user insists
        self.number = number

    def check(self) -> None:
        """Throws Stopped, if there was a signal."""
        if self.number:
            raise Stopped(self.number)


class Schedule:
    """The tasks of a batch that are waiting and running."""

    def __init__(self, cluster: Cluster, store: Store, retries: int, patience_s: float, terminal: Terminal,
                 progress: Progress, signals: Signals) -> None:
        self.cluster = cluster
        self.store = store
        self.retries = retries
        self.patience_s = patience_s
        self.terminal = terminal
        self.progress = progress
        self.signals = signals
        self.waiting: collections.deque[Task] = collections.deque()
        self.running: list[tuple[Any, Task]] = []  # futures
        self.client: Any = None
        self.slots = 0
        self.looked = 0.0
        self.alive = time.monotonic()  # when there were workers last
        self.ended = threading.Event()  # set when a task has ended
        self.records: dict[str, Record] = {}

    def run(self, tasks: list[Task]) -> dict[str, Record]:
        """Does all tasks. Returns what became of them, by their names. Raises Stopped, BatchError."""
        self.waiting.extend(tasks)
        try:
            while self.waiting or self.running:
                self.signals.check()
                if self._is_connected():
                    self._count_workers()
                    self._collect()
                    self._submit()
                self.terminal.progress(self.progress.text())
                if self.ended.wait(POLL_S):
                    self.ended.clear()
        finally:
            self._disconnect()
        return self.records

    # --- the connection --------------------------------------------------------------------------------------------

    def _is_connected(self) -> bool:
        if self.client is not None and self.client.status == "running":
            return True
        if self.client is not None:
            self._disconnect()
            if not self.cluster.can_come_back:
                raise BatchError("the scheduler of this batch has ended; call the batch again")
            self.terminal.note(f"the connection to {self.cluster.address} is lost; trying to connect again")
            self.alive = time.monotonic()
        try:
            self.client = self.cluster.connect()
        except (OSError, TimeoutError) as error:
            if time.monotonic() - self.alive > self.patience_s:
                said = (str(error).splitlines() or ["no answer"])[0]
                raise BatchError(f"{self.cluster.address}: there is no scheduler: {said}") from None
            time.sleep(RECONNECT_S)
            return False
        dashboard = dashboard_of(self.client)
        if dashboard:
            self.terminal.note(f"dashboard: {dashboard}")
        self.alive = time.monotonic()
        return True

    def _disconnect(self) -> None:
        """Puts what was running back into the line."""
        self.waiting.extendleft(task for _, task in reversed(self.running))
        self.running.clear()
        if self.client is not None:
            try:
                self.client.close(timeout=2)
            except (OSError, TimeoutError):
                pass
            self.client = None
        self.slots = 0
        self.looked = 0.0

    def _count_workers(self) -> None:
        if time.monotonic() - self.looked < LOOK_AT_WORKERS_S:
            return
        self.looked = time.monotonic()
        try:
            workers = self.client.scheduler_info()["workers"].values()
        except (OSError, KeyError, TimeoutError):
            workers = ()
        slots = sum(int(worker["nthreads"]) for worker in workers)
        if slots:
            if not self.slots:
                self.terminal.detail(f"{counted(len(workers), 'worker')}, {counted(slots, 'item')} at a time")
            self.alive = time.monotonic()
        elif time.monotonic() - self.alive > self.patience_s and not self.cluster.waits_for_ever:
            raise BatchError(f"{self.cluster.address}: no worker came in {duration_text(self.patience_s)}")
        self.slots = slots
        self.cluster.look_after(len(workers))

    # --- the tasks -------------------------------------------------------------------------------------------------

    def _submit(self) -> None:
        while self.waiting and len(self.running) < self.slots:
            task = self.waiting.popleft()
            key = f"item-{task.attempt}-{uuid.uuid4().hex}"
            future = self.client.submit(run_item, task, key=key, pure=False, retries=0)
            future.add_done_callback(lambda _: self.ended.set())
            self.running.append((future, task))

    def _collect(self) -> None:
        ended = [(future, task) for future, task in self.running if future.done()]
        self.running = [(future, task) for future, task in self.running if not future.done()] if ended else self.running
        for future, task in ended:
            record = self._record_of(future, task)
            if record:
                self._finish(task, record)
            else:
                self.waiting.appendleft(task)  # the connection was lost
            future.release()

    def _record_of(self, future: Any, task: Task) -> Record:
        """What came of a task; nothing, if this cannot be known."""
        if future.status not in ("finished", "error"):
            return {}
        try:
            record: Record = future.result(timeout=ANSWER_TIMEOUT_S)
            return record
        except (concurrent.futures.CancelledError, asyncio.CancelledError, TimeoutError, OSError):
            return {}
        except Exception as error:  # of the task, or because its worker was lost with the result
            return self._record_of_error(task, error)

    def _record_of_error(self, task: Task, error: BaseException) -> Record:
        from distributed import KilledWorker

        if isinstance(error, KilledWorker):
            return failed(new_record(task), "the worker was lost", again=True)
        return failed(new_record(task), f"the worker cannot run items: {type(error).__name__}: {error}")

    def _finish(self, task: Task, record: Record) -> None:
        if record["status"] == "stopped":
            self.waiting.append(task)
            return
        if record.get("again") and task.attempt <= self.retries:
            self.terminal.note(f"{task.name}: {record['reason']}; attempt {task.attempt + 1} of {self.retries + 1}")
            self.waiting.append(dataclasses.replace(task, attempt=task.attempt + 1))
            return
        if record["status"] not in COMPLETE and not self.store.failure(task.name).get("run") == task.run:
            self._keep_failure(task, record)
        self.records[task.name] = record
        self.progress.add(record["status"] == "done")
        self._print(record)

    def _keep_failure(self, task: Task, record: Record) -> None:
        """Writes a failure that no worker could write."""
        try:
            self.store.commit_failed(self.store.new_staging(task.run), record)
        except (OSError, BatchError):
            pass  # it is in the summary

    def _print(self, record: Record) -> None:
        if record["status"] not in COMPLETE:
            self.terminal.result(f"{record['name']}: failed: {record['reason']}")
            return
        text = f"{record['name']}: {counted(record['objects'], 'object')}, {record['seconds']:.1f} s, "
        text += f"{record['peak_memory_bytes'] / 2**20:.0f} MiB"
        remarks = len(record["warnings"]) + len(record["notes"])
        if remarks:
            text += ", " + counted(remarks, "warning")
        if record["status"] == "partial":
            text += f", failed: {record['reason']}"
        self.terminal.result(text)
