#include <abut/private/recorderimpl.h> /*I "abutrecorder.h" I*/
#include <math.h>
#include <stdbool.h>
#include <string.h>

/* What the profile of one pair is made of, known on all ranks */
typedef struct {
  const char      *name;
  const AbutSide  *side[2];
  const PetscReal *trace[2]; /* [components*side[s]->n] u_n, or (u1, u2) */
  PetscInt         components;
  PetscInt         which;    /* the side that carries the pressures */
  const PetscReal *pressure; /* [side[which]->n] */
  const PetscReal *length;   /* [side[which]->n] 0 where a node carries no pressure */
  PetscReal       *gap;      /* [side[which]->n] */
  PetscReal       *slip;     /* [side[which]->n] NULL without friction; then pressure has the tangential tractions behind */
} PairProfile;

typedef struct {
  PetscInt     n;
  PairProfile *pair;
  bool         friction; /* of any pair */
} Profile;

/* Arc length of each node from the first one on the way: to be called for i = 0, 1, ... */
static double AddArc(const AbutSide *side, PetscInt i, double arc)
{
  const PetscReal *x = &side->x[2 * i];

  return i ? arc + hypot(x[0] - x[-2], x[1] - x[-1]) : 0.;
}

static double NormalDisplacement(const PairProfile *p, int s, PetscInt i)
{
  const PetscReal *u = p->trace[s] + p->components * i;
  PetscReal        normal[2];

  if (p->components == 1) return u[0];
  (void)AbutSideGetNodeNormal(p->side[s], i, normal);
  return u[0] * normal[0] + u[1] * normal[1];
}

static void WriteTrace(FILE *f, const PairProfile *p, int s, bool friction)
{
  const AbutSide *side = p->side[s];
  double          arc  = 0.;

  for (PetscInt i = 0; i < side->n; ++i) {
    const double x = side->x[2 * i], y = side->x[2 * i + 1];

    arc = AddArc(side, i, arc);
    fprintf(f, "%s,%d,%.10g,%.10g,%.10g,%.10g,,%s\n", p->name, s + 1, arc, x, y, NormalDisplacement(p, s, i), friction ? ",," : "");
  }
}

static void WritePressure(FILE *f, const PairProfile *p, bool friction)
{
  const AbutSide *side = p->side[p->which];
  double          arc  = 0.;

  for (PetscInt i = 0; i < side->n; ++i) {
    const double x = side->x[2 * i], y = side->x[2 * i + 1];

    arc = AddArc(side, i, arc);
    if (p->length[i] == 0.) continue;
    fprintf(f, "%s,pressure,%.10g,%.10g,%.10g,,%.10g,%.10g", p->name, arc, x, y, (double)p->gap[i], (double)p->pressure[i]);
    if (p->slip) fprintf(f, ",%.10g,%.10g\n", (double)p->slip[i], (double)p->pressure[side->n + i]);
    else fprintf(f, friction ? ",,\n" : "\n");
  }
}

static void WriteProfile(FILE *f, const void *ctx)
{
  const Profile *p = (const Profile *)ctx;

  fprintf(f, "pair,side,s,x,y,u_n,gap,pressure%s\n", p->friction ? ",slip,traction_t" : "");
  for (PetscInt i = 0; i < p->n; ++i) {
    for (int s = 0; s < 2 && p->pair[i].side[s]; ++s) WriteTrace(f, &p->pair[i], s, p->friction);
    WritePressure(f, &p->pair[i], p->friction);
  }
}

