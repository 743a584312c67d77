#!/usr/bin/env python3
"""Writes the parts of the machines of this guide as binary STL files, in millimetres.

    python3 parts.py [NAME...]      deflector, guides, deck, bin; all of them if left out
"""

import math
import struct
import sys


def save(name, triangles):
    with open(f"{name}.stl", "wb") as file:
        file.write(name.encode().ljust(80) + struct.pack("<I", len(triangles)))
        for a, b, c in triangles:
            u, v = ([q - p for p, q in zip(a, end)] for end in (b, c))
            normal = [u[i - 2] * v[i - 1] - u[i - 1] * v[i - 2] for i in range(3)]
            size = math.hypot(*normal)
            numbers = [n / size for n in normal] + [*a, *b, *c]
            file.write(struct.pack("<12fH", *numbers, 0))


def quad(a, b, c, d):
    return [(a, b, c), (a, c, d)]


def blocks(xs, ys, zs, is_full):
    """The cells of a grid whose middle is full, as one closed surface."""
    grid = (xs, ys, zs)

    def full(cell):
        if not all(0 <= i < len(lines) - 1 for i, lines in zip(cell, grid)):
            return False
        return is_full(*((lines[i] + lines[i + 1]) / 2 for i, lines in zip(cell, grid)))

    cells = [
        (i, j, k)
        for i in range(len(xs) - 1)
        for j in range(len(ys) - 1)
        for k in range(len(zs) - 1)
    ]
    triangles = []
    for cell in filter(full, cells):
        for axis in range(3):
            for side in (0, 1):
                beside = list(cell)
                beside[axis] += 2 * side - 1
                if full(beside):
                    continue
                corners = []
                for steps in ((0, 0), (1, 0), (1, 1), (0, 1)):
                    corner = list(cell)
                    corner[axis] += side
                    corner[(axis + 1) % 3] += steps[0]
                    corner[(axis + 2) % 3] += steps[1]
                    corners.append(tuple(float(grid[d][corner[d]]) for d in range(3)))
                triangles += quad(*(corners if side else reversed(corners)))
    return triangles


def prism(pairs, low, high, place):
    """A strip between pairs of points of a plane, from `low` to `high` across the plane."""
    at = [[[place(*point, h) for h in (low, high)] for point in pair] for pair in pairs]
    triangles = []
    for (left, right), (next_left, next_right) in zip(at, at[1:]):
        triangles += quad(left[1], right[1], next_right[1], next_left[1])
        triangles += quad(left[0], next_left[0], next_right[0], right[0])
        triangles += quad(left[0], left[1], next_left[1], next_left[0])
        triangles += quad(right[0], next_right[0], next_right[1], right[1])
    for left, right in (at[0], reversed(at[-1])):
        triangles += quad(left[0], right[0], right[1], left[1])
    return triangles


def deflector():
    """A pad of 30 mm that bends the way of the fruit by a quarter turn, then goes straight on."""
    pairs = []
    for angle in range(0, 91, 9):
        s, c = math.sin(math.radians(angle)), math.cos(math.radians(angle))
        pairs.append([(110 + r * s, 190 - r * c) for r in (300, 330)])
    pairs.append([(410, 600), (440, 600)])
    return prism(pairs, 45, 170, lambda x, y, z: (x, y, z))


def guides():
    """A sheet on either side of a belt 300 mm wide, with a flange folded outwards."""
    triangles = []
    for y, outwards in ((0, -30), (300, 30)):
        profile = [(y, 102), (y, 200), (y + outwards, 200)]
        for (y0, z0), (y1, z1) in zip(profile, profile[1:]):
            triangles += quad((-800, y0, z0), (20, y0, z0), (20, y1, z1), (-800, y1, z1))
    return triangles


def deck():
    """Six hexagonal bars 16 mm across whose gaps widen from 70 to 80 mm, between two rails."""
    triangles = []
    corner = [(8 * math.cos(k * math.pi / 3), 8 * math.sin(k * math.pi / 3) - 7) for k in range(6)]
    hexagon = [(corner[4], corner[5]), (corner[3], corner[0]), (corner[2], corner[1])]
    for bar in range(6):
        begin, end = (250 + (bar - 2.5) * pitch for pitch in (86, 96))
        triangles += prism(
            hexagon, 0, 600, lambda y, z, x: (x, (end if x else begin) + y, z)
        )
    for side in (-1, 1):
        left, right = sorted((0, 8 * side))
        rail = [((left, -30), (right, -30)), ((left, 100), (right, 100))]
        triangles += prism(
            rail, 0, 610, lambda y, z, x: (x, 250 + side * (250 if x else 225) + y, z)
        )
    return triangles


def ribbed_bin():
    """600 x 500 x 400 mm with walls of 10 mm, ribs and a rim of 15 mm outside, a floor of 25 mm."""
    xs = [0, 15, 25, 140, 170, 285, 315, 430, 460, 575, 585, 600]
    ys = [0, 15, 25, 120, 150, 235, 265, 350, 380, 475, 485, 500]
    zs = [0, 25, 360, 400]

    def is_full(x, y, z):
        if 25 < x < 575 and 25 < y < 475:
            return z < 25
        across, along = 15 < x < 585, 15 < y < 485
        if across and along:
            return True
        rim = z > 360
        ribs = (140, 285, 430) if across else (120, 235, 350)
        at = x if across else y
        return (across or along) and (rim or any(rib < at < rib + 30 for rib in ribs))

    return blocks(xs, ys, zs, is_full)


PARTS = {"deflector": deflector, "guides": guides, "deck": deck, "bin": ribbed_bin}

for name in sys.argv[1:] or PARTS:
    save(name, PARTS[name]())
