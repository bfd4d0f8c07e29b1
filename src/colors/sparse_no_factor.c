// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Cholesky factors in a library that is built without CHOLMOD: none ever fits, so that the gradient does all.
#include "colors/sparse_parts.h"

ewa_status ewa_sparse_factor_analyse(ewa_context *context, const ewa_sparse *matrix, sparse_factor **factor,
                                     uint64_t *factor_bytes) {
    (void)context, (void)matrix;
    *factor = NULL;
    *factor_bytes = UINT64_MAX;
    return EWA_OK;
}

ewa_status ewa_sparse_factor_make(sparse_factor *factor, ewa_severity unsolved_severity) {
    (void)factor, (void)unsolved_severity;
    return EWA_ERROR_UNSUPPORTED;
}

ewa_status ewa_sparse_factor_apply(sparse_factor *factor, uint32_t count, const double *sides,
                                   double *solution) {
    (void)factor, (void)count, (void)sides, (void)solution;
    return EWA_ERROR_UNSUPPORTED;
}

void ewa_sparse_factor_destroy(sparse_factor **factor) { *factor = NULL; }
