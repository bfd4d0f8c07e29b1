// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Events of SDL as the viewer takes them, and back.
#include "events_sdl.h"

#include <math.h>
#include <string.h>

/// Half the distance of two fingers, as a share of the touch screen, where SDL does not tell it.
static const double usual_spread = 0.25;

/// SDL gives floats; the viewer gets the decimal that was meant, so that 0.1 of a notch is 0.1.
static double decimal(double number) { return nearbyint(number * 1e6) / 1e6; }

void events_measure(events_window *window, viewer_event *event) {
    int width, height, width_px, height_px;
    SDL_GetWindowSize(window->window, &width, &height);
    SDL_GetWindowSizeInPixels(window->window, &width_px, &height_px);
    if (width > 0) window->scale = window->zoom * width_px / width;
    *event = (viewer_event){.kind = VIEWER_RESIZE,
                            .x = (width_px - window->left_px) / window->scale,
                            .y = (height_px - window->top_px) / window->scale,
                            .amount = window->scale};
}

/// Puts a place of the window, in SDL's units, into the picture.
static void place(const events_window *window, double x, double y, viewer_event *to) {
    to->x = x / window->zoom - window->left_px / window->scale;
    to->y = y / window->zoom - window->top_px / window->scale;
}

static uint32_t modifiers_of(int state) {
    return (state & KMOD_SHIFT ? (uint32_t)VIEWER_SHIFT : 0u) |
           (state & KMOD_CTRL ? (uint32_t)VIEWER_CTRL : 0u) | (state & KMOD_ALT ? (uint32_t)VIEWER_ALT : 0u);
}

static int state_of(uint32_t modifiers) {
    return (modifiers & VIEWER_SHIFT ? KMOD_LSHIFT : 0) | (modifiers & VIEWER_CTRL ? KMOD_LCTRL : 0) |
           (modifiers & VIEWER_ALT ? KMOD_LALT : 0);
}

/// Keys that have no character, and those of the number pad that have one.
static const struct {
    SDL_Keycode code;
    int key;
} named_keys[] = {
    {SDLK_RETURN, VIEWER_KEY_ENTER},
    {SDLK_ESCAPE, VIEWER_KEY_ESCAPE},
    {SDLK_DELETE, VIEWER_KEY_DELETE},
    {SDLK_LEFT, VIEWER_KEY_LEFT},
    {SDLK_RIGHT, VIEWER_KEY_RIGHT},
    {SDLK_UP, VIEWER_KEY_UP},
    {SDLK_DOWN, VIEWER_KEY_DOWN},
    {SDLK_KP_ENTER, VIEWER_KEY_ENTER},
    {SDLK_KP_PLUS, '+'},
    {SDLK_KP_MINUS, '-'},
    {SDLK_KP_MULTIPLY, '*'},
    {SDLK_KP_DIVIDE, '/'},
    {SDLK_KP_PERIOD, '.'},
    {SDLK_KP_0, '0'},
};

/// The key as the viewer calls it: what a person reads on it, where that is a plain character. Rows of digits
/// that need Shift (AZERTY) count as digits, and keys of other alphabets as those of a US keyboard in their
/// place. 0: no key of the viewer's.
static int key_of(const SDL_Keysym *pressed) {
    const SDL_Keycode code = pressed->sym;
    for (size_t i = 0; i < SDL_arraysize(named_keys); i++)
        if (named_keys[i].code == code) return named_keys[i].key;
    if (code >= SDLK_F1 && code <= SDLK_F12) return VIEWER_KEY_F1 + (int)(code - SDLK_F1);
    if (code >= SDLK_KP_1 && code <= SDLK_KP_9) return '1' + (int)(code - SDLK_KP_1);
    const bool digit_row = pressed->scancode >= SDL_SCANCODE_1 && pressed->scancode <= SDL_SCANCODE_0;
    if (digit_row && code != '+' && code != '-')
        return pressed->scancode == SDL_SCANCODE_0 ? '0' : '1' + (int)(pressed->scancode - SDL_SCANCODE_1);
    if (code >= 'a' && code <= 'z') return (int)code;
    if (pressed->scancode >= SDL_SCANCODE_A && pressed->scancode <= SDL_SCANCODE_Z &&
        (code >= 128 || code == 0))
        return 'a' + (int)(pressed->scancode - SDL_SCANCODE_A);
    return code == SDLK_TAB || (code >= ' ' && code < 127) ? (int)code : 0;
}

