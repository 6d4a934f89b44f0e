/* appcheck.c - `frond check`: everything set up, counted, and a few steps timed; nothing is written. */
#include "app.h"
#include <math.h>

static PetscErrorCode print_fluid(App *app)
{
  PetscReal dp, h, cs, rho, mu, bytes, evaluations, dt;

  PetscFunctionBegin;
  if (!app->sph) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SphGetSpacing(app->sph, &dp));
  PetscCall(SphGetSmoothingLength(app->sph, &h));
  PetscCall(SphGetSoundSpeed(app->sph, &cs));
  PetscCall(SphGetDensity(app->sph, &rho));
  PetscCall(SphGetViscosity(app->sph, &mu));
  PetscCall(SphGetWork(app->sph, &bytes, &evaluations));
  PetscCall(SphComputeTimeStep(app->sph, &dt));
  printf("  fluid:    %dD, density %g kg/m^3, viscosity %g Pa s, sound speed %g m/s\n", (int)app->dim, (double)rho, (double)mu,
         (double)cs);
  printf("  spacing:  dp %g m, h %g m (h/dp %.3g)\n", (double)dp, (double)h, (double)(h / dp));
  printf("  markers:  %d fluid, %d boundary\n", (int)app->nfluid, (int)app->nboundary);
  for (PetscInt i = 0; i < app->nsurfaces; i++)
    printf("            %-16s %d\n", app->surfaces[i].name, (int)app->surfaces[i].markers);
  printf("  memory:   about %.1f MB for the markers\n", (double)bytes / 1e6);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode print_structures(const App *app)
{
  PetscInt nodes;

  PetscFunctionBegin;
  if (app->ancf) {
    PetscCall(AncfGetNumNodes(app->ancf, &nodes));
    printf("  beams:    %d with %d nodes\n", (int)app->scene.nbeams, (int)nodes);
  }
  if (app->rigid) printf("  bodies:   %d\n", (int)app->scene.nbodies);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void format_cost(PetscReal s, size_t len, char text[])
{
  if (s < 120)
    snprintf(text, len, "%.2g s", (double)s);
  else if (s < 7200)
    snprintf(text, len, "%.3g min", (double)(s / 60));
  else
    snprintf(text, len, "%.3g h", (double)(s / 3600));
}

/* Steps taken for timing: a warm one, then at most 10 or about 2 s. */
static PetscErrorCode time_steps(App *app, PetscReal *dt, PetscReal *wall)
{
  PetscReal start, t0;
  PetscInt n = 0;

  PetscFunctionBegin;
  start = AppWallTime();
  PetscCall(AppStep(app, app->scene.tend, dt));
  *wall = AppWallTime() - start;
  t0 = app->t;
  start = AppWallTime();
  while (n < 10 && app->t < app->scene.tend && AppWallTime() - start < 2) {
    PetscCall(AppStep(app, app->scene.tend, dt));
    n++;
  }
  if (n) *wall = (AppWallTime() - start) / (PetscReal)n;
  if (n) *dt = (app->t - t0) / (PetscReal)n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppCheck(App *app)
{
  PetscReal dt = 0, wall = 0, steps;
  char cost[32];

  PetscFunctionBegin;
  PetscCall(AppOutputCheck(app->scene.outdir));
  printf("scene %s: %g s, every option is understood\n", app->scene.name, (double)app->scene.tend);
  PetscCall(print_fluid(app));
  PetscCall(print_structures(app));
  PetscCall(time_steps(app, &dt, &wall));
  steps = PetscCeilReal(app->scene.tend / dt - 1e-9);
  format_cost(wall * steps, sizeof(cost), cost);
  printf("  time step: %.3g s, about %.0f steps\n", (double)dt, (double)steps);
  printf("  cost:     %.3g ms a step, about %s in all on this machine, output not counted\n", 1e3 * (double)wall, cost);
  PetscFunctionReturn(PETSC_SUCCESS);
}
