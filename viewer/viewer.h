// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The viewer without a window: events with their times come in, pictures go out. Front ends (SDL, scripts)
// translate; what is loaded from files comes through services of the program.
//
// One thread calls in. Loading and drawing happen on threads of the viewer's own, or, where there are none, in viewer_frame(). Places are in points from
// the window's upper left corner, y down; a point is `scale` pixels.
#ifndef EWA_VIEWER_VIEWER_H
#define EWA_VIEWER_VIEWER_H

#include "ewa/ewa.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
    VIEWER_MAX_ITEMS = 64,
    VIEWER_NAME_BYTES = 256,
    VIEWER_TEXT_BYTES = 1024,
    VIEWER_PATH_BYTES = 4096,
    VIEWER_VOXEL_LEVELS = 3, ///< of volumes that are loaded: the second or the third is drawn while something moves
};

typedef struct viewer viewer;

/// Where the news of a load goes; any of its calls may come on any thread.
typedef struct viewer_news {
    void *user;
    /// The share of a stage that is done, in [0, 1]; false: give up.
    bool (*progress)(void *user, const char *stage, double fraction);
    /// A warning, a note or an error, without a line feed.
    void (*message)(void *user, ewa_severity severity, const char *text);
    /// Something to look at until the load is done, resident surfels: one reference, the receiver's. `as_points`: they
    /// have no size of their own.
    void (*preview)(void *user, ewa_asset *asset, bool as_points);
} viewer_news;

enum { VIEWER_MAX_CLASSES = 64 };

/// A row of a legend.
typedef struct viewer_class {
    double value;
    uint8_t srgb[3];
    char name[EWA_CLASS_NAME_BYTES]; ///< empty: the number
} viewer_class;

/// What is chosen of a cloud's surfels. Fill with viewer_coloring_init().
typedef struct viewer_coloring {
    char attribute[EWA_NAME_BYTES + 4]; ///< as of ewa_coloring; of what is shown, that which was chosen
    ewa_coloring_map map;
    bool length;          ///< filled in: the numbers are lengths of the world
    uint32_t class_count; ///< filled in: of `classes`; 0: a bar shows the colours
    viewer_class classes[VIEWER_MAX_CLASSES];
    bool percent[2];     ///< an end of `range` is a percentile, until it is filled in
    bool ranged;         ///< `range` is given; else it is filled with that of ewa_coloring
    double range[2];     ///< numbers of the first and the last colour
    bool tinted;         ///< all points have the one colour `tint`, when no attribute is chosen
    double tint[3];      ///< sRGB, [0, 1]
    double alpha;        ///< of all points, times their own; [0, 1]; default 1
    double radius_scale; ///< multiplies radii; (0, 100]; default 1
} viewer_coloring;

void viewer_coloring_init(viewer_coloring *coloring);

/// Photographs that points get colours from.
typedef struct viewer_photos {
    char cameras[VIEWER_PATH_BYTES]; ///< a file or folder of cameras (ewa_photo_list_load())
    char images[VIEWER_PATH_BYTES];  ///< folder of the photographs; empty: as the cameras say
    char masks[VIEWER_PATH_BYTES];   ///< folder of their masks; empty: there are none
    char to[VIEWER_PATH_BYTES];      ///< PLY file that is written
    ewa_photos_options options;
} viewer_photos;

