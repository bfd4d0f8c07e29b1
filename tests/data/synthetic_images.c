// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Pictures: PNG of every depth, interlaced or not, and broken ones; PFM; OpenEXR in tiles and with subsampled
// channels.
#include "tests/data/synthetic_data.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

/// Bytes that grow.
typedef struct bytes {
    uint8_t *data;
    size_t size, room;
} bytes;

static void add(bytes *to, const void *data, size_t size) {
    if (to->size + size > to->room) {
        to->room = 2 * (to->size + size);
        to->data = realloc(to->data, to->room);
        if (!to->data) exit(1);
    }
    if (size) memcpy(to->data + to->size, data, size);
    to->size += size;
}

static void add_byte(bytes *to, uint32_t value) {
    const uint8_t byte = (uint8_t)value;
    add(to, &byte, 1);
}

static void add_big(bytes *to, uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) add_byte(to, value >> shift);
}

static void add_little(bytes *to, uint64_t value, int size) {
    for (int i = 0; i < size; i++) add_byte(to, (uint32_t)(value >> (8 * i)));
}

static void add_float(bytes *to, float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    add_little(to, bits, 4);
}

// ---- PNG

typedef struct png {
    uint32_t width, height, bits, type;
    bool interlaced, transparent;
} png;

static uint32_t png_channels(uint32_t type) { return type == 2 ? 3 : type == 4 ? 2 : type == 6 ? 4 : 1; }

/// The number of a channel, of as many bits as the picture has; those of 16 bits that tests look at are those
/// of the suite that this stands for.
static uint32_t png_sample(const png *made, uint32_t x, uint32_t y, uint32_t channel) {
    const uint32_t maximum = made->bits == 16 ? 65535 : (1u << made->bits) - 1;
    if (made->type == 3) return (x + 3 * y) % (maximum < 31 ? maximum + 1 : 32);
    if (made->bits == 16 && made->type == 0) return x * 2304 + y * 64 > 65535 ? 65535 : x * 2304 + y * 64;
    return (uint32_t)(maximum * synthetic_noise(5000 * channel + 100 * y + x));
}

static void png_chunk(bytes *file, const char *name, const bytes *data) {
    bytes checked = {0};
    add(&checked, name, 4);
    add(&checked, data->data, data->size);
    add_big(file, (uint32_t)data->size);
    add(file, checked.data, checked.size);
    add_big(file, (uint32_t)crc32(0, checked.data, (uInt)checked.size));
    free(checked.data);
}

/// One pass of the rows: pixels from (x0, y0) in steps.
static void png_rows(const png *made, uint32_t x0, uint32_t y0, uint32_t dx, uint32_t dy, bytes *rows) {
    const uint32_t channels = png_channels(made->type);
    for (uint32_t y = y0; y < made->height && x0 < made->width; y += dy) {
        add_byte(rows, 0); // no filter
        uint32_t held = 0, count = 0;
        for (uint32_t x = x0; x < made->width; x += dx)
            for (uint32_t c = 0; c < channels; c++) {
                const uint32_t sample = png_sample(made, x, y, c);
                if (made->bits == 16) add_byte(rows, sample >> 8);
                if (made->bits >= 8) {
                    add_byte(rows, sample);
                    continue;
                }
                held = held << made->bits | sample, count += made->bits;
                if (count == 8) add_byte(rows, held), held = count = 0;
            }
        if (count) add_byte(rows, held << (8 - count));
    }
}

