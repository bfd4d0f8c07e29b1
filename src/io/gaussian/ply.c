// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// PLY as programs that train Gaussians write it: a property for each number of a Gaussian, straight into the
// streams of the set.
//
// Based on: B. Kerbl et al., "3D Gaussian Splatting for Real-Time Radiance Field Rendering", 2023; B. Huang et
// al., "2D Gaussian Splatting for Geometrically Accurate Radiance Fields", 2024 (no third scale); Z. Yu et al.,
// "Mip-Splatting", 2024 (filter_3D); and their programs.
#include "io/gaussian/ply.h"
#include "io/reader.h"

#include <stdio.h>
#include <string.h>

enum { MAX_REST = 3 * ((EWA_MAX_SH_DEGREE + 1) * (EWA_MAX_SH_DEGREE + 1) - 1), NAME_BYTES = 16 };

/// What the vertices of a file have.
typedef struct columns {
    const ewa_ply_element *element;
    uint32_t x[3], dc[3], opacity, scale[3], rotation[4], filter;
    uint32_t rest[MAX_REST], rest_count;
    uint32_t sh_degree;
    uint32_t label;
    bool flat, filtered, labelled, exact; ///< exact: centres are doubles
} columns;

/// Finds a scalar of the vertices.
static bool find(const ewa_ply_header *header, const ewa_ply_element *element, const char *name,
                 uint32_t *property) {
    return ewa_ply_find_property(header, element, name, property) && !header->properties[*property].is_list;
}

/// Finds name_0, name_1, ...; returns how many of `maximum`.
static uint32_t find_row(const ewa_ply_header *header, const ewa_ply_element *element, const char *stem,
                         uint32_t maximum, uint32_t *properties) {
    char name[NAME_BYTES];
    uint32_t count = 0;
    for (; count < maximum; count++) {
        snprintf(name, sizeof name, "%s_%u", stem, count);
        if (!find(header, element, name, &properties[count])) break;
    }
    return count;
}

/// Finds the number that says what a Gaussian is part of, by the names that programs have for it.
static bool find_class(const ewa_ply_header *header, const ewa_ply_element *element, uint32_t *property) {
    static const char *const names[] = {"classification", "scalar_classification", "class", "label", "scalar_label"};
    for (size_t n = 0; n < sizeof names / sizeof *names; n++)
        for (uint32_t k = 0; k < element->property_count; k++) {
            *property = element->first_property + k;
            const ewa_ply_property *own = &header->properties[*property];
            if (!own->is_list && ewa_text_is_any_case(own->name, names[n])) return true;
        }
    return false;
}

/// Whether the vertices have the columns of 3DGS or 2DGS.
static bool is_plain(const ewa_ply_header *header) {
    const ewa_ply_element *vertices = ewa_ply_vertices(header);
    uint32_t found[4];
    return vertices && find_row(header, vertices, "f_dc", 3, found) == 3 &&
           find_row(header, vertices, "scale", 3, found) >= 2 &&
           find_row(header, vertices, "rot", 4, found) == 4 && find(header, vertices, "opacity", found);
}

/// Finds the columns. Errors: EWA_ERROR_FORMAT.
static ewa_status find_columns(const ewa_gaussian_source *source, const ewa_ply_header *header,
                               columns *made) {
    static const char *const axes[] = {"x", "y", "z"};
    *made = (columns){.element = ewa_ply_vertices(header)};
    const ewa_ply_element *vertices = made->element;
    for (int k = 0; k < 3; k++) {
        if (!find(header, vertices, axes[k], &made->x[k]))
            return ewa_fail(source->context, EWA_ERROR_FORMAT, "%s: the vertices have no number named '%s'",
                            source->name, axes[k]);
        const ewa_type type = header->properties[made->x[k]].type;
        made->exact |= type == EWA_F64 || type == EWA_I32 || type == EWA_U32;
    }
    find_row(header, vertices, "f_dc", 3, made->dc);
    find_row(header, vertices, "rot", 4, made->rotation);
    find(header, vertices, "opacity", &made->opacity);
    made->flat = find_row(header, vertices, "scale", 3, made->scale) == 2;
    made->filtered = find(header, vertices, "filter_3D", &made->filter);
    made->labelled = find_class(header, vertices, &made->label);
    made->rest_count = find_row(header, vertices, "f_rest", MAX_REST, made->rest);
    while (3 * (ewa_sh_count(made->sh_degree) - 1) < made->rest_count) made->sh_degree++;
    if (3 * (ewa_sh_count(made->sh_degree) - 1) == made->rest_count) return EWA_OK;
    return ewa_fail(source->context, EWA_ERROR_FORMAT,
                    "%s: %u coefficients f_rest; 0, 9, 24, 45 or 72 make whole degrees", source->name,
                    made->rest_count);
}

