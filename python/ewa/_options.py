# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Made by tools/dump_python.py from docs/options.json; a test holds it to that. Do not edit.

"""Keyword arguments: the members of the C library's structs of options, for type checkers."""
from __future__ import annotations

from typing import Literal, Sequence, TypedDict


class AcquireOptions(TypedDict, total=False):
    """Members of ewa_acquire_options."""

    #: nearest: the pixel at the point; ewa: the mean under the surfel; optimal: the sharpest, by least squares, colours may leave [0, 1]; nearest|ewa|optimal, default optimal
    filter: Literal["nearest", "ewa", "optimal"] | int | None
    #: what optimal colours minimise: the error of the surface as it is drawn, or the paper's sum; normalized|sum, default normalized
    fit: Literal["normalized", "sum"] | int | None
    #: what lies beyond the left and right edges; repeat|clamp, default repeat
    wrap_s: Literal["repeat", "clamp"] | int | None
    #: what lies beyond the lower and upper edges; repeat|clamp, default repeat
    wrap_t: Literal["repeat", "clamp"] | int | None
    #: standard deviation of the Gaussian that stands for one pixel of the picture, in pixels; [0.3, 8], px, default 0.5
    pixel_sigma_px: float | None
    #: standard deviations in a radius; (0, 4], default 3
    cutoff: float | None
    #: pull of the optimal colours towards the filtered ones; [1e-6, 1], default 0.005
    ridge: float | None
    #: multiply with the colours that the cloud has; on|off, default off
    modulate: bool | None


class AssetOptions(TypedDict, total=False):
    """Members of ewa_asset_options."""

    #: draw trained Gaussians as opaque surfels, in their constant colours; on|off, default off
    gaussians_as_surfels: bool | None
    #: make levels of large sets of Gaussians, among which merge_px chooses; on|off, default off
    gaussian_levels: bool | None
    #: draw octrees (COPC, EPT) from their levels; auto: those of more than 4000000 points; auto|always|never, default auto
    levels: Literal["auto", "always", "never"] | int | None
    #: standard deviations at which kernels of a mesh's points end; (0, 4], default 3
    cutoff: float | None
    #: levels of detail of volumes; [1, 4], default 1
    voxel_level_count: int | None
    #: levels of detail of volumes at least, for pictures while something moves; [1, 4], default 1
    voxel_level_minimum: int | None
    #: how far a voxel's footprint counts in the picture's frame, steps of the grid; [0, 64], default 1.7999999999999998
    reach_steps: float | None


class CloudLoadOptions(TypedDict, total=False):
    """Members of ewa_cloud_load_options."""

    #: step over damaged pieces of a file, with a warning, and count the points that are lost; on|off, default off
    keep_going: bool | None
    #: PNG and WebP are grids of heights, in colours as Mapbox or as Mapzen has them; none|terrain-rgb|terrarium, default none
    heights: Literal["none", "terrain-rgb", "terrarium"] | int | None


class CloudSaveOptions(TypedDict, total=False):
    """Members of ewa_cloud_save_options."""

    #: how PLY files hold numbers; little-endian|big-endian|ascii, default little-endian
    ply_encoding: Literal["little-endian", "big-endian", "ascii"] | int | None
    #: step of the coordinates of LAS, world units; 0: that of the cloud, else by the size of the box; [0, inf), default 0
    step_world: float | None
    #: points of one chunk of LAZ; [1, 10000000], default 50000
    chunk_points: int | None


class ColoringOptions(TypedDict, total=False):
    """Members of ewa_coloring."""

    #: colours of the numbers; auto: classes for whole numbers named classification, else viridis; auto|viridis|turbo|gray|plasma|inferno|magma|cividis|coolwarm|classes, default auto
    map: Literal["auto", "viridis", "turbo", "gray", "plasma", "inferno", "magma", "cividis", "coolwarm", "classes"] | int | None
    #: the range is given; on|off, default off
    ranged: bool | None
    #: an end of the range is a percentile; on|off, default off
    percent: Sequence[bool] | None
    #: numbers of the first and the last colour; (-inf, inf), default 0
    range: Sequence[float] | None
    #: all points have the colour tint; on|off, default off
    tinted: bool | None
    #: sRGB; [0, 1], default 0
    tint: Sequence[float] | None


