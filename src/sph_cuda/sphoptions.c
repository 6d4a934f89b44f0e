/* sphoptions.c - every parameter of the fluid: setter, option of the same name, and what SphView prints. */
#include "sphimpl.h"
#include "sphopenimpl.h"

/* A pointer by itself since PETSc 3.23. */
#if PETSC_VERSION_LT(3, 23, 0)
typedef PetscOptionItems *SphOptionItems;
#else
typedef PetscOptionItems SphOptionItems;
#endif

const char *const SphKernelTypes[] = {"cubic", "wendland", "SphKernelType", "SPH_KERNEL_", NULL};
const char *const SphPrecisions[] = {"single", "double", "SphPrecision", "SPH_PRECISION_", NULL};
const char *const SphWallTypes[] = {"bce", "adami", "SphWallType", "SPH_WALL_", NULL};
const char *const SphReinitTypes[] = {"none", "sum", "shepard", "SphReinitType", "SPH_REINIT_", NULL};
const char *const SphViscosityTypes[] = {"eq6", "morris", "artificial", "SphViscosityType", "SPH_VISCOSITY_", NULL};
const char *const SphDiffusionTypes[] = {"none", "molteni", "fourtakas", "SphDiffusionType", "SPH_DIFFUSION_", NULL};
const char *const SphIntegratorTypes[] = {"rk2", "verlet", "symplectic", "SphIntegratorType", "SPH_INTEGRATOR_", NULL};
const char *const SphSlipTypes[] = {"none", "free", "SphSlipType", "SPH_SLIP_", NULL};
const char *const SphGradientTypes[] = {"none", "bonet", "SphGradientType", "SPH_GRADIENT_", NULL};
const char *const SphShiftingTypes[] = {"none", "sun", "SphShiftingType", "SPH_SHIFTING_", NULL};

