/*
  appfluid.c - the fluid markers of a scene: a lattice in the fluid box less the sites that structures hold.

  Structures and their periodic images are sorted into a grid of bins by their bounding boxes, so that a site looks only
  at the few that can hold it.
*/
#include "app.h"
#include "sphfill.h"
#include "sphopen.h"
#include <unistd.h>

#define BINS_MAX 64 /* along an axis */
#define BYTES_PER_MARKER 200.0

/* A beam (number < nbeams) or a body (number - nbeams), displaced to one of its periodic images. */
typedef struct {
  PetscInt number;
  PetscReal shift[3]; /* m, of the structure */
} Image;

typedef struct {
  const App *app;
  PetscReal (*X)[3], (*R)[9]; /* centre (m) and rotation of each body */
  Image *image;
  PetscInt nimages, aimages;
  PetscInt bins[3], *start, *list; /* images of bin b: list[start[b]] ... list[start[b + 1] - 1] */
  PetscReal slack, at[3], far;     /* m: where a region ends; the last site asked for and its distance from the surface */
} Carve;

/*
  An arc turns by `turn` about the normal, over its chord: about its centre, points of its plane are (sin, -cos)/curvature of the
  angle from the middle.
*/
static PetscBool inside_arc(const AncfBeamSpec *spec, PetscInt dim, const PetscReal x[3])
{
  const PetscReal k = spec->curvature, *n = spec->normal, size = PetscSqrtReal(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  PetscReal chord = 0, t[3], half, u = 0, w = 0, z = 0, angle, off;

  for (int a = 0; a < 3; a++) {
    t[a] = spec->end[a] - spec->start[a];
    chord += t[a] * t[a];
  }
  chord = PetscSqrtReal(chord);
  half = PetscAsinReal(k * chord / 2);
  for (PetscInt a = 0; a < dim; a++) {
    const PetscReal d = x[a] - spec->start[a], side = (n[(a + 1) % 3] * t[(a + 2) % 3] - n[(a + 2) % 3] * t[(a + 1) % 3]);

    u += d * t[a] / chord;
    w += d * side / (chord * size);
    z += d * n[a] / size;
  }
  u -= PetscSinReal(half) / k;
  w -= PetscCosReal(half) / k;
  angle = PetscAtan2Real(k * u, -k * w);
  off = PetscSqrtReal(u * u + w * w) - 1 / PetscAbsReal(k);
  return (PetscBool)(PetscAbsReal(angle) <= PetscAbsReal(half) && off * off + z * z < PetscSqr(spec->diameter / 2));
}

#define CURVE_PARTS 16 /* straight parts of an element: off by (l kappa)^2/2048 of its length l */

/* A curve of elements, as a tube around straight parts and the wedges between them; beyond its flat ends it is outside. */
static PetscBool inside_curve(const AncfBeamSpec *spec, PetscInt dim, const PetscReal x[3])
{
  const PetscInt n = CURVE_PARTS * spec->elements;
  PetscReal a[6], b[6], before = 0;

  if (AncfBeamSpecGetPoint(spec, 0, b)) return PETSC_FALSE;
  for (PetscInt k = 0; k < n; k++) {
    PetscReal s = 0, h2 = 0, r2 = 0, part;

    for (int c = 0; c < 6; c++) a[c] = b[c];
    if (AncfBeamSpecGetPoint(spec, (PetscReal)(k + 1) / (PetscReal)n, b)) return PETSC_FALSE;
    for (PetscInt c = 0; c < dim; c++) {
      s += (x[c] - a[c]) * (b[c] - a[c]);
      h2 += PetscSqr(b[c] - a[c]);
    }
    s /= h2;
    part = PetscMax(0, s);
    for (PetscInt c = 0; c < dim; c++) r2 += PetscSqr(x[c] - a[c] - part * (b[c] - a[c]));
    if (s <= 1 && (s >= 0 || before > 1) && r2 < PetscSqr(spec->diameter / 2)) return PETSC_TRUE;
    before = s;
  }
  return PETSC_FALSE;
}

/* How far the axis reaches beyond the box of its ends, m: the rise of an arc over its chord; the length of a curve is enough. */
static PetscReal rise_of(const AncfBeamSpec *spec)
{
  PetscReal chord2 = 0;

  for (int a = 0; a < 3; a++) chord2 += PetscSqr(spec->end[a] - spec->start[a]);
  if (spec->curve) return spec->curvelength;
  if (spec->curvature == 0) return 0;
  return (1 - PetscSqrtReal(PetscMax(0, 1 - PetscSqr(spec->curvature) * chord2 / 4))) / PetscAbsReal(spec->curvature);
}

static PetscBool inside_beam(const AncfBeamSpec *spec, PetscInt dim, const PetscReal x[3])
{
  PetscReal L2 = 0, s = 0, r2 = 0, t[3];

  if (spec->curve) return inside_curve(spec, dim, x);
  if (spec->curvature != 0) return inside_arc(spec, dim, x);
  for (PetscInt a = 0; a < dim; a++) {
    t[a] = spec->end[a] - spec->start[a];
    L2 += t[a] * t[a];
    s += t[a] * (x[a] - spec->start[a]);
  }
  s /= L2;
  if (s < 0 || s > 1) return PETSC_FALSE;
  for (PetscInt a = 0; a < dim; a++) r2 += PetscSqr(x[a] - spec->start[a] - s * t[a]);
  return (PetscBool)(r2 < PetscSqr(spec->diameter / 2));
}

static PetscBool inside_body(const Carve *c, PetscInt body, const PetscReal x[3])
{
  const PetscReal *X = c->X[body], *R = c->R[body];
  PetscReal d[3], xb[3];

  for (int a = 0; a < 3; a++) d[a] = (a < c->app->dim) ? x[a] - X[a] : 0;
  for (int a = 0; a < 3; a++) xb[a] = R[a] * d[0] + R[3 + a] * d[1] + R[6 + a] * d[2];
  return (PetscBool)(RigidShapeDistance(&c->app->scene.bodies[body].spec, xb) < 0);
}

static PetscInt bin_of(const Carve *c, PetscInt a, PetscReal x)
{
  const AppScene *s = &c->app->scene;
  const PetscReal at = (x - s->fluidlo[a]) / (s->fluidhi[a] - s->fluidlo[a]) * (PetscReal)c->bins[a];

  return at < 0 ? 0 : at >= (PetscReal)c->bins[a] ? c->bins[a] - 1 : (PetscInt)at;
}

/* Whether a site lies in the regions and in the fluid box; near the last site asked for that needs no new distance. */
static PetscBool inside_regions(Carve *c, const PetscReal x[3])
{
  const AppScene *s = &c->app->scene;
  PetscReal d2 = 0, wall;
  PetscInt nearest;

  for (PetscInt a = 0; a < c->app->dim; a++) {
    if (x[a] < s->fluidlo[a] - c->slack || x[a] > s->fluidhi[a] + c->slack) return PETSC_FALSE;
    d2 += PetscSqr(x[a] - c->at[a]);
  }
  if (PetscSqrtReal(d2) < PetscAbsReal(c->far) - 2 * c->slack) return (PetscBool)(c->far < 0);
  AppRegionDistance(c->app, x, &c->far, &wall, &nearest);
  for (int a = 0; a < 3; a++) c->at[a] = x[a];
  return (PetscBool)(c->far <= c->slack);
}

/* A lattice site is fluid when it lies in the regions, if there are any, and no structure, nor a periodic image of one, holds it.
 */
static PetscBool keep_site(const PetscReal x[3], void *ctx)
{
  Carve *c = ctx;
  const AppScene *s = &c->app->scene;
  PetscInt b = 0;
  PetscBool open;

  if (s->nregions && !inside_regions(c, x)) return PETSC_FALSE;
  if (s->nopenings && !SphInOpening(c->app->sph, x, &open) && open) return PETSC_FALSE;
  for (PetscInt a = c->app->dim - 1; a >= 0; a--) b = b * c->bins[a] + bin_of(c, a, x[a]);
  for (PetscInt k = c->start[b]; k < c->start[b + 1]; k++) {
    const Image *image = &c->image[c->list[k]];
    const PetscReal y[3] = {x[0] - image->shift[0], x[1] - image->shift[1], x[2] - image->shift[2]};
    if (image->number < s->nbeams) {
      if (inside_beam(&s->beams[image->number].spec, c->app->dim, y)) return PETSC_FALSE;
    } else if (inside_body(c, image->number - s->nbeams, y))
      return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Half the extent of a body along any direction, m; infinite where the shape does not tell. */
static PetscReal reach_of(const RigidBodySpec *spec)
{
  const PetscReal *a = spec->size;

  switch (spec->shape) {
  case RIGID_SPHERE:
    return a[0];
  case RIGID_BOX:
    return PetscSqrtReal(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]) / 2;
  case RIGID_CYLINDER:
    return PetscSqrtReal(a[0] * a[0] + a[1] * a[1] / 4);
  case RIGID_ELLIPSOID:
    return PetscMax(a[0], PetscMax(a[1], a[2]));
  case RIGID_CAPSULE:
    return a[0] + a[1] / 2;
  default:
    return PETSC_MAX_REAL;
  }
}

/* Bounding box of an image, m. */
static void bounds(const Carve *c, const Image *image, PetscReal lo[3], PetscReal hi[3])
{
  const AppScene *s = &c->app->scene;

  for (PetscInt a = 0; a < 3; a++) {
    if (image->number < s->nbeams) {
      const AncfBeamSpec *spec = &s->beams[image->number].spec;
      const PetscReal reach = spec->diameter / 2 + rise_of(spec);
      lo[a] = PetscMin(spec->start[a], spec->end[a]) - reach + image->shift[a];
      hi[a] = PetscMax(spec->start[a], spec->end[a]) + reach + image->shift[a];
    } else {
      const PetscInt body = image->number - s->nbeams;
      const PetscReal reach = reach_of(&s->bodies[body].spec);
      lo[a] = c->X[body][a] - reach + image->shift[a];
      hi[a] = c->X[body][a] + reach + image->shift[a];
    }
  }
}

static PetscErrorCode add_image(Carve *c, PetscInt number, const PetscReal shift[3])
{
  const AppScene *s = &c->app->scene;
  Image image = {number, {shift[0], shift[1], shift[2]}};
  PetscReal lo[3], hi[3];

  PetscFunctionBegin;
  bounds(c, &image, lo, hi);
  for (PetscInt a = 0; a < c->app->dim; a++)
    if (hi[a] < s->fluidlo[a] || lo[a] > s->fluidhi[a]) PetscFunctionReturn(PETSC_SUCCESS);
  if (c->nimages == c->aimages) {
    c->aimages = 2 * c->aimages + 64;
    PetscCall(PetscRealloc((size_t)c->aimages * sizeof(Image), &c->image));
  }
  c->image[c->nimages++] = image;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Images of every structure that reach the fluid box. */
static PetscErrorCode find_images(Carve *c)
{
  const AppScene *s = &c->app->scene;
  PetscInt n[3];

  PetscFunctionBegin;
  for (int a = 0; a < 3; a++) n[a] = (a < c->app->dim && s->periodic[a]) ? 1 : 0;
  for (PetscInt number = 0; number < s->nbeams + s->nbodies; number++)
    for (PetscInt i = -n[0]; i <= n[0]; i++)
      for (PetscInt j = -n[1]; j <= n[1]; j++)
        for (PetscInt k = -n[2]; k <= n[2]; k++) {
          const PetscReal shift[3] = {(PetscReal)i * (s->hi[0] - s->lo[0]), (PetscReal)j * (s->hi[1] - s->lo[1]),
                                      (PetscReal)k * (s->hi[2] - s->lo[2])};
          PetscCall(add_image(c, number, shift));
        }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Count (list NULL) or enter each image in the bins that its bounding box meets. */
static void sweep_images(const Carve *c, PetscInt *count, PetscInt *list)
{
  for (PetscInt i = 0; i < c->nimages; i++) {
    PetscReal lo[3], hi[3];
    PetscInt b0[3] = {0, 0, 0}, b1[3] = {0, 0, 0};
    bounds(c, &c->image[i], lo, hi);
    for (PetscInt a = 0; a < c->app->dim; a++) {
      b0[a] = bin_of(c, a, lo[a]);
      b1[a] = bin_of(c, a, hi[a]);
    }
    for (PetscInt z = b0[2]; z <= b1[2]; z++)
      for (PetscInt y = b0[1]; y <= b1[1]; y++)
        for (PetscInt x = b0[0]; x <= b1[0]; x++) {
          PetscInt *at = &count[(z * c->bins[1] + y) * c->bins[0] + x];
          if (list) list[*at] = i;
          (*at)++;
        }
  }
}

static PetscErrorCode carve_create(const App *app, PetscReal dp, Carve *c)
{
  const AppScene *s = &app->scene;
  PetscInt n = 1, *next, sum = 0;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(c, sizeof(*c)));
  c->app = app;
  c->slack = SPH_FILL_SLACK * dp;
  PetscCall(PetscMalloc2(s->nbodies, &c->X, s->nbodies, &c->R));
  for (PetscInt b = 0; b < s->nbodies; b++) {
    PetscReal q[4];
    PetscCall(RigidGetState(app->rigid, b, c->X[b], q, NULL, NULL));
    RigidRotationMatrix(q, c->R[b]);
  }
  for (PetscInt a = 0; a < 3; a++) {
    const PetscReal wide = (s->fluidhi[a] - s->fluidlo[a]) / (4 * dp);
    c->bins[a] = a >= app->dim || wide < 1 ? 1 : wide > BINS_MAX ? BINS_MAX : (PetscInt)wide;
    n *= c->bins[a];
  }
  PetscCall(find_images(c));
  PetscCall(PetscCalloc1(n + 1, &c->start));
  PetscCall(PetscCalloc1(n + 1, &next));
  sweep_images(c, next, NULL);
  for (PetscInt b = 0; b <= n; b++) {
    c->start[b] = sum;
    sum += next[b];
    next[b] = c->start[b];
  }
  PetscCall(PetscMalloc1(sum, &c->list));
  sweep_images(c, next, c->list);
  PetscCall(PetscFree(next));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode carve_destroy(Carve *c)
{
  PetscFunctionBegin;
  PetscCall(PetscFree2(c->X, c->R));
  PetscCall(PetscFree(c->image));
  PetscCall(PetscFree(c->start));
  PetscCall(PetscFree(c->list));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Depth below the top of the fluid box along gravity times |g|, m^2/s^2. */
static PetscReal head(const AppScene *s, PetscInt dim, const PetscReal x[3])
{
  PetscReal sum = 0;

  for (PetscInt a = 0; a < dim; a++) sum += s->gravity[a] * (x[a] - (s->gravity[a] > 0 ? s->fluidlo[a] : s->fluidhi[a]));
  return sum;
}

/* Pressure at first, Pa. */
PetscReal AppFluidPressure(const App *app, const PetscReal x[3])
{
  PetscReal rho;

  if (app->scene.pressure != PRESSURE_HYDROSTATIC || SphGetDensity(app->sph, &rho)) return 0;
  return rho * head(&app->scene, app->dim, x);
}

/* Before any memory is taken: so many sites must be numbers that PetscInt holds, and must fit into this machine. */
static PetscErrorCode check_size(const App *app, PetscReal dp)
{
  const AppScene *s = &app->scene;
  const PetscReal memory = (PetscReal)sysconf(_SC_PHYS_PAGES) * (PetscReal)sysconf(_SC_PAGESIZE);
  PetscReal sites = 1;

  PetscFunctionBegin;
  for (PetscInt a = 0; a < app->dim; a++) sites *= PetscMax((PetscReal)1, (s->fluidhi[a] - s->fluidlo[a]) / dp);
  PetscCheck(3 * sites < (PetscReal)PETSC_MAX_INT && sites < 7e8, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "sph_dp = %g m puts about %.2g markers into the fluid box; this build takes fewer than 7e8", (double)dp,
             (double)sites);
  PetscCheck(BYTES_PER_MARKER * sites < memory || memory <= 0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "sph_dp = %g m puts about %.2g markers into the fluid box, which need about %.2g GB; this machine has %.2g GB",
             (double)dp, (double)sites, (double)(BYTES_PER_MARKER * sites * 1e-9), (double)(memory * 1e-9));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A periodic axis must be a whole number of spacings long, else its lattice does not close. */
static PetscErrorCode check_lattice(const App *app, PetscReal dp)
{
  const AppScene *s = &app->scene;

  PetscFunctionBegin;
  for (PetscInt a = 0; a < app->dim; a++) {
    const PetscReal length = s->fluidhi[a] - s->fluidlo[a],
                    sites = PetscMax((PetscReal)1, PetscFloorReal(length / dp + (PetscReal)0.5));
    const PetscBool whole = (PetscBool)(PetscAbsReal(length / dp - sites) < 1e-5 * sites);
    PetscCheck(whole || !s->periodic[a] || length < s->hi[a] - s->lo[a], PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "the periodic axis %c is %g m long, which is not a whole number of sph_dp = %g m (%" PetscInt_FMT
               " of %.10g m would fit)",
               "xyz"[a], (double)length, (double)dp, (PetscInt)sites, (double)(length / sites));
    if (!whole && s->wall[2 * a] && s->wall[2 * a + 1])
      fprintf(stderr,
              "frond: warning: the fluid is %g m long along %c, not a whole number of sph_dp = %g m: a gap of %.3g m at the wall "
              "(below 0: an overlap)\n",
              (double)length, "xyz"[a], (double)dp, (double)(length - sites * dp));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The box whose lattice the fluid takes: the fluid box; with regions, whose walls share it, a part of the domain's lattice. */
static void lattice_box(const App *app, PetscReal dp, PetscReal lo[3], PetscReal hi[3])
{
  const AppScene *s = &app->scene;

  for (int a = 0; a < 3; a++) {
    const PetscReal first = PetscFloorReal((s->fluidlo[a] - s->lo[a]) / dp + SPH_FILL_SLACK),
                    last = PetscCeilReal((s->fluidhi[a] - s->lo[a]) / dp - SPH_FILL_SLACK);
    lo[a] = s->nregions ? s->lo[a] + first * dp : s->fluidlo[a];
    hi[a] = s->nregions ? s->lo[a] + last * dp : s->fluidhi[a];
  }
}

/* Give app->sph its fluid markers. */
PetscErrorCode AppFluidFill(App *app)
{
  AppScene *s = &app->scene;
  PetscReal dp, lo[3], hi[3], *x = NULL, *v = NULL, *p = NULL;
  PetscInt n = 0;
  Carve c;

  PetscFunctionBegin;
  PetscCall(SphGetSpacing(app->sph, &dp));
  PetscCall(check_size(app, dp));
  PetscCall(carve_create(app, dp, &c));
  lattice_box(app, dp, lo, hi);
  PetscCall(SphFillBox(app->dim, dp, lo, hi, keep_site, &c, &n, &x));
  PetscCall(carve_destroy(&c));
  PetscCheck(n > 0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "the domain has no fluid: no marker of spacing sph_dp = %g m fits into the fluid box outside the structures",
             (double)dp);
  PetscCall(check_lattice(app, dp));
  PetscCall(PetscMalloc2(3 * (size_t)n, &v, n, &p));
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(PetscArraycpy(v + 3 * i, s->fluidvelocity, 3));
    p[i] = AppFluidPressure(app, x + 3 * i);
  }
  PetscCall(SphAddFluid(app->sph, n, x, v, p));
  app->nfluid = n;
  PetscCall(PetscFree2(v, p));
  PetscCall(PetscFree(x));
  PetscFunctionReturn(PETSC_SUCCESS);
}
