// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Dear ImGui in an SDL window: its events, its look, its triangles. What the panels say is laid out elsewhere.
#include "panel_parts.h"

#include <imgui_internal.h>
#include <math.h>
#include <new>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

namespace {

/// Points.
constexpr float font_points = 14;

/// Pixels per point, of glyphs that still fit a texture.
constexpr double largest_scale = 8;

/// Where the font is on Debian, Fedora and Arch; else Dear ImGui's own is taken.
const char *const font_paths[] = {
    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
    "/usr/share/fonts/TTF/DejaVuSans.ttf", "/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf",
    "/usr/share/fonts/truetype/noto/NotoSans-Regular.ttf"};

/// Latin, Greek, Cyrillic, and what units and numbers need.
const ImWchar glyph_ranges[] = {0x20,   0x24F,  0x370,  0x52F,  0x2010, 0x2026, 0x2070,
                                0x209F, 0x2190, 0x2193, 0x2200, 0x2265, 0};

/// Keys that edit text.
const struct {
    ImGuiKey key;
    SDL_Scancode code;
} edit_keys[] = {{ImGuiKey_Tab, SDL_SCANCODE_TAB},
                 {ImGuiKey_LeftArrow, SDL_SCANCODE_LEFT},
                 {ImGuiKey_RightArrow, SDL_SCANCODE_RIGHT},
                 {ImGuiKey_UpArrow, SDL_SCANCODE_UP},
                 {ImGuiKey_DownArrow, SDL_SCANCODE_DOWN},
                 {ImGuiKey_Home, SDL_SCANCODE_HOME},
                 {ImGuiKey_End, SDL_SCANCODE_END},
                 {ImGuiKey_Delete, SDL_SCANCODE_DELETE},
                 {ImGuiKey_Backspace, SDL_SCANCODE_BACKSPACE},
                 {ImGuiKey_Enter, SDL_SCANCODE_RETURN},
                 {ImGuiKey_KeyPadEnter, SDL_SCANCODE_KP_ENTER},
                 {ImGuiKey_Escape, SDL_SCANCODE_ESCAPE},
                 {ImGuiKey_Space, SDL_SCANCODE_SPACE},
                 {ImGuiKey_A, SDL_SCANCODE_A},
                 {ImGuiKey_C, SDL_SCANCODE_C},
                 {ImGuiKey_V, SDL_SCANCODE_V},
                 {ImGuiKey_X, SDL_SCANCODE_X},
                 {ImGuiKey_Y, SDL_SCANCODE_Y},
                 {ImGuiKey_Z, SDL_SCANCODE_Z}};

} // namespace

struct panel {
    SDL_Window *window;
    SDL_Renderer *renderer;
    ImGuiContext *context;
    SDL_Texture *glyphs;
    SDL_Cursor *cursors[ImGuiMouseCursor_COUNT]; ///< made when they are needed
    int cursor;                                  ///< that is shown
    char *pasted;                                ///< SDL's text of the clipboard
    panel_edit edit;
    panel_files files;
    bool escape; ///< the key is pressed
    panel_facts facts;
    double laid_out_s; ///< when the panels were laid out last
    double spare_s;
    float density; ///< pixels per unit of SDL
    bool pointed;  ///< the pointer has moved since
};

