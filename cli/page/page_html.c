// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The text of pages.
#include "cli/page/page_html.h"
#include "cli/page/sha256.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// Bytes that are encoded at a time: a multiple of 3, so that no piece but the last has an end.
enum { PIECE_BYTES = 3 << 15 };

static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// Writes the base64 (RFC 4648, section 4) of some bytes; returns its length.
static size_t encode(const uint8_t *bytes, size_t size_bytes, char *text) {
    size_t length = 0;
    for (size_t i = 0; i < size_bytes; i += 3) {
        const size_t left = size_bytes - i;
        const uint32_t three = (uint32_t)bytes[i] << 16 | (left > 1 ? (uint32_t)bytes[i + 1] << 8 : 0) | (left > 2 ? bytes[i + 2] : 0);
        for (int k = 0; k < 4; k++) text[length++] = (size_t)k <= left ? letters[three >> (18 - 6 * k) & 63] : '=';
    }
    return length;
}

static void write_encoded(const uint8_t *bytes, size_t size_bytes, FILE *file) {
    char text[PIECE_BYTES / 3 * 4];
    for (size_t at = 0; at < size_bytes; at += PIECE_BYTES) {
        const size_t left = size_bytes - at;
        fwrite(text, 1, encode(bytes + at, left < PIECE_BYTES ? left : PIECE_BYTES, text), file);
    }
}

/// Writes a text so that it is text in HTML, also in an attribute between quotes.
static void write_escaped(const char *text, FILE *file) {
    for (; *text; text++) {
        const unsigned char c = (unsigned char)*text;
        const char *name = c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '"' ? "&quot;" : c == '\'' ? "&#39;" : NULL;
        if (name)
            fputs(name, file);
        else
            fputc(c < 0x20 || c == 0x7f ? ' ' : c, file);
    }
}

/// Writes the source of a policy that is exactly this text.
static void write_hash(const page_bytes *text, FILE *file) {
    uint8_t digest[SHA256_BYTES];
    sha256(text->bytes, text->size_bytes, digest);
    fputs("'sha256-", file);
    write_encoded(digest, sizeof digest, file);
    fputc('\'', file);
}

static void write_head(const char *title, FILE *file) {
    fprintf(file, "\">\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
                  "<meta name=\"generator\" content=\"ewa %s\">\n<title>", ewa_version());
    write_escaped(title, file);
    fputs("</title>\n<link rel=\"icon\" href=\"data:,\">\n", file);
}

static void write_title(const char *title, FILE *file) {
    fputs("<main>\n<h1>", file);
    write_escaped(title, file);
    fputs("</h1>\n<noscript>This page draws with a script, which is switched off.</noscript>\n", file);
}

/// Writes bytes as text that no browser takes for a script, by an attribute that says which they are.
static void write_part(const char *attribute, const char *value, const page_bytes *part, FILE *file) {
    fprintf(file, "<script type=\"application/octet-stream\" %s=\"", attribute);
    write_escaped(value, file);
    fputs("\">", file);
    write_encoded((const uint8_t *)part->bytes, part->size_bytes, file);
    fputs("</script>\n", file);
}

static bool write_data(cli_session *session, const page_data *data, FILE *file) {
    uint64_t total_bytes = 0;
    for (size_t i = 0; i < data->count; i++) {
        char path[PATH_BYTES];
        page_bytes part;
        int error = ENAMETOOLONG;
        const int length = snprintf(path, sizeof path, "%s/%s", data->folder, data->names[i]);
        if (length >= (int)sizeof path || !page_bytes_read(path, &part, &error)) {
            session_fail(session, "%s: %s", data->names[i], strerror(error));
            return false;
        }
        total_bytes += part.size_bytes;
        const bool fits = total_bytes <= PAGE_SINGLE_BYTES;
        if (fits) write_part("data-name", data->names[i], &part, file);
        page_bytes_free(&part);
        if (!fits) {
            session_fail(session, "%s: %llu MB are too much for a page of one file; --small packs points and Gaussians, --folder makes a page "
                                  "for a server, which large data needs",
                         data->names[i], (unsigned long long)(total_bytes >> 20));
            return false;
        }
        if (!session_step(session, "page", i + 1, data->count)) return false;
    }
    return true;
}

static bool write_single(cli_session *session, const page_assets *assets, const page_data *data, const page_words *words,
                         const page_bytes *script, const page_bytes *worker, FILE *file) {
    const page_bytes *style = &assets->each[PAGE_STYLE_CSS];
    fputs("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
          "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src 'wasm-unsafe-eval' ", file);
    write_hash(script, file);
    fputs("; style-src ", file);
    write_hash(style, file);
    fputs("; worker-src blob:; img-src data: blob:; base-uri 'none'; form-action 'none'", file);
    write_head(words->title, file);
    fprintf(file, "<style>%s</style>\n</head>\n<body%s>\n", style->bytes, words->color_bar ? " data-color-bar" : "");
    write_title(words->title, file);
    fputs("</main>\n", file);
    if (!write_data(session, data, file)) return false;
    fprintf(file, "<script type=\"text/plain\" id=\"ewa-worker\">%s</script>\n", worker->bytes);
    write_part("id", "ewa-exact", &assets->each[PAGE_EXACT_WASM], file);
    if (assets->each[PAGE_RELAXED_WASM].bytes) write_part("id", "ewa-relaxed", &assets->each[PAGE_RELAXED_WASM], file);
    fprintf(file, "<script type=\"module\">%s</script>\n</body>\n</html>\n", script->bytes);
    return true;
}

bool page_html_single(cli_session *session, const page_assets *assets, const page_data *data, const page_words *words, FILE *file) {
    static const page_asset scripts[] = {PAGE_LOOK_JS, PAGE_VIEW_JS, PAGE_SINGLE_JS};
    static const page_asset workers[] = {PAGE_FILES_JS, PAGE_RANGES_JS, PAGE_MODULE_JS, PAGE_THREADS_JS, PAGE_PICTURES_JS, PAGE_WORKER_JS};
    page_bytes script, worker = {.bytes = NULL};
    bool done = page_assets_join(assets, scripts, sizeof scripts / sizeof scripts[0], &script) &&
                page_assets_join(assets, workers, sizeof workers / sizeof workers[0], &worker);
    if (!done) session_fail(session, "out of memory");
    done = done && write_single(session, assets, data, words, &script, &worker, file);
    page_bytes_free(&script);
    page_bytes_free(&worker);
    return done;
}

bool page_html_folder(const page_words *words, FILE *file) {
    fputs("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
          "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'self'; script-src 'self' 'wasm-unsafe-eval'; "
          "img-src data: blob:; base-uri 'none'; form-action 'none'", file);
    write_head(words->title, file);
    fputs("<link rel=\"stylesheet\" href=\"page.css\">\n<script type=\"module\" src=\"ewa-view.js\"></script>\n</head>\n<body>\n", file);
    write_title(words->title, file);
    fprintf(file, "<ewa-view src=\"" PAGE_SCENE_NAME "\" link%s label=\"", words->color_bar ? " color-bar" : "");
    write_escaped(words->title, file);
    fputs("\"></ewa-view>\n</main>\n</body>\n</html>\n", file);
    return fflush(file) == 0 && !ferror(file);
}
