/* fuzz_mesh.c - an STL file, text or binary, or an OBJ file: read, welded, checked; a mesh that is taken has a volume. */
#define FUZZ_STREAM
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  RigidGeometry mesh = NULL;
  PetscReal volume, center[3], q[4];

  fuzz_write(data, size);
  if (!(size > 1 && (data[0] == 'v' || data[0] == 'f' || data[0] == '#') ? RigidGeometryCreateOBJ : RigidGeometryCreateSTL)(
          PETSC_COMM_SELF, fuzz_file, 1., &mesh)) {
    if (RigidGeometryGetPlacement(mesh, &volume, center, q)) abort();
    if (!(volume > 0)) abort();
    RigidGeometryDestroy(&mesh);
  }
  fuzz_free_all();
  return 0;
}
