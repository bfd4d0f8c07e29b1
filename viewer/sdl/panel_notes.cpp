// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What comes and goes: progress, messages, notes, help.
#include "panel_parts.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

namespace {

/// So long a message stays, and a note of what was done.
constexpr double message_stays_s = 10, note_stays_s = 4;
/// Progress is shown anew so often.
constexpr double progress_step_s = 0.1;

constexpr uint32_t max_help_lines = 256;

constexpr ImGuiWindowFlags note_flags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                                        ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoFocusOnAppearing |
                                        ImGuiWindowFlags_NoNav;

/// What the picture leaves free at the bottom, beside a graph.
float room_of(const panel_page *page) { return (float)page->state.free_width * (page->width - page->left); }

/// Its middle.
float middle_of(const panel_page *page) { return floorf(page->left + 0.5f * room_of(page)); }

void progress(panel_page *page, float *bottom) {
    const viewer_state &state = page->state;
    if (!state.loading[0]) return;
    page->spare_s = fmin(page->spare_s, progress_step_s);
    const float width = fminf(360 * page->unit, 0.8f * room_of(page));
    ImGui::SetNextWindowPos(ImVec2(middle_of(page), *bottom), 0, ImVec2(0.5f, 1));
    ImGui::SetNextWindowSize(ImVec2(width, 0));
    ImGui::Begin("progress", nullptr, note_flags & ~ImGuiWindowFlags_AlwaysAutoResize);
    ImGui::Text("%s", state.loading);
    if (state.queued) {
        ImGui::SameLine();
        ImGui::TextDisabled("and %u more", state.queued);
    }
    const float button = ImGui::CalcTextSize("Cancel").x + 2 * ImGui::GetStyle().FramePadding.x;
    const float fraction = (float)fmin(fmax(state.fraction, 0), 1);
    char stage[sizeof state.stage + 16];
    snprintf(stage, sizeof stage, "%s %.0f %%", state.stage, 100 * (double)fraction);
    ImGui::ProgressBar(fraction, ImVec2(-button - ImGui::GetStyle().ItemSpacing.x, 0), state.stage[0] ? stage : "...");
    ImGui::SameLine();
    if (ImGui::Button("Cancel")) panel_say(page, "cancel");
    *bottom = ImGui::GetWindowPos().y - panel_margin(page);
    ImGui::End();
}

/// The way through the keyframes: the camera travels it, or goes where a hand puts it.
void look_along(const panel_page *page) {
    if (ImGui::Button(page->state.previews ? "Stop" : "Play")) panel_say(page, "film preview");
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Travel through them");
    ImGui::SameLine();
    float at = (float)page->state.keyframe_at;
    ImGui::SetNextItemWidth(140 * page->unit);
    if (ImGui::SliderFloat("##at", &at, 0, (float)(page->state.keyframes - 1), "", ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoInput))
        panel_say(page, "keyframe go %.4f", (double)at);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("A place on their way");
    ImGui::SameLine();
}

/// The keyframes, at the bottom: a click goes there, a right click takes one out.
void keyframes(const panel_page *page, float *bottom) {
    if (!page->state.keyframes || !page->state.panels) return;
    ImGui::SetNextWindowPos(ImVec2(middle_of(page), *bottom), 0, ImVec2(0.5f, 1));
    ImGui::SetNextWindowSizeConstraints(ImVec2(0, 0), ImVec2(0.9f * room_of(page), page->height));
    ImGui::Begin("keyframes", nullptr, (note_flags & ~ImGuiWindowFlags_NoScrollbar) | ImGuiWindowFlags_HorizontalScrollbar);
    for (uint32_t i = 0; i < page->state.keyframes; i++) {
        char name[16];
        snprintf(name, sizeof name, "%u", i + 1);
        if (ImGui::Button(name)) panel_say(page, "keyframe go %u", i);
        const bool out = ImGui::IsItemClicked(ImGuiMouseButton_Right);
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("Go there; a right click takes it out");
        ImGui::SameLine();
        if (out) panel_say(page, "keyframe delete %u", i);
    }
    if (ImGui::Button("+")) panel_say(page, "keyframe add");
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Keep this view as the next keyframe");
    ImGui::SameLine();
    if (page->state.keyframes > 1) look_along(page);
    if (ImGui::Button("Film")) panel_say(page, "film");
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Make a film through them");
    *bottom = ImGui::GetWindowPos().y - panel_margin(page);
    ImGui::End();
}

/// A text that stays for a while, above what stands there.
void say(panel_page *page, const char *name, const char *text, double left_s, float *bottom) {
    if (!text[0] || left_s <= 0) return;
    page->spare_s = fmin(page->spare_s, left_s);
    const float width = fminf(520 * page->unit, 0.8f * room_of(page));
    ImGui::SetNextWindowPos(ImVec2(middle_of(page), *bottom), 0, ImVec2(0.5f, 1));
    ImGui::Begin(name, nullptr, note_flags | ImGuiWindowFlags_NoInputs);
    ImGui::PushTextWrapPos(width);
    ImGui::TextUnformatted(text);
    ImGui::PopTextWrapPos();
    *bottom = ImGui::GetWindowPos().y - panel_margin(page);
    ImGui::End();
}

/// An empty window says what to do with it.
void invitation(const panel_page *page) {
    if (viewer_item_count(page->viewer) || page->state.loading[0]) return;
    static const char text[] = "Drop a point cloud, a mesh, Gaussians or a volume here, or open one: Ctrl O";
    const ImVec2 size = ImGui::CalcTextSize(text);
    const ImVec2 place(floorf(middle_of(page) - 0.5f * size.x), floorf(0.5f * (page->top + page->height - size.y)));
    const ImVec2 pad(12 * page->unit, 8 * page->unit);
    ImDrawList *list = ImGui::GetBackgroundDrawList();
    list->AddRectFilled(ImVec2(place.x - pad.x, place.y - pad.y),
                        ImVec2(place.x + size.x + pad.x, place.y + size.y + pad.y),
                        ImGui::GetColorU32(ImGuiCol_WindowBg));
    list->AddText(place, ImGui::GetColorU32(ImGuiCol_Text), text);
}

/// The keys of a row, which a click has learned anew.
void help_keys(const panel_page *page, const viewer_help *row) {
    if (!row->action) {
        ImGui::Text("%s  ", row->keys);
        return;
    }
    const bool learns = page->state.learns == row->action;
    ImGui::PushID(row->action);
    if (ImGui::Selectable(learns ? "press a key" : row->keys[0] ? row->keys : "-", learns)) panel_say(page, "keys learn %s", row->action->command);
    ImGui::PopID();
}

} // namespace

