# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""Names of results: readable, harmless as names of folders, and the same in each batch on one OUTPUT."""
import hashlib
import os
import re
from typing import Iterable

from pcl_cosection_batch.items import Item

LONGEST_BYTES = 150
RESERVED = ("index.html", "summary.csv", "summary.json")


def clean_name(wanted: str) -> str:
    """A name of one folder: slashes become dashes, control characters underscores; not hidden, not an option."""
    name = re.sub(r"[\x00-\x1f\x7f]", "_", wanted).replace("/", "-")
    if name[:1] in (".", "-", ""):
        name = "_" + name[1:]
    encoded = os.fsencode(name)
    if len(encoded) > LONGEST_BYTES:
        digest = hashlib.sha256(encoded).hexdigest()[:8]
        name = encoded[:LONGEST_BYTES].decode("utf-8", "ignore").rstrip() + "-" + digest
    return name + "_" if name in RESERVED else name


def source_is_gone(source: str) -> bool:
    """Whether what a name was given to is no longer there."""
    paths = source.partition("\0\0")[0].split("\0")[1:]
    return not any(os.path.exists(path) for path in paths)


def assign_names(items: Iterable[Item], known: dict[str, str]) -> dict[str, str]:
    """The name of each source, and of those that earlier batches knew.

    A source keeps the name that it has. A new one gets what it wants, with -2, -3 and so on if that is taken.
    The names of sources that are gone are free again.
    """
    present = {item.source: item for item in items}
    names = {source: name for source, name in known.items() if source in present or not source_is_gone(source)}
    taken = {name.casefold() for name in names.values()}
    for source, item in present.items():
        if source in names:
            continue
        wanted = clean_name(item.wanted_name)
        name, number = wanted, 1
        while name.casefold() in taken:
            number += 1
            name = f"{wanted}-{number}"
        names[source] = name
        taken.add(name.casefold())
    return names
