// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The transfer function of a volume over the histogram of its values: points are dragged, added by a double click, taken out by a
// right click, and coloured.
#include "panel_parts.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

namespace {

/// Points of the window.
constexpr float graph_points = 110, dot_points = 4, reach_points = 7;

/// Where a function's values and extinctions are in the window.
struct transfer_graph {
    ImVec2 corner, size;
    double low, high, max_extinction;
};

ImVec2 place_of(const transfer_graph &graph, double value, double extinction) {
    const double x = (value - graph.low) / (graph.high - graph.low), y = extinction / graph.max_extinction;
    return ImVec2(graph.corner.x + (float)fmin(fmax(x, 0), 1) * graph.size.x, graph.corner.y + (float)(1 - fmin(y, 1)) * graph.size.y);
}

ImU32 color_of(const ewa_transfer_point &point) {
    int c[3];
    for (int i = 0; i < 3; i++) c[i] = (int)lroundf(255 * ewa_srgb_from_linear(fminf(point.color[i], 1)));
    return IM_COL32(c[0], c[1], c[2], 255);
}

void say_point(const panel_page *page, int index, const char *which, double value, const float srgb[3], double extinction) {
    panel_say(page, "transfer %d point %s %.9g,%.4f,%.4f,%.4f,%.9g", index, which, value, (double)srgb[0], (double)srgb[1], (double)srgb[2], extinction);
}

void histogram(const transfer_graph &graph, const viewer_values *values) {
    ImDrawList *list = ImGui::GetWindowDrawList();
    double max_height = 1;
    for (const uint64_t count : values->facts.histogram) max_height = fmax(max_height, log1p((double)count));
    const float step = graph.size.x / IM_ARRAYSIZE(values->facts.histogram);
    for (int i = 0; i < IM_ARRAYSIZE(values->facts.histogram); i++) {
        const float high = graph.size.y * (float)(log1p((double)values->facts.histogram[i]) / max_height);
        const float x = floorf(graph.corner.x + step * (float)i), next = floorf(graph.corner.x + step * (float)(i + 1));
        const float bottom = graph.corner.y + graph.size.y;
        list->AddRectFilled(ImVec2(x, bottom - high), ImVec2(next, bottom), ImGui::GetColorU32(ImGuiCol_PlotHistogram, 0.5f));
    }
}

/// The point under the pointer; -1: none.
int find_point(const transfer_graph &graph, const ewa_transfer *transfer, float reach) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    int found = -1;
    for (uint32_t i = 0; i < transfer->point_count; i++) {
        const ImVec2 place = place_of(graph, transfer->points[i].value, (double)transfer->points[i].extinction);
        const float away = hypotf(place.x - mouse.x, place.y - mouse.y);
        if (away < reach) found = (int)i, reach = away;
    }
    return found;
}

/// Draws the function, a point of which is where a hand holds it.
void curve(const panel_page *page, const transfer_graph &graph, const ewa_transfer *transfer, int held, ImVec2 hand) {
    ImDrawList *list = ImGui::GetWindowDrawList();
    const ImDrawListFlags flags = list->Flags;
    list->Flags |= ImDrawListFlags_AntiAliasedLines;
    ImVec2 before;
    for (int i = 0; i < (int)transfer->point_count; i++) {
        const ewa_transfer_point &point = transfer->points[i];
        const ImVec2 place = i == held ? hand : place_of(graph, point.value, (double)point.extinction);
        if (i) list->AddLine(before, place, ImGui::GetColorU32(ImGuiCol_Text), 1.4f * page->unit);
        before = place;
    }
    list->Flags = flags;
    for (int i = 0; i < (int)transfer->point_count; i++) {
        const ewa_transfer_point &point = transfer->points[i];
        const ImVec2 place = i == held ? hand : place_of(graph, point.value, (double)point.extinction);
        list->AddCircleFilled(place, dot_points * page->unit, ImGui::GetColorU32(ImGuiCol_Text), 12);
        list->AddCircleFilled(place, (dot_points - 1) * page->unit, color_of(point), 12);
    }
}

