// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A lock that is given in the order in which it was asked for.
#include "turns.h"

void turns_init(turn_lock *t) {
    pthread_mutex_init(&t->lock, NULL);
    pthread_cond_init(&t->changed, NULL);
    t->next = t->serving = 0;
}

void turns_free(turn_lock *t) {
    pthread_cond_destroy(&t->changed);
    pthread_mutex_destroy(&t->lock);
}

void turns_take(turn_lock *t) {
    pthread_mutex_lock(&t->lock);
    const uint64_t own = t->next++;
    while (t->serving != own) pthread_cond_wait(&t->changed, &t->lock);
    pthread_mutex_unlock(&t->lock);
}

void turns_give(turn_lock *t) {
    pthread_mutex_lock(&t->lock);
    t->serving++;
    pthread_cond_broadcast(&t->changed);
    pthread_mutex_unlock(&t->lock);
}

void turns_take_all(octree_turns *t) {
    turns_take(&t->files);
    turns_take(&t->nodes);
}

void turns_give_all(octree_turns *t) {
    turns_give(&t->nodes);
    turns_give(&t->files);
}
