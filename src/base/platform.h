// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// All that the library asks of the operating system, once for each kind of system (platform_posix.c, platform_wasm.c,
// what these share in platform_unix.c, platform_windows.c; what a system lacks in platform_without_*.c); threads are in pool.c. Test `opens` finds calls elsewhere.
//
// Paths are UTF-8 with '/' between names, on Windows also '\'. What fails returns false, NULL or -1 and leaves the reason in errno. Every
// function may be called from any thread.
#ifndef EWA_SRC_BASE_PLATFORM_H
#define EWA_SRC_BASE_PLATFORM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    EWA_PATH_BYTES = 4096, ///< of a path, with the 0 behind it
    EWA_FILE_NAME_BYTES = 256,  ///< of one name in it, likewise
};

// ---- The machine

/// Returns memory aligned to 64 bytes at least, uninitialised, for ewa_platform_release(); NULL where there is none.
void *ewa_platform_allocate(size_t size_bytes);
void ewa_platform_release(void *memory);

/// Returns the bytes of memory that the machine has, or a guess.
uint64_t ewa_platform_memory_bytes(void);

/// Returns how many processors there are for threads, at least 1.
uint32_t ewa_platform_processor_count(void);

/// Returns a time in seconds that only grows.
double ewa_platform_seconds(void);

/// Returns whether the system finds a shared library by its name.
bool ewa_platform_has_library(const char *name);

/// Loads a shared library by its name, for as long as the process runs; NULL where there is none.
void *ewa_platform_open_library(const char *name);

/// Returns a function of a library, NULL where it has none of that name.
void *ewa_platform_find_function(void *library, const char *name);

/// Writes what an errno means.
void ewa_platform_describe(int error, char *text, size_t room);

// ---- Names of files

/// What is known of a file without reading it.
typedef struct ewa_platform_facts {
    bool regular, folder;
    uint64_t size_bytes;
    uint32_t permissions;    ///< its nine bits; 0 where the system has none
    uint64_t device, number; ///< equal for two paths of one file
} ewa_platform_facts;

/// Returns whether a character stands between the names of a path.
bool ewa_platform_is_separator(char character);

/// Returns what follows the folder in a path; all of it where it names none.
const char *ewa_platform_file_name(const char *path);

/// Returns whether a path means the same from every folder.
bool ewa_platform_is_absolute(const char *path);

bool ewa_platform_stat(const char *path, ewa_platform_facts *facts);
bool ewa_platform_stat_open(int descriptor, ewa_platform_facts *facts);

/// Returns whether there is a link of that name, wherever it leads.
bool ewa_platform_is_link(const char *path);
bool ewa_platform_may_read(const char *path);
bool ewa_platform_may_write(const char *path);

/// Writes the absolute path of a file or folder that is there, links and ".." resolved, '/' between its names.
bool ewa_platform_resolve(const char *path, char resolved[EWA_PATH_BYTES]);

/// Gives a file another name, in place of a file that has it; for the same folder.
bool ewa_platform_rename(const char *from, const char *to);
bool ewa_platform_remove(const char *path);

/// Writes words for a name that no other process makes now; `attempt` tells those of one process apart.
void ewa_platform_unique(int attempt, char words[64]);

// ---- Open files: descriptors, which programs that are started do not get

/// Opens a file to be read; by `waits` also what makes one wait, such as a pipe without a writer.
int ewa_platform_open(const char *path, bool waits);

/// Opens to be read what `inner` names from `folder` on, one name after the other: a link among them fails with ELOOP, so
/// that nothing can be exchanged for one between a check and this.
int ewa_platform_open_below(const char *folder, const char *inner);

/// Makes a file to be written; EEXIST where the name is taken.
int ewa_platform_create(const char *path);

/// Makes a file without a name in a folder, to be written, which is gone when the process ends, however it ends; -1 where the
/// system or the file system has none. ewa_platform_name() gives it a name in that folder, which fails as create() does.
int ewa_platform_create_nameless(const char *folder);
int ewa_platform_name(int descriptor, const char *path);

/// Makes a file in a folder, to be written and read, that is gone when it is closed.
int ewa_platform_create_temporary(const char *folder);

/// Opens a device or a pipe to be written.
int ewa_platform_open_device(const char *path);

/// The process's own; the output as a descriptor to be closed. Bytes go through as they are.
int ewa_platform_standard_input(void);
int ewa_platform_standard_output(void);

/// Reads or writes some bytes, at a place or where the file stands; returns how many, 0 for none more, or -1, also by EINTR.
int64_t ewa_platform_read(int descriptor, void *bytes, size_t size_bytes);
int64_t ewa_platform_read_at(int descriptor, void *bytes, size_t size_bytes, uint64_t at_bytes);
int64_t ewa_platform_write(int descriptor, const void *bytes, size_t size_bytes);
int64_t ewa_platform_write_at(int descriptor, const void *bytes, size_t size_bytes, uint64_t at_bytes);

/// Returns whether nothing was read yet from what has places to read at.
bool ewa_platform_is_at_start(int descriptor);

/// Waits until what was written survives a power cut, where that can be had.
bool ewa_platform_flush(int descriptor);
void ewa_platform_permit(int descriptor, uint32_t permissions);
bool ewa_platform_close(int descriptor);

// ---- Mapping

/// Places in a file that mappings can begin at are multiples of this.
size_t ewa_platform_map_step(void);

/// Makes bytes of an open file readable; NULL where that cannot be, and always in a library without mapping.
void *ewa_platform_map(int descriptor, uint64_t at_bytes, size_t size_bytes);
void ewa_platform_unmap(void *mapped, size_t size_bytes);

/// Gives up some steps within a mapping; false, with nothing done, where only all of it can be given up.
bool ewa_platform_unmap_part(void *first, size_t size_bytes);

/// Lets the first steps of a mapping leave memory; they come back when they are read.
void ewa_platform_forget(void *mapped, size_t size_bytes);

#endif
