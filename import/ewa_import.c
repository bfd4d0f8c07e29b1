// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa-import: reads a mesh through Assimp and writes it to standard output as PLY. A process of its own, that
// the program ewa starts for formats that the library does not read: Assimp's readers are not made for files
// from strangers. It limits its memory, its time and its files, opens nothing but the mesh and regular files
// below the mesh's folder, and can write nothing but its standard output.
//
//   ewa-import MEMORY_BYTES CPU_SECONDS FILE NAMED_FILES
#define _DEFAULT_SOURCE // RLIMIT_NPROC
#include "import_scene.h"
#include "io/referenced_file.h"

#include <assimp/cfileio.h>
#include <assimp/cimport.h>
#include <assimp/postprocess.h>
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

enum { OPEN_FILES = 32 };

static int fail(const char *what) {
    fprintf(stderr, "%s\n", what);
    return 1;
}

static void limit(int resource, uint64_t maximum) {
    const struct rlimit both = {(rlim_t)maximum, (rlim_t)maximum};
    setrlimit(resource, &both);
}

// ---- Assimp's files

static size_t read_file(struct aiFile *file, char *bytes, size_t size, size_t count) {
    return fread(bytes, size, count, (FILE *)(void *)file->UserData);
}

static size_t write_nothing(struct aiFile *file, const char *bytes, size_t size, size_t count) {
    (void)file, (void)bytes, (void)size, (void)count;
    return 0;
}

static size_t tell(struct aiFile *file) {
    const long at = ftell((FILE *)(void *)file->UserData);
    return at > 0 ? (size_t)at : 0;
}

static size_t file_size(struct aiFile *file) {
    struct stat facts;
    return fstat(fileno((FILE *)(void *)file->UserData), &facts) == 0 && facts.st_size > 0
               ? (size_t)facts.st_size
               : 0;
}

static enum aiReturn seek(struct aiFile *file, size_t offset, enum aiOrigin origin) {
    static const int from[] = {SEEK_SET, SEEK_CUR, SEEK_END};
    if ((unsigned)origin > 2) return aiReturn_FAILURE;
    return fseek((FILE *)(void *)file->UserData, (long)offset, from[origin]) == 0 ? aiReturn_SUCCESS
                                                                                  : aiReturn_FAILURE;
}

static void flush_nothing(struct aiFile *file) { (void)file; }

/// The mesh, and which files are opened that it names.
typedef struct import_input {
    const char *path;
    ewa_named_files named_files;
} import_input;

/// Opens the mesh itself, or a file that it names.
static struct aiFile *open_file(struct aiFileIO *io, const char *name, const char *mode) {
    const import_input *input = (const void *)io->UserData;
    const char *mesh = input->path, *slash = strrchr(mesh, '/');
    char reason[EWA_REASON_BYTES];
    if (!mode || mode[0] != 'r') return NULL;
    const size_t folder = slash ? (size_t)(slash - mesh) + 1 : 0;
    const char *inner = strncmp(name, mesh, folder) == 0 ? name + folder : name;
    const int opened = strcmp(name, mesh) == 0
                           ? open(mesh, O_RDONLY | O_CLOEXEC | O_NOCTTY)
                           : ewa_referenced_file_open(input->named_files, mesh, (ewa_text){inner, strlen(inner)}, reason);
    FILE *stream = opened >= 0 ? fdopen(opened, "rb") : NULL;
    struct aiFile *file = stream ? malloc(sizeof *file) : NULL;
    if (!file) {
        if (stream)
            fclose(stream);
        else if (opened >= 0)
            close(opened);
        return NULL;
    }
    *file = (struct aiFile){.ReadProc = read_file,
                            .WriteProc = write_nothing,
                            .TellProc = tell,
                            .FileSizeProc = file_size,
                            .SeekProc = seek,
                            .FlushProc = flush_nothing,
                            .UserData = (aiUserData)(void *)stream};
    return file;
}

static void close_file(struct aiFileIO *io, struct aiFile *file) {
    (void)io;
    fclose((FILE *)(void *)file->UserData);
    free(file);
}

/// Whether every face has only vertices that its mesh has: the next step relies on it.
static bool faces_hold(const struct aiScene *scene) {
    for (unsigned m = 0; m < scene->mNumMeshes; m++) {
        const struct aiMesh *mesh = scene->mMeshes[m];
        if (!mesh || (mesh->mNumVertices && !mesh->mVertices) || (mesh->mNumFaces && !mesh->mFaces))
            return false;
        for (unsigned f = 0; f < mesh->mNumFaces; f++)
            for (unsigned c = 0; c < mesh->mFaces[f].mNumIndices; c++)
                if (!mesh->mFaces[f].mIndices || mesh->mFaces[f].mIndices[c] >= mesh->mNumVertices)
                    return false;
    }
    return true;
}

int main(int argument_count, char **arguments) {
    if (argument_count != 5) return fail("usage: ewa-import MEMORY_BYTES CPU_SECONDS FILE NAMED_FILES");
    char *path = arguments[3];
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_FSIZE, 0);
    limit(RLIMIT_NOFILE, OPEN_FILES);
    limit(RLIMIT_NPROC, 0);
    limit(RLIMIT_CPU, strtoull(arguments[2], NULL, 10));
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) // they reserve terabytes of address space
    limit(RLIMIT_AS, strtoull(arguments[1], NULL, 10));
#endif
    struct stat facts;
    if (stat(path, &facts) != 0) return fail(strerror(errno));
    if (!S_ISREG(facts.st_mode)) return fail("it has to be a regular file, no pipe");
    // As a number, as the library has them.
    import_input input = {path, (ewa_named_files)strtoul(arguments[4], NULL, 10)};
    struct aiFileIO io = {.OpenProc = open_file, .CloseProc = close_file, .UserData = (char *)&input};
    const struct aiScene *scene = aiImportFileEx(path, 0, &io);
    // Where it has no reader for the suffix, it tries others, and says what these miss.
    const char *suffix = strrchr(path, '.');
    if (!scene && suffix && !aiIsExtensionSupported(suffix))
        return fail("this build of Assimp does not read such files: exported as glTF or OBJ they are read");
    if (!scene) return fail(aiGetErrorString());
    if (!faces_hold(scene)) return fail("a face has a vertex that is not there");
    scene = aiApplyPostProcessing(scene, aiProcess_Triangulate);
    if (!scene || !faces_hold(scene)) return fail("its polygons cannot be cut");
    const char *problem = import_write_scene(scene, stdout);
    return problem ? fail(problem) : 0;
}
