// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// From the bytes of a volume file to voxels: sizes are checked against the bytes that are there before memory
// is asked for, then unpacked, turned to this machine's order and converted block by block.
#include "base/base.h"
#include "io/number.h"
#include "io/volume/file.h"

#include <math.h>
#include <string.h>

enum { BLOCK_NUMBERS = 1 << 14, SKIP_BYTES = 1 << 14, MAX_COMPONENTS = 4 };

/// Volume of the box that three unit steps span, below which they lie in one plane.
static const double MIN_DETERMINANT = 1e-6;

size_t ewa_file_number_bytes(int number) {
    return number == EWA_FILE_I64 || number == EWA_FILE_U64 ? 8 : ewa_type_bytes((ewa_type)number);
}

const char *ewa_file_number_name(int number) {
    if (number == EWA_FILE_I64) return "64-bit int";
    return number == EWA_FILE_U64 ? "64-bit uint" : ewa_type_name((ewa_type)number);
}

/// A decoding under way: whole blocks of numbers from piece after piece.
typedef struct decoder {
    const ewa_volume_input *in;
    const ewa_volume_header *header;
    size_t piece;
    ewa_source *source; // of the piece
    const char *text, *text_end;
    uint64_t piece_numbers, left_numbers; // of each piece; of this one
    uint64_t not_finite_count;
    ewa_volume *volume;
} decoder;

static bool is_voxel_type(int number) {
    return number == EWA_U8 || number == EWA_I8 || number == EWA_U16 || number == EWA_I16 ||
           number == EWA_F32;
}

static bool machine_is_big_endian(void) {
    const uint16_t one = 1;
    uint8_t first;
    memcpy(&first, &one, 1);
    return first == 0;
}

static void swap_numbers(uint8_t *numbers, size_t count, size_t size_bytes) {
    for (uint8_t *n = numbers; count; count--, n += size_bytes)
        for (size_t low = 0, high = size_bytes - 1; low < high; low++, high--) {
            const uint8_t byte = n[low];
            n[low] = n[high];
            n[high] = byte;
        }
}

#define READ_AS(type)                                                                                        \
    for (size_t i = 0; i < count; i++) {                                                                     \
        type number;                                                                                         \
        memcpy(&number, bytes + i * sizeof number, sizeof number);                                           \
        numbers[i] = (double)number;                                                                         \
    }                                                                                                        \
    break

static void numbers_to_doubles(int type, const uint8_t *bytes, size_t count, double *numbers) {
    switch (type) {
    case EWA_F32:
        READ_AS(float);
    case EWA_F64:
        READ_AS(double);
    case EWA_I8:
        READ_AS(int8_t);
    case EWA_U8:
        READ_AS(uint8_t);
    case EWA_I16:
        READ_AS(int16_t);
    case EWA_U16:
        READ_AS(uint16_t);
    case EWA_I32:
        READ_AS(int32_t);
    case EWA_U32:
        READ_AS(uint32_t);
    case EWA_FILE_I64:
        READ_AS(int64_t);
    default:
        READ_AS(uint64_t);
    }
}

/// Stores doubles as a voxel type, integers clamped to its range.
static void store_voxels(ewa_type type, const double *numbers, size_t count, uint8_t *voxels) {
    for (size_t i = 0; i < count; i++) {
        const double number = numbers[i];
        if (type == EWA_F32) {
            const float value = isfinite((float)number) ? (float)number : NAN;
            memcpy(voxels + 4 * i, &value, 4);
        } else if (type == EWA_U8 || type == EWA_I8) {
            const double low = type == EWA_I8 ? -128 : 0;
            voxels[i] = (uint8_t)(int)fmin(fmax(number, low), low + 255);
        } else {
            const double low = type == EWA_I16 ? -32768 : 0;
            const uint16_t value = (uint16_t)(int)fmin(fmax(number, low), low + 65535);
            memcpy(voxels + 2 * i, &value, 2);
        }
    }
}

