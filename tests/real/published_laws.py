# SPDX-License-Identifier: Apache-2.0
"""Pose tables of fluxgates of which laws are published and no readings: a random attitude a pose, the field and noise chosen here.

Only the laws are real. y = S(T) P(T)^-1 b + o(T) for the four of one set, y = M(T) b for the two flight models.
"""
import csv
import dataclasses
import math
import pathlib
import random

FIELD_NT = 50000.0
SAMPLES, SAMPLE_SD_NT = 100, 1.0  # of one dwell: 0.1 nT in its mean
SPACING_S = 20.0


def inverse_of_lower(m):
    """Of a 3 x 3 lower triangular matrix."""
    a, b, c = 1 / m[0][0], 1 / m[1][1], 1 / m[2][2]
    return [[a, 0, 0], [-m[1][0] * a * b, b, 0], [(m[1][0] * m[2][1] * b - m[2][0]) * a * c, -m[2][1] * b * c, c]]


def times(m, v):
    return [sum(p * q for p, q in zip(line, v)) for line in m]


@dataclasses.dataclass
class Fluxgate:
    """Quadratic laws of temperature, offset, scale and angles, as published with the correction b = P S^-1 (y - o)."""
    laws: dict

    def at(self, quantity, axis, T_degC):
        return sum(c * T_degC**power for power, c in enumerate(self.laws[quantity, axis]))

    def reading(self, field, T_degC):
        u1, u2, u3 = [math.radians(self.at("angle_arcsec", axis, T_degC) / 3600) for axis in "123"]
        w = math.sqrt(1 - math.sin(u2) ** 2 - math.sin(u3) ** 2)
        p = [[1, 0, 0], [math.tan(u1), 1 / math.cos(u1), 0],
             [-(math.sin(u1) * math.sin(u3) + math.cos(u1) * math.sin(u2)) / (w * math.cos(u1)),
              -math.sin(u3) / (w * math.cos(u1)), 1 / w]]
        skew = times(inverse_of_lower(p), field)
        return [self.at("scale", axis, T_degC) * b + self.at("offset_nT", axis, T_degC) for axis, b in zip("123", skew)]


@dataclasses.dataclass
class FlightModel:
    """Transfer matrices as measured, at the temperatures of the measurement and at no other."""
    matrices: dict

    def reading(self, field, T_degC):
        return times(self.matrices[T_degC], field)


def four_fluxgates(folder):
    laws = {}
    for row in csv.DictReader((folder / "four_fluxgates.csv").open()):
        laws.setdefault(row["sensor"], {})[row["quantity"], row["axis"]] = [float(row[c]) for c in ("c0", "c1_per_C", "c2_per_C2")]
    return [Fluxgate(laws[serial]) for serial in sorted(laws)]


def flight_model(folder, model, gain_range):
    rows = [r for r in csv.DictReader((folder / "imap_fm4_fm5.csv").open()) if (r["model"], r["range"]) == (model, gain_range)]
    return FlightModel({float(r["temp_C"]): [[float(r[f"m{i}{j}"]) for j in "123"] for i in "123"] for r in rows})


def in_steps(temperatures, poses):
    """Poses in as many equal stretches as there are temperatures."""
    return [temperatures[pose * len(temperatures) // poses] for pose in range(poses)]


def ramp(first, last, poses):
    return [first + (last - first) * pose / (poses - 1) for pose in range(poses)]


def direction(draw):
    v = [draw.gauss(0, 1) for _ in range(3)]
    size = math.sqrt(sum(c * c for c in v))
    return [c / size for c in v]


def pose_table(sensors, temperatures, seed, told, vector):
    """CSV. told: the temperature stands in the table; vector: the field stands there as a vector and not as F."""
    draw = random.Random(seed)
    names = [f"s{i + 1}" for i in range(len(sensors))]
    header = ["pose", "t_s", "n", "n_eff"] + (["ref_x_nT", "ref_y_nT", "ref_z_nT", "ref_sd_nT"] if vector else ["f_nT"])
    header += [f"{s}_{axis}_nT" for s in names for axis in "xyz"] + [f"{s}_sd_{axis}_nT" for s in names for axis in "xyz"]
    header += [f"{s}_T_degC" for s in names] if told else []
    lines = [",".join(header)]
    for pose, T_degC in enumerate(temperatures):
        field = [FIELD_NT * c for c in direction(draw)]
        cells = [pose + 1, SPACING_S * pose, SAMPLES, SAMPLES]
        cells += [f"{b:.4f}" for b in field] + [0.05] if vector else [FIELD_NT]
        for sensor in sensors:
            noise = [draw.gauss(0, SAMPLE_SD_NT / math.sqrt(SAMPLES)) for _ in range(3)]
            cells += [f"{y + e:.4f}" for y, e in zip(sensor.reading(field, T_degC), noise)]
        cells += [SAMPLE_SD_NT] * 3 * len(sensors) + ([f"{T_degC:.4f}"] * len(sensors) if told else [])
        lines.append(",".join(map(str, cells)))
    return "\n".join(lines) + "\n"
