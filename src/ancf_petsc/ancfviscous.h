/*
  ancfviscous.h - private: internal (Kelvin-Voigt) damping of one ANCF cable element, in lanes.

  N = EA (eps + tau_a deps/dt), M = EI (kappa + tau_b kappa*). The rate kappa* of the curvature vector is that seen in a frame
  that turns with the section: with the tangent t = r'/|r'|, and about it with the spin s t,

    kappa* = dkappa/dt - (t x dt/dt + s t) x kappa,       s = omega . t.

  A cable has no frame of its own, so that omega is a vector of the whole beam (AncfElementSpin()): zero where a clamp
  holds the sections, otherwise the one that dissipates least. A rigid motion then dissipates nothing, and the force is the
  derivative of half the dissipated power by the velocities.
*/
#ifndef ANCFVISCOUS_H
#define ANCFVISCOUS_H

#include "ancfelement.h"

typedef struct {
  AncfLanes EA, EI, l; /* EA tau_a, N s; EI tau_b, N m^2 s; m */
} AncfViscosity;

/* Adds the damping force to Q, and to *power (may be NULL) the dissipated power, W; v: velocities of e; spin: omega, 1/s. */
extern void AncfElementViscous(const AncfRule *rule, const AncfViscosity *s, const AncfLanes e[12], const AncfLanes v[12],
                               const AncfLanes spin[3], AncfLanes Q[12], AncfLanes *power);
/* Adds ge dQ/de + gv dQ/dv at fixed spin to the 9 x 9 tangent H by scaled coordinates (see AncfScaledExpand()). */
extern void AncfElementViscousTangent(const AncfRule *rule, const AncfViscosity *s, const AncfLanes e[12], const AncfLanes v[12],
                                      const AncfLanes spin[3], PetscReal ge, PetscReal gv, AncfLanes H[81]);
/* Least dissipation A omega = b; A symmetric (xx xy xz yy yz zz), sums over the element of one lane each. */
extern void AncfElementSpin(const AncfRule *rule, const AncfViscosity *s, const AncfLanes e[12], const AncfLanes v[12],
                            AncfLanes A[6], AncfLanes b[3]);

/* Adds one lane of H to the 12 x 12 row-major k, or the symmetric part of H to a packed tangent. */
extern void AncfScaledExpand(const AncfLanes H[81], AncfLanes l, PetscInt lane, PetscReal k[144]);
extern void AncfScaledPack(const AncfLanes H[81], AncfLanes l, AncfLanes K[ANCF_TANGENT]);

#endif
