/*
  rigidobj.c - OBJ files (Wavefront): "v x y z" and "f a b c ...". Texture and normal numbers, groups and materials are passed
  over; facets are cut into triangles from their first corner.
*/
#include "rigidgeometry.h"
#include <stdlib.h>
#include <string.h>

typedef struct {
  MPI_Comm comm;
  const char *filename;
  PetscInt line;
  PetscReal *x; /* vertices so far, nv x 3 */
  size_t nx, ax;
  PetscReal *corner; /* nf x 9 */
  size_t nc, ac;
} Obj;

static PetscErrorCode Grow(size_t n, size_t *alloc, PetscReal **a)
{
  PetscFunctionBegin;
  if (n > *alloc) {
    *alloc = 2 * *alloc + 900;
    PetscCall(PetscRealloc(sizeof(PetscReal) * *alloc, a));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadVertex(Obj *o, const char *at)
{
  double x[3];

  PetscFunctionBegin;
  PetscCheck(sscanf(at + 1, "%lf %lf %lf", &x[0], &x[1], &x[2]) == 3, o->comm, PETSC_ERR_FILE_UNEXPECTED,
             "OBJ file %s, line %" PetscInt_FMT ": \"%.40s\" is not a vertex with three numbers", o->filename, o->line, at);
  PetscCall(Grow(o->nx + 3, &o->ax, &o->x));
  for (int k = 0; k < 3; k++) o->x[o->nx++] = (PetscReal)x[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The next vertex number of a facet, from 0; at moves on, to NULL where there is none. */
static PetscErrorCode NextVertex(const Obj *o, const char **at, PetscInt *vertex)
{
  const long n = (long)(o->nx / 3);
  char *end;
  long v;

  PetscFunctionBegin;
  *at += strspn(*at, " \t\r");
  if (!**at) {
    *at = NULL;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  v = strtol(*at, &end, 10);
  PetscCheck(end != *at && v != 0 && v <= n && v >= -n, o->comm, PETSC_ERR_FILE_UNEXPECTED,
             "OBJ file %s, line %" PetscInt_FMT ": a facet names vertex \"%.20s\"; must be 1 ... %ld, those read so far",
             o->filename, o->line, *at, n);
  *vertex = (PetscInt)(v > 0 ? v - 1 : n + v);
  *at = end + strcspn(end, " \t\r");
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadFacet(Obj *o, const char *at)
{
  PetscInt v[3] = {0, 0, 0}, count = 0;

  PetscFunctionBegin;
  for (at++; at; count++) {
    PetscCall(NextVertex(o, &at, &v[count < 2 ? count : 2]));
    if (!at) break;
    if (count < 2) continue;
    PetscCall(Grow(o->nc + 9, &o->ac, &o->corner));
    for (int c = 0; c < 3; c++)
      for (int k = 0; k < 3; k++) o->corner[o->nc++] = o->x[3 * v[c] + k];
    v[1] = v[2];
  }
  PetscCheck(count >= 3, o->comm, PETSC_ERR_FILE_UNEXPECTED,
             "OBJ file %s, line %" PetscInt_FMT ": a facet of %" PetscInt_FMT " corners; must be 3 or more", o->filename, o->line,
             count);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* corners: nf x 3 x 3, PetscMalloc'ed. */
PetscErrorCode RigidMeshReadOBJ(MPI_Comm comm, const char filename[], PetscReal scale, PetscInt *nf, PetscReal **corners)
{
  Obj o = {comm, filename, 0, NULL, 0, 0, NULL, 0, 0};
  char *data = NULL;
  size_t size = 0;

  PetscFunctionBegin;
  PetscCheck(scale > 0. && !PetscIsInfOrNanReal(scale), comm, PETSC_ERR_ARG_OUTOFRANGE, "OBJ file %s: scale = %g; must be > 0",
             filename, (double)scale);
  PetscCall(RigidMeshReadFile(comm, "OBJ", filename, &size, &data));
  PetscCheck(size < (size_t)(PETSC_MAX_INT / 9), comm, PETSC_ERR_FILE_UNEXPECTED,
             "OBJ file %s: has %g bytes; must be fewer than %" PetscInt_FMT, filename, (double)size, PETSC_MAX_INT / 9);
  for (char *at = data, *next; at && *at; at = next) {
    next = strchr(at, '\n');
    if (next) *next++ = 0;
    o.line++;
    at += strspn(at, " \t\r");
    if (at[0] == 'v' && (at[1] == ' ' || at[1] == '\t')) PetscCall(ReadVertex(&o, at));
    if (at[0] == 'f' && (at[1] == ' ' || at[1] == '\t')) PetscCall(ReadFacet(&o, at));
  }
  PetscCheck(o.nc > 0, comm, PETSC_ERR_FILE_UNEXPECTED, "OBJ file %s: holds no facets", filename);
  PetscCall(PetscFree(data));
  PetscCall(PetscFree(o.x));
  *nf = (PetscInt)(o.nc / 9);
  *corners = o.corner;
  PetscCall(RigidMeshScale(comm, "OBJ", filename, scale, *nf, *corners));
  PetscFunctionReturn(PETSC_SUCCESS);
}
