/*
  app.h - private header of the `frond` command: scene, run, output.

  A scene is a PETSc options file in YAML (scene.c lists its options); appbuild.c makes the solver objects from it,
  apprun.c steps them, output.c and history.c write the results.
*/
#ifndef APP_H
#define APP_H

#include "couple.h"
#include "frondstate.h"
#include <stdint.h>
#include <stdio.h>

#define APP_NAME_LEN 64

/* Exit codes of the command. */
enum { APP_EXIT_OK = 0, APP_EXIT_USER = 1, APP_EXIT_NUMERICAL = 2, APP_EXIT_IO = 3 };

/* apperror.c: one clear line for an error, whatever depth it comes from. */
typedef struct {
  PetscBool trace;  /* print PETSc's trace too */
  PetscBool memory; /* there is not enough */
  PetscBool files;  /* HDF5 holds a file that it could not write */
  char message[2048];
  char context[128]; /* what the command was doing, put before the message; empty for nothing */
} AppErrors;
PetscErrorCode AppErrorInstall(AppErrors *errors);
/* appstudy.c: `frond study ...`; the exit code, when it cannot start. */
int AppStudy(int argc, char **argv);
int AppErrorReport(const AppErrors *errors, PetscErrorCode ierr, PetscBool quiet);

/* appoptions.c: tables of options, read through PETSc so that -help lists them. */
typedef enum { OPT_REAL, OPT_INT, OPT_BOOL, OPT_STRING, OPT_VEC, OPT_AXISANGLE, OPT_CHOICE, OPT_SUBSET, OPT_NAMES } AppOptType;
typedef struct {
  AppOptType type;
  const char *key, *help;
  void *value; /* PetscReal, PetscInt, PetscBool, char[PETSC_MAX_PATH_LEN], PetscReal[3], [4], PetscInt, PetscBool[], AppNames */
  const char *const *list; /* OPT_CHOICE, OPT_SUBSET: the words allowed, NULL at the end */
  PetscBool *set;          /* becomes true when the option is given; may be NULL */
} AppOpt;
typedef struct {
  PetscInt n;
  char (*name)[APP_NAME_LEN];
} AppNames;
PetscErrorCode AppOptionsRead(const char prefix[], const char title[], PetscInt n, const AppOpt opt[]);
PetscErrorCode AppOptionsInsertFile(const char file[]);
PetscErrorCode AppNameCheck(const char key[], const char name[]);

/* scene.c */
typedef enum { BUOYANCY_RESOLVED, BUOYANCY_ARCHIMEDES } SceneBuoyancy;
typedef enum { PRESSURE_HYDROSTATIC, PRESSURE_ZERO } ScenePressure;
typedef struct {
  char name[APP_NAME_LEN];
  AncfBeamSpec spec;
  char mesh[PETSC_MAX_PATH_LEN], group[PETSC_MAX_PATH_LEN]; /* Gmsh file and physical name of its axis; empty: none, the name */
  PetscReal pointload[3], pointat, lineload[3];             /* N, fraction of the length, N/m */
  PetscReal moment[2][3], ramp;                             /* at its ends, N m; s */
  PetscReal *curve;                                         /* of the spec, or NULL */
} SceneBeam;
typedef struct {
  char name[APP_NAME_LEN];
  RigidBodySpec spec;
  char file[PETSC_MAX_PATH_LEN];            /* mesh: STL file */
  PetscReal scale;                          /* m per unit of the file */
  PetscReal gravity[3], load[3], torque[3]; /* own gravity, m/s^2; permanent load, N, N m */
  PetscBool owngravity;
} SceneBody;

typedef struct {
  char name[APP_NAME_LEN];
  RigidLumpedSpec spec;
  PetscInt body; /* its first trunk */
} SceneLumped;
typedef struct {
  char name[APP_NAME_LEN], a[PETSC_MAX_PATH_LEN], b[PETSC_MAX_PATH_LEN]; /* a, b: bodies or ground */
  RigidJointSpec spec;
  PetscInt joint;
} SceneJoint;

/* How a wall moves bodily. */
typedef struct {
  char motion[PETSC_MAX_PATH_LEN]; /* "": not at all, or it slides; "constant"; else the file of a table */
  PetscReal omega[3], pivot[3];    /* rad/s, m */
  PetscBool setpivot;
} SceneWall;