static PetscErrorCode AbutRecorderCollectPair_Private(AbutInterface iface, PetscInt i, AbutPair pair, PairProfile *p)
{
  AbutBody         body[2];
  PetscInt         number[2], n;
  const PetscReal *x;
  PetscBool        friction;

  PetscFunctionBegin;
  PetscCall(AbutPairGetName(pair, &p->name));
  PetscCall(AbutPairGetBodies(pair, body, number));
  PetscCall(AbutPairGetComponents(pair, &p->components));
  p->side[1] = NULL;
  p->slip    = NULL;
  for (PetscInt s = 0; s < 2 && body[s]; ++s) {
    PetscCall(AbutBodyGetSide(body[s], number[s], &p->side[s]));
    PetscCall(AbutInterfaceGetTrace(iface, i, s, &p->trace[s]));
  }
  PetscCall(AbutInterfaceGetPressure(iface, i, &p->pressure));
  PetscCall(AbutPairGetPressureNodes(pair, &p->which, &n, &x, &p->length));
  PetscCall(PetscMalloc1(n, &p->gap));
  for (PetscInt k = 0; k < n; ++k) PetscCall(AbutPairGetNodeGap(pair, k, &p->gap[k]));
  PetscCall(AbutPairGetFriction(pair, &friction, NULL));
  if (!friction) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(n, &p->slip));
  PetscCall(AbutPairComputeSlip(pair, p->trace[0], p->trace[1], p->slip));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutRecorderWriteProfileTo_Private(AbutRecorder rec, const char path[], AbutInterface iface, PetscInt npairs,
                                                         AbutPair pairs[])
{
  Profile       p = {npairs, NULL, false};
  PetscLogEvent event;

  PetscFunctionBegin;
  PetscCall(AbutLogEventGet("AbutWriteProfile", ABUTRECORDER_CLASSID, &event));
  PetscCall(PetscLogEventBegin(event, rec, 0, 0, 0));
  PetscCall(PetscMalloc1(npairs, &p.pair));
  for (PetscInt i = 0; i < npairs; ++i) {
    PetscCall(AbutRecorderCollectPair_Private(iface, i, pairs[i], &p.pair[i]));
    if (p.pair[i].slip) p.friction = true;
  }
  PetscCall(AbutFileWrite(PetscObjectComm((PetscObject)rec), path, WriteProfile, &p));
  for (PetscInt i = 0; i < npairs; ++i) {
    PetscCall(PetscFree(p.pair[i].gap));
    PetscCall(PetscFree(p.pair[i].slip));
  }
  PetscCall(PetscFree(p.pair));
  PetscCall(PetscLogEventEnd(event, rec, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* FILE.csv as FILE_0000.csv, FILE_step_0001.csv */
static PetscErrorCode AbutRecorderWriteNumberedProfile_Private(AbutRecorder rec, const char kind[], PetscInt number, AbutInterface iface,
                                                               PetscInt npairs, AbutPair pairs[])
{
  const int stem = (int)(strlen(rec->profile_file) - strlen(".csv"));
  char      path[PETSC_MAX_PATH_LEN];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(path, sizeof(path), "%.*s%s_%04" PetscInt_FMT ".csv", stem, rec->profile_file, kind, number));
  PetscCall(AbutRecorderWriteProfileTo_Private(rec, path, iface, npairs, pairs));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutRecorderWriteProfile - Writes the traces and pressures along every pair on the present mesh

   Collective

   Input Parameters:
+  rec     - the recorder
.  iface   - the interface after a sweep
.  npairs  - how many pairs
-  pairs   - [npairs] the pairs, as given to `AbutInterfaceCreate()`

   Options Database Key:
.  -output_profile FILE.csv - where; without it nothing is done. With `AbutRecorderSetStep()` the same goes to FILE_step_0001.csv, with the
                              number of the step

   Level: intermediate

   Notes:
   The columns are pair, side, s, x, y, u_n, gap, pressure; s is the arc length from the first node of the side, lengths are in the
   unit of the scene. Rows with side 1 or 2 hold u_n, the displacement along the outward normal, at the nodes of that side; rows with
   side `pressure` hold the gap and the nodal pressure of the dual-mortar method (stress unit) at the nodes that carry one; the consistent
   pressure, whose polynomials have the largest value of the record from order 2 on, is `AbutPairRecoverPressure()`. The other cells are
   empty.

   Where a pair has friction there are two more columns, slip and traction_t, filled where the pressures of such pairs are:
   `AbutPairComputeSlip()`, and the tangential traction of the first body on the second along the same tangent.

.seealso: `AbutRecorderWriteCycleProfile()`, `AbutInterfaceGetTrace()`, `AbutInterfaceGetPressure()`, `AbutPairGetPressureNodes()`,
          `AbutRecorderSetFromOptions()`
@*/
PetscErrorCode AbutRecorderWriteProfile(AbutRecorder rec, AbutInterface iface, PetscInt npairs, AbutPair pairs[])
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(rec, ABUTRECORDER_CLASSID, 1);
  if (!rec->profile_file) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AbutRecorderWriteProfileTo_Private(rec, rec->profile_file, iface, npairs, pairs));
  if (rec->step) PetscCall(AbutRecorderWriteNumberedProfile_Private(rec, "_step", rec->step, iface, npairs, pairs));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutRecorderWriteCycleProfile - Writes the traces and pressures along every pair after a cycle, if those of every cycle are asked for

   Collective

   Input Parameters:
+  rec     - the recorder
.  cycle   - number of the cycle, 0 for the first
.  iface   - the interface after a sweep
.  npairs  - how many pairs
-  pairs   - [npairs] the pairs, as given to `AbutInterfaceCreate()`

   Options Database Key:
.  -output_profile_cycles - with `-output_profile FILE.csv`: FILE_0000.csv and so on

   Level: intermediate

.seealso: `AbutRecorderWriteProfile()`, `AbutRecorderSetFromOptions()`
@*/
PetscErrorCode AbutRecorderWriteCycleProfile(AbutRecorder rec, PetscInt cycle, AbutInterface iface, PetscInt npairs, AbutPair pairs[])
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(rec, ABUTRECORDER_CLASSID, 1);
  if (rec->profile_cycles) PetscCall(AbutRecorderWriteNumberedProfile_Private(rec, "", cycle, iface, npairs, pairs));
  PetscFunctionReturn(PETSC_SUCCESS);
}
