// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa lod: clouds of any size to an octree with surfels at every level.
#include "cli/base/commands.h"
#include "cli/base/interruption.h"
#include "cli/base/json.h"
#include "cli/base/outputs.h"
#include "cli/base/session.h"
#include "cli/input/gaussian_files.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PART_NAME_BYTES = 4096 };

typedef struct lod_command_arguments {
    common_arguments common; // first
    const char *output, *subset, *stats_path;
    bool merge;
    ewa_lod_build_options options;
} lod_command_arguments;

#define AT(member)    offsetof(lod_command_arguments, member)
#define BUILD(member) OPTION_OF(ewa_lod_build_options, AT(options), member)

static const cli_option output_table[] = {
    {"output", OPTION_OUTPUT, AT(output), "FILE",
     .help = "the octree: FILE.copc.laz, COPC 1.0, which other programs read as the points it is made of",
     .letter = 'o'},
    {"stats", OPTION_OUTPUT, AT(stats_path), "FILE",
     .help = "write counts, times per stage and peak memory as JSON"},
};

static const cli_option making_table[] = {
    {"memory", BUILD(memory_bytes), .help = "memory for points at hand: 512M, 8G"},
    {"attributes", OPTION_TEXT, AT(options.attributes), "NAMES",
     .help = "attributes that the surfels which stand for points have, too, for --color-by and --filter of 'ewa render' and 'ewa view': "
             "classification,intensity,user_data; none: no attributes",
     .absent = "auto: classification and intensity, where the points have them", .excludes = "merge"},
    {"subset", OPTION_TEXT, AT(subset), "I/N",
     .help = "make part I of N only, 1/N to N/N, on any machine: --merge joins them",
     .absent = "none: the whole at once", .excludes = "merge"},
    {"merge", OPTION_FLAG, AT(merge),
     .help = "the inputs are all parts of --subset; the file is the one that is made at once"},
    {"keep-going", OPTION_FLAG, offsetof(common_arguments, keep_going),
     .help = "step over damaged pieces of files", .excludes = "merge"},
};

static void set_defaults(void *data) {
    lod_command_arguments *arguments = data;
    ewa_lod_build_options_init(&arguments->options, sizeof arguments->options);
}

/// Reads "I/N".
static bool read_subset(const char *text, uint32_t *subset, uint32_t *subset_count) {
    unsigned part, count;
    char end;
    if (sscanf(text, "%5u/%5u%c", &part, &count, &end) != 2) return false;
    if (part < 1 || part > count || count > 65536) return false;
    *subset = part - 1, *subset_count = count;
    return true;
}

static bool check(const void *data, char message[OPTION_ERROR_BYTES]) {
    const lod_command_arguments *arguments = data;
    uint32_t subset, subset_count;
    const char *wrong = NULL;
    if (!arguments->output)
        wrong = "lod: no output; say -o FILE.copc.laz";
    else if (strcmp(arguments->output, "-") == 0)
        wrong = "--output: an octree is written to a file, not to standard output";
    else if (ewa_gaussians_format_of(arguments->output) == EWA_GAUSSIANS_STREAMED_SOG)
        wrong = "--output: levels of Gaussians are written by 'ewa convert IN -o lod-meta.json'";
    else if (arguments->subset && !read_subset(arguments->subset, &subset, &subset_count))
        wrong = "--subset: not I/N with a whole number I from 1 to N, and N up to 65536";
    return options_fine(wrong, message) &&
           output_check_suffix("output", arguments->output, ".copc.laz|.laz", message);
}

