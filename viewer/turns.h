// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A lock that is given in the order in which it was asked for: who draws picture after picture keeps nobody else out.
#ifndef EWA_VIEWER_TURNS_H
#define EWA_VIEWER_TURNS_H

#include <pthread.h>
#include <stdint.h>

typedef struct turn_lock {
    pthread_mutex_t lock;
    pthread_cond_t changed;
    uint64_t next, serving;
} turn_lock;

void turns_init(turn_lock *lock);
void turns_free(turn_lock *lock);
/// Waits for the caller's turn, which turns_give() ends.
void turns_take(turn_lock *lock);
void turns_give(turn_lock *lock);

/// Who may use the octrees that are shown. Whoever needs both takes `files` first.
typedef struct octree_turns {
    turn_lock files; ///< reads their files
    turn_lock nodes; ///< draws their nodes in memory, or changes which these are
} octree_turns;

/// Takes both.
void turns_take_all(octree_turns *turns);
void turns_give_all(octree_turns *turns);

#endif
