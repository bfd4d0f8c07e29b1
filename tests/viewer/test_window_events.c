// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// SDL's events as the viewer takes them: keyboards of other languages, wheels, fingers, what panels keep; and pictures as
// a window shows them.
#include "check.h"
#include "viewer/sdl/events_sdl.h"
#include "viewer/sdl/picture_sdl.h"

static events_window shown;

static int open_window(void **state) {
    if (SDL_Init(SDL_INIT_VIDEO) != 0) return -1;
    shown = (events_window){.window = SDL_CreateWindow("", 0, 0, 640, 480, 0), .zoom = 1, .scale = 1};
    return shown.window ? 0 : -1;
}

static int close_window(void **state) {
    SDL_DestroyWindow(shown.window);
    SDL_Quit();
    return 0;
}

/// The viewer's key of a key's character and place; 0: none.
static int key_of(SDL_Keycode code, SDL_Scancode place, uint16_t modifiers) {
    const SDL_Event event = {
        .key = {.type = SDL_KEYDOWN, .keysym = {.scancode = place, .sym = code, .mod = modifiers}}};
    viewer_event to;
    if (!events_translate(&shown, &event, 1, &to)) return 0;
    assert_int_equal(to.kind, VIEWER_KEY);
    return to.key;
}

TEST(keys_of_keyboards) {
    assert_int_equal(key_of('w', SDL_SCANCODE_W, 0), 'w');
    assert_int_equal(key_of('w', SDL_SCANCODE_Z, 0), 'w'); // AZERTY: what is written on it
    assert_int_equal(key_of('&', SDL_SCANCODE_1, 0), '1');
    assert_int_equal(key_of(0xE0, SDL_SCANCODE_0, 0), '0');
    assert_int_equal(key_of('-', SDL_SCANCODE_6, 0), '-');
    assert_int_equal(key_of(0x444, SDL_SCANCODE_A, 0), 'a'); // Cyrillic: its place
    assert_int_equal(key_of(0xE4, SDL_SCANCODE_APOSTROPHE, 0), 0);
    assert_int_equal(key_of(SDLK_KP_7, SDL_SCANCODE_KP_7, 0), '7');
    assert_int_equal(key_of(SDLK_KP_0, SDL_SCANCODE_KP_0, 0), '0');
    assert_int_equal(key_of(SDLK_KP_PLUS, SDL_SCANCODE_KP_PLUS, 0), '+');
    assert_int_equal(key_of(SDLK_F12, SDL_SCANCODE_F12, 0), VIEWER_KEY_F12);
    assert_int_equal(key_of(SDLK_KP_ENTER, SDL_SCANCODE_KP_ENTER, 0), VIEWER_KEY_ENTER);
    assert_int_equal(key_of(SDLK_TAB, SDL_SCANCODE_TAB, 0), '\t');
    assert_int_equal(key_of(SDLK_UP, SDL_SCANCODE_UP, 0), VIEWER_KEY_UP);
    assert_int_equal(key_of(SDLK_LSHIFT, SDL_SCANCODE_LSHIFT, 0), 0);
    assert_int_equal(key_of(SDLK_VOLUMEUP, SDL_SCANCODE_VOLUMEUP, 0), 0);
}

TEST(presses_of_panels_end_there) {
    viewer_event to;
    SDL_Event event = {.button = {.type = SDL_MOUSEBUTTONUP, .button = SDL_BUTTON_LEFT}};
    assert_false(events_translate(&shown, &event, 1, &to));
    event.button.type = SDL_MOUSEBUTTONDOWN;
    assert_true(events_translate(&shown, &event, 1, &to));
    // The pointer may leave the window while a button is held, the keyboard may not.
    const SDL_Event left = {.window = {.type = SDL_WINDOWEVENT, .event = SDL_WINDOWEVENT_LEAVE}};
    assert_false(events_translate(&shown, &left, 1, &to));
    const SDL_Event away = {.window = {.type = SDL_WINDOWEVENT, .event = SDL_WINDOWEVENT_FOCUS_LOST}};
    assert_true(events_translate(&shown, &away, 1, &to));
    assert_int_equal(to.kind, VIEWER_LEAVE);
    event.button.type = SDL_MOUSEBUTTONUP;
    assert_false(events_translate(&shown, &event, 1, &to));
    assert_true(events_translate(&shown, &left, 1, &to));
    SDL_Event key = {.key = {.type = SDL_KEYUP, .keysym = {.scancode = SDL_SCANCODE_S, .sym = 's'}}};
    assert_false(events_translate(&shown, &key, 1, &to));
    key.key.type = SDL_KEYDOWN;
    assert_true(events_translate(&shown, &key, 1, &to));
    key.key.repeat = 1;
    assert_false(events_translate(&shown, &key, 1, &to));
    key.key.repeat = 0;
    key.key.type = SDL_KEYUP;
    assert_true(events_translate(&shown, &key, 1, &to));
    assert_int_equal(to.kind, VIEWER_KEY_RELEASE);
    assert_int_equal(shown.key_count, 0);
}

