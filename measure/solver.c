// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Prints the table of docs/colors.md on sparse systems: measure_solver [THREADS]
#include "base/base.h"
#include "prepare/gram.h"

enum { SIDES = 3 };

int main(int count, char **words) {
    static const struct {
        double sigma;
        uint32_t side;
    } rows[] = {{0.38, 64},  {0.53, 64},  {0.7, 64},  {0.85, 64},
                {0.38, 140}, {0.53, 140}, {0.7, 140}, {0.53, 320}};
    ewa_context *context = check_context(count > 1 ? (uint32_t)atoi(words[1]) : 0, NULL);
    printf("| rows | sigma / spacing | entries per row | factor | its memory | gradient | its steps |\n"
           "|--:|--:|--:|--:|--:|--:|--:|\n");
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
        owned matrix = make_gram(rows[r].side, rows[r].sigma);
        double *truth, *sides = make_sides(&matrix.view, SIDES, &truth), took_s[2] = {0};
        double *solution = malloc(sizeof(double[SIDES]) * matrix.view.size);
        ewa_sparse_report report[2];
        bool done = solution != NULL;
        for (int k = 0; k < 2 && done; k++) {
            const ewa_sparse_options options = {.method = k ? EWA_SPARSE_GRADIENT : EWA_SPARSE_FACTOR};
            const double started_s = ewa_now_s();
            done = ewa_sparse_solve(context, &matrix.view, SIDES, sides, solution, &options, &report[k]) ==
                   EWA_OK;
            took_s[k] = ewa_now_s() - started_s;
        }
        if (done)
            printf("| %u | %g | %.1f | %.3f s | %.1f MB | %.3f s | %u |\n", matrix.view.size, rows[r].sigma,
                   (double)matrix.row_starts[matrix.view.size] / matrix.view.size, took_s[0],
                   (double)report[0].factor_bytes / 1e6, took_s[1], report[1].iterations);
        free(solution);
        free(sides);
        free(truth);
        owned_free(&matrix);
        if (!done) return 1;
    }
    ewa_context_destroy(&context);
    return 0;
}
