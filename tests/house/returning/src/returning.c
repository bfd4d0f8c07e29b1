// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Failures handed on in other ways than docs/conventions.md says: tools/check_returns.py has to find each.
static ewa_status one_by_one(void) {
    ewa_status status = first();
    if (status != EWA_OK) return status;
    return second();
}

static ewa_status in_a_chain(bool more) {
    ewa_status status = first();
    // A step that is not always wanted.
    if (status == EWA_OK && more) status = second();
    if (status == EWA_OK) status = third();
    return status;
}

/// This one has something to give back.
static ewa_status with_a_place_to_give_back(void) {
    ewa_status status = first();
    if (status == EWA_OK) status = second();
    give_back();
    return status;
}
