// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The operating system by the calls of Windows, whose names are UTF-16. Descriptors are those of its C library.
#define WIN32_LEAN_AND_MEAN
#include "base/platform.h"

#include <errno.h>
#include <fcntl.h>
#include <io.h>
#include <malloc.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <windows.h>

enum {
    SHARE_ALL = FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE,
    MAX_TRANSFER_BYTES = 1 << 30, // counts of _read() and WriteFile() are of 32 bits
    WIDE_LENGTH = EWA_PATH_BYTES + 8, // of a path and what stands before a long one
    SHORT_LENGTH = 240,               // what every call takes as it is; the limit is 260 with a name made beside
};

/// Takes over the reason of a failure; returns -1.
static int take_error(void) {
    switch (GetLastError()) {
    case ERROR_FILE_NOT_FOUND:
    case ERROR_PATH_NOT_FOUND:
    case ERROR_INVALID_NAME:
    case ERROR_BAD_NETPATH:
        errno = ENOENT;
        break;
    case ERROR_ACCESS_DENIED:
    case ERROR_WRITE_PROTECT:
        errno = EACCES;
        break;
    case ERROR_SHARING_VIOLATION:
    case ERROR_LOCK_VIOLATION:
        errno = EBUSY;
        break;
    case ERROR_FILE_EXISTS:
    case ERROR_ALREADY_EXISTS:
        errno = EEXIST;
        break;
    case ERROR_DISK_FULL:
    case ERROR_HANDLE_DISK_FULL:
        errno = ENOSPC;
        break;
    case ERROR_NOT_ENOUGH_MEMORY:
    case ERROR_OUTOFMEMORY:
        errno = ENOMEM;
        break;
    case ERROR_BROKEN_PIPE:
    case ERROR_NO_DATA:
        errno = EPIPE;
        break;
    default:
        errno = EIO;
    }
    return -1;
}

// ---- The machine

void *ewa_platform_allocate(size_t size_bytes) { return _aligned_malloc(size_bytes, 64); }

void ewa_platform_release(void *memory) { _aligned_free(memory); }

uint64_t ewa_platform_memory_bytes(void) {
    MEMORYSTATUSEX memory = {.dwLength = sizeof memory};
    return GlobalMemoryStatusEx(&memory) ? memory.ullTotalPhys : (uint64_t)1 << 34;
}

uint32_t ewa_platform_processor_count(void) {
    const DWORD processors = GetActiveProcessorCount(ALL_PROCESSOR_GROUPS);
    return processors < 1 ? 1 : (uint32_t)processors;
}

double ewa_platform_seconds(void) {
    LARGE_INTEGER now, per_second;
    QueryPerformanceCounter(&now);
    QueryPerformanceFrequency(&per_second);
    return (double)now.QuadPart / (double)per_second.QuadPart;
}

bool ewa_platform_has_library(const char *name) {
    HMODULE library = LoadLibraryA(name);
    if (library) FreeLibrary(library);
    return library != NULL;
}

void *ewa_platform_open_library(const char *name) { return (void *)LoadLibraryA(name); }

void *ewa_platform_find_function(void *library, const char *name) {
    const FARPROC found = GetProcAddress((HMODULE)library, name);
    void *function;
    memcpy(&function, &found, sizeof function);
    return function;
}

void ewa_platform_describe(int error, char *text, size_t room) {
    if (strerror_s(text, room, error) != 0) snprintf(text, room, "error %d", error);
}

// ---- Names of files

bool ewa_platform_is_separator(char character) { return character == '/' || character == '\\'; }

const char *ewa_platform_file_name(const char *path) {
    const char *name = path;
    for (; *path; path++)
        if (ewa_platform_is_separator(*path)) name = path + 1;
    return name;
}

bool ewa_platform_is_absolute(const char *path) {
    return ewa_platform_is_separator(*path) || (*path && path[1] == ':');
}

/// A path in UTF-16; false with errno where it is none. Calls take more than 260 characters only of an absolute path behind
/// \\?\, which a path becomes always if `is_long`.
static bool widen(const char *path, bool is_long, wchar_t wide[WIDE_LENGTH]) {
    wchar_t full[EWA_PATH_BYTES];
    const int length = MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, path, -1, wide, EWA_PATH_BYTES - 1);
    if (length <= 0) {
        errno = GetLastError() == ERROR_INSUFFICIENT_BUFFER ? ENAMETOOLONG : EILSEQ;
        return false;
    }
    // C: is the folder of C:/name here; to the system it is where the process stands on C.
    if (length == 3 && wide[1] == L':') wide[2] = L'\\', wide[3] = 0;
    const DWORD full_length = GetFullPathNameW(wide, EWA_PATH_BYTES, full, NULL);
    if (full_length >= EWA_PATH_BYTES) {
        errno = ENAMETOOLONG;
        return false;
    }
    if (full_length == 0 || (full_length < SHORT_LENGTH && !is_long)) return true;
    const bool has_share = wcsncmp(full, L"\\\\", 2) == 0, is_device = has_share && (full[2] == L'?' || full[2] == L'.');
    wcscpy(wide, is_device ? L"" : has_share ? L"\\\\?\\UNC\\" : L"\\\\?\\");
    wcscat(wide, full + (has_share && !is_device ? 2 : 0));
    return true;
}

