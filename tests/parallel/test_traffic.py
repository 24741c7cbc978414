"""What many ranks cost, in counts: iterations of the linear solvers, cells of a rank, bytes that a rank sends"""
import collections, functools, os, subprocess, tempfile

from abut import LAYERS, ROOT, case, read_csv, run

TOL = os.path.join(ROOT, "examples", "studies", "shares", "layers_tol.yml")
BODIES = ("lower", "upper")
MULTIGRID = " ".join(f"-{body}_ksp_type cg -{body}_pc_type hypre" for body in BODIES)
UNIFORM = "-snes_type ddactive -upper_mesh_shape quad -adaptor_threshold 0.9 -estimator_type zz"


def per_body(record, key):
    return [record[f"body.{body}.{key}"] for body in BODIES]


def check_iterations(what, scene, *options):
    """A sweep on 16 ranks takes hardly more than on one, in as many sweeps"""
    one, many = (run(scene, *options, MULTIGRID, ranks=n) for n in (1, 16))
    assert one["sweeps"] == many["sweeps"] and one["cycles"] == many["cycles"]
    ratio = max(a / b for a, b in zip(per_body(many, "ksp_its"), per_body(one, "ksp_its")))
    case("H24", f"iterations a sweep on 16 ranks over those on one, {what}", ratio, 1.15)


def test_iterations_of_multigrid_hardly_grow_with_the_ranks():
    check_iterations("six adapted meshes", TOL, "-scene_tol 1.8e-2 -estimator_type zz")
    check_iterations("uniform mesh", LAYERS, UNIFORM, "-upper_mesh_cells 128,32 -lower_mesh_cells 128,32")


MOST = 1.15
ENOUGH = 50  # cells a rank


def test_adapted_meshes_are_cut_evenly():
    """Quads on three ranks; on sixteen triangles, too, and cells that are merged again"""
    runs = (
        (3, "-scene_tol 3e-2 -estimator_type zz"),
        (16, "-scene_tol 1.8e-2 -estimator_type zz -adaptor_coarsen 0.2 -upper_mesh_shape triangle"),
    )
    worst, judged = 0, 0
    for ranks, options in runs:
        with tempfile.TemporaryDirectory() as folder:
            run(TOL, options, f"-record_csv {folder}/cycles.csv", ranks=ranks)
            rows = read_csv(f"{folder}/cycles.csv")
        assert len(rows) > 3
        for row in rows:
            cells, imbalance = per_body(row, "cells"), per_body(row, "imbalance")
            assert all(1 <= value <= ranks for value in imbalance), imbalance
            most = [value * n / ranks for value, n in zip(imbalance, cells)]  # cells of a rank
            assert all(abs(value - round(value)) < 1e-4 for value in most), most
            good = [value for value, n in zip(imbalance, cells) if n >= ENOUGH * ranks]
            worst, judged = max([worst, *good]), judged + len(good)
    assert judged > 6, judged
    case("H24", f"most cells of a rank over the mean, from {ENOUGH} cells a rank on", worst, MOST)
    assert all(value == 1 for value in per_body(run(TOL, "-scene_tol 0.1 -estimator_type zz"), "imbalance"))


@functools.cache
def counter():
    """The library that counts, made once"""
    library = os.path.join(tempfile.mkdtemp(prefix="count"), "libcount.so")
    source = os.path.join(ROOT, "examples", "studies", "scaling", "count.c")
    subprocess.run(["mpicc", "-std=gnu99", "-Wall", "-Wextra", "-Werror", "-fPIC", "-shared", source, "-o", library, "-ldl"], check=True)
    return library


def sent(ranks, cells, sweeps, rtol):
    """Of a run of the paper's loop: bytes that every rank sent to others, the most that one put into collective calls, sweeps, iterations"""
    loop = f"-snes_type ddneumann -snes_ddneumann_gamma 0.02 -snes_ddneumann_start zero -snes_max_it {sweeps}"
    mesh = " ".join(f"-{body}_mesh_cells {4 * cells},{cells} -{body}_ksp_rtol {rtol}" for body in BODIES)
    with tempfile.TemporaryDirectory() as folder:
        os.environ.update(LD_PRELOAD=counter(), ABUT_COUNTS=f"{folder}/counts")
        try:
            record = run(LAYERS, UNIFORM, mesh, MULTIGRID, loop, ranks=ranks, expect=2)
        finally:
            del os.environ["LD_PRELOAD"]
        single, together = collections.Counter(), collections.Counter()
        for row in read_csv(f"{folder}/counts"):
            single[row["rank"]] += row["bytes"]
            together[row["rank"]] += row["reduced"] + row["gathered"]
    assert record["verdict"] == "max_iterations" and len(single) == ranks
    return [single[rank] for rank in range(ranks)], max(together.values()), record["sweeps"], sum(per_body(record, "ksp_its"))


def per_sweep(ranks, cells):
    """The most bytes that a rank sends in a sweep: all of them, those beside its linear iterations, those into collective calls. Runs that
    differ in the iterations alone say what one of them sends, those that differ in the sweeps the rest."""
    (few, few_all, start, its), (more, more_all, end, loose), (exact, *_, tight) = (
        sent(ranks, cells, *how) for how in ((2, 1e-3), (6, 1e-3), (6, 1e-10))
    )
    n = end - start
    assert n == 4 and tight > loose + 20
    one = [(b - a) / (tight - loose) for a, b in zip(more, exact)]
    rest = [(b - a - c * (loose - its)) / n for a, b, c in zip(few, more, one)]
    return max(c * tight / end + r for c, r in zip(one, rest)), max(rest), (more_all - few_all) / n


def cut(ranks, cells):
    """Nodes on the cuts around the part of a rank that lies inside: squares of a box 4 by 1, in one row of four or in two of eight"""
    return 2 * (cells + 1) if ranks == 4 else 3 * (cells // 2 + 1)


def test_bytes_of_a_sweep_grow_as_the_cuts_between_the_ranks():
    """With the mesh at equal ranks, and from 4 ranks to 16, where the cuts of a rank are a fifth shorter, not at all; up to a tenth for the
    coarse levels of multigrid. The traces, which all ranks have, are sent by their owners to all others: they grow as the sides, and are a
    small part."""
    small, large = 16, 32
    found = {(ranks, cells): per_sweep(ranks, cells) for ranks in (4, 16) for cells in (small, large)}
    for ranks in 4, 16:
        (all_, rest, told), (more, longer, longest) = found[ranks, small], found[ranks, large]
        case("H24", f"growth of the bytes of a sweep over that of the cuts, {ranks} ranks, half the cell", more / all_ / (cut(ranks, large) / cut(ranks, small)), 1.1)
        case("H24", f"growth of the bytes of the traces over that of the sides, {ranks} ranks, half the cell", longer / rest / (large / small), 1.1)
        case("H24", f"growth of what a rank tells all others in a sweep over that of the sides, {ranks} ranks, half the cell", longest / told / (large / small), 1.1)
        case("H24", f"part of both in the bytes of a sweep, {ranks} ranks", max((rest + told) / all_, (longer + longest) / more), 0.1)
    for cells in small, large:
        case("H24", f"bytes of a rank and sweep on 16 ranks over those on 4, {cells} cells a unit", found[16, cells][0] / found[4, cells][0], 1.1)
