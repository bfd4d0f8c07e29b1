// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa page: a page for a browser that shows what `ewa render` would, and can be turned.
#include "cli/base/commands.h"
#include "cli/base/json.h"
#include "cli/base/path.h"
#include "cli/input/inputs.h"
#include "cli/input/scene_input.h"
#include "cli/page/page_html.h"
#include "cli/render/look.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

typedef struct page_arguments {
    frames_arguments frames; // first; the camera's options of it are taken, there are no frames
    look_arguments look;     // second
    const char *output, *folder, *title, *assets;
    bool small;
} page_arguments;

#define AT(member) offsetof(page_arguments, member)

static const cli_option output_table[] = {
    {"output", OPTION_OUTPUT, AT(output), "FILE.html",
     .help = "a page of one file, with program and data in it, that opens without a server; -: to standard output", .letter = 'o',
     .excludes = "folder"},
    {"folder", OPTION_TEXT, AT(folder), "DIR",
     .help = "a folder for a web server in its place, with the data as files; there must be none, or an empty one", .absent = "none"},
    {"title", OPTION_TEXT, AT(title), "TEXT", .help = "the page's title", .absent = "auto: the first file's name"},
    {"small", OPTION_FLAG, AT(small),
     .help = "bare points become LAZ, Gaussians SPZ, which keep fewer digits; else files stay as they are, and only what a page cannot "
             "read is converted"},
    {"assets", OPTION_TEXT, AT(assets), "DIR", .help = "the folder of page.wasm.gz and the scripts that pages draw with",
     .absent = "auto: as installed"},
};

_Static_assert(offsetof(page_arguments, look) == LOOK_OFFSET, "the look's tables say so");

static void set_defaults(void *data) {
    page_arguments *arguments = data;
    view_set_defaults(&arguments->frames.view);
    look_set_defaults(&arguments->look);
}

static bool check(const void *data, char message[OPTION_ERROR_BYTES]) {
    const page_arguments *arguments = data;
    const bool has_output = arguments->output || arguments->folder;
    return options_fine(has_output ? NULL : "page: no output; say -o FILE.html, or --folder DIR", message) && look_check(&arguments->look, NULL, message) &&
           view_check(&arguments->frames.view, false, message);
}

/// Checks the operands as `ewa render` would read them, and finds the camera that is asked for. False after reporting.
static bool look(cli_session *session, const page_arguments *arguments, const page_choice *choice, ewa_camera *camera,
                 bool *has_camera) {
    ewa_scene *scene = NULL;
    *has_camera = view_is_placed(&arguments->frames.view);
    bool done = session_passed(session, ewa_scene_create(session->context, choice->options, &scene)) &&
                scene_input_add(session, choice->count, choice->paths, choice->assets, choice->coloring, scene);
    if (done && !ewa_coloring_is_own(choice->coloring->attribute)) done = session_passed(session, ewa_scene_commit(scene)); // finds it
    const view_subject subject = {.scene = scene};
    if (done && *has_camera)
        done = view_make(session, &arguments->frames.view, &subject, camera, NULL);
    else if (done)
        *has_camera = ewa_scene_get_camera(scene, camera);
    ewa_scene_destroy(&scene);
    return done;
}

/// Puts the program beside the data of a folder. False after reporting.
static bool put_program(cli_session *session, const page_assets *assets, page_data *data, const page_words *words) {
    char path[PATH_BYTES];
    for (int i = 0; i <= PAGE_ASSET_COUNT; i++) {
        const bool is_page = i == PAGE_ASSET_COUNT; // which comes last: what it names is there
        if (i == PAGE_SINGLE_JS || (!is_page && !assets->each[i].bytes)) continue;
        const char *name = is_page ? "index.html" : page_asset_names[i];
        FILE *file = snprintf(path, sizeof path, "%s/%s", data->folder, name) < (int)sizeof path && page_data_add(data, name)
                         ? fopen(path, "wb")
                         : NULL;
        bool done = file != NULL;
        if (done && is_page) done = page_html_folder(words, file);
        if (done && !is_page) done = fwrite(assets->each[i].bytes, 1, assets->each[i].size_bytes, file) == assets->each[i].size_bytes;
        if (file && fclose(file) != 0) done = false;
        if (done) continue;
        session_fail(session, "%s: %s", path, strerror(errno));
        return false;
    }
    return true;
}

/// Makes the page of one file. False after reporting.
static bool write_single(cli_session *session, const page_arguments *arguments, const page_assets *assets, const page_data *data,
                         const page_words *words) {
    text_file text;
    if (!text_file_open(session, &text, arguments->output)) return false;
    if (page_html_single(session, assets, data, words, text.file)) return text_file_close(session, &text);
    text_file_drop(&text);
    return false;
}