class ContextOptions(TypedDict, total=False):
    """Members of ewa_context_options."""

    #: workers of the built-in pool; 0: one per processor; [0, 256], default 0
    thread_count: int | None
    #: bits of instruction sets that may be used; [0, 4294967295], default 2147483647
    cpu_mask: int | None
    #: most detailed messages to report; error|warning|note|info|debug, default warning
    message_level: Literal["error", "warning", "note", "info", "debug"] | int | None
    #: which files are opened that a file or folder names: regular ones below its own folder, anywhere, or none; below|anywhere|none, default below
    named_files: Literal["below", "anywhere", "none"] | int | None
    #: for inputs from anyone: small limits where none are set, and no file opened that another names; on|off, default off
    untrusted: bool | None


class CsgOptions(TypedDict, total=False):
    """Members of ewa_csg_options."""

    #: what to keep; difference: A without B; union|intersection|difference, default union
    operation: Literal["union", "intersection", "difference"] | int | None
    #: standard deviations at which kernels end; (0, 4], default 3
    cutoff: float | None


class EstimateOptions(TypedDict, total=False):
    """Members of ewa_estimate_options."""

    #: nearest neighbours that a point is judged by; [6, 64], default 16
    neighbour_count: int | None
    #: side that normals point to: consistent along the surface and outward, towards the viewpoint, as they come; auto: to the scanners that the cloud knows, else up where points have return numbers, else consistent; propagate|viewpoint|none|auto, default auto
    orientation: Literal["propagate", "viewpoint", "none", "auto"] | int | None
    #: place that normals point to, such as the scanner's; (-inf, inf), default 0
    viewpoint_world: Sequence[float] | None
    #: disc: a radius from the local density; ellipse: two axes from the local anisotropy of the sampling; disc|ellipse, default disc
    shape: Literal["disc", "ellipse"] | int | None
    #: support radius in units of the local spacing; (0, inf), default 1
    radius_scale: float | None
    #: largest radius that closes a gap, in median spacings of the places around; [1, inf), default 2.75
    radius_limit: float | None
    #: standard deviations at which kernels end: axes are the support radius over this; (0, 4], default 3
    cutoff: float | None
    #: keep the normals that the file has; on|off, default on
    keep_normals: bool | None
    #: keep the radii or axes that the file has; on|off, default on
    keep_radii: bool | None
    #: remove points whose mean distance to their neighbours is over the mean plus so many standard deviations of all; 0: keep all; [0, inf), default 0
    outlier_factor: float | None


class FeatureOptions(TypedDict, total=False):
    """Members of ewa_feature_options."""

    #: nearest neighbours that planes are fitted to; 0: 24 for exact points up to 64 for noisy ones; 0 or [16, 64], default 0
    neighbour_count: int | None
    #: smallest angle between the normals of two planes that meet in an edge; less is a smooth surface; [10, 120], deg, default 30
    angle_deg: float | None
    #: standard deviation of the points from the surface in units of the spacing; negative: measured; (-inf, 1], default -1
    noise: float | None
    #: standard deviations at which kernels end: axes are the support radius over this; (0, 4], default 3
    cutoff: float | None
    #: move the points beside an edge onto their plane; on|off, default on
    project: bool | None


class FurnitureOptions(TypedDict, total=False):
    """Members of ewa_furniture_options."""

    #: show how the world's axes x, y, z lie, in the lower left corner; on|off, default off
    axes: bool | None
    #: show a length, in the lower right corner; on|off, default off
    scale_bar: bool | None
    #: show what the colours mean, on the right; at the bottom of a picture that is a quarter higher than wide; on|off, default off
    color_bar: bool | None
    #: distance along the view at which the scale bar of a perspective camera holds; 0: no such bar; [0, 1e30], world, default 0
    scale_depth_world: float | None
    #: colours of the colour bar; viridis|turbo|gray|plasma|inferno|magma|cividis|coolwarm, default viridis
    colormap: Literal["viridis", "turbo", "gray", "plasma", "inferno", "magma", "cividis", "coolwarm"] | int | None
    #: numbers of the first and the last colour; (-inf, inf), default [0, 1]
    range: Sequence[float] | None
    #: pixels per point, of which text has 12; 0: a 720th of the picture's smaller side, at least 0.84; [0, 100], px, default 0
    pixel_scale: float | None
    #: colour of text and lines; auto|dark|light, default auto
    ink: Literal["auto", "dark", "light"] | int | None


