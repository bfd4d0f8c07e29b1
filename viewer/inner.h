// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The viewer's state, which its files share.
#ifndef EWA_VIEWER_INNER_H
#define EWA_VIEWER_INNER_H

#include "loader.h"
#include "node_reader.h"
#include "painter.h"
#include "viewer.h"

/// Something that was opened.
typedef struct scene_item {
    uint64_t id;
    char path[VIEWER_PATH_BYTES], name[VIEWER_NAME_BYTES];
    ewa_asset *asset;   ///< NULL until it is loaded
    ewa_asset *preview; ///< shown until it is; NULL: none
    bool as_points;     ///< of the preview: drawn as discs of pixels
    bool loaded;        ///< it is in the scene
    bool named;         ///< a scene file names it:
    const ewa_scene_file *file; ///< which, borrowed; NULL: none does
    uint32_t entry;             ///< of its files
    bool visible;
    item_load load, shown_load;     ///< how it is to be loaded, and how it was
    viewer_values *values;          ///< of a volume; NULL: nobody has asked
    bool counts;                    ///< they are being counted
    bool photographed;              ///< its colours are being found in photographs
    uint32_t material;              ///< of all its points; EWA_MATERIAL_OWN: as each says
    viewer_coloring wish, coloring; ///< what is asked for, and what is shown
} scene_item;

typedef enum navigation { NAVIGATION_TURNTABLE, NAVIGATION_TRACKBALL, NAVIGATION_FLY } navigation;

/// The viewer's own settings; the renderer's and the furniture's are in their structs.
typedef struct viewer_settings {
    size_t struct_size;
    navigation navigation;
    double budget_ms;
    bool reduce, animate;
    double volume_density;
} viewer_settings;

extern const ewa_option_table viewer_settings_table;

/// What the left button does while it is held.
typedef enum drag_kind { DRAG_NONE, DRAG_ORBIT, DRAG_PAN, DRAG_ZOOM, DRAG_LOOK, DRAG_HANDLE, DRAG_TURN_BOX } drag_kind;

/// A point that was picked.
typedef struct viewer_pick {
    bool given;
    size_t item;
    uint64_t point;
    double place_world[3];
} viewer_pick;

/// What is cut away.
typedef struct viewer_cutaway {
    bool box, slab;
    double axes_world[9]; ///< of the box: unit axes, one after another
    double low_world[3], high_world[3]; ///< of the box, along its axes
    double slab_direction[3];   ///< unit, away from the eye when it was set
    double slab_near, slab_far; ///< along it, world units from the world's origin
} viewer_cutaway;

/// The profile along a line.
typedef struct viewer_profile {
    bool shown;
    double width_world;
    uint32_t corner_count;
    double corners_world[3 * EWA_PROFILE_CORNERS];
    ewa_profile of;                      ///< zeros: none
    double low_height, high_height;      ///< of its points
    uint8_t *graph;                      ///< as it was drawn last; NULL: not yet
    uint32_t graph_width_px, graph_height_px;
} viewer_profile;

enum { SELECT_CORNERS = 1024 }; ///< of an outline that is drawn, at most

/// What a hand draws around points.
typedef enum select_tool { SELECT_OFF, SELECT_RECTANGLE, SELECT_LASSO, SELECT_POLYGON } select_tool;

/// Points that are selected, and an outline that is being drawn.
typedef struct viewer_selection {
    select_tool tool;
    bool pressed; ///< the left button was pressed for the tool, and is held
    uint32_t corner_count;
    double corners[2 * SELECT_CORNERS]; ///< points of the window
    bool given;
    ewa_region region;
    uint64_t count;        ///< points; not of octrees
    uint64_t center_count; ///< Gaussians and voxels
    uint64_t place_count;
    double *places_world; ///< of some of them, to be marked
} viewer_selection;

/// How a hand changes where things lie.
typedef enum transform_tool { TRANSFORM_OFF, TRANSFORM_MOVE, TRANSFORM_TURN, TRANSFORM_SCALE } transform_tool;

/// What the hand holds of it.
typedef struct viewer_transform {
    transform_tool tool;
    bool held;
    uint64_t item;
    double x, y, depth; ///< where it was pressed: points of the window, camera-space z
    double from_world[3];
    double by[16]; ///< what has been done since
} viewer_transform;