/* Nodes of ANCF beams held together. */
typedef struct {
  char name[APP_NAME_LEN], text[PETSC_MAX_PATH_LEN]; /* text: its nodes as given */
  char body[PETSC_MAX_PATH_LEN];                     /* they are attached to it; empty: held together */
  PetscInt type, n, *beam, *node;                    /* type: 0 ball, 1 rigid; n nodes */
  PetscInt first;                                    /* its first attachment */
} SceneLink;

/* A region that the fluid fills. */
typedef enum { REGION_BOX, REGION_SPHERE, REGION_CYLINDER, REGION_PIPE, REGION_SURFACE } SceneRegionShape;
#define REGION_SETS 9
typedef struct {
  char name[APP_NAME_LEN], file[PETSC_MAX_PATH_LEN];       /* file: of a surface */
  PetscInt shape;                                          /* SceneRegionShape */
  PetscReal lo[3], hi[3];                                  /* m: of a box; once set up, of a box about it */
  PetscReal start[3], end[3], radius, radius2, step, back; /* m: cylinder, pipe, sphere */
  PetscReal position[3], scale;                            /* m: sphere, surface; m per unit of the file */
  PetscBool wall, setlo, sethi;
  RigidGeometry geometry;                   /* surface */
  PetscReal axis[3], length, segment[8][4]; /* cylinder, pipe: unit vector, m, and (s, r) from to of its outline, m */
  PetscInt nsegments;
  PetscBool endless; /* cylinder, pipe: it goes once along a periodic axis */
} SceneRegion;

/* A regular grid of points; lo = hi along an axis makes a slice or a line. */
typedef struct {
  char name[APP_NAME_LEN];
  PetscReal lo[3], hi[3], spacing; /* m */
  PetscInt n[3], how;              /* points; SphInterpolation */
  PetscBool setlo, sethi;
} SceneGrid;
typedef struct {
  char name[APP_NAME_LEN];
  PetscInt kind, how;                        /* 0 point, 1 plane; SphInterpolation */
  PetscReal position[3], edge1[3], edge2[3]; /* m */
  PetscBool set[3];
} SceneProbe;

/* An opening of the fluid. */
typedef struct {
  char name[APP_NAME_LEN];
  PetscInt type, given, profile, face; /* SphOpeningType, -Given, -Profile; face: 0 none, else 1 + it */
  PetscReal lo[3], hi[3], position[3], edge1[3], edge2[3], speed, pressure, ramp; /* m, m/s, Pa, s */
  char file[PETSC_MAX_PATH_LEN];
  PetscBool set[8]; /* given, lo, hi, position, edge1, edge2, speed, pressure */
} SceneOpening;

/* Fields of a frame that may be left out. */
enum { FIELD_VELOCITY, FIELD_DENSITY, FIELD_PRESSURE, FIELD_GROUP, FIELD_ACCELERATION, FIELD_COUNT };
extern const char *const SceneFields[];
extern const char *const SceneFaces[]; /* xmin, xmax, ymin, ymax, zmin, zmax */

typedef struct {
  char name[APP_NAME_LEN];
  PetscReal gravity[3]; /* m/s^2 */
  SceneBuoyancy buoyancy;
  PetscBool fluid;
  PetscReal lo[3], hi[3]; /* domain, m */
  PetscBool periodic[3], wall[6];
  PetscReal wallvelocity[6][3]; /* m/s */
  SceneWall walls[6];
  PetscReal forceramp; /* s */
  char forcefile[PETSC_MAX_PATH_LEN];
  PetscReal fluidlo[3], fluidhi[3], fluidvelocity[3];
  ScenePressure pressure;
  PetscInt nbeams, nbodies;
  SceneBeam *beams;
  SceneBody *bodies; /* with the trunks of the lumped beams at the end, once they are built */
  PetscInt nlumped, njoints;
  SceneLumped *lumped; /* beams of rigid trunks; beams holds the others */
  SceneJoint *joints;
  PetscInt nlinks;
  SceneLink *links;
  PetscInt nregions;
  SceneRegion *regions;
  PetscInt nmeshjoints;
  SceneLink *meshjoints; /* of beams from meshes; they become the first links */
  PetscInt ngrids, nprobes;
  SceneGrid *grids;
  SceneProbe *probes;
  PetscInt nopenings, reserve; /* reserve: -1 predicted */
  SceneOpening *openings;
  PetscReal tend, dt; /* s; dt only without fluid */
  char outdir[PETSC_MAX_PATH_LEN];
  PetscBool overwrite;
  PetscReal outevery, histevery, progressevery; /* s, s, s of wall time */
  PetscBool field[FIELD_COUNT];
  PetscReal checkpointevery; /* s; 0: every step, -1: none */
  PetscInt checkpointkeep;
  char restart[PETSC_MAX_PATH_LEN]; /* checkpoint to go on from, or a folder of them; empty for none */
  PetscBool restartchanged;
  PetscInt faultfield, faultmarker, faultstep; /* -fault_nan; faultstep < 0: none */
  PetscReal faultvalue;
  PetscBool audit;
  PetscReal auditmomentum, auditenergy; /* relative residuals that bring a warning; -1: none */
} AppScene;
PetscErrorCode AppSceneRead(AppScene *scene, const char file[]);
PetscErrorCode AppSceneCheck(const AppScene *scene, PetscInt dim);
PetscErrorCode AppSceneDestroy(AppScene *scene);