namespace {

const char *get_clipboard(void *user) {
    panel *p = static_cast<panel *>(user);
    SDL_free(p->pasted);
    p->pasted = SDL_GetClipboardText();
    return p->pasted;
}

void set_clipboard(void *, const char *text) { SDL_SetClipboardText(text); }

/// A quiet dark look: greys with one blue.
void choose_style(float unit) {
    ImGuiStyle style;
    ImGui::StyleColorsDark(&style);
    style.WindowPadding = ImVec2(10, 8);
    style.FramePadding = ImVec2(6, 3);
    style.ItemSpacing = ImVec2(6, 5);
    style.ItemInnerSpacing = ImVec2(6, 4);
    style.IndentSpacing = 12;
    style.ScrollbarSize = 11;
    style.GrabMinSize = 10;
    style.WindowMinSize = ImVec2(8, 8);
    style.WindowBorderSize = 0;
    style.PopupBorderSize = 1;
    style.FrameRounding = 2;
    style.GrabRounding = 2;
    style.ScrollbarRounding = 2;
    // Round windows are drawn triangle by triangle, which costs milliseconds without a GPU.
    style.WindowRounding = 0;
    style.PopupRounding = 0;
    style.AntiAliasedLines = false; // those that there are run along pixels
    ImVec4 *colors = style.Colors;
    const ImVec4 blue(0.29f, 0.49f, 0.69f, 1), bright(0.37f, 0.59f, 0.80f, 1), frame(0.20f, 0.21f, 0.23f, 1);
    colors[ImGuiCol_Text] = ImVec4(0.88f, 0.89f, 0.90f, 1);
    colors[ImGuiCol_TextDisabled] = ImVec4(0.58f, 0.60f, 0.62f, 1);
    colors[ImGuiCol_WindowBg] = ImVec4(0.11f, 0.115f, 0.125f, 0.93f);
    colors[ImGuiCol_PopupBg] = ImVec4(0.13f, 0.135f, 0.145f, 0.98f);
    colors[ImGuiCol_Border] = ImVec4(0.30f, 0.31f, 0.33f, 1);
    colors[ImGuiCol_FrameBg] = frame;
    colors[ImGuiCol_FrameBgHovered] = ImVec4(0.25f, 0.26f, 0.28f, 1);
    colors[ImGuiCol_FrameBgActive] = ImVec4(0.28f, 0.29f, 0.32f, 1);
    colors[ImGuiCol_CheckMark] = bright;
    colors[ImGuiCol_SliderGrab] = blue;
    colors[ImGuiCol_SliderGrabActive] = bright;
    colors[ImGuiCol_Button] = frame;
    colors[ImGuiCol_ButtonHovered] = ImVec4(0.27f, 0.28f, 0.31f, 1);
    colors[ImGuiCol_ButtonActive] = blue;
    colors[ImGuiCol_Header] = ImVec4(0.17f, 0.18f, 0.195f, 1);
    colors[ImGuiCol_HeaderHovered] = ImVec4(0.23f, 0.24f, 0.26f, 1);
    colors[ImGuiCol_HeaderActive] = blue;
    colors[ImGuiCol_Separator] = ImVec4(0.24f, 0.25f, 0.27f, 1);
    colors[ImGuiCol_PlotHistogram] = blue;
    colors[ImGuiCol_ScrollbarBg] = ImVec4(0, 0, 0, 0);
    colors[ImGuiCol_TextSelectedBg] = ImVec4(0.29f, 0.49f, 0.69f, 0.6f);
    style.ScaleAllSizes(unit);
    ImGui::GetStyle() = style;
}

/// Draws the glyphs anew, for a screen of `unit` pixels per point.
bool make_glyphs(panel *p, float unit) {
    ImGuiIO &io = ImGui::GetIO();
    io.Fonts->Clear();
    ImFontConfig config;
    const ImFont *font = nullptr;
    for (const char *path : font_paths)
        if (!font && access(path, R_OK) == 0)
            font =
                io.Fonts->AddFontFromFileTTF(path, floorf(font_points * unit + 0.5f), &config, glyph_ranges);
    if (!font) {
        // Its glyphs are drawn for 13 pixels, or whole multiples.
        config.SizePixels = 13 * fmaxf(1, floorf(unit + 0.25f));
        io.Fonts->AddFontDefault(&config);
    }
    unsigned char *rgba8 = nullptr;
    int width = 0, height = 0;
    io.Fonts->GetTexDataAsRGBA32(&rgba8, &width, &height);
    if (p->glyphs) SDL_DestroyTexture(p->glyphs);
    p->glyphs = nullptr;
    if (!rgba8) return false;
    p->glyphs =
        SDL_CreateTexture(p->renderer, SDL_PIXELFORMAT_RGBA32, SDL_TEXTUREACCESS_STATIC, width, height);
    if (!p->glyphs) return false;
    SDL_UpdateTexture(p->glyphs, nullptr, rgba8, 4 * width);
    SDL_SetTextureBlendMode(p->glyphs, SDL_BLENDMODE_BLEND);
    io.Fonts->SetTexID(p->glyphs);
    io.Fonts->ClearTexData();
    return true;
}

/// Shows the pointer that the panels ask for.
void show_cursor(panel *p) {
    static const SDL_SystemCursor shapes[ImGuiMouseCursor_COUNT] = {
        SDL_SYSTEM_CURSOR_ARROW,    SDL_SYSTEM_CURSOR_IBEAM,  SDL_SYSTEM_CURSOR_SIZEALL,
        SDL_SYSTEM_CURSOR_SIZENS,   SDL_SYSTEM_CURSOR_SIZEWE, SDL_SYSTEM_CURSOR_SIZENESW,
        SDL_SYSTEM_CURSOR_SIZENWSE, SDL_SYSTEM_CURSOR_HAND,   SDL_SYSTEM_CURSOR_NO};
    const int wanted = ImGui::GetMouseCursor();
    if (wanted == p->cursor || wanted < 0 || wanted >= ImGuiMouseCursor_COUNT) return;
    if (!p->cursors[wanted]) p->cursors[wanted] = SDL_CreateSystemCursor(shapes[wanted]);
    if (p->cursors[wanted]) SDL_SetCursor(p->cursors[wanted]);
    p->cursor = wanted;
}

/// Whether a list or a menu is open.
bool is_list_open() { return ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel); }