/// Makes the folder that files are put in: beside the one that is asked for, or for a while. False after reporting.
static bool make_folder(cli_session *session, const page_arguments *arguments, page_data *data) {
    char own[SESSION_FOLDER_BYTES];
    if (!arguments->folder) {
        if (!session_make_folder(session, own)) return false;
        snprintf(data->folder, sizeof data->folder, "%s", own);
        return true;
    }
    size_t length = strlen(arguments->folder);
    while (length > 1 && arguments->folder[length - 1] == '/') length--;
    const bool fits = snprintf(data->folder, sizeof data->folder, "%.*s.ewa-%ld.tmp", (int)length, arguments->folder, path_process_number()) <
                      (int)sizeof data->folder;
    if (fits && path_make_folder(data->folder)) return true;
    session_fail(session, "--folder: %s: %s", arguments->folder, strerror(fits ? errno : ENAMETOOLONG));
    data->folder[0] = 0;
    return false;
}

/// Makes a folder that is whole appear. An empty one that is there gives way, which Windows has to be told.
static bool show_folder(cli_session *session, const char *folder, page_data *data) {
    if (rename(data->folder, folder) == 0 || (rmdir(folder) == 0 && rename(data->folder, folder) == 0)) {
        data->folder[0] = 0;
        return true;
    }
    session_fail(session, "--folder: %s: %s", folder, strerror(errno));
    return false;
}

static bool make(cli_session *session, const page_arguments *arguments, const page_assets *assets, const page_choice *choice,
                 page_data *data) {
    const char *path = choice->paths[0], *name = path_file_name(path);
    const page_words words = {.title = arguments->title ? arguments->title : *name ? name : path,
                              .color_bar = arguments->look.coloring.color_by && !ewa_coloring_is_own(arguments->look.coloring.color_by)};
    if (!make_folder(session, arguments, data) || !page_data_make(session, choice, data)) return false;
    return arguments->folder ? put_program(session, assets, data, &words) && show_folder(session, arguments->folder, data)
                             : write_single(session, arguments, assets, data, &words);
}

static int run(const void *data) {
    const page_arguments *arguments = data;
    const common_arguments *common = &arguments->frames.view.common;
    cli_session session;
    if (!session_start(&session, common)) return session_end(&session, EXIT_FAILED);
    const light_objects none = {.material_count = 0};
    const ewa_scene_options options = look_scene_options(&arguments->look, &none);
    ewa_asset_options of_assets = scene_input_asset_options(&session);
    look_set_asset_options(&arguments->look, &of_assets);
    ewa_coloring coloring;
    scene_input_coloring(&arguments->look.coloring, &coloring);
    page_choice choice = {.paths = common->operands,
                          .count = common->operand_count,
                          .assets = &of_assets,
                          .coloring = &coloring,
                          .options = &options,
                          .small = arguments->small};
    page_assets assets;
    page_data made = {.count = 0};
    ewa_camera camera;
    bool has_camera = false;
    bool done = page_assets_load(&session, arguments->assets, &assets) && look(&session, arguments, &choice, &camera, &has_camera);
    session.repeats = true; // what there is to say of the files has been said
    choice.camera = has_camera ? &camera : NULL;
    done = done && make(&session, arguments, &assets, &choice, &made);
    if (made.folder[0]) {
        page_data_remove(&made);
        rmdir(made.folder);
    }
    page_data_free(&made);
    page_assets_free(&assets);
    return session_end(&session, done ? EXIT_DONE : EXIT_FAILED);
}

static const option_group output_options = OPTION_GROUP("Output", output_table);
const cli_command page_command = {
    .name = "page",
    .operands = "IN... -o OUT.html",
    .summary = "make a page for a browser, with the viewer and the data in it",
    .details = "The page shows what 'ewa render' would, turns, zooms, picks and measures, on the processor, also on a phone. It is one file "
               "that opens without a server and asks no other site for anything. Files go into it as they are; other formats of points "
               "become PLY, meshes points on their faces, Gaussians SPZ, volumes NRRD where a page cannot read them. Materials and "
               "environments are not for pages.\n"
               "\n"
               "With --folder, a web server has to send the files as they are ('ewa serve' does, to this machine); with the headers Cross-Origin-Opener-Policy: same-origin and "
               "Cross-Origin-Embedder-Policy: require-corp several threads draw, and moving is smoother.",
    .examples = "ewa page scan.laz -o scan.html\n"
                "ewa page scene.json -o exhibit.html --title \"The hall, 2026\"\n"
                "ewa page trained.ply --small --view front -o trained.html\n"
                "ewa page survey.laz --color-by classification --folder site\n",
    .low_operands = 1,
    .high_operands = 64,
    .groups = (const option_group *const[]){&output_options, &cloud_input_options, &view_options, LOOK_SCENE_GROUPS, NULL},
    .arguments_bytes = sizeof(page_arguments),
    .set_defaults = set_defaults,
    .check = check,
    .run = run,
};
