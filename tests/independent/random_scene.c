// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Scenes by number. Objects are placed where the camera sees them, in a camera space whose unit is their
// distance, and then carried to the world: so every number gives a picture with something in it.
#include "tests/independent/random_scene.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROOM = 700 };

static const double PI = 3.14159265358979323846;

typedef struct stream {
    uint64_t state;
} stream;

/// xorshift64*.
static uint64_t next(stream *numbers) {
    uint64_t x = numbers->state;
    x ^= x >> 12, x ^= x << 25, x ^= x >> 27;
    numbers->state = x;
    return x * 0x2545f4914f6cdd1du;
}

static double between(stream *numbers, double low, double high) {
    return low + (high - low) * (double)(next(numbers) >> 11) / 9007199254740992.0;
}

/// Evenly by orders of magnitude.
static double scaled(stream *numbers, double low, double high) {
    return exp(between(numbers, log(low), log(high)));
}

static uint32_t below(stream *numbers, uint32_t count) { return (uint32_t)(next(numbers) >> 33) % count; }

static bool chance(stream *numbers, double share) { return between(numbers, 0, 1) < share; }

static void direction(stream *numbers, double v[3]) {
    const double z = between(numbers, -1, 1), angle = between(numbers, 0, 2 * PI), r = sqrt(1 - z * z);
    v[0] = r * cos(angle), v[1] = r * sin(angle), v[2] = z;
}

static void cross(const double a[3], const double b[3], double out[3]) {
    const double c[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    memcpy(out, c, sizeof c);
}

static void normalize(double v[3]) {
    const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; i < 3; i++) v[i] /= length;
}

/// Two unit vectors across a unit vector, turned at random.
static void frame(stream *numbers, const double n[3], double a[3], double b[3]) {
    double other[3];
    do {
        direction(numbers, other);
        cross(n, other, a);
    } while (a[0] * a[0] + a[1] * a[1] + a[2] * a[2] < 0.01);
    normalize(a);
    cross(n, a, b);
}

/// What a scene is made with.
typedef struct maker {
    stream numbers;
    random_scene *made;
    bool discs;         ///< radius and normal; else tangent axes
    double fatness;     ///< support radius over spacing
    double aspect;      ///< of ellipses, at most
    bool shears;        ///< axes that are conjugate, not orthogonal
    double roughness;   ///< how far surfels lie off their surface, in spacings
    double color[2][3]; ///< between which an object's colours lie
    bool translucent;
    double alpha;
    uint32_t material;
} maker;

static void say(maker *m, const char *format, ...) {
    char *words = m->made->words;
    const size_t used = strlen(words);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(words + used, RANDOM_SCENE_WORDS - used, format, arguments);
    va_end(arguments);
}

static independent_surfel *put(maker *m, const double position[3], const double n[3], double spacing) {
    if (m->made->scene.surfel_count == ROOM) return NULL;
    independent_surfel *s = &m->made->surfels[m->made->scene.surfel_count++];
    stream *numbers = &m->numbers;
    *s = (independent_surfel){.disc = m->discs, .alpha = 1, .material = m->material};
    const double off = m->roughness * between(numbers, -1, 1) * spacing;
    for (int i = 0; i < 3; i++) {
        const double share = between(numbers, 0, 1);
        s->position[i] = position[i] + off * n[i];
        s->normal[i] = n[i];
        s->color[i] = m->color[0][i] + share * (m->color[1][i] - m->color[0][i]);
    }
    if (m->translucent) s->alpha = chance(numbers, 0.5) ? m->alpha : between(numbers, 0, 1);
    const double radius = spacing * m->fatness * between(numbers, 0.9, 1.2);
    if (m->discs) {
        const double length = scaled(numbers, 0.1, 10); // normals of files have any
        for (int i = 0; i < 3; i++) s->normal[i] *= length;
        s->radius = radius;
        return s;
    }
    double a[3], b[3];
    frame(numbers, n, a, b);
    const double sigma = radius / m->made->scene.cutoff, thin = sigma / scaled(numbers, 1, m->aspect);
    const double turn = m->shears ? between(numbers, 0, 2 * PI) : 0;
    for (int i = 0; i < 3; i++) {
        s->axis_u[i] = sigma * a[i] * cos(turn) + thin * b[i] * sin(turn);
        s->axis_v[i] = thin * b[i] * cos(turn) - sigma * a[i] * sin(turn);
    }
    return s;
}

