// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Blocks of LZ4: by hand, cut, changed; and VTK's arrays of several of them and of LZMA, as its own writer has them.
#include "io/mesh_fixture.h"

#include "io/lz4.h"

/// "abc", five times over, then "abcxyz12": a copy that overlaps itself, then literals.
static const uint8_t block[] = {0x38, 'a', 'b', 'c', 3, 0, 0x80, 'a', 'b', 'c', 'x', 'y', 'z', '1', '2'};
static const char text[] = "abcabcabcabcabcabcxyz12";
enum { BLOCK_BYTES = sizeof block, TEXT_BYTES = sizeof text - 1 };

TEST(test_known_block) {
    uint8_t to[TEXT_BYTES + 1];
    assert_true(ewa_lz4_unpack(block, BLOCK_BYTES, to, TEXT_BYTES));
    assert_memory_equal(to, text, TEXT_BYTES);
    assert_false(ewa_lz4_unpack(block, BLOCK_BYTES, to, TEXT_BYTES - 1));
    assert_false(ewa_lz4_unpack(block, BLOCK_BYTES, to, TEXT_BYTES + 1));
    assert_true(ewa_lz4_unpack(block, 0, to, 0));
    uint8_t changed[BLOCK_BYTES];
    memcpy(changed, block, BLOCK_BYTES);
    for (uint8_t offset = 0; offset < 6; offset++) { // of what is copied: there are three bytes before it
        changed[4] = offset;
        assert_true(ewa_lz4_unpack(changed, BLOCK_BYTES, to, TEXT_BYTES) == (offset > 0 && offset < 4));
    }
}

/// A length of 300: 15, 255 and 30.
TEST(test_long_literals) {
    uint8_t from[303] = {0xf0, 255, 30}, to[300];
    for (int i = 0; i < 300; i++) from[3 + i] = (uint8_t)(7 * i);
    assert_true(ewa_lz4_unpack(from, sizeof from, to, sizeof to));
    assert_memory_equal(to, from + 3, sizeof to);
}

/// In memory that ends with the bytes, for sanitizers.
TEST(test_damaged) {
    check_random random = {3};
    for (int i = 0; i < 4000; i++) {
        const size_t cut = i < BLOCK_BYTES ? (size_t)i : BLOCK_BYTES;
        OWNED(check_free) uint8_t *from = malloc(cut + (cut == 0)), *to = malloc(TEXT_BYTES);
        assert_true(from && to);
        memcpy(from, block, cut);
        if (i >= BLOCK_BYTES) from[check_random_u64(&random) % BLOCK_BYTES] = (uint8_t)check_random_u64(&random);
        const bool good = ewa_lz4_unpack(from, cut, to, TEXT_BYTES);
        assert_false(good && cut < BLOCK_BYTES);
    }
}

#define ARRAY(attributes, bytes) "<DataArray " attributes " format=\"binary\">" bytes "</DataArray>"
#define FILE_OF(offsets)                                                                                                            \
    "<VTKFile type=\"PolyData\" compressor=\"vtkLZ4DataCompressor\"><PolyData><Piece NumberOfPoints=\"16\" NumberOfPolys=\"9\"><Points>" ARRAY( \
        "type=\"Float32\" NumberOfComponents=\"3\"",                                                                                \
        "AwAAAEAAAAAAAAAAHwAAACQAAAArAAAAGQABACeAPw8AFkAMABdADAAAAgCggD8AAAAAAACAP1IAAIA/AAEAFkAMABdADAABAgARQAYAAiwAAwwAYABAAAAAQBEAAQBQ" \
        "QEAAAAAEAAMCAAEQAFYAAACAPwwAACAABBgAoEBAAABAQAAAAAA=")                                                                     \
    "</Points><Polys>" ARRAY("type=\"Int64\" Name=\"connectivity\"",                                                               \
                             "BAAAAEAAAAAYAAAAIwAAACUAAAAlAAAAEwAAAA==EwABABMBCAATBAgABBAAEwIQABMFCAAEEACAAwAAAAAAAAAiBgABABIEBwAjAAUIABMICAAE" \
                             "EAAEKAATCRgAgAYAAAAAAAAAIgcAAQASCgcAIwAICAATCQgAEwwIAAQQAAQoAIANAAAAAAAAACIKAAEAEgsHAJAADgAAAAAAAAA=") \
        ARRAY("type=\"Int64\" Name=\"offsets\"", offsets) "</Polys></Piece></PolyData></VTKFile>"

