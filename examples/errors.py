#!/usr/bin/python3
"""What an error of a scene takes: uniform meshes of several orders, and every mesh of an adapted run

    examples/errors.py SCENE KEY VALUE [--orders 1,2,3] [--sizes 5,2.5,1.25] [--target 1e-4] [--to out/NAME]

KEY is one of the record and VALUE what it is by a formula, in Python's math. Prints a table of unknowns and relative errors, and draws it."""
import argparse, math, os, re, subprocess, tempfile

from picture import plt, save

LIMIT = 3  # exit status where a mesh would become larger than allowed
TOP = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def read_rows(path):
    with open(path) as f:
        names, *rows = [line.rstrip("\n").split(",") for line in f]
    return [dict(zip(names, row)) for row in rows]


def measure(args, *options):
    """Unknowns and errors of all meshes of a run"""
    with tempfile.TemporaryDirectory() as folder:
        command = [args.abut, args.scene, *options, "-record_csv", f"{folder}/rows.csv"]
        status = subprocess.run(command, stdout=subprocess.DEVNULL).returncode
        assert status in (0, LIMIT), command
        return [(int(row["unknowns"]), abs(float(row[args.key]) / args.value - 1)) for row in read_rows(f"{folder}/rows.csv")]


def on_bodies(args, key, value):
    return [word for body in args.bodies for word in (f"-{body}_mesh_{key}", str(value))]


def uniform(args, order):
    """Errors that no adaptation changes: every target is met at once"""
    still = ["-adaptor_target", "0.99", *on_bodies(args, "order", order)]
    return [measure(args, *still, *on_bodies(args, "size", size))[-1] for size in args.sizes]


def adapted(args, order):
    return measure(args, "-adaptor_target", args.target, "-adaptor_max_unknowns", str(args.most), *args.whole, *on_bodies(args, "order", order))


def print_points(name, points):
    rates = [math.log(a[1] / b[1]) / math.log(b[0] / a[0]) * 2 for a, b in zip(points, points[1:]) if a[1] and b[1] and a[0] != b[0]]
    print(f"{name}: " + ", ".join(f"{n} {error:.1e}" for n, error in points) + "; last orders " + ", ".join(f"{rate:.1f}" for rate in rates[-2:]))


def main():
    numbers = lambda kind: lambda text: [kind(word) for word in text.split(",")]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene")
    parser.add_argument("key")
    parser.add_argument("value", type=lambda text: eval(text, vars(math)))
    parser.add_argument("--orders", type=numbers(int), default=[1, 2, 3])
    parser.add_argument("--sizes", type=numbers(float), default=[5, 2.5, 1.25, 0.625])
    parser.add_argument("--target", default="1e-4")
    parser.add_argument("--most", type=int, default=10000, help="unknowns [10000]")
    parser.add_argument("--to", help="stem of the pictures")
    parser.add_argument("--abut", default=os.path.join(TOP, "build", "bin", "abut"))
    args = parser.parse_args()
    with open(args.scene) as f:
        text = f.read()
    args.whole = ["-scene_loop_share", "0"] if "pairs" in text else []  # the loop's part of the error is not what is looked for
    args.bodies = re.search(r'bodies: *(?:"(.*?)"|(\w+))', text).expand(r"\1\2").split(",")
    figure, axes = plt.subplots(figsize=(4.5, 3.4))
    for order in args.orders:
        for kind, points in ("uniform", uniform(args, order)), ("adapted", adapted(args, order)):
            print_points(f"order {order}, {kind}", points)
            axes.loglog(*zip(*points), "o-" if kind == "adapted" else "s--", color=f"C{order - 1}", ms=3, label=f"order {order}, {kind}")
    axes.set(xlabel="unknowns", ylabel=f"relative error of {args.key}")
    axes.legend(fontsize="small")
    if args.to:
        save(figure, args.to, colors=64)


if __name__ == "__main__":
    main()
