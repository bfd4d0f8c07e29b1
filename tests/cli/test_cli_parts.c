// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Films by several processes: parts have the bytes of the whole, what is there is left out, and a process that is
// killed leaves nothing that is not whole.
#include "run_ewa.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static int enter(void **state) {
    if (scratch_enter("cli_parts") != 0) return -1;
    return run("ewa generate torus -n 5000 -o torus.ply && ewa generate ball -o ball.nrrd --dims 32,24,28 && "
               "ewa lod torus.ply -o torus.copc.laz && "
               "ewa render torus.ply -o k_%%d.png --turntable 4 --size 64x48 --elevation 30 --save-camera "
               "keys.json");
}

/// A way to make a film, and its number of frames.
typedef struct film {
    const char *command;
    int count;
} film;

/// What looks at the whole film or cloud: framing, ranges of colours, furniture, levels, both lengths of paths.
static const film films[] = {
    {"render torus.ply --turntable 7 --size 96x72 --color-by z --color-bar --axes --scale-bar", 7},
    {"render torus.ply --turntable 7 --size 64x48 --elevation 20 --shading lambert --background transparent",
     7},
    {"render torus.ply --path keys.json", 4},
    {"render torus.ply --path keys.json --frames 9 --loop", 9},
    {"render torus.copc.laz --turntable 7 --size 96x72 --levels always --lod-spacing 2 --memory 64M", 7},
    {"volume ball.nrrd --turntable 5 --size 48x48", 5},
    {"volume ball.nrrd --path keys.json --frames 6", 6},
};
enum { FILM_COUNT = sizeof films / sizeof films[0] };

/// Draws a whole film to w_000.png and so on.
static void draw_whole(const film *of) { run_done("rm -f [wp]_*; ewa %s -o w_%%03d.png", of->command); }

/// Whether exactly the frames of the part first, first + step, ... to last are there and are those of the whole.
static void check_part(const film *of, int first, int last, int step) {
    for (int i = 0; i <= of->count; i++) {
        char part[32], whole[32];
        snprintf(part, sizeof part, "p_%03d.png", i);
        snprintf(whole, sizeof whole, "w_%03d.png", i);
        const bool chosen = i >= first && i <= last && (i - first) % step == 0 && i < of->count;
        assert_int_equal(scratch_size(part) > 0, chosen);
        if (chosen) assert_true(scratch_same(part, whole));
    }
}

TEST(test_ranges) {
    static const int ranges[][2] = {{1, 2}, {0, 0}, {3, 3}, {2, 99}};
    for (size_t k = 0; k < FILM_COUNT; k++) {
        draw_whole(&films[k]);
        for (size_t i = 0; i < sizeof ranges / sizeof ranges[0]; i++) {
            run_done("rm -f p_*; ewa %s -o p_%%03d.png --frames %d-%d --threads %d", films[k].command,
                     ranges[i][0], ranges[i][1], (int)i % 3 + 1);
            check_part(&films[k], ranges[i][0], ranges[i][1], 1);
        }
    }
}

TEST(test_round_robin) {
    for (size_t k = 0; k < FILM_COUNT; k++) {
        draw_whole(&films[k]);
        for (int part = 1; part <= 3; part++) {
            run_done("rm -f p_*; ewa %s -o p_%%03d.png --frames %d/3", films[k].command, part);
            check_part(&films[k], part - 1, films[k].count, 3);
        }
    }
    // All at the same time, without --skip-existing.
    draw_whole(&films[0]);
    run_done("for i in 1 2 3 4; do ewa %s -o p_%%03d.png --frames $i/4 & done; wait", films[0].command);
    check_part(&films[0], 0, films[0].count, 1);
    // More parts than frames: the last have nothing to do, which is no failure.
    assert_int_equal(run("rm -f p_*; ewa render torus.ply -o p_%%03d.png --turntable 3 --frames 5/8"), 0);
    assert_string_equal(last_run.err, "ewa: part 5 of 8 has no frames: the film has 3\n");
    assert_int_equal(scratch_size("p_000.png"), -1);
}

/// Planes beside the picture, statistics and cameras of a part.
TEST(test_beside) {
    run_done(
        "ewa render torus.ply -o a_%%d.exr --aov depth=ad_%%d.pfm --turntable 6 --size 64x48 --save-camera "
        "a.json "
        "&& ewa render torus.ply -o b_%%d.exr --aov depth=bd_%%d.pfm --turntable 6 --size 64x48 --frames 2/3 "
        "--save-camera b.json --stats s.json && test ! -e bd_0.pfm && test ! -e bd_5.pfm");
    assert_true(scratch_same("a_4.exr", "b_4.exr"));
    assert_true(scratch_same("ad_4.pfm", "bd_4.pfm"));
    assert_true(scratch_same("a.json", "b.json"));
    run_done("grep -q '\"film_frame_count\": 6' s.json && grep -q '\"frame_count\": 2' s.json && "
             "test $(grep -c render_s s.json) = 2 && grep -q '\"frame\": 4' s.json");
}

