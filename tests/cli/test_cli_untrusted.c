// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files from anyone: what a file or a folder names is opened below its folder only, and neither waits nor reads a device; what
// unpacks to more than --max-memory is refused by what it says of itself; --max-seconds and --untrusted.
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "run_ewa.h"

static int enter(void **state) {
    return scratch_enter("cli_untrusted");
}

/// Ways in which a name leads elsewhere, to be put in the place of a file that is named.
static const struct {
    const char *make; ///< a shell command; %s stands for the file
    const char *reason; ///< NULL: that of what is no file
} traps[] = {{"mkfifo '%s'", NULL},
             {"ln -s /dev/zero '%s'", "it is not below the folder of the file that names it"},
             {"ln -s /etc/passwd '%s'", "it is not below the folder of the file that names it"},
             {"ln -s nothing '%s'", "it is not there"}};
enum { TRAPS = sizeof traps / sizeof traps[0] };

/// Runs a command with every trap in the place of a file; it ends soon, with a message that says why, of what is no file
/// `irregular`.
static void trap_each(const char *file, const char *irregular, const char *command) {
    for (int i = 0; i < TRAPS; i++) {
        char make[512];
        snprintf(make, sizeof make, traps[i].make, file);
        run_done("rm -rf '%s' && %s", file, make);
        run_fails(1, traps[i].reason ? traps[i].reason : irregular, "timeout 20 %s", command);
    }
    run_done("rm -rf '%s'", file);
}

static void write_ept(const char *hierarchy) {
    run_done("rm -rf tree && mkdir -p tree/ept-hierarchy tree/ept-data");
    scratch_text("tree/ept.json",
                 "{\"version\":\"1.1.0\",\"dataType\":\"binary\",\"hierarchyType\":\"json\",\"points\":1,\"span\":128,"
                 "\"bounds\":[0,0,0,1,1,1],\"boundsConforming\":[0,0,0,1,1,1],\"schema\":["
                 "{\"name\":\"X\",\"type\":\"float\",\"size\":8},{\"name\":\"Y\",\"type\":\"float\",\"size\":8},"
                 "{\"name\":\"Z\",\"type\":\"float\",\"size\":8}]}");
    scratch_text("tree/ept-hierarchy/0-0-0-0.json", hierarchy);
    const double place[3] = {0.5, 0.5, 0.5};
    scratch_write("tree/ept-data/0-0-0-0.bin", place, sizeof place);
}

enum { LIMIT_MIB = 256, SLACK_MIB = 64 };

/// The largest resident memory of any command so far, in MiB.
static inline long peak_mib(void) {
    struct rusage used;
    assert_int_equal(getrusage(RUSAGE_CHILDREN, &used), 0);
    return used.ru_maxrss / 1024;
}

/// A lossless WebP picture of one colour, 16383 pixels a side, whose codes take no bits.
static size_t make_webp(uint8_t webp[64]) {
    static const uint8_t head[20] = {'R', 'I', 'F', 'F', 0, 0, 0, 0, 'W', 'E', 'B', 'P', 'V', 'P', '8', 'L'};
    memset(webp, 0, 64);
    memcpy(webp, head, sizeof head);
    uint8_t *data = webp + 20;
    data[0] = 0x2f;
    uint64_t bits = 0;
    uint32_t count = 0;
#define PUT(value, size) bits |= (uint64_t)(value) << count, count += (size)
    PUT(16382, 14);
    PUT(16382, 14);
    PUT(1, 1); // alpha
    PUT(0, 3); // version
    PUT(0, 3); // no transform, no cache, one group of codes
    for (int i = 0; i < 5; i++) PUT(1, 4); // a code of one symbol, 0
#undef PUT
    for (int i = 0; i < 8; i++) data[1 + i] = (uint8_t)(bits >> 8 * i);
    const uint32_t data_bytes = 24;
    webp[16] = (uint8_t)data_bytes;
    webp[4] = (uint8_t)(data_bytes + 12);
    return 20 + data_bytes;
}

static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

static void encode(const uint8_t *bytes, size_t count, char *text) {
    for (size_t i = 0; i < count; i += 3) {
        const uint32_t three = (uint32_t)bytes[i] << 16 | (i + 1 < count ? (uint32_t)bytes[i + 1] << 8 : 0) |
                               (i + 2 < count ? bytes[i + 2] : 0);
        for (int k = 0; k < 4; k++)
            *text++ = i + (size_t)k <= count ? letters[three >> (18 - 6 * k) & 63] : '=';
    }
    *text = 0;
}

