// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Prints the table of docs/features.md: measure_features [POINTS [MESH.obj]]. Without a mesh the part is left
// out.
#include "measure/measure.h"
#include "quality/feature_scene.h"

int main(int argument_count, char **arguments) {
    static const char *const names[] = {"cube", "cylinder", "part"};
    const long wanted = argument_count > 1 ? strtol(arguments[1], NULL, 10) : 60000;
    const uint32_t count = wanted > 600 && wanted < 100000000 ? (uint32_t)wanted : 60000;
    ewa_context *context = make_context(0);
    printf("| solid | points | noise | measured noise | k | clipped | recall | precision | at 1.5: recall | "
           "at 1.5: "
           "precision | line error | seconds |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (int solid = SOLID_CUBE; solid <= SOLID_PART; solid++) {
        feature_scene scene;
        if (!feature_scene_make((feature_solid)solid, argument_count > 2 ? arguments[2] : NULL, count,
                                &scene))
            continue;
        static const double noises[] = {0, 0.1, 0.25};
        for (int i = 0; i < 3; i++) {
            feature_score s;
            feature_scene_measure(context, &scene, noises[i], &s);
            printf("| %s | %u | %g | %.3f | %u | %u | %.3f | %.3f | %.3f | %.3f | %.3f | %.2f |\n",
                   names[solid], scene.count, noises[i], s.counts.noise, s.counts.neighbour_count, s.clipped,
                   s.recall, s.precision, s.strict_recall, s.strict_precision, s.line_error, s.seconds);
            fflush(stdout);
        }
        feature_scene_free(&scene);
    }
    ewa_context_destroy(&context);
    return 0;
}
