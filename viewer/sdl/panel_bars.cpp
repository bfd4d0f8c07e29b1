// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The bar of menus and the bar of buttons, both of the viewer's actions, and figures of the picture at its end.
#include "panel_parts.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

namespace {

/// Points: of a button's side and its icon's.
constexpr float button_points = 28, icon_points = 20;
/// Figures are shown anew so often.
constexpr double figures_step_s = 0.25;

/// What an action does, and its key.
void tell(const panel_page *page, const viewer_action *action) {
    if (!ImGui::IsItemHovered()) return;
    char keys[VIEWER_KEYS_BYTES];
    viewer_action_keys(page->viewer, action, keys);
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(24 * ImGui::GetFontSize());
    ImGui::Text("%s%s%s%s", action->label, keys[0] ? " (" : "", keys, keys[0] ? ")" : "");
    ImGui::TextDisabled("%s", action->help);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

/// The words of the setting that an action steps through; NULL: it is none of several words.
const char *words_of(const panel_page *page, const viewer_action *action, const char **name) {
    if (strncmp(action->command, "next ", 5) != 0) return nullptr;
    *name = action->command + 5;
    const char *group;
    const ewa_option *option;
    for (uint32_t i = 0; (option = viewer_setting_at(page->viewer, i, &group)); i++)
        if (strcmp(option->name, *name) == 0) return option->words;
    return nullptr;
}

void row(const panel_page *page, const viewer_action *action) {
    char keys[VIEWER_KEYS_BYTES], now[EWA_OPTION_TEXT_BYTES];
    viewer_action_keys(page->viewer, action, keys);
    const char *name, *words = words_of(page, action, &name);
    if (words && viewer_setting_get(page->viewer, name, now)) {
        if (ImGui::BeginMenu(action->label)) {
            char command[EWA_OPTION_TEXT_BYTES];
            snprintf(command, sizeof command, "set %s", name);
            panel_words(page, command, words, now, "");
            ImGui::EndMenu();
        }
        return;
    }
    const bool on = viewer_action_is_lit(page->viewer, action);
    if (ImGui::MenuItem(action->label, keys, on)) viewer_act(page->viewer, action);
    tell(page, action);
    const recent_files *recent = page->facts->recent;
    if (strcmp(action->command, "open") != 0 || !recent || !recent->count || !ImGui::BeginMenu("Open again")) return;
    for (uint32_t i = 0; i < recent->count; i++) panel_recent(page, i, true);
    ImGui::EndMenu();
}

void menus(const panel_page *page) {
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding,
                        ImVec2(8 * page->unit, 0.5f * (panel_menus_points * page->unit - ImGui::GetFontSize())));
    if (ImGui::BeginMainMenuBar()) {
        const viewer_action *action;
        for (uint32_t i = 0; (action = viewer_action_at(i));) {
            const char *menu = action->menu;
            const bool open = menu && ImGui::BeginMenu(menu);
            for (; action && (!action->menu || !menu || strcmp(action->menu, menu) == 0); action = viewer_action_at(++i)) {
                if (open && viewer_action_begins_group(action)) ImGui::Separator();
                if (open && action->label) row(page, action);
                if (!menu) break;
            }
            if (open) ImGui::EndMenu();
        }
        ImGui::EndMainMenuBar();
    }
    ImGui::PopStyleVar();
}

/// "1.0 M" of 1,000,000.
void write_short(uint64_t count, char text[32]) {
    const double number = (double)count;
    if (number >= 1e9)
        snprintf(text, 32, "%.2f G", number * 1e-9);
    else if (number >= 1e6)
        snprintf(text, 32, "%.2f M", number * 1e-6);
    else if (number >= 1e4)
        snprintf(text, 32, "%.0f k", number * 1e-3);
    else
        snprintf(text, 32, "%.0f", number);
}

/// What is drawn, and what it takes, at the right end of the bar where there is room from `left` on.
void figures(panel_page *page, float left) {
    uint64_t splats = 0, voxels = 0;
    for (size_t i = 0; i < viewer_item_count(page->viewer); i++) {
        viewer_item item;
        if (!viewer_item_get(page->viewer, i, &item) || !item.visible) continue;
        if (item.volume)
            voxels += item.count;
        else
            splats += item.count;
    }
    const panel_facts *facts = page->facts;
    char count[32], text[256] = "";
    size_t used = 0;
    if (!viewer_item_count(page->viewer)) return;
    if (splats || !voxels) {
        write_short(splats, count);
        used += (size_t)snprintf(text + used, sizeof text - used, "%s splats", count);
    }
    if (voxels) {
        write_short(voxels, count);
        used += (size_t)snprintf(text + used, sizeof text - used, "%s%s voxels", used ? "   " : "", count);
    }
    if (facts->picture.level) used += (size_t)snprintf(text + used, sizeof text - used, "   level %u", facts->picture.level);
    used += (size_t)snprintf(text + used, sizeof text - used, "   %.1f ms", 1e3 * facts->picture.drawn_s);
    if (facts->frames_per_s > 0) {
        snprintf(text + used, sizeof text - used, "   %.0f frames/s", facts->frames_per_s);
        page->spare_s = fmin(page->spare_s, figures_step_s);
    }
    // Where there is little room, the rate is what is left.
    const char *shown = text;
    float x = page->width - ImGui::CalcTextSize(shown).x - 2 * panel_margin(page);
    for (const char *next; x < left && (next = strstr(shown, "   ")); shown = next + 3)
        x = page->width - ImGui::CalcTextSize(next + 3).x - 2 * panel_margin(page);
    if (x < left) return;
    ImGui::SetCursorPos(ImVec2(floorf(x), floorf(0.5f * (panel_buttons_points * page->unit - ImGui::GetFontSize()))));
    ImGui::TextDisabled("%s", shown);
}

/// Returns whether the button was pressed.
bool button(const panel_page *page, const viewer_action *action) {
    const float side = button_points * page->unit, icon = icon_points * page->unit, pad = 0.5f * (side - icon);
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImGui::PushID(action->command);
    const bool pressed = ImGui::InvisibleButton("##button", ImVec2(side, side));
    ImGui::PopID();
    const bool on = viewer_action_is_lit(page->viewer, action);
    const bool lit = on || ImGui::IsItemHovered();
    if (lit)
        ImGui::GetWindowDrawList()->AddRectFilled(
            corner, ImVec2(corner.x + side, corner.y + side),
            ImGui::GetColorU32(on || ImGui::IsItemActive() ? ImGuiCol_ButtonActive : ImGuiCol_ButtonHovered));
    // Below the bar, whose other buttons it would hide.
    if (ImGui::IsItemHovered()) ImGui::SetNextWindowPos(ImVec2(corner.x, page->top));
    panel_icon(page, action->icon, ImVec2(corner.x + pad, corner.y + pad), icon, ImGui::GetColorU32(ImGuiCol_Text));
    tell(page, action);
    return pressed;
}

/// Buttons that have no room are rows of the menus all the same.
void buttons(panel_page *page) {
    const float side = button_points * page->unit, gap = 2 * page->unit, between = 4 * page->unit;
    const float pad = 0.5f * (panel_buttons_points * page->unit - side);
    ImGui::SetNextWindowPos(ImVec2(0, panel_menus_points * page->unit));
    ImGui::SetNextWindowSize(ImVec2(page->width, panel_buttons_points * page->unit));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(pad, pad));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
    ImGui::Begin("buttons", nullptr, panel_fixed_flags | ImGuiWindowFlags_NoScrollWithMouse);
    const viewer_action *action;
    const char *menu = nullptr;
    float x = pad;
    bool apart = false;
    for (uint32_t i = 0; (action = viewer_action_at(i)); i++) {
        apart = apart || viewer_action_begins_group(action);
        if (action->icon == VIEWER_ICON_NONE) continue;
        if (menu && (apart || strcmp(menu, action->menu) != 0)) {
            const float line = x + 0.5f * (between - gap), top = ImGui::GetWindowPos().y + pad;
            ImGui::GetWindowDrawList()->AddRectFilled(ImVec2(floorf(line), top + 4 * page->unit),
                                                      ImVec2(floorf(line) + fmaxf(1, floorf(page->unit)), top + side - 4 * page->unit),
                                                      ImGui::GetColorU32(ImGuiCol_Separator));
            x += between;
        }
        menu = action->menu;
        apart = false;
        if (x + side + pad > page->width) break;
        ImGui::SetCursorPos(ImVec2(x, pad));
        if (button(page, action)) viewer_act(page->viewer, action);
        x += side + gap;
    }
    figures(page, x + between);
    ImGui::End();
    ImGui::PopStyleVar(2);
}

} // namespace

void panel_bars(panel_page *page) {
    menus(page);
    buttons(page);
}
