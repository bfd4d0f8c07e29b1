// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The dialog for a file's name: folders, files of the kinds that are read, those of before, a name that is typed.
#include "panel_parts.h"

#include <dirent.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

namespace {

/// What names end with: files are known by what is in them, so that this is a help to the eye alone.
const struct {
    const char *label, *suffixes;
} kinds[] = {
    {"All that is read", nullptr},
    {"Points", ".ply|.las|.laz|.e57|.pcd|.ptx|.xyz|.txt|.asc|.csv|.pts|.tif|.tiff|ept.json|metadata.json"},
    {"Meshes", ".ply|.obj|.stl|.off|.gltf|.glb|.vtk|.vtp|.vtu|.vts|.vtr|.vtm|.pvtp|.pvtu|.pvts|.pvtr|.pvd"},
    {"Gaussians", ".ply|.splat|.spz|.ksplat|.sog|meta.json"},
    {"Volumes", ".nrrd|.nhdr|.mhd|.mha|.nii|.nii.gz|.vti|.vtk"},
    {"Scenes", ".json"},
    {"Cameras", ".json|.xml|cameras.bin|cameras.txt"},
    {"All files", ""},
};
constexpr int kind_count = IM_ARRAYSIZE(kinds), cameras_kind = 6;

/// What is asked for, in the order of viewer_question.
const struct {
    const char *title, *button, *suffixes, *name; ///< suffixes: of a file that is saved, the first where a name has none
} questions[] = {
    {"", "", nullptr, ""},
    {"Open", "Open", nullptr, ""},
    {"Save the scene as", "Save", ".json", "scene.json"},
    {"Cameras whose photographs give the points colours", "Colour", nullptr, ""},
    {"Save the coloured points as", "Save", ".ply", "coloured.ply"},
    {"Save the selection as", "Save", ".ply|.las|.laz|.e57|.pcd|.xyz|.txt|.pts|.csv|.splat|.spz|.sog|.glb|.nrrd", "selection"},
    {"Save the measurements as", "Save", ".csv", "measurements.csv"},
    {"Save the profile as", "Save", ".png|.jpg|.jpeg|.csv|.ply|.las|.laz|.pcd|.xyz|.txt|.pts", "profile.png"},
};

/// The command that a path answers.
bool say_answer(const panel_page *page, const char *path) {
    switch (page->state.question) {
    case VIEWER_ASKS_SAVE_SCENE:
        return panel_say(page, "scene save %s", path);
    case VIEWER_ASKS_PHOTOS:
        return panel_say(page, "photos %zu %s", page->state.asked_item, path);
    case VIEWER_ASKS_SAVE_PHOTOS:
        return panel_say(page, "photos %zu save %s", page->state.asked_item, path);
    case VIEWER_ASKS_CUT:
        return panel_say(page, "cut %s", path);
    case VIEWER_ASKS_SAVE_MEASURES:
        return panel_say(page, "measure save %s", path);
    case VIEWER_ASKS_SAVE_PROFILE:
        return panel_say(page, "profile save %s", path);
    default:
        return panel_say(page, "open %s", path);
    }
}

bool ends_with(const char *name, const char *suffixes) {
    const size_t length = strlen(name);
    while (*suffixes) {
        const size_t wanted = strcspn(suffixes, "|");
        if (length >= wanted && strncasecmp(name + length - wanted, suffixes, wanted) == 0) return true;
        suffixes += wanted + (suffixes[wanted] == '|');
    }
    return false;
}

bool is_of_kind(const char *name, int kind) {
    if (kind > 0) return !kinds[kind].suffixes[0] || ends_with(name, kinds[kind].suffixes);
    for (int k = 1; k < kind_count - 1; k++)
        if (ends_with(name, kinds[k].suffixes)) return true;
    return false;
}

int compare_entries(const void *one, const void *other) {
    const panel_entry *a = static_cast<const panel_entry *>(one), *b = static_cast<const panel_entry *>(other);
    if (a->folder != b->folder) return a->folder ? -1 : 1;
    const int order = strcasecmp(a->name, b->name);
    return order ? order : strcmp(a->name, b->name);
}

bool append(panel_files *files, const char *name, const struct stat *facts) {
    if (files->count == files->room) {
        const size_t room = files->room ? 2 * files->room : 64;
        void *larger = realloc(files->entries, room * sizeof *files->entries);
        if (!larger) return false;
        files->entries = static_cast<panel_entry *>(larger);
        files->room = room;
    }
    char *kept = strdup(name);
    if (!kept) return false;
    files->entries[files->count++] = {kept, S_ISDIR(facts->st_mode), (uint64_t)facts->st_size, facts->st_mtime};
    return true;
}

void empty(panel_files *files) {
    for (size_t i = 0; i < files->count; i++) free(files->entries[i].name);
    files->count = 0;
}

/// Reads a folder; what cannot be read is said in place of its files.
void go_to(panel_files *files, const char *folder) {
    char whole[VIEWER_PATH_BYTES];
    char *found = realpath(folder, nullptr);
    snprintf(whole, sizeof whole, "%s", found ? found : folder);
    free(found);
    memcpy(files->folder, whole, sizeof whole);
    empty(files);
    files->problem[0] = 0;
    DIR *list = opendir(files->folder);
    if (!list) {
        snprintf(files->problem, sizeof files->problem, "%s", strerror(errno));
        return;
    }
    for (const dirent *entry; (entry = readdir(list));) {
        char path[VIEWER_PATH_BYTES + 258];
        struct stat facts;
        if (entry->d_name[0] == '.') continue; // hidden, or the folder itself
        snprintf(path, sizeof path, "%s/%s", files->folder, entry->d_name);
        if (stat(path, &facts) != 0 || (!S_ISDIR(facts.st_mode) && !S_ISREG(facts.st_mode))) continue;
        if (!append(files, entry->d_name, &facts)) break;
    }
    closedir(list);
    qsort(files->entries, files->count, sizeof *files->entries, compare_entries);
}

void go_up(panel_files *files) {
    char *slash = strrchr(files->folder, '/');
    if (!slash || !files->folder[1]) return;
    char above[VIEWER_PATH_BYTES];
    snprintf(above, sizeof above, "%.*s", slash == files->folder ? 1 : (int)(slash - files->folder), files->folder);
    go_to(files, above);
}

/// The path that a typed name means: from the root, from home, of a server, or in the folder that is shown. False: it is
/// too long.
bool complete(const panel_files *files, const char *name, char path[VIEWER_PATH_BYTES]) {
    const char *home = getenv("HOME");
    int used;
    if (name[0] == '/' || strstr(name, "://"))
        used = snprintf(path, VIEWER_PATH_BYTES, "%s", name);
    else if (name[0] == '~' && (name[1] == '/' || !name[1]) && home)
        used = snprintf(path, VIEWER_PATH_BYTES, "%s%s", home, name + 1);
    else
        used = snprintf(path, VIEWER_PATH_BYTES, "%s%s%s", files->folder, files->folder[1] ? "/" : "", name);
    return used < VIEWER_PATH_BYTES;
}

/// Answers the question by a name; a folder is gone into, unless it is the answer as a `whole`.
void answer(const panel_page *page, const char *name, bool whole = false) {
    panel_files *files = page->files;
    char path[VIEWER_PATH_BYTES];
    struct stat facts;
    if (!name[0]) return;
    if (!complete(files, name, path)) {
        snprintf(files->problem, sizeof files->problem, "The name is too long.");
        return;
    }
    const bool there = stat(path, &facts) == 0;
    // Folders that are one thing, as octrees are, are named by a file in them.
    if (there && S_ISDIR(facts.st_mode) && !whole) {
        files->name[0] = 0;
        go_to(files, path);
        return;
    }
    const char *suffixes = questions[page->state.question].suffixes;
    const bool saves = suffixes != nullptr;
    if (!saves && !there && !strstr(path, "://")) {
        snprintf(files->problem, sizeof files->problem, "%s", strerror(errno));
        return;
    }
    const size_t length = strlen(path), first = saves ? strcspn(suffixes, "|") : 0;
    if (saves && !ends_with(path, suffixes) && length + first < sizeof path)
        snprintf(path + length, sizeof path - length, "%.*s", (int)first, suffixes);
    if (saves && stat(path, &facts) == 0 && !(files->confirmed[0] && strcmp(files->confirmed, path) == 0)) {
        memcpy(files->confirmed, path, sizeof path);
        snprintf(files->problem, sizeof files->problem, "It is there already: again to replace it.");
        return;
    }
    if (!say_answer(page, path)) return;
    files->shown = false;
}

void write_size(uint64_t bytes, char text[32]) {
    static const char *const units[] = {"B", "kB", "MB", "GB", "TB"};
    double size = (double)bytes;
    int unit = 0;
    for (; size >= 1000 && unit < 4; unit++) size /= 1000;
    snprintf(text, 32, size < 10 && unit ? "%.1f %s" : "%.0f %s", size, units[unit]);
}

void list(const panel_page *page) {
    panel_files *files = page->files;
    if (!ImGui::BeginTable("files", 3, ImGuiTableFlags_RowBg | ImGuiTableFlags_ScrollY, ImGui::GetContentRegionAvail())) return;
    ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthStretch);
    ImGui::TableSetupColumn("size", ImGuiTableColumnFlags_WidthFixed, 70 * page->unit);
    ImGui::TableSetupColumn("changed", ImGuiTableColumnFlags_WidthFixed, 120 * page->unit);
    char into[VIEWER_PATH_BYTES] = "", opened[VIEWER_PATH_BYTES] = "";
    const char *suffixes = questions[page->state.question].suffixes;
    bool listed = false;
    for (size_t i = 0; i < files->count; i++) {
        const panel_entry &entry = files->entries[i];
        if (!entry.folder && !(suffixes ? ends_with(entry.name, suffixes) : is_of_kind(entry.name, files->kind))) continue;
        listed = true;
        ImGui::TableNextColumn();
        char text[VIEWER_PATH_BYTES];
        snprintf(text, sizeof text, "%s%s", entry.name, entry.folder ? "/" : "");
        ImGui::PushID((int)i);
        const bool chosen = strcmp(entry.name, files->name) == 0;
        if (ImGui::Selectable(text, chosen, ImGuiSelectableFlags_SpanAllColumns | ImGuiSelectableFlags_AllowDoubleClick)) {
            if (entry.folder)
                snprintf(into, sizeof into, "%s", entry.name);
            else
                snprintf(files->name, sizeof files->name, "%s", entry.name);
            if (!entry.folder && ImGui::IsMouseDoubleClicked(0)) snprintf(opened, sizeof opened, "%s", entry.name);
        }
        ImGui::PopID();
        ImGui::TableNextColumn();
        if (!entry.folder) {
            write_size(entry.size_bytes, text);
            ImGui::TextDisabled("%s", text);
        }
        ImGui::TableNextColumn();
        struct tm day;
        if (localtime_r(&entry.changed_s, &day) && strftime(text, 32, "%Y-%m-%d %H:%M", &day)) ImGui::TextDisabled("%s", text);
    }
    if (!listed) {
        ImGui::TableNextColumn();
        ImGui::TextDisabled(suffixes ? "No such files here yet" : "Nothing of this kind here");
    }
    ImGui::EndTable();
    // After the list, which they change.
    if (into[0] || opened[0]) answer(page, into[0] ? into : opened);
}

