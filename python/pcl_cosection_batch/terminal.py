# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""What is printed: a line for each item, and on a terminal a last line with the progress."""
import os
import shutil
import sys
import time

from pcl_cosection_batch.arguments import PROGRAM

LONGEST_LINE = 2000


def one_line(text: str) -> str:
    """A text that no name of a file can make the terminal misbehave with."""
    plain = "".join(" " if c in "\n\r\t" else c if c.isprintable() else "?" for c in text)
    if len(plain) > LONGEST_LINE:
        plain = plain[:LONGEST_LINE // 2] + " ... " + plain[-LONGEST_LINE // 2:]
    return plain


def duration_text(seconds: float) -> str:
    """A time as one says it: 40 s, 12 min, 3 h 5 min."""
    if seconds < 90:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60)
    return f"{minutes} min" if minutes < 90 else f"{minutes // 60} h {minutes % 60} min"


def counted(number: int, what: str) -> str:
    """1 item, 2 items."""
    return f"{number} {what}" + ("" if number == 1 else "s")


class Progress:
    """How far a batch is."""

    def __init__(self, total: int, done_before: int) -> None:
        self.total = total
        self.done = done_before
        self.failed = 0
        self.finished = 0  # in this batch
        self.start = time.monotonic()

    @property
    def left(self) -> int:
        """How many items have neither a result nor failed."""
        return self.total - self.done - self.failed

    def add(self, succeeded: bool) -> None:
        """Counts one more item."""
        self.finished += 1
        if succeeded:
            self.done += 1
        else:
            self.failed += 1

    def text(self) -> str:
        """The counts, and the time that is left at the rate so far."""
        text = f"{self.done} of {self.total} done, {self.failed} failed, {self.left} left"
        if self.finished and self.left:
            seconds = (time.monotonic() - self.start) / self.finished * self.left
            text += ", about " + duration_text(seconds)
        return text


class Terminal:
    """Prints to standard output and standard error. What cannot be printed is lost: results are in files."""

    def __init__(self, quiet: bool, verbose: bool) -> None:
        self.quiet = quiet
        self.verbose = verbose
        self.has_bar = not quiet and sys.stderr is not None and sys.stderr.isatty() and os.environ.get("TERM") != "dumb"
        self.bar = ""
        self.is_broken = False  # standard output

    def result(self, text: str) -> None:
        """A line on standard output."""
        if not self.quiet:
            self._clear()
            self.is_broken = self.is_broken or sys.stdout is None
            self._write(sys.stdout, one_line(text) + "\n")

    def note(self, text: str) -> None:
        """A line on standard error."""
        if not self.quiet:
            self.error(text)

    def detail(self, text: str) -> None:
        """A line on standard error, with --verbose."""
        if self.verbose:
            self.error(text)

    def error(self, text: str) -> None:
        """A line on standard error."""
        self._clear()
        self._write(sys.stderr, f"{PROGRAM}: {one_line(text)}\n")

    def progress(self, text: str) -> None:
        """The line that stays last."""
        if self.has_bar:
            text = one_line(text)[:max(10, shutil.get_terminal_size().columns - 1)]
            if text != self.bar:
                self._clear()
                self.bar = text
                self._write(sys.stderr, text)

    def finish(self) -> None:
        """Removes the last line."""
        self._clear()

    def _clear(self) -> None:
        if self.bar:
            self._write(sys.stderr, "\r" + " " * len(self.bar) + "\r")
            self.bar = ""

    def _write(self, stream: object, text: str) -> None:
        try:
            print(text, end="", file=stream, flush=True)  # type: ignore[call-overload]
        except (OSError, ValueError):
            self.is_broken = self.is_broken or stream is sys.stdout
