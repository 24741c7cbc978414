#include <abut/private/sceneimpl.h>
#include <sys/resource.h>

/* What a run says of itself: the keys of the record */

static PetscErrorCode AbutSceneSetReal_Private(AbutScene scene, const char kind[], const char name[], const char key[], PetscReal value)
{
  char full[256];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(full, sizeof(full), "%s.%s%s%s", kind, name, key[0] ? "." : "", key));
  PetscCall(AbutRecorderSetReal(scene->recorder, full, value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Unknowns of the uniform mesh of a box whose cells are all as small as the smallest: what the adapted mesh is compared with; 0 for a
   file */
static PetscErrorCode AbutSceneUniformUnknowns_Private(AbutMesh mesh, PetscReal h_min, PetscReal *n)
{
  PetscReal   lower[2], upper[2];
  PetscInt    p;
  const char *file;

  PetscFunctionBegin;
  PetscCall(AbutMeshGetFile(mesh, &file));
  *n = 0.;
  if (file) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AbutMeshGetBox(mesh, lower, upper));
  PetscCall(AbutMeshGetOrder(mesh, &p));
  *n = 2. * (p * PetscFloorReal(0.5 + (upper[0] - lower[0]) / h_min) + 1.) * (p * PetscFloorReal(0.5 + (upper[1] - lower[1]) / h_min) + 1.);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A body that only moves has forces and energies of round-off, and of the linear solver's tolerance: they are compared with at least a
   thousandth of E times the largest displacement, and this times that displacement */
static PetscErrorCode AbutSceneScales_Private(AbutBody body, PetscReal *force, PetscReal *energy)
{
  PetscReal young, poisson, umax;
  Vec       u;

  PetscFunctionBegin;
  PetscCall(AbutBodyGetMaterial(body, &young, &poisson));
  PetscCall(AbutBodyGetSolution(body, &u));
  PetscCall(VecNorm(u, NORM_INFINITY, &umax));
  *force  = 1e-3 * young * umax;
  *energy = *force * umax;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How evenly the ranks that have a body share it: the most cells of one over the mean. Assembly, stresses and estimators follow the cells;
   the rows of the matrix do too, but for the nodes on the cut, each of which has one owner. */
static PetscErrorCode AbutSceneRecordRanks_Private(AbutScene scene, AbutMesh mesh, PetscInt cells, const char name[])
{
  const AbutMeshTopology *t;
  PetscMPIInt             first, n;
  PetscInt                most;

  PetscFunctionBegin;
  PetscCall(AbutMeshGetTopology(mesh, &t));
  PetscCall(AbutMeshGetRanks(mesh, &first, &n));
  PetscCallMPI(MPI_Allreduce(&t->ncells, &most, 1, MPIU_INT, MPI_MAX, PetscObjectComm((PetscObject)mesh)));
  if (scene->split) PetscCall(AbutSceneSetReal_Private(scene, "body", name, "ranks", n));
  PetscCall(AbutSceneSetReal_Private(scene, "body", name, "imbalance", (PetscReal)most * n / cells));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutSceneRecordBodies_Private(AbutScene scene)
{
  AbutRecorder rec      = scene->recorder;
  PetscInt     unknowns = 0;
  PetscReal    strain = 0., done = 0.;

  PetscFunctionBegin;
  for (PetscInt b = 0; b < scene->nbodies; ++b) {
    const char      *name;
    AbutMesh         mesh;
    AbutMeshMeasures m;
    PetscInt         n, cells, solves, its;
    const char      *integration;
    char             key[256];
    PetscReal        energy, work, reaction[2], applied[2], residual, uniform = 0., force = 0., floor = 0.;

    PetscCall(AbutBodyGetName(scene->body[b], &name));
    PetscCall(AbutBodyGetMesh(scene->body[b], &mesh));
    PetscCall(AbutBodyGetSize(scene->body[b], &n));
    PetscCall(AbutMeshGetCellCount(mesh, &cells));
    PetscCall(AbutMeshGetMeasures(mesh, &m));
    PetscCall(AbutBodyGetSolveCounts(scene->body[b], &solves, &its));
    PetscCall(AbutBodyGetEnergy(scene->body[b], &energy, &work));
    PetscCall(AbutBodyGetReaction(scene->body[b], reaction, applied));
    PetscCall(AbutBodyGetLinearResidual(scene->body[b], &residual));
    PetscCall(AbutSceneUniformUnknowns_Private(mesh, m.h_min, &uniform));
    PetscCall(AbutSceneSetReal_Private(scene, "body", name, "unknowns", n));
    PetscCall(AbutSceneSetReal_Private(scene, "body", name, "cells", cells));
    PetscCall(AbutSceneSetReal_Private(scene, "body", name, "level_max", m.level_max));
    PetscCall(AbutSceneSetReal_Private(scene, "body", name, "hmin", m.h_min));
    PetscCall(AbutSceneSetReal_Private(scene, "body", name, "ksp_its", its));
    PetscCall(AbutSceneSetReal_Private(scene, "body", name, "h_fe", m.h_fe));
    PetscCall(AbutSceneSetReal_Private(scene, "body", name, "h_be", m.h_be));
    PetscCall(AbutSceneSetReal_Private(scene, "body", name, "regularity", m.regularity));
    PetscCall(AbutSceneSetReal_Private(scene, "body", name, "h_ratio", m.ratio));
    PetscCall(AbutSceneSetReal_Private(scene, "body", name, "lemma", m.lemma));
    if (uniform > 0.) PetscCall(AbutSceneSetReal_Private(scene, "body", name, "unknowns_uniform", uniform));
    PetscCall(AbutSceneRecordRanks_Private(scene, mesh, cells, name));
    PetscCall(AbutBodyGetIntegration(scene->body[b], &integration, NULL));
    PetscCall(PetscSNPrintf(key, sizeof(key), "body.%s.integration", name));
    PetscCall(AbutRecorderSetString(rec, key, integration));
    unknowns += n;
    done += work;
    strain += energy;
    AbutSceneAddCheck_Private(scene, ABUT_CHECK_LINEAR, residual);
    PetscCall(AbutSceneScales_Private(scene->body[b], &force, &floor));
    for (PetscInt d = 0; d < 2; ++d) force = PetscMax(force, PetscAbsReal(reaction[d]));
    for (PetscInt d = 0; d < 2 && force > 0.; ++d)
      AbutSceneAddCheck_Private(scene, ABUT_CHECK_BALANCE, PetscAbsReal(reaction[d] + applied[d]) / force);
    if (floor > 0.) AbutSceneAddCheck_Private(scene, ABUT_CHECK_ENERGY, PetscAbsReal(2. * energy - work) / PetscMax(2. * energy, floor));
  }
  PetscCall(AbutRecorderSetInt(rec, "unknowns", unknowns));
  PetscCall(AbutRecorderSetReal(rec, "energy.strain", strain));
  PetscCall(AbutRecorderSetReal(rec, "energy.work", done));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutSceneRecordPair_Private(AbutScene scene, const char name[], PetscReal theta, const AbutPairState *s)
{
  const struct {
    const char *key;
    PetscReal   value;
  } read[] = {
    {"force",           s->force          },
    {"pressure_max",    s->pressure_max   },
    {"contact_length",  s->contact_length },
    {"contact_edge",    s->contact_edge   },
    {"penetration_max", s->penetration_max},
    {"active",          s->active         },
    {"balance",         s->balance        },
    {"complementarity", s->complementarity},
    {"theta",           theta             }
  };
  char key[256];

  PetscFunctionBegin;
  for (PetscInt k = 0; k < (PetscInt)PETSC_STATIC_ARRAY_LENGTH(read); ++k)
    PetscCall(AbutSceneSetReal_Private(scene, "pair", name, read[k].key, read[k].value));
  PetscCall(PetscSNPrintf(key, sizeof(key), "pair.%s.pressure_reading", name));
  PetscCall(AbutRecorderSetString(scene->recorder, key, s->consistent ? "consistent" : "nodal"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutSceneRecordFriction_Private(AbutScene scene, PetscInt pair, const char name[], const AbutPairState *s)
{
  PetscBool friction;

  PetscFunctionBegin;
  PetscCall(AbutPairGetFriction(scene->pair[pair], &friction, NULL));
  if (!friction) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AbutSceneSetReal_Private(scene, "pair", name, "tangential", s->tangential));
  PetscCall(AbutSceneSetReal_Private(scene, "pair", name, "slip_max", s->slip_max));
  PetscCall(AbutSceneSetReal_Private(scene, "pair", name, "stick_length", s->stick_length));
  AbutSceneAddCheck_Private(scene, ABUT_CHECK_FRICTION, s->friction);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutSceneRecordPairs_Private(AbutScene scene)
{
  AbutRecorder rec     = scene->recorder;
  PetscReal    penalty = 0., residual, pressure;

  PetscFunctionBegin;
  if (!scene->npairs) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; i < scene->npairs; ++i) {
    const char   *name;
    AbutPairState s;
    PetscReal     theta;

    PetscCall(AbutPairGetName(scene->pair[i], &name));
    PetscCall(AbutPairGetTheta(scene->pair[i], &theta));
    PetscCall(AbutInterfaceGetPairState(scene->iface, i, &s));
    PetscCall(AbutSceneRecordPair_Private(scene, name, theta, &s));
    PetscCall(AbutSceneRecordFriction_Private(scene, i, name, &s));
    penalty += s.energy;
    AbutSceneAddCheck_Private(scene, ABUT_CHECK_CONTACT, s.balance);
    AbutSceneAddCheck_Private(scene, ABUT_CHECK_TENSION,
                              s.pressure_min < 0. ? -s.pressure_min / PetscMax(s.pressure_max, -s.pressure_min) : 0.);
    AbutSceneAddCheck_Private(scene, ABUT_CHECK_COMPLEMENTARITY, s.complementarity);
    AbutSceneAddCheck_Private(scene, ABUT_CHECK_PENETRATION, s.excess);
  }
  PetscCall(AbutInterfaceGetResidual(scene->iface, &residual, &pressure));
  PetscCall(AbutRecorderSetReal(rec, "energy.penalty", penalty));
  PetscCall(AbutRecorderSetReal(rec, "residual.loop", PetscMax(residual, pressure)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutSceneRecordEstimates_Private(AbutScene scene)
{
  PetscFunctionBegin;
  if (!scene->estimator) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt b = 0; b < scene->nbodies; ++b) {
    const char *name;
    PetscReal   eta, eta_max;

    if (!scene->eta[b]) continue;
    PetscCall(AbutBodyGetName(scene->body[b], &name));
    PetscCall(AbutEstimatorGetNorms(scene->body[b], scene->eta[b], &eta, &eta_max));
    PetscCall(AbutSceneSetReal_Private(scene, "eta", name, "", eta));
    PetscCall(AbutSceneSetReal_Private(scene, "eta_max", name, "", eta_max));
  }
  PetscCall(AbutRecorderSetInt(scene->recorder, "unknowns_estimator", scene->unknowns_estimator));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutSceneRecordProbes_Private(AbutScene scene)
{
  static const char *const key[] = {"u1", "u2", "s11", "s22", "s12", "s33", "vm"};

  PetscFunctionBegin;
  for (PetscInt i = 0; i < scene->nprobes; ++i) {
    PetscReal value[7];

    PetscCall(AbutBodyGetPointValues(scene->probe[i].body, scene->probe[i].x, value));
    for (PetscInt k = 0; k < 7; ++k) PetscCall(AbutSceneSetReal_Private(scene, "probe", scene->probe[i].name, key[k], value[k]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Unknowns of all bodies on the present meshes */
PetscErrorCode AbutSceneGetUnknowns_Private(AbutScene scene, PetscInt *unknowns)
{
  PetscFunctionBegin;
  *unknowns = 0;
  for (PetscInt b = 0; b < scene->nbodies; ++b) {
    PetscInt n;

    PetscCall(AbutBodyGetSize(scene->body[b], &n));
    *unknowns += n;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sweeps, and how many of the present meshes they are worth: those of small meshes cost less */
static PetscErrorCode AbutSceneRecordSweeps_Private(AbutScene scene)
{
  PetscInt sweeps = scene->cycle + 1, start = 0, unknowns;

  PetscFunctionBegin;
  if (scene->snes) PetscCall(AbutInterfaceGetSweeps(scene->iface, &sweeps, &start));
  PetscCall(AbutSceneGetUnknowns_Private(scene, &unknowns));
  scene->work += (PetscReal)(sweeps - scene->sweepsbefore) * unknowns;
  PetscCall(AbutRecorderSetInt(scene->recorder, "sweeps", sweeps));
  PetscCall(AbutRecorderSetInt(scene->recorder, "sweeps_start", start));
  PetscCall(AbutRecorderSetInt(scene->recorder, "sweeps_cycle", sweeps - scene->sweepsbefore));
  PetscCall(AbutRecorderSetReal(scene->recorder, "sweeps_work", scene->work / unknowns));
  scene->sweepsbefore = sweeps;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The keys of this cycle; consistent: the run agrees with itself (balance of forces, energy identity, no tension) */
PetscErrorCode AbutSceneRecord_Private(AbutScene scene, PetscBool last, PetscBool *consistent)
{
  PetscFunctionBegin;
  PetscCall(AbutRecorderSetString(scene->recorder, "verdict", scene->verdict));
  PetscCall(AbutRecorderSetInt(scene->recorder, "cycles", scene->cycle + 1));
  PetscCall(AbutSceneRecordStep_Private(scene));
  PetscCall(AbutSceneRecordSweeps_Private(scene));
  AbutSceneBeginChecks_Private(scene);
  PetscCall(AbutSceneRecordBodies_Private(scene));
  PetscCall(AbutSceneRecordPairs_Private(scene));
  PetscCall(AbutSceneEndChecks_Private(scene, last, consistent));
  PetscCall(AbutSceneRecordTies_Private(scene));
  PetscCall(AbutSceneRecordEstimates_Private(scene));
  PetscCall(AbutSceneRecordBudget_Private(scene));
  PetscCall(AbutSceneRecordProbes_Private(scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The price of contact and adaptivity in one number: the processor time of the whole run over that of one linear problem in every body on
   the last mesh, solved to 1e-8 */
PetscErrorCode AbutSceneRecordRatio_Private(AbutScene scene)
{
  MPI_Comm       comm   = PetscObjectComm((PetscObject)scene);
  PetscReal      linear = 0.;
  PetscLogDouble whole;
  PetscLogEvent  event;

  PetscFunctionBegin;
  if (!scene->wantsratio) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AbutGetProcessorTime(&whole));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &whole, 1, MPI_DOUBLE, MPI_SUM, comm));
  PetscCall(AbutLogEventGet("AbutTimeRatio", ABUTSCENE_CLASSID, &event));
  PetscCall(PetscLogEventBegin(event, scene, 0, 0, 0));
  for (PetscInt b = 0; b < scene->nbodies; ++b) {
    PetscReal cpu;

    PetscCall(AbutBodyGetLinearCost(scene->body[b], 1e-8, &cpu));
    linear += cpu;
  }
  PetscCall(PetscLogEventEnd(event, scene, 0, 0, 0));
  scene->ratio = whole / linear;
  PetscCall(AbutRecorderSetReal(scene->recorder, "time.ratio", scene->ratio));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutSceneRecordTimes_Private(AbutScene scene)
{
  static const char *const key[ABUT_TIMES] = {"time.setup", "time.solve", "time.estimate", "time.adapt", "time.output"};
  MPI_Comm                 comm            = PetscObjectComm((PetscObject)scene);
  PetscReal                seconds[ABUT_TIMES + 1], memory, factor = 0.;
  struct rusage            usage;

  PetscFunctionBegin;
  for (PetscInt b = 0; b < scene->nbodies; ++b) {
    PetscReal of[2];
    PetscInt  cells;

    PetscCall(AbutBodyGetSetUpCost(scene->body[b], &of[0], &cells, &of[1]));
    factor += of[1];
  }
  for (PetscInt i = 0; i < ABUT_TIMES; ++i) seconds[i] = scene->seconds[i];
  seconds[ABUT_TIMES] = scene->mark - scene->begun;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, seconds, ABUT_TIMES + 1, MPIU_REAL, MPIU_MAX, comm));
  PetscCall(AbutRecorderSetReal(scene->recorder, "time.total", seconds[ABUT_TIMES]));
  PetscCall(AbutRecorderSetReal(scene->recorder, "time.factor", factor));
  for (PetscInt i = 0; i < ABUT_TIMES; ++i) PetscCall(AbutRecorderSetReal(scene->recorder, key[i], seconds[i]));
  getrusage(RUSAGE_SELF, &usage);
  memory = 1024. * usage.ru_maxrss;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &memory, 1, MPIU_REAL, MPIU_SUM, comm));
  PetscCall(AbutRecorderSetReal(scene->recorder, "memory.peak", memory));
  PetscFunctionReturn(PETSC_SUCCESS);
}
