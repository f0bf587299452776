#!/usr/bin/env python3
"""Draws the worlds of the sealed games: python3 draw.py SEED DIRECTORY.

Games 1 to 4 hide effects of the library: DIRECTORY/game-N.sh holds only the mgt-rig command, the coin is how many.
Games 5 to 11 are two runs with noise that is not white, three disturbances, one site and one law that is in no
library, in an order that is drawn too. Game 12 is any of them, played through the serial ports.
Nothing is printed: who wants to play does not look into the files."""
import random, sys, os
seed, out = int(sys.argv[1]), sys.argv[2]
os.makedirs(out, exist_ok=True)
r = random.Random(seed)
AXES = [f"s{i}.{a}" for i in range(1, 5) for a in "xyz"]

def log(lo, hi): return round(lo * (hi / lo) ** r.random(), 4)
def vec(n, size):
    v = [r.gauss(0, 1) for _ in range(n)]
    k = size / sum(x * x for x in v) ** 0.5
    return "[" + ", ".join(f"{x * k:.4f}" for x in v) + "]"
def place(lo, hi):
    while True:
        v = [r.gauss(0, 1) for _ in range(3)]
        n = sum(x * x for x in v) ** 0.5
        d = r.uniform(lo, hi)
        v = [x * d / n for x in v]
        return "[" + ", ".join(f"{x:.3f}" for x in v) + "]"
def rig():
    return (f'[rig]\nparameters = "{r.choice(["table3", "table6", "random", "random"])}"\nseed = {r.randrange(1, 10**6)}\n'
            f'[site]\nf_nT = {r.choice([38000, 50000, 58000])}\ninclination_deg = {r.choice([-60, 35, 64, 72])}\n'
            f'drift_nT_per_h = {r.choice([0, 3, 10])}\n'
            f'[temperature]\nstart_degC = 20\nramp_degC_per_h = {r.choice([0, 1, 2])}\npulse_degC = {r.choice([2, 3])}\npulse_at_s = 600\npulse_tau_s = 900\n')
def noise(two):
    lines = {"ar": f'ar1_rho = {r.choice([0.5, 0.8, 0.9, 0.95])}\ntells_n_eff = {r.choice(["true", "false"])}\n',
             "walk": f"walk_nT_per_sqrt_h = {log(0.1, 3)}\n",
             "flicker": f"flicker_nT_per_sqrt_hz = {log(0.006, 0.05)}\n",
             "quantised": f"mean_step_nT = {r.choice([0.01, 0.1, 0.5, 1])}\n",
             "slow": f"slow_nT = {log(0.05, 1)}\nslow_tau_s = {log(100, 3000)}\n",
             "spikes": f"spike_share = {log(0.0005, 0.01)}\nspike_nT = {log(5, 200)}\n",
             "tails": 'noise = "student"\nstudent_dof = 3\n'}
    kinds = r.sample(sorted(lines), 2 if two else 1)
    text = "[sensors]\nnoise_nT = 0.3\n" + "".join(lines[k] for k in kinds)
    if two:
        text += r.choice(["", '[visit]\nnoise = "student"\nnoise_nT = 0.05\nstudent_dof = 3\n', "[table]\naccuracy_deg = 2\n"])
    return text
def car():
    if r.random() < 0.5:
        return f"[[vehicle]]\nat_s = {r.randrange(600, 3000)}\nnearest_m = {log(6, 15)}\nspeed_m_per_s = {log(2, 10)}\nstands_s = {r.choice([60, 120, 240])}\nmoment_Am2 = {log(100, 600)}\n"
    return "".join(f"[[vehicle]]\nat_s = {r.randrange(300, 3300)}\nnearest_m = {log(6, 20)}\nspeed_m_per_s = {log(2, 10)}\nmoment_Am2 = {log(100, 600)}\n" for _ in range(r.randrange(2, 6)))
def magnet():
    at = r.randrange(500, 3000)
    until = r.choice([None, at + r.randrange(60, 900)])
    return f"[[magnet]]\nat_s = {at}\n" + (f"until_s = {until}\n" if until else "") + f"moment_Am2 = {vec(3, log(0.3, 5))}\nat_m = {place(1.5, 3.5)}\n"
def gross():
    text = ""
    for _ in range(r.randrange(1, 6)):
        do = r.choice(["off", "off", "stuck", "saturated"])
        where = r.choice(AXES + ["s1", "s2", "s3", "s4"])
        text += f'[[gross]]\npose = {r.randrange(2, 145)}\nposes = {r.choice([1, 1, 1, 3, 8])}\nwhere = "{where}"\ndo = "{do}"\n' + (f"nT = {log(2, 5000)}\n" if do == "off" else "")
    return text
