#include "lod/build.h"
ewa_status ewa_lod_part_write(ewa_lod_builder *b, const char *out, uint32_t subset, uint32_t subset_count) {
    (void)b;
    (void)out;
    (void)subset;
    (void)subset_count;
    return EWA_ERROR_UNSUPPORTED;
}
