/*
  scenerigid.c - what a scene says about beams of rigid trunks, joints and short-range forces, and the solver objects of it.

  The trunks of a lumped beam become bodies <beam>_0, <beam>_1, ... after the scene's own ones, so that the fluid, the surfaces
  and the output treat them like any other body.
*/
#include "app.h"
#include <string.h>

static const char *const types[] = {"ancf", "lumped", NULL};
static const char *const joints[] = {"ball", "hinge", "slider", "spring", "linear", "bend", NULL};

#define COUNT(table) ((PetscInt)(sizeof(table) / sizeof((table)[0])))

/* type: 0 ancf, 1 lumped. */
static PetscErrorCode read_lumped(const char prefix[], const char title[], PetscInt *type, RigidLumpedSpec *spec)
{
  const AppOpt opt[] = {
      {OPT_CHOICE, "type", "Model of the beam: ANCF elements, or rigid trunks joined by rotational springs", type, types, NULL},
      {OPT_INT, "trunks", "lumped: number of rigid trunks, 0: as many as elements", &spec->trunks, NULL, NULL},
      {OPT_REAL, "poisson", "lumped: Poisson's ratio, for the torsion of the hinges", &spec->poisson, NULL, NULL},
      {OPT_REAL, "damper", "lumped: damper between the last end and the ground, N s/m", &spec->damping, NULL, NULL},
      {OPT_VEC, "damper_axis", "lumped: direction of that damper", spec->damperaxis, NULL, NULL},
      {OPT_REAL, "hinge_damping", "lumped: damping of each hinge, N m s/rad", &spec->hingedamping, NULL, NULL},
      {OPT_REAL, "hinge_yield", "lumped: moment at which a hinge yields, N m (default: never)", &spec->yield, NULL, NULL},
      {OPT_REAL, "hinge_rupture", "lumped: angle at which a hinge breaks, rad (default: never)", &spec->rupture, NULL, NULL},
  };

  PetscFunctionBegin;
  PetscCall(AppOptionsRead(prefix, title, COUNT(opt), opt));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The fields that both models of a beam share. */
static PetscErrorCode lumped_from_beam(const SceneBeam *beam, SceneLumped *lumped)
{
  static const RigidEnd end[] = {
      [ANCF_END_FREE] = RIGID_END_FREE, [ANCF_END_PIN] = RIGID_END_PIN, [ANCF_END_CLAMP] = RIGID_END_CLAMP};
  const AncfBeamSpec *from = &beam->spec;
  RigidLumpedSpec *spec = &lumped->spec;

  PetscFunctionBegin;
  PetscCheck(from->EA == PETSC_DECIDE, PETSC_COMM_SELF, PETSC_ERR_ARG_INCOMP,
             "beam_%s_EA = %g: a lumped beam has no axial elasticity; leave it out", beam->name, (double)from->EA);
  PetscCheck(from->axialdamping == 0 && from->bendingdamping == 0, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
             "beam_%s_axial_damping = %g, bending_damping = %g s: a lumped beam is damped by beam_%s_hinge_damping", beam->name,
             (double)from->axialdamping, (double)from->bendingdamping, beam->name);
  PetscCheck(from->pretension == 0 && from->curvature == 0, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
             "beam_%s_pretension = %g N, curvature = %g 1/m: a lumped beam is straight and without stress at first", beam->name,
             (double)from->pretension, (double)from->curvature);
  PetscCheck(from->inner == 0 && from->width == 0 && from->thickness == 0, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
             "beam_%s_inner = %g m, width = %g m, thickness = %g m: a lumped beam takes a diameter, or EI and rhoA", beam->name,
             (double)from->inner, (double)from->width, (double)from->thickness);
  PetscCheck(spec->trunks >= 0 && PetscMax(spec->trunks, from->elements) <= 1000000, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "beam_%s_trunks = %" PetscInt_FMT " must be 1 to 1e6 (0: as many as elements)", beam->name,
             spec->trunks ? spec->trunks : from->elements);
  PetscCall(PetscStrncpy(lumped->name, beam->name, APP_NAME_LEN));
  PetscCall(PetscArraycpy(spec->start, from->start, 3));
  PetscCall(PetscArraycpy(spec->end, from->end, 3));
  PetscCall(PetscArraycpy(spec->velocity, from->velocity, 3));
  if (!spec->trunks) spec->trunks = from->elements;
  spec->section[0] = from->diameter;
  spec->density = from->density;
  spec->young = from->young;
  spec->EI = from->EI;
  spec->rhoA = from->rhoA;
  spec->end0 = end[from->end0];
  spec->end1 = end[from->end1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Read the models of the beams; lumped ones go from s->beams to s->lumped. trunks: of all of them. */
PetscErrorCode AppSceneReadLumped(AppScene *s, PetscInt *trunks)
{
  RigidLumpedSpec all;
  PetscInt alltype = 0, kept = 0;
  PetscBool help;
  char prefix[128], title[128];

  PetscFunctionBegin;
  *trunks = 0;
  PetscCall(PetscOptionsHasHelp(NULL, &help));
  PetscCall(RigidLumpedSpecInit(&all));
  if (s->nbeams || help) PetscCall(read_lumped("beam_", "Lumped beams: the model of a beam; the same for all", &alltype, &all));
  PetscCall(PetscCalloc1(s->nbeams, &s->lumped));
  for (PetscInt b = 0; b < s->nbeams; b++) {
    SceneLumped *lumped = &s->lumped[s->nlumped];
    PetscInt type = alltype;
    lumped->spec = all;
    PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "beam_%s_", s->beams[b].name));
    PetscCall(PetscSNPrintf(title, sizeof(title), "Beam '%s': model", s->beams[b].name));
    PetscCall(read_lumped(prefix, title, &type, &lumped->spec));
    if (type == 0) {
      s->beams[kept++] = s->beams[b];
      continue;
    }
    PetscCall(lumped_from_beam(&s->beams[b], lumped));
    *trunks += lumped->spec.trunks;
    s->nlumped++;
  }
  s->nbeams = kept;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode read_joint(const char prefix[], const char title[], SceneJoint *j, PetscBool set[4])
{
  RigidJointSpec *spec = &j->spec;
  PetscInt type = (PetscInt)spec->type;
  const AppOpt opt[] = {
      {OPT_CHOICE, "type", "Kind of joint", &type, joints, NULL},
      {OPT_STRING, "a", "First body, or ground (needed)", j->a, NULL, &set[0]},
      {OPT_STRING, "b", "Second body, or ground", j->b, NULL, NULL},
      {OPT_VEC, "point", "Point of the joint, m (needed)", spec->point, NULL, &set[1]},
      {OPT_VEC, "pointb", "spring: its end on b, m (needed)", spec->pointb, NULL, &set[2]},
      {OPT_VEC, "axis", "hinge, slider, linear, bend: the axis, of any length (needed)", spec->axis, NULL, &set[3]},
      {OPT_REAL, "stiffness", "Spring: N m/rad (hinge, bend) or N/m (slider, spring, linear)", &spec->stiffness, NULL, NULL},
      {OPT_REAL, "damping", "Damper: N m s/rad (hinge, bend) or N s/m (slider, spring, linear)", &spec->damping, NULL, NULL},
      {OPT_REAL, "torsion", "bend: spring about the axis, N m/rad", &spec->torsion, NULL, NULL},
      {OPT_REAL, "torsion_damping", "bend: damper about the axis, N m s/rad", &spec->torsiondamping, NULL, NULL},
      {OPT_REAL, "rest", "Coordinate without force: m (spring: its length, -1: the initial one) or rad", &spec->rest, NULL, NULL},
      {OPT_REAL, "yield", "hinge, bend: moment at which it yields, N m (default: never)", &spec->yield, NULL, NULL},
      {OPT_REAL, "rupture", "hinge, bend: angle at which it breaks, rad (default: never)", &spec->rupture, NULL, NULL},
  };

  PetscFunctionBegin;
  PetscCall(AppOptionsRead(prefix, title, COUNT(opt), opt));
  spec->type = (RigidJointType)type;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode check_joint(const SceneJoint *j, const PetscBool set[4])
{
  const RigidJointType type = j->spec.type;
  const PetscBool axis = (PetscBool)(type != RIGID_JOINT_BALL && type != RIGID_JOINT_SPRING);

  PetscFunctionBegin;
  PetscCheck(set[0], PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "joint '%s' needs joint_%s_a: its first body", j->name, j->name);
  PetscCheck(set[1], PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "joint '%s' needs joint_%s_point", j->name, j->name);
  PetscCheck(set[2] || type != RIGID_JOINT_SPRING, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
             "joint '%s' is a spring and needs joint_%s_pointb", j->name, j->name);
  PetscCheck(set[3] || !axis, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "joint '%s' is a %s and needs joint_%s_axis", j->name,
             joints[type], j->name);
  PetscCheck(strcasecmp(j->a, j->b), PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "joint '%s' joins '%s' with itself", j->name, j->a);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Read the joints. */
PetscErrorCode AppSceneReadJoints(AppScene *s)
{
  AppNames names = {0, NULL};
  SceneJoint all;
  PetscBool help, allset[4] = {PETSC_FALSE, PETSC_FALSE, PETSC_FALSE, PETSC_FALSE}, set[4];
  const AppOpt opt[] = {{OPT_NAMES, "joints", "Names of the joints, separated by commas", &names, NULL, NULL}};
  char prefix[128], title[128];

  PetscFunctionBegin;
  PetscCall(AppOptionsRead(NULL, "Scene: joints", 1, opt));
  PetscCall(PetscOptionsHasHelp(NULL, &help));
  PetscCall(PetscMemzero(&all, sizeof(all)));
  PetscCall(RigidJointSpecInit(&all.spec));
  PetscCall(PetscStrncpy(all.b, "ground", sizeof(all.b)));
  if (names.n || help) PetscCall(read_joint("joint_", "Joints: the same for all; -joint_<name>_... for one", &all, allset));
  PetscCall(PetscCalloc1(names.n, &s->joints));
  s->njoints = names.n;
  for (PetscInt i = 0; i < names.n; i++) {
    s->joints[i] = all;
    PetscCall(PetscArraycpy(set, allset, 4));
    PetscCall(PetscStrncpy(s->joints[i].name, names.name[i], APP_NAME_LEN));
    PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "joint_%s_", names.name[i]));
    PetscCall(PetscSNPrintf(title, sizeof(title), "Joint '%s'", names.name[i]));
    PetscCall(read_joint(prefix, title, &s->joints[i], set));
    if (!help) PetscCall(check_joint(&s->joints[i], set));
  }
  PetscCall(PetscFree(names.name));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Add the trunks of the lumped beams, after the scene's own bodies. */
PetscErrorCode AppBuildLumped(App *app)
{
  AppScene *s = &app->scene;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < s->nlumped; i++) {
    SceneLumped *lumped = &s->lumped[i];
    AppDoing(app, "beam '%s'", lumped->name);
    PetscCall(RigidAddLumpedBeam(app->rigid, &lumped->spec, &lumped->body, NULL));
    for (PetscInt k = 0; k < lumped->spec.trunks; k++) {
      SceneBody *body = &s->bodies[s->nbodies];
      PetscCall(PetscSNPrintf(body->name, sizeof(body->name), "%s_%" PetscInt_FMT, lumped->name, k));
      for (PetscInt j = 0; j < s->nbodies; j++)
        PetscCheck(strcasecmp(s->bodies[j].name, body->name), PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
                   "its trunk %" PetscInt_FMT " would be called '%s', which is a body's name already", k, body->name);
      PetscCall(RigidGetBody(app->rigid, s->nbodies, &body->spec));
      s->nbodies++;
    }
    AppDoing(app, "%s", "");
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode find_body(const AppScene *s, const SceneJoint *j, const char name[], PetscInt *body)
{
  PetscFunctionBegin;
  *body = RIGID_GROUND;
  if (!strcasecmp(name, "ground")) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt b = 0; b < s->nbodies; b++)
    if (!strcasecmp(s->bodies[b].name, name)) {
      *body = b;
      PetscFunctionReturn(PETSC_SUCCESS);
    }
  SETERRQ(PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "joint '%s': '%s' is neither a body nor ground", j->name, name);
}

PetscErrorCode AppBuildJoints(App *app)
{
  AppScene *s = &app->scene;

  PetscFunctionBegin;
  PetscCheck(app->rigid || !s->njoints, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "joint '%s': the scene has no bodies",
             s->joints[0].name);
  for (PetscInt i = 0; i < s->njoints; i++) {
    SceneJoint *j = &s->joints[i];
    PetscCall(find_body(s, j, j->a, &j->spec.a));
    PetscCall(find_body(s, j, j->b, &j->spec.b));
    AppDoing(app, "joint '%s'", j->name);
    PetscCall(RigidAddJoint(app->rigid, &j->spec, &j->joint));
    AppDoing(app, "%s", "");
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Periods of the domain, m; the faces that are walls: a point and the normal of each. Nothing without fluid. */
static PetscInt domain(const App *app, PetscReal period[3], PetscReal x[6][3], PetscReal n[6][3])
{
  const AppScene *s = &app->scene;
  PetscInt walls = 0;

  for (PetscInt a = 0; a < 3; a++) period[a] = app->sph && a < app->dim && s->periodic[a] ? s->hi[a] - s->lo[a] : 0;
  for (int f = 0; f < 2 * app->dim && app->sph; f++) {
    if (!s->wall[f]) continue;
    for (int a = 0; a < 3; a++) {
      x[walls][a] = f % 2 ? s->hi[a] : s->lo[a];
      n[walls][a] = a == f / 2 ? (f % 2 ? -1 : 1) : 0;
    }
    walls++;
  }
  return walls;
}

/* Spacing of the fluid, period and walls of the domain, for the short-range forces; options given for the spacing win. */
PetscErrorCode AppBuildShortRange(App *app)
{
  PetscReal dp, period[3], x[6][3], n[6][3];
  const PetscInt walls = domain(app, period, x, n);
  PetscBool any = PETSC_FALSE;

  PetscFunctionBegin;
  if (!app->sph) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SphGetSpacing(app->sph, &dp));
  PetscCall(RigidSetShortRangeSpacing(app->rigid, dp));
  PetscCall(RigidSetPeriod(app->rigid, period));
  for (PetscInt w = 0; w < walls; w++) PetscCall(RigidAddWall(app->rigid, x[w], n[w]));
  for (PetscInt r = 0; r < app->scene.nregions; r++) any = (PetscBool)(any || app->scene.regions[r].wall);
  if (any) PetscCall(RigidAddWallGap(app->rigid, AppRegionGap, app));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The same for the ANCF beams, in 3D, when bodies and beams are there. */
PetscErrorCode AppBuildShortBeams(App *app)
{
  PetscReal period[3], x[6][3], n[6][3];
  const PetscInt walls = domain(app, period, x, n);
  const AppScene *s = &app->scene;
  PetscErrorCode ierr;
  int i, j;

  PetscFunctionBegin;
  if (!app->ancf || app->dim != 3) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CoupleShortCreate(PETSC_COMM_SELF, app->ancf, app->rigid, &app->shortrange));
  PetscCall(CoupleShortSetFromOptions(app->shortrange));
  PetscCall(CoupleShortSetPeriod(app->shortrange, period));
  PetscCall(CoupleShortSetAttach(app->shortrange, app->attach));
  for (PetscInt w = 0; w < walls; w++) PetscCall(CoupleShortAddWall(app->shortrange, x[w], n[w]));
  ierr = CoupleShortSetUp(app->shortrange);
  if (ierr && app->errors) {
    const char *text = app->errors->message;
    if (sscanf(text, "beam %d and beam %d", &i, &j) == 2 && i < s->nbeams && j < s->nbeams)
      AppDoing(app, "beams '%.40s' and '%.40s'", s->beams[i].name, s->beams[j].name);
    else if (sscanf(text, "beam %d and body %d", &i, &j) == 2 && i < s->nbeams && j < s->nbodies)
      AppDoing(app, "beam '%.40s' and body '%.40s'", s->beams[i].name, s->bodies[j].name);
    else if (sscanf(text, "beam %d", &i) == 1 && i < s->nbeams)
      AppDoing(app, "beam '%.40s'", s->beams[i].name);
  }
  PetscFunctionReturn(ierr);
}

/* Position and velocity (m, m/s) of the last end of a lumped beam. */
PetscErrorCode AppLumpedTip(App *app, PetscInt beam, PetscReal r[3], PetscReal v[3])
{
  const SceneLumped *lumped = &app->scene.lumped[beam];
  const PetscInt n = lumped->spec.trunks;
  PetscReal X[3], w[3], *x;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(3 * (size_t)(n + 1), &x));
  PetscCall(RigidGetLumpedNodes(app->rigid, lumped->body, n, x));
  PetscCall(PetscArraycpy(r, x + 3 * n, 3));
  PetscCall(PetscFree(x));
  PetscCall(RigidGetState(app->rigid, lumped->body + n - 1, X, NULL, v, w));
  for (int a = 0; a < 3; a++) {
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    v[a] += w[b] * (r[c] - X[c]) - w[c] * (r[b] - X[b]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuse bodies that overlap at the start; bodies that are no spheres need the fluid's spacing for it. */
PetscErrorCode AppCheckOverlap(App *app)
{
  const AppScene *s = &app->scene;
  PetscReal dp = 0;

  PetscFunctionBegin;
  if (app->sph) PetscCall(SphGetSpacing(app->sph, &dp));
  for (PetscInt b = 0; b < s->nbodies && !app->sph; b++) {
    const PetscReal *size = s->bodies[b].spec.size;
    for (int a = 0; a < 3; a++)
      if (size[a] > 0 && (dp == 0 || size[a] / 8 < dp)) dp = size[a] / 8;
  }
  if (dp == 0) PetscFunctionReturn(PETSC_SUCCESS); /* meshes only, without fluid */
  PetscCall(RigidCheckOverlap(app->rigid, dp));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The name of the surface with this group of markers; "fluid" for none of them. */
static const char *surface_name(const App *app, int group)
{
  for (PetscInt i = 0; i < app->nsurfaces; i++) {
    PetscInt g;
    if (!CoupleGetSurface(app->couple, i, NULL, &g) && g == group) return app->surfaces[i].name;
  }
  return "fluid";
}

/* Puts the scene's names before an error of the library that knows bodies, joints and surfaces by their numbers. */
void AppNameError(App *app)
{
  const AppScene *s = &app->scene;
  const char *text = app->errors ? app->errors->message : "";
  int i, j;

  if (!app->errors || app->errors->context[0]) return;
  if (sscanf(text, "Rigid bodies %d (%*[a-z]) and %d", &i, &j) == 2 && i >= 0 && j >= 0 && i < s->nbodies && j < s->nbodies)
    AppDoing(app, "bodies '%.40s' and '%.40s'", s->bodies[i].name, s->bodies[j].name);
  else if (sscanf(text, "Rigid body %d", &i) == 1 && i >= 0 && i < s->nbodies)
    AppDoing(app, "body '%.40s'", s->bodies[i].name);
  else if (sscanf(text, "markers %*d and %*d (groups %d and %d)", &i, &j) == 2)
    AppDoing(app, "'%.40s' and '%.40s'", surface_name(app, i), surface_name(app, j));
  else if (sscanf(text, "beam %d and body %d overlap", &i, &j) == 2 && i >= 0 && j >= 0 && i < s->nbeams && j < s->nbodies)
    AppDoing(app, "beam '%.40s' and body '%.40s'", s->beams[i].name, s->bodies[j].name);
  else if (sscanf(text, "beam %d and beam %d overlap", &i, &j) == 2 && i >= 0 && j >= 0 && i < s->nbeams && j < s->nbeams)
    AppDoing(app, "beams '%.40s' and '%.40s'", s->beams[i].name, s->beams[j].name);
  else if (sscanf(text, "Rigid joint %d (", &i) == 1)
    for (PetscInt k = 0; k < s->njoints; k++)
      if (s->joints[k].joint == i) AppDoing(app, "joint '%.40s'", s->joints[k].name);
}