class GaussianOptions(TypedDict, total=False):
    """Members of ewa_gaussian_options."""

    #: how a Gaussian gets onto the screen: by the affine map at its centre, as in training, or by what each pixel's ray meets of it; trained|exact, default trained
    projection: Literal["trained", "exact"] | int | None
    #: what is in front of what: by the depth of the centres, as in training, or in each pixel by the depth at which its ray passes the greatest density; auto: centre of trained, ray of exact; auto|centre|ray, default auto
    order: Literal["auto", "centre", "ray"] | int | None
    #: what the pixel filter does to small Gaussians: what the file was trained with, of 2DGS a dot at least, nothing but thicken them, or lower them so that they add as much as before; file|thicken|keep, default file
    filter: Literal["file", "thicken", "keep"] | int | None
    #: variance of the pixel filter; [0, 16], px^2, default 0.3
    prefilter_px2: float | None
    #: standard deviations at which every Gaussian ends; [1, 6], default 4
    cutoff: float | None
    #: less of a Gaussian is not drawn; [1e-6, 0.5], default 0.00392156862745098
    minimum_alpha: float | None
    #: a pixel where less of what is behind would show gets nothing more; [0, 0.999999], default 0.001953125
    minimum_transmittance: float | None
    #: trained: Gaussians whose centres are nearer to the eye along its axis are not drawn; [0, 1e15], world, default 0.2
    near_world: float | None
    #: of large sets, Gaussians that are within so many pixels (RMS) of one that stands for them are drawn by that; 0: all are drawn; [0, 1000], px, default 0
    merge_px: float | None
    #: what is shown of Gaussians: what they were trained to show, or each as an opaque ellipsoid, lit from the eye, or as a dot; blended|ellipsoids|points, default blended
    display: Literal["blended", "ellipsoids", "points"] | int | None
    #: of ellipsoids, standard deviations; [0.1, 4], default 1
    ellipsoid_radius: float | None
    #: diameter of dots; [1, 8], px, default 2
    dot_px: float | None
    #: the depth of a pixel: where half of the light is gone, or the mean of all that shows, by how much it shows; median|expected, default median
    depth: Literal["median", "expected"] | int | None
    #: spherical harmonics beyond that degree are not used; [0, 4], default 4
    sh_degree: int | None


class GaussiansSaveOptions(TypedDict, total=False):
    """Members of ewa_gaussians_save_options."""

    #: highest degree of the spherical harmonics that are kept; .splat: 0; [0, 4], default 4
    sh_degree: int | None
    #: what is up in the set, which is turned to what is up in files; zeros: -y, as in 3DGS; (-inf, inf), default 0
    up_world: Sequence[float] | None
    #: of .spz: 2 and 3 are gzip, 3 has finer quaternions, 4 is zstd; [2, 4], default 3
    spz_version: int | None


class GenerateOptions(TypedDict, total=False):
    """Members of ewa_generate_options."""

    #: same seed, same bytes, on every machine; [0, inf), default 1
    seed: int | None
    #: edge of plane, cube, terrain and town, outer diameter of sphere and torus, length of csg, in world units; [1e-25, 1e25], default 2
    size_world: float | None
    #: 0: a regular grid, 1: anywhere in the cell; [0, 1], default 0.5
    jitter: float | None
    #: squares along an edge of the checkerboard and of the cube's faces; [1e-6, 1000000], default 16
    checks: float | None
    #: support radius in units of the spacing; 0: closed for the jitter; 0 or [1e-6, 1000000], default 0
    radius_scale: float | None
    #: leave out normals and radii; on|off, default off
    positions_only: bool | None
    #: cube and csg: rows of points on every edge, and clip lines; on|off, default off
    sharp: bool | None
    #: add texture coordinates; on|off, default off
    texcoords: bool | None


class ImageSaveOptions(TypedDict, total=False):
    """Members of ewa_image_save_options."""

    #: EXR: store half floats; on|off, default off
    exr_half: bool | None
    #: PNG, JPEG: un-premultiply before encoding; on|off, default on
    srgb_alpha_straight: bool | None
    #: JPEG: from 0 (small) to 100 (good), on libjpeg's scale; [0, 100], default 95
    jpeg_quality: int | None


