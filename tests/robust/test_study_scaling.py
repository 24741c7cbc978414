"""The study of scaling: its counter against a program whose messages are known, its model against counts with a known law, its page against
the kept table, and rows of that recomputed"""
import csv, math, os, subprocess, sys, tempfile, unittest

from abut import PROGRAM, ROOT

STUDY = os.path.join(ROOT, "examples", "studies", "scaling")
sys.path[:0] = [STUDY, os.path.dirname(STUDY)]
COUNTS = "messages bytes multigrid reductions gathers gathered steps".split()
STAGES = """
int PetscLogStageRegister(const char name[], int *stage) { static int n; (void)name; *stage = ++n; return 0; }
int PetscLogStagePush(int stage) { (void)stage; return 0; }
int PetscLogStagePop(void) { return 0; }
"""
EXCHANGE = """
#include <mpi.h>
void Exchange(int rank, int size)
{
  int         x = 0, y;
  MPI_Request request;

  MPI_Irecv(&y, 1, MPI_INT, (rank + size - 1) % size, 4, MPI_COMM_WORLD, &request);
  MPI_Send(&x, 1, MPI_INT, (rank + 1) % size, 4, MPI_COMM_WORLD);
  MPI_Wait(&request, MPI_STATUS_IGNORE);
}
"""
TALK = """
#include <mpi.h>
void Exchange(int, int);
int PetscLogStageRegister(const char[], int *), PetscLogStagePush(int), PetscLogStagePop(void);
int main(int argc, char **argv)
{
  int         rank, size, stage[2], in[64], out[64] = {0}, counts[16], at[16];
  double      x[10] = {0}, y[10];
  MPI_Request request, both[2];
  MPI_Comm    other;

  MPI_Init(&argc, &argv);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  PetscLogStageRegister("Talk", &stage[0]);
  PetscLogStageRegister("Gather", &stage[1]);
  PetscLogStagePush(stage[0]);
  for (int i = 0; i < 3; ++i) { /* 3 messages of 80 bytes */
    MPI_Isend(x, 10, MPI_DOUBLE, (rank + 1) % size, 0, MPI_COMM_WORLD, &request);
    MPI_Recv(y, 10, MPI_DOUBLE, (rank + size - 1) % size, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    MPI_Wait(&request, MPI_STATUS_IGNORE);
  }
  MPI_Irecv(y, 10, MPI_DOUBLE, rank, 1, MPI_COMM_WORLD, &request); /* to itself: none */
  MPI_Send(x, 10, MPI_DOUBLE, rank, 1, MPI_COMM_WORLD);
  MPI_Wait(&request, MPI_STATUS_IGNORE);
  MPI_Send_init(out, 5, MPI_INT, (rank + 1) % size, 2, MPI_COMM_WORLD, &both[0]);
  MPI_Recv_init(in, 5, MPI_INT, (rank + size - 1) % size, 2, MPI_COMM_WORLD, &both[1]);
  for (int i = 0; i < 2; ++i) { /* 4 of 20 bytes, one by one and together */
    MPI_Startall(2, both);
    MPI_Waitall(2, both, MPI_STATUSES_IGNORE);
    MPI_Start(&both[1]);
    MPI_Start(&both[0]);
    MPI_Waitall(2, both, MPI_STATUSES_IGNORE);
  }
  MPI_Request_free(&both[0]);
  MPI_Request_free(&both[1]);
  Exchange(rank, size);
  PetscLogStagePush(stage[1]); /* a stage in a stage */
  MPI_Allreduce(x, y, 4, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  MPI_Allreduce(x, y, 4, MPI_DOUBLE, MPI_SUM, MPI_COMM_SELF); /* alone: none */
  MPI_Barrier(MPI_COMM_WORLD);
  MPI_Bcast(out, 1, MPI_INT, 0, MPI_COMM_WORLD);
  MPI_Comm_dup(MPI_COMM_WORLD, &other);
  MPI_Allgather(out, 2, MPI_INT, in, 2, MPI_INT, other);
  for (int i = 0, sum = 0; i < size; sum += counts[i++]) {
    counts[i] = i + 1;
    at[i]     = sum;
  }
  MPI_Allgatherv(out, rank + 1, MPI_INT, in, counts, at, MPI_INT, other);
  MPI_Comm_free(&other);
  PetscLogStagePop();
  MPI_Sendrecv(out, 7, MPI_CHAR, (rank + 1) % size, 3, in, 7, MPI_CHAR, (rank + size - 1) % size, 3, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  PetscLogStagePop();
  MPI_Finalize();
  return 0;
}
"""


def rows_of(path):
    with open(path) as f:
        return list(csv.DictReader(f))


def study(folder, *options, **how):
    command = [sys.executable, os.path.join(STUDY, "scaling.py"), "--abut", PROGRAM, "--out", folder, *options]
    result = subprocess.run(command, capture_output=True, text=True, **how)
    assert not result.returncode, result.stdout + result.stderr
    return result.stdout


