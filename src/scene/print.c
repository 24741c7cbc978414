#include <abut/private/sceneimpl.h>

/* Progress for people: one line a cycle, a summary at the end */

/* A gap that is drawn wrong looks like a heavy load */
PetscErrorCode AbutSceneWarnOfOverlap_Private(AbutScene scene)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < scene->npairs; ++i) {
    PetscReal   depth, x[2];
    const char *name;
    AbutBody    body[2];
    PetscInt    side[2];
    PetscBool   meant[2] = {PETSC_FALSE, PETSC_FALSE};

    PetscCall(AbutPairGetBodies(scene->pair[i], body, side));
    for (PetscInt s = 0; s < 2 && body[s]; ++s) PetscCall(AbutBodyHasSideOffset(body[s], side[s], &meant[s]));
    PetscCall(AbutPairGetOverlap(scene->pair[i], &depth, x));
    if (depth == 0. || meant[0] || meant[1]) continue;
    PetscCall(AbutPairGetName(scene->pair[i], &name));
    PetscCall(PetscPrintf(PetscObjectComm((PetscObject)scene),
                          "warning: pair %s: at first the sides overlap, by %.6g at (%.6g, %.6g), and contact pushes them apart; if this "
                          "is not meant, mend %s_pair_gap or the meshes\n",
                          name, (double)depth, (double)x[0], (double)x[1], name));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutScenePrintHeader_Private(AbutScene scene)
{
  PetscFunctionBegin;
  PetscCall(AbutSceneViewTolerance_Private(scene, PETSC_VIEWER_STDOUT_(PetscObjectComm((PetscObject)scene))));
  for (PetscInt b = 0; b < scene->nbodies; ++b)
    PetscCall(AbutBodyViewIntegration(scene->body[b], PETSC_VIEWER_STDOUT_(PetscObjectComm((PetscObject)scene))));
  PetscCall(PetscPrintf(PetscObjectComm((PetscObject)scene), "%5s %10s %8s %7s %10s %10s %12s %9s\n", "cycle", "unknowns", "cells",
                        "marked", "estimate", "eta_max", "sweeps", "seconds"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutScenePrintCycle_Private(AbutScene scene, PetscInt nmarked)
{
  PetscInt  unknowns, cells = 0, sweeps = scene->cycle + 1;
  PetscReal worst           = -1.;
  char      estimate[2][32] = {"-", "-"};

  PetscFunctionBegin;
  PetscCall(AbutSceneGetUnknowns_Private(scene, &unknowns));
  for (PetscInt b = 0; b < scene->nbodies; ++b) {
    AbutMesh  mesh;
    PetscInt  c;
    PetscReal eta, eta_max;

    PetscCall(AbutBodyGetMesh(scene->body[b], &mesh));
    PetscCall(AbutMeshGetCellCount(mesh, &c));
    cells += c;
    if (!scene->eta[b]) continue;
    PetscCall(AbutEstimatorGetNorms(scene->body[b], scene->eta[b], &eta, &eta_max));
    worst = PetscMax(worst, eta_max);
  }
  if (worst >= 0.) {
    PetscCall(PetscSNPrintf(estimate[0], sizeof(estimate[0]), "%.4f", (double)scene->discretisation));
    PetscCall(PetscSNPrintf(estimate[1], sizeof(estimate[1]), "%.4f", (double)worst));
  }
  if (scene->snes) PetscCall(AbutInterfaceGetSweeps(scene->iface, &sweeps, NULL));
  PetscCall(PetscPrintf(PetscObjectComm((PetscObject)scene),
                        "%5" PetscInt_FMT " %10" PetscInt_FMT " %8" PetscInt_FMT " %7" PetscInt_FMT " %10s %10s %12" PetscInt_FMT
                        " %9.2f\n",
                        scene->cycle + 1, unknowns, cells, nmarked, estimate[0], estimate[1], sweeps,
                        (double)(scene->mark - scene->begun)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutScenePrintPairs_Private(AbutScene scene)
{
  MPI_Comm comm = PetscObjectComm((PetscObject)scene);

  PetscFunctionBegin;
  for (PetscInt i = 0; i < scene->npairs; ++i) {
    AbutPairState s;
    const char   *name;
    PetscBool     friction;

    PetscCall(AbutPairGetName(scene->pair[i], &name));
    PetscCall(AbutInterfaceGetPairState(scene->iface, i, &s));
    if (!s.active) {
      PetscCall(PetscPrintf(comm, "pair %s: no contact\n", name));
      continue;
    }
    PetscCall(PetscPrintf(comm,
                          "pair %s: force %.8g, largest pressure %.8g, contact edge at %.6g, %" PetscInt_FMT " of %" PetscInt_FMT
                          " nodes in contact\n",
                          name, (double)s.force, (double)s.pressure_max, (double)s.contact_edge, s.active, s.nodes));
    PetscCall(PetscPrintf(comm, "  penetration %.3g, complementarity %.1e, balance of forces %.1e\n", (double)s.penetration_max,
                          (double)s.complementarity, (double)s.balance));
    PetscCall(AbutPairGetFriction(scene->pair[i], &friction, NULL));
    if (friction)
      PetscCall(PetscPrintf(comm, "  tangential force %.8g, largest slip %.3g, %.6g of %.6g sticks\n", (double)s.tangential,
                            (double)s.slip_max, (double)s.stick_length, (double)s.contact_length));
    if (s.active == 1)
      PetscCall(PetscPrintf(comm, "warning: pair %s: one node in contact is too few for its pressure; take smaller cells there\n", name));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the run cost, and where; times of the bodies' set-up are part of the scene's */
static PetscErrorCode AbutScenePrintCost_Private(AbutScene scene)
{
  MPI_Comm        comm     = PetscObjectComm((PetscObject)scene);
  const PetscReal total    = scene->mark - scene->begun;
  PetscReal       assembly = 0., factor = 0.;
  PetscInt        assembled = 0, unknowns;

  PetscFunctionBegin;
  for (PetscInt b = 0; b < scene->nbodies; ++b) {
    PetscReal seconds[2];
    PetscInt  cells;

    PetscCall(AbutBodyGetSetUpCost(scene->body[b], &seconds[0], &cells, &seconds[1]));
    assembly += seconds[0];
    factor += seconds[1];
    assembled += cells;
  }
  PetscCall(PetscPrintf(comm,
                        "seconds: %.2f = set-up %.2f (factors %.2f) + sweeps %.2f + estimate %.2f (%.0f %%) + adapt %.2f + output %.2f\n",
                        (double)total, scene->seconds[ABUT_TIME_SETUP], (double)factor, scene->seconds[ABUT_TIME_SOLVE],
                        scene->seconds[ABUT_TIME_ESTIMATE], total > 0. ? 100. * scene->seconds[ABUT_TIME_ESTIMATE] / total : 0.,
                        scene->seconds[ABUT_TIME_ADAPT], scene->seconds[ABUT_TIME_OUTPUT]));
  PetscCall(AbutSceneGetUnknowns_Private(scene, &unknowns));
  if (scene->snes && !scene->interleave && scene->cycle > 1)
    PetscCall(PetscPrintf(comm, "sweeps: %" PetscInt_FMT " %s %" PetscInt_FMT " %s, worth %.1f of the last mesh\n", scene->sweepsbefore,
                          scene->nsteps ? "in" : "on", scene->cycle, scene->nsteps ? "cycles" : "meshes",
                          (double)(scene->work / unknowns)));
  PetscCall(PetscPrintf(comm, "element matrices and their insertion: %.2f microseconds a cell (%" PetscInt_FMT " cells)\n",
                        assembled ? (double)(1e6 * assembly / assembled) : 0., assembled));
  if (scene->ratio > 0.)
    PetscCall(PetscPrintf(comm, "processor time: that of %.1f linear problems on the last mesh\n", (double)scene->ratio));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What a limit kept from being reached, and which keys say so */
static PetscErrorCode AbutScenePrintLimit_Private(AbutScene scene)
{
  PetscReal   target;
  const char *what = "cells are still above the threshold", *key = "the threshold";

  PetscFunctionBegin;
  PetscCall(AbutAdaptorGetTarget(scene->adaptor, &target));
  if (scene->tol > 0.) {
    what = "the estimate is still above its part of scene_tol";
    key  = "-scene_tol";
  } else if (target > 0. && scene->discretisation <= target) {
    what = "the estimate is at the target, and the largest pressure not resolved";
    key  = "-adaptor_peak";
  } else if (target > 0.) {
    what = "the estimate is still above the target";
    key  = "-adaptor_target";
  }
  PetscCall(PetscPrintf(PetscObjectComm((PetscObject)scene), "verdict: %s (%s: raise -adaptor_max_level or -adaptor_max_unknowns, or %s)\n",
                        scene->verdict, what, key));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutScenePrintEnd_Private(AbutScene scene)
{
  MPI_Comm    comm = PetscObjectComm((PetscObject)scene);
  const char *floating;

  PetscFunctionBegin;
  PetscCall(AbutScenePrintPairs_Private(scene));
  PetscCall(AbutScenePrintBudget_Private(scene));
  PetscCall(AbutScenePrintCost_Private(scene));
  PetscCall(AbutInterfaceGetFloating(scene->iface, &floating));
  if (floating[0]) PetscCall(PetscPrintf(comm, "%s\n", floating));
  if (scene->status == 3) PetscCall(AbutScenePrintLimit_Private(scene));
  else if (!strcmp(scene->verdict, "inconsistent") && scene->wrong[0])
    PetscCall(PetscPrintf(comm, "verdict: %s (%s)\n", scene->verdict, scene->wrong));
  else PetscCall(PetscPrintf(comm, "verdict: %s\n", scene->verdict));
  PetscFunctionReturn(PETSC_SUCCESS);
}
