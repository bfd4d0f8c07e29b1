// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Scenes as text: files that open as the same scene, and descriptions.
#include "base/base.h"
#include "base/context.h"
#include "io/camera/file.h"
#include "io/file.h"
#include "io/json_text.h"
#include "io/referenced_file.h"
#include "io/number.h"
#include "scene/file.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// Makes an array of numbers, each the shortest that reads as the same: cJSON's own lose the last digit.
static cJSON *make_numbers(const double *numbers, uint32_t count) {
    cJSON *array = cJSON_CreateArray();
    for (uint32_t i = 0; i < count && array; i++) {
        char text[EWA_NUMBER_BYTES + 1];
        text[ewa_number_write_f64(numbers[i], text)] = 0;
        if (cJSON_AddItemToArray(array, cJSON_CreateRaw(text))) continue;
        cJSON_Delete(array);
        array = NULL;
    }
    return array;
}

static bool add_numbers(cJSON *object, const char *name, const double *numbers, uint32_t count) {
    return cJSON_AddItemToObject(object, name, make_numbers(numbers, count));
}

/// Adds a value as its text reads: a number, a switch or a word; of arrays one value each.
static bool add_value(cJSON *object, const ewa_option *option, const void *options) {
    char text[EWA_OPTION_TEXT_BYTES], array[EWA_OPTION_TEXT_BYTES + 2];
    if (option->count && option->type == EWA_OPTION_F64)
        return add_numbers(object, option->name,
                           (const double *)(const void *)((const char *)options + option->offset),
                           option->count);
    ewa_option_get(option, options, text);
    snprintf(array, sizeof array, "[%s]", text);
    if (option->count) return cJSON_AddRawToObject(object, option->name, array);
    switch (option->type) {
    case EWA_OPTION_BOOL:
        return cJSON_AddBoolToObject(object, option->name, strcmp(text, "on") == 0);
    case EWA_OPTION_CHOICE:
        return cJSON_AddStringToObject(object, option->name, text);
    // As text, a number is the shortest one that reads as the same.
    default:
        return cJSON_AddRawToObject(object, option->name, text);
    }
}

/// Adds the options of a table that are not what they are in `defaults`.
static bool add_options(cJSON *object, const ewa_option_table *table, const void *options,
                        const void *defaults) {
    bool done = true;
    for (size_t i = 0; i < table->option_count && done; i++) {
        const ewa_option *option = &table->options[i];
        if (ewa_scene_option_is_kept(option) && !ewa_scene_option_is_same(option, options, defaults))
            done = add_value(object, option, options);
    }
    return done;
}

static bool add_lights(cJSON *object, const ewa_render_options *render) {
    ewa_light usual;
    ewa_light_init(&usual);
    cJSON *lights = render->light_count ? cJSON_AddArrayToObject(object, "lights") : NULL;
    bool done = lights || !render->light_count;
    for (uint32_t i = 0; i < render->light_count && done; i++) {
        cJSON *light = cJSON_CreateObject();
        done = cJSON_AddItemToArray(lights, light);
        for (int k = 0; k < EWA_SCENE_LIGHT_ROWS && done; k++)
            done = add_value(light, &ewa_scene_light_rows[k], &render->lights[i]);
    }
    return done;
}

static bool add_planes(cJSON *object, const ewa_render_options *render) {
    cJSON *planes = render->section_count ? cJSON_AddArrayToObject(object, "section_planes") : NULL;
    bool done = planes || !render->section_count;
    for (uint32_t i = 0; i < render->section_count && done; i++)
        done = cJSON_AddItemToArray(planes, make_numbers(render->section_planes[i], 4));
    return done;
}

