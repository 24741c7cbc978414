#!/usr/bin/env python3
"""Random scenes: every one has to end as converged and consistent, or with a name for what is wrong; never with a crash, a NaN, or exit status 0 and a self-check
that fails.

  scenes.py [--abut build/bin/abut] [--count 200] [--seed 1] [--only K] [--limit 60]

Stacks of two to four bodies, of heights .05 to 5, moduli 1 to 1e8, Poisson's ratios 0 to .49, quads and triangles of all orders, gaps that are polynomials, closed, opened or loaded,
with penalties 1e-4 to 1 or exact contact, by all loops, adapted or not. --only K repeats scene K and shows what it prints. Exit status 1 if any went wrong.
"""
import argparse, collections, math, os, random, shlex, subprocess, sys, tempfile

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
NAMED = ("oscillation", "stagnation", "cycling", "floating", "max_iterations", "linear_solver", "diverged", "inconsistent", "limit_level", "limit_unknowns")
CHECKS = ("balance", "energy", "contact", "tension", "complementarity", "penetration")


def scene(seed, k):
    """The options of scene k"""
    r = random.Random(f"{seed} {k}")
    n, length, bottom, words = r.choice((2, 2, 2, 3, 4)), r.choice((1, 2, 4)), 0.0, []
    names = [f"b{i}" for i in range(n)]
    pairs = [f"p{i}" for i in range(n - 1)]
    words += ["-scene_bodies", ",".join(names), "-scene_pairs", ",".join(pairs), "-snes_max_it", "500"]
    for name in names:
        height, shape = 10 ** r.uniform(-1.3, 0.7), r.choice(("quad", "quad", "triangle"))
        cells = max(2, round(r.uniform(3, 12) * length / 4)), max(1, min(8, round(r.uniform(2, 6) * height)))
        order = r.choice((1, 1, 1, 2, 3)) if shape == "triangle" else r.choice((1, 1, 1, 2, 3, 4))
        words += [f"-{name}_mesh_box", f"0,{bottom!r},{length},{bottom + height!r}", f"-{name}_mesh_cells", f"{cells[0]},{cells[1]}"]
        words += [f"-{name}_mesh_shape", shape, f"-{name}_mesh_order", order, f"-{name}_bc_left_u1", 0]
        words += [f"-{name}_material_young", 10 ** r.uniform(0, 8), f"-{name}_material_poisson", r.uniform(0, 0.49)]
        bottom += height
    words += ["-b0_bc_bottom_u2", 0]
    size = 10 ** r.uniform(-5, -2)
    closure = size * r.choice((-1, 0, 0.5, 1, 1, 2, 5))
    load = r.random() < 0.2
    words += [f"-{names[-1]}_bc_top_" + ("t2" if load else "u2"), 10 ** r.uniform(-3, 3) * r.choice((-1, -1, -1, 1)) if load else -closure]
    loop = r.choice(("ddactive", "ddactive", "ddactive", "ddneumann", "anderson"))
    for i, pair in enumerate(pairs):
        a, b, c = (r.uniform(-0.2, 1) * size for _ in range(3))
        gap = r.choice(("0", f"{a!r}", f"{abs(a)!r}*x^2", f"{a!r}+{b!r}*x+{c!r}*x^2", f"{abs(a)!r}*(x-{length}/2)^2", f"{abs(b)!r}*x^4"))
        exact = loop == "ddactive" and r.random() < 0.5
        words += [f"-{pair}_pair_bodies", f"{names[i + 1]},{names[i]}", f"-{pair}_pair_sides", "bottom,top", f"-{pair}_pair_gap", gap]
        words += [f"-{pair}_pair_penalty", 0 if exact else 10 ** r.uniform(-4, 0)]
    words += ["-snes_type", loop]
    if r.random() < 0.4:
        words += ["-adaptor_type", r.choice(("threshold", "equal", "doerfler")), "-estimator_type", r.choice(("zz", "fembem", "residual"))]
        words += ["-adaptor_max_level", r.choice((2, 3, 4)), "-adaptor_max_unknowns", 4000]
        if r.random() < 0.3:
            words += ["-adaptor_peak", 10 ** r.uniform(-5, -1)]
    if r.random() < 0.15:
        words += [word for name in names for word in (f"-{name}_pc_type", "hypre", f"-{name}_ksp_type", "cg")]
    return [str(word) for word in words]


def judge(abut, options, limit):
    """What became of it, and what is wrong with that, if anything"""
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        path = os.path.join(folder, "record")
        environment = {**os.environ, "TMPDIR": folder, "OMP_NUM_THREADS": "1", "OMPI_MCA_ess_singleton_isolated": "1"}
        try:
            result = subprocess.run([abut, *options, "-record", path], capture_output=True, text=True, timeout=limit, env=environment, errors="replace")
        except subprocess.TimeoutExpired:
            return "time", f"is not done after {limit} s", ""
        lines = [line for line in result.stderr.splitlines() if line.strip()]
        if result.returncode == 1:
            one = len(lines) == 1 and lines[0].startswith("abut: ") and not os.path.exists(path)
            return "refused", None if one else "is refused, but not in one line", result.stdout + result.stderr
        if result.returncode not in (0, 2, 3) or not os.path.exists(path):
            return "crash", f"ends with status {result.returncode}", result.stdout + result.stderr
        with open(path) as f:
            record = dict(line.rstrip("\n").split(" ", 1) for line in f)
    said, verdict = result.stdout + result.stderr, record["verdict"]
    for key, value in record.items():
        try:
            if not math.isfinite(float(value)):
                return verdict, f"records {key} {value}", said
        except ValueError:
            pass
    if (result.returncode == 0) != (verdict == "converged") or (result.returncode and verdict not in NAMED):
        return verdict, f"has verdict {verdict} and exit status {result.returncode}", said
    if not result.returncode:
        loop = 30 * float(record["residual.loop"])
        bad = [key for key in CHECKS if float(record[f"check.{key}"]) > (max(1e-4, loop) if key in CHECKS[-2:] else 1e-6)]
        if bad:
            return verdict, f"has exit status 0, and fails {', '.join(bad)}", said
    return verdict, None, said


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--abut", default=os.path.join(TOP, "build", "bin", "abut"))
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", type=int)
    parser.add_argument("--limit", type=float, default=60, help="seconds for one scene")
    args = parser.parse_args()
    count, wrong = collections.Counter(), 0
    for k in range(args.count) if args.only is None else [args.only]:
        options = scene(args.seed, k)
        verdict, what, said = judge(args.abut, options, args.limit)
        count[verdict] += 1
        if args.only is not None:
            print(f"{args.abut} {shlex.join(options)}\n{said}")
        if what:
            wrong += 1
            print(f"scene {k} {what}: --seed {args.seed} --only {k}", flush=True)
        if k % 20 == 19:
            print(f"{k + 1:5} scenes, {wrong} wrong: " + ", ".join(f"{n} {name}" for name, n in count.most_common()), flush=True)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
