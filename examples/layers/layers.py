"""What the scripts of this folder share: the files a run leaves, and the reference values."""
import csv, json, os

HERE = os.path.dirname(os.path.abspath(__file__))


def number(text):
    try:
        return float(text)
    except ValueError:
        return text


def record(path):
    """A file written by -record: one `key value` a line"""
    with open(path) as f:
        return {key: number(value) for key, _, value in (line.strip().partition(" ") for line in f) if key}


def profile_rows(path, pair="mid"):
    """The rows of one pair of a file written by -output_profile, by x"""
    with open(path) as f:
        return sorted((r for r in csv.DictReader(f) if r["pair"] == pair), key=lambda r: float(r["x"]))


def profile(path, pair="mid"):
    """Nodes and nodal pressures of one pair from a file written by -output_profile: x, p"""
    nodes = [(float(r["x"]), float(r["pressure"])) for r in profile_rows(path, pair) if r["side"] == "pressure"]
    return [list(column) for column in zip(*nodes)]


def reference(c):
    """Reference values of the scene with theta = c*H/E; c = 0 is exact contact"""
    with open(os.path.join(HERE, "reference.json")) as f:
        cases = json.load(f)["cases"]
    for key, case in cases.items():
        if abs(float(key) - c) <= 1e-6 * c:
            return case
    raise SystemExit(f"no reference values for c = {c:g}; there are some for {', '.join(cases)}")


def penalty(run):
    """c of a record: theta = c*H/E with H = 1, E = 2.1e5"""
    return 2.1e5 * run["pair.mid.theta"]
