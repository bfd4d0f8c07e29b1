// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// NIfTI-1 and NIfTI-2 headers, and Analyze 7.5, which NIfTI-1 grew from. Based on: R. Cox et al., nifti1.h,
// 2004 (methods 1 to 3 of the orientation), nifti2.h, 2015.
#include "base/base.h"
#include "base/platform.h"
#include "io/volume/file.h"

#include <limits.h>
#include <math.h>
#include <string.h>

enum {
    HEADER1_BYTES = 348,
    HEADER2_BYTES = 540,
    MAX_AXES = 7,
    EXTENSION_BYTES = 4, // at least, between the header and the voxels of one file
};

/// What both versions say.
typedef struct nifti {
    const uint8_t *bytes;
    bool swapped, second; // NIfTI-2
    bool nifti, detached; // Analyze: neither magic
    int64_t dims[MAX_AXES + 1];
    double steps[MAX_AXES + 1]; // "pixdim"
    double offset_bytes, slope, intercept;
    int type, qform_code, sform_code;
    double quaternion[3], shift[3], rows[3][4];
} nifti;

static uint64_t read_bits(const nifti *file, size_t at, size_t size_bytes) {
    uint64_t bits = 0;
    for (size_t i = 0; i < size_bytes; i++) {
        const size_t from = file->swapped ? i : size_bytes - 1 - i; // "swapped": the highest byte first
        bits = bits << 8 | file->bytes[at + from];
    }
    return bits;
}

static int read_i16(const nifti *file, size_t at) { return (int16_t)read_bits(file, at, 2); }

static int read_i32(const nifti *file, size_t at) { return (int32_t)read_bits(file, at, 4); }

/// A float of NIfTI-1 or a double of NIfTI-2; `index` counts from the number at `at`.
static double read_real(const nifti *file, size_t at, size_t index) {
    if (file->second) {
        const uint64_t bits = read_bits(file, at + 8 * index, 8);
        double value;
        memcpy(&value, &bits, sizeof value);
        return value;
    }
    const uint32_t bits = (uint32_t)read_bits(file, at + 4 * index, 4);
    float value;
    memcpy(&value, &bits, sizeof value);
    return (double)value;
}

/// Takes the fields from their places in either version.
static void read_fields(nifti *file) {
    const bool second = file->second;
    for (size_t i = 0; i <= MAX_AXES; i++) {
        file->dims[i] = second ? (int64_t)read_bits(file, 16 + 8 * i, 8) : read_i16(file, 40 + 2 * i);
        file->steps[i] = read_real(file, second ? 104 : 76, i);
    }
    file->type = read_i16(file, second ? 12 : 70);
    file->offset_bytes = second ? (double)(int64_t)read_bits(file, 168, 8) : read_real(file, 108, 0);
    file->slope = read_real(file, second ? 176 : 112, 0);
    file->intercept = read_real(file, second ? 184 : 116, 0);
    if (!file->nifti) return;
    file->qform_code = second ? read_i32(file, 344) : read_i16(file, 252);
    file->sform_code = second ? read_i32(file, 348) : read_i16(file, 254);
    for (size_t k = 0; k < 3; k++) {
        file->quaternion[k] = read_real(file, second ? 352 : 256, k);
        file->shift[k] = read_real(file, second ? 376 : 268, k);
        for (size_t c = 0; c < 4; c++) file->rows[k][c] = read_real(file, second ? 400 : 280, 4 * k + c);
    }
}

/// Finds version and byte order from the first HEADER2_BYTES bytes, fewer at the end of a file; false when
/// it is none such.
static bool read_magic(const uint8_t *bytes, size_t size_bytes, nifti *file) {
    *file = (nifti){.bytes = bytes};
    if (size_bytes < HEADER1_BYTES) return false;
    const uint32_t size = (uint32_t)read_bits(file, 0, 4);
    const uint32_t turned = size >> 24 | (size >> 8 & 0xff00) | (size << 8 & 0xff0000) | size << 24;
    file->swapped = size != HEADER1_BYTES && size != HEADER2_BYTES;
    const uint32_t said = file->swapped ? turned : size;
    file->second = said == HEADER2_BYTES;
    if (said != HEADER1_BYTES && !file->second) return false;
    const uint8_t *magic = bytes + (file->second ? 4 : 344);
    const char version = file->second ? '2' : '1';
    file->nifti = magic[0] == 'n' && (magic[1] == '+' || magic[1] == 'i') && magic[2] == version && !magic[3];
    file->detached = !file->nifti || magic[1] == 'i';
    if (file->second) return file->nifti && size_bytes >= HEADER2_BYTES;
    // Analyze has no magic: the count of axes must make sense.
    const int axis_count = read_i16(file, 40);
    return file->nifti || (axis_count >= 1 && axis_count <= MAX_AXES);
}

