// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Binning: count per contiguous part of the candidates, prefix sums over parts, fill. Parts come in order, so
// a bin's items stay in order however many parts there are.
#include "tiling/bin.h"

/// The filling of one set of lists, in parts.
typedef struct bin_job {
    ewa_bin_lists *lists;
    ewa_bin_find *find;
    const void *data;
    ewa_bin_items items; // each part's from its first candidate on
    uint32_t *ids;
    uint64_t *counts;     // [part][bin]: first the number of items, then where the next one goes
    uint64_t *item_count; // [part]
    uint64_t bin_count, id_count;
    uint32_t candidate_count, parts;
    uint32_t first_task; // of all lists' parts
} bin_job;

/// All that is filled together: a task is a part of one of them.
typedef struct bin_jobs {
    bin_job *jobs;
    uint32_t count, task_count;
} bin_jobs;

static uint32_t part_first(const bin_job *job, uint32_t part) {
    const uint64_t groups = ((uint64_t)job->candidate_count + EWA_BIN_ALIGNMENT - 1) / EWA_BIN_ALIGNMENT;
    const uint64_t first = ewa_split(groups, job->parts, part) * EWA_BIN_ALIGNMENT;
    return first < job->candidate_count ? (uint32_t)first : job->candidate_count;
}

/// Bins [x0, x1) x [y0, y1).
typedef struct bin_rect {
    uint32_t x0, y0, x1, y1;
} bin_rect;

static bin_rect rect_of(const bin_job *job, size_t k) {
    const uint32_t first = (uint32_t)job->items.first[k], end = (uint32_t)job->items.end[k];
    return (bin_rect){first & 0xffff, first >> 16, end & 0xffff, end >> 16};
}

/// The job of a task.
static const bin_job *job_of(const bin_jobs *all, uint32_t task) {
    uint32_t low = 0, high = all->count; // jobs[low] begins at or before the task, jobs[high] behind it
    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        if (all->jobs[middle].first_task <= task)
            low = middle;
        else
            high = middle;
    }
    return &all->jobs[low];
}

static void count_part(void *data, uint32_t task, uint32_t worker) {
    const bin_job *job = job_of(data, task);
    const uint32_t part = task - job->first_task;
    uint64_t *counts = job->counts + part * job->bin_count;
    for (uint64_t bin = 0; bin < job->bin_count; bin++) counts[bin] = 0;
    const uint32_t first = part_first(job, part), count = part_first(job, part + 1) - first;
    job->item_count[part] = job->find(job->data, worker, first, count, &job->items);
    for (size_t k = first; k < first + job->item_count[part]; k++) {
        const bin_rect r = rect_of(job, k);
        for (uint32_t y = r.y0; y < r.y1; y++)
            for (uint32_t x = r.x0; x < r.x1; x++) counts[(size_t)y * job->lists->columns + x]++;
    }
}

static void fill_part(void *data, uint32_t task, uint32_t worker) {
    (void)worker;
    const bin_job *job = job_of(data, task);
    const uint32_t part = task - job->first_task;
    uint64_t *next = job->counts + part * job->bin_count;
    const uint32_t first = part_first(job, part);
    for (size_t k = first; k < first + job->item_count[part]; k++) {
        const bin_rect r = rect_of(job, k);
        for (uint32_t y = r.y0; y < r.y1; y++)
            for (uint32_t x = r.x0; x < r.x1; x++)
                job->ids[next[(size_t)y * job->lists->columns + x]++] = (uint32_t)job->items.ids[k];
    }
}

/// Turns counts into first places, bin by bin and part by part.
static void place(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    bin_job *job = &((const bin_jobs *)data)->jobs[index];
    ewa_bin_lists *lists = job->lists;
    uint64_t *starts = lists->start_buffer.data;
    uint64_t sum = 0;
    lists->largest = lists->item_count = 0;
    for (uint64_t bin = 0; bin < job->bin_count; bin++) {
        starts[bin] = sum;
        for (uint32_t part = 0; part < job->parts; part++) {
            uint64_t *count = &job->counts[part * job->bin_count + bin];
            const uint64_t here = *count;
            *count = sum;
            sum += here;
        }
        if (sum - starts[bin] > lists->largest) lists->largest = sum - starts[bin];
    }
    starts[job->bin_count] = sum;
    for (uint32_t part = 0; part < job->parts; part++) lists->item_count += job->item_count[part];
    job->id_count = sum;
}