/// The point of camera space behind a pixel.
static void unproject(const maker *m, double x, double y, double z, double p[3]) {
    const ewa_camera *camera = &m->made->scene.camera;
    const double depth = camera->projection == EWA_ORTHOGRAPHIC ? 1 : z;
    p[0] = (x - camera->cx_px) / camera->fx_px * depth;
    p[1] = (y - camera->cy_px) / camera->fy_px * depth;
    p[2] = z;
}

/// Length at depth z that is a pixel high.
static double pixel_at(const maker *m, double z) {
    const ewa_camera *camera = &m->made->scene.camera;
    return (camera->projection == EWA_ORTHOGRAPHIC ? 1 : z) / camera->fy_px;
}

static void somewhere(maker *m, double z, double p[3]) {
    const ewa_camera *camera = &m->made->scene.camera;
    // One after the other: arguments of one call come in any order.
    const double y = between(&m->numbers, -0.1, 1.1) * camera->height_px;
    const double x = between(&m->numbers, -0.1, 1.1) * camera->width_px;
    unproject(m, x, y, z, p);
}

static void choose_colors(maker *m) {
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < 3; i++) m->color[k][i] = between(&m->numbers, 0, 1);
    m->alpha = between(&m->numbers, 0.05, 0.95);
    m->material = below(&m->numbers, RANDOM_SCENE_MATERIALS);
}

/// A jittered grid on a plane, waved or not.
static void make_sheet(maker *m, uint32_t side, bool waves) {
    stream *numbers = &m->numbers;
    double center[3], n[3], a[3], b[3];
    const double z = scaled(numbers, 0.3, 8), spacing = scaled(numbers, 0.4, 25) * pixel_at(m, z);
    somewhere(m, z, center);
    direction(numbers, n);
    frame(numbers, n, a, b);
    const double height = waves ? spacing * between(numbers, 0.5, 3) : 0, length = between(numbers, 3, 12);
    for (uint32_t row = 0; row < side; row++)
        for (uint32_t column = 0; column < side; column++) {
            const double x = column - side / 2.0 + between(numbers, -0.3, 0.3);
            const double y = row - side / 2.0 + between(numbers, -0.3, 0.3);
            const double phase = 2 * PI * x / length,
                         slope = -height / spacing * 2 * PI / length * cos(phase);
            double p[3], tilted[3];
            for (int i = 0; i < 3; i++) {
                p[i] = center[i] + spacing * (x * a[i] + y * b[i]) + height * sin(phase) * n[i];
                tilted[i] = n[i] + slope * a[i];
            }
            normalize(tilted);
            put(m, p, tilted, spacing);
        }
    say(m, " sheet");
}

/// The ground, from behind the eye to far away.
static void make_floor(maker *m, uint32_t count) {
    stream *numbers = &m->numbers;
    // Without perspective level ground is seen from its edge.
    const double tilt = m->made->scene.camera.projection == EWA_ORTHOGRAPHIC ? between(numbers, 0.02, 1) : 0;
    const double height = between(numbers, 0.1, 1.5), n[3] = {0, -cos(tilt), -sin(tilt)};
    const double spread = pixel_at(m, 1) * m->made->scene.camera.width_px;
    for (uint32_t i = 0; i < count; i++) {
        const double z = i % 4 == 0 ? between(numbers, -1, 1) : scaled(numbers, 0.5, 30);
        const double p[3] = {between(numbers, -0.7, 0.7) * spread * (1 + fabs(z)), height - z * tan(tilt), z};
        put(m, p, n, (0.1 + fabs(z) * 0.15) * fmin(spread, 2));
    }
    say(m, " floor");
}