static bool write_stats(cli_session *session, const lod_command_arguments *arguments,
                        const ewa_lod_build_stats *stats) {
    text_file text;
    if (!text_file_open(session, &text, arguments->stats_path)) return false;
    json_writer json;
    json_start(&json, text.file);
    json_text(&json, "version", ewa_version());
    json_array(&json, "inputs");
    for (size_t i = 0; i < arguments->common.operand_count; i++)
        json_text(&json, NULL, arguments->common.operands[i]);
    json_close(&json, ']');
    json_count(&json, "threads", ewa_context_worker_count(session->context));
    json_count(&json, "points", stats->point_count);
    json_count(&json, "points_left_out", stats->left_out_count);
    json_count(&json, "merged_surfels", stats->merged_count);
    json_count(&json, "nodes", stats->node_count);
    json_count(&json, "levels", stats->level_count);
    json_count(&json, "temporary_bytes", stats->temporary_bytes);
    json_object(&json, "wall_s");
    json_number(&json, "statistics", stats->statistics_s);
    json_number(&json, "distribute", stats->distribute_s);
    json_number(&json, "estimate", stats->estimate_s);
    json_number(&json, "merge", stats->merge_s);
    json_number(&json, "write", stats->write_s);
    json_number(&json, "total", stats->total_s);
    json_close(&json, '}');
    json_count(&json, "peak_memory_bytes", memory_peak_bytes());
    json_end(&json);
    return text_file_close(session, &text);
}

/// Waits for all processes of a process group.
static ewa_status meet(const cli_session *session) {
    int64_t nothing = 0;
    return ewa_exchange_add(session->context, &session->group->exchange, &nothing, 1);
}

/// Names the part that process `rank` of a process group makes, beside the output.
static bool name_part(const char *output, uint32_t rank, uint32_t count, char name[PART_NAME_BYTES]) {
    const int length = snprintf(name, PART_NAME_BYTES, "%s.part-%u-of-%u.copc.laz", output, rank + 1, count);
    return length > 0 && length < PART_NAME_BYTES;
}

/// Joins the parts of all processes.
static ewa_status join_parts(cli_session *session, const char *output, ewa_lod_build_stats *stats) {
    const uint32_t count = session->group->exchange.rank_count;
    char(*names)[PART_NAME_BYTES] = calloc(count, sizeof *names);
    const char **parts = calloc(count, sizeof *parts);
    ewa_status status = names && parts ? EWA_OK : EWA_ERROR_MEMORY;
    for (uint32_t i = 0; i < count && status == EWA_OK; i++) {
        name_part(output, i, count, names[i]);
        parts[i] = names[i];
    }
    if (status == EWA_OK) status = ewa_lod_merge(session->context, parts, count, output, stats);
    free(parts);
    free(names);
    return status;
}

/// Makes an octree by all processes of a process group: a part each, which the first one joins.
static ewa_status build_together(cli_session *session, const lod_command_arguments *arguments,
                                 const ewa_lod_build_options *options, ewa_lod_build_stats *stats) {
    const ewa_exchange *all = &session->group->exchange;
    const common_arguments *common = &arguments->common;
    ewa_lod_build_options own = *options;
    own.subset = all->rank, own.subset_count = all->rank_count;
    char part[PART_NAME_BYTES];
    if (arguments->subset || arguments->merge) {
        session_fail(session, "--subset and --merge: the ranks do this by themselves");
        return EWA_ERROR_ARGUMENT;
    }
    if (!name_part(arguments->output, all->rank, all->rank_count, part)) {
        session_fail(session, "%.200s: the path is too long", arguments->output);
        return EWA_ERROR_ARGUMENT;
    }
    // A rank that is killed cannot remove its part: the next one does, which fails or ends by a signal for its sake.
    const uint32_t killed = (all->rank + all->rank_count - 1) % all->rank_count;
    char other[PART_NAME_BYTES];
    name_part(arguments->output, killed, all->rank_count, other);
    interruption_watch_file(part);
    interruption_watch_file(other);
    ewa_status status =
        ewa_lod_build(session->context, common->operands, (uint32_t)common->operand_count, part, &own, stats);
    if (status == EWA_OK) status = meet(session);
    if (status == EWA_OK && all->rank == 0) status = join_parts(session, arguments->output, stats);
    if (status == EWA_OK) status = meet(session);
    remove(part);
    if (status != EWA_OK) remove(other);
    interruption_release_file(part);
    interruption_release_file(other);
    return status;
}

