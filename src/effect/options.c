#include <abut/private/bodyimpl.h>
#include <abut/private/sysimpl.h>
#include <abut/private/effectimpl.h> /*I "abuteffect.h" I*/

/* The keys of an effect, NAME_effect_..., and what types have in common */

/* The names in "lower, upper", or all bodies where nothing is said */
static PetscErrorCode AbutEffectFindBodies_Private(AbutEffect effect, const char text[], PetscInt nbodies, AbutBody bodies[])
{
  MPI_Comm    comm = PetscObjectComm((PetscObject)effect);
  const char *name = ((PetscObject)effect)->name;
  char        all[ABUT_LIST], copy[PETSC_MAX_PATH_LEN], *word, *rest = copy;
  AbutBody   *found, one;
  PetscInt    n = 0;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(nbodies, &found));
  PetscCall(PetscStrncpy(copy, text, sizeof(copy)));
  PetscCall(AbutBodyFind_Private(nbodies, bodies, "", &one, all, sizeof(all)));
  while ((word = strtok_r(NULL, ", ", &rest))) {
    PetscCall(AbutBodyFind_Private(nbodies, bodies, word, &one, all, sizeof(all)));
    AbutCheckInput(one, comm, "%s_effect_bodies: the scene has no body \"%s\"; give some of: %s", name, word, all);
    for (PetscInt i = 0; i < n; ++i)
      AbutCheckInput(found[i] != one, comm, "%s_effect_bodies: \"%s\" stands twice; once is enough", name, word);
    found[n++] = one;
  }
  AbutCheckInput(n, comm, "%s_effect_bodies: \"%s\" names no body; give some of: %s", name, text, all);
  PetscCall(AbutEffectSetBodies(effect, n, found));
  PetscCall(PetscFree(found));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutEffectSetFromOptions - Reads the keys of an effect, its type's too, and lets it act on its bodies

   Collective

   Input Parameters:
+  effect  - the effect
.  nbodies - bodies of the scene
-  bodies  - [nbodies] the bodies, which have read their keys

   Options Database Keys:
+  -NAME_effect_type <type>    - what it is: `gravity`, `force`, `pressure`, `spring`, `overlap`, `thermal`,
                                 `plane_stress`, `axisymmetric`, or that of a plugin
.  -NAME_effect_bodies <names> - what it acts on, all bodies by default; a type with a side wants one body
-  -NAME_effect_*              - keys of the type

   Level: beginner