/// Lays the panels out; what hands do there is said to the viewer.
void lay_out(panel *p, viewer *shown) {
    ImGuiIO &io = ImGui::GetIO();
    int width, height, width_px = 0, height_px = 0;
    SDL_GetWindowSize(p->window, &width, &height);
    SDL_GetRendererOutputSize(p->renderer, &width_px, &height_px);
    p->density = width > 0 ? (float)width_px / (float)width : 1;
    io.DisplaySize = ImVec2((float)width_px, (float)height_px);
    const double passed_s = p->facts.now_s - p->laid_out_s;
    // Two layouts of one event are no time apart, which Dear ImGui does not take.
    io.DeltaTime = (float)fmin(fmax(passed_s, 1e-4), 1);
    p->laid_out_s = p->facts.now_s;
    p->pointed = false;
    // Arrows walk through what is open, and are the viewer's else.
    io.ConfigFlags = is_list_open() ? ImGuiConfigFlags_NavEnableKeyboard : ImGuiConfigFlags_None;
    ImGui::NewFrame();
    panel_page page = {};
    page.viewer = shown;
    page.facts = &p->facts;
    page.edit = &p->edit;
    page.files = &p->files;
    page.escape = p->escape;
    page.unit = (float)p->facts.scale;
    page.width = io.DisplaySize.x;
    page.height = io.DisplaySize.y;
    page.spare_s = (double)INFINITY;
    viewer_get_state(shown, &page.state);
    panel_insets insets;
    panel_measure(&page.state, page.width, page.height, page.unit, &insets);
    page.left = (float)insets.left_px;
    page.top = (float)insets.top_px;
    if (page.state.panels) {
        panel_bars(&page);
        panel_scene(&page);
    }
    panel_notes(&page);
    if (page.state.help) panel_help(&page);
    panel_question(&page);
    ImGui::Render();
    p->spare_s = io.WantTextInput ? fmin(page.spare_s, 0.25) : page.spare_s;
    show_cursor(p);
    if (io.WantTextInput != (SDL_IsTextInputActive() == SDL_TRUE)) {
        if (io.WantTextInput)
            SDL_StartTextInput();
        else
            SDL_StopTextInput();
    }
}

void draw_list(panel *p, const ImDrawList *list) {
    for (const ImDrawCmd &command : list->CmdBuffer) {
        if (command.UserCallback || !command.ElemCount) continue;
        const ImVec4 &box = command.ClipRect;
        const int left = (int)fmaxf(box.x, 0), top = (int)fmaxf(box.y, 0);
        const SDL_Rect clip = {left, top, (int)box.z - left, (int)box.w - top};
        if (clip.w <= 0 || clip.h <= 0) continue;
        SDL_RenderSetClipRect(p->renderer, &clip);
        const ImDrawVert *first = list->VtxBuffer.Data + command.VtxOffset;
        constexpr int stride = (int)sizeof *first;
        SDL_RenderGeometryRaw(p->renderer, static_cast<SDL_Texture *>(command.GetTexID()), &first->pos.x,
                              stride, reinterpret_cast<const SDL_Color *>(&first->col), stride, &first->uv.x,
                              stride, list->VtxBuffer.Size - (int)command.VtxOffset,
                              list->IdxBuffer.Data + command.IdxOffset, (int)command.ElemCount,
                              (int)sizeof(ImDrawIdx));
    }
}

