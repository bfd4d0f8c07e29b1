// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The state of the paper's pipeline: surfels as rows of vertices, the packets of a band as runs of them, the pictures
// that are drawn into, and programs.
#ifndef EWA_SRC_GL_RASTER_H
#define EWA_SRC_GL_RASTER_H

#include "gl/memory.h"
#include "surface/backend.h"
#include "surface/job.h"

/// What is drawn of splats.
typedef enum ewa_raster_pass {
    EWA_RASTER_VISIBILITY, ///< the nearest z + eps, by MAX
    EWA_RASTER_SUMS,       ///< by ADD
    EWA_RASTER_MATERIALS,  ///< the same of the numbers of materials
    EWA_RASTER_SINGLE,     ///< one pass: the nearest splat, by the test of depths
    EWA_RASTER_PASSES
} ewa_raster_pass;

/// How splats are drawn.
typedef enum ewa_raster_form {
    EWA_RASTER_ELLIPSES,
    EWA_RASTER_RAYCAST, ///< the kernel of that name
    EWA_RASTER_NEAR,    ///< by pixel rays: surfels at the eye's plane
    EWA_RASTER_FORMS
} ewa_raster_form;

/// What is made of sums.
typedef enum ewa_raster_stage {
    EWA_RASTER_COMPOSE, ///< a surface, under those before it
    EWA_RASTER_PLANES,  ///< its normal, depth and coverage
    EWA_RASTER_CUT,     ///< what clip lines leave of it, for the surface behind it
    EWA_RASTER_PEEL,    ///< where more is wanted
    EWA_RASTER_BROKEN,  ///< pixels without a colour
    EWA_RASTER_PICTURE,
    EWA_RASTER_STAGES
} ewa_raster_stage;

/// Pictures of the device.
typedef enum ewa_raster_picture {
    EWA_PICTURE_NEAREST, ///< R32F: largest key of z + eps
    EWA_PICTURE_PASSED,  ///< R32F: keys below are wanted
    EWA_PICTURE_COLOR,   ///< RGBA32F: sums of colour, weight
    EWA_PICTURE_NORMAL,  ///< RGBA32F: sums of normal, depth
    EWA_PICTURE_CUT,     ///< RGBA32F: of what clip lines cut: kept weight, whole weight, direction
    EWA_PICTURE_OPACITY, ///< R32F: sums of weight times opacity
    EWA_PICTURE_COLOR_TURNED,
    EWA_PICTURE_NORMAL_TURNED,
    EWA_PICTURE_OPACITY_TURNED,
    EWA_PICTURE_COMPOSED, ///< RGBA32F: premultiplied
    EWA_PICTURE_FIRST_CUT,
    EWA_PICTURE_BESIDE,     ///< no picture of these, but where programs see clip lines or the environment
    EWA_PICTURE_MATERIAL,   ///< RGBA32F: sums of ambient, diffuse, specular, shininess
    EWA_PICTURE_REFLECTION, ///< R32F
    EWA_PICTURE_MATERIAL_TURNED,
    EWA_PICTURE_REFLECTION_TURNED,
    EWA_PICTURE_DEPTH,    ///< of EWA_RASTER_SINGLE
    EWA_PICTURE_PLANES,   ///< RGBA32F: normal, depth
    EWA_PICTURE_COVERAGE, ///< R32F
    EWA_PICTURE_CODES,    ///< RGBA8
    EWA_PICTURE_FLOATS,   ///< RGBA32F: over the background
    EWA_PICTURES
} ewa_raster_picture;

/// Frame buffers.
typedef enum ewa_raster_target {
    EWA_TARGET_NEAREST,
    EWA_TARGET_SUMS,
    EWA_TARGET_TURNED, ///< with the cuts of EWA_TARGET_SUMS
    EWA_TARGET_MATERIAL,
    EWA_TARGET_MATERIAL_TURNED,
    EWA_TARGET_COMPOSED,
    EWA_TARGET_PASSED,
    EWA_TARGET_FIRST_CUT,
    EWA_TARGET_PLANES,
    EWA_TARGET_PICTURE,
    EWA_TARGETS
} ewa_raster_target;

/// Pictures of one size, and the frame buffers that draw into them. Zero-initialise.
typedef struct ewa_raster_targets {
    GLuint pictures[EWA_PICTURES], targets[EWA_TARGETS];
    uint32_t width_px, height_px;
    uint32_t made; ///< bit per picture
} ewa_raster_targets;

/// A surfel as vertices have it (ewa_packet).
typedef struct ewa_raster_surfel {
    float x, y, z, sigma;
    int16_t oct_x, oct_y;
    uint16_t angle, ratio;
    uint16_t red, green, blue, opacity;
} ewa_raster_surfel;

/// Packets [first, first + count) of some surfels.
typedef struct ewa_raster_page {
    ewa_gl_buffer surfels, materials; ///< materials: a code each; 0: all have the same
    uint32_t first, count;
} ewa_raster_page;

/// Surfels that are on the device.
typedef struct ewa_raster_resident {
    uint64_t serial, used, size_bytes;
    ewa_raster_page *pages;
    uint32_t page_count;
    GLuint lines; ///< RGBA32F: three texels for each surfel with clip lines; 0: none has
} ewa_raster_resident;

/// All that are there. Zero-initialise.
typedef struct ewa_raster_residents {
    ewa_buffer items; ///< ewa_raster_resident
    uint32_t count;
    uint64_t frame, size_bytes;
} ewa_raster_residents;

/// A packet of a band as vertices have it.
typedef struct ewa_raster_packet {
    float base_px[2]; ///< where its slope is in the band
    float slope[2];
    float rest[2], depth, pad; ///< ewa_packet_places
    uint32_t form;             ///< of its colours
    uint32_t lanes;            ///< a bit per surfel | those that section planes cut << 16
    uint32_t own;              ///< a bit per surfel that has clip lines of its own
    uint32_t first_line;       ///< of them, among those of all surfels
} ewa_raster_packet;