/// What the program does for the viewer, on the threads that are named. Calls may be NULL where it says so.
typedef struct viewer_services {
    void *user;
    /// Returns the loading thread's context, whose news go to `news` from now on; NULL after telling why.
    ewa_context *(*context)(void *user, const viewer_news *news);
    /// Loads a file in it; on the loading thread. `said`: what a scene file and the user say of it. Returns false after telling
    /// `news` why.
    bool (*load)(void *user, const char *path, const ewa_asset_options *said, const viewer_news *news, ewa_asset **asset);
    /// Writes a file's points in the colours of photographs to another file; on the loading thread. Returns false after telling
    /// `news` why. May be NULL: there are no photographs.
    bool (*photos)(void *user, const char *path, const ewa_asset_options *said, const viewer_photos *photos, const viewer_news *news,
                   ewa_photos_report *report);
    /// Places a camera, whose picture's size is set, for a first look or for a named view ("front" ... "iso",
    /// NULL: the best) at all that is visible, with room for a colour bar if there is to be one; on the calling thread.
    bool (*place)(void *user, ewa_scene *scene, const char *view, bool color_bar, ewa_camera *camera, double up_world[3]);
    /// Says a line to standard output (picks, measures) or, for messages, to standard error.
    void (*say)(void *user, bool message, const char *text);
    /// Whether the program was asked to end, by a signal. May be NULL.
    bool (*interrupted)(void *user);
    /// Whether an event waits for which a whole picture is to be given up; of stepped viewers, while they draw. May be NULL.
    bool (*waiting)(void *user);
    /// A film at a path, or numbered pictures where it has a place for a number: begins, takes a frame (sRGB, straight alpha; it may
    /// be written over), ends it, whole or given up. Return false after saying why. On the calling thread. All may be NULL: there are no films.
    bool (*film_begin)(void *user, const char *path, uint32_t width_px, uint32_t height_px, bool opaque);
    bool (*film_put)(void *user, uint8_t *rgba8);
    bool (*film_end)(void *user, bool whole);
    /// The clipboard; both may be NULL: the viewer keeps a text of its own then.
    void (*clipboard_set)(void *user, const char *text);
    bool (*clipboard_get)(void *user, char *text, size_t text_bytes);
} viewer_services;

/// How things are shown at first. Fill with viewer_look_init().
typedef struct viewer_look {
    ewa_scene_options scene;         ///< its objects are borrowed as long as the viewer
    ewa_furniture_options furniture; ///< its texts are copied, but for the unit, which is borrowed; NULL: as the files say
    ewa_coloring coloring;           ///< of files that no scene file names; those without its attribute have their own colours
    const char *transfer;            ///< of volumes: a preset or a file, copied; NULL: automatic
} viewer_look;

void viewer_look_init(viewer_look *look);

/// How a viewer is made.
typedef struct viewer_options {
    viewer_services services;
    uint32_t thread_count;      ///< that draw; 0: one per processor
    ewa_executor executor;      ///< draws in their place; run = NULL: they do
    ewa_allocator allocator;    ///< of what draws; allocate = NULL: the library's
    uint32_t cpu_mask;          ///< EWA_CPU_*
    ewa_backend_kind backend;   ///< draws the pictures
    uint32_t width, height;     ///< of the window, points
    double scale;               ///< pixels per point, > 0
    const viewer_look *look;    ///< copied; NULL: defaults
    bool stepped;               ///< no threads: viewer_frame() does what there is to do, one thing at a time
    bool waits;                 ///< drawing and loading are waited for: no picture depends on time (scripts)
    const ewa_camera *camera;   ///< the first look; NULL: as the program frames it
} viewer_options;

/// Makes a viewer of nothing. The caller destroys it. Errors: EWA_ERROR_MEMORY, EWA_ERROR_ARGUMENT.
ewa_status viewer_create(const viewer_options *options, viewer **made);
/// Gives up everything for good, before the viewer is destroyed, which waits for its threads. Returns whether they rest.
bool viewer_stop(viewer *viewer);
void viewer_destroy(viewer **viewer);

typedef enum viewer_event_kind {
    VIEWER_MOVE,        ///< the pointer is at x, y
    VIEWER_PRESS,       ///< of `button`, the `clicks`th in a row
    VIEWER_RELEASE,     ///< of `button`
    VIEWER_WHEEL,       ///< by `amount` notches, away from the user is positive; `across`: sideways
    VIEWER_PINCH,       ///< two fingers: distances grow by the factor `amount`
    VIEWER_KEY,         ///< `key` went down
    VIEWER_KEY_RELEASE, ///< `key` went up
    VIEWER_DROP,        ///< of the file `text`
    VIEWER_RESIZE,      ///< the window has width x, height y points and `amount` pixels per point
    VIEWER_LEAVE,       ///< the pointer or the keyboard is elsewhere: nothing is held
} viewer_event_kind;

