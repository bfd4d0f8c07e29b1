// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Settings as the viewer's tables of options tell them: type, range, unit, help.
#include "panel_parts.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

namespace {

constexpr int max_numbers = 4;

/// "eye_dome" as "Eye dome"; a unit is said beside the number.
void write_label(const ewa_option *option, char text[EWA_OPTION_TEXT_BYTES]) {
    snprintf(text, EWA_OPTION_TEXT_BYTES, "%s", option->name);
    char *last = strrchr(text, '_');
    if (last && option->unit && strcmp(last + 1, option->unit) == 0) *last = 0;
    for (char *c = text; *c; c++)
        if (*c == '_') *c = ' ';
    if (text[0] >= 'a' && text[0] <= 'z') text[0] = (char)(text[0] - 'a' + 'A');
}

bool is_integer(const ewa_option *option) {
    return option->type == EWA_OPTION_U32 || option->type == EWA_OPTION_U64;
}

/// Reads "1,2,3"; returns how many there are.
int read_numbers(const char *text, double numbers[max_numbers]) {
    int count = 0;
    for (char *end; count < max_numbers; text = end + 1) {
        numbers[count] = strtod(text, &end);
        if (end == text) break;
        count++;
        if (*end != ',') break;
    }
    return count;
}

void say_numbers(const panel_page *page, const ewa_option *option, int count, const double *numbers) {
    char text[EWA_OPTION_TEXT_BYTES];
    int used = 0;
    for (int i = 0; i < count; i++)
        used += snprintf(text + used, sizeof text - (size_t)used, "%s%.9g", i ? "," : "", numbers[i]);
    panel_say(page, "set %s %s", option->name, text);
}

/// The nearest number that the option may have.
double allowed(const ewa_option *option, double number) {
    const double low = option->minimum, high = option->maximum;
    if (is_integer(option)) number = nearbyint(number);
    if (option->limits & EWA_OPTION_OR_ZERO && fabs(number) < 0.5 * fabs(low)) return 0;
    // Above an end that is not allowed itself: a thousandth of the range, or of one.
    const double step = (isfinite(high) && isfinite(low) ? high - low : 1) * 1e-3;
    if (option->limits & EWA_OPTION_ABOVE && number <= low) return low + step;
    if (option->limits & EWA_OPTION_BELOW && number >= high) return high - step;
    return fmin(fmax(number, low), high);
}

/// Numbers: along their range where it is short, else by dragging.
void choose_numbers(panel_page *page, const ewa_option *option, const char *now) {
    static const char label[] = "##number";
    double numbers[max_numbers];
    const int count = read_numbers(now, numbers);
    if (!count) return;
    panel_edit_begin(page, label, count, numbers);
    double low = option->minimum, high = option->maximum;
    if (option->limits & EWA_OPTION_OR_ZERO) low = fmin(low, 0);
    // Beyond this a slider's step is too coarse for what people mean.
    const bool slides = isfinite(low) && isfinite(high) && high - low <= (is_integer(option) ? 64 : 20);
    char format[64];
    snprintf(format, sizeof format, "%s%s%s", is_integer(option) ? "%.0f" : "%.3g", option->unit ? " " : "",
             option->unit ? option->unit : "");
    bool changed;
    if (slides) {
        changed = ImGui::SliderScalarN(label, ImGuiDataType_Double, numbers, count, &low, &high, format);
    } else {
        const double size = fmax(fabs(numbers[0]), fabs(option->initial));
        const float speed = is_integer(option) ? (float)fmax(0.1, 0.01 * size)
                            : size > 0         ? (float)(0.01 * size)
                                               : 0.01f;
        changed =
            ImGui::DragScalarN(label, ImGuiDataType_Double, numbers, count, speed,
                               isfinite(low) ? &low : nullptr, isfinite(high) ? &high : nullptr, format);
    }
    double meant[max_numbers];
    for (int i = 0; i < count; i++) meant[i] = allowed(option, numbers[i]);
    if (panel_edit_end(page, label, count, numbers, changed, true)) say_numbers(page, option, count, meant);
}

/// Takes the default back.
void offer_default(const panel_page *page, const ewa_option *option) {
    if (!ImGui::BeginPopupContextItem("##default")) return;
    if (ImGui::MenuItem("Default")) {
        double numbers[max_numbers];
        const int count = option->count ? (int)option->count : 1;
        for (int i = 0; i < count && i < max_numbers; i++)
            numbers[i] = option->initials ? option->initials[i] : option->initial;
        if (option->type == EWA_OPTION_BOOL) {
            panel_say(page, "set %s %s", option->name, option->initial != 0 ? "on" : "off");
        } else if (option->type == EWA_OPTION_CHOICE) {
            const char *word = option->words;
            for (int i = 0; i < (int)option->initial && strchr(word, '|'); i++) word = strchr(word, '|') + 1;
            panel_say(page, "set %s %.*s", option->name, (int)strcspn(word, "|"), word);
        } else {
            say_numbers(page, option, count, numbers);
        }
    }
    ImGui::EndPopup();
}

void explain(const ewa_option *option) {
    if (!ImGui::IsItemHovered() || ImGui::IsItemActive()) return;
    char range[EWA_OPTION_TEXT_BYTES];
    ewa_option_range(option, range);
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(ImGui::GetFontSize() * 26);
    ImGui::TextUnformatted(option->help);
    ImGui::TextDisabled("%s%s%s", range, option->unit ? " " : "", option->unit ? option->unit : "");
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

void setting_row(panel_page *page, const ewa_option *option) {
    char now[EWA_OPTION_TEXT_BYTES], label[EWA_OPTION_TEXT_BYTES];
    if (option->count > max_numbers || !viewer_setting_get(page->viewer, option->name, now)) return;
    write_label(option, label);
    panel_label(page, label);
    if (option->type == EWA_OPTION_BOOL) {
        bool on = strcmp(now, "on") == 0;
        if (ImGui::Checkbox("##switch", &on)) panel_say(page, "set %s %s", option->name, on ? "on" : "off");
    } else if (option->words) {
        if (ImGui::BeginCombo("##word", now)) {
            char command[EWA_OPTION_TEXT_BYTES];
            snprintf(command, sizeof command, "set %s", option->name);
            panel_words(page, command, option->words, now, "");
            ImGui::EndCombo();
        }
    } else {
        choose_numbers(page, option, now);
    }
    explain(option);
    offer_default(page, option);
}

/// What is open, of which some settings alone are.
struct kinds_open {
    bool points, octrees, gaussians, volumes;
};

kinds_open find_kinds(const panel_page *page) {
    kinds_open kinds = {};
    viewer_item item;
    for (size_t i = 0; viewer_item_get(page->viewer, i, &item); i++) {
        kinds.octrees = kinds.octrees || item.octree;
        kinds.gaussians = kinds.gaussians || item.gaussians;
        kinds.volumes = kinds.volumes || item.volume;
        kinds.points = kinds.points || (!item.gaussians && !item.volume);
    }
    return kinds;
}

/// Whether a setting changes anything that is open: others would be in the way of those that do.
bool concerns(const kinds_open &kinds, const char *group, const ewa_option *option) {
    if (strcmp(group, "Octrees") == 0) return kinds.octrees;
    if (strcmp(group, "Gaussians") == 0) return kinds.gaussians;
    if (strcmp(group, "Splats") == 0) return kinds.points || kinds.gaussians;
    if (strcmp(group, "Photographs") == 0) return kinds.points;
    return strcmp(option->name, "volume_density") != 0 || kinds.volumes;
}

} // namespace

void panel_words(const panel_page *page, const char *command, const char *words, const char *now, const char *rest) {
    for (const char *at = words; *at;) {
        char word[EWA_OPTION_TEXT_BYTES];
        const size_t length = strcspn(at, "|");
        snprintf(word, sizeof word, "%.*s", (int)length, at);
        if (ImGui::MenuItem(word, nullptr, strcmp(word, now) == 0)) panel_say(page, "%s %s%s", command, word, rest);
        at += length + (at[length] == '|');
    }
}

void panel_settings(panel_page *page) {
    const char *group = nullptr, *before = nullptr;
    bool open = false;
    const ewa_option *option;
    const kinds_open kinds = find_kinds(page);
    for (uint32_t i = 0; (option = viewer_setting_at(page->viewer, i, &group)); i++) {
        if (!concerns(kinds, group, option)) continue;
        const bool first = !before;
        if (first || strcmp(group, before) != 0)
            open = ImGui::CollapsingHeader(group, first ? ImGuiTreeNodeFlags_DefaultOpen : 0);
        before = group;
        if (!open) continue;
        ImGui::PushID((int)i);
        setting_row(page, option);
        ImGui::PopID();
    }
}
