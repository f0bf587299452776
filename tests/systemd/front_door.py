#!/usr/bin/env python3
"""Installs into an empty directory and looks at what arrived, as the machine's own tools do.

front_door.py --build DIR --source DIR --programs DIR CHECK, where CHECK is
  tree        every file in its place, the configuration accepted by the programs, an edited one kept
  verify      systemd-analyze finds nothing wrong with the unit
  exposure    the unit is confined: systemd-analyze's score is at most LIMIT
  manual      groff finds nothing wrong with the manual pages
  keys        every key the configuration knows is in mgtd.toml and in its manual page
  commands    every command and option of the programs is in the manual pages, and nothing else is
  links       every file and heading that README.md and docs/ point to is there
  completion  bash completes subcommands and options of the programs
  outputs     an output path that is a device, a FIFO or a symbolic link is written to and stays what it is
  packages    debian/ has the project's version and puts every installed file into one package
  kept        what `add` found is kept: every command tells the same residual of that run file
  import      a table of another program comes in by a map of its columns, and out again unchanged
Exit code 77: the tool needed for the check is not on this machine.
"""
import argparse
import csv
import fnmatch
import json
import math
import os
import pathlib
import re
import shutil
import stat
import subprocess
import sys
import tempfile

LIMIT = 13  # tenths, as systemd-analyze counts; its scale ends at 100
SKIPPED = 77
TREE = [
    "usr/bin/mgtd",
    "usr/bin/mgt",
    "usr/bin/mgt-rig",
    "usr/lib/systemd/system/mgtd.service",
    "usr/lib/systemd/system/mgtd.socket",
    "usr/lib/sysusers.d/mgtd.conf",
    "usr/share/man/man1/mgt.1",
    "usr/share/man/man1/mgt-rig.1",
    "usr/share/man/man5/mgtd.toml.5",
    "usr/share/man/man8/mgtd.8",
    "usr/share/bash-completion/completions/mgt",
    "usr/share/doc/mgtd/examples/70-mgtd.rules",
    "usr/share/doc/mgtd/examples/mgtd.toml",
    "etc/mgtd/mgtd.toml",
]
KEY_CALL = re.compile(
    r"""\b(?:number|integer|boolean|text|numbers|texts|required_number|required_text)\(\s*"([\w.]+)"
      | \boptional_number\(\s*\w+,\s*"([\w.]+)" """,
    re.X,
)


class Failure(Exception):
    pass


def run(*command):
    return subprocess.run([str(c) for c in command], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)


def need(tool):
    if shutil.which(tool) is None:
        print(f"skipped: {tool} is not on this machine")
        sys.exit(SKIPPED)
    return tool


def demand(result, what):
    if result.returncode != 0:
        raise Failure(f"{what} (exit code {result.returncode}):\n{result.stdout}")
    return result.stdout