/* appbuild.c: the solver objects of a scene. */
typedef enum { SURFACE_WALL, SURFACE_BEAM, SURFACE_BODY, SURFACE_KINDS } AppSurfaceKind;
typedef struct {
  char name[APP_NAME_LEN + 8];
  CoupleSurface surface;
  PetscInt markers, group; /* group: of its markers in the fluid */
  AppSurfaceKind kind;
} AppSurface;
typedef struct {
  AppScene scene;
  AppErrors *errors;
  Sph sph;                /* NULL without fluid */
  Ancf ancf;              /* NULL without beams */
  Rigid rigid;            /* NULL without bodies */
  Couple couple;          /* NULL without fluid */
  CoupleAttach attach;    /* NULL without links to bodies */
  CoupleShort shortrange; /* of the beams; NULL without beams and in 2D */
  PetscInt dim, nsurfaces;
  AppSurface *surfaces;
  PetscInt nfluid, nboundary;
  Rigid mover[6];               /* prescribed motion of each wall that moves bodily, else NULL */
  PetscReal loadramp, loadtime; /* when all beams have all of their loads, s; time of those that they have */
  PetscReal t;                  /* time, s */
  PetscInt step;
  PetscReal beamtorque[3],
      beamturn[3]; /* of weight and supports now, N m; its impulse since the first row of the history, N m s */
} App;
PetscErrorCode AppBuild(App *app);
PetscErrorCode AppView(const App *app, FILE *out);
PetscErrorCode AppDestroy(App *app);
PetscErrorCode AppStep(App *app, PetscReal tmax, PetscReal *dt);
/* Position and velocity (m, m/s) at material coordinate s (m) of a beam, and r,x. */
PetscErrorCode AppBeamPoint(App *app, PetscInt beam, PetscReal s, PetscReal r[3], PetscReal v[3], PetscReal rx[3]);

/* PETSc's context of the error line: what was being made. */
#define AppDoing(app, ...)                                                                                                       \
  do {                                                                                                                           \
    if ((app)->errors) snprintf((app)->errors->context, sizeof((app)->errors->context), __VA_ARGS__);                            \
  } while (0)

/* appfault.c: values that are not finite; the fields in the order of fluid, beams, bodies. */
enum {
  FAULT_X,
  FAULT_V,
  FAULT_RHO,
  FAULT_BEAM_X,
  FAULT_BEAM_SLOPE,
  FAULT_BEAM_V,
  FAULT_BEAM_SLOPE_V,
  FAULT_BODY_X,
  FAULT_BODY_Q,
  FAULT_BODY_V,
  FAULT_BODY_OMEGA
};
PetscErrorCode AppInjectFault(App *app);
PetscErrorCode AppTraceFault(App *app, PetscInt failed, PetscReal tmax, size_t len, char text[]);

/* appstate.c: the state of a run as named arrays in memory. */
typedef struct {
  char name[96];
  FrondStateType type;
  size_t n, bytes; /* values; bytes of memory */
  void *data;
} StateArray;
typedef struct {
  FrondState state; /* first: AppStateBegin() gives a pointer to it */
  PetscInt n, alloc, at;
  StateArray *array;
} AppState;
FrondState *AppStateBegin(AppState *s, FrondStateWay way);
PetscErrorCode AppStateAdd(AppState *s, const char name[], FrondStateType type, size_t n, void **data);
const char *AppStateNotFinite(const AppState *s);
PetscErrorCode AppStateDestroy(AppState *s);
PetscErrorCode AppMoveState(App *app, FrondState *s);