static HANDLE open_wide(const wchar_t *path, DWORD access, DWORD share, DWORD how, DWORD flags) {
    return CreateFileW(path, access, share, NULL, how, flags, NULL);
}

/// A handle that programs that are started do not get; INVALID_HANDLE_VALUE with errno.
static HANDLE open_handle(const char *path, DWORD access, DWORD share, DWORD how, DWORD flags) {
    wchar_t wide[WIDE_LENGTH];
    if (!widen(path, false, wide)) return INVALID_HANDLE_VALUE;
    HANDLE handle = open_wide(wide, access, share, how, flags);
    if (handle == INVALID_HANDLE_VALUE) take_error();
    return handle;
}

static int descriptor_of(HANDLE handle, int flags) {
    if (handle == INVALID_HANDLE_VALUE) return -1;
    const int descriptor = _open_osfhandle((intptr_t)handle, flags | _O_BINARY | _O_NOINHERIT);
    if (descriptor < 0) CloseHandle(handle);
    return descriptor;
}

static HANDLE handle_of(int descriptor) { return (HANDLE)_get_osfhandle(descriptor); }

static bool take_facts(HANDLE handle, ewa_platform_facts *facts) {
    BY_HANDLE_FILE_INFORMATION found;
    *facts = (ewa_platform_facts){0};
    if (GetFileType(handle) != FILE_TYPE_DISK) return true;
    if (!GetFileInformationByHandle(handle, &found)) {
        // Wine knows no more of a file that it was given open.
        LARGE_INTEGER size_bytes;
        facts->regular = GetFileSizeEx(handle, &size_bytes);
        if (facts->regular) facts->size_bytes = (uint64_t)size_bytes.QuadPart;
        return facts->regular || take_error() == 0;
    }
    facts->folder = (found.dwFileAttributes & FILE_ATTRIBUTE_DIRECTORY) != 0;
    facts->regular = !facts->folder;
    facts->size_bytes = (uint64_t)found.nFileSizeHigh << 32 | found.nFileSizeLow;
    facts->device = found.dwVolumeSerialNumber;
    facts->number = (uint64_t)found.nFileIndexHigh << 32 | found.nFileIndexLow;
    return true;
}

bool ewa_platform_stat(const char *path, ewa_platform_facts *facts) {
    HANDLE handle = open_handle(path, FILE_READ_ATTRIBUTES, SHARE_ALL, OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS);
    if (handle == INVALID_HANDLE_VALUE) return false;
    const bool known = take_facts(handle, facts);
    CloseHandle(handle);
    return known;
}

bool ewa_platform_stat_open(int descriptor, ewa_platform_facts *facts) { return take_facts(handle_of(descriptor), facts); }

bool ewa_platform_is_link(const char *path) {
    wchar_t wide[WIDE_LENGTH];
    const DWORD attributes = widen(path, false, wide) ? GetFileAttributesW(wide) : INVALID_FILE_ATTRIBUTES;
    return attributes != INVALID_FILE_ATTRIBUTES && (attributes & FILE_ATTRIBUTE_REPARSE_POINT);
}

static bool may(const char *path, DWORD access) {
    HANDLE handle = open_handle(path, access, SHARE_ALL, OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS);
    if (handle == INVALID_HANDLE_VALUE) return false;
    CloseHandle(handle);
    return true;
}

bool ewa_platform_may_read(const char *path) { return may(path, GENERIC_READ); }

bool ewa_platform_may_write(const char *path) { return may(path, GENERIC_WRITE); }