/// Folds `count` voxels of several components to their luminance (ITU-R BT.709), in place.
static void fold_colors(uint32_t component_count, size_t count, double *numbers) {
    for (size_t i = 0; i < count; i++) {
        const double *c = numbers + i * component_count;
        numbers[i] = 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
    }
}

static ewa_status skip_lines(const decoder *job, const ewa_file *piece, size_t *at_bytes) {
    *at_bytes = 0;
    for (uint64_t line = 0; line < job->header->skipped_lines; line++) {
        const size_t left = piece->size_bytes - *at_bytes;
        const uint8_t *end = left ? memchr(piece->bytes + *at_bytes, '\n', left) : NULL;
        if (!end)
            return ewa_volume_fail(job->in, EWA_ERROR_FORMAT, "%llu lines are to be skipped, %llu are there",
                                   (unsigned long long)job->header->skipped_lines, (unsigned long long)line);
        *at_bytes = (size_t)(end - piece->bytes) + 1;
    }
    return EWA_OK;
}

/// How many bytes a piece has for its numbers, before any is unpacked, is compared with what it needs.
static ewa_status check_piece_size(const decoder *job, uint64_t packed_bytes) {
    const ewa_volume_header *header = job->header;
    const uint64_t number_bytes = ewa_file_number_bytes(header->number);
    uint64_t there, needed = job->piece_numbers * number_bytes;
    if (header->packing == EWA_PACKING_TEXT) { // a digit and a blank for each number
        there = packed_bytes / 2 + 1;
        needed = job->piece_numbers;
    } else {
        there = ewa_source_bound(header->packing, packed_bytes);
        there = there > header->skipped_bytes ? there - header->skipped_bytes : 0;
    }
    const bool exact = header->exact && header->packing == EWA_PACKING_NONE;
    if (there >= needed && (!exact || there == needed)) return EWA_OK;
    const uint64_t *dims = header->dims;
    const bool bound = header->packing != EWA_PACKING_NONE;
    return ewa_volume_fail(
        job->in, EWA_ERROR_FORMAT, "%llu x %llu x %llu voxels of %u %s%s need %llu %s, but %s%llu are there",
        (unsigned long long)dims[0], (unsigned long long)dims[1], (unsigned long long)dims[2],
        header->component_count, ewa_file_number_name(header->number),
        header->pieces.count > 1 ? " in equal files" : "", (unsigned long long)needed,
        header->packing == EWA_PACKING_TEXT ? "numbers" : "bytes", bound ? "at most " : "",
        (unsigned long long)there);
}

static ewa_status skip_bytes(const decoder *job, uint64_t count) {
    uint8_t skipped[SKIP_BYTES];
    while (count) {
        const size_t wanted = count < sizeof skipped ? (size_t)count : sizeof skipped;
        size_t got;
        EWA_TRY(ewa_source_read(job->source, skipped, wanted, &got));
        if (got < wanted)
            return ewa_volume_fail(job->in, EWA_ERROR_FORMAT, "the data end before the voxels begin");
        count -= got;
    }
    return EWA_OK;
}

static ewa_status open_piece(decoder *job) {
    const ewa_volume_header *header = job->header;
    const ewa_file *piece = &header->pieces.files[job->piece];
    size_t at_bytes;
    EWA_TRY(skip_lines(job, piece, &at_bytes));
    job->left_numbers = job->piece_numbers;
    EWA_TRY(check_piece_size(job, piece->size_bytes - at_bytes));
    if (header->packing == EWA_PACKING_TEXT) {
        job->text = (const char *)piece->bytes + at_bytes;
        job->text_end = (const char *)piece->bytes + piece->size_bytes;
        return EWA_OK;
    }
    if (header->at_end)
        at_bytes = piece->size_bytes - (size_t)(job->piece_numbers * ewa_file_number_bytes(header->number));
    EWA_TRY(ewa_source_open(job->in->context, job->in->name, header->packing, piece->bytes + at_bytes,
                            piece->size_bytes - at_bytes, &job->source));
    return skip_bytes(job, header->skipped_bytes);
}

