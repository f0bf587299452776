# SPDX-License-Identifier: Apache-2.0
"""The affine map, twelve numbers, that brings readings nearest to a known field: linear least squares of |A y + c - b|.

Written without the program that it is compared with; nothing is left out and nothing is weighed.
"""
from nine_parameters import solved


def fitted_fields(readings, fields):
    """A y + c of every reading y, with the A and c that leave least against the fields b."""
    count = len(readings)
    centre = [sum(y[i] for y in readings) / count for i in range(3)]
    scale = max(abs(y[i] - centre[i]) for y in readings for i in range(3))
    rows = [[(y[i] - centre[i]) / scale for i in range(3)] + [1.0] for y in readings]
    normal = [[sum(r[i] * r[j] for r in rows) for j in range(4)] for i in range(4)]
    maps = [solved(normal, [sum(r[i] * b[axis] for r, b in zip(rows, fields)) for i in range(4)]) for axis in range(3)]
    return [[sum(p * q for p, q in zip(x, r)) for x in maps] for r in rows]
