/*
  sph_cudalink.cu - linked boundary groups on the device: markers from states, generalised forces from markers.

  Sums run over fixed pieces in a fixed order: markers of a section in chunks, chunks of a section, sections of a node, sections
  of a structure. No atomics, so the bits do not depend on the device's schedule. Equations: sectionmath.h.
*/
#include "sph_cuda.cuh"

/* Markers to a chunk: about the root of a section's markers, so that no thread adds up many. */
static int ChunkLength(int n)
{
  return PetscMax(32, (int)ceil(sqrt((double)n)));
}

static int SectionOf(const SphLink *k, int i)
{
  return k->nnodes ? k->section[i] : 0;
}

/* First marker of link k behind i that is of another section. */
static int SectionEnd(const SphLink *k, int i)
{
  const int s = SectionOf(k, i);

  while (i < k->n && SectionOf(k, i) == s) i++;
  return i;
}

/* Sizes of the tables. */
void SphCudaLinkCount(Sph sph, SphCudaLinks *l)
{
  *l = SphCudaLinks{};
  for (int g = 0; sph->links && g < sph->links->n; g++) {
    const SphLink *k = &sph->links->link[g];
    l->nlinks++;
    l->nsections += k->nsections;
    l->nnodes += k->nnodes;
    l->nentries += k->nnodes ? k->rowstart[k->nsections] : 0;
    l->nstate += 1 + k->nstate;
    l->nload += k->nload + SECTION_TOTALS;
    for (int i = 0; i < k->n;) {
      const int end = SectionEnd(k, i), length = ChunkLength(end - i);
      l->nchunks += (end - i + length - 1) / length;
      i = end;
    }
  }
}

/* Tables of one link, behind those of the ones before it; `at` counts what is there. */
static void FillSections(const SphLink *k, int g, int b0, SphCudaLinks *h, SphCudaLinks *at)
{
  const int s0 = at->nsections;

  for (int s = 0; s < k->nsections; s++) {
    h->sectionlink[s0 + s] = g;
    h->rowstart[s0 + s] = at->nentries + (k->nnodes ? k->rowstart[s] : 0);
  }
  h->rowstart[s0 + k->nsections] = at->nentries + (k->nnodes ? k->rowstart[k->nsections] : 0);
  for (int i = 0; i < k->n; i++) {
    h->section[b0 + i] = s0 + SectionOf(k, i);
    for (int c = 0; c < 3; c++) h->offset[3 * (size_t)(b0 + i) + c] = k->offset[3 * (size_t)i + c];
  }
  for (int s = 0, i = 0; s < k->nsections; s++) {
    h->chunkstart[s0 + s] = at->nchunks;
    const int end = i < k->n && SectionOf(k, i) == s ? SectionEnd(k, i) : i, length = ChunkLength(end - i);
    for (; i < end; at->nchunks++) {
      h->chunk0[at->nchunks] = b0 + i;
      i = PetscMin(i + length, end);
      h->chunk1[at->nchunks] = b0 + i;
    }
  }
  h->chunkstart[s0 + k->nsections] = at->nchunks;
}

/* Entries, and the same by node: ascending sections. */
static void FillNodes(const SphLink *k, SphCudaLinks *h, SphCudaLinks *at)
{
  const int e0 = at->nentries, ne = k->nnodes ? k->rowstart[k->nsections] : 0;
  int *start = h->nodestart + at->nnodes;

  for (int e = 0; e < ne; e++) {
    h->node[e0 + e] = k->node[e];
    h->shape[e0 + e] = k->shape[e];
    h->slope[e0 + e] = k->slope ? k->slope[e] : 0.0;
  }
  for (int j = 0; j <= k->nnodes; j++) start[j] = e0;
  for (int e = 0; e < ne; e++) start[k->node[e] + 1]++;
  for (int j = 1; j <= k->nnodes; j++) start[j] += start[j - 1] - e0;
  for (int s = 0; s < k->nsections && k->nnodes; s++)
    for (int e = k->rowstart[s]; e < k->rowstart[s + 1]; e++) {
      const int j = start[k->node[e]]++;
      h->byentry[j] = e0 + e;
      h->bysection[j] = at->nsections + s;
    }
  for (int j = k->nnodes; j > 0; j--) start[j] = start[j - 1];
  start[0] = e0;
  for (int j = 0; j < k->nnodes; j++) h->nodeload[at->nnodes + j] = at->nload + 3 * j;
}

