/*
  sphopen.c - openings: what their zones prescribe, and which markers come in and go out.

  A zone marker takes what it does not prescribe from a linear fit to the fluid at its mirror image in the opening, as Tafuni et
  al. (2018), Sect. 3. Velocity given: the fit's pressure is continued to the marker, p_o = p_g + (x_o - x_g) . grad p_g. Pressure
  given: p_o = 2 p - p_g, so that the pressure in the opening is the one given and its gradient that of the fluid; the velocity is
  that of the mirror image (no normal gradient), without the part along the opening where fluid comes in, and with the normal part
  off by (p - p_f)/(rho c_s), p_f the fit's pressure in the opening: the Riemann invariant that leaves the fluid is kept
  (Lastiwka, Basa, Quinlan, Int. J. Numer. Meth. Fluids 61 (2009)), else pressures would jump in the opening.
*/
#include <math.h>
typedef double sphreal;
#include "sphimpl.h"
#include "sphopenimpl.h"
#include "sphpair.h"

const char *const SphOpeningTypes[] = {"inflow", "outflow", "SphOpeningType", "SPH_", NULL};
const char *const SphOpeningGivens[] = {"velocity", "pressure", "SphOpeningGiven", "SPH_OPENING_", NULL};
const char *const SphOpeningProfiles[] = {"uniform", "parabolic", "SphOpeningProfile", "SPH_PROFILE_", NULL};