void graph_of(panel_page *page, int index, const viewer_values *values) {
    const ewa_transfer *transfer = &values->transfer;
    ImGuiStorage *storage = ImGui::GetStateStorage();
    const ImGuiID held_id = ImGui::GetID("held"), chosen_id = ImGui::GetID("chosen");
    int held = storage->GetInt(held_id, -1), chosen = storage->GetInt(chosen_id, 0);
    transfer_graph graph = {ImGui::GetCursorScreenPos(), ImVec2(ImGui::GetContentRegionAvail().x, graph_points * page->unit),
                            values->facts.low, values->facts.high, 1e-30};
    if (!(graph.high > graph.low)) graph.high = graph.low + 1;
    for (uint32_t i = 0; i < transfer->point_count; i++) graph.max_extinction = fmax(graph.max_extinction, 1.1 * (double)transfer->points[i].extinction);
    ImGui::InvisibleButton("##graph", graph.size);
    const bool hovered = ImGui::IsItemHovered();
    if (chosen >= (int)transfer->point_count) chosen = 0;
    const ImVec2 corner = graph.corner, far_corner(corner.x + graph.size.x, corner.y + graph.size.y), mouse = ImGui::GetIO().MousePos;
    ImGui::GetWindowDrawList()->AddRectFilled(corner, far_corner, ImGui::GetColorU32(ImGuiCol_FrameBg));
    histogram(graph, values);
    const ImVec2 hand(fminf(fmaxf(mouse.x, corner.x), far_corner.x), fminf(fmaxf(mouse.y, corner.y), far_corner.y));
    const double value = graph.low + (graph.high - graph.low) * (double)((hand.x - corner.x) / graph.size.x);
    const double extinction = graph.max_extinction * (double)(1 - (hand.y - corner.y) / graph.size.y);
    curve(page, graph, transfer, held, hand);
    const int under = hovered ? find_point(graph, transfer, reach_points * page->unit) : -1;
    if (hovered) ImGui::SetTooltip("%.6g: %.4g\nDrag points; a double click adds one, a right click takes one out", value, extinction);
    float srgb[3];
    const ewa_transfer_point &color = transfer->points[held >= 0 && held < (int)transfer->point_count ? held : chosen];
    for (int c = 0; c < 3; c++) srgb[c] = ewa_srgb_from_linear(fminf(color.color[c], 1));
    char which[16];
    if (hovered && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left) && under < 0) {
        held = -1;
        say_point(page, index, "add", value, srgb, extinction);
    } else if (under >= 0 && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
        held = chosen = under;
    } else if (under >= 0 && ImGui::IsMouseClicked(ImGuiMouseButton_Right)) {
        panel_say(page, "transfer %d point delete %d", index, under);
    } else if (held >= 0 && !ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
        snprintf(which, sizeof which, "%d", held);
        const ImVec2 place = place_of(graph, color.value, (double)color.extinction);
        if (hypotf(place.x - hand.x, place.y - hand.y) > page->unit) say_point(page, index, which, value, srgb, extinction);
        held = -1;
    }
    storage->SetInt(held_id, held);
    storage->SetInt(chosen_id, chosen);
    const ewa_transfer_point &shown = transfer->points[chosen < (int)transfer->point_count ? chosen : 0];
    double edited[3];
    for (int c = 0; c < 3; c++) edited[c] = (double)ewa_srgb_from_linear(fminf(shown.color[c], 1));
    panel_label(page, "Its colour");
    static const char label[] = "##color";
    panel_edit_begin(page, label, 3, edited);
    for (int c = 0; c < 3; c++) srgb[c] = (float)edited[c];
    const bool changed = ImGui::ColorEdit3(label, srgb, ImGuiColorEditFlags_NoOptions);
    for (int c = 0; c < 3; c++) edited[c] = fmin(fmax((double)srgb[c], 0), 1), srgb[c] = (float)edited[c];
    snprintf(which, sizeof which, "%d", chosen);
    if (panel_edit_end(page, label, 3, edited, changed, false)) say_point(page, index, which, shown.value, srgb, (double)shown.extinction);
}

} // namespace

void panel_transfer(panel_page *page, int index, const viewer_item *item) {
    const char *word = item->transfer[0] ? item->transfer : "auto", *slash = strrchr(word, '/');
    panel_label(page, "Transfer");
    if (ImGui::BeginCombo("##transfer", slash ? slash + 1 : word)) {
        char command[32];
        snprintf(command, sizeof command, "transfer %d", index);
        const char *name = "auto";
        for (uint32_t i = 0; name; name = ewa_transfer_preset_name(i++, nullptr)) panel_words(page, command, name, word, "");
        ImGui::EndCombo();
    }
    if (item->values)
        graph_of(page, index, item->values);
    else if (ImGui::Button("Edit the function"))
        panel_say(page, "transfer %d edit", index);
}