void panel_notes(panel_page *page) {
    float bottom = page->height - panel_margin(page);
    // Help takes the middle down to here.
    if (page->state.help) return;
    keyframes(page, &bottom);
    progress(page, &bottom);
    const double now_s = page->facts->now_s;
    say(page, "message", page->state.message, message_stays_s - (now_s - page->state.message_s), &bottom);
    say(page, "note", page->state.note, note_stays_s - (now_s - page->state.note_s), &bottom);
    invitation(page);
}

void panel_help(panel_page *page) {
    ImGui::SetNextWindowPos(ImVec2(0.5f * page->width, 0.5f * page->height), 0, ImVec2(0.5f, 0.5f));
    const float margin = panel_margin(page);
    ImGui::SetNextWindowSizeConstraints(ImVec2(0, 0),
                                        ImVec2(page->width - 2 * margin, page->height - 2 * margin));
    ImGui::SetNextWindowBgAlpha(0.98f);
    ImGui::Begin("help", nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                     ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_HorizontalScrollbar);
    // Each group of rows has a heading: `lines` are rows, or headings, whose row is the one below.
    struct {
        uint32_t row;
        bool heading;
    } lines[max_help_lines];
    uint32_t count = 0;
    const char *heading = "";
    viewer_help row;
    for (uint32_t i = 0; viewer_help_at(page->viewer, i, &row) && count + 2 <= max_help_lines; i++) {
        if (strcmp(heading, row.heading) != 0) lines[count++] = {i, true};
        heading = row.heading;
        lines[count++] = {i, false};
    }
    // As many columns as are needed for the rows not to be higher than the window.
    const float row_px = ImGui::GetTextLineHeight() + 2 * ImGui::GetStyle().CellPadding.y;
    const float room = page->height - 2 * margin - 4 * ImGui::GetFrameHeight();
    const int fitting = room > row_px ? (int)(room / row_px) : 1;
    const int columns = (int)fminf(3, ceilf((float)count / (float)fitting)), high = ((int)count + columns - 1) / columns;
    if (ImGui::BeginTable("rows", 2 * columns, ImGuiTableFlags_SizingFixedFit)) {
        for (int i = 0; i < high * columns; i++) {
            const int wanted = i % columns * high + i / columns;
            ImGui::TableNextColumn();
            const bool given = wanted < (int)count && viewer_help_at(page->viewer, lines[wanted].row, &row);
            const bool heads = given && lines[wanted].heading;
            if (heads) ImGui::TextColored(ImGui::GetStyleColorVec4(ImGuiCol_CheckMark), "%s", row.heading);
            if (given && !heads) help_keys(page, &row);
            ImGui::TableNextColumn();
            if (given && !heads) ImGui::TextDisabled("%s     ", row.what);
        }
        ImGui::EndTable();
    }
    if (ImGui::Button("Close")) panel_say(page, "help off");
    ImGui::SameLine();
    ImGui::TextDisabled("or Escape. A click on a key has another one learned.");
    ImGui::End();
}
