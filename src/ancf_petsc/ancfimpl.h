/* ancfimpl.h - private: the Ancf object and the functions shared by its source files. */
#ifndef ANCFIMPL_H
#define ANCFIMPL_H

#include "ancfelement.h"

/* No line search; PETSc renamed it in 3.26. */
#if PETSC_VERSION_LT(3, 26, 0)
  #define ANCF_FULL_STEP SNESLINESEARCHBASIC
#else
  #define ANCF_FULL_STEP SNESLINESEARCHNONE
#endif

/* How the equations of motion are handed to TS. */
typedef enum {
  ANCF_FORM_SECOND,    /* F(t,e,edot,eddot) = 0 */
  ANCF_FORM_FIRST,     /* F(t,y,ydot) = 0, y = (e, v) interleaved node by node */
  ANCF_FORM_EXPLICIT,  /* ydot = G(t,y), mass matrix factored once */
  ANCF_FORM_SYMPLECTIC /* edot = v, vdot = a(e), split for TSBASICSYMPLECTIC */
} AncfForm;

enum { ANCF_FIX_POSITION = 1, ANCF_FIX_GRADIENT = 2, ANCF_MOVING = 4 };

typedef struct {
  PetscInt beam, node;
  AncfEnd how;
} AncfSupport;

/* One scalar equation of a joint, see ancfconstraint.c. */
typedef enum { ANCF_ROW_POSITION, ANCF_ROW_EQUAL, ANCF_ROW_ANGLE, ANCF_ROW_FOLLOW } AncfRowKind;
typedef struct {
  AncfRowKind kind;
  int k, c;       /* node of the joint; component or basis vector */
  PetscReal s[3]; /* EQUAL: sign; ANGLE: cosine; FOLLOW: the direction as s0 t0 + s1 tr + s2 t0 x tr */
} AncfRow;

/* Nodes of beams held together. Local coordinates: positions of its nodes, then, if rigid, their gradients. */
typedef struct {
  AncfJointType type;
  PetscInt n, *beam, *node, *at; /* its nodes; at: among all nodes */
  PetscInt nrows, nloc, ref;     /* ref: node whose tangent with the first one's gives a frame; -1: all collinear */
  PetscBool linear, fresh;       /* fresh: choose dependent coordinates and normals anew */
  AncfRow *row;
  PetscReal (*normal)[2][3];       /* of each node's tangent, for FOLLOW */
  PetscInt *dep;                   /* dependent local coordinates, one per row; -1 before they are chosen */
  PetscReal *G, *Gdot, *T, *LU;    /* rows, their rates, e_dep = T e: nrows x nloc; factored dependent columns, nrows x nrows */
  PetscReal *x, *v, *lambda, *phi; /* local coordinates and velocities; forces and values of the rows */
  PetscInt *pivot;
} AncfJoint;

typedef struct {
  AncfBeamSpec spec;
  PetscInt node, element;          /* first ones */
  PetscReal l, EA, EI, rhoA, area; /* element length, m; section; outer area, m^2 */
  PetscReal EAtau, EItau;          /* internal damping, N s, N m^2 s */
} AncfBeam;

/* Up to ANCF_LANES consecutive elements; unused lanes repeat the last one. */
typedef struct {
  PetscInt n, node[ANCF_LANES], beam[ANCF_LANES];
  PetscReal EA[ANCF_LANES], EI[ANCF_LANES], rhoA[ANCF_LANES], l[ANCF_LANES];
} AncfBatch;

/* Up to ANCF_LANES beams, one per lane, longest first; unused lanes have no elements. */
typedef struct {
  PetscInt first[ANCF_LANES], elements[ANCF_LANES], most, least;
  PetscReal EA[ANCF_LANES], EI[ANCF_LANES], rhoA[ANCF_LANES], l[ANCF_LANES];
} AncfLaneBeams;

/* Nodes [begin, end). */
typedef struct {
  PetscInt begin, end;
} AncfNodes;

