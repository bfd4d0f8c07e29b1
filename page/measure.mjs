// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Opens a file by the modules of a page under node, the relaxed one where the host rounds its multiply-add once, and prints the
// hash of a picture and the processor time of a frame. As a page would, it needs no files and no program.
//   node page/measure.mjs scan.laz 1920 1080 10 build/wasm-relaxed/page/page.wasm build/wasm/page/page.wasm
import { createHash } from "node:crypto";
import { readFileSync } from "node:fs";
import { basename } from "node:path";
import { WASI } from "node:wasi";

/// The first module that the host takes: one with instructions it has not is no module, and one that must not run makes no view.
async function load(paths) {
  for (const path of paths) {
    try {
      const wasi = new WASI({ version: "preview1", returnOnExit: true });
      const imports = wasi.getImportObject();
      // Called without a function between, some of these abort node 20 once the module's memory has grown.
      for (const group of Object.values(imports))
        for (const [name, call] of Object.entries(group)) group[name] = (...values) => call(...values);
      const { instance } = await WebAssembly.instantiate(readFileSync(path), imports);
      wasi.initialize(instance);
      const view = instance.exports.page_create();
      if (view) return { path, view, calls: instance.exports };
    } catch (error) {
      if (!(error instanceof WebAssembly.CompileError)) throw error;
    }
  }
  throw new Error("no module runs here");
}

const [file, width, height, frames, ...paths] = process.argv.slice(2);
const { path, view, calls } = await load(paths);

function give(bytes) {
  const at = calls.page_allocate(bytes.length);
  if (!at) throw new Error("no memory");
  new Uint8Array(calls.memory.buffer, at, bytes.length).set(bytes);
  return at;
}

function message() {
  const bytes = new Uint8Array(calls.memory.buffer, calls.page_message(view));
  return new TextDecoder().decode(bytes.subarray(0, bytes.indexOf(0)));
}

const bytes = readFileSync(file);
const opened = performance.now();
const name = give(new TextEncoder().encode(basename(file) + "\0"));
if (!calls.page_open(view, name, give(bytes), bytes.length)) throw new Error(message());
const draw = () => {
  const at = calls.page_draw(view, Number(width), Number(height));
  if (!at) throw new Error(message());
  return new Uint8Array(calls.memory.buffer, at, 4 * width * height);
};
const hash = createHash("md5").update(draw()).digest("hex");
const first = performance.now();
const times = [];
for (let i = 0; i < Number(frames); i++) {
  const began = process.cpuUsage().user;
  calls.page_orbit(view, 1, 0);
  draw();
  times.push((process.cpuUsage().user - began) / 1000);
}
times.sort((a, b) => a - b);
console.log(`${path}: ${hash}, first picture ${(first - opened).toFixed(0)} ms, frame ${times[times.length >> 1]?.toFixed(0)} ms, ` +
            `memory ${(calls.memory.buffer.byteLength / 2 ** 20).toFixed(0)} MiB`);
