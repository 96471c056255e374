# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""The program pcl_cosection_batch."""
import concurrent.futures
import dataclasses
import os
import signal
import sys
import threading
import time
import uuid

from pcl_cosection_batch import clusters, measures
from pcl_cosection_batch.arguments import PROGRAM, Arguments, parse_arguments
from pcl_cosection_batch.errors import BatchError, Stopped, UsageError
from pcl_cosection_batch.fingerprint import fingerprint
from pcl_cosection_batch.items import SEQUENCE, Finder, Item, is_result
from pcl_cosection_batch.list_file import read_list
from pcl_cosection_batch.lock import OutputLock
from pcl_cosection_batch.names import assign_names
from pcl_cosection_batch.overview import write_overview
from pcl_cosection_batch.programs import NAME_OF, find_program, item_options, version_of
from pcl_cosection_batch.run_item import Task, failed, new_record, now
from pcl_cosection_batch.schedule import Schedule, Signals
from pcl_cosection_batch.sequence_layout import is_view
from pcl_cosection_batch.store import Record, Store
from pcl_cosection_batch.tables import write_tables
from pcl_cosection_batch.terminal import Progress, Terminal, counted

STOP_TIMEOUT_S = 10.0


def find_items(arguments: Arguments) -> list[Item]:
    """All items of the INPUTs, each once. Raises UsageError."""
    finder = Finder(arguments.subfolders == "views", {os.path.realpath(arguments.output)})
    for path in arguments.inputs:
        if os.path.isfile(path) and not is_view(path):
            finder.items += read_list(path)
        else:
            finder.add_input(path)
    items: dict[str, Item] = {}
    for item in finder.items:
        if items.setdefault(item.source, item).options != item.options:
            raise UsageError(f"{' '.join(item.inputs)}: is there twice, with different options; "
                             "name them in the list, as in 'cup: cup.pcd -- --resolution 32'")
    return list(items.values())


def own_folder() -> str:
    """Where this program is, and so the others may be."""
    return os.path.dirname(os.path.realpath(sys.argv[0])) if sys.argv and sys.argv[0] else ""


class Batch:
    """All tasks of one call."""

    def __init__(self, arguments: Arguments, terminal: Terminal) -> None:
        self.arguments = arguments
        self.terminal = terminal
        self.store = Store(arguments.output)
        if is_result(arguments.output) and not os.path.isdir(self.store.state):
            raise UsageError(f"{arguments.output}: has what a program wrote, which would be lost; give another OUTPUT")
        self.items = find_items(arguments)
        self.run_id = uuid.uuid4().hex[:12]
        kinds = sorted({item.kind for item in self.items})
        self.programs = {kind: find_program(NAME_OF[kind], arguments.programs, own_folder()) for kind in kinds}
        self.records: dict[str, Record] = {}  # of this call
        self.tasks: list[Task] = []
        self.signals = Signals()

    def make_tasks(self, names: dict[str, str]) -> None:
        """Decides what each item is: program, options, fingerprint."""
        for item in self.items:
            name = names[item.source]
            kind_options = self.arguments.fusion_options if item.kind == SEQUENCE else self.arguments.options
            given = (*kind_options, *self.arguments.more_options, *item.options)
            options = item_options(item, given, name)
            program = self.programs[item.kind]
            version = version_of(program)
            key = fingerprint(item, options, given, version, self.store.output)
            task = Task(
                output=self.store.output, run=self.run_id, name=name, kind=item.kind, inputs=item.inputs,
                options=options, key=key, program=program, version=version, folder=os.getcwd(), threads=0, sharers=1,
                time_limit_s=self.arguments.time_limit, memory_limit=self.arguments.memory_limit, attempt=1,
                redo=self.arguments.force)
            self.tasks.append(task)
            if item.problem:
                self.records[name] = failed(new_record(task), item.problem)

    def chosen(self) -> list[Task]:
        """The tasks that this call is about. Raises UsageError."""
        unknown = [name for name in self.arguments.only if all(task.name != name for task in self.tasks)]
        if unknown:
            raise UsageError(f"--only {unknown[0]}: there is no such item; --dry-run shows their names")
        tasks = [task for task in self.tasks if not self.arguments.only or task.name in self.arguments.only]
        part, whole = self.arguments.share
        return tasks[part - 1::whole]

    def is_done(self, task: Task) -> bool:
        """Whether a result is there that another call would make again."""
        return self.store.done(task.name).get("key") == task.key

    def work(self, tasks: list[Task]) -> None:
        """Does what is not done. Raises Stopped, BatchError."""
        self.store.adopt_complete()
        todo = [task for task in tasks if task.name not in self.records and
                (self.arguments.force or not self.is_done(task))]
        problems = sum(task.name in self.records for task in tasks)
        progress = Progress(len(tasks), len(tasks) - len(todo) - problems)
        progress.failed = problems
        for task in tasks:
            if task.name in self.records:
                self.terminal.result(f"{task.name}: failed: {self.records[task.name]['reason']}")
        self.terminal.note(f"{counted(len(tasks), 'item')}: {progress.done} done before, {len(todo)} to do")
        if not todo:
            return
        threads, sharers = clusters.threads_of_programs(self.arguments, len(todo))
        cluster = self._open_cluster(len(todo))
        schedule = Schedule(cluster, self.store, self.arguments.retries, self.arguments.wait, self.terminal, progress,
                            self.signals)
        try:
            schedule.run([dataclasses.replace(task, threads=threads, sharers=sharers) for task in todo])
        except Stopped:
            self._stop_workers(schedule)
            raise
        finally:
            self.records.update(schedule.records)
            cluster.close()
            self.terminal.finish()
            self.store.clear_staging(self.run_id)

    def _open_cluster(self, items: int) -> clusters.Cluster:
        """Starts the cluster in a thread, so that signals interrupt this. Raises Stopped, BatchError."""
        clusters.configure(self.arguments.verbose)
        folder = self.store.path("staging", self.run_id, "cluster")
        opened: concurrent.futures.Future[clusters.Cluster] = concurrent.futures.Future()

        def start() -> None:
            # Signals from the terminal are for this process. The cluster's processes inherit what is blocked.
            signal.pthread_sigmask(signal.SIG_BLOCK, (signal.SIGINT, signal.SIGHUP))
            try:
                opened.set_result(clusters.open_cluster(self.arguments, items, folder, self.terminal))
            except BaseException as error:
                opened.set_exception(error)

        threading.Thread(target=start, daemon=True).start()
        while not opened.done():
            concurrent.futures.wait([opened], timeout=0.1)
            self.signals.check()
        return opened.result()

    def _stop_workers(self, schedule: Schedule) -> None:
        """Asks workers elsewhere to end their programs, and gives them time to do so."""
        with open(self.store.path("stop", self.run_id), "wb"):
            pass
        if not self.arguments.is_local:
            time.sleep(1.0)

    def collected(self) -> list[Record]:
        """What is known of each item, in the order of the INPUTs."""
        return [self.records.get(task.name) or self._known(task) for task in self.tasks]

    def _known(self, task: Task) -> Record:
        done = self.store.done(task.name)
        if done:
            return done if done.get("key") == task.key else {**done, "status": "outdated",
                                                             "reason": "made of other inputs or options"}
        failure = self.store.failure(task.name)
        return failure or {**new_record(task), **measures.nothing(), "status": "missing", "attempts": 0}