def install(options, root):
    done = subprocess.run(
        ["cmake", "--install", options.build, "--prefix", "/usr"],
        env={"PATH": "/usr/local/bin:/usr/bin:/bin", "DESTDIR": str(root)},
        text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    demand(done, "cmake --install failed")


def check_tree(options, root):
    install(options, root)
    missing = [path for path in TREE if not (root / path).is_file()]
    if missing:
        raise Failure("not installed: " + ", ".join(missing))
    config = root / "etc/mgtd/mgtd.toml"
    demand(run(options.programs / "mgt", "check-config", config), "the installed configuration is refused")
    config.write_text("# edited by the operator\n")
    install(options, root)
    if config.read_text() != "# edited by the operator\n":
        raise Failure("a second installation overwrote the operator's configuration")


def unit_to_check(options, root):
    """The unit as built, with the program where it is now: `verify` wants to see it."""
    text = (options.build / "systemd/mgtd.service").read_text()
    moved, count = re.subn(r"^ExecStart=\S+", f"ExecStart={options.programs / 'mgtd'}", text, flags=re.M)
    if count != 1:
        raise Failure("the unit has no single ExecStart")
    unit = root / "mgtd.service"
    unit.write_text(moved)
    return unit


def check_verify(options, root):
    tool = need("systemd-analyze")
    units = [unit_to_check(options, root), root / "mgtd.socket"]
    shutil.copy(options.source / "systemd/mgtd.socket", units[1])
    said = demand(run(tool, "verify", "--man=no", *units), "systemd-analyze verify")
    if "mgtd." in said:  # a key it does not know is only a remark to systemd-analyze
        raise Failure(said)


def check_exposure(options, root):
    tool = need("systemd-analyze")
    unit = unit_to_check(options, root)

    def score():
        return run(tool, "security", "--offline=true", f"--threshold={LIMIT}", unit)

    print(demand(score(), "the unit is exposed too much").splitlines()[-1])
    unit.write_text(re.sub(r"^(SystemCallFilter|Protect\w+)=.*\n", "", unit.read_text(), flags=re.M))
    if score().returncode == 0:
        raise Failure("the check cannot fail: an unconfined unit passed")


def check_manual(options, root):
    tool = need("groff")
    complaints = ""
    for page in sorted((options.source / "man").iterdir()):
        said = run(tool, "-man", "-ww", "-Tutf8", "-z", page).stdout
        complaints += f"{page.name}: {said}" if said else ""
    if complaints:
        raise Failure(complaints)
    planted = root / "planted.1"
    planted.write_text(".TH X 1\n.SH NAME\n.nosuchmacro\n")
    if not run(tool, "-man", "-ww", "-Tutf8", "-z", planted).stdout:
        raise Failure("the check cannot fail: an unknown macro passed")


def check_keys(options, root):
    del root
    sources = [source for room in ("daemon/config", "drivers") for source in sorted((options.source / room).glob("*.cc"))]
    keys = set()
    for source in sources:
        for match in KEY_CALL.finditer(source.read_text()):
            keys.add(match.group(1) or match.group(2))
    if not {"baseline_m", "field_nT", "profile"} <= keys:
        raise Failure(f"the keys are no longer found in the sources: {sorted(keys)}")
    lacking = []
    for document in ("systemd/mgtd.toml", "man/mgtd.toml.5"):
        text = (options.source / document).read_text().replace("\\-", "-")
        lacking += [f"{document}: '{key}'" for key in sorted(keys) if not re.search(rf"\b{re.escape(key)}\b", text)]
    if lacking:
        raise Failure("not documented: " + ", ".join(lacking))


def help_of(program, path):
    """Subcommands and long options that --help lists."""
    said = demand(run(program, *path, "--help"), f"{program.name} {' '.join(path)} --help")
    inside, subcommands = False, []
    for line in said.splitlines():
        if re.match(r"\S", line):
            inside = line.lower().startswith("subcommands")
        elif inside and (name := re.match(r"  ([a-z][\w-]*)", line)):
            subcommands.append(name.group(1))
    listed = said[said.index("Options:"):] if "Options:" in said else said
    return subcommands, set(re.findall(r"(?<![\w-])--[a-z][a-z-]*", listed))


def walk(program, path=()):
    """Every command of a program, with the options that it takes."""
    subcommands, options = help_of(program, path)
    yield path, options
    for name in subcommands:
        yield from walk(program, (*path, name))


def check_commands(options, root):
    del root
    wrong, texts, known = [], {}, set()
    for name, page in (("mgt", "mgt.1"), ("mgtd", "mgtd.8"), ("mgt-rig", "mgt-rig.1")):
        text = (options.source / "man" / page).read_text().replace("\\-", "-")
        text = re.sub(r"\\f[BIRP]", "", text)
        texts[page] = text
        for path, taken in walk(options.programs / name):
            known |= taken
            wrong += [f"{page} lacks {option} ({name} {' '.join(path)})" for option in taken if option not in text]
            command = r"[\s\"]+".join(path)
            if path and not re.search(rf"(?<![\w-]){command}(?![\w-])", text):
                wrong.append(f"{page} lacks the command {name} {' '.join(path)}")
    for page, text in texts.items():
        wrong += [f"{page} has {option}, which no program takes"
                  for option in sorted(set(re.findall(r"(?<![\w-])--[a-z][a-z-]*", text)) - known)]
    if wrong:
        raise Failure("\n".join(wrong))


def anchors(text):
    """Headings as a reader's browser knows them."""
    heads = re.findall(r"^#+ (.+)$", text, flags=re.M)
    return {re.sub(r"[^\w -]", "", head.lower()).replace(" ", "-") for head in heads}


def check_links(options, root):
    del root
    broken = []
    for page in (options.source / "README.md", *sorted((options.source / "docs").glob("*.md"))):
        text = page.read_text()
        for target, anchor in re.findall(r"\]\((?!https?:)([^)#]*)(?:#([^)]*))?\)", text):
            file = (page.parent / target) if target else page
            if not file.exists():
                broken.append(f"{page.name}: there is no {target}")
            elif anchor and anchor not in anchors(file.read_text()):
                broken.append(f"{page.name}: {target or page.name} has no heading #{anchor}")
        rooms = "proto|drivers|calib|daemon|tests|systemd|man|docs"
        for path in re.findall(rf"`((?:{rooms})/[\w./-]+)`", text):
            if "NAME" not in path and not (options.source / path).exists():
                broken.append(f"{page.name}: there is no {path}")
    if broken:
        raise Failure("\n".join(broken))


def check_completion(options, root):
    del root
    script = options.source / "systemd/completion.bash"

    def complete(*words):
        line = " ".join(f"'{w}'" for w in words)
        return demand(run("bash", "-c", f"PATH={options.programs}:$PATH; . {script}; COMP_WORDS=({line}); "
                          f"COMP_CWORD={len(words) - 1}; _mgt; printf '%s\\n' \"${{COMPREPLY[@]}}\""),
                      "completion").split()

    for words, wanted in ((("mgt", "check-c"), "check-config"), (("mgt", "check-config", "--js"), "--json"),
                          (("mgtd", "--ver"), "--version")):
        if wanted not in complete(*words):
            raise Failure(f"{' '.join(words)}: {wanted} not offered, but {complete(*words)}")


def poses_of(options, root, *scenario):
    table = root / "poses.csv"
    demand(run(options.programs / "mgt-rig", "table", *scenario, "-o", table), "mgt-rig table")
    return table


def check_outputs(options, root):
    table = poses_of(options, root, "--rig", "table6")
    plain, target, link, fifo = (root / name for name in ("plain.json", "target.json", "link.json", "fifo"))
    link.symlink_to(target.name)
    os.mkfifo(fifo)

    def fit(output):
        demand(run(options.programs / "mgt", "fit", table, "-o", output), f"mgt fit -o {output}")

    fit(plain)
    text = plain.read_text()
    for what in ("made by", "replacing what stands at the end of"):
        fit(link)
        if not link.is_symlink() or target.read_text() != text:
            raise Failure(f"{what} a symbolic link: it is {'still one' if link.is_symlink() else 'gone'}")
        target.write_text("old and longer than the new one" * len(text))
    reader = subprocess.Popen(["cat", fifo], text=True, stdout=subprocess.PIPE)
    fit(fifo)
    if reader.communicate(timeout=60)[0] != text or not fifo.is_fifo():
        raise Failure("a FIFO did not get the calibration, or is none any more")
    device = root / "null"
    if os.geteuid() == 0:
        os.mknod(device, 0o666 | stat.S_IFCHR, os.makedev(1, 3))
        fit(device)
        if not device.is_char_device():
            raise Failure("a device was replaced by a file")
    left = sorted(p.name for p in root.iterdir() if p.suffix == ".tmp")
    if left:
        raise Failure(f"left behind: {left}")


def check_kept(options, root):
    mgt, kept = options.programs / "mgt", root / "run.mgtrun"
    scenario = root / "step.toml"
    scenario.write_text("""[rig]
name = "step"
parameters = "table6"
seed = 4
[[effect]]
name = "axis.offset.step"
where = "s4.y"
nT = 6.0
at_s = 1100.0
""")
    table = poses_of(options, root, "--scenario", scenario)
    demand(run(mgt, "import", table, "-o", kept), "mgt import")
    demand(run(mgt, "add", "axis.offset.step@s4.y", kept), "mgt add")

    def said(*words):
        done = subprocess.run([mgt, *words, kept, "--json"], text=True, stdout=subprocess.PIPE)
        return json.loads(done.stdout)

    model = said("model")
    if ",ts=" not in model["model"][0]:
        raise Failure(f"the time that was found is not in the kept model: {model['model']}")
    choice = model["history"][0]["result"].get("choice", {})
    if choice.get("spec") != model["model"][0] or not isinstance(choice.get("rivals"), list):
        raise Failure(f"what could have stood in its place is not kept: {choice}")
    residuals = {"fit": said("fit")["residual_nT"], "compare": said("compare")["residual_nT"],
                 "explain": said("explain")["residual_nT"], "improve": said("improve")["fit"]["residual_nT"],
                 "add": model["history"][0]["result"]["rms_after_nT"]}
    if len({f"{value:.3g}" for value in residuals.values()}) != 1:
        raise Failure(f"the commands disagree about the residual: {residuals}")
    page = root / "report.html"
    demand(run(mgt, "report", kept, "-o", page), "mgt report")
    wanted = f"Residual {residuals['fit']:.3g} nT"
    if wanted not in page.read_text():
        raise Failure(f"the report does not say '{wanted}'")


def check_import(options, root):
    """A table of another program (semicolons, microtesla, radians, another order and sign) comes in unchanged."""
    mgt, table = options.programs / "mgt", poses_of(options, root, "--rig", "table6")
    rows = list(csv.DictReader(table.read_text().splitlines()))
    axes = [f"s{sensor}_{axis}_nT" for sensor in range(1, 5) for axis in "xyz"]
    foreign, columns = root / "logger.txt", root / "columns.toml"
    lines = ["made by a logger", ";".join(["F", "turn"] + [f"B{i}" for i in range(12)])]
    for row in rows:
        cells = [row["f_nT"], repr(math.radians(float(row["azimuth_deg"])))]
        lines.append(";".join(cells + [repr(float(row[axis]) * (1e-3 if axis[3] != "z" else -1e-3)) for axis in axes]))
    foreign.write_text("\n".join(lines) + "\n")
    map_lines = ["[columns]", 'f_nT = "F"', 'azimuth_deg = {from = "turn", unit = "rad"}']
    for i, axis in enumerate(axes):
        map_lines.append(f'{axis} = {{from = "B{i}", unit = "uT", sign = {-1 if axis[3] == "z" else 1}}}')
    columns.write_text("\n".join(map_lines + ["[file]", "skip = 1"]) + "\n")
    kept, back = root / "logger.mgtrun", root / "back.csv"
    demand(run(mgt, "import", foreign, "--columns", columns, "-o", kept), "mgt import --columns")
    demand(run(mgt, "export", kept, "-o", back), "mgt export")
    again = list(csv.DictReader(back.read_text().splitlines()))
    if len(again) != len(rows):
        raise Failure(f"{len(rows)} rows went in, {len(again)} came out")
    for name in ("f_nT", "azimuth_deg", *axes):
        worst = max(abs(float(a[name]) - float(b[name])) for a, b in zip(rows, again))
        if worst > 1e-6:
            raise Failure(f"{name} changed by {worst} on its way through mgt import")
    columns.write_text("[columns]\n" + 's1_x_nT = "nowhere"\n')
    refused = subprocess.run([mgt, "import", foreign, "--columns", columns, "-o", root / "no.mgtrun"],
                             text=True, stderr=subprocess.PIPE)
    if refused.returncode != 2 or "there is no column 'nowhere'" not in refused.stderr or (root / "no.mgtrun").exists():
        raise Failure(f"a column that is not there: {refused.returncode}, {refused.stderr}")


def claims(source, package):
    """The paths that a package takes from the installation, as in debian/PACKAGE.install."""
    lines = (source / f"debian/{package}.install").read_text().split()
    return [line.replace("${env:UNIT_DIR}", "usr/lib/systemd/system") for line in lines]


def misplaced(files, packages):
    """Files that are not in exactly one package, and claims that no file answers."""
    def taken(file, claim):
        return fnmatch.fnmatch(file, claim) or file.startswith(claim + "/")
    wrong = []
    for file in files:
        homes = [name for name, paths in packages.items() if any(taken(file, path) for path in paths)]
        if len(homes) != 1:
            wrong.append(f"{file} is in {' and '.join(homes) or 'no package'}")
    for name, paths in packages.items():
        wrong += [f"debian/{name}.install: nothing is installed as {path}"
                  for path in paths if not any(taken(file, path) for file in files)]
    return wrong


def check_packages(options, root):
    version = re.search(r"project\(mgtd VERSION ([\d.]+)", (options.source / "CMakeLists.txt").read_text()).group(1)
    newest = (options.source / "debian/changelog").read_text().splitlines()[0]
    if not newest.startswith(f"mgtd ({version}) "):
        raise Failure(f"CMakeLists.txt has version {version}, debian/changelog begins with: {newest}")
    install(options, root)
    files = sorted(str(path.relative_to(root)) for path in root.rglob("*") if path.is_file())
    control = (options.source / "debian/control").read_text()
    packages = {name: claims(options.source, name) for name in re.findall(r"^Package: (\S+)", control, flags=re.M)}
    wrong = misplaced(files, packages)
    if wrong:
        raise Failure("\n".join(wrong))
    if len(misplaced([*files, "usr/bin/planted"], {**packages, "planted": ["usr/bin/mgt", "usr/bin/no"]})) != 3:
        raise Failure("the check cannot fail: a file without a package, one in two packages or a false claim passed")


CHECKS = {name[6:]: function for name, function in list(globals().items()) if name.startswith("check_")}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--build", type=pathlib.Path, required=True)
    parser.add_argument("--source", type=pathlib.Path, required=True)
    parser.add_argument("--programs", type=pathlib.Path, required=True)
    parser.add_argument("check", choices=CHECKS)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="mgtd-front-door-") as root:
        try:
            CHECKS[options.check](options, pathlib.Path(root))
        except Failure as failure:
            print(failure)
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