bool ewa_platform_resolve(const char *path, char resolved[EWA_PATH_BYTES]) {
    wchar_t wide[EWA_PATH_BYTES];
    HANDLE handle = open_handle(path, FILE_READ_ATTRIBUTES, SHARE_ALL, OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS);
    if (handle == INVALID_HANDLE_VALUE) return false;
    const DWORD length = GetFinalPathNameByHandleW(handle, wide, EWA_PATH_BYTES, FILE_NAME_NORMALIZED | VOLUME_NAME_DOS);
    const bool found = length > 0 && length < EWA_PATH_BYTES;
    if (!found) take_error();
    CloseHandle(handle);
    if (!found) return false;
    // \\?\C:\folder is C:/folder, and \\?\UNC\server\share is //server/share.
    wchar_t *plain = wide;
    if (wcsncmp(wide, L"\\\\?\\UNC\\", 8) == 0)
        plain = wide + 6, plain[0] = L'\\';
    else if (wcsncmp(wide, L"\\\\?\\", 4) == 0)
        plain = wide + 4;
    const int bytes = WideCharToMultiByte(CP_UTF8, WC_ERR_INVALID_CHARS, plain, -1, resolved, EWA_PATH_BYTES, NULL, NULL);
    if (bytes <= 0) {
        errno = ENAMETOOLONG;
        return false;
    }
    for (char *c = resolved; *c; c++)
        if (*c == '\\') *c = '/';
    // A drive has a '/' at its end; as a folder it is to have none.
    if (bytes > 2 && resolved[bytes - 2] == '/') resolved[bytes - 2] = 0;
    return true;
}

bool ewa_platform_rename(const char *from, const char *to) {
    wchar_t wide_from[WIDE_LENGTH], wide_to[WIDE_LENGTH];
    if (!widen(from, false, wide_from) || !widen(to, false, wide_to)) return false;
    return MoveFileExW(wide_from, wide_to, MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH) || take_error() == 0;
}

bool ewa_platform_remove(const char *path) {
    wchar_t wide[WIDE_LENGTH];
    return widen(path, false, wide) && (DeleteFileW(wide) || take_error() == 0);
}

void ewa_platform_unique(int attempt, char words[64]) {
    FILETIME now;
    GetSystemTimePreciseAsFileTime(&now);
    snprintf(words, 64, "%lu-%08lx%08lx-%d", (unsigned long)GetCurrentProcessId(), (unsigned long)now.dwHighDateTime,
             (unsigned long)now.dwLowDateTime, attempt);
}

// ---- Open files

int ewa_platform_open(const char *path, bool waits) {
    (void)waits;
    return descriptor_of(open_handle(path, GENERIC_READ, SHARE_ALL, OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS), _O_RDONLY);
}

/// Opens the file of a path; every folder on the way stays open meanwhile, not to be renamed, and is none that leads elsewhere.
static HANDLE open_steps(wchar_t *path, wchar_t *from) {
    wchar_t *slash = wcschr(from, L'\\');
    if (slash) *slash = 0;
    HANDLE handle = open_wide(path, slash ? FILE_READ_ATTRIBUTES : GENERIC_READ,
                              slash ? FILE_SHARE_READ | FILE_SHARE_WRITE : SHARE_ALL, OPEN_EXISTING,
                              FILE_FLAG_BACKUP_SEMANTICS | FILE_FLAG_OPEN_REPARSE_POINT);
    if (handle == INVALID_HANDLE_VALUE) {
        take_error();
        return handle;
    }
    BY_HANDLE_FILE_INFORMATION found;
    if (!GetFileInformationByHandle(handle, &found) || (found.dwFileAttributes & FILE_ATTRIBUTE_REPARSE_POINT)) {
        CloseHandle(handle);
        errno = ELOOP;
        return INVALID_HANDLE_VALUE;
    }
    if (!slash) return handle;
    *slash = L'\\';
    HANDLE inner = open_steps(path, slash + 1);
    const int error = errno;
    CloseHandle(handle);
    errno = error;
    return inner;
}

int ewa_platform_open_below(const char *folder, const char *inner) {
    char path[EWA_PATH_BYTES];
    wchar_t wide[WIDE_LENGTH];
    // The root of all shares is a '/' of its own, and the first steps from there are no folders.
    const bool is_root = strcmp(folder, "/") == 0;
    const int length = snprintf(path, sizeof path, "%s%s%s", folder, is_root ? "" : "/", inner);
    if (length < 0 || length >= (int)sizeof path) {
        errno = ENAMETOOLONG;
        return -1;
    }
    if (!widen(path, true, wide)) return -1;
    int steps = 1; // of `inner`, from its end on
    for (const char *at = inner + (is_root && *inner == '/'); *at; at++) steps += *at == '/';
    if (is_root) steps -= 2;
    wchar_t *from = wide + wcslen(wide);
    for (; steps > 0 && from > wide; steps--)
        do from--;
        while (from > wide && *from != L'\\');
    return descriptor_of(open_steps(wide, from + 1), _O_RDONLY);
}

int ewa_platform_create(const char *path) {
    return descriptor_of(open_handle(path, GENERIC_WRITE, FILE_SHARE_READ | FILE_SHARE_DELETE, CREATE_NEW, FILE_ATTRIBUTE_NORMAL),
                         _O_WRONLY);
}

