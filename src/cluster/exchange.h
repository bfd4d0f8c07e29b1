// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Messages between ranks.
#ifndef EWA_SRC_CLUSTER_EXCHANGE_H
#define EWA_SRC_CLUSTER_EXCHANGE_H

#include "base/base.h"
#include "ewa/cluster.h"

/// Checks an exchange of a caller. Errors: EWA_ERROR_ARGUMENT.
ewa_status ewa_exchange_check(ewa_context *context, const ewa_exchange *exchange);

/// What goes to and comes from each rank in one swap. Zero-initialise.
typedef struct ewa_messages {
    ewa_parcel *given, *taken; ///< [rank]
    ewa_parcel *given_sizes, *taken_sizes;
    uint64_t *sizes; ///< [2][rank]
    ewa_buffer memory, received;
} ewa_messages;

/// Makes room for the parcels of all ranks, empty. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_messages_open(ewa_context *context, const ewa_exchange *exchange, ewa_messages *messages);

/// Swaps given[] and taken[], whose sizes are known. Errors: those of the exchange.
ewa_status ewa_messages_send(const ewa_exchange *exchange, const ewa_messages *messages);

/// Swaps given[] of sizes that the others do not know, and points taken[] at what has come, which stays until the next
/// such call. Errors: EWA_ERROR_MEMORY, those of the exchange.
ewa_status ewa_messages_send_any(ewa_context *context, const ewa_exchange *exchange, ewa_messages *messages);

void ewa_messages_free(ewa_context *context, ewa_messages *messages);

#endif
