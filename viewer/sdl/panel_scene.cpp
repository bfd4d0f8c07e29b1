// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The panel of what is loaded: shown or not, name, colours, opacity; results and settings below.
#include "panel_parts.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

namespace {

/// Larger clouds take too long to be coloured again while a hand moves.
constexpr uint64_t live_count = 2000000;

/// Chooses the file's colours, one colour, or an attribute's.
void choose_colors(const panel_page *page, int index, const viewer_item *item) {
    const viewer_coloring &now = item->coloring;
    static const char own[] = "automatic", one[] = "one colour", none[] = "none";
    panel_label(page, "Colours");
    if (!ImGui::BeginCombo("##colors", now.attribute[0] ? now.attribute : now.tinted ? one : own, ImGuiComboFlags_HeightLarge)) return;
    if (ImGui::Selectable(own, !now.attribute[0] && !now.tinted)) {
        panel_say(page, "color %d auto", index);
        panel_say(page, "tint %d none", index);
    }
    if (ImGui::Selectable(none, strcmp(now.attribute, none) == 0)) {
        panel_say(page, "color %d none", index);
        panel_say(page, "tint %d none", index);
    }
    if (ImGui::Selectable(one, !now.attribute[0] && now.tinted)) {
        panel_say(page, "color %d auto", index);
        panel_say(page, "tint %d 0.8,0.8,0.8", index);
    }
    char name[EWA_NAME_BYTES + 4];
    for (uint32_t i = 0; viewer_attribute_at(page->viewer, (size_t)index, i, name); i++)
        if (ImGui::Selectable(name, strcmp(name, now.attribute) == 0))
            panel_say(page, "color %d %s", index, name);
    ImGui::EndCombo();
}

/// Selects the points of a class.
void choose_class(const panel_page *page, const viewer_coloring &now) {
    if (strcmp(now.attribute, "classification") != 0) return;
    panel_label(page, "Select");
    if (!ImGui::BeginCombo("##class", "points of a class", ImGuiComboFlags_HeightLarge)) return;
    for (uint32_t i = 0; i < now.class_count; i++) {
        char name[VIEWER_NAME_BYTES];
        snprintf(name, sizeof name, "%.0f %s", (double)now.classes[i].value, now.classes[i].name);
        if (ImGui::Selectable(name)) panel_say(page, "select class %.0f", (double)now.classes[i].value);
    }
    ImGui::EndCombo();
}

/// The map of an attribute's numbers to colours; where each number has a row of the legend, there is no range.
void choose_map(panel_page *page, int index, const viewer_item *item) {
    const viewer_coloring &now = item->coloring;
    const ewa_option *maps = ewa_option_find(&ewa_coloring_table, "map");
    ewa_coloring coloring;
    ewa_coloring_init(&coloring, sizeof coloring);
    coloring.map = now.map;
    char map[EWA_OPTION_TEXT_BYTES];
    ewa_option_get(maps, &coloring, map);
    panel_label(page, "Colour map");
    if (ImGui::BeginCombo("##map", map, ImGuiComboFlags_HeightLarge)) {
        char command[VIEWER_TEXT_BYTES], kept[64] = "";
        snprintf(command, sizeof command, "color %d %s", index, now.attribute);
        if (now.ranged) snprintf(kept, sizeof kept, " %.10g,%.10g", now.range[0], now.range[1]);
        panel_words(page, command, maps->words, map, kept);
        ImGui::EndCombo();
    }
    if (now.class_count) {
        choose_class(page, now);
        return;
    }
    panel_label(page, "Range");
    static const char label[] = "##range";
    double range[2] = {now.range[0], now.range[1]};
    panel_edit_begin(page, label, 2, range);
    const float width = ImGui::CalcTextSize("Auto").x + 2 * ImGui::GetStyle().FramePadding.x;
    ImGui::SetNextItemWidth(-width - ImGui::GetStyle().ItemInnerSpacing.x);
    const float extent = (float)fabs(range[1] - range[0]);
    // As many decimals as tell the ends from each other: of map coordinates four digits are the same.
    char format[16] = "%.4g";
    const double largest = fmax(fabs(range[0]), fabs(range[1]));
    if (extent > 0 && largest < 1e9 && largest > 1e3 * (double)extent)
        snprintf(format, sizeof format, "%%.%.0ff", fmin(fmax(1 - floor(log10((double)extent)), 0), 6));
    const bool changed = ImGui::DragScalarN(label, ImGuiDataType_Double, range, 2,
                                            extent > 0 ? 0.005f * extent : 0.01f, nullptr, nullptr, format);
    if (panel_edit_end(page, label, 2, range, changed, item->count <= live_count))
        panel_say(page, "color %d %s %s %.10g,%.10g", index, now.attribute, map, range[0], range[1]);
    ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
    if (ImGui::Button("Auto")) panel_say(page, "color %d %s %s", index, now.attribute, map);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("As the numbers are");
}

void choose_tint(panel_page *page, int index, const viewer_item *item) {
    panel_label(page, "Colour");
    static const char label[] = "##tint";
    double tint[3] = {item->coloring.tint[0], item->coloring.tint[1], item->coloring.tint[2]};
    panel_edit_begin(page, label, 3, tint);
    float shown[3] = {(float)tint[0], (float)tint[1], (float)tint[2]};
    const bool changed = ImGui::ColorEdit3(label, shown, ImGuiColorEditFlags_NoOptions);
    for (int c = 0; c < 3; c++) tint[c] = shown[c] < 0 ? 0 : shown[c] > 1 ? 1 : (double)shown[c];
    if (panel_edit_end(page, label, 3, tint, changed, item->count <= live_count))
        panel_say(page, "tint %d %.4f,%.4f,%.4f", index, tint[0], tint[1], tint[2]);
}

void choose_alpha(panel_page *page, int index, const viewer_item *item) {
    panel_label(page, "Opacity");
    static const char label[] = "##alpha";
    const double none = 0, full = 1;
    double alpha = item->coloring.alpha;
    panel_edit_begin(page, label, 1, &alpha);
    const bool changed = ImGui::SliderScalar(label, ImGuiDataType_Double, &alpha, &none, &full, "%.2f",
                                             ImGuiSliderFlags_AlwaysClamp);
    if (panel_edit_end(page, label, 1, &alpha, changed, item->count <= live_count))
        panel_say(page, "alpha %d %.4f", index, alpha);
}

void choose_look(panel_page *page, int index, const viewer_item *item) {
    choose_colors(page, index, item);
    if (!ewa_coloring_is_own(item->coloring.attribute))
        choose_map(page, index, item);
    else if (item->coloring.tinted)
        choose_tint(page, index, item);
    if (!item->gaussians) choose_alpha(page, index, item);
}

/// A row of numbers that are said when the hand lets go of them.
bool type_numbers(panel_page *page, const char *name, const char *label, int count, double *numbers, const char *format) {
    panel_label(page, name);
    panel_edit_begin(page, label, count, numbers);
    const bool changed = ImGui::InputScalarN(label, ImGuiDataType_Double, numbers, count, nullptr, nullptr, format);
    return panel_edit_end(page, label, count, numbers, changed, false);
}

/// Characters of a number that a third of a row has room for.
const int SHORT_NUMBER = 7;

/// Where an item lies: what its coordinates are moved by, then by how much it is to be turned about what is up, or resized.
void choose_place(panel_page *page, int index, const viewer_item *item) {
    const double *m = item->to_world;
    double moved[3] = {m[3], m[7], m[11]}, angle_deg = 0, factor = 1;
    // Numbers that three fields side by side would cut stand below each other.
    static const char *const labels[] = {"##moved x", "##moved y", "##moved z"};
    int longest = 0;
    for (double number : moved) {
        const int length = snprintf(nullptr, 0, "%.10g", number);
        if (length > longest) longest = length;
    }
    bool moves = false;
    if (longest <= SHORT_NUMBER) moves = type_numbers(page, "Moved by", "##moved", 3, moved, "%.10g");
    for (int c = 0; c < 3 && longest > SHORT_NUMBER; c++)
        if (type_numbers(page, c ? "" : "Moved by", labels[c], 1, &moved[c], "%.10g")) moves = true;
    if (moves)
        panel_say(page, "move %d %.17g,%.17g,%.17g", index, moved[0] - m[3], moved[1] - m[7], moved[2] - m[11]);
    if (type_numbers(page, "Turn by", "##turned", 1, &angle_deg, "%.6g deg")) panel_say(page, "rotate %d %.17g", index, angle_deg);
    if (type_numbers(page, "Resize by", "##resized", 1, &factor, "%.6g")) panel_say(page, "scale %d %.17g", index, factor);
}

/// A number with its thousands set apart.
void write_count(uint64_t count, char text[32]) {
    char digits[24];
    const int length = snprintf(digits, sizeof digits, "%llu", (unsigned long long)count);
    int used = 0;
    for (int i = 0; i < length; i++) {
        if (i && (length - i) % 3 == 0) text[used++] = ',';
        text[used++] = digits[i];
    }
    text[used] = 0;
}

/// Colours of photographs: found, saved, taken away.
void choose_photos(const panel_page *page, int index, const viewer_item *item) {
    panel_label(page, "Photographs");
    if (ImGui::Button("Cameras...")) panel_say(page, "photos %d", index);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Colours of photographs, whose cameras are chosen");
    if (!item->colored[0]) return;
    ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
    if (ImGui::Button("Save...")) panel_say(page, "photos %d save", index);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", strcmp(item->colored, "changed") == 0 ? "They are in no file yet" : item->colored);
    ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
    if (ImGui::Button("x")) panel_say(page, "photos %d off", index);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("The file's own colours again");
}

/// Returns false when the item was closed.
bool item_row(panel_page *page, int index, const viewer_item *item, bool open_first) {
    const float gap = ImGui::GetStyle().ItemInnerSpacing.x, side = ImGui::GetFrameHeight();
    bool visible = item->visible;
    if (ImGui::Checkbox("##shown", &visible)) panel_say(page, "show %d %s", index, visible ? "on" : "off");
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Show it");
    ImGui::SameLine(0, gap);
    bool *open = ImGui::GetStateStorage()->GetBoolRef(ImGui::GetID("open"), open_first);
    ImGui::PushStyleColor(ImGuiCol_Button, ImVec4(0, 0, 0, 0));
    if (ImGui::ArrowButton("##fold", *open ? ImGuiDir_Down : ImGuiDir_Right)) *open = !*open;
    ImGui::PopStyleColor();
    ImGui::SameLine(0, gap);
    char name[VIEWER_NAME_BYTES];
    memcpy(name, item->name, sizeof name);
    ImGui::SetNextItemWidth(-side - gap);
    ImGui::PushStyleColor(ImGuiCol_FrameBg, ImVec4(0, 0, 0, 0));
    ImGui::InputText("##name", name, sizeof name, ImGuiInputTextFlags_AutoSelectAll);
    ImGui::PopStyleColor();
    if (ImGui::IsItemDeactivatedAfterEdit() && name[0]) panel_say(page, "name %d %s", index, name);
    if (ImGui::IsItemHovered() && !ImGui::IsItemActive()) ImGui::SetTooltip("%s", item->path);
    ImGui::SameLine(0, gap);
    ImGui::PushStyleColor(ImGuiCol_Button, ImVec4(0, 0, 0, 0));
    const bool closed = ImGui::Button("x", ImVec2(side, 0));
    ImGui::PopStyleColor();
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Close it");
    if (closed) {
        panel_say(page, "close %d", index);
        return false;
    }
    if (!*open) return true;
    if (!item->count) {
        ImGui::TextDisabled("is being loaded");
        return true;
    }
    char count[32];
    write_count(item->count, count);
    if (ImGui::ArrowButton("##up", ImGuiDir_Up) && index > 0) panel_say(page, "order %d %d", index, index - 1);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Up in the list");
    ImGui::SameLine(0, gap);
    ImGui::TextDisabled("%s %s", count,
                        item->volume      ? "voxels"
                        : item->gaussians ? "Gaussians"
                        : item->mesh      ? "points on faces"
                                          : "points");
    if (!item->volume) choose_look(page, index, item);
    if (!item->volume && !item->gaussians) choose_photos(page, index, item);
    if (item->volume) panel_transfer(page, index, item);
    choose_place(page, index, item);
    return true;
}

void items(panel_page *page) {
    const size_t count = viewer_item_count(page->viewer);
    if (!count) ImGui::TextDisabled("Nothing is open.");
    for (size_t i = 0; i < count; i++) {
        viewer_item item;
        if (!viewer_item_get(page->viewer, i, &item)) break;
        ImGui::PushID((int)i);
        const bool kept = item_row(page, (int)i, &item, count == 1);
        ImGui::PopID();
        if (!kept) break;
    }
}

/// What was picked or measured last.
void picked(const panel_page *page) {
    if (!page->state.picked[0]) return;
    ImGui::Separator();
    ImGui::TextWrapped("%s", page->state.picked);
    if (ImGui::Button("Copy")) SDL_SetClipboardText(page->state.picked);
    ImGui::SameLine();
    if (ImGui::Button("Clear")) panel_say(page, "clear");
}

/// Measures and notes that stay, with names that can be changed.
void measures(panel_page *page) {
    char name[VIEWER_NAME_BYTES], value[VIEWER_NAME_BYTES];
    const float gap = ImGui::GetStyle().ItemInnerSpacing.x, side = ImGui::GetFrameHeight();
    for (size_t i = 0; viewer_measure_get(page->viewer, i, name, value); i++) {
        if (!i) ImGui::Separator();
        ImGui::PushID((int)(1000 + i));
        const float room = ImGui::GetContentRegionAvail().x - side - gap;
        ImGui::SetNextItemWidth(value[0] ? 0.5f * room : room);
        // A note that was just put down waits for its text.
        char none[VIEWER_NAME_BYTES];
        const bool last = !viewer_measure_get(page->viewer, i + 1, none, none);
        if (last && !value[0] && page->state.noted_count != page->edit->noted_count) ImGui::SetKeyboardFocusHere();
        if (last) page->edit->noted_count = page->state.noted_count;
        ImGui::InputText("##name", name, sizeof name, ImGuiInputTextFlags_AutoSelectAll);
        if (ImGui::IsItemDeactivatedAfterEdit() && name[0]) panel_say(page, "measure name %zu %s", i, name);
        ImGui::SameLine(0, gap);
        if (value[0]) ImGui::TextUnformatted(value);
        ImGui::SameLine(room + gap + ImGui::GetStyle().WindowPadding.x);
        const bool out = ImGui::Button("x", ImVec2(side, 0));
        ImGui::PopID();
        if (out) {
            panel_say(page, "measure delete %zu", i);
            break;
        }
    }
}

} // namespace

void panel_scene(panel_page *page) {
    ImGui::SetNextWindowPos(ImVec2(0, page->top));
    ImGui::SetNextWindowSize(ImVec2(page->left, page->height - page->top));
    ImGui::Begin("scene", nullptr, panel_fixed_flags & ~ImGuiWindowFlags_NoScrollbar);
    items(page);
    picked(page);
    measures(page);
    ImGui::Separator();
    panel_settings(page);
    ImGui::End();
}
