// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The scene: everything that a picture shows, from any files and objects, with what belongs to each and to the
// whole; and its pictures. What is shown is decided here and nowhere else: program, viewer, Python and ranks hand
// over files, options and a camera, and get the same bytes. docs/scene.md.
//
// The words are those of ANARI and OSPRay: a scene (their world) has instances of assets; a renderer draws a frame
// of it by a camera. An asset is immutable and shared, so that a scene is made anew cheaply when an instance changes.
#ifndef EWA_SCENE_H
#define EWA_SCENE_H

#include "ewa/cluster.h"
#include "ewa/coloring.h"
#include "ewa/framing.h"
#include "ewa/furniture.h"
#include "ewa/gpu.h"
#include "ewa/lod.h"
#include "ewa/measure.h"
#include "ewa/mixture.h"
#include "ewa/model.h"
#include "ewa/photos.h"
#include "ewa/region.h"
#include "ewa/select.h"

#ifdef __cplusplus
extern "C" {
#endif

/// What an asset is.
typedef enum ewa_asset_kind {
    EWA_ASSET_POINTS = 0,    ///< a cloud, drawn as a surface
    EWA_ASSET_MESH = 1,      ///< points on the faces of a mesh, drawn as a surface
    EWA_ASSET_SURFELS = 2,   ///< a surface that is resident already
    EWA_ASSET_OCTREE = 3,    ///< points of a file that stay there, drawn as a surface from the levels of an octree
    EWA_ASSET_GAUSSIANS = 4, ///< trained Gaussians
    EWA_ASSET_VOLUME = 5,    ///< voxels under a transfer function
} ewa_asset_kind;

/// Returns "points", "mesh", "surfels", "octree", "gaussians" or "volume". Any thread.
EWA_API const char *ewa_asset_kind_name(ewa_asset_kind kind);

/// Whether octrees (COPC, EPT) are drawn from their levels.
typedef enum ewa_octree_levels {
    EWA_OCTREE_AUTO = 0,   ///< those of more than EWA_OCTREE_WHOLE_POINTS points are, unless all are needed: by a filter or columns
    EWA_OCTREE_ALWAYS = 1, ///< whatever their size
    EWA_OCTREE_NEVER = 2,  ///< they are read whole, as any other file
} ewa_octree_levels;

enum {
    EWA_OCTREE_WHOLE_POINTS = 4000000,  ///< octrees of more are drawn from their levels
    EWA_OCTREE_SAMPLE_POINTS = 400000, ///< of an octree stand for the whole where a camera is placed
    EWA_SCENE_MAX_INSTANCES = 65536,
};

/// Reads a file that the library does not: fills `model` and sets `*taken` for a file that is its own, leaves both for
/// all others. On the thread that loads. Returns EWA_OK or, after reporting, an error.
typedef ewa_status ewa_asset_reader(void *user, ewa_context *context, const char *path, ewa_model *model, bool *taken);

/// How something becomes an asset. Fill with ewa_asset_options_init().
typedef struct ewa_asset_options {
    size_t struct_size;
    const ewa_cloud_load_options *load; ///< of files of points, borrowed during the call; default NULL: its defaults
    const ewa_filter *filter;           ///< which points are taken, borrowed during the call; default NULL: all
    /// Where its coordinates lie in the scene: row-major, acts on columns, affine and invertible, last row 0 0 0 1;
    /// default: where they are.
    double to_world[16];
    bool gaussians_as_surfels; ///< trained Gaussians become a surface, in their constant colours; default false
    bool gaussian_levels;      ///< trained Gaussians get levels (ewa_splats_create()), but for streamed ones, which have some; default false
    ewa_octree_levels levels;  ///< default EWA_OCTREE_AUTO
    double cutoff;             ///< F that axes of a mesh's points are made for; (0, 4]; default 3
    /// Of volumes: a file of a transfer function or the name of a preset, borrowed during the call; default NULL, as
    /// "auto": ewa_transfer_automatic().
    const char *transfer;
    uint32_t voxel_level_count; ///< of volumes: ewa_voxels_options.level_count; [1, EWA_MAX_VOLUME_LEVELS]; default 1
    uint32_t voxel_level_minimum; ///< as many at least, for pictures while something moves: no scene file says so; default 1
    double reach_steps;      ///< of volumes: how far a voxel's footprint counts, steps of the grid; [0, 64], default 1.8
    /// Octrees get a context of their own, like the one that loads, so that they can be drawn while that loads other
    /// files; default false
    bool own_context;
    ewa_asset_reader *reader; ///< for files that the library does not read; default NULL: none
    void *reader_user;
} ewa_asset_options;

EWA_API extern const ewa_option_table ewa_asset_options_table;
EWA_API void ewa_asset_options_init(ewa_asset_options *options, size_t struct_size);

/// Returns whether a map can be ewa_asset_options.to_world: row-major, finite, of last row 0 0 0 1, its determinant neither
/// zero nor infinite. Any thread.
EWA_API bool ewa_asset_map_is_valid(const double to_world[16]);

/// Objects that become an asset: exactly one of the pointers before `outline` is set. All are borrowed until `release`
/// is called, but for those that are converted, which are needed during the call only.
typedef struct ewa_asset_source {
    const char *name;              ///< for messages and descriptions; copied; NULL: the kind's name
    const ewa_cloud *cloud;        ///< with or without normals and radii; its streams are borrowed
    const ewa_surfels *surfels;    ///< borrowed
    ewa_lod *lod;                  ///< borrowed; one thread at a time may use it
    const ewa_splats *splats;      ///< borrowed
    const ewa_voxels *voxels;      ///< borrowed
    const ewa_mesh *mesh;          ///< converted: points on its faces
    const ewa_gaussians *gaussians; ///< converted
    const ewa_volume *volume;      ///< converted; or, beside `voxels`, what they were made of: from where they are seen
    /// Of `volume`: what it looks like, needed during the call only; NULL: as ewa_asset_options.transfer says.
    const ewa_transfer *transfer;
    const ewa_cloud *outline;      ///< of splats and voxels: places where something can be seen; borrowed
    double up_world[3];            ///< what is up, where something says so; zeros: nothing does
    bool flat;                     ///< of `voxels` and `transfer`: they look best without light
    void (*release)(void *user);   ///< called when the asset is gone, also after a failure; NULL: nobody asks
    void *user;
} ewa_asset_source;

/// What can be drawn: immutable once made, counted references. May be shared by scenes of any contexts, by one thread
/// at a time.
typedef struct ewa_asset ewa_asset;

/// Facts about an asset.
typedef struct ewa_asset_info {
    ewa_asset_kind kind;
    const char *name;      ///< stays as long as the asset
    uint64_t count;        ///< points, surfels, Gaussians or voxels
    ewa_bounds bounds;     ///< of their centres; of Gaussians without far floaters
    const ewa_cloud *cloud; ///< of points and meshes, while they are kept (ewa_scene_options.keep_points); else NULL
    ewa_lod *lod;           ///< of an octree; else NULL
    const ewa_surfels *surfels; ///< of what was resident; else NULL
    const ewa_splats *splats;   ///< of Gaussians; else NULL
    const ewa_voxels *voxels;   ///< of a volume; else NULL
    double up_world[3];     ///< what is up, as the file says; zeros: it does not
    double load_s;          ///< what loading took
    bool drawable;          ///< points have normals and radii, or axes, of their own
    bool
        changeable; ///< opacity, radius scale, material and colouring of instances count: points, meshes, octrees
    bool colorable; ///< the colouring of instances counts: those, and Gaussians
} ewa_asset_info;

/// Loads a file of any kind: points, meshes, octrees, Gaussians, volumes. The kind goes by content, of volumes by the
/// suffix. Messages begin with the path. The caller releases `*asset`, which is NULL after a failure. `options` may be
/// NULL. Errors: those of the readers (ewa_model_load(), ewa_gaussians_load(), ewa_volume_load(), ewa_lod_open()),
/// EWA_ERROR_ARGUMENT (to_world), EWA_ERROR_FORMAT (no points, no finite voxel), EWA_ERROR_UNSUPPORTED.
EWA_API ewa_status ewa_asset_load(ewa_context *context, const char *path, const ewa_asset_options *options,
                                  ewa_asset **asset);

/// Says what ewa_asset_load() would make of a file, of which only what tells it is read: EWA_ASSET_POINTS of a mesh, too.
/// `options` may be NULL. Errors: those of ewa_lod_open(), EWA_ERROR_ARGUMENT, EWA_ERROR_UNSUPPORTED (another folder).
EWA_API ewa_status ewa_asset_probe(ewa_context *context, const char *path, const ewa_asset_options *options,
                                   ewa_asset_kind *kind);

/// Makes an asset of objects in memory. As ewa_asset_load().
EWA_API ewa_status ewa_asset_create(ewa_context *context, const ewa_asset_source *source,
                                    const ewa_asset_options *options, ewa_asset **asset);

/// Counts one more reference; returns the asset.
EWA_API ewa_asset *ewa_asset_retain(ewa_asset *asset);

/// Gives one reference back, with the last one the asset; sets `*asset` to NULL; accepts NULL and a pointer to NULL.
EWA_API void ewa_asset_release(ewa_asset **asset);

EWA_API void ewa_asset_describe(const ewa_asset *asset, ewa_asset_info *info);

/// Says what is up in a scene of one asset, and from where it is seen, as ewa_scene_place_camera() finds it where nobody
/// says otherwise. Errors: EWA_ERROR_ARGUMENT (nothing is there, or its points are gone), EWA_ERROR_NUMERIC,
/// EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_asset_find_upright(const ewa_asset *asset, ewa_upright *upright);

/// What is up in a scene.
typedef enum ewa_scene_up {
    EWA_UP_AUTO = 0, ///< as the files say, else as what they show stands (ewa_framing_choose())
    EWA_UP_Y = 1,
    EWA_UP_Z = 2,
    EWA_UP_MINUS_Y = 3, ///< y down and z ahead, as cameras have it
    EWA_UP_MINUS_Z = 4,
} ewa_scene_up;

/// How a scene is made and drawn; what is documented here is the default of every door. Fill with
/// ewa_scene_options_init().
typedef struct ewa_scene_options {
    size_t struct_size;
    ewa_scene_up up;
    /// Measures radii anew where those of files leave gaps between the surfels: a median below 1 spacing; default true
    bool close_gaps;
    bool keep_points;            ///< clouds stay in memory beside their surfels, for picks and changes; default true
    bool shade_volumes;          ///< volumes get the light that suits their transfer function, whatever
                                 ///< `volumes.shading` is: none for "fog" and "gray", else Phong; default true
    ewa_surfels_options surfels; ///< of all surfaces
    ewa_lod_options lod;         ///< of all octrees together
    ewa_render_options render;   ///< of the picture; `background` (default: opaque white), sections and lights are those
                                 ///< of Gaussians and volumes, too; `opacity` and `layers` are of surfaces
    ewa_gaussian_options gaussians; ///< of Gaussians; `near_world` 0 (default): as suits them
    ewa_volume_options volumes;     ///< of volumes; `level`: of those that have as many
    /// Hide points of clouds, meshes and octrees, Gaussians and voxels by their centres, in pictures, picks, profiles and what is
    /// written (ewa_scene_points(), ewa_scene_gaussians(), ewa_scene_volume()); those of the scene's own options count, whatever
    /// ewa_scene_draw() is given. Colours, estimates and cameras stay those of the whole.
    ewa_region regions[EWA_MAX_REGIONS];
    uint32_t region_count; ///< of `regions`; [0, EWA_MAX_REGIONS]; default 0
    /// Many frames of the scene follow, as of a film: surfels in memory are drawn by levels of detail where the picture is expected
    /// to be off by no more than a third of `lod.error` (root of the mean square over all pixels), 1/255 by default. The renderer
    /// makes the levels for the first frame that they are enough for. Without effect where `render` has a level, a budget, a point
    /// size or a supersampling other than 1, and on panoramas. Default false: by all surfels
    bool many_frames;
} ewa_scene_options;

EWA_API extern const ewa_option_table ewa_scene_options_table;
EWA_API void ewa_scene_options_init(ewa_scene_options *options, size_t struct_size);

/// An asset in a scene. Octrees that are drawn from their levels are coloured and filtered by what their representatives
/// have, too (places, normals, radii, colours); by all else with ewa_lod_options.error 0, or where there are none: else
/// EWA_ERROR_UNSUPPORTED when it is drawn. Fill with ewa_instance_init().
typedef struct ewa_instance {
    size_t struct_size;
    bool visible;         ///< default true
    double opacity;       ///< of a surface's points, times their own; [0, 1]; default 1
    double radius_scale;  ///< of a surface's radii, beside that of all; (0, 100]; default 1
    uint32_t material;    ///< of all points of a surface, 0 to 255; EWA_MATERIAL_OWN (default): as each says
    ewa_coloring coloring; ///< of a surface's points, and of Gaussians by what ewa_gaussians_to_cloud() has of them; default:
                           ///< their own colours
} ewa_instance;

#define EWA_MATERIAL_OWN UINT32_MAX

EWA_API extern const ewa_option_table ewa_instance_table;
EWA_API void ewa_instance_init(ewa_instance *instance, size_t struct_size);

/// A scene: instances of assets in an order that changes no pixel.
typedef struct ewa_scene ewa_scene;

/// Makes an empty scene. `options` may be NULL. The caller destroys `*scene`. Errors: EWA_ERROR_ARGUMENT,
/// EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_scene_create(ewa_context *context, const ewa_scene_options *options, ewa_scene **scene);
EWA_API void ewa_scene_destroy(ewa_scene **scene);

/// Makes a scene of the same instances and options, which shares all that has been made for them: to be changed while
/// the other one is drawn. `context`: of the copy, for the thread that uses it. Errors: EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_scene_copy(const ewa_scene *scene, ewa_context *context, ewa_scene **copy);

/// Has a scene share what has been made for another one, as far as it is of the same assets, shown in the same way.
EWA_API void ewa_scene_reuse(ewa_scene *scene, const ewa_scene *other);

/// Adds an asset, of which the scene holds a reference. `instance` may be NULL. Its number, from 0 on, is the count of
/// instances before. Errors: EWA_ERROR_ARGUMENT, EWA_ERROR_LIMIT (EWA_SCENE_MAX_INSTANCES), EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_scene_add(ewa_scene *scene, ewa_asset *asset, const ewa_instance *instance);

/// Takes instance `index` out; those behind it move up. Errors: EWA_ERROR_ARGUMENT.
EWA_API ewa_status ewa_scene_remove(ewa_scene *scene, uint32_t index);

EWA_API uint32_t ewa_scene_count(const ewa_scene *scene);

/// Returns the asset of instance `index`, borrowed; NULL: there is none.
EWA_API ewa_asset *ewa_scene_asset(const ewa_scene *scene, uint32_t index);

/// Reads and changes how instance `index` is shown. Errors: EWA_ERROR_ARGUMENT.
EWA_API ewa_status ewa_scene_get(const ewa_scene *scene, uint32_t index, ewa_instance *instance);
EWA_API ewa_status ewa_scene_set(ewa_scene *scene, uint32_t index, const ewa_instance *instance);

/// Reads and changes the options. Errors: EWA_ERROR_ARGUMENT.
EWA_API void ewa_scene_get_options(const ewa_scene *scene, ewa_scene_options *options);
EWA_API ewa_status ewa_scene_set_options(ewa_scene *scene, const ewa_scene_options *options);

/// Makes what surfels need and points lack. Clouds that lack it and overlap or touch, whether visible or not, are
/// estimated together, as if they were one file, which an info message says. Called by what needs it. Errors: those of
/// ewa_cloud_estimate(); EWA_ERROR_UNSUPPORTED (columns of Gaussians without what Gaussians need).
EWA_API ewa_status ewa_scene_complete(ewa_scene *scene);

/// Makes one cloud of all visible clouds and meshes: of what ewa_scene_commit() makes surfels, with what they lacked, before
/// gaps are closed. The caller destroys `*cloud`. Errors: those of ewa_scene_commit(); EWA_ERROR_ARGUMENT (no points are
/// visible, or they are gone).
EWA_API ewa_status ewa_scene_cloud(ewa_scene *scene, ewa_cloud **cloud);

/// Makes one cloud of the points of all that is visible, with every attribute and number of their files, without those that
/// regions hide and sections cut away; of octrees all points. The caller destroys `*cloud`, which may have no points. Errors:
/// EWA_ERROR_ARGUMENT (points that are gone), those of ewa_lod_read() and ewa_cloud_merge().
EWA_API ewa_status ewa_scene_points(ewa_scene *scene, ewa_cloud **cloud);

/// Reads the file of the visible Gaussians again, without those that regions hide and sections cut away, every number as the file
/// has it, moved as the item is; `up_world` (may be NULL): what the file says is up, zeros where it does not. The caller frees
/// `*gaussians`, zeroed after a failure. Errors: EWA_ERROR_ARGUMENT (not one set of Gaussians is visible), EWA_ERROR_UNSUPPORTED
/// (it was made in memory), those of ewa_gaussians_load().
EWA_API ewa_status ewa_scene_gaussians(const ewa_scene *scene, ewa_gaussians *gaussians, double up_world[3]);

/// Reads the file of the visible volume again: the smallest grid around those voxels that no region hides and no section cuts
/// away, moved as the item is. Others within have the lowest number that the transfer function leaves empty, of floats NaN. The
/// caller frees `*volume`, zeroed after a failure. Errors: EWA_ERROR_ARGUMENT (not one volume is visible, nothing of it is left),
/// EWA_ERROR_UNSUPPORTED (it was made in memory), those of ewa_volume_load() and ewa_transfer_choose().
EWA_API ewa_status ewa_scene_volume(const ewa_scene *scene, ewa_volume *volume);

/// Makes a cloud of the centres ("position", doubles, world units) of the Gaussians and voxels that are resident, visible, neither
/// hidden by regions nor cut away by sections: all, or evenly some, up to `limit` > 0; `*count` is how many there are. The
/// caller destroys `*cloud`, NULL after a failure. Errors: EWA_ERROR_ARGUMENT, EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_scene_centers(const ewa_scene *scene, uint64_t limit, ewa_cloud **cloud, uint64_t *count);

/// Makes everything resident that is visible: all clouds and meshes become one set of surfels, as if they were one
/// file, coloured and measured as the instances say. Called by ewa_scene_draw() and ewa_scene_pick(). Without
/// keep_points the clouds are gone afterwards, and instances of points can no longer change. Errors: those of
/// ewa_surfels_create() and ewa_scene_complete(); EWA_ERROR_ARGUMENT (an attribute that is not there),
/// EWA_ERROR_FORMAT (nothing can be drawn of any cloud), EWA_ERROR_UNSUPPORTED (an octree that cannot be drawn as its
/// instance says with the scene's `lod` options).
EWA_API ewa_status ewa_scene_commit(ewa_scene *scene);

/// What a scene is, and what making it took.
typedef struct ewa_scene_info {
    uint32_t instance_count, visible_count;
    uint64_t point_count;      ///< points, Gaussians and points of octrees that are visible
    bool surfaces, octrees, gaussians, volumes; ///< some are visible
    bool gaussian_levels;      ///< some of those Gaussians have levels (ewa_gaussian_options.merge_px)
    ewa_surfels_info surfels;  ///< of the committed surfaces; zeros: none
    const ewa_surfels *resident; ///< those surfels, borrowed until the scene changes; NULL: none
    /// Of its lengths: "m", "ft" or "US ft" (1200/3937 m), as the reference systems of what is visible say; NULL: they do not, or
    /// differently. Lives as long as the program.
    const char *unit;
    uint64_t estimated_count;  ///< points that got normals or radii
    double load_s, estimate_s, surfels_s; ///< wall clock, of all assets and of this scene
} ewa_scene_info;

EWA_API void ewa_scene_describe(const ewa_scene *scene, ewa_scene_info *info);

/// Measures the box of all visible centres. Never fails: finite_count 0 where there is nothing.
EWA_API void ewa_scene_bounds(const ewa_scene *scene, ewa_bounds *bounds);

/// Sets the measurements of a scene, copies of `count` in `measures`; they change no picture, and scene files keep them. Errors:
/// EWA_ERROR_ARGUMENT (more than EWA_MAX_MEASURES; one that ewa_places_measure() does not take, or without an end of its name),
/// EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_scene_set_measures(ewa_scene *scene, const ewa_measure *measures, uint32_t count);
/// Returns measurement `index`, borrowed until they are set again; NULL: there is none.
EWA_API const ewa_measure *ewa_scene_measure(const ewa_scene *scene, uint32_t index);

enum { EWA_MAX_KEYFRAMES = 64 }; ///< of a scene

/// Sets the keyframes of a scene, copies of `count` cameras through which its films go; they change no picture, and scene files keep
/// them. Errors: EWA_ERROR_ARGUMENT (more than EWA_MAX_KEYFRAMES), those of ewa_camera_check(), EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_scene_set_keyframes(ewa_scene *scene, const ewa_camera *keyframes, uint32_t count);
/// Returns keyframe `index`, borrowed until they are set again; NULL: there is none.
EWA_API const ewa_camera *ewa_scene_keyframe(const ewa_scene *scene, uint32_t index);

/// Returns what the colours of instance `index` mean, borrowed until the scene changes; NULL: they are the points' own,
/// or the scene is not committed.
EWA_API const ewa_legend *ewa_scene_legend(const ewa_scene *scene, uint32_t index);

/// Vertical field of view of cameras where nobody says.
#define EWA_VIEW_FOV_DEG 30.0

/// How a camera is placed where no file says. Fill with ewa_view_options_init().
typedef struct ewa_view_options {
    size_t struct_size;
    uint32_t width_px, height_px;  ///< of the picture; [1, 65536], or both 0 (default): those of the scene's camera, else
                                   ///< 1280 x 720
    double fov_deg;                ///< vertical field of view; [0, 180); 0 (default): EWA_VIEW_FOV_DEG, but for what a
                                   ///< camera at the origin took, which is seen from there as wide as it is
    double ortho_height_world;     ///< an orthographic camera that shows so much; [0, inf); 0 (default): perspective
    int32_t view;                  ///< ewa_named_view; -1 (default): as suits what is seen
    double up_world[3];            ///< up in the picture; zeros (default): the scene's
    bool has_eye, has_target;      ///< whether the next two are given; default false
    double eye_world[3];           ///< default: so that all is in the picture
    double target_world[3];        ///< default: the middle
    double azimuth_deg;            ///< carries the camera about the up axis; [-360, 360]; default 0
    double elevation_deg;          ///< then raises it; [-180, 180]; default 0
    bool turntable;                ///< all must be in the picture in every turn about the axis; default false
    double direction_world[3];     ///< in which it looks, any length, in place of `view`; zeros (default): as `view` says
    bool color_bar;                ///< room is left for a colour bar where all is put into the picture; default off
} ewa_view_options;

EWA_API extern const ewa_option_table ewa_view_options_table;
EWA_API void ewa_view_options_init(ewa_view_options *options, size_t struct_size);

/// What was chosen for a camera.
typedef struct ewa_view_info {
    ewa_upright upright;    ///< what is up, from where it is seen, and why
    double up_world[3];     ///< unit axis that is up, of turntables and of those who walk about
    double pivot_world[3];  ///< the middle, or the target
    bool trimmed;           ///< a few points far off are left outside
} ewa_view_info;

/// Sets from where a scene is seen when ewa_scene_place_camera() is asked for nothing else; NULL: all is in the picture.
/// Errors: those of ewa_camera_check().
EWA_API ewa_status ewa_scene_set_camera(ewa_scene *scene, const ewa_camera *camera);

/// Fills a scene's camera; false: it has none.
EWA_API bool ewa_scene_get_camera(const ewa_scene *scene, ewa_camera *camera);

/// Places a camera at all that is visible; where the options say nothing of it but the size, it is the scene's own, of which
/// another size keeps what is seen from the upper edge to the lower one. `camera` may be NULL: only what is up and where
/// the middle is. `options` and
/// `info` may be NULL. Errors: EWA_ERROR_ARGUMENT (options, nothing is visible), EWA_ERROR_NUMERIC (numbers too large;
/// the eye is the target), those of ewa_scene_complete().
EWA_API ewa_status ewa_scene_place_camera(ewa_scene *scene, const ewa_view_options *options, ewa_camera *camera,
                                          ewa_view_info *info);

/// The same at one cloud, whose radii are drawn times `radius_scale`: `up` is what its file says, `convention` what the
/// kind of its file does. Nothing is estimated. Errors: EWA_ERROR_ARGUMENT, EWA_ERROR_NUMERIC, EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_cloud_place_camera(const ewa_cloud *cloud, double radius_scale, ewa_up_convention convention,
                                          ewa_scene_up up, const ewa_view_options *options, ewa_camera *camera,
                                          ewa_view_info *info);