static bool add_region(cJSON *list, const ewa_region *region) {
    cJSON *object = cJSON_CreateObject();
    bool done = cJSON_AddItemToArray(list, object) && cJSON_AddBoolToObject(object, "keep", region->kept);
    if (done && region->has_box) done = add_numbers(object, "box", region->box_world, 6);
    if (done && region->has_box && ewa_region_is_turned(region)) done = add_numbers(object, "box_axes", region->box_axes_world, 9);
    if (done && region->has_classes) {
        double codes[EWA_REGION_CLASSES];
        uint32_t count = 0;
        for (uint32_t c = 0; c < EWA_REGION_CLASSES; c++)
            if (region->classes[c / 32] >> c % 32 & 1) codes[count++] = c;
        done = add_numbers(object, "classes", codes, count);
    }
    if (done && region->corner_count)
        done = add_numbers(object, "outline", region->outline_px, 2 * region->corner_count) &&
               add_numbers(object, "world_to_picture", region->world_to_picture, 12);
    return done;
}

static bool add_regions(cJSON *object, const ewa_scene_options *options) {
    cJSON *list = options->region_count ? cJSON_AddArrayToObject(object, "regions") : NULL;
    bool done = list || !options->region_count;
    for (uint32_t i = 0; i < options->region_count && done; i++) done = add_region(list, &options->regions[i]);
    return done;
}

/// Adds what of a scene's options is no default.
static bool add_all_options(cJSON *root, const ewa_scene *scene) {
    static const char *const names[] = {NULL, "surfels", "lod", "render", "gaussians", "volumes"};
    ewa_scene_options options = scene->options, defaults;
    ewa_scene_options_init(&defaults, sizeof defaults);
    cJSON *object = cJSON_CreateObject();
    bool done = object != NULL;
    for (int s = 0; s <= EWA_SCENE_VOLUMES && done; s++) {
        void *part, *usual;
        const ewa_option_table *table = ewa_scene_section_table((ewa_scene_section)s, &options, &part);
        (void)ewa_scene_section_table((ewa_scene_section)s, &defaults, &usual);
        cJSON *group = s ? cJSON_CreateObject() : object;
        done = group && add_options(group, table, part, usual);
        if (s && done && group->child)
            done = cJSON_AddItemToObject(object, names[s], group);
        else if (s)
            cJSON_Delete(group);
    }
    done = done && add_lights(object, &options.render) && add_planes(object, &options.render) &&
           add_regions(object, &options);
    if (done && object->child) return cJSON_AddItemToObject(root, "options", object);
    cJSON_Delete(object);
    return done;
}

static bool add_coloring(cJSON *object, const ewa_coloring *coloring) {
    bool done = ewa_coloring_is_auto(coloring->attribute) ||
                cJSON_AddStringToObject(object, "color_by", coloring->attribute);
    char map[EWA_OPTION_TEXT_BYTES];
    ewa_option_get(ewa_option_find(&ewa_coloring_table, "map"), coloring, map);
    if (done && coloring->map != EWA_COLORING_AUTO) done = cJSON_AddStringToObject(object, "colormap", map);
    if (done && coloring->tinted) done = add_numbers(object, "tint", coloring->tint, 3);
    cJSON *range = done && coloring->ranged ? cJSON_AddArrayToObject(object, "range") : NULL;
    for (int i = 0; i < 2 && done && coloring->ranged; i++) {
        char text[EWA_NUMBER_BYTES + 2];
        size_t length = ewa_number_write_f64(coloring->range[i], text);
        if (coloring->percent[i]) text[length++] = '%';
        text[length] = 0;
        done = range && cJSON_AddItemToArray(range, coloring->percent[i] ? cJSON_CreateString(text)
                                                                         : cJSON_CreateRaw(text));
    }
    return done;
}

