/*
  test_rigid_mesh.c - closed meshes and composites: volume integrals, placement, signed distance, markers, refusals.
  A box as a mesh must be the box; other solids have formulas of their own.
*/
#define _GNU_SOURCE /* mkdtemp */
#include "rigid.h"
#include "rigidtest.h"
#include <stdint.h>
#include <stdlib.h>
#include <unistd.h>

static const char help[] = "Meshes and composites of rigid bodies.\n";

static const PetscInt boxfacets[36] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                       2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};

/* Corners of a box of edges a, turned by q (0: not) and moved to c. */
static void BoxCorners(const PetscReal a[3], const PetscReal q[4], const PetscReal c[3], PetscReal x[24])
{
  PetscReal R[9];
  RigidRotationMatrix(q, R);
  for (int v = 0; v < 8; v++) {
    const PetscReal y[3] = {((v & 1) - .5) * a[0], ((v >> 1 & 1) - .5) * a[1], ((v >> 2) - .5) * a[2]};
    for (int k = 0; k < 3; k++) x[3 * v + k] = c[k] + R[3 * k] * y[0] + R[3 * k + 1] * y[1] + R[3 * k + 2] * y[2];
  }
}

/* A torus of radii R, r about the z axis: n x m vertices, 2 n m facets. */
static PetscErrorCode TorusMesh(PetscInt n, PetscInt m, PetscReal R, PetscReal r, PetscReal **x, PetscInt **tri)
{
  PetscFunctionBegin;
  PetscCall(PetscMalloc1((size_t)(3 * n * m), x));
  PetscCall(PetscMalloc1((size_t)(6 * n * m), tri));
  for (PetscInt i = 0; i < n; i++)
    for (PetscInt j = 0; j < m; j++) {
      const PetscReal u = 2. * PETSC_PI * i / n, v = 2. * PETSC_PI * j / m;
      const PetscInt a = i * m + j, b = (i + 1) % n * m + j, c = (i + 1) % n * m + (j + 1) % m, d = i * m + (j + 1) % m;
      PetscReal *p = *x + 3 * a;
      PetscInt *t = *tri + 6 * a;
      p[0] = (R + r * cos(v)) * cos(u), p[1] = (R + r * cos(v)) * sin(u), p[2] = r * sin(v);
      t[0] = a, t[1] = b, t[2] = c, t[3] = a, t[4] = c, t[5] = d;
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WriteSTL(const char name[], PetscBool binary, PetscInt nf, const PetscReal x[], const PetscInt tri[])
{
  FILE *fp = fopen(name, "wb");

  PetscFunctionBegin;
  PetscCheck(fp, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s", name);
  if (binary) {
    char head[80] = "solid is what some binary files start with";
    const uint32_t n = (uint32_t)nf;
    fwrite(head, 1, 80, fp);
    fwrite(&n, 4, 1, fp);
    for (PetscInt f = 0; f < nf; f++) {
      float v[12] = {0.f};
      for (int k = 0; k < 9; k++) v[3 + k] = (float)x[3 * tri[3 * f + k / 3] + k % 3];
      fwrite(v, 4, 12, fp);
      fwrite("\0\0", 1, 2, fp);
    }
  } else {
    fprintf(fp, "solid test\n");
    for (PetscInt f = 0; f < nf; f++) {
      fprintf(fp, " facet normal 0 0 0\n  outer loop\n");
      for (int k = 0; k < 3; k++) {
        const PetscReal *p = &x[3 * tri[3 * f + k]];
        fprintf(fp, "   vertex %.17g %.17g %.17g\r\n", p[0], p[1], p[2]);
      }
      fprintf(fp, "  endloop\n endfacet\n");
    }
    fprintf(fp, "endsolid\n");
  }
  fclose(fp);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One body of this geometry at its centre of mass, not turned: the mesh stands where its coordinates say. */
static PetscErrorCode InPlace(RigidGeometry g, RigidShape shape, PetscReal density, Rigid *r)
{
  RigidBodySpec s;

  PetscFunctionBegin;
  PetscCall(RigidBodySpecInit(&s));
  s.shape = shape;
  s.geometry = g;
  s.density = density;
  PetscCall(RigidGeometryGetPlacement(g, NULL, s.position, NULL));
  PetscCall(RigidCreate(PETSC_COMM_SELF, r));
  PetscCall(RigidAddBody(*r, &s, NULL));
  PetscCall(RigidSetUp(*r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void ToBody(const PetscReal X[3], const PetscReal q[4], const PetscReal x[3], PetscReal y[3])
{
  PetscReal R[9], d[3];
  RigidRotationMatrix(q, R);
  for (int k = 0; k < 3; k++) d[k] = x[k] - X[k];
  for (int k = 0; k < 3; k++) y[k] = R[k] * d[0] + R[3 + k] * d[1] + R[6 + k] * d[2];
}

/* tol: round-off, or that of single precision coordinates in binary files. */
static PetscErrorCode CheckBoxMesh(RigidGeometry g, const PetscReal a[3], const PetscReal q[4], const PetscReal c[3],
                                   PetscReal tol)
{
  Rigid r;
  RigidBodySpec s, box;
  PetscReal X[3], qb[4], sorted[3], got[3];
  const PetscReal m = a[0] * a[1] * a[2] * 3.;

  PetscFunctionBegin;
  PetscCall(InPlace(g, RIGID_MESH, 3., &r));
  PetscCall(RigidGetBody(r, 0, &s));
  PetscCall(RigidGetState(r, 0, X, qb, NULL, NULL));
  TEST_REL(s.mass, m, tol, "mass");
  for (int k = 0; k < 3; k++) {
    TEST_NEAR(X[k], c[k], tol * 3., "centre of mass");
    sorted[k] = m / 12. * (a[(k + 1) % 3] * a[(k + 1) % 3] + a[(k + 2) % 3] * a[(k + 2) % 3]);
    got[k] = s.inertia[k];
  }
  PetscCall(PetscSortReal(3, sorted));
  PetscCall(PetscSortReal(3, got));
  for (int k = 0; k < 3; k++) TEST_REL(got[k], sorted[k], 4. * tol, "principal moment");
  PetscCall(RigidBodySpecInit(&box));
  box.shape = RIGID_BOX;
  for (int k = 0; k < 3; k++) box.size[k] = a[k];
  for (int i = 0; i < 2000; i++) {
    PetscReal x[3], y[3], z[3];
    for (int k = 0; k < 3; k++) x[k] = c[k] + 3. * (Random() - .5);
    ToBody(X, qb, x, y);
    ToBody(c, q, x, z);
    TEST_NEAR(RigidShapeDistance(&s, y), RigidShapeDistance(&box, z), 4. * tol, "distance to the box");
  }
  PetscCall(RigidDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TestBox(const char dir[])
{
  const PetscReal a[3] = {.7, 1.1, 1.6}, c[3] = {3., -2., 5.}, q0[4] = {1., 0., 0., 0.};
  PetscReal q[4] = {.8, .3, -.4, .2}, x[24], norm = 0.;
  RigidGeometry g;
  char name[PETSC_MAX_PATH_LEN];

  PetscFunctionBegin;
  for (int k = 0; k < 4; k++) norm += q[k] * q[k];
  for (int k = 0; k < 4; k++) q[k] /= sqrt(norm);
  BoxCorners(a, q0, c, x);
  PetscCall(RigidGeometryCreateMesh(PETSC_COMM_SELF, 8, x, 12, boxfacets, &g));
  PetscCall(CheckBoxMesh(g, a, q0, c, 1e-13));
  PetscCall(RigidGeometryDestroy(&g));
  BoxCorners(a, q, c, x);
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s/box.stl", dir));
  PetscCall(WriteSTL(name, PETSC_FALSE, 12, x, boxfacets));
  PetscCall(RigidGeometryCreateSTL(PETSC_COMM_SELF, name, 1., &g));
  PetscCall(CheckBoxMesh(g, a, q, c, 1e-13));
  PetscCall(RigidGeometryDestroy(&g));
  for (int k = 0; k < 24; k++) x[k] *= 1000.;
  PetscCall(WriteSTL(name, PETSC_TRUE, 12, x, boxfacets));
  PetscCall(RigidGeometryCreateSTL(PETSC_COMM_SELF, name, 1e-3, &g));
  PetscCall(CheckBoxMesh(g, a, q, c, 3e-6)); /* 6 x 6e-8 of the coordinates, over edges of .7 */
  PetscCall(RigidGeometryDestroy(&g));
  unlink(name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Volume 2 pi^2 R r^2, J_zz = V (R^2 + 3/4 r^2); inscribed facets are short by O(n^-2 + m^-2). Distance sqrt((rho - R)^2 + z^2) -
 * r. */
static PetscErrorCode TestTorus(void)
{
  const PetscReal R = 1., r = .4, V = 2. * PETSC_PI * PETSC_PI * R * r * r, Jz = V * (R * R + .75 * r * r);
  PetscReal ev[2], ej[2], dp = .1;

  PetscFunctionBegin;
  for (int pass = 0; pass < 2; pass++) {
    const PetscInt n = 48 << pass, m = 24 << pass;
    const PetscReal sag = r * (1. - cos(PETSC_PI / m)) + (R + r) * (1. - cos(PETSC_PI / n));
    RigidGeometry g;
    Rigid body;
    RigidBodySpec s;
    PetscReal *x, X[3], q[4];
    PetscInt *tri;
    PetscCall(TorusMesh(n, m, R, r, &x, &tri));
    PetscCall(RigidGeometryCreateMesh(PETSC_COMM_SELF, n * m, x, 2 * n * m, tri, &g));
    PetscCall(InPlace(g, RIGID_MESH, 1., &body));
    PetscCall(RigidGetBody(body, 0, &s));
    PetscCall(RigidGetState(body, 0, X, q, NULL, NULL));
    ev[pass] = 1. - s.mass / V;
    ej[pass] = 1. - PetscMax(PetscMax(s.inertia[0], s.inertia[1]), s.inertia[2]) / Jz;
    for (int i = 0; i < 3000; i++) {
      PetscReal p[3], y[3], d;
      for (int k = 0; k < 3; k++) p[k] = (k == 2 ? 1.2 : 3.2) * (Random() - .5);
      d = sqrt(PetscSqr(sqrt(p[0] * p[0] + p[1] * p[1]) - R) + p[2] * p[2]) - r;
      ToBody(X, q, p, y);
      TEST_NEAR(RigidShapeDistance(&s, y), d, 1.5 * sag, "distance to the torus");
    }
    if (pass == 1) {
      PetscInt nm;
      PetscReal *xm, *v, *depth, sum = 0., lo = 1e30, hi = 0., vlo = 1e30, vhi = 0.;
      PetscCall(RigidFillMarkers(&s, 3, dp, 100., &nm, &xm, &v, &depth));
      for (PetscInt i = 0; i < nm; i++) {
        PetscReal near = 1e30;
        for (PetscInt j = 0; j < nm; j++)
          if (j != i)
            near = PetscMin(near, PetscSqr(xm[3 * i] - xm[3 * j]) + PetscSqr(xm[3 * i + 1] - xm[3 * j + 1]) +
                                      PetscSqr(xm[3 * i + 2] - xm[3 * j + 2]));
        lo = PetscMin(lo, sqrt(near) / dp);
        hi = PetscMax(hi, sqrt(near) / dp);
        vlo = PetscMin(vlo, v[i] / dp / dp / dp);
        vhi = PetscMax(vhi, v[i] / dp / dp / dp);
        sum += v[i];
        TEST(depth[i] > .25 * dp, "depth %g", depth[i]);
      }
      printf("torus: %d markers for %.1f dp^3, nearest %.3f..%.3f dp, volume %.3f..%.3f dp^3\n", (int)nm, s.mass / dp / dp / dp,
             lo, hi, vlo, vhi);
      TEST_REL(sum, s.mass, 1e-12, "marker volume");
      TEST(lo >= .85 * (1. - 1e-12) && hi < 1.7, "nearest marker %g .. %g dp", lo,
           hi); /* closer: refused by construction; a gap of 2 x .85 would be filled */
      TEST(vlo > .2 && vhi < 2.5, "marker volume %g .. %g dp^3", vlo, vhi);
      PetscCall(PetscFree(xm));
      PetscCall(PetscFree(v));
      PetscCall(PetscFree(depth));
    }
    PetscCall(PetscFree(x));
    PetscCall(PetscFree(tri));
    PetscCall(RigidDestroy(&body));
    PetscCall(RigidGeometryDestroy(&g));
  }
  printf("torus: volume short by %.3e %.3e, J_zz by %.3e %.3e\n", ev[0], ev[1], ej[0], ej[1]);
  TEST_NEAR(log2(ev[0] / ev[1]), 2., .05, "order of the volume");
  TEST_NEAR(log2(ej[0] / ej[1]), 2., .05, "order of the moment");
  TEST(ev[1] < 2. * PETSC_PI * PETSC_PI * (1. / (48. * 48.) + 1. / (96. * 96.)), "volume short by %g", ev[1]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Markers of a box given as a mesh: layers at dp/2, 3dp/2, and the volumes of the layers within the grid's resolution. */
static PetscErrorCode TestMeshLayers(void)
{
  const PetscReal a[3] = {1., 1.2, .9}, c[3] = {0., 0., 0.}, q[4] = {1., 0., 0., 0.}, dp = .1;
  PetscReal x[24], *xm, *v, *depth, sum = 0.;
  PetscInt n, outer = 0, second = 0;
  RigidGeometry g;
  RigidBodySpec s;

  PetscFunctionBegin;
  BoxCorners(a, q, c, x);
  PetscCall(RigidGeometryCreateMesh(PETSC_COMM_SELF, 8, x, 12, boxfacets, &g));
  PetscCall(RigidBodySpecInit(&s));
  s.shape = RIGID_MESH;
  s.geometry = g;
  PetscCall(RigidFillMarkers(&s, 3, dp, 2. * dp, &n, &xm, &v, &depth));
  for (PetscInt i = 0; i < n; i++) {
    sum += v[i];
    outer += fabs(depth[i] - .5 * dp) < .01 * dp;
    second += fabs(depth[i] - 1.5 * dp) < .01 * dp;
  }
  printf("box mesh: %d markers, %d in the outer layer, %d in the second, volume %.5f\n", (int)n, (int)outer, (int)second, sum);
  TEST(outer + second > .9 * n, "only %d + %d of %d markers lie in the middle of a layer", (int)outer, (int)second, (int)n);
  /* layer surfaces 2 (.9 1.1 + .9 .8 + 1.1 .8) dp^-2 = 518 and 2 (.7 .9 + .7 .6 + .9 .6) dp^-2 = 318; hexagons .85 dp apart 1.6
   * as many, random ones .8 */
  TEST(outer > .7 * 518 && outer < 1.4 * 518 && second > .6 * 318 && second < 1.4 * 318, "%d and %d markers", (int)outer,
       (int)second);
  TEST_REL(sum, 1. * 1.2 * .9 - .6 * .8 * .5, 1e-9,
           "volume of two layers"); /* grid of dp/3: faces of the layers fall on cell faces */
  PetscCall(PetscFree(xm));
  PetscCall(PetscFree(v));
  PetscCall(PetscFree(depth));
  PetscCall(RigidGeometryDestroy(&g));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Two half boxes are the box; a dumbbell by Steiner's rule; two densities move the centre and let buoyancy turn the body. */
static PetscErrorCode TestComposite(void)
{
  RigidBodySpec part[3], s, box;
  RigidGeometry g;
  Rigid r;
  PetscReal X[3], q[4], J[3], e0, e1, ke, pe, kemax = 0., al[3], R[9], n;
  PetscReal *xm, *v, *depth, sum = 0.;
  PetscInt nm;
  const PetscReal grav[3] = {0., 0., -10.};

  PetscFunctionBegin;
  for (int i = 0; i < 2; i++) {
    PetscCall(RigidBodySpecInit(&part[i]));
    part[i].shape = RIGID_BOX;
    part[i].size[0] = .6, part[i].size[1] = 1.1, part[i].size[2] = .7;
    part[i].position[0] = 2. + .3 * (2 * i - 1);
    part[i].position[1] = 1.;
    part[i].density = 2.;
  }
  /* the second one is turned on its own axes: a cube-symmetric change of description */
  part[1].size[0] = 1.1, part[1].size[1] = .6;
  part[1].axisangle[3] = .5 * PETSC_PI;
  PetscCall(RigidGeometryCreateComposite(PETSC_COMM_SELF, 3, 2, part, &g));
  PetscCall(InPlace(g, RIGID_COMPOSITE, 99., &r));
  PetscCall(RigidGetBody(r, 0, &s));
  PetscCall(RigidGetState(r, 0, X, q, NULL, NULL));
  TEST_REL(s.density, 2., 1e-14, "mean density");
  TEST_REL(s.mass, 2. * 1.2 * 1.1 * .7, 1e-14, "mass");
  TEST_NEAR(X[0], 2., 1e-14, "centre");
  const PetscReal want[3] = {s.mass / 12. * (1.1 * 1.1 + .49), s.mass / 12. * (1.44 + .49), s.mass / 12. * (1.44 + 1.21)};
  for (int k = 0; k < 3; k++) J[k] = s.inertia[k];
  PetscCall(PetscSortReal(3, J));
  TEST_REL(J[0], want[0], 1e-13, "J");
  TEST_REL(J[1], want[1], 1e-13, "J");
  TEST_REL(J[2], want[2], 1e-13, "J");
  PetscCall(RigidBodySpecInit(&box));
  box.shape = RIGID_BOX;
  box.size[0] = 1.2, box.size[1] = 1.1, box.size[2] = .7;
  for (int i = 0; i < 1000; i++) {
    PetscReal x[3], y[3], z[3], d;
    for (int k = 0; k < 3; k++) x[k] = X[k] + 3. * (Random() - .5), z[k] = x[k] - X[k];
    ToBody(X, q, x, y);
    d = RigidShapeDistance(&box, z);
    if (d > 0.)
      TEST_NEAR(RigidShapeDistance(&s, y), d, 1e-13, "distance outside");
    else
      TEST(RigidShapeDistance(&s, y) <= 0. && RigidShapeDistance(&s, y) >= d - 1e-13, "inside: %g, depth of the box %g",
           RigidShapeDistance(&s, y), d);
  }
  PetscCall(RigidFillMarkers(&s, 3, .1, 100., &nm, &xm, &v, &depth));
  for (PetscInt i = 0; i < nm; i++) sum += v[i];
  TEST_REL(sum, 1.2 * 1.1 * .7, 1e-12, "marker volume of the composite");
  PetscCall(PetscFree(xm));
  PetscCall(PetscFree(v));
  PetscCall(PetscFree(depth));
  PetscCall(RigidDestroy(&r));
  PetscCall(RigidGeometryDestroy(&g));

  /* rod of radius .2 between spheres of radius .5, of densities 1, 3 and 2; along z */
  for (int i = 0; i < 3; i++) PetscCall(RigidBodySpecInit(&part[i]));
  part[0].size[0] = part[1].size[0] = .5;
  part[2].shape = RIGID_CYLINDER;
  part[2].size[0] = .2, part[2].size[1] = 1.;
  part[0].position[2] = -1.05, part[1].position[2] = 1.05;
  part[0].density = 1., part[1].density = 3., part[2].density = 2.;
  PetscCall(RigidGeometryCreateComposite(PETSC_COMM_SELF, 3, 3, part, &g));
  const PetscReal Vs = 4. / 3. * PETSC_PI * .125, Vc = PETSC_PI * .04, m[3] = {Vs, 3. * Vs, 2. * Vc}, M = m[0] + m[1] + m[2];
  const PetscReal zc = 1.05 * (m[1] - m[0]) / M, V = 2. * Vs + Vc;
  PetscReal Jx = 0., Jz = 0.;
  for (int i = 0; i < 2; i++) Jx += .4 * m[i] * .25 + m[i] * PetscSqr(part[i].position[2] - zc), Jz += .4 * m[i] * .25;
  Jx += m[2] * (.04 / 4. + 1. / 12.) + m[2] * zc * zc;
  Jz += m[2] * .02;
  PetscCall(RigidGeometryGetPlacement(g, &n, X, NULL));
  TEST_REL(n, V, 1e-14, "volume of the dumbbell");
  TEST_REL(X[2], zc, 1e-13, "centre of mass of the dumbbell");
  PetscCall(RigidBodySpecInit(&s));
  s.shape = RIGID_COMPOSITE;
  s.geometry = g;
  s.axisangle[0] = 1., s.axisangle[2] = 0., s.axisangle[3] = .8; /* tilted by .8 rad about x */
  PetscCall(RigidCreate(PETSC_COMM_SELF, &r));
  PetscCall(RigidSetGravity(r, grav));
  PetscCall(RigidSetFluidDensity(r, M / V)); /* floats neutrally, the heavy end sinks */
  PetscCall(RigidAddBody(r, &s, NULL));
  PetscCall(RigidSetUp(r));
  PetscCall(RigidGetBody(r, 0, &s));
  for (int k = 0; k < 3; k++) J[k] = s.inertia[k];
  PetscCall(PetscSortReal(3, J));
  TEST_REL(J[0], Jz, 1e-13, "dumbbell J_zz");
  TEST_REL(J[1], Jx, 1e-13, "dumbbell J_xx");
  /* torque of the lift M g in the centroid, zc below the centre of mass along the rod: M g zc sin(tilt), upright is unstable */
  PetscCall(RigidGetAcceleration(r, 0, NULL, al));
  TEST_REL(al[0], M * 10. * zc * sin(.8) / Jx, 1e-12, "buoyancy turns the dumbbell");
  PetscCall(RigidGetEnergy(r, &ke, &pe));
  e0 = ke + pe;
  for (int i = 1; i <= 4000; i++) {
    PetscCall(RigidAdvance(r, i * 1e-3));
    PetscCall(RigidGetEnergy(r, &ke, NULL));
    kemax = PetscMax(kemax, ke);
  }
  PetscCall(RigidGetEnergy(r, &ke, &pe));
  e1 = ke + pe;
  PetscCall(RigidGetState(r, 0, X, q, NULL, NULL));
  RigidRotationMatrix(q, R);
  TEST_NEAR(e1, e0, 1e-5 * M * 10. * zc, "energy of the swinging dumbbell"); /* (omega dt)^2/8 with omega = 2.5 rad/s */
  TEST_NEAR(kemax, M * 10. * zc * (1. + cos(.8)), .01 * M * 10. * zc, "kinetic energy at the lowest point");
  TEST_NEAR(X[2], 0., 1e-12, "neutrally buoyant");
  PetscCall(RigidDestroy(&r));
  PetscCall(RigidGeometryDestroy(&g));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Two discs in 2D: m 2 (r^2/2 + d^2) per metre. */
static PetscErrorCode TestComposite2D(void)
{
  RigidBodySpec part[2], s;
  RigidGeometry g;
  Rigid r;
  PetscReal *x, *v, *depth, sum = 0.;
  PetscInt n;

  PetscFunctionBegin;
  for (int i = 0; i < 2; i++) {
    PetscCall(RigidBodySpecInit(&part[i]));
    part[i].shape = RIGID_CYLINDER;
    part[i].size[0] = .5;
    part[i].position[0] = i ? .5 : -.5;
    part[i].density = 4.;
  }
  PetscCall(RigidGeometryCreateComposite(PETSC_COMM_SELF, 2, 2, part, &g));
  PetscCall(RigidCreate(PETSC_COMM_SELF, &r));
  PetscCall(RigidSetDimension(r, 2));
  PetscCall(RigidBodySpecInit(&s));
  s.shape = RIGID_COMPOSITE;
  s.geometry = g;
  PetscCall(RigidAddBody(r, &s, NULL));
  PetscCall(RigidSetUp(r));
  PetscCall(RigidGetBody(r, 0, &s));
  TEST_REL(s.mass, 2. * PETSC_PI, 1e-14, "mass of two discs");
  TEST_REL(s.inertia[2], 2. * PETSC_PI * (.125 + .25), 1e-14, "moment of two discs");
  PetscCall(RigidFillMarkers(&s, 2, .08, 100., &n, &x, &v, &depth));
  for (PetscInt i = 0; i < n; i++) {
    sum += v[i];
    TEST(x[3 * i + 2] == 0., "z = %g", x[3 * i + 2]);
  }
  TEST_REL(sum, .5 * PETSC_PI, 1e-12, "area of the markers");
  PetscCall(PetscFree(x));
  PetscCall(PetscFree(v));
  PetscCall(PetscFree(depth));
  PetscCall(RigidDestroy(&r));
  PetscCall(RigidGeometryDestroy(&g));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Bytes(const char name[], const char *text, size_t n)
{
  FILE *fp = fopen(name, "wb");
  PetscFunctionBegin;
  PetscCheck(fp, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s", name);
  fwrite(text, 1, n, fp);
  fclose(fp);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TestBadInput(const char dir[])
{
  const PetscReal a[3] = {1.25, 1.25, 1.25}, c[3] = {0., 0., 0.}, q[4] = {1., 0., 0., 0.};
  PetscReal x[24];
  PetscInt f[36];
  RigidGeometry g = NULL;
  RigidBodySpec part[2];
  char name[PETSC_MAX_PATH_LEN], bin[84 + 50] = "binary";
  const char *bad = "solid s\nfacet\nvertex 0 0 0\nvertex 1 0 zero\nvertex 0 1 0\n",
             *two = "solid s\nfacet\nvertex 0 0 0\nvertex 1 0 0\nendfacet\n";

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s/bad.stl", dir));
  BoxCorners(a, q, c, x);
  memcpy(f, boxfacets, sizeof(f));
  PetscCall(PetscPushErrorHandler(TestCatch, NULL));
  Refused(RigidGeometryCreateMesh(PETSC_COMM_SELF, 8, x, 11, f, &g), "open box", "not closed: edge (0.625,", "1 facet(s)");
  f[30] = boxfacets[31], f[31] = boxfacets[30];
  Refused(RigidGeometryCreateMesh(PETSC_COMM_SELF, 8, x, 12, f, &g), "turned facet", "not oriented: facets", "10");
  f[30] = f[31];
  Refused(RigidGeometryCreateMesh(PETSC_COMM_SELF, 8, x, 12, f, &g), "facet without area", "facet 10", "no area");
  f[30] = 8;
  Refused(RigidGeometryCreateMesh(PETSC_COMM_SELF, 8, x, 12, f, &g), "vertex 8", "facet 10 names vertex 8", "0 ... 7");
  for (int k = 0; k < 12; k++)
    f[3 * k] = boxfacets[3 * k + 1], f[3 * k + 1] = boxfacets[3 * k], f[3 * k + 2] = boxfacets[3 * k + 2];
  Refused(RigidGeometryCreateMesh(PETSC_COMM_SELF, 8, x, 12, f, &g), "inside out", "volume of -1.95", "> 0");
  x[3] = (PetscReal)NAN;
  Refused(RigidGeometryCreateMesh(PETSC_COMM_SELF, 8, x, 12, f, &g), "NaN vertex", "vertex 1", "not finite");
  Refused(RigidGeometryCreateSTL(PETSC_COMM_SELF, "/no/such/file.stl", 1., &g), "no file", "/no/such/file.stl",
          "cannot be opened");
  PetscCall(Bytes(name, "", 0));
  Refused(RigidGeometryCreateSTL(PETSC_COMM_SELF, name, 1., &g), "empty file", "bad.stl", "empty");
  PetscCall(Bytes(name, bad, strlen(bad)));
  Refused(RigidGeometryCreateSTL(PETSC_COMM_SELF, name, 1., &g), "bad vertex", "line 4", "vertex 1 0 zero");
  PetscCall(Bytes(name, two, strlen(two)));
  Refused(RigidGeometryCreateSTL(PETSC_COMM_SELF, name, 1., &g), "two vertices", "2. vertices", "three for each facet");
  bin[80] = 2;
  PetscCall(Bytes(name, bin, sizeof(bin)));
  Refused(RigidGeometryCreateSTL(PETSC_COMM_SELF, name, 1., &g), "short binary file", "ends after 134. bytes", "need 184");
  Refused(RigidGeometryCreateSTL(PETSC_COMM_SELF, name, 0., &g), "scale 0", "scale = 0", "> 0");
  unlink(name);

  for (int i = 0; i < 2; i++) {
    PetscCall(RigidBodySpecInit(&part[i]));
    part[i].size[0] = .5;
    part[i].position[0] = .9 * i;
  }
  Refused(RigidGeometryCreateComposite(PETSC_COMM_SELF, 3, 2, part, &g), "overlap", "parts 0 and 1 overlap", "touch");
  part[1].density = -2.;
  Refused(RigidGeometryCreateComposite(PETSC_COMM_SELF, 3, 2, part, &g), "density", "body 1", "density = -2");
  Refused(RigidGeometryCreateComposite(PETSC_COMM_SELF, 3, 0, part, &g), "no parts", "0 parts", "one at least");
  part[1].shape = RIGID_MESH;
  Refused(RigidGeometryCreateComposite(PETSC_COMM_SELF, 3, 2, part, &g), "mesh part", "part 1 is a mesh", "sphere, box");
  {
    Rigid r;
    PetscCall(RigidCreate(PETSC_COMM_SELF, &r));
    Refused(RigidAddBody(r, &part[1], NULL), "mesh without geometry", "shape = mesh", "missing");
    PetscCall(RigidDestroy(&r));
  }
  PetscCall(PetscPopErrorHandler());
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  char dir[] = "/tmp/frond_mesh_XXXXXX";

  PetscCall(PetscInitialize(&argc, &argv, NULL, help));
  PetscCheck(mkdtemp(dir), PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s", dir);
  PetscCall(TestBox(dir));
  PetscCall(TestTorus());
  PetscCall(TestMeshLayers());
  PetscCall(TestComposite());
  PetscCall(TestComposite2D());
  PetscCall(TestBadInput(dir));
  rmdir(dir);
  PetscCall(PetscFinalize());
  return test_report();
}
