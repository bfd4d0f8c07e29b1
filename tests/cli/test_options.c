// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The option tables and their parser, in this process.
#include "check.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/base/commands.h"

/// One option of every kind.
typedef struct sample_arguments {
    common_arguments common;
    bool flag, antialias;
    double number;
    int64_t integer;
    const char *text;
    int choice;
    option_vector vector;
    option_vectors vectors;
    option_color color;
    option_size size;
    option_bounds bounds;
    uint32_t set;
    option_size fitting;
} sample_arguments;

#define AT(member) offsetof(sample_arguments, member)

static const cli_option sample_table[] = {
    {"flag", OPTION_FLAG, AT(flag), .help = "h", .letter = 'f'},
    {"antialias", OPTION_ON_OFF, AT(antialias), .help = "h"},
    {"number", OPTION_NUMBER, AT(number), "N", "(0, 4]", .help = "h", .aliases = "figure value"},
    {"integer", OPTION_INTEGER, AT(integer), "N", "[-5, 5]", .help = "h", .letter = 'n'},
    {"text", OPTION_TEXT, AT(text), "T", .help = "h"},
    {"choice", OPTION_CHOICE, AT(choice), NULL, "one|two|three", .help = "h"},
    {"vector", OPTION_VECTOR, AT(vector), "x,y[,z]", .help = "h", .low = 2, .high = 3},
    {"vectors", OPTION_VECTORS, AT(vectors), "x,y", .help = "h", .low = 2, .high = 2},
    {"color", OPTION_COLOR, AT(color), "r,g,b[,a]", .help = "h"},
    {"size", OPTION_SIZE, AT(size), "WxH", .help = "h"},
    {"bounds", OPTION_BOUNDS, AT(bounds), "a,b", .help = "h"},
    {"set", OPTION_SET, AT(set), "WORD,...", "one|two|three", .help = "h"},
    {"fitting", OPTION_SIZE, AT(fitting), "WxH", .help = "h", .absent = "auto: as it fits",
     .excludes = "flag"},
};

static const option_group sample_group = OPTION_GROUP("Sample", sample_table);
static const cli_command sample = {.name = "sample",
                                   .operands = "[IN...]",
                                   .summary = "s",
                                   .examples = "e\n",
                                   .high_operands = 3,
                                   .groups = (const option_group *const[]){&sample_group, NULL},
                                   .arguments_bytes = sizeof(sample_arguments)};

static sample_arguments arguments;
static const char *operands[16];
static char message[OPTION_ERROR_BYTES];

/// Parses words that are separated by blanks; "_" stands for an empty word.
static bool parse(const char *line) {
    static char words[512];
    const char *list[16];
    size_t count = 0;
    snprintf(words, sizeof words, "%s", line);
    for (char *word = strtok(words, " "); word; word = strtok(NULL, " "))
        list[count++] = *word == '_' ? "" : word;
    options_default(&sample, &arguments);
    message[0] = 0;
    return options_parse(&sample, count, list, operands, &arguments, message);
}

