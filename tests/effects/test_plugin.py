"""An effect that a plugin brings: found by its name, given its keys, logged under its own event, listed"""
import os, subprocess, tempfile

from abut import BUILD, PROGRAM, ROOT, run, run_error

SOURCE = r"""
#include <abuteffect.h>

/* A force at the first node of the top: every rank is called, and adds what is its own */
static PetscErrorCode Load(AbutBody body, Vec load, void *ctx)
{
  const AbutSide *top;
  PetscMPIInt     rank;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(PetscObjectComm((PetscObject)load), &rank));
  PetscCall(AbutBodyGetSide(body, 3, &top));
  if (!rank) PetscCall(VecSetValue(load, 2 * top->global[0] + 1, *(PetscReal *)ctx, ADD_VALUES));
  PetscCall(VecAssemblyBegin(load));
  PetscCall(VecAssemblyEnd(load));
  PetscFunctionReturn(0);
}

static PetscErrorCode SetFromOptions(AbutEffect effect, AbutOptionItems PetscOptionsObject)
{
  PetscReal *force;

  PetscFunctionBegin;
  PetscCall(AbutEffectGetData(effect, &force));
  PetscCall(AbutOptionsReal(PetscOptionsObject, "-effect_f", "Force", force, NULL));
  PetscFunctionReturn(0);
}

static PetscErrorCode Apply(AbutEffect effect, AbutBody body)
{
  PetscReal    *force;
  PetscLogEvent event;
  const char   *name;

  PetscFunctionBegin;
  PetscCall(AbutEffectGetData(effect, &force));
  PetscCall(AbutEffectGetName(effect, &name));
  PetscCall(AbutEffectGetEvent(effect, &event));
  PetscCall(AbutBodyAddLoad(body, name, event, Load, force));
  PetscFunctionReturn(0);
}

static PetscErrorCode Create(AbutEffect effect)
{
  static PetscReal    force;
  const AbutEffectOps ops = {.setfromoptions = SetFromOptions, .apply = Apply};

  PetscFunctionBegin;
  PetscCall(AbutEffectSetData(effect, &force));
  PetscCall(AbutEffectSetOps(effect, &ops));
  PetscCall(AbutEffectSetAbout(effect, "a force at a node"));
  PetscFunctionReturn(0);
}

PETSC_EXTERN PetscErrorCode PetscDLLibraryRegister_effect_point(void);
PETSC_EXTERN PetscErrorCode PetscDLLibraryRegister_effect_point(void)
{
  PetscFunctionBegin;
  PetscCall(AbutEffectRegister("point", Create));
  PetscFunctionReturn(0);
}
"""
SCENE = """-scene_bodies b -b_mesh_box 0,0,2,1 -b_mesh_cells 4,2 -b_material_young 1e3 -b_material_poisson 0 -b_bc_bottom_u1 0 -b_bc_bottom_u2 0
    -scene_effects pin -pin_effect_type point -pin_effect_f -3 -scene_probes A -A_probe_body b -A_probe_point 2,1"""


def config():
    """What the compiler needs to find PETSc, from the build"""
    with open(os.path.join(BUILD, "config.mk")) as f:
        (line,) = [line for line in f if line.startswith("DEPS_CFLAGS")]
    return line.split("=", 1)[1].split()


def build(folder):
    with open(os.path.join(folder, "point.c"), "w") as f:
        f.write(SOURCE)
    path = os.path.join(folder, "libeffect_point.so")
    command = ["mpicc", *"-std=gnu99 -Wall -Wextra -Werror -fPIC -shared".split(), f"-I{ROOT}/include", *config(), f"{folder}/point.c", "-o", path]
    done = subprocess.run(command, capture_output=True, text=True)
    assert not done.returncode, done.stderr
    return path


def test_a_plugin_brings_an_effect():
    with tempfile.TemporaryDirectory() as folder:
        library = build(folder)
        moved = []
        for ranks, where in (1, f"-plugin {library}"), (2, f"-plugin {library}"), (1, f"-plugin_path {folder}"):
            record = run(None, *SCENE.split(), *where.split(), "-log_view", ranks=ranks)
            assert "AbutPoint " in record.stdout and record["check.balance"] < 1e-10 and record["check.energy"] < 1e-10
            moved.append(record["probe.A.u2"])
        assert moved[0] < -3e-3 and max(abs(u / moved[0] - 1) for u in moved) < 1e-8, moved
        line = run_error(None, *SCENE.split(), "-plugin", library, "-estimator_type residual")
        assert line.startswith("abut: estimator_type: residual does not know how to judge b with nodal forces, that of pin; "), line
        listed = subprocess.run([PROGRAM, "-list", "-plugin", library], capture_output=True, text=True).stdout
        assert any(text.startswith("  point ") and "a force at a node" in text and library in text for text in listed.splitlines()), listed
        assert "there are: " in run_error(None, *SCENE.split(), "-plugin_path", BUILD)
