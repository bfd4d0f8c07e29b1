#!/bin/sh
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Displays that a window cannot be on, and one that goes away: one line that says what helps, exit status 1:
# display_x11.sh EWA-VIEW FOLDER
set -u
view=$1
folder=$2
mkdir -p "$folder"
cd "$folder" || exit 1
unset DISPLAY WAYLAND_DISPLAY SDL_VIDEODRIVER
screen=""
trap 'kill $screen 2>/dev/null || true' EXIT
fail() {
    echo "display: $1" >&2
    sed 's/^/  said: /' said >&2
    exit 1
}
# expect WHAT PATTERN STATUS: of the one line that was said.
expect() {
    [ "$3" = 1 ] || fail "$1: exit status $3"
    [ "$(wc -l <said)" = 1 ] || fail "$1: not one line"
    grep -q "^ewa: view: $2.*ewa render\$" said || fail "$1: other words"
}
SDL_VIDEODRIVER=dummy timeout 20 "$view" >said 2>&1
expect "a driver without a screen" "no display .*SDL_VIDEODRIVER=dummy: unset it" $?
SDL_VIDEODRIVER=nonesuch timeout 20 "$view" >said 2>&1
expect "no such driver" "no display .*SDL_VIDEODRIVER=nonesuch cannot be used: unset it" $?
DISPLAY=:4095 timeout 20 "$view" >said 2>&1
expect "no such display" "no display .*DISPLAY=:4095 cannot be opened" $?

command -v Xvfb >/dev/null 2>&1 || { echo "skipped: Xvfb is not installed"; exit 77; }
# start_screen BITS: the screen says its own number.
start_screen() {
    rm -f display
    Xvfb -noreset -displayfd 3 -screen 0 "320x240x$1" -nolisten tcp 3>display 2>xvfb.log &
    screen=$!
    tries=300
    until [ -s display ]; do
        tries=$((tries - 1))
        [ $tries -gt 0 ] || fail "a screen of $1 bits does not start"
        sleep 0.1
    done
}
start_screen 8
DISPLAY=:$(cat display) timeout 20 "$view" >said 2>&1
expect "8 bits" "no renderer .*the display.s pixels may have too few bits" $?
kill $screen

start_screen 24
DISPLAY=:$(cat display) timeout 60 "$view" >said 2>&1 &
session=$!
sleep 2
kill $screen
wait $session
expect "a display that goes away" "the display has gone" $?
screen=""