class InstanceOptions(TypedDict, total=False):
    """Members of ewa_instance."""

    #: whether it is drawn; on|off, default on
    visible: bool | None
    #: of its points, times their own; [0, 1], default 1
    opacity: float | None
    #: of its points' radii; (0, 100], default 1
    radius_scale: float | None
    #: of all its points; 4294967295: as each says; [0, 4294967295], default 4294967295
    material: int | None


class LimitsOptions(TypedDict, total=False):
    """Members of ewa_limits."""

    #: points in one cloud; 0: 4294967279, of untrusted inputs 67108864; 0 or [1, 9.007199255e15], default 0
    max_points: int | None
    #: memory held at a time, 512M or 8G; 0: three quarters of the machine's, of untrusted inputs 1G at most; 0 or [1, 4.611686018e18], bytes, default 0
    max_memory_bytes: int | None
    #: width and height of a picture; 0: 65536, of untrusted inputs 16384; 0 or [1, 4294967295], px, default 0
    max_image_side: int | None
    #: time after which work is given up, from the start on; 0: none; [0, inf), s, default 0
    max_seconds: float | None


class LodBuildOptions(TypedDict, total=False):
    """Members of ewa_lod_build_options."""

    #: memory for points at hand; [67108864, 1.125899907e15], bytes, default 2147483648
    memory_bytes: int | None
    #: which part is made, counted from 0; [0, 65535], default 0
    subset: int | None
    #: how many parts are made, to be merged; 1: the whole at once; [1, 65536], default 1
    subset_count: int | None
    #: step over damaged pieces of files; on|off, default off
    keep_going: bool | None


class LodOptions(TypedDict, total=False):
    """Members of ewa_lod_options."""

    #: nodes are drawn by surfels that represent their points where these are no farther apart; (0, 64], px, default 1
    spacing_px: float | None
    #: and expected to be off by no more than so much, rms, in 1/255; 0: all points; [0, 255], default 3
    error: float | None
    #: memory for nodes; a picture that needs more is drawn in bands; and for streamed Gaussians, coarser ones where it needs more; [16777216, 1.125899907e15], bytes, default 1073741824
    memory_bytes: int | None
    #: time for reading nodes; what is missing then is drawn coarser; 0: as long as it takes; [0, 1e15], s, default 0
    load_s: float | None
    #: part that a rank draws of what a renderer of several ranks shows; [0, 1048576], default 0
    share: int | None
    #: of so many; 0: no parts; [0, 1048576], default 0
    share_count: int | None
    #: about so many surfels and points are drawn of octrees, coarser ones where it would be more; 0: 8 for each pixel that they cover; [0, 9.007199255e15], default 0
    max_splats: int | None
    #: nothing is read: nodes that are not in memory are drawn coarser and counted as missing; on|off, default off
    resident_only: bool | None


class MaterialOptions(TypedDict, total=False):
    """Members of ewa_material."""

    #: light from everywhere; [0, 1000], default 0.15
    ambient: float | None
    #: light from the lights, in all directions; [0, 1000], default 0.85
    diffuse: float | None
    #: strength of the highlights, which have the light's colour; [0, 1000], default 0.3
    specular: float | None
    #: exponent of the highlights; [1, 65536], default 32
    shininess: float | None
    #: strength of the environment's mirror image; [0, 1000], default 0.25
    reflection: float | None


class MeshSampleOptions(TypedDict, total=False):
    """Members of ewa_mesh_sample_options."""

    #: about how many points; [0, inf), default 100000
    point_count: int | None
    #: square root of the area per point away from edges, in world units; 0: by the count; [0, inf), world, default 0
    spacing_world: float | None
    #: same seed, same bytes, on every machine; [0, inf), default 1
    seed: int | None
    #: edges that bend by more are sharp; [0, 180], deg, default 35
    crease_degrees: float | None
    #: support radius in units of the spacing; [0.5, 10], default 1.6
    radius_scale: float | None
    #: standard deviations at which kernels end: axes are the support radius over this; (0, 4], default 3
    cutoff: float | None
    #: make sharp edges, corners and borders exact by clip lines; on|off, default on
    clip_lines: bool | None
    #: interpolate normals across edges that are not sharp; off: those of the triangles; on|off, default on
    smooth_normals: bool | None
    #: how pictures come onto the points; nearest|ewa|optimal, default optimal
    texture_filter: Literal["nearest", "ewa", "optimal"] | int | None
    #: standard deviation of the Gaussian that stands for one pixel of a picture, in pixels; [0.3, 8], px, default 0.5
    pixel_sigma_px: float | None
    #: keep texture coordinates; on|off, default off
    texcoords: bool | None