/// What draws scenes: the memory of frames, of one context.
typedef struct ewa_scene_renderer ewa_scene_renderer;

/// Makes a renderer on a back end; with `exchange`, one of all ranks (ewa_renderer_create_joint(), on processors), which
/// each have the whole scene: octrees are shared by their cubes, and what lets light through is drawn by the rank that
/// gets the picture. `exchange` may be NULL. The caller destroys it. Errors: those of ewa_renderer_create_on() and
/// ewa_renderer_create_joint().
EWA_API ewa_status ewa_scene_renderer_create(ewa_context *context, ewa_backend_kind backend,
                                             const ewa_exchange *exchange, ewa_scene_renderer **renderer);
EWA_API void ewa_scene_renderer_destroy(ewa_scene_renderer **renderer);

/// Returns the renderer of surfaces within, borrowed.
EWA_API ewa_renderer *ewa_scene_renderer_surfaces(ewa_scene_renderer *renderer);

/// Describes what draws the pictures of a scene: ewa_renderer_describe() of its surfaces, and what drew Gaussians and volumes.
/// Errors: EWA_ERROR_ARGUMENT (struct_size).
EWA_API ewa_status ewa_scene_renderer_describe(const ewa_scene_renderer *renderer, ewa_renderer_info *info);

/// What a frame took.
typedef struct ewa_scene_stats {
    ewa_render_stats render;   ///< surfaces, and what of Gaussians and volumes is counted alike: splats, culled, drawn
    ewa_lod_stats lod;         ///< of octrees, and what of streamed Gaussians is chosen and read; zeros without
    ewa_volume_stats volumes;  ///< of volumes, summed; zeros without
    double total_s;            ///< wall clock
} ewa_scene_stats;