/* checkpoint.c: checkpoint files. */
#define APP_CHECKPOINT_FORMAT 3
typedef struct {
  PetscInt step;
  PetscReal t;   /* s */
  char *options; /* AppOptionsText() of the run that wrote it */
} CheckpointInfo;
void AppCheckpointName(PetscInt step, size_t len, char name[]);
PetscErrorCode AppCheckpointWrite(const char dir[], const AppState *s, const CheckpointInfo *info, PetscInt keep, size_t len,
                                  char path[]);
PetscErrorCode AppCheckpointRead(const char file[], AppState *s, CheckpointInfo *info);
PetscErrorCode AppCheckpointNewest(const char dir[], const char not [], PetscBool good, size_t len, char path[]);
PetscErrorCode AppCheckpointPrune(const char dir[], PetscInt newest, PetscInt keep);

/* apprestart.c: which checkpoint, and whether it is of this scene. */
PetscErrorCode AppOptionsText(char **text);
PetscErrorCode AppRestartRead(const App *app, AppState *s, CheckpointInfo *info);

/* scenerigid.c: lumped beams, joints, short-range forces. */
PetscErrorCode AppSceneReadLumped(AppScene *scene, PetscInt *trunks);
PetscErrorCode AppSceneReadJoints(AppScene *scene);
PetscErrorCode AppBuildLumped(App *app);
PetscErrorCode AppBuildJoints(App *app);
PetscErrorCode AppBuildShortRange(App *app);
PetscErrorCode AppBuildShortBeams(App *app);
PetscErrorCode AppCheckOverlap(App *app);
void AppNameError(App *app);
PetscErrorCode AppLumpedTip(App *app, PetscInt beam, PetscReal r[3], PetscReal v[3]);

/* scenemesh.c: beams from a Gmsh mesh, the last file being kept; a group of lines makes start, end, elements, curvature, curve.
 */
typedef struct {
  char file[PETSC_MAX_PATH_LEN];
  DM dm;
  const char *scene; /* file of the scene, or NULL */
} AppMesh;
typedef struct {
  PetscInt n, njoints;
  SceneBeam *beam;
  SceneLink *joint; /* beams counted from the first of these */
} AppPieces;
PetscErrorCode AppMeshBeam(AppMesh *mesh, SceneBeam *beam, AppPieces *pieces);
PetscErrorCode AppMeshDestroy(AppMesh *mesh);
PetscErrorCode AppFindFile(const char scene[], char file[PETSC_MAX_PATH_LEN]);

/* scenecurve.c: lines, arcs and other curves through points. */
void AppCurveTangent(const PetscReal a[3], const PetscReal b[3], const PetscReal c[3], PetscReal t[3]);
PetscErrorCode AppCurveSimple(PetscInt m, const PetscReal *x, const PetscReal *t0, const PetscReal *t1, PetscInt n,
                              AncfBeamSpec *spec, PetscBool *done);
PetscErrorCode AppCurveGeneral(PetscInt m, const PetscReal *x, const PetscReal *t0, const PetscReal *t1, PetscInt n,
                               AncfBeamSpec *spec, PetscReal **curve, PetscReal *off);

/* sceneload.c: permanent loads of beams; power: of the moments at their ends now, W. */
PetscErrorCode AppBuildBeamLoads(App *app);
PetscErrorCode AppUpdateBeamLoads(App *app);
PetscErrorCode AppBeamMomentPower(App *app, PetscReal *power);

/* scenelink.c: links between nodes of beams. */
PetscErrorCode AppSceneReadLinks(AppScene *scene);
PetscErrorCode AppSceneFreeLinks(AppScene *scene);
PetscErrorCode AppBuildLinks(App *app);
PetscErrorCode AppSetUpBeams(App *app);
PetscErrorCode AppBuildAttach(App *app);