static bytes png_make(const png *made) {
    static const uint32_t passes[7][4] = {{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4},
                                          {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2}};
    bytes file = {0}, part = {0}, rows = {0};
    add(&file, "\x89PNG\r\n\x1a\n", 8);
    add_big(&part, made->width), add_big(&part, made->height);
    add_byte(&part, made->bits), add_byte(&part, made->type);
    add_byte(&part, 0), add_byte(&part, 0), add_byte(&part, made->interlaced);
    png_chunk(&file, "IHDR", &part);
    part.size = 0;
    for (uint32_t i = 0; made->type == 3 && i < 1u << made->bits && i < 32; i++)
        for (uint32_t c = 0; c < 3; c++) add_byte(&part, (uint32_t)(256 * synthetic_noise(3 * i + c)));
    if (made->type == 3) png_chunk(&file, "PLTE", &part);
    part.size = 0;
    add_byte(&part, 0);
    if (made->transparent) png_chunk(&file, "tRNS", &part);
    if (made->interlaced)
        for (int i = 0; i < 7; i++)
            png_rows(made, passes[i][0], passes[i][1], passes[i][2], passes[i][3], &rows);
    else
        png_rows(made, 0, 0, 1, 1, &rows);
    uLongf packed_size = compressBound((uLong)rows.size);
    part.size = 0;
    bytes packed = {synthetic_memory(packed_size), packed_size, packed_size};
    if (compress2(packed.data, &packed_size, rows.data, (uLong)rows.size, 6) != Z_OK) exit(1);
    packed.size = packed_size;
    png_chunk(&file, "IDAT", &packed);
    png_chunk(&file, "IEND", &part);
    free(packed.data), free(rows.data), free(part.data);
    return file;
}

static void put_png_suite(const char *folder) {
    static const struct {
        uint32_t type, bits;
        const char *name;
    } kinds[] = {{0, 1, "0g01"}, {0, 2, "0g02"},  {0, 4, "0g04"},  {0, 8, "0g08"}, {0, 16, "0g16"},
                 {2, 8, "2c08"}, {2, 16, "2c16"}, {3, 1, "3p01"},  {3, 2, "3p02"}, {3, 4, "3p04"},
                 {3, 8, "3p08"}, {4, 8, "4a08"},  {4, 16, "4a16"}, {6, 8, "6a08"}, {6, 16, "6a16"}};
    char path[128];
    for (size_t i = 0; i < 2 * sizeof kinds / sizeof *kinds; i++) {
        const png made = {32, 32, kinds[i / 2].bits, kinds[i / 2].type, i % 2, false};
        bytes file = png_make(&made);
        snprintf(path, sizeof path, "images/pngsuite/bas%c%s.png", i % 2 ? 'i' : 'n', kinds[i / 2].name);
        synthetic_put(folder, path, file.data, file.size);
        free(file.data);
    }
    const png palette = {32, 32, 8, 3, false, true};
    bytes file = png_make(&palette);
    synthetic_put(folder, "images/pngsuite/tbbn3p08.png", file.data, file.size);
    synthetic_put(folder, "images/camera.png", file.data, file.size);
    free(file.data);
}

static void put_broken_pngs(const char *folder) {
    const png made = {32, 32, 8, 2, false, false};
    static const struct {
        const char *name;
        size_t at;
        uint8_t value;
    } changes[] = {{"badcrc.png", 31, 0x55},     {"signature.png", 1, 'Q'}, {"no_width.png", 19, 0},
                   {"three_bits.png", 24, 3},    {"type_five.png", 25, 5},  {"method.png", 26, 1},
                   {"interlace_two.png", 28, 2}, {"no_head.png", 12, 'J'},  {"huge_chunk.png", 33, 0x7f},
                   {"stream.png", 43, 0xff}};
    char path[128];
    for (size_t i = 0; i < sizeof changes / sizeof *changes; i++) {
        bytes file = png_make(&made);
        file.data[changes[i].at] = changes[i].value;
        snprintf(path, sizeof path, "hostile/png/%s", changes[i].name);
        synthetic_put(folder, path, file.data, i == 9 ? file.size / 2 : file.size);
        free(file.data);
    }
}

/// Depths in millimetres: a floor that comes nearer downwards, and the numbers that tests look at.
static void put_depth(const char *folder, const char *relative, uint32_t width, uint32_t height) {
    bytes file = {0}, part = {0}, rows = {0};
    for (uint32_t y = 0; y < height; y++) {
        add_byte(&rows, 0);
        for (uint32_t x = 0; x < width; x++) {
            uint32_t depth = 3000 - 2 * y + x % 7;
            if (x == 300 && y == 200) depth = 2248;
            if (x == 101 && y == 100) depth = 1370;
            add_byte(&rows, depth >> 8), add_byte(&rows, depth);
        }
    }
    add(&file, "\x89PNG\r\n\x1a\n", 8);
    add_big(&part, width), add_big(&part, height);
    add(&part, "\x10\0\0\0\0", 5);
    png_chunk(&file, "IHDR", &part);
    uLongf packed_size = compressBound((uLong)rows.size);
    bytes packed = {synthetic_memory(packed_size), packed_size, packed_size};
    if (compress2(packed.data, &packed_size, rows.data, (uLong)rows.size, 6) != Z_OK) exit(1);
    packed.size = packed_size;
    part.size = 0;
    png_chunk(&file, "IDAT", &packed);
    png_chunk(&file, "IEND", &part);
    synthetic_put(folder, relative, file.data, file.size);
    free(packed.data), free(rows.data), free(part.data), free(file.data);
}

