# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""What the tests of the hostile suite share: they know nothing of the library, run the program as a stranger would, and look
at what it leaves behind. Needs Python 3.9 and nothing else. EWA_PROGRAM is the program."""

import os
import resource
import signal
import subprocess
import sys
import tempfile
import time

PROGRAM = os.environ["EWA_PROGRAM"]
TIMEOUT_S = 60


class Failed(Exception):
    """A case did not hold."""


class Result:
    """How a run ended: status (negative: by that signal), what it printed, how long it took, its peak of memory."""

    def __init__(self, status, out, err, seconds, peak_bytes):
        self.status, self.out, self.err, self.seconds, self.peak_bytes = status, out, err, seconds, peak_bytes


def start(words, *, cwd=None, env=None, limits=(), stdin=subprocess.DEVNULL, ignored=()):
    """Starts the program with words and limits ((resource, value) pairs). Its output goes to a file that has no name, its few
    messages to a pipe, which no limit of files concerns."""

    def prepare():
        for what, value in limits:
            resource.setrlimit(what, (value, value))
        for number in ignored:
            signal.signal(number, signal.SIG_IGN)

    out = tempfile.TemporaryFile()
    process = subprocess.Popen([PROGRAM, *words], cwd=cwd, stdin=stdin, stdout=out, stderr=subprocess.PIPE, preexec_fn=prepare,
                               env={**os.environ, **(env or {})})
    process.out_file, process.began = out, time.monotonic()
    return process


def finish(process, timeout_s=TIMEOUT_S):
    """Waits for the end; a process that is not through in time is killed, which fails the case."""
    deadline = time.monotonic() + timeout_s
    while True:
        pid, state, usage = os.wait4(process.pid, os.WNOHANG)
        if pid:
            break
        if time.monotonic() > deadline:
            process.kill()
            os.wait4(process.pid, 0)
            process.returncode = -9
            raise Failed(f"{' '.join(map(str, process.args[1:]))}: not through after {timeout_s} s")
        time.sleep(0.002)
    process.returncode = os.waitstatus_to_exitcode(state)
    seconds = time.monotonic() - process.began
    texts = []
    process.out_file.seek(0)
    for file in (process.out_file, process.stderr):
        texts.append(file.read())
        file.close()
    return Result(process.returncode, texts[0], texts[1].decode(errors="replace"), seconds, usage.ru_maxrss * 1024)


def run(*words, **options):
    """Runs the program to its end."""
    timeout_s = options.pop("timeout_s", TIMEOUT_S)
    return finish(start([str(word) for word in words], **options), timeout_s)


def done(*words, **options):
    """The same, which has to succeed."""
    result = run(*words, **options)
    if result.status != 0:
        raise Failed(f"{' '.join(map(str, words))}: status {result.status}: {result.err.strip()}")
    return result


def refused(*words, **options):
    """The same, which has to fail with a message, not by a signal; returns the result."""
    result = run(*words, **options)
    said = result.err.strip()
    if result.status not in (1, 2) or not said.startswith("ewa: "):
        raise Failed(f"{' '.join(map(repr, words))}: status {result.status}: {said[-300:]!r}")
    return result


def check(holds, text):
    if not holds:
        raise Failed(text)


def listing(folder):
    """Names below a folder with their sizes, hidden ones too."""
    found = {}
    for place, _, names in os.walk(folder):
        for name in names:
            path = os.path.join(place, name)
            found[os.path.relpath(path, folder)] = os.lstat(path).st_size
    return found


def main(cases):
    """Runs the cases, each in a folder of its own, or those that the command line names; prints which of them failed."""
    chosen = sys.argv[1:]
    failures = 0
    for case in cases:
        name = case.__name__
        if chosen and name not in chosen:
            continue
        with tempfile.TemporaryDirectory(prefix="ewa-hostile-") as folder:
            began = time.monotonic()
            here = os.getcwd()
            os.chdir(folder)
            try:
                case()
                said = "ok"
            except Failed as failure:
                failures += 1
                said = f"FAILED: {failure}"
            finally:
                os.chdir(here)
        print(f"{name}: {said} ({time.monotonic() - began:.1f} s)", flush=True)
    sys.exit(1 if failures else 0)
