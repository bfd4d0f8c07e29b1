// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Opens a file by the modules of a page under node, the relaxed one where the host rounds its multiply-add once, and prints the
// hash of a still picture and the processor time of a frame, still and moving. As a page would, it needs no files and no program.
//   node page/measure.mjs scan.laz 1920 1080 10 build/wasm-relaxed/page/page.wasm build/wasm/page/page.wasm
import { createHash } from "node:crypto";
import { readFileSync } from "node:fs";
import { basename } from "node:path";
import { Bytes } from "./files.js";
import { open_module } from "./module.js";

const [file, width, height, frames, ...paths] = process.argv.slice(2);
let taken, message = "";
const hooks = {
  say: (isMessage, text) => (message = isMessage ? text : message),
  progress: () => {},
  waiting: () => false,
};
const modules = paths.map((path) => () => readFileSync((taken = path)));
const viewer = await open_module(modules, hooks, +width, +height, 1);

let now_s = 1;
const step = (seconds) => viewer.frame((now_s += seconds));

/// Frames until nothing changes by itself; the last one drew the picture as `ewa render` does.
function settle() {
  for (let i = 0; i < 1000; i++) {
    const report = step(0.1);
    if (report.still) return report;
    if (message) throw new Error(message);
  }
  throw new Error("the picture does not come to rest");
}

const median = (times) => times.sort((a, b) => a - b)[times.length >> 1]?.toFixed(0);

viewer.files.put(basename(file), new Bytes(readFileSync(file)));
const opened = performance.now();
if (!viewer.open("/" + basename(file))) throw new Error(message);
let report;
while (!(report = step(0.001)).at) if (message) throw new Error(message);
const first = performance.now();
report = settle();
const hash = createHash("md5").update(viewer.pixels(report)).digest("hex");
const still = [], moving = [];
for (let i = 0; i < +frames; i++) {
  viewer.event({ kind: "press", x: 1, y: 1, button: 1 }, now_s);
  viewer.event({ kind: "move", x: 9, y: 1 + (i & 1) }, now_s);
  let began = process.cpuUsage().user;
  step(0.001);
  moving.push((process.cpuUsage().user - began) / 1000);
  viewer.event({ kind: "release", x: 9, y: 1, button: 1 }, now_s);
  began = process.cpuUsage().user;
  settle();
  still.push((process.cpuUsage().user - began) / 1000);
}
console.log(`${taken}: ${hash}, first picture ${(first - opened).toFixed(0)} ms, frame ${median(still)} ms, moving ${median(moving)} ms, ` +
            `memory ${(viewer.memory.buffer.byteLength / 2 ** 20).toFixed(0)} MiB`);
