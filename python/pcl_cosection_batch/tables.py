# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""summary.csv and summary.json: a row for each item."""
import collections
import csv
import io
from typing import Any

from pcl_cosection_batch.run_item import now
from pcl_cosection_batch.store import Record, Store, write_atomically, write_json

COLUMNS = (
    "name", "status", "reason", "program", "version", "inputs", "options", "attempts", "host", "started", "seconds",
    "cpu_seconds", "peak_memory_bytes", "objects", "objects_failed", "warnings", "relative_error", "worst_object",
    "guessed_share", "contradicted_share", "penetration_m", "remarks")


def row_of(record: Record) -> dict[str, Any]:
    """The values of an item; what is not known is empty."""
    row = {name: record.get(name) for name in COLUMNS}
    remarks = [*(record.get("warnings") or []), *(record.get("notes") or [])]
    row["warnings"] = len(remarks)
    row["remarks"] = remarks
    row["inputs"] = record.get("inputs") or []
    row["options"] = record.get("options") or []
    return row


def csv_text(records: list[Record]) -> str:
    """The table as CSV. Lists are in one field, a line each."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    for record in records:
        row = row_of(record)
        writer.writerow(["\n".join(value) if isinstance(value, list) else "" if value is None else value
                         for value in (row[name] for name in COLUMNS)])
    return text.getvalue()


def counts(records: list[Record]) -> dict[str, int]:
    """How many items have each status."""
    return dict(collections.Counter(str(record["status"]) for record in records))


def write_tables(store: Store, records: list[Record]) -> None:
    """Writes both files."""
    write_atomically(store.result("summary.csv"), csv_text(records).encode("utf-8", "surrogateescape"))
    write_json(store.result("summary.json"), {
        "written": now(), "counts": counts(records), "items": [row_of(record) for record in records]})
