// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Icons of lines, on a square of 24 by 24: "M x y" begins a line, "L x y" goes on, "Z" closes it, "F" fills what the
// line went around, "O x y r" is a circle, "D x y r" a disc.
#include "panel_parts.h"

#include <math.h>
#include <stdlib.h>

namespace {

constexpr float grid = 24, stroke_points = 1.4f;

#define CUBE "M 12 3 L 20 7.5 L 20 16.5 L 12 21 L 4 16.5 L 4 7.5 Z M 4 7.5 L 12 12 L 20 7.5 M 12 12 L 12 21"

const char *const icons[] = {
    "",
    /* open */ "M 3 19 L 3 5 L 9 5 L 11 8 L 19 8 L 19 11 M 3 19 L 7 11 L 22 11 L 18 19 Z",
    /* picture */ "M 3 7 L 8 7 L 9.5 4.5 L 14.5 4.5 L 16 7 L 21 7 L 21 19 L 3 19 Z O 12 13 3.5",
    /* photos */ "M 3 4 L 15 4 L 15 13 L 3 13 Z M 5 11 L 8 7 L 10 10 L 12 8 L 13 11 M 12 15 L 15 15 M 9 18 L 18 18 M 12 21 L 21 21 D 19 6 1.6 D 19 11 1.6 "
                "D 8 15.5 1.4 D 20 15 1.4",
    /* home */ "M 3 12 L 12 4 L 21 12 M 6 9.5 L 6 20 L 18 20 L 18 9.5 M 10 20 L 10 14 L 14 14 L 14 20",
    /* front */ "M 4 7.5 L 12 12 L 12 21 L 4 16.5 F " CUBE,
    /* right */ "M 20 7.5 L 20 16.5 L 12 21 L 12 12 F " CUBE,
    /* top */ "M 12 3 L 20 7.5 L 12 12 L 4 7.5 F " CUBE,
    /* corner */ CUBE " D 12 12 3",
    /* ortho */ "M 3 3 L 21 3 L 21 21 L 3 21 Z M 9 9 L 15 9 L 15 15 L 9 15 Z M 3 3 L 9 9 M 21 3 L 15 9 M 21 21 L 15 15 "
                "M 3 21 L 9 15",
    /* measure */ "M 3 16 L 16 3 L 21 8 L 8 21 Z M 6 13 L 8 15 M 9 10 L 12 13 M 12 7 L 14 9 M 15 4 L 18 7",
    /* box */ "M 5 5 L 19 5 L 19 19 L 5 19 Z D 12 5 2.4 D 19 12 2.4 D 12 19 2.4 D 5 12 2.4",
    /* slab */ "M 4 8 L 10 4 L 10 16 L 4 20 Z M 14 8 L 20 4 L 20 16 L 14 20 Z",
    /* profile */ "M 3 4 L 3 20 L 21 20 M 5 16 L 9 13 L 12 14 L 16 7 L 20 9",
    /* rectangle */ "M 4 4 L 8 4 M 11 4 L 14 4 M 17 4 L 20 4 L 20 8 M 20 11 L 20 14 M 20 17 L 20 20 L 16 20 M 13 20 L 10 20 "
                    "M 7 20 L 4 20 L 4 16 M 4 13 L 4 10 M 4 7 L 4 4",
    /* lasso */ "M 12 4 L 17 5 L 20 8 L 19 12 L 15 15 L 9 15 L 5 12 L 4 8 L 7 5 Z M 9 15 L 7 18 L 9 21",
    /* polygon */ "M 5 9 L 12 3 L 20 8 L 17 20 L 7 18 Z D 5 9 1.8 D 12 3 1.8 D 20 8 1.8 D 17 20 1.8 D 7 18 1.8",
    /* hide */ "M 2 12 L 6 8 L 12 6 L 18 8 L 22 12 L 18 16 L 12 18 L 6 16 Z O 12 12 3 M 4 21 L 20 3",
    /* keep */ "M 4 8 L 4 4 L 8 4 M 16 4 L 20 4 L 20 8 M 20 16 L 20 20 L 16 20 M 8 20 L 4 20 L 4 16 D 12 12 4",
    /* show */ "M 2 12 L 6 8 L 12 6 L 18 8 L 22 12 L 18 16 L 12 18 L 6 16 Z O 12 12 3",
    /* move */ "M 12 2 L 12 22 M 2 12 L 22 12 M 9 5 L 12 2 L 15 5 M 9 19 L 12 22 L 15 19 M 5 9 L 2 12 L 5 15 M 19 9 L 22 12 L 19 15",
    /* turn */ "M 8.5 8.5 L 15.5 8.5 L 15.5 15.5 L 8.5 15.5 Z M 3.5 10 L 5 6.5 L 8 4 L 12 3 L 16 4 L 19 6.5 M 19.5 2.5 L 19 6.5 L 15 6.8 "
              "M 20.5 14 L 19 17.5 L 16 20 L 12 21 L 8 20 L 5 17.5 M 4.5 21.5 L 5 17.5 L 9 17.2",
    /* scale */ "M 3 21 L 3 13 L 11 13 L 11 21 Z M 13 11 L 21 3 M 15 3 L 21 3 L 21 9",
    /* height */ "M 4 20 L 20 20 M 4 4 L 20 4 M 12 6 L 12 18 M 9 9 L 12 6 L 15 9 M 9 15 L 12 18 L 15 15",
    /* angle */ "M 20 19 L 4 19 L 16 5 M 12 19 L 11.2 15.5 L 9 13.2",
    /* area */ "M 4 18 L 8 5 L 20 8 L 18 19 F M 4 18 L 8 5 L 20 8 L 18 19 Z",
    /* way */ "M 4 18 L 9 8 L 15 14 L 20 5 D 4 18 2 D 9 8 2 D 15 14 2 D 20 5 2",
    /* note */ "M 4 4 L 20 4 L 20 15 L 11 15 L 6 20 L 6 15 L 4 15 Z M 8 8 L 16 8 M 8 11 L 14 11",
    /* keyframe */ "M 12 4 L 20 12 L 12 20 L 4 12 Z M 12 9 L 12 15 M 9 12 L 15 12",
    /* film */ "M 3 5 L 21 5 L 21 19 L 3 19 Z M 7 5 L 7 19 M 17 5 L 17 19 M 3 9.7 L 7 9.7 M 3 14.3 L 7 14.3 M 17 9.7 L 21 9.7 M 17 14.3 L 21 14.3",
    /* clear */ "M 6 6 L 18 18 M 18 6 L 6 18",
    /* help */ "O 12 12 9 M 9.3 9.7 L 9.8 8.2 L 11 7.2 L 12.8 7.2 L 14.2 8.1 L 14.6 9.7 L 14 11.1 L 12.5 12.2 L 12 13.2 "
               "L 12 14.4 D 12 17 1",
    /* undo */ "M 9 4 L 4 9 L 9 14 M 4 9 L 15 9 L 18.5 10.5 L 20 14 L 18.5 17.5 L 15 19 L 9 19",
    /* redo */ "M 15 4 L 20 9 L 15 14 M 20 9 L 9 9 L 5.5 10.5 L 4 14 L 5.5 17.5 L 9 19 L 15 19",
};
static_assert(IM_ARRAYSIZE(icons) == VIEWER_ICON_COUNT, "each icon is drawn");

} // namespace