static void make_ball(maker *m, uint32_t count) {
    stream *numbers = &m->numbers;
    double center[3];
    const double z = scaled(numbers, 0.5, 10),
                 radius = fmin(scaled(numbers, 2, 80) * pixel_at(m, z), 0.8 * z);
    somewhere(m, z, center);
    for (uint32_t i = 0; i < count; i++) {
        const double h = 1 - (2 * i + 1.0) / count, turn = 2.399963229728653 * i, r = sqrt(1 - h * h);
        const double n[3] = {r * cos(turn), r * sin(turn), h};
        const double p[3] = {center[0] + radius * n[0], center[1] + radius * n[1], center[2] + radius * n[2]};
        put(m, p, n, radius * sqrt(4 * PI / count));
    }
    say(m, " ball");
}

/// Surfels of any size and direction; some beside, before and behind the eye.
static void make_soup(maker *m, uint32_t count) {
    stream *numbers = &m->numbers;
    for (uint32_t i = 0; i < count; i++) {
        double p[3], n[3];
        const double z = scaled(numbers, 0.05, 20);
        somewhere(m, z, p);
        if (chance(numbers, 0.05)) p[2] *= between(numbers, -1, 0.5);
        direction(numbers, n);
        const double size = i % 20 == 0 ? scaled(numbers, 10, 100) : scaled(numbers, 0.1, 10);
        put(m, p, n, size * pixel_at(m, z));
    }
    say(m, " soup");
}

/// A sheet of which surfels that reach beyond a line, or a corner, are cut there.
static void make_cut(maker *m, uint32_t side) {
    stream *numbers = &m->numbers;
    double center[3], n[3], a[3], b[3];
    const double z = scaled(numbers, 0.3, 5), spacing = scaled(numbers, 1.5, 25) * pixel_at(m, z);
    somewhere(m, z, center);
    direction(numbers, n);
    frame(numbers, n, a, b);
    const uint32_t lines = 1 + below(numbers, 2);
    const bool either = chance(numbers, 0.5);
    double normal[2][2], offset[2];
    for (uint32_t k = 0; k < 2; k++) {
        const double turn = between(numbers, 0, 2 * PI);
        normal[k][0] = cos(turn), normal[k][1] = sin(turn), offset[k] = between(numbers, -0.2, 0.3) * side;
    }
    for (uint32_t row = 0; row < side; row++)
        for (uint32_t column = 0; column < side; column++) {
            const double x = column - side / 2.0 + between(numbers, -0.3, 0.3);
            const double y = row - side / 2.0 + between(numbers, -0.3, 0.3);
            double p[3];
            for (int i = 0; i < 3; i++) p[i] = center[i] + spacing * (x * a[i] + y * b[i]);
            independent_surfel *s = put(m, p, n, spacing);
            if (!s) return;
            // a u + b v + c for the line at a distance of `inside` from the surfel, in its own axes.
            s->clip_count = lines, s->clip_either = either;
            for (uint32_t k = 0; k < lines; k++) {
                const double inside = offset[k] + normal[k][0] * x + normal[k][1] * y;
                double u = 0, v = 0;
                for (int i = 0; i < 3; i++) {
                    const double toward = normal[k][0] * a[i] + normal[k][1] * b[i];
                    u += toward * s->axis_u[i], v += toward * s->axis_v[i];
                }
                s->clip[k][0] = u, s->clip[k][1] = v, s->clip[k][2] = inside * spacing;
            }
        }
    say(m, lines == 1 ? " cut" : either ? " cut either" : " cut both");
}

/// Sheets behind one another, across the view.
static void make_stack(maker *m, uint32_t side) {
    stream *numbers = &m->numbers;
    const uint32_t sheets = 2 + below(numbers, 3);
    const double z = scaled(numbers, 1, 4), spacing = scaled(numbers, 2, 12) * pixel_at(m, z);
    double center[3], n[3] = {between(numbers, -0.5, 0.5), between(numbers, -0.5, 0.5), -1}, a[3], b[3];
    somewhere(m, z, center);
    normalize(n);
    frame(numbers, n, a, b);
    for (uint32_t k = 0; k < sheets; k++) {
        choose_colors(m);
        for (uint32_t i = 0; i < side * side; i++) {
            double p[3];
            const double x = i % side - side / 2.0 + between(numbers, -0.3, 0.3);
            const double y = i / side - side / 2.0 + between(numbers, -0.3, 0.3);
            for (int c = 0; c < 3; c++)
                p[c] = center[c] + spacing * (x * a[c] + y * b[c]) -
                       n[c] * k * between(numbers, 5.5, 6) * spacing;
            put(m, p, n, spacing);
        }
    }
    say(m, " stack");
}

