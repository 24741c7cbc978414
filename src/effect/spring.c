#include <abut/private/effectimpl.h> /*I "abuteffect.h" I*/

/*MC
   ABUTEFFECTSPRING - "spring": a side on springs, E. Winkler's foundation

   Options Database Keys:
+  -NAME_effect_bodies <name>      - the body
.  -NAME_effect_side <side>        - its side
.  -NAME_effect_normal <0>         - k_n >= 0, stiffness along the normal, force per area and length: stress over length
-  -NAME_effect_tangential <0>     - k_t >= 0, along the side

   Level: beginner

   Notes:
   The traction -k_n u_n n - k_t u_t t, on top of what is given. The springs are without stress at first, and pull as well as they push.
   They hold the body: one on a foundation needs no prescribed displacement in the directions that it resists. Their forces and their work
   are in `check.balance` and `check.energy`; `energy.strain` is that of the bodies alone. In the log it is "AbutSpring".

   Limits: constant along the side, none on a side in contact; a side that runs along no axis wants both.

.seealso: `AbutEffectSetType()`, `AbutBodyAddFoundation()`
M*/

typedef struct {
  PetscInt  side;
  PetscReal stiffness[2]; /* normal, tangential */
} AbutEffect_Spring;

static PetscErrorCode AbutEffectSetFromOptions_Spring(AbutEffect effect, AbutOptionItems PetscOptionsObject)
{
  MPI_Comm           comm = PetscObjectComm((PetscObject)effect);
  const char        *name = ((PetscObject)effect)->name;
  AbutEffect_Spring *e;

  PetscFunctionBegin;
  PetscCall(AbutEffectGetData(effect, &e));
  PetscCall(AbutEffectOptionsSide(effect, PetscOptionsObject, &e->side));
  PetscCall(AbutOptionsReal(PetscOptionsObject, "-effect_normal", "Stiffness along the normal", &e->stiffness[0], NULL));
  PetscCall(AbutOptionsReal(PetscOptionsObject, "-effect_tangential", "Stiffness along the side", &e->stiffness[1], NULL));
  for (PetscInt d = 0; d < 2; ++d)
    AbutCheckInput(e->stiffness[d] >= 0., comm, "%s_effect_%s: %g is no stiffness; give a positive number, or leave it out", name,
                   d ? "tangential" : "normal", (double)e->stiffness[d]);
  AbutCheckInput(e->stiffness[0] > 0. || e->stiffness[1] > 0., comm,
                 "%s_effect_normal: missing, and so is %s_effect_tangential; give one of them, or both, for example 1e3", name, name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The component of the displacement that runs along a side, -1 if it runs along no axis */
static PetscErrorCode AbutSideGetAxis_Private(AbutMesh mesh, PetscInt side, PetscInt *along)
{
  PetscReal ends[4], normal[2];
  PetscBool straight;

  PetscFunctionBegin;
  *along = -1;
  PetscCall(AbutMeshIsSideStraight(mesh, side, &straight));
  if (!straight) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AbutMeshGetSideEnds(mesh, side, ends, normal));
  for (PetscInt d = 0; d < 2; ++d)
    if (PetscAbsReal(normal[d]) <= 1e-9) *along = d;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Springs have something to do where they may move, and what they leave free must be a move along an axis */
static PetscErrorCode AbutEffectCheck_Spring(AbutEffect effect, AbutBody body)
{
  MPI_Comm           comm = PetscObjectComm((PetscObject)effect);
  const char        *name = ((PetscObject)effect)->name, *bodyname = ((PetscObject)body)->name, *side;
  AbutEffect_Spring *e;
  AbutMesh           mesh;
  PetscInt           along = -1;

  PetscFunctionBegin;
  PetscCall(AbutEffectGetData(effect, &e));
  PetscCall(AbutEffectCheckSide(effect, body, e->side, PETSC_FALSE));
  PetscCall(AbutBodyGetMesh(body, &mesh));
  PetscCall(AbutMeshGetSideName(mesh, e->side, &side));
  PetscCall(AbutSideGetAxis_Private(mesh, e->side, &along));
  AbutCheckInput((e->stiffness[0] > 0. && e->stiffness[1] > 0.) || along >= 0, comm,
                 "%s_effect_%s: missing; %s of %s runs along no axis, there give both stiffnesses", name,
                 e->stiffness[0] > 0. ? "tangential" : "normal", side, bodyname);
  for (PetscInt d = 0; d < 2 && along >= 0; ++d) {
    AbutConditionType type;

    PetscCall(AbutBodyGetCondition(body, e->side, d, &type));
    AbutCheckInput(e->stiffness[d == along] == 0. || type != ABUT_DISPLACEMENT, comm,
                   "%s_effect_%s: u%d of %s of %s is prescribed, so there these springs have nothing to do; leave out one of the two", name,
                   d == along ? "tangential" : "normal", (int)d + 1, side, bodyname);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEffectApply_Spring(AbutEffect effect, AbutBody body)
{
  AbutEffect_Spring *e;
  PetscLogEvent      event;

  PetscFunctionBegin;
  PetscCall(AbutEffectGetData(effect, &e));
  PetscCall(AbutEffectGetEvent(effect, &event));
  PetscCall(AbutBodyAddFoundation(body, ((PetscObject)effect)->name, event, e->side, e->stiffness[0], e->stiffness[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEffectView_Spring(AbutEffect effect, PetscViewer viewer)
{
  AbutEffect_Spring *e;
  AbutMesh           mesh;
  const char        *side;

  PetscFunctionBegin;
  PetscCall(AbutEffectGetData(effect, &e));
  PetscCall(AbutBodyGetMesh(effect->body[0], &mesh));
  PetscCall(AbutMeshGetSideName(mesh, e->side, &side));
  PetscCall(PetscViewerASCIIPrintf(viewer, ", %s: stiffness %g along the normal, %g along the side", side, (double)e->stiffness[0],
                                   (double)e->stiffness[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEffectDestroy_Spring(AbutEffect effect)
{
  AbutEffect_Spring *e;

  PetscFunctionBegin;
  PetscCall(AbutEffectGetData(effect, &e));
  PetscCall(PetscFree(e));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutEffectCreate_Spring(AbutEffect effect)
{
  const AbutEffectOps ops = {.setfromoptions = AbutEffectSetFromOptions_Spring,
                             .check          = AbutEffectCheck_Spring,
                             .apply          = AbutEffectApply_Spring,
                             .view           = AbutEffectView_Spring,
                             .destroy        = AbutEffectDestroy_Spring};
  AbutEffect_Spring  *e;

  PetscFunctionBegin;
  PetscCall(PetscNew(&e));
  PetscCall(AbutEffectSetData(effect, e));
  PetscCall(AbutEffectSetOps(effect, &ops));
  PetscCall(AbutEffectSetAbout(effect, "a side on springs, Winkler's foundation"));
  PetscFunctionReturn(PETSC_SUCCESS);
}
