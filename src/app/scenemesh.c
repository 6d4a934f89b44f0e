/*
  scenemesh.c - beams from the line elements of a Gmsh mesh, through PETSc's DMPlex.

  A physical group of lines is one beam: an open chain, straight or an arc of a circle, of evenly spaced nodes.
*/
#include "app.h"
#include <petscdmplex.h>
#include <string.h>

/* Places of nodes may differ by this share of an element: files hold as few as eight digits. */
#define PLACE_TOLERANCE 1e-6

typedef struct {
  const char *beam, *file, *group;
  DM dm;
  PetscInt n, v0, nv;    /* line elements of the group; the mesh's vertices are v0 to v0 + nv - 1 */
  PetscInt *edge, *pair; /* vertices of each element, n x 2; n + 1 vertices in the order of the chain */
  PetscInt *count, *at;  /* per vertex: elements that it is in, and two of them */
  PetscReal *x;          /* n + 1 x 3, nodes in the order of the chain, m */
} Chain;

#define CHAIN_CHECK(c, ok, ...) PetscCheck(ok, PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED, __VA_ARGS__)

/* What PETSc's reader needs not be asked for: a file that is there, starts as a mesh and is whole. */
static PetscErrorCode check_file(const char beam[], const char file[])
{
  FILE *f = fopen(file, "rb");
  const char *const last = "$EndElements";
  const size_t nlast = strlen(last);
  char start[12] = "";
  size_t matched = 0, got;
  int c;

  PetscFunctionBegin;
  PetscCheck(f, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "beam '%s': cannot open its mesh '%s'", beam, file);
  got = fread(start, 1, sizeof(start) - 1, f);
  while (matched < nlast && (c = fgetc(f)) != EOF) matched = c == last[matched] ? matched + 1 : c == last[0];
  fclose(f);
  PetscCheck(got == 11 && !strncmp(start, "$MeshFormat", 11), PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED,
             "beam '%s': '%s' is no Gmsh mesh; it does not start with $MeshFormat", beam, file);
  PetscCheck(matched == nlast, PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED, "beam '%s': the mesh '%s' is not whole; it has no %s",
             beam, file, last);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Physical names become labels; options of the program's do not reach the reader. */
static PetscErrorCode load(const char beam[], const char file[], DM *dm)
{
  PetscOptions own;
  PetscErrorCode ierr;
  PetscInt dim;

  PetscFunctionBegin;
  PetscCall(check_file(beam, file));
  PetscCall(PetscOptionsCreate(&own));
  PetscCall(PetscOptionsPush(own));
  PetscCall(PetscOptionsSetValue(NULL, "-dm_plex_gmsh_use_regions", "true"));
  PetscCall(PetscOptionsSetValue(NULL, "-dm_plex_gmsh_spacedim", "3"));
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  ierr = DMPlexCreateGmshFromFile(PETSC_COMM_SELF, file, PETSC_TRUE, dm);
  PetscCall(PetscPopErrorHandler());
  PetscCall(PetscOptionsPop());
  PetscCall(PetscOptionsDestroy(&own));
  PetscCheck(!ierr, PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED,
             "beam '%s': PETSc cannot read the mesh '%s'; it is damaged, not of lines alone, or of a version other than 2.2, 4.0 "
             "and 4.1",
             beam, file);
  PetscCall(DMGetDimension(*dm, &dim));
  PetscCheck(dim == 1, PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED,
             "beam '%s': the mesh '%s' has elements of dimension %" PetscInt_FMT "; save the lines alone", beam, file, dim);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The physical names of a mesh, for an error line. */
static PetscErrorCode list_groups(DM dm, size_t len, char text[])
{
  const char *const own[] = {"celltype", "depth", "Cell Sets", "Face Sets", "Edge Sets", "Vertex Sets"};
  PetscInt n;

  PetscFunctionBegin;
  text[0] = 0;
  PetscCall(DMGetNumLabels(dm, &n));
  for (PetscInt i = 0; i < n; i++) {
    const char *name;
    PetscBool skip = PETSC_FALSE;

    PetscCall(DMGetLabelName(dm, i, &name));
    for (int k = 0; k < 6; k++) skip = (PetscBool)(skip || !strcmp(name, own[k]));
    if (skip) continue;
    if (text[0]) PetscCall(PetscStrlcat(text, ", ", len));
    PetscCall(PetscStrlcat(text, name, len));
  }
  if (!text[0]) PetscCall(PetscStrncpy(text, "none", len));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode find_lines(Chain *c)
{
  PetscInt lo, hi, value, none;
  DMLabel label;
  char known[256];

  PetscFunctionBegin;
  PetscCall(DMGetLabel(c->dm, c->group, &label));
  PetscCall(list_groups(c->dm, sizeof(known), known));
  CHAIN_CHECK(c, label, "beam '%s': the mesh '%s' has no physical group '%s' (it has: %s)", c->beam, c->file, c->group, known);
  PetscCall(DMPlexGetDepthStratum(c->dm, 0, &c->v0, &hi));
  c->nv = hi - c->v0;
  PetscCall(DMPlexGetHeightStratum(c->dm, 0, &lo, &hi));
  PetscCall(DMLabelGetDefaultValue(label, &none));
  PetscCall(PetscMalloc2(2 * (size_t)(hi - lo), &c->edge, (size_t)(hi - lo + 1), &c->pair));
  for (PetscInt e = lo; e < hi; e++) {
    const PetscInt *cone;

    PetscCall(DMLabelGetValue(label, e, &value));
    if (value == none) continue;
    PetscCall(DMPlexGetCone(c->dm, e, &cone));
    for (int k = 0; k < 2; k++) c->edge[2 * c->n + k] = cone[k] - c->v0;
    c->n++;
  }
  CHAIN_CHECK(c, c->n, "beam '%s': the physical group '%s' of '%s' has no line elements", c->beam, c->group, c->file);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode place(const Chain *c, PetscInt vertex, PetscReal x[3])
{
  PetscSection section;
  const PetscScalar *all;
  PetscInt offset;
  Vec places;

  PetscFunctionBegin;
  PetscCall(DMGetCoordinatesLocal(c->dm, &places));
  PetscCall(DMGetCoordinateSection(c->dm, &section));
  PetscCall(PetscSectionGetOffset(section, vertex + c->v0, &offset));
  PetscCall(VecGetArrayRead(places, &all));
  for (int a = 0; a < 3; a++) x[a] = PetscRealPart(all[offset + a]);
  PetscCall(VecRestoreArrayRead(places, &all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal distance(const PetscReal a[3], const PetscReal b[3])
{
  return PetscSqrtReal(PetscSqr(a[0] - b[0]) + PetscSqr(a[1] - b[1]) + PetscSqr(a[2] - b[2]));
}

/* Elements without length; which elements meet at each vertex. */
static PetscErrorCode meet(Chain *c)
{
  PetscReal a[3], b[3], longest = 0;

  PetscFunctionBegin;
  PetscCall(PetscCalloc2(c->nv, &c->count, 2 * (size_t)c->nv, &c->at));
  for (int pass = 0; pass < 2; pass++)
    for (PetscInt e = 0; e < c->n; e++) {
      PetscCall(place(c, c->edge[2 * e], a));
      PetscCall(place(c, c->edge[2 * e + 1], b));
      if (!pass) longest = PetscMax(longest, distance(a, b));
      CHAIN_CHECK(c, !pass || distance(a, b) > 1e-9 * longest,
                  "beam '%s': the physical group '%s' of '%s' has a line element of zero length at (%g, %g, %g) m", c->beam,
                  c->group, c->file, (double)a[0], (double)a[1], (double)a[2]);
    }
  for (PetscInt k = 0; k < 2 * c->n; k++) {
    const PetscInt v = c->edge[k];

    PetscCall(place(c, v, a));
    CHAIN_CHECK(c, c->count[v] < 2,
                "beam '%s': the physical group '%s' of '%s' branches at (%g, %g, %g) m; make each branch a group and a beam, and "
                "hold them together by links",
                c->beam, c->group, c->file, (double)a[0], (double)a[1], (double)a[2]);
    c->at[2 * v + c->count[v]++] = k / 2;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Ends at one place are nodes that were written twice; else there is a gap. */
static PetscErrorCode refuse_pieces(const Chain *c)
{
  PetscReal a[3], b[3];

  PetscFunctionBegin;
  for (PetscInt i = 0; i < c->nv; i++)
    for (PetscInt j = 0; j < i && c->count[i] == 1; j++) {
      if (c->count[j] != 1) continue;
      PetscCall(place(c, i, a));
      PetscCall(place(c, j, b));
      CHAIN_CHECK(c, distance(a, b) > 1e-9 * (distance(a, (PetscReal[3]){0}) + distance(b, (PetscReal[3]){0})),
                  "beam '%s': the physical group '%s' of '%s' has duplicate nodes at (%g, %g, %g) m; merge them (Coherence Mesh)",
                  c->beam, c->group, c->file, (double)a[0], (double)a[1], (double)a[2]);
    }
  SETERRQ(PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED,
          "beam '%s': the physical group '%s' of '%s' is disconnected; a beam is one chain of lines", c->beam, c->group, c->file);
}

/* The nodes one after the other, in the direction that the lines have in the file. */
static PetscErrorCode follow(Chain *c)
{
  PetscInt v = -1, e = -1, done = 0;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < c->nv; i++) {
    if (c->count[i] != 1) continue;
    if (v < 0 || (c->edge[2 * c->at[2 * i]] == i && c->edge[2 * c->at[2 * v]] != v)) v = i;
  }
  CHAIN_CHECK(c, v >= 0, "beam '%s': the physical group '%s' of '%s' is a closed loop; a beam has two ends: make it two groups",
              c->beam, c->group, c->file);
  for (c->pair[0] = v; done < c->n; c->pair[done] = v) {
    const PetscInt next = c->at[2 * v] != e ? c->at[2 * v] : c->at[2 * v + 1];

    if (done && c->count[v] == 1) break;
    e = next;
    v = c->edge[2 * e] == v ? c->edge[2 * e + 1] : c->edge[2 * e];
    done++;
  }
  if (done < c->n) PetscCall(refuse_pieces(c));
  PetscCall(PetscMalloc1(3 * (size_t)(c->n + 1), &c->x));
  for (PetscInt i = 0; i <= c->n; i++) PetscCall(place(c, c->pair[i], c->x + 3 * i));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The circle through the first, the middle and the last node: curvature (1/m), axis and centre; 0 for a straight line. */
static PetscReal circle(const Chain *c, PetscReal axis[3], PetscReal centre[3])
{
  const PetscReal *p = c->x, *q = c->x + 3 * (c->n / 2), *r = c->x + 3 * c->n;
  PetscReal u[3], w[3], uu = 0, ww = 0, nn = 0;

  for (int a = 0; a < 3; a++) u[a] = q[a] - p[a], w[a] = r[a] - p[a], uu += u[a] * u[a], ww += w[a] * w[a];
  for (int a = 0; a < 3; a++)
    axis[a] = u[(a + 1) % 3] * w[(a + 2) % 3] - u[(a + 2) % 3] * w[(a + 1) % 3], nn += axis[a] * axis[a];
  if (PetscSqrtReal(nn) <= PLACE_TOLERANCE * ww / (PetscReal)c->n) return 0;
  for (int a = 0; a < 3; a++) {
    const int i = (a + 1) % 3, j = (a + 2) % 3;

    centre[a] = p[a] + (uu * (w[i] * axis[j] - w[j] * axis[i]) + ww * (axis[i] * u[j] - axis[j] * u[i])) / (2 * nn);
  }
  for (int a = 0; a < 3; a++) axis[a] /= PetscSqrtReal(nn);
  return 1 / distance(p, centre);
}

/* Start, end, elements, curvature and normal; the nodes must be where a beam so described has them. */
static PetscErrorCode describe(const Chain *c, AncfBeamSpec *spec)
{
  const PetscReal *first = c->x, *last = c->x + 3 * c->n;
  const PetscReal chord = distance(first, last);
  PetscReal axis[3], centre[3] = {0}, side[3] = {0};
  const PetscReal kappa = c->n > 1 ? circle(c, axis, centre) : 0;
  const PetscReal angle = kappa > 0 ? 2 * PetscAsinReal(PetscMin(1.0, chord * kappa / 2)) : 0;

  PetscFunctionBegin;
  for (int a = 0; a < 3 && kappa > 0; a++) {
    const int i = (a + 1) % 3, j = (a + 2) % 3;

    side[a] = axis[i] * (first[j] - centre[j]) - axis[j] * (first[i] - centre[i]);
  }
  for (PetscInt k = 0; k <= c->n; k++) {
    const PetscReal xi = (PetscReal)k / (PetscReal)c->n, co = PetscCosReal(angle * xi), si = PetscSinReal(angle * xi);
    PetscReal x[3];

    for (int a = 0; a < 3; a++)
      x[a] = kappa > 0 ? centre[a] + co * (first[a] - centre[a]) + si * side[a] : first[a] * (1 - xi) + last[a] * xi;
    CHAIN_CHECK(c, distance(x, c->x + 3 * k) <= PLACE_TOLERANCE * PetscMax(chord, angle / PetscMax(kappa, 1e-300)),
                "beam '%s': node %" PetscInt_FMT
                " of the physical group '%s' of '%s', (%g, %g, %g) m, lies %g m from its place; a "
                "beam is a straight line or an arc of at most half a circle, with evenly spaced nodes",
                c->beam, k, c->group, c->file, (double)c->x[3 * k], (double)c->x[3 * k + 1], (double)c->x[3 * k + 2],
                (double)distance(x, c->x + 3 * k));
  }
  PetscCall(PetscArraycpy(spec->start, first, 3));
  PetscCall(PetscArraycpy(spec->end, last, 3));
  spec->elements = c->n;
  spec->curvature = kappa;
  if (kappa > 0) PetscCall(PetscArraycpy(spec->normal, axis, 3));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A file that is not in the working folder may lie beside the scene. */
PetscErrorCode AppFindFile(const char scene[], char file[PETSC_MAX_PATH_LEN])
{
  const char *slash = scene ? strrchr(scene, '/') : NULL;
  char beside[PETSC_MAX_PATH_LEN];
  PetscBool there;

  PetscFunctionBegin;
  PetscCall(PetscTestFile(file, 'r', &there));
  if (there || !slash || file[0] == '/') PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscStrncpy(beside, scene, PetscMin((size_t)(slash - scene) + 2, sizeof(beside))));
  PetscCall(PetscStrlcat(beside, file, sizeof(beside)));
  PetscCall(PetscTestFile(beside, 'r', &there));
  if (there) PetscCall(PetscStrncpy(file, beside, PETSC_MAX_PATH_LEN));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppMeshBeam(AppMesh *mesh, SceneBeam *beam)
{
  Chain c = {beam->name, beam->mesh, beam->group[0] ? beam->group : beam->name, NULL, 0, 0, 0, NULL, NULL, NULL, NULL, NULL};

  PetscFunctionBegin;
  PetscCall(AppFindFile(mesh->scene, beam->mesh));
  if (!mesh->dm || strcmp(mesh->file, beam->mesh)) {
    PetscCall(AppMeshDestroy(mesh));
    PetscCall(load(beam->name, beam->mesh, &mesh->dm));
    PetscCall(PetscStrncpy(mesh->file, beam->mesh, sizeof(mesh->file)));
  }
  c.dm = mesh->dm;
  PetscCall(find_lines(&c));
  PetscCall(meet(&c));
  PetscCall(follow(&c));
  PetscCall(describe(&c, &beam->spec));
  PetscCall(PetscFree2(c.edge, c.pair));
  PetscCall(PetscFree2(c.count, c.at));
  PetscCall(PetscFree(c.x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppMeshDestroy(AppMesh *mesh)
{
  PetscFunctionBegin;
  PetscCall(DMDestroy(&mesh->dm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