/// Where the numbers of a property go.
static void add_stream(const ewa_ply_header *header, uint32_t property, ewa_type type, void *to,
                       size_t stride_bytes, ewa_ply_sink *sink) {
    const ewa_ply_property *from = &header->properties[property];
    sink->streams[sink->stream_count++] = (ewa_ply_stream){.move = {.from_type = from->type,
                                                                    .to_type = type,
                                                                    .component_count = 1,
                                                                    .swap = ewa_ply_is_swapped(header)},
                                                           .from_offset_bytes = from->offset_bytes,
                                                           .to = to,
                                                           .to_stride_bytes = stride_bytes};
}

static void add_floats(const ewa_ply_header *header, uint32_t property, float *to, size_t stride,
                       ewa_ply_sink *sink) {
    add_stream(header, property, EWA_F32, to, stride * sizeof(float), sink);
}

/// Leads every column to its stream. f_rest has all coefficients of red, then of green, then of blue.
static void fill_sink(const ewa_ply_header *header, const columns *from, double *centers, float *filter, float *labels,
                      ewa_gaussians *set, ewa_ply_sink *sink) {
    const uint32_t coefficients = ewa_sh_count(set->sh_degree);
    const size_t harmonics_stride = 3 * (size_t)coefficients;
    for (uint32_t k = 0; k < 3; k++) {
        if (centers)
            add_stream(header, from->x[k], EWA_F64, centers + k, 3 * sizeof(double), sink);
        else
            add_floats(header, from->x[k], set->centers + k, 3, sink);
        add_floats(header, from->dc[k], set->harmonics + k, harmonics_stride, sink);
    }
    for (uint32_t k = 0; k < (from->flat ? 2u : 3u); k++)
        add_floats(header, from->scale[k], set->scales + k, 3, sink);
    for (uint32_t k = 0; k < 4; k++) add_floats(header, from->rotation[k], set->rotations + k, 4, sink);
    add_floats(header, from->opacity, set->opacities, 1, sink);
    if (filter) add_floats(header, from->filter, filter, 1, sink);
    if (labels) add_floats(header, from->label, labels, 1, sink);
    for (uint32_t i = 0; i < from->rest_count; i++) {
        const uint32_t color = i / (coefficients - 1), k = 1 + i % (coefficients - 1);
        add_floats(header, from->rest[i], set->harmonics + 3 * (size_t)k + color, harmonics_stride, sink);
    }
}

ewa_status ewa_gaussians_ply_skip_to(const ewa_ply_source *ply, const ewa_ply_header *header,
                                     const ewa_ply_element *element, uint64_t *at) {
    for (const ewa_ply_element *before = header->elements; before < element; before++) {
        EWA_TRY(ewa_ply_check_size(ply, header, before, *at));
        EWA_TRY(header->encoding == EWA_PLY_ASCII ? ewa_ply_ascii_skip(ply, header, before, at)
                                                  : ewa_ply_binary_skip(ply, header, before, at));
    }
    return ewa_ply_check_size(ply, header, element, *at);
}

ewa_status ewa_gaussians_ply_read_element(const ewa_ply_source *ply, const ewa_ply_header *header,
                                          const ewa_ply_element *element, const ewa_ply_sink *sink,
                                          uint64_t *at) {
    return header->encoding == EWA_PLY_ASCII ? ewa_ply_ascii_read(ply, header, element, sink, at)
                                             : ewa_ply_binary_read(ply, header, element, sink, at);
}

