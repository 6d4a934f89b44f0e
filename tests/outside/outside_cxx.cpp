// outside_cxx.cpp - the headers are C++ too.
#include <frond/couple.h>
#include <frond/sphfill.h>

int main(int argc, char **argv)
{
  Couple couple = nullptr;
  if (PetscInitialize(&argc, &argv, nullptr, nullptr)) return 1;
  if (CoupleCreate(PETSC_COMM_SELF, &couple) || CoupleDestroy(&couple)) return 1;
  return PetscFinalize() ? 1 : 0;
}