/// Draws a frame of everything: surfaces of points, meshes, octrees and resident surfels meet and blend as one;
/// Gaussians and volumes lie among them in one order of depth. All planes of the frame are of all of it. The scene is
/// committed first where it is not. `options` (may be NULL: the scene's) are used for what belongs to drawing: lod,
/// render, gaussians, volumes, shade_volumes. The same bytes for every number of threads, every instruction set, every
/// order of the instances and every number of ranks. `stats` may be NULL. Errors: those of ewa_scene_commit(),
/// ewa_lod_scene_render() and ewa_mixture_render().
EWA_API ewa_status ewa_scene_draw(ewa_scene *scene, ewa_scene_renderer *renderer, const ewa_camera *camera,
                                  const ewa_scene_options *options, const ewa_frame *frame, ewa_scene_stats *stats);

/// Reads nodes of a scene's octrees on a thread of its own, while another one draws those that are there
/// (ewa_lod_options.resident_only): again and again it chooses some, reads them and puts them into the octrees. Choosing and
/// putting wait for their turn with whatever draws the scene or picks from it; reading goes on beside drawing, but not
/// beside picking, ewa_lod_read() and drawing that reads.
typedef struct ewa_scene_reader ewa_scene_reader;

/// Makes a reader in the context of its thread. The caller destroys it, before the context and not while it has chosen nodes of
/// octrees that are gone. Errors: EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_scene_reader_create(ewa_context *context, ewa_scene_reader **reader);
EWA_API void ewa_scene_reader_destroy(ewa_scene_reader **reader);