/// Takes classes; labels that are none, as the -1 of what belongs to nothing, are class 0, "never classified".
static ewa_status take_classes(const ewa_gaussian_source *source, const float *labels, ewa_gaussians *set) {
    EWA_TRY(ewa_gaussians_add_classes(set));
    uint32_t none_count = 0;
    for (size_t i = 0; i < set->count; i++) {
        const bool is_class = labels[i] >= 0 && labels[i] <= UINT16_MAX && labels[i] == floorf(labels[i]);
        set->classes[i] = is_class ? (uint16_t)labels[i] : 0;
        none_count += !is_class;
    }
    if (none_count)
        ewa_report(source->context, EWA_SEVERITY_WARNING, "%s: %u of %u classes are no whole numbers from 0 to %u; they are taken as 0", source->name,
                   none_count, set->count, UINT16_MAX);
    return EWA_OK;
}

/// Reads the records into the set and the memory beside it.
static ewa_status read_records(const ewa_gaussian_source *source, const ewa_ply_source *ply,
                               const ewa_ply_header *header, const columns *from, uint64_t at,
                               double *centers, float *filter, float *labels, ewa_gaussians *set) {
    ewa_ply_stream streams[3 + 3 + 3 + 4 + 1 + 1 + 1 + MAX_REST];
    ewa_ply_sink sink = {.streams = streams, .stream_capacity = sizeof streams / sizeof streams[0]};
    fill_sink(header, from, centers, filter, labels, set, &sink);
    EWA_TRY(ewa_gaussians_ply_read_element(ply, header, from->element, &sink, &at));
    if (centers) ewa_gaussians_place(centers, set);
    if (labels) EWA_TRY(take_classes(source, labels, set));
    const ewa_ply_element *element = from->element;
    const ewa_gaussian_form form = {.log_scales = true,
                                    .logits = true,
                                    .filter = filter,
                                    .first = element->before_count,
                                    .whole = element->before_count + element->count + element->after_count};
    return ewa_gaussians_settle(source, &form, set);
}

static ewa_status read_plain(const ewa_gaussian_source *source, const ewa_ply_source *ply,
                             const ewa_ply_header *header, ewa_gaussians *set, ewa_gaussian_facts *facts) {
    columns from;
    uint64_t at = header->body_at;
    EWA_TRY(find_columns(source, header, &from));
    EWA_TRY(ewa_gaussians_ply_skip_to(ply, header, from.element, &at));
    at += from.element->before_count * from.element->record_bytes; // of pieces, whose records are all as long
    EWA_TRY(ewa_gaussians_make(source, from.element->count, 0, 0, from.sh_degree, set));
    set->flat = from.flat;
    set->antialiased = facts->filtered = from.filtered;
    const size_t center_count = from.exact ? 3 * (size_t)set->count : 0,
                 filter_count = from.filtered ? set->count : 0, label_count = from.labelled ? set->count : 0;
    double *centers = center_count ? ewa_allocate(source->context, center_count, sizeof *centers) : NULL;
    float *filter = filter_count ? ewa_allocate(source->context, filter_count, sizeof *filter) : NULL;
    float *labels = label_count ? ewa_allocate(source->context, label_count, sizeof *labels) : NULL;
    ewa_status status = EWA_OK;
    if ((center_count && !centers) || (filter_count && !filter) || (label_count && !labels))
        status = EWA_ERROR_MEMORY;
    else
        status = read_records(source, ply, header, &from, at, centers, filter, labels, set);
    ewa_release(source->context, centers, center_count, sizeof *centers);
    ewa_release(source->context, filter, filter_count, sizeof *filter);
    ewa_release(source->context, labels, label_count, sizeof *labels);
    return status;
}

/// What the comments of a header say.
typedef struct header_words {
    bool antialiased, plain, flat, z_up;
} header_words;

/// "SplatRenderMode: mip" of Brush, "antialiased 1" of Postshot, "Vertical Axis: z" of nerfstudio; the last one
/// counts. Brush writes "Vertical axis: y" on whatever it trained with, mostly y down: that says nothing.
static void take_comment(void *user, const char *line) {
    header_words *words = user;
    ewa_cursor cursor = {line, line + strlen(line), 1};
    if (!ewa_text_is(ewa_cursor_word(&cursor), "comment")) return;
    const ewa_text first = ewa_cursor_word(&cursor), second = ewa_cursor_word(&cursor);
    if (ewa_text_is_any_case(first, "SplatRenderMode:")) {
        words->antialiased = ewa_text_is_any_case(second, "mip");
        words->plain = ewa_text_is_any_case(second, "default");
        words->flat = ewa_text_is_any_case(second, "2dgs");
    } else if (ewa_text_is_any_case(first, "antialiased")) {
        words->antialiased = ewa_text_is(second, "1");
        words->plain = ewa_text_is(second, "0");
    } else if (ewa_text_is_any_case(first, "vertical") && ewa_text_is_any_case(second, "axis:")) {
        words->z_up = ewa_text_is_any_case(ewa_cursor_word(&cursor), "z");
    }
}

