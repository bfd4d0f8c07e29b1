// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Fuzz target: any bytes as a scene file; what can be read has members with places and values.
#include "fuzz.h"
#include "io/scene_text.h"

#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size_bytes) {
    ewa_context *context = fuzz_context(1, 0, NULL);
    ewa_scene_text text;
    (void)ewa_scene_text_probe(bytes, size_bytes);
    if (ewa_scene_text_read(context, "fuzz", bytes, size_bytes, &text) == EWA_OK) {
        for (size_t i = 0; i < text.member_count; i++) {
            char place[EWA_SCENE_PLACE_BYTES];
            ewa_scene_text_place(&text.members[i], place);
            const char *value = ewa_scene_text_value(&text, &text.members[i]);
            if (value + strlen(value) >= text.values + text.values_size || !place[0]) abort();
        }
        ewa_scene_text_free(&text);
    }
    ewa_context_destroy(&context);
    return 0;
}