/// Chooses at most `maximum` nodes that a picture needs and that are not in memory, the coarsest and what is large in the middle of
/// the picture first; `*count` says how many: 0 where nothing is missing, what is missing is damaged, or
/// ewa_lod_options.memory_bytes are full. `options` as for ewa_scene_draw(). Errors: those of ewa_scene_draw().
EWA_API ewa_status ewa_scene_reader_choose(ewa_scene_reader *reader, ewa_scene *scene, const ewa_camera *camera,
                                           const ewa_scene_options *options, uint32_t maximum, uint32_t *count);
/// Reads what was chosen. After a failure, too, ewa_scene_reader_put() is called, and what cannot be read is not chosen again: the
/// surfels that represent it stay in pictures. Errors: those of ewa_lod_open().
EWA_API ewa_status ewa_scene_reader_read(ewa_scene_reader *reader);
/// Has pictures be drawn of what was read.
EWA_API void ewa_scene_reader_put(ewa_scene_reader *reader);

/// A photograph and what a scene shows in its place.
typedef struct ewa_photo_comparison {
    ewa_image photo;   ///< as ewa_photo_load() gives it, over the background
    ewa_image picture; ///< 4 channels, opaque
    ewa_image_quality quality;
} ewa_photo_comparison;

/// Draws a scene by the camera of a photograph, as ewa_scene_draw() does but over an opaque background, and compares the two. The
/// caller frees both images, which are empty after a failure. Errors: those of ewa_photo_load(), ewa_scene_draw() and
/// ewa_image_compare().
EWA_API ewa_status ewa_scene_compare_photo(ewa_scene *scene, ewa_scene_renderer *renderer, const ewa_photo *photo,
                                           const ewa_scene_options *options, ewa_photo_comparison *found);