enum { VIEWER_LEFT = 1, VIEWER_MIDDLE = 2, VIEWER_RIGHT = 3 };
enum { VIEWER_SHIFT = 1, VIEWER_CTRL = 2, VIEWER_ALT = 4 };

/// Keys are their lower-case character, or one of these.
enum {
    VIEWER_KEY_ENTER = 13,
    VIEWER_KEY_ESCAPE = 27,
    VIEWER_KEY_DELETE = 127,
    VIEWER_KEY_F1 = 256, ///< F2 is the next, and so on
    VIEWER_KEY_F12 = VIEWER_KEY_F1 + 11,
    VIEWER_KEY_LEFT,
    VIEWER_KEY_RIGHT,
    VIEWER_KEY_UP,
    VIEWER_KEY_DOWN,
};

typedef struct viewer_event {
    viewer_event_kind kind;
    double time_s; ///< any clock that never runs backwards
    double x, y;   ///< points
    int button, clicks;
    uint32_t modifiers; ///< VIEWER_SHIFT ...
    int key;
    double amount, across;
    const char *text;
} viewer_event;

/// Whether a window may have so many points and pixels per point; VIEWER_RESIZE of another one changes nothing.
bool viewer_size_fits(double width, double height, double scale);

/// Takes an event. What goes wrong is said as a message, never returned.
void viewer_handle(viewer *viewer, const viewer_event *event);

/// A picture to show, of `width_px` x `height_px`: sRGB, straight alpha, valid until the next call.
typedef struct viewer_picture {
    const uint8_t *rgba8;
    uint32_t width_px, height_px; ///< half of the window's while something moves in large windows
    uint64_t number;              ///< another one for another picture; 0: none yet
    bool still;                   ///< all there is at full size: nothing will change until something is done
    uint32_t level;               ///< of the surfels drawn
    uint64_t splat_count;         ///< of what was drawn
    double drawn_s;               ///< what the drawing took
    double spare_s;               ///< when to ask again: 0: soon, for something moves or is under way
} viewer_picture;

/// Advances to a time and gives the newest picture.
void viewer_frame(viewer *viewer, double time_s, viewer_picture *picture);

/// Does what a line of the command language says (docs/viewer.md), such as "set kernel affine" or "view front".
/// Returns false after saying what is wrong.
bool viewer_do(viewer *viewer, const char *command);

/// Returns the ewa_named_view of a word, or -1.
int viewer_view_find(const char *word);

/// Opens a file, as "open" does; it may still be loading afterwards.
bool viewer_open(viewer *viewer, const char *path);

/// Path of what was opened last and is loaded; empty: nothing. `number`: how many there were.
const char *viewer_opened(const viewer *viewer, uint64_t *number);

/// The last line of results, such as a pick; empty: none.
const char *viewer_said(const viewer *viewer);

/// Whether something is being loaded or made a scene of.
bool viewer_is_loading(const viewer *viewer);

/// Whether nothing is loading, moving or waiting to be drawn.
bool viewer_is_still(const viewer *viewer);

