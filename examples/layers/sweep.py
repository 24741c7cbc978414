#!/usr/bin/env python3
"""Runs layers.yml for thresholds delta from 0.3 to 0.05 and shows what each costs and gives: a table, and sweep.png and .svg like the
paper's Fig. 8 (displacements at (0.5, 0.75) against delta) and Fig. 10 (unknowns of the adapted and of the uniform mesh against 1/delta).

  sweep.py [--abut build/bin/abut] [--out out] [--deltas 0.3,0.2,0.1,0.07,0.05] [further options of abut]
"""
import argparse, os, subprocess, sys

from layers import HERE, penalty, record, reference

sys.path.insert(0, os.path.dirname(HERE))
from picture import plt, save  # noqa: E402


def solve(args, delta, further):
    path = os.path.join(args.out, f"layers_{delta:g}.record")
    scene = os.path.join(HERE, "layers.yml")
    command = [args.abut, "-options_file", scene, "-adaptor_threshold", f"{delta:g}", "-adaptor_max_level", "12", "-record", path]
    # pressures on the adapted side: the dual functions jump at its nodes, and cells smaller than those of the pressure side would be split without end
    command += ["-mid_pair_pressure_side", "second"] + further
    status = subprocess.run(command, stdout=subprocess.DEVNULL).returncode
    if status not in (0, 3):  # 3: a limit was reached, which the verdict names
        raise SystemExit(f"{' '.join(command)}\nended with exit status {status}")
    return record(path)


def draw(runs, folder):
    deltas = sorted(runs)
    lower = {d: runs[d]["body.lower.unknowns"] for d in deltas}
    uniform = {d: runs[d]["body.lower.unknowns_uniform"] for d in deltas}
    figure, axes = plt.subplots(1, 3, figsize=(11, 3.4))
    for i, axis in enumerate(axes[:2], 1):
        exact = reference(penalty(runs[deltas[0]]))["A"][f"u{i}"]["value"]
        axis.axhline(1e4 * exact, color="0.4", lw=0.8, ls="--", marker="", label="reference")
        axis.plot(deltas, [1e4 * runs[d][f"probe.A.u{i}"] for d in deltas], "o-", label="computed")
        axis.set(xlabel=r"$\delta$", ylabel=f"$u_{i}(0.5, 0.75)$ [$10^{{-4}}$ cm]")
        axis.legend()
    inverse = [1 / d for d in deltas]
    axes[2].semilogy(inverse, [uniform[d] for d in deltas], "^--", label="uniform, equal smallest cell")
    axes[2].semilogy(inverse, [lower[d] for d in deltas], "o-", label="adapted")
    axes[2].set(xlabel=r"$1/\delta$", ylabel="unknowns of the lower body")
    axes[2].legend()
    save(figure, os.path.join(folder, "sweep"))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--abut", default=os.path.join(HERE, "..", "..", "build", "bin", "abut"))
    parser.add_argument("--out", default="out")
    parser.add_argument("--deltas", default="0.3,0.2,0.1,0.07,0.05")
    args, further = parser.parse_known_args()
    os.makedirs(args.out, exist_ok=True)
    print(f"{'delta':>6}{'cycles':>8}{'cells':>8}{'level':>7}{'unknowns':>10}{'uniform':>12}{'ratio':>8}{'u1 [cm]':>14}{'u2 [cm]':>14}{'time [s]':>10}  verdict")
    runs = {}
    for delta in map(float, args.deltas.split(",")):
        r = runs[delta] = solve(args, delta, further)
        unknowns, uniform = r["body.lower.unknowns"], r["body.lower.unknowns_uniform"]
        print(
            f"{delta:6g}{r['cycles']:8.0f}{r['body.lower.cells']:8.0f}{r['body.lower.level_max']:7.0f}{unknowns:10.0f}{uniform:12.0f}"
            f"{uniform / unknowns:8.1f}{r['probe.A.u1']:14.6e}{r['probe.A.u2']:14.6e}{r['time.total']:10.1f}  {r['verdict']}",
            flush=True,
        )
    draw(runs, args.out)


if __name__ == "__main__":
    main()
