#!/bin/sh
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# A viewer that is killed leaves files of its own, which the next one takes away; those of one that lives it leaves alone:
# killed.sh EWA FOLDER
set -eu
ewa=$1
folder=$2
rm -rf "$folder"
mkdir -p "$folder/own"
cd "$folder"
TMPDIR=$PWD/own
export TMPDIR
viewers=""
trap 'kill -KILL $viewers 2>/dev/null || true' EXIT
fail() {
    echo "killed: $1" >&2
    ls "$TMPDIR" >&2
    exit 1
}
count() { find "$TMPDIR" -name "$1" | wc -l; }
# start N: a viewer that has changed a transfer function and goes on until its words end.
start() {
    mkfifo "words$1"
    "$ewa" view ball.nrrd --size 80x60 --script "words$1" --timings >"printed$1" 2>"complained$1" &
    viewers="$viewers $!"
    exec 9>"words$1"
    printf 'settle\ndo transfer 0 edit\nsettle\ndo transfer 0 point add 0.3,0,1,0,0.3\nsettle\nshot shown%s.png\n' "$1" >&9
    tries=600
    until [ -s "shown$1.png" ]; do
        tries=$((tries - 1))
        [ $tries -gt 0 ] || fail "viewer $1 shows nothing: $(cat "complained$1")"
        sleep 0.1
    done
}
"$ewa" generate ball --dims 16 -o ball.nrrd
start 1
killed=${viewers# }
exec 8>&9 # the first one's words do not end yet
start 2
[ "$(count '*.lock')" = 2 ] && [ "$(count '*-transfer-*')" = 2 ] || fail "not two functions and two locks"
kill -KILL "$killed"
wait "$killed" || true
: >"$TMPDIR/ewa-view-notes.lock" # of nobody's viewer
: >"$TMPDIR/ewa-view-1-0-mine"
echo frame | "$ewa" view ball.nrrd --size 80x60 --script -
[ "$(count 'ewa-view-*-[0-9]*.lock')" = 1 ] && [ "$(count '*-transfer-*')" = 1 ] || fail "not one function and one lock"
printf 'shot again.png\n' >&9
exec 9>&- 8>&-
wait "${viewers##* }" || fail "the living viewer does not go on: $(cat complained2)"
cmp -s shown2.png again.png || fail "the living viewer shows something else"
[ "$(ls "$TMPDIR")" = "ewa-view-1-0-mine
ewa-view-notes.lock" ] || fail "files stay, or too many went"
echo "what was left is gone"