enum { OWN_PATH_BYTES = 256 };

/// Files of transfer functions and colours that are not saved, until the end: steps back need them.
typedef struct own_files {
    char stem[OWN_PATH_BYTES - 32]; ///< what all their names begin with; "": nothing has been made
    int lock;                       ///< descriptor, where something has
    unsigned made_count;            ///< names that were used
    char **paths;
    size_t count;
} own_files;

/// Keyframes, and the film that is being made of them.
typedef struct viewer_film {
    uint32_t key_count;
    ewa_camera keys[EWA_MAX_KEYFRAMES];
    double at;     ///< of the look along the way: keyframe 1 is 1
    bool previews; ///< the camera that travels goes the way of the film
    bool active;
    char path[VIEWER_PATH_BYTES];
    uint32_t frame, count, width_px, height_px;
    ewa_ink ink;
    ewa_camera_path *way;
    uint8_t *rgba8; ///< a frame
} viewer_film;

enum { VIEWER_HISTORY = 64 };

typedef struct viewer_snapshot viewer_snapshot;

/// What was before changes, the newest last.
typedef struct viewer_history {
    uint32_t depth;          ///< of commands and gestures that are under way
    viewer_snapshot *before; ///< the first of them
    size_t undo_count, redo_count;
    viewer_snapshot *undo[VIEWER_HISTORY], *redo[VIEWER_HISTORY];
} viewer_history;

enum { VIEWER_MAX_ACTIONS = 96 };

/// A key that a person has chosen for an action.
typedef struct viewer_key {
    bool chosen;
    int key; ///< 0: none
    uint32_t modifiers;
} viewer_key;

struct viewer {
    viewer_services services;
    bool waits, stepped;
    loader *loader;
    painter *painter;
    paint_tools probe; ///< the calling thread's own
    char clipboard[VIEWER_TEXT_BYTES];

    scene_item items[VIEWER_MAX_ITEMS];
    size_t item_count;
    ewa_scene *scene; ///< of what is shown, in the probe's context, previews last
    uint32_t scene_count;
    uint64_t scene_items[VIEWER_MAX_ITEMS]; ///< of its first instances: the items' ids
    uint64_t next_id;
    char opened[VIEWER_PATH_BYTES]; ///< what was opened last
    uint64_t opened_count;
    ewa_scene_options base; ///< what the program and scene files say beside the settings
    ewa_coloring coloring;  ///< of files that no scene file names
    char transfer[VIEWER_PATH_BYTES]; ///< of volumes of which no scene file says one; empty: automatic
    ewa_scene_file **files; ///< scene files that were opened
    size_t file_count;
    bool has_scene_camera;
    ewa_camera scene_camera; ///< of the first scene file that has one

    viewer_settings settings;
    ewa_render_options render;
    ewa_furniture_options furniture;
    ewa_lod_options lod;
    octree_turns *turns;      ///< of who uses octrees
    node_reader *node_reader; ///< reads their nodes beside what is drawn; NULL: drawing does
    bool octrees, gaussian_levels, volumes; ///< some are visible
    const char *unit;         ///< of the world's lengths, as its files say; NULL: they do not
    uint32_t voxel_level;     ///< the coarsest at which one can tell what the volumes are
    char title[VIEWER_NAME_BYTES];

    double width, height, scale; ///< of the window: points, pixels per point
    ewa_camera camera;           ///< of the window's full size
    double up_world[3], pivot_world[3];
    double reach_world; ///< size of all that is shown
    bool placed;        ///< the camera is where the user or a file put it: loading does not move it

    double now_s, changed_s; ///< the last frame's or event's time; when the picture last changed
    bool animated;
    double animation_s; ///< when it began
    ewa_camera animation_from, animation_to;

    // The hand.
    double x, y, press_x, press_y;
    int button;
    drag_kind drag;
    bool moved; ///< since the button was pressed
    double drag_depth;
    int handle; ///< of the box: axis and 3 for its high side
    double wheel_s, wheel_world[3];
    bool wheel_held;   ///< `wheel_world` is what the wheel turns about
    viewer_key keys[VIEWER_MAX_ACTIONS]; ///< of the actions, in their order
    const viewer_action *learns;         ///< the next key becomes its key; NULL: none is waited for
    uint32_t fly_keys; ///< bits of the keys that are held, in the order of keys.c
    double fly_speed;  ///< sizes of the scene a second

