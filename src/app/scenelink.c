/*
  scenelink.c - what a scene says about links, which hold nodes of ANCF beams together, and the joints made of it.

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
  PetscCheck(l->n >= 2, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
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
  PetscCall(PetscCalloc1(names.n, &s->links));
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
  PetscCall(PetscFree(s->links));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where a node lies at first. */
static void place(const AppScene *s, PetscInt beam, PetscInt node, PetscReal x[3])
{
  const AncfBeamSpec *spec = &s->beams[beam].spec;
  const PetscReal xi = (PetscReal)node / (PetscReal)spec->elements;

  for (int a = 0; a < 3; a++) x[a] = spec->start[a] * (1 - xi) + spec->end[a] * xi;
}

/* By the names of the scene: nodes apart, and nodes that are listed already. */
static PetscErrorCode check_nodes(const AppScene *s, PetscInt number)
{
  const SceneLink *l = &s->links[number];
  PetscReal x0[3], x[3];

  PetscFunctionBegin;
  place(s, l->beam[0], l->node[0], x0);
  for (PetscInt k = 0; k < l->n; k++) {
    const AncfBeamSpec *spec = &s->beams[l->beam[k]].spec;
    PetscReal d = 0, length = 0;

    for (PetscInt m = 0; m <= number; m++)
      for (PetscInt i = 0; i < (m < number ? s->links[m].n : k); i++)
        PetscCheck(s->links[m].beam[i] != l->beam[k] || s->links[m].node[i] != l->node[k], PETSC_COMM_SELF, PETSC_ERR_ARG_INCOMP,
                   "link '%s': node %" PetscInt_FMT
                   " of beam '%s' is in link '%s' already; list all nodes that meet in one link, "
                   "each once",
                   l->name, l->node[k], s->beams[l->beam[k]].name, s->links[m].name);
    place(s, l->beam[k], l->node[k], x);
    for (int a = 0; a < 3; a++) d += PetscSqr(x[a] - x0[a]), length += PetscSqr(spec->end[a] - spec->start[a]);
    PetscCheck(d <= 1e-16 * length / PetscSqr((PetscReal)spec->elements), PETSC_COMM_SELF, PETSC_ERR_ARG_INCOMP,
               "link '%s': node %" PetscInt_FMT " of beam '%s' lies %g m from node %" PetscInt_FMT
               " of beam '%s'; they must be at the same point",
               l->name, l->node[k], s->beams[l->beam[k]].name, (double)PetscSqrtReal(d), l->node[0], s->beams[l->beam[0]].name);
  }
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
  if (at && sscanf(at, "oint %d", &i) == 1 && i >= 0 && i < app->scene.nlinks)
    AppDoing(app, "link '%s'", app->scene.links[i].name);
  PetscFunctionReturn(ierr);
}
