# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""Prints the manual page, which says what --help says. Argument: the version."""
import argparse
import sys

from pcl_cosection_batch.arguments import PROGRAM, make_parser


def escaped(text: str) -> str:
    """Text as troff has it."""
    text = text.replace("\\", "\\\\").replace("-", "\\-")
    return "\n".join("\\&" + line if line.startswith((".", "'")) else line for line in text.split("\n"))


def man_page(version: str) -> str:
    """The page in troff."""
    parser = make_parser()
    lines = [f'.TH {PROGRAM.upper()} 1 "" "pcl_cosection {version}" "User Commands"', ".SH NAME",
             f"{PROGRAM} \\- complete many views and sequences, on all cores or a cluster", ".SH SYNOPSIS",
             ".B " + escaped(parser.format_usage().partition(":")[2].strip()), ".SH DESCRIPTION"]
    for text in (parser.description or "").strip().split("\n\n"):
        lines += [escaped(text), ".PP"]
    lines.append(".SH OPTIONS")
    formatter = argparse.HelpFormatter(PROGRAM)
    for group in parser._action_groups:  # there is no public way to list them
        actions = [action for action in group._group_actions if action.option_strings]
        if actions:
            lines.append(f".SS {group.title}")
        for action in actions:
            names = ", ".join(action.option_strings)
            value = "" if action.nargs == 0 else f" {formatter._format_args(action, action.dest.upper())}"
            text = (action.help or "") % {**vars(action), "prog": PROGRAM}
            lines += [".TP", ".B " + escaped(names + value), escaped(text)]
    lines += [".SH EXIT STATUS", escaped((parser.epilog or "").strip().partition("Exit status:")[2].strip())]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    print(man_page(sys.argv[1]), end="")
