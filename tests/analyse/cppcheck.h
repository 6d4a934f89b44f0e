/* What cppcheck has to know of PETSc's macros: which of them return. */
#define PetscFunctionBegin
#define PetscFunctionReturn(x) return (x)
#define PETSC_SUCCESS 0
#define PetscCall(x)                                                                                                             \
  do {                                                                                                                           \
    int error = (x);                                                                                                             \
    if (error) return error;                                                                                                     \
  } while (0)
#define PetscCheck(c, ...)                                                                                                       \
  do {                                                                                                                           \
    if (!(c)) return 1;                                                                                                          \
  } while (0)
#define SETERRQ(...) return 1
