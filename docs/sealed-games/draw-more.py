#!/usr/bin/env python3
"""Eighteen more worlds, from the same bags as draw.py, in a drawn order: python3 draw-more.py SEED DIRECTORY."""
import os, re, sys, tempfile
more_seed, more_out = int(sys.argv[1]), sys.argv[2]
here = os.path.dirname(os.path.abspath(__file__))
with tempfile.TemporaryDirectory() as unused:
    sys.argv[1:] = ["1", unused]
    exec(open(os.path.join(here, "draw.py")).read())
os.makedirs(more_out, exist_ok=True)
r.seed(more_seed)
def early(t): return re.sub(r"at_s = (\d+)", lambda m: f"at_s = {200 + int(m.group(1)) * 1700 // 3300}", t)
worlds = [outside() for _ in range(7)] + [library() for _ in range(2)] + [library() + library()]
worlds += [early(car()), early(magnet()), early(magnet()), gross(), site(), site(), noise(True), noise(True)]
r.shuffle(worlds)
for n, w in enumerate(worlds):
    with open(os.path.join(more_out, f"m{n:02d}.toml"), "w") as f: f.write(rig() + w)
