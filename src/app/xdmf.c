/*
  xdmf.c - run.xdmf, the index by which ParaView opens the frames: at each time the markers as points, every beam's
  centre line as a polyline, the bodies as points, and every grid. The file is written anew beside the old one and then put in
  its place, so that a killed run leaves a whole file.
*/
#include "app.h"
#include <errno.h>
#include <string.h>
#include <unistd.h>

typedef struct {
  const char *name, *type, *number; /* dataset, Scalar or Vector, number type */
  int precision, cols;
} XdmfField;

static const XdmfField marker_fields[FIELD_COUNT] = {
    {"velocity", "Vector", "Float", 4, 3}, {"density", "Scalar", "Float", 4, 1},      {"pressure", "Scalar", "Float", 4, 1},
    {"group", "Scalar", "Int", 4, 1},      {"acceleration", "Vector", "Float", 4, 3},
};
static const XdmfField beam_fields[] = {
    {"velocity", "Vector", "Float", 8, 3},    {"stretch", "Scalar", "Float", 8, 1},   {"coordinate", "Scalar", "Float", 8, 1},
    {"axial_force", "Scalar", "Float", 8, 1}, {"curvature", "Vector", "Float", 8, 3}, {"moment", "Vector", "Float", 8, 3},
};
static const XdmfField body_fields[] = {
    {"velocity", "Vector", "Float", 8, 3},
    {"omega", "Vector", "Float", 8, 3},
};

void AppFrameName(PetscInt frame, size_t len, char name[])
{
  snprintf(name, len, "frame_%05d.h5", (int)frame);
}

static void item(FILE *f, const char frame[], const char group[], const XdmfField *field, PetscInt rows)
{
  fprintf(f, "<DataItem Format=\"HDF\" NumberType=\"%s\" Precision=\"%d\" Dimensions=\"%d", field->number, field->precision,
          (int)rows);
  if (field->cols > 1) fprintf(f, " %d", field->cols);
  fprintf(f, "\">%s:/%s/%s</DataItem>", frame, group, field->name);
}

static void grid(FILE *f, const char frame[], const char group[], const char name[], PetscBool line, PetscInt n, PetscInt nfields,
                 const XdmfField *fields, const PetscBool *wanted)
{
  const XdmfField position = {"position", "Vector", "Float", 8, 3}, index = {"index", "Scalar", "Int", 4, 1};

  fprintf(f, "   <Grid Name=\"%s\" GridType=\"Uniform\">\n    ", name);
  if (line)
    fprintf(f, "<Topology TopologyType=\"Polyline\" NumberOfElements=\"1\" NodesPerElement=\"%d\">", (int)n);
  else
    fprintf(f, "<Topology TopologyType=\"Polyvertex\" NumberOfElements=\"%d\" NodesPerElement=\"1\">", (int)n);
  item(f, frame, group, &index, n);
  fprintf(f, "</Topology>\n    <Geometry GeometryType=\"XYZ\">");
  item(f, frame, group, &position, n);
  fprintf(f, "</Geometry>\n");
  for (PetscInt i = 0; i < nfields; i++) {
    if (wanted && !wanted[i]) continue;
    fprintf(f, "    <Attribute Name=\"%s\" AttributeType=\"%s\" Center=\"Node\">", fields[i].name, fields[i].type);
    item(f, frame, group, &fields[i], n);
    fprintf(f, "</Attribute>\n");
  }
  fprintf(f, "   </Grid>\n");
}

