// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tags of XML one after the other.
#include "io/volume/xml_tags.h"

#include <string.h>

static bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

static bool begins(const char *at, const char *end, const char *word) {
    const size_t length = strlen(word);
    return (size_t)(end - at) >= length && memcmp(at, word, length) == 0;
}

/// Behind the next `word`, or NULL.
static const char *behind(const char *at, const char *end, const char *word) {
    for (; at < end; at++) {
        at = memchr(at, word[0], (size_t)(end - at));
        if (!at) return NULL;
        if (begins(at, end, word)) return at + strlen(word);
    }
    return NULL;
}

/// The > that ends a tag, outside of quotes; NULL when there is none.
static const char *find_end(const char *at, const char *end) {
    char quote = 0;
    for (; at < end; at++) {
        if (quote)
            quote = *at == quote ? 0 : quote;
        else if (*at == '"' || *at == '\'')
            quote = *at;
        else if (*at == '>')
            return at;
    }
    return NULL;
}

bool ewa_xml_next(const char **at, const char *end, ewa_xml_tag *tag) {
    const char *open = *at;
    while (open && open < end) {
        open = memchr(open, '<', (size_t)(end - open));
        if (!open) return false;
        if (begins(open, end, "<!--")) {
            open = behind(open + 4, end, "-->");
        } else if (begins(open, end, "<?")) {
            open = behind(open + 2, end, "?>");
        } else if (begins(open, end, "<!")) {
            open = behind(open + 2, end, ">");
        } else {
            const char *last = find_end(open, end);
            if (!last) return false;
            tag->open = open;
            tag->closing = open + 1 < last && open[1] == '/';
            tag->name = open + 1 + tag->closing;
            tag->name_bytes = 0;
            while (tag->name + tag->name_bytes < last && !is_blank(tag->name[tag->name_bytes]) &&
                   tag->name[tag->name_bytes] != '/')
                tag->name_bytes++;
            tag->attributes = tag->name + tag->name_bytes;
            tag->end = last;
            *at = last + 1;
            return true;
        }
    }
    return false;
}

bool ewa_xml_is(const ewa_xml_tag *tag, const char *name) {
    return tag->name_bytes == strlen(name) && memcmp(tag->name, name, tag->name_bytes) == 0;
}

bool ewa_xml_attribute(const ewa_xml_tag *tag, const char *name, char *value, size_t value_bytes) {
    const char *at = tag->attributes, *end = tag->end;
    const size_t length = strlen(name);
    while (at < end) {
        while (at < end && (is_blank(*at) || *at == '/')) at++;
        const char *word = at;
        while (at < end && !is_blank(*at) && *at != '=') at++;
        const size_t word_bytes = (size_t)(at - word);
        while (at < end && is_blank(*at)) at++;
        if (at == end || *at != '=') continue; // a word without a value
        at++;
        while (at < end && is_blank(*at)) at++;
        if (at == end || (*at != '"' && *at != '\'')) return false;
        const char *from = at + 1, *quote = memchr(from, *at, (size_t)(end - from));
        if (!quote) return false;
        if (word_bytes == length && memcmp(word, name, length) == 0) {
            const size_t bytes = (size_t)(quote - from);
            if (bytes >= value_bytes) return false;
            memcpy(value, from, bytes);
            value[bytes] = 0;
            return true;
        }
        at = quote + 1;
    }
    return false;
}