/// A random rotation, by a unit quaternion.
static void rotation(stream *numbers, double r[3][3]) {
    double q[4], length = 0;
    do {
        length = 0;
        for (int i = 0; i < 4; i++) q[i] = between(numbers, -1, 1), length += q[i] * q[i];
    } while (length > 1 || length < 0.01);
    const double w = q[0] / sqrt(length), x = q[1] / sqrt(length), y = q[2] / sqrt(length),
                 z = q[3] / sqrt(length);
    const double m[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                            {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                            {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
    memcpy(r, m, sizeof m);
}

static void make_camera(maker *m) {
    stream *numbers = &m->numbers;
    ewa_camera *camera = &m->made->scene.camera;
    ewa_camera_init(camera);
    camera->width_px = 60 + below(numbers, 70);
    camera->height_px = 60 + below(numbers, 70);
    if (chance(numbers, 0.2)) camera->projection = EWA_ORTHOGRAPHIC;
    const double fov = chance(numbers, 0.3) ? between(numbers, 90, 150) : between(numbers, 5, 90);
    camera->fy_px = camera->projection == EWA_ORTHOGRAPHIC ? camera->height_px / between(numbers, 1, 4)
                                                           : camera->height_px / 2.0 / tan(fov * PI / 360);
    camera->fx_px = camera->fy_px * (chance(numbers, 0.5) ? 1 : scaled(numbers, 0.5, 2));
    camera->cx_px = camera->width_px / 2.0, camera->cy_px = camera->height_px / 2.0;
    if (chance(numbers, 0.4)) {
        const double reach = chance(numbers, 0.3) ? 1.5 : 0.3;
        camera->cx_px += between(numbers, -reach, reach) * camera->width_px;
        camera->cy_px += between(numbers, -reach, reach) * camera->height_px;
    }
    if (camera->projection == EWA_ORTHOGRAPHIC)
        say(m, "ortho");
    else
        say(m, "fov %.0f", fov);
    say(m, " centre %.1f %.1f aspect %.2f", camera->cx_px / camera->width_px,
        camera->cy_px / camera->height_px, camera->fx_px / camera->fy_px);
}

static void make_lights(maker *m) {
    stream *numbers = &m->numbers;
    ewa_render_options *options = &m->made->scene.options;
    options->light_count = 1 + below(numbers, 5);
    for (uint32_t i = 0; i < options->light_count; i++) {
        ewa_light *light = &options->lights[i];
        ewa_light_init(light);
        if (chance(numbers, 0.8)) {
            direction(numbers, light->direction_world);
            for (int c = 0; c < 3; c++) light->direction_world[c] *= 3;
        }
        for (int c = 0; c < 3; c++) light->color[c] = (float)between(numbers, 0, 1);
    }
    for (int i = 0; i < RANDOM_SCENE_MATERIALS; i++)
        m->made->materials[i] = (ewa_material){.ambient = (float)between(numbers, 0, 0.5),
                                               .diffuse = (float)between(numbers, 0, 1),
                                               .specular = (float)between(numbers, 0, 1),
                                               .shininess = (float)scaled(numbers, 1, 300),
                                               .reflection = 0};
    if (chance(numbers, 0.5)) {
        options->materials = m->made->materials;
        options->material_count = RANDOM_SCENE_MATERIALS;
    }
}

/// A sky of a few lights and a ground.
static void make_sky(ewa_context *context, maker *m) {
    stream *numbers = &m->numbers;
    random_scene *made = m->made;
    ewa_image sky;
    const uint32_t width = 1 + below(numbers, 40), height = 1 + below(numbers, 20);
    if (ewa_image_create(context, width, height, chance(numbers, 0.2) ? 1 : 3, &sky) != EWA_OK) abort();
    for (uint32_t i = 0; i < width * height * sky.channel_count; i++)
        sky.pixels[i] = (float)(chance(numbers, 0.05) ? between(numbers, 0, 3) : between(numbers, 0, 0.5));
    made->sky = calloc(1, sizeof *made->sky);
    if (!made->sky || ewa_environment_create(&sky, &made->environment) != EWA_OK) abort();
    independent_environment_make(&sky, made->sky);
    ewa_image_free(&sky);
    made->scene.sky = made->sky, made->scene.options.environment = made->environment;
    if (chance(numbers, 0.8)) direction(numbers, made->scene.options.environment_up);
    for (int i = 0; i < RANDOM_SCENE_MATERIALS; i++)
        made->materials[i].reflection = (float)between(numbers, 0, 1);
    say(m, " sky");
}

static void make_options(ewa_context *context, maker *m) {
    static const char *const kernels[] = {"perspective", "affine", "source", "circular", "raycast"};
    static const char *const shadings[] = {"plain", "lambert", "phong"};
    stream *numbers = &m->numbers;
    random_scene *made = m->made;
    ewa_render_options *options = &made->scene.options;
    ewa_render_options_init(options, sizeof *options);
    ewa_surfels_options_init(&made->surfels_options, sizeof made->surfels_options);
    if (chance(numbers, 0.5)) options->kernel = (ewa_kernel)below(numbers, 5);
    if (chance(numbers, 0.4)) made->surfels_options.cutoff = between(numbers, 1, 4);
    if (chance(numbers, 0.3)) made->surfels_options.radius_scale = between(numbers, 0.5, 2);
    if (chance(numbers, 0.4)) options->prefilter_px = chance(numbers, 0.2) ? 0 : between(numbers, 0.1, 1.5);
    if (chance(numbers, 0.3)) options->tolerance = between(numbers, 0, 4);
    if (chance(numbers, 0.1)) options->passes = 1;
    if (chance(numbers, 0.2)) options->edge_antialiasing = false;
    if (chance(numbers, 0.3)) options->edge_threshold = between(numbers, 0.1, 1.2);
    if (chance(numbers, 0.3)) options->edge_layers = 1 + below(numbers, EWA_MAX_EDGE_LAYERS);
    if (chance(numbers, 0.2)) options->opacity = between(numbers, 0, 1);
    m->translucent = chance(numbers, 0.2);
    if (chance(numbers, 0.3)) options->layers = 1 + below(numbers, 5);
    if (chance(numbers, 0.2)) options->cull = EWA_CULL_BACK;
    options->shading = (ewa_shading)below(numbers, 3);
    options->ambient = between(numbers, 0, 1);
    if (options->shading != EWA_SHADING_NONE && chance(numbers, 0.7)) make_lights(m);
    if (chance(numbers, 0.15)) options->eye_dome = scaled(numbers, 0.01, 3);
    if (chance(numbers, 0.6))
        for (int c = 0; c < 4; c++) options->background[c] = (float)between(numbers, 0, 1);
    if (options->shading == EWA_SHADING_PHONG && chance(numbers, 0.5)) make_sky(context, m);
    made->scene.cutoff = made->surfels_options.cutoff;
    made->scene.radius_scale = made->surfels_options.radius_scale;
    say(m, " %s %s F %.2f h %.2f kappa %.2f passes %u%s layers %u/%u opacity %.2f%s%s%s",
        kernels[options->kernel], shadings[options->shading], made->scene.cutoff, options->prefilter_px,
        options->tolerance, options->passes, options->edge_antialiasing ? "" : " hard", options->layers,
        options->edge_layers, options->opacity, m->translucent ? " translucent" : "",
        options->cull == EWA_CULL_BACK ? " cull" : "", options->eye_dome > 0 ? " dome" : "");
}

static void make_objects(maker *m) {
    stream *numbers = &m->numbers;
    const uint32_t objects = 1 + below(numbers, 3);
    for (uint32_t i = 0; i < objects; i++) {
        choose_colors(m);
        m->fatness = chance(numbers, 0.6) ? 1.14 : between(numbers, 0.8, 2.5);
        m->shears = chance(numbers, 0.5);
        m->aspect = chance(numbers, 0.6) ? 1 : chance(numbers, 0.6) ? 4 : 1000;
        const uint32_t side = objects == 1 ? 18 : objects == 2 ? 14 : 11;
        switch (below(numbers, m->discs ? 5 : 7)) {
        case 0:
            make_sheet(m, side, false);
            break;
        case 1:
            make_sheet(m, side, true);
            break;
        case 2:
            make_floor(m, side * side);
            break;
        case 3:
            make_ball(m, side * side);
            break;
        case 4:
            chance(numbers, 0.5) ? make_soup(m, side * side) : make_stack(m, 2 * side / 3);
            break;
        default:
            make_cut(m, side);
            break;
        }
    }
    if (chance(numbers, 0.1)) {
        for (uint64_t i = 0; i < m->made->scene.surfel_count; i++)
            if (chance(numbers, 0.05)) {
                const double gain = scaled(numbers, 1, 1e4);
                for (int c = 0; c < 3; c++) m->made->surfels[i].color[c] *= gain;
            }
        say(m, " hdr");
    }
}

/// Carries the scene from camera space to the world, through a rotation, a scale and a place.
static void make_world(maker *m, double origin[3]) {
    stream *numbers = &m->numbers;
    random_scene *made = m->made;
    const double unit = scaled(numbers, 1e-2, 1e3),
                 scale = chance(numbers, 0.4) ? scaled(numbers, 1e-2, 1e2) : 1;
    double r[3][3], shift[3];
    rotation(numbers, r);
    direction(numbers, shift);
    ewa_camera *camera = &made->scene.camera;
    if (camera->projection == EWA_ORTHOGRAPHIC) camera->fx_px /= unit, camera->fy_px /= unit;
    const bool far = chance(numbers, 0.3);
    for (int i = 0; i < 3; i++) {
        shift[i] *= unit * between(numbers, 0, 10);
        for (int j = 0; j < 3; j++) camera->world_to_camera[4 * i + j] = scale * r[i][j];
    }
    for (int i = 0; i < 3; i++) origin[i] = far ? between(numbers, -1e3, 1e3) * unit : 0;
    for (int i = 0; i < 3; i++) {
        double moved = shift[i];
        for (int j = 0; j < 3; j++) moved -= scale * r[i][j] * origin[j];
        camera->world_to_camera[4 * i + 3] = moved;
    }
    for (uint64_t k = 0; k < made->scene.surfel_count; k++) {
        independent_surfel *s = &made->surfels[k], from = *s;
        for (int j = 0; j < 3; j++) {
            s->position[j] = s->normal[j] = s->axis_u[j] = s->axis_v[j] = 0;
            for (int i = 0; i < 3; i++) {
                s->position[j] += r[i][j] * (from.position[i] * unit - shift[i]) / scale;
                s->normal[j] += r[i][j] * from.normal[i];
                s->axis_u[j] += r[i][j] * from.axis_u[i] * unit / scale;
                s->axis_v[j] += r[i][j] * from.axis_v[i] * unit / scale;
            }
        }
        s->radius = from.radius * unit / scale;
        for (uint32_t c = 0; c < s->clip_count; c++)
            for (int i = 0; i < 3; i++) s->clip[c][i] *= unit / scale;
    }
    say(m, " unit %.1g scale %.1g%s", unit, scale, far ? " far" : "");
}

void random_scene_make(ewa_context *context, uint64_t seed, random_scene *made) {
    *made = (random_scene){.surfels = calloc(ROOM, sizeof *made->surfels)};
    if (!made->surfels) abort();
    maker m = {.numbers = {seed * 0x9e3779b97f4a7c15u + 0x1234567u}, .made = made};
    for (int i = 0; i < 8; i++) next(&m.numbers);
    double origin[3];
    make_camera(&m);
    make_options(context, &m);
    m.discs = chance(&m.numbers, 0.5);
    // With one pass the nearest surfel wins: in a plane that is all of them, and rounding would decide.
    m.roughness = made->scene.options.passes == 1 ? 0.05 : 0;
    say(&m, m.discs ? " discs" : " ellipses");
    make_objects(&m);
    make_world(&m, origin);
    static const char *const types[] = {" u8", " u16", " f32"};
    const ewa_type type = scene_cloud_color_type(made, below(&m.numbers, 3));
    const bool doubles = chance(&m.numbers, 0.5);
    scene_cloud_make(context, made, origin, doubles ? EWA_F64 : EWA_F32, type);
    say(&m, "%s%s", types[type == EWA_U8 ? 0 : type == EWA_U16 ? 1 : 2], doubles ? " f64" : "");
}
