/* sphforce.c - the body force as it changes with time: constant and table. */
#include "sphimpl.h"

/*@
  SphSetBodyForceTable - Body force (n x 3, m/s^2) at n times (s), on top of the constant one.

  The integrators take it where they take the rates: rk2 and symplectic at the beginning and at the middle of a step, verlet at
the beginning; the impulse of a force linear over the step is exact with the former two.
@*/
PetscErrorCode SphSetBodyForceTable(Sph sph, PetscInt n, const PetscReal t[], const PetscReal f[])
{
  PetscFunctionBegin;
  PetscCheck(!sph->setup, sph->comm, PETSC_ERR_ORDER, "SphSetBodyForceTable() must come before SphSetUp()");
  PetscCheck(n >= 0, sph->comm, PETSC_ERR_ARG_OUTOFRANGE, "body force table of %" PetscInt_FMT " entries: must be >= 0", n);
  for (PetscInt i = 0; i < n; i++) {
    PetscCheck(!PetscIsInfOrNanReal(t[i]) && (i == 0 || t[i] > t[i - 1]), sph->comm, PETSC_ERR_ARG_OUTOFRANGE,
               "body force table: time %" PetscInt_FMT " is %g s; times must be finite and increase", i, (double)t[i]);
    for (int k = 0; k < 3; k++)
      PetscCheck(!PetscIsInfOrNanReal(f[3 * i + k]), sph->comm, PETSC_ERR_ARG_OUTOFRANGE,
                 "body force table: entry %" PetscInt_FMT " is %g m/s^2 along axis %d; must be finite", i, (double)f[3 * i + k],
                 k);
  }
  PetscCall(PetscFree(sph->forcetime));
  PetscCall(PetscFree(sph->force));
  sph->nforce = n;
  PetscCall(PetscMalloc1(n, &sph->forcetime));
  PetscCall(PetscMalloc1(3 * (size_t)n, &sph->force));
  PetscCall(PetscArraycpy(sph->forcetime, t, n));
  PetscCall(PetscArraycpy(sph->force, f, 3 * n));
  SphBodyForceAt(sph, sph->t);
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SphBodyForceAt(Sph sph, PetscReal t)
{
  const PetscInt n = sph->nforce;
  PetscInt i = 0;
  PetscReal part = 0.0;

  for (int k = 0; k < 3; k++) sph->par.f[k] = sph->fconst[k];
  if (!n) return;
  while (i + 1 < n && sph->forcetime[i + 1] <= t) i++;
  if (i + 1 < n && t > sph->forcetime[i]) part = (t - sph->forcetime[i]) / (sph->forcetime[i + 1] - sph->forcetime[i]);
  for (int k = 0; k < 3; k++) {
    const PetscReal *f = sph->force + 3 * i + k;
    sph->par.f[k] += f[0] + (part > 0.0 ? part * (f[3] - f[0]) : 0.0);
  }
}
