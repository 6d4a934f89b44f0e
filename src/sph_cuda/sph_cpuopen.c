/* sph_cpuopen.c - linear fits to the fluid at points, from the cells of the CPU backend; for the zones of openings. */
#include <math.h>
typedef double sphreal;
#include "sph_cpu.h"
#include "sphsearch.h"

/* Sums over the markers of a group, fluid or zone, within 2h of x. */
static void SumAround(Sph sph, const SphCpu *cpu, const double x[3], int group, SphPointSums *sums)
{
  const SphGrid *g = &cpu->grid;
  const SphParams *p = &sph->par;
  int c[3] = {0, 0, 0};

  memset(sums, 0, sizeof(*sums));
  for (int k = 0; k < p->dim; k++) c[k] = sph_cell_coord(g, k, x[k]);
  for (int o = 0; o < (p->dim == 3 ? 27 : 9); o++) {
    const int nx = sph_cell_neighbour(g, 0, c[0], o % 3 - 1), ny = sph_cell_neighbour(g, 1, c[1], o / 3 % 3 - 1);
    const int nz = p->dim == 3 ? sph_cell_neighbour(g, 2, c[2], o / 9 - 1) : 0;
    if (nx < 0 || ny < 0 || nz < 0) continue;
    const int *range = cpu->cellstart + 2 * sph_cell_index(g, nx, ny, nz);
    for (int j = range[0]; j < range[1]; j++) {
      double d[3] = {0.0, 0.0, 0.0};
      if (sph->group[j] != group) continue;
      for (int k = 0; k < p->dim; k++) {
        d[k] = sph->st.x[k][j] - x[k];
        if (g->periodic[k]) d[k] -= g->length[k] * rint(d[k] / g->length[k]);
        d[k] /= p->h;
      }
      if (d[0] * d[0] + d[1] * d[1] + d[2] * d[2] >= 4.0) continue;
      SphPointAdd(p, sph->m[j] / (p->rho0 * (1.0 + sph->st.s[j])),
                  (const double[3]){sph->st.v[0][j], sph->st.v[1][j], sph->st.v[2][j]}, sph->st.s[j], d, sums);
    }
  }
}

PetscErrorCode SphFit_CPU(Sph sph, PetscInt n, const double *at, const double *offset, const int *group, double *value, int *near)
{
  const SphCpu *cpu = (const SphCpu *)sph->data;
  const double h = sph->par.h;

  PetscFunctionBegin;
#pragma omp parallel for schedule(dynamic, 16)
  for (PetscInt j = 0; j < n; j++) {
    const double u[3] = {offset[3 * j] / h, offset[3 * j + 1] / h, offset[3 * j + 2] / h};
    SphPointSums sums;
    SumAround(sph, cpu, at + 3 * j, group ? group[j] : -1, &sums);
    near[j] = SphPointValues(&sums, (int)sph->par.dim, 1, value + 10 * j) >= 0;
    (void)SphPointValuesAt(&sums, (int)sph->par.dim, 1, u, value + 10 * j + 5);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