class PanoramaOptions(TypedDict, total=False):
    """Members of ewa_panorama_options."""

    #: all that is around the eye, in place of a plane picture: longitude and latitude, twice as wide as high; or a circle, in which distances from the middle are angles; none|equirectangular|fisheye, default none
    kind: Literal["none", "equirectangular", "fisheye"] | int | None
    #: angle across the circle of a fisheye; (0, 360], deg, default 180
    fov_deg: float | None
    #: axis that stands upright in an equirectangular picture; 0,0,0: the camera's own; (-inf, inf), default 0
    up_world: Sequence[float] | None
    #: pixels of the plane pictures that it is made of, along each side of its own; [1, 4], default 2
    finer: float | None


class PhotosOptions(TypedDict, total=False):
    """Members of ewa_photos_options."""

    #: colours whose pictures differ least from the photographs; or, of what these show at a point, the weighted median, the weighted mean, or that of the one that sees it largest; fit|median|mean|best, default fit
    method: Literal["fit", "median", "mean", "best"] | int | None
    #: what photographs are corrected by, channel by channel: gain, gain and offset, or nothing; gain|gain-offset|off, default gain
    exposure: Literal["gain", "gain-offset", "off"] | int | None
    #: photographs 0, N, 2N, ... are not used and compared with the result; 0: all are used; [0, 65535], default 0
    hold_out: int | None
    #: rounds of the fit, each with new weights of pixels and exposures; [1, 20], default 3
    rounds: int | None
    #: difference of sRGB numbers in [0, 1] at which a pixel counts a quarter; 0: all count; [0, 1], default 0.05
    robust: float | None
    #: pull of the fit towards the median, of the median point's own weight; (0, 10], default 0.1
    ridge: float | None
    #: photographs are halved while points stay so many pixels apart; 0: never; [0, 100], default 2
    spacing_px: float | None
    #: standard deviations at which kernels end; (0, 4], default 3
    cutoff: float | None
    #: with the method fit: steps by which the pose of each photograph is refined in each round, and as many in all of those that are held out; 0: poses are taken as they are; [0, 20], default 0
    pose_steps: int | None
    #: find how much darker photographs are towards their corners, which one lens has taken; on|off, default off
    vignetting: bool | None


class ProcedureOptions(TypedDict, total=False):
    """Members of ewa_procedure_options."""

    #: features per world unit: cubes, veins, rings, waves; (0, 1000000000], default 8
    frequency: float | None
    #: width of the filter in units of the surfel's kernel; 0: none, which aliases; [0, 10], default 1
    prefilter: float | None
    #: standard deviations at which kernels end; (0, 4], default 3
    cutoff: float | None
    #: same seed, same noise; [0, inf), default 1
    seed: int | None
    #: two linear colours, whose defaults go with the procedure; [0, 1], default 0
    colors: Sequence[float] | None


class ProfileGraphOptions(TypedDict, total=False):
    """Members of ewa_profile_graph_options."""

    #: how many times larger heights are drawn than lengths; 0: so that the graph fills the picture; [0, 1000000], default 0
    exaggeration: float | None
    #: diameter of dots; 0: two points of text; [0, 256], px, default 0
    point_size_px: float | None
    #: pixels per point, of which text has 12; 0: a 720th of the picture's smaller side, at least 0.84; [0, 100], px, default 0
    pixel_scale: float | None


class ProfileOptions(TypedDict, total=False):
    """Members of ewa_profile_options."""

    #: of the strip beside the line, half of it on each side; (0, 1e30], world, default 1
    width_world: float | None
    #: what is up; zeros: as the scene has it; (-inf, inf), default 0
    up_world: Sequence[float] | None


