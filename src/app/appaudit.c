/*
  appaudit.c - balances of mass, momentum and energy of a run, one for each row of the history, and which of them is off.

  Energies of fluid, beams and bodies are balanced one by one, so that a residual tells where it arises:
    fluid   kinetic + compression - work of the body force + viscous heat + work on all surfaces
    beams   kinetic + elastic + potential - work of the fluid + energy that damping took - work of moments at their ends
    bodies  kinetic + potential + springs of joints - work of the fluid
  each less its value at the first row. Works of the fluid are sums over all steps; heat, body force and damping are sums of
  trapezoids over the rows. docs/output.md says what the residuals hold.
*/
#include "app.h"
#include <math.h>

static PetscReal norm3(const PetscReal v[3])
{
  return PetscSqrtReal(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* Add the trapezoids since the last row; rate: of this row. */
static void integrate(AppAudit *a, PetscReal t, const PetscReal rate[AUDIT_INTEGRALS])
{
  for (int k = 0; k < AUDIT_INTEGRALS; k++) {
    if (a->rows > 0) a->integral[k] += 0.5 * (t - a->t) * (a->rate[k] + rate[k]);
    a->rate[k] = rate[k];
  }
  a->t = t;
}

static void set_residual(AppAudit *a, int term, PetscReal residual, PetscInt n, const PetscReal terms[])
{
  a->residual[term] = residual;
  for (PetscInt i = 0; i < n; i++) a->scale[term] = PetscMax(a->scale[term], PetscAbsReal(terms[i]));
}

/* What the fluid has done on the surfaces, and the angular impulse on all of them. */
static PetscErrorCode add_works(App *app, AppAudit *a, PetscReal impulse[3])
{
  PetscFunctionBegin;
  for (int k = 0; k < SURFACE_KINDS; k++) a->work[k] = 0;
  for (int k = 0; k < 3; k++) impulse[k] = 0;
  for (PetscInt i = 0; i < app->nsurfaces && app->couple; i++) {
    PetscReal work, turn[3];
    PetscCall(CoupleGetWork(app->couple, i, &work, turn));
    a->work[app->surfaces[i].kind] += work;
    for (int k = 0; k < 3; k++) impulse[k] += turn[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Powers of this moment. */
static PetscErrorCode get_rates(App *app, AppAudit *a, const SphSums *sums, PetscReal rate[AUDIT_INTEGRALS])
{
  SphAudit audit;
  PetscReal f[3];

  PetscFunctionBegin;
  for (int k = 0; k < AUDIT_INTEGRALS; k++) rate[k] = 0;
  if (app->ancf) {
    PetscReal power;
    PetscCall(AncfGetDissipation(app->ancf, &rate[AUDIT_DAMPING]));
    PetscCall(AppBeamMomentPower(app, &power));
    rate[AUDIT_DAMPING] -= power;
  }
  if (!app->sph) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SphGetAudit(app->sph, &audit));
  PetscCall(SphGetBodyForce(app->sph, f));
  rate[AUDIT_HEAT] = audit.viscous;
  for (int k = 0; k < 3; k++) {
    const int b = (k + 1) % 3, c = (k + 2) % 3;
    rate[AUDIT_BODY] += f[k] * sums->momentum[k];
    rate[AUDIT_TORQUE + k] = sums->mass * (audit.centre[b] * f[c] - audit.centre[c] * f[b]);
    a->L[k] = audit.angular[k];
  }
  a->pressure = audit.pressure;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Residuals of mass, momentum, energy and angular momentum of the fluid. */
static PetscErrorCode fluid_residuals(App *app, AppAudit *a, const SphSums *sums, const PetscReal impulse[3])
{
  const PetscReal W = a->work[SURFACE_WALL] + a->work[SURFACE_BEAM] + a->work[SURFACE_BODY];
  const PetscReal E = sums->kinetic + sums->internal, *got = a->integral;
  PetscReal cs, small;
  PetscInt left;
  CoupleBalance balance;

  PetscFunctionBegin;
  PetscCall(SphGetCounts(app->sph, NULL, NULL, &left));
  if (!(a->rows > 0)) {
    a->energy[AUDIT_FLUID] = E;
    PetscCall(PetscArraycpy(a->angular, a->L, 3));
  }
  if (!(a->rows > 0) || (PetscReal)left != a->left) a->mass = sums->mass; /* markers that leave take their mass along */
  a->left = (PetscReal)left;
  PetscCall(SphGetSoundSpeed(app->sph, &cs));
  small = 1e-3 * sums->mass * cs / 10; /* of the momentum and energy of a fluid at a tenth of the speed of sound */
  set_residual(a, AUDIT_MASS, sums->mass - a->mass, 1, &sums->mass);
  PetscCall(CoupleGetBalance(app->couple, &balance));
  set_residual(a, AUDIT_MOMENTUM, norm3(balance.residual), 2, (PetscReal[]){balance.scale, small});
  set_residual(a, AUDIT_FLUID, E - a->energy[AUDIT_FLUID] - got[AUDIT_BODY] + got[AUDIT_HEAT] + W, 6,
               (PetscReal[]){sums->kinetic, sums->internal, got[AUDIT_BODY], got[AUDIT_HEAT], W, small * cs / 20});
  for (int k = 0; k < 3; k++) a->turn[k] = a->L[k] - a->angular[k] - got[AUDIT_TORQUE + k] + impulse[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode structure_residuals(App *app, AppAudit *a)
{
  PetscReal kinetic, elastic, potential, E;

  PetscFunctionBegin;
  if (app->ancf) {
    const PetscReal W = a->work[SURFACE_BEAM], D = a->integral[AUDIT_DAMPING];
    PetscCall(AncfGetEnergy(app->ancf, &kinetic, &elastic, &potential));
    E = kinetic + elastic + potential;
    if (!(a->rows > 0)) a->energy[AUDIT_BEAMS] = E;
    E -= a->energy[AUDIT_BEAMS];
    set_residual(a, AUDIT_BEAMS, E - W + D, 4, (PetscReal[]){kinetic, elastic, W, D});
  }
  if (app->rigid) {
    const PetscReal W = a->work[SURFACE_BODY];
    PetscCall(RigidGetEnergy(app->rigid, &kinetic, &potential));
    PetscCall(RigidGetJointEnergy(app->rigid, &elastic));
    E = kinetic + elastic + potential;
    if (!(a->rows > 0)) a->energy[AUDIT_BODIES] = E;
    E -= a->energy[AUDIT_BODIES];
    set_residual(a, AUDIT_BODIES, E - W, 3, (PetscReal[]){kinetic, elastic, W});
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether nothing takes part in this balance that it does not know of. */
static PetscErrorCode is_closed(App *app, int term, const AppAudit *a, PetscBool *closed)
{
  static const char *const near[] = {"-rigid_lubrication_viscosity", "-rigid_contact_modulus"};
  const AppScene *s = &app->scene;
  PetscBool free = (PetscBool)(s->nlinks == 0), set;

  PetscFunctionBegin;
  for (size_t k = 0; k < sizeof(near) / sizeof(near[0]); k++) {
    PetscCall(PetscOptionsHasName(NULL, NULL, near[k], &set));
    free = (PetscBool)(free && !set);
  }
  *closed = PETSC_TRUE;
  if (term == AUDIT_MOMENTUM || term == AUDIT_FLUID) *closed = (PetscBool)(a->left == 0);
  if (term == AUDIT_BEAMS) *closed = (PetscBool)(free && app->loadramp == 0);
  if (term != AUDIT_BODIES) PetscFunctionReturn(PETSC_SUCCESS);
  *closed = (PetscBool)(free && s->nlumped == 0 && s->njoints == 0);
  for (PetscInt b = 0; b < s->nbodies; b++) *closed = (PetscBool)(*closed && s->bodies[b].spec.motion != RIGID_PRESCRIBED);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Warn, once for each balance; the first rows, whose terms are small differences, are let off. */
static PetscErrorCode judge(App *app, AppAudit *a)
{
  static const char *const names[] = {"mass of the fluid", "momentum", "energy of the fluid", "energy of the beams",
                                      "energy of the bodies"};
  static const char *const options[] = {"", " (audit_momentum = %g)", " (audit_energy = %g)"};
  const AppScene *s = &app->scene;

  PetscFunctionBegin;
  for (int k = 0; k < AUDIT_TERMS; k++) {
    const PetscReal limit = k == AUDIT_MASS ? 1e-12 : (k == AUDIT_MOMENTUM ? s->auditmomentum : s->auditenergy);
    const PetscReal part = a->scale[k] > 0 ? PetscAbsReal(a->residual[k]) / a->scale[k] : 0;
    char option[64];
    PetscBool closed = PETSC_FALSE;
    if (a->rows < 10) continue;
    a->worst[k] = PetscMax(a->worst[k], part);
    if (!(part > limit) || limit < 0 || a->warned[k] != 0) continue;
    PetscCall(is_closed(app, k, a, &closed));
    if (!closed) continue;
    a->warned[k] = 1;
    snprintf(option, sizeof(option), options[PetscMin(k, 2)], (double)limit);
    fprintf(stderr,
            "frond: warning: the balance of the %s is off by %.3g of its largest term, %.4g,%s at t = %g s, step %d; said once\n",
            names[k], (double)part, (double)a->scale[k], option, (double)app->t, (int)app->step);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppAuditUpdate(App *app, AppAudit *a)
{
  PetscReal rate[AUDIT_INTEGRALS], impulse[3];
  SphSums sums = {0};

  PetscFunctionBegin;
  if (!app->scene.audit) PetscFunctionReturn(PETSC_SUCCESS);
  if (app->sph) PetscCall(SphGetSums(app->sph, &sums));
  PetscCall(get_rates(app, a, &sums, rate));
  integrate(a, app->t, rate);
  PetscCall(add_works(app, a, impulse));
  if (app->sph) PetscCall(fluid_residuals(app, a, &sums, impulse));
  PetscCall(structure_residuals(app, a));
  a->rows++;
  PetscCall(judge(app, a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode put_fluid(App *app, const AppAudit *a, AppPut put, AppHistory h)
{
  const PetscBool flat = (PetscBool)(app->dim == 2);
  const char *J = flat ? "J/m" : "J", *W = flat ? "W/m" : "W", *L = flat ? "kg m/s" : "kg m^2/s";
  char name[64];

  PetscFunctionBegin;
  PetscCall(put(h, "fluid_heat", J, "viscous heat since the start", a->integral[AUDIT_HEAT]));
  PetscCall(put(h, "fluid_heat_power", W, "power of viscous forces that becomes heat", a->rate[AUDIT_HEAT]));
  PetscCall(put(h, "fluid_pressure_power", W, "power of pressure forces on the fluid's relative motion", a->pressure));
  PetscCall(put(h, "body_force_work", J, "work of the body force on the fluid", a->integral[AUDIT_BODY]));
  PetscCall(put(h, "work_on_walls", J, "work of the fluid on walls", a->work[SURFACE_WALL]));
  PetscCall(put(h, "work_on_beams", J, "work of the fluid on beams", a->work[SURFACE_BEAM]));
  PetscCall(put(h, "work_on_bodies", J, "work of the fluid on bodies and beams of trunks", a->work[SURFACE_BODY]));
  PetscCall(put(h, "mass_residual", flat ? "kg/m" : "kg", "mass of the fluid - initial", a->residual[AUDIT_MASS]));
  PetscCall(put(h, "fluid_energy_residual", J, "energy of the fluid - initial - what it received", a->residual[AUDIT_FLUID]));
  PetscCall(put(h, "fluid_energy_scale", J, "largest term of that balance so far", a->scale[AUDIT_FLUID]));
  for (int k = flat ? 2 : 0; k < 3; k++) {
    const PetscBool *periodic = app->scene.periodic;
    if (periodic[(k + 1) % 3] || (periodic[(k + 2) % 3])) continue; /* markers that are put back jump */
    PetscCall(PetscSNPrintf(name, sizeof(name), "fluid_angular_%c", "xyz"[k]));
    PetscCall(put(h, name, L, "angular momentum of the fluid about the origin", a->L[k]));
    PetscCall(PetscSNPrintf(name, sizeof(name), "fluid_angular_residual_%c", "xyz"[k]));
    PetscCall(put(h, name, L, "that - initial - angular impulses of body force and surfaces", a->turn[k]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The audit's columns. */
PetscErrorCode AppAuditPut(App *app, const AppAudit *a, AppPut put, AppHistory h)
{
  const char *J = app->dim == 2 ? "J/m" : "J";

  PetscFunctionBegin;
  if (!app->scene.audit) PetscFunctionReturn(PETSC_SUCCESS);
  if (app->sph) PetscCall(put_fluid(app, a, put, h));
  if (app->ancf) {
    PetscCall(put(h, "beams_damped", J, "energy that damping took from the beams, less the work of moments at their ends",
                  a->integral[AUDIT_DAMPING]));
    PetscCall(put(h, "beams_energy_residual", J, "energy of the beams - initial - what they received", a->residual[AUDIT_BEAMS]));
  }
  if (app->rigid)
    PetscCall(put(h, "bodies_energy_residual", J,
                  "energy of the bodies - initial - work of the fluid: of dampers, contacts, prescribed motion",
                  a->residual[AUDIT_BODIES]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
