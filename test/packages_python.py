#!/usr/bin/env python3
# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""Completes a ball before a wall with the installed module; test/packages.sh runs it in a new Debian.

Usage: packages_python.py [--help]      exit status 0: the volume is about the ball's, 1: it is not
"""
import math
import sys

import numpy
import pcl_cosection

RADIUS_M = 0.1
DISTANCE_M = 0.6
FOCAL_LENGTH_PX = 300.0
HEIGHT, WIDTH = 240, 320


def main():
    if len(sys.argv) > 1:
        print(__doc__)
        return 0 if sys.argv[1:] == ["--help"] else 2
    centre = ((WIDTH - 1) / 2, (HEIGHT - 1) / 2)
    v, u = numpy.mgrid[:HEIGHT, :WIDTH]
    # A ray (x, y, 1) meets the ball where a t^2 - 2 d t + d^2 - r^2 = 0.
    a = ((u - centre[0]) / FOCAL_LENGTH_PX) ** 2 + ((v - centre[1]) / FOCAL_LENGTH_PX) ** 2 + 1
    discriminant = DISTANCE_M**2 - a * (DISTANCE_M**2 - RADIUS_M**2)
    is_ball = discriminant > 0
    depth = numpy.where(is_ball, (DISTANCE_M - numpy.sqrt(numpy.maximum(discriminant, 0))) / a, 0.8)
    result = pcl_cosection.complete(depth.astype(numpy.float32), is_ball.astype(numpy.uint16),
                                    intrinsics=(FOCAL_LENGTH_PX, FOCAL_LENGTH_PX, *centre))
    volume = result.objects[1].volume
    truth = 4 / 3 * math.pi * RADIUS_M**3
    print(f"{pcl_cosection.__file__}: a ball of {1000 * volume:.2f} litres instead of {1000 * truth:.2f}")
    print(f"network: {result.summary['parameters']['model'] or 'none'}")
    return 0 if 0.7 < volume / truth < 1.3 else 1


if __name__ == "__main__":
    sys.exit(main())