def site():
    k = r.choice(["gradient", "dipole", "both", "step", "curvature"])
    t = ""
    if k in ("gradient", "both"): t += f'[[effect]]\nname = "site.gradient"\nnT_per_m = {vec(5, log(3, 3000))}\n'
    if k in ("dipole", "both"): t += f'[[effect]]\nname = "site.dipole"\nmoment_Am2 = {vec(3, log(0.1, 3))}\nat_m = {place(0.9, 2.5)}\n'
    if k == "step": t += f'[[effect]]\nname = "site.gradient-step"\nnT_per_m = {vec(5, log(3, 300))}\nat_s = {r.randrange(500, 3000)}\n'
    if k == "curvature": t += f'[[effect]]\nname = "site.curvature"\nnT_per_m2 = {vec(7, log(3, 300))}\n'
    return t
def outside():
    a = r.choice(AXES)
    return r.choice([
        lambda: f'[[effect]]\nname = "hidden.neighbour"\nwhere = "{a[:2]}"\nnT_at_F0 = {vec(3, log(0.5, 8))}\npower = 2\n',
        lambda: f'[[effect]]\nname = "hidden.azimuth-harmonic"\nwhere = "{a}"\nnT = {log(0.1, 3)}\nper_turn = {r.choice([2, 3, 4, 5])}\nphase_deg = {r.randrange(360)}\n',
        lambda: f'[[effect]]\nname = "hidden.quartic"\nwhere = "{a}"\nnT_at_F0 = {log(0.5, 8)}\n',
        lambda: f'[[effect]]\nname = "hidden.cross-cubic"\nwhere = "{a}"\nnT_at_F0 = {log(0.5, 8)}\n',
        lambda: f'[[effect]]\nname = "hidden.soft-limit"\nwhere = "{a}"\nnT = {log(0.5, 8)}\nabove = {r.uniform(0.4, 0.8):.2f}\n',
        lambda: f'[[effect]]\nname = "hidden.warm-up"\nwhere = "{a[:2]}"\nnT = {log(0.5, 8)}\ntau_s = {log(200, 2000)}\n',
        lambda: f'[[effect]]\nname = "hidden.thermometer-lag"\nwhere = "{a[:2]}"\nnT_per_degC = {log(0.3, 3)}\ntau_s = {log(100, 900)}\n',
        lambda: f'[[effect]]\nname = "hidden.slip"\nwhere = "{a[:2]}"\narcsec = {vec(3, log(2, 60))}\nat_s = {r.randrange(500, 3000)}\n',
        lambda: f'[[effect]]\nname = "hidden.gravity-offset"\nwhere = "{a[:2]}"\nnT = {vec(3, log(0.2, 5))}\n',
        lambda: f'[[effect]]\nname = "hidden.cable-twist"\nwhere = "{a}"\nnT_per_turn = {log(0.2, 5)}\n',
        lambda: f'[[effect]]\nname = "hidden.beat"\nwhere = "{a}"\nnT = {log(0.1, 3)}\nperiod_s = {log(40, 900)}\n',
        lambda: f'[[covariate]]\nname = "motor_A"\nmean = 1.5\namplitude = 1.5\nwave = "toggle"\nevery_s = {r.choice([70, 130, 300])}\nrecorded = {r.choice(["true", "false"])}\n'
                f'[[effect]]\nname = "platform.current"\nof = "motor_A"\nwhere = "{a[:2]}"\nnT_per_A = {vec(3, log(0.2, 5))}\n',
    ])()
def library():
    a = r.choice(AXES)
    return r.choice([
        f'[[effect]]\nname = "axis.offset.temperature"\nwhere = "{a}"\nnT_per_degC = {log(0.1, 3)}\n',
        f'[[effect]]\nname = "axis.gain.temperature"\nwhere = "{a}"\nppm_per_degC = {log(5, 100)}\n',
        f'[[effect]]\nname = "axis.offset.step"\nwhere = "{a}"\nnT = {log(0.2, 10)}\nat_s = {r.randrange(500, 3000)}\n',
        f'[[effect]]\nname = "axis.cubic"\nwhere = "{a}"\nnT_at_F0 = {log(0.3, 10)}\n',
        f'[[effect]]\nname = "axis.hysteresis"\nwhere = "{a}"\nh_nT = {log(0.3, 10)}\nwidth = 0.1\n',
        f'[[effect]]\nname = "axis.zero-crossing"\nwhere = "{a}"\nnT = {log(0.2, 5)}\n'])

sizes = [r.choice([1, 1, 2]) for _ in range(4)]
for n, k in enumerate(sizes, 1):
    which = r.choice(["table6", "random"])
    with open(f"{out}/game-{n}.sh", "w") as f:
        f.write(f"mgt-rig table --rig {which} --seed {r.randrange(1, 10**6)} --hide {k} --seal game-{n}.sealed -o game-{n}.csv\n")
worlds = [noise(False), noise(True), car(), magnet(), gross(), site(), outside()]
r.shuffle(worlds)
for n, w in enumerate(worlds, 5):
    with open(f"{out}/game-{n}.toml", "w") as f: f.write(rig() + w)
last = r.choice([lambda: "", library, library, lambda: library() + library(), site, magnet, car, outside])()
with open(f"{out}/game-12.toml", "w") as f: f.write(rig() + last)
