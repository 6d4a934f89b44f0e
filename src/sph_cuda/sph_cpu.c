/*
  sph_cpu.c - the CPU backend: when to rebuild the search structure, the sweeps of one right-hand side, the stages of a step.

  Positions and densities move with the XSPH velocity, Eq. 10, velocities with Eq. 5; the time integrators are in sphstep.h.
*/
#include "sph_cpu.h"
#include "sphopenimpl.h"
#include <math.h>
#include <omp.h>
typedef double sphreal;
#include "sphstep.h"

/* Cells are 5 % larger than the support, so that they serve until a marker has moved half of that. */
#define SPH_SKIN 0.05

static PetscErrorCode SetUp_CPU(Sph sph)
{
  const size_t real = sph->par.precision == SPH_PRECISION_SINGLE ? sizeof(float) : sizeof(double);
  SphCpu *cpu;

  PetscFunctionBegin;
  PetscCall(PetscNew(&cpu));
  cpu->skin = SPH_SKIN;
  cpu->threads = omp_get_max_threads();
  cpu->stride = (sph->n + 31) / 16 * 16;
  cpu->nq = SPH_NQ_BASE + (SphTwoVelocities(&sph->par) ? 3 : 0) + (sph->par.diffusion != SPH_DIFFUSION_NONE);
  PetscCall(PetscMalloc((size_t)cpu->stride * (size_t)cpu->nq * real, &cpu->q)); /* also the workspace of the sort */
  PetscCall(PetscCalloc1(PetscMax(1, sph->ngroups), &cpu->gmoved));
  sph->data = cpu;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy_CPU(Sph sph)
{
  SphCpu *cpu = (SphCpu *)sph->data;

  PetscFunctionBegin;
  if (!cpu) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree(cpu->gmoved));
  PetscCall(PetscFree(cpu->cellstart));
  PetscCall(PetscFree(cpu->firstbox));
  PetscCall(PetscFree(cpu->q));
  PetscCall(PetscFree(cpu->lists));
  PetscCall(PetscFree(cpu->boxes));
  PetscCall(PetscFree(sph->data));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Bound on the displacement of any marker since the last build, m; HUGE when there is none. Non-finite positions count as far. */
static double MaxMoved(Sph sph, const SphCpu *cpu)
{
  double m = cpu->moved;
  if (!cpu->built) return HUGE_VAL;
  for (PetscInt g = 0; g < sph->ngroups; g++) m = PetscMax(m, cpu->gmoved[g]);
  return m;
}

/* Fluid markers beyond the walls' outer side or an open side are frozen, taken out of all sums and counted. */
static void TakeOutLeft(Sph sph)
{
  const SphParams *p = &sph->par;
  const double margin = 2.0 * p->h + p->dp;
  PetscInt left = 0;
#pragma omp parallel for schedule(static) reduction(+ : left)
  for (PetscInt i = 0; i < sph->n; i++) {
    if (sph->group[i] != -1) continue;
    for (int k = 0; k < p->dim; k++) {
      if (p->periodic[k]) continue;
      if (sph->st.x[k][i] < p->lo[k] - margin || sph->st.x[k][i] > p->hi[k] + margin) {
        sph->group[i] = -2;
        for (int d = 0; d < 3; d++) {
          sph->st.v[d][i] = 0.0;
          SphSetValue(&sph->rate.a[d], i, 0.0);
          SphSetValue(&sph->rate.dv[d], i, 0.0);
        }
        SphSetValue(&sph->rate.ds, i, 0.0);
        left++;
        break;
      }
    }
  }
  sph->left += left;
}

/* The batches of all ranges, numbered one after the other, and room for their boxes. */
static PetscErrorCode NumberBatches(Sph sph, SphCpu *cpu)
{
  const size_t real = sph->par.precision == SPH_PRECISION_SINGLE ? sizeof(float) : sizeof(double);
  const PetscInt ranges = 2 * (PetscInt)cpu->grid.n[0] * cpu->grid.n[1] * cpu->grid.n[2];
  PetscInt n = 0;

  PetscFunctionBegin;
  PetscCall(PetscFree(cpu->firstbox));
  PetscCall(PetscMalloc1(ranges, &cpu->firstbox));
  for (PetscInt r = 0; r < ranges; r++) {
    cpu->firstbox[r] = (int)n;
    n += (cpu->cellstart[r + 1] - cpu->cellstart[r] + SPH_BATCH - 1) / SPH_BATCH;
  }
  if (n > cpu->boxcap) {
    cpu->boxcap = n + n / 16;
    PetscCall(PetscFree(cpu->boxes));
    PetscCall(PetscMalloc(6 * (size_t)cpu->boxcap * real, &cpu->boxes));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Room for each thread's list and batches, and for the boxes of all batches. */
static PetscErrorCode SizeLists(Sph sph, SphCpu *cpu)
{
  const size_t real = sph->par.precision == SPH_PRECISION_SINGLE ? sizeof(float) : sizeof(double);
  const PetscInt ncell = (PetscInt)cpu->grid.n[0] * cpu->grid.n[1] * cpu->grid.n[2], around = sph->par.dim == 3 ? 27 : 9;
  PetscInt most = 0;

  PetscFunctionBegin;
#pragma omp parallel for schedule(static) reduction(max : most)
  for (PetscInt c = 0; c < ncell; c++) most = PetscMax(most, cpu->cellstart[2 * c + 2] - cpu->cellstart[2 * c]);
  if (around * most + 32 > cpu->listcap) {
    most += most / 4;
    cpu->listcap = (around * most + 47) / 16 * 16;
    cpu->batchcap = (around * (most / 16 + 2) + 31) / 16 * 16;
    cpu->listbytes = (size_t)cpu->listcap * SPH_NQ_MAX * real + (size_t)cpu->batchcap * (9 * real + 3 * sizeof(int)) + 128;
    cpu->listbytes = cpu->listbytes / 64 * 64;
    PetscCall(PetscFree(cpu->lists));
    PetscCall(PetscMalloc(cpu->listbytes * (size_t)cpu->threads + 64, &cpu->lists));
  }
  PetscCall(NumberBatches(sph, cpu));
  sph->backendbytes = (PetscReal)((size_t)cpu->stride * (size_t)cpu->nq * real + cpu->listbytes * (size_t)cpu->threads +
                                  ((size_t)cpu->cellcap + 2 * (size_t)ncell) * sizeof(int) + 6 * (size_t)cpu->boxcap * real);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Build_CPU(Sph sph)
{
  SphCpu *cpu = (SphCpu *)sph->data;
  const double allowed = 0.5 * cpu->skin * 2.0 * sph->par.h * 0.5; /* half: the other half is for the motion within the step */

  PetscFunctionBegin;
  if (MaxMoved(sph, cpu) <= allowed) PetscFunctionReturn(PETSC_SUCCESS);
  if (cpu->built) PetscCall(SphCheckFinite(sph));
  TakeOutLeft(sph);
  PetscCall(SphGridSetUp(sph, cpu->skin, &cpu->grid));
  PetscCall(SphSortMarkers(sph, &cpu->grid, &cpu->cellstart, &cpu->cellcap, cpu->q));
  PetscCall(SizeLists(sph, cpu));
  cpu->moved = 0.0;
  PetscCall(PetscArrayzero(cpu->gmoved, PetscMax(1, sph->ngroups)));
  if (!cpu->built && !sph->step) PetscCall(SphCheckOverlap(sph, &cpu->grid, cpu->cellstart));
  cpu->built = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void Prepare(Sph sph, int afteraux)
{
  if (sph->par.precision == SPH_PRECISION_SINGLE)
    SphCpuPrepare_single(sph, afteraux);
  else
    SphCpuPrepare_double(sph, afteraux);
}

static void Sweep(Sph sph, SphSweep sweep)
{
  if (sph->par.precision == SPH_PRECISION_SINGLE)
    SphCpuSweep_single(sph, sweep);
  else
    SphCpuSweep_double(sph, sweep);
}

static PetscErrorCode Rates_CPU(Sph sph)
{
  PetscFunctionBegin;
  PetscCall(PetscLogEventBegin(SPH_Aux, 0, 0, 0, 0));
  Prepare(sph, 0);
  if (SphTwoVelocities(&sph->par)) {
    Sweep(sph, SPH_SWEEP_AUX);
    Prepare(sph, 1);
  }
  PetscCall(PetscLogEventEnd(SPH_Aux, 0, 0, 0, 0));
  PetscCall(PetscLogEventBegin(SPH_Rates, 0, 0, 0, 0));
  Sweep(sph, SPH_SWEEP_RATES);
  if (sph->par.gradient != SPH_GRADIENT_NONE) Sweep(sph, SPH_SWEEP_CORRECT);
  if (sph->par.shifting != SPH_SHIFTING_NONE) Sweep(sph, SPH_SWEEP_SHIFT);
  PetscCall(PetscLogEventEnd(SPH_Rates, 0, 0, 0, 0));
  sph->evaluations += (PetscReal)(sph->n - sph->left - (sph->openings ? sph->openings->idle : 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

typedef enum { STAGE_HALF, STAGE_RK2, STAGE_SYMPLECTIC, STAGE_VERLET } Stage;

/*
  Zone marker i of an opening: moves with its velocity, keeps it and its density. Returns the squared displacement so far, m^2.
*/
SPH_INLINE double MoveZone(Sph sph, const Stage stage, PetscInt i, double dt)
{
  double r2 = 0.0;

  for (int k = 0; k < sph->par.dim; k++) {
    double *x = &sph->st.x[k][i], *xn = &sph->stn.x[k][i];
    if (stage == STAGE_HALF) *xn = *x;
    *x = *xn + (stage == STAGE_HALF ? 0.5 : 1.0) * dt * sph->st.v[k][i];
    r2 += (*x - *xn) * (*x - *xn);
  }
  return r2;
}

/*
  One stage of sphstep.h for every marker; boundaries keep their motion, and their density unless it is evolved. Returns the
  largest squared displacement of a fluid marker over the step, m^2.
*/
SPH_INLINE double MoveStage(Sph sph, const Stage stage, double dt)
{
  const SphParams *p = &sph->par;
  const int evolve = p->wall == SPH_WALL_BCE;
  double far2 = 0.0;
#pragma omp parallel for schedule(static) reduction(max : far2)
  for (PetscInt i = 0; i < sph->n; i++) {
    const int fluid = sph->group[i] == -1;
    double r2 = 0.0;
    SphStepMarker m;
    if (SphIsZone(sph->group[i])) {
      r2 = MoveZone(sph, stage, i, dt);
      far2 = PetscMax(far2, r2);
      continue;
    }
    if (!fluid && !(evolve && sph->group[i] >= 0)) continue;
    for (int k = 0; k < 3; k++) {
      m.x[k] = sph->st.x[k][i];
      m.v[k] = sph->st.v[k][i];
      m.xn[k] = stage == STAGE_VERLET ? m.x[k] : sph->stn.x[k][i];
      m.vn[k] = sph->stn.v[k][i];
      m.acc[k] = k < p->dim ? SphValue(&sph->rate.a[k], i) + p->f[k] : 0.0;
      m.dv[k] = SphValue(&sph->rate.dv[k], i);
    }
    m.s = sph->st.s[i];
    m.sn = sph->stn.s[i];
    m.ds = SphValue(&sph->rate.ds, i);
    if (stage == STAGE_HALF)
      sph_step_half(&m, fluid, dt);
    else if (stage == STAGE_RK2)
      sph_step_full_rk2(&m, fluid, dt);
    else if (stage == STAGE_SYMPLECTIC)
      sph_step_full_symplectic(&m, fluid, dt);
    else
      sph_step_full_verlet(&m, fluid, dt, sph->verletspan);
    sph->st.s[i] = m.s;
    if (stage == STAGE_HALF || stage == STAGE_VERLET) sph->stn.s[i] = m.sn;
    for (int k = 0; k < 3 && fluid; k++) {
      sph->st.x[k][i] = m.x[k];
      sph->st.v[k][i] = m.v[k];
      if (stage == STAGE_HALF) sph->stn.x[k][i] = m.xn[k];
      if (stage == STAGE_HALF || stage == STAGE_VERLET) sph->stn.v[k][i] = m.vn[k];
      r2 += (m.x[k] - m.xn[k]) * (m.x[k] - m.xn[k]);
    }
    if (fluid && !(r2 <= far2)) far2 = isnan(r2) ? HUGE_VAL : r2;
  }
  return far2;
}

static PetscErrorCode HalfStep_CPU(Sph sph, PetscReal dt)
{
  PetscFunctionBegin;
  MoveStage(sph, STAGE_HALF, dt);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FullStep_CPU(Sph sph, PetscReal dt)
{
  SphCpu *cpu = (SphCpu *)sph->data;
  double far2;

  PetscFunctionBegin;
  if (sph->par.integrator == SPH_INTEGRATOR_RK2)
    far2 = MoveStage(sph, STAGE_RK2, dt);
  else if (sph->par.integrator == SPH_INTEGRATOR_SYMPLECTIC)
    far2 = MoveStage(sph, STAGE_SYMPLECTIC, dt);
  else
    far2 = MoveStage(sph, STAGE_VERLET, dt);
  cpu->moved += sqrt(far2); /* over the whole step: saved positions are those at its beginning */
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Reinit_CPU(Sph sph)
{
  PetscFunctionBegin;
  Prepare(sph, 0);
  Sweep(sph, SPH_SWEEP_SUM);
#pragma omp parallel for schedule(static)
  for (PetscInt i = 0; i < sph->n; i++)
    if (sph->group[i] == -1) sph->st.s[i] = SphValue(&sph->rate.ds, i);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Groups of fewer markers are moved and read by one thread: to wake the others takes as long as some thousand markers. */
#define SERIAL 2048

static PetscErrorCode Motion_CPU(Sph sph, PetscInt group, const PetscReal *x, const PetscReal *v, const PetscReal *a)
{
  const PetscInt first = sph->groupstart[group], last = sph->groupstart[group + 1];
  SphCpu *cpu = (SphCpu *)sph->data;
  double far2 = 0.0;

  PetscFunctionBegin;
#pragma omp parallel for schedule(static) reduction(max : far2) if (last - first >= SERIAL)
  for (PetscInt id = first; id < last; id++) {
    const int i = sph->slot[id];
    const PetscInt o = 3 * (id - first);
    double r2 = 0.0;
    for (int k = 0; k < sph->par.dim; k++) {
      double d = x[o + k] - sph->st.x[k][i];
      if (cpu->grid.periodic[k]) d -= cpu->grid.length[k] * rint(d / cpu->grid.length[k]);
      r2 += d * d;
      sph->st.x[k][i] = x[o + k];
      sph->st.v[k][i] = v[o + k];
      if (sph->ab[k]) sph->ab[k][i] = a ? a[o + k] : 0.0;
    }
    if (!(r2 <= far2)) far2 = isnan(r2) ? HUGE_VAL : r2;
  }
  cpu->gmoved[group] += sqrt(far2);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Force_CPU(Sph sph, PetscInt group, PetscReal *f)
{
  const PetscInt first = sph->groupstart[group], last = sph->groupstart[group + 1];

  PetscFunctionBegin;
#pragma omp parallel for schedule(static) if (last - first >= SERIAL)
  for (PetscInt id = first; id < last; id++) {
    const int i = sph->slot[id];
    for (int k = 0; k < 3; k++) f[3 * (id - first) + k] = sph->m[i] * SphValue(&sph->rate.a[k], i);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Limits_CPU(Sph sph, PetscReal *vmax, PetscReal *amax)
{
  double v2 = 0.0, a2 = 0.0;

  PetscFunctionBegin;
#pragma omp parallel for schedule(static) reduction(max : v2, a2)
  for (PetscInt i = 0; i < sph->n; i++) {
    double v = 0.0, a = 0.0;
    for (int k = 0; k < sph->par.dim; k++) {
      const double f = sph->group[i] == -1 ? SphValue(&sph->rate.a[k], i) + sph->par.f[k] : 0.0;
      v += sph->st.v[k][i] * sph->st.v[k][i];
      a += f * f;
    }
    v2 = PetscMax(v2, v);
    a2 = PetscMax(a2, a);
  }
  *vmax = sqrt(v2);
  *amax = sqrt(a2);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Pull_CPU(Sph sph)
{
  (void)sph;
  return PETSC_SUCCESS;
}

static PetscErrorCode Push_CPU(Sph sph)
{
  ((SphCpu *)sph->data)->built = PETSC_FALSE;
  return PETSC_SUCCESS;
}

/* Grid, cell ranges, and how far markers have moved since these were made. A state of another backend has none of it. */
static PetscErrorCode State_CPU(Sph sph, FrondState *s)
{
  SphCpu *cpu = (SphCpu *)sph->data;
  PetscInt nstart = cpu->built ? 2 * (PetscInt)cpu->grid.n[0] * cpu->grid.n[1] * cpu->grid.n[2] + 2 : 0;
  const PetscBool load = s->way == FROND_STATE_LOAD ? PETSC_TRUE : PETSC_FALSE;
  PetscBool there = PETSC_TRUE;

  PetscFunctionBegin;
  if (load) PetscCall((*s->has)(s, "fluid/search_cpu/built", &there));
  if (!there) {
    PetscCall(Push_CPU(sph));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  FrondMoveBool(s, "fluid/search_cpu/built", &cpu->built);
  PetscCall(SphMoveGrid(s, "fluid/search_cpu", &cpu->grid));
  FrondMoveInt(s, "fluid/search_cpu/ranges", &nstart, 1);
  if (load && nstart > cpu->cellcap) {
    cpu->cellcap = nstart;
    PetscCall(PetscFree(cpu->cellstart));
    PetscCall(PetscMalloc1(nstart, &cpu->cellstart));
  }
  FrondMoveInt32(s, "fluid/search_cpu/start", cpu->cellstart, nstart);
  FrondMoveReal(s, "fluid/search_cpu/moved", &cpu->moved, 1);
  FrondMoveReal(s, "fluid/search_cpu/group_moved", cpu->gmoved, sph->ngroups);
  if (load && nstart) PetscCall(SizeLists(sph, cpu));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* sph_cpuopen.c */
extern PetscErrorCode SphFit_CPU(Sph sph, PetscInt n, const double *at, const double *offset, const int *group, double *value,
                                 int *near);

const SphOps SphOps_CPU = {SetUp_CPU,  Build_CPU, Rates_CPU,  HalfStep_CPU, FullStep_CPU, Reinit_CPU,
                           Motion_CPU, Force_CPU, Limits_CPU, Pull_CPU,     Push_CPU,     Destroy_CPU,
                           NULL,       State_CPU, NULL,       NULL,         NULL,         SphFit_CPU};