/* All tables, in host memory laid out as on the device; section and offset for every boundary marker. */
static PetscErrorCode Fill(Sph sph, SphCudaLinks *h)
{
  SphCudaLinks at = {};

  PetscFunctionBegin;
  for (PetscInt b = 0; b < sph->n - sph->nfluid; b++) h->section[b] = -1;
  for (int g = 0; g < sph->links->n; g++) {
    const SphLink *k = &sph->links->link[g];
    const int b0 = (int)(sph->groupstart[k->group] - sph->nfluid);
    h->link[g] = SphCudaLinkInfo{
        k->nnodes, k->slope ? 1 : 0, at.nstate, at.nload, k->nload, at.nsections, at.nsections + k->nsections, b0, b0 + k->n};
    FillSections(k, g, b0, h, &at);
    FillNodes(k, h, &at);
    at.nsections += k->nsections;
    at.nentries += k->nnodes ? k->rowstart[k->nsections] : 0;
    at.nnodes += k->nnodes;
    at.nstate += 1 + k->nstate;
    at.nload += k->nload + SECTION_TOTALS;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The arrays of l: the constant tables first, then those that live on the device only. */
int SphCudaLinkTables(SphCudaLinks *l, PetscInt nb, SphCudaTable *t)
{
  const size_t ns = (size_t)l->nsections, ne = (size_t)l->nentries, nc = (size_t)l->nchunks, nn = (size_t)l->nnodes;
  const SphCudaTable all[SPH_LINKTABLES] = {{(void **)&l->link, (size_t)l->nlinks * sizeof(*l->link)},
                                            {(void **)&l->sectionlink, ns * sizeof(int)},
                                            {(void **)&l->rowstart, (ns + 1) * sizeof(int)},
                                            {(void **)&l->section, (size_t)nb * sizeof(int)},
                                            {(void **)&l->offset, 3 * (size_t)nb * sizeof(double)},
                                            {(void **)&l->chunkstart, (ns + 1) * sizeof(int)},
                                            {(void **)&l->chunk0, nc * sizeof(int)},
                                            {(void **)&l->chunk1, nc * sizeof(int)},
                                            {(void **)&l->node, ne * sizeof(int)},
                                            {(void **)&l->shape, ne * sizeof(double)},
                                            {(void **)&l->slope, ne * sizeof(double)},
                                            {(void **)&l->nodestart, (nn + 1) * sizeof(int)},
                                            {(void **)&l->byentry, ne * sizeof(int)},
                                            {(void **)&l->bysection, ne * sizeof(int)},
                                            {(void **)&l->nodeload, nn * sizeof(int)},
                                            {(void **)&l->state, (size_t)l->nstate * sizeof(double)},
                                            {(void **)&l->frame, ns * sizeof(FrondSection)},
                                            {(void **)&l->chunksums, SECTION_SUMS * nc * sizeof(double)},
                                            {(void **)&l->sums, SECTION_SUMS * ns * sizeof(double)},
                                            {(void **)&l->load, (size_t)l->nload * sizeof(double)}};

  for (int k = 0; k < SPH_LINKTABLES; k++) t[k] = all[k];
  return l->nlinks ? SPH_LINKTABLES : 0;
}

/* The constant tables, to the device arrays that are there; pinned memory for what crosses the bus in every step. */
PetscErrorCode SphCudaLinkSetUp(Sph sph)
{
  SphCuda *cuda = (SphCuda *)sph->data;
  SphCudaLinks host = cuda->links;
  SphCudaTable h[SPH_LINKTABLES], d[SPH_LINKTABLES];

  PetscFunctionBegin;
  if (!SphCudaLinkTables(&cuda->links, cuda->nb, d)) PetscFunctionReturn(PETSC_SUCCESS);
  (void)SphCudaLinkTables(&host, cuda->nb, h);
  SphCallCUDA(cudaMallocHost((void **)&cuda->hstate, (size_t)host.nstate * sizeof(double)));
  SphCallCUDA(cudaMallocHost((void **)&cuda->hload, (size_t)host.nload * sizeof(double)));
  memset(cuda->hstate, 0, (size_t)host.nstate * sizeof(double));
  for (int k = 0; k < SPH_LINKCONSTANTS; k++) PetscCall(PetscCalloc1(PetscMax(h[k].bytes, (size_t)16), (char **)h[k].p));
  PetscCall(Fill(sph, &host));
  for (int k = 0; k < SPH_LINKCONSTANTS; k++)
    SphCallCUDA(cudaMemcpyAsync(*d[k].p, *h[k].p, h[k].bytes, cudaMemcpyHostToDevice, cuda->stream));
  SphCallCUDA(cudaStreamSynchronize(cuda->stream));
  PetscCall(PetscMalloc1(host.nlinks, &cuda->hlink));
  PetscCall(PetscArraycpy(cuda->hlink, host.link, host.nlinks));
  for (int k = 0; k < SPH_LINKCONSTANTS; k++) PetscCall(PetscFree(*h[k].p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Markers may have been moved by others: every state counts as new. The stream is at rest. */
void SphCudaLinkForget(SphCuda *cuda)
{
  for (int g = 0; cuda->hlink && g < cuda->links.nlinks; g++) cuda->hstate[cuda->hlink[g].state] = 0.0;
  cuda->link0 = cuda->link1 = 0;
  cuda->loadcurrent = PETSC_FALSE;
}

static __global__ void SectionKernel(SphCudaLinks l, int dim, int s0, int s1)
{
  const int s = s0 + SPH_ITEM;

  if (s >= s1) return;
  const SphCudaLinkInfo k = l.link[l.sectionlink[s]];
  const double *state = l.state + k.state + 1;
  FrondSection out;
  if (l.state[k.state] == 0.0) return; /* not set yet */
  if (!k.nnodes)
    section_from_body(state, &out);
  else {
    const size_t nn = 3 * (size_t)k.nnodes;
    const int e = l.rowstart[s];
    section_from_nodes(dim, l.rowstart[s + 1] - e, l.node + e, l.shape + e, k.slopes ? l.slope + e : NULL, state, state + nn,
                       state + 2 * nn, state + 3 * nn + 3 * (size_t)(s - k.section0), &out);
  }
  l.frame[s] = out;
}

static __global__ void LinkMotionKernel(SphCudaArrays d, SphCudaLinks l, int dim, int nfluid, int b0, int b1)
{
  const int b = b0 + SPH_ITEM;
  double o[3], x[3], v[3], a[3];

  if (b >= b1 || l.section[b] < 0) return;
  if (l.state[l.link[l.sectionlink[l.section[b]]].state] == 0.0) return;
  const FrondSection *s = &l.frame[l.section[b]];
  const int i = d.slot[nfluid + b];
  section_offset(s, l.offset + 3 * (size_t)b, o);
  section_marker(s, o, x, v, a);
  for (int k = 0; k < 3; k++) { /* a fixed count keeps x, v, a in registers */
    if (k == dim) break;
    d.st.x[k][i] = x[k];
    d.st.v[k][i] = v[k];
    d.ab[k][i] = a[k];
  }
  for (int k = 0; k < 3; k++) d.omega[3 * (size_t)b + k] = s->w[k];
}

static __global__ void ChunkKernel(SphCudaArrays d, SphCudaLinks l, int nfluid)
{
  const int c = SPH_ITEM;
  double sums[SECTION_SUMS];

  if (c >= l.nchunks) return;
  const FrondSection *s = &l.frame[l.section[l.chunk0[c]]];
  for (int k = 0; k < SECTION_SUMS; k++) sums[k] = 0.0;
  for (int b = l.chunk0[c]; b < l.chunk1[c]; b++) {
    const int i = d.slot[nfluid + b];
    double o[3], x[3], v[3], a[3], f[3];
    section_offset(s, l.offset + 3 * (size_t)b, o);
    section_marker(s, o, x, v, a);
    for (int k = 0; k < 3; k++) f[k] = d.m[i] * d.rate.a[k][i];
    section_add_force(o, f, sums);
    section_add_moment_power(x, v, f, sums);
  }
  for (int k = 0; k < SECTION_SUMS; k++) l.chunksums[SECTION_SUMS * (size_t)c + k] = sums[k];
}

static __global__ void SectionSumKernel(SphCudaLinks l)
{
  const int s = SPH_ITEM;
  double sums[SECTION_SUMS];

  if (s >= l.nsections) return;
  for (int k = 0; k < SECTION_SUMS; k++) sums[k] = 0.0;
  for (int c = l.chunkstart[s]; c < l.chunkstart[s + 1]; c++)
    for (int k = 0; k < SECTION_SUMS; k++) sums[k] += l.chunksums[SECTION_SUMS * (size_t)c + k];
  for (int k = 0; k < SECTION_SUMS; k++) l.sums[SECTION_SUMS * (size_t)s + k] = sums[k];
}

static __global__ void NodeKernel(SphCudaLinks l)
{
  const int j = SPH_ITEM;
  double Q[3] = {0.0, 0.0, 0.0};

  if (j >= l.nnodes) return;
  for (int p = l.nodestart[j]; p < l.nodestart[j + 1]; p++) {
    const int s = l.bysection[p], e = l.byentry[p];
    const double *sums = l.sums + SECTION_SUMS * (size_t)s;
    section_add_node(&l.frame[s], l.shape[e], l.slope[e], sums, sums + 3, Q);
  }
  for (int k = 0; k < 3; k++) l.load[l.nodeload[j] + k] = Q[k];
}

static __global__ void TotalKernel(SphCudaLinks l)
{
  const int g = SPH_ITEM;
  double totals[SECTION_TOTALS];

  if (g >= l.nlinks) return;
  const SphCudaLinkInfo k = l.link[g];
  for (int c = 0; c < SECTION_TOTALS; c++) totals[c] = 0.0;
  for (int s = k.section0; s < k.section1; s++) section_add_totals(&l.frame[s], l.sums + SECTION_SUMS * (size_t)s, totals);
  for (int c = 0; c < SECTION_TOTALS; c++) l.load[k.load + k.nload + c] = totals[c];
  for (int c = 0; c < 6 && !k.nnodes; c++) l.load[k.load + c] = l.sums[SECTION_SUMS * (size_t)k.section0 + c];
}

/* Send the states that changed and move their markers. */
PetscErrorCode SphCudaLinkFlush(Sph sph)
{
  SphCuda *cuda = (SphCuda *)sph->data;
  SphCudaLinks *l = &cuda->links;

  PetscFunctionBegin;
  if (cuda->link0 == cuda->link1) PetscFunctionReturn(PETSC_SUCCESS);
  const SphCudaLinkInfo *first = &cuda->hlink[cuda->link0], *last = &cuda->hlink[cuda->link1 - 1];
  const size_t count = (size_t)(last->state + 1 + sph->links->link[cuda->link1 - 1].nstate - first->state);
  int b0 = first->b0, b1 = first->b1;
  for (const SphCudaLinkInfo *k = first; k <= last; k++) {
    b0 = PetscMin(b0, k->b0);
    b1 = PetscMax(b1, k->b1);
  }
  SphCallCUDA(cudaMemcpyAsync(l->state + first->state, cuda->hstate + first->state, count * sizeof(double),
                              cudaMemcpyHostToDevice, cuda->stream));
  SphCallCUDA(cudaEventRecord(cuda->uploaded, cuda->stream));
  cuda->uploading = PETSC_TRUE;
  SphCallCUDA(SphLaunch(cuda->stream, last->section1 - first->section0, SectionKernel, *l, (int)sph->par.dim, first->section0,
                        last->section1));
  SphCallCUDA(SphLaunch(cuda->stream, b1 - b0, LinkMotionKernel, cuda->d, *l, (int)sph->par.dim, (int)sph->nfluid, b0, b1));
  cuda->link0 = cuda->link1 = 0;
  cuda->hostcurrent = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A link that stays as it is, a wall above all, is not sent again. */
PetscErrorCode SphCudaLinkMotion(Sph sph, PetscInt g)
{
  SphCuda *cuda = (SphCuda *)sph->data;
  const SphLink *k = &sph->links->link[g];
  double *h = cuda->hstate + cuda->hlink[g].state;

  PetscFunctionBegin;
  if (h[0] != 0.0 && !memcmp(h + 1, k->state, (size_t)k->nstate * sizeof(double))) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SphCudaAwaitUpload(cuda));
  PetscCall(PetscArraycpy(h + 1, k->state, k->nstate));
  h[0] = 1.0;
  cuda->loadcurrent = PETSC_FALSE;
  if (cuda->link0 == cuda->link1) {
    cuda->link0 = (int)g;
    cuda->link1 = (int)g + 1;
  } else {
    cuda->link0 = PetscMin(cuda->link0, (int)g);
    cuda->link1 = PetscMax(cuda->link1, (int)g + 1);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Generalised forces of all links on their way to the host; the stream goes on meanwhile. */
PetscErrorCode SphCudaLinkReduce(Sph sph)
{
  SphCuda *cuda = (SphCuda *)sph->data;
  const SphCudaLinks *l = &cuda->links;

  PetscFunctionBegin;
  SphCallCUDA(SphLaunch(cuda->stream, l->nchunks, ChunkKernel, cuda->d, *l, (int)sph->nfluid));
  SphCallCUDA(SphLaunch(cuda->stream, l->nsections, SectionSumKernel, *l));
  SphCallCUDA(SphLaunch(cuda->stream, l->nnodes, NodeKernel, *l));
  SphCallCUDA(SphLaunch(cuda->stream, l->nlinks, TotalKernel, *l));
  SphCallCUDA(cudaMemcpyAsync(cuda->hload, l->load, (size_t)l->nload * sizeof(double), cudaMemcpyDeviceToHost, cuda->stream));
  SphCallCUDA(cudaEventRecord(cuda->downloaded, cuda->stream));
  cuda->loadcurrent = PETSC_TRUE;
  cuda->downloading = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphCudaLinkLoad(Sph sph, PetscInt g, PetscReal *load, double *totals)
{
  SphCuda *cuda = (SphCuda *)sph->data;
  const SphCudaLinkInfo *k = &cuda->hlink[g];

  PetscFunctionBegin;
  PetscCall(SphCudaFlushMotion(sph));
  if (!cuda->loadcurrent) PetscCall(SphCudaLinkReduce(sph));
  if (cuda->downloading) SphCallCUDA(cudaEventSynchronize(cuda->downloaded));
  cuda->downloading = PETSC_FALSE;
  PetscCall(PetscArraycpy(load, cuda->hload + k->load, k->nload));
  PetscCall(PetscArraycpy(totals, cuda->hload + k->load + k->nload, SECTION_TOTALS));
  PetscFunctionReturn(PETSC_SUCCESS);
}