/// After the last number of a piece: what packs it must end well, and nothing may follow where the header
/// says all.
static ewa_status close_piece(decoder *job) {
    bool more = false;
    ewa_status status = job->source ? ewa_source_settle(job->source, &more) : EWA_OK;
    if (status == EWA_OK && more && job->header->exact)
        status = ewa_volume_fail(
            job->in, EWA_ERROR_FORMAT, "more bytes than %llu x %llu x %llu voxels of %s need",
            (unsigned long long)job->header->dims[0], (unsigned long long)job->header->dims[1],
            (unsigned long long)job->header->dims[2], ewa_file_number_name(job->header->number));
    ewa_source_close(&job->source);
    job->piece++;
    return status;
}

static bool is_separator(char c) { return c == ' ' || c == ',' || (c >= '\t' && c <= '\r'); }

static ewa_status read_text(decoder *job, size_t count, double *numbers) {
    for (size_t i = 0; i < count; i++) {
        while (job->text < job->text_end && is_separator(*job->text)) job->text++;
        const char *after = ewa_number_read_f64(job->text, job->text_end, &numbers[i]);
        if (!after)
            return ewa_volume_fail(job->in, EWA_ERROR_FORMAT, "%s at number %llu of %llu",
                                   job->text < job->text_end ? "no number" : "the text ends",
                                   (unsigned long long)(job->piece_numbers - job->left_numbers + i),
                                   (unsigned long long)job->piece_numbers);
        job->text = after;
    }
    return EWA_OK;
}

static ewa_status read_binary(decoder *job, size_t count, uint8_t *bytes) {
    const size_t number_bytes = ewa_file_number_bytes(job->header->number), wanted = count * number_bytes;
    size_t got;
    EWA_TRY(ewa_source_read(job->source, bytes, wanted, &got));
    if (got < wanted)
        return ewa_volume_fail(
            job->in, EWA_ERROR_FORMAT, "the data end after %llu of %llu numbers",
            (unsigned long long)(job->piece_numbers - job->left_numbers + got / number_bytes),
            (unsigned long long)job->piece_numbers);
    if (number_bytes > 1 && job->header->big_endian != machine_is_big_endian())
        swap_numbers(bytes, count, number_bytes);
    return EWA_OK;
}

/// Reads `count` <= BLOCK_NUMBERS voxels, all of one piece, to `voxels`.
static ewa_status read_block(decoder *job, size_t count, uint8_t *bytes, double *numbers, uint8_t *voxels) {
    const ewa_volume_header *header = job->header;
    const uint32_t components = header->component_count;
    const bool scaled = header->slope != 1 || header->intercept != 0;
    const bool text = header->packing == EWA_PACKING_TEXT;
    const ewa_type type = job->volume->type;
    if (!text && !scaled && (int)type == header->number && components == 1 && type != EWA_F32)
        return read_binary(job, count, voxels);
    EWA_TRY(text ? read_text(job, count * components, numbers) : read_binary(job, count * components, bytes));
    if (!text) numbers_to_doubles(header->number, bytes, count * components, numbers);
    if (components > 1) fold_colors(components, count, numbers);
    if (scaled)
        for (size_t i = 0; i < count; i++) numbers[i] = numbers[i] * header->slope + header->intercept;
    for (size_t i = 0; i < count; i++) job->not_finite_count += !isfinite((float)numbers[i]);
    store_voxels(type, numbers, count, voxels);
    return EWA_OK;
}

