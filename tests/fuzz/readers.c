#include <abut/private/sceneimpl.h>

/* What libFuzzer gives to the readers of the program, as texts or files: FUZZ_READER=scene|formula|points|restart says to which. A bad
   one has to end in PETSC_ERR_USER_INPUT and one line; another code, or another text on stderr, is as bad as a crash.

   In one process, for a run of the program takes 0.1 s to start MPI. PETSc's errors are return codes, and our handler, below PETSc's own,
   prints the line; nothing aborts before main() does. What an error leaves behind is lost, as in a run, which ends with it: so
   readers.py starts a new process now and then. Nothing is solved. */

#define SCENE "tests/fuzz/restart.yml" /* whose checkpoints are read; FUZZ_TOP is the folder where it lies */

static char  fuzz_said[4096];
static FILE *fuzz_terminal;

static void FuzzFail(const char what[], PetscErrorCode ierr)
{
  fprintf(fuzz_terminal, "%s: code %d, %s\n", what, (int)ierr, fuzz_said);
  abort();
}

/* Neither main() nor a user sees more of an error than this */
static void FuzzJudge(PetscErrorCode ierr)
{
  const char *end;

  fclose(stderr);
  stderr = fuzz_terminal;
  if (ierr && ierr != PETSC_ERR_USER_INPUT && ierr != PETSC_ERR_FILE_WRITE) FuzzFail("an error that is no bad input", ierr);
  if (!ierr && fuzz_said[0]) FuzzFail("a message without an error", ierr);
  end = strchr(fuzz_said, '\n');
  if (ierr && (strncmp(fuzz_said, "abut: ", 6) || !end || end[1])) FuzzFail("not one line", ierr);
}

static const char *FuzzFile(const char name[], const uint8_t *data, size_t size)
{
  FILE *f = fopen(name, "wb");

  if (!f || fwrite(data, 1, size, f) < size || fclose(f)) FuzzFail("a file cannot be written", 0);
  return name;
}

/* The checks that come before meshes are made, of which a text may ask for any number of cells */
static PetscErrorCode FuzzCheck(AbutScene scene)
{
  PetscFunctionBegin;
  PetscCall(AbutOptionsCheckAllRead(PETSC_COMM_WORLD, PETSC_FALSE));
  for (PetscInt i = 0; i < scene->nbodies; ++i) PetscCall(AbutBodyCheck(scene->body[i]));
  for (PetscInt i = 0; i < scene->npairs; ++i) PetscCall(AbutPairCheck(scene->pair[i]));
  PetscCall(AbutInterfaceCheck(scene->iface));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FuzzRunScene(PetscBool setup)
{
  AbutScene scene;

  PetscFunctionBegin;
  PetscCall(AbutSceneCreate(PETSC_COMM_WORLD, &scene));
  PetscCall(AbutSceneSetFromOptions(scene));
  if (setup) PetscCall(AbutSceneSetUp(scene));
  else PetscCall(FuzzCheck(scene));
  PetscCall(AbutSceneDestroy(&scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What PETSc's own parser of YAML refuses, AbutInitialize() says in a line of its own */
static PetscErrorCode FuzzScene(const char text[])
{
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  ierr = PetscOptionsInsertStringYAML(NULL, text);
  PetscCall(PetscPopErrorHandler());
  if (!ierr) PetscCall(FuzzRunScene(PETSC_FALSE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FuzzExpression(const char text[])
{
  AbutExpression e;
  PetscReal      value;

  PetscFunctionBegin;
  PetscCall(AbutExpressionCreate(PETSC_COMM_WORLD, "key", text, &e));
  for (PetscInt i = 0; i < 4; ++i) {
    const PetscReal x[2] = {i % 2, i / 2};

    PetscCall(AbutExpressionEvaluate(e, x, &value));
  }
  PetscCall(AbutExpressionDestroy(&e));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FuzzRestart(const char file[])
{
  char path[PETSC_MAX_PATH_LEN];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/%s", getenv("FUZZ_TOP"), SCENE));
  PetscCall(PetscOptionsInsertFile(PETSC_COMM_WORLD, NULL, path, PETSC_TRUE));
  PetscCall(PetscOptionsSetValue(NULL, "-restart", file));
  PetscCall(FuzzRunScene(PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
  int    one     = 1;
  char **program = *argv;

  (void)argc; /* libFuzzer's own */
  fuzz_terminal = stderr;
  return AbutInitialize(&one, &program, NULL);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  const char     reader = getenv("FUZZ_READER")[0];
  char          *text   = strndup((const char *)data, size);
  PetscErrorCode ierr;

  if (PetscOptionsClear(NULL)) abort();
  memset(fuzz_said, 0, sizeof(fuzz_said));
  stderr = fmemopen(fuzz_said, sizeof(fuzz_said) - 1, "w");
  if (reader == 's') ierr = FuzzScene(text);
  else if (reader == 'f') ierr = FuzzExpression(text);
  else if (reader == 'p') ierr = FuzzExpression(FuzzFile("fuzz.csv", data, size));
  else ierr = FuzzRestart(FuzzFile("fuzz.restart", data, size));
  FuzzJudge(ierr);
  free(text);
  return 0;
}

size_t LLVMFuzzerMutate(uint8_t *, size_t, size_t);

/* A checkpoint of which only bytes have changed is refused for its checksum: most get a new one, so that what is behind it is reached */
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned int seed)
{
  unsigned long long header[5], sum = 0xcbf29ce484222325;

  size = LLVMFuzzerMutate(data, size, most);
  if (getenv("FUZZ_READER")[0] != 'r' || size < sizeof(header) || seed % 8 == 0) return size;
  memcpy(header, data, sizeof(header));
  for (size_t i = sizeof(header); i < size; ++i) sum = (sum ^ data[i]) * 0x100000001b3;
  header[3] = size - sizeof(header);
  header[4] = sum;
  memcpy(data, header, sizeof(header));
  return size;
}
