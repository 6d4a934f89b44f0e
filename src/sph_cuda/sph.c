/* sph.c - lifecycle, backend choice and stepping of the fluid; no physics. */
#include "sphimpl.h"
#include "sphlink.h"
#include "sphopenimpl.h"
#include <math.h>
#if defined(_OPENMP)
  #include <omp.h>
#endif

PetscLogEvent SPH_Build, SPH_Aux, SPH_Rates, SPH_Integrate, SPH_Reinit, SPH_Motion, SPH_Output, SPH_Open;

static PetscErrorCode SphRegisterEvents(void)
{
  static PetscBool done = PETSC_FALSE;
  PetscClassId classid;

  PetscFunctionBegin;
  if (done) PetscFunctionReturn(PETSC_SUCCESS);
  done = PETSC_TRUE;
  PetscCall(PetscClassIdRegister("SPH fluid", &classid));
  PetscCall(PetscLogEventRegister("SphBuild", classid, &SPH_Build));
  PetscCall(PetscLogEventRegister("SphAuxiliary", classid, &SPH_Aux));
  PetscCall(PetscLogEventRegister("SphRates", classid, &SPH_Rates));
  PetscCall(PetscLogEventRegister("SphIntegrate", classid, &SPH_Integrate));
  PetscCall(PetscLogEventRegister("SphReinit", classid, &SPH_Reinit));
  PetscCall(PetscLogEventRegister("SphMotion", classid, &SPH_Motion));
  PetscCall(PetscLogEventRegister("SphOutput", classid, &SPH_Output));
  PetscCall(PetscLogEventRegister("SphOpenings", classid, &SPH_Open));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SphCreate - Create an empty fluid with the default parameters.

  Source: defaults of Pazouki, Serban, Negrut, Sect. 2.1 where the paper gives them.
@*/
PetscErrorCode SphCreate(MPI_Comm comm, Sph *newsph)
{
  Sph sph;
  PetscMPIInt size;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCheck(size == 1, comm, PETSC_ERR_SUP,
             "the fluid runs on 1 MPI rank, the communicator has %d: use threads (OMP_NUM_THREADS) instead", (int)size);
  PetscCall(SphRegisterEvents());
  PetscCall(PetscNew(&sph));
  sph->comm = comm;
  PetscCall(PetscStrncpy(sph->type, SPHCPU, sizeof(sph->type)));
  sph->par.dim = 3;
  sph->par.rho0 = 1000.0;
  sph->par.mu = 1e-3;
  sph->par.gamma = 7.0;
  sph->par.zeta = 0.5;
  sph->par.epsilon = 0.01;
  sph->par.lattice = PETSC_TRUE;
  sph->par.alpha = 0.1;
  sph->par.delta = 0.1;
  sph->par.shiftfactor = 2.0;
  sph->par.cfl = 0.25;
  sph->par.speedstop = 1.0;
  sph->par.dtfixed = PETSC_DECIDE;
  sph->par.reinit = SPH_REINIT_SHEPARD;
  sph->par.reinitevery = 10;
  sph->par.checkevery = 10;
  sph->par.wall = SPH_WALL_ADAMI;
  sph->hratio = 1.2;
  PetscCall(PetscMalloc1(1, &sph->groupstart));
  sph->groupcap = 1;
  sph->groupstart[0] = 0;
  *newsph = sph;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphDestroy(Sph *sph)
{
  PetscFunctionBegin;
  if (!*sph) PetscFunctionReturn(PETSC_SUCCESS);
  if ((*sph)->ops) PetscCall((*(*sph)->ops->destroy)(*sph));
  PetscCall(SphLinksDestroy(*sph));
  PetscCall(SphOpeningsDestroy(*sph));
  PetscCall(SphFreeArrays(*sph));
  PetscCall(PetscFree((*sph)->forcetime));
  PetscCall(PetscFree((*sph)->force));
  PetscCall(PetscFree(*sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The one table of backends. fallback: auto was asked for and there is no device. */
static PetscErrorCode FindBackend(Sph sph, const SphOps **ops, PetscBool *fallback)
{
  PetscBool cpu, cuda, any;

  PetscFunctionBegin;
  PetscCall(PetscStrcmp(sph->type, SPHCPU, &cpu));
  PetscCall(PetscStrcmp(sph->type, SPHCUDA, &cuda));
  PetscCall(PetscStrcmp(sph->type, SPHAUTO, &any));
  PetscCheck(cpu || cuda || any, sph->comm, PETSC_ERR_ARG_UNKNOWN_TYPE, "sph_type = %s: must be cpu, cuda or auto", sph->type);
  *ops = &SphOps_CPU;
  *fallback = PETSC_FALSE;
#if defined(FROND_HAVE_CUDA)
  if (cuda || any) {
    PetscBool have;
    PetscCall(SphCudaAvailable(&have));
    PetscCheck(have || any, sph->comm, PETSC_ERR_SUP_SYS, "sph_type = cuda: no CUDA device was found; use cpu or auto");
    if (have) *ops = &SphOps_CUDA;
    *fallback = have ? PETSC_FALSE : PETSC_TRUE;
  }
#else
  PetscCheck(!cuda, sph->comm, PETSC_ERR_SUP, "sph_type = cuda: this build has no CUDA backend; use cpu or auto");
  *fallback = any;
#endif
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ChooseBackend(Sph sph)
{
  PetscBool fallback = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(FindBackend(sph, &sph->ops, &fallback));
  if (fallback) PetscCall(PetscPrintf(sph->comm, "sph_type auto: no CUDA device, using the CPU backend\n"));
  PetscCall(PetscStrncpy(sph->type, sph->ops == &SphOps_CPU ? SPHCPU : SPHCUDA, sizeof(sph->type)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphGetResident(Sph sph, PetscBool *yes)
{
  PetscBool fallback = PETSC_FALSE;
  const SphOps *ops;

  PetscFunctionBegin;
  PetscCall(FindBackend(sph, &ops, &fallback));
  *yes = ops->linkmotion ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckParameters(Sph sph)
{
  SphParams *p = &sph->par;

  PetscFunctionBegin;
  PetscCheck(p->dp > 0.0, sph->comm, PETSC_ERR_ARG_OUTOFRANGE, "sph_dp = %g: the marker spacing must be given and > 0 (m)",
             (double)p->dp);
  if (!sph->hset) p->h = sph->hratio * p->dp;
  PetscCheck(p->h >= p->dp * (1.0 - 1e-12), sph->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "sph_h = %g is %g sph_dp: must be at least 1 sph_dp, or the kernel sees too few neighbours", (double)p->h,
             (double)(p->h / p->dp));
  PetscCheck(p->h <= p->dp * 4.0, sph->comm, PETSC_ERR_ARG_OUTOFRANGE, "sph_h = %g is %g sph_dp: must be at most 4 sph_dp",
             (double)p->h, (double)(p->h / p->dp));
  PetscCheck(sph->csset || sph->vmaxset, sph->comm, PETSC_ERR_ARG_WRONGSTATE,
             "sph_max_speed: the expected maximum speed (m/s, > 0) must be given, or sph_sound_speed");
  if (!sph->csset) p->cs = 10.0 * p->vmax;
  if (!sph->vmaxset) p->vmax = 0.1 * p->cs;
  SphLattice(p);
  p->B = p->cs * p->cs * p->rho0 / p->gamma;
  PetscCheck(sph->domainset, sph->comm, PETSC_ERR_ARG_WRONGSTATE, "domain_lo, domain_hi: the domain must be given");
  for (int k = 0; k < p->dim; k++) {
    PetscCheck(p->hi[k] > p->lo[k], sph->comm, PETSC_ERR_ARG_OUTOFRANGE, "domain_hi[%d] = %g: must be > domain_lo[%d] = %g", k,
               (double)p->hi[k], k, (double)p->lo[k]);
    PetscCheck(!p->periodic[k] || p->hi[k] - p->lo[k] >= 2.0 * p->h * 1.05, sph->comm, PETSC_ERR_ARG_OUTOFRANGE,
               "domain_hi[%d] - domain_lo[%d] = %g: a periodic side must be at least 2.1 sph_h = %g m long", k, k,
               (double)(p->hi[k] - p->lo[k]), (double)(2.1 * p->h));
  }
  PetscCheck(sph->nfluid > 0, sph->comm, PETSC_ERR_ARG_WRONGSTATE, "the domain holds no fluid: no fluid marker was added");
  PetscCheck(p->slip == SPH_SLIP_NONE || p->wall == SPH_WALL_ADAMI, sph->comm, PETSC_ERR_ARG_INCOMP,
             "sph_slip = free: needs sph_wall adami, it is %s", SphWallTypes[p->wall]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What a backend does not have is refused, never left out silently. */
static PetscErrorCode CheckBackend(Sph sph)
{
  PetscBool cuda;

  PetscFunctionBegin;
  PetscCall(PetscStrcmp(sph->type, SPHCUDA, &cuda));
  PetscCheck(!cuda || sph->par.shifting == SPH_SHIFTING_NONE, sph->comm, PETSC_ERR_SUP,
             "sph_shifting = %s: the cuda backend has none; use sph_type cpu or sph_shifting none",
             SphShiftingTypes[sph->par.shifting]);
  PetscCheck(!cuda || sph->par.gradient == SPH_GRADIENT_NONE, sph->comm, PETSC_ERR_SUP,
             "sph_gradient_correction = %s: the cuda backend has none; use sph_type cpu or sph_gradient_correction none",
             SphGradientTypes[sph->par.gradient]);
  PetscCheck(sph->par.gradient == SPH_GRADIENT_NONE || sph->par.shifting != SPH_SHIFTING_NONE, sph->comm, PETSC_ERR_ARG_INCOMP,
             "sph_gradient_correction = %s: needs sph_shifting sun, else nothing keeps the markers in order",
             SphGradientTypes[sph->par.gradient]);
  PetscCall(SphOpeningsCheck(sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SphSetUp - Check the parameters, choose the backend, sort the markers and evaluate the first right-hand side.

  Errors: a parameter out of range, no fluid, markers closer than 0.1 dp, no device.
@*/
PetscErrorCode SphSetUp(Sph sph)
{
  PetscFunctionBegin;
  if (sph->setup) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CheckParameters(sph));
  PetscCall(ChooseBackend(sph));
  PetscCall(CheckBackend(sph));
  for (PetscInt i = 0; i < sph->n; i++) {
    if (sph->group[i] == -2) continue; /* in reserve: no mass yet */
    if (sph->group[i] < 0) {           /* SphAddFluid left the pressure here, and the volume in m */
      PetscCheck(sph->st.s[i] > -0.5 * sph->par.B, sph->comm, PETSC_ERR_ARG_OUTOFRANGE,
                 "initial pressure %g Pa of marker %" PetscInt_FMT ": must be > %g Pa for this sound speed", sph->st.s[i], i,
                 (double)(-0.5 * sph->par.B));
      sph->st.s[i] = expm1(log1p(sph->st.s[i] / sph->par.B) / sph->par.gamma);
      /* a site's volume at its density */
      sph->m[i] = sph->par.rho0 * (1.0 + sph->st.s[i]) * pow(sph->par.dp, (double)sph->par.dim);
    } else {
      sph->m[i] *= sph->par.rho0;
      if (sph->wallratio[i] != SPH_WALLRATIO_SLIP)
        sph->wallratio[i] = sph->par.slip == SPH_SLIP_FREE ? SPH_WALLRATIO_SLIP : SphWallRatio(&sph->par, sph->wallratio[i]);
    }
  }
  PetscCall(SphAllocateArrays(sph, sph->ops == &SphOps_CPU ? PETSC_TRUE : PETSC_FALSE));
  PetscCall((*sph->ops->setup)(sph));
  sph->setup = PETSC_TRUE;
  PetscCall(SphOpeningsSetUp(sph));
  PetscCall((*sph->ops->build)(sph));
  PetscCall(SphOpeningsApply(sph, 0.0, 0.0));
  PetscCall((*sph->ops->rates)(sph));
  sph->evaluations = 0.0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FixedTimeStep(Sph sph, PetscReal limit, const char *which)
{
  const PetscReal dt = sph->par.dtfixed;

  PetscFunctionBegin;
  if (dt <= limit * (1.0 + 1e-9)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(sph->step > 0, sph->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "sph_dt = %g s: must be at most the stable step %g s (%s limit, sph_cfl = %g)", (double)dt, (double)limit, which,
             (double)sph->par.cfl);
  if (!sph->fixedwarned) {
    sph->fixedwarned = PETSC_TRUE;
    PetscCall(PetscFPrintf(sph->comm, PETSC_STDERR,
                           "frond: warning: sph_dt = %g s exceeds the stable step %g s (%s limit) at step %" PetscInt_FMT "\n",
                           (double)dt, (double)limit, which, sph->step));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Speeds near c_s compress the fluid: by about 4 % at c_s/5. Warned at the first time and at each doubling; the end at c_s. */
static PetscErrorCode CheckSpeed(Sph sph, PetscReal vmax)
{
  const PetscReal cs = sph->par.cs, stop = sph->par.speedstop;

  PetscFunctionBegin;
  PetscCheck(!(stop > 0.0 && vmax > stop * cs), sph->comm, PETSC_ERR_CONV_FAILED,
             "speed %g m/s at step %" PetscInt_FMT
             ", time %g s, is %.3g of the speed of sound %g m/s: the run is unstable, or sph_sound_speed too low "
             "(sph_speed_stop = %g ends it here; 0 goes on)",
             (double)vmax, sph->step, (double)sph->t, (double)(vmax / cs), (double)cs, (double)stop);
  if (vmax <= PetscMax(0.2 * cs, 2.0 * sph->speedwarned)) PetscFunctionReturn(PETSC_SUCCESS);
  sph->speedwarned = vmax;
  PetscCall(PetscFPrintf(sph->comm, PETSC_STDERR,
                         "frond: warning: speed %g m/s at step %" PetscInt_FMT
                         " is %.2g of the speed of sound %g m/s: the fluid is "
                         "compressed too much; sph_sound_speed should be at least %g m/s\n",
                         (double)vmax, sph->step, (double)(vmax / cs), (double)cs, (double)(10.0 * vmax)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SphComputeTimeStep - Stable step from the acoustic, force and viscous limits, or the fixed one.

  dt = cfl min(h/(c_s + v_max), sqrt(h/a_max), h^2/(2 nu)), s. Source: Morris, Fox, Zhu, J. Comput. Phys. 136 (1997), Eqs. 19-21.
The artificial viscosity counts as nu = alpha c_s h/(2 (dim + 2)): Monaghan, Rep. Prog. Phys. 68 (2005), Sect. 7. Errors: a fixed
step above the limit at the first step; later it is a warning, once. A speed beyond SphSetSpeedStop(), a step below
SphSetMinTimeStep().
@*/
PetscErrorCode SphComputeTimeStep(Sph sph, PetscReal *dt)
{
  const SphParams *p = &sph->par;
  const PetscReal nu =
      p->viscosity == SPH_VISCOSITY_ARTIFICIAL ? p->alpha * p->cs * p->h / (2.0 * (PetscReal)(p->dim + 2)) : p->mu / p->rho0;
  PetscReal vmax, amax, limit;
  const char *which = "acoustic";

  PetscFunctionBegin;
  SphBodyForceAt(sph, sph->t);
  PetscCall((*sph->ops->limits)(sph, &vmax, &amax));
  limit = p->cfl * p->h / (p->cs + vmax);
  if (amax > 0.0 && p->cfl * PetscSqrtReal(p->h / amax) < limit) {
    limit = p->cfl * PetscSqrtReal(p->h / amax);
    which = "force";
  }
  if (nu > 0.0 && p->cfl * 0.5 * p->h * p->h / nu < limit) {
    limit = p->cfl * 0.5 * p->h * p->h / nu;
    which = "viscous";
  }
  PetscCheck(PetscIsNormalReal(limit), sph->comm, PETSC_ERR_FP,
             "non-finite velocity or acceleration at step %" PetscInt_FMT ", time %g s: the stable step is %g s", sph->step,
             (double)sph->t, (double)limit);
  PetscCall(CheckSpeed(sph, vmax));
  PetscCheck(limit >= p->dtmin, sph->comm, PETSC_ERR_CONV_FAILED,
             "the stable step %g s (%s limit) at step %" PetscInt_FMT ", time %g s, is below sph_dt_min = %g s", (double)limit,
             which, sph->step, (double)sph->t, (double)p->dtmin);
  *dt = limit;
  if (p->dtfixed > 0.0) {
    PetscCall(FixedTimeStep(sph, limit, which));
    *dt = p->dtfixed;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* dt: of the step that begins; 0 inside one. What openings prescribe is that of the middle of the step. */
static PetscErrorCode EvaluateRates(Sph sph, PetscReal dt)
{
  PetscFunctionBegin;
  PetscCall(PetscLogEventBegin(SPH_Build, 0, 0, 0, 0));
  if (!sph->insidestep) PetscCall((*sph->ops->build)(sph));
  PetscCall(PetscLogEventEnd(SPH_Build, 0, 0, 0, 0));
  if (!sph->insidestep) PetscCall(SphOpeningsApply(sph, sph->t + 0.5 * dt, dt));
  PetscCall((*sph->ops->rates)(sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SphStepBegin - First stage: rates at t, state at t + dt/2 (verlet: the state stays). Set the boundary motion at t + dt/2 next.
@*/
PetscErrorCode SphStepBegin(Sph sph, PetscReal dt)
{
  PetscFunctionBegin;
  PetscCheck(!sph->insidestep, sph->comm, PETSC_ERR_ORDER, "SphStepBegin() was called twice without SphStepEnd()");
  PetscCheck(dt > 0.0, sph->comm, PETSC_ERR_ARG_OUTOFRANGE, "the time step %g s must be > 0", (double)dt);
  SphBodyForceAt(sph, sph->t);
  PetscCall(EvaluateRates(sph, dt));
  PetscCall(PetscLogEventBegin(SPH_Integrate, 0, 0, 0, 0));
  if (sph->par.integrator != SPH_INTEGRATOR_VERLET) PetscCall((*sph->ops->halfstep)(sph, dt));
  PetscCall(PetscLogEventEnd(SPH_Integrate, 0, 0, 0, 0));
  if (sph->par.integrator != SPH_INTEGRATOR_VERLET) SphBodyForceAt(sph, sph->t + 0.5 * dt);
  sph->dt = dt;
  sph->insidestep = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SphStepEvaluate - Second-stage rates and boundary forces for the boundary motion as set now; may be repeated with another
  motion before SphStepEnd(), which then takes the last ones. For couplings that iterate on the forces.

  Errors: outside a step; with the Verlet integrator, which has no second stage.
@*/
PetscErrorCode SphStepEvaluate(Sph sph)
{
  PetscFunctionBegin;
  PetscCheck(sph->insidestep, sph->comm, PETSC_ERR_ORDER, "SphStepEvaluate() was called without SphStepBegin()");
  PetscCheck(sph->par.integrator != SPH_INTEGRATOR_VERLET, sph->comm, PETSC_ERR_SUP,
             "sph_integrator = verlet has no second stage to evaluate again: use rk2 or symplectic");
  PetscCall(EvaluateRates(sph, 0.0));
  sph->evaluated = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SphStepEnd - Second stage: rates and boundary forces at t + dt/2 (verlet: those at t stay), fluid state at t + dt.

  Errors: PETSC_ERR_FP naming field, marker, step and time when a value is not finite (every -sph_check_every steps).
@*/
PetscErrorCode SphStepEnd(Sph sph)
{
  PetscFunctionBegin;
  PetscCheck(sph->insidestep, sph->comm, PETSC_ERR_ORDER, "SphStepEnd() was called without SphStepBegin()");
  if (sph->par.integrator != SPH_INTEGRATOR_VERLET && !sph->evaluated) PetscCall(EvaluateRates(sph, 0.0));
  sph->evaluated = PETSC_FALSE;
  PetscCall(PetscLogEventBegin(SPH_Integrate, 0, 0, 0, 0));
  sph->verletspan = sph->verletstep % SPH_VERLET_EVERY ? sph->dt + sph->dtold : 0.0;
  sph->verletstep++;
  PetscCall(SphOpeningsForce(sph, sph->dt));
  PetscCall((*sph->ops->fullstep)(sph, sph->dt));
  sph->dtold = sph->dt;
  PetscCall(PetscLogEventEnd(SPH_Integrate, 0, 0, 0, 0));
  sph->insidestep = PETSC_FALSE;
  sph->t += sph->dt;
  sph->step++;
  PetscCall(SphOpeningsExchange(sph));
  if (sph->par.reinit != SPH_REINIT_NONE && sph->step % sph->par.reinitevery == 0) {
    PetscCall(PetscLogEventBegin(SPH_Reinit, 0, 0, 0, 0));
    PetscCall((*sph->ops->build)(sph));
    PetscCall((*sph->ops->reinit)(sph));
    sph->verletstep = 0;
    PetscCall(PetscLogEventEnd(SPH_Reinit, 0, 0, 0, 0));
  }
  if (sph->step % sph->par.checkevery == 0) PetscCall((*(sph->ops->check ? sph->ops->check : SphCheckFinite))(sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSetBoundaryMotion(Sph sph, PetscInt group, const PetscReal *x, const PetscReal *v, const PetscReal *a)
{
#if defined(_OPENMP)
  const PetscBool alone = omp_in_parallel() ? PETSC_FALSE : PETSC_TRUE; /* the log belongs to one thread */
#else
  const PetscBool alone = PETSC_TRUE;
#endif

  PetscFunctionBegin;
  PetscCheck(group >= 0 && group < sph->ngroups, sph->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "boundary group %" PetscInt_FMT ": must be in [0, %" PetscInt_FMT ")", group, sph->ngroups);
  PetscCheck(!SphIsLinked(sph, group), sph->comm, PETSC_ERR_ORDER,
             "boundary group %" PetscInt_FMT " is linked: SphSetGroupState() moves it", group);
  if (alone) PetscCall(PetscLogEventBegin(SPH_Motion, 0, 0, 0, 0));
  PetscCall((*sph->ops->motion)(sph, group, x, v, a));
  if (alone) PetscCall(PetscLogEventEnd(SPH_Motion, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSetBoundaryRotation(Sph sph, PetscInt group, const PetscReal *omega)
{
  PetscInt first, n;

  PetscFunctionBegin;
  PetscCheck(group >= 0 && group < sph->ngroups, sph->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "boundary group %" PetscInt_FMT ": must be in [0, %" PetscInt_FMT ")", group, sph->ngroups);
  PetscCheck(sph->setup, sph->comm, PETSC_ERR_ORDER, "SphSetBoundaryRotation() must come after SphSetUp()");
  if (!sph->omega) PetscFunctionReturn(PETSC_SUCCESS);
  first = 3 * (sph->groupstart[group] - sph->nfluid);
  n = 3 * (sph->groupstart[group + 1] - sph->groupstart[group]);
  for (PetscInt i = 0; i < n; i++) {
    if (sph->omega[first + i] == omega[i]) continue;
    PetscCall(PetscArraycpy(sph->omega + first, omega, n));
    if (sph->ops->rotation) PetscCall((*sph->ops->rotation)(sph, group));
    break;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphGetBoundaryForce(Sph sph, PetscInt group, PetscReal *f)
{
  PetscFunctionBegin;
  PetscCheck(group >= 0 && group < sph->ngroups, sph->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "boundary group %" PetscInt_FMT ": must be in [0, %" PetscInt_FMT ")", group, sph->ngroups);
  PetscCall((*sph->ops->force)(sph, group, f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphGetTime(Sph sph, PetscReal *t, PetscInt *step)
{
  PetscFunctionBegin;
  if (t) *t = sph->t;
  if (step) *step = sph->step;
  PetscFunctionReturn(PETSC_SUCCESS);
}
