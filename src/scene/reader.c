// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Nodes of a scene's octrees, read on a thread of their own.
#include "lod/reading.h"
#include "base/base.h"
#include "scene/draw.h"

struct ewa_scene_reader {
    ewa_scene_renderer lists; ///< of what is visible; it draws nothing
    ewa_lod_reading reading;
};

ewa_status ewa_scene_reader_create(ewa_context *context, ewa_scene_reader **made) {
    if (!context || !made) return EWA_ERROR_ARGUMENT;
    *made = ewa_allocate_zeroed(context, 1, sizeof **made);
    if (!*made) return EWA_ERROR_MEMORY;
    (*made)->lists.context = (*made)->reading.context = context;
    return EWA_OK;
}

void ewa_scene_reader_destroy(ewa_scene_reader **given) {
    ewa_scene_reader *reader = given ? *given : NULL;
    if (!reader) return;
    *given = NULL;
    ewa_context *context = reader->lists.context;
    ewa_lod_reading_free(&reader->reading);
    ewa_scene_renderer_free_lists(&reader->lists);
    ewa_release(context, reader, 1, sizeof *reader);
}

ewa_status ewa_scene_reader_choose(ewa_scene_reader *reader, ewa_scene *scene, const ewa_camera *camera,
                                   const ewa_scene_options *given, uint32_t maximum, uint32_t *count) {
    if (!reader || !scene || !camera || !count) return EWA_ERROR_ARGUMENT;
    *count = 0;
    reader->reading.count = 0;
    const ewa_scene_options *options = given ? given : &scene->options;
    ewa_scene_shown shown;
    EWA_TRY(ewa_scene_make_resident(scene));
    EWA_TRY(ewa_scene_list_shown(scene, &options->lod, &reader->lists, &shown));
    const ewa_lod_scene octrees = {shown.lods, shown.lod_count, 0, NULL};
    const ewa_status status = ewa_lod_reading_choose(&reader->reading, &octrees, shown.appearances, camera, &options->render,
                                                     &options->lod, maximum);
    *count = reader->reading.count;
    return status;
}

ewa_status ewa_scene_reader_read(ewa_scene_reader *reader) {
    if (!reader) return EWA_ERROR_ARGUMENT;
    return reader->reading.count ? ewa_lod_reading_read(&reader->reading) : EWA_OK;
}

void ewa_scene_reader_put(ewa_scene_reader *reader) {
    if (reader && reader->reading.count) ewa_lod_reading_put(&reader->reading);
}