/// Says which inputs are Gaussians, of which only the centres are taken.
static void tell_of_gaussians(cli_session *session, const common_arguments *common) {
    for (size_t i = 0; i < common->operand_count; i++) {
        const char *path = common->operands[i];
        if (gaussian_files_format(session, path) != EWA_GAUSSIANS_NONE)
            session_note(session, "%s: Gaussians become points at their centres; 'ewa convert %s -o lod-meta.json' makes levels of Gaussians",
                         path, path);
    }
    session->subject = NULL;
}

static int run(const void *data) {
    const lod_command_arguments *arguments = data;
    const common_arguments *common = &arguments->common;
    cli_session session;
    if (!session_start(&session, common)) return session_end(&session, EXIT_FAILED);
    ewa_lod_build_options options = arguments->options;
    options.keep_going = common->keep_going;
    const bool named = options.attributes && strcmp(options.attributes, "auto") != 0;
    options.attributes = !named ? NULL : strcmp(options.attributes, "none") == 0 ? "" : options.attributes;
    if (arguments->subset) read_subset(arguments->subset, &options.subset, &options.subset_count);
    if (!arguments->merge && process_group_leads(session.group)) tell_of_gaussians(&session, common);
    ewa_lod_build_stats stats = {.point_count = 0};
    const uint32_t count = (uint32_t)common->operand_count;
    const ewa_status status =
        session.group ? build_together(&session, arguments, &options, &stats)
        : arguments->merge
            ? ewa_lod_merge(session.context, common->operands, count, arguments->output, &stats)
            : ewa_lod_build(session.context, common->operands, count, arguments->output, &options, &stats);
    if (status != EWA_OK) session_failed(&session, status);
    if (status == EWA_OK && stats.left_out_count)
        session_note(&session, "%llu points without finite coordinates are left out",
                     (unsigned long long)stats.left_out_count);
    if (status == EWA_OK)
        session_say(&session,
                    "%s: %llu points in %u nodes of %u levels, %llu surfels that stand for them, in %.1f s",
                    arguments->output, (unsigned long long)stats.point_count, stats.node_count,
                    stats.level_count, (unsigned long long)stats.merged_count, stats.total_s);
    const bool done = status == EWA_OK && (!arguments->stats_path || !process_group_leads(session.group) ||
                                           write_stats(&session, arguments, &stats));
    return session_end(&session, done ? EXIT_DONE : EXIT_FAILED);
}

static const option_group output_options = OPTION_GROUP("Output", output_table);
static const option_group making_options = OPTION_GROUP("Making", making_table);
const cli_command lod_command = {
    .name = "lod",
    .operands = "IN... -o OUT.copc.laz",
    .summary = "make an octree of clouds of any size, which is drawn from little memory",
    .details =
        "The points of all inputs go into one COPC file with all their attributes, and with surfels that "
        "stand for "
        "them at every level, so that 'ewa render' and 'ewa view' read only what a picture shows, as fine as "
        "it "
        "shows it. The clouds need not fit into memory: they are read twice, and a temporary file, beside "
        "the "
        "output, takes up to 40 bytes for each point. Normals and radii that the files lack are estimated.",
    .examples = "ewa lod scans/*.laz -o city.copc.laz --memory 8G\n"
                "ewa render city.copc.laz -o city.png --memory 2G\n"
                "ewa lod scans/*.laz -o part1.copc.laz --subset 1/2\n"
                "ewa lod part1.copc.laz part2.copc.laz -o city.copc.laz --merge\n",
    .low_operands = 1,
    .high_operands = 65536,
    .groups = (const option_group *const[]){&output_options, &making_options, NULL},
    .arguments_bytes = sizeof(lod_command_arguments),
    .set_defaults = set_defaults,
    .check = check,
    .run = run,
};
