#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What mgt makes of real recordings, as the page docs/real-data.md.

    python3 tests/real/real_data.py build/bin --whole DIR > docs/real-data.md
    python3 tests/real/real_data.py build/bin --check

With --whole DIR the page has the whole recordings too. DIR holds the files of the sources, by the names they have there (whole.py);
a file that is missing is named on the page.

--check writes no page. It fails where a residual is more than 2 % (a pair: 5 %) larger than the best known one, where a law is named
(nobody knows one in the recordings), where the set that does not cover the sphere is accepted or refused for another reason, or where
improve does not come down to the noise on published laws whose temperature and field vector are told.
"""
import argparse
import dataclasses
import json
import math
import pathlib
import re
import sys
import tempfile

import law_data
import real_page
import whole
from nine_parameters import fitted_sizes
from program import Failed, distance, fields, improved, mean, mgt, rms, size, spread
from twelve_parameters import fitted_fields

DATA = pathlib.Path(__file__).resolve().parent.parent / "data" / "real"
BLOCKS = 5


@dataclasses.dataclass
class Set:
    name: str
    columns: str
    what: str
    known: tuple  # rms of | |b| - F | over F after nine parameters, by others, of the whole recording, for each sensor; 0: none
    field_nT: float = 0  # 0: not known, the scale is free
    covers: bool = True
    first: int = 0  # cell of a row in which the readings begin
    every: int = 1  # the extract holds one row of so many

    @property
    def sensors(self):
        return len(self.known)

    def readings(self, rows):
        cells = [[float(c) for c in row.split(",")] for row in rows[1:]]
        return [[row[self.first + 3 * s:self.first + 3 * s + 3] for row in cells] for s in range(self.sensors)]


SETS = [
    Set("hand_1", "hand", "magnetometer turned by hand", (2.6e-2,), every=2),
    Set("hand_2", "hand", "the same, part of the sphere only", (0,), covers=False, every=6),
    Set("drone_00", "drone", "racing drone, motors off", (4.2e-2,), every=16),
    Set("drone_03", "drone", "the same, another day", (1.13e-2,), every=4),
    Set("rm3100", "rm3100", "RM3100 on a quadrotor", (344 / 57130,), field_nT=57130, every=3),
    Set("pair", "pair", "RM3100 and MPU-9250 on that quadrotor, N = 2", (0, 0), field_nT=57130, first=1),
]


class Recording:
    """One set: its rows, and the folder in which run files of it are made."""

    def __init__(self, programs, given, rows, folder, entire):
        self.programs, self.given, self.rows, self.folder = programs, given, rows, folder
        text = (DATA / f"{given.columns}.toml").read_text()
        if entire:
            text = re.sub(r"rate_hz = ([0-9.]+)", lambda m: f"rate_hz = {float(m[1]) * given.every}", text)
        self.columns = folder / "columns.toml"
        self.columns.write_text(text)
        self.options = ["--field", given.field_nT] if given.field_nT else []

    def run(self, samples, name):
        text = self.folder / f"{name}.csv"
        text.write_text("\n".join(self.rows[:1] + samples) + "\n")
        run = self.folder / f"{name}.mgtrun"
        array = ["--array", DATA / f"{self.given.name}_array.toml"] if self.given.sensors > 1 else []
        mgt(self.programs, "import", text, "--columns", self.columns, *array, "-o", run)
        return run

    def fields(self, calibration, run):
        return fields(self.programs, calibration, run, self.given.sensors)

    def spreads(self, calibration, run):
        return [spread(b, self.given.field_nT) for b in self.fields(calibration, run)]


def rms_before(given, rows):
    return [spread(raw, 0) for raw in given.readings(rows)]


def rms_independent(given, rows):
    """After nine parameters fitted by nine_parameters.py, without the program."""
    sizes = [fitted_sizes(readings) for readings in given.readings(rows)]
    return [rms([s / mean(one) - 1 for s in one]) for one in sizes]


def rms_unseen(recording):
    """Each fifth of the time in turn, with the calibration of the other four fifths.

    None where four fifths do not give a calibration at all.
    """
    given, samples = recording.given, recording.rows[1:]
    squares = [0.0] * given.sensors
    for block in range(BLOCKS):
        first, last = block * len(samples) // BLOCKS, (block + 1) * len(samples) // BLOCKS
        seen = recording.run(samples[:first] + samples[last:], f"seen{block}")
        unseen = recording.run(samples[first:last], f"unseen{block}")
        calibration = recording.folder / f"block{block}.json"
        mgt(recording.programs, "fit", seen, *recording.options, "-o", calibration, "--json")
        if not calibration.exists():  # these attitudes determine nothing
            return None
        pairs = zip(recording.fields(calibration, seen), recording.fields(calibration, unseen))
        for s, (before, after) in enumerate(pairs):
            field_nT = given.field_nT or mean([size(b) for b in before])
            squares[s] += (last - first) * spread(after, field_nT) ** 2
    return [math.sqrt(square / len(samples)) for square in squares]


@dataclasses.dataclass
class Outcome:
    samples: int
    before: list
    after: list
    keeping_all: list  # after nine parameters, nothing left out
    independent: list
    unseen: list | None
    accepted: bool
    reasons: list
    left_out: int
    verdict: str
    improved: list
    why: str
    twelve: tuple  # of a pair: rms of |b1 - b2| over F before, after the joint fit, after an affine map


def twelve_of_pair(given, readings, after):
    """What is left between both sensors: of the readings, of the joint fit, of the best affine map of s2 on what s1 measures."""
    mapped = fitted_fields(readings[1], after[0])
    # All maps read uT and the fields are in nT.
    return tuple(d / given.field_nT for d in (1000 * distance(*readings), distance(*after), distance(mapped, after[0])))


def tried(programs, given, rows, folder, page, entire=False):
    recording = Recording(programs, given, rows, folder, entire)
    run = recording.run(rows[1:], given.name)
    calibration = folder / f"{given.name}.json"
    fit = json.loads(mgt(programs, "fit", run, *recording.options, "-o", calibration, "--json"))
    plain = folder / f"{given.name}_all.json"
    mgt(programs, "fit", run, *recording.options, "--keep-all", "-o", plain, "--json")
    names, why = improved(programs, run, recording.options + ([] if page else ["--no-law"]), folder / "improved.json")
    return Outcome(
        samples=len(rows) - 1,
        before=rms_before(given, rows),
        after=recording.spreads(calibration, run),
        keeping_all=recording.spreads(plain, run),
        independent=rms_independent(given, rows),
        unseen=rms_unseen(recording) if page else None,
        accepted=fit["accepted"],
        reasons=fit["reasons"],
        left_out=len(fit["outliers"]),
        verdict=mgt(programs, "explain", run, *recording.options, "--no-law").splitlines()[0],
        improved=names,
        why=why,
        twelve=twelve_of_pair(given, given.readings(rows), recording.fields(calibration, run)) if given.sensors == 2 else (),
    )


def complaints(given, outcome):
    for known, after, independent in zip(given.known, outcome.after, outcome.independent):
        if known and after > 1.02 * known:
            yield f"{given.name}: nine parameters leave {after:.3g} of the field, by others {known:.3g}"
        # Nine parameters of a pair serve the agreement of the two as well.
        if given.covers and after > (1.05 if given.sensors > 1 else 1.02) * independent:
            yield f"{given.name}: nine parameters leave {after:.3g}, an independent fit {independent:.3g}"
    if ":" in outcome.verdict:
        yield f"{given.name}: explain names a law: {outcome.verdict}"
    if outcome.improved:
        yield f"{given.name}: improve adds {', '.join(outcome.improved)}"
    refused = any(reason.startswith("coverage") for reason in outcome.reasons)
    if refused == given.covers:
        yield f"{given.name}: {'refused for' if refused else 'not refused for'} its coverage"
    if outcome.accepted:
        yield f"{given.name}: accepted, though it leaves more than 0.1 % of the field"


def by_folder(programs, given, rows, page, entire=False):
    with tempfile.TemporaryDirectory() as folder:
        return tried(programs, given, rows, pathlib.Path(folder), page, entire)


def laws(programs, quick):
    for one in law_data.SETS:
        if one.quick or not quick:
            with tempfile.TemporaryDirectory() as folder:
                yield one, law_data.tried(programs, one, DATA, pathlib.Path(folder))


def entire_recordings(programs, folder):
    """Of every set (set, outcome), or (set, None) where the folder lacks it."""
    for given in (one for one in SETS if one.name in whole.SOURCES):
        rows = whole.rows_of(folder, given.name)
        yield given, rows and by_folder(programs, given, rows, True, entire=True)


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("programs", type=lambda p: pathlib.Path(p).resolve(), help="folder with mgt")
    options.add_argument("--check", action="store_true", help="compare with what is known; write no page")
    options.add_argument("--whole", metavar="DIR", type=pathlib.Path, help="folder with the files of the sources")
    given = options.parse_args()
    outcomes = []
    for one in SETS:
        rows = (DATA / f"{one.name}.csv").read_text().splitlines()
        outcomes.append((one, by_folder(given.programs, one, rows, not given.check)))
    of_laws = list(laws(given.programs, given.check))
    if not given.check:
        real_page.page(outcomes, of_laws, list(entire_recordings(given.programs, given.whole)) if given.whole else [])
        return 0
    found = [text for one, outcome in outcomes for text in complaints(one, outcome)]
    found += [text for one, outcome in of_laws for text in law_data.complaints(one, outcome)]
    print("\n".join(found) or f"{len(outcomes)} recordings and {len(of_laws)} sets of published laws, all as they should be")
    return 1 if found else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except Failed as failure:
        sys.exit(str(failure))