/// Time of the last change and number of a file, which a new file in its place changes.
static struct stat facts_of(const char *name) {
    struct stat facts;
    assert_int_equal(stat(scratch_path(name), &facts), 0);
    return facts;
}

TEST(test_skip_existing) {
    const film *of = &films[0];
    draw_whole(of);
    run_done("ewa %s -o p_%%03d.png && rm p_002.png && : >p_004.png", of->command);
    struct stat before[7];
    char name[32];
    for (int i = 0; i < 7; i++)
        if (i != 2) before[i] = (snprintf(name, sizeof name, "p_%03d.png", i), facts_of(name));
    run_done("ewa %s -o p_%%03d.png --skip-existing", of->command);
    check_part(of, 0, 6, 1);
    for (int i = 0; i < 7; i++) {
        if (i == 2) continue;
        snprintf(name, sizeof name, "p_%03d.png", i);
        const struct stat after = facts_of(name);
        const bool same = after.st_ino == before[i].st_ino &&
                          after.st_mtim.tv_sec == before[i].st_mtim.tv_sec &&
                          after.st_mtim.tv_nsec == before[i].st_mtim.tv_nsec;
        assert_int_equal(same, i != 4); // the empty one held a place only
    }
    // Nothing is read where nothing is left to draw, and only the part is looked at.
    run_done(
        "mv torus.ply aside.ply && ewa %s -o p_%%03d.png --skip-existing && rm p_001.png && "
        "ewa %s -o p_%%03d.png --skip-existing --frames 1/2; ended=$?; mv aside.ply torus.ply; exit $ended",
        of->command, of->command);
    assert_int_equal(scratch_size("p_001.png"), -1);
    // But what else is asked for is made.
    run_done(
        "ewa volume ball.nrrd -o v_%%d.png --turntable 2 --size 32x32 && ewa volume ball.nrrd -o v_%%d.png "
        "--turntable 2 --size 32x32 --skip-existing --save-transfer t.json --save-camera v.json && "
        "test -s t.json -a -s v.json");
    // A frame is there when all of its files are.
    run_done(
        "ewa render torus.ply -o a_%%d.png --aov depth=d_%%d.pfm --turntable 3 --size 64x48 && rm d_1.pfm && "
        "ewa render torus.ply -o a_%%d.png --aov depth=d_%%d.pfm --turntable 3 --size 64x48 --skip-existing "
        "--stats s.json && test -s d_1.pfm && grep -q '\"frame_count\": 1' s.json && "
        "ewa render torus.ply -o a_%%d.png --turntable 3 --size 64x48 --skip-existing --stats s.json && "
        "grep -q '\"frame_count\": 0' s.json");
}