// ---- Floats

/// Disparities of a stereo pair: larger below, with holes. Rows of PFM run upwards.
static void put_disparities(const char *folder) {
    bytes file = {0};
    add(&file, "Pf\n741 500\n-1.0\n", 16);
    for (uint32_t row = 0; row < 500; row++)
        for (uint32_t x = 0; x < 741; x++)
            add_float(&file,
                      x % 50 == 7 ? INFINITY : 20 + 0.1f * (float)(499 - row) + 0.01f * (float)(x % 9));
    synthetic_put(folder, "rgbd/stereo/motorcycle_disp.pfm", file.data, file.size);
    free(file.data);
}

static void exr_attribute(bytes *file, const char *name, const char *type, const bytes *value) {
    add(file, name, strlen(name) + 1);
    add(file, type, strlen(type) + 1);
    add_little(file, value->size, 4);
    add(file, value->data, value->size);
}

/// Everything up to the offsets of the chunks. `channels` are names of one letter or two, with their
/// subsampling.
static bytes exr_head(uint32_t width, uint32_t height, const char *const *channels, const int *sampling,
                      int count, uint32_t tile) {
    bytes file = {0}, value = {0};
    add_little(&file, 20000630, 4);
    add_little(&file, tile ? 0x202 : 2, 4);
    for (int i = 0; i < count; i++) {
        add(&value, channels[i], strlen(channels[i]) + 1);
        add_little(&value, 1, 4); // half
        add_little(&value, 0, 4);
        add_little(&value, (uint64_t)sampling[i], 4), add_little(&value, (uint64_t)sampling[i], 4);
    }
    add_byte(&value, 0);
    exr_attribute(&file, "channels", "chlist", &value);
    value.size = 0, add_byte(&value, 0);
    exr_attribute(&file, "compression", "compression", &value);
    value.size = 0;
    add_little(&value, 0, 8), add_little(&value, width - 1, 4), add_little(&value, height - 1, 4);
    exr_attribute(&file, "dataWindow", "box2i", &value);
    exr_attribute(&file, "displayWindow", "box2i", &value);
    value.size = 0, add_byte(&value, 0);
    exr_attribute(&file, "lineOrder", "lineOrder", &value);
    value.size = 0, add_float(&value, 1);
    exr_attribute(&file, "pixelAspectRatio", "float", &value);
    exr_attribute(&file, "screenWindowWidth", "float", &value);
    value.size = 0, add_little(&value, 0, 8);
    exr_attribute(&file, "screenWindowCenter", "v2f", &value);
    value.size = 0;
    add_little(&value, tile, 4), add_little(&value, tile, 4), add_byte(&value, 1); // levels of half the size
    if (tile) exr_attribute(&file, "tiles", "tiledesc", &value);
    add_byte(&file, 0);
    free(value.data);
    return file;
}

static const uint16_t HALF_ONE = 0x3c00;

