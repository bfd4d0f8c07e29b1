#!/bin/sh
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# A film by many processes: numbered frames of `ewa render` or `ewa volume`, every Nth by one of N tasks.
#
#   sbatch examples/slurm_film.sh render scan.ply -o turn_%04d.png --turntable 360       a Slurm array of 8
#   sbatch --array=1-40 examples/slurm_film.sh ...                                       of 40
#   PARTS=4 sh examples/slurm_film.sh ...                                                here, without Slurm
#
# Run the same line again after a failure: frames that are there are left out. EWA names the program, THREADS the
# worker threads of each part where Slurm does not.
#
#SBATCH --job-name=ewa-film
#SBATCH --array=1-8
#SBATCH --cpus-per-task=4
#SBATCH --mem=8G
#SBATCH --time=01:00:00
#SBATCH --requeue
#SBATCH --output=ewa-film-%A_%a.log
set -eu

# Tasks are counted from 1, so that the last one's number is that of all; to run some of them again by
# --array=3,5, give PARTS too.
parts=${PARTS:-${SLURM_ARRAY_TASK_MAX:-2}}

draw_part() {
    part=$1
    shift
    exec "${EWA:-ewa}" "$@" --frames "$part/$parts" --skip-existing --threads "${SLURM_CPUS_PER_TASK:-${THREADS:-1}}"
}

if [ -n "${SLURM_ARRAY_TASK_ID:-}" ]; then
    draw_part "$SLURM_ARRAY_TASK_ID" "$@"
fi
running=
for part in $(seq "$parts"); do
    draw_part "$part" "$@" &
    running="$running $!"
done
ended=0
for process in $running; do wait "$process" || ended=$?; done
exit $ended
