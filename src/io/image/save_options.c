// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What writers of pictures are told beside the pixels, for all formats.
#include "base/options.h"
#include "ewa/io.h"

#include <stddef.h>

#define AT(member) offsetof(ewa_image_save_options, member)

static const ewa_option option_rows[] = {
    {"exr_half", EWA_OPTION_BOOL, AT(exr_half), .help = "EXR: store half floats"},
    {"srgb_alpha_straight", EWA_OPTION_BOOL, AT(srgb_alpha_straight), .initial = true,
     .help = "PNG, JPEG: un-premultiply before encoding"},
    {"jpeg_quality", EWA_OPTION_U32, AT(jpeg_quality), 0, 100, .initial = 95,
     .help = "JPEG: from 0 (small) to 100 (good), on libjpeg's scale"},
};

const ewa_option_table ewa_image_save_options_table = EWA_OPTION_TABLE(ewa_image_save_options, option_rows);

void ewa_image_save_options_init(ewa_image_save_options *options, size_t struct_size) {
    ewa_options_init(&ewa_image_save_options_table, options, struct_size);
}
