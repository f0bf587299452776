# SPDX-License-Identifier: Apache-2.0
"""The whole recordings, from a folder that holds the files of the sources under the names they have there.

The rows come out as those of the extracts in tests/data/real, first the header; a source names its own file.
"""
import csv


def xyz(path):
    return path.read_text().splitlines()


def first_three(path):
    lines = [line for line in path.read_text().splitlines() if line.strip()]
    return ["x,y,z"] + [",".join(cell.strip() for cell in line.split(",")[:3]) for line in lines]


def named(path, names):
    with path.open() as file:
        return [{name: row[name] for name in names} for row in csv.DictReader(file)]


def rm3100(path):
    names = ["rm3100_x", "rm3100_y", "rm3100_z"]
    return [",".join(names)] + [",".join(row.values()) for row in named(path, names)]


SOURCES = {
    "hand_1": ("data-set_1.csv", xyz),
    "hand_2": ("data-set_2.csv", xyz),
    "drone_00": ("20231008_apex5_mag_on_tpu_00.txt", first_three),
    "drone_03": ("20231014_apex5_mag_on_tpu_03.txt", first_three),
    "rm3100": ("test1_esti.csv", rm3100),
}


def rows_of(folder, name):
    """None where the folder lacks the file."""
    file, read = SOURCES[name]
    path = folder / file
    return read(path) if path.exists() else None
