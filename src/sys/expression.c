#include <abut/private/sysimpl.h>
#include <dlfcn.h>
#include <muParserDLL.h>

/* The entry points of muParser that are used, looked up when the first formula of a run is met */
static struct {
  void *library;
  muParserHandle_t (*create)(int);
  void (*release)(muParserHandle_t);
  void (*setexpr)(muParserHandle_t, const muChar_t *);
  void (*definevar)(muParserHandle_t, const muChar_t *, muFloat_t *);
  void (*defineconst)(muParserHandle_t, const muChar_t *, muFloat_t);
  muFloat_t (*eval)(muParserHandle_t);
  muBool_t (*error)(muParserHandle_t);
  const muChar_t *(*errormsg)(muParserHandle_t);
  void (*errorhandler)(muParserHandle_t, muErrorHandler_t);
} AbutMuParser;

struct _n_AbutExpression {
  MPI_Comm          comm;
  char             *key, *text;
  PetscReal         value; /* of a plain number */
  muParserHandle_t  formula;
  muFloat_t         x[2]; /* the variables of the formula */
  PetscInt          n;    /* points of a CSV file, three numbers each */
  PetscReal        *point;
  AbutPointFunction function;
  void             *ctx;
};

static void AbutExpressionQuiet_Private(PETSC_UNUSED muParserHandle_t h) { } /* errors are asked for; without a handler muParser prints */

static PetscErrorCode AbutMuParserOpen_Private(MPI_Comm comm, const char key[])
{
  static const char *const libraries[] = {"libmuparser.so.2", "libmuparser.so", "libmuparser.dylib", NULL};

  PetscFunctionBegin;
  if (AbutMuParser.library) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; libraries[i] && !AbutMuParser.library; ++i) AbutMuParser.library = dlopen(libraries[i], RTLD_NOW | RTLD_LOCAL);
  AbutCheckInput(AbutMuParser.library, comm,
                 "%s: a formula needs the library muParser, which was not found; install libmuparser2v5, or give a number", key);
#define ABUT_MUPARSER_SYMBOL(member, name) *(void **)&AbutMuParser.member = dlsym(AbutMuParser.library, name)
  ABUT_MUPARSER_SYMBOL(create, "mupCreate");
  ABUT_MUPARSER_SYMBOL(release, "mupRelease");
  ABUT_MUPARSER_SYMBOL(setexpr, "mupSetExpr");
  ABUT_MUPARSER_SYMBOL(definevar, "mupDefineVar");
  ABUT_MUPARSER_SYMBOL(defineconst, "mupDefineConst");
  ABUT_MUPARSER_SYMBOL(eval, "mupEval");
  ABUT_MUPARSER_SYMBOL(error, "mupError");
  ABUT_MUPARSER_SYMBOL(errormsg, "mupGetErrorMsg");
  ABUT_MUPARSER_SYMBOL(errorhandler, "mupSetErrorHandler");
