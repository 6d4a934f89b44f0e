/* shortrange.c - the formulas of shortrange.h. */
#include "shortrange.h"
#include <math.h>

/* No lubrication, no contact. */
PetscErrorCode ShortRangeInit(ShortRange *p)
{
  PetscFunctionBegin;
  PetscCall(PetscMemzero(p, sizeof(*p)));
  p->restitution = 1.;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ShortRangeCheck(MPI_Comm comm, const ShortRange *p)
{
  PetscFunctionBegin;
  PetscCheck(p->viscosity >= 0. && !PetscIsInfOrNanReal(p->viscosity), comm, PETSC_ERR_ARG_OUTOFRANGE,
             "-rigid_lubrication_viscosity %g Pa s: must be >= 0", (double)p->viscosity);
  PetscCheck(p->modulus >= 0. && !PetscIsInfOrNanReal(p->modulus), comm, PETSC_ERR_ARG_OUTOFRANGE,
             "-rigid_contact_modulus %g Pa: must be >= 0", (double)p->modulus);
  if (p->viscosity == 0. && p->modulus == 0.) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(p->roughness > 0. && !PetscIsInfOrNanReal(p->roughness), comm, PETSC_ERR_ARG_OUTOFRANGE,
             "-rigid_roughness %g m: must be > 0", (double)p->roughness);
  PetscCheck(p->viscosity == 0. || (p->cutoff > p->roughness && !PetscIsInfOrNanReal(p->cutoff)), comm, PETSC_ERR_ARG_OUTOFRANGE,
             "-rigid_lubrication_cutoff %g m: must be > -rigid_roughness = %g m", (double)p->cutoff, (double)p->roughness);
  PetscCheck(p->restitution > 0. && p->restitution <= 1., comm, PETSC_ERR_ARG_OUTOFRANGE,
             "-rigid_contact_restitution %g: must be > 0 and <= 1", (double)p->restitution);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ShortRangeSetFromOptions(MPI_Comm comm, const char prefix[], ShortRange *p, PetscReal *spacing)
{
  PetscFunctionBegin;
  PetscOptionsBegin(comm, prefix, "Short-range forces", "Rigid");
  PetscCall(PetscOptionsReal("-rigid_lubrication_viscosity", "Viscosity for lubrication between bodies, Pa s (0: none)",
                             "RigidSetShortRange", p->viscosity, &p->viscosity, NULL));
  PetscCall(PetscOptionsReal("-rigid_lubrication_cutoff", "Gap Dc beyond which lubrication is left to the fluid, m",
                             "RigidSetShortRange", p->cutoff, &p->cutoff, NULL));
  PetscCall(PetscOptionsBool("-rigid_lubrication_kink", "Factor 1/s - 1/Dc as printed in Eqs. 31, 32 (default: smooth at Dc)",
                             "RigidSetShortRange", p->kink, &p->kink, NULL));
  PetscCall(PetscOptionsReal("-rigid_roughness", "Gap at which surfaces touch and lubrication is capped, m", "RigidSetShortRange",
                             p->roughness, &p->roughness, NULL));
  PetscCall(PetscOptionsReal("-rigid_contact_modulus", "Reduced Young's modulus of Hertz contact, Pa (0: no contact)",
                             "RigidSetShortRange", p->modulus, &p->modulus, NULL));
  PetscCall(PetscOptionsReal("-rigid_contact_restitution", "Coefficient of restitution of contact", "RigidSetShortRange",
                             p->restitution, &p->restitution, NULL));
  PetscCall(PetscOptionsReal("-rigid_shortrange_spacing", "Distance of surface markers of bodies that are no spheres, m",
                             "RigidSetShortRangeSpacing", *spacing, spacing, NULL));
  PetscOptionsEnd();
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* 1/m: the factor of Eqs. 31 and 32. */
static PetscReal GapFactor(const ShortRange *p, PetscReal s)
{
  const PetscReal g = PetscMax(s, p->roughness), d = p->cutoff;
  if (p->viscosity == 0. || s >= d) return 0.;
  return p->kink ? 1. / g - 1. / d : (d - g) * (d - g) / (g * d * d);
}

PetscReal ShortRangeSphere(const ShortRange *p, PetscReal ai, PetscReal aj, PetscReal s)
{
  const PetscReal a = 1. / (1. / ai + 1. / aj);
  return 6. * PETSC_PI * p->viscosity * a * a * GapFactor(p, s);
}

PetscReal ShortRangeMarkers(const ShortRange *p, PetscReal h, PetscReal s)
{
  return 1.5 * PETSC_PI * p->viscosity * h * h * GapFactor(p, s);
}

PetscReal ShortRangeLine(const ShortRange *p, PetscReal R, PetscReal s)
{
  const PetscReal g = PetscMax(s, p->roughness), d = p->cutoff;
  PetscReal factor;
  if (p->viscosity == 0. || s >= d) return 0.;
  factor = 1. / (g * PetscSqrtReal(g)) - 1. / (d * PetscSqrtReal(d));
  if (!p->kink) factor -= 1.5 * (d - g) / (d * d * PetscSqrtReal(d));
  return 3. * PetscSqrtReal(2.) * PETSC_PI * p->viscosity * R * PetscSqrtReal(R) * factor;
}

/* Damping ratio of the linear spring with restitution e: -ln e/sqrt(ln^2 e + pi^2). */
void ShortRangeLineContact(const ShortRange *p, PetscReal m, PetscReal s, PetscReal *stiffness, PetscReal *damping)
{
  const PetscReal d = p->roughness - s, l = PetscLogReal(p->restitution), x = PetscMin(1., 10. * d / p->roughness);
  *stiffness = *damping = 0.;
  if (p->modulus == 0. || d <= 0.) return;
  *stiffness = .5 * p->modulus;
  *damping = x * x * (3. - 2. * x) * -2. * l / PetscSqrtReal(l * l + PETSC_PI * PETSC_PI) * PetscSqrtReal(m * *stiffness);
}

PetscReal ShortRangeContact(const ShortRange *p, PetscReal R, PetscReal m, PetscReal s, PetscReal dsdt)
{
  const PetscReal d = p->roughness - s, k = 4. / 3. * p->modulus * PetscSqrtReal(R), l = PetscLogReal(p->restitution);
  const PetscReal alpha = -PetscSqrtReal(5.) * l / PetscSqrtReal(l * l + PETSC_PI * PETSC_PI);
  if (p->modulus == 0. || d <= 0.) return 0.;
  return k * d * PetscSqrtReal(d) - alpha * PetscSqrtReal(m * k * PetscSqrtReal(d)) * dsdt;
}

PetscReal ShortRangeContactEnergy(const ShortRange *p, PetscReal R, PetscReal s)
{
  const PetscReal d = p->roughness - s;
  return p->modulus == 0. || d <= 0. ? 0. : .4 * 4. / 3. * p->modulus * PetscSqrtReal(R) * d * d * PetscSqrtReal(d);
}

/* m v^2/2 = (2/5) k d^(5/2). */
PetscReal ShortRangeOverlap(const ShortRange *p, PetscReal R, PetscReal m, PetscReal v)
{
  const PetscReal k = 4. / 3. * p->modulus * PetscSqrtReal(R);
  return PetscPowReal(1.25 * m * v * v / k, .4);
}

/* 2 d/v int_0^1 dx/sqrt(1 - x^(5/2)), d the largest overlap; the integral is sqrt(pi) Gamma(7/5)/Gamma(9/10). */
PetscReal ShortRangeContactTime(const ShortRange *p, PetscReal R, PetscReal m, PetscReal v)
{
  return 2. * ShortRangeOverlap(p, R, m, v) / v * PetscSqrtReal(PETSC_PI) * tgamma(1.4) / tgamma(.9);
}

PetscReal ShortRangeCriticalStokes(const ShortRange *p)
{
  const PetscReal x = p->roughness / p->cutoff;
  return p->kink ? -PetscLogReal(x) - 1. + x : -PetscLogReal(x) - 2. * (1. - x) + .5 * (1. - x * x);
}
