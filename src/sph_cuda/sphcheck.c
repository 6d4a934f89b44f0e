/* sphcheck.c - no non-finite value goes unnoticed: the check of all fields every -sph_check_every steps. */
#include "sphimpl.h"
#include <math.h>

/* Smallest added-order number of a marker whose value is not finite, or -1. */
static PetscInt FirstBad(Sph sph, const SphValues *a)
{
  PetscInt bad = PETSC_MAX_INT;
#pragma omp parallel for schedule(static) reduction(min : bad)
  for (PetscInt i = 0; i < sph->n; i++)
    if (!isfinite(SphValue(a, i))) bad = PetscMin(bad, (PetscInt)sph->id[i]);
  return bad == PETSC_MAX_INT ? -1 : bad;
}

PetscErrorCode SphCheckFinite(Sph sph)
{
  const SphValues fields[] = {{sph->st.x[0], NULL}, {sph->st.x[1], NULL}, {sph->st.x[2], NULL}, {sph->st.v[0], NULL},
                              {sph->st.v[1], NULL}, {sph->st.v[2], NULL}, {sph->st.s, NULL},    sph->rate.a[0],
                              sph->rate.a[1],       sph->rate.a[2]};
  const char *names[] = {"position x", "position y", "position z",     "velocity x",     "velocity y",
                         "velocity z", "density",    "acceleration x", "acceleration y", "acceleration z"};

  PetscFunctionBegin;
  for (int f = 0; f < 10; f++) {
    const PetscInt bad = FirstBad(sph, &fields[f]);
    if (bad >= 0)
      SETERRQ(sph->comm, PETSC_ERR_FP,
              "non-finite %s of marker %" PetscInt_FMT " (%s) at step %" PetscInt_FMT ", time %g s: every value must be finite",
              names[f], bad, bad < sph->nfluid ? "fluid" : "boundary", sph->step, (double)sph->t);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
