#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# Copyright (c) 2026, the pcl_cosection authors
"""Draws the figures of doc/method.md and doc/architecture.md (method_*.svg, architecture.svg) into this folder.
It needs nothing but Python. The four panels of method_constraints.svg are minimisers of the energy in two dimensions."""
import math, os, random

INK, PALE, GRID = "#222222", "#777777", "#e4e4e4"
OBSERVED, INFERRED, HULL, BODY = "#808080", "#e08a00", "#2f6fc0", "#2f9550"
FREE, MATTER, TABLE = "#dbe9f8", "#f1e7d6", "#d5ebdc"


class Svg:
    def __init__ (self, width, height):
        self.width, self.height, self.items = width, height, []

    def add (self, text):
        self.items.append (text)

    def style (self, stroke, width, fill="none", dash=None, opacity=None):
        s = f'fill="{fill}"' + (f' stroke="{stroke}" stroke-width="{width}"' if stroke else "")
        return s + (f' stroke-dasharray="{dash}"' if dash else "") + (f' opacity="{opacity}"' if opacity else "")

    def line (self, x1, y1, x2, y2, stroke=INK, width=1.5, dash=None):
        self.add (f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" {self.style (stroke, width, dash=dash)}/>')

    def path (self, points, stroke=INK, width=1.5, fill="none", dash=None, close=False, opacity=None):
        d = "M" + " L".join (f"{x:.1f} {y:.1f}" for x, y in points) + ("Z" if close else "")
        self.add (f'<path d="{d}" stroke-linejoin="round" stroke-linecap="round" {self.style (stroke, width, fill, dash, opacity)}/>')

    def curve (self, d, stroke=INK, width=1.5, fill="none", dash=None):
        self.add (f'<path d="{d}" stroke-linecap="round" {self.style (stroke, width, fill, dash)}/>')

    def rect (self, x, y, w, h, stroke=INK, width=1.5, fill="none", dash=None, rounding=0):
        self.add (f'<rect x="{x:.1f}" y="{y:.1f}" width="{w:.1f}" height="{h:.1f}" rx="{rounding}" {self.style (stroke, width, fill, dash)}/>')

    def dot (self, x, y, r=2.5, fill=INK, stroke=None):
        self.add (f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{r}" {self.style (stroke, 1.2, fill)}/>')

    def ring (self, x, y, r, stroke=INK, width=1.2, dash=None, fill="none"):
        self.add (f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{r}" {self.style (stroke, width, fill, dash)}/>')

    def arrow (self, x1, y1, x2, y2, stroke=INK, width=1.6, both=False, dash=None):
        self.line (x1, y1, x2, y2, stroke, width, dash)
        for a, b, c, d in ([(x1, y1, x2, y2)] + ([(x2, y2, x1, y1)] if both else [])):
            t = math.atan2 (d - b, c - a)
            tips = [(c - 8 * math.cos (t + s), d - 8 * math.sin (t + s)) for s in (0.4, -0.4)]
            self.path ([tips[0], (c, d), tips[1]], stroke, 1, stroke, close=True)

    def text (self, x, y, text, size=14, fill=INK, anchor="start", italic=False, bold=False):
        look = (' font-style="italic"' if italic else "") + (' font-weight="bold"' if bold else "")
        text = text.replace ("&", "&amp;").replace ("<", "&lt;").replace (">", "&gt;")
        self.add (f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" fill="{fill}" text-anchor="{anchor}"{look}>{text}</text>')

    def camera (self, x, y, angle):
        c, s = math.cos (angle), math.sin (angle)
        at = lambda a, b: (x + c * a - s * b, y + s * a + c * b)
        self.path ([at (-26, -9), at (-8, -9), at (-8, 9), at (-26, 9)], INK, 1.5, "#ffffff", close=True)
        self.path ([at (-8, -4), at (0, -9), at (0, 9), at (-8, 4)], INK, 1.5, "#ffffff", close=True)

    def save (self, name):
        folder = os.path.dirname (os.path.abspath (__file__))
        with open (os.path.join (folder, name), "w", encoding="utf-8") as out:
            out.write (f'<svg xmlns="http://www.w3.org/2000/svg" width="{self.width}" height="{self.height}" '
                       f'viewBox="0 0 {self.width} {self.height}" font-family="DejaVu Sans, Helvetica, Arial, sans-serif">\n'
                       f'<rect width="{self.width}" height="{self.height}" rx="6" fill="#fdfdfb"/>\n'
                       + "\n".join (self.items) + "\n</svg>\n")


def legend (f, x, y, entries, gap=22):
    for n, (colour, text) in enumerate (entries):
        f.line (x, y + gap * n - 5, x + 26, y + gap * n - 5, colour, 4)
        f.text (x + 34, y + gap * n, text, 13)


# --- The energy in two dimensions ------------------------------------------------------------------------------------

class Plane:
    """A grid of nx * ny values, y upwards; lengths are voxels."""
    alpha, beta_hull, beta_inter = 0.005, 0.01, 0.04

    def __init__ (self, nx, ny):
        self.nx, self.ny, self.n = nx, ny, nx * ny
        self.w, self.c = [0.0] * self.n, [0.0] * self.n
        self.hull, self.inter = [0.0] * self.n, [0.0] * self.n

    def at (self, i, j):
        return i * self.ny + j

    def cells (self):
        return ((i, j) for i in range (self.nx) for j in range (self.ny))

    def hessian (self):
        """Rows of the band at and behind the diagonal of alpha H^T H."""
        band = 2 * self.ny + 1
        rows = [[0.0] * band for _ in range (self.n)]

        def gram (terms, weight):
            for a, va in terms:
                for b, vb in terms:
                    if b >= a:
                        rows[a][b - a] += weight * va * vb

        for i, j in self.cells ():
            if 0 < i < self.nx - 1:
                gram ([(self.at (i - 1, j), 1), (self.at (i, j), -2), (self.at (i + 1, j), 1)], self.alpha)
            if 0 < j < self.ny - 1:
                gram ([(self.at (i, j - 1), 1), (self.at (i, j), -2), (self.at (i, j + 1), 1)], self.alpha)
            if i + 1 < self.nx and j + 1 < self.ny:
                gram ([(self.at (i, j), 1), (self.at (i + 1, j + 1), 1), (self.at (i + 1, j), -1), (self.at (i, j + 1), -1)],
                      2 * self.alpha)
        return rows

    def minimise (self):
        """Newton's method on the active set."""
        regulariser, u, active = self.hessian (), [0.0] * self.n, None
        for _ in range (25):
            bounds = [(self.beta_hull * (self.hull[n] > max (0.0, u[n])), self.beta_inter * (self.inter[n] > max (0.0, u[n])))
                      for n in range (self.n)]
            if bounds == active:
                break
            active = bounds
            rows = [list (row) for row in regulariser]
            right = list (self.c)
            for n, (h, b) in enumerate (active):
                rows[n][0] += self.w[n] + h + b + 1e-9
                right[n] += h * self.hull[n] + b * self.inter[n]
            u = solve (rows, right)
        return u


def solve (rows, b):
    """Cholesky's method on a symmetric band matrix."""
    n, band = len (rows), len (rows[0])
    for k in range (n):
        row = rows[k]
        pivot = row[0]
        for m in range (1, min (band, n - k)):
            if row[m] != 0.0:
                f = row[m] / pivot
                target = rows[k + m]
                rows[k + m] = [t - f * r for t, r in zip (target, row[m:])] + target[band - m:]
                b[k + m] -= f * b[k]
    for k in reversed (range (n)):
        row = rows[k]
        s = b[k]
        for m in range (1, min (band, n - k)):
            s -= row[m] * b[k + m]
        b[k] = s / row[0]
    return b


def constraints ():
    nx, ny, table, box = 58, 46, 12.0, (20.0, 12.0, 38.0, 30.0)
    eye = (-60.0, 84.0)
    points = [((box[0], box[1] + 0.5 * k), (-1, 0)) for k in range (1, 36)]
    points += [((box[0] + 0.5 * k, box[3]), (0, 1)) for k in range (1, 36)]

    def hits (x, y):
        """Distance to what the ray through (x, y) meets first."""
        dx, dy = x - eye[0], y - eye[1]
        length = math.hypot (dx, dy)
        dx, dy = dx / length, dy / length
        low, high = 0.0, 1e9
        for o, d, a, b in ((eye[0], dx, box[0], box[2]), (eye[1], dy, box[1], box[3])):
            if abs (d) > 1e-9:
                s, t = sorted (((a - o) / d, (b - o) / d))
                low, high = max (low, s), min (high, t)
        ground = (table - eye[1]) / dy if dy < 0 else 1e9
        return length, (min (low, ground) if low < high else ground)

    base = Plane (nx, ny)
    count = [0] * base.n
    for (px, py), (ax, ay) in points:
        for i, j in base.cells ():
            s = (i - px) ** 2 + (j - py) ** 2
            if s < 9.0:
                w = math.exp (-s)
                n = base.at (i, j)
                base.w[n] += w
                base.c[n] += w * ((i - px) * ax + (j - py) * ay)
                count[n] += 1
    free = [False] * base.n
    for i, j in base.cells ():
        n = base.at (i, j)
        if count[n]:
            base.w[n], base.c[n] = base.w[n] / count[n], base.c[n] / count[n]
        way, depth = hits (i, j)
        free[n] = depth - way > 3.0
    hull, inter = [0.0] * base.n, [0.0] * base.n
    taken = [(i, j) for i, j in base.cells () if not free[base.at (i, j)]]
    for i, j in base.cells ():
        n = base.at (i, j)
        if free[n]:
            hull[n] = min (min (math.hypot (i - a, j - b) for a, b in taken), i + 1, j + 1, nx - i, ny - j)
        elif j < table:
            inter[n] = min (table - j, 5.0)

    f = Svg (880, 470)
    scale, names = 6.6, ("none", "hull", "intersection", "all")
    for p, name in enumerate (names):
        plane = Plane (nx, ny)
        plane.w, plane.c = list (base.w), list (base.c)
        if name in ("hull", "all"):
            plane.hull = hull
            for n in range (plane.n):
                if free[n]:
                    plane.w[n] = plane.c[n] = 0.0
        if name in ("intersection", "all"):
            plane.inter = inter
        u = plane.minimise ()
        x0, y0 = 20 + (p % 2) * 430, 34 + (p // 2) * 220
        sx = lambda x: x0 + (x + 1) * scale
        sy = lambda y: y0 + (ny - 8 - y) * scale * 0.72
        ys = 0.72
        height = (ny - 8) * scale * ys
        clip = f"clip{p}"
        f.add (f'<clipPath id="{clip}"><rect x="{x0}" y="{y0}" width="{nx * scale:.0f}" height="{height - 2:.0f}"/></clipPath>')
        f.add (f'<g clip-path="url(#{clip})">')
        f.rect (x0, y0, nx * scale, height, None, 0, "#ffffff")
        if name in ("hull", "all"):
            for i, j in plane.cells ():
                if free[plane.at (i, j)]:
                    f.rect (sx (i - 0.5), sy (j + 0.5), scale + 0.3, scale * ys + 0.3, None, 0, FREE)
        f.rect (x0, sy (table), nx * scale, 200, None, 0, TABLE)
        f.line (x0, sy (table), x0 + nx * scale, sy (table), BODY, 1.2)
        f.rect (sx (box[0]), sy (box[3]), (box[2] - box[0]) * scale, (box[3] - box[1]) * scale * ys, PALE, 1, dash="3 3")
        for i in range (nx - 1):
            for j in range (ny - 1):
                corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
                cut = []
                for k in range (4):
                    a, b = corners[k], corners[(k + 1) % 4]
                    ua, ub = u[plane.at (*a)], u[plane.at (*b)]
                    if (ua < 0) != (ub < 0):
                        t = ua / (ua - ub)
                        cut.append ((a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])))
                if len (cut) == 2:
                    mx, my = (cut[0][0] + cut[1][0]) / 2, (cut[0][1] + cut[1][1]) / 2
                    near = [(a, b) for a in range (int (mx) - 2, int (mx) + 4) for b in range (int (my) - 2, int (my) + 4)
                            if 0 <= a < nx and 0 <= b < ny]
                    to = lambda a, b: math.hypot (a - mx, b - my)
                    if any (count[plane.at (a, b)] and base.w[plane.at (a, b)] > 0.15 and to (a, b) <= 1.0 for a, b in near):
                        colour = OBSERVED
                    elif any (plane.inter[plane.at (a, b)] > max (0, u[plane.at (a, b)]) and to (a, b) <= 1.0 for a, b in near):
                        colour = BODY
                    elif name in ("hull", "all") and any (free[plane.at (a, b)] and to (a, b) <= 2.0 for a, b in near):
                        colour = HULL
                    else:
                        colour = INFERRED
                    f.line (sx (cut[0][0]), sy (cut[0][1]), sx (cut[1][0]), sy (cut[1][1]), colour, 3.2)
        f.add ("</g>")
        f.rect (x0, y0, nx * scale, height - 2, PALE, 1)
        f.text (x0 + nx * scale / 2, y0 - 8, name, 15, anchor="middle", bold=True)
    f.text (862, 464, "the camera looks from the upper left; dashed: the true box; light blue: seen free", 12, PALE, "end")
    f.save ("method_constraints.svg")


# --- Terms -----------------------------------------------------------------------------------------------------------

def setup ():
    f = Svg (760, 320)
    for k in range (16):
        f.line (270 + 20 * k, 30, 270 + 20 * k, 290, GRID, 1)
    for k in range (14):
        f.line (270, 30 + 20 * k, 570, 30 + 20 * k, GRID, 1)
    f.rect (270, 250, 300, 40, None, 0, TABLE)
    f.line (230, 250, 620, 250, BODY, 2)
    f.path ([(350, 250), (350, 120), (490, 120), (490, 250)], None, 0, MATTER, close=True)
    f.path ([(350, 250), (350, 120), (490, 120)], OBSERVED, 4)
    f.path ([(490, 120), (490, 250), (350, 250)], INFERRED, 3, dash="7 6")
    for y in (140, 170, 200, 230):
        f.line (75, 55, 350, y, HULL, 0.8, "4 4")
    for x in (370, 410, 450):
        f.line (75, 55, x, 120, HULL, 0.8, "4 4")
    f.camera (75, 55, 0.35)
    f.text (30, 105, "sensor")
    f.text (418, 190, "u < 0", 16, anchor="middle", italic=True)
    f.text (418, 210, "inside", 13, PALE, "middle")
    f.text (530, 60, "u > 0", 16, anchor="middle", italic=True)
    f.text (530, 80, "outside", 13, PALE, "middle")
    f.text (580, 284, "table", 13, BODY)
    legend (f, 600, 120, [(OBSERVED, "observed"), (INFERRED, "hidden")])
    f.line (602, 161, 626, 161, HULL, 0.9, "4 4")
    f.text (634, 166, "free ray", 13)
    f.text (270, 308, "Ω: one value u per voxel centre, voxel size h", 13, PALE)
    f.save ("method_setup.svg")


def data ():
    f = Svg (760, 330)
    cx, cy, n = 250, 190, (math.sin (0.35), -math.cos (0.35))
    for r, o in ((123, "0.06"), (96, "0.08"), (68, "0.12"), (41, "0.2")):
        f.add (f'<circle cx="{cx}" cy="{cy}" r="{r}" fill="{INFERRED}" opacity="{o}"/>')
    f.ring (cx, cy, 123, INFERRED, 1.4, "5 4")
    f.curve ("M40 255 Q 150 130 250 190 T 470 240", OBSERVED, 3)
    t = (-n[1], n[0])
    f.line (cx - 190 * t[0], cy - 190 * t[1], cx + 190 * t[0], cy + 190 * t[1], INK, 1.2, "6 5")
    f.arrow (cx, cy, cx + 70 * n[0], cy + 70 * n[1], BODY, 2.2)
    f.dot (cx, cy, 5)
    f.text (cx + 10, cy + 24, "pᵢ", 17, italic=True)
    f.text (cx + 75 * n[0] - 6, cy + 75 * n[1] - 8, "nᵢ", 17, BODY, italic=True)
    x = (cx + 62 * t[0] + 78 * n[0], cy + 62 * t[1] + 78 * n[1])
    foot = (cx + 62 * t[0], cy + 62 * t[1])
    f.arrow (foot[0], foot[1], x[0], x[1], HULL, 2)
    f.dot (x[0], x[1], 5, HULL)
    f.text (x[0] + 10, x[1] + 2, "x", 17, italic=True)
    f.text ((foot[0] + x[0]) / 2 + 10, (foot[1] + x[1]) / 2 + 10, "fᵢ(x)", 16, HULL, italic=True)
    f.line (cx, cy, cx - 123 * math.cos (0.9), cy + 123 * math.sin (0.9), INFERRED, 1.4)
    f.text (cx - 92, cy + 118, "3 σ", 15, INFERRED)
    y = 66
    for line in ("The measurement at a voxel x is its signed", "distance to the tangent plane of the point:", "positive on the side of the normal, which",
                 "points outward.", "", "The weight is a Gaussian of |x − pᵢ|, of", "width σ = 1 voxel, and 0 beyond 3 σ."):
        f.text (430, y, line, 13)
        y += 20
    f.save ("method_data.svg")


def hessian ():
    f = Svg (760, 290)
    sets = {0: {(0, 0): "42", (1, 0): "−12", (0, 1): "−12", (-1, 0): "−12", (0, -1): "−12", (1, 1): "2", (-1, 1): "2", (1, -1): "2",
                (-1, -1): "2", (2, 0): "1", (-2, 0): "1", (0, 2): "1", (0, -2): "1"},
            1: {(0, 0): "−12", (1, 0): "2", (-1, 0): "2", (0, 1): "2", (0, -1): "2"}, 2: {(0, 0): "1"}}
    for p, layer in enumerate ((0, 1, 2)):
        x0, y0 = 40 + 245 * p, 62
        f.text (x0 + 95, 36, ("the voxel's own layer", "layers ± 1", "layers ± 2")[p], 14, anchor="middle", bold=True)
        for a in range (-2, 3):
            for b in range (-2, 3):
                value = sets[layer].get ((a, b))
                fill = {None: "#ffffff", "42": "#f6c77a", "−12": "#c9dcf2", "2": "#d5ebdc", "1": "#eee6f5"}[value]
                f.rect (x0 + (a + 2) * 38, y0 + (b + 2) * 38, 38, 38, "#bbbbbb", 1, fill)
                if value:
                    f.text (x0 + (a + 2) * 38 + 19, y0 + (b + 2) * 38 + 24, value, 14, anchor="middle")
    f.text (380, 278, "Row of HᵀH in the interior: 25 entries, the square of the Laplacian with 7 points", 13, PALE, "middle")
    f.save ("method_hessian.svg")


def hull ():
    f = Svg (760, 350)
    eye = (60, 175)
    back, front = 640, 370
    top, bottom = 130, 225
    step = 22
    def depth (y_at_unit):  # slope of the ray
        y = eye[1] + y_at_unit * (front - eye[0])
        return front if top <= y <= bottom else back
    for i in range (19):
        for j in range (13):
            x, y = 230 + step * i, 42 + step * j
            slope = (y - eye[1]) / (x - eye[0])
            d = depth (slope)
            edge = any (depth (slope + s) != d for s in (-0.022, 0.022))
            missing = 0.205 < slope < 0.262 and x > 300
            free = d - x > 45 and not edge and not missing and not (0.205 < slope < 0.262)
            if free:
                f.dot (x, y, 4, HULL)
            else:
                f.dot (x, y, 3.2, "#ffffff", "#999999")
    f.rect (front, top, 120, bottom - top, None, 0, MATTER)
    f.rect (front, top, 120, bottom - top, PALE, 1, dash="4 3")
    f.line (front, top, front, bottom, OBSERVED, 5)
    f.line (back, 20, back, 330, OBSERVED, 5)
    for y in (top, bottom):
        s = (y - eye[1]) / (front - eye[0])
        f.line (eye[0], eye[1], back, eye[1] + s * (back - eye[0]), INK, 1, "5 4")
    f.arrow (front - 46, 185, front, 185, INFERRED, 2, True)
    f.rect (front - 116, 176, 58, 18, None, 0, "#fdfdfb")
    f.text (front - 60, 190, "margin", 13, INFERRED, "end")
    f.camera (eye[0], eye[1], 0)
    f.text (30, 212, "sensor", 13)
    f.arrow (450, 64, 450, 106, BODY, 2, True)
    f.rect (457, 70, 52, 20, None, 0, "#fdfdfb")
    f.text (460, 85, "d_hull", 14, BODY, italic=True)
    f.text (front + 60, 182, "object", 14, anchor="middle")
    f.text (back + 8, 40, "background", 13)
    f.dot (36, 300, 4, HULL)
    f.text (48, 305, "seen free", 13)
    f.dot (36, 324, 3.2, "#ffffff", "#999999")
    f.text (48, 329, "hull", 13)
    f.text (300, 344, "depth edges and rays without a reading say nothing: hull", 12, PALE)
    f.save ("method_hull.svg")


def carving ():
    f = Svg (760, 290)
    for p, title in enumerate (("the minimiser", "cut at the silhouette")):
        x0 = 20 + 375 * p
        f.text (x0 + 170, 26, title, 14, anchor="middle", bold=True)
        f.path ([(x0, 40), (x0 + 345, 40), (x0 + 345, 90), (x0, 120)], None, 0, FREE, close=True)
        f.path ([(x0, 120), (x0 + 345, 90)], HULL, 1.6, dash="6 4")
        if p == 0:
            f.curve (f"M{x0 + 60} 260 L{x0 + 60} 140 Q {x0 + 62} 104 {x0 + 90} 100 Q {x0 + 220} 84 {x0 + 300} 74 Q {x0 + 325} 74 {x0 + 325} 110 L{x0 + 325} 260 Z",
                     None, 0, MATTER)
            f.curve (f"M{x0 + 60} 260 L{x0 + 60} 140", OBSERVED, 4)
            f.curve (f"M{x0 + 60} 140 Q {x0 + 62} 104 {x0 + 90} 100 Q {x0 + 220} 84 {x0 + 300} 74 Q {x0 + 325} 74 {x0 + 325} 110", HULL, 3)
            f.text (x0 + 200, 62, "about a voxel outside", 13, HULL, "middle")
        else:
            y = lambda x: 120 - 30 * (x - x0) / 345
            f.path ([(x0 + 60, 260), (x0 + 60, y (x0 + 60)), (x0 + 325, y (x0 + 325)), (x0 + 325, 260)], None, 0, MATTER, close=True)
            f.path ([(x0 + 60, 260), (x0 + 60, y (x0 + 60) + 12)], OBSERVED, 4)
            f.path ([(x0 + 60, y (x0 + 60) + 12), (x0 + 60, y (x0 + 60)), (x0 + 325, y (x0 + 325)), (x0 + 325, 130)], HULL, 3)
        f.text (x0 + 14, 72, "seen free", 13, HULL)
        f.text (x0 + 190, 190, "hidden wall", 13, PALE, "middle")
        f.path ([(x0 + 325, 130), (x0 + 325, 260)], INFERRED, 3)
    f.text (380, 280, "dashed: the ray along the silhouette", 12, PALE, "middle")
    f.save ("method_carving.svg")


def intersection ():
    f = Svg (760, 320)
    f.curve ("M330 60 Q 520 40 560 160 Q 540 290 380 270 Q 260 250 270 160 Q 275 80 330 60 Z", BODY, 2.5, TABLE)
    f.curve ("M330 60 Q 275 80 270 160 Q 262 240 350 264", BODY, 5)
    f.curve ("M110 90 Q 240 50 350 130 Q 370 190 280 240 Q 150 270 90 190 Q 80 120 110 90 Z", OBSERVED, 2.5, None)
    f.curve ("M110 90 Q 80 120 90 190 Q 105 215 130 232", OBSERVED, 5)
    f.curve ("M395 78 Q 352 100 348 160 Q 344 222 400 248", INK, 1, dash="4 4")
    f.text (180, 205, "object o", 15, anchor="middle")
    f.text (470, 130, "object p", 15, BODY, "middle")
    f.dot (322, 165, 5)
    f.text (328, 186, "x", 16, italic=True)
    f.arrow (322, 165, 272, 165, HULL, 2, True)
    f.text (262, 170, "d_inter(x) = −uᵖ(x)", 14, HULL, italic=True, anchor="end")
    f.text (585, 80, "thick line: observed;", 12, PALE)
    f.text (585, 97, "dashed: how deep behind", 12, PALE)
    f.text (585, 114, "its data p is supported", 12, PALE)
    f.text (585, 131, "(5 voxels)", 12, PALE)
    f.text (585, 200, "Beyond, uᵖ is extrapolated", 12, PALE)
    f.text (585, 217, "and bounds nothing.", 12, PALE)
    f.text (30, 306, "Over all relative poses of the two bodies, the largest depth counts.", 13)
    f.save ("method_intersection.svg")


def support_plane ():
    f = Svg (760, 270)
    f.rect (20, 180, 600, 60, None, 0, TABLE)
    random.seed (3)
    for x in list (range (30, 195, 9)) + list (range (470, 620, 9)):
        f.dot (x, 180 + random.uniform (-2, 2), 3, OBSERVED)
    f.line (195, 180, 470, 180, INFERRED, 3, "8 6")
    f.path ([(210, 170), (210, 60), (360, 60)], OBSERVED, 4)
    f.path ([(360, 60), (360, 180)], INFERRED, 3, dash="7 6")
    f.text (285, 125, "object", 14, anchor="middle")
    f.arrow (540, 180, 540, 120, BODY, 2)
    f.text (548, 138, "n", 16, BODY, italic=True)
    f.text (330, 208, "continued", 13, INFERRED, "middle")
    f.text (30, 208, "background points", 13, PALE)
    f.text (330, 232, "d_inter = depth below the plane", 13, BODY, "middle")
    f.text (630, 176, "n·x + d = 0", 14, italic=True)
    f.camera (70, 50, 0.4)
    f.line (70, 50, 205, 180, HULL, 0.9, "4 4")
    f.save ("method_support_plane.svg")


def solver ():
    f = Svg (820, 360)
    f.text (150, 30, "first solution: coarse to fine", 14, anchor="middle", bold=True)
    for k, (_, w) in enumerate (((8, 70), (16, 110), (32, 160), (64, 230))):
        y = 56 + 66 * k
        f.rect (150 - w / 2, y, w, 40, INK, 1.4, ("#f6f6f6", "#e9eff7", "#dbe9f8", "#c9dcf2")[k], rounding=4)
        f.text (150, y + 26, ("8", "16", "32", "64 voxels")[k], 14, anchor="middle")
        if k:
            f.arrow (150, y - 26, 150, y - 2)
    f.text (150, 330, "the whole energy on each level", 13, PALE, "middle")
    f.text (150, 348, "(Fast Jacobi: from 32, data and smoothness only)", 11, PALE, "middle")
    f.text (560, 30, "on each level: multigrid", 14, anchor="middle", bold=True)
    boxes = [(330, 60, "active set\nA = {d > u}"), (500, 60, "residual r"), (670, 60, "z = multigrid\ncycle (r)"),
             (670, 180, "direction\np = z + γ p"), (500, 180, "exact line search\nof E(u + t p)"), (330, 180, "u ← u + t p")]
    for x, y, text in boxes:
        f.rect (x, y, 140, 60, INK, 1.4, "#ffffff", rounding=5)
        lines = text.split ("\n")
        for n, line in enumerate (lines):
            f.text (x + 70, y + (35 if len (lines) == 1 else 27 + 19 * n), line, 13, anchor="middle")
    f.arrow (470, 90, 498, 90)
    f.arrow (640, 90, 668, 90)
    f.arrow (740, 120, 740, 178)
    f.arrow (670, 210, 642, 210)
    f.arrow (500, 210, 472, 210)
    f.arrow (400, 180, 400, 122)
    f.text (412, 155, "until the change near u = 0", 12, PALE)
    f.text (412, 171, "is below the tolerance", 12, PALE)
    f.text (570, 280, "The energy never rises from step to step.", 13, anchor="middle")
    f.text (570, 302, "Step blocked by bounds that were not active: predict them, once.", 12, PALE, "middle")
    f.save ("method_solver.svg")


# --- Priors ----------------------------------------------------------------------------------------------------------

def extent ():
    f = Svg (760, 320)
    f.camera (40, 150, 0)
    f.rect (230, 110, 230, 84, None, 0, "#fbe9cc")
    f.line (230, 105, 230, 200, OBSERVED, 5)
    f.rect (190, 214, 12, 70, None, 0, BODY)
    f.path ([(230, 214), (390, 230), (390, 292), (230, 270)], None, 0, TABLE, close=True)
    f.line (40, 150, 640, 68, INK, 0.9, "5 4")
    f.line (40, 150, 640, 252, INK, 0.9, "5 4")
    f.arrow (232, 150, 458, 150, INFERRED, 2, True)
    f.text (345, 140, "behind the object's surface", 12, anchor="middle")
    f.text (345, 170, "0.75 e₂", 15, INFERRED, "middle")
    f.arrow (232, 245, 388, 258, BODY, 2, True)
    f.text (315, 240, "0.5 e₂", 15, BODY, "middle")
    f.text (398, 284, "behind something else", 12)
    f.arrow (230, 103, 230, 74, HULL, 2, True)
    f.text (206, 70, "0.15 e₂ elsewhere (0.05 e₂ if the object was cut out)", 13, HULL)
    f.text (196, 306, "another body", 12, BODY, "middle")
    f.arrow (214, 107, 214, 198, PALE, 1.4, True)
    f.text (206, 155, "e₂", 15, PALE, "end", italic=True)
    y = 118
    for line in ("A voxel that is farther from", "the data than allowed should", "keep the excess as distance:", "u ≥ b(x), weight β_extent"):
        f.text (530, y, line, 13)
        y += 20
    f.save ("method_extent.svg")


def symmetry ():
    f = Svg (880, 330)
    f.text (230, 26, "a box from above, and two mirror planes", 14, anchor="middle", bold=True)
    f.path ([(110, 90), (110, 230), (330, 230)], OBSERVED, 4)
    f.path ([(110, 90), (330, 90), (330, 230)], INFERRED, 3, dash="7 5")
    f.line (220, 60, 220, 262, PALE, 1, "8 4 2 4")
    f.line (80, 160, 370, 160, PALE, 1, "8 4 2 4")
    f.dot (110, 200, 5)
    f.arrow (118, 200, 322, 200, PALE, 1.2)
    f.dot (330, 200, 5, INFERRED)
    f.text (340, 205, "hidden: what it adds", 12)
    f.dot (110, 120, 5, OBSERVED)
    f.arrow (110, 192, 110, 128, PALE, 1.2)
    f.text (122, 125, "on surface: supports", 12)
    f.text (680, 26, "a plane that is not one", 14, anchor="middle", bold=True)
    f.path ([(560, 90), (560, 230), (780, 230)], OBSERVED, 4)
    f.line (520, 110, 800, 250, PALE, 1, "8 4 2 4")
    f.dot (740, 230, 5)
    f.dot (752, 218, 5, HULL)
    f.dot (560, 200, 5)
    f.arrow (566, 194, 600, 142, PALE, 1.2)
    f.dot (604, 136, 5, HULL)
    f.text (614, 136, "where a view looked through: contradicts", 12, HULL)
    legend (f, 200, 306, [(OBSERVED, "points")])
    legend (f, 320, 306, [(INFERRED, "copies where nothing was seen")])
    f.save ("method_symmetry.svg")


def vessel ():
    f = Svg (760, 330)
    f.line (230, 285, 520, 285, BODY, 2)
    f.path ([(280, 70), (306, 70), (306, 259), (464, 259), (464, 70), (490, 70), (490, 285), (280, 285)], None, 0, MATTER, close=True)
    f.line (385, 50, 385, 300, PALE, 1, "8 4 2 4")
    f.path ([(280, 240), (280, 70), (306, 70)], OBSERVED, 4)
    f.path ([(464, 70), (464, 190)], OBSERVED, 4)
    f.path ([(464, 70), (490, 70)], OBSERVED, 4)
    f.path ([(280, 240), (280, 285), (490, 285), (490, 70)], INFERRED, 3, dash="7 5")
    f.path ([(306, 70), (306, 259), (464, 259), (464, 190)], INFERRED, 3, dash="7 5")
    f.arrow (464, 130, 490, 130, INK, 1.5, True)
    f.text (500, 135, "wall thickness t", 14)
    f.text (500, 78, "rim", 14)
    f.text (270, 160, "outer side", 14, anchor="end")
    f.text (378, 215, "inner side", 14, anchor="end")
    f.line (380, 210, 462, 190, PALE, 1)
    f.arrow (350, 259, 350, 285, INK, 1.5, True)
    f.text (360, 277, "t", 14, italic=True)
    f.text (500, 262, "floor", 14)
    f.text (500, 300, "bottom", 14)
    f.text (385, 40, "axis", 13, PALE, "middle")
    legend (f, 40, 40, [(OBSERVED, "seen"), (INFERRED, "expected")])
    f.text (512, 176, "cavity: expected empty", 13)
    f.arrow (508, 172, 420, 165, PALE, 1.2)
    f.save ("method_vessel.svg")


def open_box ():
    f = Svg (760, 290)
    f.rect (230, 50, 300, 180, None, 0, MATTER)
    f.rect (252, 72, 256, 136, None, 0, "#fdfdfb")
    f.path ([(230, 50), (230, 230)], OBSERVED, 4)
    f.path ([(252, 72), (508, 72), (508, 208)], OBSERVED, 4)
    f.path ([(230, 230), (530, 230)], OBSERVED, 4)
    f.path ([(230, 50), (530, 50), (530, 230)], INFERRED, 3, dash="7 5")
    f.path ([(252, 72), (252, 208), (508, 208)], INFERRED, 3, dash="7 5")
    f.line (380, 30, 380, 250, PALE, 1, "8 4 2 4")
    f.line (210, 140, 550, 140, PALE, 1, "8 4 2 4")
    f.arrow (300, 214, 300, 64, INK, 1.3, True)
    f.arrow (246, 170, 518, 170, INK, 1.3, True)
    f.text (380, 22, "from above: middle planes", 13, PALE, "middle")
    legend (f, 40, 60, [(OBSERVED, "seen"), (INFERRED, "mirrored")])
    f.text (380, 274, "Each wall is like the opposite one; all are equally thick.", 13, anchor="middle")
    f.save ("method_open_box.svg")


def extrusion ():
    f = Svg (820, 300)
    f.text (200, 26, "vertical walls: columns are filled", 14, anchor="middle", bold=True)
    f.line (40, 250, 360, 250, BODY, 2)
    for x in range (120, 281, 20):
        f.line (x, 80, x, 250, INFERRED, 1.2)
    f.path ([(110, 250), (110, 80), (290, 80)], OBSERVED, 4)
    f.path ([(290, 80), (290, 250)], INFERRED, 3, dash="7 5")
    f.camera (50, 50, 0.5)
    f.text (200, 284, "a top, and nothing that shows free space below it", 12, PALE, "middle")
    f.text (610, 26, "free space cuts columns: they are not", 14, anchor="middle", bold=True)
    f.line (450, 250, 780, 250, BODY, 2)
    f.curve ("M540 150 A 70 70 0 0 1 680 150", OBSERVED, 4)
    f.curve ("M540 150 A 70 70 0 0 0 680 150", INFERRED, 3, dash="7 5")
    f.camera (460, 180, 0.5)
    f.line (460, 180, 600, 240, HULL, 0.9, "4 4")
    f.line (460, 180, 560, 236, HULL, 0.9, "4 4")
    f.text (610, 284, "a view looked below it", 12, PALE, "middle")
    f.save ("method_extrusion.svg")


def inferred_plane ():
    f = Svg (760, 300)
    f.curve ("M220 200 A 105 105 0 0 1 325 95", OBSERVED, 5)
    f.curve ("M325 95 A 105 105 0 0 1 430 200", INFERRED, 3, dash="7 5")
    f.curve ("M220 200 A 105 105 0 0 0 325 270 A 105 105 0 0 0 430 200", PALE, 1.4, dash="3 4")
    f.line (110, 200, 560, 200, INFERRED, 2.4, "9 6")
    f.camera (60, 60, 0.6)
    f.line (60, 60, 218, 198, HULL, 0.9, "4 4")
    f.line (60, 60, 322, 94, HULL, 0.9, "4 4")
    f.ring (220, 200, 12, HULL, 2)
    f.text (190, 224, "the surface ends here,", 12, HULL, "end")
    f.text (190, 240, "though it faces the sensor", 12, HULL, "end")
    f.text (570, 204, "inferred plane", 14, INFERRED)
    f.text (325, 290, "without it, half a ball would be taken for a ball", 12, PALE, "middle")
    f.text (460, 60, "Nothing is known around the object.", 13)
    f.text (460, 80, "Its surface ends on one plane, although", 13)
    f.text (460, 100, "the sensor would have seen it go on.", 13)
    f.save ("method_inferred_plane.svg")


def no_return ():
    f = Svg (760, 300)
    f.rect (60, 30, 330, 230, PALE, 1.5, "#ffffff")
    for i in range (22):
        for j in range (15):
            x, y = 67 + 15 * i, 37 + 15 * j
            inside = 120 < x < 320 and 80 < y < 225
            hole = 190 < x < 250 and 120 < y < 170
            if inside and not hole:
                f.rect (x - 6, y - 6, 12, 12, None, 0, OBSERVED)
            elif hole:
                f.rect (x - 6, y - 6, 12, 12, "#bbbbbb", 1, "#ffffff")
            else:
                ring = 104 < x < 336 and 64 < y < 240
                f.rect (x - 6, y - 6, 12, 12, None, 0, "#eeeeee" if ring else FREE)
    f.text (225, 284, "the image of an object that was cut out", 12, PALE, "middle")
    y = 70
    for colour, stroke, text in ((OBSERVED, None, "a reading of the object"), ("#ffffff", "#bbbbbb", "no reading, inside the outline: says nothing"),
                                 ("#eeeeee", None, "next to the outline: says nothing"), (FREE, None, "ray without return: nothing is expected")):
        f.rect (420, y - 12, 14, 14, stroke, 1, colour)
        f.text (442, y, text, 12)
        y += 28
    f.save ("method_no_return.svg")


def provenance ():
    f = Svg (760, 310)
    f.rect (60, 230, 460, 44, None, 0, TABLE)
    f.path ([(60, 60), (470, 60), (330, 92), (150, 94), (150, 230), (60, 230)], None, 0, FREE, close=True)
    f.path ([(150, 226), (150, 100), (330, 98), (352, 130), (360, 226)], None, 0, MATTER, close=True)
    f.path ([(150, 218), (150, 100), (310, 98)], OBSERVED, 5)
    f.path ([(310, 98), (334, 104)], HULL, 5)
    f.path ([(334, 104), (354, 140), (360, 218)], INFERRED, 5)
    f.path ([(360, 218), (356, 228), (154, 228), (150, 218)], BODY, 5)
    f.text (250, 170, "u < 0", 15, anchor="middle", italic=True)
    f.text (72, 84, "seen free", 13, HULL)
    f.text (70, 262, "another body", 13, BODY)
    legend (f, 400, 100, [(OBSERVED, "0  observed: data within 1 voxel"), (BODY, "3  its bound is active within 1 voxel"),
                          (HULL, "2  free space within 1.5 voxels"), (INFERRED, "1  else: inferred")], 26)
    f.text (400, 210, "tested in this order", 12, PALE)
    f.save ("method_provenance.svg")


def front_end ():
    f = Svg (880, 330)
    rows = [[("depth image", "bilateral filter"), ("points, normals", "mixed pixels out"), ("associate", "a ∝ L(d) p"), ("track the camera", "against the background")],
            [("integrate depth", "TSDF, counts"), ("match masks", "create, delete"), ("segment", "by association"), ("track objects", "each its own TSDF")]]
    at = {}
    for r, row in enumerate (rows):
        for c, (title, below) in enumerate (row):
            x, y = 20 + 214 * c, 50 + 110 * r
            at[(r, c)] = (x, y)
            f.rect (x, y, 186, 64, INK, 1.4, "#ffffff" if r == 0 else "#f4f8fc", rounding=6)
            f.text (x + 93, y + 28, title, 14, anchor="middle", bold=True)
            f.text (x + 93, y + 48, below, 12, PALE, "middle")
    for c in range (3):
        f.arrow (at[(0, c)][0] + 186, 82, at[(0, c + 1)][0] - 2, 82)
        f.arrow (at[(1, c + 1)][0], 192, at[(1, c)][0] + 188, 192)
    f.arrow (755, 114, 755, 158)
    f.text (770, 140, "and again", 12, PALE)
    f.text (20, 30, "each frame", 14, bold=True)
    f.rect (20, 262, 300, 50, BODY, 1.6, TABLE, rounding=6)
    f.text (170, 283, "every 10th frame: keyframe", 13, anchor="middle", bold=True)
    f.text (170, 301, "oriented points and free space", 12, PALE, "middle")
    f.rect (450, 262, 400, 50, BODY, 1.6, TABLE, rounding=6)
    f.text (650, 283, "back end: Co-Section on all that was kept", 13, anchor="middle", bold=True)
    f.text (650, 301, "warm-started updates, one solution at the end", 12, PALE, "middle")
    f.arrow (322, 287, 448, 287, BODY, 2)
    f.arrow (113, 224, 113, 260, BODY, 2)
    f.save ("method_front_end.svg")


# --- Architecture ----------------------------------------------------------------------------------------------------

def architecture ():
    f = Svg (1000, 720)
    scene, stream = HULL, INFERRED
    rows = [
        (30, [("tools", ["one small main per program, option groups; no algorithm"], 90, 850)]),
        (112, [("visualization", ["pictures; the window"], 90, 160), ("fusion", ["tracking · mapping · association · backend"], 275, 285),
               ("sequence", ["RGB-D, masks"], 585, 110), ("simulation", ["scenes"], 710, 110), ("evaluation", ["scores"], 835, 105)]),
        (212, [("completion", ["observe → support planes → grids → evidence → background → energies → priors → joint solve → meshes"], 90, 850)]),
        (304, [("priors", ["what hidden surface is expected"], 90, 250), ("energy", ["data · constraints · solver (eq. 1–5)"], 355, 265),
               ("segmentation", ["geometry · motion · network"], 635, 190), ("tracking", ["pose"], 840, 100)]),
        (392, [("view", ["camera, normals, mixed pixels, range image, sensor pose, visibility"], 90, 850)]),
        (474, [("io", ["files, and nothing but files"], 90, 560), ("rendering", ["rasteriser"], 670, 270)]),
        (566, [("volume", ["grids, TSDF, iso surface"], 90, 270), ("mesh", ["triangle meshes, decimation"], 380, 270),
               ("common", ["errors, parallel loops, robust statistics"], 670, 270)]),
    ]
    for y, boxes in rows:
        for name, below, x, w in boxes:
            f.rect (x, y, w, 56, INK, 1.4, "#ffffff", rounding=6)
            f.text (x + w / 2, y + 24, name, 15, anchor="middle", bold=True)
            f.text (x + w / 2, y + 43, below[0], 11.5, PALE, "middle")
    f.add (f'<text transform="rotate(-90 28 330)" x="28" y="330" font-size="13" fill="{PALE}" text-anchor="middle">dependencies go downwards only</text>')
    f.arrow (42, 180, 42, 480, PALE, 1.4)
    f.arrow (340, 332, 354, 332, PALE, 1.4)
    f.arrow (106, 474, 106, 450, scene, 3.5)
    f.arrow (106, 392, 106, 270, scene, 3.5)
    f.path ([(90, 240), (68, 240), (68, 502), (84, 502)], scene, 3.5)
    f.arrow (70, 502, 89, 502, scene, 3.5)
    f.arrow (585, 140, 562, 140, stream, 3.5)
    f.arrow (420, 168, 420, 210, stream, 3.5)
    f.arrow (460, 212, 460, 170, stream, 3.5)
    f.path ([(275, 150), (263, 150), (263, 198), (972, 198), (972, 548), (297, 548)], stream, 3.5)
    f.arrow (297, 548, 297, 532, stream, 3.5)
    f.line (90, 668, 130, 668, scene, 4)
    f.text (140, 673, "a scene of PCD views: io reads, view prepares, completion solves, io writes meshes", 13)
    f.line (90, 694, 130, 694, stream, 4)
    f.text (140, 699, "an RGB-D sequence: sequence reads, fusion tracks and maps, completion solves, io writes trajectories and meshes", 13)
    f.save ("architecture.svg")


if __name__ == "__main__":
    for draw in (setup, data, hessian, hull, carving, intersection, support_plane, solver, extent, symmetry, vessel, open_box, extrusion,
                 inferred_plane, no_return, provenance, front_end, architecture, constraints):
        draw ()