TEST(test_values) {
    assert_true(parse("--number 2.5 --integer=-3 --text a=b -f --antialias on --choice two a b"));
    assert_true(arguments.number == 2.5);
    assert_int_equal(arguments.integer, -3);
    assert_string_equal(arguments.text, "a=b");
    assert_true(arguments.flag && arguments.antialias);
    assert_int_equal(arguments.choice, 1);
    assert_int_equal(arguments.common.operand_count, 2);
    assert_string_equal(operands[1], "b");
    assert_true(parse("--vector -1,2e3 --color 0.25,0.5,1 --size 640x480 -n4"));
    assert_int_equal(arguments.vector.count, 2);
    assert_true(arguments.vector.values[0] == -1 && arguments.vector.values[1] == 2000);
    assert_true(arguments.color.rgba[0] == 0.25 && arguments.color.rgba[3] == 1);
    assert_int_equal(arguments.size.width_px, 640);
    assert_int_equal(arguments.size.height_px, 480);
    assert_int_equal(arguments.integer, 4);
    assert_true(parse("--bounds -1,2e3") && arguments.bounds.given);
    assert_true(arguments.bounds.values[0] == -1 && arguments.bounds.values[1] == 2000);
    assert_false(arguments.bounds.percent[0] || arguments.bounds.percent[1]);
    assert_true(parse("--bounds 2.5%,100%") && arguments.bounds.values[0] == 2.5);
    assert_true(arguments.bounds.percent[0] && arguments.bounds.percent[1]);
    assert_true(parse("--bounds 0,98%") && !arguments.bounds.percent[0] && arguments.bounds.percent[1]);
    assert_true(parse("--color=transparent --size 3,4 --figure 1 --value 4"));
    assert_true(arguments.color.rgba[3] == 0 && arguments.size.given && arguments.number == 4);
    assert_true(parse("--vectors 1,2 --number 1 --vectors=-3,4"));
    assert_int_equal(arguments.vectors.count, 2);
    assert_true(arguments.vectors.each[0].values[1] == 2 && arguments.vectors.each[1].values[0] == -3);
    assert_true(parse("--integer -0.3e1"));
    assert_int_equal(arguments.integer, -3);
    assert_true(parse("--set three,one,three"));
    assert_int_equal(arguments.set, 5);
    assert_true(parse("--text --flag"));
    assert_string_equal(arguments.text, "--flag");
    assert_true(parse("-- --flag -"));
    assert_int_equal(arguments.common.operand_count, 2);
    assert_true(parse("--no-progress"));
    assert_int_equal(arguments.common.progress, 0);
    assert_true(parse("--progress"));
    assert_int_equal(arguments.common.progress, 1);
    assert_true(parse("--help --nonsense"));
    assert_true(arguments.common.help);
}

/// The word of a default that is worked out is as if the option was not given, whatever was before it.
TEST(test_default_words) {
    assert_true(parse("--fitting 3x4 --fitting auto -f") && !arguments.fitting.given && arguments.flag);
    assert_int_equal(arguments.fitting.width_px, 0);
    assert_true(parse("--fitting auto --fitting=3x4") && arguments.fitting.given);
    assert_false(parse("--fitting auto --fitting 3x4 -f"));
    assert_false(parse("--fitting all"));
    assert_false(parse("--fitting aut"));
    assert_false(parse("--size auto"));
    for (size_t c = 0; c < all_commands_count; c++) {
        const cli_option *option;
        for (size_t i = 0; (option = options_at(all_commands[c], i)); i++) {
            const ewa_option *of = options_library(option);
            assert_true(!option->absent || !of || of->type == EWA_OPTION_F64);
        }
    }
}

