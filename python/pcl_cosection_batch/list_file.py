# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""Reads list files: an item a line, its views separated by spaces."""
import os
import shlex

from pcl_cosection_batch.errors import UsageError
from pcl_cosection_batch.items import SEQUENCE, VIEWS, Item, views_in, without_ending
from pcl_cosection_batch.sequence_layout import VIEW_ENDINGS, is_sequence, is_view

MAX_BYTES = 64 << 20
HOW = "a line is a view, several views of one scene, or a folder"


def read_list(path: str) -> list[Item]:
    """The items of a list file. Paths are relative to its folder. An item that is not there has a problem."""
    try:
        if os.path.getsize(path) > MAX_BYTES:
            raise UsageError(f"{path}: is too large for a list; {HOW}")
        with open(path, "rb") as file:
            data = file.read()
    except OSError as error:
        raise UsageError(f"{path}: cannot be read: {error.strerror}") from None
    if b"\0" in data:
        raise UsageError(f"{path}: is neither a view (.pcd, .ply) nor a list; {HOW}")
    text = os.fsdecode(data.removeprefix(b"\xef\xbb\xbf"))
    items = []
    for number, line in enumerate(text.split("\n"), 1):
        where = f"{path}: line {number}"
        item = parse_line(line.rstrip("\r"), os.path.dirname(os.path.abspath(path)), where)
        if item:
            items.append(item)
    if not items:
        raise UsageError(f"{path}: has no items; {HOW}")
    return items


def parse_line(line: str, folder: str, where: str) -> Item | None:
    """The item of a line: [NAME:] PATH [PATH ...] [-- OPTIONS]. Nothing for an empty line or a comment."""
    try:
        words = shlex.split(line, comments=line.lstrip().startswith("#"))
    except ValueError as error:
        raise UsageError(f"{where}: {str(error).lower()}") from None
    options: list[str] = []
    if "--" in words:
        options = words[words.index("--") + 1:]
        words = words[:words.index("--")]
        if not words:
            raise UsageError(f"{where}: has options, but no view and no folder")
    if not words:
        return None
    name = ""
    if len(words) > 1 and words[0].endswith(":"):
        name = words[0][:-1]
        words = words[1:]
        if not name:
            raise UsageError(f"{where}: there is no name before the colon")
    return make_item(name, words, folder, tuple(options), where)


def make_item(name: str, words: list[str], folder: str, options: tuple[str, ...], where: str) -> Item:
    """The item of paths that belong together."""
    paths = [os.path.normpath(os.path.join(folder, word)) for word in words]
    named = bool(name)
    name = name or without_ending(name_from(words[0]))
    problem = ""
    views: list[str] = []
    for word, path in zip(words, paths):
        if os.path.isdir(path) and is_sequence(path):
            if len(paths) > 1:
                raise UsageError(f"{where}: {word} is a sequence, which must be alone on its line")
            return Item(SEQUENCE, (path,), name, options, named=named)
        found = views_in(path) if os.path.isdir(path) else [path]
        views += found
        if os.path.isdir(path) and not found:
            problem = problem or f"{where}: {word} has no views (.pcd, .ply) and is no sequence"
        elif not os.path.isdir(path) and not path.lower().endswith(VIEW_ENDINGS):
            problem = problem or f"{where}: {word} is " + (
                "no view (.pcd, .ply)" if os.path.exists(path) else "not there")
        elif found == [path] and not is_view(path):
            problem = problem or f"{where}: {word} is " + ("no file" if os.path.exists(path) else "not there")
    return Item(VIEWS, tuple(views or paths), name, options, problem, named)


def name_from(word: str) -> str:
    """A name of the path as it was written, without parts that only lead upward; of a long way, the last two parts."""
    parts = [part for part in word.split("/") if part not in ("", ".", "..")]
    return "/".join(parts[-2:] if word.startswith("/") else parts) or "item"
