#!/usr/bin/env python3
"""The arrows between the rooms, checked in every #include.

daemon -> calib, drivers -> proto. calib and drivers never meet except in daemon. tests -> anything, nothing -> tests.
The simulated rig includes neither calib nor drivers nor daemon: simulator and estimator must not share mistakes.
Asio and libserialport live in drivers and daemon, spdlog and sqlite in daemon, only.
"""
import pathlib
import re
import sys

ALLOWED = {
    "proto": {"proto"},
    "drivers": {"drivers", "proto"},
    "calib": {"calib", "proto"},
    "daemon": {"daemon", "calib", "drivers", "proto"},
    "tests/rig": {"tests/rig", "proto"},
}
ROOMS = ("proto", "drivers", "calib", "daemon", "tests")
LIBRARIES = {
    r"boost/(asio|beast)": {"drivers", "daemon", "tests/rig"},
    r"libserialport\.h": {"drivers"},
    r"spdlog/": {"daemon"},
    r"sqlite3\.h": {"daemon"},
    r"toml\+\+": {"daemon", "tests/rig"},
    r"(thread|mutex|fstream|iostream|cstdio)$": {"drivers", "daemon", "tests/rig"},
}
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def room_of(path: str):
    if path.startswith("tests/rig/"):
        return "tests/rig"
    top = path.split("/", 1)[0]
    return top if top in ALLOWED else None


def offences(path: str, text: str):
    room = room_of(path)
    if room is None:
        return
    for number, line in enumerate(text.splitlines(), 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        kind, target = match.groups()
        if kind == '"':
            wanted = room_of(target) or target.split("/", 1)[0]
            if wanted in ROOMS + ("tests/rig",) and wanted not in ALLOWED[room]:
                yield f"{path}:{number}: {room} may not include {wanted} ({target})"
        for pattern, rooms in LIBRARIES.items():
            if re.match(pattern, target) and room not in rooms:
                yield f"{path}:{number}: {target} belongs to {', '.join(sorted(rooms))}, not to {room}"


def self_test():
    planted = [
        ("calib/x.cc", '#include "drivers/device.h"'),
        ("proto/x.h", "#include <boost/asio/io_context.hpp>"),
        ("calib/x.cc", "#include <fstream>"),
        ("tests/rig/x.cc", '#include "calib/sensor_model.h"'),
        ("drivers/x.cc", '#include "tests/rig/world.h"'),
        ("drivers/x.cc", "#include <spdlog/spdlog.h>"),
    ]
    missed = [p for p in planted if not list(offences(*p))]
    clean = list(offences("daemon/x.cc", '#include "calib/tensor.h"\n#include "proto/time.h"\n'))
    for path, text in missed:
        print(f"not caught: {path}: {text}")
    return 1 if missed or clean else 0


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    root = pathlib.Path(sys.argv[1])
    found = []
    for room in ("proto", "drivers", "calib", "daemon", "tests/rig"):
        for path in sorted((root / room).rglob("*")):
            if path.suffix in (".h", ".cc"):
                found += offences(path.relative_to(root).as_posix(), path.read_text())
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
