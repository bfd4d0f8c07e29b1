// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa generate: test objects.
#include "cli/base/commands.h"
#include "cli/base/pattern.h"
#include "cli/image/textured.h"

#include <stdio.h>
#include <string.h>

typedef struct generate_arguments {
    textured_arguments textured; // first
    ewa_generate_options options;
    option_vector dims;
} generate_arguments;

#define AT(member)       offsetof(generate_arguments, member)
#define GENERATE(member) OPTION_OF(ewa_generate_options, AT(options), member)

/// In the order of ewa_object.
static const char *const objects[] = {"plane", "checker", "cube", "sphere", "torus", "terrain", "csg", "town"};

/// In the order of ewa_volume_object.
static const char *const volumes[] = {"checkerbox", "blob", "ball", "vessels"};

static const cli_option object_table[] = {
    {"points", OPTION_INTEGER, AT(options.point_count), "N", "[1, 4294967279]",
     .help = "about how many points; grids round", .letter = 'n'},
    {"seed", GENERATE(seed)},
    {"extent", GENERATE(size_world), .value = "SIZE",
     .help = "edge of plane, cube, terrain and town, outer diameter of sphere and torus, length of csg, longest "
             "edge of a volume, in world units"},
    {"jitter", GENERATE(jitter)},
    {"checks", GENERATE(checks),
     .help = "squares along an edge of the checkerboard and of the cube's faces, cubes of checkerbox"},
    {"radius-scale", GENERATE(radius_scale), .absent = "auto: closed for the jitter"},
    {"positions-only", OPTION_FLAG, AT(options.positions_only),
     .help = "leave out normals and radii, as a scanner does"},
    {"sharp", OPTION_FLAG, AT(options.sharp),
     .help = "cube and csg: clip lines on every edge, and points on the edges"},
    {"dims", OPTION_VECTOR, AT(dims), "x,y,z",
     .help = "volumes: voxels along each axis; one number: along all", .low = 1, .high = 3,
     .absent = "auto: 128,128,128"},
};

static void set_defaults(void *data) {
    generate_arguments *arguments = data;
    ewa_generate_options_init(&arguments->options, sizeof arguments->options);
    textured_set_defaults(&arguments->textured);
}

enum {
    OBJECT_COUNT = sizeof objects / sizeof objects[0],
    VOLUME_COUNT = sizeof volumes / sizeof volumes[0],
};

/// Index of a word in a list; `count` when it is not there.
static size_t find_word(const char *word, size_t count, const char *const *words) {
    size_t index = 0;
    while (index < count && strcmp(words[index], word) != 0) index++;
    return index;
}

/// What is wrong with the options for a volume; NULL: nothing.
static const char *check_volume(const generate_arguments *arguments) {
    const output_arguments *output = &arguments->textured.procedure.output;
    const ewa_generate_options *options = &arguments->options;
    ewa_generate_options defaults;
    ewa_generate_options_init(&defaults, sizeof defaults);
    if (!output->path) return "no output; say -o FILE";
    if (!path_has_suffix(output->path, ".nrrd|-"))
        return "generate: this is a volume, which goes to a .nrrd file";
    if (output->ascii || output->big_endian || options->positions_only || options->sharp ||
        arguments->textured.picture || arguments->textured.procedure.procedure ||
        options->point_count != defaults.point_count || options->jitter != defaults.jitter ||
        options->radius_scale != defaults.radius_scale)
        return "generate: of a volume are --dims, --extent, --checks and --seed only";
    for (uint32_t k = 0; k < arguments->dims.count; k++) {
        const double side = arguments->dims.values[k];
        if (!(side >= 2 && side <= 65536) || side != (double)(uint32_t)side)
            return "--dims: whole numbers in [2, 65536]";
    }
    return arguments->dims.count == 2 ? "--dims: one number or three" : NULL;
}

static bool check(const void *data, char message[OPTION_ERROR_BYTES]) {
    const generate_arguments *arguments = data;
    const char *word = arguments->textured.procedure.output.common.operands[0];
    const bool volume = find_word(word, VOLUME_COUNT, volumes) < VOLUME_COUNT;
    if (!volume && find_word(word, OBJECT_COUNT, objects) == OBJECT_COUNT) {
        const char *nearest = options_nearest(word, OBJECT_COUNT, objects);
        if (!nearest) nearest = options_nearest(word, VOLUME_COUNT, volumes);
        snprintf(
            message, OPTION_ERROR_BYTES,
            "generate: '%.80s' is none of plane, checker, cube, sphere, torus, terrain, csg, town, checkerbox, "
            "blob, ball, vessels%s%s",
            word, nearest ? "; did you mean " : "", nearest ? nearest : "");
        return false;
    }
    const char *wrong = volume                  ? check_volume(arguments)
                        : arguments->dims.count ? "generate: --dims is of volumes"
                                                : NULL;
    if (!options_fine(wrong, message)) return false;
    if (volume) return true;
    const procedure_arguments *procedure = &arguments->textured.procedure;
    if (arguments->options.positions_only && procedure->procedure && procedure->options.prefilter > 0) {
        snprintf(message, OPTION_ERROR_BYTES, "--procedure with --positions-only needs --prefilter-scale 0");
        return false;
    }
    return procedure_check(&arguments->textured.procedure, message);
}