/// Places to go, and the files of before.
void places(const panel_page *page) {
    panel_files *files = page->files;
    const char *home = getenv("HOME");
    char here[VIEWER_PATH_BYTES];
    if (home && ImGui::Selectable("Home")) go_to(files, home);
    if (getcwd(here, sizeof here) && ImGui::Selectable("Where ewa was started")) go_to(files, here);
    if (ImGui::Selectable("Root")) go_to(files, "/");
    const recent_files *recent = page->facts->recent;
    if (!recent || !recent->count || page->state.question != VIEWER_ASKS_OPEN) return;
    ImGui::Separator();
    ImGui::TextDisabled("Recent");
    for (uint32_t i = 0; i < recent->count; i++)
        if (panel_recent(page, i, false)) files->shown = false;
}

void begin(const panel_page *page) {
    panel_files *files = page->files;
    files->shown = files->focus = true;
    files->asked = page->state.question;
    files->name[0] = files->confirmed[0] = 0;
    go_to(files, files->folder[0] ? files->folder : ".");
    files->kind = files->asked == VIEWER_ASKS_PHOTOS ? cameras_kind : 0;
    snprintf(files->name, sizeof files->name, "%s", questions[files->asked].name);
}

} // namespace

bool panel_recent(const panel_page *page, uint32_t index, bool in_menu) {
    const char *path = page->facts->recent->paths[index], *slash = strrchr(path, '/');
    const char *name = slash && slash[1] ? slash + 1 : path;
    ImGui::PushID((int)index);
    const bool chosen = in_menu ? ImGui::MenuItem(name) : ImGui::Selectable(name);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", path);
    ImGui::PopID();
    return chosen && panel_say(page, "open %s", path);
}

