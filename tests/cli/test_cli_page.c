// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa page without a browser: what is in a page, what is not, and what it shows.
#include "cli/page/sha256.h"
#include "run_ewa.h"

#include <stdlib.h>

/// Scripts and modules that stand for those of page/.
static int enter(void **state) {
    (void)state;
    if (scratch_enter("page") != 0) return 1;
    run_done("mkdir assets && cp $EWA_PAGE_SOURCE/*.js $EWA_PAGE_SOURCE/*.css assets && printf exact >assets/page.wasm.gz && "
             "printf relaxed >assets/page-relaxed.wasm.gz");
    run_done("ewa generate torus -n 2000 -o torus.ply && ewa generate terrain -n 3000 -o terrain.las && "
             "ewa generate blob --dims 12 -o blob.nrrd");
    return 0;
}

static char *read_text(const char *name) {
    const long size = scratch_size(name);
    assert_true(size > 0);
    char *text = malloc((size_t)size + 1);
    FILE *file = fopen(scratch_path(name), "rb");
    assert_true(text && file);
    assert_int_equal(fread(text, 1, (size_t)size, file), size);
    fclose(file);
    text[size] = 0;
    return text;
}

static int count(const char *text, const char *what) {
    int found = 0;
    for (const char *at = text; (at = strstr(at, what)); at++) found++;
    return found;
}

/// Writes what stands behind `begin`, up to the next "<", as a file.
static void take_part(const char *page, const char *begin, const char *name) {
    const char *at = strstr(page, begin);
    assert_non_null(at);
    at += strlen(begin);
    scratch_write(name, at, strcspn(at, "<"));
}

TEST(digests_are_those_of_the_standard) {
    (void)state;
    // FIPS 180-2, appendix B, and the empty text.
    static const struct {
        const char *text;
        uint8_t begin[4];
    } known[] = {{"abc", {0xba, 0x78, 0x16, 0xbf}},
                 {"", {0xe3, 0xb0, 0xc4, 0x42}},
                 {"abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq", {0x24, 0x8d, 0x6a, 0x61}}};
    uint8_t digest[SHA256_BYTES];
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        sha256(known[i].text, strlen(known[i].text), digest);
        assert_memory_equal(digest, known[i].begin, 4);
    }
    OWNED(check_free) char *million = malloc(1000000);
    assert_non_null(million);
    memset(million, 'a', 1000000);
    sha256(million, 1000000, digest);
    assert_memory_equal(digest, ((const uint8_t[]){0xcd, 0xc7, 0x6e, 0x5c}), 4);
}

TEST(a_page_is_whole_and_closed) {
    (void)state;
    run_done("ewa page torus.ply -o torus.html --assets assets");
    OWNED(check_free) char *page = read_text("torus.html");
    // Nothing is asked of anybody, and only what belongs to the page runs.
    assert_null(strstr(page, "http:"));
    assert_null(strstr(page, "https:"));
    assert_non_null(strstr(page, "default-src 'none'; script-src 'wasm-unsafe-eval' 'sha256-"));
    assert_null(strstr(page, "unsafe-inline"));
    assert_null(strstr(page, "\nimport "));
    assert_null(strstr(page, "\nexport "));
    assert_int_equal(count(page, "<script"), 6); // file, scene, worker, two modules, program
    assert_int_equal(count(page, "</script>"), 6);
    // The policy has the digests of script and style.
    run_done("sed -n '/<script type=\"module\">/,/<\\/script>/p' torus.html | sed '1s/.*<script type=\"module\">//; s/<\\/script>.*//' | "
             "head -c -1 | sha256sum | cut -c 1-64 | xxd -r -p | base64 >script.txt; "
             "sed -n '/<style>/,/<\\/style>/p' torus.html | sed '1s/.*<style>//; s/<\\/style>.*//' | head -c -1 | sha256sum | cut -c 1-64 | "
             "xxd -r -p | base64 >style.txt; grep -F -q \"$(cat script.txt)\" torus.html && grep -F -q \"$(cat style.txt)\" torus.html");
    // Files come out as they went in.
    take_part(page, "data-name=\"torus.ply\">", "torus.txt");
    run_done("base64 -d torus.txt >again.ply && cmp again.ply torus.ply");
    take_part(page, "id=\"ewa-relaxed\">", "relaxed.txt");
    run_done("test \"$(base64 -d relaxed.txt)\" = relaxed");
}

TEST(names_and_titles_are_text) {
    (void)state;
    run_done("cp torus.ply '<script>alert(1)<;script>\"&.ply'");
    run_done("ewa page '<script>alert(1)<;script>\"&.ply' -o named.html --assets assets");
    OWNED(check_free) char *page = read_text("named.html");
    assert_int_equal(count(page, "<script"), 6);
    assert_non_null(strstr(page, "data-name=\"_script_alert_1___script___.ply\""));
    assert_non_null(strstr(page, "<title>&lt;script&gt;alert(1)&lt;;script&gt;&quot;&amp;.ply</title>"));
    free(page);
    run_done("ewa page torus.ply --title '</title></script><img src=x onerror=alert(1)>' -o titled.html --assets assets");
    page = read_text("titled.html");
    assert_int_equal(count(page, "</script>"), 6);
    assert_null(strstr(page, "<img"));
}

