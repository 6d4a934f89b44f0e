/*
  scenemesh.c - beams from the line elements of a Gmsh mesh, through PETSc's DMPlex.

  A physical group of lines is one beam, or several that are joined rigidly where they branch, at corners, and where a closed loop
  is cut. Each is straight, an arc, or another curve in a plane (scenecurve.c).
*/
#include "app.h"
#include <petscdmplex.h>
#include <string.h>

/* A corner is where the direction turns by more than CORNER_ANGLE, or by SMOOTH_ANGLE (rad) and SHARP_RATIO times what it turns
   at the points around. */
#define CORNER_ANGLE 0.9
#define SMOOTH_ANGLE 0.02
#define SHARP_RATIO 2.5

/* Lines order[first] to order[first + n - 1], from the vertex start on. closed: a loop without any end. */
typedef struct {
  PetscInt first, n, start;
  PetscBool closed;
} Piece;

typedef struct {
  const char *beam, *file, *group;
  DM dm;
  PetscBool curved;           /* lines of second order */
  PetscInt n, v0, nv;         /* line elements of the group; the mesh's vertices are v0 to v0 + nv - 1 */
  PetscInt *edge, *line;      /* vertices of each element, n x 2; its number in the mesh */
  PetscReal *vertex, *middle; /* places of vertices and, of second order, of the middles of lines, m */
  PetscInt *first, *at;       /* lines that meet at each vertex, see meet() */
  PetscBool *ends;            /* vertices where pieces end */
  PetscInt npieces, *order;
  Piece *piece;
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
  PetscCall(PetscMalloc2(2 * (size_t)(hi - lo), &c->edge, (size_t)(hi - lo), &c->line));
  for (PetscInt e = lo; e < hi; e++) {
    const PetscInt *cone;

    PetscCall(DMLabelGetValue(label, e, &value));
    if (value == none) continue;
    PetscCall(DMPlexGetCone(c->dm, e, &cone));
    for (int k = 0; k < 2; k++) c->edge[2 * c->n + k] = cone[k] - c->v0;
    c->line[c->n++] = e;
  }
  CHAIN_CHECK(c, c->n, "beam '%s': the physical group '%s' of '%s' has no line elements", c->beam, c->group, c->file);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Places of vertices and middle nodes. PETSc keeps lines of second order either cell by cell, three places each, or as a place for
  each vertex and one for each line.
*/
static PetscErrorCode read_places(Chain *c)
{
  PetscInt lo, hi, dof, offset;
  PetscSection section;
  const PetscScalar *all;
  Vec places;

  PetscFunctionBegin;
  PetscCall(DMGetCoordinatesLocal(c->dm, &places));
  PetscCall(DMGetCoordinateSection(c->dm, &section));
  PetscCall(PetscSectionGetChart(section, &lo, &hi));
  PetscCall(PetscCalloc2(3 * (size_t)c->nv, &c->vertex, 3 * (size_t)c->n, &c->middle));
  PetscCall(VecGetArrayRead(places, &all));
  for (PetscInt v = 0; v < c->nv; v++) {
    PetscCall(PetscSectionGetDof(section, v + c->v0, &dof));
    PetscCall(PetscSectionGetOffset(section, v + c->v0, &offset));
    for (int a = 0; a < 3 && dof == 3; a++) c->vertex[3 * v + a] = PetscRealPart(all[offset + a]);
  }
  for (PetscInt e = 0; e < c->n; e++) {
    if (c->line[e] < lo || c->line[e] >= hi) continue;
    PetscCall(PetscSectionGetDof(section, c->line[e], &dof));
    PetscCall(PetscSectionGetOffset(section, c->line[e], &offset));
    CHAIN_CHECK(c, dof == 0 || dof == 3 || dof == 9,
                "beam '%s': the physical group '%s' of '%s' has lines of an order above 2; save first or second order", c->beam,
                c->group, c->file);
    for (int a = 0; a < 3 && dof == 9; a++) {
      c->vertex[3 * c->edge[2 * e] + a] = PetscRealPart(all[offset + a]);
      c->vertex[3 * c->edge[2 * e + 1] + a] = PetscRealPart(all[offset + 6 + a]);
    }
    for (int a = 0; a < 3 && dof; a++) c->middle[3 * e + a] = PetscRealPart(all[offset + (dof == 9 ? 3 : 0) + a]);
    if (dof) c->curved = PETSC_TRUE;
  }
  PetscCall(VecRestoreArrayRead(places, &all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal distance(const PetscReal a[3], const PetscReal b[3])
{
  return PetscSqrtReal(PetscSqr(a[0] - b[0]) + PetscSqr(a[1] - b[1]) + PetscSqr(a[2] - b[2]));
}

/* The vertex at the other end of a line element. */
static PetscInt other(const Chain *c, PetscInt line, PetscInt vertex)
{
  return c->edge[2 * line] == vertex ? c->edge[2 * line + 1] : c->edge[2 * line];
}

/* The lines that meet at each vertex: at[first[v]] to at[first[v + 1] - 1]. */
static PetscErrorCode meet(Chain *c)
{
  PetscInt *fill;

  PetscFunctionBegin;
  PetscCall(PetscCalloc3((size_t)c->nv + 1, &c->first, 2 * (size_t)c->n, &c->at, (size_t)c->nv, &c->ends));
  PetscCall(PetscCalloc1(c->nv, &fill));
  for (PetscInt k = 0; k < 2 * c->n; k++) c->first[c->edge[k] + 1]++;
  for (PetscInt v = 0; v < c->nv; v++) {
    c->ends[v] = (PetscBool)(c->first[v + 1] != 2 && c->first[v + 1] != 0);
    c->first[v + 1] += c->first[v];
  }
  for (PetscInt k = 0; k < 2 * c->n; k++) c->at[c->first[c->edge[k]] + fill[c->edge[k]]++] = k / 2;
  PetscCall(PetscFree(fill));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How many lines meet at a vertex. */
static PetscInt degree(const Chain *c, PetscInt v)
{
  return c->first[v + 1] - c->first[v];
}

/* Elements without length, and elements that are there twice. */
static PetscErrorCode check_lines(const Chain *c)
{
  PetscReal a[3], b[3], longest = 0;

  PetscFunctionBegin;
  for (int pass = 0; pass < 2; pass++)
    for (PetscInt e = 0; e < c->n; e++) {
      const PetscInt v = c->edge[2 * e];

      PetscCall(PetscArraycpy(a, c->vertex + 3 * (v), 3));
      PetscCall(PetscArraycpy(b, c->vertex + 3 * (c->edge[2 * e + 1]), 3));
      if (!pass) longest = PetscMax(longest, distance(a, b));
      CHAIN_CHECK(c, !pass || distance(a, b) > 1e-9 * longest,
                  "beam '%s': the physical group '%s' of '%s' has a line element of zero length at (%g, %g, %g) m", c->beam,
                  c->group, c->file, (double)a[0], (double)a[1], (double)a[2]);
      for (PetscInt k = c->first[v]; k < c->first[v + 1] && pass; k++)
        CHAIN_CHECK(c, c->at[k] >= e || other(c, c->at[k], v) != c->edge[2 * e + 1],
                    "beam '%s': the physical group '%s' of '%s' has a line element twice, from (%g, %g, %g) to (%g, %g, %g) m",
                    c->beam, c->group, c->file, (double)a[0], (double)a[1], (double)a[2], (double)b[0], (double)b[1],
                    (double)b[2]);
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Ends at one place are nodes that were written twice. */
static PetscErrorCode check_duplicates(const Chain *c, PetscBool all)
{
  PetscReal a[3], b[3];

  PetscFunctionBegin;
  for (PetscInt i = 0; i < c->nv; i++)
    for (PetscInt j = 0; j < i && (c->ends[i] || (all && degree(c, i))); j++) {
      if (!c->ends[j] && !(all && degree(c, j))) continue;
      PetscCall(PetscArraycpy(a, c->vertex + 3 * (i), 3));
      PetscCall(PetscArraycpy(b, c->vertex + 3 * (j), 3));
      CHAIN_CHECK(c, distance(a, b) > 1e-9 * (distance(a, (PetscReal[3]){0}) + distance(b, (PetscReal[3]){0})),
                  "beam '%s': the physical group '%s' of '%s' has duplicate nodes at (%g, %g, %g) m; merge them (Coherence Mesh)",
                  c->beam, c->group, c->file, (double)a[0], (double)a[1], (double)a[2]);
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Every line must be reached from the first one. */
static PetscErrorCode check_connected(const Chain *c)
{
  PetscInt *queue, n = 1, *seen;

  PetscFunctionBegin;
  PetscCall(PetscCalloc2(c->n, &queue, c->n, &seen));
  seen[0] = 1;
  for (PetscInt i = 0; i < n; i++)
    for (int end = 0; end < 2; end++) {
      const PetscInt v = c->edge[2 * queue[i] + end];

      for (PetscInt k = c->first[v]; k < c->first[v + 1]; k++)
        if (!seen[c->at[k]]) seen[c->at[k]] = 1, queue[n++] = c->at[k];
    }
  PetscCall(PetscFree2(queue, seen));
  PetscCall(check_duplicates(c, (PetscBool)(n < c->n)));
  CHAIN_CHECK(c, n == c->n, "beam '%s': the physical group '%s' of '%s' is disconnected; the lines of a beam hang together",
              c->beam, c->group, c->file);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The next point from a vertex along a line: the middle node of a line of second order, else the other end. */
static PetscErrorCode next_point(const Chain *c, PetscInt line, PetscInt vertex, PetscReal x[3])
{
  PetscFunctionBegin;
  PetscCall(PetscArraycpy(x, c->curved ? c->middle + 3 * line : c->vertex + 3 * other(c, line, vertex), 3));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Angle by which the way from one line to another turns at a vertex, rad. */
static PetscErrorCode turn(const Chain *c, PetscInt vertex, PetscInt from, PetscInt to, PetscReal *angle)
{
  PetscReal a[3], b[3], x[3], u[3], w[3], dot = 0, n2 = 0;

  PetscFunctionBegin;
  PetscCall(PetscArraycpy(x, c->vertex + 3 * (vertex), 3));
  PetscCall(next_point(c, from, vertex, a));
  PetscCall(next_point(c, to, vertex, b));
  for (int k = 0; k < 3; k++) u[k] = x[k] - a[k], w[k] = b[k] - x[k], dot += u[k] * w[k];
  for (int k = 0; k < 3; k++) n2 += PetscSqr(u[(k + 1) % 3] * w[(k + 2) % 3] - u[(k + 2) % 3] * w[(k + 1) % 3]);
  *angle = PetscAtan2Real(PetscSqrtReal(n2), dot);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lines that leave a vertex in one direction lie upon one another. */
static PetscErrorCode check_folds(const Chain *c)
{
  PetscReal angle = 0, x[3];

  PetscFunctionBegin;
  for (PetscInt v = 0; v < c->nv; v++)
    for (PetscInt i = c->first[v]; i < c->first[v + 1]; i++)
      for (PetscInt j = c->first[v]; j < i; j++) {
        PetscCall(turn(c, v, c->at[i], c->at[j], &angle));
        PetscCall(PetscArraycpy(x, c->vertex + 3 * (v), 3));
        CHAIN_CHECK(c, angle < PETSC_PI - 1e-3,
                    "beam '%s': the physical group '%s' of '%s' has lines that lie upon one another at (%g, %g, %g) m", c->beam,
                    c->group, c->file, (double)x[0], (double)x[1], (double)x[2]);
      }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The turn at the point that follows a vertex along a line; 0 where that is an end. */
static PetscErrorCode next_turn(const Chain *c, PetscInt line, PetscInt vertex, PetscReal *angle)
{
  const PetscInt v = other(c, line, vertex);
  PetscReal a[3], m[3], b[3], u[3], w[3], dot = 0, n2 = 0;

  PetscFunctionBegin;
  *angle = 0;
  if (!c->curved) {
    if (degree(c, v) == 2) PetscCall(turn(c, v, c->at[c->first[v]], c->at[c->first[v] + 1], angle));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscArraycpy(a, c->vertex + 3 * (vertex), 3));
  PetscCall(next_point(c, line, vertex, m));
  PetscCall(PetscArraycpy(b, c->vertex + 3 * (v), 3));
  for (int k = 0; k < 3; k++) u[k] = m[k] - a[k], w[k] = b[k] - m[k], dot += u[k] * w[k];
  for (int k = 0; k < 3; k++) n2 += PetscSqr(u[(k + 1) % 3] * w[(k + 2) % 3] - u[(k + 2) % 3] * w[(k + 1) % 3]);
  *angle = PetscAtan2Real(PetscSqrtReal(n2), dot);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A corner turns much, or by far more than the points around it. */
static PetscErrorCode is_sharp(const Chain *c, PetscInt vertex, PetscInt from, PetscInt to, PetscReal *angle, PetscBool *sharp)
{
  PetscReal before, after;

  PetscFunctionBegin;
  PetscCall(turn(c, vertex, from, to, angle));
  PetscCall(next_turn(c, from, vertex, &before));
  PetscCall(next_turn(c, to, vertex, &after));
  *sharp = (PetscBool)(*angle > CORNER_ANGLE || (*angle > SMOOTH_ANGLE && *angle > SHARP_RATIO * PetscMax(before, after)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Cut into pieces between the vertices that are ends, in the order of their first lines, which give their directions. */
static PetscErrorCode cut(Chain *c)
{
  PetscBool *seen;
  PetscInt done = 0;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(c->n, &seen));
  c->npieces = 0;
  for (PetscInt e = 0; e < c->n; e++) {
    PetscInt line = e, v = c->edge[2 * e], n = 0, *to = c->order + done;

    if (seen[e]) continue;
    while (!c->ends[v]) { /* back to where the piece begins */
      const PetscInt before = c->at[c->first[v]] != line ? c->at[c->first[v]] : c->at[c->first[v] + 1];

      line = before;
      v = other(c, line, v);
      if (before == e) { /* a loop starts where its first line starts */
        v = c->edge[2 * e];
        break;
      }
    }
    c->piece[c->npieces] = (Piece){done, 0, v, (PetscBool)!c->ends[v]};
    for (;;) {
      to[n++] = line;
      seen[line] = PETSC_TRUE;
      v = other(c, line, v);
      if (c->ends[v] || v == c->piece[c->npieces].start) break;
      line = c->at[c->first[v]] != line ? c->at[c->first[v]] : c->at[c->first[v] + 1];
    }
    c->piece[c->npieces++].n = n;
    done += n;
    { /* turned around if the line at its end starts there, and the one at its start does not */
      Piece *p = &c->piece[c->npieces - 1];
      const PetscBool starts = (PetscBool)(c->edge[2 * to[0]] == p->start), back = (PetscBool)(c->edge[2 * to[n - 1]] == v);

      if (p->closed || (starts && !back) || (starts == back && p->start < v)) continue;
      for (PetscInt k = 0; k < n / 2; k++) {
        const PetscInt swap = to[k];

        to[k] = to[n - 1 - k];
        to[n - 1 - k] = swap;
      }
      p->start = v;
    }
  }
  PetscCall(PetscFree(seen));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The points of a piece, middle nodes included; m: their number less 1. x: 3 x (2 n + 1). */
static PetscErrorCode points(const Chain *c, const Piece *p, PetscInt *m, PetscReal *x)
{
  PetscInt v = p->start;

  PetscFunctionBegin;
  *m = 0;
  PetscCall(PetscArraycpy(x, c->vertex + 3 * (v), 3));
  for (PetscInt k = 0; k < p->n; k++) {
    const PetscInt line = c->order[p->first + k];

    if (c->curved) {
      ++*m;
      PetscCall(PetscArraycpy(x + 3 * *m, c->middle + 3 * line, 3));
    }
    v = other(c, line, v);
    ++*m;
    PetscCall(PetscArraycpy(x + 3 * *m, c->vertex + 3 * (v), 3));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where a piece ends. */
static PetscInt last_vertex(const Chain *c, const Piece *p)
{
  PetscInt v = p->start;

  for (PetscInt k = 0; k < p->n; k++) v = other(c, c->order[p->first + k], v);
  return v;
}

/* Corners, and cuts of closed loops into three, become ends of pieces. */
static PetscErrorCode add_ends(Chain *c, AncfBeamSpec *spec, PetscReal *x)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < c->npieces; i++) {
    const Piece *p = &c->piece[i];
    PetscInt v = p->start, m, cuts = 0;
    PetscBool simple = PETSC_FALSE, sharp = PETSC_FALSE, round = (PetscBool)(last_vertex(c, p) == v);
    PetscReal angle = 0;

    PetscCall(points(c, p, &m, x));
    if (!round) PetscCall(AppCurveSimple(m, x, NULL, NULL, p->n, spec, &simple));
    for (PetscInt k = 0; k < p->n; k++) {
      const PetscInt line = c->order[p->first + k], before = c->order[p->first + (k ? k - 1 : p->n - 1)];

      if (k || p->closed) PetscCall(is_sharp(c, v, before, line, &angle, &sharp));
      sharp = (PetscBool)(sharp && !(simple && angle <= CORNER_ANGLE));
      if ((k || p->closed) && sharp) c->ends[v] = PETSC_TRUE, cuts++;
      v = other(c, line, v);
    }
    v = p->start;
    for (PetscInt k = 0; k < p->n && round && cuts < 2; k++) {
      if ((k == 0 && p->closed) || k == p->n / 3 || k == 2 * p->n / 3) c->ends[v] = PETSC_TRUE;
      v = other(c, c->order[p->first + k], v);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The tangent that a piece has at one end in common with the piece that goes on smoothly there. has: whether there is one. */
static PetscErrorCode shared_tangent(const Chain *c, PetscInt vertex, PetscInt line, PetscBool leaves, PetscReal t[3],
                                     PetscBool *has)
{
  PetscInt mate = -1;
  PetscReal best = PETSC_MAX_REAL, a[3], b[3], x[3];

  PetscFunctionBegin;
  for (PetscInt i = c->first[vertex]; i < c->first[vertex + 1]; i++)
    for (PetscInt j = c->first[vertex]; j < i; j++) {
      PetscReal angle;
      PetscBool sharp = PETSC_FALSE;

      PetscCall(is_sharp(c, vertex, c->at[i], c->at[j], &angle, &sharp));
      if (sharp || angle >= best) continue;
      best = angle;
      mate = c->at[i] == line ? c->at[j] : c->at[j] == line ? c->at[i] : -1;
    }
  *has = (PetscBool)(mate >= 0 && best <= CORNER_ANGLE);
  if (!*has) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscArraycpy(x, c->vertex + 3 * (vertex), 3));
  PetscCall(next_point(c, leaves ? mate : line, vertex, a));
  PetscCall(next_point(c, leaves ? line : mate, vertex, b));
  AppCurveTangent(a, x, b, t);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The beam of one piece. */
static PetscErrorCode make_beam(const Chain *c, const Piece *p, PetscReal *x, SceneBeam *beam)
{
  const PetscInt end = last_vertex(c, p);
  PetscReal t[2][3], off = 0;
  PetscBool has[2], simple;
  PetscInt m;

  PetscFunctionBegin;
  PetscCall(points(c, p, &m, x));
  PetscCall(shared_tangent(c, p->start, c->order[p->first], PETSC_TRUE, t[0], &has[0]));
  PetscCall(shared_tangent(c, end, c->order[p->first + p->n - 1], PETSC_FALSE, t[1], &has[1]));
  PetscCall(AppCurveSimple(m, x, has[0] ? t[0] : NULL, has[1] ? t[1] : NULL, p->n, &beam->spec, &simple));
  if (!simple)
    PetscCall(AppCurveGeneral(m, x, has[0] ? t[0] : NULL, has[1] ? t[1] : NULL, p->n, &beam->spec, &beam->curve, &off));
  CHAIN_CHECK(
      c, off <= 1e-6,
      "beam '%s': the lines of the physical group '%s' of '%s' from (%g, %g, %g) to (%g, %g, %g) m are curved and lie off a "
      "plane by %g of their length; without twist, a curved beam lies and moves in one plane",
      c->beam, c->group, c->file, (double)x[0], (double)x[1], (double)x[2], (double)x[3 * m], (double)x[3 * m + 1],
      (double)x[3 * m + 2], (double)off);
  if (degree(c, p->start) != 1) beam->spec.end0 = ANCF_END_FREE;
  if (degree(c, end) != 1) beam->spec.end1 = ANCF_END_FREE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A rigid joint at each vertex where pieces meet. */
static PetscErrorCode make_joints(const Chain *c, AppPieces *out)
{
  PetscFunctionBegin;
  PetscCall(PetscCalloc1(c->nv, &out->joint));
  for (PetscInt v = 0; v < c->nv; v++) {
    SceneLink *l = &out->joint[out->njoints];
    PetscInt n = 0;

    if (!c->ends[v] || degree(c, v) < 2) continue;
    PetscCall(PetscMalloc2(degree(c, v), &l->beam, degree(c, v), &l->node));
    for (PetscInt i = 0; i < c->npieces; i++)
      for (int end = 0; end < 2; end++) {
        if ((end ? last_vertex(c, &c->piece[i]) : c->piece[i].start) != v) continue;
        l->beam[n] = i;
        l->node[n++] = end ? c->piece[i].n : 0;
      }
    l->n = n;
    l->type = 1;
    out->njoints++;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Names and places of all pieces; no name of digits alone, which PETSc leaves out when it looks for an option. */
static PetscErrorCode make_pieces(const Chain *c, const SceneBeam *beam, PetscReal *x, AppPieces *out)
{
  PetscFunctionBegin;
  PetscCall(PetscCalloc1(c->npieces, &out->beam));
  for (out->n = 0; out->n < c->npieces; out->n++) {
    SceneBeam *b = &out->beam[out->n];

    *b = *beam;
    PetscCall(make_beam(c, &c->piece[out->n], x, b));
    if (c->npieces == 1) continue;
    PetscCall(PetscSNPrintf(b->name, sizeof(b->name), "%s_p%" PetscInt_FMT, beam->name, out->n));
    PetscCall(AppNameCheck("beams", b->name));
  }
  PetscCall(make_joints(c, out));
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

/* The beams of a group of lines, more than one if it branches, has corners or is closed, and the joints between them. */
PetscErrorCode AppMeshBeam(AppMesh *mesh, SceneBeam *beam, AppPieces *out)
{
  Chain c = {.beam = beam->name, .file = beam->mesh, .group = beam->group[0] ? beam->group : beam->name};
  AncfBeamSpec scratch = beam->spec;
  PetscReal *x;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(out, sizeof(*out)));
  PetscCall(AppFindFile(mesh->scene, beam->mesh));
  if (!mesh->dm || strcmp(mesh->file, beam->mesh)) {
    PetscCall(AppMeshDestroy(mesh));
    PetscCall(load(beam->name, beam->mesh, &mesh->dm));
    PetscCall(PetscStrncpy(mesh->file, beam->mesh, sizeof(mesh->file)));
  }
  c.dm = mesh->dm;
  PetscCall(find_lines(&c));
  PetscCall(read_places(&c));
  PetscCall(meet(&c));
  PetscCall(check_lines(&c));
  PetscCall(check_connected(&c));
  PetscCall(check_folds(&c));
  PetscCall(PetscMalloc3(c.n, &c.order, c.n, &c.piece, 3 * (2 * (size_t)c.n + 1), &x));
  PetscCall(cut(&c));
  PetscCall(add_ends(&c, &scratch, x));
  PetscCall(cut(&c));
  PetscCall(make_pieces(&c, beam, x, out));
  PetscCall(PetscFree3(c.order, c.piece, x));
  PetscCall(PetscFree2(c.edge, c.line));
  PetscCall(PetscFree2(c.vertex, c.middle));
  PetscCall(PetscFree3(c.first, c.at, c.ends));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppMeshDestroy(AppMesh *mesh)
{
  PetscFunctionBegin;
  PetscCall(DMDestroy(&mesh->dm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
