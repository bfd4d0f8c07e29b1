// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The numbers and rules that the reference and every fast pipeline share, where docs/math.md leaves them
// open, in the sections of that page; what was another rule before, and what that cost, is in its section 14.
//
// ---- Section 2: one primitive
//
// A surfel has centre p, orthogonal kernel axes tu, tv of length sigma (after radius_scale), unit normal n,
// all in camera space (p = A w + t; axes and normal by A). Sigma = tu'tu + tv'tv, R = F sqrt(Sigma33) the
// depth half range of its disc, F the cutoff.
//
// Section planes, of unit normal m and distance e from the origin, keep m.q + e >= 0 in the world. A surfel is
// as far inside as its centre, a = m.p + e, and its disc reaches r = F |tu| sqrt(1 - (m.n)^2) to either side at
// most; points have r = 0. It is dropped where a < 0 and a <= -r, and cut where a < r.
//
// Dropped before anything else: perspective, pz + R <= 0 (wholly behind the eye plane); orthographic, pz <=
// 0; with EWA_CULL_BACK, n.p >= 0 (orthographic: nz >= 0). Without culling, n is turned towards the viewer
// per surfel: where n.p > 0 (orthographic nz > 0) it is negated; the splat is then called back-facing.
//
// ---- Section 3: ellipse, near surfels
//
// Near surfels (perspective, pz <= EWA_NEAR_RATIO * R) touch or nearly touch the eye plane: their conic is no
// safe ellipse. Of broad ones (sigma max(fx, fy) >= EWA_BROAD_PX pz; orthographic: sigma max(fx, fy) >
// EWA_BROAD_PX) it is out of range. Both are drawn by pixel rays, whatever the kernel:
//   ray d = ((x - cx)/fx, (y - cy)/fy, 1), z = n.p / n.d, q = z d - p, u = (q.tu / tu.tu, q.tv / tv.tv);
//   a = du/dx, b = du/dy per pixel (exact derivatives); W = I + h^2 (a'a + b'b); r^2 = u W^-1 u';
//   weight = exp(-r^2 / 2) / (2 pi sqrt|W|); the pixel counts where z > 0, r^2 < F^2 and u.u < 4 F^2 (the
//   linearised prefilter is not trusted farther from the disc than that). A surfel with |n.p| < EWA_EDGE_ON
//   |p| (orthographic: |nz| < EWA_EDGE_ON) is then dropped.
//   Orthographic: q = ((x - cx)/fx, (y - cy)/fy, z) - p where n.q = 0.
//
// All others: V by the perspective kernel, or V = J'J around the projected centre, J the Jacobian there
// (affine).
//
// ---- Section 4: resampling kernel
//
// An ellipse with variance V' = V + h^2 I around its centre, pixel counts where r^2 < F^2, weight = sqrt(|V|
// / |V'|) exp(-r^2 / 2) / (2 pi).
//
// Without a prefilter a splat with |V'| < EWA_FLAT V'11 V'22 is a line: it covers no pixel. (r^2 is a sum of
// terms that are up to V'11 V'22 / |V'| times as large, of which single precision would leave nothing.) Nor does
// one with sqrt|V| < EWA_MIN_SPLAT, whatever its pixels' alpha is made of.
//
// ---- Section 5: depth and clip lines
//
// Depth (both): key(x) = 1/z(x) = 1/pz + n.(d(x) - p/pz) / n.p with |n.p| raised to EWA_EDGE_ON |p| where
// smaller (sign kept, + for 0); orthographic: key(x) = -z(x) = -pz + ((x - px) nx/fx + (y - py) ny/fy) / nz
// with |nz| raised to EWA_EDGE_ON likewise. g is what z changes per pixel at the centre: |grad key| pz^2
// (orthographic: |grad key|), F h g the depth that the prefilter reaches across, s the longer axis.
// Range: the key is clamped to that of [pz - R, pz + R], widened at both ends by m (perspective: m / pz^2), m
// = max(0, min(EWA_FREE_RADII F s, EWA_FREE_DEPTH pz) - F h g). At first m was 0. A margin that fades out
// keeps what that is for, silhouettes that do not fray, and leaves the plane alone, even and cheaper, where
// it is seen from the front: a splat with m >= F h g is nowhere clamped. Others are steep. Near surfels have
// m = 0.
//
// Clip lines: a splat's weight is rho times the share of the pixel's square that lies on the inner side of
// the line on the screen, its area; of two lines the smaller share (clip_mode 1: the larger). A share of 0
// does not count. The paper keeps where the pixel's centre is inside; areas antialias the edge, and those of
// two surfaces that are clipped by one line add up to 1. A section plane that cuts a surfel is a line of its,
// m.(q - p) + a >= 0. Of all lines, the two of clip_mode 1 taken for one, the smallest share counts. There are no
// more than EWA_CLIP_LINES: the surfel's own, then those of the planes of smallest a.
//
// Contours: the splat of a surfel of curvature C > 0 ("signed_curvature") without clip lines, neither near nor of one's own
// size on the screen, moves away from its contour. s is the sine of the angle between plane and ray (n.p / pz,
// orthographic nz), b = 2 C pz / fx (orthographic: without pz): s^2 / b is how many pixels before the contour the
// centre is seen. E^2 = h^2 + (EWA_CONTOUR_WIDTH s_px s)^2, s_px the longer axis over pz in pixels, is the splat's size
// across it, and
//   c E w,    w = max(0, 1 - s^2 / min(EWA_CONTOUR_REACH E b, S)),    S as ewa_contour_sine2() has it
// the way: up the key's gradient where n.p < 0, for n as the surfel has it, else down. Its plane of keys stays
// where it is. By S it stays within the picture of a sphere around its disc, but for c h. c is EWA_CONTOUR_SHIFT
// times the x at which the normal distribution below -x is tau / 2 with EWA_CULL_BACK, else tau (1 - sqrt(1/2)), where
// what two layers cover is a half; 0 without edge antialiasing, with one pass, for points, and with the raycast kernel
// in perspective. With n.p > 0 and w > EWA_CONTOUR_CONCAVE it is the far side of what ends there: where nothing is
// transparent it is in no layer behind the first. With C < 0 none moves: contours of surfaces that bend towards their
// normals' side, as of the valley behind a ridge, are hidden, and where ridge and valley meet nothing ends.
//
// ---- Section 6: visibility and accumulation
//
// Tolerance: eps = kappa F s + min(F h g, EWA_GRAZING_TOLERANCE F s).
//
// Three passes: B(x) = min (z + eps) over the surfels that count at x, then those with z <= B(x) are summed.
// The minimum is that of z + eps as it is at x, not of a plane through its value at the centre: where z
// changes much within a splat, as in a disc near the eye, a tangent of the key is too near, and hides what
// lies within the tolerance.
// One pass: the surfel of smallest z wins, with weight 1 and full coverage.
//
// Sums are exact: a term, the kernel over its peak times the payload there, is rounded once to a whole number
// of units, and whole numbers are added (pipeline_sums.h). So neither the order of the splats nor how they
// are spread over sources or the picture is cut into tiles changes a byte. 2^22 units are a weight of 1
// (less, by a power of two, where q0 is large; more where no splat can have a weight near 1 / (2 pi)), as
// many a colour, material or opacity as large as any there is; z is summed over B(x), orthographic: over the
// scene's depth. What the rounding leaves is summed too, to 2^-12 of a unit: of depths and the weights that
// they are divided by; of splats that clip lines cut; of all without edge antialiasing, where a pixel shows
// splats of next to no weight, and where colours beyond 16 meet far smaller ones. Weights of several sources
// are those of the one with the smallest q0: the others' times that over their own. And times the source's
// own weight, if it has one. A source that hides nothing has no say in B(x); where no other has a surface,
// nothing of it is summed.
//
// Facing: back-facing splats hide others and cover the pixel as all do, but are seen only where nothing faces
// the viewer. With S_f the sums of weight, colour, normal, depth, material and opacity over the splats that
// are front-facing, S_b those over the back-facing ones, q_f and q_b their weights, the surface's sums are
//   S = (q_f + q_b) (s S_f / q_f + (1 - s) S_b / q_b),    s = min(1, q_f / (EWA_FRONT q0)),
// of weight q = q_f + q_b; where one of these is 0, the other's. The mean goes over from one to the other as
// s grows, however little weight either has. At sharp edges the far side's discs reach past the near side's
// and lie in front of them there; without this they draw a rim in the far side's colour, with its normals
// turned over. But near contours (section 5) alpha and coverage do not depend on which way normals point.
//
// ---- Section 7: resolve, alpha, shading
//
// Resolve: q = sum of weights; nothing where q = 0. Colour, depth: weighted means. Normal: weighted sum,
// normalised. Coverage AOV: q / q0. alpha = min(1, q / (tau q0)) with edge antialiasing (but see clip lines),
// else 1. Then shading, surface by surface.
// Over the background (straight alpha bg): rgb = colour alpha + bg_rgb bg_a (1 - alpha), a = alpha + bg_a (1
// - alpha). rgba8: divided by its alpha (black when 0), sRGB curve, rounded to nearest.
//
// What a line leaves is not for the threshold tau to judge: an edge alone in front of something else covers
// its share of the pixel. A splat is cut there by c = min(1, (1 - share) / EWA_CUT). With w = sum of c rho
// over a surface's splats, k = sum of c rho share, u = q - k the rest, and D = sum of c rho m, m the
// direction on the screen in which the line keeps (unit; of several lines their mean weighted by what each cuts
// off, of the two of clip_mode 1 first by what each keeps), where w > 0:
//   alpha = min(1, max(u / (tau q0), q / max(tau q0, u + a w))),
//   a = clamp((|D| / w - EWA_EDGES_OPPOSE) / (EWA_EDGES_AGREE - EWA_EDGES_OPPOSE), 0, 1).
// Lines that agree (a = 1) are one edge: alpha is the mean share as long as the whole weights reach tau q0.
// Where faces meet, what one line cuts off another keeps, and their directions cancel: the ordinary rule.
//
// The normal that is shaded by is the weighted sum over max(its length, EWA_SHADED_NORMAL q): of unit length
// where the normals of a pixel agree, shorter where they cancel. Both sides of a silhouette do, as each is
// turned to the viewer: a unit normal would face him there, and draw a bright rim around what is closed. At a
// sharp edge the faces do: light goes with N.L, so that the mean normal as it is gives the mean of their light,
// and one made longer a line brighter than either. Nearly equal normals are smoothed to unit length, so that
// surfaces that bend are not darker between their discs.
// Shading: colour (ambient + diffuse sum light max(0, N.L)) [+ specular sum light max(0, N.H)^shininess where
// N.L > 0, + reflection environment(R)], the part in brackets with EWA_SHADING_PHONG. V is the direction to
// the eye along the pixel's ray (orthographic: against the view direction); a headlight has L = H = V, others
// H halfway between L and V; R = 2 (N.V) N - V. A material's five numbers are weighted means like the colour,
// where the surfels have several materials (but not by opacity, as normals). The environment is looked up
// (image/environment.h) with the footprint |R - R'|, R' the reflection at the pixel's neighbour in x or in y
// within its aligned 2x2 pixels, the larger one of those that have the surface too.
//
// Supersampling: a pixel of N x N parts is the mean of the pixels of a picture N times as large, whose filter is h of
// those: premultiplied colours over the background, coverages; its normal is their sum, of length 1, its depth the
// smallest. Where the surfels are to say (0): with t = log2(EWA_PART_RADIUS_PX / r), r the median by r^2 of the radii F sigma max(fx, fy) / pz
// (orthographic: without pz) in the picture, N is 1 for t <= 0, from t = k + 1/8 on 2^(k + 1), at most 8, and between k and that the
// mean of the pictures of 2^k and 2^(k + 1), by 8 (t - k). Points of a size in pixels and eye-dome lighting: 1.
//
// Eye-dome lighting: the premultiplied colour, before the background, times exp(-EWA_EYE_DOME_GAIN strength
// mean), mean over EWA_EYE_DOME_PAIRS pairs of opposite pixels at x +- d of
// max(0, (key(x + d) + key(x - d)) / 2 - key(x)) / key(x), 0 where one of the three shows nothing. d: (r, 0),
// (0, r), (r, r), (r, -r) for r of 1, 2 and 4 pixels. Orthographic: divided by the height of the view in world
// units instead. Keys being linear on planes, planes stay as they are.
//
// ---- Section 8: opacity, layers
//
// Opacity: a surface whose weights are q has the opacity A = (sum of weight opacity) / q times the options',
// and alpha times A; its colour is the mean by weight opacity. Opaque surfaces have A = 1.
//
// Layers: where alpha < 1 and there is something, the splats with z > B(x) make the next surface by the same
// rules, and so on, composited front to back before the background; depth, normal and coverage are the first
// one's. Opaque surfaces go on at their antialiased edges, up to edge_layers surfaces (one layer is the
// paper's rule, where the background shines through silhouettes inside the object); transparent ones
// everywhere, until nothing is left, or up to L surfaces. The last of L or of edge_layers, if it is not the
// first, takes all that is left: B(x) is infinite then. How many surfaces that is its coverage k = q / q0 says:
// alpha becomes 1 - (1 - alpha) prod (1 - alpha share_i), share_i = clamp(4 (k - i) - 2, 0, 1), i = 1, 2, ...
// below EWA_MERGED_SURFACES. A surface more counts from half of one on, not earlier, so that the ripple of a
// single surface's coverage does not show. Such a layer is many surfaces: its sums are not parted by facing, and
// alpha is min(1, q / (tau q0)).
//
// An opaque surface behind the first, both cut by clip lines, is often the other side of its edge. With
// alpha, u, w and D of the first, alpha', q', u', w' and D' of the one behind, d = D / (u + w) and d' = D' /
// (u' + w'), it covers of what the first leaves open
//   alpha' + min(1, 2 |d.d'|) (r - alpha'),  r = max(0, alpha' - alpha) / (1 - alpha) where d.d' > 0,
// for there it keeps what the first keeps, else r = min(1, q' / (tau q0)), for it goes on where that ends.
//
// ---- Section 9: other kernels of the affine map (orthographic: of the same ellipse); points
//
// Source: u = (x - c) J^-1, W = I + h^2 J^-T J^-1, r^2 = u W^-1 u', weight = exp(-r^2 / 2) / (2 pi sqrt|W|).
// It needs the inverse: a surfel with |V| < EWA_SINGULAR V11 V22 or sqrt|V| < EWA_MIN_AREA is dropped.
//
// Circular: V' is replaced by its larger eigenvalue l times I, |V| stays. The circle reaches far beyond a
// disc that is seen at a grazing angle: m of section 5 is larger by min(F sqrt(l) g, EWA_GRAZING_TOLERANCE F
// s), and the key goes no lower than EWA_MIN_KEY / pz.
//
// Raycast (perspective cameras; orthographic ones see the affine kernel): V' = w^2 V + h^2 I and |V| w^4 for
// |V|, w(x) = pz / z(x), clamped to [pz / (pz + R), pz / (pz - R)], what it is on the disc. Since u = (x - c)
// J^-1 / w is the projective map, r^2 = u.u without a prefilter. A surfel with |n.p| < EWA_EDGE_ON |p| is
// dropped.
//
// Points (point_size_px > 0): a surfel is replaced by a disc around its centre, parallel to the picture, with
// the axes (s pz / fx, 0, 0) and (0, s pz / fy, 0) (orthographic: without pz), n = (0, 0, -1), no clip lines,
// dropped where pz <= 0. R = point_size_px / 2, s^2 = max(min(R / 2, R^2 / 2), R^2 / 16), h = 0; with edge
// antialiasing and three passes F^2 = R^2 / s^2 - 2 + 2 ln 1024, else F = R / s; tau q0 = exp(1 - R^2 / (2
// s^2)) / (2 pi). Then alpha of one disc is min(1, exp((R^2 - 2 s^2 - r^2) / (2 s^2))), which adds up to pi
// R^2.
#ifndef EWA_SRC_SURFACE_SEMANTICS_H
#define EWA_SRC_SURFACE_SEMANTICS_H