/// A button counts where the pointer is now, and is not missed: each change has a layout of its own.
void press(panel *p, viewer *shown, const SDL_MouseButtonEvent &event) {
    ImGuiIO &io = ImGui::GetIO();
    const int button = event.button == SDL_BUTTON_LEFT ? 0 : event.button == SDL_BUTTON_RIGHT ? 1 : 2;
    if (event.button > SDL_BUTTON_RIGHT) return;
    io.MousePos = ImVec2((float)event.x * p->density, (float)event.y * p->density);
    lay_out(p, shown);
    io.MouseDown[button] = event.type == SDL_MOUSEBUTTONDOWN;
    lay_out(p, shown);
}

void press_key(const SDL_KeyboardEvent &event) {
    ImGuiIO &io = ImGui::GetIO();
    if (event.keysym.scancode < IM_ARRAYSIZE(io.KeysDown))
        io.KeysDown[event.keysym.scancode] = event.type == SDL_KEYDOWN;
    io.KeyShift = (event.keysym.mod & KMOD_SHIFT) != 0;
    io.KeyCtrl = (event.keysym.mod & KMOD_CTRL) != 0;
    io.KeyAlt = (event.keysym.mod & KMOD_ALT) != 0;
}

/// Closes them; false: none is.
bool close_list() {
    if (!is_list_open()) return false;
    ImGui::ClosePopupToLevel(0, true);
    return true;
}

/// Nothing is held, and the pointer is nowhere.
void let_go(ImGuiIO &io) {
    io.MousePos = ImVec2(-FLT_MAX, -FLT_MAX);
    for (bool &down : io.MouseDown) down = false;
    for (bool &down : io.KeysDown) down = false;
    io.KeyShift = io.KeyCtrl = io.KeyAlt = false;
}

} // namespace

panel *panel_create(SDL_Window *window, SDL_Renderer *renderer) {
    panel *p = new (std::nothrow) panel();
    if (!p) return nullptr;
    p->window = window;
    p->renderer = renderer;
    p->density = 1;
    p->cursor = ImGuiMouseCursor_Arrow;
    p->spare_s = (double)INFINITY;
    p->context = ImGui::CreateContext();
    ImGuiIO &io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.LogFilename = nullptr;
    io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset | ImGuiBackendFlags_HasMouseCursors;
    io.ConfigWindowsMoveFromTitleBarOnly = true;
    io.MouseDoubleClickTime = 0.5f; // as desktops have it
    io.ClipboardUserData = p;
    io.GetClipboardTextFn = get_clipboard;
    io.SetClipboardTextFn = set_clipboard;
    for (const auto &row : edit_keys) io.KeyMap[row.key] = row.code;
    SDL_StopTextInput();
    return p;
}

void panel_destroy(panel **destroyed) {
    panel *p = *destroyed;
    if (!p) return;
    ImGui::DestroyContext(p->context);
    if (p->glyphs) SDL_DestroyTexture(p->glyphs);
    for (SDL_Cursor *cursor : p->cursors)
        if (cursor) SDL_FreeCursor(cursor);
    SDL_free(p->pasted);
    panel_files_free(&p->files);
    delete p;
    *destroyed = nullptr;
}

