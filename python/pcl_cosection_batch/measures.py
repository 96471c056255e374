# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""Reads the summary of a result, and says what is worst in it."""
import os
from typing import Any

from pcl_cosection_batch.store import Record, read_json

CONTRADICTED_SHARE = 0.1  # of an object's points, from which on the programs warn
MOST_WARNINGS = 100  # that are kept in a record


def nothing() -> Record:
    """The measures of an item without a result."""
    return {"summary": False, "objects": 0, "objects_failed": 0, "first_failure": "", "warnings": [], "notes": [],
            "relative_error": None, "worst_object": None, "guessed_share": None, "contradicted_share": None,
            "penetration_m": None, "picture": ""}


def number(container: Any, key: str) -> float | None:
    """A number in a JSON object."""
    value = container.get(key) if isinstance(container, dict) else None
    return float(value) if isinstance(value, (int, float)) and not isinstance(value, bool) else None


def largest(values: list[float | None]) -> float | None:
    """The largest of the values that are known."""
    known = [value for value in values if value is not None]
    return max(known) if known else None


def objects_in(summary: Record, key: str) -> list[Record]:
    """A list of JSON objects."""
    value = summary.get(key)
    return [entry for entry in value if isinstance(entry, dict)] if isinstance(value, list) else []


def relative_error(item: Record) -> float | None:
    """The mean expected error of an object over its size, the edge of a cube of its volume."""
    sigma, volume = number(item, "mean_sigma_m"), number(item, "volume_m3")
    return sigma / volume ** (1 / 3) if sigma is not None and volume is not None and volume > 0 else None


def guessed_share(item: Record) -> float | None:
    """The share of an object's vertices that were not observed."""
    observed = number(item.get("provenance"), "observed")
    return None if observed is None else 1 - observed


def notes_on(item: Record) -> list[str]:
    """What is wrong with an object, though the program does not warn of it."""
    name = f"object {item.get('id')}"
    notes = []
    if item.get("closed") is False:
        notes.append(f"{name}: the mesh is not closed")
    share = number(item, "contradicted_share")
    if share is not None and share > CONTRADICTED_SHARE:
        notes.append(f"{name}: a view looks through {share:.0%} of its points")
    solver = item.get("solver")
    if isinstance(solver, dict) and solver.get("converged") is False:
        notes.append(f"{name}: the solver did not converge")
    return notes


def of_result(folder: str) -> Record:
    """The measures of a result."""
    summary = read_json(os.path.join(folder, "summary.json"))
    if not summary:
        return nothing()
    objects, failed = objects_in(summary, "objects"), objects_in(summary, "failed")
    warnings = summary.get("warnings")
    errors = {str(entry.get("id")): relative_error(entry) for entry in objects}
    worst = largest(list(errors.values()))
    return {
        **nothing(), "summary": True, "objects": len(objects), "objects_failed": len(failed),
        "first_failure": f"object {failed[0].get('id')}: {failed[0].get('error')}" if failed else "",
        "warnings": [str(text) for text in warnings][:MOST_WARNINGS] if isinstance(warnings, list) else [],
        "notes": [note for entry in objects for note in notes_on(entry)][:MOST_WARNINGS],
        "relative_error": worst,
        "worst_object": next((name for name, error in errors.items() if worst is not None and error == worst), None),
        "guessed_share": largest([guessed_share(entry) for entry in objects]),
        "contradicted_share": largest([number(entry, "contradicted_share") for entry in objects]),
        "penetration_m": largest([number(entry, "penetration_m") for entry in objects])}


def badness(record: Record) -> tuple[int, int, float, float]:
    """A key that is larger the worse an item is: failed, partial or done; warnings; expected error; guessed share."""
    status = {"failed": 3, "stopped": 2, "partial": 1}.get(str(record.get("status")), 0)
    remarks = len(record.get("warnings") or []) + len(record.get("notes") or [])
    return status, remarks, number(record, "relative_error") or 0, number(record, "guessed_share") or 0
