/* Between a program and MPI: counts the bytes that each rank sends, those to single ranks and those that it puts into collective calls.
   Loaded before the program (LD_PRELOAD); at the end rank 0 writes one line a rank into the file ABUT_TALLY. C alone: what Fortran sends
   goes by. */
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>

#define MOST 65536 /* persistent requests */

static double sent[2]; /* to single ranks, into collective calls */
static struct {
  MPI_Request request;
  double      bytes;
} kept[MOST];
static int nkept;

static double Bytes(int count, MPI_Datatype type)
{
  int size;

  PMPI_Type_size(type, &size);
  return (double)count * size;
}

static int Keep(int ierr, MPI_Request request, double bytes)
{
  int i = 0;

  while (i < nkept && kept[i].request != request) ++i;
  if (i == MOST) abort();
  if (i == nkept) ++nkept;
  kept[i].request = request;
  kept[i].bytes   = bytes;
  return ierr;
}

static void Start(MPI_Request request)
{
  for (int i = 0; i < nkept; ++i)
    if (kept[i].request == request) sent[0] += kept[i].bytes;
}

#define SEND(name) \
  int MPI_##name(const void *b, int n, MPI_Datatype t, int to, int tag, MPI_Comm comm) \
  { \
    sent[0] += Bytes(n, t); \
    return PMPI_##name(b, n, t, to, tag, comm); \
  }
#define ISEND(name) \
  int MPI_##name(const void *b, int n, MPI_Datatype t, int to, int tag, MPI_Comm comm, MPI_Request *r) \
  { \
    sent[0] += Bytes(n, t); \
    return PMPI_##name(b, n, t, to, tag, comm, r); \
  }
SEND(Send)
SEND(Ssend)
SEND(Rsend)
ISEND(Isend)
ISEND(Issend)
ISEND(Irsend)

int MPI_Send_init(const void *b, int n, MPI_Datatype t, int to, int tag, MPI_Comm comm, MPI_Request *r)
{
  const int ierr = PMPI_Send_init(b, n, t, to, tag, comm, r);

  return Keep(ierr, *r, Bytes(n, t));
}

/* The place of a request may come again, for another */
int MPI_Recv_init(void *b, int n, MPI_Datatype t, int from, int tag, MPI_Comm comm, MPI_Request *r)
{
  const int ierr = PMPI_Recv_init(b, n, t, from, tag, comm, r);

  return Keep(ierr, *r, 0.);
}

int MPI_Start(MPI_Request *r)
{
  Start(*r);
  return PMPI_Start(r);
}

int MPI_Startall(int n, MPI_Request r[])
{
  for (int i = 0; i < n; ++i) Start(r[i]);
  return PMPI_Startall(n, r);
}

int MPI_Allreduce(const void *b, void *all, int n, MPI_Datatype t, MPI_Op op, MPI_Comm comm)
{
  sent[1] += Bytes(n, t);
  return PMPI_Allreduce(b, all, n, t, op, comm);
}

int MPI_Iallreduce(const void *b, void *all, int n, MPI_Datatype t, MPI_Op op, MPI_Comm comm, MPI_Request *r)
{
  sent[1] += Bytes(n, t);
  return PMPI_Iallreduce(b, all, n, t, op, comm, r);
}

int MPI_Reduce(const void *b, void *all, int n, MPI_Datatype t, MPI_Op op, int root, MPI_Comm comm)
{
  sent[1] += Bytes(n, t);
  return PMPI_Reduce(b, all, n, t, op, root, comm);
}

int MPI_Bcast(void *b, int n, MPI_Datatype t, int root, MPI_Comm comm)
{
  sent[1] += Bytes(n, t);
  return PMPI_Bcast(b, n, t, root, comm);
}

int MPI_Scan(const void *b, void *all, int n, MPI_Datatype t, MPI_Op op, MPI_Comm comm)
{
  sent[1] += Bytes(n, t);
  return PMPI_Scan(b, all, n, t, op, comm);
}

int MPI_Allgather(const void *b, int n, MPI_Datatype t, void *all, int m, MPI_Datatype u, MPI_Comm comm)
{
  sent[1] += Bytes(m, u);
  return PMPI_Allgather(b, n, t, all, m, u, comm);
}

int MPI_Allgatherv(const void *b, int n, MPI_Datatype t, void *all, const int m[], const int at[], MPI_Datatype u, MPI_Comm comm)
{
  sent[1] += b == MPI_IN_PLACE ? 0. : Bytes(n, t);
  return PMPI_Allgatherv(b, n, t, all, m, at, u, comm);
}

int MPI_Iallgatherv(const void *b, int n, MPI_Datatype t, void *all, const int m[], const int at[], MPI_Datatype u, MPI_Comm comm,
                    MPI_Request *r)
{
  sent[1] += b == MPI_IN_PLACE ? 0. : Bytes(n, t);
  return PMPI_Iallgatherv(b, n, t, all, m, at, u, comm, r);
}

int MPI_Iallgather(const void *b, int n, MPI_Datatype t, void *all, int m, MPI_Datatype u, MPI_Comm comm, MPI_Request *r)
{
  sent[1] += Bytes(m, u);
  return PMPI_Iallgather(b, n, t, all, m, u, comm, r);
}

int MPI_Ibcast(void *b, int n, MPI_Datatype t, int root, MPI_Comm comm, MPI_Request *r)
{
  sent[1] += Bytes(n, t);
  return PMPI_Ibcast(b, n, t, root, comm, r);
}

int MPI_Finalize(void)
{
  double *all = NULL;
  int     size, rank;

  PMPI_Comm_size(MPI_COMM_WORLD, &size);
  PMPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (!rank) all = malloc(2 * sizeof(double) * size);
  PMPI_Gather(sent, 2, MPI_DOUBLE, all, 2, MPI_DOUBLE, 0, MPI_COMM_WORLD);
  if (!rank && getenv("ABUT_TALLY")) {
    FILE *f = fopen(getenv("ABUT_TALLY"), "w");

    for (int i = 0; f && i < size; ++i) fprintf(f, "%.0f %.0f\n", all[2 * i], all[2 * i + 1]);
    if (f) fclose(f);
  }
  free(all);
  return PMPI_Finalize();
}
