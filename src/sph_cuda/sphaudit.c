/*
  sphaudit.c - what the pair forces of sphpair.h do to the energy of the fluid, for balances at output steps.

  The force m_a a_ab of a pair does the power m_a a_ab . v_a on fluid marker a. Between fluid markers the two add up to
  m_a a_ab . (v_a - v_b), of which either gets one half; of a pair with a boundary marker, m_a a_ab . v_b is work of the boundary
  (CoupleAudit.power) and the rest, with the boundary's own velocity v_b, is counted here. All in double precision.
*/
#include <math.h>
typedef double sphreal;
#include "sphsearch.h"
#include "sphpair.h"

/* Viscous heat (W) and pressure power (W) of fluid marker j of the search with all its neighbours. */
static void MarkerPower(Sph sph, const SphPairConst *c, const SphSearch *s, PetscInt j, double power[2])
{
  const SphParams *p = &sph->par;
  const PetscReal at[3] = {s->x[0][j], s->x[1][j], s->x[2][j]};
  const double rhoa = p->rho0 * (1.0 + s->s[j]), ma = s->vol[j] * rhoa;
  const double Pa = (sph_eos(s->s[j], p->B, p->gamma) + p->pb) / (rhoa * rhoa);
  SphSearchRange range[27];
  double x[3];
  const int n = SphSearchRanges(sph, s, at, x, range);

  power[0] = power[1] = 0.0;
  for (int o = 0; o < n; o++) {
    for (int b = range[o].first; b < range[o].last; b++) {
      const int fluid = sph->group[s->marker[b]] == -1;
      const double rhob = p->rho0 * (1.0 + s->s[b]), mb = s->vol[b] * rhob;
      const double Pb = (sph_eos(s->s[b], p->B, p->gamma) + p->pb) / (rhob * rhob);
      double r2 = 0.0, vx = 0.0, ux = 0.0, uv = 0.0;
      for (int k = 0; k < p->dim; k++) {
        const double d = x[k] - s->x[k][b] - range[o].shift[k], v = s->v[k][j] - s->v[k][b];
        const double u = fluid ? v : v - SphValue(&sph->rate.dv[k], s->marker[b]); /* extrapolated velocity of a wall */
        r2 += d * d;
        vx += v * d;
        ux += u * d;
        uv += u * v;
      }
      if (r2 >= c->r2max) continue;
      const double F = c->fnorm * sph_f(p->kernel, sqrt(r2) * c->hinv), share = (fluid ? 0.5 : 1.0) * ma;
      power[1] += share * sph_pressure(mb, Pa, Pb, F) * vx;
      if (p->viscosity == SPH_VISCOSITY_ARTIFICIAL)
        power[0] -= share * sph_viscosity_artificial(c, mb, rhoa, rhob, ux, r2, F) * vx;
      else if (p->viscosity == SPH_VISCOSITY_MORRIS)
        power[0] -= share * sph_viscosity_morris(c, mb, rhoa, rhob, r2, F) * uv;
      else
        power[0] -= share * sph_viscosity(c, mb, rhoa, rhob, r2, F) * uv;
    }
  }
}

/* Angular momentum and centre of mass. */
static void Moments(Sph sph, SphAudit *t)
{
  double mass = 0.0;

  for (PetscInt i = 0; i < sph->n; i++) {
    const double m = sph->m[i];
    if (sph->group[i] != -1) continue;
    mass += m;
    for (int k = 0; k < 3; k++) {
      const int a = (k + 1) % 3, b = (k + 2) % 3;
      t->angular[k] += m * (sph->st.x[a][i] * sph->st.v[b][i] - sph->st.x[b][i] * sph->st.v[a][i]);
      t->centre[k] += m * sph->st.x[k][i];
    }
  }
  for (int k = 0; k < 3 && mass > 0.0; k++) t->centre[k] /= mass;
}

/*@
  SphGetAudit - Powers of the pair forces (W) and moments of the fluid now; see SphAudit.
@*/
PetscErrorCode SphGetAudit(Sph sph, SphAudit *out)
{
  const SphPairConst c = sph_pair_const(&sph->par);
  SphAudit t = {0};
  SphSearch search;
  double *power;

  PetscFunctionBegin;
  PetscCheck(sph->setup, sph->comm, PETSC_ERR_ORDER, "SphGetAudit() must come after SphSetUp()");
  PetscCall(PetscLogEventBegin(SPH_Output, 0, 0, 0, 0));
  PetscCall((*sph->ops->pull)(sph));
  PetscCall(SphSearchCreate(sph, NULL, NULL, 1, &search));
  PetscCall(PetscMalloc1(2 * (size_t)PetscMax(1, search.n), &power));
#pragma omp parallel for schedule(dynamic, 64)
  for (PetscInt j = 0; j < search.n; j++) {
    power[2 * j] = power[2 * j + 1] = 0.0;
    if (sph->group[search.marker[j]] == -1) MarkerPower(sph, &c, &search, j, power + 2 * j);
  }
  for (PetscInt j = 0; j < search.n; j++) { /* in order: the same bits for any number of threads */
    t.viscous += power[2 * j];
    t.pressure += power[2 * j + 1];
  }
  Moments(sph, &t);
  PetscCall(PetscFree(power));
  PetscCall(SphSearchDestroy(&search));
  PetscCall(PetscLogEventEnd(SPH_Output, 0, 0, 0, 0));
  *out = t;
  PetscFunctionReturn(PETSC_SUCCESS);
}