/// What is small in a file and large in memory is refused before it is unpacked. The first test: memory is that of the largest command.
TEST(test_bombs) {
    uint8_t webp[64];
    char text[128], gltf[2048];
    const size_t webp_bytes = make_webp(webp);
    scratch_write("bomb.webp", webp, webp_bytes);
    run_fails(1, "WebP of 16383 x 16383 pixels: |bytes are needed|max_memory_bytes 268435456",
              "ewa texture bomb.webp -o never.png --max-memory %dM", LIMIT_MIB);
    encode(webp, webp_bytes, text);
    snprintf(gltf, sizeof gltf,
             "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{"
             "\"POSITION\":0,\"TEXCOORD_0\":1},\"material\":0}]}],\"materials\":[{\"pbrMetallicRoughness\":{"
             "\"baseColorTexture\":{\"index\":0}}}],\"textures\":[{\"source\":0}],\"images\":[{\"uri\":\"data:image/webp;base64,%s\"}],"
             "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},"
             "{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC2\"}],"
             "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"buffers\":[{\"byteLength\":36,\"uri\":\"data:;base64,"
             "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}]}",
             text);
    scratch_text("bomb.gltf", gltf);
    assert_int_equal(run("ewa sample bomb.gltf -o bomb.ply -n 20 --max-memory %dM", LIMIT_MIB), 0);
    assert_non_null(strstr(last_run.err, "WebP of 16383 x 16383 pixels: "));
    assert_non_null(strstr(last_run.err, "the picture 'image 0' is left out"));
    // Trees of many nodes.
    run_done("{ printf '{\"asset\":{\"version\":\"2.0\"},\"extras\":['; yes '1,' | head -c 12000000 | tr -d '\\n'; printf '1]}'; } "
             ">tree.gltf");
    run_fails(1, "tree.gltf: JSON of |bytes are needed", "ewa info tree.gltf --max-memory %dM", LIMIT_MIB);
    write_ept("{\"0-0-0-0\":1}");
    run_done("awk 'BEGIN { printf \"{\\\"0-0-0-0\\\":1\"; for (i = 0; i < 1500000; i++) printf \",\\\"20-%%d-0-0\\\":1\", i %% 1000000; "
             "print \"}\" }' >tree/ept-hierarchy/0-0-0-0.json");
    run_fails(1, "bytes are needed", "ewa info tree --max-memory %dM", LIMIT_MIB);
    // Points and voxels by their headers; a stream that does not end.
    scratch_text("huge.nrrd", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4000 4000 4000\nencoding: gzip\n\n0123456789");
    run_fails(1, "huge.nrrd", "ewa info huge.nrrd --max-memory %dM", LIMIT_MIB);
    run_fails(1, "bytes are needed", "head -c 400000000 /dev/zero | ewa info - --max-memory %dM", LIMIT_MIB);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) // which hold memory of their own
    if (peak_mib() > LIMIT_MIB + SLACK_MIB)
        fail_msg("%ld MiB by a limit of %d MiB", peak_mib(), LIMIT_MIB);
#endif
}

/// By default a small input unpacks to 1 GiB at most, whatever the machine has; who sets a limit gets it.
TEST(test_defaults) {
    uint8_t webp[64];
    const size_t webp_bytes = make_webp(webp);
    scratch_write("bomb.webp", webp, webp_bytes);
    run_fails(1, "WebP of 16383 x 16383 pixels: |44 bytes of input do not explain|max_memory_bytes",
              "ewa texture bomb.webp -o never.png --corners 0,0,1,0,1,1,0,1");
    run_done("{ printf '{\"asset\":{\"version\":\"2.0\"},\"extras\":['; yes '1,' | head -c 50000000 | tr -d '\n'; printf '1]}'; } "
             ">tree.gltf");
    run_fails(1, "tree.gltf: JSON of |bytes of input do not explain", "ewa info tree.gltf");
    // A picture of one colour of an ordinary size is no bomb.
    run_done("ewa generate sphere -n 50 -o dots.ply && ewa render dots.ply -o dots.png --size 4096x4096");
    run_done("ewa texture dots.png -o small.png --size 16x16");
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    if (peak_mib() > 1024 + SLACK_MIB) fail_msg("%ld MiB by default", peak_mib());
#endif
}

TEST(test_folders) {
    run_done("ewa generate sphere -n 50 -o ball.ply");
    write_ept("{\"0-0-0-0\":1}");
    run_done("ewa convert tree -o point.ply");
    trap_each("tree/ept-data/0-0-0-0.bin", "it is no regular file", "\"$EWA_PROGRAM\" convert tree -o never.ply");
    trap_each("tree/ept-hierarchy/0-0-0-0.json", "it is no regular file", "\"$EWA_PROGRAM\" convert tree -o never.ply");
    run_done("mkdir -p model && printf '1 PINHOLE 8 8 8 8 4 4\\n' >model/cameras.txt && "
             "printf '1 1 0 0 0 0 0 5 1 a.png\\n\\n' >model/images.txt && "
             "ewa render ball.ply --camera model -o ball.png && cp -r model whole");
    run_done("rm model/images.txt && ln -s /etc/passwd model/images.txt");
    run_fails(1, "model/images.txt: it is not below", "ewa render ball.ply --camera model -o never.png");
    run_done("rm model/images.txt && mkfifo model/images.txt");
    run_fails(1, "model/images.txt: it is no regular file",
              "timeout 20 \"$EWA_PROGRAM\" render ball.ply --camera model -o never.png");
    // Who asks for it gets links that lead out, of regular files.
    run_done("rm model/images.txt && ln -s ../whole/images.txt model/images.txt");
    run_fails(1, "named_files anywhere", "ewa render ball.ply --camera model -o never.png");
    run_done("ewa render ball.ply --camera model -o linked.png --named-files anywhere && cmp ball.png linked.png");
    run_fails(1, "files that others name are not opened", "ewa render ball.ply --camera whole -o never.png --named-files none");
    run_fails(1, "files that others name are not opened", "ewa convert tree -o never.ply --untrusted");
    assert_int_equal(scratch_size("never.ply"), -1);
}