void panel_question(panel_page *page) {
    panel_files *files = page->files;
    const viewer_question question = page->state.question;
    if (question == VIEWER_ASKS_NOTHING) {
        files->shown = false;
        return;
    }
    if (!files->shown || files->asked != question) begin(page);
    if (page->escape) {
        panel_say(page, "cancel");
        return;
    }
    const float margin = panel_margin(page);
    const ImVec2 size(fminf(760 * page->unit, page->width - 2 * margin), fminf(480 * page->unit, page->height - 2 * margin));
    ImGui::SetNextWindowPos(ImVec2(floorf(0.5f * (page->width - size.x)), floorf(0.5f * (page->height - size.y))));
    ImGui::SetNextWindowSize(size);
    ImGui::SetNextWindowBgAlpha(1);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 1);
    ImGui::Begin("question", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
    ImGui::TextUnformatted(questions[question].title);
    if (ImGui::Button("Up")) go_up(files);
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("%s", files->folder);
    const float below = 2 * ImGui::GetFrameHeightWithSpacing() + ImGui::GetStyle().ItemSpacing.y;
    ImGui::BeginChild("places", ImVec2(190 * page->unit, -below));
    places(page);
    ImGui::EndChild();
    ImGui::SameLine();
    ImGui::BeginChild("list", ImVec2(0, -below));
    list(page);
    ImGui::EndChild();
    const bool saves = questions[question].suffixes != nullptr;
    ImGui::SetNextItemWidth(saves ? -FLT_MIN : -170 * page->unit);
    if (files->focus) ImGui::SetKeyboardFocusHere();
    files->focus = false;
    bool done = ImGui::InputTextWithHint("##name", saves ? "name or path" : "name, path or https://", files->name, sizeof files->name,
                                         ImGuiInputTextFlags_EnterReturnsTrue);
    if (!saves) ImGui::SameLine();
    ImGui::SetNextItemWidth(-FLT_MIN);
    if (!saves && ImGui::BeginCombo("##kind", kinds[files->kind].label)) {
        for (int k = 0; k < kind_count; k++)
            if (ImGui::Selectable(kinds[k].label, k == files->kind)) files->kind = k;
        ImGui::EndCombo();
    }
    done = ImGui::Button(questions[question].button, ImVec2(80 * page->unit, 0)) || done;
    ImGui::SameLine();
    // A model of COLMAP is a folder.
    const bool whole = question == VIEWER_ASKS_PHOTOS && ImGui::Button("This folder", ImVec2(100 * page->unit, 0));
    if (question == VIEWER_ASKS_PHOTOS) ImGui::SameLine();
    if (ImGui::Button("Cancel", ImVec2(80 * page->unit, 0))) panel_say(page, "cancel");
    ImGui::SameLine();
    ImGui::TextDisabled("%s", files->problem);
    if (whole) {
        char folder[VIEWER_PATH_BYTES];
        memcpy(folder, files->folder, sizeof folder);
        answer(page, folder, true);
    } else if (done) {
        char name[VIEWER_PATH_BYTES];
        memcpy(name, files->name, sizeof name);
        answer(page, name);
    }
    ImGui::End();
    ImGui::PopStyleVar();
}

void panel_files_free(panel_files *files) {
    empty(files);
    free(files->entries);
}