struct _p_Ancf {
  MPI_Comm comm;
  char *prefix;
  PetscInt nbeams, maxbeams, nnodes, nelements, nbatches;
  AncfBeam *beams;
  AncfBatch *batches;       /* elements in lanes: everything, for few beams */
  AncfLaneBeams *lanebeams; /* beams in lanes: the residual of many beams; NULL for few */
  PetscInt nlanebeams;
  AncfStrain strain;
  PetscInt naxial, nbending, substeps;
  AncfRule rule;
  PetscReal gravity[3], fluiddensity, damping, stiffnessdamping;
  PetscReal *natural; /* strain and curvature without stress at the Gauss points of the element after each node; NULL: zero */
  PetscReal *normal,
      *shape;        /* of the plane of beams that have one, nodes x 3, or NULL; initial coordinates, nodes x 6; with natural */
  PetscBool viscous; /* some beam has internal damping */
  PetscReal *spin, *spinsum; /* see ancfviscous.h: per beam 3 and, to work with, 9; NULL without internal damping */
  PetscReal *damped;         /* a + damping v, nodes x 6 */
  PetscBool setup;
  AncfForm form;
  PetscBool fromoptions, exposed; /* AncfSetFromOptions() and AncfGetTS() were called */
  Ancf whole, *groups;            /* see ancfgroup.c; whole is NULL but in a group */
  PetscInt ngroups, groupnodes, firstbeam;

  PetscReal t;
  PetscReal *e, *v, *a; /* state, nodes x 6 */
  PetscBool avalid;
  PetscReal loadscale;            /* of Q^a and Q^g; 1 but for the load steps of AncfSolveStatic() */
  PetscReal *load, *weight;       /* Q^a, Q^g */
  PetscReal *permanent, *moment;  /* point and line loads, nodes x 6; moments, nodes x 3; NULL until used */
  PetscReal *steady;              /* weight + permanent */
  PetscReal *loadend;             /* Q^a at loadtime[1], NULL until asked for */
  PetscBool linear;               /* Q^a goes from load to loadend between the two times, s */
  PetscReal loadtime[2], loadnow; /* loadnow: where the residual is evaluated, 0..1 */
  PetscReal *rest, *resta;        /* eliminated coordinates and their accelerations; resta is NULL while none moves */
  PetscReal *restm, *restv;       /* resta + damping times their velocities, these velocities */
  PetscReal *motion, motiontime;  /* e, v, a of moving nodes at that time, nodes x 18; NULL while none moves */
  AncfSupport *supports;
  PetscInt nsupports, maxsupports;
  unsigned char *fixed;                   /* per node, ANCF_FIX_* */
  AncfConstraints constraints;            /* see ancfdae.c; the next ones are for multipliers */
  PetscInt nmult, nrows, nheld, *heldrow; /* multipliers with those that fill up blocks; rows; rows and coordinates of supports */
  unsigned char *nofix, *allfixed;        /* fixed[] of free nodes; the true one while that is in place, else NULL */
  PetscReal rowscale;                     /* N/m */
  AncfJoint *joints;
  PetscInt njoints, maxjoints;
  PetscInt *jointof, *localof; /* per node: its joint or -1, and its number there; NULL without joints */
  PetscReal *je, *jv, *ja;     /* coordinates as the beams see them, nodes x 6; NULL without joints */
  PetscReal *jrow;             /* accelerations that the rows of dependent coordinates carry through a step */
  Mat JM;                      /* mass with joints, for accelerations */
  KSP JK;
  PetscBool jfactored;
  PetscReal *mass; /* banded Cholesky factor, 2 rows per node x 4 */

