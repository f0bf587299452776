# SPDX-License-Identifier: Apache-2.0
"""The page docs/real-data.md in Markdown."""
import whole
from law_data import POSES
from program import capital


def figures(values):
    return " / ".join(f"{v:.3g}" if v else "-" for v in values)


def sentence(text):
    return capital(text).replace("@", " at ").replace("|", "\\|").rstrip(".") + "."


def added(names):
    return ", ".join(f"`{n}`" for n in names) or "nothing added"


def recordings(outcomes):
    print("""| set | what | samples | before | nine parameters | nothing left out | independent | others | unseen fifths | left out | `explain` | after `improve` |
|---|---|---:|---:|---:|---:|---:|---:|---:|---:|---|---|""")
    for given, o in outcomes:
        if o is None:
            continue
        unseen = "no calibration" if o.unseen is None else figures(o.unseen)
        print(f"| {given.name} | {given.what} | {o.samples} | {figures(o.before)} | {figures(o.after)} | {figures(o.keeping_all)} | {figures(o.independent)} | "
              f"{figures(given.known)} | {unseen} | {o.left_out} | {o.verdict} | {added(o.improved)} |")


def entire(outcomes):
    print("\n## The whole recordings\n")
    if not outcomes:
        print("Not measured for this page: it was written without `--whole DIR`.")
        return
    print("""The same, of every row that the sources hold; `DIR` is a folder with their files, by the names that [the table of sources](../tests/data/real/README.md) gives. "Others" can be compared with these rows directly. The extract of `pair` is whole: it has every row with a new reading of the slower sensor.
""")
    recordings(outcomes)
    print()
    for given, o in outcomes:
        if o is None:
            print(f"- **{given.name}** is not measured: the folder had no `{whole.SOURCES[given.name][0]}`.")
        else:
            print(f"- **{given.name}**: {sentence(o.why)}")


def law_tables(of_laws, pairs):
    print(f"""
## Fluxgates with published laws

Of six real fluxgates the laws are published and no readings: offset, scale and angles of four of one set as quadratic functions of temperature, and the transfer matrices of the flight models FM4 and FM5 of the magnetometer on IMAP, measured at three temperatures each in range 2 ([sources](../tests/data/real/README.md)). [published_laws.py](../tests/real/published_laws.py) makes readings of them: {POSES} random attitudes, a field of 50 000 nT, dwells of 100 samples, a noise of 0.1 nT in their mean. The laws are measured; attitudes, field, noise and the course of the temperature are ours. The four see one temperature, a flight model the measured ones one after the other. These rows come from the same command.

Figures are in nT, rms of |b| - F, for each sensor in turn; "independent" is the fit of nine parameters as above.

| set | what | before | nine parameters | independent | `explain` | `improve` adds | after it |
|---|---|---:|---:|---:|---|---|---:|""")
    for given, o in of_laws:
        if not given.vector:
            law_row(given, o)
    print()
    for given, o in of_laws:
        if not given.vector:
            print(f"- **{given.name}**: {sentence(o.why)}")
    print("""
On `fluxgates_swing`, `fm4` and `fm5` `explain` names the laws that the readings follow and no others. On `fluxgates` the temperature rises evenly with time: what drifts and what follows the temperature look alike, and `explain` says so (AMBIGUOUS). On `fluxgates_untold` the two drifts are right for the same reason.

## Twelve parameters

Where the field is known as a vector, the three angles to its frame are determined beside the nine, and the figure is the rms of |b - B|. "Independent" is the affine map of the readings with the least |b - B|, by [twelve_parameters.py](../tests/real/twelve_parameters.py), which shares nothing with the program. The readings are those of the laws above, in nT, for each sensor in turn:

| set | what | before | twelve parameters | independent | `explain` | `improve` adds | after it |
|---|---|---:|---:|---:|---|---|---:|""")
    for given, o in of_laws:
        if given.vector:
            law_row(given, o)
    print()
    for given, o in of_laws:
        if given.vector:
            print(f"- **{given.name}**: {sentence(o.why)}")
    for o in pairs:
        before, joint, mapped = o.twelve
        print(f"""
Of `pair` no field is known as a vector, and its two sensors measure one field: the rms of |b1 - b2| over F is {before:.3g} of the readings, {joint:.3g} after the joint fit (nine parameters of s1, twelve of s2), and {mapped:.3g} with the affine map of the readings of s2 that comes nearest to s1 as calibrated by the program.""")


def law_row(given, o):
    last = figures(o.last) if o.last else "no calibration"
    print(f"| {given.name} | {given.what} | {figures(o.before)} | {figures(o.after)} | {figures(o.independent)} | {o.verdict} | {added(o.improved)} | {last} |")


def page(outcomes, of_laws, of_whole):
    print("""# Real recordings

Magnetometers, turned by hand, one sample a row, five single ones and a pair; the extracts stand in [tests/data/real](../tests/data/real/README.md) with source and licence. This page is written by

    python3 tests/real/real_data.py build/bin --whole DIR > docs/real-data.md

Every figure of the recordings is the rms of | |b| - F | over F: of the raw readings about their mean, after nine parameters, and on each fifth of the time with the calibration of the other four fifths. F is the known field, or where none is known the mean of |b|. A pair has two figures, s1 / s2. All samples count, those too that the fit leaves out; "nothing left out" is the fit with `--keep-all`, the figure to compare with plain least squares. "Others" is the best figure known for the whole recording, by independent programs. The list that gives these figures has those of the two drone sets the other way round, 0.0113 and 0.042; the independent fit confirms that they belong as they stand in the table. "Independent" is plain least squares of | |b| - F | over all samples of the extract with the mean of |b| for F, by [nine_parameters.py](../tests/real/nine_parameters.py), which shares nothing with the program. On `hand_2` the two end apart: its samples do not determine nine parameters.
""")
    recordings(outcomes)
    print("""
None of these calibrations is accepted, and none should be: what is left is far more than the noise of a magnetometer. `mgt fit` gives the reasons, with the total field of the samples it kept:
""")
    for given, o in outcomes:
        first = [r for r in o.reasons if r.startswith(("total field", "coverage"))]
        print(f"- **{given.name}**: " + ". ".join(map(capital, first)) + ".")
    print("""
Something is there beyond nine parameters (UNKNOWN). No currents and no attitudes stand beside these readings, and the temperature of the board and the battery's voltage beside the pair alone, so nothing here says what it is, and no name is given. Why `mgt improve` adds nothing, as it says itself:
""")
    for given, o in outcomes:
        print(f"- **{given.name}**: {sentence(o.why)}")
    print("""
`hand_2` must be refused: it covers a part of the sphere, and its small residual says nothing about the rest of it. "No calibration" means that without one of the fifths the rest determines none.

The places of the two sensors of `pair` are not published. The fit needs them for nothing but the gradient, of which this page says nothing. Only the rows in which the slower sensor has a new reading are taken: the source repeats its last one up to four times.""")
    entire(of_whole)
    law_tables(of_laws, [o for _, o in outcomes if o.twelve])
    print("""
More runs with these temperature laws are simulated in `tests/scenarios/paper_experiment.toml` and [the blind benchmark](blind-benchmark.md). Still means of an accelerometer, which is calibrated by gravity as a magnetometer is by the field, are in [tests/data/constant_norm_static](../tests/data/constant_norm_static/README.md) and checked by `tests/unit/calib/fit/real_sensor_test.cc`.""")
