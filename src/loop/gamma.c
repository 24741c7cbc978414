#include <abut/private/loopimpl.h> /*I "abutloop.h" I*/

/* The relaxation of a sweep: the user's, or from bounds of its eigenvalues, those of layers in closed form or those that SLEPc finds */

/*@
   AbutInterfaceSetGamma - Sets the relaxation of a sweep

   Logically Collective

   Input Parameters:
+  iface - the map
-  gamma - > 0; or 0 for the automatic one

   Level: intermediate

.seealso: `AbutInterfaceGetGamma()`, `AbutInterfaceSetSpectrum()`, `SNESDDNEUMANN`
@*/
PetscErrorCode AbutInterfaceSetGamma(AbutInterface iface, PetscReal gamma)
{
  PetscFunctionBegin;
  iface->gamma = gamma;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutInterfaceSetSpectrum - Whether the automatic relaxation comes from computed eigenvalues, not from those of layers

   Logically Collective

   Input Parameters:
+  iface    - the map
-  computed - `PETSC_TRUE` needs an Abut that was built with SLEPc

   Level: intermediate

.seealso: `AbutInterfaceGetSpectrum()`, `AbutInterfaceSetGamma()`
@*/
PetscErrorCode AbutInterfaceSetSpectrum(AbutInterface iface, PetscBool computed)
{
  PetscFunctionBegin;
  if (computed) PetscCall(AbutInterfaceCheckSpectrum_Private(iface));
  iface->spectrum = computed;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutInterfaceSetGammaFromOptions - Reads the relaxation from the options

   Collective

   Input Parameter:
.  iface - the map

   Options Database Keys:
+  -snes_ddneumann_gamma <0>               - relaxation of a sweep, whatever accelerates it; 0 for the automatic one
-  -snes_ddneumann_gamma_spectrum <no,yes> - the automatic one from computed eigenvalues, see `AbutInterfaceGetSpectrum()`

   Level: intermediate

.seealso: `AbutInterfaceSetGamma()`, `AbutInterfaceSetSpectrum()`, `AbutInterfaceSetFromOptions()`, `SNESDDNEUMANN`
@*/
PetscErrorCode AbutInterfaceSetGammaFromOptions(AbutInterface iface)
{
  PetscReal gamma    = iface->gamma;
  PetscBool spectrum = iface->spectrum;

  PetscFunctionBegin;
  PetscObjectOptionsBegin((PetscObject)iface);
  PetscCall(AbutOptionsReal(PetscOptionsObject, "-snes_ddneumann_gamma", "Relaxation of a sweep, whatever accelerates it", &gamma, NULL));
  AbutCheckInput(gamma >= 0., PetscObjectComm((PetscObject)iface),
                 "snes_ddneumann_gamma: %g; give a positive number, or 0 for 2/(2+C/theta)", (double)gamma);
  PetscCall(AbutOptionsBool(PetscOptionsObject, "-snes_ddneumann_gamma_spectrum", "Automatic relaxation from computed eigenvalues",
                            &spectrum, NULL));
  PetscOptionsEnd();
  PetscCall(AbutInterfaceSetGamma(iface, gamma));
  PetscCall(AbutInterfaceSetSpectrum(iface, spectrum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutInterfaceGetSpectrum - Bounds of the eigenvalues of I - dG, the derivative of what a sweep relaxes

   Collective

   Input Parameter:
.  iface - the map; set up if the eigenvalues are to be computed

   Output Parameters:
+  least   - 1
-  largest - 1 + C/theta, C = sum of H(1-nu^2)/E, the largest of all pairs; or computed on the present meshes

   Level: intermediate

   Notes:
   On a contact zone A the derivative is I + S diag(D_i/theta) with the compliance S of all bodies in the nodes of A. Open nodes have the
   eigenvalue 1, and the more nodes are closed, the larger is the largest one. The zone is not known before the loop, so all contact nodes
   are taken as closed: a relaxation below 2/largest then converges from every start, because a sweep is a gradient step on a convex energy.
   With contact on a small part of the sides it could be a little larger (by 6 per cent in the paper's scene).

   The closed form bounds the eigenvalues of layers between their supports. A body that is held from aside, or that is in several pairs,
   gives way more, and so do pressures on cells that are larger than a quarter of a body's height, with other cells opposite: there the
   computed one is the right one. It takes some ten solves of every body on each mesh, which `AbutInterfaceGetSweeps()` counts as start, and
   is kept until the meshes change. With bodies that bend easily it may be so large that no relaxation is of use.

   With friction H 2(1+nu)/E, what a layer gives under tangential tractions, takes the place of H(1-nu^2)/E. Bodies whose far sides are free
   along them give way more, and so do narrow ones under shear: there, too, the computed one is the right one. A sweep is then no gradient
   step, and the bound no proof.

   Limits: theta > 0; every body is held by itself.

.seealso: `AbutInterfaceSetSpectrum()`, `AbutInterfaceGetGamma()`, `AbutPairGetCompliance()`
@*/
PetscErrorCode AbutInterfaceGetSpectrum(AbutInterface iface, PetscReal *least, PetscReal *largest)
{
  PetscFunctionBegin;
  *least = *largest = 1.;
  if (iface->spectrum) {
    if (iface->largest == 0.) PetscCall(AbutInterfaceComputeSpectrum_Private(iface, &iface->largest));
    *largest = iface->largest;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (PetscInt i = 0; i < iface->npairs; ++i) {
    PetscReal c[2], theta;
    PetscBool friction;

    PetscCall(AbutPairGetFriction(iface->pair[i], &friction, NULL));
    if (friction) PetscCall(AbutPairGetShearCompliance(iface->pair[i], c));
    else PetscCall(AbutPairGetCompliance(iface->pair[i], c));
    PetscCall(AbutPairGetTheta(iface->pair[i], &theta));
    *largest = PetscMax(*largest, 1. + (c[0] + c[1]) / theta);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutInterfaceGetGamma - The relaxation of a sweep: the user's, or the one that balances the ends of the spectrum

   Collective

   Input Parameter:
.  iface - the map

   Output Parameter:
.  gamma - the relaxation; the automatic one is 2/(least + largest) of `AbutInterfaceGetSpectrum()`, so in closed form 2/(2 + C/theta),
           C = sum of H(1-nu^2)/E, the least over the pairs

   Level: intermediate

.seealso: `AbutInterfaceSetGamma()`, `AbutInterfaceGetSpectrum()`
@*/
PetscErrorCode AbutInterfaceGetGamma(AbutInterface iface, PetscReal *gamma)
{
  PetscReal least, largest;

  PetscFunctionBegin;
  *gamma = iface->gamma;
  if (*gamma > 0.) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AbutInterfaceGetSpectrum(iface, &least, &largest));
  *gamma = 2. / (least + largest);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutInterfaceJudgeGamma - What there is to say of the relaxation before a loop: that the user's is too large, or which one was computed

   Collective

   Input Parameters:
+  iface - the map; set up if the eigenvalues are to be computed
-  len   - room in text, 256 is enough

   Output Parameter:
.  text - one line, empty for a user's relaxation in range and for 2/(2 + C/theta)

   Level: developer

.seealso: `AbutInterfaceGetGamma()`, `AbutInterfaceGetSpectrum()`
@*/
PetscErrorCode AbutInterfaceJudgeGamma(AbutInterface iface, char text[], size_t len)
{
  const char *limit = iface->spectrum ? "2/lambda" : "2/(1+C/theta)", *best = iface->spectrum ? "2/(1+lambda)" : "2/(2+C/theta)";
  char        lambda[64] = "";
  PetscReal   gamma, least, largest;

  PetscFunctionBegin;
  text[0] = 0;
  PetscCall(AbutInterfaceGetGamma(iface, &gamma));
  PetscCall(AbutInterfaceGetSpectrum(iface, &least, &largest));
  if (iface->linearfailed) PetscFunctionReturn(PETSC_SUCCESS); /* the verdict will say so */
  if (iface->spectrum) PetscCall(PetscSNPrintf(lambda, sizeof(lambda), "; the largest eigenvalue lambda is %.6g", (double)largest));
  if (gamma >= 2. / largest)
    PetscCall(PetscSNPrintf(text, len, "snes_ddneumann_gamma %.6g: not below %s = %.6g, the loop may oscillate; %s = %.6g would not%s",
                            (double)gamma, limit, (double)(2. / largest), best, (double)(2. / (least + largest)), lambda));
  else if (iface->spectrum)
    PetscCall(PetscSNPrintf(text, len, "snes_ddneumann_gamma %.6g%s: below %s = %.6g%s", (double)gamma,
                            iface->gamma > 0. ? "" : " = 2/(1+lambda)", limit, (double)(2. / largest), lambda));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Anderson mixing on F has the mixing parameter of a relaxation. With another solver as its preconditioner it mixes the results of that
   one. There is no setter, and SNESSetFromOptions() would add the monitors a second time: only the type reads its options again. */
PetscErrorCode AbutInterfaceSetMixing_Private(AbutInterface iface, SNES snes)
{
  PetscOptions options;
  const char  *prefix;
  char         key[256], value[64];
  PetscBool    anderson, preconditioned, given;
  PetscReal    gamma;

  PetscFunctionBegin;
  PetscCall(PetscObjectTypeCompare((PetscObject)snes, SNESANDERSON, &anderson));
  PetscCall(SNESHasNPC(snes, &preconditioned));
  PetscCall(PetscObjectGetOptions((PetscObject)snes, &options));
  PetscCall(SNESGetOptionsPrefix(snes, &prefix));
  PetscCall(PetscOptionsHasName(options, prefix, "-snes_anderson_beta", &given));
  if (!anderson || preconditioned || given) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AbutInterfaceGetGamma(iface, &gamma));
  PetscCall(PetscSNPrintf(key, sizeof(key), "-%ssnes_anderson_beta", prefix ? prefix : ""));
  PetscCall(PetscSNPrintf(value, sizeof(value), "%.16g", (double)gamma));
  PetscCall(PetscOptionsSetValue(options, key, value));
  PetscObjectOptionsBegin((PetscObject)snes);
  PetscUseTypeMethod(snes, setfromoptions, PetscOptionsObject);
  PetscOptionsEnd();
  PetscCall(PetscOptionsClearValue(options, key));
  PetscFunctionReturn(PETSC_SUCCESS);
}