/// What a page's folder shows is what the program draws of the files.
static void check_same_picture(const char *inputs, const char *options, bool same) {
    run_done("rm -rf site && ewa page %s %s --folder site --assets assets -q", inputs, options);
    run_done("ewa render %s -o before.png --size 160x120 -q && ewa render site/scene.json -o after.png --size 160x120 -q", inputs);
    assert_true(scratch_same("before.png", "after.png") == same);
}

TEST(pages_show_what_is_rendered) {
    (void)state;
    check_same_picture("torus.ply", "", true);
    check_same_picture("terrain.las blob.nrrd torus.ply", "", true);
    run_done("test -f site/terrain.las && test -f site/blob.nrrd && test -f site/index.html && test -f site/page.wasm.gz");
    // Two files of one name, moved by a scene file.
    run_done("mkdir -p a b && cp torus.ply a && cp torus.ply b");
    scratch_text("two.json", "{\"ewa_scene\": 1, \"options\": {\"render\": {\"ambient\": 0.5}}, \"items\": [{\"file\": \"a/torus.ply\"}, "
                             "{\"file\": \"b/torus.ply\", \"to_world\": [1,0,0,3, 0,1,0,0, 0,0,1,0, 0,0,0,1], \"tint\": [1,0,0]}]}");
    check_same_picture("two.json", "", true);
    run_done("test -f site/torus.ply && test -f site/2-torus.ply");
    // LAZ of the same grid, and a mesh as the points that are drawn of it.
    run_done("ewa generate terrain -n 3000 --positions-only -o bare.las");
    check_same_picture("bare.las", "--small", true);
    run_done("test -f site/bare.laz && ! test -f site/bare.las");
    scratch_text("plate.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0.2\nf 1 2 3\nf 1 3 4\n");
    check_same_picture("plate.obj", "", true);
    run_done("test -f site/plate.ply");
    scratch_text("narrow.json", "{\"ewa_scene\": 1, \"items\": [{\"file\": \"plate.obj\", \"cutoff\": 3.5}]}");
    check_same_picture("narrow.json", "", true);
}

/// How things are shown is said to both alike.
TEST(looks_come_along) {
    (void)state;
    run_done("ewa volume blob.nrrd -o blob.png --save-transfer look.json -q");
    static const char *const looks[] = {
        "torus.ply --color-by z --colormap turbo --edl 1 --background 0.1,0.2,0.3 --kernel affine --clip-plane 1,0,0,0.1 --tau 0.3",
        "torus.ply --radius-scale 1.2 --opacity 0.5 --layers exact --cull back --light 1,1,1 --ambient 0.3",
        "blob.nrrd --transfer look.json --opacity-scale 3 --shading none",
        "blob.nrrd --transfer fog",
    };
    for (size_t i = 0; i < sizeof looks / sizeof looks[0]; i++) {
        run_done("rm -rf site && ewa page %s --folder site --assets assets -q", looks[i]);
        run_done("ewa render %s -o before.png --size 160x120 -q && ewa render site/scene.json -o after.png --size 160x120 -q", looks[i]);
        run_done("ewa render %.9s -o plain.png --size 160x120 -q", looks[i]);
        assert_true(scratch_same("before.png", "after.png") && !scratch_same("before.png", "plain.png"));
    }
    run_fails(2, "--env", "ewa page torus.ply --env sky.exr --folder site --assets assets");
}

TEST(cameras_come_along) {
    (void)state;
    run_done("rm -rf site && ewa page torus.ply --view top --size 160x120 --folder site --assets assets");
    run_done("ewa render torus.ply --view top --size 160x120 -o before.png && ewa render site/scene.json -o after.png");
    assert_true(scratch_same("before.png", "after.png"));
}

TEST(failures_leave_nothing) {
    (void)state;
    run_done("rm -rf empty && mkdir empty empty/full empty/none && echo x >empty/full/kept");
    run_fails(1, "--assets|files.js", "ewa page torus.ply -o empty/a.html --assets empty/none");
    run_done("cp -r assets scripts && rm scripts/*.gz");
    run_fails(1, "--assets|page.wasm.gz", "ewa page torus.ply -o empty/a.html --assets scripts");
    run_done("rm scripts/files.js && ln -s files.js scripts/files.js"); // which is there, but cannot be read
    run_fails(1, "--assets|scripts/files.js: Too many", "ewa page torus.ply -o empty/a.html --assets scripts");
    run_done("rm assets/page-relaxed.wasm.gz");
    run_fails(0, "page-relaxed.wasm.gz", "ewa page torus.ply -o exact.html --assets assets");
    run_done("printf relaxed >assets/page-relaxed.wasm.gz");
    run_fails(1, "--folder: empty/full", "ewa page torus.ply --folder empty/full --assets assets");
    run_fails(2, "no output", "ewa page torus.ply");
    run_fails(2, "--folder", "ewa page torus.ply -o empty/a.html --folder empty/b");
    run_fails(1, "missing.ply", "ewa page missing.ply -o empty/a.html --assets assets");
    run_done("head -c 300 torus.ply >cut.ply");
    run_fails(1, "cut.ply", "ewa page torus.ply cut.ply -o empty/a.html --assets assets");
    run_fails(1, "nothing", "ewa page torus.ply --color-by nothing --folder empty/b --assets assets");
    run_done("test \"$(find empty -type f)\" = empty/full/kept && test \"$(ls empty | wc -l)\" = 2");
    run_done("ewa page torus.ply --folder empty/none --assets assets && test -f empty/none/index.html");
    run_done("ewa page torus.ply -o - --assets assets | grep -q '</html>'");
}

int main(void) { return RUN_TESTS(enter, NULL); }
