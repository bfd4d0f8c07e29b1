#!/bin/sh
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# A person's session in a window, on a screen of its own: orbit by dragging, pick by a click, measure by a Shift-click,
# clip box, pictures, a file by its name, Escape, the bar's tools, a profile, a film, a transfer function, end. Checks what is printed, the pictures and the exit status: session_x11.sh EWA EWA-VIEW FOLDER
set -eu
ewa=$1
view=$2
folder=$3

for tool in Xvfb xdotool; do
    command -v $tool >/dev/null 2>&1 || { echo "skipped: $tool is not installed"; exit 77; }
done
rm -rf "$folder"
mkdir -p "$folder"
cd "$folder"

# The screen says its own number, so that sessions beside this one do not matter.
Xvfb -noreset -displayfd 3 -screen 0 1280x800x24 -nolisten tcp 3>display 2>xvfb.log &
screen=$!
session=""
server=""
writer=""
trap 'kill $screen $session $writer 2>/dev/null || true; kill -KILL $server 2>/dev/null || true' EXIT
fail() {
    echo "session: $1" >&2
    sed 's/^/  printed: /' printed >&2 || true
    sed 's/^/  complained: /' complained >&2 || true
    exit 1
}
# wait_for WHAT COMMAND...: until the command succeeds; a minute at most, for slow machines.
wait_for() {
    what=$1
    shift
    tries=600
    until "$@" >/dev/null 2>&1; do
        tries=$((tries - 1))
        [ $tries -gt 0 ] || fail "$what does not happen"
        sleep 0.1
    done
}
# open_window FILE: starts the viewer on a file, in the screen's corner.
open_window() {
    : >printed
    "$view" "$1" --size 1000x700 >printed 2>complained &
    session=$!
    wait_for "a window" xdotool search --onlyvisible --name "$1"
    xdotool windowmove "$(xdotool search --onlyvisible --name "$1" | tail -n 1)" 0 0
}
: >printed
: >complained
wait_for "a screen" test -s display
DISPLAY=:$(cat display)
export DISPLAY
unset WAYLAND_DISPLAY SDL_VIDEODRIVER
XDG_STATE_HOME=$PWD/state
XDG_CONFIG_HOME=$PWD/config
export XDG_STATE_HOME XDG_CONFIG_HOME

"$ewa" generate torus --points 20000 -o torus.ply
open_window torus.ply
# The first picture that is saved shows that the file is there: a key is a request, a file is the answer.
wait_for "the first picture" sh -c "xdotool key F12 && sleep 0.5 && test -s ewa-0001.png && ! cmp -s ewa-0001.png empty.png"

# Drag across the ring, away from the panels.
xdotool mousemove 500 200 mousedown 1
for step in 1 2 3 4 5 6 7 8; do
    xdotool mousemove $((500 + 12 * step)) $((200 + 6 * step))
    sleep 0.02
done
xdotool mouseup 1
sleep 0.5

# Somewhere down the middle is the ring: clicks that meet nothing print nothing.
pick() {
    for y in 200 250 300 400 450 500 550 600; do
        xdotool mousemove "$1" $y
        sleep 0.1
        [ -z "$2" ] || xdotool keydown "$2"
        xdotool click 1
        [ -z "$2" ] || xdotool keyup "$2"
        sleep 0.4
        grep -q "$3" printed && return
    done
    fail "nothing is picked"
}
pick 500 "" "^pick torus.ply point [0-9]* at "
pick 560 shift "^measure distance [0-9]"
[ "$(grep -c '^pick ' printed)" = 2 ] || fail "not two picks"

count=$(ls ewa-*.png | wc -l)
xdotool key c
sleep 0.3
xdotool key F12
wait_for "the last picture" sh -c "test \$(ls ewa-*.png | wc -l) -gt $count"
sleep 0.5
last=$(ls ewa-*.png | tail -n 1)
cmp -s ewa-0001.png "$last" && fail "nothing has turned"

# A name is typed into the dialog for files: a second file, which the next session will find among the recent ones.
"$ewa" generate sphere --points 2000 -o "$folder/ball.ply"
open_ball() {
    xdotool key ctrl+o
    sleep 0.5
    xdotool key ctrl+a
    xdotool type ball.ply
    xdotool key Return
    sleep 0.5
    grep -q /ball.ply state/ewa/recent
}
wait_for "a second file" open_ball
# A folder, and its one file by a double click.
mkdir one
"$ewa" generate sphere --points 2000 -o "$folder/one/dot.ply"
open_dot() {
    xdotool key ctrl+o
    sleep 0.5
    xdotool key ctrl+a
    xdotool type one
    xdotool key Return
    sleep 0.5
    xdotool mousemove 500 172 click --repeat 2 --delay 100 1
    sleep 0.5
    grep -q /one/dot.ply state/ewa/recent
}
wait_for "a third file" open_dot
[ "$(wc -l <state/ewa/recent)" = 3 ] || fail "not three recent files"
# Saves a picture and waits for it: "last".
shot() {
    count=$(ls ewa-*.png | wc -l)
    xdotool key F12
    wait_for "a picture" sh -c "test \$(ls ewa-*.png | wc -l) -gt $count"
    sleep 0.3
    last=$(ls ewa-*.png | tail -n 1)
}
same_as_before() {
    before=$last
    shot
    cmp -s "$before" "$last"
}
# Escape closes help and dialogs, and nothing else: the picks are there still, which the picture shows.
wait_for "rest" same_as_before
xdotool key h Escape
same_as_before || fail "Escape has done more than close the help"
xdotool key ctrl+o Escape
same_as_before || fail "Escape has done more than close the dialog"
xdotool key Escape
same_as_before && fail "Escape has not taken the picks"