PetscErrorCode SphOpeningSpecInit(SphOpeningSpec *spec)
{
  PetscFunctionBegin;
  PetscCall(PetscMemzero(spec, sizeof(*spec)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MakeOpenings(Sph sph)
{
  PetscFunctionBegin;
  if (!sph->openings) PetscCall(PetscNew(&sph->openings));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Values of an opening and of its table. */
static PetscErrorCode CheckValues(Sph sph, const SphOpeningSpec *spec)
{
  const PetscBool speed = spec->given == SPH_OPENING_VELOCITY ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBegin;
  PetscCheck(spec->n >= 0 && (!spec->n || (spec->t && spec->values)), sph->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "opening '%s': a table of %" PetscInt_FMT " entries", spec->name, spec->n);
  for (PetscInt i = -1; i < spec->n; i++) {
    const PetscReal value = i < 0 ? spec->value : spec->values[i];
    PetscCheck(!PetscIsInfOrNanReal(value) && (!speed || value >= 0.0), sph->comm, PETSC_ERR_ARG_OUTOFRANGE,
               "opening '%s': %s %g; must be %s", spec->name, speed ? "speed (m/s)" : "pressure (Pa)", (double)value,
               speed ? "0 or more: type inflow or outflow says which way" : "finite");
    PetscCheck(i < 0 || (!PetscIsInfOrNanReal(spec->t[i]) && (i == 0 || spec->t[i] > spec->t[i - 1])), sph->comm,
               PETSC_ERR_ARG_OUTOFRANGE, "opening '%s': time %" PetscInt_FMT " of the table is %g s; times must increase",
               spec->name, i, i < 0 ? 0.0 : (double)spec->t[i]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SphAddOpening - An opening with its buffer zone and the n markers (x: n x 3, m; p: n, Pa) that it holds at first.

  Errors: values out of range, overlap with another opening, after SphAddBoundary().
@*/
PetscErrorCode SphAddOpening(Sph sph, const SphOpeningSpec *spec, PetscInt n, const PetscReal *x, const PetscReal *p,
                             PetscInt *opening)
{
  SphOpenings *all;
  SphOpening o, *list;

  PetscFunctionBegin;
  PetscCall(CheckValues(sph, spec));
  PetscCall(SphOpeningFrame(sph, spec, &o));
  PetscCall(MakeOpenings(sph));
  all = sph->openings;
  for (PetscInt k = 0; k < all->n; k++)
    PetscCheck(!SphOpeningsOverlap(&o, &all->opening[k], 1e-3 * sph->par.dp), sph->comm, PETSC_ERR_ARG_INCOMP,
               "openings '%s' and '%s' overlap: their zones reach %g m behind them", spec->name, all->opening[k].spec.name,
               o.depth);
  PetscCall(SphAppendFluid(sph, n, x, NULL, p, SPH_ZONE((int)all->n)));
  PetscCall(PetscMalloc1(all->n + 1, &list));
  PetscCall(PetscArraycpy(list, all->opening, all->n));
  PetscCall(PetscFree(all->opening));
  all->opening = list;
  if (spec->n) {
    PetscReal *t, *values;
    PetscCall(PetscMalloc1(spec->n, &t));
    PetscCall(PetscMalloc1(spec->n, &values));
    PetscCall(PetscArraycpy(t, spec->t, spec->n));
    PetscCall(PetscArraycpy(values, spec->values, spec->n));
    o.spec.t = t;
    o.spec.values = values;
  }
  list[all->n] = o;
  if (opening) *opening = all->n;
  all->n++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SphAddReserve - n markers of group -2 that openings may bring in.
@*/
PetscErrorCode SphAddReserve(Sph sph, PetscInt n)
{
  PetscReal *x;

  PetscFunctionBegin;
  PetscCheck(n >= 0, sph->comm, PETSC_ERR_ARG_OUTOFRANGE, "reserve of %" PetscInt_FMT " markers: must be >= 0", n);
  PetscCall(MakeOpenings(sph));
  PetscCall(PetscMalloc1(3 * (size_t)n, &x));
  for (PetscInt i = 0; i < 3 * n; i++) x[i] = sph->par.lo[i % 3];
  PetscCall(SphAppendFluid(sph, n, x, NULL, NULL, -2));
  PetscCall(PetscFree(x));
  sph->openings->idle += n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphGetNumOpenings(Sph sph, PetscInt *n)
{
  *n = sph->openings ? sph->openings->n : 0;
  return PETSC_SUCCESS;
}

PetscErrorCode SphGetFlow(Sph sph, PetscInt opening, SphFlow *flow)
{
  PetscFunctionBegin;
  PetscCheck(sph->openings && opening >= 0 && opening < sph->openings->n, sph->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "opening %" PetscInt_FMT ": must be in [0, %" PetscInt_FMT ")", opening, sph->openings ? sph->openings->n : 0);
  *flow = sph->openings->opening[opening].flow;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphInOpening(Sph sph, const PetscReal x[3], PetscBool *inside)
{
  double c[3];

  PetscFunctionBegin;
  *inside = PETSC_FALSE;
  for (PetscInt k = 0; sph->openings && k < sph->openings->n; k++) {
    SphOpeningCoordinates(&sph->openings->opening[k], x, c);
    if (SphOpeningHolds(&sph->openings->opening[k], c, 0.0)) *inside = PETSC_TRUE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What is not there with openings is refused. */
PetscErrorCode SphOpeningsCheck(Sph sph)
{
  PetscFunctionBegin;
  if (!sph->openings || !sph->openings->n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(sph->ops->fit, sph->comm, PETSC_ERR_SUP, "opening '%s': the %s backend has no openings; use sph_type cpu",
             sph->openings->opening[0].spec.name, sph->type);
  PetscCheck(sph->par.integrator != SPH_INTEGRATOR_VERLET, sph->comm, PETSC_ERR_SUP,
             "opening '%s': sph_integrator verlet has no openings; use rk2 or symplectic", sph->openings->opening[0].spec.name);
  PetscCheck(sph->par.gradient == SPH_GRADIENT_NONE, sph->comm, PETSC_ERR_SUP,
             "opening '%s': sph_gradient_correction %s has no openings; use none", sph->openings->opening[0].spec.name,
             SphGradientTypes[sph->par.gradient]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A boundary marker that is `margin` (m) deep inside a zone. */
static PetscErrorCode Obstructed(Sph sph, PetscInt i, PetscInt k)
{
  const SphOpening *o = &sph->openings->opening[k];

  PetscFunctionBegin;
  SETERRQ(sph->comm, PETSC_ERR_ARG_INCOMP,
          "opening '%s': marker (%g, %g, %g) m of boundary group %d lies in its zone, %g m deep, at t = %g s: walls and bodies "
          "must stay out of it",
          o->spec.name, sph->st.x[0][i], sph->st.x[1][i], sph->st.x[2][i], sph->group[i], o->depth, (double)sph->t);
}

PetscErrorCode SphOpeningsSetUp(Sph sph)
{
  SphOpenings *all = sph->openings;
  double x[3], c[3];

  PetscFunctionBegin;
  if (!all) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1(sph->n, &all->event));
  for (PetscInt k = 0; k < all->n; k++)
    for (PetscInt i = 0; i < sph->n; i++) {
      if (sph->group[i] < 0) continue;
      for (int d = 0; d < 3; d++) x[d] = sph->st.x[d][i];
      SphOpeningCoordinates(&all->opening[k], x, c);
      if (SphOpeningHolds(&all->opening[k], c, 0.25 * sph->par.dp)) PetscCall(Obstructed(sph, i, k));
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Linear between the entries of the table, constant before and after. */
static double ValueAt(const SphOpeningSpec *spec, PetscReal t)
{
  PetscInt i = 0;

  if (!spec->n) return spec->value;
  while (i + 1 < spec->n && spec->t[i + 1] <= t) i++;
  if (i + 1 == spec->n || t <= spec->t[i]) return spec->values[i];
  return spec->values[i] + (t - spec->t[i]) / (spec->t[i + 1] - spec->t[i]) * (spec->values[i + 1] - spec->values[i]);
}

/* The parabola with the mean 1. */
static double Profile(const SphOpening *o, const double c[3])
{
  double factor = 1.0;

  for (int e = 0; e < 2 && o->spec.profile == SPH_PROFILE_PARABOLIC; e++) {
    const double s = o->length[e] > 0.0 ? c[e] / o->length[e] : 0.0;
    if (o->length[e] > 0.0 && !o->spec.across[e]) factor *= s > 0.0 && s < 1.0 ? 6.0 * s * (1.0 - s) : 0.0;
  }
  return factor;
}

/* Slots of all zone markers, and for each the mirror image and the offset of what the fit is to give. */
static PetscErrorCode Collect(Sph sph)
{
  SphOpenings *all = sph->openings;

  PetscFunctionBegin;
  all->nzone = 0;
  for (PetscInt i = 0; i < sph->n; i++) all->nzone += SphIsZone(sph->group[i]);
  if (all->nzone > all->cap) {
    all->cap = all->nzone + all->nzone / 4 + 16;
    PetscCall(PetscFree(all->zone));
    if (all->at) PetscCall(PetscFree3(all->at, all->offset, all->value));
    PetscCall(PetscMalloc1(all->cap, &all->zone));
    PetscCall(
        PetscMalloc3(3 * (size_t)all->cap, &all->at, 3 * (size_t)all->cap, &all->offset, 10 * (size_t)all->cap, &all->value));
  }
  all->nzone = 0;
  for (PetscInt i = 0; i < sph->n; i++) {
    if (!SphIsZone(sph->group[i])) continue;
    const SphOpening *o = &all->opening[SPH_ZONE(sph->group[i])];
    const double x[3] = {sph->st.x[0][i], sph->st.x[1][i], sph->st.x[2][i]};
    double c[3];
    SphOpeningCoordinates(o, x, c);
    for (int k = 0; k < 3; k++) {
      all->at[3 * all->nzone + k] = x[k] - 2.0 * c[2] * o->normal[k];
      all->offset[3 * all->nzone + k] = (o->spec.given == SPH_OPENING_VELOCITY ? 2.0 : 1.0) * c[2] * o->normal[k];
    }
    all->zone[all->nzone++] = (int)i;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Velocity and density of zone marker i from the fits' vx, vy, vz, p; fluid 0: none is near. own: the fit to the zone itself,
  where the marker is; part: of the change that is made now.
*/
static void Prescribe(Sph sph, const SphOpening *o, int i, const double value[10], const double own[3], double part, double now,
                      int fluid)
{
  const SphParams *p = &sph->par;
  const double x[3] = {sph->st.x[0][i], sph->st.x[1][i], sph->st.x[2][i]};
  double c[3], pressure, vn = 0.0, vo = 0.0, change;

  SphOpeningCoordinates(o, x, c);
  if (o->spec.given == SPH_OPENING_VELOCITY) {
    const double speed = (o->spec.type == SPH_INFLOW ? 1.0 : -1.0) * now * Profile(o, c);
    for (int k = 0; k < 3; k++) sph->st.v[k][i] = speed * o->normal[k];
    pressure = fluid ? value[8] : 0.0;
  } else {
    for (int k = 0; k < 3; k++) {
      now += o->spec.gradient[k] * (x[k] - c[2] * o->normal[k] - o->spec.corner[k]);
      vn += value[k] * o->normal[k];
      vo += own[k] * o->normal[k];
    }
    change = part * (vn - vo + (now - value[8]) / (p->rho0 * p->cs));
    vo = sph->st.v[0][i] * o->normal[0] + sph->st.v[1][i] * o->normal[1] + sph->st.v[2][i] * o->normal[2];
    for (int k = 0; k < 3 && fluid; k++)
      sph->st.v[k][i] = (vn < 0.0 ? value[k] - vn * o->normal[k] : 0.0) + (vo + change) * o->normal[k];
    pressure = fluid ? 2.0 * now - value[3] : now;
  }
  sph->st.s[i] = sph_eos_inverse(PetscMax(pressure - p->pb, -0.5 * p->B), p->B, p->gamma);
}

PetscErrorCode SphOpeningsApply(Sph sph, PetscReal t, PetscReal dt)
{
  const double part = dt > 0.0 ? PetscMin(1.0, dt * sph->par.cs / sph->par.h) : 1.0;
  SphOpenings *all = sph->openings;
  double *now, *own, *x;
  int *fluid, *group, *near;

  PetscFunctionBegin;
  if (!all || !all->n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscLogEventBegin(SPH_Open, 0, 0, 0, 0));
  PetscCall(Collect(sph));
  PetscCall(PetscMalloc6(all->nzone, &fluid, all->n, &now, 10 * (size_t)all->nzone, &own, 3 * (size_t)all->nzone, &x, all->nzone,
                         &group, all->nzone, &near));
  for (PetscInt j = 0; j < all->nzone; j++) {
    group[j] = sph->group[all->zone[j]];
    if (all->opening[SPH_ZONE(group[j])].spec.given == SPH_OPENING_VELOCITY) group[j] = -2; /* not needed */
    for (int k = 0; k < 3; k++) x[3 * j + k] = sph->st.x[k][all->zone[j]];
  }
  PetscCall((*sph->ops->fit)(sph, all->nzone, all->at, all->offset, NULL, all->value, fluid));
  PetscCall((*sph->ops->fit)(sph, all->nzone, x, all->offset, group, own, near));
  for (PetscInt k = 0; k < all->n; k++) now[k] = ValueAt(&all->opening[k].spec, t);
  for (PetscInt j = 0; j < all->nzone; j++) {
    const int i = all->zone[j], k = SPH_ZONE(sph->group[i]);
    Prescribe(sph, &all->opening[k], i, all->value + 10 * j, own + 10 * j, part, now[k], fluid[j]);
  }
  PetscCall(PetscFree6(fluid, now, own, x, group, near));
  PetscCall(PetscLogEventEnd(SPH_Open, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* By action and reaction the force on the zone's markers by all others is what they exert on those that are not of a zone. */
PetscErrorCode SphOpeningsForce(Sph sph, PetscReal dt)
{
  SphOpenings *all = sph->openings;

  PetscFunctionBegin;
  if (!all || !all->n) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt j = 0; j < all->nzone; j++) {
    const int i = all->zone[j];
    for (int k = 0; k < 3; k++)
      all->opening[SPH_ZONE(sph->group[i])].flow.impulse[k] -= dt * sph->m[i] * SphValue(&sph->rate.a[k], i);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

enum { EVENT_NONE, EVENT_ENTERS, EVENT_GOES, EVENT_OBSTRUCTS, EVENT_LEAVES }; /* EVENT_LEAVES + k: into zone k */

/* What marker i does at the end of a step. */
static int EventOf(Sph sph, PetscInt i)
{
  const SphOpenings *all = sph->openings;
  const double x[3] = {sph->st.x[0][i], sph->st.x[1][i], sph->st.x[2][i]}, slack = 0.5 * sph->par.dp;
  const int group = sph->group[i];
  double c[3];

  if (group == -2) return EVENT_NONE;
  if (SphIsZone(group)) {
    const SphOpening *o = &all->opening[SPH_ZONE(group)];
    SphOpeningCoordinates(o, x, c);
    if (c[2] >= 0.0) return EVENT_ENTERS;
    return SphOpeningHolds(o, c, -slack) && c[2] >= -o->depth ? EVENT_NONE : EVENT_GOES;
  }
  for (PetscInt k = 0; k < all->n; k++) {
    const SphOpening *o = &all->opening[k];
    SphOpeningCoordinates(o, x, c);
    if (group >= 0) {
      if (SphOpeningHolds(o, c, slack)) return EVENT_OBSTRUCTS;
    } else if (c[2] < 0.0 && SphOpeningHolds(o, c, -slack))
      return EVENT_LEAVES + (int)k;
  }
  return EVENT_NONE;
}

/* Marker i is no more. */
static void TakeOut(Sph sph, PetscInt i)
{
  sph->group[i] = -2;
  for (int d = 0; d < 3; d++) {
    sph->st.v[d][i] = 0.0;
    SphSetValue(&sph->rate.a[d], i, 0.0);
    SphSetValue(&sph->rate.dv[d], i, 0.0);
  }
  SphSetValue(&sph->rate.ds, i, 0.0);
  sph->openings->idle++;
}

/* A marker of the reserve takes the place one depth behind marker i, which has just come in; free: where to look on. */
static PetscErrorCode Follow(Sph sph, PetscInt k, PetscInt i, PetscInt *free)
{
  const SphOpening *o = &sph->openings->opening[k];
  PetscInt j = *free;

  PetscFunctionBegin;
  while (j >= 0 && sph->group[j] != -2) j--;
  PetscCheck(j >= 0, sph->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "opening '%s': no marker is left in the reserve at step %" PetscInt_FMT ", time %g s, of %" PetscInt_FMT
             " fluid markers in all: a larger openings_reserve is needed",
             o->spec.name, sph->step, (double)sph->t, sph->nfluid);
  *free = j;
  sph->group[j] = SPH_ZONE((int)k);
  for (int d = 0; d < 3; d++) {
    sph->st.x[d][j] = sph->st.x[d][i] - (d < sph->par.dim ? o->depth * o->normal[d] : 0.0);
    sph->st.v[d][j] = sph->st.v[d][i];
  }
  sph->st.s[j] = sph->st.s[i];
  sph->m[j] = sph->par.rho0 * (1.0 + sph->st.s[i]) * o->volume;
  sph->openings->idle--;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Count marker i in (way 1) or out (-1) of the fluid. */
static void Count(Sph sph, PetscInt k, PetscInt i, int way)
{
  SphFlow *f = &sph->openings->opening[k].flow;

  if (way > 0) {
    f->in += 1.0;
    f->massin += sph->m[i];
  } else {
    f->out += 1.0;
    f->massout += sph->m[i];
  }
  for (int d = 0; d < sph->par.dim; d++) f->momentum[d] += way * sph->m[i] * sph->st.v[d][i];
}

/* Said when more than a layer of markers has gone against the type of the opening. */
static PetscErrorCode WarnBackFlow(Sph sph, SphOpening *o)
{
  const PetscReal against = o->spec.type == SPH_INFLOW ? o->flow.out : o->flow.in;

  PetscFunctionBegin;
  if (o->warned || against <= (PetscReal)(o->sites[0] * o->sites[1])) PetscFunctionReturn(PETSC_SUCCESS);
  o->warned = PETSC_TRUE;
  PetscCall(PetscFPrintf(sph->comm, PETSC_STDERR,
                         "frond: warning: back flow through opening '%s' (%s): more than a layer of markers, %d, by step "
                         "%" PetscInt_FMT ", time %g s; said once\n",
                         o->spec.name, SphOpeningTypes[o->spec.type], (int)against, sph->step, (double)sph->t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphOpeningsExchange(Sph sph)
{
  SphOpenings *all = sph->openings;
  PetscInt events = 0, moved = 0, free = sph->n - 1;

  PetscFunctionBegin;
  if (!all || !all->n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscLogEventBegin(SPH_Open, 0, 0, 0, 0));
#pragma omp parallel for schedule(static) reduction(+ : events)
  for (PetscInt i = 0; i < sph->n; i++) {
    all->event[i] = EventOf(sph, i);
    events += all->event[i] != EVENT_NONE;
  }
  for (PetscInt i = 0; i < sph->n && events; i++) {
    const int event = all->event[i];
    if (event == EVENT_NONE) continue;
    if (event == EVENT_OBSTRUCTS) {
      for (PetscInt k = 0; k < all->n; k++) {
        double c[3];
        SphOpeningCoordinates(&all->opening[k], (const double[3]){sph->st.x[0][i], sph->st.x[1][i], sph->st.x[2][i]}, c);
        if (SphOpeningHolds(&all->opening[k], c, 0.5 * sph->par.dp)) PetscCall(Obstructed(sph, i, k));
      }
    } else if (event == EVENT_ENTERS) {
      const PetscInt k = SPH_ZONE(sph->group[i]);
      sph->group[i] = -1;
      Count(sph, k, i, 1);
      PetscCall(Follow(sph, k, i, &free));
      moved++;
    } else if (event == EVENT_GOES) {
      TakeOut(sph, i);
      moved++;
    } else {
      sph->group[i] = SPH_ZONE(event - EVENT_LEAVES);
      Count(sph, event - EVENT_LEAVES, i, -1);
    }
  }
  for (PetscInt k = 0; k < all->n && events; k++) PetscCall(WarnBackFlow(sph, &all->opening[k]));
  if (moved) PetscCall((*sph->ops->push)(sph));
  PetscCall(PetscLogEventEnd(SPH_Open, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphOpeningsView(Sph sph, PetscViewer viewer)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; sph->openings && k < sph->openings->n; k++) {
    const SphOpening *o = &sph->openings->opening[k];
    PetscCall(PetscViewerASCIIPrintf(
        viewer, "  opening '%s': %s, %s %g %s%s%s, corner (%g, %g, %g) m, normal (%g, %g, %g), zone %g m deep\n", o->spec.name,
        SphOpeningTypes[o->spec.type], SphOpeningGivens[o->spec.given], (double)ValueAt(&o->spec, 0.0),
        o->spec.given == SPH_OPENING_VELOCITY ? "m/s " : "Pa",
        o->spec.given == SPH_OPENING_VELOCITY ? SphOpeningProfiles[o->spec.profile] : "", o->spec.n ? " over time" : "",
        (double)o->spec.corner[0], (double)o->spec.corner[1], (double)o->spec.corner[2], o->normal[0], o->normal[1], o->normal[2],
        o->depth));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What has passed so far. */
PetscErrorCode SphOpeningsState(Sph sph, FrondState *s)
{
  SphOpenings *all = sph->openings;
  char name[64];

  PetscFunctionBegin;
  if (!all) PetscFunctionReturn(PETSC_SUCCESS);
  FrondMoveInt(s, "fluid/openings_idle", &all->idle, 1);
  for (PetscInt k = 0; k < all->n; k++) {
    PetscCall(PetscSNPrintf(name, sizeof(name), "fluid/opening_%" PetscInt_FMT "_flow", k));
    FrondMoveReal(s, name, (PetscReal *)&all->opening[k].flow, sizeof(SphFlow) / sizeof(PetscReal));
    PetscCall(PetscSNPrintf(name, sizeof(name), "fluid/opening_%" PetscInt_FMT "_warned", k));
    FrondMoveBool(s, name, &all->opening[k].warned);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphOpeningsDestroy(Sph sph)
{
  SphOpenings *all = sph->openings;

  PetscFunctionBegin;
  if (!all) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < all->n; k++) {
    PetscReal *t = (PetscReal *)(size_t)all->opening[k].spec.t, *values = (PetscReal *)(size_t)all->opening[k].spec.values;
    if (!all->opening[k].spec.n) continue;
    PetscCall(PetscFree(t));
    PetscCall(PetscFree(values));
  }
  PetscCall(PetscFree(all->opening));
  PetscCall(PetscFree(all->zone));
  PetscCall(PetscFree(all->event));
  if (all->at) PetscCall(PetscFree3(all->at, all->offset, all->value));
  PetscCall(PetscFree(sph->openings));
  PetscFunctionReturn(PETSC_SUCCESS);
}
