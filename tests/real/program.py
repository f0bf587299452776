# SPDX-License-Identifier: Apache-2.0
"""The program under test, and what its answers say about readings."""
import csv
import io
import json
import math
import re
import subprocess


class Failed(Exception):
    pass


def mgt(programs, *words):
    done = subprocess.run([programs / "mgt", *map(str, words)], capture_output=True, text=True)
    if done.returncode not in (0, 1) or (done.returncode == 1 and not done.stdout):
        raise Failed(f"mgt {' '.join(map(str, words))}: exit {done.returncode}: {done.stderr.strip()}")
    return done.stdout


def fields(programs, calibration, run, sensors):
    """Calibrated field of every row, one list for each sensor."""
    rows = list(csv.DictReader(io.StringIO(mgt(programs, "apply", calibration, run))))
    return [[[float(row[f"s{s + 1}_b{axis}_nT"]) for axis in "xyz"] for row in rows] for s in range(sensors)]


def size(v):
    return math.sqrt(sum(c * c for c in v))


def mean(values):
    return sum(values) / len(values)


def rms(values):
    return math.sqrt(mean([v * v for v in values]))


def spread(vectors, field_nT):
    """rms of | |b| - F | over F; F is the mean of |b| where no field is given."""
    sizes = [size(v) for v in vectors]
    field = field_nT or mean(sizes)
    return rms([s / field - 1 for s in sizes])


def distance(vectors, others):
    return rms([size([p - q for p, q in zip(a, b)]) for a, b in zip(vectors, others)])


def capital(sentence):
    """Its first letter in upper case, unless it begins with a name: s2, axis.cubic."""
    return sentence if re.match(r"s\d|\w+\.\w", sentence) else sentence[:1].upper() + sentence[1:]


def improved(programs, run, options, calibration):
    """Effects that improve adds, and in words why it adds no more."""
    try:
        answer = json.loads(mgt(programs, "improve", run, *options, "-o", calibration, "--json"))
    except Failed as refused:
        return [], str(refused)
    if "error" in answer:
        return [], "refused: " + answer["error"]["message"]
    why = ". ".join(map(capital, [answer["stopped"], *answer["notes"]]))
    law = answer.get("law")
    if law:
        why += f". The search for a formula says {law['verdict']}"
        why += f": {law['reason']['text']}" if law.get("reason") else ""
    return [r["spec"] for r in answer["rounds"]], why