/// What buttons of a toolbar show.
typedef enum viewer_icon {
    VIEWER_ICON_NONE,
    VIEWER_ICON_OPEN,
    VIEWER_ICON_PICTURE,
    VIEWER_ICON_PHOTOS,
    VIEWER_ICON_HOME,
    VIEWER_ICON_FRONT,
    VIEWER_ICON_RIGHT,
    VIEWER_ICON_TOP,
    VIEWER_ICON_CORNER,
    VIEWER_ICON_ORTHO,
    VIEWER_ICON_MEASURE,
    VIEWER_ICON_BOX,
    VIEWER_ICON_SLAB,
    VIEWER_ICON_PROFILE,
    VIEWER_ICON_RECTANGLE,
    VIEWER_ICON_LASSO,
    VIEWER_ICON_POLYGON,
    VIEWER_ICON_HIDE,
    VIEWER_ICON_KEEP,
    VIEWER_ICON_SHOW,
    VIEWER_ICON_MOVE,
    VIEWER_ICON_TURN,
    VIEWER_ICON_SCALE,
    VIEWER_ICON_HEIGHT,
    VIEWER_ICON_ANGLE,
    VIEWER_ICON_AREA,
    VIEWER_ICON_WAY,
    VIEWER_ICON_NOTE,
    VIEWER_ICON_KEYFRAME,
    VIEWER_ICON_FILM,
    VIEWER_ICON_CLEAR,
    VIEWER_ICON_HELP,
    VIEWER_ICON_UNDO,
    VIEWER_ICON_REDO,
    VIEWER_ICON_COUNT,
} viewer_icon;

/// Something that a person has done by a key, a row of a menu or a button.
typedef struct viewer_action {
    const char *menu;    ///< that it is a row of; NULL: another key of a command
    const char *label;   ///< of the row
    const char *command; ///< of the language
    const char *help;    ///< what it does
    int key;             ///< 0: none
    uint32_t modifiers;  ///< VIEWER_CTRL
    viewer_icon icon;    ///< of its button
} viewer_action;

/// NULL beyond the last.
const viewer_action *viewer_action_at(uint32_t index);
/// Whether a line stands before the row in its menu, and before its button: it is the first of a group.
bool viewer_action_begins_group(const viewer_action *action);
enum { VIEWER_KEYS_BYTES = 16 };
/// Writes the name of an action's key, such as "Ctrl C"; empty: none. `viewer` (may be NULL: as it is at first) knows which were chosen.
void viewer_action_keys(const viewer *viewer, const viewer_action *action, char text[VIEWER_KEYS_BYTES]);
/// Writes the command that gives an action the key that was chosen for it; false: none was.
bool viewer_action_choice(const viewer *viewer, const viewer_action *action, char text[VIEWER_TEXT_BYTES]);
/// Whether an action is a switch; `on`: how it is.
bool viewer_action_is_switch(const viewer *viewer, const viewer_action *action, bool *on);
/// Whether an action is a switch that is on, or a tool that the hand holds.
bool viewer_action_is_lit(const viewer *viewer, const viewer_action *action);
/// Does an action and notes what has become of it. Returns false after saying what is wrong.
bool viewer_act(viewer *viewer, const viewer_action *action);

/// A row of the help.
typedef struct viewer_help {
    const viewer_action *action; ///< NULL: a gesture of the pointer
    const char *heading;         ///< what rows that follow each other share
    const char *what;            ///< it does
    char keys[40];
} viewer_help;

/// Fills in a row of the help: gestures, then what has a key, menu by menu. False beyond the last.
bool viewer_help_at(const viewer *viewer, uint32_t index, viewer_help *row);

/// A setting for a panel, in groups that follow each other; NULL beyond the last.
const ewa_option *viewer_setting_at(const viewer *viewer, uint32_t index, const char **group);
/// Its value as "set NAME VALUE" takes it; false: there is no such setting.
bool viewer_setting_get(const viewer *viewer, const char *name, char text[EWA_OPTION_TEXT_BYTES]);
/// Sets it, as "set NAME VALUE" does, but not as a step that can be undone. Returns false after saying what is wrong.
bool viewer_setting_set(viewer *viewer, const char *name, const char *text);

/// What a volume's file holds, and what its values look like.
typedef struct viewer_values {
    ewa_volume_facts facts;
    ewa_transfer transfer;
} viewer_values;