/// One per worker, or fewer where several lists are filled, but more where these would take milliseconds, between
/// which a run can be stopped. More parts than are worthwhile would spend more on their counts than on the items.
static uint32_t part_count(uint32_t candidate_count, uint64_t bin_count, uint32_t worker_count,
                           uint32_t list_count) {
    enum { LARGE_PART = 1 << 16 };
    const uint64_t worthwhile = 1 + candidate_count / bin_count;
    const uint32_t large = candidate_count / LARGE_PART, own = list_count < worker_count ? worker_count : 1,
                   parts = large > own ? large : own;
    return worthwhile < parts ? (uint32_t)worthwhile : parts;
}

/// Makes room for all but the ids.
static ewa_status start(ewa_context *context, const ewa_bin_request *request, uint32_t columns, uint32_t rows,
                        uint32_t parts, bin_job *job) {
    ewa_bin_lists *lists = request->lists;
    const uint64_t bin_count = (uint64_t)columns * rows;
    const size_t stride =
        ((size_t)request->candidate_count + EWA_BIN_ALIGNMENT - 1) / EWA_BIN_ALIGNMENT * EWA_BIN_ALIGNMENT;
    EWA_TRY(ewa_buffer_reserve(context, &lists->item_buffer, 3 * stride + 1, sizeof(int32_t)));
    EWA_TRY(ewa_buffer_reserve(context, &lists->count_buffer, (bin_count + 1) * parts, sizeof(uint64_t)));
    EWA_TRY(ewa_buffer_reserve(context, &lists->start_buffer, bin_count + 1, sizeof(uint64_t)));
    int32_t *items = lists->item_buffer.data;
    uint64_t *counts = lists->count_buffer.data;
    *job = (bin_job){.lists = lists,
                     .find = request->find,
                     .data = request->data,
                     .items = {items, items + stride, items + 2 * stride},
                     .counts = counts,
                     .item_count = counts + parts * bin_count,
                     .bin_count = bin_count,
                     .candidate_count = request->candidate_count,
                     .parts = parts};
    lists->columns = columns;
    return EWA_OK;
}

static ewa_status run(ewa_context *context, ewa_task *task, bin_jobs *all, bool stoppable) {
    if (stoppable) return ewa_parallel_stoppable(context, "bin", task, all, all->task_count);
    ewa_parallel(context, task, all, all->task_count);
    return EWA_OK;
}

static ewa_status fill(ewa_context *context, const ewa_bin_request *requests, uint32_t columns, uint32_t rows,
                       bin_jobs *all) {
    const uint32_t workers = ewa_context_worker_count(context);
    bool stoppable = false;
    for (uint32_t i = 0; i < all->count; i++) {
        const uint32_t parts =
            part_count(requests[i].candidate_count, (uint64_t)columns * rows, workers, all->count);
        EWA_TRY(start(context, &requests[i], columns, rows, parts, &all->jobs[i]));
        all->jobs[i].first_task = all->task_count;
        all->task_count += parts;
        stoppable |= parts > workers;
    }
    EWA_TRY(run(context, count_part, all, stoppable));
    ewa_parallel(context, place, all, all->count);
    for (uint32_t i = 0; i < all->count; i++) {
        bin_job *job = &all->jobs[i];
        ewa_bin_lists *lists = job->lists;
        EWA_TRY(ewa_buffer_reserve(context, &lists->id_buffer, job->id_count, sizeof *job->ids));
        lists->starts = lists->start_buffer.data;
        lists->ids = job->ids = lists->id_buffer.data;
    }
    return run(context, fill_part, all, stoppable);
}

ewa_status ewa_bin_lists_fill_all(ewa_context *context, ewa_buffer *room, const ewa_bin_request *requests,
                                  uint32_t count, uint32_t columns, uint32_t rows) {
    if (count == 0) return EWA_OK;
    EWA_TRY(ewa_buffer_reserve(context, room, count, sizeof(bin_job)));
    return fill(context, requests, columns, rows, &(bin_jobs){.jobs = room->data, .count = count});
}

ewa_status ewa_bin_lists_fill(ewa_context *context, ewa_bin_lists *lists, uint32_t columns, uint32_t rows,
                              uint32_t candidate_count, ewa_bin_find *find, const void *data) {
    const ewa_bin_request request = {lists, candidate_count, find, data};
    bin_job job;
    return fill(context, &request, columns, rows, &(bin_jobs){.jobs = &job, .count = 1});
}

void ewa_bin_lists_free(ewa_context *context, ewa_bin_lists *lists) {
    ewa_buffer_free(context, &lists->item_buffer);
    ewa_buffer_free(context, &lists->count_buffer);
    ewa_buffer_free(context, &lists->start_buffer);
    ewa_buffer_free(context, &lists->id_buffer);
}
