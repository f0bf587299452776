#!/usr/bin/env python3
"""Draws docs/rooms.svg from rooms.py, so that the picture cannot differ from what the lint checks.

  rooms_svg.py ROOT           writes ROOT/docs/rooms.svg
  rooms_svg.py ROOT --check   exit code 1 when the picture is another one
"""
import pathlib
import sys

from rooms import CALIB, DAEMON

# What stands in a box, below the name of the room.
SAYS = {
    "calib/stats": "tails of distributions",
    "calib/linear": "Cholesky, QR, errors",
    "calib/sensor": "one sensor, step 1",
    "calib/poses": "the pose table",
    "calib/effects": "what an effect is",
    "calib/effects/laws": "one file for each law",
    "calib/effects/formula": "the user's own",
    "calib/effects/library": "names, sizes, causes",
    "calib/calibration": "the document, the tensor",
    "calib/fit": "options, report, readings",
    "calib/fit/two_step": "the method of the paper",
    "calib/fit/joint": "all at once, robust",
    "calib/fit/checks": "is it fit for use?",
    "calib/fit/method_choice": "fit(): one call",
    "calib/criticism/live": "closure of the stream",
    "calib/criticism/tests": "scores, maps, noise",
    "calib/criticism/search": "explain(), improve()",
    "calib/design": "poses for their worth",
    "calib/validity": "does it still hold?",
    "calib/discovery": "laws of no library",
    "calib/report/figures": "values in, SVG out",
    "calib/report": "all words, text and JSON",
    "daemon/plan": "what a run will do",
    "daemon/store": "where it is kept",
    "daemon/config": "what was written down",
    "daemon/acquire": "from devices to epochs",
    "daemon/run": "what happens next",
    "daemon/serve": "who is told, who may ask",
    "daemon/serve/console": "a browser's door",
    "daemon/core": "all of it, without I/O",
    "daemon/app": "mgtd: core, ports, sockets",
    "daemon/cli": "mgt: the commands",
}
# Column and row of each room, the roof first: a room stands above those that it includes.
GRID = {
    "daemon": {"app": (0, 0), "cli": (1, 0), "core": (0, 1), "run": (0, 2), "serve/console": (1, 2), "serve": (1, 3), "acquire": (0, 3),
               "config": (0.5, 4), "plan": (0, 5), "store": (1, 5)},
    "calib": {"report": (0, 0), "report/figures": (1, 1), "criticism/search": (0, 1), "design": (0, 2),
              "discovery": (1, 2), "validity": (1, 3), "criticism/tests": (0, 3), "fit/method_choice": (0, 4), "criticism/live": (1, 5),
              "fit/checks": (0, 5), "fit/joint": (0, 6), "fit/two_step": (0, 7), "fit": (0, 8), "calibration": (0, 9),
              "effects/library": (0, 10), "effects/formula": (0, 11), "effects/laws": (0, 12), "effects": (0, 13),
              "stats": (1, 13), "sensor": (0, 14), "poses": (1, 14), "linear": (0, 15)},
}
LEFT = {"daemon": 149, "calib": 722}
COLUMN = {"daemon": 250, "calib": 246}
WIDTH, ROW, BOX_W, BOX_H = 1120, 58, 208, 40
TOP = 92
COLOURS = {"daemon": ("#dcefe3", "#2a7a4b"), "calib": ("#e3eefb", "#1d5fa8"), "drivers": ("#fdf1dc", "#b3700d"),
           "proto": ("#f1e9f7", "#6b3fa0")}


def reduced(graph):
    """The arrows that are not a detour along two others."""
    def reach(room):
        out, todo = set(), list(graph[room])
        while todo:
            other = todo.pop()
            if other not in out:
                out.add(other)
                todo += graph[other]
        return out
    return [(a, b) for a in graph for b in graph[a] if not any(b in reach(c) for c in graph[a] if c != b)]


def places():
    return {f"{top}/{name}": (LEFT[top] + COLUMN[top] * column, TOP + ROW * row)
            for top, rooms in GRID.items() for name, (column, row) in rooms.items()}


def frame(top, title, x, y, w, h):
    fill, line = COLOURS[top]
    return (f'<rect x="{x}" y="{y}" width="{w}" height="{h}" rx="10" fill="{fill}" stroke="{line}" stroke-width="2"/>'
            f'<text x="{x + 16}" y="{y + 26}" font-weight="bold" font-size="17" fill="{line}">{top}/</text>'
            f'<text x="{x + 110}" y="{y + 26}" fill="#394b5a">{title}</text>')