TEST(test_volumes) {
    run_done("mkdir -p voxels");
    scratch_text("voxels/a.nhdr", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 4 4\nencoding: raw\ndata file: a.raw\n\n");
    scratch_text("voxels/a.mhd", "ObjectType = Image\nNDims = 3\nDimSize = 4 4 4\nElementType = MET_UCHAR\nElementDataFile = a.raw\n");
    char bytes[64];
    for (int i = 0; i < 64; i++) bytes[i] = (char)(4 * i);
    scratch_write("voxels/a.raw", bytes, sizeof bytes);
    run_done("ewa info voxels/a.nhdr && ewa info voxels/a.mhd");
    trap_each("voxels/a.raw", "it is no regular file", "\"$EWA_PROGRAM\" volume voxels/a.nhdr -o never.png");
    trap_each("voxels/a.raw", "it is no regular file", "\"$EWA_PROGRAM\" volume voxels/a.mhd -o never.png");
    scratch_write("outside.raw", bytes, sizeof bytes);
    static const char *const names[] = {"../outside.raw", "../../../../../../../../../../etc/passwd"};
    for (int i = 0; i < 2; i++) {
        char text[256];
        snprintf(text, sizeof text, "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 4 4\nencoding: raw\ndata file: %s\n\n",
                 names[i]);
        scratch_text("voxels/b.nhdr", text);
        run_fails(1, "it is not below the folder", "ewa info voxels/b.nhdr");
        run_fails(1, "it is not below the folder", "ewa volume voxels/b.nhdr -o never.png");
    }
    scratch_text("voxels/b.nhdr", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 4 4\nencoding: raw\ndata file: ../outside.raw\n\n");
    run_done("ewa info voxels/b.nhdr --named-files anywhere");
}

TEST(test_scenes) {
    run_done("mkdir -p show && ewa generate sphere -n 50 -o show/ball.ply");
    scratch_text("show/scene.json", "{\"ewa_scene\": 1, \"items\": [{\"file\": \"ball.ply\"}]}");
    run_done("ewa render show/scene.json -o scene.png --size 16x16");
    trap_each("show/ball.ply", "it is neither a regular file nor a folder", "\"$EWA_PROGRAM\" render show/scene.json -o never.png --size 16x16");
    scratch_text("show/scene.json", "{\"ewa_scene\": 1, \"items\": [{\"file\": \"../../../../../../../../etc/passwd\"}]}");
    run_fails(1, "it is not below the folder", "ewa render show/scene.json -o never.png --size 16x16");
    run_done("ewa generate sphere -n 50 -o show/ball.ply");
    scratch_text("show/scene.json", "{\"ewa_scene\": 1, \"items\": [{\"file\": \"ball.ply\"}]}");
    run_fails(1, "files that others name are not opened", "ewa render show/scene.json -o never.png --untrusted");
}

TEST(test_limits) {
    run_done("ewa generate sphere -n 400000 -o many.ply");
    run_fails(1, "0.01 s are over (max_seconds)", "ewa surfels many.ply -o never.ply --max-seconds 0.01");
    assert_int_equal(scratch_size("never.ply"), -1);
    run_fails(1, "max_memory_bytes 1048576", "ewa convert many.ply -o never.xyz --max-memory 1M");
    run_fails(2, "--max-memory: ", "ewa convert many.ply -o never.xyz --max-memory much");
    run_fails(2, "--max-seconds: ", "ewa convert many.ply -o never.xyz --max-seconds -1");
    run_done("ewa convert many.ply -o all.xyz --max-memory 0 --max-seconds 0");
    // No helper programs, and the small limits where none are set.
    scratch_text("old.fbx", "FBX");
    run_fails(1, "--untrusted does not start", "ewa info old.fbx --untrusted");
    run_fails(2, "--untrusted does not start", "ewa render many.ply -o film.mp4 --turntable 3 --untrusted");
    run_done("ewa info many.ply --untrusted");
    uint8_t webp[64];
    scratch_write("bomb.webp", webp, make_webp(webp));
    run_fails(1, "max_memory_bytes 1073741824", "ewa texture bomb.webp -o never.png --untrusted");
}

int main(void) { return RUN_TESTS(enter, NULL); }
