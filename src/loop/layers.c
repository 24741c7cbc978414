#include <abut/private/loopimpl.h>
#include <petscblaslapack.h>

/* The compliance of the bodies as if each were an elastic layer between its contact side and the side opposite to it: closed forms for a
   pressure cos(xi x). It replaces no solve; it predicts the contact zone and preconditions, and what it misses the sweeps correct.
   Some n^3 operations and n^2 numbers, which the ranks share: blocks of the modes go round, and each rank adds them to its columns. */

/* How far each face of a layer of half height h gives way, smooth faces, equal pressures cos(xi x) on both: k/xi 2 sinh^2 s/(sinh 2s +
   2s), s = xi h. By symmetry also a layer of height h on a smooth rigid base. k = 2(1-nu^2)/E; xi -> 0: k h/2; xi -> infinity: k/xi, the
   half plane. */
static PetscReal AbutLayerSqueeze_Private(PetscReal k, PetscReal xi, PetscReal h)
{
  const PetscReal s = xi * h;

  if (s < 1e-4) return 0.5 * k * h;
  if (s > 20.) return k / xi;
  return k / xi * 2. * PetscSqr(PetscSinhReal(s)) / (PetscSinhReal(2. * s) + 2. * s);
}

/* The same for opposite pressures: the layer bends, k/xi 2 cosh^2 s/(sinh 2s - 2s) */
static PetscReal AbutLayerBend_Private(PetscReal k, PetscReal xi, PetscReal h)
{
  const PetscReal s = xi * h;

  if (s < 1e-2) return 1.5 * k / (xi * s * s * s);
  if (s > 20.) return k / xi;
  return k / xi * 2. * PetscSqr(PetscCoshReal(s)) / (PetscSinhReal(2. * s) - 2. * s);
}

/* S += W_a diag(w) W_b' in the part of their pairs and the columns of this rank, for the modes that both sides have */
static PetscErrorCode AbutLayerAdd_Private(AbutContactModel model, const AbutModes *a, const AbutModes *b, const PetscReal w[])
{
  const PetscInt modes = PetscMin(a->n, b->n);
  PetscInt       own, from, to;
  PetscReal     *S = AbutComplianceGetColumns_Private(model->S, &own, &to), one = 1., *scaled;
  PetscBLASInt   na, nb, nk, ld;

  PetscFunctionBegin;
  from = PetscMax(own, b->first);
  to   = PetscMin(to, b->first + b->rows);
  if (!modes || !a->rows || from >= to) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscBLASIntCast(a->rows, &na));
  PetscCall(PetscBLASIntCast(to - from, &nb));
  PetscCall(PetscBLASIntCast(modes, &nk));
  PetscCall(PetscBLASIntCast(model->n, &ld));
  PetscCall(PetscMalloc1(nb * modes, &scaled));
  for (PetscInt k = 0; k < modes; ++k)
    for (PetscInt j = 0; j < nb; ++j) scaled[k * nb + j] = w[k] * b->W[k * b->rows + from - b->first + j];
  PetscCallBLAS("BLASgemm", BLASgemm_("N", "T", &na, &nb, &nk, &one, a->W, &na, scaled, &nb, &one,
                                      S + (size_t)model->n * (from - own) + a->first, &ld));
  PetscCall(PetscFree(scaled));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How the contact on side t gives way under the contact on side r of the same body: itself or another one on the same side, or one on
   the opposite side. A layer that is held on its far side only gets thinner; one that is not also bends, and its faces act on each
   other, mode by mode. */
