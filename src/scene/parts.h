// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What scenes and assets are made of, for the files of this room.
//
// What is dear is shared by counted references: assets, groups of clouds that were completed together, and the surfels
// of everything that is visible. A copy of a scene shares them until one of the two changes.
#ifndef EWA_SRC_SCENE_PARTS_H
#define EWA_SRC_SCENE_PARTS_H

#include "ewa/scene.h"
#include "scene/region.h"
#include "volume/splat_colors.h"

#include <stdatomic.h>

typedef struct ewa_asset_stream ewa_asset_stream;

struct ewa_asset {
    ewa_context *context;
    atomic_uint_fast32_t references;
    uint64_t serial; ///< another one of each asset: one that comes later may lie where one was that is gone
    ewa_asset_kind kind;
    char *name; ///< of a file: its path as it was given
    size_t name_bytes;
    bool of_file;
    bool of_octree; ///< of a folder of one, whose name says nothing
    ewa_asset_source source; ///< of objects in memory, whose release() is called in the end

    // What a scene file says of it.
    double to_world[16];
    ewa_filter filter; ///< of no terms: all points
    char *transfer;    ///< NULL: automatic
    size_t transfer_bytes;
    ewa_octree_levels levels;
    bool gaussians_as_surfels;
    bool of_columns; ///< some were chosen, which no scene file says
    double cutoff, reach_steps;
    uint32_t voxel_level_count;

    uint64_t count;
    ewa_bounds bounds;
    double up_world[3], load_s;
    const char *up_why; ///< for which reason that is up, as ewa_upright.why; NULL: files of its kind have it
    const char *unit; ///< of its lengths, a word of ewa_scene_info.unit; NULL: nothing says it

    ewa_cloud *cloud; ///< of points and meshes; NULL: gone, or something else
    bool drawable;    ///< it has normals and radii, or axes
    bool plain;       ///< a mesh of so few colours that its form is all there is to see
    ewa_lod *lod;
    ewa_context *lod_context; ///< of its own; NULL: that of the asset
    const ewa_surfels *surfels; ///< of another owner
    ewa_splats *splats; ///< of streamed Gaussians the coarsest level
    ewa_asset_stream *stream; ///< the others; NULL: there are none
    ewa_voxels *voxels;
    bool owns_parts;    ///< the octree, the splats and the voxels are its own
    ewa_cloud *outline; ///< of octrees, Gaussians, volumes and resident surfels: places to have in the picture, with
                        ///< radii where there are some
    double near_world;  ///< of Gaussians
    bool flat;          ///< of volumes: best without light
    int view;           ///< of volumes: the ewa_named_view that suits them; -1: none does
};

/// Diameter of dots that nobody says the size of.
enum { EWA_DOT_PX = 6 };

/// Clouds of which some lack normals or radii, completed together.
typedef struct ewa_completed {
    ewa_context *context;
    atomic_uint_fast32_t references;
    uint32_t count;
    ewa_asset **assets; ///< retained, in the order of the scene
    ewa_cloud **clouds; ///< of each asset: its streams and those that were estimated
    ewa_cloud *merged;  ///< what was estimated, of several; NULL: of one
    uint64_t estimated_count;
    bool sparse; ///< no surface, all of it: radii are those of dots
    bool photographed; ///< all of it has colours and is what a camera at the origin saw, whose light they have
    double estimate_s;
} ewa_completed;

/// What regions leave of an asset of Gaussians or a volume (hidden.c).
typedef struct ewa_left_part {
    ewa_context *context;
    atomic_uint_fast32_t references;
    uint32_t region_count;
    ewa_region regions[EWA_MAX_REGIONS];
    ewa_splats *splats; ///< a view of the asset's; NULL: of a volume
    ewa_voxels *voxels; ///< NULL: of Gaussians
} ewa_left_part;

/// An instance of a scene.
typedef struct ewa_scene_item {
    ewa_asset *asset; ///< retained
    ewa_instance instance;
    ewa_completed *completed; ///< retained; NULL: not yet, or not of points
    uint32_t member;          ///< of its clouds
    ewa_left_part *left;      ///< retained; NULL: no region hides Gaussians or voxels of it, or nobody has drawn it yet
} ewa_scene_item;

/// What of an item decides how its points look as surfels.
typedef struct ewa_surface_key {
    const ewa_asset *asset; ///< not retained: it may be gone
    uint64_t serial;        ///< of the asset
    const ewa_completed *completed; ///< NULL: the asset's cloud is complete
    ewa_instance instance;
    uint32_t member; ///< of the completed clouds
} ewa_surface_key;