/* sceneregion.c, appregion.c: regions that the fluid fills, in place of the domain. */
PetscErrorCode AppSceneReadRegions(AppScene *scene, const char file[]);
PetscErrorCode AppSceneFreeRegions(AppScene *scene);
PetscErrorCode AppRegionsSetUp(App *app);
void AppRegionDistance(const App *app, const PetscReal x[3], PetscReal *region, PetscReal *wall, PetscInt *nearest);
PetscReal AppRegionGap(const PetscReal x[3], void *app);
PetscErrorCode AppRegionWalls(App *app, PetscInt *n, PetscReal **x, PetscReal **volume, PetscReal **depth, PetscInt **owner);

/* appfluid.c */
PetscErrorCode AppFluidFill(App *app);
PetscReal AppFluidPressure(const App *app, const PetscReal x[3]);

/* sceneopen.c */
PetscErrorCode AppSceneReadOpenings(AppScene *scene);
PetscErrorCode AppBuildOpenings(App *app, PetscReal *brought, PetscInt *zone);
PetscErrorCode AppBuildReserve(App *app, PetscReal brought, PetscInt zone);
PetscErrorCode AppOpeningDepth(const App *app, PetscInt face, PetscReal *depth);

/* appcsv.c: a table over time. */
typedef struct {
  PetscInt n;
  PetscReal *t, *value; /* n, s; n x columns */
} AppTable;
PetscErrorCode AppTableRead(const char file[], const char *const names[], PetscReal tend, AppTable *table);
PetscErrorCode AppTableDestroy(AppTable *table);

/* appmotion.c */
PetscErrorCode AppWallCreateMoving(App *app, PetscInt face, const char name[], PetscInt n, const PetscReal *x,
                                   const PetscReal *volume, const PetscReal *depth, CoupleSurface *surface);
PetscErrorCode AppBodyForce(App *app);

/* appunknown.c: options that nothing has asked for are an error. */
typedef struct {
  PetscInt n, alloc;
  char **name;
  PetscBool partial; /* the list is not whole */
} AppKnown;
PetscErrorCode AppKnownCollect(AppKnown *known);
void AppKnownFree(AppKnown *known);
PetscErrorCode AppOptionsUnused(const AppKnown *known, PetscBool only_unlisted, size_t len, char text[]);
PetscErrorCode AppOptionsCheckUnused(const AppKnown *known);
PetscErrorCode AppHelp(void);

/* output.c: one HDF5 file per frame and an XDMF index of them all. */
typedef struct _AppOutput *AppOutput;
PetscErrorCode AppOutputCheck(const char dir[]);
PetscErrorCode AppOutputCreate(const App *app, AppOutput *out);
PetscErrorCode AppOutputWrite(AppOutput out, App *app);
PetscErrorCode AppOutputLast(AppOutput out, PetscReal *t, const char **file, PetscInt *frames);
/* The frames so far; after a load AppOutputCut() removes those of the folder that are later and writes the index anew. */
PetscErrorCode AppOutputMoveState(AppOutput out, FrondState *s);
PetscErrorCode AppOutputCut(AppOutput out);
PetscErrorCode AppOutputDestroy(AppOutput *out);

/* xdmf.c */
typedef struct {
  const App *app;
  PetscInt first, nframes; /* first: of the frames that are in the folder */
  PetscReal *time;         /* nframes, s */
  PetscInt *points;        /* points on each beam's centre line, nbeams */
} XdmfSeries;
PetscErrorCode AppXdmfWrite(const char dir[], const XdmfSeries *series);
void AppFrameName(PetscInt frame, size_t len, char name[]);

/* h5write.c: datasets with unit and description. */
typedef struct {
  const char *name, *unit, *description;
} H5Label;
PetscErrorCode AppH5Create(const char file[], int64_t *id);
PetscErrorCode AppH5Close(int64_t id, const char file[]);
PetscErrorCode AppH5Group(int64_t loc, const char name[], int64_t *group);
PetscErrorCode AppH5GroupClose(int64_t group);
PetscErrorCode AppH5Real(int64_t loc, const H5Label *label, PetscBool single, PetscInt rows, PetscInt cols,
                         const PetscReal *data);
PetscErrorCode AppH5Grid(int64_t loc, const H5Label *label, const PetscInt points[3], PetscInt cols, const PetscReal *data);
PetscErrorCode AppH5Int(int64_t loc, const H5Label *label, PetscInt rows, PetscInt cols, const PetscInt *data);
PetscErrorCode AppH5AttrReal(int64_t loc, const char name[], PetscReal value);
PetscErrorCode AppH5AttrInt(int64_t loc, const char name[], PetscInt value);
PetscErrorCode AppH5AttrString(int64_t loc, const char name[], const char value[]);

