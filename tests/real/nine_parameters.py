# SPDX-License-Identifier: Apache-2.0
"""Offset and upper triangular matrix of one magnetometer, by damped least squares of |K (y - o)| - 1.

Written without the program that it is compared with; nothing is left out and nothing is weighed.
"""
import math


def sizes(x, samples):
    for y in samples:
        d = [y[i] - x[6 + i] for i in range(3)]
        b = [x[0] * d[0] + x[1] * d[1] + x[2] * d[2], x[3] * d[1] + x[4] * d[2], x[5] * d[2]]
        yield d, b, math.sqrt(b[0] ** 2 + b[1] ** 2 + b[2] ** 2)


def solved(a, b):
    rows = [line + [right] for line, right in zip(a, b)]
    for k in range(len(rows)):  # positive definite: the diagonal is a pivot
        for j in range(k + 1, len(rows)):
            share = rows[j][k] / rows[k][k]
            rows[j] = [p - share * q for p, q in zip(rows[j], rows[k])]
    x = [0.0] * len(rows)
    for k in reversed(range(len(rows))):
        x[k] = (rows[k][-1] - sum(rows[k][j] * x[j] for j in range(k + 1, len(rows)))) / rows[k][k]
    return x


def fitted_sizes(readings):
    """|b| of every reading after the best nine parameters, in units of the field."""
    centre = [sum(y[i] for y in readings) / len(readings) for i in range(3)]
    radius = math.sqrt(sum((y[i] - centre[i]) ** 2 for y in readings for i in range(3)) / len(readings))
    samples = [[(y[i] - centre[i]) / radius for i in range(3)] for y in readings]
    x, damping, cost = [1.0, 0, 0, 1.0, 0, 1.0, 0, 0, 0], 1e-3, math.inf
    for _ in range(100):
        a, right = [[0.0] * 9 for _ in range(9)], [0.0] * 9
        for d, b, m in sizes(x, samples):
            u = [c / m for c in b]
            row = [u[0] * d[0], u[0] * d[1], u[0] * d[2], u[1] * d[1], u[1] * d[2], u[2] * d[2],
                   -x[0] * u[0], -x[1] * u[0] - x[3] * u[1], -x[2] * u[0] - x[4] * u[1] - x[5] * u[2]]
            for i in range(9):
                right[i] += row[i] * (1 - m)
                a[i] = [p + row[i] * q for p, q in zip(a[i], row)]
        before = sum((m - 1) ** 2 for _, _, m in sizes(x, samples))
        while damping < 1e9:
            step = solved([[v * (1 + damping * (i == j)) for j, v in enumerate(line)] for i, line in enumerate(a)], right)
            trial = [p + q for p, q in zip(x, step)]
            cost = sum((m - 1) ** 2 for _, _, m in sizes(trial, samples))
            if cost <= before:
                break
            damping *= 10
        else:
            break
        x, damping = trial, damping / 10
        if before - cost < 1e-12 * before:
            break
    return [m for _, _, m in sizes(x, samples)]