static bool is_gzip(const uint8_t *bytes, size_t size_bytes) {
    return size_bytes >= 2 && bytes[0] == 0x1f && bytes[1] == 0x8b;
}

/// The beginning of a file, unpacked to `head` when it is in gzip.
static ewa_status find_head(const ewa_volume_input *in, uint8_t head[HEADER2_BYTES], const uint8_t **bytes,
                            size_t *size_bytes) {
    *bytes = in->bytes;
    *size_bytes = in->size_bytes;
    if (!is_gzip(in->bytes, in->size_bytes)) return EWA_OK;
    ewa_source *source;
    EWA_TRY(ewa_source_open(in->context, in->name, EWA_PACKING_DEFLATE, in->bytes, in->size_bytes, &source));
    ewa_status status = ewa_source_read(source, head, HEADER2_BYTES, size_bytes);
    ewa_source_close(&source);
    *bytes = head;
    return status;
}

ewa_status ewa_nifti_recognise(const ewa_volume_input *in, bool *is_nifti) {
    uint8_t head[HEADER2_BYTES];
    const uint8_t *bytes;
    size_t size_bytes;
    nifti file;
    const ewa_status status = find_head(in, head, &bytes, &size_bytes);
    *is_nifti = status == EWA_OK && read_magic(bytes, size_bytes, &file);
    return status;
}

static ewa_status take_type(const ewa_volume_input *in, int type, ewa_volume_header *header) {
    static const struct {
        int code, number;
        uint32_t component_count;
    } types[] = {
        {2, EWA_U8, 1},    {4, EWA_I16, 1},         {8, EWA_I32, 1},         {16, EWA_F32, 1},
        {64, EWA_F64, 1},  {128, EWA_U8, 3},        {256, EWA_I8, 1},        {512, EWA_U16, 1},
        {768, EWA_U32, 1}, {1024, EWA_FILE_I64, 1}, {1280, EWA_FILE_U64, 1}, {2304, EWA_U8, 4},
    };
    for (size_t i = 0; i < sizeof types / sizeof types[0]; i++) {
        if (types[i].code != type) continue;
        header->number = types[i].number;
        header->component_count = types[i].component_count;
        return EWA_OK;
    }
    return ewa_volume_fail(in, EWA_ERROR_UNSUPPORTED, "NIfTI: data type %d", type);
}

static ewa_status take_dims(const ewa_volume_input *in, const nifti *file, ewa_volume_header *header) {
    const int64_t axis_count = file->dims[0];
    if (axis_count < 1 || axis_count > MAX_AXES)
        return ewa_volume_fail(in, EWA_ERROR_FORMAT, "NIfTI: %lld axes", (long long)axis_count);
    uint64_t volumes = 1;
    for (int64_t axis = 1; axis <= axis_count; axis++) {
        const int64_t size = file->dims[axis];
        if (size < 1)
            return ewa_volume_fail(in, EWA_ERROR_FORMAT, "NIfTI: axis %lld has %lld entries", (long long)axis,
                                   (long long)size);
        if (axis <= 3) header->dims[axis - 1] = (uint64_t)size;
        if (axis > 3 && (uint64_t)size > 1 && volumes < UINT32_MAX) volumes *= (uint64_t)size & UINT32_MAX;
    }
    if (volumes > 1)
        ewa_report(in->context, EWA_SEVERITY_WARNING, "%s: the first of %llu volumes is read", in->name,
                   (unsigned long long)volumes);
    return EWA_OK;
}

/// Method 2: a rotation by a unit quaternion, steps, a shift. Columns of `m` are the steps.
static void place_by_quaternion(const nifti *file, double m[3][4]) {
    double b = file->quaternion[0], c = file->quaternion[1], d = file->quaternion[2];
    double a = 1 - (b * b + c * c + d * d);
    if (a < 1e-7) { // a half turn, not quite of length one
        const double scale = 1 / sqrt(b * b + c * c + d * d);
        a = 0;
        b *= scale;
        c *= scale;
        d *= scale;
    } else {
        a = sqrt(a);
    }
    const double rotation[3][3] = {{a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)},
                                   {2 * (b * c + a * d), a * a + c * c - b * b - d * d, 2 * (c * d - a * b)},
                                   {2 * (b * d - a * c), 2 * (c * d + a * b), a * a + d * d - c * c - b * b}};
    for (int k = 0; k < 3; k++) {
        for (int axis = 0; axis < 3; axis++) m[k][axis] = rotation[k][axis] * fabs(file->steps[axis + 1]);
        if (file->steps[0] < 0) m[k][2] = -m[k][2];
        m[k][3] = file->shift[k];
    }
}

