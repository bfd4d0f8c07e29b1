// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa-mpi: ranks that share a film, a picture or an octree make the bytes of one process; one that fails ends all, and
// leaves nothing behind.
#include "run_ewa.h"

#include <stdlib.h>
#include <string.h>

static const char *mpi; // how ewa-mpi is started, up to the number of ranks

static int enter(void **state) {
    if (scratch_enter("cli_mpi") != 0) return -1;
    return run("ewa generate terrain -n 60000 -o terrain.ply && ewa generate torus -n 20000 -o torus.ply && "
               "ewa generate ball -o ball.nrrd --dims 24,24,24 && ewa lod terrain.ply -o terrain.copc.laz && "
               "ewa lod torus.ply -o torus.copc.laz");
}

TEST(test_one_picture) {
    static const char *const looks[] = {
        "",
        "--lod-spacing 2 --shading lambert --aov depth=%c_z.pfm,normal=%c_n.exr",
        "--opacity 0.5 --layers exact",
        "--edl 1 --axes --scale-bar",
        "--clip-box -0.4,-0.4,-1,0.4,0.4,1 --edge-layers 2",
        "--kernel raycast --point-size 0 --title ranks",
        "--passes 1 --point-size 2.5",
        "--ortho 2 --view top --background transparent",
    };
    static const char *const clouds[] = {"terrain", "torus"};
    for (size_t i = 0; i < sizeof looks / sizeof looks[0]; i++) {
        const char *cloud = clouds[i % 2];
        char look[2][256];
        for (int k = 0; k < 2; k++) // each writes planes of its own
            snprintf(look[k], sizeof look[k], looks[i], "ab"[k], "ab"[k]);
        run_done("rm -f a.* b.* a_* b_*; ewa render %s.copc.laz --levels always --memory 64M --size 160x120 "
                 "-o a.png %s",
                 cloud, look[0]);
        run_done("%s %d $EWA_MPI_PROGRAM render %s.copc.laz --levels always --memory 64M --size 160x120 -o "
                 "b.png %s --threads 1",
                 mpi, 2 + (int)i % 3, cloud, look[1]);
        assert_true(scratch_same("a.png", "b.png"));
        if (i == 1) assert_true(scratch_same("a_z.pfm", "b_z.pfm") && scratch_same("a_n.exr", "b_n.exr"));
    }
    run_done("%s 2 $EWA_MPI_PROGRAM render torus.copc.laz --levels always --memory 64M --size 64x48 -o b.png "
             "--stats s.json",
             mpi);
    assert_true(scratch_size("s.json") > 0);
}

TEST(test_films) {
    static const char *const films[] = {
        "render torus.ply --turntable 5 --size 64x48 --color-by z",
        "volume ball.nrrd --turntable 5 --size 32x32",
        "render torus.copc.laz --levels always --memory 64M --turntable 5 --size 64x48 --split cloud"};
    for (int k = 0; k < 3; k++) {
        char alone[256];
        snprintf(alone, sizeof alone, "%s", films[k]);
        if (strstr(alone, " --split")) *strstr(alone, " --split") = 0;
        run_done("rm -f [wp]_*; ewa %s -o w_%%d.png", alone);
        run_done("%s 3 $EWA_MPI_PROGRAM %s -o p_%%d.png --threads 1", mpi, films[k]);
        for (int i = 0; i < 5; i++) {
            char whole[16], part[16];
            snprintf(whole, sizeof whole, "w_%d.png", i);
            snprintf(part, sizeof part, "p_%d.png", i);
            assert_true(scratch_same(whole, part));
        }
    }
    // What is there is left out, whoever would have drawn it.
    run_done(
        "rm -f p_*; echo kept > p_1.png; %s 2 $EWA_MPI_PROGRAM render torus.ply --turntable 5 --size 64x48 "
        "--color-by z -o p_%%d.png --skip-existing --frames 0-3",
        mpi);
    assert_int_equal(scratch_size("p_1.png"), 5);
    assert_true(scratch_size("p_3.png") > 0);
    assert_int_equal(scratch_size("p_4.png"), -1);
}

TEST(test_octree) {
    for (int ranks = 2; ranks <= 4; ranks++) {
        run_done("%s %d $EWA_MPI_PROGRAM lod terrain.ply torus.ply -o together.copc.laz", mpi, ranks);
        run_done("ewa lod terrain.ply torus.ply -o alone.copc.laz");
        assert_true(scratch_same("together.copc.laz", "alone.copc.laz"));
        run_done("rm together.copc.laz alone.copc.laz");
    }
    assert_int_equal(run("ls *part-*"), 2); // no parts are left
}