/// Three whole blocks of 64 bytes, three and a part, one and a part.
CASE(test_arrays) {
    ewa_mesh mesh;
    mesh_load_text(context, &messages, "a.vtp",
                   FILE_OF("AgAAAEAAAAAIAAAAJwAAAAkAAAA=IgMAAQASBgcAIwAJCAATDAgAEw8IABMSCAATFQgAgBgAAAAAAAAAgBsAAAAAAAAA"), &mesh);
    assert_int_equal(mesh.triangle_count, 9);
    assert_float_equal(mesh_area(&mesh, NULL), 4.5, 1e-12);
    ewa_mesh_free(&mesh);
    static const struct {
        const char *text, *said;
    } broken[] = {
        {FILE_OF("AgAAAEAAAAAIAAAAJwAAAAkAAAA=IgMAAQASBgcAIwAJCAATDAgAEw8IABMSCAATFQgAgBgAAAAAAAAAgBsAAAAAAAA="), "end early"},
        {FILE_OF("AgAAAEAAAAAIAAAAJwAAAAkAAAA=/wMAAQASBgcAIwAJCAATDAgAEw8IABMSCAATFQgAgBgAAAAAAAAAgBsAAAAAAAAA"), "a packed array is damaged"},
        {FILE_OF("AgAAAEAAAABIAAAAJwAAAAkAAAA=IgMAAQASBgcAIwAJCAATDAgAEw8IABMSCAATFQgAgBgAAAAAAAAAgBsAAAAAAAAA"), "end early"},
        {FILE_OF("AgAAAP///38IAAAAJwAAAAkAAAA=IgMAAQASBgcAIwAJCAATDAgAEw8IABMSCAATFQgAgBgAAAAAAAAAgBsAAAAAAAAA"), "end early"},
    };
    for (size_t i = 0; i < sizeof broken / sizeof broken[0]; i++)
        mesh_refuse(context, &messages, "a.vtp", broken[i].text, strlen(broken[i].text), EWA_ERROR_FORMAT, broken[i].said);
}

#define LZMA_FILE(places)                                                                                                       \
    "<VTKFile type=\"PolyData\" compressor=\"vtkLZMADataCompressor\"><PolyData><Piece NumberOfPoints=\"9\" NumberOfPolys=\"4\"><Points>" ARRAY( \
        "type=\"Float32\" NumberOfComponents=\"3\"", places)                                                                  \
    "</Points><Polys>" ARRAY("type=\"Int64\" Name=\"connectivity\"",                                                          \
                             "AgAAAGAAAAAgAAAAUAAAAEgAAAA=/Td6WFoAAAFpIt42AsAgYCEBFgBfIlBw4ABfABhdAABqfrsUcWhFpXAJqq4OIF58Pb3BYKi3OgBE" \
                             "zqSAAAEwYIDicrKQQpkNAQAAAAABWVr9N3pYWgAAAWki3jYCwBYgIQEWAKaegPrgAB8ADl0AAgA34WP8NdfG5jxWewAAAACpInX5AAEm" \
                             "IMcWNtiQQpkNAQAAAAABWVo=")                                                                     \
        ARRAY("type=\"Int64\" Name=\"offsets\"", "AQAAAGAAAAAgAAAASAAAAA==/Td6WFoAAAFpIt42AsAWICEBFgCmnoD64AAfAA5dAAIAN+HOKwGazEAO" \
                                                 "Jo+AAAAA2pEUYQABJiDHFjbYkEKZDQEAAAAAAVla") "</Polys></Piece></PolyData></VTKFile>"

/// As VTK's own writer has them: two blocks of 96 bytes and less.
CASE(test_lzma) {
    if (!strstr(ewa_parts(), "lzma")) skip();
    ewa_mesh mesh;
    mesh_load_text(context, &messages, "a.vtp",
                   LZMA_FILE("AgAAAGAAAAAMAAAAUAAAAEAAAAA=/Td6WFoAAAFpIt42AsAeYCEBFgCCRCBO4ABfABZdAABoLkNQCwqpQyZ8KfVu3t3NMBdG/AAAAACoTvo0"
                             "AAEuYF/dM2aQQpkNAQAAAAABWVr9N3pYWgAAAWki3jYCwBAMIQEAAGkKcDQBAAsAAAA/AAAAPwAAAAAAO+YsqQABIAyi3bS8kEKZDQEA"
                             "AAAAAVla"), &mesh);
    assert_int_equal(mesh.triangle_count, 8);
    assert_float_equal(mesh_area(&mesh, NULL), 1, 1e-12);
    ewa_mesh_free(&mesh);
    // A byte of what is packed is another one.
    static const char changed[] =
        LZMA_FILE("AQAAAGAAAAAMAAAAQAAAAA==/Td6WFoAAAFpIt42AgAhAQwAAACPmEGc4AALAAZdAQBsPk8AAAAAAG/G1XsAAR4M38Zx/ZBCmQ0BAAAAAAFZWg==");
    mesh_refuse(context, &messages, "a.vtp", changed, sizeof changed - 1, EWA_ERROR_FORMAT, "a packed array is damaged");
}

int main(void) { return RUN_TESTS(NULL, NULL); }
