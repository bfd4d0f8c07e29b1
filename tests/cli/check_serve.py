#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""ewa serve: files whole and in parts, nothing else, and octrees drawn from it as from the disk.

Usage: check_serve.py EWA FOLDER
The folder is made anew.
"""
import http.client
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

EWA, ROOT = str(Path(sys.argv[1]).resolve()), Path(sys.argv[2]).resolve()
failures = []


def hold(what, holds):
    if not holds:
        failures.append(what)
        print("does not hold:", what)


def run(*words):
    done = subprocess.run([EWA, *words], cwd=ROOT, capture_output=True, text=True, timeout=120)
    return done.returncode, done.stderr


class Server:
    def __init__(self, *words):
        self.process = subprocess.Popen([EWA, "serve", "--port", "0", *words], cwd=ROOT, stdout=subprocess.PIPE,
                                        stderr=subprocess.DEVNULL, text=True)
        self.address = self.process.stdout.readline().strip()
        self.port = int(self.address.rstrip("/").rsplit(":", 1)[1])

    def ask(self, path, method="GET", connection=None, **headers):
        connection = connection or http.client.HTTPConnection("127.0.0.1", self.port, timeout=20)
        connection.putrequest(method, path, skip_host="Host" in headers)
        for name, value in headers.items():
            connection.putheader(name, value)
        connection.endheaders()
        answer = connection.getresponse()
        return answer.status, dict(answer.getheaders()), answer.read()

    def end(self, number):
        began = time.monotonic()
        self.process.send_signal(number)
        status = self.process.wait(20)
        return status, time.monotonic() - began


shutil.rmtree(ROOT, ignore_errors=True)
site = ROOT / "site"
(site / "sub").mkdir(parents=True)
text = bytes(range(256)) * 40
(site / "data.bin").write_bytes(text)
(site / "index.html").write_text("<!doctype html><title>t</title>")
(site / "page.wasm").write_bytes(b"\0asm")
(site / "script.mjs").write_text("1\n")
(site / "run.cgi").write_text("#!/bin/sh\necho 'Content-Type: text/plain'; echo; echo ran\n")
(site / "run.cgi").chmod(0o755)
(site / "name with \u00e4.txt").write_text("name")
(site / ".secret").write_text("secret")
(site / "sub" / "shown.txt").write_text("shown")
(site / "sub" / ".hidden").write_text("hidden")
(ROOT / "outside.txt").write_text("outside")
(ROOT / "sitemap").mkdir()
(ROOT / "sitemap" / "x").write_text("outside")
(site / "out").symlink_to(ROOT / "outside.txt")
(site / "beside").symlink_to(ROOT / "sitemap")
(site / "within").symlink_to(site / "data.bin")

server = Server("site")
hold("it is at this machine", server.address.startswith("http://127.0.0.1:"))
status, headers, body = server.ask("/data.bin")
hold("a file is whole", status == 200 and body == text and headers.get("Accept-Ranges") == "bytes")
hold("a page may have threads", headers.get("Cross-Origin-Opener-Policy") == "same-origin"
     and headers.get("Cross-Origin-Embedder-Policy") == "require-corp")
for asked, begin, end in (("bytes=0-0", 0, 1), ("bytes=100-299", 100, 300), ("bytes=10000-", 10000, 10240), ("bytes=10000-10240", 10000, 10240),
                          ("bytes=0-262143", 0, 10240)):
    status, headers, body = server.ask("/data.bin", Range=asked)
    hold(f"{asked} is a part", status == 206 and body == text[begin:end]
         and headers.get("Content-Range") == f"bytes {begin}-{end - 1}/{len(text)}")
for asked in ("bytes=10240-", "bytes=99999999999999999999-", "bytes=10-5"):
    hold(f"{asked} is not there", server.ask("/data.bin", Range=asked)[0] == 416)
for asked in ("bytes=-5", "bytes=", "lines=1-2", "bytes=a-b"):
    hold(f"of {asked} the whole comes", server.ask("/data.bin", Range=asked)[::2] == (200, text))
status, headers, body = server.ask("/data.bin", "HEAD")
hold("a head is without a body", status == 200 and body == b"" and headers.get("Content-Length") == str(len(text)))
hold("modules say what they are", server.ask("/page.wasm")[1].get("Content-Type") == "application/wasm"
     and server.ask("/script.mjs")[1].get("Content-Type", "").startswith("text/javascript"))
hold("a folder shows its page", server.ask("/")[2].startswith(b"<!doctype html>"))
listed = server.ask("/sub/")[2]
hold("a folder without a page lists its files", b"shown.txt" in listed and b".hidden" not in listed)
hold("names are decoded", server.ask("/name%20with%20%C3%A4.txt")[2] == b"name")
hold("links within are followed", server.ask("/within")[2] == text)
hold("a program is a file", b"echo ran" in server.ask("/run.cgi")[2])
for path in ("/out", "/beside/x", "/../outside.txt", "/sub/../../outside.txt", "/%2e%2e/outside.txt", "/..%2foutside.txt", "/.secret",
             "/sub/%2e%2e/%2e%2e/outside.txt", "//../outside.txt", "/..\\outside.txt", "/none"):
    status, _, body = server.ask(path)
    hold(f"{path} is not there", status in (400, 404) and b"outside" not in body and b"secret" not in body)
hold("nothing is written", server.ask("/new.txt", "PUT")[0] == 405 and server.ask("/data.bin", "DELETE")[0] == 405
     and server.ask("/data.bin", "POST")[0] == 405 and (site / "data.bin").exists())
for host in ("example.com", "127.0.0.1.example.com", "localhost.example.com:80", ""):
    hold(f"host {host!r} is refused", server.ask("/data.bin", Host=host)[0] in (400, 403))
hold("localhost is no other host", server.ask("/data.bin", Host=f"LocalHost:{server.port}")[0] == 200)
kept = http.client.HTTPConnection("127.0.0.1", server.port, timeout=20)
hold("a connection is kept", all(server.ask("/data.bin", connection=kept)[0] == 200 for _ in range(3)))

for words in (("generate", "terrain", "-n", "60000", "-o", "t.laz"), ("lod", "t.laz", "-o", "site/t.copc.laz"),
              ("render", "site/t.copc.laz", "--levels", "always", "--size", "160x120", "-o", "here.png"),
              ("render", server.address + "t.copc.laz", "--levels", "always", "--size", "160x120", "-o", "there.png")):
    status, said = run(*words)
    hold(f"{words[0]} ends well: {said}", status == 0)
hold("an octree is drawn as from the disk", (ROOT / "here.png").read_bytes() == (ROOT / "there.png").read_bytes())

busy = subprocess.run([EWA, "serve", "--port", str(server.port), "site"], cwd=ROOT, capture_output=True, text=True, timeout=60)
hold("a port that is taken is an error", busy.returncode == 1 and f"--port {server.port}: cannot be listened at" in busy.stderr)
status, took_s = server.end(signal.SIGINT)
hold(f"an interrupt ends it ({status}, {took_s:.2f} s)", status == -signal.SIGINT
     and took_s < (0.3 if os.environ.get("EWA_QUIET_MACHINE") else 5))

status, said = run("serve", "--port", "0", "--max-seconds", "0.2", "site")
hold(f"time is over: {said}", status == 1 and "0.2 s are over" in said)
status, said = run("serve", "none")
hold(f"a folder has to be there: {said}", status == 1 and "none: there is no such folder" in said)
status, said = run("serve", "t.laz")
hold(f"a file is no folder: {said}", status == 1 and "t.laz: no folder; 'ewa page t.laz --folder DIR' makes one" in said)
sys.exit(bool(failures))
