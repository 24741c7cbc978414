"""What the studies share: runs side by side, whose rows are kept in a CSV file as they come, so that a study goes on where it was stopped;
what a run took, and on which machine; points of other programs; meshes of an adaptive series one by one; errors of nodal pressures; the
first mesh that meets a target."""
import collections, concurrent.futures, csv, os, subprocess, tempfile, threading, time

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
NUMBERS = "unknowns bodies sweeps cpu_s cum_cpu_s memory_MB err_P err_p0 err_energy err_p_L2".split()
Took = collections.namedtuple("Took", "status said cpu wall rss")  # of a command: last line it said, CPU and wall seconds, bytes


def append(path, columns, rows):
    """Adds rows, dictionaries, to a CSV file that begins with the names of its columns"""
    fresh = not os.path.exists(path)
    with open(path, "a", newline="") as f:
        out = csv.DictWriter(f, columns, restval="", lineterminator="\n")
        if fresh:
            out.writeheader()
        out.writerows(rows)


def read(path):
    """The rows of a CSV file, none if there is no file; lines that begin with # are remarks"""
    if not os.path.exists(path):
        return []
    with open(path) as f:
        return list(csv.DictReader(line for line in f if not line.startswith("#")))


def points(path):
    """What other programs took, in the format of examples/studies/compare: numbers under the names of the study of cost, or None"""
    found = []
    for line, row in enumerate(read(path), 1):
        one = {"program": row.get("program"), "variant": row.get("variant") or "", "scene": row.get("scene") or "layers"}
        if not one["program"] or not row.get("unknowns"):
            raise SystemExit(f"{path}, row {line}: wants at least program and unknowns; examples/studies/compare/README.md has the columns")
        try:
            value = {key: float(text) for key, text in row.items() if key in NUMBERS and text}
        except ValueError as error:
            raise SystemExit(f"{path}, row {line}: {error}; columns {', '.join(NUMBERS)} are numbers") from None
        times = 2 if value.get("bodies") == 1 else 1
        own = value.get("cum_cpu_s", value.get("cpu_s"))
        one.update(unknowns=times * value["unknowns"], cpu_s=own and times * own, rss_MB=value.get("memory_MB"))
        one["work"] = one["unknowns"] * value["sweeps"] if "sweeps" in value else None
        one.update((key, value.get(key)) for key in NUMBERS if key.startswith("err_"))
        found.append(one)
    if not found:
        raise SystemExit(f"{path}: no rows; examples/studies/compare/README.md has the format")
    return found


def side_by_side(processes, run, cases, keep):
    """run(case) of every case, some at a time; keep(case, result, done, total) in the order in which they end. An error ends all."""
    with concurrent.futures.ThreadPoolExecutor(processes) as pool:
        runs = {pool.submit(run, case): case for case in cases}
        try:
            for done, future in enumerate(concurrent.futures.as_completed(runs), 1):
                keep(runs[future], future.result(), done, len(cases))
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise


class Kept:
    """The rows of a study in a CSV file, by case; kind makes a case of a row"""

    def __init__(self, path, columns, kind):
        self.path, self.columns, self.lock, self.rows = path, columns, threading.Lock(), {}
        for row in read(path):
            self.rows.setdefault(kind(row), []).append(row)

    def all(self, processes, run, cases, named):
        """run(case), a list of rows, of each case that has none yet; named(case) for the line of progress"""
        todo = [case for case in cases if case not in self.rows]
        print(f"{len(cases)} cases, {len(cases) - len(todo)} of them in {self.path}", flush=True)

        def keep(case, rows, done, total):
            with self.lock:
                append(self.path, self.columns, rows)
                self.rows[case] = [{key: str(row.get(key, "")) for key in self.columns} for row in rows]
                print(f"{done:4}/{total}  {named(case):60}{len(rows):3} rows  {rows[-1]['verdict'][:60]}", flush=True)

        side_by_side(processes, run, todo, keep)


