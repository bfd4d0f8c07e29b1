// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The figures of docs/page.md: how long a file of a local server takes to be seen, a still picture, pictures while a hand moves, and memory.
//   node tests/page/timings.mjs build/release/page FILE [SECONDS [exact|relaxed [isolated]]]
// The modules are those of build/wasm and build/wasm-relaxed beside it.
import { basename, dirname, join, resolve } from "node:path";
import { ISOLATED, launch, serve } from "./chromium.mjs";

const [folder, file, seconds = "3", kind, isolated] = process.argv.slice(2);
const build = resolve(folder, "../.."), exact = join(build, "wasm/page/page.wasm.gz");
const server = await serve({ "/": resolve(folder), "/data/": dirname(resolve(file)), "/page.wasm.gz": { "": exact },
                             "/page-relaxed.wasm.gz": { "": kind === "exact" ? exact : join(build, "wasm-relaxed/page/page.wasm.gz") } },
                           isolated ? ISOLATED : {});
const browser = await launch();
const page = await browser.page(`${server.origin}/index.html?src=data/${encodeURIComponent(basename(file))}`, {
  width: 1920, height: 1080,
  before: `addEventListener("DOMContentLoaded", () => { self.pictures = [];
    document.addEventListener("picture", ({ detail }) => pictures.push({ at: performance.now(), ...detail }), true); });`,
});
const view = `document.querySelector("ewa-view")`;
await page.until("self.pictures?.find((p) => p.splats || p.still)", 300);
const first_bytes = server.bytes(); // up to a few hundredths of a second later
await page.until(`${view}.still`, 300);
const opened = await page.evaluate("pictures"), first = opened.find((p) => p.splats || p.still), whole = opened.at(-1);
console.log(`${basename(file)}: first picture ${first.at.toFixed(0)} ms after the page was asked for and ${(first_bytes / 1e6).toFixed(1)} MB, ` +
            `whole ${whole.at.toFixed(0)} ms and ${(server.bytes() / 1e6).toFixed(1)} MB; drawing ${(1000 * whole.drawn_s).toFixed(0)} ms by ${whole.threads}, memory ${(whole.memory / 2 ** 20).toFixed(0)} MiB`);
const stage = `${view}.shadowRoot.querySelector(".stage")`;
await page.evaluate(`(async () => {
  pictures.length = 0;
  const stage = ${stage}, send = (type, x, y) => stage.dispatchEvent(new PointerEvent(type, { pointerId: 1, clientX: x, clientY: y, button: 0, pointerType: "mouse" }));
  stage.setPointerCapture = () => {};
  send("pointerdown", 960, 540);
  const began = performance.now();
  for (let now; (now = performance.now() - began) < 1000 * ${seconds}; ) {
    send("pointermove", 960 + 300 * Math.sin(now / 700), 540 + 80 * Math.sin(now / 900));
    await new Promise((done) => setTimeout(done, 16));
  }
  self.released = performance.now();
  send("pointerup", 960, 540);
})()`);
await page.until(`${view}.still`, 60);
const released = await page.evaluate("released"), moved = await page.evaluate("pictures");
const moving = moved.filter((p) => p.at < released), last = moved.at(-1);
const gaps = moving.slice(1).map((p, i) => p.at - moving[i].at).sort((a, b) => a - b);
console.log(`moving: ${(moving.length / Number(seconds)).toFixed(0)} pictures a second, 95 % within ${gaps[Math.floor(0.95 * gaps.length)]?.toFixed(0)} ms, ` +
            `${moving.at(-1)?.width} x ${moving.at(-1)?.height}; whole ${(last.at - released).toFixed(0)} ms after the hand, ` +
            `drawn in ${(1000 * last.drawn_s).toFixed(0)} ms; memory ${(last.memory / 2 ** 20).toFixed(0)} MiB`);
await browser.close();
server.close();
