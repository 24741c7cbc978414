"""Runs on several numbers of ranks, and whether they say the same"""
import math, os, re, tempfile, xml.etree.ElementTree as xml

from abut import read_csv, run

# What says nothing of the answer
OTHER = r"time\.|memory\.|body\.\w+\.(imbalance|ranks)"
# Keys that may be nothing but round-off: what is below this on both numbers of ranks is the same
ROUNDOFF = r"check\.|residual\.|error\.(linear|loop)|pair\.\w+\.(balance|complementarity|penetration_max|tangential|slip_max)"
NOTHING = 1e-10
# Bounds from the contact model, which the last sweep corrected: a step of 1e-8 of the answer leaves the correction eight digits or fewer
MODEL = r"error\.penalty|pair\.\w+\.force_penalty"
MODEL_DIGITS = 1e-4


def numbers(array):
    return [float(word) for word in array.text.split()]


def read_cells(path):
    """The cells of a VTU file as a set: corners, with nine digits, and level"""
    data = {array.get("Name"): numbers(array) for array in xml.parse(path).getroot().iter("DataArray")}
    x = data["vertices"]
    points = [(f"{x[i]:.9g}", f"{x[i + 1]:.9g}") for i in range(0, len(x), 3)]
    ends = [int(end) for end in data["offsets"]]
    corners = [tuple(sorted(points[int(k)] for k in data["connectivity"][a:b])) for a, b in zip([0] + ends, ends)]
    return set(zip(corners, data["level"]))


def outcome(scene, options, ranks, expect):
    """Record, rows of the cycles, cells of all meshes"""
    with tempfile.TemporaryDirectory() as folder:
        record = run(scene, *options, f"-record_csv {folder}/cycles.csv -output {folder}/fields.vtu", ranks=ranks, expect=expect, limit=100)
        rows = read_csv(f"{folder}/cycles.csv")
        cells = {name: read_cells(f"{folder}/{name}") for name in sorted(os.listdir(folder)) if name.endswith(".vtu")}
    return record, rows, cells


def read_values(path):
    """Displacements of the points and, if there are any, indicators of the cells of a VTU file, by where they are, with all digits"""
    data = {array.get("Name"): numbers(array) for array in xml.parse(path).getroot().iter("DataArray")}
    x, u, corner = data["vertices"], data["displacement"], data["connectivity"]
    points = [(f"{x[i]:.9g}", f"{x[i + 1]:.9g}") for i in range(0, len(x), 3)]
    moved = {(point, d): u[3 * i + d] for i, point in enumerate(points) for d in range(2)}
    ends = [int(end) for end in data["offsets"]]
    cells = [tuple(sorted(points[int(k)] for k in corner[a:b])) for a, b in zip([0] + ends, ends)]
    return moved, dict(zip(cells, data.get("eta", [])))


def farthest(one, other):
    """The largest difference of two fields on the same points, over the largest value"""
    assert one.keys() == other.keys()
    return max((abs(one[at] - other[at]) for at in one), default=0) / max(map(abs, one.values()), default=1)


def digits_off(one, other):
    """Relative difference beyond one unit of the tenth digit, which is the last of the record"""
    return max(0, abs(one - other) - 1.01 * 10.0 ** (math.floor(math.log10(one)) - 9)) / one


def off(one, other, key):
    """How far two values of a key are from each other, relative, beyond the digits of the record"""
    if one == other:
        return 0
    if isinstance(one, str) or isinstance(other, str):
        return math.inf
    if re.match(ROUNDOFF, key) and max(abs(one), abs(other)) < NOTHING:
        return 0
    distance = digits_off(abs(one), abs(other)) if one * other > 0 else math.inf
    return 0 if re.match(MODEL, key) and distance < MODEL_DIGITS else distance


def farthest_key(one, other):
    """By how much two records differ most, and in which key"""
    keys, others = ({key for key in record if not re.match(OTHER, key)} for record in (one, other))
    assert keys == others, keys ^ others
    return max((off(one[key], other[key], key), key) for key in keys)
