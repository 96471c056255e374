# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""What lies in OUTPUT, and how it gets there: a result appears by one renaming, with all that is known of it.

    OUTPUT/NAME/                  a result: the program's files, its pictures, log.txt, batch.json
    OUTPUT/.batch/failed/NAME/    why an item failed: batch.json, log.txt
    OUTPUT/.batch/staging/RUN/    what is being made
    OUTPUT/.batch/names.json      which name belongs to which input
    OUTPUT/.batch/lock            locked while a batch writes
"""
import json
import os
import shutil
import tempfile
import uuid
from typing import Any

from pcl_cosection_batch.errors import BatchError
from pcl_cosection_batch.items import STATE_FILE, STATE_FOLDER

COMPLETE = ("done", "partial")  # the statuses of items that have a result
WRONG_USAGE = 2  # exit status of programs
Record = dict[str, Any]  # what is known of an item that was run; the content of batch.json


def write_atomically(path: str, data: bytes) -> None:
    """Writes a file under another name first: PATH is complete or as it was, also after a crash of the machine."""
    folder, name = os.path.split(path)
    handle, temporary = tempfile.mkstemp(prefix="." + name[:50] + ".", dir=folder)
    try:
        with os.fdopen(handle, "wb") as file:
            os.fchmod(file.fileno(), 0o644)
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        os.replace(temporary, path)
    except BaseException:
        os.unlink(temporary)
        raise


def write_json(path: str, content: Any) -> None:
    """Writes JSON that holds any name of a file."""
    write_atomically(path, (json.dumps(content, indent=1) + "\n").encode("ascii"))


def read_json(path: str) -> dict[str, Any]:
    """The object in a JSON file; an empty one if there is no such file, or if it is damaged."""
    try:
        with open(path, "rb") as file:
            content = json.loads(file.read())
    except (OSError, ValueError, RecursionError):
        return {}
    return content if isinstance(content, dict) else {}


class Store:
    """The folder OUTPUT."""

    def __init__(self, output: str) -> None:
        self.output = os.path.abspath(output)
        self.state = os.path.join(self.output, STATE_FOLDER)

    def path(self, *parts: str) -> str:
        """A path in the folder .batch."""
        return os.path.join(self.state, *parts)

    def result(self, name: str) -> str:
        """The folder of a result."""
        return os.path.join(self.output, name)

    def create(self) -> None:
        """Makes the folders."""
        try:
            for folder in ("failed", "staging", "stop", "trash"):
                os.makedirs(self.path(folder), exist_ok=True)
        except OSError as error:
            raise BatchError(f"{error.filename}: cannot be created: {error.strerror}") from None

    # --- names ---------------------------------------------------------------------------------------------------

    def load_names(self) -> dict[str, str]:
        """Names of earlier batches: source and name."""
        entries = read_json(self.path("names.json")).items()
        return {source: name for source, name in entries if isinstance(name, str)}

    def save_names(self, names: dict[str, str]) -> None:
        """Writes the names, if they have changed."""
        if names != self.load_names():
            write_json(self.path("names.json"), names)

    # --- what is known of items ----------------------------------------------------------------------------------

    def done(self, name: str) -> Record:
        """What is known of a result; empty if there is no complete one."""
        return read_json(os.path.join(self.result(name), STATE_FILE))

    def failure(self, name: str) -> Record:
        """Why an item failed when it was run last; empty if it did not."""
        return read_json(self.path("failed", name, STATE_FILE))

    def is_foreign(self, name: str) -> bool:
        """Whether something is in the place of a result that no batch has put there, other than an empty folder."""
        place = self.result(name)
        if not os.path.lexists(place) or self.done(name):
            return False
        return os.path.islink(place) or not os.path.isdir(place) or bool(os.listdir(place))

    # --- writing -------------------------------------------------------------------------------------------------

    def new_staging(self, run: str) -> str:
        """A new folder for one attempt."""
        folder = self.path("staging", run)
        os.makedirs(folder, exist_ok=True)
        return tempfile.mkdtemp(dir=folder)

    def commit_done(self, made: str, record: Record, replace: bool) -> Record:
        """Makes the folder MADE the result of an item. One that is there of the same inputs stays, unless REPLACE.
        Returns what is known of the result that is there then."""
        name, key = record["name"], "" if replace else record["key"]
        write_json(os.path.join(made, STATE_FILE), record)
        self._publish(made, self.result(name), key)
        self._remove(self.path("failed", name))
        return self.done(name) or record

    def commit_failed(self, made: str, record: Record) -> Record:
        """Makes the folder MADE the reason of a failure. An older result of other inputs goes, unless the options are
        wrong, so that nothing was tried."""
        name = record["name"]
        write_json(os.path.join(made, STATE_FILE), record)
        self._publish(made, self.path("failed", name), "")
        if self.done(name) and record.get("exit_status") != WRONG_USAGE:
            self._remove(self.result(name))
        return record

    def adopt_complete(self) -> int:
        """Moves results to their places that a killed batch had completed, but not moved. Returns how many."""
        adopted = 0
        for folder, folders, names in os.walk(self.path("staging")):
            record = read_json(os.path.join(folder, STATE_FILE)) if STATE_FILE in names else {}
            if record.get("status") in COMPLETE and self._is_newer(record):
                self._publish(folder, self.result(record["name"]), record["key"])
                adopted += 1
                folders.clear()
        return adopted

    def _is_newer(self, record: Record) -> bool:
        """Whether a result that was completed may take its place."""
        name = record["name"]
        return not self.is_foreign(name) and str(self.done(name).get("finished", "")) < str(record["finished"])

    def clear_staging(self, run: str = "") -> None:
        """Removes what was not completed: of one run, or of all."""
        if run:
            self._remove(self.path("staging", run))
            return
        for folder in ("staging", "stop", "trash"):
            for entry in os.listdir(self.path(folder)):
                self._remove(self.path(folder, entry))

    def _publish(self, made: str, place: str, key: str) -> None:
        """Renames MADE to PLACE. A result of the same KEY that is there stays; another one is replaced."""
        for _ in range(100):
            try:
                os.rename(made, place)
                return
            except OSError:
                if not os.path.lexists(place):
                    raise
            if key and read_json(os.path.join(place, STATE_FILE)).get("key") == key:
                self._remove(made)
                return
            self._remove(place)
        raise BatchError(f"{place}: something else is put there again and again")

    def _remove(self, path: str) -> None:
        """Removes a file or a folder at one blow: it is moved away first."""
        trash = self.path("trash", uuid.uuid4().hex)
        try:
            os.rename(path, trash)
        except FileNotFoundError:
            return
        if os.path.isdir(trash):
            shutil.rmtree(trash, ignore_errors=True)
        else:
            os.unlink(trash)
