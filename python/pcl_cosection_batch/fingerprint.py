# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""What a result depends on, as one short text: if it is the same, the item is not done again."""
import hashlib
import json
import os
from typing import Iterator

from pcl_cosection_batch.items import Item


def files_below(path: str, left_out: str) -> Iterator[str]:
    """A file, or all files in a folder and the folders in it but for OUTPUT."""
    if not os.path.isdir(path):
        yield path
        return
    for folder, folders, names in os.walk(path):
        folders[:] = sorted(name for name in folders if os.path.realpath(os.path.join(folder, name)) != left_out)
        for name in sorted(names):
            yield os.path.join(folder, name)


def states_of(path: str, left_out: str) -> list[tuple[str, int, int]]:
    """Name, size and time of change of each file of an input."""
    states = []
    for file in files_below(path, left_out):
        try:
            state = os.stat(file)
        except OSError:
            states.append((os.path.relpath(file, path), -1, -1))
            continue
        states.append((os.path.relpath(file, path), state.st_size, state.st_mtime_ns))
    return states


def paths_in(options: tuple[str, ...]) -> list[str]:
    """The files and folders that options name: --masks DIR, --object-trajectory 1=FILE."""
    found = []
    for option in options:
        for word in (option, *option.split("=")[1:], option.rpartition("=")[2]):
            if os.path.exists(word) and word not in found and word not in (".", "..", "/"):
                found.append(word)
    return found


def fingerprint(item: Item, options: tuple[str, ...], given_options: tuple[str, ...], version: str, output: str) -> str:
    """A hash of the program's version, the options and the state of all files.

    GIVEN_OPTIONS are as the user wrote them, OPTIONS have the item's paths in place. Folders that hold the inputs
    do not count: inputs may be moved.
    """
    left_out = os.path.realpath(output)
    inputs = [(os.path.basename(path), states_of(path, left_out)) for path in item.inputs]
    named = [(os.path.basename(path), states_of(path, left_out)) for path in paths_in(options)]
    content = json.dumps([item.kind, version, given_options, inputs, named])
    return hashlib.sha256(content.encode()).hexdigest()