static ewa_status read_voxels(decoder *job, uint64_t voxel_count) {
    ewa_context *context = job->in->context;
    const uint32_t components = job->header->component_count;
    const size_t voxel_bytes = ewa_type_bytes(job->volume->type);
    enum { ROOM = BLOCK_NUMBERS * MAX_COMPONENTS };
    uint8_t *bytes = ewa_allocate(context, ROOM, sizeof(double));
    double *numbers = ewa_allocate(context, ROOM, sizeof(double));
    ewa_status status = bytes && numbers ? EWA_OK : EWA_ERROR_MEMORY;
    uint8_t *to = job->volume->voxels;
    for (uint64_t done = 0; done < voxel_count && status == EWA_OK;) {
        if (job->left_numbers == 0) {
            status = ewa_progress(context, "load", (double)done / (double)voxel_count);
            if (status == EWA_OK) status = open_piece(job);
            if (status != EWA_OK) break;
        }
        const uint64_t left = job->left_numbers / components;
        const size_t count = left < BLOCK_NUMBERS ? (size_t)left : BLOCK_NUMBERS;
        status = read_block(job, count, bytes, numbers, to);
        job->left_numbers -= count * components;
        to += count * voxel_bytes;
        done += count;
        if (status == EWA_OK && job->left_numbers == 0) status = close_piece(job);
    }
    ewa_source_close(&job->source);
    ewa_release(context, bytes, ROOM, sizeof(double));
    ewa_release(context, numbers, ROOM, sizeof(double));
    return status;
}