/// Reads the element of a header, or the piece of it that the header says.
static ewa_status read_element(const ewa_gaussian_source *source, const ewa_ply_header *header, ewa_gaussians *set, ewa_gaussian_facts *facts) {
    const ewa_ply_source ply = {source->context, source->name, source->bytes, source->size_bytes};
    header_words words = {.z_up = false};
    ewa_ply_header_lines(&ply, header, take_comment, &words);
    EWA_TRY(read_plain(source, &ply, header, set, facts));
    if (words.antialiased || words.plain) set->antialiased = words.antialiased;
    facts->up_world[2] = words.z_up;
    if (words.flat) ewa_gaussians_flatten(set);
    return EWA_OK;
}

static ewa_status read_with(const ewa_gaussian_source *source, ewa_ply_header *header, ewa_gaussians *set, ewa_gaussian_facts *facts) {
    const ewa_ply_source ply = {source->context, source->name, source->bytes, source->size_bytes};
    EWA_TRY(ewa_ply_header_read(&ply, header));
    return read_element(source, header, set, facts);
}

ewa_status ewa_gaussians_ply_pieces(const ewa_gaussian_source *source, ewa_ply_header *header, uint64_t *count) {
    const ewa_ply_source ply = {source->context, source->name, source->bytes, source->size_bytes};
    columns from;
    *count = 0;
    if (!ewa_gaussians_ply_probe(source, is_plain, &(ewa_status){EWA_OK})) return EWA_OK;
    EWA_TRY(ewa_ply_header_read(&ply, header));
    EWA_TRY(find_columns(source, header, &from));
    uint64_t at = header->body_at;
    EWA_TRY(ewa_gaussians_ply_skip_to(&ply, header, from.element, &at));
    if (header->encoding != EWA_PLY_ASCII && !from.element->list_count && !from.exact) *count = from.element->count;
    return EWA_OK;
}

ewa_status ewa_gaussians_ply_piece(const ewa_gaussian_source *source, ewa_ply_header *header, uint64_t first, uint32_t count,
                                   ewa_gaussians *set, ewa_gaussian_facts *facts) {
    ewa_ply_element *element = &header->elements[ewa_ply_vertices(header) - header->elements];
    const uint64_t whole = element->before_count + element->count + element->after_count;
    element->before_count = first, element->count = count, element->after_count = whole - first - count;
    *set = (ewa_gaussians){.context = NULL};
    const ewa_status status = read_element(source, header, set, facts);
    if (status != EWA_OK) ewa_gaussians_free(set);
    return status;
}

static ewa_status read_ply(const ewa_gaussian_source *source, ewa_gaussians *set, ewa_gaussian_facts *facts) {
    ewa_ply_header *header = ewa_allocate(source->context, 1, sizeof *header);
    const ewa_status status = header ? read_with(source, header, set, facts) : EWA_ERROR_MEMORY;
    ewa_release(source->context, header, 1, sizeof *header);
    return status;
}

bool ewa_gaussians_ply_probe(const ewa_gaussian_source *source, bool (*fits)(const ewa_ply_header *header),
                             ewa_status *status) {
    if (source->size_bytes < 4 || !ewa_bytes_begin(source->bytes, source->size_bytes, "ply")) return false;
    ewa_ply_header *header = ewa_allocate(source->context, 1, sizeof *header);
    if (!header) {
        *status = EWA_ERROR_MEMORY;
        return false;
    }
    // Nobody wants to be told here what is wrong with files of other readers.
    const ewa_ply_source ply = {NULL, source->name, source->bytes, source->size_bytes};
    const bool found = ewa_ply_header_read(&ply, header) == EWA_OK && fits(header);
    ewa_release(source->context, header, 1, sizeof *header);
    return found;
}

static bool probe(const ewa_gaussian_source *source, ewa_status *status) {
    return ewa_gaussians_ply_probe(source, is_plain, status);
}

const ewa_gaussian_reader ewa_gaussians_ply = {EWA_GAUSSIANS_PLY, probe, read_ply};