  TS ts;
  Vec U, V;
  Mat J;
  PetscReal *backup;                      /* e, v, history at the start of AncfAdvance(), 3 x nodes x 6 */
  PetscReal *saved, savedtime, savedstep; /* the same for AncfSaveState(), NULL before */
  PetscReal *history, *eprev, *vprev;     /* acceleration carried by TSALPHA2, e and v before the step; NULL with other types */
  Vec A, E0, V0, work;                    /* the same as vectors, and a work vector */
  PetscReal stagestart, stagetime;        /* of the last stage: start of its step, its own time, s */
  PetscBool interpolates;                 /* TS takes stages as linear between the ends of a step */
  PetscReal stagedt;                      /* step of the last stage, s */
  PetscBool fused, stored;                /* stages are made by ancfstage.c; backup holds the start of the coming step */
  const PetscReal *e0, *v0;               /* fused: start of the step */
  PetscReal *stagex, *stagev, *stagea;    /* fused: arguments of the equations of motion; stagev NULL without damping */
  PetscReal *stagesum, stagenorm;         /* sums of squares of the batches' residuals; norm of the last one, < 0: unknown */
  PetscReal *piece;                       /* sums over pieces of the vectors of TS */
  Vec stageat;                            /* the unknown that these arguments belong to */
  PetscBool lasting;                      /* the coordinates given to AncfAssemble() stay until they are used */
  PetscReal nominal;                      /* step of a TS that does not adapt, s; 0: it adapts */
  PetscBool given;                        /* history was set by the user */
  PetscBool restart, priming;             /* TS must start afresh; AncfAlphaStart() is at work */
  PetscBool exact;                        /* e, v and history are all that TS remembers, see AncfPack() */
  PetscInt uncounted[3];      /* steps, Newton and linear iterations that AncfAlphaStart() added to the counts of TS */
  PetscReal *stage, *impulse; /* forces of supports in the last residual, N; their sum over the steps, N s; nodes x 6; see
                                 AncfGetMeanReactions() */
  PetscReal advanced;         /* length of the last AncfAdvance(), s */
  PetscReal step;             /* what an adaptive TS wants next, s; 0: unknown */
};

extern PetscLogEvent ANCF_Advance, ANCF_Force, ANCF_Tangent, ANCF_MassSolve;

/* Gauss points per element: see docs/beams.md for the evidence. */
#define ANCF_DEFAULT_AXIAL 3
#define ANCF_DEFAULT_BENDING 3
#define ANCF_DEFAULT_RADIUS 0.8
#define ANCF_PIECE 1536    /* numbers of a vector that are summed as one */
#define ANCF_PARALLEL 64   /* batches of beams, from which on they are shared out among threads */
#define ANCF_MAX_HALVES 14 /* of a step that Newton's method fails in */
#define ANCF_DEFAULT_GROUP 16000

#if defined(PETSC_UNLIMITED)
  #define ANCF_UNLIMITED PETSC_UNLIMITED
#else
  #define ANCF_UNLIMITED (-1)
#endif

/* ancfstate.c */
extern PetscErrorCode AncfCheckFinite(Ancf ancf, const char what[], const PetscReal *x, PetscReal t);
/* Copies (e, v, history) to and from an array of 3 x nodes x 6; Load makes TS restart from it at time t. */
extern PetscErrorCode AncfStateStore(Ancf ancf, PetscReal *x);
extern PetscErrorCode AncfStateLoad(Ancf ancf, PetscReal t, const PetscReal *x);
/* Loads at time t of the step. */
extern void AncfSetLoadTime(Ancf ancf, PetscReal t);

/* ancfalpha.c: steps, Newton and linear iterations of TS. */
extern PetscErrorCode AncfTSCounts(Ancf ancf, PetscInt n[3]);

/* ancfmotion.c: room for the motion of supports; prescribed coordinates at time t; MoveNodes also in the state and the vectors of
 * TS. */
extern PetscErrorCode AncfMotionCreate(Ancf ancf);
extern void AncfMove(Ancf ancf, PetscReal t);
extern void AncfMoveStage(Ancf ancf, PetscReal t);
extern PetscErrorCode AncfMoveNodes(Ancf ancf, PetscReal t);

/* ancfdae.c: constraints with multipliers; nmult = 0 without. */
extern PetscInt AncfDaeRoom(const Ancf ancf);
extern PetscErrorCode AncfDaeSetUp(Ancf ancf);
extern PetscErrorCode AncfDaeDestroy(Ancf ancf);
extern PetscErrorCode AncfDaeResidual(Ancf ancf, const PetscReal *e, const PetscReal *v, const PetscReal *a, PetscInt stride,
                                      const PetscReal *lambda, PetscReal *f, PetscInt fstride, PetscReal *g);
extern PetscErrorCode AncfDaeAssemble(Ancf ancf, const PetscReal *e, const PetscReal *v, PetscInt stride, const PetscReal *lambda,
                                      PetscReal shift, PetscReal gv, PetscReal diag, Mat J, Mat P);