#undef ABUT_MUPARSER_SYMBOL
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutExpressionParse_Private(AbutExpression e)
{
  PetscLogEvent event;

  PetscFunctionBegin;
  PetscCall(AbutLogEventGet("AbutFormula", PETSC_OBJECT_CLASSID, &event));
  PetscCall(PetscLogEventBegin(event, 0, 0, 0, 0));
  PetscCall(AbutMuParserOpen_Private(e->comm, e->key));
  e->formula = (*AbutMuParser.create)(0);
  (*AbutMuParser.errorhandler)(e->formula, AbutExpressionQuiet_Private);
  (*AbutMuParser.definevar)(e->formula, "x", &e->x[0]);
  (*AbutMuParser.definevar)(e->formula, "y", &e->x[1]);
  (*AbutMuParser.defineconst)(e->formula, "pi", PETSC_PI);
  (*AbutMuParser.setexpr)(e->formula, e->text);
  (void)(*AbutMuParser.eval)(e->formula);
  AbutCheckInput(!(*AbutMuParser.error)(e->formula), e->comm, "%s: \"%s\" is not a formula in x and y (%s); give for example 1e-3*x^2",
                 e->key, e->text, (*AbutMuParser.errormsg)(e->formula));
  PetscCall(PetscLogEventEnd(event, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Every rank reads the file: it is small, and a point is then looked up without messages */
static PetscErrorCode AbutExpressionReadPoints_Private(AbutExpression e)
{
  FILE    *f;
  char     line[512], path[PETSC_MAX_PATH_LEN];
  PetscInt room = 0;

  PetscFunctionBegin;
  PetscCall(AbutFileFind(e->comm, e->key, e->text, path, sizeof(path)));
  f = fopen(path, "r");
  AbutCheckInput(f, e->comm, "%s: no file \"%s\"; give the path of a file with lines x,y,value", e->key, e->text);
  while (fgets(line, sizeof(line), f)) {
    double v[3];

    if (sscanf(line, "%lf , %lf , %lf", &v[0], &v[1], &v[2]) != 3) {
      AbutCheckInput(!e->n, e->comm, "%s: file \"%s\", after point %" PetscInt_FMT ": a line is not x,y,value", e->key, e->text, e->n);
      continue; /* headings */
    }
    if (e->n == room) {
      room = 2 * room + 64;
      PetscCall(PetscRealloc(3 * room * sizeof(*e->point), &e->point));
    }
    for (PetscInt i = 0; i < 3; ++i) e->point[3 * e->n + i] = v[i];
    ++e->n;
  }
  fclose(f);
  AbutCheckInput(e->n > 0, e->comm, "%s: file \"%s\" holds no line x,y,value", e->key, e->text);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutExpressionCreate - Makes a function of the point from a text: a number, a formula in x and y, or the name of a CSV file

   Collective

   Input Parameters:
+  comm - the communicator, for messages
.  key  - the key the text comes from, for messages
-  text - the text; `.csv` at its end means a file of lines `x,y,value`, found by `AbutFileFind()`

   Output Parameter:
.  expression - the function

   Level: beginner

.seealso: `AbutExpressionCreateFunction()`, `AbutExpressionEvaluate()`, `AbutExpressionDestroy()`
@*/
PetscErrorCode AbutExpressionCreate(MPI_Comm comm, const char key[], const char text[], AbutExpression *expression)
{
  AbutExpression e;
  size_t         len;
  char          *end;

  PetscFunctionBegin;
  PetscCall(PetscNew(&e));
  e->comm = comm;
  PetscCall(PetscStrallocpy(key, &e->key));
  PetscCall(PetscStrallocpy(text, &e->text));
  PetscCall(PetscStrlen(text, &len));
  e->value = strtod(text, &end);
  while (*end == ' ') ++end;
  if (len > 4 && !strcmp(text + len - 4, ".csv")) PetscCall(AbutExpressionReadPoints_Private(e));
  else if (end == text || *end) PetscCall(AbutExpressionParse_Private(e));
  else AbutCheckInput(!PetscIsInfOrNanReal(e->value), comm, "%s: \"%s\" is not a finite number", key, text);
  *expression = e;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutExpressionCreateFunction - Makes a function of the point from a C function

   Not Collective

   Input Parameters:
+  function - called with a point and ctx
-  ctx      - handed to it

   Output Parameter:
.  expression - the function

   Level: intermediate

.seealso: `AbutExpressionCreate()`
@*/
PetscErrorCode AbutExpressionCreateFunction(AbutPointFunction function, void *ctx, AbutExpression *expression)
{
  PetscFunctionBegin;
  PetscCall(PetscNew(expression));
  (*expression)->comm     = PETSC_COMM_SELF;
  (*expression)->function = function;
  (*expression)->ctx      = ctx;
  PetscCall(PetscStrallocpy("function", &(*expression)->key));
  PetscCall(PetscStrallocpy("a C function", &(*expression)->text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Linear along the polyline of the points, at the foot of the perpendicular nearest to x */
static PetscReal AbutExpressionInterpolate_Private(AbutExpression e, const PetscReal x[2])
{
  PetscReal best = PETSC_MAX_REAL, value = e->point[2];

  for (PetscInt i = 0; i + 1 < e->n; ++i) {
    const PetscReal *p = e->point + 3 * i, *q = p + 3, d[2] = {q[0] - p[0], q[1] - p[1]}, len2 = d[0] * d[0] + d[1] * d[1];
    PetscReal        t = len2 > 0. ? ((x[0] - p[0]) * d[0] + (x[1] - p[1]) * d[1]) / len2 : 0., r;

    t = PetscMin(1., PetscMax(0., t));
    r = PetscSqr(x[0] - p[0] - t * d[0]) + PetscSqr(x[1] - p[1] - t * d[1]);
    if (r < best) {
      best  = r;
      value = (1. - t) * p[2] + t * q[2];
    }
  }
  return value;
}

/*@C
   AbutExpressionEvaluate - The value at a point

   Not Collective

   Input Parameters:
+  e - the function
-  x - the point

   Output Parameter:
.  value - its value; not being finite is an error that names the key

   Level: beginner

.seealso: `AbutExpressionCreate()`
@*/
PetscErrorCode AbutExpressionEvaluate(AbutExpression e, const PetscReal x[2], PetscReal *value)
{
  PetscFunctionBegin;
  *value = e->value;
  if (e->function) PetscCall((*e->function)(x, value, e->ctx));
  else if (e->n) *value = AbutExpressionInterpolate_Private(e, x);
  else if (e->formula) {
    e->x[0] = x[0];
    e->x[1] = x[1];
    *value  = (*AbutMuParser.eval)(e->formula);
  }
  AbutCheckInput(!PetscIsInfOrNanReal(*value), e->comm, "%s: \"%s\" is not a finite number at (%g, %g)", e->key, e->text, (double)x[0],
                 (double)x[1]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutExpressionGetText - The text an expression was made from

   Not Collective

   Input Parameter:
.  e - the function

   Output Parameter:
.  text - its text, owned by the expression

   Level: beginner

.seealso: `AbutExpressionCreate()`
@*/
PetscErrorCode AbutExpressionGetText(AbutExpression e, const char *text[])
{
  PetscFunctionBegin;
  *text = e->text;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutExpressionDestroy - Frees an expression

   Not Collective

   Input Parameter:
.  e - the expression; set to `NULL`

   Level: beginner

.seealso: `AbutExpressionCreate()`
@*/
PetscErrorCode AbutExpressionDestroy(AbutExpression *e)
{
  PetscFunctionBegin;
  if (!*e) PetscFunctionReturn(PETSC_SUCCESS);
  if ((*e)->formula) (*AbutMuParser.release)((*e)->formula);
  PetscCall(PetscFree((*e)->point));
  PetscCall(PetscFree((*e)->key));
  PetscCall(PetscFree((*e)->text));
  PetscCall(PetscFree(*e));
  PetscFunctionReturn(PETSC_SUCCESS);
}
