/* scene.c - the options of a scene: domain, fluid, walls, beams, bodies, run and output. */
#include "app.h"
#include <math.h>
#include <ctype.h>
#include <string.h>

const char *const SceneFields[] = {"velocity", "density", "pressure", "group", "acceleration", NULL};
const char *const SceneFaces[] = {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax", NULL};

static const char *const axes[] = {"x", "y", "z", NULL};
static const char *const buoyancies[] = {"resolved", "archimedes", NULL};
static const char *const pressures[] = {"hydrostatic", "zero", NULL};
static const char *const ends[] = {"free", "pin", "clamp", NULL};
static const char *const shapes[] = {"sphere", "box", "cylinder", "ellipsoid", "capsule", "mesh", NULL};
static const char *const motions[] = {"fixed", "prescribed", "free", NULL};
static const char *const locks[] = {"x", "y", "z", "rx", "ry", "rz", NULL};
static const char *const faults[] = {"x",      "v",      "rho",    "beam_x",     "beam_slope", "beam_v", "beam_slope_v",
                                     "body_x", "body_q", "body_v", "body_omega", NULL};

#define COUNT(table) ((PetscInt)(sizeof(table) / sizeof((table)[0])))

typedef struct {
  PetscBool lo, hi, fluidlo, fluidhi, tend, dt, outevery, histevery, pressure;
} SceneSet;

/* scene_name defaults to the file's name. */
static PetscErrorCode default_name(const char file[], char name[])
{
  const char *base = strrchr(file, '/');
  size_t n;

  PetscFunctionBegin;
  base = base ? base + 1 : file;
  n = strcspn(base, ".");
  PetscCall(PetscStrncpy(name, n ? base : "scene", PetscMin(n ? n + 1 : 6, 33)));
  for (char *c = name; *c; c++)
    if (!isalnum((unsigned char)*c)) *c = '_';
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode read_domain(AppScene *s, SceneSet *set)
{
  PetscInt buoyancy = (PetscInt)s->buoyancy, pressure = (PetscInt)s->pressure;
  char key[24][32];
  AppOpt wall[24];
  const AppOpt opt[] = {
      {OPT_VEC, "gravity", "Acceleration of gravity, m/s^2", s->gravity, NULL, NULL},
      {OPT_CHOICE, "buoyancy", "Gravity on the fluid: resolved as a body force, or left out with weights reduced by Archimedes",
       &buoyancy, buoyancies, NULL},
      {OPT_VEC, "domain_lo", "Lower corner of the domain, m (needed with fluid)", s->lo, NULL, &set->lo},
      {OPT_VEC, "domain_hi", "Upper corner of the domain, m (needed with fluid)", s->hi, NULL, &set->hi},
      {OPT_SUBSET, "domain_periodic", "Periodic axes", s->periodic, axes, NULL},
      {OPT_SUBSET, "walls", "Faces of the domain that are walls", s->wall, SceneFaces, NULL},
      {OPT_BOOL, "fluid", "Whether there is a fluid", &s->fluid, NULL, NULL},
      {OPT_VEC, "fluid_lo", "Lower corner of the box filled with fluid, m (default: the domain's)", s->fluidlo, NULL,
       &set->fluidlo},
      {OPT_VEC, "fluid_hi", "Upper corner of the box filled with fluid, m (default: the domain's)", s->fluidhi, NULL,
       &set->fluidhi},
      {OPT_VEC, "fluid_velocity", "Initial velocity of the fluid, m/s", s->fluidvelocity, NULL, NULL},
      {OPT_REAL, "body_force_ramp", "Time over which sph_body_force comes up linearly from 0, s (0: at once)", &s->forceramp,
       NULL, NULL},
      {OPT_STRING, "body_force_file", "CSV file with columns t, fx, fy, fz (s, m/s^2): body force on top of sph_body_force",
       s->forcefile, NULL, NULL},
      {OPT_CHOICE, "fluid_pressure", "Initial pressure (default: hydrostatic when gravity is resolved)", &pressure, pressures,
       &set->pressure},
  };

  PetscFunctionBegin;
  PetscCall(AppOptionsRead(NULL, "Scene: domain and fluid", COUNT(opt), opt));
  s->buoyancy = (SceneBuoyancy)buoyancy;
  s->pressure = (ScenePressure)pressure;
  if (!set->pressure) s->pressure = s->buoyancy == BUOYANCY_RESOLVED ? PRESSURE_HYDROSTATIC : PRESSURE_ZERO;
  if (!set->fluidlo) PetscCall(PetscArraycpy(s->fluidlo, s->lo, 3));
  if (!set->fluidhi) PetscCall(PetscArraycpy(s->fluidhi, s->hi, 3));
  for (PetscInt i = 0; i < 6; i++) {
    SceneWall *w = &s->walls[i];
    static const char *const names[] = {"velocity", "motion", "omega", "pivot"};
    for (PetscInt k = 0; k < 4; k++) PetscCall(PetscSNPrintf(key[4 * i + k], sizeof(key[0]), "%s_%s", SceneFaces[i], names[k]));
    wall[4 * i] =
        (AppOpt){OPT_VEC, key[4 * i], "Velocity of this wall, along itself unless it moves, m/s", s->wallvelocity[i], NULL, NULL};
    wall[4 * i + 1] = (AppOpt){
        OPT_STRING,
        key[4 * i + 1],
        "How this wall moves bodily: constant (its velocity and omega), or a CSV file with columns t, vx, vy, vz, wx, wy, wz",
        w->motion,
        NULL,
        NULL};
    wall[4 * i + 2] = (AppOpt){OPT_VEC,  key[4 * i + 2], "Angular velocity of this wall when its motion is constant, rad/s",
                               w->omega, NULL,           NULL};
    wall[4 * i + 3] =
        (AppOpt){OPT_VEC,  key[4 * i + 3], "Point that this wall turns about, moving along, m (needed when it turns)",
                 w->pivot, NULL,           &w->setpivot};
  }
  PetscCall(AppOptionsRead("wall_", "Scene: walls", 24, wall));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode read_fault(AppScene *s, const char text[])
{
  char copy[64], *part[3], *end;

  PetscFunctionBegin;
  s->faultstep = -1;
  if (!text[0]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscStrncpy(copy, text, sizeof(copy)));
  part[0] = strtok(copy, ",");
  part[1] = strtok(NULL, ",");
  part[2] = strtok(NULL, ",");
  PetscCheck(part[0] && part[1] && part[2], PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "fault_nan: '%s' is not field,marker,step",
             text);
  for (s->faultfield = 0; faults[s->faultfield] && strcmp(faults[s->faultfield], part[0]);) s->faultfield++;
  PetscCheck(
      faults[s->faultfield], PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
      "fault_nan: field '%s' is none of x, v, rho, beam_x, beam_slope, beam_v, beam_slope_v, body_x, body_q, body_v, body_omega",
      part[0]);
  s->faultmarker = (PetscInt)strtol(part[1], &end, 10);
  PetscCheck(!*end && s->faultmarker >= 0, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "fault_nan: number '%s' must be 0 or more",
             part[1]);
  s->faultstep = (PetscInt)strtol(part[2], &end, 10);
  PetscCheck(!*end && s->faultstep >= 0, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "fault_nan: step '%s' must be 0 or more", part[2]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode read_run(AppScene *s, SceneSet *set)
{
  char name[PETSC_MAX_PATH_LEN], fault[PETSC_MAX_PATH_LEN] = "";
  const AppOpt opt[] = {
      {OPT_STRING, "scene_name", "Name of the scene: letters, digits, '_' (default: the file's name)", name, NULL, NULL},
      {OPT_REAL, "time_end", "Time at which the run ends, s (needed)", &s->tend, NULL, &set->tend},
      {OPT_REAL, "time_step", "Time step, s (needed without fluid; with fluid: sph_dt)", &s->dt, NULL, &set->dt},
      {OPT_STRING, "output_dir", "Folder of the results (default: out_<scene_name>)", s->outdir, NULL, NULL},
      {OPT_BOOL, "output_overwrite", "Replace the results of an earlier run in output_dir", &s->overwrite, NULL, NULL},
      {OPT_REAL, "output_every", "Time between frames, s; 0: every step (default: time_end/40)", &s->outevery, NULL,
       &set->outevery},
      {OPT_REAL, "history_every", "Time between rows of the history, s; 0: every step (default: time_end/500)", &s->histevery,
       NULL, &set->histevery},
      {OPT_SUBSET, "output_fields", "Fields of a frame (default: velocity, density, pressure, group)", s->field, SceneFields,
       NULL},
      {OPT_REAL, "progress_every", "Wall time between progress lines, s; 0: none", &s->progressevery, NULL, NULL},
      {OPT_REAL, "checkpoint_every",
       "Time between checkpoints, s; 0: every step; -1: none but when the run is interrupted or fails", &s->checkpointevery, NULL,
       NULL},
      {OPT_INT, "checkpoint_keep", "Checkpoints kept, the last ones", &s->checkpointkeep, NULL, NULL},
      {OPT_STRING, "restart", "Checkpoint to go on from, or a folder whose last one is taken", s->restart, NULL, NULL},
      {OPT_BOOL, "restart_changed", "Go on although options differ from those of the checkpoint", &s->restartchanged, NULL, NULL},
      {OPT_STRING, "fault_nan",
       "For tests: put NaN in field,number,step before that step (x|v|rho of a marker, beam_x|beam_slope|beam_v|beam_slope_v of "
       "a node, body_x|body_q|body_v|body_omega)",
       fault, NULL, NULL},
      {OPT_REAL, "fault_value", "For tests: the value that fault_nan puts; 0: NaN", &s->faultvalue, NULL, NULL},
      {OPT_BOOL, "audit", "Balances of energy and angular momentum in the history: a sum over pairs for each row", &s->audit,
       NULL, NULL},
      {OPT_REAL, "audit_momentum", "Warn when the residual of the momentum exceeds this part of its largest term; -1: never",
       &s->auditmomentum, NULL, NULL},
      {OPT_REAL, "audit_energy", "Warn when the residual of an energy exceeds this part of its largest term; -1: never",
       &s->auditenergy, NULL, NULL},
  };

  PetscFunctionBegin;
  PetscCall(PetscStrncpy(name, s->name, sizeof(name)));
  PetscCall(AppOptionsRead(NULL, "Scene: run and output", COUNT(opt), opt));
  PetscCall(AppNameCheck("scene_name", name));
  PetscCall(PetscStrncpy(s->name, name, sizeof(s->name)));
  if (!s->outdir[0]) PetscCall(PetscSNPrintf(s->outdir, sizeof(s->outdir), "out_%s", s->name));
  if (!set->outevery) s->outevery = s->tend / 40;
  if (!set->histevery) s->histevery = s->tend / 500;
  PetscCheck(s->checkpointevery >= 0 || s->checkpointevery == -1, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "checkpoint_every = %g s: must be >= 0, or -1 for none", (double)s->checkpointevery);
  PetscCheck(s->checkpointkeep >= 1, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "checkpoint_keep = %" PetscInt_FMT ": must be at least 1", s->checkpointkeep);
  PetscCheck(s->auditmomentum > 0 || s->auditmomentum == -1, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "audit_momentum = %g: must be > 0, or -1 for never", (double)s->auditmomentum);
  PetscCheck(s->auditenergy > 0 || s->auditenergy == -1, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "audit_energy = %g: must be > 0, or -1 for never", (double)s->auditenergy);
  PetscCall(read_fault(s, fault));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode read_beam(const char prefix[], const char title[], SceneBeam *beam, PetscBool set[5])
{
  AncfBeamSpec *spec = &beam->spec;
  PetscInt end0 = (PetscInt)spec->end0, end1 = (PetscInt)spec->end1;
  PetscBool stiff[3] = {PETSC_FALSE, PETSC_FALSE, PETSC_FALSE};
  PetscReal *derived[3] = {&spec->EA, &spec->EI, &spec->rhoA};
  const AppOpt opt[] = {
      {OPT_VEC, "start", "First end of the axis, m (needed)", spec->start, NULL, &set[0]},
      {OPT_VEC, "end", "Last end of the axis, m (needed)", spec->end, NULL, &set[1]},
      {OPT_INT, "elements", "Number of ANCF elements", &spec->elements, NULL, &set[2]},
      {OPT_REAL, "diameter", "Diameter of the circular section; in 2D the thickness of a plate of unit depth, m (needed)",
       &spec->diameter, NULL, NULL},
      {OPT_REAL, "density", "Density of the material, kg/m^3 (needed)", &spec->density, NULL, NULL},
      {OPT_REAL, "young", "Young's modulus E, Pa; in 2D that of the plate, E/(1-nu^2) (needed)", &spec->young, NULL, NULL},
      {OPT_REAL, "EA", "Axial stiffness in place of E and diameter, N; 2D: N/m (-1: derived)", &spec->EA, NULL, &stiff[0]},
      {OPT_REAL, "EI", "Bending stiffness in place of E and diameter, N m^2; 2D: N m (-1: derived)", &spec->EI, NULL, &stiff[1]},
      {OPT_REAL, "rhoA", "Mass per length in place of density and diameter, kg/m; 2D: kg/m^2 (-1: derived)", &spec->rhoA, NULL,
       &stiff[2]},
      {OPT_REAL, "axial_damping", "Retardation time of the axial strain (Kelvin-Voigt), s", &spec->axialdamping, NULL, NULL},
      {OPT_REAL, "bending_damping", "Retardation time of the curvature (Kelvin-Voigt), s", &spec->bendingdamping, NULL, NULL},
      {OPT_REAL, "inner", "Inner diameter of a tube, m", &spec->inner, NULL, NULL},
      {OPT_REAL, "width", "Rectangular section in place of diameter: along the normal, m", &spec->width, NULL, NULL},
      {OPT_REAL, "thickness", "Rectangular section: across the normal, m; a square needs no normal", &spec->thickness, NULL,
       NULL},
      {OPT_REAL, "pretension", "Axial force in the initial shape, N; 2D: N/m", &spec->pretension, NULL, NULL},
      {OPT_REAL, "curvature", "Curvature of the axis at first, an arc from start to end without stress, 1/m", &spec->curvature,
       NULL, &set[3]},
      {OPT_VEC, "normal", "Axis that a curved beam turns about; the beam moves in the plane across, other motion is refused",
       spec->normal, NULL, &set[4]},
      {OPT_VEC, "velocity", "Initial velocity, m/s", spec->velocity, NULL, NULL},
      {OPT_VEC, "point_load", "Permanent force of fixed direction at one point, N; 2D: N/m", beam->pointload, NULL, NULL},
      {OPT_REAL, "point_load_at", "Where it acts, as a fraction of the length from the start", &beam->pointat, NULL, NULL},
      {OPT_VEC, "line_load", "Permanent load of fixed direction per length of the unstrained axis, N/m; 2D: N/m^2",
       beam->lineload, NULL, NULL},
      {OPT_VEC, "moment0", "Moment at the first end, across the beam, following it as it bends about this axis, N m; 2D: N",
       beam->moment[0], NULL, NULL},
      {OPT_VEC, "moment1", "Moment at the last end, N m; 2D: N", beam->moment[1], NULL, NULL},
      {OPT_REAL, "load_ramp", "Time over which these loads come up linearly from 0, s (0: at once)", &beam->ramp, NULL, NULL},
      {OPT_STRING, "mesh", "Gmsh file whose lines give the axis, and several beams <name>_p0, <name>_p1, ... where they branch",
       beam->mesh, NULL, NULL},
      {OPT_STRING, "group", "Physical name of the lines in the mesh (default: the beam's name)", beam->group, NULL, NULL},
      {OPT_CHOICE, "end0", "Support of the first end", &end0, ends, NULL},
      {OPT_CHOICE, "end1", "Support of the last end", &end1, ends, NULL},
  };

  PetscFunctionBegin;
  PetscCall(AppOptionsRead(prefix, title, COUNT(opt), opt));
  for (PetscInt i = 0; i < 3; i++)
    PetscCheck(!stiff[i] || *derived[i] > 0 || *derived[i] == -1, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "%s%s = %g must be positive", prefix, opt[6 + i].key, (double)*derived[i]);
  spec->end0 = (AncfEnd)end0;
  spec->end1 = (AncfEnd)end1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode read_body(const char prefix[], const char title[], SceneBody *body, PetscBool set[2])
{
  RigidBodySpec *spec = &body->spec;
  PetscInt shape = (PetscInt)spec->shape, motion = (PetscInt)spec->motion;
  PetscBool mass = PETSC_FALSE, inertia = PETSC_FALSE, owngravity = body->owngravity;
  const AppOpt opt[] = {
      {OPT_CHOICE, "shape", "Shape", &shape, shapes, NULL},
      {OPT_CHOICE, "motion", "Motion", &motion, motions, NULL},
      {OPT_VEC, "size",
       "sphere: radius,0,0; box: edges; cylinder, capsule: radius,length,0; ellipsoid: semi-axes; mesh: none; m (needed)",
       spec->size, NULL, &set[0]},
      {OPT_REAL, "density", "Density, kg/m^3", &spec->density, NULL, NULL},
      {OPT_VEC, "position", "Centre, m (needed)", spec->position, NULL, &set[1]},
      {OPT_AXISANGLE, "axisangle", "Initial orientation: axis x,y,z and angle, rad", spec->axisangle, NULL, NULL},
      {OPT_VEC, "velocity", "Velocity, m/s", spec->velocity, NULL, NULL},
      {OPT_VEC, "omega", "Angular velocity in the space frame, rad/s", spec->omega, NULL, NULL},
      {OPT_REAL, "mass", "Mass in place of density, kg (default: derived)", &spec->mass, NULL, &mass},
      {OPT_VEC, "inertia", "Principal moments in place of density, kg m^2 (default: derived)", spec->inertia, NULL, &inertia},
      {OPT_SUBSET, "lock", "Motions that a free body may not make: along x, y, z and about x, y, z", spec->lock, locks, NULL},
      {OPT_VEC, "gravity", "Acceleration of gravity of this body, m/s^2 (default: the scene's)", body->gravity, NULL,
       &owngravity},
      {OPT_VEC, "load", "Constant force in the centre of mass, N", body->load, NULL, NULL},
      {OPT_VEC, "torque", "Constant torque of fixed direction, N m", body->torque, NULL, NULL},
      {OPT_STRING, "file", "mesh: STL or OBJ file of the closed surface (needed for a mesh)", body->file, NULL, NULL},
      {OPT_REAL, "scale", "mesh: metres per unit of the file", &body->scale, NULL, NULL},
  };

  PetscFunctionBegin;
  PetscCall(AppOptionsRead(prefix, title, COUNT(opt), opt));
  PetscCheck(!mass || spec->mass > 0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "%smass = %g kg must be positive", prefix,
             (double)spec->mass);
  for (int a = 0; a < 3 && inertia; a++)
    PetscCheck(spec->inertia[a] > 0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "%sinertia = %g,%g,%g kg m^2: each moment must be positive", prefix, (double)spec->inertia[0],
               (double)spec->inertia[1], (double)spec->inertia[2]);
  body->owngravity = owngravity;
  spec->shape = (RigidShape)shape;
  spec->motion = (RigidMotion)motion;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Room for n beams, and the beams so far in it. */
static PetscErrorCode grow_beams(AppScene *s, PetscInt n)
{
  SceneBeam *more;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(n, &more));
  PetscCall(PetscArraycpy(more, s->beams, s->nbeams));
  PetscCall(PetscFree(s->beams));
  s->beams = more;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One piece of a group of lines may have options of its own. */
static PetscErrorCode read_piece(SceneBeam *beam)
{
  static const char *const keys[] = {"start", "end", "elements", "curvature", "normal"};
  char prefix[128], title[128], mesh[PETSC_MAX_PATH_LEN], group[PETSC_MAX_PATH_LEN];
  PetscBool set[5] = {PETSC_FALSE, PETSC_FALSE, PETSC_FALSE, PETSC_FALSE, PETSC_FALSE};

  PetscFunctionBegin;
  PetscCall(PetscArraycpy(mesh, beam->mesh, PETSC_MAX_PATH_LEN));
  PetscCall(PetscArraycpy(group, beam->group, PETSC_MAX_PATH_LEN));
  PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "beam_%s_", beam->name));
  PetscCall(PetscSNPrintf(title, sizeof(title), "Beam '%s'", beam->name));
  PetscCall(read_beam(prefix, title, beam, set));
  for (int k = 0; k < 5; k++)
    PetscCheck(!set[k], PETSC_COMM_SELF, PETSC_ERR_ARG_INCOMP, "beam '%s': %s is given but comes from its mesh '%s'", beam->name,
               keys[k], mesh);
  PetscCheck(!strcmp(mesh, beam->mesh) && !strcmp(group, beam->group), PETSC_COMM_SELF, PETSC_ERR_ARG_INCOMP,
             "beam '%s': it is a piece of the mesh '%s', group '%s', and takes no mesh or group of its own", beam->name, mesh,
             group);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The beams that the mesh of one beam makes; left: how many beams are still to come. */
static PetscErrorCode take_pieces(AppScene *s, AppMesh *mesh, const SceneBeam *beam, PetscInt left)
{
  AppPieces pieces;
  SceneBeam one = *beam;

  PetscFunctionBegin;
  PetscCall(AppMeshBeam(mesh, &one, &pieces));
  for (int k = 0; k < 3 && pieces.n > 1; k++)
    PetscCheck(one.pointload[k] == 0 && one.moment[0][k] == 0 && one.moment[1][k] == 0, PETSC_COMM_SELF, PETSC_ERR_ARG_INCOMP,
               "beam '%s': its lines make %" PetscInt_FMT
               " beams, %s_p0, %s_p1, ...; give beam_%s_p0_point_load or such for one of "
               "them",
               one.name, pieces.n, one.name, one.name, one.name);
  if (pieces.n > 1) PetscCall(grow_beams(s, s->nbeams + pieces.n + left));
  PetscCall(PetscRealloc(sizeof(SceneLink) * (size_t)(s->nmeshjoints + pieces.njoints), &s->meshjoints));
  for (PetscInt i = 0; i < pieces.njoints; i++) {
    SceneLink *l = &s->meshjoints[s->nmeshjoints];

    *l = pieces.joint[i];
    for (PetscInt k = 0; k < l->n; k++) l->beam[k] += s->nbeams;
    PetscCall(PetscSNPrintf(l->name, sizeof(l->name), "%.20s_joint%" PetscInt_FMT, one.name, i));
    s->nmeshjoints++;
  }
  for (PetscInt i = 0; i < pieces.n; i++) {
    if (pieces.n > 1) PetscCall(read_piece(&pieces.beam[i]));
    s->beams[s->nbeams++] = pieces.beam[i];
  }
  PetscCall(PetscFree(pieces.beam));
  PetscCall(PetscFree(pieces.joint));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode check_beam_names(const AppScene *s)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < s->nbeams; i++)
    for (PetscInt j = 0; j < i && (s->nmeshjoints || s->beams[i].mesh[0]); j++)
      PetscCheck(strcasecmp(s->beams[i].name, s->beams[j].name), PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
                 "beams: the name '%s' is that of a piece of the mesh '%s' already", s->beams[i].name,
                 s->beams[s->beams[j].mesh[0] ? j : i].mesh);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode read_beams(AppScene *s, const AppNames *names, const char file[], PetscBool help)
{
  static const char *const keys[] = {"start", "end", "elements", "curvature", "normal"};
  SceneBeam all, one;
  AppMesh mesh = {"", NULL, file};
  PetscBool allset[5] = {PETSC_FALSE, PETSC_FALSE, PETSC_FALSE, PETSC_FALSE, PETSC_FALSE};
  char prefix[128], title[128];

  PetscFunctionBegin;
  PetscCall(PetscMemzero(&all, sizeof(all)));
  PetscCall(AncfBeamSpecInit(&all.spec));
  all.pointat = 1;
  if (names->n || help) PetscCall(read_beam("beam_", "Beams: the same for all; -beam_<name>_... for one", &all, allset));
  for (PetscInt i = 0; i < names->n; i++) {
    PetscBool set[5];

    one = all;
    PetscCall(PetscArraycpy(set, allset, 5));
    PetscCall(PetscStrncpy(one.name, names->name[i], APP_NAME_LEN));
    PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "beam_%s_", names->name[i]));
    PetscCall(PetscSNPrintf(title, sizeof(title), "Beam '%s'", names->name[i]));
    PetscCall(read_beam(prefix, title, &one, set));
    for (int k = 0; k < 5 && one.mesh[0]; k++)
      PetscCheck(!set[k], PETSC_COMM_SELF, PETSC_ERR_ARG_INCOMP, "beam '%s': %s is given but comes from its mesh '%s'", one.name,
                 keys[k], one.mesh);
    if (one.mesh[0] && !help) {
      PetscCall(take_pieces(s, &mesh, &one, names->n - i - 1));
      continue;
    }
    s->beams[s->nbeams++] = one;
    if (one.mesh[0]) continue;
    PetscCheck(!one.group[0], PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "beam '%s': group '%s' needs a mesh", one.name, one.group);
    PetscCheck(set[0] && set[1], PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "beam '%s' needs %s%s", names->name[i], prefix,
               set[0] ? "end" : "start");
  }
  PetscCall(check_beam_names(s));
  PetscCall(AppMeshDestroy(&mesh));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode read_bodies(AppScene *s, const AppNames *names, PetscBool help)
{
  SceneBody all;
  PetscBool allset[2] = {PETSC_FALSE, PETSC_FALSE};
  char prefix[128], title[128];

  PetscFunctionBegin;
  PetscCall(PetscMemzero(&all, sizeof(all)));
  PetscCall(RigidBodySpecInit(&all.spec));
  all.scale = 1;
  if (names->n || help) PetscCall(read_body("body_", "Rigid bodies: the same for all; -body_<name>_... for one", &all, allset));
  for (PetscInt i = 0; i < names->n; i++) {
    SceneBody *body = &s->bodies[i];
    PetscBool set[2] = {allset[0], allset[1]}, mesh;
    *body = all;
    PetscCall(PetscStrncpy(body->name, names->name[i], APP_NAME_LEN));
    for (PetscInt j = 0; j < s->nbeams; j++)
      PetscCheck(strcasecmp(s->beams[j].name, body->name), PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
                 "bodies: the name '%s' is a beam's already", body->name);
    for (PetscInt j = 0; j < s->nlumped; j++)
      PetscCheck(strcasecmp(s->lumped[j].name, body->name), PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
                 "bodies: the name '%s' is a beam's already", body->name);
    PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "body_%s_", body->name));
    PetscCall(PetscSNPrintf(title, sizeof(title), "Body '%s'", body->name));
    PetscCall(read_body(prefix, title, body, set));
    mesh = (PetscBool)(body->spec.shape == RIGID_MESH);
    PetscCheck(set[1] && (set[0] || mesh), PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "body '%s' needs %s%s", body->name, prefix,
               set[1] ? "size" : "position");
    PetscCheck(!mesh || body->file[0], PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
               "body '%s' needs %sfile: the STL or OBJ file of its mesh", body->name, prefix);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode read_structures(AppScene *s, const char file[])
{
  AppNames beams = {0, NULL}, bodies = {0, NULL};
  PetscInt trunks;
  PetscBool help;
  const AppOpt opt[] = {
      {OPT_NAMES, "beams", "Names of the beams, separated by commas", &beams, NULL, NULL},
      {OPT_NAMES, "bodies", "Names of the rigid bodies, separated by commas", &bodies, NULL, NULL},
  };

  PetscFunctionBegin;
  PetscCall(AppOptionsRead(NULL, "Scene: structures", COUNT(opt), opt));
  PetscCall(PetscOptionsHasHelp(NULL, &help));
  s->nbodies = bodies.n;
  PetscCall(PetscCalloc1(beams.n, &s->beams));
  PetscCall(read_beams(s, &beams, file, help));
  PetscCall(AppSceneReadLumped(s, &trunks));
  PetscCall(PetscCalloc1((size_t)(bodies.n + trunks), &s->bodies));
  PetscCall(read_bodies(s, &bodies, help));
  PetscCall(AppSceneReadJoints(s));
  PetscCall(AppSceneReadLinks(s));
  PetscCall(AppSceneReadProbes(s));
  PetscCall(AppSceneReadOpenings(s));
  PetscCall(PetscFree(beams.name));
  PetscCall(PetscFree(bodies.name));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode check_given(const AppScene *s, const SceneSet *set)
{
  PetscFunctionBegin;
  PetscCheck(set->tend, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "time_end is needed: the time at which the run ends, s");
  PetscCheck(s->tend > 0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "time_end = %g s must be positive", (double)s->tend);
  PetscCheck(s->forceramp >= 0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "body_force_ramp = %g s must be 0 (none) or more",
             (double)s->forceramp);
  PetscCheck(s->outevery >= 0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "output_every = %g s must be 0 (every step) or more",
             (double)s->outevery);
  PetscCheck(s->histevery >= 0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "history_every = %g s must be 0 (every step) or more",
             (double)s->histevery);
  PetscCheck(s->progressevery >= 0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "progress_every = %g s must be 0 (never) or more",
             (double)s->progressevery);
  PetscCheck(s->fluid || !s->nregions, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
             "regions: '%s' is to be filled with fluid, but the scene has none", s->regions[0].name);
  PetscCheck(s->fluid || s->nbeams || s->nbodies || s->nlumped, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
             "nothing to simulate: fluid is false, and neither beams nor bodies are listed");
  if (s->fluid) {
    PetscCheck(set->lo && set->hi, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
               "%s is needed: a corner of the domain, m (or set fluid to false)", set->lo ? "domain_hi" : "domain_lo");
    PetscCheck(!set->dt, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
               "time_step is for scenes without fluid; with fluid set sph_dt or sph_cfl");
  } else {
    PetscCheck(set->dt, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "time_step is needed in a scene without fluid, s");
    PetscCheck(s->dt > 0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "time_step = %g s must be positive", (double)s->dt);
    PetscCheck(s->faultstep < 0 || s->faultfield > FAULT_RHO, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "fault_nan needs a fluid");
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Read a scene from the options database; file gives the default name. */
PetscErrorCode AppSceneRead(AppScene *s, const char file[])
{
  SceneSet set = {0};
  PetscBool help;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(s, sizeof(*s)));
  s->fluid = PETSC_TRUE;
  s->progressevery = 1;
  s->checkpointevery = -1;
  s->checkpointkeep = 3;
  s->audit = PETSC_TRUE;
  s->auditmomentum = 1e-3;
  s->auditenergy = 0.2;
  for (PetscInt i = 0; i <= FIELD_GROUP; i++) s->field[i] = PETSC_TRUE;
  PetscCall(default_name(file, s->name));
  PetscCall(read_domain(s, &set));
  PetscCall(AppSceneReadRegions(s, file));
  PetscCall(read_structures(s, file));
  PetscCall(read_run(s, &set));
  PetscCall(PetscOptionsHasHelp(NULL, &help));
  if (!help) PetscCall(check_given(s, &set));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A wall that turns needs a point to turn about. */
static PetscErrorCode check_turn(const AppScene *s, PetscInt face)
{
  const SceneWall *w = &s->walls[face];
  const PetscBool turns = (PetscBool)(w->omega[0] != 0 || w->omega[1] != 0 || w->omega[2] != 0);

  PetscFunctionBegin;
  PetscCheck(!turns || !strcmp(w->motion, "constant"), PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
             "wall_%s_omega = %g,%g,%g rad/s: needs wall_%s_motion constant", SceneFaces[face], (double)w->omega[0],
             (double)w->omega[1], (double)w->omega[2], SceneFaces[face]);
  PetscCheck(!turns || w->setpivot, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
             "wall_%s_omega needs wall_%s_pivot: the point to turn about", SceneFaces[face], SceneFaces[face]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What can be judged once the dimension of the fluid is known. */
PetscErrorCode AppSceneCheck(const AppScene *s, PetscInt dim)
{
  PetscFunctionBegin;
  for (PetscInt a = 0; a < dim; a++) {
    PetscCheck(s->hi[a] > s->lo[a], PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "domain_hi %s = %g m must lie above domain_lo = %g m", axes[a], (double)s->hi[a], (double)s->lo[a]);
    PetscCheck(s->fluidhi[a] > s->fluidlo[a], PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "fluid_hi %s = %g m must lie above fluid_lo = %g m: the domain has no fluid", axes[a], (double)s->fluidhi[a],
               (double)s->fluidlo[a]);
    PetscCheck(s->fluidlo[a] >= s->lo[a] && s->fluidhi[a] <= s->hi[a], PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "the fluid box (%g to %g m along %s) must lie inside the domain (%g to %g m)", (double)s->fluidlo[a],
               (double)s->fluidhi[a], axes[a], (double)s->lo[a], (double)s->hi[a]);
  }
  for (PetscInt i = 0; i < 6; i++) {
    const PetscReal *v = s->wallvelocity[i];
    PetscBool moves = (PetscBool)(v[0] != 0 || v[1] != 0 || v[2] != 0);
    PetscCheck(!s->wall[i] || i / 2 < dim, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "walls: %s has no meaning in a 2D scene",
               SceneFaces[i]);
    PetscCheck(!s->wall[i] || !s->periodic[i / 2], PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
               "walls: %s is on axis %s, which is periodic", SceneFaces[i], axes[i / 2]);
    PetscCheck(!moves || s->wall[i], PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "wall_%s_velocity is set but walls does not list %s",
               SceneFaces[i], SceneFaces[i]);
    PetscCheck(!s->walls[i].motion[0] || s->wall[i], PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
               "wall_%s_motion is set but walls does not list %s", SceneFaces[i], SceneFaces[i]);
    PetscCall(check_turn(s, i));
    if (s->walls[i].motion[0]) continue;
    PetscCheck(v[i / 2] == 0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "wall_%s_velocity = %g,%g,%g: a wall moves along itself only, its %s component must be 0, or set wall_%s_motion",
               SceneFaces[i], (double)v[0], (double)v[1], (double)v[2], axes[i / 2], SceneFaces[i]);
  }
  PetscCheck(dim == 3 || !s->periodic[2], PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
             "domain_periodic: z has no meaning in a 2D scene");
  PetscCheck(dim == 3 || s->gravity[2] == 0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "gravity: its z component %g must be 0 in a 2D scene", (double)s->gravity[2]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppSceneDestroy(AppScene *s)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < s->nbeams; i++) PetscCall(PetscFree(s->beams[i].curve));
  PetscCall(PetscFree(s->beams));
  PetscCall(PetscFree(s->bodies));
  PetscCall(PetscFree(s->lumped));
  PetscCall(PetscFree(s->joints));
  PetscCall(AppSceneFreeLinks(s));
  PetscCall(AppSceneFreeRegions(s));
  PetscCall(PetscFree(s->grids));
  PetscCall(PetscFree(s->probes));
  PetscCall(PetscFree(s->openings));
  PetscFunctionReturn(PETSC_SUCCESS);
}