/// Lights that are nowhere dark, in tiles, with levels.
static void put_tiled_exr(const char *folder) {
    static const char *const names[] = {"B", "G", "R"};
    static const int sampling[] = {1, 1, 1};
    enum { WIDTH = 256, HEIGHT = 1536, TILE = 64, LEVELS = 11 };
    bytes file = exr_head(WIDTH, HEIGHT, names, sampling, 3, TILE), chunks = {0}, offsets = {0};
    uint64_t count = 0;
    for (int pass = 0; pass < 2; pass++) // the offsets come first, and say where the tiles are
        for (uint32_t level = 0; level < LEVELS; level++) {
            const uint32_t width = WIDTH >> level ? WIDTH >> level : 1, height = HEIGHT >> level;
            for (uint32_t y = 0; y < height; y += TILE)
                for (uint32_t x = 0; x < width; x += TILE) {
                    if (pass == 0) {
                        count++;
                        continue;
                    }
                    const uint32_t columns = width - x < TILE ? width - x : TILE,
                                   rows = height - y < TILE ? height - y : TILE;
                    add_little(&offsets, file.size + 8 * count + chunks.size, 8);
                    add_little(&chunks, x / TILE, 4), add_little(&chunks, y / TILE, 4);
                    add_little(&chunks, level, 4), add_little(&chunks, level, 4);
                    add_little(&chunks, 6ull * columns * rows, 4);
                    for (uint32_t i = 0; i < 3 * columns * rows; i++)
                        add_little(&chunks, HALF_ONE - i % 512, 2);
                }
        }
    add(&file, offsets.data, offsets.size);
    add(&file, chunks.data, chunks.size);
    synthetic_put(folder, "images/env/KernerEnvCube.exr", file.data, file.size);
    free(offsets.data), free(chunks.data), free(file.data);
}

/// Luminance with chroma for every second pixel of every second row.
static void put_luminance_exr(const char *folder) {
    static const char *const names[] = {"BY", "RY", "Y"};
    static const int sampling[] = {2, 2, 1};
    enum { SIDE = 16 };
    bytes file = exr_head(SIDE, SIDE, names, sampling, 3, 0), chunks = {0}, offsets = {0};
    for (uint32_t y = 0; y < SIDE; y++) {
        const uint32_t numbers = SIDE + (y % 2 ? 0 : SIDE);
        add_little(&offsets, file.size + 8 * SIDE + chunks.size, 8);
        add_little(&chunks, y, 4), add_little(&chunks, 2 * numbers, 4);
        for (uint32_t i = 0; i < numbers; i++) add_little(&chunks, HALF_ONE, 2);
    }
    add(&file, offsets.data, offsets.size);
    add(&file, chunks.data, chunks.size);
    synthetic_put(folder, "images/exr_sample.exr", file.data, file.size);
    free(offsets.data), free(chunks.data), free(file.data);
}

/// The picture above, cut and changed.
static void put_broken_exrs(const char *folder) {
    static const char *const names[] = {"Y"};
    static const int sampling[] = {1};
    char path[128];
    for (uint64_t i = 0; i < 24; i++) {
        bytes file = exr_head(16, 16, names, sampling, 1, 0);
        const size_t head = file.size;
        for (uint32_t y = 0; y < 16; y++) add_little(&file, head + 128 + 40ull * y, 8);
        for (uint32_t y = 0; y < 16; y++) {
            add_little(&file, y, 4), add_little(&file, 32, 4);
            for (uint32_t x = 0; x < 16; x++) add_little(&file, HALF_ONE, 2);
        }
        // Cut in head, table and rows, or a byte changed among the sizes.
        if (i < 12)
            file.size = file.size * (i + 1) / 14;
        else
            file.data[4 + (size_t)(synthetic_noise(i) * (double)(head - 4))] ^= 0x80;
        snprintf(path, sizeof path, "hostile/exr/broken_%02u.exr", (unsigned)i);
        synthetic_put(folder, path, file.data, file.size);
        free(file.data);
    }
}

void synthetic_images(const char *folder) {
    put_png_suite(folder);
    put_broken_pngs(folder);
    put_depth(folder, "rgbd/livingroom/depth/00000.png", 640, 480);
    put_depth(folder, "rgbd/sensor_sequence/frame-000065.depth.png", 320, 120);
    for (int i = 0; i < 5; i++) {
        char path[128];
        snprintf(path, sizeof path, "rgbd/posed_lego/train/r_%d.png", i);
        const png made = {800, 800, 8, 0, false, false};
        bytes file = png_make(&made);
        synthetic_put(folder, path, file.data, file.size);
        free(file.data);
    }
    put_disparities(folder);
    put_tiled_exr(folder);
    put_luminance_exr(folder);
    put_broken_exrs(folder);
}
