/* fuzz_scene.c - a scene file: YAML to options, options to the scene. */
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  PetscOptions options;
  AppScene scene;

  fuzz_write(data, size);
  if (PetscOptionsCreate(&options) || PetscOptionsPush(options)) abort();
  if (!AppOptionsInsertFile(fuzz_file) && !AppSceneRead(&scene, "scene")) AppSceneDestroy(&scene);
  if (PetscOptionsPop() || PetscOptionsDestroy(&options)) abort();
  fuzz_free_all();
  return 0;
}