extern PetscErrorCode AncfDaeCreateMatrix(Ancf ancf, PetscInt bs, PC pc, Mat *J);
extern PetscErrorCode AncfDaePost(Ancf ancf);

/* ancfjoint.c */
extern PetscErrorCode AncfJointSetUp(Ancf ancf);
extern PetscErrorCode AncfJointDestroy(Ancf ancf);
/* PETSC_ERR_ARG_INCOMP when nodes of a joint lie or move apart. */
extern PetscErrorCode AncfJointCheck(Ancf ancf, const char function[], const PetscReal *e, const PetscReal *v);

/* ancfconstraint.c */
extern void AncfRowsEvaluate(const AncfJoint *j, const PetscReal *x, const PetscReal *v, PetscReal *phi, PetscReal *G,
                             PetscReal *Gdot, const PetscReal *lambda, PetscReal *H);
extern PetscInt AncfJointCoordinate(const AncfJoint *j, PetscInt local);
extern void AncfJointNormals(AncfJoint *j, const PetscReal *x);
/* Dependent coordinates of the state put right, and chosen anew where they serve badly (changed; may be NULL) or if fresh. */
extern PetscErrorCode AncfJointSync(Ancf ancf, PetscBool fresh, PetscBool *changed);
/* Coordinates, velocities, accelerations (each with its stride; v, a may be NULL) as the beams see them: into je, jv, ja. */
extern PetscErrorCode AncfJointState(Ancf ancf, const PetscReal *e, const PetscReal *v, PetscInt stride, const PetscReal *a,
                                     PetscInt astride);
/* f of the free coordinates += the joints' forces; rows of dependent ones: x less the acceleration they carry (x NULL: 0). */
extern PetscErrorCode AncfJointReduce(Ancf ancf, PetscReal *f, PetscInt fstride, const PetscReal *x, PetscInt stride);
extern PetscErrorCode AncfJointAcceleration(Ancf ancf, const PetscReal *e, const PetscReal *v, PetscInt stride, PetscReal *a,
                                            PetscInt astride);

/* ancfnetwork.c: matrices of beams with joints. Adds the matrix k of n coordinates, dependent ones replaced, in rows and columns
   shifted by these numbers within each node's block; pattern: all places that this may ever touch, with zeros. */
extern PetscErrorCode AncfNetworkAdd(Ancf ancf, Mat P, PetscInt n, const PetscInt coord[], const PetscReal k[], PetscInt row,
                                     PetscInt col, PetscBool pattern);
extern PetscErrorCode AncfNetworkElement(Ancf ancf, Mat P, PetscInt node, const PetscReal k[144], const PetscReal m[144]);
extern PetscErrorCode AncfNetworkGeometric(Ancf ancf, Mat P);
extern PetscErrorCode AncfNetworkCreate(Ancf ancf, PetscInt bs, PC pc, Mat *J);
static inline PetscBool AncfInJoint(const Ancf ancf, PetscInt node)
{
  return ancf->jointof && ancf->jointof[node] >= 0 ? PETSC_TRUE : PETSC_FALSE;
}
extern PetscBool AncfIsDependent(const Ancf ancf, PetscInt coordinate);

/* ancfloads.c */
extern PetscErrorCode AncfSetUpWeight(Ancf ancf);
extern void AncfMomentForce(const PetscReal M[3], const PetscReal r[3], PetscReal Q[3], PetscReal dQ[9]);

extern void AncfMeasure(AncfStrain strain, PetscReal l, PetscReal xi, const PetscReal e[12], PetscReal r[3], PetscReal *eps,
                        PetscReal kappa[3]);

/* ancf.c */
extern PetscErrorCode AncfSetUpBatches(Ancf ancf);
extern PetscErrorCode AncfSetUpLaneBeams(Ancf ancf);
extern PetscErrorCode AncfPrefixTS(Ancf ancf);
extern PetscInt AncfFindBeam(Ancf ancf, PetscInt node);

