/* ancfsection.c - axial and bending stiffness and mass per length of circular, annular and rectangular sections. */
#include "ancfimpl.h"

/* A = pi/4 (d^2 - i^2), I = pi/64 (d^4 - i^4) */
static void Annulus(PetscReal d, PetscReal i, PetscReal *A, PetscReal *I2)
{
  *A = PETSC_PI / 4 * (d * d - i * i);
  *I2 = *A * (d * d + i * i) / 16;
}

PetscErrorCode AncfBeamSpecSetAnnulus(AncfBeamSpec *spec, PetscReal inner)
{
  PetscReal A, I2;

  PetscFunctionBegin;
  PetscCheck(inner >= 0 && inner < spec->diameter, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "AncfBeamSpecSetAnnulus: inner diameter %g m must be in [0, %g), the outer diameter", (double)inner,
             (double)spec->diameter);
  Annulus(spec->diameter, inner, &A, &I2);
  spec->EA = spec->young * A;
  spec->EI = spec->young * I2;
  spec->rhoA = spec->density * A;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AncfCheckPositive(Ancf ancf, const char field[], PetscReal x, const char unit[])
{
  PetscFunctionBegin;
  PetscCheck(PetscIsNormalReal(x) && x > 0, ancf->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Beam %" PetscInt_FMT ": %s = %g %s must be positive and finite", ancf->nbeams, field, (double)x, unit);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AncfCheckNotNegative(Ancf ancf, const char field[], PetscReal x, const char unit[])
{
  PetscFunctionBegin;
  PetscCheck(x >= 0 && !PetscIsInfOrNanReal(x), ancf->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Beam %" PetscInt_FMT ": %s = %g %s must be finite and not negative", ancf->nbeams, field, (double)x, unit);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* width along the normal, thickness across it; the beam bends about the normal, or the section is a square. */
static PetscErrorCode Rectangle(Ancf ancf, AncfBeamSpec *s, PetscReal *A, PetscReal *I2)
{
  const PetscReal w = s->width, t = s->thickness;
  const PetscBool square = PetscAbsReal(w - t) <= 1e-12 * w ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(AncfCheckPositive(ancf, "width", w, "m"));
  PetscCall(AncfCheckPositive(ancf, "thickness", t, "m"));
  PetscCheck(s->inner == 0, ancf->comm, PETSC_ERR_ARG_INCOMP,
             "Beam %" PetscInt_FMT ": inner = %g m and width = %g m exclude one another: a tube or a rectangle", ancf->nbeams,
             (double)s->inner, (double)w);
  PetscCheck(
      square || s->EI != PETSC_DECIDE || s->normal[0] != 0 || s->normal[1] != 0 || s->normal[2] != 0, ancf->comm, PETSC_ERR_SUP,
      "Beam %" PetscInt_FMT ": width = %g m and thickness = %g m make two bending stiffnesses, a cable element without twist "
      "carries one: give normal, along the width, if all bending is about it, or EI",
      ancf->nbeams, (double)w, (double)t);
  *A = w * t;
  *I2 = w * t * t * t / 12;
  if (s->diameter == 0) s->diameter = PetscSqrtReal(4 * w * t / PETSC_PI);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The section follows from its shape, E and rho_s unless given directly. */
PetscErrorCode AncfBeamSection(Ancf ancf, AncfBeam *beam)
{
  AncfBeamSpec *s = &beam->spec;
  PetscReal A = 0, I2 = 0;

  PetscFunctionBegin;
  if (s->width != 0 || s->thickness != 0) {
    PetscCall(Rectangle(ancf, s, &A, &I2));
    beam->area = A;
  } else {
    PetscCall(AncfCheckPositive(ancf, "diameter", s->diameter, "m"));
    PetscCheck(s->inner >= 0 && s->inner < s->diameter, ancf->comm, PETSC_ERR_ARG_OUTOFRANGE,
               "Beam %" PetscInt_FMT ": inner = %g m must be in [0, %g), the outer diameter", ancf->nbeams, (double)s->inner,
               (double)s->diameter);
    Annulus(s->diameter, s->inner, &A, &I2);
    beam->area = PETSC_PI * s->diameter * s->diameter / 4;
  }
  PetscCall(AncfCheckPositive(ancf, "diameter", s->diameter, "m"));
  if (s->EA == PETSC_DECIDE || s->EI == PETSC_DECIDE) PetscCall(AncfCheckPositive(ancf, "young", s->young, "Pa"));
  if (s->rhoA == PETSC_DECIDE) PetscCall(AncfCheckPositive(ancf, "density", s->density, "kg/m^3"));
  beam->EA = s->EA == PETSC_DECIDE ? s->young * A : s->EA;
  beam->EI = s->EI == PETSC_DECIDE ? s->young * I2 : s->EI;
  beam->rhoA = s->rhoA == PETSC_DECIDE ? s->density * A : s->rhoA;
  PetscCall(AncfCheckPositive(ancf, "EA", beam->EA, "N"));
  PetscCheck(PetscAbsReal(s->pretension) < beam->EA, ancf->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Beam %" PetscInt_FMT ": pretension = %g N must be within +-%g N, EA: the strain of the initial shape stays below 1",
             ancf->nbeams, (double)s->pretension, (double)beam->EA);
  PetscCall(AncfCheckPositive(ancf, "EI", beam->EI, "N m^2"));
  PetscCall(AncfCheckPositive(ancf, "rhoA", beam->rhoA, "kg/m"));
  PetscCall(AncfCheckNotNegative(ancf, "axialdamping", s->axialdamping, "s"));
  PetscCall(AncfCheckNotNegative(ancf, "bendingdamping", s->bendingdamping, "s"));
  PetscFunctionReturn(PETSC_SUCCESS);
}
