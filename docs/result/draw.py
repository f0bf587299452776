#!/usr/bin/env python3
"""Draws docs/result/result.svg: what each step of a calibration leaves of the error, from the JSON of `mgt fit`.

  draw.py PLAIN.json WITH_EFFECT.json > result.svg
"""
import json
import math
import sys

WIDTH, ROW, TOP, LEFT, PANEL, GAP = 900, 34, 62, 250, 285, 50
FROM, TO = 0.01, 10_000  # of both axes
COLOURS = {"raw": "#9aa0a6", "fit": "#0072b2", "last": "#1b7f4b"}


def rms(values):
    values = list(values)
    return math.sqrt(sum(v * v for v in values) / len(values))


def errors(table):
    return rms(table["total_field_rmse_nT"]), rms(table["tensor_rmse_nT_per_m"].values())


def main():
    plain, named = (json.load(open(path, encoding="utf-8")) for path in sys.argv[1:3])
    rows = [("raw readings", errors(plain["before"]), "raw"),
            ("simplified linear method", errors(plain["simplified"]), "fit"),
            ("joint fit of all poses", errors(plain["after"]), "fit"),
            ("with site.gradient, as explain says", errors(named["after"]), "last")]
    height = TOP + ROW * len(rows) + 40
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" width="{WIDTH}" '
           'font-family="system-ui, Noto Sans, sans-serif" font-size="13" fill="#1d2329">',
           f'<rect width="{WIDTH}" height="{height}" fill="#fff"/>']
    for panel, (title, unit) in enumerate([("error of the total field", "nT"), ("error of the tensor", "nT/m")]):
        left = LEFT + panel * (PANEL + GAP)

        def x(value):
            return left + PANEL * math.log(value / FROM) / math.log(TO / FROM)

        bottom = TOP + ROW * len(rows)
        out.append(f'<text x="{left}" y="24" font-weight="600">{title}, {unit}, rms</text>')
        for decade in range(-2, 5):
            at = x(10.0 ** decade)
            out.append(f'<line x1="{at:.1f}" x2="{at:.1f}" y1="{TOP - 14}" y2="{bottom}" stroke="#e3e7ea"/>')
            label = f"{10.0 ** decade:g}" if decade < 4 else "10 000"
            out.append(f'<text x="{at:.1f}" y="{bottom + 18}" text-anchor="middle" font-size="11" '
                       f'fill="#66707a">{label}</text>')
        if unit == "nT":
            noise = x(plain["noise_nT"])
            out.append(f'<line x1="{noise:.1f}" x2="{noise:.1f}" y1="{TOP - 14}" y2="{bottom}" '
                       'stroke="#39424b" stroke-dasharray="4 3"/>')
            out.append(f'<text x="{noise:.1f}" y="{TOP - 19}" font-size="11" fill="#39424b" '
                       f'text-anchor="middle">noise {plain["noise_nT"]:.3f}</text>')
        for k, (name, values, kind) in enumerate(rows):
            y, end = TOP + ROW * k + 12, x(values[panel])
            if panel == 0:
                out.append(f'<text x="{LEFT - 14}" y="{y + 4}" text-anchor="end">{name}</text>')
            out.append(f'<line x1="{left}" x2="{end:.1f}" y1="{y}" y2="{y}" stroke="{COLOURS[kind]}" '
                       'stroke-width="3"/>')
            out.append(f'<circle cx="{end:.1f}" cy="{y}" r="5" fill="{COLOURS[kind]}"/>')
            text = f"{values[panel]:.0f}" if values[panel] >= 100 else f"{values[panel]:.2g}"
            out.append(f'<text x="{end + 10:.1f}" y="{y + 4}" font-weight="600">{text}</text>')
    print("\n".join(out) + "\n</svg>")


if __name__ == "__main__":
    main()
