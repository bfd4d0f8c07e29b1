// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// TIFF in a build without libtiff: known, and refused.
#include "base/base.h"
#include "io/cloud/geotiff.h"

static bool probe(const char *name, const uint8_t *bytes, uint64_t size_bytes) {
    (void)name;
    return ewa_tiff_recognise(bytes, size_bytes);
}

static ewa_status open_grid(const ewa_cloud_source *source, ewa_cloud *prototype, uint64_t *point_count, void **data) {
    (void)prototype, (void)point_count, (void)data;
    return ewa_fail(source->context, EWA_ERROR_UNSUPPORTED,
                    "%s: TIFF, which this build does not read (EWA_WITH_TIFF); an ASCII grid is read", source->name);
}

static ewa_status read_grid(void *data, uint64_t maximum, const ewa_cloud_sink *sinks, uint64_t *got_count) {
    (void)data, (void)maximum, (void)sinks;
    *got_count = 0;
    return EWA_OK;
}

static void close_grid(void *data) { (void)data; }

const ewa_cloud_format ewa_format_tiff = {EWA_MODEL_TIFF, probe, open_grid, read_grid, close_grid};