bool panel_event(panel *p, viewer *shown, const SDL_Event *event, double now_s) {
    if (!p->glyphs) return false;
    // Else the rest before a first click would pass between it and a second one.
    p->facts.now_s = fmax(p->facts.now_s, now_s);
    ImGuiIO &io = ImGui::GetIO();
    switch (event->type) {
    case SDL_MOUSEMOTION:
        io.MousePos = ImVec2((float)event->motion.x * p->density, (float)event->motion.y * p->density);
        p->pointed = true;
        return io.WantCaptureMouse;
    case SDL_MOUSEBUTTONDOWN:
    case SDL_MOUSEBUTTONUP:
        press(p, shown, event->button);
        // The viewer gets the release of what was pressed over it: it knows.
        return event->type == SDL_MOUSEBUTTONDOWN && io.WantCaptureMouse;
    case SDL_MOUSEWHEEL:
        if (p->pointed) lay_out(p, shown);
        if (!io.WantCaptureMouse) return false;
        io.MouseWheel += event->wheel.preciseY;
        io.MouseWheelH += event->wheel.preciseX;
        return true;
    case SDL_KEYDOWN:
    case SDL_KEYUP: {
        const bool list_open = is_list_open();
        press_key(event->key);
        // Else it would be the viewer's, which forgets picks by it.
        if (event->type == SDL_KEYDOWN && event->key.keysym.sym == SDLK_ESCAPE && close_list()) return true;
        if (!io.WantCaptureKeyboard && !list_open && !p->files.shown) return false;
        p->escape = event->type == SDL_KEYDOWN && event->key.keysym.sym == SDLK_ESCAPE;
        lay_out(p, shown);
        p->escape = false;
        return event->type == SDL_KEYDOWN;
    }
    case SDL_TEXTINPUT:
        io.AddInputCharactersUTF8(event->text.text);
        return io.WantTextInput;
    case SDL_WINDOWEVENT:
        if (event->window.event == SDL_WINDOWEVENT_LEAVE && !ImGui::IsAnyMouseDown())
            io.MousePos = ImVec2(-FLT_MAX, -FLT_MAX);
        if (event->window.event == SDL_WINDOWEVENT_FOCUS_LOST) let_go(io);
        return false;
    default:
        return false;
    }
}

void panel_draw(panel *p, viewer *shown, const panel_facts *facts) {
    const double scale = fmin(facts->scale, largest_scale);
    if (!p->glyphs || p->facts.scale != scale) {
        choose_style((float)scale);
        if (!make_glyphs(p, (float)scale)) return;
    }
    p->facts = *facts;
    p->facts.scale = scale;
    lay_out(p, shown);
    const ImDrawData *data = ImGui::GetDrawData();
    for (int i = 0; i < data->CmdListsCount; i++) draw_list(p, data->CmdLists[i]);
    SDL_RenderSetClipRect(p->renderer, nullptr);
}

void panel_measure(const viewer_state *state, double width_px, double height_px, double scale, panel_insets *insets) {
    insets->left_px = insets->top_px = 0;
    if (!state->panels) return;
    scale = fmin(scale, largest_scale);
    insets->left_px = (int)fmin((double)panel_side_points * scale, 0.5 * width_px);
    insets->top_px = (int)fmin((double)(panel_menus_points + panel_buttons_points) * scale, 0.5 * height_px);
}

double panel_spare_s(const panel *p) { return p->spare_s; }

bool panel_say(const panel_page *page, const char *format, ...) {
    char command[VIEWER_PATH_BYTES];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(command, sizeof command, format, arguments);
    va_end(arguments);
    return viewer_do(page->viewer, command);
}

void panel_label(const panel_page *page, const char *text) {
    ImGui::AlignTextToFramePadding();
    ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
    ImGui::TextUnformatted(text);
    ImGui::PopStyleColor();
    ImGui::SameLine(118 * page->unit);
    ImGui::SetNextItemWidth(-FLT_MIN);
}

void panel_edit_begin(panel_page *page, const char *label, int count, double *numbers) {
    if (page->edit->id != ImGui::GetID(label)) return;
    for (int i = 0; i < count; i++) numbers[i] = page->edit->numbers[i];
}

bool panel_edit_end(panel_page *page, const char *label, int count, const double *numbers, bool changed,
                    bool live) {
    const ImGuiID id = ImGui::GetID(label);
    if (ImGui::IsItemActive()) {
        page->edit->id = id;
        for (int i = 0; i < count; i++) page->edit->numbers[i] = numbers[i];
    } else if (page->edit->id == id) {
        page->edit->id = 0;
    }
    return live ? changed : ImGui::IsItemDeactivatedAfterEdit();
}