class RefitOptions(TypedDict, total=False):
    """Members of ewa_refit_options."""

    #: the picture has each point's colour at the point, or nearly, for noisy or aliased colours; interpolate|fit, default interpolate
    goal: Literal["interpolate", "fit"] | int | None
    #: standard deviations at which kernels will end where the cloud is drawn; (0, 4], default 3
    cutoff: float | None


class RenderOptions(TypedDict, total=False):
    """Members of ewa_render_options."""

    #: projected shape of a splat: its exact ellipse, the ellipse of the affine map at its centre, the same evaluated in the surfel's plane, the circle around it, or the exact kernel at each pixel; perspective|affine|source|circular|raycast, default perspective
    kernel: Literal["perspective", "affine", "source", "circular", "raycast"] | int | None
    #: standard deviation of the pixel filter; 0: none; [0, 4], px, default 0.35
    prefilter_px: float | None
    #: draws every point as a disc of that diameter that faces the viewer: for points that are no surface; 0: surfels as they are; 0 or [1, 256], px, default 0
    point_size_px: float | None
    #: splats closer in depth than so many support radii are blended as one surface; [0, 1e15], default 1
    tolerance: float | None
    #: 3: splats of one surface are blended; 1: the nearest splat of each pixel wins; 1|3, default 3
    passes: int | None
    #: smooth silhouettes by coverage; on|off, default on
    edge_antialiasing: bool | None
    #: coverage, as a share of a covered pixel's, from which a pixel is opaque; (0, 4], default 0.45
    edge_threshold: float | None
    #: surfaces that show through each other at smoothed silhouettes, the last of them all that is left; 1: the background shows through instead; [1, 8], default 8
    edge_layers: int | None
    #: of every surface, times the alpha of the colours; [0, 1], default 1
    opacity: float | None
    #: leave out splats that face away; none|back, default none
    cull: Literal["none", "back"] | int | None
    #: light: none gives the bare colours, lambert matt surfaces, phong materials with highlights; none|lambert|phong, default lambert
    shading: Literal["none", "lambert", "phong"] | int | None
    #: share of the light that comes from everywhere, where materials do not say; [0, 1], default 0.15
    ambient: float | None
    #: direction in the world of the surroundings' upper edge; (-inf, inf), default [0, 1, 0]
    environment_up: Sequence[float] | None
    #: eye-dome lighting: darken what lies behind its surroundings; 0: none, 1: strong; [0, 100], default 0
    eye_dome: float | None
    #: level of detail, if the surfels have levels; 0: all surfels; [0, 7], default 0
    level: int | None
    #: time for a frame: of the levels of detail from `level` on, the finest that is expected to be drawn in that time; 0: `level`; [0, 1e15], s, default 0
    budget_s: float | None
    #: draws every pixel as so many by so many parts, and their average; 0: as it is where surfels are as large as pixels, and 2, 4 or 8 for what is far, where a pixel holds many small things; [0, 8], default 0
    supersampling: int | None


class SceneOptions(TypedDict, total=False):
    """Members of ewa_scene_options."""

    #: what is up; auto: as files and points say; auto|y|z|-y|-z, default auto
    up: Literal["auto", "y", "z", "-y", "-z"] | int | None
    #: measure anew the radii of a file that leave gaps between the discs, and its normals where many are far off the points' own surface; on|off, default on
    close_gaps: bool | None
    #: clouds stay in memory beside their surfels, for picks and changes; on|off, default on
    keep_points: bool | None
    #: volumes get the light that suits their transfer function; on|off, default on
    shade_volumes: bool | None
    #: many frames of the scene follow: surfels in memory are drawn by levels of detail where the picture is off by next to nothing; on|off, default off
    many_frames: bool | None
    #: of the regions that hide points; [0, 16], default 0
    region_count: int | None


class SurfelsOptions(TypedDict, total=False):
    """Members of ewa_surfels_options."""

    #: standard deviations at which a kernel ends; (0, 4], default 3
    cutoff: float | None
    #: multiplies every radius and axis; (0, 1e15], default 1
    radius_scale: float | None
    #: levels of detail, each of a quarter of the surfels of the one before; 1: all surfels only; [1, 8], default 1
    level_count: int | None