    viewer_pick picks[2];
    bool measures; ///< a click measures from the one before, without Shift
    viewer_cutaway cutaway;
    viewer_profile profile;
    viewer_selection selection;
    viewer_transform transform;
    viewer_film film;
    ewa_photos_options photos;
    own_files own;
    ewa_measure measure_list[EWA_MAX_MEASURES];
    size_t measure_count;
    bool measures_kind;       ///< clicks add places to
    ewa_measure measuring; ///< what is under way
    viewer_history history;

    uint64_t revision, posted; ///< of what is to be drawn; the last one handed to the painter
    bool posted_whole;
    double whole_s;   ///< what the last whole picture took, without threads
    uint64_t refined; ///< the last picture that was drawn again for the nodes that had come, without a thread that reads
    double refined_s; ///< when that was last, with one
    uint32_t plain, slow_count, fast_count;          ///< of moving pictures: see adapt()
    uint64_t adapted;                                ///< the last picture that was looked at for it
    uint64_t marks, composed_marks, composed_ticket; ///< of what is drawn over the picture
    uint64_t composed_drawn;                         ///< which picture it was drawn over
    bool composed_complete; ///< no node is missing in it that will come
    uint8_t *composed;
    size_t composed_bytes;
    uint64_t number; ///< of composed pictures

    viewer_state state;
    char said[VIEWER_TEXT_BYTES]; ///< the last line for standard output
};

/// Something that is drawn has changed.
void viewer_change(viewer *v);
/// Something that is drawn over the picture has changed.
void viewer_mark(viewer *v);
/// Says a message, or a line of results.
void viewer_tell(viewer *v, const char *format, ...) __attribute__((format(printf, 2, 3)));
/// Notes what was done, for people alone.
void viewer_note(viewer *v, const char *format, ...) __attribute__((format(printf, 2, 3)));
void viewer_say(viewer *v, const char *format, ...) __attribute__((format(printf, 2, 3)));

// colorings.c
/// Sets a wish to what a scene file or the program says of colours.
void colorings_take(const ewa_coloring *coloring, viewer_coloring *wish);
/// Sets how an item is shown to what a scene file says; its colours stay where that says nothing of them.
void colorings_take_instance(const ewa_instance *instance, scene_item *item);
/// What of an item the scene shows.
ewa_instance colorings_instance(const scene_item *item);
/// Fills in what the colours of an item mean.
void colorings_take_legend(const ewa_legend *legend, viewer_coloring *coloring);
/// Whether an item is coloured as the program says for all, which may not fit it.
bool colorings_is_program(const viewer *v, const viewer_coloring *wish);

// items.c
bool items_open(viewer *v, const char *path);
bool items_close(viewer *v, size_t index);
/// Gives up all loads; what was to be loaded is gone at once. Returns whether there were any.
bool items_cancel(viewer *v);
/// Takes in what the loader has to report.
void items_update(viewer *v);
/// Has an item loaded again in another way. Returns false after saying why not.
bool items_reload(viewer *v, size_t index, const item_load *load);
/// Has the values of a volume counted, unless they are; also where its transfer function has changed: `again`.
bool items_count(viewer *v, size_t index, bool again);
/// Has colours of an item found in photographs. Returns false after saying why not.
bool items_photos(viewer *v, size_t index, const viewer_photos *photos);
/// Moves an item to another place in the list.
void items_move(viewer *v, size_t from, size_t to);
/// Orders a scene in which the item is as its wish says.
void items_recolor(viewer *v, size_t index);
/// Shows the items as they are now, when their scene is made.
void items_refresh(viewer *v);
/// Item of an instance of the scene; SIZE_MAX: none.
size_t items_find_instance(const viewer *v, uint32_t instance);
/// Fills in what is to be drawn; the camera and what goes with it are the caller's.
void items_gather(const viewer *v, paint_scene *scene);
/// Measures the box of all that is visible; false: there is nothing.
bool items_bounds(const viewer *v, double low_world[3], double high_world[3]);
/// Places the camera: a named view, or NULL for the best. `animate`: on the way there.
bool items_place(viewer *v, const char *view, bool animate);