/// NIfTI's world is right-anterior-superior; ours is left-posterior-superior.
static void take_place(const nifti *file, ewa_volume_header *header) {
    double m[3][4] = {{0}};
    if (file->sform_code > 0) {
        memcpy(m, file->rows, sizeof m);
    } else if (file->qform_code > 0) {
        place_by_quaternion(file, m);
    } else {
        for (int axis = 0; axis < 3; axis++) m[axis][axis] = fabs(file->steps[axis + 1]);
    }
    header->axis_count = file->dims[0] < 3 ? (uint32_t)file->dims[0] : 3;
    header->placed = file->sform_code > 0 || file->qform_code > 0;
    header->anatomical = header->placed;
    for (int k = 0; k < 3; k++) {
        // Without a place nothing says that the axes are a patient's: they stay as they are.
        const double mirror = header->placed && k < 2 ? -1 : 1;
        for (int axis = 0; axis < 3; axis++) header->directions[axis][k] = mirror * m[k][axis];
        header->first_world[k] = mirror * m[k][3];
    }
}

/// Adds the .img file that belongs to a .hdr file, also when one of them is in gzip.
static ewa_status add_image_file(const ewa_volume_input *in, ewa_volume_header *header) {
    if (!in->path)
        return ewa_volume_fail(in, EWA_ERROR_UNSUPPORTED,
                               "NIfTI: the voxels are in another file, which needs the name of this one");
    const char *base = ewa_platform_file_name(in->path);
    char name[EWA_PATH_BYTES];
    size_t length = strlen(base);
    if (length > 3 && strcmp(base + length - 3, ".gz") == 0) length -= 3;
    if (length < 5 || length >= sizeof name - 8 || strncmp(base + length - 4, ".hdr", 4) != 0)
        return ewa_volume_fail(in, EWA_ERROR_FORMAT,
                               "NIfTI: the voxels are in another file, but the name of "
                               "this one does not end in .hdr");
    memcpy(name, base, length - 3);
    memcpy(name + length - 3, "img", 4);
    if (!ewa_volume_has_file(in, name)) memcpy(name + length, ".gz", 4);
    EWA_TRY(ewa_volume_add_file(in, name, &header->pieces));
    if (is_gzip(header->pieces.files[0].bytes, header->pieces.files[0].size_bytes))
        header->packing = EWA_PACKING_DEFLATE;
    return EWA_OK;
}

static ewa_status parse_header(const ewa_volume_input *in, const nifti *file, ewa_volume_header *header) {
    EWA_TRY(take_type(in, file->type, header));
    EWA_TRY(take_dims(in, file, header));
    header->big_endian = file->swapped;
    if (file->nifti && file->slope != 0 && isfinite(file->slope) && isfinite(file->intercept)) {
        header->slope = file->slope;
        header->intercept = file->intercept;
    }
    take_place(file, header);
    if (!(file->offset_bytes >= 0) || file->offset_bytes > 1e15)
        return ewa_volume_fail(in, EWA_ERROR_FORMAT, "NIfTI: voxels at byte %g", file->offset_bytes);
    header->skipped_bytes = (uint64_t)file->offset_bytes;
    if (file->detached) return EWA_OK;
    const uint64_t minimum = (file->second ? HEADER2_BYTES : HEADER1_BYTES) + EXTENSION_BYTES;
    if (header->skipped_bytes < minimum) header->skipped_bytes = minimum;
    return EWA_OK;
}

ewa_status ewa_nifti_parse(const ewa_volume_input *in, ewa_volume_header *header) {
    uint8_t head[HEADER2_BYTES];
    const uint8_t *bytes;
    size_t size_bytes;
    EWA_TRY(find_head(in, head, &bytes, &size_bytes));
    nifti file;
    if (!read_magic(bytes, size_bytes, &file))
        return ewa_volume_fail(in, EWA_ERROR_FORMAT, "NIfTI: no header");
    read_fields(&file);
    EWA_TRY(parse_header(in, &file, header));
    if (file.detached) return add_image_file(in, header);
    if (bytes == head) header->packing = EWA_PACKING_DEFLATE;
    return ewa_volume_add_bytes(in, in->bytes, in->size_bytes, &header->pieces);
}