class TextureOptions(TypedDict, total=False):
    """Members of ewa_texture_options."""

    #: hybrid: texels are points where they are minified along both axes, and splats elsewhere; all splats; all points, with holes where magnified; backward, by bilinear interpolation, which aliases; hybrid|splat|point|bilinear, default hybrid
    method: Literal["hybrid", "splat", "point", "bilinear"] | int | None
    #: standard deviation of the pixel filter in pixels; [0.1, 4], px, default 0.3
    prefilter_px: float | None
    #: standard deviations at which kernels end; [1, 4], default 3.3
    cutoff: float | None
    #: standard deviation of a texel's disc, in texels: larger is softer where magnified; [0.3, 2], default 0.4
    sigma_texels: float | None
    #: hybrid: texels that are not farther apart than this, in pixels, are points; [0.05, 1], px, default 0.5
    point_spacing_px: float | None
    #: fill the whole plane with copies of the image, up to the horizon; on|off, default off
    repeat: bool | None


class ViewOptions(TypedDict, total=False):
    """Members of ewa_view_options."""

    #: of the picture; 0: of the scene's camera, else 1280; 0 or [1, 65536], px, default 0
    width_px: int | None
    #: of the picture; 0: of the scene's camera, else 720; 0 or [1, 65536], px, default 0
    height_px: int | None
    #: vertical field of view; 0: 30, but for what a camera at the origin took; [0, 180), deg, default 0
    fov_deg: float | None
    #: an orthographic camera that shows so much; 0: perspective; [0, inf), world, default 0
    ortho_height_world: float | None
    #: up in the picture; zeros: the scene's; (-inf, inf), default 0
    up_world: Sequence[float] | None
    #: the eye is given; on|off, default off
    has_eye: bool | None
    #: the target is given; on|off, default off
    has_target: bool | None
    #: where the camera is; (-inf, inf), default 0
    eye_world: Sequence[float] | None
    #: what it looks at; (-inf, inf), default 0
    target_world: Sequence[float] | None
    #: carries the camera about the up axis; [-360, 360], deg, default 0
    azimuth_deg: float | None
    #: then raises it; [-180, 180], deg, default 0
    elevation_deg: float | None
    #: all is in the picture in every turn about the axis; on|off, default off
    turntable: bool | None
    #: in which it looks; zeros: as the view says; (-inf, inf), default 0
    direction_world: Sequence[float] | None
    #: room is left for a colour bar where all is put into the picture; on|off, default off
    color_bar: bool | None


class VolumeGenerateOptions(TypedDict, total=False):
    """Members of ewa_volume_generate_options."""

    #: voxels along each axis; [2, 4294967295], default 128
    dims: Sequence[int] | None
    #: distance of the outermost voxels along the longest axis, in world units; (0, inf), default 1
    size_world: float | None
    #: cubes along an edge of checkerbox; (0, 1000000], default 8
    checks: float | None
    #: of the vessels: same seed, same bytes, on every machine; [0, inf), default 0
    seed: int | None


class VolumeLoadOptions(TypedDict, total=False):
    """Members of ewa_volume_load_options."""

    #: of raw numbers: how many along each axis, x fastest; 0: as the file says; [0, 4294967295], default 0
    dims: Sequence[int] | None
    #: raw numbers have their highest byte first; on|off, default off
    big_endian: bool | None
    #: bytes in front of raw numbers; [0, inf), default 0
    header_bytes: int | None
    #: distances of the voxels along each axis; 0: as the file says, else 1; [0, inf), world, default 0
    spacing_world: Sequence[float] | None


