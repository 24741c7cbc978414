#include "ckbody.h"
#include <abutscene.h>

/* The patch test of contact: two boxes pressed together evenly. Whatever the meshes, the displacements are linear and the pressure is
   p = (delta - gap)/(theta + sum H (1-nu^2)/E). One-sided quadrature of the contact forces is off by some per cent here. */

#define DELTA 0.01
#define GAP   0.002
#define THETA 4. /* as -mid_pair_theta below; soft enough for 20 sweeps */

static PetscReal theta = THETA;

/* Of both bodies: the base, held on its far side, and the punch, pushed by delta */
static const PetscReal height[2] = {1., 0.7}, young[2] = {1., 3.}, poisson[2] = {0.3, 0.2};

typedef struct {
  PetscInt  along;           /* the direction of the sides in contact: 0 punch on base, 1 punch to the right of the base */
  PetscReal low[2], high[2]; /* ends of these sides */
  PetscInt  cells[2];        /* along them */
  AbutShape shape[2];
  PetscInt  order[2];  /* 0 is 1 */
  PetscInt  levels[2]; /* refinements of the cells at the first half of the side */
  PetscBool held[2];   /* the displacement normal to the contact is prescribed on the free end of the body too */
} Patch;

/* clang-format off */
static const Patch patches[] = {
  {.high = {1., 1.}, .cells = {4, 4}},
  {.high = {1., 1.}, .cells = {3, 4}},
  {.high = {1., 1.}, .cells = {3, 3}, .shape = {ABUT_QUAD, ABUT_TRIANGLE}},
  {.high = {1., 1.}, .cells = {5, 3}, .shape = {ABUT_TRIANGLE, ABUT_QUAD}, .along = 1},
  {.high = {1., 1.}, .cells = {4, 3}, .levels = {2, 0}},
  {.high = {1., 1.}, .cells = {4, 4}, .shape = {ABUT_TRIANGLE, ABUT_QUAD}, .levels = {2, 1}, .along = 1},
  {.high = {1., 1.}, .cells = {1, 100}},
  /* sides of unequal length, beside each other */
  {.low = {0., 0.37}, .high = {3., 2.21}, .cells = {7, 5}},
  {.low = {0., -0.4}, .high = {3., 1.6}, .cells = {7, 50}, .shape = {ABUT_QUAD, ABUT_TRIANGLE}},
  {.low = {-0.1, 0.}, .high = {1.7, 2.}, .cells = {9, 6}, .along = 1},
  {.low = {0., 0.37}, .high = {3., 2.21}, .cells = {7, 5}, .order = {2, 3}},
  {.low = {-0.1, 0.}, .high = {1.7, 2.}, .cells = {5, 4}, .order = {4, 2}, .shape = {ABUT_QUAD, ABUT_TRIANGLE}, .along = 1},
  /* by little: within one element, by a thousandth of one, by almost nothing */
  {.low = {0., 0.7}, .high = {3., 0.9}, .cells = {2, 3}},
  {.low = {0., 2.999}, .high = {3., 4.}, .cells = {3, 4}},
  {.low = {0., 1e-8}, .high = {3., 2. + 1e-8}, .cells = {3, 3}},
  {.low = {0., 0.}, .high = {4., 3.5001}, .cells = {8, 4}, .order = {4, 2}},
  /* a node that carries no pressure */
  {.high = {1., 1.}, .cells = {3, 4}, .held = {PETSC_TRUE, PETSC_TRUE}},
  {.high = {1., 1.}, .cells = {4, 4}, .held = {PETSC_TRUE, PETSC_FALSE}},
  {.high = {1., 1.}, .cells = {4, 3}, .held = {PETSC_FALSE, PETSC_TRUE}, .levels = {0, 1}},
  {.high = {1., 1.}, .cells = {4, 3}, .held = {PETSC_FALSE, PETSC_TRUE}, .levels = {0, 1}, .order = {3, 2}},
  /* whole sides of higher order */
  {.high = {1., 1.}, .cells = {3, 3}, .order = {2, 2}},
  {.high = {1., 1.}, .cells = {4, 3}, .order = {3, 3}, .shape = {ABUT_QUAD, ABUT_TRIANGLE}, .along = 1},
  {.high = {1., 1.}, .cells = {3, 2}, .order = {4, 1}, .levels = {1, 0}},
  {.high = {1., 1.}, .cells = {2, 3}, .order = {2, 4}, .shape = {ABUT_TRIANGLE, ABUT_QUAD}, .levels = {1, 2}}
};
/* clang-format on */
static const int npatches = PETSC_STATIC_ARRAY_LENGTH(patches), first_unequal = 7, first_alone = 10, end_unequal = 16, end_alone = 20;

