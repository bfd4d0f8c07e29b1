// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a volume file holds, for ewa info.
#include "cli/info/info_volume.h"
#include "cli/info/info_facts.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

enum { BINS = 256, BARS = 16, PERCENTILES = 7 };

static const double percentiles[PERCENTILES] = {1, 5, 25, 50, 75, 95, 99};

/// The value below which so many per cent of the voxels lie, to the width of a bin.
static double percentile(const ewa_volume_facts *facts, double percent) {
    const double wanted = 0.01 * percent * (double)facts->finite_count;
    double below = 0;
    int bin = 0;
    while (bin < BINS - 1 && below + (double)facts->histogram[bin] < wanted)
        below += (double)facts->histogram[bin++];
    return facts->low + (facts->high - facts->low) * bin / (BINS - 1);
}

/// Unit vector of an axis of the grid.
static void direction(const ewa_volume *volume, const ewa_volume_facts *facts, int axis, double d[3]) {
    for (int k = 0; k < 3; k++)
        d[k] = volume->index_to_world[4 * k + axis] / facts->spacing_world[axis] + 0.0;
}

/// Counts of voxels in BARS equal ranges of values.
static void make_bars(const ewa_volume_facts *facts, uint64_t bars[BARS]) {
    for (int i = 0; i < BARS; i++) bars[i] = 0;
    for (int i = 0; i < BINS; i++) bars[i * BARS / BINS] += facts->histogram[i];
}

/// What ewa volume shows of it unless told otherwise; without points when there is nothing to tell apart.
static ewa_status choose_transfer(const ewa_volume *volume, const ewa_volume_facts *facts,
                                  ewa_transfer *transfer) {
    transfer->point_count = 0;
    return facts->finite_count && facts->low < facts->high ? ewa_transfer_automatic(volume, facts, transfer)
                                                           : EWA_OK;
}

/// Finds what is up, as a picture of the volume alone has it. False after reporting.
static bool find_upright(cli_session *session, const char *path, const ewa_volume *volume, const ewa_transfer *transfer,
                         ewa_upright *upright) {
    const ewa_asset_source source = {.name = path, .volume = volume, .transfer = transfer};
    ewa_asset *asset = NULL;
    ewa_status status = ewa_asset_create(session->context, &source, NULL, &asset);
    if (status == EWA_OK) status = ewa_asset_find_upright(asset, upright);
    ewa_asset_release(&asset);
    return session_passed(session, status);
}

static void print_text(const char *path, const ewa_volume *volume, const ewa_volume_facts *facts,
                       const ewa_transfer *transfer, const ewa_upright *upright) {
    const double *low = facts->low_world, *high = facts->high_world, *s = facts->spacing_world;
    printf("%s\n", path);
    printf("  volume      %u x %u x %u voxels of %s\n", volume->dims[0], volume->dims[1], volume->dims[2],
           ewa_type_name(volume->type));
    printf("  spacing     %.6g %.6g %.6g\n", s[0], s[1], s[2]);
    printf("  low         %.8g %.8g %.8g\n", low[0], low[1], low[2]);
    printf("  high        %.8g %.8g %.8g\n", high[0], high[1], high[2]);
    printf("  extent      %.6g %.6g %.6g\n", high[0] - low[0], high[1] - low[1], high[2] - low[2]);
    for (int axis = 0; axis < 3; axis++) {
        double d[3];
        direction(volume, facts, axis, d);
        printf("  axis %c      %.6g %.6g %.6g\n", "ijk"[axis], d[0], d[1], d[2]);
    }
    if (transfer->point_count) info_upright_print(upright);
    printf("  values      ");
    if (facts->finite_count)
        printf("%.6g .. %.6g, mean %.6g\n", facts->low, facts->high, facts->mean);
    else
        printf("nothing finite\n");
    if (facts->finite_count < facts->voxel_count)
        printf("  not finite  %" PRIu64 " voxels\n", facts->voxel_count - facts->finite_count);
    if (!facts->finite_count) return;
    printf("  percentiles");
    for (int i = 0; i < PERCENTILES; i++)
        printf("%s %g %%: %.5g", i ? "," : "", percentiles[i], percentile(facts, percentiles[i]));
    uint64_t bars[BARS];
    make_bars(facts, bars);
    printf("\n  histogram  ");
    for (int i = 0; i < BARS; i++) printf(" %.3g", 100 * (double)bars[i] / (double)facts->finite_count);
    printf(" %%\n");
    if (!transfer->point_count) return;
    printf("  transfer   ");
    for (uint32_t i = 0; i < transfer->point_count; i++)
        printf("%s %.5g: %.2g", i ? "," : "", transfer->points[i].value,
               1 - exp(-(double)transfer->points[i].extinction));
    printf(" (value: opacity of %.4g units; ewa volume --save-transfer FILE writes it)\n",
           transfer->unit_length_world);
}

