/* sphmarkers.c - adding markers, reading and writing fields, sums; arrays in the order added. */
#include <math.h>
typedef double sphreal;
#include "sphimpl.h"
#include "sphpair.h"

static PetscErrorCode GrowDouble(double **a, PetscInt n, PetscInt cap)
{
  double *b;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(cap, &b));
  if (n) PetscCall(PetscArraycpy(b, *a, n));
  PetscCall(PetscFree(*a));
  *a = b;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode GrowInt(int **a, PetscInt n, PetscInt cap)
{
  int *b;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(cap, &b));
  if (n) PetscCall(PetscArraycpy(b, *a, n));
  PetscCall(PetscFree(*a));
  *a = b;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Reserve(Sph sph, PetscInt more)
{
  PetscInt cap = sph->n + more;

  PetscFunctionBegin;
  PetscCheck(cap < 2000000000, sph->comm, PETSC_ERR_ARG_OUTOFRANGE, "%" PetscInt_FMT " markers: must be fewer than 2e9", cap);
  if (cap <= sph->cap) PetscFunctionReturn(PETSC_SUCCESS);
  if (sph->ngroups >= 8) cap = PetscMax(cap, sph->cap + sph->cap / 16); /* thousands of beams or bodies: not a copy for each */
  for (int k = 0; k < 3; k++) {
    PetscCall(GrowDouble(&sph->st.x[k], sph->n, cap));
    PetscCall(GrowDouble(&sph->st.v[k], sph->n, cap));
  }
  PetscCall(GrowDouble(&sph->st.s, sph->n, cap));
  PetscCall(GrowDouble(&sph->m, sph->n, cap));
  PetscCall(GrowDouble(&sph->wallratio, sph->n, cap));
  PetscCall(GrowInt(&sph->group, sph->n, cap));
  PetscCall(GrowInt(&sph->id, sph->n, cap));
  PetscCall(GrowInt(&sph->slot, sph->n, cap));
  sph->cap = cap;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AllocateValues(Sph sph, PetscBool single, SphValues *a)
{
  PetscFunctionBegin;
  if (single)
    PetscCall(PetscCalloc1(sph->cap, &a->f));
  else
    PetscCall(PetscCalloc1(sph->cap, &a->d));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphAllocateArrays(Sph sph, PetscBool spare)
{
  const SphParams *p = &sph->par;
  const PetscBool single = spare && p->precision == SPH_PRECISION_SINGLE ? PETSC_TRUE : PETSC_FALSE;
  const PetscBool adami = p->wall == SPH_WALL_ADAMI ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBegin;
  if (spare && !adami) PetscCall(PetscFree(sph->wallratio)); /* first: its memory goes to another array */
  for (int k = 0; k < 3; k++) {
    if (!spare || p->integrator != SPH_INTEGRATOR_VERLET) PetscCall(PetscCalloc1(sph->cap, &sph->stn.x[k]));
    PetscCall(PetscCalloc1(sph->cap, &sph->stn.v[k]));
    PetscCall(AllocateValues(sph, single, &sph->rate.a[k]));
    if (!spare || SphTwoVelocities(p)) PetscCall(AllocateValues(sph, single, &sph->rate.dv[k]));
    if (!spare || adami) PetscCall(PetscCalloc1(sph->cap, &sph->ab[k]));
  }
  PetscCall(PetscCalloc1(sph->cap, &sph->stn.s));
  PetscCall(AllocateValues(sph, single, &sph->rate.ds));
  if (adami) PetscCall(PetscCalloc1(3 * (size_t)PetscMax(1, sph->n - sph->nfluid), &sph->omega));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Every array of doubles, of one value of a marker each, and every array of rates. */
#define SPH_NDOUBLES 19
#define SPH_NRATES 7
static void ListArrays(Sph sph, double **doubles[SPH_NDOUBLES], SphValues *rates[SPH_NRATES])
{
  int n = 0, r = 0;

  for (int k = 0; k < 3; k++) {
    doubles[n++] = &sph->st.x[k];
    doubles[n++] = &sph->st.v[k];
    doubles[n++] = &sph->stn.x[k];
    doubles[n++] = &sph->stn.v[k];
    doubles[n++] = &sph->ab[k];
    rates[r++] = &sph->rate.a[k];
    rates[r++] = &sph->rate.dv[k];
  }
  doubles[n++] = &sph->st.s;
  doubles[n++] = &sph->stn.s;
  doubles[n++] = &sph->m;
  doubles[n++] = &sph->wallratio;
  rates[r++] = &sph->rate.ds;
}

PetscErrorCode SphFreeArrays(Sph sph)
{
  double **doubles[SPH_NDOUBLES];
  SphValues *rates[SPH_NRATES];

  PetscFunctionBegin;
  ListArrays(sph, doubles, rates);
  for (int k = 0; k < SPH_NDOUBLES; k++) PetscCall(PetscFree(*doubles[k]));
  for (int k = 0; k < SPH_NRATES; k++) {
    PetscCall(PetscFree(rates[k]->d));
    PetscCall(PetscFree(rates[k]->f));
  }
  PetscCall(PetscFree(sph->omega));
  PetscCall(PetscFree(sph->group));
  PetscCall(PetscFree(sph->id));
  PetscCall(PetscFree(sph->slot));
  PetscCall(PetscFree(sph->groupstart));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Append(Sph sph, PetscInt n, const PetscReal *x, const PetscReal *v, int group)
{
  PetscFunctionBegin;
  PetscCheck(!sph->setup, sph->comm, PETSC_ERR_ORDER, "markers cannot be added after SphSetUp()");
  PetscCall(Reserve(sph, n));
  for (PetscInt j = 0; j < n; j++) {
    const PetscInt i = sph->n + j;
    for (int k = 0; k < sph->par.dim; k++) {
      PetscCheck(!PetscIsInfOrNanReal(x[3 * j + k]) && !(v && PetscIsInfOrNanReal(v[3 * j + k])), sph->comm,
                 PETSC_ERR_ARG_OUTOFRANGE, "marker %" PetscInt_FMT ": position %g and velocity %g along axis %d must be finite",
                 i, (double)x[3 * j + k], v ? (double)v[3 * j + k] : 0.0, k);
      sph->st.x[k][i] = x[3 * j + k];
      sph->st.v[k][i] = v ? v[3 * j + k] : 0.0;
    }
    sph->group[i] = group;
    sph->id[i] = sph->slot[i] = (int)i;
  }
  sph->n += n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphAppendFluid(Sph sph, PetscInt n, const PetscReal *x, const PetscReal *v, const PetscReal *p, int group)
{
  const PetscInt first = sph->n;

  PetscFunctionBegin;
  PetscCheck(sph->ngroups == 0, sph->comm, PETSC_ERR_ORDER,
             "SphAddFluid(), SphAddOpening() and SphAddReserve() must come before SphAddBoundary()");
  PetscCall(Append(sph, n, x, v, group));
  for (PetscInt j = 0; j < n; j++) sph->st.s[first + j] = p ? p[j] : 0.0; /* turned into a density by SphSetUp() */
  sph->nfluid += n;
  sph->groupstart[0] = sph->n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SphAddFluid - Add n fluid markers at x (n x 3, m) with velocities v (n x 3, m/s, or NULL) and pressures p (n, Pa, or NULL).

  Errors: after SphSetUp(), after SphAddBoundary(), a value that is not finite.
@*/
PetscErrorCode SphAddFluid(Sph sph, PetscInt n, const PetscReal *x, const PetscReal *v, const PetscReal *p)
{
  PetscFunctionBegin;
  PetscCall(SphAppendFluid(sph, n, x, v, p, -1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SphAddBoundary - Add a group of n boundary markers; volume (n, m^3) and depth below the surface (n, m) of each; returns its
number.
@*/
PetscErrorCode SphAddBoundary(Sph sph, PetscInt n, const PetscReal *x, const PetscReal *v, const PetscReal *volume,
                              const PetscReal *depth, PetscInt *group)
{
  const PetscInt first = sph->n;

  PetscFunctionBegin;
  if (sph->ngroups + 2 > sph->groupcap) {
    PetscInt *old = sph->groupstart;
    sph->groupcap = 2 * sph->groupcap + 8;
    PetscCall(PetscMalloc1(sph->groupcap, &sph->groupstart));
    PetscCall(PetscArraycpy(sph->groupstart, old, sph->ngroups + 1));
    PetscCall(PetscFree(old));
  }
  PetscCall(Append(sph, n, x, v, (int)sph->ngroups));
  for (PetscInt j = 0; j < n; j++) {
    PetscCheck(volume[j] > 0.0, sph->comm, PETSC_ERR_ARG_OUTOFRANGE,
               "boundary marker %" PetscInt_FMT ": its volume %g must be > 0", j, (double)volume[j]);
    sph->m[first + j] = volume[j]; /* turned into a mass by SphSetUp() */
    sph->wallratio[first + j] = depth ? depth[j] : 0.0;
  }
  *group = sph->ngroups++;
  sph->groupstart[sph->ngroups] = sph->n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SphSetGroupSlip - Slip along the markers of one boundary group.
@*/
PetscErrorCode SphSetGroupSlip(Sph sph, PetscInt group, SphSlipType slip)
{
  PetscFunctionBegin;
  PetscCheck(!sph->setup, sph->comm, PETSC_ERR_ORDER, "the slip of a group cannot change after SphSetUp()");
  PetscCheck(group >= 0 && group < sph->ngroups, sph->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "boundary group %" PetscInt_FMT ": must be in [0, %" PetscInt_FMT ")", group, sph->ngroups);
  PetscCheck(slip == SPH_SLIP_NONE || sph->par.wall == SPH_WALL_ADAMI, sph->comm, PETSC_ERR_ARG_INCOMP,
             "free slip needs sph_wall adami, it is %s", SphWallTypes[sph->par.wall]);
  for (PetscInt i = sph->groupstart[group]; i < sph->groupstart[group + 1] && slip == SPH_SLIP_FREE; i++)
    sph->wallratio[i] = SPH_WALLRATIO_SLIP;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphGetCounts(Sph sph, PetscInt *fluid, PetscInt *boundary, PetscInt *left)
{
  PetscFunctionBegin;
  if (fluid) *fluid = sph->nfluid;
  if (boundary) *boundary = sph->n - sph->nfluid;
  if (left) *left = sph->left;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphGetFields(Sph sph, const SphFields *f)
{
  const SphParams *p = &sph->par;

  PetscFunctionBegin;
  PetscCall((*sph->ops->pull)(sph));
#pragma omp parallel for schedule(static)
  for (PetscInt id = 0; id < sph->n; id++) {
    const int i = sph->slot[id];
    for (int k = 0; k < 3; k++) {
      if (f->x) f->x[3 * id + k] = sph->st.x[k][i];
      if (f->v) f->v[3 * id + k] = sph->st.v[k][i];
      if (f->a) f->a[3 * id + k] = SphValue(&sph->rate.a[k], i);
    }
    if (f->rho) f->rho[id] = p->rho0 * (1.0 + sph->st.s[i]);
    if (f->p) f->p[id] = sph_eos(sph->st.s[i], p->B, p->gamma) + p->pb;
    if (f->group) f->group[id] = sph->group[i];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSetFields(Sph sph, const SphFields *f)
{
  PetscFunctionBegin;
  PetscCheck(!sph->insidestep, sph->comm, PETSC_ERR_ORDER, "SphSetFields() was called inside a step");
  PetscCall((*sph->ops->pull)(sph));
  for (PetscInt id = 0; id < sph->n; id++) {
    const int i = sph->slot[id];
    for (int k = 0; k < sph->par.dim; k++) {
      if (f->x) sph->st.x[k][i] = f->x[3 * id + k];
      if (f->v) sph->st.v[k][i] = f->v[3 * id + k];
    }
    if (f->rho) sph->st.s[i] = f->rho[id] / sph->par.rho0 - 1.0;
  }
  sph->verletstep = 0;
  PetscCall((*sph->ops->push)(sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Specific internal energy relative to rho0 (J/kg): integral of p/rho^2 d rho, p of Eq. 7 and the background pressure. */
static double InternalEnergy(const SphParams *p, double s)
{
  const double r = 1.0 + s, background = p->pb / p->rho0 * s / r;
  if (p->gamma == 1.0) return background + p->B / p->rho0 * (log1p(s) + 1.0 / r - 1.0);
  return background + p->B / p->rho0 * (expm1((p->gamma - 1.0) * log1p(s)) / (p->gamma - 1.0) - s / r);
}

PetscErrorCode SphGetSums(Sph sph, SphSums *out)
{
  const SphParams *p = &sph->par;
  SphSums t = {0};

  PetscFunctionBegin;
  PetscCall((*sph->ops->pull)(sph));
  for (PetscInt i = 0; i < sph->n; i++) {
    double v2 = 0.0, fx = 0.0;
    if (sph->group[i] != -1) continue;
    for (int k = 0; k < p->dim; k++) {
      v2 += sph->st.v[k][i] * sph->st.v[k][i];
      fx += p->f[k] * sph->st.x[k][i];
      t.momentum[k] += sph->m[i] * sph->st.v[k][i];
    }
    t.mass += sph->m[i];
    t.kinetic += 0.5 * sph->m[i] * v2;
    t.potential -= sph->m[i] * fx;
    t.internal += sph->m[i] * InternalEnergy(p, sph->st.s[i]);
    t.vmax = PetscMax(t.vmax, v2);
    t.compression = PetscMax(t.compression, fabs(sph->st.s[i]));
  }
  t.vmax = sqrt(t.vmax);
  *out = t;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphGetWork(Sph sph, PetscReal *bytes, PetscReal *evaluations)
{
  double **doubles[SPH_NDOUBLES];
  SphValues *rates[SPH_NRATES];
  size_t each = 3 * sizeof(int);

  PetscFunctionBegin;
  ListArrays(sph, doubles, rates);
  for (int k = 0; k < SPH_NDOUBLES; k++) each += *doubles[k] ? sizeof(double) : 0;
  for (int k = 0; k < SPH_NRATES; k++) each += rates[k]->d ? sizeof(double) : (rates[k]->f ? sizeof(float) : 0);
  if (bytes) *bytes = (PetscReal)sph->cap * (PetscReal)each + sph->backendbytes;
  if (bytes && sph->omega) *bytes += 3.0 * sizeof(double) * (PetscReal)(sph->n - sph->nfluid);
  if (evaluations) *evaluations = sph->evaluations;
  PetscFunctionReturn(PETSC_SUCCESS);
}
