/*
  rigidstl.c - STL files, text and binary. Text: "solid", then facets of three "vertex x y z" lines. Binary: 80 bytes, a
  32-bit count, then 50 bytes a facet (normal, three corners as 32-bit floats, 16 unused bits), little-endian.
  Normals in the file are not used: the order of the corners tells the outside.
*/
#include "rigidgeometry.h"
#include <stdint.h>
#include <stdio.h>
#include <string.h>

/* Host-independent little-endian reads. */
static uint32_t Word(const unsigned char *p)
{
  return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

static PetscReal Float(const unsigned char *p)
{
  const uint32_t w = Word(p);
  float f;
  memcpy(&f, &w, sizeof(f));
  return (PetscReal)f;
}

/* The file as it is and a 0 behind it; kind: STL or OBJ, for messages. */
PetscErrorCode RigidMeshReadFile(MPI_Comm comm, const char kind[], const char filename[], size_t *size, char **data)
{
  FILE *fp = fopen(filename, "rb");
  long n = 0;

  PetscFunctionBegin;
  PetscCheck(fp, comm, PETSC_ERR_FILE_OPEN, "%s file %s: cannot be opened", kind, filename);
  if (fseek(fp, 0, SEEK_END) == 0) n = ftell(fp);
  if (n <= 0 || fseek(fp, 0, SEEK_SET) != 0) {
    fclose(fp);
    SETERRQ(comm, PETSC_ERR_FILE_READ, "%s file %s: is empty or cannot be read", kind, filename);
  }
  PetscCall(PetscMalloc1((size_t)n + 1, data));
  *size = fread(*data, 1, (size_t)n, fp);
  fclose(fp);
  (*data)[*size] = 0;
  PetscCheck(*size == (size_t)n, comm, PETSC_ERR_FILE_READ, "%s file %s: cannot be read to its end", kind, filename);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Coordinates to metres, in place. */
PetscErrorCode RigidMeshScale(MPI_Comm comm, const char kind[], const char filename[], PetscReal scale, PetscInt nf,
                              PetscReal corners[])
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < 9 * nf; i++) {
    corners[i] *= scale;
    PetscCheck(!PetscIsInfOrNanReal(corners[i]), comm, PETSC_ERR_FILE_UNEXPECTED,
               "%s file %s: facet %" PetscInt_FMT " has a coordinate that is not finite", kind, filename, i / 9);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadBinary(MPI_Comm comm, const char filename[], size_t size, const char *data, PetscInt *nf,
                                 PetscReal **corners)
{
  const unsigned char *p = (const unsigned char *)data + 84;
  const size_t n = Word((const unsigned char *)data + 80);

  PetscFunctionBegin;
  PetscCheck(n > 0 && n < (size_t)(PETSC_MAX_INT / 9), comm, PETSC_ERR_FILE_UNEXPECTED,
             "STL file %s: holds %g facets; must be 1 ... %" PetscInt_FMT, filename, (double)n, (PetscInt)(PETSC_MAX_INT / 9));
  PetscCheck(size >= 84 + 50 * n, comm, PETSC_ERR_FILE_UNEXPECTED, "STL file %s: ends after %g bytes, its %g facets need %g",
             filename, (double)size, (double)n, (double)(84 + 50 * n));
  PetscCall(PetscMalloc1(9 * n, corners));
  for (size_t i = 0; i < n; i++, p += 50)
    for (size_t k = 0; k < 9; k++) (*corners)[9 * i + k] = Float(p + 12 + 4 * k);
  *nf = (PetscInt)n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadText(MPI_Comm comm, const char filename[], char *data, PetscInt *nf, PetscReal **corners)
{
  size_t n = 0, alloc = 0;
  PetscInt line = 0;

  PetscFunctionBegin;
  for (char *at = data, *next; at && *at; at = next) {
    double x[3];
    char rest;
    next = strchr(at, '\n');
    if (next) *next++ = 0;
    line++;
    at += strspn(at, " \t\r");
    if (strncmp(at, "vertex", 6)) continue;
    PetscCheck(sscanf(at + 6, "%lf %lf %lf %c", &x[0], &x[1], &x[2], &rest) == 3, comm, PETSC_ERR_FILE_UNEXPECTED,
               "STL file %s, line %" PetscInt_FMT ": \"%.40s\" is not a vertex with three numbers", filename, line, at);
    if (n + 3 > alloc) {
      alloc = 2 * alloc + 900;
      PetscCall(PetscRealloc(sizeof(PetscReal) * alloc, corners));
    }
    for (int k = 0; k < 3; k++) (*corners)[n++] = (PetscReal)x[k];
  }
  PetscCheck(n > 0 && n % 9 == 0, comm, PETSC_ERR_FILE_UNEXPECTED,
             "STL file %s: holds %g vertices; must be three for each facet, one facet at least", filename, (double)n / 3);
  *nf = (PetscInt)(n / 9);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* corners: nf x 3 x 3, PetscMalloc'ed. A file is text if it starts with "solid" and its size does not fit its binary count. */
PetscErrorCode RigidMeshReadSTL(MPI_Comm comm, const char filename[], PetscReal scale, PetscInt *nf, PetscReal **corners)
{
  char *data = NULL;
  size_t size = 0;
  PetscBool binary;

  PetscFunctionBegin;
  PetscCheck(scale > 0. && !PetscIsInfOrNanReal(scale), comm, PETSC_ERR_ARG_OUTOFRANGE, "STL file %s: scale = %g; must be > 0",
             filename, (double)scale);
  *corners = NULL;
  PetscCall(RigidMeshReadFile(comm, "STL", filename, &size, &data));
  binary = (PetscBool)(size >= 84 && (84 + 50 * (size_t)Word((unsigned char *)data + 80) == size || strncmp(data, "solid", 5)));
  if (binary)
    PetscCall(ReadBinary(comm, filename, size, data, nf, corners));
  else
    PetscCall(ReadText(comm, filename, data, nf, corners));
  PetscCall(PetscFree(data));
  PetscCall(RigidMeshScale(comm, "STL", filename, scale, *nf, *corners));
  PetscFunctionReturn(PETSC_SUCCESS);
}