static SDL_Keycode code_of(int key) {
    for (size_t i = 0; i < SDL_arraysize(named_keys); i++)
        if (named_keys[i].key == key && key > 126) return named_keys[i].code;
    if (key == VIEWER_KEY_ENTER || key == VIEWER_KEY_ESCAPE) return key;
    if (key >= VIEWER_KEY_F1 && key <= VIEWER_KEY_F12) return SDLK_F1 + (key - VIEWER_KEY_F1);
    return key;
}

/// The factor by which the distance of two fingers grew.
static double pinch_factor(const SDL_MultiGestureEvent *gesture) {
    double spread = usual_spread;
    const SDL_Finger *first = SDL_GetTouchFinger(gesture->touchId, 0);
    const SDL_Finger *second = first ? SDL_GetTouchFinger(gesture->touchId, 1) : NULL;
    if (second)
        spread = 0.5 * hypot((double)first->x - (double)second->x, (double)first->y - (double)second->y);
    const double before = spread - (double)gesture->dDist;
    // Fingers that SDL confuses with each other must not throw the camera away.
    return before > 0 ? decimal(fmin(fmax(spread / before, 0.5), 2.0)) : 1.0;
}

static bool translate_window(events_window *window, const SDL_WindowEvent *event, viewer_event *to) {
    switch (event->event) {
    case SDL_WINDOWEVENT_LEAVE:
        // A drag that leaves the window goes on, and so does a flight by keys.
        if (window->buttons || window->key_count) return false;
        break;
    case SDL_WINDOWEVENT_FOCUS_LOST:
        break;
    default:
        return false;
    }
    window->buttons = 0;
    window->key_count = 0;
    memset(window->keys, 0, sizeof window->keys);
    to->kind = VIEWER_LEAVE;
    return true;
}

static bool translate_button(events_window *window, const SDL_MouseButtonEvent *event, viewer_event *to) {
    if (event->button < VIEWER_LEFT || event->button > VIEWER_RIGHT) return false;
    const uint32_t bit = 1u << event->button;
    const bool press = event->type == SDL_MOUSEBUTTONDOWN;
    // What was pressed over a panel is released there.
    if (!press && !(window->buttons & bit)) return false;
    window->buttons = press ? window->buttons | bit : window->buttons & ~bit;
    to->kind = press ? VIEWER_PRESS : VIEWER_RELEASE;
    to->button = event->button;
    to->clicks = event->clicks;
    place(window, event->x, event->y, to);
    return true;
}

static bool translate_key(events_window *window, const SDL_KeyboardEvent *event, viewer_event *to) {
    const bool press = event->type == SDL_KEYDOWN;
    to->key = key_of(&event->keysym);
    if (!to->key || event->repeat || event->keysym.scancode >= SDL_NUM_SCANCODES) return false;
    bool *held = &window->keys[event->keysym.scancode];
    if (!press && !*held) return false; // it was pressed for a panel
    window->key_count += (press ? 1u : 0u) - (*held ? 1u : 0u);
    *held = press;
    to->kind = press ? VIEWER_KEY : VIEWER_KEY_RELEASE;
    to->modifiers = modifiers_of(event->keysym.mod);
    return true;
}

static bool translate_pinch(events_window *window, const SDL_MultiGestureEvent *event, viewer_event *to) {
    if (event->numFingers != 2) return false;
    int width, height;
    SDL_GetWindowSize(window->window, &width, &height);
    window->pinching = true;
    to->kind = VIEWER_PINCH;
    place(window, nearbyint((double)event->x * width), nearbyint((double)event->y * height), to);
    to->amount = pinch_factor(event);
    return to->amount != 1;
}

bool events_translate(events_window *window, const SDL_Event *event, double time_s, viewer_event *to) {
    *to = (viewer_event){.time_s = time_s, .modifiers = modifiers_of(SDL_GetModState())};
    switch (event->type) {
    case SDL_MOUSEMOTION:
        // SDL moves a mouse by the first finger; two fingers are a pinch alone.
        if (window->pinching && event->motion.which == SDL_TOUCH_MOUSEID) return false;
        to->kind = VIEWER_MOVE;
        place(window, event->motion.x, event->motion.y, to);
        return true;
    case SDL_MOUSEBUTTONDOWN:
    case SDL_MOUSEBUTTONUP:
        return translate_button(window, &event->button, to);
    case SDL_MOUSEWHEEL: {
        // Turned back where the desktop has turned it round: what counts is the finger.
        const double sign = event->wheel.direction == SDL_MOUSEWHEEL_FLIPPED ? -1 : 1;
        to->kind = VIEWER_WHEEL;
        place(window, event->wheel.mouseX, event->wheel.mouseY, to);
        to->amount = sign * decimal((double)event->wheel.preciseY);
        to->across = sign * decimal((double)event->wheel.preciseX);
        return true;
    }
    case SDL_MULTIGESTURE:
        return translate_pinch(window, &event->mgesture, to);
    case SDL_FINGERUP:
        window->pinching = false;
        return false;
    case SDL_KEYDOWN:
    case SDL_KEYUP:
        return translate_key(window, &event->key, to);
    case SDL_DROPFILE:
        to->kind = VIEWER_DROP;
        to->text = event->drop.file;
        return to->text != NULL;
    case SDL_WINDOWEVENT:
        return translate_window(window, &event->window, to);
    default:
        return false;
    }
}

