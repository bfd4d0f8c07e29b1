// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Paths by the calls of Windows. The program's manifest (ewa.rc) makes UTF-8 what its calls for narrow characters take, and lets
// them take long paths.
#define WIN32_LEAN_AND_MEAN
#include "cli/base/path.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <windows.h>

enum { SHORT_LENGTH = 240 }; ///< characters that every call takes

/// What GetLastError() says, as an error number.
static int error_number(void) {
    switch (GetLastError()) {
    case ERROR_FILE_NOT_FOUND:
    case ERROR_PATH_NOT_FOUND:
    case ERROR_INVALID_NAME:
        return ENOENT;
    case ERROR_ACCESS_DENIED:
    case ERROR_WRITE_PROTECT:
        return EACCES;
    case ERROR_SHARING_VIOLATION:
    case ERROR_LOCK_VIOLATION:
    case ERROR_USER_MAPPED_FILE:
        return EBUSY;
    case ERROR_FILE_EXISTS:
    case ERROR_ALREADY_EXISTS:
        return EEXIST;
    case ERROR_DISK_FULL:
        return ENOSPC;
    default:
        return EIO;
    }
}

/// A path in UTF-16, absolute and behind \\?\ where it is too long for the calls as it is; false with errno where it is none.
static bool widen(const char *path, wchar_t wide[PATH_BYTES + 8]) {
    wchar_t full[PATH_BYTES];
    if (MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, path, -1, wide, PATH_BYTES) <= 0) {
        errno = GetLastError() == ERROR_INSUFFICIENT_BUFFER ? ENAMETOOLONG : EILSEQ;
        return false;
    }
    const DWORD length = GetFullPathNameW(wide, PATH_BYTES, full, NULL);
    if (length < SHORT_LENGTH || wcsncmp(full, L"\\\\?\\", 4) == 0) return true;
    if (length >= PATH_BYTES) {
        errno = ENAMETOOLONG;
        return false;
    }
    const bool has_share = wcsncmp(full, L"\\\\", 2) == 0;
    wcscpy(wide, has_share ? L"\\\\?\\UNC\\" : L"\\\\?\\");
    wcscat(wide, full + (has_share ? 2 : 0));
    return true;
}

static DWORD attributes_of(const char *path) {
    wchar_t wide[PATH_BYTES + 8];
    return widen(path, wide) ? GetFileAttributesW(wide) : INVALID_FILE_ATTRIBUTES;
}

static bool is_separator(char character) { return character == '/' || character == '\\'; }

const char *path_file_name(const char *path) {
    const char *name = path;
    for (; *path; path++)
        if (is_separator(*path)) name = path + 1;
    return name;
}

bool path_is_link(const char *path) {
    const DWORD attributes = attributes_of(path);
    return attributes != INVALID_FILE_ATTRIBUTES && (attributes & FILE_ATTRIBUTE_REPARSE_POINT);
}

/// Opens what is there to ask about it; INVALID_HANDLE_VALUE with errno.
static HANDLE open_path(const char *path, DWORD access) {
    wchar_t wide[PATH_BYTES + 8];
    if (!widen(path, wide)) return INVALID_HANDLE_VALUE;
    HANDLE handle = CreateFileW(wide, access, FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE, NULL, OPEN_EXISTING,
                                FILE_FLAG_BACKUP_SEMANTICS, NULL);
    if (handle == INVALID_HANDLE_VALUE) errno = error_number();
    return handle;
}

bool path_takes_files(const char *folder) {
    HANDLE handle = open_path(folder, FILE_ADD_FILE);
    if (handle == INVALID_HANDLE_VALUE) return false;
    CloseHandle(handle);
    if (attributes_of(folder) & FILE_ATTRIBUTE_DIRECTORY) return true;
    errno = ENOTDIR;
    return false;
}

bool path_make_folder(const char *path) {
    wchar_t wide[PATH_BYTES + 8];
    if (!widen(path, wide)) return false;
    const bool made = CreateDirectoryW(wide, NULL);
    if (!made) errno = error_number();
    return made;
}

bool path_resolve_writable(const char *path, char resolved[PATH_BYTES]) {
    HANDLE handle = open_path(path, GENERIC_WRITE);
    if (handle == INVALID_HANDLE_VALUE) return false;
    wchar_t wide[PATH_BYTES];
    const DWORD length = GetFinalPathNameByHandleW(handle, wide, PATH_BYTES, FILE_NAME_NORMALIZED | VOLUME_NAME_DOS);
    CloseHandle(handle);
    if (length > 0 && length < PATH_BYTES && WideCharToMultiByte(CP_UTF8, 0, wide, -1, resolved, PATH_BYTES, NULL, NULL) > 0)
        return true;
    errno = ENAMETOOLONG;
    return false;
}

int path_replace(const char *written, const char *target) {
    wchar_t from[PATH_BYTES + 8], to[PATH_BYTES + 8];
    HANDLE handle = open_path(written, GENERIC_WRITE);
    if (handle == INVALID_HANDLE_VALUE) return errno;
    const int unsafe = FlushFileBuffers(handle) ? 0 : error_number();
    CloseHandle(handle);
    if (unsafe) return unsafe;
    if (!widen(written, from) || !widen(target, to)) return errno;
    return MoveFileExW(from, to, MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH) ? 0 : error_number();
}

long path_process_number(void) { return (long)GetCurrentProcessId(); }

bool path_is_program(char path[PATH_BYTES]) {
    const size_t length = strlen(path);
    const bool named = length > 4 && _stricmp(path + length - 4, ".exe") == 0;
    struct stat found;
    if (length + 5 > PATH_BYTES) return false;
    if (!named) strcpy(path + length, ".exe");
    return stat(path, &found) == 0 && S_ISREG(found.st_mode);
}

bool path_find_program(const char *name, char program[PATH_BYTES]) {
    if (path_file_name(name) > name) // it says where it is
        return snprintf(program, PATH_BYTES, "%s", name) < PATH_BYTES && path_is_program(program);
    // SearchPath() would also look in the current folder, where a program may lie beside somebody's data.
    const char *folder = getenv("PATH");
    while (folder && *folder) {
        const size_t length = strcspn(folder, ";");
        const int written = length ? snprintf(program, PATH_BYTES, "%.*s/%s", (int)length, folder, name) : 0;
        if (written > 0 && written < PATH_BYTES && path_is_program(program)) return true;
        folder += length + (folder[length] == ';');
    }
    return false;
}

bool path_of_own_folder(char folder[PATH_BYTES]) {
    const DWORD length = GetModuleFileNameA(NULL, folder, PATH_BYTES);
    if (length == 0 || length >= PATH_BYTES) return false;
    char *name = folder + (path_file_name(folder) - folder);
    *name = 0;
    return name > folder;
}