TEST(test_usage) {
    static const struct {
        const char *options, *said;
    } cases[] = {
        {"-o u_%d.png --turntable 4 --frames 4-9", "--frames: 4-9 is empty|frames 0 to 3"},
        {"-o u_%d.png --path keys.json --frames 4-4", "--frames: 4-4 is empty|frames 0 to 3"},
        {"-o u_%d.png --path keys.json --frames 9 --frames 9-10", "--frames: 9-10 is empty|frames 0 to 8"},
        {"-o u_%d.png --turntable 4 --frames 3-2", "--frames: '3-2' is empty"},
        {"-o u_%d.png --turntable 4 --frames 3/2", "--frames: '3/2' is no part"},
        {"-o u_%d.png --turntable 4 --frames 0/2", "--frames: '0/2' is no part"},
        {"-o u_%d.png --turntable 4 --frames 0/0", "--frames: '0/0' is no part"},
        {"-o u_%d.png --turntable 4 --frames 1-", "--frames: '1-' is neither"},
        {"-o u_%d.png --turntable 4 --frames -1", "--frames: '-1' is neither"},
        {"-o u_%d.png --turntable 4 --frames 1-2-3", "--frames: '1-2-3' is neither"},
        {"-o u_%d.png --turntable 4 --frames 1/2x", "--frames: '1/2x' is neither"},
        {"-o u_%d.png --turntable 4 --frames 1-99999999999999999999", "is neither"},
        {"-o u_%d.png --turntable 4 --frames 0-1 --frames 1/2", "--frames: '1/2' is a second part"},
        {"-o u_%d.png --path keys.json --frames 5 --frames 6", "--frames: two numbers"},
        {"-o u_%d.png --path keys.json --frames 0", "--frames: 0 is outside [1, 1000000]"},
        {"-o u_%d.png --turntable 4 --frames 2", "--frames N needs --path|2-2"},
        {"-o u_%d.png --path keys.json --frames 1/2 --loop", "--loop needs --frames N"},
        {"-o u.png --frames 1/2", "--frames needs --turntable or --path"},
        {"-o u.png --skip-existing", "--skip-existing needs --turntable or --path"},
        {"-o u.mp4 --turntable 4 --skip-existing", "--skip-existing is for numbered files"},
        {"-o u.mp4 --turntable 4 --frames 1/2", "--frames I/N|A-B"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        run_fails(2, cases[i].said, "ewa render torus.ply %s", cases[i].options);
        assert_int_equal(run("ls u*"), 2);
    }
    run_fails(2, "--frames: 5-6 is empty", "ewa volume ball.nrrd -o u_%%d.png --turntable 5 --frames 5-6");
    run_fails(2, "--frames: 4-6 is empty", "ewa volume ball.nrrd -o u_%%d.png --path keys.json --frames 4-6");
}

/// A frame that cannot be written: the status says so, what is written stays, and is named by its own number.
TEST(test_failure) {
    run("mkdir f_5.png");
    run_fails(1, "f_5.png|of 4 frames, |are written and stay: 1, 3",
              "ewa render torus.ply -o f_%%d.png --turntable 8 --size 64x48 --frames 2/2 --threads 1");
    assert_true(scratch_size("f_1.png") > 0 && scratch_size("f_3.png") > 0);
    assert_int_equal(run("test -e f_0.png"), 1);
    run_done("rmdir f_5.png && ewa render torus.ply -o f_%%d.png --turntable 8 --size 64x48 --frames 2/2 "
             "--skip-existing && test -s f_5.png && test -s f_7.png");
}

/// A film's range is that part of the film.
TEST(test_film) {
    run_done("mkdir fake && printf '%%s\\n' '#!/bin/sh' 'for last; do :; done' 'cat >\"${last#file:}\"' "
             ">fake/ffmpeg && "
             "chmod +x fake/ffmpeg && PATH=$PWD/fake:$PATH && "
             "ewa render torus.ply -o whole.mp4 --turntable 6 --size 32x24 && "
             "ewa render torus.ply -o part.mp4 --turntable 6 --size 32x24 --frames 2-4 && "
             "tail -c +%d whole.mp4 | head -c %d >cut && cmp cut part.mp4",
             2 * 32 * 24 * 4 + 1, 3 * 32 * 24 * 4);
}

/// Whatever moment it is killed at, what has a name is whole, and the rest can be drawn afterwards.
TEST(test_killed) {
    static const char command[] = "render torus.ply --turntable 150 --size 320x240 --threads 2";
    run_done("ewa %s -o w_%%03d.png", command);
    for (int wanted = 1; wanted <= 9; wanted += 4) {
        // In the middle: when so many frames are there.
        run("rm -rf film; mkdir film; $EWA_PROGRAM %s -o film/%%03d.png & film=$!; "
            "until [ -e film/%03d.png ]; do sleep 0.01; done; kill -9 $film; wait $film",
            command, wanted);
        assert_int_equal(last_run.exit_status, 128 + 9);
        assert_int_equal(
            run("n=0; for f in film/[0-9]*.png; do "
                "cmp \"$f\" \"w_${f#film/}\" || exit 1; n=$((n + 1)); done; test $n -ge %d -a $n -lt 150",
                wanted),
            0);
        run_done("ewa %s -o film/%%03d.png --skip-existing && for f in w_*.png; do cmp $f film/${f#w_} || "
                 "exit 1; done",
                 command);
    }
}

/// The script for Slurm, as a task of an array and by itself.
TEST(test_script) {
    const film *of = &films[0];
    draw_whole(of);
    assert_int_equal(setenv("EWA", getenv("EWA_PROGRAM"), 1), 0);
    run_done("export SLURM_ARRAY_TASK_ID=2 SLURM_ARRAY_TASK_MAX=3 SLURM_CPUS_PER_TASK=2; "
             "sh \"$EWA_SOURCE_DIR/examples/slurm_film.sh\" %s -o p_%%03d.png",
             of->command);
    check_part(of, 1, 6, 3);
    run_done("PARTS=4 sh \"$EWA_SOURCE_DIR/examples/slurm_film.sh\" %s -o p_%%03d.png", of->command);
    check_part(of, 0, 6, 1);
    // One part that fails fails the whole; the others are drawn.
    assert_int_equal(
        run("rm p_*; mkdir p_001.png; sh \"$EWA_SOURCE_DIR/examples/slurm_film.sh\" %s -o p_%%03d.png",
            of->command),
        1);
    run_done("rmdir p_001.png && test -s p_006.png && test ! -e p_003.png");
}

int main(void) { return RUN_TESTS(enter, NULL); }
