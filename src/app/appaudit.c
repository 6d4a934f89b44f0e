/*
  appaudit.c - balances of mass, momentum and energy of a run, one for each row of the history, and which of them is off.

  Energies of fluid, beams and bodies are balanced one by one, so that a residual tells where it arises:
    fluid   kinetic + compression - work of the body force + viscous heat + work on all surfaces
    beams   kinetic + elastic + potential - work of the fluid + energy that damping took - work of moments at their ends
            + elastic and taken of short-range forces - work of bodies on beams
    bodies  kinetic + potential + springs of joints + elastic of contacts + energy that lubrication, contacts and joints took
            - work of the fluid, of the beams, and of what drives the bodies
  each less its value at the first row; bodies are the free ones. Works are sums over all steps; heat, body force and damping are
  sums of trapezoids over the rows. Angular momenta likewise. docs/output.md says what the residuals hold.
*/
#include "app.h"
#include "sphopen.h"
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

/* Mass that came in less that which went out through openings since the start, kg; how much passed in all. */
static PetscErrorCode through_openings(App *app, PetscReal *net, PetscReal *passed)
{
  PetscFunctionBegin;
  *net = *passed = 0;
  for (PetscInt i = 0; i < app->scene.nopenings; i++) {
    SphFlow f;
    PetscCall(SphGetFlow(app->sph, i, &f));
    *net += f.massin - f.massout;
    *passed += f.massin + f.massout;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void set_residual(AppAudit *a, int term, PetscReal residual, PetscInt n, const PetscReal terms[])
{
  a->residual[term] = residual;
  for (PetscInt i = 0; i < n; i++) a->scale[term] = PetscMax(a->scale[term], PetscAbsReal(terms[i]));
}

/* What the fluid has done on the surfaces, and the angular impulse on all of them. */
static PetscErrorCode add_works(App *app, AppAudit *a, PetscReal impulse[3])
{
  PetscInt body = 0; /* surfaces of bodies come in the order of the scene's */

  PetscFunctionBegin;
  for (int k = 0; k < SURFACE_KINDS; k++) a->work[k] = 0;
  for (int k = 0; k < 3; k++) impulse[k] = a->freeturn[k] = a->beamturn[k] = 0;
  a->freework = 0;
  for (PetscInt i = 0; i < app->nsurfaces && app->couple; i++) {
    PetscReal work, turn[3];
    PetscCall(CoupleGetWork(app->couple, i, &work, turn));
    a->work[app->surfaces[i].kind] += work;
    for (int k = 0; k < 3; k++) impulse[k] += turn[k];
    if (app->surfaces[i].kind == SURFACE_BEAM)
      for (int k = 0; k < 3; k++) a->beamturn[k] += turn[k];
    if (app->surfaces[i].kind != SURFACE_BODY || app->scene.bodies[body++].spec.motion != RIGID_FREE) continue;
    a->freework += work;
    for (int k = 0; k < 3; k++) a->freeturn[k] += turn[k];
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
  PetscReal cs, small, net, passed;
  PetscInt left;
  CoupleBalance balance;

  PetscFunctionBegin;
  PetscCall(SphGetCounts(app->sph, NULL, NULL, &left));
  if (!(a->rows > 0)) {
    a->energy[AUDIT_FLUID] = E + W;
    for (int k = 0; k < 3; k++) a->angular[k] = a->L[k] + impulse[k];
  }
  PetscCall(through_openings(app, &net, &passed));
  if (!(a->rows > 0) || (PetscReal)left != a->left) a->mass = sums->mass - net; /* markers that leave take their mass along */
  a->left = (PetscReal)left;
  PetscCall(SphGetSoundSpeed(app->sph, &cs));
  small = 1e-3 * sums->mass * cs / 10; /* of the momentum and energy of a fluid at a tenth of the speed of sound */
  set_residual(a, AUDIT_MASS, sums->mass - a->mass - net, 2, (PetscReal[]){sums->mass, passed});
  PetscCall(CoupleGetBalance(app->couple, &balance));
  set_residual(a, AUDIT_MOMENTUM, norm3(balance.residual), 2, (PetscReal[]){balance.scale, small});
  set_residual(a, AUDIT_FLUID, E + W - a->energy[AUDIT_FLUID] - got[AUDIT_BODY] + got[AUDIT_HEAT], 6,
               (PetscReal[]){sums->kinetic, sums->internal, got[AUDIT_BODY], got[AUDIT_HEAT], W, small * cs / 20});
  for (int k = 0; k < 3; k++) a->turn[k] = a->L[k] + impulse[k] - a->angular[k] - got[AUDIT_TORQUE + k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What is in energy[] at the first row is taken off, so that a sum that was not 0 then does no harm. */
static PetscReal since_start(AppAudit *a, int term, PetscReal sum)
{
  if (!(a->rows > 0)) a->energy[term] = sum;
  return sum - a->energy[term];
}

static void angular_residual(AppAudit *a, int part, const PetscReal impulse[3])
{
  for (int k = 0; k < 3; k++) {
    if (!(a->rows > 0)) a->L0[part][k] = a->part[part][k] - impulse[k];
    a->partturn[part][k] = a->part[part][k] - impulse[k] - a->L0[part][k];
  }
}

static PetscErrorCode beam_residuals(App *app, AppAudit *a)
{
  const PetscReal W = a->work[SURFACE_BEAM], D = a->integral[AUDIT_DAMPING], bodies = a->links.beams + a->near.beams;
  PetscReal kinetic, elastic, potential, impulse[3];

  PetscFunctionBegin;
  PetscCall(AncfGetEnergy(app->ancf, &kinetic, &elastic, &potential));
  set_residual(a, AUDIT_BEAMS,
               since_start(a, AUDIT_BEAMS, kinetic + elastic + potential + a->near.elastic + a->near.taken - W + D - bodies), 7,
               (PetscReal[]){kinetic, elastic, W, D, a->near.elastic, a->near.taken, bodies});
  PetscCall(AncfGetMomentum(app->ancf, NULL, a->part[0]));
  for (int k = 0; k < 3; k++) impulse[k] = a->beamturn[k] + app->beamturn[k] + a->links.turnbeams[k] + a->near.turnbeams[k];
  angular_residual(a, 0, impulse);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode body_residuals(App *app, AppAudit *a)
{
  const PetscReal W = a->freework, beams = a->links.bodies + a->near.bodies;
  const RigidAudit *b = &a->bodies;
  PetscReal springs, potential, impulse[3];

  PetscFunctionBegin;
  PetscCall(RigidGetAudit(app->rigid, &a->bodies));
  PetscCall(RigidGetEnergy(app->rigid, NULL, &potential));
  PetscCall(RigidGetJointEnergy(app->rigid, &springs));
  set_residual(
      a, AUDIT_BODIES,
      since_start(a, AUDIT_BODIES,
                  b->kinetic + potential + springs + b->contact + b->lubrication + b->impact + b->joints - b->driven - W - beams),
      9, (PetscReal[]){b->kinetic, springs, b->contact, b->lubrication, b->impact, b->joints, b->driven, W, beams});
  PetscCall(PetscArraycpy(a->part[1], b->angular, 3));
  for (int k = 0; k < 3; k++) impulse[k] = a->freeturn[k] + b->turn[k] + a->links.turnbodies[k] + a->near.turnbodies[k];
  angular_residual(a, 1, impulse);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of weight and supports on the beams; attachments are not among these, as they know their mean over the step. */
static PetscErrorCode get_torque(App *app, PetscReal T[3])
{
  CoupleExchange links;

  PetscFunctionBegin;
  PetscCall(AncfGetTorque(app->ancf, T));
  if (!app->attach) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CoupleAttachGetExchange(app->attach, &links));
  for (int k = 0; k < 3; k++) T[k] -= links.torque[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Angular impulse of weight and supports on the beams in a step: supports vary too fast for sums over the rows. */
PetscErrorCode AppAuditStep(App *app, PetscReal dt)
{
  PetscReal T[3];

  PetscFunctionBegin;
  if (!app->scene.audit || !app->ancf) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(get_torque(app, T));
  for (int k = 0; k < 3; k++) {
    app->beamturn[k] += 0.5 * dt * (app->beamtorque[k] + T[k]);
    app->beamtorque[k] = T[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode structure_residuals(App *app, AppAudit *a)
{
  PetscFunctionBegin;
  if (app->attach) PetscCall(CoupleAttachGetExchange(app->attach, &a->links));
  if (app->shortrange) PetscCall(CoupleShortGetExchange(app->shortrange, &a->near));
  if (app->ancf && !(a->rows > 0)) { /* the sum over steps begins here */
    for (int k = 0; k < 3; k++) app->beamturn[k] = 0;
    PetscCall(get_torque(app, app->beamtorque));
  }
  if (app->ancf) PetscCall(beam_residuals(app, a));
  if (app->rigid) PetscCall(body_residuals(app, a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Markers that leave take momentum and energy along; loads that grow change the potential energy. */
static PetscBool is_closed(const App *app, int term, const AppAudit *a)
{
  if (term == AUDIT_BEAMS) return (PetscBool)(app->loadramp == 0);
  if (term == AUDIT_FLUID && app->scene.nopenings) return PETSC_FALSE; /* what passes them is not in the balance */
  return (PetscBool)((term != AUDIT_MOMENTUM && term != AUDIT_FLUID) || a->left == 0);
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
    if (a->rows < 10) continue;
    a->worst[k] = PetscMax(a->worst[k], part);
    if (!(part > limit) || limit < 0 || a->warned[k] != 0) continue;
    if (!is_closed(app, k, a)) continue;
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

static PetscErrorCode near_forces(PetscBool *near)
{
  PetscBool contact;

  PetscFunctionBegin;
  PetscCall(PetscOptionsHasName(NULL, NULL, "-rigid_lubrication_viscosity", near));
  PetscCall(PetscOptionsHasName(NULL, NULL, "-rigid_contact_modulus", &contact));
  *near = (PetscBool)(*near || contact);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of one part; not about axes that periodic sides turn into each other: what is put back jumps. */
static PetscErrorCode put_angular(const App *app, const char part[], const PetscReal L[3], const PetscReal residual[3],
                                  AppPut put, AppHistory h)
{
  const char *unit = app->dim == 2 ? "kg m/s" : "kg m^2/s";
  const PetscBool *periodic = app->scene.periodic;
  char name[64], what[128];

  PetscFunctionBegin;
  for (int k = app->dim == 2 ? 2 : 0; k < 3; k++) {
    if (periodic[(k + 1) % 3] || periodic[(k + 2) % 3]) continue;
    snprintf(name, sizeof(name), "%s_angular_%c", part, "xyz"[k]);
    snprintf(what, sizeof(what), "angular momentum of the %s about the origin", part);
    PetscCall(put(h, name, unit, what, L[k]));
    snprintf(name, sizeof(name), "%s_angular_residual_%c", part, "xyz"[k]);
    PetscCall(put(h, name, unit, "that - initial - angular impulses received", residual[k]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode put_fluid(App *app, const AppAudit *a, AppPut put, AppHistory h)
{
  const PetscBool flat = (PetscBool)(app->dim == 2);
  const char *J = flat ? "J/m" : "J", *W = flat ? "W/m" : "W";

  PetscFunctionBegin;
  PetscCall(put(h, "fluid_heat", J, "viscous heat since the start", a->integral[AUDIT_HEAT]));
  PetscCall(put(h, "fluid_heat_power", W, "power of viscous forces that becomes heat", a->rate[AUDIT_HEAT]));
  PetscCall(put(h, "fluid_pressure_power", W, "power of pressure forces on the fluid's relative motion", a->pressure));
  PetscCall(put(h, "body_force_work", J, "work of the body force on the fluid", a->integral[AUDIT_BODY]));
  PetscCall(put(h, "work_on_walls", J, "work of the fluid on walls", a->work[SURFACE_WALL]));
  PetscCall(put(h, "work_on_beams", J, "work of the fluid on beams", a->work[SURFACE_BEAM]));
  PetscCall(put(h, "work_on_bodies", J, "work of the fluid on bodies and beams of trunks", a->work[SURFACE_BODY]));
  PetscCall(put(h, "mass_residual", flat ? "kg/m" : "kg", "mass of the fluid - initial - what openings let in",
                a->residual[AUDIT_MASS]));
  PetscCall(put(h, "fluid_energy_residual", J, "energy of the fluid - initial - what it received", a->residual[AUDIT_FLUID]));
  PetscCall(put(h, "fluid_energy_scale", J, "largest term of that balance so far", a->scale[AUDIT_FLUID]));
  PetscCall(put_angular(app, "fluid", a->L, a->turn, put, h));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What contacts, joints and drives do, where there are any. */
static PetscErrorCode put_bodies(App *app, const AppAudit *a, AppPut put, AppHistory h)
{
  const char *J = app->dim == 2 ? "J/m" : "J";
  const AppScene *s = &app->scene;
  PetscBool near;

  PetscFunctionBegin;
  PetscCall(near_forces(&near));
  if (near) {
    PetscCall(put(h, "bodies_contact", J, "elastic energy in contacts of bodies", a->bodies.contact));
    PetscCall(put(h, "bodies_impact", J, "energy that the damping of contacts took since the start", a->bodies.impact));
    PetscCall(
        put(h, "bodies_lubrication", J, "energy that lubrication between bodies took since the start", a->bodies.lubrication));
  }
  if (s->njoints || s->nlumped)
    PetscCall(
        put(h, "joints_taken", J, "energy that dampers, yield and rupture of joints took since the start", a->bodies.joints));
  PetscCall(put(h, "bodies_driven", J, "work of prescribed bodies and permanent torques on free bodies", a->bodies.driven));
  PetscCall(
      put(h, "bodies_energy_residual", J, "energy of the free bodies - initial - what they received", a->residual[AUDIT_BODIES]));
  PetscCall(put_angular(app, "bodies", a->part[1], a->partturn[1], put, h));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode put_beams(App *app, const AppAudit *a, AppPut put, AppHistory h)
{
  const char *J = app->dim == 2 ? "J/m" : "J";
  PetscBool near;

  PetscFunctionBegin;
  PetscCall(near_forces(&near));
  PetscCall(put(h, "beams_damped", J, "energy that damping took from the beams, less the work of moments at their ends",
                a->integral[AUDIT_DAMPING]));
  if (near) {
    PetscCall(put(h, "beams_contact", J, "elastic energy in contacts of beams", a->near.elastic));
    PetscCall(put(h, "beams_near_taken", J, "energy that lubrication and contacts of beams took since the start", a->near.taken));
  }
  if (app->rigid)
    PetscCall(put(h, "beams_from_bodies", J, "work of bodies on beams by links and short-range forces",
                  a->links.beams + a->near.beams));
  PetscCall(put(h, "beams_energy_residual", J, "energy of the beams - initial - what they received", a->residual[AUDIT_BEAMS]));
  PetscCall(put_angular(app, "beams", a->part[0], a->partturn[0], put, h));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The audit's columns. */
PetscErrorCode AppAuditPut(App *app, const AppAudit *a, AppPut put, AppHistory h)
{
  PetscFunctionBegin;
  if (!app->scene.audit) PetscFunctionReturn(PETSC_SUCCESS);
  if (app->sph) PetscCall(put_fluid(app, a, put, h));
  if (app->ancf) PetscCall(put_beams(app, a, put, h));
  if (app->rigid) PetscCall(put_bodies(app, a, put, h));
  PetscFunctionReturn(PETSC_SUCCESS);
}
