#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Files on servers: a server on this machine that does well, and badly in every way that it can.

Usage: check_servers.py EWA FOLDER
The folder is made anew. What is drawn of a file on the server has to be the bytes of the file here.
"""
import concurrent.futures
import http.server
import json
import os
import re
import shutil
import struct
import subprocess
import sys
import threading
import time
from pathlib import Path

EWA, ROOT = str(Path(sys.argv[1]).resolve()), Path(sys.argv[2]).resolve()
SIZE = ["--size", "160x120"]
failures = []


class Server(http.server.ThreadingHTTPServer):
    """Paths are /WAY/FILE; the way says what goes wrong. Counts what is asked for and sent."""
    daemon_threads = True

    def __init__(self):
        super().__init__(("127.0.0.1", 0), Handler)
        self.asked, self.sent_bytes, self.seen, self.paths = 0, 0, {}, []
        threading.Thread(target=self.serve_forever, daemon=True).start()

    def address(self, way, name):
        return f"http://127.0.0.1:{self.server_address[1]}/{way}/{name}"

    def forget(self):
        self.asked, self.sent_bytes, self.seen, self.paths = 0, 0, {}, []

    def handle_error(self, request, client_address):
        pass  # clients that hang up


class Handler(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    disable_nagle_algorithm = True

    def log_message(self, *arguments):
        pass

    def answer(self, status, headers, body=b""):
        self.send_response(status)
        for name, value in headers.items():
            self.send_header(name, value)
        if "Content-Length" not in headers:
            self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def do_GET(self):
        server = self.server
        _, way, name = self.path.replace("%20", " ").split("/", 2)
        server.asked += 1
        server.paths.append(name)
        key = (name, self.headers.get("Range"))
        server.seen[key] = server.seen.get(key, 0) + 1
        first_time = server.seen[key] == 1
        if way == "leads":
            return self.answer(302, {"Location": f"/plain/{name}"})
        if way in ("circles", "astray"):
            return self.answer(302, {"Location": self.path if way == "circles" else "file:///etc/passwd"})
        if way == "fails" or (way == "stumbles" and first_time):
            return self.answer(503, {}, b"busy")
        if way == "refuses":
            return self.answer(403, {})
        if way == "silent":
            time.sleep(60)
            return None
        path = ROOT / name
        if not path.is_file():
            return self.answer(404, {}, b"not here")
        content = path.read_bytes()
        size = len(content)
        asked = re.fullmatch(r"bytes=(\d+)-(\d+)", self.headers.get("Range", ""))
        if way == "whole" or not asked:
            server.sent_bytes += size
            return self.answer(200, {}, content)
        first, last = int(asked[1]), min(int(asked[2]), size - 1)
        if first >= size:
            return self.answer(416, {"Content-Range": f"bytes */{size}"})
        body = content[first:last + 1]
        headers = {"ETag": '"1"'}
        if way == "other":
            first += 1
        if way == "changes":
            headers["ETag"] = f'"{server.asked}"'
        if way == "packs":
            headers["Content-Encoding"] = "gzip"
        said = size + 100000 if way == "overstates" else size // 2 if way == "understates" else size
        headers["Content-Range"] = f"bytes {first}-{last}/{said}"
        if way == "more":
            headers["Content-Range"] = f"bytes {first}-{last - 10}/{size}"
        headers["Content-Length"] = str(len(body))
        self.send_response(206)
        for name, value in headers.items():
            self.send_header(name, value)
        self.end_headers()
        if way == "hangs up" or (way == "cuts" and len(body) > 20000):
            body = b"" if way == "hangs up" else body[:len(body) // 2 + 1]
            self.close_connection = True
        if way == "trickles":
            for at in range(0, len(body), 1 + len(body) // 4):
                self.wfile.write(body[at:at + 1 + len(body) // 4])
                self.wfile.flush()
                time.sleep(0.01)
        else:
            self.wfile.write(body)
        server.sent_bytes += len(body)
        return None


def run(*arguments, seconds=60):
    return subprocess.run([EWA, *arguments], cwd=ROOT, capture_output=True, text=True, timeout=seconds)


def expect(what, good, said=""):
    if not good:
        failures.append(f"{what}: {said}")


def draws(path, output, *options):
    done = run("render", str(path), "-o", output, *SIZE, *options)
    expect(f"render {path}", done.returncode == 0 and not done.stderr, done.stderr)
    return (ROOT / output).read_bytes() if (ROOT / output).exists() else b""


def make_files():
    run("generate", "terrain", "-n", "120000", "-o", "ground.ply")
    run("lod", "ground.ply", "-o", "ground.copc.laz")
    run("generate", "torus", "-n", "3000", "-o", "torus.ply")
    (ROOT / "empty.ply").write_bytes(b"")
    # EPT: a root of points on a slope, eight bytes of doubles a coordinate.
    folder = ROOT / "ept"
    for below in ("ept-data", "ept-hierarchy"):
        (folder / below).mkdir(parents=True)
    points = [(i % 40 / 40, i // 40 / 40, i % 40 / 80) for i in range(1600)]
    box = [-0.1, -0.1, -0.1, 1.1, 1.1, 1.1]
    (folder / "ept.json").write_text(json.dumps({
        "version": "1.0.0", "bounds": box, "boundsConforming": [0, 0, 0, 1, 1, 1], "dataType": "binary", "hierarchyType": "json",
        "points": len(points), "span": 128, "srs": {},
        "schema": [{"name": name, "type": "float", "size": 8} for name in "XYZ"]}))
    (folder / "ept-hierarchy" / "0-0-0-0.json").write_text(json.dumps({"0-0-0-0": len(points)}))
    (folder / "ept-data" / "0-0-0-0.bin").write_bytes(b"".join(struct.pack("<3d", *point) for point in points))


def look_at_good_servers(server):
    levels = ["--levels", "always", "--lod-spacing", "4", "--lod-error", "64"]
    octree = draws("ground.copc.laz", "a.png", *levels)
    server.forget()
    expect("octree", draws(server.address("plain", "ground.copc.laz"), "b.png", *levels) == octree, "other bytes")
    size = (ROOT / "ground.copc.laz").stat().st_size
    print(f"octree of {size} bytes: {server.sent_bytes} in {server.asked} requests")
    # Of so few points all are looked at to place the camera; none twice.
    expect("octree", server.sent_bytes <= size, f"{server.sent_bytes} of {size} bytes were read")
    for way in ("cuts", "trickles", "leads", "whole"):
        server.forget()
        expect(way, draws(server.address(way, "ground.copc.laz"), "b.png", *levels) == octree, "other bytes")
        if way == "whole":
            expect(way, server.sent_bytes == size, f"{server.sent_bytes} of {size} bytes were read: more than once")
    for way, name in (("plain", "ept/ept.json"), ("whole", "ept/ept.json"), ("stumbles", "torus.ply")):
        near = draws(name, "a.png")
        expect(name, near and draws(server.address(way, name), "b.png") == near, "other bytes")
    near, far = (run("info", path, "--json").stdout for path in ("ground.copc.laz", server.address("plain", "ground.copc.laz")))
    expect("info", near and far.replace(server.address("plain", ""), "") == near, far)


def look_at_bad_servers(server):
    def look(case):
        address, said, *options = case
        done = run("render", address, "-o", "x.png", *SIZE, *options)
        lines = [line for line in done.stderr.splitlines() if "warning" not in line]
        good = done.returncode == 1 and len(lines) == 1 and lines[0].startswith("ewa: ") and any(s in lines[0] for s in said.split("|"))
        expect(address, good, f"{done.returncode} {done.stderr}")

    def at(way, name):
        return server.address(way.replace(" ", "%20"), name)

    always = "--levels", "always"
    cases = ((at("plain", "absent.laz"), "the server has no such file (404)"), (at("refuses", "ground.copc.laz"), "refuses it (403)"),
             (at("fails", "torus.ply"), "the server fails (503), four times"), (at("hangs up", "torus.ply"), "the connection was cut, four times"),
             (at("circles", "torus.ply"), "it leads on more than 5 times"), (at("astray", "torus.ply"), "neither http nor https"),
             (at("other", "torus.ply"), "another part than it was asked for"), (at("more", "torus.ply"), "sends more than it says"),
             (at("packs", "torus.ply"), "the server sends it compressed"), (at("changes", "ground.copc.laz"), "has changed on the server", *always),
             (at("overstates", "ground.ply"), "fewer than there are"), (at("understates", "ground.copc.laz"), "", *always),
             (at("plain", "empty.ply"), "empty"), (at("silent", "torus.ply"), "given up", "--max-seconds", "1"),
             ("http://127.0.0.1:9/x.ply", "the server cannot be reached, four times"),
             ("http://name.invalid/x.ply", "the name of the server is not known|cannot be reached"))
    with concurrent.futures.ThreadPoolExecutor(len(cases)) as pool:  # which wait, most of them
        list(pool.map(look, cases))


def look_at_who_may_ask(server):
    server.forget()
    inner = server.address("plain", "torus.ply")
    (ROOT / "names.json").write_text(json.dumps({"ewa_scene": 1, "items": [{"file": inner}]}))
    for arguments, said in ((["names.json"], "named_files anywhere asks it"), ([inner, "--untrusted"], "untrusted inputs"),
                            ([inner.replace("http://", "http://me:secret@")], "a user's name in it"),
                            ([f"http://127.0.0.1:{server.server_address[1]}"], "names a server and no file")):
        done = run("render", *arguments, "-o", "x.png")
        expect(arguments[0], done.returncode == 1 and said in done.stderr, done.stderr)
    expect("refused", server.asked == 0, f"{server.asked} requests")
    expect("named", draws("names.json", "b.png", "--named-files", "anywhere") == draws("torus.ply", "a.png"), "other bytes")


def main():
    if "curl" not in subprocess.run([EWA, "--version"], capture_output=True, text=True).stdout.split():
        print("skipped: the program was built without libcurl")
        sys.exit(77)
    shutil.rmtree(ROOT, ignore_errors=True)
    ROOT.mkdir(parents=True)
    for name in list(os.environ):
        if name.lower().endswith("_proxy"):
            del os.environ[name]
    make_files()
    server = Server()
    Handler.timeout = 30
    for look in (look_at_good_servers, look_at_bad_servers, look_at_who_may_ask):
        began = time.monotonic()
        look(server)
        print(f"{look.__name__}: {time.monotonic() - began:.1f} s")
    print("\n".join(failures))
    print(f"{len(failures)} lines")
    sys.exit(1 if failures else 0)


main()