/* The bits of a variant: pressures on the second side of the pair; the punch is its first body; the free ends are those of small x or y */
static PetscBool Bit(PetscInt variant, PetscInt bit)
{
  return (PetscBool)(variant >> bit & 1);
}

static PetscInt nvariants = 8; /* on several ranks only the first two */

static PetscReal Overlap(const Patch *patch, PetscReal *from, PetscReal *to)
{
  *from = PetscMax(patch->low[0], patch->low[1]);
  *to   = PetscMin(patch->high[0], patch->high[1]);
  return *to - *from;
}

static PetscReal Pressure(void)
{
  PetscReal sum = theta;

  for (PetscInt b = 0; b < 2; ++b) sum += height[b] * (1. - poisson[b] * poisson[b]) / young[b];
  return (DELTA - GAP) / sum;
}

/* One of the two bodies, as a field for the functions of ckbody.h, which hand `field` back */
typedef struct {
  CkField      field;
  const Patch *patch;
  PetscInt     b;
  PetscReal    origin; /* the end of the side that does not move along it */
} Box;

static void Evenly(const CkField *field, const PetscReal x[2], PetscReal u[2], PetscReal s[3])
{
  const Box      *box = (const Box *)field;
  const PetscInt  b = box->b, along = box->patch->along, across = !along;
  const PetscReal p = Pressure(), support = b ? height[0] + height[1] : 0.;

  u[along]  = p * poisson[b] * (1. + poisson[b]) / young[b] * (x[along] - box->origin);
  u[across] = (b ? -DELTA : 0.) - p * (1. - poisson[b] * poisson[b]) / young[b] * (x[across] - support);
  s[along]  = 0.;
  s[across] = -p;
  s[2]      = 0.;
}

/* Integrals of the functions of an element [0,1] over a part of it */
static void Moments(PetscInt order, PetscReal from, PetscReal to, PetscReal m[])
{
  PetscReal z[3], w[3], N[ABUT_SIDE_NODES_MAX];

  CkOk(PetscDTGaussQuadrature(3, from, to, z, w));
  for (PetscInt i = 0; i <= order; ++i) m[i] = 0.;
  for (PetscInt q = 0; from < to && q < 3; ++q) {
    CkOk(AbutEvaluateLobatto(order, 2. * z[q] - 1., N, NULL));
    for (PetscInt i = 0; i <= order; ++i) m[i] += w[q] * N[i];
  }
}

/* The same pressure where the other body does not reach: on the element with its end, the polynomial of the same nodal forces */
static PetscErrorCode PressureBeside(const PetscReal x[2], PetscReal *value, void *ctx)
{
  const Box      *box = (const Box *)ctx;
  const PetscInt  b = box->b, along = box->patch->along, order = PetscMax(1, box->patch->order[b]), n = order + 1;
  const PetscReal low = box->patch->low[b], h = (box->patch->high[b] - low) / box->patch->cells[b];
  const PetscReal at = (x[along] - low) / h, left = PetscFloorReal(at), z = at - left;
  PetscReal       from, to, l, r, m[2][ABUT_SIDE_NODES_MAX], N[ABUT_SIDE_NODES_MAX], inverse[ABUT_SIDE_NODES_MAX * ABUT_SIDE_NODES_MAX];

  Overlap(box->patch, &from, &to);
  l = PetscMin(PetscMax((from - low) / h - left, 0.), 1.); /* the part [l,r] of the element is in contact */
  r = PetscMax(PetscMin((to - low) / h - left, 1.), l);
  Moments(order, 0., l, m[0]);
  Moments(order, r, 1., m[1]);
  CkOk(AbutGetLobattoMassInverse(order, inverse));
  CkOk(AbutEvaluateLobatto(order, 2. * z - 1., N, NULL));
  *value = 0.;
  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt j = 0; j < n; ++j) *value += 2. * (b ? 1. : -1.) * Pressure() * N[i] * inverse[n * i + j] * (m[0][j] + m[1][j]);
  return PETSC_SUCCESS;
}

