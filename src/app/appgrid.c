/*
  appgrid.c - what a scene looks at: regular grids (volumes, slices, lines) that go into the frames, points and planes that go
  into the history.

  Values come from the fluid markers by SphInterpolate(): by a linear fit, or by Shepard's mean, the mapping of Pazouki, Serban,
  Negrut.
*/
#include "app.h"

/* Distance of the grid's points along an axis, m; the spacing where there is one point only. */
PetscReal AppGridStep(const SceneGrid *g, PetscInt axis)
{
  return g->n[axis] > 1 ? (g->hi[axis] - g->lo[axis]) / (PetscReal)(g->n[axis] - 1) : g->spacing;
}

static PetscErrorCode write_grid(App *app, const SceneGrid *g, int64_t at)
{
  const PetscInt n = g->n[0] * g->n[1] * g->n[2];
  PetscReal *x, *v, *p, *rho, *fraction;
  int64_t group;

  PetscFunctionBegin;
  PetscCall(PetscMalloc5(3 * (size_t)n, &x, 3 * (size_t)n, &v, n, &p, n, &rho, n, &fraction));
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt c[3] = {i % g->n[0], i / g->n[0] % g->n[1], i / (g->n[0] * g->n[1])};
    for (int a = 0; a < 3; a++) x[3 * i + a] = g->lo[a] + (PetscReal)c[a] * AppGridStep(g, a);
  }
  PetscCall(SphInterpolate(app->sph, (SphInterpolation)g->how, n, x, &(SphPoints){v, p, rho, fraction}));
  PetscCall(AppH5Group(at, g->name, &group));
  PetscCall(
      AppH5Grid(group, &(H5Label){"velocity", "m/s", "velocity of the fluid; not a number where no fluid is near"}, g->n, 3, v));
  PetscCall(
      AppH5Grid(group, &(H5Label){"pressure", "Pa", "pressure of the fluid; not a number where no fluid is near"}, g->n, 1, p));
  PetscCall(AppH5Grid(group, &(H5Label){"density", "kg/m^3", "density of the fluid; not a number where no fluid is near"}, g->n,
                      1, rho));
  PetscCall(AppH5Grid(group, &(H5Label){"fraction", "1", "kernel sum: about 1 in the fluid, 0.5 at its surface, 0 outside"}, g->n,
                      1, fraction));
  for (int a = 0; a < 3; a++) {
    const char origin[] = {'o', 'r', 'i', 'g', 'i', 'n', '_', "xyz"[a], 0}, step[] = {'s', 't', 'e', 'p', '_', "xyz"[a], 0};
    PetscCall(AppH5AttrReal(group, origin, g->lo[a]));
    PetscCall(AppH5AttrReal(group, step, AppGridStep(g, a)));
  }
  PetscCall(AppH5GroupClose(group));
  PetscCall(PetscFree5(x, v, p, rho, fraction));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The group grids of a frame. */
PetscErrorCode AppGridsWrite(App *app, int64_t file)
{
  const AppScene *s = &app->scene;
  int64_t group;

  PetscFunctionBegin;
  if (!s->ngrids) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AppH5Group(file, "grids", &group));
  for (PetscInt i = 0; i < s->ngrids; i++) PetscCall(write_grid(app, &s->grids[i], group));
  PetscCall(AppH5GroupClose(group));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode put_point(App *app, const SceneProbe *p, AppPut put, AppHistory h)
{
  PetscReal v[3] = {0}, pressure, fraction;
  char name[96];

  PetscFunctionBegin;
  PetscCall(SphInterpolate(app->sph, (SphInterpolation)p->how, 1, p->position, &(SphPoints){v, &pressure, NULL, &fraction}));
  if (!(fraction > 0)) v[0] = v[1] = v[2] = pressure = 0;
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s_p", p->name));
  PetscCall((*put)(h, name, "Pa", "pressure at the probe; 0 when dry", pressure));
  for (int a = 0; a < 3; a++) {
    PetscCall(PetscSNPrintf(name, sizeof(name), "%s_v%c", p->name, "xyz"[a]));
    PetscCall((*put)(h, name, "m/s", "velocity at the probe; 0 when dry", v[a]));
  }
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s_fraction", p->name));
  PetscCall((*put)(h, name, "1", "kernel sum at the probe: about 1 in the fluid, 0 when dry", fraction));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Columns of the probes, through the history's own put. */
PetscErrorCode AppProbesPut(App *app, AppPut put, AppHistory h)
{
  const PetscBool flat = (PetscBool)(app->dim == 2);

  PetscFunctionBegin;
  for (PetscInt i = 0; i < app->scene.nprobes; i++) {
    const SceneProbe *p = &app->scene.probes[i];
    SphPlane plane;
    char name[96];
    if (p->kind == 0) {
      PetscCall(put_point(app, p, put, h));
      continue;
    }
    PetscCall(SphGetPlane(app->sph, p->position, p->edge1, p->edge2, &plane));
    PetscCall(PetscSNPrintf(name, sizeof(name), "%s_flow", p->name));
    PetscCall((*put)(h, name, flat ? "m^2/s" : "m^3/s", "volume flow through the plane", plane.volume));
    PetscCall(PetscSNPrintf(name, sizeof(name), "%s_massflow", p->name));
    PetscCall((*put)(h, name, flat ? "kg/m/s" : "kg/s", "mass flow through the plane", plane.mass));
    PetscCall(PetscSNPrintf(name, sizeof(name), "%s_p", p->name));
    PetscCall((*put)(h, name, "Pa", "mean pressure over the wetted part of the plane; 0 when dry", plane.pressure));
    PetscCall(PetscSNPrintf(name, sizeof(name), "%s_area", p->name));
    PetscCall((*put)(h, name, flat ? "m" : "m^2", "wetted part of the plane", plane.area));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