/// As in files of --transfer.
static void print_transfer(json_writer *json, const ewa_transfer *transfer) {
    json_object(json, "transfer");
    json_text(json, "color_space", "linear");
    json_number(json, "unit_length", transfer->unit_length_world);
    json_array(json, "points");
    for (uint32_t i = 0; i < transfer->point_count; i++) {
        const ewa_transfer_point *point = &transfer->points[i];
        const double color[3] = {(double)point->color[0], (double)point->color[1], (double)point->color[2]};
        json_object(json, NULL);
        json_number(json, "value", point->value);
        json_vector(json, "color", 3, color);
        json_number(json, "extinction", (double)point->extinction);
        json_close(json, '}');
    }
    json_close(json, ']');
    json_close(json, '}');
}

static void print_json(json_writer *json, const char *path, const ewa_volume *volume,
                       const ewa_volume_facts *facts, const ewa_transfer *transfer, const ewa_upright *upright) {
    const double dims[3] = {volume->dims[0], volume->dims[1], volume->dims[2]};
    json_object(json, NULL);
    json_text(json, "file", path);
    json_vector(json, "dims", 3, dims);
    json_text(json, "type", ewa_type_name(volume->type));
    json_vector(json, "spacing", 3, facts->spacing_world);
    json_vector(json, "index_to_world", 12, volume->index_to_world);
    json_vector(json, "low", 3, facts->low_world);
    json_vector(json, "high", 3, facts->high_world);
    json_count(json, "voxels", facts->voxel_count);
    json_count(json, "finite_voxels", facts->finite_count);
    if (transfer->point_count) info_upright_write(json, upright);
    json_object(json, "values");
    json_number(json, "low", facts->low);
    json_number(json, "high", facts->high);
    json_number(json, "mean", facts->mean);
    for (int i = 0; i < PERCENTILES && facts->finite_count; i++) {
        char key[32];
        snprintf(key, sizeof key, "percentile_%g", percentiles[i]);
        json_number(json, key, percentile(facts, percentiles[i]));
    }
    json_close(json, '}');
    json_array(json, "histogram");
    for (int i = 0; i < BINS; i++) json_count(json, NULL, facts->histogram[i]);
    json_close(json, ']');
    if (transfer->point_count) print_transfer(json, transfer);
    json_close(json, '}');
}

bool info_volume(cli_session *session, const volume_input_arguments *arguments, const char *path,
                 json_writer *json) {
    ewa_volume volume = {.context = NULL};
    ewa_volume_facts facts;
    ewa_transfer transfer;
    if (!volume_input_load(session, arguments, path, &volume)) return false;
    ewa_status status = ewa_volume_measure(&volume, &facts);
    if (status == EWA_OK) status = choose_transfer(&volume, &facts, &transfer);
    ewa_upright upright;
    bool done = session_passed(session, status);
    if (done && transfer.point_count) done = find_upright(session, path, &volume, &transfer, &upright);
    if (done && json)
        print_json(json, path, &volume, &facts, &transfer, &upright);
    else if (done)
        print_text(path, &volume, &facts, &transfer, &upright);
    ewa_volume_free(&volume);
    return done;
}
