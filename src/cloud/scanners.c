// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The note "scanners" (scanners.h).
#include "cloud/scanners.h"
#include "base/base.h"
#include "base/format.h"
#include "cloud/cloud.h"

#include <math.h>
#include <string.h>

static const char *skip_space(const char *text, const char *end) {
    while (text < end && strchr(" \t\r\n", *text)) text++;
    return text;
}

/// Reads digits; returns behind them.
static const char *read_digits(const char *text, const char *end, double *value, int *count) {
    for (*count = 0; text < end && *text >= '0' && *text <= '9'; text++, (*count)++)
        *value = 10 * *value + (*text - '0');
    return text;
}

/// Reads a decimal number, in any locale, to a few units in the last place: a direction needs no more. Returns
/// behind it, NULL if there is none.
static const char *read_number(const char *text, const char *end, double *number) {
    double value = 0, power = 0;
    int whole, fraction = 0, digits = 1;
    const bool negative = text < end && *text == '-';
    text = read_digits(text + (negative || (text < end && *text == '+')), end, &value, &whole);
    if (text < end && *text == '.') text = read_digits(text + 1, end, &value, &fraction);
    if (whole + fraction == 0) return NULL;
    if (text < end && (*text == 'e' || *text == 'E')) {
        text++;
        const bool below = text < end && *text == '-';
        text = read_digits(text + (below || (text < end && *text == '+')), end, &power, &digits);
        power = below ? -power : power;
    }
    *number = (negative ? -value : value) * pow(10, power - fraction);
    return digits ? text : NULL;
}

/// Reads up to `maximum` numbers; returns how many there are, 0 if there is anything else.
static size_t read_numbers(const char *text, size_t bytes, size_t maximum, double *numbers) {
    const char *end = text + bytes;
    size_t count = 0;
    for (text = skip_space(text, end); text < end; text = skip_space(text, end), count++) {
        double number;
        text = read_number(text, end, &number);
        if (!text || !isfinite(number)) return 0;
        if (count < maximum) numbers[count] = number;
    }
    return count;
}

size_t ewa_cloud_read_scanners(const ewa_cloud *cloud, size_t maximum, double (*world)[3]) {
    size_t bytes = 0;
    const char *note = ewa_cloud_note(cloud, "scanners", &bytes);
    const size_t count = note ? read_numbers(note, bytes, 3 * maximum, world ? world[0] : NULL) : 0;
    return count % 3 ? 0 : count / 3;
}

ewa_status ewa_cloud_write_scanners(ewa_cloud *cloud, size_t count, const double (*world)[3]) {
    enum { LINE_BYTES = 96 };
    ewa_context *context = ewa_cloud_context(cloud);
    char *text = ewa_allocate(context, count, LINE_BYTES);
    if (!text) return EWA_ERROR_MEMORY;
    size_t length = 0;
    for (size_t i = 0; i < count; i++)
        length += (size_t)ewa_format(text + length, LINE_BYTES, "%s%.17g %.17g %.17g", i ? "\n" : "", world[i][0], world[i][1], world[i][2]);
    const ewa_status status = ewa_cloud_set_note(cloud, "scanners", text, length);
    ewa_release(context, text, count, LINE_BYTES);
    return status;
}