static const char *const name[2] = {"base", "punch"};
static const char *const side[4] = {"left", "right", "bottom", "top"};

/* more: the gap, theta, the loop */
static AbutScene Create(const Patch *patch, PetscInt variant, const char more[])
{
  const PetscBool punchfirst = Bit(variant, 1);
  char            text[4096], part[512];
  AbutScene       scene;

  CkOk(PetscSNPrintf(text, sizeof(text),
                     "-scene_bodies base,punch -scene_pairs mid -mid_pair_bodies %s,%s -mid_pair_sides %s,%s -mid_pair_pressure_side %s "
                     "%s",
                     name[punchfirst], name[!punchfirst], side[2 * !patch->along + !punchfirst], side[2 * !patch->along + punchfirst],
                     Bit(variant, 0) ? "second" : "first", more));
  for (PetscInt b = 0; b < 2; ++b) {
    const PetscReal low       = b ? height[0] : 0.;
    PetscReal       corner[4] = {patch->low[b], low, patch->high[b], low + height[b]};
    PetscInt        cells[2]  = {patch->cells[b], 2};

    for (PetscInt k = 0; k < 4 && patch->along; k += 2)
      corner[k] = low + (k ? height[b] : 0.), corner[k + 1] = k ? patch->high[b] : patch->low[b];
    CkOk(PetscSNPrintf(part, sizeof(part),
                       " -%s_mesh_box %.15g,%.15g,%.15g,%.15g -%s_mesh_cells %d,%d -%s_mesh_shape %s -%s_mesh_order %d "
                       "-%s_material_young %g -%s_material_poisson %g",
                       name[b], corner[0], corner[1], corner[2], corner[3], name[b], (int)cells[patch->along], (int)cells[!patch->along],
                       name[b], patch->shape[b] == ABUT_QUAD ? "quad" : "triangle", name[b], (int)PetscMax(1, patch->order[b]), name[b],
                       young[b], name[b], poisson[b]));
    CkOk(PetscStrlcat(text, part, sizeof(text)));
  }
  CkOptions(text);
  CkOk(AbutSceneCreate(PETSC_COMM_WORLD, &scene));
  CkOk(AbutSceneSetFromOptions(scene));
  return scene;
}

static void Destroy(AbutScene *scene)
{
  CkOk(AbutSceneDestroy(scene));
  CkOptionsEnd();
}

static void RefineFirstHalf(AbutMesh mesh, PetscInt along, PetscReal middle)
{
  const AbutMeshTopology *t = CkTopology(mesh);
  PetscBool              *marks;
  PetscReal               x[2];

  CkOk(PetscMalloc1(t->ncells, &marks));
  for (PetscInt c = 0; c < t->ncells; ++c) {
    CkCenter(t, c, x);
    marks[c] = (PetscBool)(x[along] < middle);
  }
  CkOk(AbutMeshAdapt(mesh, marks));
  CkOk(PetscFree(marks));
}

