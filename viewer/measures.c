// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Measurements that stay: distances, heights, angles, areas and notes with names, by clicks or by numbers.
#include "inner.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// Places after which a measurement is whole by itself; 0: a double click or Enter ends it.
static const uint32_t WHOLE[] = {[EWA_MEASURE_DISTANCE] = 0, [EWA_MEASURE_HEIGHT] = 2, [EWA_MEASURE_ANGLE] = 3, [EWA_MEASURE_AREA] = 0, [EWA_MEASURE_NOTE] = 1};

void measures_write(const viewer *v, char *text, size_t text_bytes, double number, int digits, int power) {
    snprintf(text, text_bytes, "%.*g%s%s%s", digits, number, v->unit ? " " : "", v->unit ? v->unit : "",
             v->unit && power == 2 ? "\xc2\xb2" : "");
}

void measures_value(const viewer *v, const ewa_measure *measure, char text[VIEWER_NAME_BYTES]) {
    ewa_measurement m;
    char value[64] = "";
    if (ewa_places_measure(measure->kind, measure->places_world, measure->count, v->up_world, &m) != EWA_OK)
        value[0] = 0;
    else if (measure->kind == EWA_MEASURE_NOTE)
        value[0] = 0;
    else if (measure->kind == EWA_MEASURE_ANGLE)
        snprintf(value, sizeof value, "%.6g\xc2\xb0", m.angle_deg);
    else if (measure->kind == EWA_MEASURE_AREA)
        measures_write(v, value, sizeof value, m.area, 6, 2);
    else
        measures_write(v, value, sizeof value, measure->kind == EWA_MEASURE_HEIGHT ? m.rise_world : m.length_world, 6, 1);
    snprintf(text, VIEWER_NAME_BYTES, "%s%s%s", measure->name, value[0] ? " " : "", value);
}

/// Says all that is known of a measurement.
static bool tell(viewer *v, size_t index) {
    const ewa_measure *measure = &v->measure_list[index];
    ewa_measurement m;
    if (ewa_places_measure(measure->kind, measure->places_world, measure->count, v->up_world, &m) != EWA_OK) {
        viewer_tell(v, "measure: %s does not go by %u places", ewa_measure_kind_name(measure->kind), measure->count);
        return false;
    }
    char what[VIEWER_NAME_BYTES], length[64], across[64], rise[64], area[64], horizontal_area[64];
    measures_write(v, length, sizeof length, m.length_world, 9, 1);
    measures_write(v, across, sizeof across, m.horizontal_world, 9, 1);
    measures_write(v, rise, sizeof rise, m.rise_world, 9, 1);
    measures_write(v, area, sizeof area, m.area, 9, 2);
    measures_write(v, horizontal_area, sizeof horizontal_area, m.horizontal_area, 9, 2);
    if (measure->kind == EWA_MEASURE_NOTE)
        snprintf(what, sizeof what, "at %.9g %.9g %.9g", measure->places_world[0], measure->places_world[1], measure->places_world[2]);
    else if (measure->kind == EWA_MEASURE_ANGLE)
        snprintf(what, sizeof what, "%.9g deg", m.angle_deg);
    else if (measure->kind == EWA_MEASURE_AREA)
        snprintf(what, sizeof what, "%s horizontal %s around %s", area, horizontal_area, length);
    else if (measure->kind == EWA_MEASURE_HEIGHT)
        snprintf(what, sizeof what, "%s horizontal %s slope %.4g deg", rise, across, m.slope_deg);
    else
        snprintf(what, sizeof what, "%s horizontal %s rise %s slope %.4g deg", length, across, rise, m.slope_deg);
    viewer_say(v, "measure %zu %s %s: %s", index, ewa_measure_kind_name(measure->kind), measure->name, what);
    snprintf(v->state.picked, sizeof v->state.picked, "%s\n%s %s", measure->name, ewa_measure_kind_name(measure->kind), what);
    return true;
}

/// Adds a measurement, unless it cannot be taken; `name` (may be empty) is made up then.
static bool add(viewer *v, const ewa_measure *measure, const char *name) {
    if (v->measure_count == EWA_MAX_MEASURES) {
        viewer_tell(v, "measure: there are %d already", EWA_MAX_MEASURES);
        return false;
    }
    ewa_measure *to = &v->measure_list[v->measure_count];
    *to = *measure;
    if (*name)
        snprintf(to->name, sizeof to->name, "%s", name);
    else
        snprintf(to->name, sizeof to->name, "%c%zu", "dhaAn"[measure->kind], v->measure_count + 1);
    if (!tell(v, v->measure_count)) return false;
    v->measure_count++;
    viewer_mark(v);
    return true;
}