// camera moves
void viewer_go(viewer *v, const ewa_camera *to);

// pick.c
/// Finds the surface behind a place of the window (points); false: there is nothing.
bool pick_surface(viewer *v, double x, double y, double reach, double place_world[3]);
/// Finds the item that is seen there, and the place; false: none is.
bool pick_item(viewer *v, double x, double y, double reach, size_t *index, double place_world[3]);
/// Picks the point there and says what it is; `second`: measures from the first.
bool pick_point(viewer *v, double x, double y, bool second);
void pick_clear(viewer *v);
/// Copies what was picked or measured last as text.
void pick_copy(viewer *v);
/// Writes a coordinate with the digits that it was stored with.
void pick_write_number(char text[40], double number, bool is_float);

// cutaway.c
/// Sets the planes of the renderer.
void cutaway_apply(const viewer *v, ewa_render_options *render);
bool cutaway_set(viewer *v, const char *what, const char *rest);
void cutaway_move_slab(viewer *v, double notches, bool thickness);
/// Makes planes that a scene file says, and that are those of a box or a slab, box and slab again.
void cutaway_take(viewer *v);
/// Turns the box about an axis through its middle.
void cutaway_turn(viewer *v, const double axis_world[3], double angle_deg);
/// Middle of a side of the box.
void cutaway_handle(const viewer *v, int handle, double place_world[3]);
/// The side under a place of the window; -1: none.
int cutaway_find_handle(const viewer *v, double x, double y);
void cutaway_drag(viewer *v, double x_px, double y_px);

// profile.c
bool profile_do(viewer *v, const char *rest);
/// Takes the profile along the line that is set.
bool profile_take(viewer *v);
/// Draws the graph over the lower part of a picture whose points are `scale` pixels.
/// The share of the picture's width that the graph leaves free at the bottom, on the left.
double profile_free_width(const viewer *v);
void profile_draw(viewer *v, const ewa_canvas *canvas, double scale);
void profile_free(viewer *v);

// select.c
bool select_command(viewer *v, const char *rest);
/// Whether the hand holds the tool of that name.
bool select_holds(const viewer *v, const char *word);
bool select_hide(viewer *v, const char *rest);
bool select_keep(viewer *v, const char *rest);
bool select_unhide(viewer *v, const char *rest);
void select_clear(viewer *v);
/// What a hand does while something is drawn around points; false: the event is not of it.
bool select_press(viewer *v, const viewer_event *event);
/// Closes the polygon that is being drawn; false: there is none.
bool select_end(viewer *v);
bool select_move(viewer *v, const viewer_event *event);
bool select_release(viewer *v, const viewer_event *event);

// cut.c
/// Makes a cloud of the selected points. The octrees' are read.
ewa_status cut_take_points(viewer *v, ewa_cloud **points);
/// Makes a cloud of the centres of the selected Gaussians and voxels, or of some of them, and counts them.
ewa_status cut_take_centers(viewer *v, uint64_t limit, ewa_cloud **centers, uint64_t *count);
bool select_cut(viewer *v, const char *rest);

// measures.c
bool measures_command(viewer *v, const char *rest);
/// Whether clicks measure what has that name.
bool measures_holds(const viewer *v, const char *word);
/// Adds what was clicked to the measurement that is under way; false: there is none.
bool measures_click(viewer *v, const viewer_event *event);
/// Ends the measurement that is under way, where it may have any number of places; false: there is none.
bool measures_end(viewer *v);
/// Writes a length (`power` 1) or an area (2) with its unit and so many digits.
void measures_write(const viewer *v, char *text, size_t text_bytes, double number, int digits, int power);
/// Writes name and value, for labels.
void measures_value(const viewer *v, const ewa_measure *measure, char text[VIEWER_NAME_BYTES]);

// history.c
bool history_undo(viewer *v, const char *rest);
bool history_redo(viewer *v, const char *rest);
/// Stand around what may change something; what has changed in between is one step.
void history_begin(viewer *v);
void history_end(viewer *v);
void history_free(viewer *v);

