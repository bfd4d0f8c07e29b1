#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""What a shell offers when something of a command line is typed: all options that docs/cli.md has and no other, words, files.

    check_completion.py EWA SOURCE bash|zsh|fish SCRATCH

Skipped (77) without the shell.
"""
import os
import pty
import re
import select
import shutil
import subprocess
import sys
import time
from pathlib import Path

BASH = r"""
source ./completion
while IFS=$'\t' read -r -a COMP_WORDS; do
    [ "${COMP_WORDS[-1]}" != _ ] || COMP_WORDS[-1]=
    COMP_CWORD=$((${#COMP_WORDS[@]} - 1)) COMPREPLY=()
    _ewa
    printf '%s ' "${COMPREPLY[@]}"
    echo
done
"""

# Completion of zsh runs in its line editor only. Its builtin that takes what is offered writes it to a file besides.
ZSH = r"""
PS1= PS2= ; unsetopt beep list_beep prompt_cr auto_list auto_menu
zmodload zsh/complete zsh/zle
autoload -Uz compinit; compinit -u -D
source ./completion
compadd() {
    if [[ ${@[1,(i)(-|--)]} == *-(O|A|D)\ * ]]; then builtin compadd "$@"; return; fi
    local -a offered
    builtin compadd -A offered "$@"
    [[ $#offered == 0 ]] || print -rn -- "$offered " >>offered
    builtin compadd "$@"
}
offer() { _main_complete; print >>offered; }
zle -C offer complete-word offer
bindkey '^I' offer
print ready >>offered
"""


def by_bash(lines):
    # A word that is empty is typed as nothing; `read` would drop it.
    typed = "".join("\t".join(word or "_" for word in line) + "\n" for line in lines)
    return subprocess.run(["bash", "--norc", "-c", BASH], input=typed, capture_output=True, text=True, check=True).stdout


def by_fish(lines):
    script = "source ./completion\n" + "".join(f"complete -C '{' '.join(line)}' | cut -f 1 | tr '\\n' ' '; echo\n" for line in lines)
    return subprocess.run(["fish", "--no-config", "-c", script], capture_output=True, text=True, check=True).stdout


def by_zsh(lines):
    Path("offered").unlink(missing_ok=True)
    Path("init").write_text(ZSH)
    process, terminal = pty.fork()
    if process == 0:
        os.environ["TERM"] = "dumb"
        os.execvp("zsh", ["zsh", "-f", "-i"])

    def wait_for(count):
        end = time.monotonic() + 20
        while not (Path("offered").exists() and Path("offered").read_text().count("\n") >= count):
            if select.select([terminal], [], [], 0.005)[0]:
                os.read(terminal, 65536)
            if time.monotonic() > end:
                raise SystemExit(f"zsh does not answer line {count}")

    os.write(terminal, b"source ./init\n")
    wait_for(1)
    for i, line in enumerate(lines):
        os.write(terminal, " ".join(line).encode() + b"\t")
        wait_for(i + 2)
        os.write(terminal, b"\x15")
    os.close(terminal)
    os.waitpid(process, 0)
    return Path("offered").read_text().split("\n", 1)[1]


def main():
    ewa, source, shell, scratch = sys.argv[1], Path(sys.argv[2]), sys.argv[3], Path(sys.argv[4])
    if not shutil.which(shell):
        print(f"skipped: {shell} is not installed")
        return 77
    shutil.rmtree(scratch, ignore_errors=True)
    scratch.mkdir(parents=True)
    page = (source / "docs/cli.md").read_text()
    os.chdir(scratch)
    Path("completion").write_text(subprocess.run([ewa, "--completion", shell], capture_output=True, text=True, check=True).stdout)
    Path("scan.ply").touch()
    wanted = [  # what is typed, and what is offered
        (["ewa", "rend"], {"render"}),
        (["ewa", "--vers"], {"--version"}),
        (["ewa", "help", "lo"], {"lod"}),
        (["ewa", "--completion", ""], {"bash", "zsh", "fish"}),
        (["ewa", "render", "sc"], {"scan.ply"}),
        (["ewa", "render", "scan.ply", "--output", "sc"], {"scan.ply"}),
        (["ewa", "render", "scan.ply", "-o", "sc"], {"scan.ply"}),
        (["ewa", "render", "scan.ply", "--backend", ""], {"cpu", "gl", "gl-raster", "auto"}),
        (["ewa", "render", "scan.ply", "--view", "i"], {"iso"}),
        (["ewa", "surfels", "scan.ply", "--keep-radii", ""], {"on", "off"}),
        (["ewa", "page", "--title", ""], set()),
        (["ewa", "render", "--no-progr"], {"--no-progress"}),
    ]
    if shell == "bash":  # as it takes --key=value apart
        wanted += [(["ewa", "render", "--view", "=", "i"], {"iso"}), (["ewa", "render", "--view", "="], None)]
    for part in re.split(r"(?m)^## ewa ", page)[1:]:
        rows = re.findall(r"(?m)^\| `([^`]*--[^`]*)` \|", part)
        wanted.append((["ewa", part.split()[0], "--"], {option for row in rows for option in re.findall(r"--[a-z][\w-]*", row)}))
    lines = {"bash": by_bash, "zsh": by_zsh, "fish": by_fish}[shell]([typed for typed, _ in wanted]).split("\n")
    found = 0
    for (typed, words), line in zip(wanted, lines, strict=False):
        offered = {word.split("=")[0] for word in line.split()}
        if words is None:  # those of the option before
            words = set("front back left right top bottom iso".split())
        if offered != words:
            print(f"{' '.join(typed)}: missing {sorted(words - offered)}, beside {sorted(offered - words)}")
            found += 1
    print(f"{len(wanted)} lines, {found} wrong")
    return found > 0 or len(lines) < len(wanted)


if __name__ == "__main__":
    sys.exit(main())