def box(room, place):
    x, y = place
    line = COLOURS[room.split("/")[0]][1]
    name = room.split("/", 1)[1]
    return (f'<rect x="{x - BOX_W / 2:g}" y="{y:g}" width="{BOX_W}" height="{BOX_H}" rx="6" fill="#ffffff" stroke="{line}"/>'
            f'<text x="{x:g}" y="{y + 16:g}" text-anchor="middle" font-weight="bold" fill="#1b2733">{name}</text>'
            f'<text x="{x:g}" y="{y + 33:g}" text-anchor="middle" font-size="12" fill="#5b6b7a">{SAYS[room]}</text>')


def arrow(a, b, at):
    (x0, y0), (x1, y1) = at[a], at[b]
    if x0 == x1 and y1 - y0 > ROW:  # around the boxes between, on the right
        side = x0 + BOX_W / 2 + 34
        path = (f"M{x0 + BOX_W / 2:g} {y0 + BOX_H / 2:g}C{side:g} {y0 + BOX_H / 2:g} {side:g} {y1 + BOX_H / 2:g} "
                f"{x1 + BOX_W / 2:g} {y1 + BOX_H / 2:g}")
    elif abs(x1 - x0) > BOX_W:  # between the columns, from side to side
        sign = 1 if x1 > x0 else -1
        x0, x1 = x0 + sign * BOX_W / 2, x1 - sign * BOX_W / 2
        path = (f"M{x0:g} {y0 + BOX_H / 2:g}C{x1:g} {y0 + BOX_H / 2:g} {x0:g} {y1 + BOX_H / 2:g} "
                f"{x1:g} {y1 + BOX_H / 2:g}")
    else:
        y0 += BOX_H
        path = f"M{x0:g} {y0:g}C{x0:g} {y0 + 14:g} {x1:g} {y1 - 14:g} {x1:g} {y1:g}"
    return f'<path d="{path}" fill="none" stroke="#394b5a" stroke-width="1.3" marker-end="url(#t)"/>'


def picture():
    at = places()
    assert set(at) == {*DAEMON, *CALIB}
    daemon_bottom, calib_bottom = (TOP + ROW * (1 + max(row for _, row in GRID[top].values())) + 4
                                   for top in ("daemon", "calib"))
    height = calib_bottom + 130
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" '
           'font-family="DejaVu Sans, Verdana, sans-serif" font-size="13.5" fill="#1b2733">',
           '<title>The rooms of the source tree and who may include whom</title>',
           '<defs><marker id="t" viewBox="0 0 10 10" refX="9" refY="5" markerWidth="7" markerHeight="7" orient="auto">'
           '<path d="M0 0 10 5 0 10z" fill="#394b5a"/></marker></defs>',
           f'<rect width="{WIDTH}" height="{height}" fill="#ffffff"/>',
           '<text x="24" y="32">An arrow goes from a room to one that it may include. What can be reached along two '
           'arrows has none of its own.</text>',
           frame("daemon", "decides, connects, stores, serves", 24, 50, 500, daemon_bottom - 50),
           frame("calib", "readings become a calibration, its errors a cause", 580, 50, 516, calib_bottom - 50),
           frame("drivers", "bytes become readings, a pair of files an instrument", 24, daemon_bottom + 70,
                 500, 70),
           frame("proto", "the words that all rooms share: reading, epoch, pose, tensor, time, error", 24,
                 calib_bottom + 40, 1072, 60)]
    out += [box(room, place) for room, place in at.items()]
    for graph in (DAEMON, CALIB):
        out += [arrow(a, b, at) for a, b in reduced(graph)]
    drivers_y = daemon_bottom + 70
    for path in (f"M274 {daemon_bottom}V{drivers_y}", f"M524 {TOP + 60}H580", f"M500 {drivers_y + 70}V{calib_bottom + 40}",
                 f"M833 {calib_bottom}V{calib_bottom + 40}"):
        out.append(f'<path d="{path}" fill="none" stroke="#394b5a" stroke-width="2.2" marker-end="url(#t)"/>')
    out += [f'<text x="40" y="{drivers_y + 52}" fill="#5b6b7a" font-style="italic">What did the instrument say?</text>',
            f'<text x="24" y="{drivers_y + 110}" fill="#394b5a">tests/ mirror the rooms; tests/rig = mgt-rig, physics of its own:</text>',
            f'<text x="24" y="{drivers_y + 130}" fill="#394b5a">it includes proto and nothing else of the program.</text>',
            "</svg>"]
    return "\n".join(out) + "\n"


def main():
    path = pathlib.Path(sys.argv[1]) / "docs" / "rooms.svg"
    if sys.argv[2:] == ["--check"]:
        if path.read_text() != picture():
            print(f"{path} is not what tests/lint/rooms.py says: python3 tests/lint/rooms_svg.py {sys.argv[1]}")
            return 1
        return 0
    path.write_text(picture())
    return 0


if __name__ == "__main__":
    sys.exit(main())