TEST(wheels_and_fingers) {
    viewer_event to;
    SDL_Event event = {
        .wheel = {.type = SDL_MOUSEWHEEL, .preciseX = 0.25f, .preciseY = 0.1f, .mouseX = 300, .mouseY = 200}};
    shown.zoom = 2;
    assert_true(events_translate(&shown, &event, 1, &to));
    assert_true(to.amount == 0.1 && to.across == 0.25 && to.x == 150 && to.y == 100);
    event.wheel.direction = SDL_MOUSEWHEEL_FLIPPED;
    assert_true(events_translate(&shown, &event, 1, &to));
    assert_true(to.amount == -0.1 && to.across == -0.25);
    shown.zoom = 1;
    SDL_Event pinch = {
        .mgesture = {.type = SDL_MULTIGESTURE, .dDist = 0.05f, .x = 0.5f, .y = 0.25f, .numFingers = 2}};
    assert_true(events_translate(&shown, &pinch, 1, &to));
    assert_int_equal(to.kind, VIEWER_PINCH);
    assert_true(to.amount == 1.25 && to.x == 320 && to.y == 120);
    // The first of two fingers moves a mouse for SDL: not for the viewer.
    SDL_Event motion = {.motion = {.type = SDL_MOUSEMOTION, .which = SDL_TOUCH_MOUSEID, .x = 5}};
    assert_false(events_translate(&shown, &motion, 1, &to));
    const SDL_Event up = {.tfinger = {.type = SDL_FINGERUP}};
    assert_false(events_translate(&shown, &up, 1, &to));
    assert_true(events_translate(&shown, &motion, 1, &to));
    pinch.mgesture.dDist = 10;
    assert_false(events_translate(&shown, &pinch, 1, &to));
}

TEST(way_back) {
    static const viewer_event sent[] = {
        {.kind = VIEWER_MOVE, .x = 12, .y = 34, .modifiers = VIEWER_SHIFT},
        {.kind = VIEWER_PRESS, .x = 5, .y = 6, .button = VIEWER_RIGHT, .clicks = 2, .modifiers = VIEWER_CTRL},
        {.kind = VIEWER_RELEASE, .x = 5, .y = 6, .button = VIEWER_RIGHT, .clicks = 1},
        {.kind = VIEWER_WHEEL, .x = 7, .y = 8, .amount = -0.3, .modifiers = VIEWER_ALT},
        {.kind = VIEWER_PINCH, .x = 70, .y = 80, .amount = 1.15},
        {.kind = VIEWER_KEY, .key = 'c', .modifiers = VIEWER_CTRL | VIEWER_SHIFT},
        {.kind = VIEWER_KEY_RELEASE, .key = 'c'},
        {.kind = VIEWER_KEY, .key = VIEWER_KEY_F12},
        {.kind = VIEWER_KEY, .key = '+'},
        {.kind = VIEWER_KEY, .key = '['},
        {.kind = VIEWER_KEY, .key = '5'},
        {.kind = VIEWER_KEY, .key = VIEWER_KEY_ESCAPE},
        {.kind = VIEWER_KEY, .key = VIEWER_KEY_DELETE},
        {.kind = VIEWER_KEY, .key = VIEWER_KEY_DOWN},
        {.kind = VIEWER_DROP, .text = "a file.ply"},
        {.kind = VIEWER_LEAVE},
    };
    SDL_FlushEvents(SDL_FIRSTEVENT, SDL_LASTEVENT);
    for (size_t i = 0; i < SDL_arraysize(sent); i++) {
        SDL_Event event;
        viewer_event to;
        events_push(&shown, &sent[i]);
        assert_int_equal(SDL_PeepEvents(&event, 1, SDL_GETEVENT, SDL_FIRSTEVENT, SDL_LASTEVENT), 1);
        if (!events_translate(&shown, &event, 3, &to)) fail_msg("event %zu (%x) is lost", i, event.type);
        const bool same = to.kind == sent[i].kind && to.x == sent[i].x && to.y == sent[i].y &&
                          to.time_s == 3 && to.button == sent[i].button && to.clicks == sent[i].clicks &&
                          to.key == sent[i].key && to.modifiers == sent[i].modifiers &&
                          to.amount == sent[i].amount;
        if (!same)
            fail_msg("event %zu comes back as kind %d at %g %g key %d modifiers %u amount %.17g", i,
                     (int)to.kind, to.x, to.y, to.key, to.modifiers, to.amount);
        if (sent[i].text) assert_string_equal(to.text, sent[i].text);
        if (event.type == SDL_DROPFILE) SDL_free(event.drop.file);
    }
}

TEST(rows_of_pictures) {
    const uint8_t opaque[8] = {1, 2, 3, 255, 200, 100, 50, 255};
    uint32_t xrgb[6];
    picture_row(opaque, 2, 0, 4, xrgb);
    assert_int_equal(xrgb[0], 0x010203);
    assert_int_equal(xrgb[1], 0xC86432);
    // What is there keeps its colour; what is not shows the checkerboard; half of it is between.
    const uint8_t clear[24] = {1, 2, 3, 255, 9, 9, 9, 0, 0, 0, 0, 0, 255, 0, 0, 128, 0, 0, 0, 0, 0, 0, 0, 0};
    picture_row(clear, 6, 0, 2, xrgb);
    assert_int_equal(xrgb[0], 0x010203);
    assert_int_equal(xrgb[1], 0x606060);
    assert_int_equal(xrgb[2], 0x707070);
    assert_int_equal(xrgb[3], 0xB83838);
    assert_int_equal(xrgb[4], 0x606060);
    picture_row(clear, 6, 2, 2, xrgb);
    assert_int_equal(xrgb[1], 0x707070);
}

int main(void) { return RUN_TESTS(open_window, close_window); }