xdotool key k
xdotool key ctrl+q
status=0
wait $session || status=$?
session=""
[ $status = 0 ] || fail "the exit status is $status"
[ ! -s complained ] || fail "something was wrong"
grep -q "^set navigation trackball$" config/ewa/view || fail "the navigation is not kept"

# The buttons of the bar, by their places: a rectangle is drawn around points, which are hidden; a distance, a note, the clip box and two
# keyframes. All of it is in the scene that is saved, which is drawn without a window.
# button N: the N-th of the tools, from 0.
button() {
    wanted=$1
    set -- 372 402 432 462 492 522 556 586 616 650 680 710 744 774 804 838 868 898 932 962
    shift "$wanted"
    xdotool mousemove "$1" 42
    sleep 0.5
    xdotool click 1
    sleep 0.5
}
# click_until X WORDS: clicks down the ring until the words are printed.
click_until() {
    for y in 200 250 300 400 450 500 550 600; do
        xdotool mousemove "$1" $y
        sleep 0.3
        xdotool click 1
        sleep 0.7
        grep -q "$2" printed && return
    done
    fail "'$2' is not printed"
}
open_window torus.ply
last=none.png
wait_for "the first picture" same_as_before
button 9
xdotool mousemove 700 120
sleep 0.3
xdotool mousedown 1
for x in 760 820 900; do
    xdotool mousemove $x $((x - 300))
    sleep 0.3
done
xdotool mouseup 1
wait_for "a selection" grep -q "^select [1-9][0-9]* points" printed
# It is written to a file by the menu.
save_selection() {
    xdotool mousemove 22 12
    sleep 0.3
    xdotool click 1
    sleep 0.5
    xdotool mousemove 60 139
    sleep 0.3
    xdotool click 1
    sleep 0.7
    xdotool key ctrl+a
    xdotool type part
    xdotool key Return
    sleep 0.7
    test -s part.ply
}
wait_for "a file of the selection" save_selection
button 12
button 9
wait_for "rest" same_as_before
button 0
click_until 560 "^pick torus.ply"
click_until 680 "^measure distance"
button 0
# Along what was measured.
button 8
wait_for "a profile" grep -q "^profile [1-9][0-9]* points length" printed
button 8
button 5
click_until 560 "^measure [0-9]* note"
button 5
button 6
button 18
xdotool key Left Left
button 18
if command -v ffmpeg >/dev/null 2>&1; then
    button 19
    wait_for "a film" grep -q "^film .*ewa-0001.mp4 61 700x640" printed
    [ -s ewa-0001.mp4 ] || fail "the film is not there"
fi
save_tools() {
    xdotool key ctrl+s
    sleep 0.7
    xdotool key ctrl+a
    xdotool type tools.json
    xdotool key Return
    sleep 0.7
    test -s tools.json
}
wait_for "a scene file" save_tools
for member in regions section_planes measures keyframes; do
    grep -q "\"$member\"" tools.json || fail "the scene file has no $member"
done
"$ewa" render tools.json -q -o tools.png || fail "the scene is not drawn"
xdotool key ctrl+q
status=0
wait $session || status=$?
session=""
[ $status = 0 ] || fail "the exit status is $status"
[ ! -s complained ] || fail "something was wrong"

# A volume, whose transfer function gets another point by a double click on its graph, which a step back takes away.
"$ewa" generate ball --dims 32 -o volume.nrrd
open_window volume.nrrd
last=none.png
wait_for "the volume" same_as_before
volume=$last
xdotool mousemove 60 154
sleep 0.5
xdotool click 1
sleep 1
add_point() {
    xdotool mousemove 60 170
    sleep 0.5
    xdotool click --repeat 2 --delay 100 1
    sleep 1
    shot
    ! cmp -s "$volume" "$last"
}
wait_for "another function" add_point
take_point() {
    xdotool key ctrl+z
    sleep 1
    shot
    cmp -s "$volume" "$last"
}
wait_for "the function before" take_point
xdotool key ctrl+q
status=0
wait $session || status=$?
session=""
[ $status = 0 ] || fail "the exit status is $status"
[ ! -s complained ] || fail "something was wrong"

# What is loaded without an end, here from a pipe, holds nobody up: it is given up at once, and so is the program.
mkfifo endless.ply
sleep 60 >endless.ply &
writer=$!
"$view" endless.ply >ended 2>&1 &
session=$!
wait_for "a window" xdotool search --onlyvisible --name endless.ply
xdotool key k ctrl+q
wait_for "the end" sh -c "! kill -0 $session"
kill $writer 2>/dev/null || fail "the end has waited for the pipe"
wait $session || fail "the exit status is $?"
session=""
grep -q "^set navigation fly$" config/ewa/view || fail "the navigation was not kept"

# Nor does a server that does not answer any more, from which nodes of an octree are read.
"$ewa" generate terrain --points 600000 --positions-only -o ground.ply
"$ewa" lod ground.ply -o ground.copc.laz
"$ewa" serve --port 0 >address 2>refused &
server=$!
sleep 1
if [ -s address ]; then
    "$view" "$(cat address)ground.copc.laz" --levels always --size 400x300 >ended 2>&1 &
    session=$!
    wait_for "a window" xdotool search --onlyvisible --name ground.copc.laz
    last=none.png
    wait_for "the octree" same_as_before
    kill -STOP $server
    xdotool key equal equal equal equal equal equal equal equal
    sleep 0.5
    xdotool key ctrl+q
    wait_for "the end" sh -c "! kill -0 $session"
    wait $session || fail "the exit status is $?"
    session=""
    kill -CONT $server
else
    grep -q EWA_WITH_CIVETWEB refused || fail "the octree is not served"
fi
kill $server 2>/dev/null || true
server=""
echo "a session of $(wc -l <printed) results and $(ls ewa-*.png | wc -l) pictures"