def cpu_of(command):
    """What a command took; without Open MPI's daemon, whose 0.07 s of CPU would be missing"""
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:  # also where MPI keeps its session
        with open(os.path.join(folder, "said"), "w+") as said:
            environment = {**os.environ, "TMPDIR": folder, "OMP_NUM_THREADS": "1", "OMPI_MCA_ess_singleton_isolated": "1"}
            start = time.time()
            process = subprocess.Popen(command, stdout=said, stderr=said, env=environment)
            _, status, used = os.wait4(process.pid, 0)
            wall = time.time() - start
            process.returncode = os.waitstatus_to_exitcode(status)
            said.seek(0)
            lines = said.read().split("\n")
    line = next((line for line in reversed(lines) if line.strip()), "")
    return Took(process.returncode, line, used.ru_utime + used.ru_stime, wall, 1024 * used.ru_maxrss)


def load():
    """CPU seconds of a fixed piece of work, by which those of other days and machines can be compared: the least of five"""
    seconds = []
    for _ in range(5):
        start, total = time.process_time(), 0
        for i in range(3_000_000):
            total += i * i % 7
        seconds.append(time.process_time() - start)
    return min(seconds)


def first_line(*command):
    try:
        result = subprocess.run(command, capture_output=True, text=True)
    except OSError:
        return ""
    return "" if result.returncode else result.stdout.split("\n")[0]


def where():
    """Commit, version of PETSc, processor and cores"""
    processor = ""
    if os.path.exists("/proc/cpuinfo"):
        with open("/proc/cpuinfo") as f:
            processor = next((line.split(":", 1)[1].strip() for line in f if line.startswith("model name")), "")
    petsc = first_line("pkg-config", "--modversion", "PETSc") or first_line("pkg-config", "--modversion", "petsc")
    git = first_line("git", "-C", TOP, "describe", "--always", "--dirty")
    return {"git": git or "none", "petsc": petsc or "own", "machine": f"{processor.replace(',', '')} x{os.cpu_count()}"}


def ends(series):
    """Of each line of a -record_csv file a target for -adaptor_target with which a run ends on this mesh: between its estimate and the
    least of the meshes before, since with the loop run to its end the estimate is a little different"""
    least = 4 * series[0]["error.discretisation"] if series else 0
    for row in series:
        yield row, (row["error.discretisation"] * least) ** 0.5
        least = min(least, row["error.discretisation"])


def pressure_error(nodes, pressures, order, exact, edge, end=float("inf")):
    """Of nodal pressures, in the norm of L2 over [0, end], and relative; between the nodes they are polynomials of the order of the
    displacements. exact is a function of points, which at the edge of the contact may be like a root"""
    import numpy as np

    nodes, pressures, (points, weights) = np.array(nodes), np.array(pressures), np.polynomial.legendre.leggauss(24)
    error = norm = 0.0
    for first in range(0, len(nodes) - order, order):  # a node that a support holds is missing
        x, p = nodes[first : first + order + 1], pressures[first : first + order + 1]
        cuts = [at for at in (x[0], min(edge, end), max(edge, end), x[-1]) if x[0] <= at <= min(x[-1], end)]
        for low, high in zip(cuts, cuts[1:]):
            s = (points + 1) / 2
            at, w = (high - (high - low) * s**2, (high - low) * s * weights)  # crowded at the edge of the contact
            mine = sum(p[i] * np.prod([(at - x[j]) / (x[i] - x[j]) for j in range(order + 1) if j != i], axis=0) for i in range(order + 1))
            error, norm = error + w @ (mine - exact(at)) ** 2, norm + w @ exact(at) ** 2
    return float((error / norm) ** 0.5)


def chebyshev(one):
    """The pressure of a case of examples/studies/accuracy/reference.json as a function"""
    import numpy as np

    def pressure(at):
        angle = np.arccos(np.minimum(at / one["a"], 1))
        return sum(c * np.sin((2 * k + 1) * angle) for k, c in enumerate(one["chebyshev"]))

    return pressure


def first_that(rows, good):
    """The first mesh that is good if all later ones are, too, and there is one"""
    found = None
    for row in reversed(rows):
        if not good(row):
            break
        found = row
    return found if found is not None and found is not rows[-1] else None