class VolumeOptions(TypedDict, total=False):
    """Members of ewa_volume_options."""

    #: voxels as splats where they are magnified and as points where they are minified, or all as one of these; hybrid|splats|points, default hybrid
    method: Literal["hybrid", "splats", "points"] | int | None
    #: how a pixel finds its place in a splat: how far its ray passes the voxel's centre, or the paper's table; exact|table, default exact
    index: Literal["exact", "table"] | int | None
    #: standard deviation of the kernel around each voxel, in voxels; [0.3, 2], default 0.6
    sigma: float | None
    #: standard deviations at which a kernel ends; [1, 4], default 3
    cutoff: float | None
    #: standard deviation of the pixel filter in pixels; 0: none; [0, 4], px, default 0.35
    prefilter_px: float | None
    #: spacing on the screen up to which voxels are points; [0, 1.5], px, default 1.2
    point_threshold_px: float | None
    #: depth that is composited at once, in smallest spacings of the grid; [0.25, 16], default 1
    depth_unit: float | None
    #: which of the voxels' levels; 0: all voxels; [0, 3], default 0
    level: int | None
    #: multiplies every extinction: 2 is twice as dense; [0, 1e15], default 1
    density_scale: float | None
    #: where less of what is behind would show, nothing more is drawn; 0: everything is; [0, 0.999999], default 0.001953125
    minimum_transmittance: float | None
    #: light, by the gradient: none gives the bare colours, lambert matt matter, phong highlights; none|lambert|phong, default none
    shading: Literal["none", "lambert", "phong"] | int | None
    #: draw voxels that are splats in red, points as they are; on|off, default off
    mark_splats: bool | None


class VolumeSaveOptions(TypedDict, total=False):
    """Members of ewa_volume_save_options."""

    #: not compressed; on|off, default off
    plain: bool | None


class VoxelsOptions(TypedDict, total=False):
    """Members of ewa_voxels_options."""

    #: levels of means of 2x2x2 voxels, for a first picture that is fast; [1, 4], default 2
    level_count: int | None


class WarpOptions(TypedDict, total=False):
    """Members of ewa_warp_options."""

    #: standard deviations at which a kernel ends; (0, 4], default 3
    cutoff: float | None
    #: support radius of a splat in units of the distance to its neighbours; [0.5, 10], default 1.14
    radius_spacings: float | None
    #: depths of neighbours that differ by more than this share are on different surfaces, unless they continue a plane; (0, 1], default 0.02
    depth_jump: float | None
    #: steps of a sensor's depths at distance 1, growing with its square: depths that differ by little more are averaged over 5 x 5 pixels. 0.0036 for a first Kinect in metres; 0: taken as they are; [0, 1000000], default 0
    depth_noise: float | None
    #: leave out samples that hang between two surfaces; on|off, default on
    drop_flying: bool | None
    #: nearer depths are left out; [1e-9, 1e12], world, default 1e-06
    nearest_world: float | None
    #: farther depths are left out; [1e-9, 1e12], world, default 1000000000.0
    farthest_world: float | None


#: Members that are no keyword arguments: the package sets them by arguments of its own.
OWN: dict[str, frozenset[str]] = {
    "ewa_asset_options": frozenset(['own_context', 'to_world']),
    "ewa_render_options": frozenset(['background', 'layers', 'light_count', 'material_count', 'section_count']),
    "ewa_volume_options": frozenset(['background', 'light_count', 'section_count']),
    "ewa_texture_options": frozenset(['background']),
    "ewa_gaussian_options": frozenset(['background', 'section_count']),
    "ewa_generate_options": frozenset(['object', 'point_count']),
    "ewa_volume_generate_options": frozenset(['object']),
    "ewa_procedure_options": frozenset(['procedure']),
    "ewa_furniture_options": frozenset(['category_count']),
}

__all__ = [
    "AcquireOptions",
    "AssetOptions",
    "CloudLoadOptions",
    "CloudSaveOptions",
    "ColoringOptions",
    "ContextOptions",
    "CsgOptions",
    "EstimateOptions",
    "FeatureOptions",
    "FurnitureOptions",
    "GaussianOptions",
    "GaussiansSaveOptions",
    "GenerateOptions",
    "ImageSaveOptions",
    "InstanceOptions",
    "LimitsOptions",
    "LodBuildOptions",
    "LodOptions",
    "MaterialOptions",
    "MeshSampleOptions",
    "PanoramaOptions",
    "PhotosOptions",
    "ProcedureOptions",
    "ProfileGraphOptions",
    "ProfileOptions",
    "RefitOptions",
    "RenderOptions",
    "SceneOptions",
    "SurfelsOptions",
    "TextureOptions",
    "ViewOptions",
    "VolumeGenerateOptions",
    "VolumeLoadOptions",
    "VolumeOptions",
    "VolumeSaveOptions",
    "VoxelsOptions",
    "WarpOptions",
]