/* ancfresidual.c */
/* The nodes of a batch of beams, in as few pieces as it takes; returns how many. */
extern int AncfBatchNodes(const AncfLaneBeams *b, AncfNodes nodes[ANCF_LANES]);
extern void AncfMotionBatch(Ancf ancf, PetscInt k, const PetscReal *e, const PetscReal *v, const PetscReal *a, PetscReal *f);
/* M (a + damping v) + internal damping + Q^e - Q^g - Q^a, the forces of joints handed on to free coordinates; identity rows. */
extern PetscErrorCode AncfFreeResidual(Ancf ancf, const PetscReal *e, const PetscReal *v, const PetscReal *a, PetscInt stride,
                                       PetscReal *f, PetscInt fstride); /* the same without any constraint */
extern PetscErrorCode AncfMotionResidual(Ancf ancf, const PetscReal *e, const PetscReal *v, const PetscReal *a, PetscInt stride,
                                         PetscReal *f, PetscInt fstride);

/* ancfts.c: Push and Pull copy the state into and out of the vectors of TS; Push makes TS restart. */
extern PetscErrorCode AncfTSCreate(Ancf ancf);
extern PetscErrorCode AncfTSDestroy(Ancf ancf);
/* ancftype.c */
extern PetscErrorCode AncfChooseForm(Ancf ancf);
extern PetscErrorCode AncfCheckVariant(Ancf ancf);
extern PetscErrorCode AncfTSSetUp(Ancf ancf);
extern PetscErrorCode AncfTSPush(Ancf ancf);
extern PetscErrorCode AncfTSPull(Ancf ancf);
extern PetscErrorCode AncfTSCopy(Ancf ancf);  /* first-order forms: state -> vector, without a restart */
extern PetscErrorCode AncfTSTouch(Ancf ancf); /* second-order form: U and V wrap e and v, say that these changed */
/* f = M a + Q^e(e) - Q^g - Q^a; a may be NULL. Arrays are nodes x 6 with the given strides between nodes. */
extern PetscErrorCode AncfResidual(Ancf ancf, const PetscReal *e, PetscInt stride, const PetscReal *a, PetscInt astride,
                                   PetscReal *f, PetscInt fstride);
/* a = M^-1 (Q^g + Q^a - Q^e - C v), v may be NULL, prescribed values in eliminated rows. */
extern PetscErrorCode AncfExplicitAcceleration(Ancf ancf, const PetscReal *e, const PetscReal *v, PetscInt stride, PetscReal *a,
                                               PetscInt astride);
/* What supports and joints must supply at each node; supports: with the joints' forces handed on to the supports. */
extern PetscErrorCode AncfSupportForces(Ancf ancf, PetscReal *f, PetscBool supports);

extern PetscErrorCode AncfElasticEnergy(Ancf ancf, PetscReal *W);

/* ancfmat.c. P = tangent + shift M + gv (internal damping's dQ/dv, v may be NULL without); diag on the diagonal of eliminated
 * coordinates. Form and stride follow from the block size of P. */
extern PetscErrorCode AncfAssemble(Ancf ancf, const PetscReal *e, const PetscReal *v, PetscInt stride, PetscReal shift,
                                   PetscReal gv, PetscReal diag, Mat J, Mat P);
/* P += elements' tangent (e NULL: none) + shift M */
extern PetscErrorCode AncfAssembleElements(Ancf ancf, const PetscReal *e, PetscInt stride, PetscReal shift, Mat P);
extern PetscErrorCode AncfAssembleNodes(Ancf ancf, PetscReal shift, Mat P);
extern PetscErrorCode AncfAssembleIdentity(Ancf ancf, PetscReal diag, Mat P);
extern PetscErrorCode AncfCreateMatrix(Ancf ancf, PetscInt bs, PC pc, PetscBool choose, Mat *J);
/* Rows of eliminated coordinates: f = x - prescribed acceleration; x NULL: f = that acceleration. */
extern void AncfFixRows(Ancf ancf, const PetscReal *x, PetscInt stride, PetscReal *f, PetscInt fstride);

/* ancfdamping.c: f += internal damping force, power (may be NULL) its power; f may be NULL. */
extern PetscErrorCode AncfSetUpDamping(Ancf ancf);
extern void AncfAddViscous(Ancf ancf, const PetscReal *e, const PetscReal *v, PetscInt stride, PetscReal *f, PetscInt fstride,
                           PetscReal *power);
