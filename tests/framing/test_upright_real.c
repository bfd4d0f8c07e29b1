// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which way is up in the pictures of real files, held to labels: how many are right is printed, and none but those that
// are listed may be wrong. Only where the data set is; test_upright_bodies is the same for things that it makes.
#include "check.h"
#include "upright_labels.h"

#include "ewa/scene.h"

#include <math.h>
#include <string.h>

/// Writes what is up in the picture of one file: "y", "-z".
static void up_of(ewa_context *context, const char *path, char up[4], ewa_view_info *info) {
    OWNED(ewa_asset_release) ewa_asset *asset = NULL;
    OWNED(ewa_scene_destroy) ewa_scene *scene = NULL;
    assert_int_equal(ewa_asset_load(context, path, NULL, &asset), EWA_OK);
    assert_int_equal(ewa_scene_create(context, NULL, &scene), EWA_OK);
    assert_int_equal(ewa_scene_add(scene, asset, NULL), EWA_OK);
    if (ewa_scene_place_camera(scene, NULL, NULL, info) != EWA_OK) fail_msg("%s: no camera", path);
    double ahead[3], above[3];
    ewa_upright_look(&info->upright, ahead, above);
    int axis = 0;
    for (int c = 1; c < 3; c++)
        if (fabs(above[c]) > fabs(above[axis])) axis = c;
    snprintf(up, 4, "%s%c", above[axis] < 0 ? "-" : "", "xyz"[axis]);
}

TEST(labels) {
    (void)state;
    int right = 0, all = 0, open = 0, unexpected = 0;
    for (int i = 0; i < UPRIGHT_LABEL_COUNT; i++) {
        const upright_label *label = &UPRIGHT_LABELS[i];
        char path[1024], up[4];
        ewa_view_info info;
        if (!check_data(label->path, path, sizeof path)) skip();
        ewa_context *context = check_context(2, NULL);
        up_of(context, path, up, &info);
        ewa_context_destroy(&context);
        const bool told = strcmp(label->up, "yz") != 0;
        const bool fits = told ? strcmp(up, label->up) == 0 : strlen(up) == 1 && strchr(label->up, up[0]);
        all++;
        right += fits;
        open += !told;
        unexpected += fits == (label->wrong != NULL);
        if (!fits || label->wrong)
            print_message("%s: %s is up, %s was chosen (%s)%s%s\n", label->path, label->up, up, info.upright.why,
                          label->wrong ? ": " : "", label->wrong ? label->wrong : "");
    }
    print_message("%d of %d right; of %d nothing tells\n", right, all, open);
    assert_int_equal(unexpected, 0);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
