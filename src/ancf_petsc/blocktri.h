/*
  blocktri.h - PCBLOCKTRI, an exact solver for many independent block-tridiagonal systems ("chains"), registered with PETSc.

  Eight chains are eliminated at a time, one per vector lane; batches of eight are shared out among OpenMP threads. Block LU
  without pivoting across rows: exact for positive definite and diagonally dominant matrices, such as a tangent plus a mass
  matrix over dt^2; elsewhere let a Krylov method or Newton's method correct it.

  Works on any sequential matrix whose block rows couple only to their neighbours, of type (S)BAIJ or AIJ with a block size. A
  matrix that can produce its blocks on the fly gives them through MatBlockTriSetSource(): they are then eliminated in cache
  while being made, and no factor is stored.
*/
#ifndef BLOCKTRI_H
#define BLOCKTRI_H

#include "frondsys.h"
#include <petscpc.h>

/* PETSc type name of the block-tridiagonal solver. */
#define PCBLOCKTRI "blocktri"
/* Chains eliminated at a time. */
#define BLOCKTRI_LANES 8
/* One number of each of 8 chains. */
typedef PetscReal BlockTriLanes __attribute__((vector_size(BLOCKTRI_LANES * sizeof(PetscReal))));

/*
  Blocks of up to 8 chains, chain[i] < 0 for an unused lane: D[row][r][c] and U[row][r][c] (block (row, row+1)), all rows up to
  nrows, which is the longest length in the batch. Rows beyond the end of a chain: D = identity, U = 0. The matrix must be
  symmetric, and only the upper triangle of D is read. Called by several threads at once.
*/
typedef void (*BlockTriFill)(void *ctx, const PetscInt chain[BLOCKTRI_LANES], PetscInt nrows, BlockTriLanes *D, BlockTriLanes *U);

/* A matrix that makes its blocks on the fly. */
typedef struct {
  PetscInt nchains;               /* number of chains */
  const PetscInt *first, *length; /* first block row and number of block rows of each chain; kept, not copied */
  BlockTriFill fill;              /* makes the blocks of up to 8 chains */
  void *ctx;                      /* its first argument */
} BlockTriSource;

/* Make PCBLOCKTRI known to PETSc; may be called again. libfrond does it when loaded with -dll_append. */
FROND_EXTERN PetscErrorCode PCBlockTriRegister(void);
/* Let a matrix give its blocks on the fly. P: the matrix. source: kept by reference, must outlive the matrix. */
FROND_EXTERN PetscErrorCode MatBlockTriSetSource(Mat P, const BlockTriSource *source);

#endif
