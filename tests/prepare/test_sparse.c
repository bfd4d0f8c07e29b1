// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Sparse positive definite systems: known answers, both methods, what is not solvable, threads, memory.
#include "check_prepare.h"
#include "gram.h"
#include "io/scratch.h"

/// Both methods find the known solution, for one to seven right sides, in the same bytes for any number of
/// threads.
TEST(test_known_solution) {
    ewa_context *contexts[3] = {check_context(1, NULL), check_context(2, NULL), check_context(7, NULL)};
    owned matrix = make_gram(90, 0.5);
    for (uint32_t side_count = 1; side_count <= 7; side_count += 2) {
        OWNED(check_free) double *truth, *sides = make_sides(&matrix.view, side_count, &truth);
        const size_t count = (size_t)matrix.view.size * side_count;
        OWNED(check_free) double *first = malloc(count * sizeof(double)), *other = malloc(count * sizeof(double));
        assert_true(first && other);
        for (int method = EWA_SPARSE_FACTOR; method <= EWA_SPARSE_GRADIENT; method++) {
            const ewa_sparse_options options = {.method = (ewa_sparse_method)method, .tolerance = 1e-12};
            ewa_sparse_report report;
            assert_int_equal(
                ewa_sparse_solve(contexts[0], &matrix.view, side_count, sides, first, &options, &report),
                EWA_OK);
            assert_int_equal(report.method, method);
            assert_true(report.residual <= 2e-12);
            assert_true((report.factor_bytes > 0) == (method == EWA_SPARSE_FACTOR));
            assert_true(report.iterations > 0 && report.iterations < 100);
            for (size_t i = 0; i < count; i++) assert_true(fabs(first[i] - truth[i]) < 1e-9);
            for (int c = 1; c < 3; c++) {
                memset(other, 0xff, count * sizeof(double));
                assert_int_equal(
                    ewa_sparse_solve(contexts[c], &matrix.view, side_count, sides, other, &options, NULL),
                    EWA_OK);
                assert_memory_equal(first, other, count * sizeof(double));
            }
        }
    }
    owned_free(&matrix);
    for (int c = 0; c < 3; c++) ewa_context_destroy(&contexts[c]);
}

/// A dense little system by hand, one row, no rows, no sides, sides of zeros.
TEST_ON(test_small, 2) {
    for (int method = EWA_SPARSE_AUTO; method <= EWA_SPARSE_GRADIENT; method++) {
        const ewa_sparse_options options = {.method = (ewa_sparse_method)method};
        ewa_sparse_report report;
        const uint64_t starts[] = {0, 2, 5, 7};
        const uint32_t columns[] = {0, 1, 0, 1, 2, 1, 2};
        const double values[] = {4, 2, 2, 5, 1, 1, 3}, sides[] = {8, 0, 15, 0, 11, 0};
        double solution[6];
        const ewa_sparse three = {3, starts, columns, values};
        assert_int_equal(ewa_sparse_solve(context, &three, 2, sides, solution, &options, &report), EWA_OK);
        const double expected[] = {1, 2, 3};
        for (int i = 0; i < 3; i++) {
            assert_true(fabs(solution[2 * i] - expected[i]) < 1e-12);
            assert_true(solution[2 * i + 1] == 0);
        }
        const ewa_sparse one = {1, (uint64_t[]){0, 1}, (uint32_t[]){0}, (double[]){4}};
        assert_int_equal(ewa_sparse_solve(context, &one, 1, (double[]){2}, solution, &options, &report),
                         EWA_OK);
        assert_true(solution[0] == 0.5);
        const ewa_sparse none = {0, (uint64_t[]){0}, NULL, NULL};
        assert_int_equal(ewa_sparse_solve(context, &none, 3, NULL, NULL, &options, &report), EWA_OK);
        assert_int_equal(ewa_sparse_solve(context, &one, 0, NULL, NULL, &options, &report), EWA_OK);
    }
}

/// Each bad system gives its status and a message, by either method.
TEST(test_unsolvable) {
    check_log log = {0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &log);
    const struct {
        const char *says;
        double values[4], sides[2];
        uint32_t columns[4];
        ewa_status status;
    } rows[] = {
        {"positive definite", {1, 2, 2, 1}, {1, -1}, {0, 1, 0, 1}, EWA_ERROR_NUMERIC},        // indefinite
        {"", {1, 1, 1, 1}, {1, -1}, {0, 1, 0, 1}, EWA_ERROR_NUMERIC},                         // singular
        {"no positive diagonal", {1, 0, 0, -1}, {1, 1}, {0, 1, 0, 1}, EWA_ERROR_NUMERIC},     // negative
        {"no positive diagonal", {1, 0, 0, 0}, {1, 1}, {0, 1, 0, 1}, EWA_ERROR_NUMERIC},      // zero
        {"row 1 has a number", {1, 0, NAN, 1}, {1, 1}, {0, 1, 0, 1}, EWA_ERROR_NUMERIC},      // in the matrix
        {"row 0 has a number", {1, 0, 0, 1}, {INFINITY, 1}, {0, 1, 0, 1}, EWA_ERROR_NUMERIC}, // in a side
        {"row 1 are not ascending", {1, 0, 0, 1}, {1, 1}, {0, 1, 1, 0}, EWA_ERROR_ARGUMENT},
        {"row 0 are not ascending", {1, 0, 0, 1}, {1, 1}, {0, 2, 0, 1}, EWA_ERROR_ARGUMENT}, // no such column
    };
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++)
        for (int method = EWA_SPARSE_AUTO; method <= EWA_SPARSE_GRADIENT; method++) {
            const ewa_sparse_options options = {.method = (ewa_sparse_method)method};
            const ewa_sparse matrix = {2, (uint64_t[]){0, 2, 4}, rows[r].columns, rows[r].values};
            double solution[2];
            log = (check_log){0};
            assert_int_equal(ewa_sparse_solve(context, &matrix, 1, rows[r].sides, solution, &options, NULL),
                             rows[r].status);
            assert_int_equal(log.count, 1);
            assert_non_null(strstr(log.text, rows[r].says));
        }
}

