#!/bin/sh
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Whether memory stays flat while a window is used for long: an octree stays open; other files are opened beside it in turn, turned, picked,
# coloured, cut, hidden, drawn into files and undone. Prints, a line each round, minutes, rounds, resident memory in KiB, threads and open files:
#   soak_x11.sh EWA EWA-VIEW FOLDER OCTREE MINUTES FILE...
# Not a test of the list: an hour is too long for that.
set -eu
ewa=$1
view=$2
folder=$3
octree=$4
minutes=$5
shift 5

mkdir -p "$folder"
cd "$folder"
rm -f round.png display lines
Xvfb -noreset -displayfd 3 -screen 0 1280x800x24 -nolisten tcp 3>display 2>xvfb.log &
screen=$!
session=""
trap 'kill $screen $session 2>/dev/null || true' EXIT
until [ -s display ]; do sleep 0.1; done
DISPLAY=:$(cat display)
export DISPLAY
unset WAYLAND_DISPLAY SDL_VIDEODRIVER

mkfifo lines
"$view" "$octree" --size 1000x700 --window --timings --script - <lines >printed 2>complained &
session=$!
exec 4>lines

# Lines of a round, with a file beside the octree. Times are the clock's: events follow each other as a person's do.
turn() {
    echo "press 500 400 left"
    for step in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20; do
        echo "move $((500 + $1 * step)) $((400 + $2 * step))"
        echo "wait 0.03"
    done
    echo "release $((500 + 20 * $1)) $((400 + 20 * $2)) left"
}
round() {
    echo "do panels on"
    echo "do view reset"
    turn 9 2
    for notch in 1 2 3 4 5; do printf 'wheel 500 400 1\nwait 0.1\n'; done
    turn -7 3
    for notch in 1 2 3 4 5; do printf 'wheel 500 400 -1\nwait 0.1\n'; done
    echo "do open $1"
    echo "settle"
    echo "do focus"
    echo "do measure distance 0,0,0;1,1,0;2,1,0 line"
    turn 5 5
    echo "do color next"
    echo "settle"
    echo "do box on"
    turn -5 2
    echo "do box turn 20"
    echo "settle"
    echo "do box off"
    echo "do select rectangle 300 200 600 500"
    echo "do hide"
    echo "settle"
    echo "do undo"
    echo "do unhide"
    echo "do select none"
    echo "do shot shot.png 640x480"
    echo "do close 1"
    echo "do measure delete all"
    echo "do help on"
    echo "wait 0.3"
    echo "do help off"
    echo "shot round.png"
}
began=$(date +%s)
rounds=0
echo "minutes rounds KiB threads files"
while [ $(($(date +%s) - began)) -lt $((60 * minutes)) ]; do
    for file; do
        round "$file" >&4
        tries=1200
        until [ -s round.png ]; do
            kill -0 $session 2>/dev/null && [ $tries -gt 0 ] || { echo "the window is gone"; cat complained; exit 1; }
            tries=$((tries - 1))
            sleep 0.2
        done
        sleep 0.5
        rm -f round.png
        rounds=$((rounds + 1))
        echo "$(($(date +%s) - began)) $rounds $(awk '/VmRSS/ { m = $2 } /Threads/ { t = $2 } END { print m, t }' /proc/$session/status) \
$(ls /proc/$session/fd | wc -l)" | awk '{ printf "%.1f %d %d %d %d\n", $1 / 60, $2, $3, $4, $5 }'
    done
done
exec 4>&-
wait $session