.seealso: `AbutEffectCreate()`, `AbutEffectSetType()`, `ABUTEFFECTGRAVITY`
@*/
PetscErrorCode AbutEffectSetFromOptions(AbutEffect effect, PetscInt nbodies, AbutBody bodies[])
{
  char      type[256] = "", text[PETSC_MAX_PATH_LEN] = "";
  PetscBool given;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(effect, ABUTEFFECT_CLASSID, 1);
  if (((PetscObject)effect)->type_name) PetscCall(PetscStrncpy(type, ((PetscObject)effect)->type_name, sizeof(type)));
  PetscObjectOptionsBegin((PetscObject)effect);
  PetscCall(AbutOptionsString(PetscOptionsObject, "-effect_type", "What the effect is", type, sizeof(type), NULL));
  PetscCall(AbutOptionsString(PetscOptionsObject, "-effect_bodies", "Names of the bodies it acts on", text, sizeof(text), &given));
  AbutCheckInput(type[0], PetscObjectComm((PetscObject)effect), "%s_effect_type: missing; give what it is, for example gravity",
                 ((PetscObject)effect)->name);
  if (given) PetscCall(AbutEffectFindBodies_Private(effect, text, nbodies, bodies));
  else PetscCall(AbutEffectSetBodies(effect, nbodies, bodies));
  PetscCall(AbutEffectSetType(effect, type));
  PetscTryTypeMethod(effect, setfromoptions, PetscOptionsObject);
  PetscOptionsEnd();
  PetscCall(AbutEffectSetUp(effect));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutEffectOptionsSide - Reads the side of an effect that acts on one side of one body, `-NAME_effect_side`

   Logically Collective

   Input Parameters:
+  effect             - the effect
-  PetscOptionsObject - the block in which the type reads its keys

   Output Parameter:
.  side - number of the side

   Level: advanced

   Note:
   No such key, more than one body, or a side that there is not, are bad input.

.seealso: `AbutEffectSetFromOptions()`, `AbutEffectCheckSide()`
@*/
PetscErrorCode AbutEffectOptionsSide(AbutEffect effect, AbutOptionItems PetscOptionsObject, PetscInt *side)
{
  MPI_Comm    comm      = PetscObjectComm((PetscObject)effect);
  const char *name      = ((PetscObject)effect)->name;
  char        text[256] = "", key[256];
  PetscBool   given;
  AbutMesh    mesh;

  PetscFunctionBegin;
  PetscCall(AbutOptionsString(PetscOptionsObject, "-effect_side", "Side of the body", text, sizeof(text), &given));
  AbutCheckInput(given, comm, "%s_effect_side: missing; give the side that the effect acts on, for example top", name);
  AbutCheckInput(effect->nbodies == 1, comm, "%s_effect_bodies: a side belongs to one body; give one, not %" PetscInt_FMT, name,
                 effect->nbodies);
  PetscCall(PetscSNPrintf(key, sizeof(key), "%s_effect_side", name));
  PetscCall(AbutBodyGetMesh(effect->body[0], &mesh));
  PetscCall(AbutMeshFindSide(mesh, key, text, side));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutEffectOptionsExpression - Reads a number, a formula in x and y, or a CSV file

   Logically Collective

   Input Parameters:
+  effect             - the effect
.  PetscOptionsObject - the block in which the type reads its keys
.  opt                - the key with its dash, without the prefix
.  text               - one line for `-help`
-  otherwise          - the value where the key is not given; `NULL` where it must be

   Output Parameter:
.  e - the expression, to be destroyed by the type

   Level: advanced

.seealso: `AbutEffectSetFromOptions()`, `AbutExpressionCreate()`
@*/
PetscErrorCode AbutEffectOptionsExpression(AbutEffect effect, AbutOptionItems PetscOptionsObject, const char opt[], const char text[],
                                           const char otherwise[], AbutExpression *e)
{
  MPI_Comm  comm                      = PetscObjectComm((PetscObject)effect);
  char      value[PETSC_MAX_PATH_LEN] = "", key[256];
  PetscBool given;

  PetscFunctionBegin;
  if (otherwise) PetscCall(PetscStrncpy(value, otherwise, sizeof(value)));
  PetscCall(AbutOptionsString(PetscOptionsObject, opt, text, value, sizeof(value), &given));
  PetscCall(PetscSNPrintf(key, sizeof(key), "%s%s", ((PetscObject)effect)->prefix, opt + 1));
  AbutCheckInput(given || otherwise, comm, "%s: missing; give a number, a formula in x and y, or a CSV file", key);
  PetscCall(AbutExpressionDestroy(e));
  PetscCall(AbutExpressionCreate(comm, key, value, e));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutEffectCheckSide - Ends the run if a side that an effect acts on is in contact, or if it is not

   Collective

   Input Parameters:
+  effect  - the effect
.  body    - its body
.  side    - number of the side
-  contact - whether the effect is one for sides in contact

   Level: advanced

.seealso: `AbutEffectOptionsSide()`, `AbutEffectCheck()`
@*/
PetscErrorCode AbutEffectCheckSide(AbutEffect effect, AbutBody body, PetscInt side, PetscBool contact)
{
  AbutMesh          mesh;
  AbutConditionType type[2];
  const char       *where;
  PetscBool         is;

  PetscFunctionBegin;
  PetscCall(AbutBodyGetMesh(body, &mesh));
  PetscCall(AbutMeshGetSideName(mesh, side, &where));
  for (PetscInt d = 0; d < 2; ++d) PetscCall(AbutBodyGetCondition(body, side, d, &type[d]));
  is = (PetscBool)(type[0] == ABUT_CONTACT || type[1] == ABUT_CONTACT);
  AbutCheckInput(contact || !is, PetscObjectComm((PetscObject)effect),
                 "%s_effect_side: %s of %s is in contact, and its tractions are those of contact; give a side without a pair",
                 ((PetscObject)effect)->name, where, ((PetscObject)body)->name);
  AbutCheckInput(is || !contact, PetscObjectComm((PetscObject)effect),
                 "%s_effect_side: %s of %s is in no pair; give a side in contact, or leave the effect out", ((PetscObject)effect)->name,
                 where, ((PetscObject)body)->name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Point i of ABUT_EFFECT_SAMPLES in the box of a body: z in the unit square, and x; -3, -2, -1 are its corners (0,0), (1,0), (0,1) */
PetscErrorCode AbutEffectGetSample_Private(AbutBody body, PetscInt i, PetscReal z[2], PetscReal x[2])
{
  const PetscInt n = ABUT_EFFECT_LINE;
  AbutMesh       mesh;
  PetscReal      lower[2], upper[2];

  PetscFunctionBegin;
  PetscCall(AbutBodyGetMesh(body, &mesh));
  PetscCall(AbutMeshGetBox(mesh, lower, upper));
  z[0] = i < 0 ? i == -2 : (i % n + 0.5) / n;
  z[1] = i < 0 ? i == -1 : (i / n + 0.5) / n;
  for (PetscInt d = 0; d < 2; ++d) x[d] = lower[d] + z[d] * (upper[d] - lower[d]);
  PetscFunctionReturn(PETSC_SUCCESS);
}
