/* h5write.c - HDF5 files whose datasets carry `unit` and `description`; any failure is PETSC_ERR_FILE_WRITE. */
#include "app.h"
#include <errno.h>
#include <hdf5.h>
#include <string.h>

_Static_assert(sizeof(hid_t) == sizeof(int64_t), "HDF5 1.10 or newer is needed");

#define H5Check(ok, what, name)                                                                                                  \
  PetscCheck(ok, PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "cannot write %s '%s' (HDF5): %s", what, name,                           \
             errno ? strerror(errno) : "is the disk full?")

PetscErrorCode AppH5Create(const char file[], int64_t *id)
{
  PetscFunctionBegin;
  H5Check(H5Eset_auto2(H5E_DEFAULT, NULL, NULL) >= 0, "file", file); /* errors are reported by our own line */
  errno = 0;
  *id = H5Fcreate(file, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  H5Check(*id >= 0, "file", file);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Flush and close. */
PetscErrorCode AppH5Close(int64_t id, const char file[])
{
  herr_t flushed, closed;

  PetscFunctionBegin;
  errno = 0;
  flushed = H5Fflush(id, H5F_SCOPE_GLOBAL);
  closed = H5Fclose(id);
  H5Check(flushed >= 0 && closed >= 0, "file", file);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppH5Group(int64_t loc, const char name[], int64_t *group)
{
  PetscFunctionBegin;
  *group = H5Gcreate2(loc, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  H5Check(*group >= 0, "group", name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppH5GroupClose(int64_t group)
{
  PetscFunctionBegin;
  H5Check(H5Gclose(group) >= 0, "group", "close");
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode attribute(int64_t loc, const char name[], hid_t type, const void *value)
{
  hid_t space = H5Screate(H5S_SCALAR), attr = H5Acreate2(loc, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
  herr_t err = attr >= 0 ? H5Awrite(attr, type, value) : -1;

  PetscFunctionBegin;
  if (attr >= 0) H5Aclose(attr);
  H5Sclose(space);
  H5Check(err >= 0, "attribute", name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppH5AttrReal(int64_t loc, const char name[], PetscReal value)
{
  double x = (double)value;

  PetscFunctionBegin;
  PetscCall(attribute(loc, name, H5T_NATIVE_DOUBLE, &x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppH5AttrInt(int64_t loc, const char name[], PetscInt value)
{
  int64_t x = (int64_t)value;

  PetscFunctionBegin;
  PetscCall(attribute(loc, name, H5T_NATIVE_INT64, &x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppH5AttrString(int64_t loc, const char name[], const char value[])
{
  hid_t type = H5Tcopy(H5T_C_S1);
  PetscErrorCode ierr;

  PetscFunctionBegin;
  H5Tset_size(type, strlen(value) + 1);
  ierr = attribute(loc, name, type, value);
  H5Tclose(type);
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* An array of any shape, of memtype, stored as filetype. */
static PetscErrorCode dataset_shape(int64_t loc, const H5Label *label, hid_t filetype, hid_t memtype, int rank,
                                    const hsize_t dims[], const void *data)
{
  hid_t space = H5Screate_simple(rank, dims, NULL);
  hid_t set = H5Dcreate2(loc, label->name, filetype, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  herr_t err = set >= 0 ? (dims[0] ? H5Dwrite(set, memtype, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) : 0) : -1;

  PetscFunctionBegin;
  H5Sclose(space);
  H5Check(err >= 0, "dataset", label->name);
  PetscCall(AppH5AttrString(set, "unit", label->unit));
  PetscCall(AppH5AttrString(set, "description", label->description));
  H5Check(H5Dclose(set) >= 0, "dataset", label->name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* rows x cols (cols 0: a plain list). */
static PetscErrorCode dataset(int64_t loc, const H5Label *label, hid_t filetype, hid_t memtype, PetscInt rows, PetscInt cols,
                              const void *data)
{
  const hsize_t dims[2] = {(hsize_t)rows, (hsize_t)cols};

  PetscFunctionBegin;
  PetscCall(dataset_shape(loc, label, filetype, memtype, cols ? 2 : 1, dims, data));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppH5Real(int64_t loc, const H5Label *label, PetscBool single, PetscInt rows, PetscInt cols, const PetscReal *data)
{
  PetscFunctionBegin;
  PetscCall(dataset(loc, label, single ? H5T_IEEE_F32LE : H5T_IEEE_F64LE,
                    sizeof(PetscReal) == sizeof(double) ? H5T_NATIVE_DOUBLE : H5T_NATIVE_FLOAT, rows, cols, data));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Values on points[0] x points[1] x points[2] points, x fastest, of cols components each; stored in single precision. */
PetscErrorCode AppH5Grid(int64_t loc, const H5Label *label, const PetscInt points[3], PetscInt cols, const PetscReal *data)
{
  const hsize_t dims[4] = {(hsize_t)points[2], (hsize_t)points[1], (hsize_t)points[0], (hsize_t)cols};

  PetscFunctionBegin;
  PetscCall(dataset_shape(loc, label, H5T_IEEE_F32LE, sizeof(PetscReal) == sizeof(double) ? H5T_NATIVE_DOUBLE : H5T_NATIVE_FLOAT,
                          cols > 1 ? 4 : 3, dims, data));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppH5Int(int64_t loc, const H5Label *label, PetscInt rows, PetscInt cols, const PetscInt *data)
{
  PetscFunctionBegin;
  PetscCall(dataset(loc, label, H5T_STD_I32LE, sizeof(PetscInt) == 8 ? H5T_NATIVE_INT64 : H5T_NATIVE_INT32, rows, cols, data));
  PetscFunctionReturn(PETSC_SUCCESS);
}
