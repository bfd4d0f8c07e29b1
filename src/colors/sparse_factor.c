// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Cholesky factors by CHOLMOD's simplicial code (its Core and Cholesky modules, LGPL), in AMD order: plain
// loops without BLAS, so that the result depends on nothing that is installed beside it.
//
// CHOLMOD's memory comes from malloc(): its allocator is one set of function pointers for the whole process
// (SuiteSparse_config), which a library must not change under others' feet, and they carry no user pointer.
#include "colors/sparse_parts.h"

#include <cholmod.h>
#include <limits.h>

struct sparse_factor {
    ewa_context *context;
    cholmod_common common;
    cholmod_sparse matrix; // the caller's rows, with row_starts of its own
    int *row_starts;       // [size + 1]
    cholmod_factor *factor;
    cholmod_dense *solution, *work[2]; // kept between right sides
    double *columns;                   // [EWA_GRADIENT_SIDES][size]
};

enum { STEPS = 256 }; // of the factor, between which one may cancel

static ewa_status fail(sparse_factor *self, const char *what) {
    if (self->common.status == CHOLMOD_OUT_OF_MEMORY)
        return ewa_fail(self->context, EWA_ERROR_MEMORY, "solve: no memory to %s %zu rows", what,
                        self->matrix.nrow);
    if (self->common.status == CHOLMOD_TOO_LARGE)
        return ewa_fail(self->context, EWA_ERROR_LIMIT, "solve: %zu rows are too many to %s",
                        self->matrix.nrow, what);
    return ewa_fail(self->context, EWA_ERROR_NUMERIC, "solve: CHOLMOD cannot %s %zu rows: status %d", what,
                    self->matrix.nrow, self->common.status);
}

ewa_status ewa_sparse_factor_analyse(ewa_context *context, const ewa_sparse *matrix, sparse_factor **factor,
                                     uint64_t *factor_bytes) {
    *factor = NULL;
    const size_t size = matrix->size;
    const uint64_t entries = matrix->row_starts[size];
    if (size >= INT_MAX || entries > INT_MAX)
        return ewa_fail(context, EWA_ERROR_LIMIT, "solve: %zu rows of %llu entries are too many for a factor",
                        size, (unsigned long long)entries);
    sparse_factor *self = ewa_allocate_zeroed(context, 1, sizeof *self);
    if (!self) return EWA_ERROR_MEMORY;
    *self = (sparse_factor){.context = context};
    cholmod_start(&self->common);
    *factor = self;
    self->common.print = 0;
    self->common.try_catch = 1; // failures come as a status, without a word
    self->common.supernodal = CHOLMOD_SIMPLICIAL;
    self->common.nmethods = 1;
    self->common.method[0].ordering = CHOLMOD_AMD;
    self->common.postorder = 1;
    self->common.grow2 = 0; // no room for later updates
    self->matrix = (cholmod_sparse){.nrow = size,
                                    .ncol = size,
                                    .nzmax = entries,
                                    .i = (void *)matrix->columns,
                                    .x = (void *)matrix->values,
                                    .stype = -1,
                                    .itype = CHOLMOD_INT,
                                    .xtype = CHOLMOD_REAL,
                                    .dtype = CHOLMOD_DOUBLE,
                                    .sorted = 1,
                                    .packed = 1};
    self->row_starts = ewa_allocate(context, size + 1, sizeof *self->row_starts);
    self->columns = ewa_allocate(context, size * EWA_GRADIENT_SIDES, sizeof *self->columns);
    ewa_status status = self->row_starts && self->columns ? EWA_OK : EWA_ERROR_MEMORY;
    if (status == EWA_OK) {
        for (size_t i = 0; i <= size; i++) self->row_starts[i] = (int)matrix->row_starts[i];
        self->matrix.p = self->row_starts;
        self->factor = cholmod_analyze(&self->matrix, &self->common);
        if (!self->factor) status = fail(self, "order");
    }
    if (status != EWA_OK) {
        ewa_sparse_factor_destroy(factor);
        return status;
    }
    self->factor->is_ll = 1;
    *factor_bytes = (uint64_t)self->common.lnz * (sizeof(double) + sizeof(int));
    return EWA_OK;
}

ewa_status ewa_sparse_factor_make(sparse_factor *self, ewa_severity unsolved_severity) {
    const size_t size = self->matrix.nrow;
    // The lower half in the factor's order, transposed: the upper one, by columns, as cholmod_rowfac takes
    // it.
    cholmod_sparse *ordered =
        cholmod_ptranspose(&self->matrix, 1, self->factor->Perm, NULL, 0, &self->common);
    if (!ordered) return fail(self, "order");
    ewa_status status = EWA_OK;
    double shift[2] = {0, 0};
    for (uint32_t step = 0; step < STEPS && status == EWA_OK; step++) {
        const size_t first = ewa_split(size, STEPS, step), end = ewa_split(size, STEPS, step + 1);
        if (first == end) continue;
        cholmod_rowfac(ordered, NULL, shift, first, end, self->factor, &self->common);
        if (self->common.status == CHOLMOD_NOT_POSDEF || self->factor->minor < size)
            status = ewa_sparse_refuse(
                self->context, unsolved_severity,
                "solve: the matrix of %zu rows is not positive definite: the pivot of row %d "
                "is not positive",
                size, ((const int *)self->factor->Perm)[self->factor->minor]);
        else if (self->common.status != CHOLMOD_OK)
            status = fail(self, "factor");
        else
            status = ewa_progress(self->context, "solve", 0.99 * (double)end / (double)size);
    }
    cholmod_free_sparse(&ordered, &self->common);
    return status;
}

ewa_status ewa_sparse_factor_apply(sparse_factor *self, uint32_t count, const double *sides,
                                   double *solution) {
    const size_t size = self->matrix.nrow;
    for (size_t i = 0; i < size; i++)
        for (uint32_t s = 0; s < count; s++) self->columns[s * size + i] = sides[i * count + s];
    cholmod_dense right = {.nrow = size,
                           .ncol = count,
                           .nzmax = size * count,
                           .d = size,
                           .x = self->columns,
                           .xtype = CHOLMOD_REAL,
                           .dtype = CHOLMOD_DOUBLE};
    if (!cholmod_solve2(CHOLMOD_A, self->factor, &right, NULL, &self->solution, NULL, &self->work[0],
                        &self->work[1], &self->common))
        return fail(self, "solve");
    const double *found = self->solution->x;
    for (size_t i = 0; i < size; i++)
        for (uint32_t s = 0; s < count; s++) solution[i * count + s] = found[s * size + i];
    return EWA_OK;
}

void ewa_sparse_factor_destroy(sparse_factor **factor) {
    sparse_factor *self = *factor;
    if (!self) return;
    cholmod_free_dense(&self->solution, &self->common);
    for (int k = 0; k < 2; k++) cholmod_free_dense(&self->work[k], &self->common);
    cholmod_free_factor(&self->factor, &self->common);
    cholmod_finish(&self->common);
    ewa_release(self->context, self->columns, self->matrix.nrow * EWA_GRADIENT_SIDES, sizeof *self->columns);
    ewa_release(self->context, self->row_starts, self->matrix.nrow + 1, sizeof *self->row_starts);
    ewa_release(self->context, self, 1, sizeof *self);
    *factor = NULL;
}