// ---- Section 3

/// Closer than this many depth half ranges to the eye plane, a surfel is drawn by pixel rays. The exact bound
/// is 1; the margin keeps D33 away from zero in single precision.
#define EWA_NEAR_RATIO 1.05

/// Standard deviation from which on a splat is drawn by pixel rays.
#define EWA_BROAD_PX 1e8

// ---- Section 4

/// Smallest |V'| / (V'11 V'22) that counts as an area: that of a splat 500 times as long as it is wide.
#define EWA_FLAT 4e-6

/// Smallest sqrt|V| of a splat that is drawn, in square pixels: squares of less are lost in single precision.
#define EWA_MIN_SPLAT      1e-16

#define EWA_INVERSE_TWO_PI 0.15915494309189535

// ---- Levels of detail (docs/levels.md)

/// How much larger the first coarser level's surfels are than what keeps the area of those that they stand
/// for, and how far from the middle of these one of them may be, in sigmas, before that makes the surfel
/// larger. Without both, grids show holes; with them, no sampling of docs/levels.md does.
#define EWA_LEVEL_GROWTH 1.3
#define EWA_LEVEL_SPREAD 1.7

// ---- Section 5

/// Sine of the smallest angle between a viewing ray and a surfel's plane that its depth plane is computed
/// with.
#define EWA_EDGE_ON 1e-5

