"""The cases of the suite: what is verified (V) and what is hard (H). `make suite` runs the tests that measure them, and prints what they measured.

A test measures a case by case() of tests/abut.py, or CkCase() of tests/unit/ck.h. A case with a reason cannot pass yet: it is an expected failure, and a
test that measures it all the same is a failure of this list.
"""

CASES = {
    "V01": ("two blocks pressed together, closed form with penalty and sweeps", None),
    "V02": ("patch test of the contact on matching and non-matching meshes", None),
    "V03": ("Hertz' pressure on boxes, exact displacements around", None),
    "V04": ("two layers, integral equation and scaling laws", None),
    "V05": ("the error of the penalty", None),
    "V06": ("Hertz' line contact of cylinders, NAFEMS 1", None),
    "V07": ("Hertz' contact of spheres", None),
    "V08": ("receding contact of a layer on a half-plane", None),
    "V09": ("flat punch with sharp corners", None),
    "V10": ("re-entrant corner of 3 pi/2", None),
    "V11": ("pin in a hole, conforming", None),
    "V13": ("one body: orders of convergence, hanging nodes", None),
    "V14": ("three layers, the middle one afloat", None),
    "V15": ("kernels of the boundary elements", None),
    "V16": ("estimators against true errors", None),
    "V17": ("friction of a block: uniform stress, held by friction alone", None),
    "V18": ("partial slip, Cattaneo and Mindlin, and friction that turns back", None),
    "V19": ("shrink fits, Lame", None),
    "V20": ("thick tubes under pressure, Lame", None),
    "H01": ("nearly incompressible", None),
    "H02": ("constants that no material has", None),
    "H03": ("contrast of the materials", None),
    "H04": ("ten decades of the penalty", None),
    "H05": ("relaxation beyond its limit", None),
    "H06": ("the stop test against the true error", None),
    "H07": ("no gap anywhere", None),
    "H08": ("no contact reached", None),
    "H09": ("bodies that nothing holds", None),
    "H10": ("penetration at first", None),
    "H11": ("contact in a point", None),
    "H12": ("contact grows over the whole side", None),
    "H13": ("cells far from squares", None),
    "H14": ("very thin layers", None),
    "H15": ("units", None),
    "H16": ("no stress", None),
    "H17": ("refinement without end", None),
    "H18": ("symmetry", None),
    "H19": ("hanging nodes on the contact side", None),
    "H20": ("boundary elements close to the boundary", None),
    "H21": ("balance of forces on curved sides", None),
    "H22": ("meshes that match badly", None),
    "H23": ("checkpoint and restart", None),
    "H24": ("ranks", None),
    "H25": ("the same run again", None),
    "H26": ("bad input", None),
    "H27": ("load up and down", None),
    "H28": ("linear solvers that fail", None),
}
MOST_EXPECTED = 5
MARK = "case "  # begins the line of a measured case: name | criterion | measured | bound | verdict


def read(output):
    """The lines of cases in what a test said"""
    for line in output.splitlines():
        if line.startswith(MARK):
            name, *rest = [part.strip() for part in line[len(MARK) :].split("|")]
            if len(rest) == 4:
                yield (name, *rest)


def table(measured):
    """Lines to print, and whether all is well; measured: of every case the rows (criterion, measured, bound, verdict)"""
    lines, count = [], {"pass": 0, "expected failure": 0, "FAIL": 0}
    for name, (title, reason) in CASES.items():
        rows = measured.get(name, [])
        verdict = "pass" if rows and all(row[3] == "pass" for row in rows) else "FAIL"
        if reason:
            verdict = "FAIL" if rows else "expected failure"
        count[verdict] += 1
        lines.append(f"{name}  {title}: {verdict}" + (f", {reason}" if reason else "" if rows else ", nothing measured it"))
        for criterion, value, bound, good in dict.fromkeys(rows):
            lines.append(f"       {criterion:80} {value:>11} {bound:>16}  {good}")
    for name in sorted(set(measured) - set(CASES)):
        lines.append(f"{name}: no such case in tests/cases.py")
        count["FAIL"] += 1
    lines.append(", ".join(f"{number} {verdict}" for verdict, number in count.items()))
    return lines, not count["FAIL"] and count["expected failure"] <= MOST_EXPECTED
