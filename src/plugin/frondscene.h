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
  Read a scene as `frond run` does, make all objects and set them up; refuses what `frond check` refuses. PETSc's options
  database is left as it was. file: path of the YAML file. n: number of options. options: 2 n strings, name and value,
  "sph_dp", "0.02", ..., which win over the file. scene: the new scene.
*/
FROND_EXTERN PetscErrorCode FrondSceneLoad(const char file[], PetscInt n, const char *const options[], FrondScene *scene);
/* Free the scene and its objects. scene: becomes NULL. */
FROND_EXTERN PetscErrorCode FrondSceneDestroy(FrondScene *scene);
/*
  Borrowed objects, NULL for those that the scene has not; each output may be NULL. couple: the coupling. sph: the fluid.
  ancf: the beams. rigid: the rigid bodies.
*/
FROND_EXTERN PetscErrorCode FrondSceneGetObjects(FrondScene scene, Couple *couple, Sph *sph, Ancf *ancf, Rigid *rigid);
/* Each output may be NULL. t: time, s. step: number of steps. tend: time at which the scene ends (time_end), s. */
FROND_EXTERN PetscErrorCode FrondSceneGetTime(FrondScene scene, PetscReal *t, PetscInt *step, PetscReal *tend);
/*
  One step. PETSC_ERR_FP on a value that is not finite, PETSC_ERR_NOT_CONVERGED when a solver fails. tmax: not past this time,
  s. dt: the step taken, s, or NULL.
*/
FROND_EXTERN PetscErrorCode FrondSceneStep(FrondScene scene, PetscReal tmax, PetscReal *dt);
/* i: number of the beam, from 0. name: as the scene has it; borrowed. */
FROND_EXTERN PetscErrorCode FrondSceneGetBeamName(FrondScene scene, PetscInt i, const char **name);
/* i: number of the body, from 0. name: as the scene has it; borrowed. */
FROND_EXTERN PetscErrorCode FrondSceneGetBodyName(FrondScene scene, PetscInt i, const char **name);
/* n: how many surfaces the coupling has; 0 without fluid. */
FROND_EXTERN PetscErrorCode FrondSceneGetNumSurfaces(FrondScene scene, PetscInt *n);
/* i: number of the surface, as in CoupleGetSurface(). name: borrowed. */
FROND_EXTERN PetscErrorCode FrondSceneGetSurfaceName(FrondScene scene, PetscInt i, const char **name);
/* Bytes of PetscInt and PetscReal in this build, for callers from other languages. integer: of PetscInt. real: of PetscReal. */
FROND_EXTERN void FrondGetSizes(int *integer, int *real);

#endif