/// Adds how an instance is shown, where that is no default.
static bool add_instance(cJSON *object, const ewa_scene_item *item) {
    const ewa_asset *asset = item->asset;
    ewa_instance usual;
    ewa_instance_init(&usual, sizeof usual);
    ewa_asset_options options, defaults;
    ewa_asset_options_init(&defaults, sizeof defaults);
    options = defaults;
    memcpy(options.to_world, asset->to_world, sizeof options.to_world);
    options.gaussians_as_surfels = asset->gaussians_as_surfels;
    options.levels = asset->levels;
    if (asset->kind == EWA_ASSET_MESH) options.cutoff = asset->cutoff;
    if (asset->kind == EWA_ASSET_VOLUME) {
        options.voxel_level_count = asset->voxel_level_count;
        options.reach_steps = asset->reach_steps;
    }
    enum { FILTER_BYTES = 1 << 14 };
    char filter[FILTER_BYTES];
    bool done = add_options(object, &ewa_asset_options_table, &options, &defaults) &&
                add_options(object, &ewa_instance_table, &item->instance, &usual) &&
                add_coloring(object, &item->instance.coloring);
    if (done && asset->filter.term_count)
        done = ewa_filter_write(&asset->filter, filter, sizeof filter) &&
               cJSON_AddStringToObject(object, "filter", filter);
    return done;
}

/// Adds the name that a file has in the scene file at `path`.
static ewa_status add_name(const ewa_scene *scene, const char *path, const char *target, const char *member,
                           cJSON *object) {
    char name[EWA_PATH_BYTES], reason[EWA_REASON_BYTES];
    if (!ewa_referenced_file_relate(path, target, name, reason))
        return ewa_fail(scene->context, EWA_ERROR_UNSUPPORTED, "%s: cannot be named in %s: %s", target, path,
                        reason);
    return cJSON_AddStringToObject(object, member, name) ? EWA_OK : EWA_ERROR_MEMORY;
}

static bool is_preset(const char *word) {
    const char *name = "auto";
    for (uint32_t i = 0; name && strcmp(name, word) != 0; i++) name = ewa_transfer_preset_name(i, NULL);
    return name != NULL;
}

static ewa_status add_item(const ewa_scene *scene, const ewa_scene_item *item, const char *path,
                           cJSON *items) {
    const ewa_asset *asset = item->asset;
    if (!asset->of_file || asset->of_columns)
        return ewa_fail(scene->context, EWA_ERROR_UNSUPPORTED, "%s: %s, which no scene file can say",
                        asset->name, asset->of_file ? "columns of it were chosen" : "it is in memory");
    cJSON *object = cJSON_CreateObject();
    if (!object || !cJSON_AddItemToArray(items, object)) return EWA_ERROR_MEMORY;
    ewa_status status = add_name(scene, path, asset->name, "file", object);
    const char *transfer = asset->kind == EWA_ASSET_VOLUME ? asset->transfer : NULL;
    if (status == EWA_OK && transfer && is_preset(transfer))
        status = cJSON_AddStringToObject(object, "transfer", transfer) ? EWA_OK : EWA_ERROR_MEMORY;
    else if (status == EWA_OK && transfer)
        status = add_name(scene, path, transfer, "transfer", object);
    return status == EWA_OK && !add_instance(object, item) ? EWA_ERROR_MEMORY : status;
}

static bool add_measures(cJSON *root, const ewa_scene *scene) {
    cJSON *list = scene->measure_count ? cJSON_AddArrayToObject(root, "measures") : NULL;
    bool done = list || !scene->measure_count;
    for (uint32_t i = 0; i < scene->measure_count && done; i++) {
        const ewa_measure *measure = &scene->measures[i];
        cJSON *object = cJSON_CreateObject();
        done = cJSON_AddItemToArray(list, object) && cJSON_AddStringToObject(object, "kind", ewa_measure_kind_name(measure->kind)) &&
               cJSON_AddStringToObject(object, "name", measure->name) &&
               add_numbers(object, "places_world", measure->places_world, 3 * measure->count);
    }
    return done;
}

/// Makes the text of a scene file without its camera.
static ewa_status make_text(const ewa_scene *scene, const char *path, char **text) {
    cJSON *root = cJSON_CreateObject();
    ewa_status status = root && cJSON_AddNumberToObject(root, "ewa_scene", 1) && add_all_options(root, scene)
                            ? EWA_OK
                            : EWA_ERROR_MEMORY;
    cJSON *items = status == EWA_OK ? cJSON_AddArrayToObject(root, "items") : NULL;
    if (status == EWA_OK && !items) status = EWA_ERROR_MEMORY;
    for (uint32_t i = 0; i < scene->count && status == EWA_OK; i++)
        status = add_item(scene, &scene->items[i], path, items);
    if (status == EWA_OK && !add_measures(root, scene)) status = EWA_ERROR_MEMORY;
    if (status == EWA_OK) *text = cJSON_Print(root);
    if (status == EWA_OK && !*text) status = EWA_ERROR_MEMORY;
    cJSON_Delete(root);
    return status;
}