/// What a panel says of one thing that was loaded.
typedef struct viewer_item {
    char name[VIEWER_NAME_BYTES];
    const char *path;
    bool visible, volume, gaussians, mesh, octree;
    uint64_t count; ///< of points, voxels or Gaussians
    double to_world[16]; ///< where its coordinates lie
    const viewer_values *values; ///< of a volume, borrowed until the next call; NULL: "transfer N edit" has them counted
    const char *colored;         ///< file of its colours from photographs; empty: its own; "changed": it is in no file of a person's
    const char *transfer;        ///< of a volume: a preset or a file; empty: automatic; "changed": it is in no file of a person's
    viewer_coloring coloring;
} viewer_item;

size_t viewer_item_count(const viewer *viewer);
/// False: there is no item `index`.
bool viewer_item_get(const viewer *viewer, size_t index, viewer_item *item);
/// Fills measurement `index` with its name and what it says, such as "12.5 m"; false: there is none.
bool viewer_measure_get(const viewer *viewer, size_t index, char name[VIEWER_NAME_BYTES], char value[VIEWER_NAME_BYTES]);
/// Name of an attribute that item `index` can be coloured by, such as "intensity" or "normal.x"; NULL beyond
/// the last.
const char *viewer_attribute_at(const viewer *viewer, size_t index, uint32_t attribute,
                                char name[EWA_NAME_BYTES + 4]);

/// Fills the place of a pick (0), or of the second one of a measure (1); false: there is none.
bool viewer_get_pick(const viewer *viewer, int index, double place_world[3]);

/// A file's name that a command goes without: the answer is the command with it, or "cancel".
typedef enum viewer_question {
    VIEWER_ASKS_NOTHING,
    VIEWER_ASKS_OPEN,
    VIEWER_ASKS_SAVE_SCENE,
    VIEWER_ASKS_PHOTOS,      ///< for cameras, of item `asked_item`
    VIEWER_ASKS_SAVE_PHOTOS, ///< for a file of its coloured points
    VIEWER_ASKS_CUT,         ///< for a file of what is selected
    VIEWER_ASKS_SAVE_MEASURES,
    VIEWER_ASKS_SAVE_PROFILE,
} viewer_question;

/// What goes on.
typedef struct viewer_state {
    uint32_t keyframes;
    double keyframe_at; ///< where on their way the last look was: keyframe 1 is 1
    bool previews;      ///< the camera travels through them
    char loading[VIEWER_NAME_BYTES]; ///< name of what loads, or of the film that is being made; empty: nothing
    char stage[64];
    double fraction;
    uint32_t queued;                 ///< loads that wait
    char message[VIEWER_TEXT_BYTES]; ///< the last thing that went wrong or is worth knowing; empty: none
    double message_s;                ///< when
    size_t asked_item; ///< of VIEWER_ASKS_PHOTOS and VIEWER_ASKS_SAVE_PHOTOS
    char note[VIEWER_TEXT_BYTES];    ///< what was done last, such as where a picture was saved; empty: nothing
    double note_s;                   ///< when
    viewer_question question;        ///< what the window is to ask for
    char picked[VIEWER_TEXT_BYTES];  ///< the last pick or measure, several lines
    double free_width;               ///< share of the picture's width at the bottom, from the left, where nothing stands over it
    uint32_t noted_count;            ///< notes that were clicked: the last measurement is one that waits for its text
    bool moving, help, panels, fullscreen; ///< which are to be shown
    const viewer_action *learns; ///< the next key becomes its key; NULL: none is waited for
    bool quit;                             ///< the user asked to end
    bool flying;                           ///< a key is held by which the camera flies: nothing comes to rest
} viewer_state;

void viewer_get_state(const viewer *viewer, viewer_state *state);

/// The camera of the window's full size.
void viewer_get_camera(const viewer *viewer, ewa_camera *camera);

#ifdef __cplusplus
}
#endif
#endif