/// The surfels of all visible clouds and meshes.
typedef struct ewa_surface {
    ewa_context *context;
    atomic_uint_fast32_t references;
    uint32_t count, cloud_count; ///< of keys; of those that are of clouds and meshes, the first
    ewa_surface_key *keys;       ///< what it was made of
    ewa_surfels_options options;
    bool close_gaps;
    bool colored;   ///< some of it has colours, and is not plain
    bool photographed; ///< all of it is
    uint32_t region_count;
    ewa_region regions[EWA_MAX_REGIONS]; ///< that hide points
    bool as_points; ///< drawn as discs of pixels: gaps do not matter
    bool sparse;    ///< all of it is: drawn so unless somebody says how
    ewa_surfels *surfels;
    ewa_surfels_info info;
    uint32_t legend_count;
    ewa_legend *legends;
    uint32_t *legend_of; ///< of each key: of `legends`; UINT32_MAX: none
    ewa_splat_colors **splat_colors; ///< of each key that is of Gaussians; else NULL
    double surfels_s, estimate_s;
} ewa_surface;

struct ewa_scene {
    ewa_context *context;
    ewa_scene_options options;
    ewa_scene_item *items;
    uint32_t count, capacity;
    bool complete, committed, points_gone;
    uint32_t ups_told; ///< items of which was said that they have not the same up
    ewa_surface *surface; ///< retained; NULL: none
    bool has_camera;
    ewa_camera camera; ///< from where it is seen, unless somebody says otherwise
    ewa_measure *measures;
    uint32_t measure_count;
    ewa_camera *keyframes;
    uint32_t keyframe_count;
};

/// What of an item is drawn; NULL: it has none.
static inline const ewa_splats *ewa_item_splats(const ewa_scene_item *item) {
    return item->left ? item->left->splats : item->asset->splats;
}
static inline const ewa_voxels *ewa_item_voxels(const ewa_scene_item *item) {
    return item->left ? item->left->voxels : item->asset->voxels;
}

/// Whether instances of an asset are part of the one surface of points.
static inline bool ewa_asset_is_points(const ewa_asset *asset) {
    return asset->kind == EWA_ASSET_POINTS || asset->kind == EWA_ASSET_MESH;
}

/// Whether opacity, radius scale and material of an instance count, too.
static inline bool ewa_asset_is_changeable(const ewa_asset *asset) {
    return ewa_asset_is_points(asset) || asset->kind == EWA_ASSET_OCTREE;
}

/// Whether the colouring of an instance counts.
static inline bool ewa_asset_is_colorable(const ewa_asset *asset) {
    return ewa_asset_is_changeable(asset) || asset->kind == EWA_ASSET_GAUSSIANS;
}

/// Whether coordinates lie elsewhere in the scene than in the asset's file.
static inline bool ewa_asset_is_moved(const ewa_asset *asset) {
    bool moved = false;
    for (int i = 0; i < 16; i++) moved = moved || asset->to_world[i] != (i % 5 == 0);
    return moved;
}

/// Takes options of an asset, with their defaults, and checks the map. Errors: EWA_ERROR_ARGUMENT.
ewa_status ewa_asset_take_options(ewa_context *context, const ewa_asset_options *given, ewa_asset_options *options);

/// Makes a cloud over points [first, first + count) of another, whose streams stay where they are; with its origin,
/// grid and notes.
ewa_status ewa_cloud_view(ewa_context *context, const ewa_cloud *cloud, uint64_t first, uint64_t count,
                          ewa_cloud **view);

/// Replaces a cloud by one of the points that a filter takes.
ewa_status ewa_cloud_filter(ewa_context *context, const ewa_filter *filter, ewa_cloud **cloud);

/// Gives clouds that become one the same kinds of colours, axes and materials, and leaves nothing that is not drawn.
/// Discs become axes for kernels that end at `cutoff`.
ewa_status ewa_clouds_make_alike(ewa_cloud *const *clouds, uint32_t count, double cutoff);

/// Replaces a cloud's colours, or their absence, by linear floats with alpha, which all colours can become.
ewa_status ewa_cloud_colors_to_linear(ewa_cloud *cloud);

/// Gives the items of points what they lack (complete.c).
ewa_status ewa_scene_complete_items(ewa_scene *scene);
void ewa_completed_release(ewa_completed **completed);

