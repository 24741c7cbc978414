#!/usr/bin/env python3
"""Two ranks against one on a machine with two free cores: wall times of runs that take turns.

  two.py [--abut build/bin/abut] [--turns 9] [--cells 1408,352] [--options=-scene_split] [--launcher "mpiexec -n {ranks}"]

Two layers of about a million unknowns each, uniform meshes, penalty contact, once solved. A turn is a run on one rank and one on two; what
counts is the ratio of each turn, and of these the median: a machine that is busy for a while disturbs both runs of a turn. Prints for
the whole run and each part of it the medians of the seconds, and median, least and largest ratio. All runs of one launch have to agree on
force and pressure to eight digits. For the estimator: --options="-estimator_type fembem".
"""
import argparse, os, shlex, statistics, subprocess, sys, tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
TOP = os.path.dirname(os.path.dirname(os.path.dirname(HERE)))
sys.path[:0] = [os.path.join(TOP, "examples", "layers"), os.path.join(TOP, "tests")]
from layers import record  # noqa: E402
from run import MPI  # noqa: E402

PARTS = "total", "setup", "factor", "solve", "estimate", "output"


def once(args, ranks, folder):
    words = ["-scene_bodies lower,upper -scene_pairs mid -mid_pair_bodies upper,lower -mid_pair_sides bottom,top -mid_pair_gap 1e-3*x^2 -mid_pair_penalty 0.05"]
    for name, y in ("lower", 0), ("upper", 1):
        words.append(f"-{name}_mesh_box 0,{y},4,{y + 1} -{name}_mesh_cells {args.cells} -{name}_material_young 2.1e5 -{name}_material_poisson 0.3 -{name}_bc_left_u1 0")
    words.append("-lower_bc_bottom_u2 0 -upper_bc_top_u2 -1.366e-3")
    path = os.path.join(folder, "record")
    command = shlex.split(args.launcher.format(ranks=ranks)) + [args.abut, *" ".join(words).split(), *shlex.split(args.options), "-record", path]
    done = subprocess.run(command, capture_output=True, text=True, env={**MPI, **os.environ, "TMPDIR": folder})
    if done.returncode:
        raise SystemExit(done.stdout[-2000:] + done.stderr[-2000:])
    return record(path)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--abut", default=os.path.join(TOP, "build", "bin", "abut"))
    parser.add_argument("--turns", type=int, default=9)
    parser.add_argument("--cells", default="1408,352")
    parser.add_argument("--options", default="-scene_split")
    parser.add_argument("--launcher", default="mpiexec -n {ranks}")
    args = parser.parse_args()
    turns = []
    for turn in range(args.turns):
        with tempfile.TemporaryDirectory() as folder:
            order = (1, 2) if turn % 2 else (2, 1)
            runs = {ranks: once(args, ranks, folder) for ranks in order}
        for key in "pair.mid.force", "pair.mid.pressure_max":
            assert abs(runs[1][key] / runs[2][key] - 1) < 1e-8, (key, runs)
        turns.append(runs)
        print(f"turn {turn + 1}: {runs[1]['time.total']:.1f} s on one rank, {runs[2]['time.total']:.1f} s on two, ratio {runs[2]['time.total'] / runs[1]['time.total']:.3f}", flush=True)
    print(f"\n{int(turns[0][1]['unknowns'])} unknowns, {int(turns[0][1]['sweeps'])} sweeps, {args.turns} turns, {args.options}")
    print("part        one rank, s   two ranks, s   ratio   least to largest")
    for part in PARTS:
        one, two = ([runs[ranks][f"time.{part}"] for runs in turns] for ranks in (1, 2))
        if min(one) < 1e-3:
            continue
        ratios = [b / a for a, b in zip(one, two)]
        print(f"{part:10} {statistics.median(one):12.2f} {statistics.median(two):14.2f} {statistics.median(ratios):7.3f}   {min(ratios):.3f} to {max(ratios):.3f}")


if __name__ == "__main__":
    main()