/* A regular grid of points: a structured block that ParaView can contour, slice and draw glyphs on. */
static void regular(FILE *f, const char frame[], const SceneGrid *g)
{
  static const char *const fields[] = {"velocity", "pressure", "density", "fraction"};
  const int n[3] = {(int)g->n[2], (int)g->n[1], (int)g->n[0]};

  fprintf(f,
          "   <Grid Name=\"%s\" GridType=\"Uniform\">\n    <Topology TopologyType=\"3DCORECTMesh\" Dimensions=\"%d %d %d\"/>\n",
          g->name, n[0], n[1], n[2]);
  fprintf(f,
          "    <Geometry GeometryType=\"ORIGIN_DXDYDZ\"><DataItem Format=\"XML\" Dimensions=\"3\">%.15g %.15g %.15g</DataItem>",
          (double)g->lo[2], (double)g->lo[1], (double)g->lo[0]);
  fprintf(f, "<DataItem Format=\"XML\" Dimensions=\"3\">%.15g %.15g %.15g</DataItem></Geometry>\n", (double)AppGridStep(g, 2),
          (double)AppGridStep(g, 1), (double)AppGridStep(g, 0));
  for (int i = 0; i < 4; i++)
    fprintf(f,
            "    <Attribute Name=\"%s\" AttributeType=\"%s\" Center=\"Node\"><DataItem Format=\"HDF\" NumberType=\"Float\" "
            "Precision=\"4\" Dimensions=\"%d %d %d%s\">%s:/grids/%s/%s</DataItem></Attribute>\n",
            fields[i], i ? "Scalar" : "Vector", n[0], n[1], n[2], i ? "" : " 3", frame, g->name, fields[i]);
  fprintf(f, "   </Grid>\n");
}

/* Write run.xdmf in dir for all frames so far. */
PetscErrorCode AppXdmfWrite(const char dir[], const XdmfSeries *series)
{
  const App *app = series->app;
  char path[PETSC_MAX_PATH_LEN + 32], tmp[PETSC_MAX_PATH_LEN + 40], frame[32], group[APP_NAME_LEN + 16];
  FILE *f;
  int bad;

  PetscFunctionBegin;
  snprintf(path, sizeof(path), "%s/run.xdmf", dir);
  snprintf(tmp, sizeof(tmp), "%s.part", path);
  f = fopen(tmp, "w");
  PetscCheck(f, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "cannot write '%s': %s", tmp, strerror(errno));
  fprintf(f,
          "<?xml version=\"1.0\" ?>\n<Xdmf Version=\"2.0\">\n <Domain>\n <Grid Name=\"%s\" GridType=\"Collection\" "
          "CollectionType=\"Temporal\">\n",
          app->scene.name);
  for (PetscInt k = series->first; k < series->nframes; k++) {
    AppFrameName(k, sizeof(frame), frame);
    fprintf(f, "  <Grid Name=\"frame_%d\" GridType=\"Collection\" CollectionType=\"Spatial\">\n   <Time Value=\"%.15g\"/>\n",
            (int)k, (double)series->time[k]);
    if (app->sph)
      grid(f, frame, "markers", "markers", PETSC_FALSE, app->nfluid + app->nboundary, FIELD_COUNT, marker_fields,
           app->scene.field);
    for (PetscInt b = 0; b < app->scene.nbeams; b++) {
      snprintf(group, sizeof(group), "beams/%s/line", app->scene.beams[b].name);
      grid(f, frame, group, app->scene.beams[b].name, PETSC_TRUE, series->points[b], sizeof(beam_fields) / sizeof(beam_fields[0]),
           beam_fields, NULL);
    }
    if (app->rigid) grid(f, frame, "bodies", "bodies", PETSC_FALSE, app->scene.nbodies, 2, body_fields, NULL);
    for (PetscInt i = 0; i < app->scene.ngrids; i++) regular(f, frame, &app->scene.grids[i]);
    fprintf(f, "  </Grid>\n");
  }
  fprintf(f, " </Grid>\n </Domain>\n</Xdmf>\n");
  bad = ferror(f);
  bad |= fflush(f);
  bad |= fsync(fileno(f));
  bad |= fclose(f);
  PetscCheck(!bad && !rename(tmp, path), PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "cannot write '%s': %s", path, strerror(errno));
  PetscFunctionReturn(PETSC_SUCCESS);
}
