/* Counts what a run sends, by rank and phase, whoever sends it: PETSc's log does not know the messages of hypre and p4est. Loaded before the
   program (LD_PRELOAD), it stands in front of MPI (the standard's profiling interface) and of PETSc's stages, by which it knows the phase.
   When MPI ends, a CSV file of the name in ABUT_COUNTS has one line for each rank and phase:

     messages, bytes   sent to other ranks: MPI_Send and its kin, persistent ones each time they start
     multigrid         those of the messages that a library sends whose name has HYPRE in it
     reductions        collective calls whose data do not grow with the ranks: Allreduce, Bcast, Scan, Barrier, ..., and new communicators
     reduced           bytes of them
     gathers, gathered those whose data do: Allgather, Alltoall, ...; bytes that arrive on this rank
     steps             of all of these ceil(log2 of the ranks), the messages of a tree one after the other
     work              processor seconds outside MPI, which waiting for others, or for a core, does not change

   Calls on one rank, and messages to oneself, cost no network and are left out. So are those of Fortran, which is MUMPS. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <mpi.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum {
  MESSAGES,
  BYTES,
  MULTIGRID,
  REDUCTIONS,
  REDUCED,
  GATHERS,
  GATHERED,
  STEPS,
  WORK,
  COUNTS
};
#define PHASES 16   /* at most */
#define DEPTH  64   /* of stages in stages */
#define TABLE  4096 /* requests, by their handle */

static double counts[PHASES][COUNTS], since;
static char   names[PHASES][32] = {"Main"};
static int    nphases           = 1, stack[DEPTH], top, inside;
static struct {
  MPI_Request request;
  double      bytes; /* below zero: does not send */
} persistent[TABLE];

/* --- phases ----------------------------------------------------------------------------------------------------------------- */
static double *Phase(void)
{
  return counts[stack[top]];
}

