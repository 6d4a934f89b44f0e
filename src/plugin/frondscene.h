/*
  frondscene.h - a scene of the `frond` command for programs that own the time loop: loaded from its YAML file, stepped, read. No
  files are written, nothing is printed. Python's frond module is made of this and of the other public headers.
*/
#ifndef FRONDSCENE_H
#define FRONDSCENE_H

#include "couple.h"

/* A scene of the frond command. */
typedef struct _p_FrondScene *FrondScene;

/*
  Read the scene in `file` (as `frond run` does) with n options given as pairs of strings, "sph_dp", "0.02", ..., which win over
  the file; make all objects and set them up. PETSc's options database is left as it was. Errors: those of `frond check`.
*/
FROND_EXTERN PetscErrorCode FrondSceneLoad(const char file[], PetscInt n, const char *const options[], FrondScene *scene);
/* Free the scene and its objects; *scene becomes NULL. */
FROND_EXTERN PetscErrorCode FrondSceneDestroy(FrondScene *scene);
/* The objects of the scene, NULL those it has not; borrowed. Any may be NULL. */
FROND_EXTERN PetscErrorCode FrondSceneGetObjects(FrondScene scene, Couple *couple, Sph *sph, Ancf *ancf, Rigid *rigid);
/* Time (s) and number of steps now, and the time at which the scene ends (time_end). Any may be NULL. */
FROND_EXTERN PetscErrorCode FrondSceneGetTime(FrondScene scene, PetscReal *t, PetscInt *step, PetscReal *tend);
/* One step, not past tmax (s); dt (s), or NULL, is the step taken. Errors: PETSC_ERR_FP, PETSC_ERR_NOT_CONVERGED. */
FROND_EXTERN PetscErrorCode FrondSceneStep(FrondScene scene, PetscReal tmax, PetscReal *dt);
/* Name of beam or body i as the scene has it; borrowed. */
FROND_EXTERN PetscErrorCode FrondSceneGetBeamName(FrondScene scene, PetscInt i, const char **name);
/* The same for rigid body i. */
FROND_EXTERN PetscErrorCode FrondSceneGetBodyName(FrondScene scene, PetscInt i, const char **name);
/* How many surfaces the coupling has (0 without fluid), and name of the i-th, its number being that of CoupleGetSurface();
 * borrowed. */
FROND_EXTERN PetscErrorCode FrondSceneGetNumSurfaces(FrondScene scene, PetscInt *n);
/* Name of surface i, which is also its number in CoupleGetSurface(); borrowed. */
FROND_EXTERN PetscErrorCode FrondSceneGetSurfaceName(FrondScene scene, PetscInt i, const char **name);
/* Bytes of PetscInt and PetscReal in this build, for callers from other languages. */
FROND_EXTERN void FrondGetSizes(int *integer, int *real);

#endif