/// Too few steps are an error that says so; a factor over the limit is one, or, by AUTO, the gradient.
TEST_LOGGED(test_limits, 1) {
    OWNED(owned_free) owned matrix = make_gram(30, 0.5);
    OWNED(check_free) double *truth, *sides = make_sides(&matrix.view, 1, &truth);
    OWNED(check_free) double *solution = malloc(matrix.view.size * sizeof(double));
    assert_non_null(solution);
    ewa_sparse_options options = {.method = EWA_SPARSE_GRADIENT, .max_iterations = 2};
    assert_int_equal(ewa_sparse_solve(context, &matrix.view, 1, sides, solution, &options, NULL),
                     EWA_ERROR_NUMERIC);
    assert_non_null(strstr(log->text, "after 2 iterations"));
    options = (ewa_sparse_options){.method = EWA_SPARSE_FACTOR, .max_factor_bytes = 10000};
    assert_int_equal(ewa_sparse_solve(context, &matrix.view, 1, sides, solution, &options, NULL),
                     EWA_ERROR_LIMIT);
    options.method = EWA_SPARSE_AUTO;
    ewa_sparse_report report;
    assert_int_equal(ewa_sparse_solve(context, &matrix.view, 1, sides, solution, &options, &report), EWA_OK);
    assert_int_equal(report.method, EWA_SPARSE_GRADIENT);
    options.max_factor_bytes = 0;
    assert_int_equal(ewa_sparse_solve(context, &matrix.view, 1, sides, solution, &options, &report), EWA_OK);
    assert_int_equal(report.method, EWA_SPARSE_FACTOR);
}

/// AUTO takes the gradient for many rows, and a factor where that needs more than 500 steps.
TEST_ON(test_choice, 0) {
    const struct {
        double sigma;
        uint64_t max_factor_bytes;
        ewa_sparse_method method;
    } rows[] = {
        {0.5, 0, EWA_SPARSE_GRADIENT}, {0.85, 0, EWA_SPARSE_FACTOR}, {0.85, 1000, EWA_SPARSE_GRADIENT}};
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
        OWNED(owned_free) owned matrix = make_gram(70, rows[r].sigma);
        OWNED(check_free) double *truth, *sides = make_sides(&matrix.view, 2, &truth);
        OWNED(check_free) double *solution = malloc(2 * matrix.view.size * sizeof(double));
        assert_non_null(solution);
        const ewa_sparse_options options = {.max_factor_bytes = rows[r].max_factor_bytes};
        ewa_sparse_report report;
        assert_int_equal(ewa_sparse_solve(context, &matrix.view, 2, sides, solution, &options, &report),
                         EWA_OK);
        assert_int_equal(report.method, rows[r].method);
        assert_true(rows[r].max_factor_bytes ? report.iterations > 500 : report.iterations <= 500);
    }
}

typedef struct system_of_equations {
    const ewa_sparse *matrix;
    const double *sides;
    double *solution;
    ewa_sparse_method method;
} system_of_equations;

static ewa_status solve_system(ewa_context *context, void *user) {
    const system_of_equations *system = user;
    const ewa_sparse_options options = {.method = system->method};
    return ewa_sparse_solve(context, system->matrix, 2, system->sides, system->solution, &options, NULL);
}

/// Progress grows to 1; it may cancel at any call; each allocation may fail; nothing leaks.
TEST(test_cancel_and_memory) {
    OWNED(owned_free) owned matrix = make_gram(20, 0.5);
    OWNED(check_free) double *truth, *sides = make_sides(&matrix.view, 2, &truth);
    OWNED(check_free) double *solution = malloc(2 * matrix.view.size * sizeof(double));
    assert_non_null(solution);
    for (int method = EWA_SPARSE_FACTOR; method <= EWA_SPARSE_GRADIENT; method++) {
        system_of_equations system = {&matrix.view, sides, solution, (ewa_sparse_method)method};
        scratch_fail_each(solve_system, &system);
        assert_true(check_cancel_each("solve", solve_system, &system) > 3);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