/// Ends the measurement that is under way.
static bool finish(viewer *v) {
    const ewa_measure measure = v->measuring;
    v->measuring.count = 0;
    viewer_mark(v);
    if (!add(v, &measure, "")) return false;
    char text[VIEWER_NAME_BYTES];
    measures_value(v, &v->measure_list[v->measure_count - 1], text);
    pick_copy(v);
    viewer_note(v, measure.kind == EWA_MEASURE_NOTE ? "%s: its text is written in the panel" : "%s, copied as text", text);
    return true;
}

bool measures_click(viewer *v, const viewer_event *event) {
    ewa_measure *measure = &v->measuring;
    if (!v->measures_kind || event->modifiers) return false;
    if (event->clicks >= 2 && !WHOLE[measure->kind]) return finish(v); // the first of both clicks has added the place
    if (event->clicks >= 2 || measure->count == EWA_MEASURE_PLACES || !pick_point(v, event->x, event->y, false)) return true;
    memcpy(measure->places_world + 3 * measure->count, v->picks[0].place_world, sizeof v->picks[0].place_world);
    v->picks[0].given = false; // the place is the measurement's now
    viewer_note(v, "measure: %u of %s", ++measure->count, WHOLE[measure->kind] ? WHOLE[measure->kind] == 2 ? "two places" : "three places" : "as many places as there are; a double click or Enter ends it");
    if (measure->count == WHOLE[measure->kind] && finish(v) && measure->kind == EWA_MEASURE_NOTE) v->state.noted_count++;
    return true;
}

bool measures_end(viewer *v) {
    if (!v->measures_kind || !v->measuring.count || WHOLE[v->measuring.kind]) return false;
    finish(v);
    return true;
}

/// Writes a name as a cell of a table.
static void put_name(FILE *file, const char *name) {
    fputc('"', file);
    for (; *name; name++) {
        if (*name == '"') fputc('"', file);
        fputc(*name, file);
    }
    fputc('"', file);
}

static bool save(viewer *v, const char *path) {
    const char *unit = v->unit ? v->unit : "";
    FILE *file = fopen(path, "w");
    bool done = file != NULL;
    if (file) {
        fputs("name,kind,length,horizontal,rise,slope_deg,angle_deg,area,horizontal_area,unit,places\n", file);
        for (size_t i = 0; i < v->measure_count; i++) {
            const ewa_measure *measure = &v->measure_list[i];
            ewa_measurement m;
            (void)ewa_places_measure(measure->kind, measure->places_world, measure->count, v->up_world, &m);
            put_name(file, measure->name);
            fprintf(file, ",%s,", ewa_measure_kind_name(measure->kind));
            // A kind leaves the cells of others empty.
            if (measure->kind != EWA_MEASURE_NOTE) fprintf(file, "%.9g,%.9g,", m.length_world, m.horizontal_world);
            if (measure->kind == EWA_MEASURE_NOTE)
                fprintf(file, ",,,,,,,%s,", unit);
            else if (measure->kind == EWA_MEASURE_AREA)
                fprintf(file, ",,,%.9g,%.9g,%s,", m.area, m.horizontal_area, unit);
            else if (measure->kind == EWA_MEASURE_ANGLE)
                fprintf(file, ",,%.9g,,,%s,", m.angle_deg, unit);
            else
                fprintf(file, "%.9g,%.9g,,,,%s,", m.rise_world, m.slope_deg, unit);
            for (uint32_t k = 0; k < 3 * measure->count; k++) {
                char number[40];
                pick_write_number(number, measure->places_world[k], false);
                fprintf(file, "%s%s", number, k % 3 < 2 ? " " : k + 1 < 3 * measure->count ? "; " : "\n");
            }
        }
        done = !ferror(file);
        done = fclose(file) == 0 && done;
    }
    if (done)
        viewer_say(v, "measures %zu %s", v->measure_count, path);
    else
        viewer_tell(v, "%s: the measurements cannot be saved", path);
    return done;
}

/// Takes a measurement out, or all.
static bool delete_measures(viewer *v, const char *word) {
    char *end;
    const size_t index = strtoul(word, &end, 10);
    if (strcmp(word, "all") == 0) {
        v->measure_count = 0;
    } else if (*word && !*end && index < v->measure_count) {
        v->measure_count--;
        memmove(&v->measure_list[index], &v->measure_list[index + 1], (v->measure_count - index) * sizeof v->measure_list[0]);
    } else {
        viewer_tell(v, "measure: '%s' is neither all nor the number of a measurement", word);
        return false;
    }
    viewer_mark(v);
    return true;
}

