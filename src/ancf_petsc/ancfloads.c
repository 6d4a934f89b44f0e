/* ancfloads.c - gravity, permanent loads, moments, and the section forces they cause. */
#include "ancfimpl.h"

static PetscErrorCode CheckNode(Ancf ancf, const char function[], PetscInt beam, PetscInt node, const PetscReal x[3])
{
  PetscFunctionBegin;
  PetscCheck(ancf->setup, ancf->comm, PETSC_ERR_ARG_WRONGSTATE, "%s: call AncfSetUp() first", function);
  PetscCheck(beam >= 0 && beam < ancf->nbeams, ancf->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "%s: beam %" PetscInt_FMT " must be in 0..%" PetscInt_FMT, function, beam, ancf->nbeams - 1);
  PetscCheck(node >= 0 && node <= ancf->beams[beam].spec.elements, ancf->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "%s: node %" PetscInt_FMT " of beam %" PetscInt_FMT " must be in 0..%" PetscInt_FMT, function, node, beam,
             ancf->beams[beam].spec.elements);
  PetscCheck(!PetscIsInfOrNanReal(x[0] + x[1] + x[2]), ancf->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "%s: beam %" PetscInt_FMT ": (%g, %g, %g) must be finite", function, beam, (double)x[0], (double)x[1], (double)x[2]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Element and local coordinate of the fraction s of a beam's length. */
static PetscErrorCode FindElement(Ancf ancf, const char function[], PetscInt beam, PetscReal s, PetscInt *node, PetscReal *xi)
{
  const PetscReal none[3] = {0};
  PetscInt n, k;

  PetscFunctionBegin;
  PetscCall(CheckNode(ancf, function, beam, 0, none));
  PetscCheck(s >= 0 && s <= 1, ancf->comm, PETSC_ERR_ARG_OUTOFRANGE, "%s: beam %" PetscInt_FMT ": s = %g must be in [0, 1]",
             function, beam, (double)s);
  n = ancf->beams[beam].spec.elements;
  k = PetscMin(n - 1, (PetscInt)(s * (PetscReal)n));
  *node = ancf->beams[beam].node + k;
  *xi = s * (PetscReal)n - (PetscReal)k;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Q^g = integral of (rho_s A - rho A_outer) S^T g (Eq. 24 less buoyancy); with the permanent loads it makes the steady ones. */
PetscErrorCode AncfSetUpWeight(Ancf ancf)
{
  PetscFunctionBegin;
  PetscCall(PetscArrayzero(ancf->weight, 6 * ancf->nnodes));
  for (PetscInt b = 0; b < ancf->nbeams; b++) {
    const AncfBeam *beam = &ancf->beams[b];
    PetscReal w[4], q = beam->rhoA - ancf->fluiddensity * beam->area;

    AncfElementLoad(beam->l, w);
    for (PetscInt k = 0; k < beam->spec.elements; k++)
      for (PetscInt i = 0; i < 4; i++)
        for (PetscInt c = 0; c < 3; c++) ancf->weight[6 * (beam->node + k) + 3 * i + c] += w[i] * q * ancf->gravity[c];
  }
  for (PetscInt i = 0; i < 6 * ancf->nnodes; i++) ancf->steady[i] = ancf->weight[i] + (ancf->permanent ? ancf->permanent[i] : 0);
  ancf->avalid = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddPermanent(Ancf ancf, PetscInt node, const PetscReal w[4], const PetscReal F[3])
{
  PetscFunctionBegin;
  if (!ancf->permanent) PetscCall(PetscCalloc1(6 * (size_t)ancf->nnodes, &ancf->permanent));
  for (PetscInt i = 0; i < 4; i++)
    for (PetscInt c = 0; c < 3; c++) {
      ancf->permanent[6 * node + 3 * i + c] += w[i] * F[c];
      ancf->steady[6 * node + 3 * i + c] += w[i] * F[c];
    }
  ancf->avalid = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds a permanent force F (N, fixed direction) at the fraction s of the beam's length: Q = S^T F (Eq. 23). */
PetscErrorCode AncfAddPointLoad(Ancf ancf, PetscInt beam, PetscReal s, const PetscReal F[3])
{
  PetscReal xi = 0, S[4];
  PetscInt node = 0;

  PetscFunctionBegin;
  PetscCall(CheckNode(ancf, "AncfAddPointLoad", beam, 0, F));
  PetscCall(FindElement(ancf, "AncfAddPointLoad", beam, s, &node, &xi));
  AncfShape(xi, ancf->beams[beam].l, S);
  PetscCall(AddPermanent(ancf, node, S, F));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds a permanent uniform load q (N per m of rest length, fixed direction) over a whole beam (Eq. 24). */
PetscErrorCode AncfAddLineLoad(Ancf ancf, PetscInt beam, const PetscReal q[3])
{
  PetscReal w[4];

  PetscFunctionBegin;
  PetscCall(CheckNode(ancf, "AncfAddLineLoad", beam, 0, q));
  AncfElementLoad(ancf->beams[beam].l, w);
  for (PetscInt k = 0; k < ancf->beams[beam].spec.elements; k++) PetscCall(AddPermanent(ancf, ancf->beams[beam].node + k, w, q));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Sets the moment M (N m, fixed direction) at a node, until it is set again. It works on the rotation of the tangent,
  dtheta = r' x dr'/|r'|^2, hence Q = M x r'/|r'|^2 on the gradient; a component along the tangent would twist the beam, which has
  no such coordinate, and has no effect.
*/
PetscErrorCode AncfSetMoment(Ancf ancf, PetscInt beam, PetscInt node, const PetscReal M[3])
{
  PetscFunctionBegin;
  PetscCall(CheckNode(ancf, "AncfSetMoment", beam, node, M));
  if (!ancf->moment) {
    PetscCall(PetscCalloc1(3 * (size_t)ancf->nnodes, &ancf->moment));
    for (PetscInt k = 0; k < ancf->ngroups; k++)
      ancf->groups[k]->moment = ancf->moment + 3 * ancf->beams[ancf->groups[k]->firstbeam].node;
  }
  PetscCall(PetscArraycpy(ancf->moment + 3 * (ancf->beams[beam].node + node), M, 3));
  ancf->avalid = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Removes all point loads, line loads and moments. */
PetscErrorCode AncfClearLoads(Ancf ancf)
{
  const PetscReal none[3] = {0};

  PetscFunctionBegin;
  PetscCall(CheckNode(ancf, "AncfClearLoads", 0, 0, none));
  if (ancf->permanent) PetscCall(PetscArrayzero(ancf->permanent, 6 * ancf->nnodes));
  if (ancf->moment) PetscCall(PetscArrayzero(ancf->moment, 3 * ancf->nnodes));
  PetscCall(AncfSetUpWeight(ancf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Q of one moment and dQ/dr' (row-major). */
void AncfMomentForce(const PetscReal M[3], const PetscReal r[3], PetscReal Q[3], PetscReal dQ[9])
{
  const PetscReal a = r[0] * r[0] + r[1] * r[1] + r[2] * r[2];
  const PetscReal cross[9] = {0, -M[2], M[1], M[2], 0, -M[0], -M[1], M[0], 0}; /* M x */

  for (int i = 0; i < 3; i++) Q[i] = (cross[3 * i] * r[0] + cross[3 * i + 1] * r[1] + cross[3 * i + 2] * r[2]) / a;
  if (dQ)
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) dQ[3 * i + j] = cross[3 * i + j] / a - 2 * Q[i] * r[j] / a;
}

/* Position, strain and curvature vector of one element at xi. */
void AncfMeasure(AncfStrain strain, PetscReal l, PetscReal xi, const PetscReal e[12], PetscReal r[3], PetscReal *eps,
                 PetscReal kappa[3])
{
  PetscReal S[4], S1[4], S2[4], r1[3] = {0}, r2[3] = {0}, a, p;

  AncfShape(xi, l, S);
  AncfShapeX(xi, l, S1);
  AncfShapeXX(xi, l, S2);
  r[0] = r[1] = r[2] = 0;
  for (int i = 0; i < 4; i++)
    for (int c = 0; c < 3; c++) {
      r[c] += S[i] * e[3 * i + c];
      r1[c] += S1[i] * e[3 * i + c];
      r2[c] += S2[i] * e[3 * i + c];
    }
  a = r1[0] * r1[0] + r1[1] * r1[1] + r1[2] * r1[2];
  p = strain == ANCF_STRAIN_PAPER ? a * PetscSqrtReal(a) : a;
  *eps = strain == ANCF_STRAIN_PAPER ? (a - 1) / 2 : PetscSqrtReal(a) - 1;
  for (int c = 0; c < 3; c++) kappa[c] = (r1[(c + 1) % 3] * r2[(c + 2) % 3] - r1[(c + 2) % 3] * r2[(c + 1) % 3]) / p;
}

/*
  AncfGetSection - centreline and section forces at the fraction s of a beam's length; any output may be NULL.

  r: position, m. N: axial force EA (eps - eps0), N. kappa: curvature vector r' x r''/|r'|^3, or over |r'|^2 with engineering
  strains, 1/m. M: bending moment EI (kappa - kappa0), N m. Strains are most accurate at the Gauss points of the elements.
*/
PetscErrorCode AncfGetSection(Ancf ancf, PetscInt beam, PetscReal s, PetscReal r[3], PetscReal *N, PetscReal kappa[3],
                              PetscReal M[3])
{
  PetscReal xi = 0, x[3], k[3], k0[3], eps, eps0;
  PetscInt node = 0;
  const AncfBeam *m;

  PetscFunctionBegin;
  PetscCall(FindElement(ancf, "AncfGetSection", beam, s, &node, &xi));
  m = &ancf->beams[beam];
  AncfMeasure(ancf->strain, m->l, xi, ancf->e + 6 * node, x, &eps, k);
  AncfRestSection(ancf, m, node, xi, &eps0, k0);
  if (N) *N = m->EA * (eps - eps0);
  for (int c = 0; c < 3; c++) {
    if (r) r[c] = x[c];
    if (kappa) kappa[c] = k[c];
    if (M) M[c] = m->EI * (k[c] - k0[c]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
