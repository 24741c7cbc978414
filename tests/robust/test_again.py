"""The same run again, with addresses that the system shuffles: files to the last byte, times and memory left out. On one rank: on several
the residuals differ in their round-off from run to run."""
import os, tempfile

from abut import LAYERS, case, run

TIMES = "time.", "memory."
RUNS = 5


def files(folder, *options):
    """The bytes of the CSV of the cycles, without the columns of times and memory, and of the profile"""
    run(*options, f"-record_csv {folder}/cycles.csv -output_profile {folder}/profile.csv")
    with open(os.path.join(folder, "cycles.csv"), "rb") as f:
        rows = [line.split(b",") for line in f]
    keep = [i for i, name in enumerate(rows[0]) if not name.decode().startswith(TIMES)]
    assert len(rows) > 3 and 20 < len(keep) < len(rows[0]) and len({len(row) for row in rows}) == 1
    with open(os.path.join(folder, "profile.csv"), "rb") as f:
        return [[row[i] for i in keep] for row in rows], f.read()


def test_five_runs_write_the_same_bytes():
    scenes = (
        "-snes_type ddactive -adaptor_bodies lower,upper -adaptor_threshold 0.2",
        "-snes_type ddactive -estimator_type residual -lower_mesh_order 2 -upper_mesh_order 2 -adaptor_threshold 0.05",
        "-snes_type anderson -estimator_type zz -adaptor_threshold 0.2",
    )
    other = 0
    for options in scenes:
        with tempfile.TemporaryDirectory() as folder:
            first, *again = (files(folder, LAYERS, "-upper_mesh_cells 8,2", *options.split()) for _ in range(RUNS))
        other += sum(one != first for one in again)
    case("H25", "of four repetitions of three runs on one rank, those with other bytes", other, 0)
