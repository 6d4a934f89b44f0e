/*
  sphcell.h - the cell grid of the neighbour search: cells of edge >= 2h (1 + skin), numbered with x fastest.

  Within a cell fluid markers come before boundary markers: sort key = 2 cell + (boundary ? 1 : 0). Markers that left the
  domain have the key 2 ncell and stand behind all others. Index arithmetic is shared with the device.
*/
#ifndef SPHCELL_H
#define SPHCELL_H

typedef struct {
  double lo[3];     /* origin, m */
  double edge[3];   /* cell edges, m */
  double length[3]; /* period along periodic axes, m, else 0 */
  int n[3];         /* cells per axis */
  int periodic[3];
} SphGrid;

#if defined(__CUDACC__)
  #define SPH_CELL_INLINE static __host__ __device__ __forceinline__
#else
  #define SPH_CELL_INLINE static inline
#endif

/* Cell coordinate along axis k of position x; clamped on open axes, wrapped on periodic ones. */
SPH_CELL_INLINE int sph_cell_coord(const SphGrid *g, int k, double x)
{
  int c = (int)floor((x - g->lo[k]) / g->edge[k]);
  if (g->periodic[k]) {
    c %= g->n[k];
    if (c < 0) c += g->n[k];
  } else {
    if (c < 0) c = 0;
    if (c >= g->n[k]) c = g->n[k] - 1;
  }
  return c;
}

SPH_CELL_INLINE int sph_cell_index(const SphGrid *g, int cx, int cy, int cz)
{
  return (cz * g->n[1] + cy) * g->n[0] + cx;
}

/* Position relative to the centre of cell coordinate c, taking the nearest periodic image: small numbers that keep their digits
 * in float. */
SPH_CELL_INLINE double sph_cell_offset(const SphGrid *g, int k, int c, double x)
{
  double d = x - (g->lo[k] + ((double)c + 0.5) * g->edge[k]);
  if (g->periodic[k]) d -= g->length[k] * rint(d / g->length[k]);
  return d;
}

/* Neighbour coordinate c + o along axis k, or -1 when there is none. */
SPH_CELL_INLINE int sph_cell_neighbour(const SphGrid *g, int k, int c, int o)
{
  int d = c + o;
  if (g->periodic[k]) return d < 0 ? d + g->n[k] : (d >= g->n[k] ? d - g->n[k] : d);
  return d < 0 || d >= g->n[k] ? -1 : d;
}

#endif