/// Makes what the regions of a scene leave of its Gaussians and volumes.
ewa_status ewa_scene_hide_parts(ewa_scene *scene);
/// Makes what they leave of splats, or, where these are NULL, of voxels.
ewa_status ewa_left_part_make(ewa_context *context, const ewa_scene_options *options, const ewa_splats *splats, const ewa_voxels *voxels,
                              ewa_left_part **part);
/// Whether that is what the regions leave; of NULL, whether there are none.
bool ewa_left_part_is_of(const ewa_left_part *part, const ewa_scene_options *options);
void ewa_left_part_release(ewa_left_part **part);

/// Does what ewa_scene_commit() does, but for looking whether octrees can be drawn with the scene's own options.
ewa_status ewa_scene_make_resident(ewa_scene *scene);

/// Makes one cloud of the visible points, as ewa_surface_gather(), of a scene that may not be complete yet.
ewa_status ewa_scene_gather(ewa_scene *scene, bool closed, ewa_cloud **cloud);

/// Makes the surfels of all visible items of points (surface.c).
ewa_status ewa_surface_make(ewa_scene *scene, ewa_surface **surface);
/// Makes one cloud of them, the caller's, whose gaps are `closed` as those of the surface are, or not yet; NULL: there are
/// none. The scene is complete.
ewa_status ewa_surface_gather(ewa_scene *scene, bool closed, ewa_cloud **cloud);
bool ewa_surface_is_of(const ewa_surface *surface, const ewa_scene *scene);
void ewa_surface_release(ewa_surface **surface);

/// Makes one cloud of all places, with radii, that a camera has to have in its picture (outline.c), maybe of a box
/// where there is nothing; `*made`: it is the caller's to destroy.
ewa_status ewa_scene_outline(ewa_scene *scene, ewa_cloud **outline, bool *made);

/// Finds what is up without anything being estimated, where options, files or their kind say so (view.c). Errors: those of
/// ewa_scene_place_camera().
ewa_status ewa_scene_find_up(ewa_scene *scene, double up_world[3]);

/// Says what the colours of the visible points mean without any surfels: `*surface` has legends only (surface.c).
ewa_status ewa_surface_make_legends(ewa_scene *scene, ewa_surface **surface);
/// What the colours of an asset's points mean; NULL: they are their own.
const ewa_legend *ewa_surface_legend(const ewa_surface *surface, const ewa_asset *asset);
/// The colours of an asset's Gaussians in place of their own; NULL: these.
const ewa_splat_colors *ewa_surface_splat_colors(const ewa_surface *surface, const ewa_asset *asset);

/// Whether the points of an octree have colours.
bool ewa_asset_has_colors(const ewa_asset *asset);

/// Leaves out the strengths of light of a cloud that another one lacks.
void ewa_cloud_drop_signals(ewa_cloud *cloud, const ewa_cloud *kept);

/// Whether a word means the points' own colours, or, of scans without any, a number: empty or "auto".
bool ewa_coloring_is_auto(const char *attribute);

/// Has scans whose colouring is automatic, and that have no colours, coloured by a strength of light, or by height where
/// that is the same everywhere: sets the attribute and the range of their colourings. Reorders both lists.
ewa_status ewa_colorings_choose(ewa_cloud **clouds, uint32_t count, ewa_coloring **colorings);

/// Takes a colouring, and checks what its table cannot say. Errors: EWA_ERROR_ARGUMENT.
ewa_status ewa_coloring_take(ewa_context *context, const ewa_coloring *given, ewa_coloring *taken);

/// Whether two colourings give the same colours.
bool ewa_colorings_agree(const ewa_coloring *a, const ewa_coloring *b);

/// Which colours numbers have.
typedef struct ewa_color_scale {
    ewa_colormap colormap;
    bool classes;    ///< whole numbers, by ewa_class_color()
    double range[2]; ///< of the first and the last colour, where there are no classes
} ewa_color_scale;

ewa_color_scale ewa_color_scale_of(const ewa_legend *legend);

/// Replaces a cloud's colours by those of its numbers, and counts those that have none and are grey.
ewa_status ewa_cloud_color_by(ewa_cloud *cloud, const ewa_scalar *scalar, const ewa_color_scale *scale,
                              uint64_t *grey_count);

/// Gives all points of a cloud one colour.
ewa_status ewa_cloud_tint(ewa_cloud *cloud, const double srgb[3]);

/// Multiplies the alpha of a cloud's colours, and sets the material of its points unless it is EWA_MATERIAL_OWN.
ewa_status ewa_cloud_set_appearance(ewa_cloud *cloud, double opacity, uint32_t material);

#endif