void panel_icon(const panel_page *page, viewer_icon icon, ImVec2 corner, float side, ImU32 color) {
    ImDrawList *list = ImGui::GetWindowDrawList();
    const ImDrawListFlags flags = list->Flags;
    list->Flags = flags | ImDrawListFlags_AntiAliasedLines | ImDrawListFlags_AntiAliasedFill;
    const float unit = side / grid, stroke = fmaxf(1, stroke_points * page->unit);
    const ImU32 faint = (color & ~IM_COL32_A_MASK) | (ImU32)0x90 << IM_COL32_A_SHIFT;
    const char *at = icons[icon];
    const auto number = [&at] {
        char *end;
        const float read = strtof(at, &end);
        at = end;
        return read;
    };
    const auto point = [&number, corner, unit] {
        const float x = number(), y = number();
        return ImVec2(corner.x + x * unit, corner.y + y * unit);
    };
    while (*at) {
        const char what = *at++;
        if (what == 'M') {
            list->PathStroke(color, 0, stroke);
            list->PathLineTo(point());
        } else if (what == 'L') {
            list->PathLineTo(point());
        } else if (what == 'Z') {
            list->PathStroke(color, ImDrawFlags_Closed, stroke);
        } else if (what == 'F') {
            list->PathFillConvex(faint);
        } else if (what == 'O' || what == 'D') {
            list->PathStroke(color, 0, stroke);
            const ImVec2 middle = point();
            const float radius = number() * unit;
            if (what == 'O')
                list->AddCircle(middle, radius, color, 0, stroke);
            else
                list->AddCircleFilled(middle, radius, color);
        }
    }
    list->PathStroke(color, 0, stroke);
    list->Flags = flags;
}
