#!/usr/bin/env python3
"""The arrows between the rooms (rooms.py), checked in every #include.

tests -> anything, nothing -> tests. The simulated rig includes neither calib nor drivers nor daemon: simulator and
estimator must not share mistakes. Every .cc and .h lies in a room, and every room says in its README.md what it is.
A .cc without a header of its own is named in that README.md. Asio and libserialport live in drivers and daemon, spdlog
and sqlite in daemon, only.

  includes.py ROOT          lists offences, exit code 1 when there are any
  includes.py --self-test   planted offences are caught, the rooms have no circle
"""
import fnmatch
import pathlib
import re
import sys

from rooms import ALLOWED, CALIB, DAEMON, circles, room_of

LIBRARIES = {
    r"boost/(asio|beast)": ("drivers", "daemon", "tests/rig"),
    r"libserialport\.h": ("drivers",),
    r"spdlog/": ("daemon",),
    r"sqlite3\.h": ("daemon",),
    r"toml\+\+": ("daemon", "tests/rig"),
    # Two processors by calib/linear/parts.h, and not otherwise.
    r"future$": ("drivers", "daemon", "tests/rig", "calib/linear"),
    r"(thread|fstream|iostream)$": ("drivers", "daemon", "tests/rig"),
    # Every program ends with a look at its standard output, that of the rig too.
    r"cstdio$": ("drivers", "daemon", "tests/rig", "proto/standard_output.cc"),
    # BLAS must be called by one thread at a time.
    r"mutex$": ("drivers", "daemon", "tests/rig", "calib/linear"),
}
WITHOUT_HEADER = re.compile(r"`([\w*]+\.cc)`")
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
README_LINES = 10


def offences(path: str, text: str):
    room = room_of(path)
    if room is None:
        yield f"{path}: is in no room"
        return
    for number, line in enumerate(text.splitlines(), 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        kind, target = match.groups()
        if kind == '"':
            wanted = room_of(target)
            if wanted is None:
                yield f"{path}:{number}: {target} is in no room"
            elif wanted not in ALLOWED[room]:
                yield f"{path}:{number}: {room} may not include {wanted} ({target})"
        for pattern, owners in LIBRARIES.items():
            if re.match(pattern, target) and not any(o in (room, path) or room.startswith(o + "/") for o in owners):
                yield f"{path}:{number}: {target} belongs to {', '.join(owners)}, not to {room}"


def without_readme(root: pathlib.Path):
    for room in (*CALIB, *DAEMON):
        page = root / room / "README.md"
        if not page.is_file():
            yield f"{room}: has no README.md that says what it is for"
        elif len(page.read_text().splitlines()) > README_LINES:
            yield f"{room}/README.md: longer than {README_LINES} lines"


def without_header(readme: str, sources, headers):
    """Sources that have no header of their own, and that the README of their folder does not explain."""
    explained = WITHOUT_HEADER.findall(readme)
    for source in sources:
        if source[:-3] + ".h" not in headers and not any(fnmatch.fnmatch(source, e) for e in explained):
            yield f"{source}: has no header of its own, and the README.md of its folder does not say why"


def unexplained(root: pathlib.Path):
    for room in (*CALIB, *DAEMON):
        names = [p.name for p in (root / room).iterdir()]
        yield from (f"{room}/{offence}" for offence in without_header(
            (root / room / "README.md").read_text(), sorted(n for n in names if n.endswith(".cc")), names))


def self_test():
    planted = [
        ("calib/fit/x.cc", '#include "drivers/device.h"'),
        ("calib/fit/x.h", '#include "calib/fit/joint/joint_fit.h"'),
        ("calib/fit/two_step/x.cc", '#include "calib/fit/joint/joint_fit.h"'),
        ("calib/effects/x.cc", '#include "calib/effects/library/library.h"'),
        ("calib/criticism/tests/x.cc", '#include "calib/criticism/search/explain.h"'),
        ("calib/criticism/search/x.cc", '#include "calib/report/verdict_text.h"'),
        ("daemon/store/x.cc", '#include "daemon/run/run_fsm.h"'),
        ("daemon/serve/x.cc", '#include "daemon/run/run_fsm.h"'),
        ("daemon/run/x.cc", '#include "daemon/app/daemon_app.h"'),
        ("calib/x.cc", ""),
        ("daemon/x.cc", ""),
        ("proto/x.h", "#include <boost/asio/io_context.hpp>"),
        ("calib/stats/x.cc", "#include <fstream>"),
        ("calib/fit/joint/x.cc", "#include <future>"),
        ("tests/rig/x.cc", '#include "calib/sensor/sensor_model.h"'),
        ("drivers/x.cc", '#include "tests/rig/world.h"'),
        ("drivers/x.cc", "#include <spdlog/spdlog.h>"),
    ]
    missed = [p for p in planted if not list(offences(*p))]
    if not list(without_header("`run_fsm_*.cc`", ["x.cc"], ["y.h"])):
        missed.append(("x.cc", "no header"))
    if list(without_header("`run_fsm_*.cc`", ["run_fsm_pose.cc"], [])):
        missed.append(("run_fsm_pose.cc", "explained, and listed all the same"))
    clean = list(offences("daemon/run/x.cc", '#include "calib/calibration/tensor.h"\n#include "proto/time.h"\n'))
    for path, text in missed:
        print(f"not caught: {path}: {text}")
    for room in circles():
        print(f"in a circle: {room}")
    return 1 if missed or clean or circles() else 0


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    root = pathlib.Path(sys.argv[1])
    found = list(without_readme(root)) or list(unexplained(root))
    for top in ("proto", "drivers", "calib", "daemon", "tests/rig"):
        for path in sorted((root / top).rglob("*")):
            if path.suffix in (".h", ".cc"):
                found += offences(path.relative_to(root).as_posix(), path.read_text())
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