/// Neighbouring packets that are drawn at once.
typedef struct ewa_raster_run {
    uint32_t source, page;
    uint32_t first, count; ///< packets of the page
    uint32_t record;       ///< of the first, in ewa_raster_band.packets
    bool near;             ///< some surfels may be drawn by pixel rays
} ewa_raster_run;

/// Rows of the picture. Zero-initialise.
typedef struct ewa_raster_band {
    uint32_t first_row_px, end_row_px;
    ewa_buffer packets, runs, live;
    uint32_t packet_count, run_count;
    uint64_t surfel_count;
} ewa_raster_band;

/// Uniform blocks; src/gl/shaders/raster_scene.glsl and raster_surface.glsl tell the forms.
typedef struct ewa_raster_view {
    float rotation[3][4], focal[4], zoomed[4], kernel[4], depth[4], point[4], sums[4], place[4];
    float sections[EWA_MAX_SECTION_PLANES][4];
    uint32_t flags[4];
} ewa_raster_view;

typedef struct ewa_raster_resolve {
    float scales[4], units[4], material[4], background[4], rays[4], to_world[3][4];
    float toward[EWA_MAX_LIGHTS][4], light[EWA_MAX_LIGHTS][4];
    float material_units[4], reflection[4], environment_from_camera[3][4];
    uint32_t flags[4], levels[EWA_MAX_ENVIRONMENT_LEVELS][4];
} ewa_raster_resolve;

/// The key of what is nowhere: below that of anything.
#define EWA_RASTER_NEVER (-3e38)

enum {
    EWA_RASTER_ATTRIBUTES = 8,    ///< of vertices
    EWA_RASTER_VIEW_STRIDE = 512, ///< bytes between views of sources
    EWA_RASTER_TRANSLUCENT =
        512 ///< in ewa_raster_view.flags, beside those of ewa_gl_view: surfels have opacities
};

typedef struct ewa_raster {
    ewa_context *context;
    ewa_gl *device;
    ewa_job_room room;
    ewa_raster_residents residents;
    ewa_raster_targets targets;
    ewa_raster_band band;
    ewa_buffer indices, views; ///< of sources
    ewa_buffer row;            ///< of numbers on their way
    ewa_gl_buffer packets, view_blocks, resolve_block, material_block;
    GLuint vertices, query, environment;
    GLuint splats[EWA_RASTER_PASSES][EWA_RASTER_FORMS][2]; ///< [..][with clip lines]; 0: not yet made
    GLuint stages[EWA_RASTER_STAGES][2];
} ewa_raster;

/// Returns a program, made when it is first asked for. Errors: EWA_ERROR_UNSUPPORTED.
ewa_status ewa_raster_splat_program(ewa_raster *raster, ewa_raster_pass pass, ewa_raster_form form,
                                    bool with_clips, GLuint *program);
ewa_status ewa_raster_stage_program(ewa_raster *raster, ewa_raster_stage stage, bool with_clips,
                                    GLuint *program);
void ewa_raster_programs_free(ewa_raster *raster);

/// Makes the pictures that are wanted, a bit for each, of a size, and their frame buffers. Errors:
/// EWA_ERROR_MEMORY, EWA_ERROR_UNSUPPORTED (they cannot be drawn into).
ewa_status ewa_raster_targets_reserve(ewa_gl *device, ewa_raster_targets *targets, uint32_t width_px,
                                      uint32_t height_px, uint32_t wanted);
void ewa_raster_targets_free(ewa_raster_targets *targets);

/// Begins a frame: what the one before did not use may go.
void ewa_raster_residents_start(ewa_gl *device, ewa_raster_residents *residents);

/// Returns surfels, copied when they are not there; they stay during the frame. Errors: EWA_ERROR_MEMORY,
/// EWA_ERROR_LIMIT.
ewa_status ewa_raster_residents_get(ewa_gl *device, ewa_raster_residents *residents,
                                    const ewa_surfels *surfels, uint32_t *index);

static inline const ewa_raster_resident *ewa_raster_residents_at(const ewa_raster_residents *residents,
                                                                 uint32_t index) {
    return (const ewa_raster_resident *)residents->items.data + index;
}

void ewa_raster_residents_free(ewa_gl *device, ewa_raster_residents *residents);

/// Lists the packets that the rows see. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_raster_band_start(ewa_context *context, ewa_raster_band *band, const ewa_tile_job *job,
                                 uint32_t first_row_px, uint32_t end_row_px);
void ewa_raster_band_free(ewa_context *context, ewa_raster_band *band);

/// What programs see of a source, or of the frame, in a band.
void ewa_raster_view_set(ewa_raster_view *to, const ewa_view *from, const ewa_tile_job *job,
                         const ewa_raster_band *band);
void ewa_raster_resolve_set(ewa_raster_resolve *to, const ewa_tile_job *job, const ewa_raster_band *band);

/// Draws the splats of the band that `turned` says: those that face the viewer, those that do not, or all
/// (visibility). `behind`: only those beyond EWA_PICTURE_PASSED. `whole`: whatever EWA_PICTURE_NEAREST says.
ewa_status ewa_raster_draw_splats(ewa_raster *raster, const ewa_tile_job *job, ewa_raster_pass pass,
                                  bool turned, bool behind, bool whole);

/// As ewa_backend has them.
ewa_status ewa_raster_create(ewa_context *context, void **state);
void ewa_raster_destroy(ewa_context *context, void *state);
ewa_status ewa_raster_draw(void *state, const ewa_render_job *frame, ewa_render_stats *stats);

#endif