extern void AncfSpin(Ancf ancf, const PetscReal *e, const PetscReal *v, PetscInt stride, PetscReal *spin);
extern void AncfViscousBatch(Ancf ancf, const AncfBatch *b, const PetscReal *spin, const AncfLanes x[12], const PetscReal *v,
                             PetscInt stride, PetscReal ge, PetscReal gv, AncfLanes H[81]);
extern void AncfViscousChain(Ancf ancf, const PetscInt chain[ANCF_LANES], PetscInt k, const AncfLanes x[12], const PetscReal *v,
                             const PetscReal *spin, PetscReal gv, AncfLanes K[ANCF_TANGENT]);
extern PetscErrorCode AncfAssembleViscous(Ancf ancf, const PetscReal *e, const PetscReal *v, PetscInt stride, PetscReal shift,
                                          Mat P);

/* ancfsection.c */
extern PetscErrorCode AncfBeamSection(Ancf ancf, AncfBeam *beam);

/* ancfrest.c: curved and prestressed beams; the first two only if ancf->natural. node: of each lane's element, -1: none. */
extern void AncfRestForce(const Ancf ancf, const PetscInt node[ANCF_LANES], const AncfSection *s, const AncfLanes e[12],
                          AncfLanes Q[12], AncfLanes *U);
extern void AncfRestTangent(const Ancf ancf, const PetscInt node[ANCF_LANES], const AncfSection *s, const AncfLanes e[12],
                            AncfLanes K[ANCF_TANGENT]);
extern void AncfRestSection(const Ancf ancf, const AncfBeam *m, PetscInt node, PetscReal xi, PetscReal *eps, PetscReal kappa[3]);
extern PetscErrorCode AncfSetUpRest(Ancf ancf);
extern PetscErrorCode AncfCheckRest(Ancf ancf, const AncfBeamSpec *s);
extern PetscErrorCode AncfCheckPlane(Ancf ancf, const PetscReal *e, PetscReal t);
extern PetscReal AncfSpecLength(const AncfBeamSpec *s);
extern void AncfSpecPoint(const AncfBeamSpec *s, PetscReal xi, PetscReal e[6]);

/* ancfgroup.c */
extern PetscErrorCode AncfGroupSetUp(Ancf ancf);
extern PetscErrorCode AncfGroupDestroy(Ancf ancf);
extern PetscErrorCode AncfGroupPush(Ancf ancf);
extern PetscErrorCode AncfGroupSolve(Ancf ancf, PetscReal t);

/* ancfadvance.c */
extern PetscErrorCode AncfTSSolve(Ancf ancf, PetscReal t);
extern PetscErrorCode AncfWorstNode(Ancf ancf, SNES snes, PetscInt *node, PetscReal *size);

/* ancfalpha.c */
extern PetscErrorCode AncfAlphaSetUp(Ancf ancf);
extern PetscErrorCode AncfAlphaPreStep(Ancf ancf);
extern PetscErrorCode AncfAlphaPostStep(Ancf ancf);
extern PetscErrorCode AncfAlphaStart(Ancf ancf, PetscReal dt);
extern PetscErrorCode AncfAlphaFunction(Ancf ancf, const PetscReal *a, PetscReal *f);

/* ancfsearch.c: makes a shell line search of the TS the one of the beams; nothing happens to those of other types. */
extern PetscErrorCode AncfSetFullStep(Ancf ancf);

/* ancfstage.c */
extern PetscErrorCode AncfStageSetUp(Ancf ancf);
extern PetscErrorCode AncfStageDestroy(Ancf ancf);
extern PetscErrorCode AncfStagePreStep(Ancf ancf);
extern PetscErrorCode AncfStagePostStep(Ancf ancf);

/* ancfmass.c */
extern PetscErrorCode AncfMassFactor(Ancf ancf);
extern PetscErrorCode AncfMassSolve(Ancf ancf, PetscReal *f, PetscInt stride);
/* f = M x over all coordinates, constraints ignored. */
extern PetscErrorCode AncfMassMult(Ancf ancf, const PetscReal *x, PetscReal *f);
/* eddot from the equations of motion at the current state and loads. */
extern PetscErrorCode AncfComputeAcceleration(Ancf ancf);

#endif
