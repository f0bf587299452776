"""The rooms of the source tree, and which room may include which: what includes.py checks and rooms_svg.py draws.

A room may include itself and the rooms listed for it. The lists have no circle; `python3 tests/lint/includes.py
--self-test` proves it. A file belongs to the deepest room that its folder is in.
"""

CALIB = {
    "calib/stats": [],
    "calib/linear": [],
    "calib/sensor": ["calib/linear"],
    "calib/poses": [],
    "calib/effects": ["calib/sensor"],
    "calib/effects/laws": ["calib/effects", "calib/poses", "calib/sensor"],
    "calib/effects/formula": ["calib/effects/laws", "calib/effects", "calib/poses"],
    "calib/effects/library": ["calib/effects/formula", "calib/effects/laws", "calib/effects", "calib/poses",
                              "calib/sensor"],
    "calib/calibration": ["calib/effects/library", "calib/effects/laws", "calib/effects", "calib/poses",
                          "calib/sensor", "calib/linear"],
    "calib/fit": ["calib/calibration", "calib/effects", "calib/poses", "calib/sensor", "calib/stats", "calib/linear"],
    "calib/fit/two_step": ["calib/fit", "calib/calibration", "calib/sensor", "calib/linear"],
    "calib/fit/joint": ["calib/stats", "calib/fit/two_step", "calib/fit", "calib/calibration", "calib/effects/library",
                        "calib/effects/formula", "calib/effects", "calib/poses", "calib/sensor", "calib/linear"],
    "calib/fit/checks": ["calib/fit/joint", "calib/fit", "calib/calibration"],
    "calib/fit/method_choice": ["calib/fit/checks", "calib/fit/joint", "calib/fit/two_step", "calib/fit"],
    "calib/criticism/live": ["calib/calibration", "calib/effects", "calib/sensor", "calib/stats", "calib/linear"],
    "calib/criticism/tests": ["calib/fit/method_choice", "calib/fit/joint", "calib/fit",
                              "calib/calibration", "calib/effects/library", "calib/effects/formula",
                              "calib/effects/laws", "calib/effects", "calib/poses", "calib/stats", "calib/linear"],
    "calib/design": ["calib/criticism/tests", "calib/fit/joint", "calib/fit/two_step",
                     "calib/fit", "calib/calibration", "calib/effects/library", "calib/sensor", "calib/linear"],
    "calib/criticism/search": ["calib/design", "calib/criticism/tests", "calib/fit/checks",
                               "calib/fit/method_choice", "calib/fit/joint", "calib/fit/two_step", "calib/fit",
                               "calib/calibration", "calib/effects/library", "calib/effects", "calib/poses",
                               "calib/stats", "calib/linear"],
    "calib/validity": ["calib/fit/method_choice", "calib/fit/joint", "calib/fit", "calib/calibration",
                       "calib/effects/library", "calib/poses", "calib/sensor", "calib/stats", "calib/linear"],
    "calib/discovery": ["calib/criticism/tests", "calib/fit/joint", "calib/fit", "calib/calibration",
                        "calib/effects/library", "calib/effects/formula", "calib/effects/laws", "calib/effects",
                        "calib/poses", "calib/sensor", "calib/stats", "calib/linear"],
    "calib/report/figures": [],
    "calib/report": ["calib/report/figures", "calib/discovery", "calib/criticism/search", "calib/criticism/live", "calib/validity",
                     "calib/design", "calib/criticism/tests", "calib/fit/checks", "calib/fit/joint", "calib/fit",
                     "calib/calibration", "calib/effects/library", "calib/effects", "calib/sensor", "calib/stats"],
}

DAEMON = {
    "daemon/plan": [],
    "daemon/store": [],
    "daemon/config": ["daemon/plan", "daemon/store"],
    "daemon/acquire": ["daemon/config", "daemon/store"],
    "daemon/run": ["daemon/acquire", "daemon/config", "daemon/plan", "daemon/store"],
    "daemon/serve": ["daemon/config", "daemon/store"],
    "daemon/serve/console": ["daemon/serve", "daemon/config", "daemon/store"],
    "daemon/core": ["daemon/run", "daemon/acquire", "daemon/config"],
    "daemon/app": ["daemon/core", "daemon/run", "daemon/serve/console", "daemon/serve", "daemon/acquire", "daemon/config", "daemon/plan",
                   "daemon/store"],
    "daemon/cli": ["daemon/run", "daemon/serve/console", "daemon/serve", "daemon/acquire", "daemon/config", "daemon/plan",
                   "daemon/store"],
}

# Every room of the daemon may use every room of calib, and drivers.
ALLOWED = {
    "proto": ["proto"],
    "drivers": ["drivers", "proto"],
    **{room: [room, *below, "proto"] for room, below in CALIB.items()},
    **{room: [room, *below, *CALIB, "drivers", "proto"] for room, below in DAEMON.items()},
    "tests/rig": ["tests/rig", "proto"],
}


def room_of(path: str):
    """The deepest room that the file is in; "tests" for what is in no room of it; None for other places."""
    folder = path.rsplit("/", 1)[0] if "/" in path else ""
    while folder:
        if folder in ALLOWED:
            return folder
        folder = folder.rsplit("/", 1)[0] if "/" in folder else ""
    return "tests" if path.startswith("tests/") else None


def circles():
    """Rooms that can be reached from themselves."""
    reach = {room: set(below) - {room} for room, below in ALLOWED.items()}
    for _ in ALLOWED:
        for room in reach:
            reach[room] |= set().union(*(reach.get(other, set()) for other in reach[room]), set())
    return sorted(room for room in reach if room in reach[room])
