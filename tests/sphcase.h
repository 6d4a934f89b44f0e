/* sphcase.h - flows of one block of fluid with walls at its sides, for the validation tests of the fluid. */
#ifndef SPHCASE_H
#define SPHCASE_H

#include "sph.h"
#include "sphfill.h"
#include "testing.h"

typedef struct {
  PetscInt dim;
  PetscReal dp, lo[3], hi[3];       /* domain, m */
  PetscReal fluidlo[3], fluidhi[3]; /* block of fluid; all zero: the domain */
  PetscBool periodic[3], wall[6];   /* xmin, xmax, ymin, ... */
  PetscReal wallvelocity[6][3];     /* m/s, along the wall */
  PetscReal rho, mu, vmax, f[3];    /* kg/m^3, Pa s, m/s, m/s^2 */
  SphKernelType kernel;
  PetscReal hratio, xsph; /* xsph < 0: the default */
  SphShiftingType shifting;
  SphFillKeep keep; /* NULL: fill everything */
  void *ctx;
  /* Initial velocity (m/s) and pressure (Pa) at x; NULL for 0. */
  void (*initial)(const PetscReal x[3], void *ctx, PetscReal v[3], PetscReal *p);
} FlowCase;

/* Create a fluid with the case's parameters, options on top, and its fluid markers. */
static inline PetscErrorCode FlowFluid(const FlowCase *c, Sph *out)
{
  const PetscBool block = c->fluidhi[0] > c->fluidlo[0] ? PETSC_TRUE : PETSC_FALSE;
  PetscReal *x, *v, *p;
  PetscInt n;
  Sph sph;

  PetscFunctionBegin;
  PetscCall(SphCreate(PETSC_COMM_SELF, &sph));
  PetscCall(SphSetDimension(sph, c->dim));
  PetscCall(SphSetSpacing(sph, c->dp));
  PetscCall(SphSetKernel(sph, c->kernel));
  PetscCall(SphSetSmoothingRatio(sph, c->hratio));
  PetscCall(SphSetDensity(sph, c->rho));
  PetscCall(SphSetViscosity(sph, c->mu));
  PetscCall(SphSetMaxSpeed(sph, c->vmax));
  PetscCall(SphSetBodyForce(sph, c->f));
  PetscCall(SphSetDomain(sph, c->lo, c->hi));
  PetscCall(SphSetPeriodic(sph, c->periodic));
  PetscCall(SphSetShifting(sph, c->shifting, 2.0));
  if (c->xsph >= 0.0) PetscCall(SphSetXSPH(sph, c->xsph));
  PetscCall(SphSetFromOptions(sph));
  PetscCall(SphFillBox(c->dim, c->dp, block ? c->fluidlo : c->lo, block ? c->fluidhi : c->hi, c->keep, c->ctx, &n, &x));
  PetscCall(PetscCalloc2(3 * (size_t)n, &v, n, &p));
  for (PetscInt i = 0; i < n && c->initial; i++) c->initial(x + 3 * i, c->ctx, v + 3 * i, p + i);
  PetscCall(SphAddFluid(sph, n, x, v, p));
  PetscCall(PetscFree2(v, p));
  PetscCall(PetscFree(x));
  *out = sph;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The walls, one boundary group; a marker behind two faces belongs to the one that rests. */
static inline PetscErrorCode FlowWalls(const FlowCase *c, Sph sph, PetscInt *group)
{
  PetscReal *x, *volume, *depth, *v, support;
  PetscInt n;

  PetscFunctionBegin;
  PetscCall(SphGetSupport(sph, &support));
  PetscCall(SphFillWalls(c->dim, c->dp, c->lo, c->hi, c->wall, c->periodic, support, &n, &x, &volume, &depth));
  PetscCall(PetscCalloc1(3 * (size_t)n, &v));
  for (PetscInt i = 0; i < n; i++) {
    PetscInt faces = 0, face = -1;
    for (PetscInt k = 0; k < 2 * c->dim; k++)
      if (c->wall[k] && (k % 2 ? x[3 * i + k / 2] > c->hi[k / 2] : x[3 * i + k / 2] < c->lo[k / 2])) {
        faces++;
        face = k;
      }
    if (faces == 1) PetscCall(PetscArraycpy(v + 3 * i, c->wallvelocity[face], 3));
  }
  PetscCall(SphAddBoundary(sph, n, x, v, volume, depth, group));
  PetscCall(PetscFree(v));
  PetscCall(PetscFree(x));
  PetscCall(PetscFree(volume));
  PetscCall(PetscFree(depth));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Steps to time end (s), walls in place. */
static inline PetscErrorCode FlowRun(Sph sph, PetscReal end)
{
  PetscReal t, dt;

  PetscFunctionBegin;
  for (;;) {
    PetscCall(SphGetTime(sph, &t, NULL));
    if (t >= end * (1.0 - 1e-12)) break;
    PetscCall(SphComputeTimeStep(sph, &dt));
    PetscCall(SphStepBegin(sph, PetscMin(dt, end - t)));
    PetscCall(SphStepEnd(sph));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

#endif