// transform.c: the commands "move", "rotate", "scale" and "transform"
bool transform_move(viewer *v, const char *rest);
bool transform_turn(viewer *v, const char *rest);
bool transform_scale(viewer *v, const char *rest);
bool transform_command(viewer *v, const char *rest);
/// The map that turns about an axis of any length through a place.
void transform_make_turn(const double axis_world[3], double angle_deg, const double place_world[3], double map[16]);
bool transform_holds(const viewer *v, const char *word);
/// The item that the hand holds, and its box before; false: it holds none.
bool transform_find(const viewer *v, size_t *index, double low_world[3], double high_world[3]);
/// What a hand does while it holds a tool; false: the event is not of it.
bool transform_press(viewer *v, const viewer_event *event);
bool transform_drag(viewer *v, const viewer_event *event);
bool transform_release(viewer *v, const viewer_event *event);

// transfers.c: the command "transfer"
bool transfers_command(viewer *v, const char *rest);
/// Whether the transfer function of an item was changed and is in no file of a person's.
bool transfers_is_changed(const viewer *v, size_t index);

// photos.c: the command "photos"
bool photos_do(viewer *v, const char *rest);
/// Whether an item has colours of photographs that are in no file of a person's.
bool photos_is_changed(const viewer *v, size_t index);
/// Shows an item in the colours that were found.
void photos_take(viewer *v, size_t index, const viewer_photos *photos, const ewa_photos_report *found);

// own_files.c
/// Makes a file of our own, which stays until the viewer goes: its name has a word and ends with a suffix. False after saying why not.
bool own_files_make(viewer *v, const char *word, const char *suffix, char path[OWN_PATH_BYTES]);
/// Takes one away before.
void own_files_drop(viewer *v, const char *path);
bool own_files_has(const viewer *v, const char *path);
/// Takes all away; nothing is made after it.
void own_files_remove(viewer *v);
/// Takes away what viewers have left that were killed.
void own_files_clean(void);

// film.c: the commands "keyframe" and "film"
bool film_keyframe(viewer *v, const char *rest);
bool film_command(viewer *v, const char *rest);
/// Draws the next frame of the film that is being made.
void film_step(viewer *v);
/// Looks from a place on the way, of which keyframe 1 is 1. Returns whether the way goes on.
bool film_look(viewer *v, double at);
/// Gives the film up.
void film_free(viewer *v);

// settings.c
void settings_init(viewer *v);

// actions.c
/// The key of an action, as a person has chosen it.
viewer_key actions_key(const viewer *v, const viewer_action *action);
/// Gives an action a key, which others lose.
void actions_set_key(viewer *v, const viewer_action *action, int key, uint32_t modifiers);
/// The command "keys".
bool actions_keys(viewer *v, const char *rest);

// commands.c
/// Takes the number of an item off what a command says.
bool commands_take_item(viewer *v, const char *command, const char **rest, size_t *index);
/// Writes what an action has set, such as "affine" of "next kernel" or "on" of "box next"; false: nothing that has a
/// name.
bool commands_value(const viewer *v, const viewer_action *action, char text[EWA_OPTION_TEXT_BYTES]);

/// Has the window ask for what a command leaves out.
bool commands_ask(viewer *v, viewer_question question);
/// The hand holds one tool: puts away what it held.
void commands_put_away(viewer *v);

// pointer.c, keys.c
void pointer_handle(viewer *v, const viewer_event *event);
void keys_handle(viewer *v, const viewer_event *event);
void keys_fly(viewer *v, double seconds);

// shot.c: the commands "shot" and "camera"
bool shot_command(viewer *v, const char *rest);
bool shot_camera(viewer *v, const char *rest);
/// Draws all there is, with what stands over it, as the window looks, whatever size the camera has.
ewa_status shot_draw(viewer *v, const ewa_camera *camera, ewa_ink ink, uint8_t *rgba8);
bool shot_scene(viewer *v, const char *rest);
/// Fills in the scene of the window at full size.
void viewer_scene(const viewer *v, paint_scene *scene);

// overlay.c
/// Whether something is shown in colours that the colour bar tells.
bool overlay_has_color_bar(const viewer *v);
/// Draws furniture in an ink, and marks, over a picture of a camera. What is `saved` has furniture of the size that `ewa render` gives it, and no
/// boxes to be dragged.
void overlay_draw(viewer *v, const ewa_camera *camera, ewa_ink ink, bool saved, uint8_t *rgba8);

#endif
