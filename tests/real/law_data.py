# SPDX-License-Identifier: Apache-2.0
"""What mgt makes of fluxgates of which laws are published and no readings; published_laws.py makes the readings."""
import csv
import dataclasses
import io
import json
import math

from nine_parameters import fitted_sizes
from program import Failed, distance, fields, improved, mean, mgt, rms, spread
from published_laws import FIELD_NT, flight_model, four_fluxgates, in_steps, pose_table, ramp
from twelve_parameters import fitted_fields

POSES = 240
SEED = 1
RANGE = "2"  # of the flight models: three temperatures were measured in it


def swing(middle, amplitude, poses):
    return [middle + amplitude * math.sin(4 * math.pi * pose / poses) for pose in range(poses)]


@dataclasses.dataclass
class Set:
    name: str
    what: str
    sensors: object  # folder -> fluxgates
    temperatures: object  # fluxgates -> degC of every pose
    told: bool = True  # the temperature stands in the table
    vector: bool = False  # the field is known as a vector
    laws: tuple = ()  # explain must name them all and nothing else, and improve end at the noise
    quick: bool = True  # a check has time for it


def flight(model):
    return lambda folder: [flight_model(folder, model, RANGE)]


def measured(sensors):
    return in_steps(sorted(sensors[0].matrices), POSES)


def rising(_):
    return ramp(18, 21, POSES)


def swinging(_):
    return swing(19.5, 1.5, POSES)


def of_temperature(*laws):
    return tuple(f"axis.{law}.temperature{power}" for law in laws for power in ("", "2"))


MATRIX = of_temperature("gain", "orthogonality")

SETS = [
    Set("fluxgates_untold", "four fluxgates of one set, 18 to 21 degC, temperature not in the table", four_fluxgates, rising, told=False,
        quick=False),
    Set("fluxgates", "the same, temperature in the table", four_fluxgates, rising, quick=False),
    Set("fluxgates_swing", "the same, twice up and down between 18 and 21 degC", four_fluxgates, swinging,
        laws=of_temperature("offset", "gain", "orthogonality"), quick=False),
    Set("fm4", "flight fluxgate at -30, 0 and 26 degC", flight("fm4"), measured, laws=MATRIX),
    Set("fm5", "flight fluxgate at -20, -10 and 20 degC", flight("fm5"), measured, laws=MATRIX),
    Set("fluxgates_vector", "the four, 18 to 21 degC", four_fluxgates, rising, vector=True, quick=False),
    Set("fm4_vector", "flight fluxgate FM4", flight("fm4"), measured, vector=True, laws=MATRIX),
    Set("fm5_vector", "flight fluxgate FM5", flight("fm5"), measured, vector=True, laws=MATRIX),
]


@dataclasses.dataclass
class Outcome:
    """rms in nT for each sensor: of |b| - F, or of b - B where the field is known as a vector."""
    before: list
    after: list
    independent: list
    verdict: str
    improved: list
    last: list | None  # after improve
    why: str


def tried(programs, given, data, folder):
    sensors = given.sensors(data)
    text = pose_table(sensors, given.temperatures(sensors), SEED, given.told, given.vector)
    run, calibration, better = folder / "run.csv", folder / "cal.json", folder / "better.json"
    run.write_text(text)
    rows = list(csv.DictReader(io.StringIO(text)))
    readings = [[[float(row[f"s{s + 1}_{axis}_nT"]) for axis in "xyz"] for row in rows] for s in range(len(sensors))]
    if given.vector:
        known = [[float(row[f"ref_{axis}_nT"]) for axis in "xyz"] for row in rows]
        left = lambda vectors: distance(vectors, known)
        independent = [distance(fitted_fields(y, known), known) for y in readings]
    else:
        left = lambda vectors: FIELD_NT * spread(vectors, FIELD_NT)
        independent = []
        for sizes in map(fitted_sizes, readings):
            independent.append(FIELD_NT * rms([s / mean(sizes) - 1 for s in sizes]))
    mgt(programs, "fit", run, "-o", calibration, "--json")
    names, why = improved(programs, run, [], better)
    try:
        verdict = mgt(programs, "explain", run, "--no-law").splitlines()[0]
    except Failed:
        verdict = "refused"
    return Outcome(
        before=[left(y) for y in readings],
        after=[left(b) for b in fields(programs, calibration, run, len(sensors))],
        independent=independent,
        verdict=verdict,
        improved=names,
        last=[left(b) for b in fields(programs, better, run, len(sensors))] if better.exists() else None,
        why=why,
    )


def complaints(given, outcome):
    for after, independent in zip(outcome.after, outcome.independent):
        if after > 1.02 * independent:
            yield f"{given.name}: the fit leaves {after:.3g} nT, an independent one {independent:.3g}"
    named = outcome.verdict.removeprefix("EXPLAINED: ").split(", ")
    if given.laws and sorted(named) != sorted(given.laws):
        yield f"{given.name}: explain says {outcome.verdict}, the readings follow {', '.join(given.laws)}"
    if given.laws and (not outcome.last or max(outcome.last) > 0.25):
        yield f"{given.name}: improve leaves {outcome.last} nT of noise of 0.1 nT on each axis"