static void push_resize(events_window *window, const viewer_event *event) {
    if (!viewer_size_fits(event->x, event->y, event->amount)) return;
    window->zoom = event->amount;
    SDL_SetWindowSize(window->window, (int)lround(event->x * event->amount),
                      (int)lround(event->y * event->amount));
    // SDL says nothing when the scale alone has changed.
    SDL_Event pushed = {.window = {.type = SDL_WINDOWEVENT,
                                   .windowID = SDL_GetWindowID(window->window),
                                   .event = SDL_WINDOWEVENT_SIZE_CHANGED}};
    SDL_PushEvent(&pushed);
}

static SDL_MouseButtonEvent button_event(const viewer_event *event, uint32_t id, int x, int y) {
    const bool pressed = event->kind == VIEWER_PRESS;
    return (SDL_MouseButtonEvent){pressed ? SDL_MOUSEBUTTONDOWN : SDL_MOUSEBUTTONUP,
                                  .windowID = id,
                                  .button = (uint8_t)event->button,
                                  .state = pressed ? SDL_PRESSED : SDL_RELEASED,
                                  .clicks = (uint8_t)event->clicks,
                                  .x = x,
                                  .y = y};
}

void events_push(events_window *window, const viewer_event *event) {
    const uint32_t id = SDL_GetWindowID(window->window);
    const int x = (int)lround(event->x * window->zoom), y = (int)lround(event->y * window->zoom);
    SDL_SetModState((SDL_Keymod)state_of(event->modifiers));
    SDL_Event pushed = {.type = SDL_FIRSTEVENT};
    switch (event->kind) {
    case VIEWER_MOVE:
        pushed.motion = (SDL_MouseMotionEvent){SDL_MOUSEMOTION, .windowID = id, .x = x, .y = y};
        break;
    case VIEWER_PRESS:
    case VIEWER_RELEASE:
        pushed.button = button_event(event, id, x, y);
        break;
    case VIEWER_WHEEL:
        pushed.wheel = (SDL_MouseWheelEvent){SDL_MOUSEWHEEL,
                                             .windowID = id,
                                             .x = (int)event->across,
                                             .y = (int)event->amount,
                                             .preciseX = (float)event->across,
                                             .preciseY = (float)event->amount,
                                             .mouseX = x,
                                             .mouseY = y};
        break;
    case VIEWER_PINCH: {
        int width, height;
        SDL_GetWindowSize(window->window, &width, &height);
        pushed.mgesture = (SDL_MultiGestureEvent){
            SDL_MULTIGESTURE, .dDist = (float)(usual_spread * (1 - 1 / event->amount)),
            .x = (float)x / (float)width, .y = (float)y / (float)height, .numFingers = 2};
        break;
    }
    case VIEWER_KEY:
    case VIEWER_KEY_RELEASE: {
        const SDL_Keycode code = code_of(event->key);
        pushed.key = (SDL_KeyboardEvent){event->kind == VIEWER_KEY ? SDL_KEYDOWN : SDL_KEYUP, .windowID = id,
                                         .state = event->kind == VIEWER_KEY ? SDL_PRESSED : SDL_RELEASED,
                                         .keysym = {.scancode = SDL_GetScancodeFromKey(code),
                                                    .sym = code,
                                                    .mod = (uint16_t)state_of(event->modifiers)}};
        break;
    }
    case VIEWER_DROP:
        pushed.drop = (SDL_DropEvent){SDL_DROPFILE, .file = SDL_strdup(event->text), .windowID = id};
        break;
    case VIEWER_RESIZE:
        push_resize(window, event);
        return;
    case VIEWER_LEAVE:
        pushed.window =
            (SDL_WindowEvent){SDL_WINDOWEVENT, .windowID = id, .event = SDL_WINDOWEVENT_FOCUS_LOST};
        break;
    }
    SDL_PushEvent(&pushed);
}
