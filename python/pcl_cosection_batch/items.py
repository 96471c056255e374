# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""Takes the INPUTs apart into items: each is one call of a program, and gets one result folder."""
import os
from dataclasses import dataclass

from pcl_cosection_batch.errors import UsageError
from pcl_cosection_batch.sequence_layout import VIEW_ENDINGS, is_sequence, is_truth, is_view, natural_order

VIEWS = "views"
SEQUENCE = "sequence"
STATE_FOLDER = ".batch"  # of an OUTPUT
STATE_FILE = "batch.json"  # of a result


@dataclass(frozen=True)
class Item:
    """One call of a program."""

    kind: str  # VIEWS: pcl_cosection; SEQUENCE: pcl_cosection_fusion
    inputs: tuple[str, ...]  # absolute paths
    wanted_name: str  # of its result, if no other item has it
    options: tuple[str, ...] = ()  # of its own, beside those of all items
    problem: str = ""  # why it cannot be run
    named: bool = False  # a list gives it its name

    @property
    def source(self) -> str:
        """What the item is made of, as one text that is the same in each batch."""
        return "\0".join((self.kind, *self.inputs, *(("", self.wanted_name) if self.named else ())))


def without_ending(path: str) -> str:
    """A path without .pcd or .ply."""
    return path[:-4] if path.lower().endswith(VIEW_ENDINGS) else path


def visible_entries(folder: str) -> list[str]:
    """The names in a folder, those that begin with a dot left out, in natural order."""
    try:
        names = os.listdir(folder)
    except OSError as error:
        raise UsageError(f"{folder}: cannot be read: {error.strerror}") from None
    return sorted((name for name in names if not name.startswith(".")), key=natural_order)


def views_in(folder: str) -> list[str]:
    """The views directly in a folder; what pcl_cosection_simulate --meshes writes beside them is their truth."""
    paths = (os.path.join(folder, name) for name in visible_entries(folder) if not is_truth(name))
    return [path for path in paths if is_view(path)]


def is_result(folder: str) -> bool:
    """Whether a batch or a program has written the folder: what is in it are no inputs."""
    if any(os.path.exists(os.path.join(folder, name)) for name in (STATE_FOLDER, STATE_FILE)):
        return True
    if not os.path.isfile(os.path.join(folder, "summary.json")):
        return False
    return any(name.startswith(("background.", "object_")) and name.endswith((".ply", ".stl", ".obj"))
               for name in visible_entries(folder)) or os.path.isdir(os.path.join(folder, "trajectory"))


class Finder:
    """Walks through folders and collects items."""

    def __init__(self, each_view: bool, left_out: set[str]) -> None:
        self.each_view = each_view
        self.seen = set(left_out)  # real paths of folders
        self.items: list[Item] = []

    def add_input(self, path: str) -> None:
        """Adds what one INPUT of the command line stands for; list files are read elsewhere."""
        absolute = os.path.abspath(path)
        if is_view(absolute):
            self.items.append(Item(VIEWS, (absolute,), without_ending(os.path.basename(absolute))))
        elif is_sequence(absolute):
            self.items.append(Item(SEQUENCE, (absolute,), os.path.basename(absolute)))
        else:
            if is_result(absolute):
                raise UsageError(f"{path}: is what a program or a batch wrote, and no input")
            before = len(self.items)
            self._add_folder(absolute, "", top=True)
            if len(self.items) == before:
                raise UsageError(f"{path}: has no views (.pcd, .ply) and no sequences, nor have the folders in it")

    def _add_folder(self, folder: str, name: str, top: bool) -> None:
        real = os.path.realpath(folder)
        if real in self.seen or (not top and is_result(folder)):
            return
        self.seen.add(real)
        if not top and is_sequence(folder):
            self.items.append(Item(SEQUENCE, (folder,), name))
            return
        views = views_in(folder)
        if top or self.each_view:
            for view in views:
                own = without_ending(os.path.basename(view))
                self.items.append(Item(VIEWS, (view,), os.path.join(name, own)))
        elif views:
            self.items.append(Item(VIEWS, tuple(views), name))
        for entry in visible_entries(folder):
            below = os.path.join(folder, entry)
            if os.path.isdir(below):
                self._add_folder(below, os.path.join(name, entry), top=False)