TEST(test_refusals) {
    static const struct {
        const char *line, *said;
    } cases[] = {
        {"--number abc", "--number: 'abc' is not a number"},
        {"--number 1x", "--number: '1x' is not a number"},
        {"--number nan", "--number: 'nan' is not a number"},
        {"--number inf", "--number: 'inf' is not a number"},
        {"--number 0", "--number: 0 is outside (0, 4]"},
        {"--number 4.5", "--number: 4.5 is outside (0, 4]"},
        {"--figure 5", "--number: 5 is outside (0, 4]"},
        {"--number _", "--number: '' is not a number"},
        {"--integer 2.5", "--integer: '2.5' is not a whole number"},
        {"--integer 99999999999999999999", "--integer: '99999999999999999999' is not a whole number"},
        {"--integer 25e-1", "--integer: '25e-1' is not a whole number"},
        {"--integer 1e30", "--integer: '1e30' is not a whole number"},
        {"--integer 0x1e0", "--integer: '0x1e0' is not a whole number"},
        {"--integer 1e", "--integer: '1e' is not a whole number"},
        {"--integer 1e1", "--integer: 10 is outside [-5, 5]"},
        {"--integer 6", "--integer: 6 is outside [-5, 5]"},
        {"--text _", "--text: the value is empty"},
        {"--choice four", "--choice: 'four' is not one of one|two|three"},
        {"--choice tw", "--choice: 'tw' is not one of one|two|three"},
        {"--choice one|two", "--choice: 'one|two' is not one of one|two|three"},
        {"--set one,four", "--set: 'four' is not one of one|two|three"},
        {"--set one,", "--set: '' is not one of one|two|three"},
        {"--set one|two", "--set: 'one|two' is not one of one|two|three"},
        {"--antialias yes", "--antialias: 'yes' is not one of off|on"},
        {"--vector 1", "--vector: '1' is not x,y[,z]"},
        {"--vector 1,2,3,4", "--vector: '1,2,3,4' is not x,y[,z]"},
        {"--vector 1,,2", "--vector: '1,,2' is not x,y[,z]"},
        {"--vector 1,2,", "--vector: '1,2,' is not x,y[,z]"},
        {"--vectors 1,2 --vectors 3", "--vectors: '3' is not x,y"},
        {"--bounds 1", "--bounds: '1' is not a,b"},
        {"--bounds 1,2,3", "--bounds: '1,2,3' is not a,b"},
        {"--bounds %,3", "--bounds: '%,3' is not a,b"},
        {"--bounds 1%%,3", "--bounds: '1%%,3' is not a,b"},
        {"--bounds 1,101%", "--bounds: 101% is outside [0, 100]"},
        {"--bounds -1%,2", "--bounds: -1% is outside [0, 100]"},
        {"--color 1,2,3", "--color: '1,2,3' is not r,g,b[,a] in [0, 1], #rrggbb, white"},
        {"--color red", "--color: 'red' is not r,g,b[,a]"},
        {"--size abc", "--size: 'abc' is not WxH"},
        {"--size 640", "--size: '640' is not WxH"},
        {"--size 640x", "--size: '640x' is not WxH"},
        {"--size 0x1", "--size: '0x1' is not WxH"},
        {"--size -1x1", "--size: '-1x1' is not WxH"},
        {"--size 1x-1", "--size: '1x-1' is not WxH"},
        {"--size 70000x1", "--size: 70000x1 is over 65536x65536 pixels"},
        {"--flag=1", "--flag: takes no value"},
        {"--progress=1", "--progress: takes no value"},
        {"--number", "--number: its value (N) is missing"},
        {"--choice", "--choice: its value (one|two|three) is missing"},
        {"--nubmer 1", "--nubmer: no such option; did you mean --number?"},
        {"--xyzzy", "--xyzzy: no such option; see 'ewa sample --help'"},
        {"-x", "-x: no such option; see 'ewa sample --help'"},
        {"--no-flag", "--no-flag: no such option"},
        {"--num 1", "--num: no such option"},
        {"a b c d", "sample: 'd' is one operand too many; usage: ewa sample [IN...]"},
        {"a _", "sample: a file name is empty"},
        {"-q -v", "--quiet and --verbose exclude each other"},
        {"--threads 257", "--threads: 257 is outside [0, 256]"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        if (parse(cases[i].line)) print_error("'%s' was accepted\n", cases[i].line);
        assert_int_equal(strncmp(message, cases[i].said, strlen(cases[i].said)), 0);
    }
}

TEST(test_tables) {
    for (size_t c = 0; c < all_commands_count; c++) {
        const cli_command *command = all_commands[c];
        assert_ptr_equal(command_find(command->name), command);
        assert_non_null(strstr(command->examples, command->name));
        assert_int_equal(command->examples[strlen(command->examples) - 1], '\n');
        const cli_option *option;
        for (size_t i = 0; (option = options_at(command, i)); i++) {
            assert_true(option->offset < command->arguments_bytes);
            const ewa_option *of = options_library(option);
            assert_true((option->kind == OPTION_LIBRARY) == (of != NULL));
            const char *help = option->help ? option->help : of->help;
            assert_int_not_equal(help[strlen(help) - 1], '.');
            char value[EWA_OPTION_TEXT_BYTES];
            options_name_value(option, value);
            const bool bare = option->kind == OPTION_FLAG || option->kind == OPTION_TOGGLE;
            assert_true(bare ? !value[0] : value[0]);
            const cli_option *other;
            for (size_t k = 0; k < i && (other = options_at(command, k)); k++) {
                assert_string_not_equal(option->key, other->key);
                assert_true(!option->letter || option->letter != other->letter);
                assert_int_not_equal(option->offset, other->offset);
            }
        }
    }
}

/// The default of each option, written as help shows it, is accepted by the parser.
TEST(test_defaults_in_range) {
    for (size_t c = 0; c < all_commands_count; c++) {
        const cli_command *command = all_commands[c];
        OWNED(check_free)
        char *defaults = calloc(1, command->arguments_bytes), *again = calloc(1, command->arguments_bytes);
        options_default(command, defaults);
        const cli_option *option;
        for (size_t i = 0; (option = options_at(command, i)); i++) {
            const ewa_option *of = options_library(option);
            if (option->absent || (!of && option->kind != OPTION_NUMBER && option->kind != OPTION_INTEGER))
                continue;
            char words[2][EWA_OPTION_TEXT_BYTES];
            snprintf(words[0], sizeof words[0], "--%s", option->key);
            if (of)
                ewa_option_get(of, defaults + option->offset - of->offset, words[1]);
            else if (option->kind == OPTION_NUMBER)
                snprintf(words[1], sizeof words[1], "%.17g", *(double *)(void *)(defaults + option->offset));
            else
                snprintf(words[1], sizeof words[1], "%lld",
                         (long long)*(int64_t *)(void *)(defaults + option->offset));
            const char *list[] = {words[0], words[1]};
            options_default(command, again);
            // What else is missing does not matter: values are checked first.
            if (!options_parse(command, 2, list, operands, again, message))
                assert_null(strstr(message, "outside"));
        }
    }
}

/// Appends an option with a value that its table allows to the words; `text` keeps the value.
static size_t add_option(const cli_option *option, const char **words, size_t count, char text[2][128]) {
    snprintf(text[0], sizeof text[0], "--%s", option->key);
    words[count++] = text[0];
    const char *range = option->range;
    char number[32] = "1";
    if (range && (range[0] == '[' || range[0] == '(')) {
        char *middle;
        const double low = strtod(range + 1, &middle), high = strtod(middle + 1, NULL);
        snprintf(number, sizeof number, "%g",
                 isinf(high)      ? low + 1
                 : high - low > 2 ? low + 1
                                  : 0.5 * low + 0.5 * high);
    }
    switch (option->kind) {
    case OPTION_FLAG:
    case OPTION_TOGGLE:
        return count;
    case OPTION_ON_OFF:
        snprintf(text[1], sizeof text[1], "on");
        break;
    case OPTION_CHOICE:
    case OPTION_SET:
        snprintf(text[1], sizeof text[1], "%.*s", (int)strcspn(range, "|"), range);
        break;
    case OPTION_VECTOR:
    case OPTION_VECTORS:
        text[1][0] = 0;
        for (uint32_t i = 0; i < option->low; i++)
            snprintf(text[1] + strlen(text[1]), sizeof text[1] - strlen(text[1]), "%s%s", i ? "," : "",
                     number);
        break;
    case OPTION_BOUNDS:
        snprintf(text[1], sizeof text[1], "0,1");
        break;
    case OPTION_FRAMES:
        snprintf(text[1], sizeof text[1], "0-1");
        break;
    case OPTION_FILTER:
        snprintf(text[1], sizeof text[1], "x>1");
        break;
    case OPTION_COLOR:
        snprintf(text[1], sizeof text[1], "0,0,0");
        break;
    case OPTION_SIZE:
        snprintf(text[1], sizeof text[1], "8x8");
        break;
    case OPTION_NUMBER:
    case OPTION_INTEGER:
        snprintf(text[1], sizeof text[1], "%s", number);
        break;
    case OPTION_LIBRARY: {
        const ewa_option *of = options_library(option);
        char allowed[EWA_OPTION_TEXT_BYTES];
        ewa_option_range(of, allowed);
        if (of->words || of->type == EWA_OPTION_BOOL)
            snprintf(text[1], sizeof text[1], "%.*s", (int)strcspn(allowed, "|"), allowed);
        else
            snprintf(text[1], sizeof text[1], "%.17g", of->initial);
        for (uint32_t i = 1; i < of->count; i++) strcat(text[1], ",1");
        break;
    }
    case OPTION_TEXT:
    case OPTION_OUTPUT:
    case OPTION_OUTPUTS:
        snprintf(text[1], sizeof text[1], "depth=x.pfm");
        break;
    }
    words[count++] = text[1];
    return count;
}

/// Parses a command line with so many operands as the command wants, and these options.
static bool parse_options(const cli_command *command, size_t count, const cli_option *const *options) {
    const char *words[16];
    char texts[2][2][128];
    size_t word_count = 0;
    for (; word_count < command->low_operands; word_count++) words[word_count] = "sphere";
    for (size_t i = 0; i < count; i++) word_count = add_option(options[i], words, word_count, texts[i]);
    OWNED(check_free) char *all = calloc(1, command->arguments_bytes);
    options_default(command, all);
    message[0] = 0;
    const bool accepted = options_parse(command, word_count, words, operands, all, message);
    return accepted;
}

static const cli_option *find_key(const cli_command *command, const char *key, size_t length) {
    const cli_option *option;
    for (size_t i = 0; (option = options_at(command, i)); i++)
        if (strlen(option->key) == length && memcmp(option->key, key, length) == 0) return option;
    return NULL;
}

/// What the tables say of options beside each other holds in every command, in either order.
TEST(test_together) {
    size_t pairs = 0, needs = 0;
    for (size_t c = 0; c < all_commands_count; c++) {
        const cli_command *command = all_commands[c];
        const cli_option *option;
        size_t count = 0;
        for (; (option = options_at(command, count)); count++) {
            for (const char *key = option->excludes; key && *key; key += strspn(key, " ")) {
                const size_t length = strcspn(key, " ");
                const cli_option *other = find_key(command, key, length);
                assert_non_null(other); // a table that is shared names no option that a command lacks
                assert_ptr_not_equal(other, option);
                char wanted[160];
                snprintf(wanted, sizeof wanted, "--%s and --%s exclude each other", option->key, other->key);
                for (int turned = 0; turned < 2; turned++) {
                    assert_false(parse_options(
                        command, 2,
                        (const cli_option *[]){turned ? other : option, turned ? option : other}));
                    if (!strstr(message, wanted) && !strstr(message, "needs"))
                        fail_msg("%s: '%s' wanted, said: %s", command->name, wanted, message);
                }
                pairs++;
                key += length;
            }
            if (!option->needs) continue;
            for (const char *key = option->needs; *key; key += strspn(key, " ")) {
                assert_non_null(find_key(command, key, strcspn(key, " ")));
                key += strcspn(key, " ");
            }
            char wanted[160];
            snprintf(wanted, sizeof wanted, "--%s needs --", option->key);
            assert_false(parse_options(command, 1, &option));
            assert_non_null(strstr(message, wanted));
            needs++;
        }
        assert_true(count < OPTION_COUNT_MAX);
    }
    assert_true(pairs > 40 && needs > 20);
}

/// What says how a scene is shown is said to the window as to the picture, by the same rows.
TEST(test_look_is_shared) {
    static const char *const of_pictures[] = {
        "output", "aov", "save-camera", "save-scene", "stats", "panorama", "panorama-fov", "turntable", "path", "frames",
        "loop", "skip-existing", "fps", "quality", "outlines", "backend"};
    const cli_command *render = command_find("render"), *view = command_find("view");
    const cli_option *option, *other;
    size_t shared = 0, alone = 0;
    for (size_t i = 0; (option = options_at(render, i)); i++) {
        bool of_picture = false, taken = false;
        for (size_t k = 0; k < sizeof of_pictures / sizeof of_pictures[0]; k++)
            of_picture = of_picture || strcmp(option->key, of_pictures[k]) == 0;
        for (size_t k = 0; (other = options_at(view, k)) && !taken; k++) taken = other == option;
        if (taken == of_picture) fail_msg("--%s is taken by view: %d", option->key, taken);
        *(taken ? &shared : &alone) += 1;
    }
    assert_true(shared > 70 && alone == sizeof of_pictures / sizeof of_pictures[0]);
    // A page takes what a scene file holds: neither what has files of its own nor what stands over pictures.
    static const char *const of_no_page[] = {"materials", "env", "env-up", "title", "axes", "scale-bar", "unit", "color-bar", "script", "timings", "window", "scale",
                                             "backend"};
    const cli_command *page = command_find("page");
    for (size_t i = 0; (option = options_at(view, i)); i++) {
        bool left_out = false, taken = false;
        for (size_t k = 0; k < sizeof of_no_page / sizeof of_no_page[0]; k++) left_out = left_out || strcmp(option->key, of_no_page[k]) == 0;
        for (size_t k = 0; (other = options_at(page, k)) && !taken; k++) taken = other == option;
        if (taken == left_out) fail_msg("--%s is taken by page: %d", option->key, taken);
    }
}

TEST(test_nearest) {
    static const char *const names[] = {"render", "info", "convert"};
    assert_string_equal(options_nearest("rendr", 3, names), "render");
    assert_string_equal(options_nearest("convret", 3, names), "convert");
    assert_null(options_nearest("xylophone", 3, names));
}

int main(void) { return RUN_TESTS(NULL, NULL); }
