// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa-mpi: commands of the program that the ranks of an MPI job do together.
#include "cli/base/commands.h"
#include "cli/base/session.h"
#include "mpi/exchange.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static const char usage[] =
    "usage: mpirun -n N ewa-mpi COMMAND ... [--split frames|cloud] [--time-limit S]\n"
    "\n"
    "Does a command of the program ewa by the N processes (ranks) of an MPI job; what it writes has the "
    "bytes\n"
    "that one process writes. The options of the commands are those of ewa (ewa help COMMAND).\n"
    "\n"
    "  render, volume  --split frames: each rank draws some frames of a film of numbered files. The default\n"
    "                  for films.\n"
    "  render          --split cloud: all draw each picture together, of an octree (COPC, EPT) of which "
    "each\n"
    "                  has a part in memory. The default for one picture.\n"
    "  lod             each rank makes a part of the octree, then one joins them.\n"
    "\n"
    "  --time-limit S  give up when a rank has not answered for S seconds, loading and drawing included, and "
    "the\n"
    "                  frames by which one is done before another; 0: never (the default)\n"
    "\n"
    "docs/cluster.md says how to start it with Slurm, by TCP, on many machines.\n";

enum { FAILURE_BYTES = 1024 };

/// What the words before and among the command's say to this program.
typedef struct mpi_arguments {
    const char *split; ///< NULL: not given
    double limit_s;
    const char **words; ///< those that are left
    size_t word_count;
    const char *wrong; ///< NULL: nothing
} mpi_arguments;

/// The value of an option, as "--key value" or "--key=value"; NULL where word `*at` is something else. Moves `*at` to the
/// last word of it.
static const char *take_value(const char *key, int count, char *const *words, int *at, bool *lacks) {
    const size_t length = strlen(key);
    const char *word = words[*at];
    if (strncmp(word, key, length) != 0) return NULL;
    if (word[length] == '=') return word + length + 1;
    if (word[length]) return NULL;
    *lacks = *at + 1 >= count;
    return *lacks ? "" : words[++*at];
}

static mpi_arguments read_arguments(int count, char *const *words, const char **room) {
    mpi_arguments made = {.words = room};
    for (int i = 1; i < count; i++) {
        bool lacks = false;
        const char *value = take_value("--split", count, words, &i, &lacks);
        if (value) {
            made.split = value;
            if (lacks || (strcmp(value, "frames") != 0 && strcmp(value, "cloud") != 0))
                made.wrong = "--split: neither frames nor cloud";
            continue;
        }
        value = take_value("--time-limit", count, words, &i, &lacks);
        if (!value) {
            room[made.word_count++] = words[i];
            continue;
        }
        char *end = NULL;
        made.limit_s = strtod(value, &end);
        if (lacks || end == value || *end || !(made.limit_s >= 0) || !isfinite(made.limit_s))
            made.wrong = "--time-limit: no number of seconds";
    }
    return made;
}

static const mpi_exchange *exchange_of(const cli_process_group *group) { return group->exchange.user; }
static uint64_t given_bytes(const cli_process_group *group) { return exchange_of(group)->given_bytes; }
static double waited_s(const cli_process_group *group) { return exchange_of(group)->waited_s; }

/// Whether a film is asked for.
static bool asks_for_film(const mpi_arguments *arguments) {
    for (size_t i = 0; i < arguments->word_count; i++)
        if (strncmp(arguments->words[i], "--turntable", 11) == 0 ||
            strncmp(arguments->words[i], "--path", 6) == 0)
            return true;
    return false;
}

/// The command that the words name, if ranks can do it; says in `*wrong` what is wrong.
static const cli_command *find_command(const mpi_arguments *arguments, const char **wrong) {
    static const cli_command *const shared[] = {&render_command, &volume_command, &lod_command};
    const char *word = arguments->word_count ? arguments->words[0] : "";
    for (size_t i = 0; i < sizeof shared / sizeof shared[0]; i++)
        if (strcmp(word, shared[i]->name) == 0) return shared[i];
    *wrong = command_find(word)
                 ? "this command is done by one process, ewa; ranks share render, volume and lod"
                 : "no such command; ewa-mpi --help says what there is";
    return NULL;
}

/// Gives others the time to say the same before this rank does.
static void pause_briefly(void) { nanosleep(&(struct timespec){.tv_sec = 1}, NULL); }

/// Ends all ranks after one has failed.
static void abort_all(const mpi_exchange *exchange, const char *failure, int exit_status) {
    if (exchange->rank) pause_briefly();
    const char *what = exchange->failure[0] ? exchange->failure : failure;
    if (what[0]) fprintf(stderr, "ewa: rank %d: %s\n", exchange->rank, what);
    fflush(stderr);
    MPI_Abort(exchange->communicator, exit_status);
}

/// Waits until all ranks are done with the command.
static ewa_status meet(mpi_exchange *exchange) {
    ewa_context *context = NULL;
    int64_t nothing = 0;
    const ewa_exchange all = mpi_exchange_of(exchange);
    ewa_status status = ewa_context_create(NULL, &context);
    if (status == EWA_OK) status = ewa_exchange_add(context, &all, &nothing, 1);
    ewa_context_destroy(&context);
    return status;
}

static int run(mpi_exchange *exchange, const mpi_arguments *arguments) {
    const bool leads = exchange->rank == 0;
    const char *wrong = arguments->wrong;
    const char *first = arguments->word_count ? arguments->words[0] : "";
    if (!wrong && (strcmp(first, "--help") == 0 || strcmp(first, "-h") == 0 || strcmp(first, "help") == 0)) {
        if (leads) fputs(usage, stdout);
        return EXIT_DONE;
    }
    if (!wrong && strcmp(first, "--version") == 0) {
        if (leads) printf("ewa-mpi %s\n", ewa_version());
        return EXIT_DONE;
    }
    const cli_command *command = wrong ? NULL : find_command(arguments, &wrong);
    if (!command) {
        if (leads) fprintf(stderr, "ewa-mpi: %s%s%s\n", first, first[0] ? ": " : "", wrong);
        return EXIT_USAGE;
    }
    char failure[FAILURE_BYTES] = "";
    const bool frames = arguments->split ? strcmp(arguments->split, "frames") == 0 : asks_for_film(arguments);
    const cli_process_group group = {.exchange = mpi_exchange_of(exchange),
                                     .shares_cloud = !frames,
                                     .given_bytes = given_bytes,
                                     .waited_s = waited_s,
                                     .failure = failure,
                                     .failure_bytes = sizeof failure};
    const int exit_status = command_run(command, &group, arguments->word_count - 1, arguments->words + 1);
    if (exit_status == EXIT_USAGE) return exit_status; // found by all of them
    if (exit_status != EXIT_DONE || meet(exchange) != EWA_OK)
        abort_all(exchange, failure, exit_status ? exit_status : EXIT_FAILED);
    return exit_status;
}

int main(int argc, char **argv) {
    int provided = 0;
    if (MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided) != MPI_SUCCESS) {
        fputs("ewa-mpi: MPI does not start\n", stderr);
        return EXIT_FAILED;
    }
    process_start();
    mpi_exchange exchange;
    mpi_arguments arguments = {.wrong = "out of memory"};
    const char **room = calloc((size_t)argc + 1, sizeof *room);
    if (room) arguments = read_arguments(argc, argv, room);
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
    mpi_exchange_open(&exchange, MPI_COMM_WORLD, arguments.limit_s, session_interrupted);
    const int exit_status = run(&exchange, &arguments);
    mpi_exchange_close(&exchange);
    free(room);
    MPI_Finalize();
    return exit_status;
}