/// What is seen at a place of the picture.
typedef struct ewa_scene_hit {
    bool hit;              ///< something is there
    double depth;          ///< camera-space z, world units
    double place_world[3]; ///< on what is seen
    bool has_point;        ///< a point of a cloud, a mesh or an octree is near
    uint32_t instance;     ///< whose it is
    uint64_t point;        ///< its number in the asset's cloud; of an octree 0
    double point_world[3];
    ewa_cloud *points;     ///< of an octree: the points around, the first of which is it; the caller destroys it; else NULL
} ewa_scene_hit;

/// Finds what is seen at (x, y), pixels, or within `reach_px`, [0, 32], the nearest to it on the screen: the depth that
/// the frame's plane has there, and the point that is nearest to it in space, if it is within `reach_world`. Points that
/// sections leave out are none. `options` as for ewa_scene_draw(). Errors: as ewa_scene_draw().
EWA_API ewa_status ewa_scene_pick(ewa_scene *scene, ewa_scene_renderer *renderer, const ewa_camera *camera,
                                  const ewa_scene_options *options, double x_px, double y_px, double reach_px,
                                  double reach_world, ewa_scene_hit *hit);

/// Draws over a picture of the scene, of the camera's size, the outlines of `count` of the surfels that are seen, evenly
/// spread over the order of the points: rims of the discs at the cutoff, where clip lines leave them, as the camera sees
/// them. Of clouds and meshes. `options` as for ewa_scene_draw(). Errors: those of ewa_scene_cloud() and ewa_scene_draw();
/// EWA_ERROR_ARGUMENT (another size). Source: PAS (docs/math.md) figure 1.
EWA_API ewa_status ewa_scene_draw_outlines(ewa_scene *scene, ewa_scene_renderer *renderer, const ewa_camera *camera,
                                           const ewa_scene_options *options, uint32_t count, const ewa_canvas *canvas);

#ifdef __cplusplus
}
#endif
#endif
