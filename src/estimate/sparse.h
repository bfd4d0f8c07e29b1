// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Points that are no surface: a handful, a curve, a few strewn in space.
#ifndef EWA_SRC_ESTIMATE_SPARSE_H
#define EWA_SRC_ESTIMATE_SPARSE_H

#include "ewa/cloud.h"

/// Says whether an estimated cloud has points that lie on no surface: up to 128 in any case, up to 4,096 on curves or
/// strewn in space, up to 4 million on curves if their surfaceness is 0. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_cloud_is_sparse(const ewa_cloud *cloud, bool *sparse);

#endif
