#!/usr/bin/env python3
# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""Writes a scene for pcl_cosection_simulate: a storey of 12 x 8 x 3 m with five furnished rooms and a corridor.

Usage: make_storey.py STOREY.json
"""
import json
import math
import sys

WALL, WOOD, GREY, RED, BLUE, GREEN = ([205, 200, 185], [160, 110, 60], [120, 130, 140], [190, 60, 50], [60, 90, 170],
                                      [80, 140, 80])
COLOURS = [WOOD, RED, BLUE, GREEN, GREY]
ROOMS = [(-4, 2.4, 4), (0, 2.4, 4), (4, 2.4, 4), (-3, -2.4, 6), (3, -2.4, 6)]  # middle x, y, and length along x
DOOR_WIDTH, DOOR_HEIGHT, HEIGHT, THICKNESS, EYE = 0.9, 2.1, 3.0, 0.12, 1.5  # metres
RATE = 30


def box(place, size, colour):
    """A box around a place."""
    return {"type": "box", "size": size, "position": place, "colour": colour}


def wall_with_doors(y, doors):
    """Along x, from end to end."""
    parts, begin = [], -6.0
    for door in doors:
        end = door - DOOR_WIDTH / 2
        parts.append(box([(begin + end) / 2, y, HEIGHT / 2], [end - begin, THICKNESS, HEIGHT], WALL))
        parts.append(box([door, y, (DOOR_HEIGHT + HEIGHT) / 2], [DOOR_WIDTH, THICKNESS, HEIGHT - DOOR_HEIGHT], WALL))
        begin = door + DOOR_WIDTH / 2
    return parts + [box([(begin + 6.0) / 2, y, HEIGHT / 2], [6.0 - begin, THICKNESS, HEIGHT], WALL)]


def furniture(number, x, y, length):
    """A table with a ball, a cupboard, a pot and a ring on the floor."""
    side, colour = math.copysign(1.0, y), [COLOURS[(number + n) % len(COLOURS)] for n in range(4)]
    table = [x - 0.9, y + side * 0.9]
    parts = [box([*table, 0.72], [1.4, 0.8, 0.05], WOOD)]
    parts += [box([table[0] + dx, table[1] + dy, 0.35], [0.07, 0.07, 0.7], WOOD)
              for dx in (-0.62, 0.62) for dy in (-0.33, 0.33)]
    parts.append(box([x + length / 2 - 0.35, y, 0.95], [0.5, 1.2, 1.9], colour[0]))
    parts.append({"type": "sphere", "radius": 0.25, "position": [*table, 0.99], "colour": colour[1]})
    parts.append({"type": "cylinder", "radius": 0.3, "height": 0.5, "position": [x + 0.5, y + side, 0.0],
                  "colour": colour[2]})
    parts.append({"type": "torus", "radius": 0.35, "tube_radius": 0.1, "position": [x + 0.5, y - side * 0.2, 0.1],
                  "colour": colour[3]})
    return parts


def turns(x, y, steps):
    """Once around at each of three inclinations: eyes and what they look at."""
    for slope in (0.9, -0.35, 0.25):
        for n in range(steps):
            a = 2 * math.pi * n / steps
            yield ([x - 0.2 * math.cos(a), y - 0.2 * math.sin(a), EYE],
                   [x + 2 * math.cos(a), y + 2 * math.sin(a), EYE - 2 * slope])


def storey():
    """The description."""
    parts = [{"type": "room", "size": [12, 8, HEIGHT], "position": [0, 0, HEIGHT / 2], "colour": WALL}]
    parts += wall_with_doors(0.8, [-4.2, -0.2, 4.2]) + wall_with_doors(-0.8, [-3.0, 3.0])
    parts += [box([x, y, HEIGHT / 2], [THICKNESS, 3.2, HEIGHT], WALL) for x, y in ((-2, 2.4), (2, 2.4), (0, -2.4))]
    path = [look for x in (-4.5, -1.5, 1.5, 4.5) for look in turns(x, 0.0, 10)]
    for number, (x, y, length) in enumerate(ROOMS):
        parts += furniture(number, x, y, length)
        for dx in (0.0,) if length < 5 else (-1.4, 1.4):
            path += turns(x + dx + 0.1, y - math.copysign(0.55, y), 14)
    keys = [{"time": n / RATE, "position": [round(v, 4) for v in eye], "look_at": [round(v, 4) for v in place]}
            for n, (eye, place) in enumerate(path)]
    camera = {"width": 320, "height": 240, "fx": 200, "fy": 200, "cx": 159.5, "cy": 119.5, "keys": keys}
    return {"name": "storey", "frames": len(path), "rate": RATE, "camera": camera,
            "background": {"name": "room", "parts": parts}, "objects": []}


if __name__ == "__main__":
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    with open(sys.argv[1], "w", encoding="utf-8") as output:
        json.dump(storey(), output, indent=1)
