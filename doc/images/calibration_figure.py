#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# Copyright (c) 2026, the pcl_cosection authors
"""Draws method_calibration.svg into this folder: the errors that 95 % of the vertices do not exceed over two sigma.

Usage: calibration_figure.py NAME=FILE.json ...      summaries of pcl_cosection_evaluate views --json FILE.json"""
import json, math, sys

from method_figures import BODY, GRID, HULL, INFERRED, INK, PALE, Svg, legend

LEAST_MM, MOST_MM = 0.5, 50.0
LEFT, TOP, SIDE = 90, 30, 380


def position (mm):
    return SIDE * math.log (min (max (mm, LEAST_MM), MOST_MM) / LEAST_MM) / math.log (MOST_MM / LEAST_MM)


def place (two_sigma_mm, error_mm):
    return LEFT + position (two_sigma_mm), TOP + SIDE - position (error_mm)


def main (arguments):
    if not arguments or not all ("=" in argument for argument in arguments):
        sys.exit (__doc__)
    f = Svg (760, 480)
    for mm in (0.5, 1, 2, 5, 10, 20, 50):
        f.line (*place (mm, LEAST_MM), *place (mm, MOST_MM), GRID, 1)
        f.line (*place (LEAST_MM, mm), *place (MOST_MM, mm), GRID, 1)
        x, y = place (mm, LEAST_MM)
        f.text (x, y + 20, str (mm), 13, anchor="middle")
        x, y = place (LEAST_MM, mm)
        f.text (x - 10, y + 5, str (mm), 13, anchor="end")
    f.rect (LEFT, TOP, SIDE, SIDE, INK, 1)
    f.line (*place (LEAST_MM, LEAST_MM), *place (MOST_MM, MOST_MM), PALE, 1.5, "6 4")
    entries = []
    for colour, argument in zip ((HULL, INFERRED, BODY), arguments):
        name, file = argument.split ("=", 1)
        with open (file, encoding="utf-8") as summary:
            curve = json.load (summary)["expected_errors"]["curve"]
        points = [place (2000 * c["mean_sigma_m"], 1000 * c["p95_error_m"]) for c in curve]
        f.path (points, colour, 2)
        for x, y in points:
            f.dot (x, y, 4, colour)
        entries.append ((colour, name))
    entries.append ((PALE, "as expected"))
    legend (f, 500, 60, entries, 26)
    f.text (LEFT + SIDE / 2, TOP + SIDE + 44, "two sigma (mm), mean of an eighth of the vertices", 14, anchor="middle")
    f.text (LEFT, TOP - 10, "95 % of their errors are smaller (mm)", 14)
    f.save ("method_calibration.svg")


if __name__ == "__main__":
    main (sys.argv[1:])