static void write_camera(ewa_writer *writer, const char *before, const ewa_camera *camera) {
    (void)ewa_writer_put(writer, before, strlen(before));
    ewa_camera_write(writer, camera);
}

ewa_status ewa_scene_save(const ewa_scene *scene, const ewa_camera *camera, const char *path) {
    if (!scene || !path) return EWA_ERROR_ARGUMENT;
    ewa_context *context = scene->context;
    const ewa_render_options *render = &scene->options.render;
    if (render->materials || render->environment)
        return ewa_fail(context, EWA_ERROR_UNSUPPORTED,
                        "%s: scene files have neither materials nor environments", path);
    EWA_TRY(ewa_json_check(context, path));
    char *text = NULL;
    ewa_writer *writer = NULL;
    if (!camera && scene->has_camera) camera = &scene->camera;
    ewa_status status = camera ? ewa_camera_check(context, camera) : EWA_OK;
    if (status == EWA_OK) status = make_text(scene, path, &text);
    if (status == EWA_OK) status = ewa_writer_open(context, path, &writer);
    if (status == EWA_OK) {
        // The text ends by a line's end and a brace, before which the cameras belong.
        (void)ewa_writer_put(writer, text, strlen(text) - 2);
        if (camera) write_camera(writer, ",\n\t\"camera\":\t", camera);
        for (uint32_t i = 0; i < scene->keyframe_count; i++)
            write_camera(writer, i ? ",\n" : ",\n\t\"keyframes\":\t[", &scene->keyframes[i]);
        if (scene->keyframe_count) (void)ewa_writer_put(writer, "]", 1);
        (void)ewa_writer_put(writer, "\n}\n", 3);
        status = ewa_writer_commit(&writer);
    }
    ewa_text_free(&text);
    return status;
}

/// Adds a box, or nothing where there is none.
static bool add_box(cJSON *object, const ewa_bounds *bounds) {
    if (!bounds->finite_count) return true;
    return add_numbers(object, "low_world", bounds->low_world, 3) &&
           add_numbers(object, "high_world", bounds->high_world, 3);
}

ewa_status ewa_scene_describe_json(const ewa_scene *scene, char **text) {
    if (!scene || !text) return EWA_ERROR_ARGUMENT;
    *text = NULL;
    EWA_TRY(ewa_json_check(scene->context, "description of the scene"));
    cJSON *root = cJSON_CreateObject();
    cJSON *items = root ? cJSON_AddArrayToObject(root, "items") : NULL;
    bool done = items && add_all_options(root, scene);
    for (uint32_t i = 0; i < scene->count && done; i++) {
        const ewa_asset *asset = scene->items[i].asset;
        cJSON *object = cJSON_CreateObject();
        done = cJSON_AddItemToArray(items, object) && cJSON_AddStringToObject(object, "name", asset->name) &&
               cJSON_AddStringToObject(object, "kind", ewa_asset_kind_name(asset->kind)) &&
               cJSON_AddNumberToObject(object, "count", (double)asset->count) &&
               add_box(object, &asset->bounds) &&
               (!asset->transfer || cJSON_AddStringToObject(object, "transfer", asset->transfer)) &&
               add_instance(object, &scene->items[i]);
    }
    ewa_bounds bounds;
    ewa_scene_bounds(scene, &bounds);
    if (done && add_box(root, &bounds)) *text = cJSON_Print(root);
    cJSON_Delete(root);
    return *text ? EWA_OK : EWA_ERROR_MEMORY;
}

void ewa_text_free(char **text) {
    if (!text) return;
    cJSON_free(*text);
    *text = NULL;
}