TEST(test_refusals) {
    // Gaussians with sizes, colours and turns of some kind: 32 bytes each.
    uint8_t splats[4][32];
    for (int i = 0; i < 4; i++) {
        const float numbers[6] = {(float)i, 0, 1, 0.1f, 0.2f, 0.3f};
        memcpy(splats[i], numbers, sizeof numbers);
        memcpy(splats[i] + 24, (const uint8_t[8]){200, 100, 50, 255, 255, 128, 128, 128}, 8);
    }
    scratch_write("four.splat", splats, sizeof splats);
    static const struct {
        const char *words, *said;
    } wrong[] = {
        {"render nowhere.copc.laz -o x.png", "No such file"},
        {"render torus.ply -o x.png --split frames", "--split cloud"},
        {"render torus.ply -o x.gif --turntable 3", "film"},
        {"render torus.ply -o x.png --split both", "neither frames nor cloud"},
        {"render torus.ply -o x.png --time-limit -1", "number of seconds"},
        {"render torus.copc.laz --levels always --memory 64M -o x.png --backend gl", "leave out --backend"},
        {"render torus.copc.laz --levels always --memory 64M -o x.png --no-such", "no-such"},
        {"volume ball.nrrd -o x.png", "order of depth"},
        {"lod torus.ply -o x.copc.laz --subset 1/2", "by themselves"},
        {"info torus.ply", "one process"},
        {"fly", "no such command"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        assert_int_not_equal(run("%s 2 $EWA_MPI_PROGRAM %s 2>&1", mpi, wrong[i].words), 0);
        if (!strstr(last_run.out, wrong[i].said)) fail_msg("%s: %s", wrong[i].words, last_run.out);
        assert_int_equal(scratch_size("x.png"), -1);
    }
    run_done("%s 2 $EWA_MPI_PROGRAM --help", mpi);
    assert_non_null(strstr(last_run.out, "--split"));
}

/// A rank that dies or stops amid a film: that has an end, soon, with an error, and every file that is there is whole.
TEST(test_lost_ranks) {
    run_done("rm -f [wp]_*; ewa render torus.copc.laz --levels always --memory 64M --turntable 400 --frames "
             "0-0 --size 320x240 -o "
             "w_%%03d.png");
    static const char *const signals[] = {"KILL", "STOP"};
    for (int i = 0; i < 2; i++)
        for (int shares_cloud = 0; shares_cloud < 2; shares_cloud++) {
            run_done("rm -f p_*");
            // The newest of the ranks is hit once the first frame is there.
            assert_int_not_equal(
                run("%s 3 sh -c 'echo $$ >> pids; exec $EWA_MPI_PROGRAM render torus.copc.laz --levels "
                    "always --memory 64M "
                    "--turntable 400 --size "
                    "320x240 --threads 1 -o p_%%03d.png --time-limit 1 --split %s' & all=$!; while [ ! -e "
                    "p_000.png ]; do sleep 0.05; done; kill -%s $(tail -n 1 pids); date +%%s > hit; wait "
                    "$all; "
                    "status=$?; [ $(($(date +%%s) - $(cat hit))) -le 6 ] || echo slow; rm pids; exit $status",
                    mpi, shares_cloud ? "cloud" : "frames", signals[i]),
                0);
            assert_null(strstr(last_run.out, "slow"));
            assert_true(scratch_same("w_000.png", "p_000.png"));
            assert_int_equal(run("ls p_*.tmp"), 2);
        }
}

/// Starts two ranks on an octree, kills those that `killed` names once the second one's part is there, and waits for the end.
static int kill_ranks(const char *killed) {
    return run("echo old > made.copc.laz; rm -f pid_*; %s 2 sh -c 'echo $$ > pid_${OMPI_COMM_WORLD_RANK-$PMI_RANK}; "
               "exec $EWA_MPI_PROGRAM lod large.ply --threads 1 -o made.copc.laz' & all=$!; echo $all > pid_all; "
               "while [ ! -e made.copc.laz.part-2-of-2.copc.laz ] && kill -0 $all; do sleep 0.01; done; "
               "kill -KILL $(cat %s); wait $all; status=$?; sleep 0.5; exit $status",
               mpi, killed);
}

/// A rank that is killed leaves its part, which the other one removes; what nobody could remove is replaced, and gone, after the
/// next run.
TEST(test_lost_parts) {
    run_done("ewa generate terrain -n 600000 -o large.ply && ewa lod large.ply -o alone.copc.laz");
    assert_int_not_equal(kill_ranks("pid_1"), 0);
    assert_int_equal(run("ls | grep -e part- -e '[.]tmp$'"), 1);
    run_done("grep -q old made.copc.laz");
    assert_int_not_equal(kill_ranks("pid_0 pid_1 pid_all"), 0);
    run_done("grep -q old made.copc.laz && ls made*part-2-of-2*");
    run_done("%s 2 $EWA_MPI_PROGRAM lod large.ply -o made.copc.laz", mpi);
    assert_int_equal(run("ls | grep -e part- -e '[.]tmp$'"), 1);
    assert_true(scratch_same("made.copc.laz", "alone.copc.laz"));
}

int main(void) {
    mpi = getenv("EWA_MPI");
    if (!mpi) return 77;
    return RUN_TESTS(enter, NULL);
}