static PetscErrorCode AbutLayerSides_Private(AbutInterface f, AbutContactModel model, PetscInt t, PetscInt r, const AbutModes m[])
{
  AbutConditionType condition;
  AbutBody          bodies[2], others[2];
  AbutMesh          mesh;
  PetscInt          sides[2], othersides[2], far;
  PetscReal         normal[2], young, poisson, height, *w;

  PetscFunctionBegin;
  PetscCall(AbutPairGetBodies(f->pair[t / 2], bodies, sides));
  PetscCall(AbutPairGetBodies(f->pair[r / 2], others, othersides));
  PetscCall(AbutBodyGetMesh(bodies[t % 2], &mesh));
  PetscCall(AbutMeshGetSideDirection(mesh, sides[t % 2], normal));
  PetscCall(AbutBodyGetFarSide(bodies[t % 2], normal, &far, &condition));
  if (othersides[r % 2] != sides[t % 2] && othersides[r % 2] != far) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AbutBodyGetHeight(bodies[t % 2], normal, &height));
  PetscCall(AbutBodyGetPlaneMaterial(bodies[t % 2], &young, &poisson));
  PetscCall(PetscMalloc1(m[t].n, &w));
  for (PetscInt k = 0; k < m[t].n; ++k) {
    const PetscReal compliance = 2. * (1. - poisson * poisson) / young, longest = 0.5 * PETSC_PI / m[t].length;
    const PetscReal xi      = k < m[r].n ? 0.5 * (m[t].xi[k] + m[r].xi[k]) : m[t].xi[k];
    const PetscReal squeeze = AbutLayerSqueeze_Private(compliance, xi, 0.5 * height);
    const PetscReal bend    = AbutLayerBend_Private(compliance, PetscMax(xi, longest), 0.5 * height); /* moving resists nothing */

    if (condition == ABUT_DISPLACEMENT) w[k] = AbutLayerSqueeze_Private(compliance, xi, height);
    else w[k] = 0.5 * (othersides[r % 2] == far ? squeeze - bend : squeeze + bend);
  }
  PetscCall(AbutLayerAdd_Private(model, &m[t], &m[r], w));
  PetscCall(PetscFree(w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The same along side t for tangential tractions t cos(xi x): k/xi tanh, which is H 2(1+nu)/E for long waves, where the far side is held
   along it, and k/xi coth, a rod, where it is not; the half plane for short ones. On straight sides slips have the modes that penetrations
   have. Nothing of how tractions and pressures act on each other: that the sweeps teach. */
static PetscErrorCode AbutLayerShear_Private(AbutInterface f, AbutContactModel model, PetscInt t, const AbutModes *side)
{
  AbutConditionType condition;
  AbutBody          bodies[2];
  AbutMesh          mesh;
  AbutModes         m = *side;
  PetscInt          sides[2], far;
  PetscReal         normal[2], tangent[2], young, poisson, height, *w;

  PetscFunctionBegin;
  PetscCall(AbutPairGetBodies(f->pair[t / 2], bodies, sides));
  PetscCall(AbutBodyGetMesh(bodies[t % 2], &mesh));
  PetscCall(AbutMeshGetSideDirection(mesh, sides[t % 2], normal));
  tangent[0] = -normal[1];
  tangent[1] = normal[0];
  PetscCall(AbutBodyGetFarSide(bodies[t % 2], normal, &far, &condition));
  if (far >= 0) PetscCall(AbutBodyGetCondition(bodies[t % 2], far, !(far / 2), &condition));
  else PetscCall(AbutBodyGetFarSide(bodies[t % 2], tangent, &far, &condition)); /* any side of a mesh from a file */
  PetscCall(AbutBodyGetHeight(bodies[t % 2], normal, &height));
  PetscCall(AbutBodyGetPlaneMaterial(bodies[t % 2], &young, &poisson));
  PetscCall(PetscMalloc1(m.n, &w));
  for (PetscInt k = 0; k < m.n; ++k) {
    const PetscReal compliance = 2. * (1. - poisson * poisson) / young, xi = PetscMax(m.xi[k], 0.5 * PETSC_PI / m.length);

    if (condition == ABUT_DISPLACEMENT) w[k] = compliance / xi * PetscTanhReal(xi * height / (1. - poisson));
    else w[k] = compliance / xi / PetscTanhReal(2. * xi * height);
  }
  m.first += m.rows;
  PetscCall(AbutLayerAdd_Private(model, &m, &m, w));
  PetscCall(PetscFree(w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds what a block of modes gives */
static PetscErrorCode AbutLayersAdd_Private(AbutInterface f, AbutContactModel model, const AbutModes m[])
{
  PetscFunctionBegin;
  for (PetscInt t = 0; t < 2 * f->npairs; ++t)
    for (PetscInt r = 0; r < 2 * f->npairs; ++r)
      if (f->bodyof[t] >= 0 && f->bodyof[t] == f->bodyof[r]) PetscCall(AbutLayerSides_Private(f, model, t, r, m));
  for (PetscInt t = 0; t < 2 * f->npairs; ++t)
    if (f->bodyof[t] >= 0 && model->first[t / 2 + 1] - model->first[t / 2] > model->normals[t / 2])
      PetscCall(AbutLayerShear_Private(f, model, t, &m[t]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Fills S, zero before, with the layers' compliance */
PetscErrorCode AbutInterfaceLayers_Private(AbutInterface f, AbutContactModel model)
{
  AbutModes  *m;
  PetscMPIInt size;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(PetscObjectComm((PetscObject)f), &size));
  PetscCall(PetscCalloc1(2 * f->npairs, &m));
  PetscCall(AbutModesCreate_Private(f, model, m));
  for (PetscMPIInt step = 0; step < size; ++step) {
    PetscCall(AbutLayersAdd_Private(f, model, m));
    if (step + 1 < size) PetscCall(AbutModesPass_Private(f, step, m));
  }
  PetscCall(AbutModesDestroy_Private(f, m));
  PetscCall(PetscFree(m));
  PetscCall(AbutComplianceAssemble_Private(model->S));
  PetscFunctionReturn(PETSC_SUCCESS);
}
