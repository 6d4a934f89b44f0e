/*
  shortrange.h - short-range forces between solids: lubrication (Pazouki, Serban, Negrut, Eqs. 31 and 32) and Hertz contact. Pure
  functions of a gap, public so that couplings of other bodies (beams) use the same ones.

  Lubrication is a resistance gamma (N s/m) to the normal relative velocity, F = -gamma v_n. The factor 1/s - 1/Dc of Eqs. 31
  and 32 has a kink at s = Dc; by default (Dc - s)^2/(s Dc^2) = 1/s - 1/Dc - (Dc - s)/Dc^2 takes its place: the same singular
  part, value and slope 0 at the cutoff. Gaps below the roughness s_min of the surfaces count as s_min.

  Contact begins at a gap of s_min, where asperities meet, so that smooth surfaces never overlap: overlap d = s_min - s,
  F = k d^(3/2) + alpha sqrt(m k) d^(1/4) dd/dt,  k = 4/3 E* sqrt(R),  alpha = -sqrt(5) ln e/sqrt(ln^2 e + pi^2),
  the law whose coefficient of restitution is e at any speed (Tsuji et al., Powder Technol. 71, 1992; Antypov and Elliott, EPL 94,
  2011).

  With both, a sphere meets a wall at the speed v0 (1 - St_c/St), St = m v0/(6 pi mu a^2) = (2/9)(rho_s/rho) Re_p (Sect. 2.5), and
  does not rebound at St near St_c or below, see ShortRangeCriticalStokes().
*/
#ifndef SHORTRANGE_H
#define SHORTRANGE_H

#include "frondsys.h"

/* Parameters of the short-range forces; ShortRangeInit() gives the defaults. */
typedef struct {
  PetscReal viscosity;   /* mu, Pa s; 0: no lubrication */
  PetscReal cutoff;      /* Dc, m, > roughness */
  PetscReal roughness;   /* s_min, m, > 0 */
  PetscReal modulus;     /* E* = 1/((1 - nu_i^2)/E_i + (1 - nu_j^2)/E_j), Pa; 0: no contact */
  PetscReal restitution; /* e, 0 < e <= 1 */
  PetscBool kink;        /* the factor 1/s - 1/Dc as printed in Eqs. 31, 32 */
} ShortRange;

/* No lubrication, no contact. p: to be filled. */
FROND_EXTERN PetscErrorCode ShortRangeInit(ShortRange *p);
/* Read -rigid_lubrication_..., -rigid_roughness, -rigid_contact_... and -rigid_shortrange_spacing, which rigid bodies and beams
   share. comm: of the options. prefix: of the options, or NULL. p: parameters to change. spacing: of surface markers, m. */
FROND_EXTERN PetscErrorCode ShortRangeSetFromOptions(MPI_Comm comm, const char prefix[], ShortRange *p, PetscReal *spacing);
/* Refuse parameters out of range, naming the one. comm: communicator of the errors. p: parameters. */
FROND_EXTERN PetscErrorCode ShortRangeCheck(MPI_Comm comm, const ShortRange *p);
/*
  Resistance gamma (N s/m) between two spheres, or a sphere and a wall. p: parameters. ai: radius, m. aj: radius, m;
  PETSC_INFINITY for a plane wall. s: gap, m. Source: the paper, Eq. 31.
*/
FROND_EXTERN PetscReal ShortRangeSphere(const ShortRange *p, PetscReal ai, PetscReal aj, PetscReal s);
/*
  Resistance gamma (N s/m) of one pair of surface markers. p: parameters. h: size of a marker, m. s: their distance s*, m.
  Source: the paper, Eq. 32.
*/
FROND_EXTERN PetscReal ShortRangeMarkers(const ShortRange *p, PetscReal h, PetscReal s);
/*
  Resistance per length (N s/m^2) of a cylinder facing another one or a plane, the leading term 3 sqrt(2) pi mu (R/s)^(3/2) of
  Jeffrey and Onishi, smoothed at the cutoff like the others. Summed along the axis of one of two cylinders crossing at an angle
  phi, s the gap to the other, it gives 12 pi mu R^(3/2) sqrt(ai + aj)/(s sin phi), the
  solution of Reynolds' equation to leading order, at every angle. p: parameters.
  R: 1/(1/ai + 1/aj), m. s: gap, m. Source: Jeffrey, Onishi, Quart. J. Mech. Appl. Math. 34 (1981).
*/
FROND_EXTERN PetscReal ShortRangeLine(const ShortRange *p, PetscReal R, PetscReal s);
/*
  Repulsion per length of a cylinder, f = stiffness d - damping ds/dt (N/m), d = s_min - s: half of E* as stiffness makes the sum
  over two equal cylinders that cross at right angles Hertz's 4/3 E* sqrt(a) d^(3/2). The damping sets in over a tenth of s_min;
  the restitution is that of bodies that meet lengthwise. p: parameters. m: reduced mass per length, kg/m. s: gap, m. stiffness:
  N/m^2. damping: N s/m^2; both 0 without contact.
*/
FROND_EXTERN void ShortRangeLineContact(const ShortRange *p, PetscReal m, PetscReal s, PetscReal *stiffness, PetscReal *damping);
/*
  Repulsion (N), 0 or more. p: parameters. R: 1/(1/ai + 1/aj), m. m: reduced mass, kg. s: gap, m. dsdt: its rate, m/s. Source:
  Tsuji et al. (1992); Antypov and Elliott (2011).
*/
FROND_EXTERN PetscReal ShortRangeContact(const ShortRange *p, PetscReal R, PetscReal m, PetscReal s, PetscReal dsdt);
/* Elastic energy (J) of that repulsion, (2/5) k d^(5/2). p: parameters. R: 1/(1/ai + 1/aj), m. s: gap, m. Source: Hertz. */
FROND_EXTERN PetscReal ShortRangeContactEnergy(const ShortRange *p, PetscReal R, PetscReal s);
/*
  Largest overlap (m) of an elastic collision, m v^2/2 = (2/5) k d^(5/2); below the roughness the smooth surfaces never meet.
  p: parameters. R: 1/(1/ai + 1/aj), m. m: reduced mass, kg. v: speed, m/s. Source: Hertz.
*/
FROND_EXTERN PetscReal ShortRangeOverlap(const ShortRange *p, PetscReal R, PetscReal m, PetscReal v);
/*
  Duration (s) of an elastic collision: resolve it by 20 steps or more. p: parameters. R: 1/(1/ai + 1/aj), m. m: reduced mass,
  kg. v: speed, m/s. Source: Hertz.
*/
FROND_EXTERN PetscReal ShortRangeContactTime(const ShortRange *p, PetscReal R, PetscReal m, PetscReal v);
/*
  St_c (-), integral of the factor of Eq. 31 over s_min < s < Dc: the share of St that the approach to contact uses up. p:
  parameters.
*/
FROND_EXTERN PetscReal ShortRangeCriticalStokes(const ShortRange *p);

#endif