int ewa_platform_create_temporary(const char *folder) {
    char words[64], name[EWA_PATH_BYTES];
    ewa_platform_unique(0, words);
    if (snprintf(name, sizeof name, "%s/.ewa-spool-%s", folder, words) >= (int)sizeof name) {
        errno = ENAMETOOLONG;
        return -1;
    }
    return descriptor_of(open_handle(name, GENERIC_READ | GENERIC_WRITE, FILE_SHARE_DELETE, CREATE_NEW,
                                     FILE_ATTRIBUTE_TEMPORARY | FILE_FLAG_DELETE_ON_CLOSE),
                         _O_RDWR);
}

int ewa_platform_open_device(const char *path) {
    return descriptor_of(open_handle(path, GENERIC_WRITE, SHARE_ALL, OPEN_EXISTING, FILE_ATTRIBUTE_NORMAL), _O_WRONLY);
}

int ewa_platform_standard_input(void) {
    _setmode(0, _O_BINARY);
    return 0;
}

int ewa_platform_standard_output(void) {
    _setmode(1, _O_BINARY);
    return _dup(1);
}

int64_t ewa_platform_read(int descriptor, void *bytes, size_t size_bytes) {
    return _read(descriptor, bytes, size_bytes < MAX_TRANSFER_BYTES ? (unsigned)size_bytes : MAX_TRANSFER_BYTES);
}

// ReadFile() and WriteFile() at a place also move to behind it where the next bytes come from or go.
int64_t ewa_platform_read_at(int descriptor, void *bytes, size_t size_bytes, uint64_t at_bytes) {
    OVERLAPPED at = {.Offset = (DWORD)at_bytes, .OffsetHigh = (DWORD)(at_bytes >> 32)};
    DWORD got = 0;
    const DWORD wanted = size_bytes < MAX_TRANSFER_BYTES ? (DWORD)size_bytes : MAX_TRANSFER_BYTES;
    const int64_t stood = _lseeki64(descriptor, 0, SEEK_CUR);
    const bool done = ReadFile(handle_of(descriptor), bytes, wanted, &got, &at) || GetLastError() == ERROR_HANDLE_EOF;
    if (!done) take_error();
    return _lseeki64(descriptor, stood, SEEK_SET) >= 0 && done ? (int64_t)got : -1;
}

int64_t ewa_platform_write(int descriptor, const void *bytes, size_t size_bytes) {
    return _write(descriptor, bytes, size_bytes < MAX_TRANSFER_BYTES ? (unsigned)size_bytes : MAX_TRANSFER_BYTES);
}

int64_t ewa_platform_write_at(int descriptor, const void *bytes, size_t size_bytes, uint64_t at_bytes) {
    OVERLAPPED at = {.Offset = (DWORD)at_bytes, .OffsetHigh = (DWORD)(at_bytes >> 32)};
    DWORD put = 0;
    const DWORD wanted = size_bytes < MAX_TRANSFER_BYTES ? (DWORD)size_bytes : MAX_TRANSFER_BYTES;
    const int64_t stood = _lseeki64(descriptor, 0, SEEK_CUR);
    const bool done = WriteFile(handle_of(descriptor), bytes, wanted, &put, &at);
    if (!done) take_error();
    return _lseeki64(descriptor, stood, SEEK_SET) >= 0 && done ? (int64_t)put : -1;
}

bool ewa_platform_is_at_start(int descriptor) { return _lseeki64(descriptor, 0, SEEK_CUR) == 0; }

bool ewa_platform_flush(int descriptor) { return FlushFileBuffers(handle_of(descriptor)) || take_error() == 0; }

bool ewa_platform_close(int descriptor) { return _close(descriptor) == 0; }

// ---- Mapping (else platform_without_mapping.c)

#ifndef EWA_NO_MMAP
size_t ewa_platform_map_step(void) {
    SYSTEM_INFO system;
    GetSystemInfo(&system);
    return system.dwAllocationGranularity;
}

void *ewa_platform_map(int descriptor, uint64_t at_bytes, size_t size_bytes) {
    HANDLE mapping = CreateFileMappingW(handle_of(descriptor), NULL, PAGE_READONLY, 0, 0, NULL);
    void *mapped =
        mapping ? MapViewOfFile(mapping, FILE_MAP_READ, (DWORD)(at_bytes >> 32), (DWORD)at_bytes, size_bytes) : NULL;
    if (!mapped) take_error();
    if (mapping) CloseHandle(mapping);
    return mapped;
}

void ewa_platform_unmap(void *mapped, size_t size_bytes) {
    (void)size_bytes;
    UnmapViewOfFile(mapped);
}

bool ewa_platform_unmap_part(void *first, size_t size_bytes) {
    (void)first, (void)size_bytes;
    return false;
}

// The system takes back pages of files by itself.
void ewa_platform_forget(void *mapped, size_t size_bytes) { (void)mapped, (void)size_bytes; }
#endif