static double Processor(void)
{
  struct timespec now;

  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Between Enter() and Leave() the processor does not work for the program */
static void Enter(void)
{
  if (!inside++) Phase()[WORK] += Processor() - since;
}

static void Leave(void)
{
  if (!--inside) since = Processor();
}

int PetscLogStageRegister(const char name[], int *stage)
{
  int (*next)(const char[], int *) = (int (*)(const char[], int *))dlsym(RTLD_NEXT, "PetscLogStageRegister");
  int error                        = next(name, stage);

  if (*stage > 0 && *stage < PHASES) {
    snprintf(names[*stage], sizeof(*names), "%s", name);
    if (*stage >= nphases) nphases = *stage + 1;
  }
  return error;
}

int PetscLogStagePush(int stage)
{
  int (*next)(int) = (int (*)(int))dlsym(RTLD_NEXT, "PetscLogStagePush");

  Enter();
  if (top < DEPTH - 1) stack[++top] = stage > 0 && stage < PHASES ? stage : 0;
  Leave();
  return next(stage);
}

int PetscLogStagePop(void)
{
  int (*next)(void) = (int (*)(void))dlsym(RTLD_NEXT, "PetscLogStagePop");

  Enter();
  if (top) --top;
  Leave();
  return next();
}

/* --- what is counted -------------------------------------------------------------------------------------------------------- */
static double Size(double n, MPI_Datatype type)
{
  int size;

  if (n <= 0 || type == MPI_DATATYPE_NULL) return 0;
  PMPI_Type_size(type, &size);
  return n * size;
}

static int Other(int rank, MPI_Comm comm)
{
  int me;

  PMPI_Comm_rank(comm, &me);
  return rank != MPI_PROC_NULL && rank != me;
}

/* caller: an address in what called MPI */
static void Message(double bytes, const void *caller)
{
  Dl_info where;

  Phase()[MESSAGES] += 1;
  Phase()[BYTES] += bytes;
  if (dladdr(caller, &where) && where.dli_fname && strstr(where.dli_fname, "HYPRE")) Phase()[MULTIGRID] += 1;
}

static void Collective(int what, double bytes, MPI_Comm comm)
{
  int size;

  PMPI_Comm_size(comm, &size);
  if (size == 1) return;
  Phase()[what] += 1;
  Phase()[what + 1] += bytes;
  for (int reach = 1; reach < size; reach *= 2) Phase()[STEPS] += 1;
}

static double All(const int n[], MPI_Comm comm)
{
  double sum = 0;
  int    size;

  PMPI_Comm_size(comm, &size);
  for (int i = 0; i < size; ++i) sum += n[i];
  return sum;
}

static double Ranks(MPI_Comm comm)
{
  int size;

  PMPI_Comm_size(comm, &size);
  return size;
}

/* The place of a persistent request, or where it may go; the table must not fill up */
static size_t Place(MPI_Request request)
{
  size_t at = (size_t)((uintptr_t)request / 64 % TABLE);

  for (int tries = 0; tries < TABLE; ++tries, at = (at + 1) % TABLE)
    if (persistent[at].request == request || !persistent[at].request) return at;
  fprintf(stderr, "count.c: more than %d persistent requests\n", TABLE);
  abort();
}

static void Keep(MPI_Request request, double bytes)
{
  const size_t at = Place(request);

  persistent[at].request = request;
  persistent[at].bytes   = bytes;
}

static void Started(int n, const MPI_Request request[], const void *caller)
{
  for (int i = 0; i < n; ++i) {
    const size_t at = Place(request[i]);

    if (persistent[at].request && persistent[at].bytes >= 0) Message(persistent[at].bytes, caller);
  }
}

/* --- MPI -------------------------------------------------------------------------------------------------------------------- */
#define WRAP(name, parameters, arguments, before, after) \
  int MPI_##name parameters \
  { \
    int error; \
\
    Enter(); \
    before; \
    error = PMPI_##name arguments; \
    after; \
    Leave(); \
    return error; \
  }
#define SENT \
  if (Other(to, comm)) Message(Size(n, type), __builtin_return_address(0))
#define REDUCE Collective(REDUCTIONS, Size(n, type), comm)
#define PLAIN  Collective(REDUCTIONS, 0, comm)

#define SEND(name) \
  WRAP(name, (const void *x, int n, MPI_Datatype type, int to, int tag, MPI_Comm comm), (x, n, type, to, tag, comm), SENT, )
#define ISEND(name) \
  WRAP(name, (const void *x, int n, MPI_Datatype type, int to, int tag, MPI_Comm comm, MPI_Request *r), (x, n, type, to, tag, comm, r), \
       SENT, )
SEND(Send)
SEND(Ssend)
SEND(Rsend)
SEND(Bsend)
ISEND(Isend)
ISEND(Issend)
ISEND(Irsend)
ISEND(Ibsend)
WRAP(Send_init, (const void *x, int n, MPI_Datatype type, int to, int tag, MPI_Comm comm, MPI_Request *r), (x, n, type, to, tag, comm, r), ,
     Keep(*r, Other(to, comm) ? Size(n, type) : -1))
WRAP(Recv_init, (void *x, int n, MPI_Datatype type, int from, int tag, MPI_Comm comm, MPI_Request *r), (x, n, type, from, tag, comm, r), ,
     Keep(*r, -1))
WRAP(Start, (MPI_Request * r), (r), Started(1, r, __builtin_return_address(0)), )
WRAP(Startall, (int n, MPI_Request r[]), (n, r), Started(n, r, __builtin_return_address(0)), )
WRAP(Sendrecv,
     (const void *x, int n, MPI_Datatype type, int to, int tag, void *y, int m, MPI_Datatype kind, int from, int mark, MPI_Comm comm,
      MPI_Status *s),
     (x, n, type, to, tag, y, m, kind, from, mark, comm, s), SENT, )

WRAP(Recv, (void *x, int n, MPI_Datatype type, int from, int tag, MPI_Comm comm, MPI_Status *s), (x, n, type, from, tag, comm, s), , )
WRAP(Irecv, (void *x, int n, MPI_Datatype type, int from, int tag, MPI_Comm comm, MPI_Request *r), (x, n, type, from, tag, comm, r), , )
WRAP(Probe, (int from, int tag, MPI_Comm comm, MPI_Status *s), (from, tag, comm, s), , )
WRAP(Iprobe, (int from, int tag, MPI_Comm comm, int *flag, MPI_Status *s), (from, tag, comm, flag, s), , )
WRAP(Wait, (MPI_Request * r, MPI_Status *s), (r, s), , )
WRAP(Waitall, (int n, MPI_Request r[], MPI_Status s[]), (n, r, s), , )
WRAP(Waitany, (int n, MPI_Request r[], int *i, MPI_Status *s), (n, r, i, s), , )
WRAP(Waitsome, (int n, MPI_Request r[], int *m, int i[], MPI_Status s[]), (n, r, m, i, s), , )
WRAP(Test, (MPI_Request * r, int *flag, MPI_Status *s), (r, flag, s), , )
WRAP(Testall, (int n, MPI_Request r[], int *flag, MPI_Status s[]), (n, r, flag, s), , )

WRAP(Barrier, (MPI_Comm comm), (comm), PLAIN, )
WRAP(Ibarrier, (MPI_Comm comm, MPI_Request *r), (comm, r), PLAIN, )
WRAP(Comm_dup, (MPI_Comm comm, MPI_Comm *made), (comm, made), PLAIN, )
WRAP(Comm_create, (MPI_Comm comm, MPI_Group group, MPI_Comm *made), (comm, group, made), PLAIN, )
WRAP(Comm_split, (MPI_Comm comm, int color, int key, MPI_Comm *made), (comm, color, key, made), PLAIN, )
WRAP(Comm_split_type, (MPI_Comm comm, int kind, int key, MPI_Info info, MPI_Comm *made), (comm, kind, key, info, made), PLAIN, )
WRAP(Bcast, (void *x, int n, MPI_Datatype type, int root, MPI_Comm comm), (x, n, type, root, comm), REDUCE, )
WRAP(Reduce, (const void *x, void *y, int n, MPI_Datatype type, MPI_Op op, int root, MPI_Comm comm), (x, y, n, type, op, root, comm),
     REDUCE, )
WRAP(Allreduce, (const void *x, void *y, int n, MPI_Datatype type, MPI_Op op, MPI_Comm comm), (x, y, n, type, op, comm), REDUCE, )
WRAP(Iallreduce, (const void *x, void *y, int n, MPI_Datatype type, MPI_Op op, MPI_Comm comm, MPI_Request *r), (x, y, n, type, op, comm, r),
     REDUCE, )
WRAP(Scan, (const void *x, void *y, int n, MPI_Datatype type, MPI_Op op, MPI_Comm comm), (x, y, n, type, op, comm), REDUCE, )
WRAP(Exscan, (const void *x, void *y, int n, MPI_Datatype type, MPI_Op op, MPI_Comm comm), (x, y, n, type, op, comm), REDUCE, )
WRAP(Reduce_scatter_block, (const void *x, void *y, int n, MPI_Datatype type, MPI_Op op, MPI_Comm comm), (x, y, n, type, op, comm),
     Collective(GATHERS, Size(n, type) * Ranks(comm), comm), )
WRAP(Reduce_scatter, (const void *x, void *y, const int n[], MPI_Datatype type, MPI_Op op, MPI_Comm comm), (x, y, n, type, op, comm),
     Collective(GATHERS, Size(All(n, comm), type), comm), )

/* x, n, type are sent and y, m, kind received; of those with a root the others' counts are not defined */
#define GATHER(name) \
  WRAP(name, (const void *x, int n, MPI_Datatype type, void *y, int m, MPI_Datatype kind, MPI_Comm comm), (x, n, type, y, m, kind, comm), \
       Collective(GATHERS, Size(m, kind) * Ranks(comm), comm), )
GATHER(Allgather)
GATHER(Alltoall)
WRAP(Allgatherv, (const void *x, int n, MPI_Datatype type, void *y, const int m[], const int at[], MPI_Datatype kind, MPI_Comm comm),
     (x, n, type, y, m, at, kind, comm), Collective(GATHERS, Size(All(m, comm), kind), comm), )
WRAP(Alltoallv,
     (const void *x, const int n[], const int from[], MPI_Datatype type, void *y, const int m[], const int at[], MPI_Datatype kind,
      MPI_Comm comm),
     (x, n, from, type, y, m, at, kind, comm), Collective(GATHERS, Size(All(m, comm), kind), comm), )
WRAP(Gather, (const void *x, int n, MPI_Datatype type, void *y, int m, MPI_Datatype kind, int root, MPI_Comm comm),
     (x, n, type, y, m, kind, root, comm), Collective(GATHERS, Other(root, comm) ? 0 : Size(m, kind) * Ranks(comm), comm), )
WRAP(Gatherv, (const void *x, int n, MPI_Datatype type, void *y, const int m[], const int at[], MPI_Datatype kind, int root, MPI_Comm comm),
     (x, n, type, y, m, at, kind, root, comm), Collective(GATHERS, Other(root, comm) ? 0 : Size(All(m, comm), kind), comm), )
WRAP(Scatter, (const void *x, int n, MPI_Datatype type, void *y, int m, MPI_Datatype kind, int root, MPI_Comm comm),
     (x, n, type, y, m, kind, root, comm), Collective(GATHERS, Size(m, kind), comm), )
WRAP(Scatterv,
     (const void *x, const int n[], const int from[], MPI_Datatype type, void *y, int m, MPI_Datatype kind, int root, MPI_Comm comm),
     (x, n, from, type, y, m, kind, root, comm), Collective(GATHERS, Size(m, kind), comm), )

/* Those that do not block, by which PETSc sends vectors to all ranks */
#define IGATHER(name) \
  WRAP(name, (const void *x, int n, MPI_Datatype type, void *y, int m, MPI_Datatype kind, MPI_Comm comm, MPI_Request *r), \
       (x, n, type, y, m, kind, comm, r), Collective(GATHERS, Size(m, kind) * Ranks(comm), comm), )
IGATHER(Iallgather)
IGATHER(Ialltoall)
WRAP(Iallgatherv,
     (const void *x, int n, MPI_Datatype type, void *y, const int m[], const int at[], MPI_Datatype kind, MPI_Comm comm, MPI_Request *r),
     (x, n, type, y, m, at, kind, comm, r), Collective(GATHERS, Size(All(m, comm), kind), comm), )
WRAP(Ialltoallv,
     (const void *x, const int n[], const int from[], MPI_Datatype type, void *y, const int m[], const int at[], MPI_Datatype kind,
      MPI_Comm comm, MPI_Request *r),
     (x, n, from, type, y, m, at, kind, comm, r), Collective(GATHERS, Size(All(m, comm), kind), comm), )
WRAP(Ibcast, (void *x, int n, MPI_Datatype type, int root, MPI_Comm comm, MPI_Request *r), (x, n, type, root, comm, r), REDUCE, )
WRAP(Igatherv,
     (const void *x, int n, MPI_Datatype type, void *y, const int m[], const int at[], MPI_Datatype kind, int root, MPI_Comm comm,
      MPI_Request *r),
     (x, n, type, y, m, at, kind, root, comm, r), Collective(GATHERS, Other(root, comm) ? 0 : Size(All(m, comm), kind), comm), )
WRAP(Iscatterv,
     (const void *x, const int n[], const int from[], MPI_Datatype type, void *y, int m, MPI_Datatype kind, int root, MPI_Comm comm,
      MPI_Request *r),
     (x, n, from, type, y, m, kind, root, comm, r), Collective(GATHERS, Size(m, kind), comm), )

/* --- the file --------------------------------------------------------------------------------------------------------------- */
static void Write(const double all[], int size)
{
  const char *path = getenv("ABUT_COUNTS");
  FILE       *file = path ? fopen(path, "w") : NULL;

  if (!file) return;
  fprintf(file, "rank,phase,messages,bytes,multigrid,reductions,reduced,gathers,gathered,steps,work\n");
  for (int r = 0; r < size; ++r)
    for (int p = 0; p < nphases; ++p) {
      fprintf(file, "%d,%s", r, names[p]);
      for (int c = 0; c < WORK; ++c) fprintf(file, ",%.0f", all[(r * PHASES + p) * COUNTS + c]);
      fprintf(file, ",%.6f\n", all[(r * PHASES + p) * COUNTS + WORK]);
    }
  fclose(file);
}

int MPI_Finalize(void)
{
  double *all;
  int     rank, size;

  Enter();
  PMPI_Comm_rank(MPI_COMM_WORLD, &rank);
  PMPI_Comm_size(MPI_COMM_WORLD, &size);
  all = malloc((size_t)size * sizeof(counts));
  PMPI_Gather(counts, PHASES * COUNTS, MPI_DOUBLE, all, PHASES * COUNTS, MPI_DOUBLE, 0, MPI_COMM_WORLD);
  if (!rank) Write(all, size);
  free(all);
  return PMPI_Finalize();
}
