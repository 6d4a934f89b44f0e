/* sph_link.h - checks of linked groups that hold for every backend. */
#ifndef SPH_LINK_H
#define SPH_LINK_H

#include "sph_conformance.h"
#include "testing.h"

/*
  Load and totals against the forces on the markers: F, M about the centre, Q of the affine nodes, force, moment, power. Both
  sides are sums of n products; each is within (n + 4) 2^-53 of the sum of the magnitudes, times 2 for both. Positions and speeds
  are below 1, so that the forces' magnitudes bound every term.
*/
static inline PetscErrorCode SceneCheckLoad(Sph sph, const Scene *c, double t, const char *what)
{
  PetscReal *f, *o, body[4], load[12], want[12] = {0.0}, total[7] = {0.0}, size = 0.0, worst = 0.0;
  SphLinkTotals got;
  PetscInt n, nload;

  PetscFunctionBegin;
  SceneBody(c, body);
  PetscCall(SceneOffsets(c, &n, &o));
  PetscCall(PetscMalloc1(3 * (size_t)n, &f));
  PetscCall(SphGetGroupLinkSize(sph, 1, NULL, &nload));
  PetscCall(SphGetGroupLoad(sph, 1, load, &got));
  PetscCall(SphGetBoundaryForce(sph, 1, f));
  for (PetscInt i = 0; i < n; i++)
    for (int k = 0; k < 3; k++) {
      const int k1 = (k + 1) % 3, k2 = (k + 2) % 3;
      const PetscReal *F = f + 3 * i, *O = o + 3 * i;
      double x[3], v[3];
      for (int j = 0; j < 3; j++) {
        v[j] = j < c->dim ? scene_velocity[j] + scene_acceleration[j] * t : 0.0;
        x[j] = body[j] + O[j] + (j < c->dim ? (v[j] - 0.5 * scene_acceleration[j] * t) * t : 0.0);
      }
      size += fabs(F[k]);
      total[k] += F[k];
      total[3 + k] += x[k1] * F[k2] - x[k2] * F[k1];
      total[6] += F[k] * v[k];
      if (nload == 6) {
        want[k] += F[k];
        want[3 + k] += O[k1] * F[k2] - O[k2] * F[k1];
      } else
        for (int j = 0; j < 4; j++) want[3 * j + k] += (j ? O[j - 1] : 1.0 - O[0] - O[1] - O[2]) * F[k];
    }
  for (PetscInt j = 0; j < nload; j++) worst = PetscMax(worst, fabs(load[j] - want[j]));
  for (int k = 0; k < 3; k++)
    worst = PetscMax(worst, PetscMax(fabs(got.force[k] - total[k]), fabs(got.moment[k] - total[3 + k])));
  worst = PetscMax(worst, fabs(got.power - total[6]));
  TEST(size > 0.0 && worst <= 2.0 * (double)(n + 4) * 1.2e-16 * size,
       "%s, %s: the load differs by %g from the markers' forces %g", c->name, what, worst, size);
  TEST(got.twist == 0.0, "%s, %s: twist %g", c->name, what, got.twist);
  PetscCall(PetscFree(o));
  PetscCall(PetscFree(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Markers moved by SphSetFields() go back where the state says when the same state is given again. */
static inline PetscErrorCode SceneCheckForgotten(Sph sph, const Scene *c, double t, const char *what)
{
  const PetscInt first = 3 * sph->groupstart[1], last = 3 * sph->groupstart[2];
  SphFields f = {0}, moved = {0};
  PetscInt bad = 0;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(3 * (size_t)sph->n, &f.x, 3 * (size_t)sph->n, &moved.x));
  PetscCall(SphGetFields(sph, &f));
  PetscCall(SphGetFields(sph, &moved));
  for (PetscInt i = first; i < last; i++) moved.x[i] += i % 3 < c->dim ? 0.1 * SCENE_DP : 0.0;
  PetscCall(SphSetFields(sph, &moved));
  PetscCall(SceneMoveBody(sph, c, t));
  PetscCall(SphGetFields(sph, &moved));
  for (PetscInt i = first; i < last; i++) bad += moved.x[i] != f.x[i];
  TEST(bad == 0, "%s, %s: %d numbers are not where the state puts them", c->name, what, (int)bad);
  PetscCall(PetscFree2(f.x, moved.x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  A linked group against one whose markers are moved one by one, 10 steps in double precision: positions differ by round-off, and
  differences grow to at most 3e-8 of each field's scale (see test_cuda_device.c: 2^20 over 20 stages, sums to 3e-14).
*/
static inline PetscErrorCode SceneCheckLink(const Scene *c, const char *type, SceneLink link, const char *what)
{
  const double scale[3] = {0.1, 1.0, 2e4};
  PetscReal *d[2], t = 0.0;
  PetscInt n = 0, bad = 0;

  PetscFunctionBegin;
  for (int k = 0; k < 2; k++) {
    SphFields f = {0};
    Sph sph;
    PetscCall(SceneCreate(c, type, SPH_PRECISION_DOUBLE, &sph));
    PetscCall(SceneSetLink(sph, c, k ? link : SCENE_FREE));
    PetscCall(SphSetUp(sph));
    PetscCall(SceneMoveBody(sph, c, 0.0));
    for (int step = 0; step < 10; step++) {
      PetscCall(SphGetTime(sph, &t, NULL));
      PetscCall(SphStepBegin(sph, 2e-4));
      PetscCall(SceneMoveBody(sph, c, t + 1e-4));
      PetscCall(SphStepEnd(sph));
      if (k && step % 3 == 0) PetscCall(SceneCheckLoad(sph, c, t + 1e-4, what));
      PetscCall(SceneMoveBody(sph, c, t + 2e-4));
    }
    n = sph->n;
    PetscCall(PetscMalloc1(9 * (size_t)n, &d[k]));
    PetscCall(SceneCheckForgotten(sph, c, t + 2e-4, what));
    f.x = d[k];
    f.v = d[k] + 3 * n;
    f.a = d[k] + 6 * n;
    PetscCall(SphGetFields(sph, &f));
    PetscCall(SphDestroy(&sph));
  }
  for (PetscInt i = 0; i < 9 * n; i++) bad += !(fabs(d[0][i] - d[1][i]) <= 3e-8 * scale[i / (3 * n)]);
  TEST(bad == 0, "%s, %s: %d values differ between linked and free markers after 10 steps", c->name, what, (int)bad);
  PetscCall(PetscFree(d[0]));
  PetscCall(PetscFree(d[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#endif
