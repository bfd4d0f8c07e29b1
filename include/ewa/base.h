// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Status codes, types of numbers, limits, the context: allocator, messages, progress, threads.
#ifndef EWA_BASE_H
#define EWA_BASE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#if defined(EWA_SHARED)
#define EWA_API __attribute__((visibility("default")))
#else
#define EWA_API
#endif

#define EWA_VERSION_MAJOR 0
#define EWA_VERSION_MINOR 1
#define EWA_VERSION_PATCH 0

#ifdef __cplusplus
extern "C" {
#endif

/// What a call came to. Zero is success, every failure is negative.
typedef enum ewa_status {
    EWA_OK = 0,
    EWA_ERROR_ARGUMENT = -1,    ///< the caller passed something the function's contract excludes
    EWA_ERROR_MEMORY = -2,      ///< the allocator returned NULL, or max_memory_bytes of the context are taken
    EWA_ERROR_IO = -3,          ///< the operating system refused: open, read, write, rename
    EWA_ERROR_FORMAT = -4,      ///< the bytes of a file contradict its format
    EWA_ERROR_UNSUPPORTED = -5, ///< well-formed, but outside of what this library reads or draws
    EWA_ERROR_LIMIT = -6,       ///< a limit of ewa_limits would be exceeded
    EWA_ERROR_NUMERIC = -7,     ///< singular map, no finite value, no solution
    EWA_CANCELLED = -8,         ///< the progress callback returned false, or max_seconds have passed
} ewa_status;

/// Returns the name of a status, such as "EWA_ERROR_FORMAT"; never NULL. Any thread.
EWA_API const char *ewa_status_name(ewa_status status);

/// Returns the version of the library that runs, "major.minor.patch"; never NULL. Any thread.
EWA_API const char *ewa_version(void);

typedef enum ewa_severity {
    EWA_SEVERITY_ERROR = 0,
    EWA_SEVERITY_WARNING = 1, ///< something of the input is not used, or not as it seems
    EWA_SEVERITY_NOTE = 2,    ///< what may surprise or help
    EWA_SEVERITY_INFO = 3,
    EWA_SEVERITY_DEBUG = 4,
} ewa_severity;

/// Instruction sets that the hot loops may use; AND them with what the CPU has.
enum {
    EWA_CPU_AVX2 = 1u << 0,   ///< AVX2 with FMA3
    EWA_CPU_AVX512 = 1u << 1, ///< AVX-512 F, DQ, BW, VL
    EWA_CPU_NEON = 1u << 2,   ///< Advanced SIMD of 64-bit Arm
    EWA_CPU_ALL = 0x7fffffff,
};

/// Types of numbers in memory that the caller describes.
typedef enum ewa_type {
    EWA_F32 = 0,
    EWA_F64,
    EWA_I8,
    EWA_U8,
    EWA_I16,
    EWA_U16,
    EWA_I32,
    EWA_U32,
} ewa_type;

/// Returns the size of one number of a type, in bytes.
EWA_API size_t ewa_type_bytes(ewa_type type);

/// Returns "float", "double", "char", "uchar", "short", "ushort", "int", "uint" (the words of PLY).
EWA_API const char *ewa_type_name(ewa_type type);

/// An axis-aligned box, world units; empty when low > high.
typedef struct ewa_bounds {
    double low_world[3], high_world[3];
    uint64_t finite_count; ///< points whose three coordinates are finite; only they count
} ewa_bounds;

/// Memory from the caller. `size_bytes` at release is the one given at allocation.
typedef struct ewa_allocator {
    void *user;
    /// Returns at least `size_bytes` (> 0) bytes aligned to 64 bytes, or NULL. Called from the thread that
    /// calls the library only.
    void *(*allocate)(void *user, size_t size_bytes);
    void (*release)(void *user, void *memory, size_t size_bytes);
} ewa_allocator;

/// One piece of parallel work: `index` of the piece, `worker` in [0, worker_count) unique among those
/// running.
typedef void ewa_task(void *data, uint32_t index, uint32_t worker);

/// Threads from the caller: `run` calls `task` once for each index in [0, count), in any order, on any of
/// `worker_count` workers, and returns when all are done.
typedef struct ewa_executor {
    void *user;
    uint32_t worker_count;
    void (*run)(void *user, ewa_task *task, void *data, uint32_t count);
} ewa_executor;

/// Receives one message, UTF-8, without a line feed, valid during the call. Comes on the thread that failed.
typedef void ewa_message_callback(void *user, ewa_severity severity, const char *text);

/// Receives the share of `stage` that is done, in [0, 1]; returning false cancels the call, which then
/// returns EWA_CANCELLED. Comes on the thread that called the library.
typedef bool ewa_progress_callback(void *user, const char *stage, double fraction);

/// A file whose bytes the caller has: behind the ranges of a server, dropped onto a page, in an archive, in memory.
typedef struct ewa_file_source {
    uint64_t size_bytes; ///< of the whole file
    /// Writes up to `size_bytes` (> 0) bytes of the file, from byte `at_bytes` on, to `bytes`, and returns how many; 0: there
    /// are none more; negative: they cannot be had, which ends the call of the library by EWA_ERROR_IO. Fewer than asked for
    /// are asked for again from there on. Comes on the thread that called the library.
    int64_t (*read_at)(void *user, uint64_t at_bytes, void *bytes, size_t size_bytes);
    void (*close)(void *user); ///< called once, when the file is not needed any more; NULL: nobody asks
    void *user;
} ewa_file_source;

/// Opens a file that is about to be read by its name: fills `file`, which is zeroed, and returns true for one that is the caller's
/// own; false: the operating system is asked. Comes on the thread that called the library, for one file several times, and
/// also for files that may not be there. Files that such a file names are looked for beside it, by names with '/' between
/// folders, as named_files says. Octrees (COPC, EPT) are read where they are seen, neighbouring parts at once; all other files as
/// a whole, in pieces of EWA_FILE_PIECE_BYTES at most, between which the progress callback is asked ("read").
typedef bool ewa_file_opener(void *user, const char *path, ewa_file_source *file);

enum { EWA_FILE_PIECE_BYTES = 1 << 22 };

/// What a context may use, whatever its inputs ask for. Sizes are looked at before anything is allocated for them, and all
/// memory that the context holds counts against max_memory_bytes, with what libraries take that decode for it; files that
/// are mapped do not. Where it is 0, an input unpacks to more than 2^30 bytes as far as its own explain: 1032 to 1, JSON 16.
typedef struct ewa_limits {
    uint64_t max_points;       ///< points in one cloud; 0 stands for 2^32 - 17, untrusted for 2^26
    uint64_t max_memory_bytes; ///< held at a time; 0 stands for three quarters of the machine's, untrusted for 2^30 at most
    uint32_t max_image_side;   ///< pixels; 0 stands for 65536, untrusted for 16384
    double max_seconds;        ///< of the clock, [0, inf), from ewa_context_create() on, after which calls end at their next
                               ///< report of progress; 0: no limit
} ewa_limits;

/// Which of the files are opened that a file or a folder names: pictures and buffers of meshes, voxels beside a header, the
/// parts of folders and scenes. Only regular files ever are: no device, no pipe.
typedef enum ewa_named_files {
    EWA_NAMED_BELOW = 0,    ///< those below its own folder, when links and ".." are resolved
    EWA_NAMED_ANYWHERE = 1, ///< links and names may lead out of it
    EWA_NAMED_NONE = 2,     ///< none
} ewa_named_files;

/// How a context is made. Fill with ewa_context_options_init().
typedef struct ewa_context_options {
    size_t struct_size;         ///< sizeof(ewa_context_options) of the caller
    ewa_allocator allocator;    ///< default: aligned_alloc and free
    ewa_executor executor;      ///< default (run = NULL): a built-in pool of `thread_count` workers
    uint32_t thread_count;      ///< workers of the built-in pool; default 0: one per processor; at most 256
    uint32_t cpu_mask;          ///< EWA_CPU_*; default EWA_CPU_ALL: everything the CPU has
    ewa_severity message_level; ///< most detailed severity to report; default EWA_SEVERITY_WARNING
    ewa_message_callback *message; ///< default NULL: silent
    void *message_user;
    ewa_progress_callback *progress; ///< default NULL
    void *progress_user;
    ewa_limits limits;
    ewa_named_files named_files; ///< default EWA_NAMED_BELOW
    bool untrusted; ///< for services: small limits where `limits` has defaults, and EWA_NAMED_NONE; default false
    ewa_file_opener *open_file; ///< for files to be read that are no files of the operating system; default NULL: none
    void *open_file_user;
} ewa_context_options;

/// Sets every member to its default; `struct_size` is sizeof of the caller's struct. Any thread.
EWA_API void ewa_context_options_init(ewa_context_options *options, size_t struct_size);

/// What every other object is made from. One thread at a time may call into objects of one context; contexts
/// are independent of each other.
typedef struct ewa_context ewa_context;

/// Makes a context; `options` may be NULL for the defaults. The caller owns `*context` and destroys it after
/// all objects made from it. Errors: EWA_ERROR_ARGUMENT, EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_context_create(const ewa_context_options *options, ewa_context **context);

/// Ends the workers and frees the context; sets `*context` to NULL; accepts NULL and a pointer to NULL.
EWA_API void ewa_context_destroy(ewa_context **context);

/// Returns the number of workers. Any thread.
EWA_API uint32_t ewa_context_worker_count(const ewa_context *context);

/// Returns the EWA_CPU_* bits in use: what the CPU has AND the mask of the options. Any thread.
EWA_API uint32_t ewa_context_cpu_features(const ewa_context *context);

#ifdef __cplusplus
}
#endif
#endif
