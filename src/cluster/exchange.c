// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Parcels between ranks, and what is made of them: gathering and sums.
#include "cluster/exchange.h"

#include <string.h>

ewa_status ewa_exchange_check(ewa_context *context, const ewa_exchange *exchange) {
    if (!exchange) return EWA_ERROR_ARGUMENT;
    if (exchange->swap && exchange->rank_count && exchange->rank_count <= EWA_MOST_RANKS &&
        exchange->rank < exchange->rank_count &&
        (exchange->picture_rank < exchange->rank_count || exchange->picture_rank == EWA_ALL_RANKS))
        return EWA_OK;
    return ewa_fail(context, EWA_ERROR_ARGUMENT,
                    "exchange: rank %u of %u, the picture for rank %u, or without a call", exchange->rank,
                    exchange->rank_count, exchange->picture_rank);
}

ewa_status ewa_mail_open(ewa_context *context, const ewa_exchange *exchange, ewa_mail *mail) {
    const size_t count = exchange->rank_count, of_rank = 4 * sizeof(ewa_parcel) + 2 * sizeof(uint64_t);
    const ewa_status status = ewa_buffer_reserve(context, &mail->memory, count, of_rank);
    if (status != EWA_OK) return status;
    memset(mail->memory.data, 0, count * of_rank);
    mail->given = mail->memory.data;
    mail->taken = mail->given + count;
    mail->given_sizes = mail->taken + count;
    mail->taken_sizes = mail->given_sizes + count;
    mail->sizes = (uint64_t *)(void *)(mail->taken_sizes + count);
    return EWA_OK;
}

ewa_status ewa_mail_send(const ewa_exchange *exchange, const ewa_mail *mail) {
    return exchange->swap(exchange->user, mail->given, mail->taken);
}

ewa_status ewa_mail_send_any(ewa_context *context, const ewa_exchange *exchange, ewa_mail *mail) {
    const uint32_t count = exchange->rank_count;
    uint64_t *mine = mail->sizes, *theirs = mail->sizes + count;
    for (uint32_t r = 0; r < count; r++) {
        mine[r] = mail->given[r].size_bytes;
        mail->given_sizes[r] = (ewa_parcel){&mine[r], sizeof *mine};
        mail->taken_sizes[r] = (ewa_parcel){&theirs[r], sizeof *theirs};
    }
    ewa_status status = exchange->swap(exchange->user, mail->given_sizes, mail->taken_sizes);
    if (status != EWA_OK) return status;
    theirs[exchange->rank] = 0;
    size_t bytes = 0;
    for (uint32_t r = 0; r < count; r++) bytes += (size_t)theirs[r];
    status = ewa_buffer_reserve(context, &mail->post, bytes, 1);
    char *at = mail->post.data;
    for (uint32_t r = 0; r < count && status == EWA_OK; r++) {
        mail->taken[r] = (ewa_parcel){at, (size_t)theirs[r]};
        at += theirs[r];
    }
    return status == EWA_OK ? ewa_mail_send(exchange, mail) : status;
}

void ewa_mail_free(ewa_context *context, ewa_mail *mail) {
    ewa_buffer_free(context, &mail->memory);
    ewa_buffer_free(context, &mail->post);
}

ewa_status ewa_exchange_gather(ewa_context *context, const ewa_exchange *exchange, const void *mine,
                               size_t size_bytes, void *all) {
    ewa_mail mail = {.given = NULL};
    ewa_status status = ewa_exchange_check(context, exchange);
    if (status == EWA_OK) status = ewa_mail_open(context, exchange, &mail);
    for (uint32_t r = 0; r < exchange->rank_count && status == EWA_OK; r++) {
        mail.given[r] = (ewa_parcel){(void *)mine, size_bytes};
        mail.taken[r] = (ewa_parcel){(char *)all + r * size_bytes, size_bytes};
    }
    if (status == EWA_OK) status = ewa_mail_send(exchange, &mail);
    if (status == EWA_OK) memmove((char *)all + exchange->rank * size_bytes, mine, size_bytes);
    ewa_mail_free(context, &mail);
    return status;
}

/// Each rank adds up one part of the numbers, then all give their parts to all.
static ewa_status add_parts(const ewa_exchange *exchange, ewa_mail *mail, int64_t *values, size_t count,
                            int64_t *parts) {
    const uint32_t ranks = exchange->rank_count, own = exchange->rank;
    const size_t first = (size_t)ewa_split(count, ranks, own),
                 own_count = (size_t)ewa_split(count, ranks, own + 1) - first;
    for (uint32_t r = 0; r < ranks; r++) {
        const size_t from = (size_t)ewa_split(count, ranks, r), end = (size_t)ewa_split(count, ranks, r + 1);
        mail->given[r] = (ewa_parcel){values + from, (end - from) * sizeof *values};
        mail->taken[r] = (ewa_parcel){parts + r * own_count, own_count * sizeof *parts};
    }
    ewa_status status = ewa_mail_send(exchange, mail);
    if (status != EWA_OK) return status;
    for (uint32_t r = 0; r < ranks; r++)
        for (size_t i = 0; i < own_count && r != own; i++) values[first + i] += parts[r * own_count + i];
    for (uint32_t r = 0; r < ranks; r++) {
        mail->taken[r] = mail->given[r];
        if (r != own) mail->given[r] = (ewa_parcel){values + first, own_count * sizeof *values};
    }
    mail->given[own] = mail->taken[own];
    return ewa_mail_send(exchange, mail);
}

ewa_status ewa_exchange_add(ewa_context *context, const ewa_exchange *exchange, int64_t *values,
                            size_t count) {
    ewa_mail mail = {.given = NULL};
    ewa_status status = ewa_exchange_check(context, exchange);
    if (status == EWA_OK) status = ewa_mail_open(context, exchange, &mail);
    if (status != EWA_OK) return status;
    const size_t room = count + exchange->rank_count;
    int64_t *parts = ewa_allocate(context, room, sizeof *parts);
    status = parts ? add_parts(exchange, &mail, values, count, parts) : EWA_ERROR_MEMORY;
    ewa_release(context, parts, room, sizeof *parts);
    ewa_mail_free(context, &mail);
    return status;
}
