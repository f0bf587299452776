#!/usr/bin/env python3
"""The same inputs give the same outputs: two builds of the programs, byte for byte.

  same.py OLD_BIN NEW_BIN [--only WORD]

Makes ten runs with the simulated rig of OLD_BIN (eight of them with a hidden effect or a kind of noise), gives each to
every offline command of both builds, and compares what they write: JSON, text, CAL.json, report. A move, a rename or
another compiler option must leave all of it as it is. Exit code 1 where a byte differs; the first difference is shown.

Not compared: the time at which a file was written, and the version of the program.
"""
import argparse
import difflib
import pathlib
import re
import subprocess
import sys
import tempfile

SCENARIOS = {
    "clean": '[rig]\nparameters = "table6"\nseed = 7\n',
    "table3": '[rig]\nparameters = "table3"\nseed = 8\n',
    "temperature": '[rig]\nseed = 9\n[[effect]]\nname = "axis.offset.temperature"\nwhere = "s2.y"\nnT_per_degC = 3\n',
    "cubic": '[rig]\nseed = 10\n[[effect]]\nname = "axis.cubic"\nwhere = "s3.z"\nnT_at_F0 = 4\n',
    "hysteresis": '[rig]\nseed = 11\n[[effect]]\nname = "axis.hysteresis"\nwhere = "s1.x"\nh_nT = 2\nwidth = 300\n',
    "step": '[rig]\nseed = 12\n[[effect]]\nname = "axis.offset.step"\nwhere = "s4.z"\nnT = 5\nat_s = 2000\n',
    "walk": '[rig]\nseed = 13\n[sensors]\nnoise = "walk"\n',
    "ar": '[rig]\nseed = 14\n[sensors]\nnoise = "ar"\n',
    "quantised": '[rig]\nseed = 15\n[sensors]\nnoise = "quantised"\n',
    "vehicle": '[rig]\nseed = 16\n[[vehicle]]\nat_s = 3000\nnearest_m = 12\nspeed_m_per_s = 5\nmoment_Am2 = 200\n',
}
COMMANDS = {  # what is run on {run}; what it writes besides goes to {out}
    "fit": "fit {run} --json -o {out}.cal.json",
    "fit-text": "fit {run}",
    "fit-two-step": "fit {run} --method two-step --json",
    "fit-simplified": "fit {run} --method simplified --json",
    "compare": "compare {run} --json",
    "compare-text": "compare {run}",
    "explain": "explain {run} --json",
    "explain-text": "explain {run}",
    "improve": "improve {run} --json -o {out}.improved.json",
    "next": "next {run} --json",
    "apply": "apply {run} {run} --json",
    "check": "check {out}.cal.json {run} --json",
    "diff": "diff {run} {run} --json",
    "report": "report {run} -o {out}.html",
}
ONCE = {"effects": "effects --json", "effects-text": "effects", "plan": "plan --json", "plan-text": "plan"}
# Of no meaning here: when it was written, by which version, and what hashes that.
VARYING = re.compile(r'"(written_utc|created_utc|version|program)":\s*"[^"]*"|\d{4}-\d\d-\d\d[T ]\d\d:\d\d:\d\d(\.\d+)?Z?')


def run(program: pathlib.Path, line: str, folder: pathlib.Path):
    done = subprocess.run([program, *line.split()], cwd=folder, capture_output=True, text=True, errors="replace")
    return f"exit {done.returncode}\n{done.stdout}\n{done.stderr}"


def outputs(programs: pathlib.Path, folder: pathlib.Path, only: str):
    out = {}
    for name in SCENARIOS:
        for title, line in COMMANDS.items():
            if only in f"{name}.{title}":
                out[f"{name}.{title}"] = run(programs / "mgt", line.format(run=f"{name}.csv", out=f"{name}"), folder)
    for title, line in ONCE.items():
        if only in title:
            out[title] = run(programs / "mgt", line, folder)
    for path in sorted(folder.iterdir()):
        if path.suffix in (".json", ".html"):
            out[path.name] = path.read_text(errors="replace")
    return {title: VARYING.sub("-", text) for title, text in out.items()}


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("old", type=lambda p: pathlib.Path(p).resolve())
    options.add_argument("new", type=lambda p: pathlib.Path(p).resolve())
    options.add_argument("--only", default="", help="only outputs with this in their name")
    given = options.parse_args()
    found = []
    for programs in (given.old, given.new):
        with tempfile.TemporaryDirectory() as scratch:
            folder = pathlib.Path(scratch) / "runs"
            folder.mkdir()
            for name, text in SCENARIOS.items():
                scenario = folder / f"{name}.toml"
                scenario.write_text(text)
                subprocess.run([given.old / "mgt-rig", "table", "--scenario", scenario, "--poses", "run157", "-o",
                                folder / f"{name}.csv"], check=True, capture_output=True)
                scenario.unlink()
            found.append({title: text.replace(str(folder), "") for title, text in
                          outputs(programs, folder, given.only).items()})
    old, new = found
    differing = [title for title in sorted({*old, *new}) if old.get(title) != new.get(title)]
    for title in differing:
        lines = difflib.unified_diff(old.get(title, "").splitlines(), new.get(title, "").splitlines(), "old", "new",
                                     lineterm="", n=0)
        print(f"{title} differs:", *[line[:300] for line, _ in zip(lines, range(8))], sep="\n  ")
    print(f"{len(old)} outputs, {len(differing)} differ")
    return 1 if differing else 0


if __name__ == "__main__":
    sys.exit(main())
