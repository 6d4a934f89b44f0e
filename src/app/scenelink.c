/*
  scenelink.c - what a scene says about links, which hold nodes of ANCF beams together or attach them to a rigid body, and the
  joints and attachments made of it.

  A node is written <beam>.<node>: start, end or a number, 0 being the beam's start.
*/
#include "app.h"
#include <string.h>

static const char *const types[] = {"ball", "rigid", NULL};

#define COUNT(table) ((PetscInt)(sizeof(table) / sizeof((table)[0])))

static PetscErrorCode read_link(const char prefix[], const char title[], SceneLink *l)
{
  const AppOpt opt[] = {
      {OPT_CHOICE, "type", "Ball: one position; rigid: the tangents turn together too", &l->type, types, NULL},
      {OPT_STRING, "body", "Rigid body, or trunk of a lumped beam, that the nodes are attached to (default: none)", l->body, NULL,
       NULL},
      {OPT_STRING, "nodes", "Nodes held together, as <beam>.<node> with start, end or a number, separated by commas (needed)",
       l->text, NULL, NULL},
  };

  PetscFunctionBegin;
  PetscCall(AppOptionsRead(prefix, title, COUNT(opt), opt));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One node, "<beam>.<node>". */
static PetscErrorCode take_node(const AppScene *s, SceneLink *l, char text[])
{
  char *dot = strrchr(text, '.'), *end;
  long node;

  PetscFunctionBegin;
  PetscCheck(dot && dot > text && dot[1], PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
             "link_%s_nodes: '%s' is no node; write <beam>.start, <beam>.end or <beam>.<number>", l->name, text);
  *dot++ = 0;
  for (PetscInt b = 0; b < s->nlumped; b++)
    PetscCheck(strcasecmp(s->lumped[b].name, text), PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
               "link_%s_nodes: beam '%s' is lumped; use joints with its trunks %s_0, %s_1, ...", l->name, text, text, text);
  for (l->beam[l->n] = 0; l->beam[l->n] < s->nbeams && strcasecmp(s->beams[l->beam[l->n]].name, text);) l->beam[l->n]++;
  PetscCheck(l->beam[l->n] < s->nbeams, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "link_%s_nodes: there is no beam '%s' (in '%s.%s')",
             l->name, text, text, dot);
  node = strtol(dot, &end, 10);
  if (!strcasecmp(dot, "start"))
    node = 0;
  else if (!strcasecmp(dot, "end"))
    node = (long)s->beams[l->beam[l->n]].spec.elements;
  else
    PetscCheck(!*end && node >= 0 && node <= (long)s->beams[l->beam[l->n]].spec.elements, PETSC_COMM_SELF,
               PETSC_ERR_ARG_OUTOFRANGE, "link_%s_nodes: node '%s' of beam '%s' must be start, end or 0 to %" PetscInt_FMT,
               l->name, dot, text, s->beams[l->beam[l->n]].spec.elements);
  l->node[l->n++] = (PetscInt)node;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode take_nodes(const AppScene *s, SceneLink *l)
{
  char *copy;
  PetscInt most = 1;

  PetscFunctionBegin;
  PetscCheck(l->text[0], PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "link '%s' needs link_%s_nodes: the nodes held together", l->name,
             l->name);
  for (const char *c = l->text; *c; c++) most += *c == ',';
  PetscCall(PetscMalloc2(most, &l->beam, most, &l->node));
  PetscCall(PetscStrallocpy(l->text, &copy));
  for (char *at = strtok(copy, ", \t"); at; at = strtok(NULL, ", \t")) PetscCall(take_node(s, l, at));
  PetscCall(PetscFree(copy));
  PetscCheck(l->n >= 2 || l->body[0], PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
             "link_%s_nodes = '%s': %" PetscInt_FMT " node; a link needs 2 or more", l->name, l->text, l->n);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Read the links; the beams must have been read. */
PetscErrorCode AppSceneReadLinks(AppScene *s)
{
  AppNames names = {0, NULL};
  SceneLink all;
  PetscBool help;
  const AppOpt opt[] = {
      {OPT_NAMES, "links", "Names of the links between nodes of ANCF beams, separated by commas", &names, NULL, NULL}};
  char prefix[128], title[128];

  PetscFunctionBegin;
  PetscCall(AppOptionsRead(NULL, "Scene: links", 1, opt));
  PetscCall(PetscOptionsHasHelp(NULL, &help));
  PetscCall(PetscMemzero(&all, sizeof(all)));
  if (names.n || help) PetscCall(read_link("link_", "Links: the same for all; -link_<name>_... for one", &all));
  PetscCall(PetscCalloc1((size_t)(s->nmeshjoints + names.n), &s->links));
  PetscCall(PetscArraycpy(s->links, s->meshjoints, s->nmeshjoints));
  s->nlinks = s->nmeshjoints;
  s->nmeshjoints = 0;
  for (PetscInt i = 0; i < names.n; i++) {
    SceneLink *l = &s->links[s->nlinks++];

    *l = all;
    PetscCall(PetscStrncpy(l->name, names.name[i], APP_NAME_LEN));
    PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "link_%s_", l->name));
    PetscCall(PetscSNPrintf(title, sizeof(title), "Link '%s'", l->name));
    PetscCall(read_link(prefix, title, l));
    if (!help) PetscCall(take_nodes(s, l));
  }
  PetscCall(PetscFree(names.name));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppSceneFreeLinks(AppScene *s)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < s->nlinks; i++)
    if (s->links[i].beam) PetscCall(PetscFree2(s->links[i].beam, s->links[i].node));
  for (PetscInt i = 0; i < s->nmeshjoints; i++) PetscCall(PetscFree2(s->meshjoints[i].beam, s->meshjoints[i].node));
  PetscCall(PetscFree(s->links));
  PetscCall(PetscFree(s->meshjoints));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where a node lies at first. */
static PetscErrorCode place(const AppScene *s, PetscInt beam, PetscInt node, PetscReal x[3])
{
  const AncfBeamSpec *spec = &s->beams[beam].spec;
  PetscReal e[6];

  PetscFunctionBegin;
  PetscCall(AncfBeamSpecGetPoint(spec, (PetscReal)node / (PetscReal)spec->elements, e));
  PetscCall(PetscArraycpy(x, e, 3));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* By the names of the scene: nodes apart, and nodes that are listed already. */
static PetscErrorCode check_nodes(const AppScene *s, PetscInt number)
{
  const SceneLink *l = &s->links[number];
  PetscReal x0[3] = {0}, x[3] = {0};

  PetscFunctionBegin;
  PetscCall(place(s, l->beam[0], l->node[0], x0));
  for (PetscInt k = 0; k < l->n; k++) {
    const AncfBeamSpec *spec = &s->beams[l->beam[k]].spec;
    PetscReal d = 0, length = 0;

    for (PetscInt m = 0; m <= number; m++)
      for (PetscInt i = 0; i < (m < number ? s->links[m].n : k) && !s->links[m].body[0] == !l->body[0]; i++)
        PetscCheck(s->links[m].beam[i] != l->beam[k] || s->links[m].node[i] != l->node[k], PETSC_COMM_SELF, PETSC_ERR_ARG_INCOMP,
                   "link '%s': node %" PetscInt_FMT
                   " of beam '%s' is in link '%s' already; list all nodes that meet in one link, "
                   "each once",
                   l->name, l->node[k], s->beams[l->beam[k]].name, s->links[m].name);
    if (l->body[0]) continue;
    PetscCall(place(s, l->beam[k], l->node[k], x));
    for (int a = 0; a < 3; a++) d += PetscSqr(x[a] - x0[a]), length += PetscSqr(spec->end[a] - spec->start[a]);
    PetscCheck(d <= 1e-16 * length / PetscSqr((PetscReal)spec->elements), PETSC_COMM_SELF, PETSC_ERR_ARG_INCOMP,
               "link '%s': node %" PetscInt_FMT " of beam '%s' lies %g m from node %" PetscInt_FMT
               " of beam '%s'; they must be at the same point",
               l->name, l->node[k], s->beams[l->beam[k]].name, (double)PetscSqrtReal(d), l->node[0], s->beams[l->beam[0]].name);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Supports of the nodes that a body will hold. */
static PetscErrorCode support_nodes(App *app, const SceneLink *l)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < l->n; k++) {
    const SceneBeam *b = &app->scene.beams[l->beam[k]];
    const PetscBool start = l->node[k] == 0 ? PETSC_TRUE : PETSC_FALSE;
    const AncfEnd end = start ? b->spec.end0 : l->node[k] == b->spec.elements ? b->spec.end1 : ANCF_END_FREE;

    PetscCheck(end == ANCF_END_FREE, PETSC_COMM_SELF, PETSC_ERR_ARG_INCOMP,
               "link '%s': beam_%s_end%d = %s, but body '%s' holds this end; leave it free", l->name, b->name, start ? 0 : 1,
               end == ANCF_END_PIN ? "pin" : "clamp", l->body);
    PetscCall(AncfFixNode(app->ancf, l->beam[k], l->node[k], l->type ? ANCF_END_CLAMP : ANCF_END_PIN));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A body's point and the beam's node must start with one velocity, or both would be hit at once. */
static PetscErrorCode check_velocity(const App *app, const SceneLink *l, PetscInt k, PetscInt body)
{
  const PetscReal *v = app->scene.beams[l->beam[k]].spec.velocity;
  PetscReal X[3], V[3], w[3], x[3] = {0}, d = 0, size = 0;

  PetscFunctionBegin;
  PetscCall(RigidGetState(app->rigid, body, X, NULL, V, w));
  PetscCall(place(&app->scene, l->beam[k], l->node[k], x));
  for (int a = 0; a < 3; a++) {
    const int b = (a + 1) % 3, c = (a + 2) % 3;

    V[a] += w[b] * (x[c] - X[c]) - w[c] * (x[b] - X[b]);
    d += PetscSqr(V[a] - v[a]);
    size += PetscSqr(v[a]);
  }
  PetscCheck(
      d <= 1e-12 * size, PETSC_COMM_SELF, PETSC_ERR_ARG_INCOMP,
      "link '%s': beam '%s' starts with (%g, %g, %g) m/s, but its node's place on body '%s' with (%g, %g, %g); give both the "
      "same velocity",
      l->name, app->scene.beams[l->beam[k]].name, (double)v[0], (double)v[1], (double)v[2], l->body, (double)V[0], (double)V[1],
      (double)V[2]);
  PetscCheck(!l->type || (w[0] == 0 && w[1] == 0 && w[2] == 0), PETSC_COMM_SELF, PETSC_ERR_ARG_INCOMP,
             "link '%s': body_%s_omega = %g,%g,%g rad/s, but the beam clamped to it starts without turning; start with 0",
             l->name, l->body, (double)w[0], (double)w[1], (double)w[2]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The attachments, once beams and bodies are set up. */
PetscErrorCode AppBuildAttach(App *app)
{
  AppScene *s = &app->scene;
  PetscInt body, any = 0;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < s->nlinks; i++) any += s->links[i].body[0] != 0;
  if (!any) PetscFunctionReturn(PETSC_SUCCESS);
  if (app->rigid) PetscCall(CoupleAttachCreate(PETSC_COMM_SELF, app->ancf, app->rigid, &app->attach));
  for (PetscInt i = 0; i < s->nlinks; i++) {
    SceneLink *l = &s->links[i];

    if (!l->body[0]) continue;
    for (body = 0; body < s->nbodies && strcasecmp(s->bodies[body].name, l->body);) body++;
    PetscCheck(app->rigid && body < s->nbodies, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "link_%s_body: there is no body '%s'",
               l->name, l->body);
    PetscCall(CoupleAttachGetNum(app->attach, &l->first));
    for (PetscInt k = 0; k < l->n; k++) {
      AppDoing(app, "link '%s'", l->name);
      PetscCall(CoupleAttachAdd(app->attach, l->beam[k], l->node[k], body));
      AppDoing(app, "%s", "");
      PetscCall(check_velocity(app, l, k, body));
    }
  }
  PetscCall(CoupleAttachSetFromOptions(app->attach));
  PetscCall(CoupleAttachSetUp(app->attach));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The joints of the beams, before they are set up. */
PetscErrorCode AppBuildLinks(App *app)
{
  const AppScene *s = &app->scene;

  PetscFunctionBegin;
  PetscCheck(s->nbeams || !s->nlinks, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "link '%s': the scene has no ANCF beams",
             s->links[0].name);
  for (PetscInt i = 0; i < s->nlinks; i++) {
    const SceneLink *l = &s->links[i];

    PetscCall(check_nodes(s, i));
    AppDoing(app, "link '%s'", l->name);
    if (l->body[0])
      PetscCall(support_nodes(app, l));
    else
      PetscCall(AncfAddJoint(app->ancf, l->type ? ANCF_JOINT_RIGID : ANCF_JOINT_BALL, l->n, l->beam, l->node, NULL));
    AppDoing(app, "%s", "");
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* AncfSetUp(), errors of a joint with the name of its link. */
PetscErrorCode AppSetUpBeams(App *app)
{
  PetscErrorCode ierr;
  const char *at;
  int i;

  PetscFunctionBegin;
  ierr = AncfSetUp(app->ancf);
  at = ierr && app->errors ? strstr(app->errors->message, "oint ") : NULL;
  if (!at || sscanf(at, "oint %d", &i) != 1) PetscFunctionReturn(ierr);
  for (PetscInt k = 0; k < app->scene.nlinks; k++)
    if (!app->scene.links[k].body[0] && i-- == 0) AppDoing(app, "link '%s'", app->scene.links[k].name);
  PetscFunctionReturn(ierr);
}