def run_batch(arguments: Arguments, terminal: Terminal) -> int:
    """Does the batch. Returns the exit status."""
    batch = Batch(arguments, terminal)
    store = batch.store
    if arguments.dry_run:
        batch.make_tasks(assign_names(batch.items, store.load_names()))
        for task in batch.chosen():
            inputs = " ".join(task.inputs)
            problem = batch.records.get(task.name, {}).get("reason")
            terminal.result(f"{task.name}: {os.path.basename(task.program)} {inputs}" +
                            (f" (failed: {problem})" if problem else " (done)" if batch.is_done(task) else ""))
        return 0
    store.create()
    with OutputLock(arguments.output, store.path("lock")) as lock:
        return locked_batch(batch, lock)


def locked_batch(batch: Batch, lock: OutputLock) -> int:
    """Does the batch, when nobody else works on its items."""
    arguments, store, terminal = batch.arguments, batch.store, batch.terminal
    if not arguments.is_part:
        lock.lock_all()
    lock.lock_names()
    names = assign_names(batch.items, store.load_names())
    store.save_names(names)
    lock.unlock_names()
    batch.make_tasks(names)
    tasks = batch.chosen()
    if arguments.is_part:
        for task in tasks:
            lock.lock_item(task.name)
    stopped = None
    if not arguments.collect:
        if not arguments.is_part:
            store.adopt_complete()
            store.clear_staging()
        try:
            batch.work(tasks)
        except Stopped as error:
            stopped = error
    records = {record["name"]: record for record in batch.collected()}
    if not arguments.is_part:
        write_tables(store, list(records.values()))
        write_overview(store, list(records.values()), now())
    done = sum(records[task.name]["status"] == "done" for task in tasks)
    if stopped:
        raise Stopped(stopped.signal_number)
    terminal.result(f"{done} of {counted(len(tasks), 'item')} done" +
                    ("" if arguments.is_part else f"; wrote {os.path.join(arguments.output, 'index.html')}"))
    return 0 if done == len(tasks) and not terminal.is_broken else 1


def require_current_folder() -> None:
    """Raises UsageError if there is none: paths are relative to it, and items run in it."""
    try:
        os.getcwd()
    except OSError as error:
        raise UsageError("the current folder was removed; change to another one") from error


def main(argv: list[str]) -> int:
    """The program. Returns the exit status."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)  # until there is something to bring to an end
    terminal = Terminal(quiet=False, verbose=False)
    try:
        arguments, parser, asked = parse_arguments(argv)
        terminal = Terminal(arguments.quiet, arguments.verbose)
        if asked == "help":
            print(parser.format_help(), end="", flush=True)
            return 0
        if asked == "version":
            print(f"{PROGRAM} of {version_of(find_program('pcl_cosection', arguments.programs, own_folder()))}",
                  flush=True)
            return 0
        require_current_folder()
        return run_batch(arguments, terminal)
    except UsageError as error:
        terminal.error(str(error))
        return 2
    except BatchError as error:
        terminal.error(str(error))
    except OSError as error:
        terminal.error(f"{error.filename}: {error.strerror}" if error.filename else str(error.strerror))
    except Stopped as stopped:
        terminal.error("interrupted; what is done stays, and the same command goes on from there")
        sys.stdout.flush()
        os._exit(128 + stopped.signal_number)  # a cluster that was just being started is not waited for
    return 1