static bool rename_measure(viewer *v, const char *rest) {
    char *end;
    const size_t index = strtoul(rest, &end, 10);
    if (end == rest || *end != ' ' || !end[1] || index >= v->measure_count) {
        viewer_tell(v, "measure: '%s' is not the number of a measurement and a name", rest);
        return false;
    }
    snprintf(v->measure_list[index].name, sizeof v->measure_list[index].name, "%s", end + 1);
    viewer_mark(v);
    return true;
}

/// Measures places that are told, "x,y,z;x,y,z NAME", or begins to take those that are clicked.
static bool begin(viewer *v, ewa_measure_kind kind, const char *rest) {
    ewa_measure measure = {.kind = kind};
    if (!*rest) {
        const bool again = v->measures_kind && v->measuring.kind == kind;
        commands_put_away(v);
        v->measures_kind = !again;
        v->measuring = measure;
        if (again) viewer_note(v, "measure: put away");
        if (again) return true;
        viewer_note(v, "measure: click %s", WHOLE[kind] == 1   ? "a place; the list of measures takes its text"
                                            : WHOLE[kind] == 2 ? "two places"
                                            : WHOLE[kind] == 3 ? "three places, the angle's in the middle"
                                                               : "places; a double click or Enter ends it");
        return true;
    }
    char word[VIEWER_TEXT_BYTES], problem[EWA_OPTION_TEXT_BYTES] = "too many places";
    double corners_world[3 * EWA_PROFILE_CORNERS];
    const size_t length = strcspn(rest, " ");
    const char *name = rest + length + strspn(rest + length, " ");
    snprintf(word, sizeof word, "%.*s", (int)(length < sizeof word ? length : sizeof word - 1), rest);
    double *place = measure.places_world;
    char end;
    if (kind == EWA_MEASURE_NOTE && sscanf(word, "%lf,%lf,%lf%c", &place[0], &place[1], &place[2], &end) == 3) {
        measure.count = 1;
        return add(v, &measure, name);
    }
    if (kind == EWA_MEASURE_NOTE) {
        viewer_tell(v, "measure: '%s' is not the place x,y,z of a note, behind which its text stands", word);
        return false;
    }
    if (length >= sizeof word || ewa_profile_line_read(word, corners_world, &measure.count, problem) != EWA_OK ||
        measure.count > EWA_MEASURE_PLACES) {
        viewer_tell(v, "measure: '%s' is not x,y,z;x,y,z;...: %s", word, problem);
        return false;
    }
    memcpy(measure.places_world, corners_world, 3 * measure.count * sizeof corners_world[0]);
    return add(v, &measure, name);
}

bool viewer_measure_get(const viewer *v, size_t index, char name[VIEWER_NAME_BYTES], char value[VIEWER_NAME_BYTES]) {
    if (index >= v->measure_count) return false;
    const ewa_measure *measure = &v->measure_list[index];
    snprintf(name, VIEWER_NAME_BYTES, "%s", measure->name);
    measures_value(v, measure, value);
    const size_t length = strlen(name); // which stands before
    memmove(value, value + length + (value[length] == ' '), strlen(value) + 1 - length - (value[length] == ' '));
    return true;
}

bool measures_holds(const viewer *v, const char *word) {
    return v->measures_kind && strcmp(word, ewa_measure_kind_name(v->measuring.kind)) == 0;
}

bool measures_command(viewer *v, const char *rest) {
    const size_t length = strcspn(rest, " ");
    const char *behind = rest + length + strspn(rest + length, " "), *kind;
    for (uint32_t k = 0; (kind = ewa_measure_kind_name(k)); k++)
        if (strlen(kind) == length && strncmp(rest, kind, length) == 0) return begin(v, (ewa_measure_kind)k, behind);
    if (strncmp(rest, "name ", 5) == 0) return rename_measure(v, behind);
    if (strncmp(rest, "delete ", 7) == 0) return delete_measures(v, behind);
    v->state.question = VIEWER_ASKS_NOTHING;
    if (strcmp(rest, "save") == 0 && v->measure_count) return commands_ask(v, VIEWER_ASKS_SAVE_MEASURES);
    if (strcmp(rest, "save") == 0) {
        viewer_tell(v, "measure: there is none to be saved");
        return false;
    }
    if (strncmp(rest, "save ", 5) == 0) return save(v, behind);
    if (strcmp(rest, "done") == 0) return finish(v);
    viewer_tell(v,
                "measure: '%s' is none of on, off, next, distance|height|angle|area|note [x,y,z;x,y,z;... [NAME]], done, name N TEXT, "
                "delete N|all, save FILE.csv",
                rest);
    return false;
}