/* history.c: the probe table, CSV while running and HDF5 at the end. */
typedef struct _AppHistory *AppHistory;
PetscErrorCode AppHistoryCreate(App *app, AppHistory *history);
PetscErrorCode AppHistoryRecord(AppHistory history, App *app, PetscReal dt);
PetscErrorCode AppHistoryDestroy(AppHistory *history);
/* The rows so far; after a load AppHistoryCut() cuts history.csv behind them. */
PetscErrorCode AppHistoryMoveState(AppHistory history, App *app, FrondState *s);
PetscErrorCode AppHistoryCut(AppHistory history);
/* Rows to the disk. */
PetscErrorCode AppHistorySync(AppHistory history);
/* Largest values seen in the rows so far: speed (m/s), compression (-), momentum residual and scale (kg m/s), audit losses. */
typedef struct {
  PetscReal vmax, compression, residual, scale, forcelost, force, momentlost, moment, powerlost, power;
} HistoryWorst;
PetscErrorCode AppHistoryWorst(AppHistory history, HistoryWorst *worst);

/*
  appaudit.c: balances of mass, momentum, energy. All reals: a checkpoint holds it as one array. Integrals are sums of trapezoids
  over the rows of the history.
*/
enum { AUDIT_MASS, AUDIT_MOMENTUM, AUDIT_FLUID, AUDIT_BEAMS, AUDIT_BODIES, AUDIT_TERMS };
enum { AUDIT_HEAT, AUDIT_BODY, AUDIT_DAMPING, AUDIT_TORQUE, AUDIT_INTEGRALS = AUDIT_TORQUE + 3 };
typedef struct {
  PetscReal rows, t, left;                                      /* rows so far; s; markers that left */
  PetscReal rate[AUDIT_INTEGRALS], integral[AUDIT_INTEGRALS];   /* W, J; torque of the body force N m, N m s */
  PetscReal mass, energy[AUDIT_TERMS], angular[3];              /* at the first row: kg, J, kg m^2/s */
  PetscReal pressure, L[3], work[SURFACE_KINDS];                /* W; kg m^2/s now; J of the fluid on the surfaces */
  PetscReal freework, freeturn[3], beamturn[3];                 /* of the fluid on free bodies J, N m s; on beams N m s */
  RigidAudit bodies;                                            /* now, and so are these: */
  CoupleExchange links, near;                                   /* beams and bodies by attachments, by short-range forces */
  PetscReal L0[2][3], part[2][3], partturn[2][3];               /* of beams, bodies: at the first row, now, residual; kg m^2/s */
  PetscReal residual[AUDIT_TERMS], scale[AUDIT_TERMS], turn[3]; /* kg, kg m/s, J, J, J; the largest term; kg m^2/s */
  PetscReal worst[AUDIT_TERMS], warned[AUDIT_TERMS];            /* largest residual over scale; whether it was said */
} AppAudit;
PetscErrorCode AppAuditUpdate(App *app, AppAudit *audit);
PetscErrorCode AppAuditStep(App *app, PetscReal dt);

/* sceneprobe.c, appgrid.c: grids in the frames, probes in the history. */
typedef PetscErrorCode (*AppPut)(AppHistory h, const char name[], const char unit[], const char description[], PetscReal value);
PetscErrorCode AppOpeningsPut(App *app, AppPut put, AppHistory h);
PetscErrorCode AppAuditPut(App *app, const AppAudit *audit, AppPut put, AppHistory h);
PetscErrorCode AppHistoryAudit(AppHistory history, const AppAudit **audit);
PetscErrorCode AppSceneReadProbes(AppScene *scene);
PetscErrorCode AppProbesSetUp(App *app);
PetscErrorCode AppGridsWrite(App *app, int64_t file);
PetscErrorCode AppProbesPut(App *app, AppPut put, AppHistory history);
PetscReal AppGridStep(const SceneGrid *grid, PetscInt axis);

/* apprun.c, appcheck.c */
PetscErrorCode AppRun(App *app, int *exitcode);
PetscErrorCode AppCheck(App *app);
PetscReal AppWallTime(void);

#endif