/* The conditions and meshes of both bodies; beside: what the other one does not cover is pressed all the same */
static void Prepare(AbutScene scene, const Patch *patch, PetscInt variant, PetscBool beside, Box box[2], AbutBody body[2])
{
  const PetscInt    along = patch->along, across = !along;
  const char *const still = side[2 * along + Bit(variant, 2)], *const end = side[2 * along + !Bit(variant, 2)];

  for (PetscInt b = 0; b < 2; ++b) {
    AbutMesh mesh;

    box[b].field  = (CkField){.at = Evenly, .young = young[b], .poisson = poisson[b]};
    box[b].patch  = patch;
    box[b].b      = b;
    box[b].origin = Bit(variant, 2) ? patch->high[b] : patch->low[b];
    CkOk(AbutSceneGetBody(scene, name[b], &body[b]));
    CkGive(body[b], &box[b].field, still, along ? "-u" : "u-");
    CkGive(body[b], &box[b].field, side[2 * across + b], along ? "u-" : "-u");
    if (patch->held[b]) CkGive(body[b], &box[b].field, end, along ? "u-" : "-u");
    if (beside) CkOk(AbutBodySetTraction(body[b], side[2 * across + !b], across, PressureBeside, &box[b]));
    CkOk(AbutBodyGetMesh(body[b], &mesh));
    CkOk(AbutMeshSetUp(mesh));
    for (PetscInt level = 0; level < patch->levels[b]; ++level) RefineFirstHalf(mesh, along, 0.5 * (patch->low[b] + patch->high[b]));
  }
}

/* Do the elements at a node lie within the common part of both sides? -1 all of it, 0 nothing, 1 a part */
static int Within(const PetscReal x[], PetscInt n, PetscInt i, PetscInt along, PetscReal from, PetscReal to)
{
  PetscReal low = x[2 * i + along], high = low;

  for (PetscInt k = PetscMax(i - 1, 0); k <= PetscMin(i + 1, n - 1); ++k) {
    low  = PetscMin(low, x[2 * k + along]);
    high = PetscMax(high, x[2 * k + along]);
  }
  if (low > from - 1e-12 && high < to + 1e-12) return -1;
  return PetscMin(high, to) - PetscMax(low, from) > 1e-12;
}

/* The largest errors so far: of displacements, of pressures */
static PetscReal worst[2];

static void CheckPressures(AbutScene scene, const Patch *patch, PetscInt variant, PetscBool exact)
{
  const PetscInt   carrier = Bit(variant, 0) != Bit(variant, 1);
  const PetscReal  end     = (Bit(variant, 2) ? patch->low : patch->high)[carrier]; /* the free one, where the body may be held */
  const PetscReal *p, *x, *D;
  PetscReal        from, to, length = Overlap(patch, &from, &to);
  AbutInterface    iface;
  AbutPairState    state;
  AbutPair         pair;
  PetscInt         number, which, n;

  CkOk(AbutSceneGetInterface(scene, &iface));
  CkOk(AbutSceneGetPair(scene, "mid", &pair, &number));
  CkOk(AbutInterfaceGetPressure(iface, number, &p));
  CkOk(AbutPairGetPressureNodes(pair, &which, &n, &x, &D));
  ck_assert_int_eq(which, Bit(variant, 0));
  for (PetscInt i = 0; i < n; ++i) {
    const PetscBool atheld = (PetscBool)(patch->held[carrier] && PetscAbsReal(x[2 * i + patch->along] - end) < 1e-12);
    const int       within = Within(x, n, i, patch->along, from, to);

    ck_assert(D[i] >= 0.);
    if (atheld || !within) ck_assert_double_eq(D[i], 0.);
    else if (within < 0) ck_assert_double_gt(D[i], 0.);
    if (exact && D[i] > 0.) worst[1] = PetscMax(worst[1], PetscAbsReal(p[i] / Pressure() - 1.));
    if (D[i] == 0.) ck_assert_double_eq(p[i], 0.);
    else if (exact) ck_assert_double_eq_tol(p[i], Pressure(), 1e-9 * Pressure());
    else ck_assert(p[i] >= 0. && !PetscIsInfOrNanReal(p[i]));
  }
  CkOk(AbutInterfaceGetPairState(iface, number, &state));
  ck_assert_double_lt(state.balance, 1e-12);
  if (!exact) return;
  ck_assert_double_eq_tol(state.contact_length, length, 1e-12 * length);
  ck_assert_double_eq_tol(state.force, Pressure() * length, 1e-9 * Pressure() * length);
}