static PetscErrorCode CheckEditable(Sph sph, const char *name)
{
  PetscFunctionBegin;
  PetscCheck(!sph->setup, sph->comm, PETSC_ERR_ORDER, "sph_%s cannot change after SphSetUp()", name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckPositive(Sph sph, const char *name, PetscReal value, const char *unit)
{
  PetscFunctionBegin;
  PetscCall(CheckEditable(sph, name));
  PetscCheck(PetscIsNormalReal(value) && value > 0.0, sph->comm, PETSC_ERR_ARG_OUTOFRANGE, "sph_%s = %g: must be > 0 (%s)", name,
             (double)value, unit);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckRange(Sph sph, const char *name, PetscReal value, PetscReal lo, PetscReal hi)
{
  PetscFunctionBegin;
  PetscCall(CheckEditable(sph, name));
  PetscCheck(value >= lo && value <= hi, sph->comm, PETSC_ERR_ARG_OUTOFRANGE, "sph_%s = %g: must be in [%g, %g]", name,
             (double)value, (double)lo, (double)hi);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckFinite3(Sph sph, const char *name, const PetscReal v[3])
{
  PetscFunctionBegin;
  for (int k = 0; k < 3; k++)
    PetscCheck(!PetscIsInfOrNanReal(v[k]), sph->comm, PETSC_ERR_ARG_OUTOFRANGE, "%s[%d] = %g: must be finite", name, k,
               (double)v[k]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSetOptionsPrefix(Sph sph, const char prefix[])
{
  PetscFunctionBegin;
  PetscCall(PetscStrncpy(sph->prefix, prefix ? prefix : "", sizeof(sph->prefix)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSetType(Sph sph, SphType type)
{
  PetscFunctionBegin;
  PetscCall(CheckEditable(sph, "type"));
  PetscCall(PetscStrncpy(sph->type, type, sizeof(sph->type)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphGetType(Sph sph, SphType *type)
{
  PetscFunctionBegin;
  *type = sph->type;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSetDimension(Sph sph, PetscInt dim)
{
  PetscFunctionBegin;
  PetscCall(CheckEditable(sph, "dim"));
  PetscCheck(dim == 2 || dim == 3, sph->comm, PETSC_ERR_ARG_OUTOFRANGE, "sph_dim = %" PetscInt_FMT ": must be 2 or 3", dim);
  sph->par.dim = dim;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSetSpacing(Sph sph, PetscReal dp)
{
  PetscFunctionBegin;
  PetscCall(CheckPositive(sph, "dp", dp, "m"));
  sph->par.dp = dp;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSetSmoothingLength(Sph sph, PetscReal h)
{
  PetscFunctionBegin;
  PetscCall(CheckPositive(sph, "h", h, "m"));
  sph->par.h = h;
  sph->hset = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSetSmoothingRatio(Sph sph, PetscReal ratio)
{
  PetscFunctionBegin;
  PetscCall(CheckRange(sph, "h_over_dp", ratio, 1.0, 4.0));
  sph->hratio = ratio;
  sph->hset = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSetDensity(Sph sph, PetscReal rho0)
{
  PetscFunctionBegin;
  PetscCall(CheckPositive(sph, "density", rho0, "kg/m^3"));
  sph->par.rho0 = rho0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSetViscosity(Sph sph, PetscReal mu)
{
  PetscFunctionBegin;
  PetscCall(CheckEditable(sph, "viscosity"));
  PetscCheck(mu >= 0.0 && !PetscIsInfOrNanReal(mu), sph->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "sph_viscosity = %g: must be >= 0 (Pa s)", (double)mu);
  sph->par.mu = mu;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSetMaxSpeed(Sph sph, PetscReal vmax)
{
  PetscFunctionBegin;
  PetscCall(CheckPositive(sph, "max_speed", vmax, "m/s"));
  sph->par.vmax = vmax;
  sph->vmaxset = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSetSoundSpeed(Sph sph, PetscReal cs)
{
  PetscFunctionBegin;
  PetscCall(CheckPositive(sph, "sound_speed", cs, "m/s"));
  sph->par.cs = cs;
  sph->csset = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSetGamma(Sph sph, PetscReal gamma)
{
  PetscFunctionBegin;
  PetscCall(CheckRange(sph, "gamma", gamma, 1.0, 20.0));
  sph->par.gamma = gamma;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSetBackgroundPressure(Sph sph, PetscReal pb)
{
  PetscFunctionBegin;
  PetscCall(CheckEditable(sph, "background_pressure"));
  PetscCheck(pb >= 0.0 && !PetscIsInfOrNanReal(pb), sph->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "sph_background_pressure = %g: must be >= 0 (Pa)", (double)pb);
  sph->par.pb = pb;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSetXSPH(Sph sph, PetscReal zeta)
{
  PetscFunctionBegin;
  PetscCall(CheckRange(sph, "xsph", zeta, 0.0, 1.0));
  sph->par.zeta = zeta;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSetDensityReinit(Sph sph, SphReinitType type, PetscInt every)
{
  PetscFunctionBegin;
  PetscCall(CheckEditable(sph, "reinit"));
  PetscCheck(every >= 1, sph->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "sph_reinit_every = %" PetscInt_FMT ": must be >= 1 (use sph_reinit none to switch off)", every);
  sph->par.reinit = (int)type;
  sph->par.reinitevery = every;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSetViscosityEpsilon(Sph sph, PetscReal epsilon)
{
  PetscFunctionBegin;
  PetscCall(CheckRange(sph, "viscosity_epsilon", epsilon, 1e-6, 1.0));
  sph->par.epsilon = epsilon;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSetLatticeNormalisation(Sph sph, PetscBool normalise)
{
  PetscFunctionBegin;
  PetscCall(CheckEditable(sph, "lattice"));
  sph->par.lattice = normalise;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSetViscosityType(Sph sph, SphViscosityType type)
{
  PetscFunctionBegin;
  PetscCall(CheckEditable(sph, "viscosity_type"));
  sph->par.viscosity = (int)type;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSetArtificialViscosity(Sph sph, PetscReal alpha)
{
  PetscFunctionBegin;
  PetscCall(CheckRange(sph, "artificial_alpha", alpha, 0.0, 10.0));
  sph->par.alpha = alpha;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSetDensityDiffusion(Sph sph, SphDiffusionType type, PetscReal delta)
{
  PetscFunctionBegin;
  PetscCall(CheckRange(sph, "density_diffusion_delta", delta, 0.0, 1.0));
  sph->par.diffusion = (int)type;
  sph->par.delta = delta;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSetShifting(Sph sph, SphShiftingType type, PetscReal factor)
{
  PetscFunctionBegin;
  PetscCall(CheckRange(sph, "shifting_factor", factor, 0.0, 5.0));
  sph->par.shifting = (int)type;
  sph->par.shiftfactor = factor;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSetGradientCorrection(Sph sph, SphGradientType type)
{
  PetscFunctionBegin;
  PetscCall(CheckEditable(sph, "gradient_correction"));
  sph->par.gradient = (int)type;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSetIntegrator(Sph sph, SphIntegratorType integrator)
{
  PetscFunctionBegin;
  PetscCall(CheckEditable(sph, "integrator"));
  sph->par.integrator = (int)integrator;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSetKernel(Sph sph, SphKernelType kernel)
{
  PetscFunctionBegin;
  PetscCall(CheckEditable(sph, "kernel"));
  sph->par.kernel = (int)kernel;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSetPrecision(Sph sph, SphPrecision precision)
{
  PetscFunctionBegin;
  PetscCall(CheckEditable(sph, "precision"));
  sph->par.precision = (int)precision;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSetWall(Sph sph, SphWallType wall)
{
  PetscFunctionBegin;
  PetscCall(CheckEditable(sph, "wall"));
  sph->par.wall = (int)wall;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSetSlip(Sph sph, SphSlipType slip)
{
  PetscFunctionBegin;
  PetscCall(CheckEditable(sph, "slip"));
  sph->par.slip = (int)slip;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSetBodyForce(Sph sph, const PetscReal f[3])
{
  PetscFunctionBegin;
  PetscCall(CheckFinite3(sph, "sph_body_force", f));
  for (int k = 0; k < 3; k++) sph->fconst[k] = f[k];
  SphBodyForceAt(sph, sph->t);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSetDomain(Sph sph, const PetscReal lo[3], const PetscReal hi[3])
{
  PetscFunctionBegin;
  PetscCall(CheckEditable(sph, "domain"));
  PetscCall(CheckFinite3(sph, "domain_lo", lo));
  PetscCall(CheckFinite3(sph, "domain_hi", hi));
  for (int k = 0; k < 3; k++) {
    sph->par.lo[k] = lo[k];
    sph->par.hi[k] = hi[k];
  }
  sph->domainset = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSetPeriodic(Sph sph, const PetscBool periodic[3])
{
  PetscFunctionBegin;
  PetscCall(CheckEditable(sph, "periodic"));
  for (int k = 0; k < 3; k++) sph->par.periodic[k] = periodic[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSetTimeStep(Sph sph, PetscReal dt)
{
  PetscFunctionBegin;
  PetscCheck(dt == (PetscReal)PETSC_DECIDE || (dt > 0.0 && !PetscIsInfOrNanReal(dt)), sph->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "sph_dt = %g: must be > 0 (s), or -1 to follow the stability limits", (double)dt);
  sph->par.dtfixed = dt;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSetCFL(Sph sph, PetscReal cfl)
{
  PetscFunctionBegin;
  PetscCheck(cfl > 0.0 && cfl <= 1.0, sph->comm, PETSC_ERR_ARG_OUTOFRANGE, "sph_cfl = %g: must be in (0, 1]", (double)cfl);
  sph->par.cfl = cfl;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSetMinTimeStep(Sph sph, PetscReal dtmin)
{
  PetscFunctionBegin;
  PetscCheck(dtmin >= 0.0 && !PetscIsInfOrNanReal(dtmin), sph->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "sph_dt_min = %g: must be >= 0 (s)", (double)dtmin);
  sph->par.dtmin = dtmin;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSetSpeedStop(Sph sph, PetscReal ratio)
{
  PetscFunctionBegin;
  PetscCheck(ratio >= 0.0 && !PetscIsInfOrNanReal(ratio), sph->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "sph_speed_stop = %g: must be >= 0 (-)", (double)ratio);
  sph->par.speedstop = ratio;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSetCheckEvery(Sph sph, PetscInt every)
{
  PetscFunctionBegin;
  PetscCheck(every >= 1, sph->comm, PETSC_ERR_ARG_OUTOFRANGE, "sph_check_every = %" PetscInt_FMT ": must be >= 1", every);
  sph->par.checkevery = every;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Options that carry a length, a material or a choice; set is true when the option was given. */
static PetscErrorCode OptionsGeometry(Sph sph, SphOptionItems PetscOptionsObject)
{
  SphParams *p = &sph->par;
  PetscInt n;
  PetscReal r;
  PetscBool set, set2;
  char type[16];

  PetscFunctionBegin;
  PetscCall(PetscOptionsString("-sph_type", "Backend: cpu, cuda, or auto (cuda when a device is there)", "SphSetType", sph->type,
                               type, sizeof(type), &set));
  if (set) PetscCall(SphSetType(sph, type));
  PetscCall(PetscOptionsInt("-sph_dim", "Dimension, 2 (x-y plane, per unit depth) or 3", "SphSetDimension", p->dim, &n, &set));
  if (set) PetscCall(SphSetDimension(sph, n));
  PetscCall(PetscOptionsReal("-sph_dp", "Initial marker spacing (m)", "SphSetSpacing", p->dp, &r, &set));
  if (set) PetscCall(SphSetSpacing(sph, r));
  PetscCall(
      PetscOptionsReal("-sph_h_over_dp", "Smoothing length over spacing (-)", "SphSetSmoothingRatio", sph->hratio, &r, &set));
  if (set) PetscCall(SphSetSmoothingRatio(sph, r));
  PetscCall(
      PetscOptionsReal("-sph_h", "Smoothing length h (m); the kernel reaches 2h", "SphSetSmoothingLength", p->h, &r, &set2));
  PetscCheck(!(set && set2), sph->comm, PETSC_ERR_ARG_INCOMP, "sph_h and sph_h_over_dp: give only one of them");
  if (set2) PetscCall(SphSetSmoothingLength(sph, r));
  PetscCall(PetscOptionsReal("-sph_density", "Reference density rho0 (kg/m^3)", "SphSetDensity", p->rho0, &r, &set));
  if (set) PetscCall(SphSetDensity(sph, r));
  PetscCall(PetscOptionsReal("-sph_viscosity", "Dynamic viscosity mu (Pa s)", "SphSetViscosity", p->mu, &r, &set));
  if (set) PetscCall(SphSetViscosity(sph, r));
  PetscCall(PetscOptionsReal("-sph_max_speed", "Expected maximum speed V_max (m/s)", "SphSetMaxSpeed", p->vmax, &r, &set));
  if (set) PetscCall(SphSetMaxSpeed(sph, r));
  PetscCall(
      PetscOptionsReal("-sph_sound_speed", "Speed of sound c_s (m/s); default 10 V_max", "SphSetSoundSpeed", p->cs, &r, &set));
  if (set) PetscCall(SphSetSoundSpeed(sph, r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode OptionsMethod(Sph sph, SphOptionItems PetscOptionsObject)
{
  SphParams *p = &sph->par;
  PetscInt n = 3;
  PetscEnum e;
  PetscReal r, f[3] = {p->f[0], p->f[1], p->f[2]};
  PetscBool set, set2;

  PetscFunctionBegin;
  PetscCall(PetscOptionsReal("-sph_gamma", "Exponent of the equation of state, Eq. 7", "SphSetGamma", p->gamma, &r, &set));
  if (set) PetscCall(SphSetGamma(sph, r));
  PetscCall(PetscOptionsReal("-sph_background_pressure", "Constant added to the pressure (Pa)", "SphSetBackgroundPressure", p->pb,
                             &r, &set));
  if (set) PetscCall(SphSetBackgroundPressure(sph, r));
  PetscCall(PetscOptionsReal("-sph_xsph", "XSPH factor zeta, Eq. 11", "SphSetXSPH", p->zeta, &r, &set));
  if (set) PetscCall(SphSetXSPH(sph, r));
  PetscCall(PetscOptionsReal("-sph_viscosity_epsilon", "Regularisation epsilon, Eq. 6", "SphSetViscosityEpsilon", p->epsilon, &r,
                             &set));
  if (set) PetscCall(SphSetViscosityEpsilon(sph, r));
  PetscCall(PetscOptionsBool("-sph_lattice", "Normalise kernel, gradient and viscosity sums on the initial lattice",
                             "SphSetLatticeNormalisation", p->lattice, &set2, &set));
  if (set) PetscCall(SphSetLatticeNormalisation(sph, set2));
  PetscCall(PetscOptionsEnum("-sph_kernel", "Smoothing kernel", "SphSetKernel", SphKernelTypes, (PetscEnum)p->kernel, &e, &set));
  if (set) PetscCall(SphSetKernel(sph, (SphKernelType)e));
  PetscCall(PetscOptionsEnum("-sph_precision", "Arithmetic of pair sums", "SphSetPrecision", SphPrecisions,
                             (PetscEnum)p->precision, &e, &set));
  if (set) PetscCall(SphSetPrecision(sph, (SphPrecision)e));
  PetscCall(PetscOptionsEnum("-sph_wall", "Wall treatment: bce evolves boundary densities, adami extrapolates from the fluid",
                             "SphSetWall", SphWallTypes, (PetscEnum)p->wall, &e, &set));
  if (set) PetscCall(SphSetWall(sph, (SphWallType)e));
  e = (PetscEnum)p->reinit;
  PetscCall(
      PetscOptionsEnum("-sph_reinit", "Density re-initialisation, Eq. 9", "SphSetDensityReinit", SphReinitTypes, e, &e, &set));
  n = p->reinitevery;
  PetscCall(
      PetscOptionsInt("-sph_reinit_every", "Steps between density re-initialisations", "SphSetDensityReinit", n, &n, &set2));
  if (set || set2) PetscCall(SphSetDensityReinit(sph, (SphReinitType)e, n));
  n = 3;
  PetscCall(PetscOptionsRealArray("-sph_body_force", "Body force per mass (m/s^2)", "SphSetBodyForce", f, &n, &set));
  PetscCheck(!set || n == 3, sph->comm, PETSC_ERR_ARG_SIZ, "sph_body_force: needs 3 numbers, got %" PetscInt_FMT, n);
  if (set) PetscCall(SphSetBodyForce(sph, f));
  PetscCall(PetscOptionsReal("-sph_dt", "Fixed time step (s); -1 follows the stability limits", "SphSetTimeStep", p->dtfixed, &r,
                             &set));
  if (set) PetscCall(SphSetTimeStep(sph, r));
  PetscCall(PetscOptionsReal("-sph_cfl", "Safety factor of the stability limits", "SphSetCFL", p->cfl, &r, &set));
  if (set) PetscCall(SphSetCFL(sph, r));
  PetscCall(PetscOptionsInt("-sph_check_every", "Steps between checks for non-finite values", "SphSetCheckEvery", p->checkevery,
                            &n, &set));
  if (set) PetscCall(SphSetCheckEvery(sph, n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Choices between forms of the viscous term, the density equation and the time stepping. */
static PetscErrorCode OptionsForms(Sph sph, SphOptionItems PetscOptionsObject)
{
  SphParams *p = &sph->par;
  PetscEnum e;
  PetscReal r;
  PetscBool set, set2;

  PetscFunctionBegin;
  PetscCall(PetscOptionsEnum("-sph_viscosity_type", "Viscous term: eq6, morris, or artificial (needs no sph_viscosity)",
                             "SphSetViscosityType", SphViscosityTypes, (PetscEnum)p->viscosity, &e, &set));
  if (set) PetscCall(SphSetViscosityType(sph, (SphViscosityType)e));
  PetscCall(PetscOptionsReal("-sph_artificial_alpha", "Factor alpha of the artificial viscosity", "SphSetArtificialViscosity",
                             p->alpha, &r, &set));
  if (set) PetscCall(SphSetArtificialViscosity(sph, r));
  e = (PetscEnum)p->diffusion;
  r = p->delta;
  PetscCall(PetscOptionsEnum("-sph_density_diffusion", "Density diffusion between fluid markers", "SphSetDensityDiffusion",
                             SphDiffusionTypes, e, &e, &set));
  PetscCall(PetscOptionsReal("-sph_density_diffusion_delta", "Factor delta of the density diffusion", "SphSetDensityDiffusion", r,
                             &r, &set2));
  if (set || set2) PetscCall(SphSetDensityDiffusion(sph, (SphDiffusionType)e, r));
  e = (PetscEnum)p->shifting;
  r = p->shiftfactor;
  PetscCall(PetscOptionsEnum("-sph_shifting", "Marker shifting, not at free surfaces: for confined and periodic flows",
                             "SphSetShifting", SphShiftingTypes, e, &e, &set));
  PetscCall(PetscOptionsReal("-sph_shifting_factor", "Factor of the shifting velocity", "SphSetShifting", r, &r, &set2));
  if (set || set2) PetscCall(SphSetShifting(sph, (SphShiftingType)e, r));
  PetscCall(PetscOptionsEnum("-sph_gradient_correction", "Gradients exact for linear fields; momentum is then not conserved",
                             "SphSetGradientCorrection", SphGradientTypes, (PetscEnum)p->gradient, &e, &set));
  if (set) PetscCall(SphSetGradientCorrection(sph, (SphGradientType)e));
  PetscCall(PetscOptionsEnum("-sph_slip", "Slip along boundary markers: none, or free (no friction; sph_wall adami)",
                             "SphSetSlip", SphSlipTypes, (PetscEnum)p->slip, &e, &set));
  if (set) PetscCall(SphSetSlip(sph, (SphSlipType)e));
  PetscCall(PetscOptionsReal("-sph_dt_min", "Floor of the time step, below which the run ends (s); 0 for none",
                             "SphSetMinTimeStep", p->dtmin, &r, &set));
  if (set) PetscCall(SphSetMinTimeStep(sph, r));
  PetscCall(PetscOptionsReal("-sph_speed_stop", "Speed over that of sound, above which the run ends (-); 0 for none",
                             "SphSetSpeedStop", p->speedstop, &r, &set));
  if (set) PetscCall(SphSetSpeedStop(sph, r));
  PetscCall(PetscOptionsEnum("-sph_integrator", "Time integration of the fluid", "SphSetIntegrator", SphIntegratorTypes,
                             (PetscEnum)p->integrator, &e, &set));
  if (set) PetscCall(SphSetIntegrator(sph, (SphIntegratorType)e));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSetFromOptions(Sph sph)
{
  PetscFunctionBegin;
  PetscOptionsBegin(sph->comm, sph->prefix[0] ? sph->prefix : NULL, "SPH fluid options", "Sph");
  PetscCall(OptionsGeometry(sph, PetscOptionsObject));
  PetscCall(OptionsMethod(sph, PetscOptionsObject));
  PetscCall(OptionsForms(sph, PetscOptionsObject));
  PetscOptionsEnd();
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphView(Sph sph, PetscViewer viewer)
{
  const SphParams *p = &sph->par;

  PetscFunctionBegin;
  PetscCall(PetscViewerASCIIPrintf(viewer, "SPH fluid: type %s, %" PetscInt_FMT "D, precision %s, kernel %s\n", sph->type, p->dim,
                                   SphPrecisions[p->precision], SphKernelTypes[p->kernel]));
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "  markers: %" PetscInt_FMT " fluid, %" PetscInt_FMT " boundary in %" PetscInt_FMT " groups\n",
                                   sph->nfluid, sph->n - sph->nfluid, sph->ngroups));
  PetscCall(PetscViewerASCIIPrintf(viewer, "  sph_dp %g m, sph_h %g m (h/dp %g)\n", (double)p->dp, (double)p->h,
                                   (double)(p->h / p->dp)));
  PetscCall(PetscViewerASCIIPrintf(
      viewer, "  sph_density %g kg/m^3, sph_viscosity %g Pa s, sph_gamma %g, sph_background_pressure %g Pa\n", (double)p->rho0,
      (double)p->mu, (double)p->gamma, (double)p->pb));
  PetscCall(PetscViewerASCIIPrintf(viewer, "  sph_max_speed %g m/s, sph_sound_speed %g m/s\n", (double)p->vmax, (double)p->cs));
  PetscCall(PetscViewerASCIIPrintf(
      viewer,
      "  sph_xsph %g, sph_viscosity_epsilon %g, sph_lattice %d, sph_wall %s, sph_reinit %s every %" PetscInt_FMT " steps\n",
      (double)p->zeta, (double)p->epsilon, p->lattice, SphWallTypes[p->wall], SphReinitTypes[p->reinit], p->reinitevery));
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "  sph_viscosity_type %s, sph_artificial_alpha %g, sph_density_diffusion %s, "
                                   "sph_density_diffusion_delta %g, sph_integrator %s\n",
                                   SphViscosityTypes[p->viscosity], (double)p->alpha, SphDiffusionTypes[p->diffusion],
                                   (double)p->delta, SphIntegratorTypes[p->integrator]));
  PetscCall(PetscViewerASCIIPrintf(
      viewer, "  sph_shifting %s, sph_shifting_factor %g, sph_slip %s, sph_dt_min %g s, sph_speed_stop %g\n",
      SphShiftingTypes[p->shifting], (double)p->shiftfactor, SphSlipTypes[p->slip], (double)p->dtmin, (double)p->speedstop));
  PetscCall(PetscViewerASCIIPrintf(viewer, "  sph_gradient_correction %s\n", SphGradientTypes[p->gradient]));
  PetscCall(PetscViewerASCIIPrintf(viewer, "  sph_body_force (%g, %g, %g) m/s^2, sph_cfl %g, sph_check_every %" PetscInt_FMT "\n",
                                   (double)p->f[0], (double)p->f[1], (double)p->f[2], (double)p->cfl, p->checkevery));
  if (sph->nforce)
    PetscCall(PetscViewerASCIIPrintf(viewer, "  body force over time: %" PetscInt_FMT " entries, %g to %g s\n", sph->nforce,
                                     (double)sph->forcetime[0], (double)sph->forcetime[sph->nforce - 1]));
  if (p->dtfixed > 0.0) PetscCall(PetscViewerASCIIPrintf(viewer, "  sph_dt %g s (fixed)\n", (double)p->dtfixed));
  PetscCall(PetscViewerASCIIPrintf(viewer, "  domain (%g, %g, %g) to (%g, %g, %g) m, periodic %d %d %d\n", (double)p->lo[0],
                                   (double)p->lo[1], (double)p->lo[2], (double)p->hi[0], (double)p->hi[1], (double)p->hi[2],
                                   p->periodic[0], p->periodic[1], p->periodic[2]));
  PetscCall(SphOpeningsView(sph, viewer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphGetDimension(Sph sph, PetscInt *dim)
{
  *dim = sph->par.dim;
  return PETSC_SUCCESS;
}

PetscErrorCode SphGetSpacing(Sph sph, PetscReal *dp)
{
  *dp = sph->par.dp;
  return PETSC_SUCCESS;
}

PetscErrorCode SphGetSmoothingLength(Sph sph, PetscReal *h)
{
  *h = sph->hset ? sph->par.h : sph->hratio * sph->par.dp;
  return PETSC_SUCCESS;
}

PetscErrorCode SphGetSupport(Sph sph, PetscReal *support)
{
  PetscFunctionBegin;
  PetscCall(SphGetSmoothingLength(sph, support));
  *support *= 2.0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphGetDensity(Sph sph, PetscReal *rho0)
{
  *rho0 = sph->par.rho0;
  return PETSC_SUCCESS;
}

PetscErrorCode SphGetViscosity(Sph sph, PetscReal *mu)
{
  *mu = sph->par.mu;
  return PETSC_SUCCESS;
}

PetscErrorCode SphGetSoundSpeed(Sph sph, PetscReal *cs)
{
  *cs = sph->csset ? sph->par.cs : 10.0 * sph->par.vmax;
  return PETSC_SUCCESS;
}

PetscErrorCode SphGetBodyForce(Sph sph, PetscReal f[3])
{
  for (int k = 0; k < 3; k++) f[k] = sph->par.f[k];
  return PETSC_SUCCESS;
}

PetscErrorCode SphGetDomain(Sph sph, PetscReal lo[3], PetscReal hi[3], PetscBool periodic[3])
{
  for (int k = 0; k < 3; k++) {
    lo[k] = sph->par.lo[k];
    hi[k] = sph->par.hi[k];
    periodic[k] = sph->par.periodic[k];
  }
  return PETSC_SUCCESS;
}