/// Puts the picture onto a new object. It goes on where the object closes upon itself.
static ewa_status add_picture(const textured_arguments *textured, ewa_object object, const ewa_image *picture,
                              ewa_cloud *cloud) {
    ewa_acquire_options options = textured->acquire;
    if (object != EWA_OBJECT_SPHERE && object != EWA_OBJECT_TORUS) options.wrap_s = EWA_TEXTURE_CLAMP;
    if (object != EWA_OBJECT_TORUS) options.wrap_t = EWA_TEXTURE_CLAMP;
    const ewa_status status = ewa_cloud_acquire(cloud, picture, 1, &options, NULL);
    ewa_cloud_remove(cloud, EWA_TEXCOORD);
    ewa_cloud_remove(cloud, EWA_TEXCOORD_S);
    ewa_cloud_remove(cloud, EWA_TEXCOORD_T);
    return status;
}

/// What the radii of generated objects are meant for, as everywhere by default.
static const double GENERATED_CUTOFF = 3;

static ewa_cloud *make(cli_session *session, const void *data) {
    const generate_arguments *arguments = data;
    ewa_generate_options options = arguments->options;
    options.object =
        (ewa_object)find_word(arguments->textured.procedure.output.common.operands[0], OBJECT_COUNT, objects);
    ewa_image picture;
    if (!textured_load(session, &arguments->textured, &picture)) return NULL;
    options.texcoords = picture.pixels != NULL;
    session->subject = arguments->textured.procedure.output.path;
    ewa_cloud *cloud = NULL;
    ewa_status status = ewa_cloud_generate(session->context, &options, &cloud);
    if (status == EWA_OK && picture.pixels)
        status = add_picture(&arguments->textured, options.object, &picture, cloud);
    ewa_image_free(&picture);
    if (status != EWA_OK) session_failed(session, status);
    if (status != EWA_OK ||
        !procedure_apply(session, &arguments->textured.procedure, GENERATED_CUTOFF, cloud))
        ewa_cloud_destroy(&cloud);
    return cloud;
}

/// Makes volume `object` and writes it; the exit status.
static int run_volume(const generate_arguments *arguments, ewa_volume_object object) {
    const output_arguments *output = &arguments->textured.procedure.output;
    cli_session session;
    if (!session_start(&session, &output->common)) return session_end(&session, EXIT_FAILED);
    ewa_volume_generate_options options;
    ewa_volume_generate_options_init(&options, sizeof options);
    options.object = object;
    options.size_world = arguments->options.size_world;
    options.checks = arguments->options.checks;
    options.seed = arguments->options.seed;
    const option_vector *dims = &arguments->dims;
    for (uint32_t k = 0; dims->count && k < 3; k++)
        options.dims[k] = (uint32_t)dims->values[dims->count == 1 ? 0 : k];
    session.subject = output->path;
    ewa_volume volume = {.context = NULL};
    ewa_status status = ewa_volume_generate(session.context, &options, &volume);
    if (status == EWA_OK) status = ewa_volume_save(&volume, output->path, NULL);
    const bool done = status == EWA_OK;
    if (!done)
        session_failed(&session, status);
    else
        session_say(&session, "%s: %u x %u x %u voxels written", output->path, options.dims[0],
                    options.dims[1], options.dims[2]);
    ewa_volume_free(&volume);
    return session_end(&session, done ? EXIT_DONE : EXIT_FAILED);
}

static int run(const void *data) {
    const generate_arguments *arguments = data;
    const size_t volume =
        find_word(arguments->textured.procedure.output.common.operands[0], VOLUME_COUNT, volumes);
    return volume < VOLUME_COUNT ? run_volume(arguments, (ewa_volume_object)volume)
                                 : cloud_output_run(data, make);
}

static const option_group object_options = OPTION_GROUP("Object", object_table);
const cli_command generate_command = {
    .name = "generate",
    .operands = "KIND -o OUT",
    .summary = "make test objects: plane, checker, cube, sphere, torus, terrain, csg, town; and volumes",
    .details =
        "The object is centred at the origin. Plane, checker, terrain and town lie in x-y with z up; the axis of "
        "the torus is z. csg is a block with a slot, a notch and two round holes; town has 160 boxes with windows, "
        "1,400 trees of loose leaves, streets and lawns. --texture lays a picture upon plane, checker, terrain and "
        "town, onto every face of the cube and of csg, by longitude and latitude around the sphere, and around ring "
        "and tube of the torus.\n"
        "\n"
        "Volumes go to .nrrd files: checkerbox, solid cubes of two values; blob, a Gaussian; ball, a ball "
        "with a soft edge; vessels, a tree of thin tubes.",
    .examples = "ewa generate torus -o torus.ply --points 200000\n"
                "ewa generate terrain -o terrain.ply -n 4000000 --seed 7\n"
                "ewa generate sphere --texture earth.png -n 1000000 -o earth.ply\n"
                "ewa generate csg --sharp -n 7000 -o part.ply\n"
                "ewa generate checker -o - --jitter 0 | ewa render - -o checker.png --shading none\n"
                "ewa generate vessels -o vessels.nrrd --dims 256\n",
    .low_operands = 1,
    .high_operands = 1,
    .groups = (const option_group *const[]){&cloud_output_options, &object_options, &procedure_options,
                                            &textured_options, NULL},
    .arguments_bytes = sizeof(generate_arguments),
    .set_defaults = set_defaults,
    .check = check,
    .run = run,
};