static void CheckEvenPressure(PetscInt which, PetscInt variant, const char more[])
{
  const Patch   *patch   = &patches[which];
  const PetscInt unequal = which >= first_unequal && which < end_unequal;
  AbutScene      scene   = Create(patch, variant, more);
  Box            box[2];
  AbutBody       body[2];
  PetscInt       status;

  Prepare(scene, patch, variant, (PetscBool)unequal, box, body);
  CkOk(AbutSceneSolve(scene));
  CkOk(AbutSceneGetExitStatus(scene, &status));
  ck_assert_int_eq(status, 0);
  for (PetscInt b = 0; b < 2; ++b) {
    const PetscReal error = CkNodalError(body[b], &box[b].field);

    ck_assert_double_lt(error, 1e-10);
    worst[0] = PetscMax(worst[0], error);
  }
  CheckPressures(scene, patch, variant, PETSC_TRUE);
  Destroy(&scene);
}

/* After the last patch: what was largest, on one rank */
static void Say(const char displacement[], const char pressure[])
{
  PetscMPIInt size;

  CkOk(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  if (size == 1) CkCase("V02", displacement, worst[0], 1e-10);
  if (size == 1) CkCase("V02", pressure, worst[1], 1e-9);
  worst[0] = worst[1] = 0.;
}

START_TEST(an_even_pressure_is_exact_on_any_meshes)
{
  CheckEvenPressure(_i / nvariants, _i % nvariants, "-mid_pair_gap 0.002 -mid_pair_theta 4 -snes_rtol 1e-12");
  if (_i == npatches * nvariants - 1)
    CkCase("H22", "displacement off, 1:100, offset, unequal sides, overlaps of 1e-8 to all", worst[0], 1e-10);
  if (_i == npatches * nvariants - 1)
    Say("largest error of u over largest u, 24 pairs of meshes", "p off the even one, 24 pairs of meshes");
}
END_TEST

START_TEST(so_it_is_with_next_to_no_penalty)
{
  theta = 1e-6;
  CheckEvenPressure(_i, 0, "-mid_pair_gap 0.002 -mid_pair_theta 1e-6 -snes_rtol 1e-12");
  theta = THETA;
  if (_i == npatches - 1) Say("largest error of u over largest u, theta 1e-6 H/E", "p off the even one, theta 1e-6 H/E");
}
END_TEST

/* With nothing beside the common part the pressure is not even; it stays finite, acts only there, and is what holds the bodies */
START_TEST(sides_of_unequal_length_are_in_balance)
{
  static PetscReal worst   = 0.;
  const Patch     *patch   = &patches[first_unequal + _i / nvariants];
  const PetscInt   variant = _i % nvariants, across = !patch->along;
  AbutScene        scene = Create(patch, variant,
                                  "-mid_pair_gap 0.002 -mid_pair_theta 0.5 -snes_type ddneumann -snes_ddneumann_start nocontact "
                                         "-snes_ddneumann_gamma 0.3 -snes_rtol 1e-11");
  Box              box[2];
  AbutBody         body[2];
  AbutInterface    iface;
  AbutPairState    state;
  PetscInt         status;

  Prepare(scene, patch, variant, PETSC_FALSE, box, body);
  CkOk(AbutSceneSolve(scene));
  CkOk(AbutSceneGetExitStatus(scene, &status));
  ck_assert_int_eq(status, 0);
  CheckPressures(scene, patch, variant, PETSC_FALSE);
  CkOk(AbutSceneGetInterface(scene, &iface));
  CkOk(AbutInterfaceGetPairState(iface, 0, &state));
  ck_assert_double_gt(state.force, 0.);
  for (PetscInt b = 0; b < 2; ++b) {
    PetscReal reaction[2], applied[2];

    CkOk(AbutBodyGetReaction(body[b], reaction, applied));
    ck_assert_double_eq_tol(reaction[across], b ? -state.force : state.force, 1e-10 * state.force);
    worst = PetscMax(worst, PetscAbsReal(reaction[across] - (b ? -state.force : state.force)) / state.force);
  }
  Destroy(&scene);
  if (_i == nvariants * (end_unequal - first_unequal) - 1)
    CkCase("H22", "forces of contact and supports off each other, beside the other side open", worst, 1e-10);
}
END_TEST

/* The integrals of the functions of a side's nodes over the common part; a side runs up or down */
static void Tributaries(const AbutSide *s, PetscInt along, PetscReal from, PetscReal to, PetscReal length[])
{
  for (PetscInt i = 0; i < s->n; ++i) length[i] = 0.;
  for (PetscInt first = 0; first + 1 < s->n; first += s->order) {
    const PetscReal a = s->x[2 * first + along], b = s->x[2 * (first + s->order) + along], l = (from - a) / (b - a), r = (to - a) / (b - a);
    PetscReal       m[ABUT_SIDE_NODES_MAX];

    Moments(s->order, PetscMax(0., PetscMin(l, r)), PetscMin(1., PetscMax(l, r)), m);
    for (PetscInt i = 0; i <= s->order; ++i) length[first + i] += m[i] * PetscAbsReal(b - a);
  }
}

static void PairOf(AbutScene scene, AbutPair *pair, const AbutSide *sides[2])
{
  AbutBody body[2];
  PetscInt number[2], n;

  CkOk(AbutSceneSetUp(scene));
  CkOk(AbutSceneGetPair(scene, "mid", pair, &n));
  CkOk(AbutPairGetBodies(*pair, body, number));
  for (PetscInt s = 0; s < 2; ++s) CkOk(AbutBodyGetSide(body[s], number[s], &sides[s]));
}

START_TEST(a_pressure_of_one_gives_every_node_its_tributary_length)
{
  const Patch    *patch   = &patches[_i / nvariants];
  const PetscInt  variant = _i % nvariants;
  AbutScene       scene   = Create(patch, variant, "-mid_pair_gap 0");
  Box             box[2];
  AbutBody        body[2];
  const AbutSide *s[2];
  PetscReal      *p, *f[2], *expected, from, to, length = Overlap(patch, &from, &to);
  AbutPair        pair;

  Prepare(scene, patch, variant, PETSC_FALSE, box, body);
  PairOf(scene, &pair, s);
  CkOk(PetscMalloc4(s[0]->n + s[1]->n, &p, s[0]->n, &f[0], s[1]->n, &f[1], s[0]->n + s[1]->n, &expected));
  for (PetscInt i = 0; i < s[0]->n + s[1]->n; ++i) p[i] = 1.;
  CkOk(AbutPairComputeForce(pair, p, f[0], f[1]));
  for (PetscInt k = 0; k < 2; ++k) {
    Tributaries(s[k], patch->along, from, to, expected);
    for (PetscInt i = 0; i < s[k]->n; ++i) ck_assert_double_eq_tol(f[k][i], expected[i], 1e-12 * length);
  }
  CkOk(PetscFree4(p, f[0], f[1], expected));
  Destroy(&scene);
}
END_TEST

/* u_n = c0 + c1 t on both sides, f = 0.002 + 0.01 t. Nodal penetrations are the values at the nodes, wherever the elements are cut,
   unless a node carries the pressure of a place alone; in any case their mean is right. */
START_TEST(a_linear_penetration_is_found_at_every_node)
{
  const Patch     *patch   = &patches[_i / nvariants];
  const PetscInt   variant = _i % nvariants;
  const PetscBool  alone   = (PetscBool)(_i / nvariants >= first_alone && _i / nvariants < end_alone);
  AbutScene        scene   = Create(patch, variant,
                           patch->along ? "-mid_pair_theta 4 -mid_pair_gap 0.002+0.01*y" : "-mid_pair_theta 4 -mid_pair_gap 0.002+0.01*x");
  Box              box[2];
  AbutBody         body[2];
  const AbutSide  *s[2];
  const PetscReal *x, *D,
    c[2][2] = {
      {0.7, 0.2 },
      {0.5, -0.1}
  };
  PetscReal *u[2], *p, from, to, length = Overlap(patch, &from, &to), sum = 0.;
  AbutPair   pair;
  PetscInt   which, n;

  Prepare(scene, patch, variant, PETSC_FALSE, box, body);
  PairOf(scene, &pair, s);
  CkOk(AbutPairGetPressureNodes(pair, &which, &n, &x, &D));
  CkOk(PetscMalloc3(s[0]->n, &u[0], s[1]->n, &u[1], n, &p));
  for (PetscInt k = 0; k < 2; ++k)
    for (PetscInt i = 0; i < s[k]->n; ++i) u[k][i] = c[k][0] + c[k][1] * s[k]->x[2 * i + patch->along];
  CkOk(AbutPairComputePressure(pair, u[0], u[1], p));
  for (PetscInt i = 0; i < n; ++i) {
    if (D[i] > 0. && !alone) ck_assert_double_eq_tol(p[i] * THETA, 1.198 + 0.09 * x[2 * i + patch->along], 1e-10);
    sum += D[i] * p[i] * THETA;
  }
  ck_assert_double_eq_tol(sum, (1.198 + 0.045 * (from + to)) * length, 1e-12 * length);
  CkOk(PetscFree3(u[0], u[1], p));
  Destroy(&scene);
}
END_TEST

/* On whole sides of order 2 and more the dual functions reproduce linear pressures, and constant ones anywhere */
START_TEST(the_recovered_pressure_is_that_of_the_nodal_forces)
{
  const Patch     *patch = &patches[_i / nvariants];
  const PetscBool  whole = (PetscBool)(_i / nvariants >= end_alone);
  AbutScene        scene = Create(patch, _i % nvariants, "-mid_pair_gap 0");
  Box              box[2];
  AbutBody         body[2];
  const AbutSide  *s[2];
  const PetscReal *x, *D;
  PetscReal       *p, *q;
  AbutPair         pair;
  PetscInt         which, n;

  Prepare(scene, patch, _i % nvariants, PETSC_FALSE, box, body);
  PairOf(scene, &pair, s);
  CkOk(AbutPairGetPressureNodes(pair, &which, &n, &x, &D));
  CkOk(PetscMalloc2(n, &p, n, &q));
  for (PetscInt i = 0; i < n; ++i) p[i] = whole && s[which]->order > 1 ? 3. + x[2 * i + patch->along] : 3.;
  CkOk(AbutPairRecoverPressure(pair, p, q));
  for (PetscInt i = 0; i < n; ++i)
    if (D[i] > 0.) ck_assert_double_eq_tol(q[i], p[i], 1e-9);
  CkOk(PetscFree2(p, q));
  Destroy(&scene);
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("patch");
  TCase *tests = tcase_create("contact");
  int    status, ranks;

  PetscCall(AbutInitialize(&argc, &argv, NULL));
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &ranks));
  if (ranks > 1) nvariants = 2;
  tcase_set_timeout(tests, 0);
  tcase_add_loop_test(tests, an_even_pressure_is_exact_on_any_meshes, 0, npatches * nvariants);
  tcase_add_loop_test(tests, so_it_is_with_next_to_no_penalty, 0, npatches);
  tcase_add_loop_test(tests, sides_of_unequal_length_are_in_balance, 0, (end_unequal - first_unequal) * nvariants);
  tcase_add_loop_test(tests, a_pressure_of_one_gives_every_node_its_tributary_length, 0, npatches * nvariants);
  tcase_add_loop_test(tests, a_linear_penetration_is_found_at_every_node, 0, npatches * nvariants);
  tcase_add_loop_test(tests, the_recovered_pressure_is_that_of_the_nodal_forces, 0, npatches * nvariants);
  suite_add_tcase(suite, tests);
  status = CkRun(suite);
  PetscCall(AbutFinalize());
  return status;
}