/// How far beyond the disc's own range its plane is used when the prefilter reaches across little depth, in
/// support radii and at most in depths of the centre. The reach takes from it.
#define EWA_FREE_RADII 2.0
#define EWA_FREE_DEPTH 0.25

/// Clip lines that a splat has at most: a surfel's own two, and those of section planes.
#define EWA_CLIP_LINES 4

/// Contours. SHIFT is more than 1 as the way shrinks with the distance from the contour.
#define EWA_CONTOUR_SHIFT  1.15
#define EWA_CONTOUR_WIDTH  1.75
#define EWA_CONTOUR_REACH  6.0
#define EWA_CONTOUR_WITHIN 0.9
#define EWA_CONTOUR_CONCAVE 0.9

// ---- Section 6

/// Largest share of the tolerance that comes from the prefilter's reach, in support radii. It was 8 at first;
/// at 16 minified planes alias less and stay opaque towards the horizon, and silhouettes keep their place
/// (docs/quality.md); more changes nothing there.
#define EWA_GRAZING_TOLERANCE 16.0

/// Share of q0 that splats facing the viewer need so that nothing of those turned away is seen.
#define EWA_FRONT 0.05

// ---- Section 7

/// Share of a pixel's square that a clip line has to cut off from a splat until that counts as cut there.
#define EWA_CUT 0.05

