// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Messages between ranks, and what is made of them: gathering and sums.
#include "cluster/exchange.h"

#include <string.h>

ewa_status ewa_exchange_check(ewa_context *context, const ewa_exchange *exchange) {
    if (!context || !exchange) return EWA_ERROR_ARGUMENT;
    if (exchange->swap && exchange->rank_count && exchange->rank_count <= EWA_MAX_RANKS &&
        exchange->rank < exchange->rank_count &&
        (exchange->picture_rank < exchange->rank_count || exchange->picture_rank == EWA_ALL_RANKS))
        return EWA_OK;
    return ewa_fail(context, EWA_ERROR_ARGUMENT,
                    "exchange: rank %u of %u, the picture for rank %u, or without a call", exchange->rank,
                    exchange->rank_count, exchange->picture_rank);
}

ewa_status ewa_messages_open(ewa_context *context, const ewa_exchange *exchange, ewa_messages *messages) {
    const size_t count = exchange->rank_count, of_rank = 4 * sizeof(ewa_parcel) + 2 * sizeof(uint64_t);
    EWA_TRY(ewa_buffer_reserve(context, &messages->memory, count, of_rank));
    memset(messages->memory.data, 0, count * of_rank);
    messages->given = messages->memory.data;
    messages->taken = messages->given + count;
    messages->given_sizes = messages->taken + count;
    messages->taken_sizes = messages->given_sizes + count;
    messages->sizes = (uint64_t *)(void *)(messages->taken_sizes + count);
    return EWA_OK;
}

ewa_status ewa_messages_send(const ewa_exchange *exchange, const ewa_messages *messages) {
    return exchange->swap(exchange->user, messages->given, messages->taken);
}

ewa_status ewa_messages_send_any(ewa_context *context, const ewa_exchange *exchange, ewa_messages *messages) {
    const uint32_t count = exchange->rank_count;
    uint64_t *mine = messages->sizes, *theirs = messages->sizes + count;
    for (uint32_t r = 0; r < count; r++) {
        mine[r] = messages->given[r].size_bytes;
        messages->given_sizes[r] = (ewa_parcel){&mine[r], sizeof *mine};
        messages->taken_sizes[r] = (ewa_parcel){&theirs[r], sizeof *theirs};
    }
    EWA_TRY(exchange->swap(exchange->user, messages->given_sizes, messages->taken_sizes));
    theirs[exchange->rank] = 0;
    size_t bytes = 0;
    for (uint32_t r = 0; r < count; r++) bytes += (size_t)theirs[r];
    EWA_TRY(ewa_buffer_reserve(context, &messages->received, bytes, 1));
    char *at = messages->received.data;
    for (uint32_t r = 0; r < count; r++) {
        messages->taken[r] = (ewa_parcel){at, (size_t)theirs[r]};
        at += theirs[r];
    }
    return ewa_messages_send(exchange, messages);
}

void ewa_messages_free(ewa_context *context, ewa_messages *messages) {
    ewa_buffer_free(context, &messages->memory);
    ewa_buffer_free(context, &messages->received);
}

ewa_status ewa_exchange_gather(ewa_context *context, const ewa_exchange *exchange, const void *mine,
                               size_t size_bytes, void *all) {
    ewa_messages messages = {.given = NULL};
    EWA_TRY(ewa_exchange_check(context, exchange));
    if (size_bytes && (!mine || !all)) return EWA_ERROR_ARGUMENT;
    ewa_status status = ewa_messages_open(context, exchange, &messages);
    for (uint32_t r = 0; r < exchange->rank_count && status == EWA_OK; r++) {
        messages.given[r] = (ewa_parcel){(void *)mine, size_bytes};
        messages.taken[r] = (ewa_parcel){(char *)all + r * size_bytes, size_bytes};
    }
    if (status == EWA_OK) status = ewa_messages_send(exchange, &messages);
    if (status == EWA_OK) memmove((char *)all + exchange->rank * size_bytes, mine, size_bytes);
    ewa_messages_free(context, &messages);
    return status;
}

/// Each rank adds up one part of the numbers, then all give their parts to all.
static ewa_status add_parts(const ewa_exchange *exchange, ewa_messages *messages, int64_t *values,
                            size_t count, int64_t *parts) {
    const uint32_t ranks = exchange->rank_count, own = exchange->rank;
    const size_t first = (size_t)ewa_split(count, ranks, own),
                 own_count = (size_t)ewa_split(count, ranks, own + 1) - first;
    for (uint32_t r = 0; r < ranks; r++) {
        const size_t from = (size_t)ewa_split(count, ranks, r), end = (size_t)ewa_split(count, ranks, r + 1);
        messages->given[r] = (ewa_parcel){values + from, (end - from) * sizeof *values};
        messages->taken[r] = (ewa_parcel){parts + r * own_count, own_count * sizeof *parts};
    }
    EWA_TRY(ewa_messages_send(exchange, messages));
    for (uint32_t r = 0; r < ranks; r++)
        for (size_t i = 0; i < own_count && r != own; i++) values[first + i] += parts[r * own_count + i];
    for (uint32_t r = 0; r < ranks; r++) {
        messages->taken[r] = messages->given[r];
        if (r != own) messages->given[r] = (ewa_parcel){values + first, own_count * sizeof *values};
    }
    messages->given[own] = messages->taken[own];
    return ewa_messages_send(exchange, messages);
}

ewa_status ewa_exchange_add(ewa_context *context, const ewa_exchange *exchange, int64_t *values,
                            size_t count) {
    ewa_messages messages = {.given = NULL};
    EWA_TRY(ewa_exchange_check(context, exchange));
    if (count && !values) return EWA_ERROR_ARGUMENT;
    EWA_TRY(ewa_messages_open(context, exchange, &messages));
    const size_t room = count + exchange->rank_count;
    int64_t *parts = ewa_allocate(context, room, sizeof *parts);
    ewa_status status = parts ? add_parts(exchange, &messages, values, count, parts) : EWA_ERROR_MEMORY;
    ewa_release(context, parts, room, sizeof *parts);
    ewa_messages_free(context, &messages);
    return status;
}
