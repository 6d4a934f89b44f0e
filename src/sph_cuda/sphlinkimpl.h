/* sphlinkimpl.h - private: linked boundary groups as the backends see them. */
#ifndef SPHLINKIMPL_H
#define SPHLINKIMPL_H

#include "sphimpl.h"
#include "sphlink.h"
#include "sectionmath.h"

typedef struct {
  int group, nnodes, nsections, n; /* n markers */
  int nstate, nload;
  int *rowstart, *node, *section; /* as in SphLinkSpec */
  double *shape, *slope, *offset; /* slope: NULL without */
  PetscBool set;                  /* state has been given */
  double *state;                  /* the last one, nstate */
  /* of the last state; host backends only */
  FrondSection *frame;  /* nsections */
  double *x, *v, *a;    /* n x 3 */
  double *f, *o, *sums; /* n x 3; n x 3; nsections x SECTION_SUMS */
} SphLink;

struct _SphLinks {
  int n, cap;
  SphLink *link;
  int *of, nof; /* link of a group (-1: none), for groups up to the last linked one */
};

/* Section s of a link in `state`. */
static inline void SphLinkSection(const SphLink *k, int dim, const double *state, int s, FrondSection *out)
{
  const size_t nn = 3 * (size_t)k->nnodes;
  const int r = k->nnodes ? k->rowstart[s] : 0;

  if (!k->nnodes)
    section_from_body(state, out);
  else
    section_from_nodes(dim, k->rowstart[s + 1] - r, k->node + r, k->shape + r, k->slope ? k->slope + r : NULL, state, state + nn,
                       state + 2 * nn, k->slope ? state + 3 * nn + 3 * (size_t)s : NULL, out);
}

#endif
