/* frondscene.c - the scene of the `frond` command behind a handle. */
#include "frondscene.h"
#include "app.h"

struct _p_FrondScene {
  App app;
};

/* With the scene's own options in place of the program's. */
static PetscErrorCode Load(App *app, const char file[], PetscInt n, const char *const options[])
{
  AppKnown known = {0, 0, NULL, PETSC_FALSE};
  PetscErrorCode ierr;
  char key[256];

  PetscFunctionBegin;
  PetscCall(AppOptionsInsertFile(file));
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(PetscSNPrintf(key, sizeof(key), "-%s", options[2 * i]));
    PetscCall(PetscOptionsSetValue(NULL, key, options[2 * i + 1]));
  }
  PetscCall(AppKnownCollect(&known));
  ierr = AppSceneRead(&app->scene, file);
  if (!ierr) ierr = AppBuild(app);
  if (!ierr) ierr = AppOptionsCheckUnused(&known);
  AppKnownFree(&known);
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FrondSceneLoad(const char file[], PetscInt n, const char *const options[], FrondScene *scene)
{
  PetscOptions own;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  *scene = NULL;
  PetscCall(PetscNew(scene));
  PetscCall(PetscOptionsCreate(&own));
  PetscCall(PetscOptionsPush(own));
  ierr = Load(&(*scene)->app, file, n, options);
  PetscCall(PetscOptionsPop());
  PetscCall(PetscOptionsDestroy(&own));
  if (ierr) (void)FrondSceneDestroy(scene);
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FrondSceneDestroy(FrondScene *scene)
{
  PetscFunctionBegin;
  if (!*scene) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AppDestroy(&(*scene)->app));
  PetscCall(PetscFree(*scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FrondSceneGetObjects(FrondScene scene, Couple *couple, Sph *sph, Ancf *ancf, Rigid *rigid)
{
  PetscFunctionBegin;
  if (couple) *couple = scene->app.couple;
  if (sph) *sph = scene->app.sph;
  if (ancf) *ancf = scene->app.ancf;
  if (rigid) *rigid = scene->app.rigid;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FrondSceneGetTime(FrondScene scene, PetscReal *t, PetscInt *step, PetscReal *tend)
{
  PetscFunctionBegin;
  if (scene->app.couple)
    PetscCall(CoupleGetTime(scene->app.couple, &scene->app.t, &scene->app.step)); /* it may have been rolled back */
  if (t) *t = scene->app.t;
  if (step) *step = scene->app.step;
  if (tend) *tend = scene->app.scene.tend;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FrondSceneStep(FrondScene scene, PetscReal tmax, PetscReal *dt)
{
  PetscReal taken;

  PetscFunctionBegin;
  PetscCall(AppStep(&scene->app, tmax, &taken));
  if (dt) *dt = taken;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckRange(const char what[], PetscInt i, PetscInt n)
{
  PetscFunctionBegin;
  PetscCheck(i >= 0 && i < n, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "%s %" PetscInt_FMT ": must be in [0, %" PetscInt_FMT ")", what, i, n);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FrondSceneGetBeamName(FrondScene scene, PetscInt i, const char **name)
{
  PetscFunctionBegin;
  PetscCall(CheckRange("beam", i, scene->app.scene.nbeams));
  *name = scene->app.scene.beams[i].name;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FrondSceneGetBodyName(FrondScene scene, PetscInt i, const char **name)
{
  PetscFunctionBegin;
  PetscCall(CheckRange("body", i, scene->app.scene.nbodies));
  *name = scene->app.scene.bodies[i].name;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FrondSceneGetNumSurfaces(FrondScene scene, PetscInt *n)
{
  PetscFunctionBegin;
  *n = scene->app.nsurfaces;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FrondSceneGetSurfaceName(FrondScene scene, PetscInt i, const char **name)
{
  PetscFunctionBegin;
  PetscCall(CheckRange("surface", i, scene->app.nsurfaces));
  *name = scene->app.surfaces[i].name;
  PetscFunctionReturn(PETSC_SUCCESS);
}

void FrondGetSizes(int *integer, int *real)
{
  *integer = (int)sizeof(PetscInt);
  *real = (int)sizeof(PetscReal);
}
