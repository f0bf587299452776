#!/usr/bin/env python3
"""The same inputs give the same outputs: two builds of the programs, byte for byte.

  same.py OLD_BIN NEW_BIN [--only WORD]

Makes ten runs with the simulated rig of OLD_BIN (eight of them with a hidden effect or a kind of noise), and three raw
journals with its daemon too; gives each to every offline command of both builds, and compares what they write: JSON,
text, CAL.json, report, the stream replayed. A move, a rename or another compiler option must leave all of it as it is.
Exit code 1 where a byte differs; the first differences are shown.

Not compared: the time at which a file was written, and the version of the program.
"""
import argparse
import contextlib
import difflib
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import time

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
    "explain-confusion": "explain {run} --confusion --impact --no-law --json",
    "discover": "discover {run} --quick --draws 200 --json",
    "why": "why axis.cubic {run} --json",
    "why-text": "why axis.cubic {run} --at s3.z",
    "add-try": "add axis.cubic@s3.z {run} --try --json",
    "define-try": "define {run} bent (u/50000)^2 --try --json",
    # What a run file keeps: its model, the steps to it, and what one step back would be.
    "import": "import {run} -o {out}.mgtrun",
    "add": "add axis.cubic@s3.z {out}.mgtrun --force --json",
    "drop-try": "drop axis.cubic {out}.mgtrun --try --json",
    "define": "define {out}.mgtrun bent (u/50000)^2 --json",
    "model": "model {out}.mgtrun --json",
    "model-text": "model {out}.mgtrun",
}
ONCE = {"effects": "effects --json", "effects-text": "effects", "plan": "plan --json", "plan-text": "plan"}
# Rigs whose daemon leaves a raw journal: an exact one, a warm one, and one whose cable is pulled.
JOURNALS = {"clean": [], "temperature": [], "vehicle": ["unplug fluxgate2 for 3"]}
JOURNAL_EPOCHS = 1500
SPEED_UP = "20"
# Of no meaning here: by which version it was written, and when.
VERSION = re.compile(r'"(version|program|software)":\s*"[^"]*"|\bmgtd? \d+\.\d+\.\d+\b')
VARYING = re.compile(r'"(written_utc|created_utc)":\s*"[^"]*"|' + VERSION.pattern +
                     r'|\d{4}-\d\d-\d\d[T ]\d\d:\d\d:\d\d(\.\d+)?Z?')


def run(program: pathlib.Path, line: str, folder: pathlib.Path):
    done = subprocess.run([program, *line.split()], cwd=folder, capture_output=True, text=True, errors="replace")
    return f"exit {done.returncode}\n{done.stdout}\n{done.stderr}"


def until(holds, of: subprocess.Popen, what: str):
    """Asks again and again; a program that has ended will not get there."""
    while not (answer := holds()):
        if of.poll() is not None:
            raise SystemExit(f"{what}: {pathlib.Path(of.args[0]).name} ended with exit code {of.returncode}")
        time.sleep(0.05)
    return answer


@contextlib.contextmanager
def running(line, folder: pathlib.Path):
    with open(folder / f"{pathlib.Path(line[0]).name}.log", "w") as log:
        program = subprocess.Popen(line, cwd=folder, stdout=log, stderr=log)
        try:
            yield program
        finally:
            program.terminate()
            program.wait()


def record(programs: pathlib.Path, name: str, faults, folder: pathlib.Path):
    """The raw journal of a daemon on a simulated rig, stopped when it has seen enough epochs."""
    folder.mkdir()
    (folder / "scenario.toml").write_text(SCENARIOS[name])
    ports = folder / "ports"
    rig = ["--scenario", "scenario.toml", "--dir", ports, "--speed-up", SPEED_UP]
    with running([programs / "mgt-rig", "run", *rig], folder) as simulator:
        until((ports / "ready").exists, simulator, name)
        config = subprocess.run([programs / "mgt-rig", "config", *rig, "--state", folder, "--tcp", "127.0.0.1:0"],
                                cwd=folder, check=True, capture_output=True, text=True).stdout
        # The page is of no use here, and its port may be another's.
        (folder / "mgtd.toml").write_text(re.sub(r'(\[console\]\nlisten = )"[^"]*"', r'\1""', config))

        def epochs():
            status = subprocess.run([programs / "mgt", "--socket", folder / "control.sock", "status", "--json"],
                                    capture_output=True, text=True).stdout
            return json.loads(status or "{}").get("sampler", {}).get("epochs", 0)  # else it is not up yet

        with running([programs / "mgtd", "--config", "mgtd.toml"], folder) as daemon:
            until(lambda: epochs() >= JOURNAL_EPOCHS / 3, daemon, name)
            for fault in faults:
                subprocess.run([programs / "mgt-rig", "fault", ports, *fault.split()], check=True, capture_output=True)
            until(lambda: epochs() >= JOURNAL_EPOCHS, daemon, name)
    return sorted((folder / "runs").glob("*.raw"))


def outputs(programs: pathlib.Path, folder: pathlib.Path, journals, only: str):
    out, stream = {}, {}
    for name in SCENARIOS:
        for title, line in COMMANDS.items():
            if only in f"{name}.{title}":
                out[f"{name}.{title}"] = run(programs / "mgt", line.format(run=f"{name}.csv", out=f"{name}"), folder)
    for title, line in ONCE.items():
        if only in title:
            out[title] = run(programs / "mgt", line, folder)
    for name, files in journals.items():
        stream[f"{name}.replay"] = run(programs / "mgt", " ".join(["replay", *map(str, files)]), folder)
    for path in sorted(folder.iterdir()):
        if path.suffix in (".json", ".html"):
            out[path.name] = path.read_text(errors="replace")
    return {**{title: VARYING.sub("-", text) for title, text in out.items()},
            **{title: VERSION.sub("-", text) for title, text in stream.items()}}  # the times are the journal's


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("old", type=lambda p: pathlib.Path(p).resolve())
    options.add_argument("new", type=lambda p: pathlib.Path(p).resolve())
    options.add_argument("--only", default="", help="only outputs with this in their name")
    given = options.parse_args()
    with tempfile.TemporaryDirectory() as recordings:
        journals = {name: record(given.old, name, faults, pathlib.Path(recordings) / name)
                    for name, faults in JOURNALS.items() if given.only in f"{name}.replay"}
        return compare(given, journals)


def compare(given, journals):
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
                          outputs(programs, folder, journals, given.only).items()})
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