def kept():
    from scaling import COLUMNS, Kept, case_of

    return Kept(os.path.join(STUDY, "scaling.csv"), COLUMNS, case_of).rows


def compile_c(folder, name, text, *options):
    source, made = os.path.join(folder, f"{name}.c"), os.path.join(folder, name)
    with open(source, "w") as f:
        f.write(text)
    done = subprocess.run(["mpicc", "-std=gnu99", source, "-o", made, *options], capture_output=True, text=True)
    assert not done.returncode, done.stderr
    return made


def test_every_message_of_a_program_is_counted_in_its_phase():
    n = 3
    with tempfile.TemporaryDirectory() as folder:
        stages = compile_c(folder, "libstages.so", STAGES, "-fPIC", "-shared")
        multigrid = compile_c(folder, "libHYPRE_test.so", EXCHANGE, "-fPIC", "-shared")
        talk = compile_c(folder, "talk", TALK, stages, multigrid, f"-Wl,-rpath,{folder}")
        counter, path = os.path.join(folder, "libcount.so"), os.path.join(folder, "counts")
        flags = "-std=gnu99 -Wall -Wextra -Werror -O2 -fPIC -shared".split()
        done = subprocess.run(["mpicc", *flags, os.path.join(STUDY, "count.c"), "-o", counter, "-ldl"], capture_output=True, text=True)
        assert not done.returncode, done.stderr
        command = ["mpiexec", "-n", str(n), "env", f"LD_PRELOAD={counter}", f"ABUT_COUNTS={path}", talk]
        done = subprocess.run(command, capture_output=True, text=True)
        assert not done.returncode, done.stdout + done.stderr
        rows = rows_of(path)
    steps = math.ceil(math.log2(n))
    expected = {
        "Main": [0] * 7,
        "Talk": [3 + 4 + 1 + 1, 3 * 80 + 4 * 20 + 7 + 4, 1, 0, 0, 0, 0],
        "Gather": [0, 0, 0, 4, 2, 4 * 2 * n + 4 * n * (n + 1) // 2, 6 * steps],
    }
    assert [int(row["reduced"]) for row in rows if row["phase"] == "Gather"] == [4 * 8 + 4] * n
    assert [(row["rank"], row["phase"]) for row in rows] == [(str(r), phase) for r in range(n) for phase in expected]
    for row in rows:
        assert [int(row[name]) for name in COUNTS] == expected[row["phase"]], row


def test_runs_with_too_few_cores_are_marked_and_solve_the_same():
    """On one core: two ranks have no seconds, and the meshes of one"""
    with tempfile.TemporaryDirectory() as folder:
        core = min(os.sched_getaffinity(0))
        options = "--ranks 1 2 --sizes 1e3 --each 0 --repetitions 1 --modes together".split()
        said = study(folder, *options, preexec_fn=lambda: os.sched_setaffinity(0, {core}))
        rows = rows_of(os.path.join(folder, "scaling.csv"))
        assert "2 cases, 2 of them in" in study(folder, *options), "a case was run twice"
    one, two = ([row for row in rows if row["ranks"] == ranks] for ranks in "12")
    assert [row["phase"] for row in one] == [row["phase"] for row in two] == ["Main", "Set-up", "Sweeps", "Estimate", "Adapt", "Output"]
    assert {row["oversubscribed"] for row in one} == {"no"} and {row["oversubscribed"] for row in two} == {"yes"}
    assert all(row["seconds"] for row in one[1:]) and not any(row["seconds"] for row in two)
    assert one[0]["mesh"] == two[0]["mesh"] and abs(float(one[0]["force"]) / float(two[0]["force"]) - 1) < 1e-8
    assert not any(float(row["messages"]) + float(row["reductions"]) for row in one) and all(float(row["messages"]) for row in two[1:])
    assert "all runs have the same meshes" in said and "oversubscribed" in said


def test_a_run_that_fails_stays_a_row():
    with tempfile.TemporaryDirectory() as folder:
        program = os.path.join(folder, "abut")
        with open(program, "w") as f:
            f.write("#!/bin/sh\necho out of order >&2\nexit 1\n")
        os.chmod(program, 0o755)
        said = study(folder, *"--ranks 1 --sizes 1e3 --each 0".split(), "--abut", program)
        assert "- strong, 1000 unknowns, 1 ranks, together: out of order" in said, said
        assert [row["verdict"] for row in rows_of(os.path.join(folder, "scaling.csv"))] == ["out of order"]


def test_one_rank_and_two_take_turns():
    """A table of times, of which nothing is asked but that it is there: two turns, small meshes, and with an estimator"""
    for options in "-scene_split", "-estimator_type fembem":
        command = [sys.executable, os.path.join(STUDY, "two.py"), "--abut", PROGRAM, *"--turns 2 --cells 128,32".split(), f"--options={options}"]
        done = subprocess.run(command, capture_output=True, text=True)
        assert done.returncode == 0, done.stdout + done.stderr
        assert done.stdout.count("turn ") == 2 and "part        one rank, s" in done.stdout and "\ntotal  " in done.stdout, done.stdout


def test_the_page_has_the_tables_and_the_picture_of_the_kept_rows():
    with tempfile.TemporaryDirectory() as folder:
        pictures = []
        for name in "one", "two":
            study(os.path.join(folder, name), "--tables", "--abut", "/nowhere")
            with open(os.path.join(folder, name, "scaling.png"), "rb") as f:
                pictures.append(f.read())
        with open(os.path.join(folder, "one", "scaling.md")) as f:
            tables = f.read()
    with open(os.path.join(STUDY, "README.md")) as f:
        page = f.read()
    assert f"<!-- tables -->\n{tables}<!-- end of tables -->" in page, "scaling.py --tables --keep writes them"
    assert pictures[0] == pictures[1] and len(pictures[0]) > 2e4


def test_kept_rows_are_of_the_same_meshes_and_are_counted_again():
    """A run of two ranks, whose counts may change by a message here or there when the program does"""
    from pages import differences
    from scaling import where

    rows = kept()
    for mode in {case.mode for case in rows}:
        meshes, worst, runs, sizes = differences({case: one for case, one in rows.items() if case.mode == mode})
        assert not meshes and worst < 1e-8 and runs > sizes, (mode, meshes, worst)
    size = min(case.size for case in rows if case.series == "strong")
    old = {row["phase"]: row for case, one in rows.items() if case[:4] == ("strong", size, 2, "together") for row in one}
    if old["Main"]["petsc"] != where()["petsc"]:
        raise unittest.SkipTest(f"the rows are of PETSc {old['Main']['petsc']}, whose hypre counts otherwise")
    with tempfile.TemporaryDirectory() as folder:
        study(folder, *f"--ranks 2 --sizes {size} --each 0 --repetitions 0 --modes together".split())
        new = {row["phase"]: row for row in rows_of(os.path.join(folder, "scaling.csv"))}
    assert all(new[phase][key] == old[phase][key] for phase in old for key in "verdict unknowns cycles sweeps mesh".split()), (old, new)
    for phase in old:
        for name in COUNTS:
            assert abs(float(new[phase][name]) - float(old[phase][name])) <= 0.05 * float(old[phase][name]), (phase, name, new[phase], old[phase])


def invented(law, work):
    """Rows of runs whose messages an iteration and work are given functions of ranks and unknowns, m = sqrt(n)"""
    from model import PHASES
    from scaling import Case

    found = {}
    for n in 10**4, 10**5, 10**6:
        for p in 1, 2, 4, 8, 16:
            row = dict(ranks=p, unknowns=n, contact=round(n**0.5), its=100, cycles=10, verdict="converged")
            rows = [dict(row, phase=phase, bytes_max=0, steps_max=0, gathered_max=0, multigrid_max=0, others_max=0, work_max=n / p) for phase in PHASES]
            rows[1].update(others_max=100 * law(p, n), work_max=work(p, n))
            found[Case("strong", float(n), p, "together")] = rows
    return found


def test_the_model_finds_a_law_and_what_it_leads_to():
    """Five phases of n/p seconds each, and in one of them m^3 on every rank: half of the time is lost on p ranks when p m^3 > 5 n"""
    from model import MODES, Model, State

    model = Model(invented(lambda p, n: 7 * math.log2(p) + 0.5 * (p - 1), lambda p, n: n / p + 1e-3 * n**1.5))
    assert abs(model.count("Sweeps", "others", State(10**4, 10**9, 0.0), 1) / (7 * math.log2(1e4) + 0.5 * 9999) - 1) < 1e-6
    n = 10**4  # 5 n = 5e4 of cells, m^3 = 1e3
    lost = lambda p: (5 * n + 1e3) / (p * (5 * n / p + 1e3)) < 0.5
    ranks, (phase, cause) = model.half(n, 0.0, 1.0)
    assert (phase, cause) == ("Sweeps", "replicated") and lost(ranks) and not lost(ranks // 2), (ranks, cause)
    alone, why = Model(invented(lambda p, n: 7 * math.log2(p), lambda p, n: n / p)).half(n, 0.0, 1.0)  # but for the modes of 100 nodes
    assert why == ("Sweeps", "modes") and alone / 2 < 5 * n / (MODES * 100**2) <= alone, (alone, why)
    slow, (phase, cause) = model.half(n, 10.0, 1.0)
    assert (phase, cause) == ("Sweeps", "messages") and slow < ranks, (slow, cause)
