# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""Finds the programs, and makes their command lines."""
import os
import re
import shutil
import subprocess
from functools import lru_cache

from pcl_cosection_batch.errors import BatchError, UsageError
from pcl_cosection_batch.items import SEQUENCE, Item

NAME_OF = {"views": "pcl_cosection", "sequence": "pcl_cosection_fusion"}
VERSION_TIMEOUT_S = 60


def find_program(name: str, folder: str, own_folder: str) -> str:
    """The path of a program: in FOLDER if one is given, else beside this one, else in PATH. Raises UsageError."""
    if folder:
        path = os.path.join(os.path.abspath(folder), name)
        if os.access(path, os.X_OK):
            return path
        raise UsageError(f"--programs {folder}: has no program {name}")
    path = os.path.join(own_folder, name)
    found = path if os.access(path, os.X_OK) else shutil.which(name)
    if not found:
        raise UsageError(f"there is no program {name} beside this one or in PATH; name its folder with --programs")
    return os.path.abspath(found)


@lru_cache
def version_of(program: str) -> str:
    """What a program says its version is. Raises BatchError."""
    try:
        run = subprocess.run([program, "--version"], stdin=subprocess.DEVNULL, capture_output=True, check=False,
                             timeout=VERSION_TIMEOUT_S)
    except (OSError, subprocess.TimeoutExpired) as error:
        raise BatchError(f"{program}: cannot be run: {getattr(error, 'strerror', None) or 'it does not end'}") from None
    lines = run.stdout.decode(errors="replace").splitlines()
    if run.returncode or not lines:
        said = run.stderr.decode(errors="replace").strip().splitlines()
        raise BatchError(f"{program}: cannot be run: " + (said[-1] if said else f"exit status {run.returncode}"))
    return lines[0].strip()


def on_this_host(program: str, version: str) -> str:
    """The path of a program on the host of a worker: the same path, else in PATH. Raises BatchError."""
    path = program if os.access(program, os.X_OK) else shutil.which(os.path.basename(program))
    if not path:
        raise BatchError(f"{program} is not there on {os.uname().nodename}, and not in PATH")
    found = version_of(path)
    if found != version:
        raise BatchError(f"{path} on {os.uname().nodename} is {found}, not {version}")
    return path


def item_options(item: Item, given: tuple[str, ...], name: str) -> tuple[str, ...]:
    """The options of an item, with {input}, {folder} and {name} replaced."""
    first = item.inputs[0]
    values = {"input": first, "folder": first if item.kind == SEQUENCE else os.path.dirname(first), "name": name}
    return tuple(re.sub(r"\{(input|folder|name)\}", lambda found: values[str(found.group(1))], option)
                 for option in given)


def sets_threads(options: tuple[str, ...]) -> bool:
    """Whether the user says how many threads there are."""
    return any(option == "--threads" or option.startswith("--threads=") for option in options)


def command_line(program: str, item_inputs: tuple[str, ...], options: tuple[str, ...], threads: int,
                 output: str) -> list[str]:
    """How to call a program."""
    number = [] if sets_threads(options) else ["--threads", str(threads)]
    return [program, *number, *options, *item_inputs, output]
