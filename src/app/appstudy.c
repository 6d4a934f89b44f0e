/*
  appstudy.c - `frond study NAME SCENE ...`: hands over to the Python program of that study, which runs this command many times.

  A study starts processes that may fail, compares tables and draws: a program for an interpreter, not for the solver's process.
  It lies in share/frond/examples beside the command's bin, installed or in the build folder.
*/
#include "app.h"
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static int refuse(const char what[], const char which[])
{
  fprintf(stderr, "frond: error: %s%s; use frond study substeps SCENE (frond study substeps -h)\n", what, which);
  return APP_EXIT_USER;
}

/* Does not return when the study starts; otherwise the exit code. */
int AppStudy(int argc, char **argv)
{
  char self[PETSC_MAX_PATH_LEN], script[PETSC_MAX_PATH_LEN + 64], *slash;
  const char *python = getenv("FROND_PYTHON");
  const ssize_t n = readlink("/proc/self/exe", self, sizeof(self) - 1);
  char **args;
  int k = 0;

  if (argc < 3) return refuse("study needs a name", "");
  if (strcmp(argv[2], "substeps")) return refuse("there is no study ", argv[2]);
  if (n <= 0) return refuse("cannot find the folder of this command", "");
  self[n] = 0;
  snprintf(script, sizeof(script), "%s", self);
  for (int up = 0; up < 2; up++)
    if ((slash = strrchr(script, '/'))) *slash = 0;
  snprintf(script + strlen(script), sizeof(script) - strlen(script), "/share/frond/examples/study_substeps.py");
  if (access(script, R_OK)) return refuse("cannot read ", script);
  if (!python) python = access("/usr/bin/python3", X_OK) ? "python3" : "/usr/bin/python3";
  args = malloc(((size_t)argc + 4) * sizeof(char *));
  if (!args) return APP_EXIT_USER;
  args[k++] = (char *)python;
  args[k++] = script;
  args[k++] = (char *)"--frond";
  args[k++] = self;
  for (int i = 3; i < argc; i++) args[k++] = argv[i];
  args[k] = NULL;
  execvp(python, args);
  free(args);
  return refuse("cannot start the Python interpreter ", python);
}