/// Length of the mean of the directions in which clip lines cut a pixel, from which on they are taken for one
/// edge, and below which for edges of several surfaces that meet.
#define EWA_EDGES_AGREE  0.95
#define EWA_EDGES_OPPOSE 0.8

/// Length of the mean of a pixel's unit normals from which on it is shaded by a unit normal: 18 degrees to either
/// side of the mean.
#define EWA_SHADED_NORMAL 0.95

/// Eye-dome lighting: pairs of opposite pixels, and what their mean is multiplied by at strength 1: a step of
/// 1 % of the depth behind a straight edge takes about half of the light.
#define EWA_EYE_DOME_PAIRS 12
#define EWA_EYE_DOME_GAIN  300.0

/// Support radius that surfels have in the parts of a pixel, where they say how many parts it has.
#define EWA_PART_RADIUS_PX 0.75

// ---- Section 8

/// Surfaces that a merged layer stands for at most.
#define EWA_MERGED_SURFACES 64

// ---- Section 9

/// Smallest key of circular splats times pz: their z goes up to 16 pz.
#define EWA_MIN_KEY 0.0625

/// Smallest |V| / (V11 V22) that the source kernel inverts.
#define EWA_SINGULAR 1e-14

/// Smallest sqrt|V| that the source kernel inverts, in square pixels.
#define EWA_MIN_AREA 1e-15

#endif