static double length3(const double v[3]) { return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

static void cross3(const double a[3], const double b[3], double c[3]) {
    for (int k = 0; k < 3; k++) c[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

/// Chooses the steps of axes that the file does not have (pictures and rows of numbers): of length one,
/// across the others.
static void complete_directions(uint32_t axis_count, double directions[3][3]) {
    for (uint32_t axis = axis_count; axis < 3; axis++) memset(directions[axis], 0, sizeof directions[axis]);
    if (axis_count == 1) {
        const double *given = directions[0];
        int across = 0;
        for (int k = 1; k < 3; k++)
            if (fabs(given[k]) < fabs(given[across])) across = k;
        // Across the first axis, as near to an axis of the world as can be.
        const double length2 = given[0] * given[0] + given[1] * given[1] + given[2] * given[2];
        for (int k = 0; k < 3 && length2 > 0; k++)
            directions[1][k] = (k == across) - given[across] * given[k] / length2;
    }
    if (axis_count < 3) cross3(directions[0], directions[1], directions[2]);
    for (uint32_t axis = axis_count; axis < 3; axis++) {
        const double length = length3(directions[axis]);
        for (int k = 0; k < 3 && length > 0; k++) directions[axis][k] /= length;
    }
}

/// Works out where the voxels are; what cannot be is reported.
static ewa_status make_place(const ewa_volume_input *in, const ewa_volume_header *header,
                             const double spacing_world[3], double index_to_world[12]) {
    double directions[3][3], across[3];
    memcpy(directions, header->directions, sizeof directions);
    complete_directions(header->axis_count, directions);
    for (int axis = 0; axis < 3; axis++) {
        const double length = length3(directions[axis]);
        if (!(length > 0) || !isfinite(length) || !isfinite(header->first_world[axis]))
            return ewa_volume_fail(in, EWA_ERROR_FORMAT, "the spacing or the place along axis %d is %s", axis,
                                   length == 0 ? "zero" : "not a finite number");
        const double wanted = spacing_world[axis] > 0 ? spacing_world[axis] : length;
        for (int k = 0; k < 3; k++) directions[axis][k] *= wanted / length;
    }
    cross3(directions[0], directions[1], across);
    double determinant = 0, scale = 1;
    for (int k = 0; k < 3; k++) determinant += across[k] * directions[2][k];
    for (int axis = 0; axis < 3; axis++) scale *= length3(directions[axis]);
    if (!(fabs(determinant) > MIN_DETERMINANT * scale))
        return ewa_volume_fail(in, EWA_ERROR_FORMAT, "the axes of the voxels lie in one plane");
    for (int k = 0; k < 3; k++) {
        double middle = 0;
        for (int axis = 0; axis < 3; axis++) {
            index_to_world[4 * k + axis] = directions[axis][k] + 0.0; // no -0
            middle += 0.5 * ((double)header->dims[axis] - 1) * directions[axis][k];
        }
        index_to_world[4 * k + 3] = (header->placed ? header->first_world[k] : -middle) + 0.0;
    }
    return EWA_OK;
}

static ewa_status check_header(const ewa_volume_input *in, const ewa_volume_header *header,
                               uint64_t *voxel_count) {
    const uint64_t limit = ewa_context_limits(in->context)->max_memory_bytes, *dims = header->dims;
    *voxel_count = 1;
    if (header->number < 0) return ewa_volume_fail(in, EWA_ERROR_FORMAT, "no type of the voxels");
    if (header->pieces.count == 0) return ewa_volume_fail(in, EWA_ERROR_FORMAT, "no voxels");
    for (int axis = 0; axis < 3; axis++) {
        if (dims[axis] == 0)
            return ewa_volume_fail(in, EWA_ERROR_FORMAT, "%llu x %llu x %llu voxels",
                                   (unsigned long long)dims[0], (unsigned long long)dims[1],
                                   (unsigned long long)dims[2]);
        // Numbers have at most 8 bytes, voxels at most 4 of them.
        if (dims[axis] > UINT32_MAX || *voxel_count > limit / dims[axis] ||
            *voxel_count * dims[axis] > UINT64_MAX / 32)
            return ewa_volume_fail(
                in, EWA_ERROR_LIMIT, "%llu x %llu x %llu voxels of %s, the limit is %llu bytes",
                (unsigned long long)dims[0], (unsigned long long)dims[1], (unsigned long long)dims[2],
                ewa_file_number_name(header->number), (unsigned long long)limit);
        *voxel_count *= dims[axis];
    }
    if (*voxel_count % header->pieces.count)
        return ewa_volume_fail(in, EWA_ERROR_FORMAT, "%llu voxels do not go into %zu equal files",
                               (unsigned long long)*voxel_count, header->pieces.count);
    return EWA_OK;
}

ewa_status ewa_volume_decode(const ewa_volume_input *in, const ewa_volume_header *header,
                             const double spacing_world[3], ewa_volume *volume) {
    *volume = (ewa_volume){0};
    uint64_t voxel_count;
    double index_to_world[12];
    EWA_TRY(check_header(in, header, &voxel_count));
    EWA_TRY(make_place(in, header, spacing_world, index_to_world));
    decoder job = {.in = in, .header = header, .volume = volume};
    job.piece_numbers = voxel_count / header->pieces.count * header->component_count;
    // Before memory is asked for: the first piece can hold what it has to.
    EWA_TRY(check_piece_size(&job, header->pieces.files[0].size_bytes));
    const bool kept = is_voxel_type(header->number) && header->component_count == 1 && header->slope == 1 &&
                      header->intercept == 0;
    const uint32_t dims[3] = {(uint32_t)header->dims[0], (uint32_t)header->dims[1],
                              (uint32_t)header->dims[2]};
    EWA_TRY(ewa_volume_create(in->context, dims, kept ? (ewa_type)header->number : EWA_F32, volume));
    memcpy(volume->index_to_world, index_to_world, sizeof index_to_world);
    volume->anatomical = header->anatomical;
    ewa_status status = read_voxels(&job, voxel_count);
    if (status != EWA_OK) {
        ewa_volume_free(volume);
        return status;
    }
    if (!kept)
        ewa_report(in->context, EWA_SEVERITY_INFO, "%s: %s%s become floats", in->name,
                   ewa_file_number_name(header->number),
                   header->component_count > 1 ? " colours, as their luminance," : " numbers");
    if (job.not_finite_count)
        ewa_report(in->context, EWA_SEVERITY_WARNING,
                   "%s: %llu of %llu voxels are no finite numbers: nothing is there", in->name,
                   (unsigned long long)job.not_finite_count, (unsigned long long)voxel_count);
    return EWA_OK;
}
