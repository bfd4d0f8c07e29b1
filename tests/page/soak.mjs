// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Whether memory stays flat while a file is looked at for long: a hand turns it and goes near and far, a step each second, and lets go every ten.
// Prints the module's memory, the scripts' (measureUserAgentSpecificMemory(), all workers in it) and the tab's as the system counts it, and what was sent.
//   node tests/page/soak.mjs build/release/page FILE [MINUTES [exact|relaxed]]
// The modules are those of build/wasm and build/wasm-relaxed beside it.
import { readdirSync, readFileSync } from "node:fs";
import { basename, dirname, join, resolve } from "node:path";
import { ISOLATED, launch, serve } from "./chromium.mjs";

const [folder, file, minutes = "30", kind] = process.argv.slice(2);
const build = resolve(folder, "../.."), exact = join(build, "wasm/page/page.wasm.gz");
const server = await serve({ "/": resolve(folder), "/data/": dirname(resolve(file)), "/page.wasm.gz": { "": exact },
                             "/page-relaxed.wasm.gz": { "": kind === "exact" ? exact : join(build, "wasm-relaxed/page/page.wasm.gz") } }, ISOLATED);
const browser = await launch();
const page = await browser.page(`${server.origin}/index.html?src=data/${encodeURIComponent(basename(file))}`, {
  width: 1280, height: 800,
  before: `Object.defineProperty(navigator, "hardwareConcurrency", { get: () => 1 }); self.pictures = 0;
    document.addEventListener("picture", ({ detail }) => { self.pictures++; self.picture = detail; }, true);`,
});
const view = `document.querySelector("ewa-view")`;
await page.until(`${view}.still && self.picture?.still`, 300);
await page.evaluate(`(() => { const stage = ${view}.shadowRoot.querySelector(".stage");
  stage.setPointerCapture = () => {};
  self.hand = (type, x, y) => stage.dispatchEvent(new PointerEvent(type, { pointerId: 1, clientX: x, clientY: y, button: 0, pointerType: "mouse" }));
  self.wheel = (notches) => stage.dispatchEvent(new WheelEvent("wheel", { deltaY: -100 * notches, clientX: 640, clientY: 400, cancelable: true })); })()`);

/// Resident memory of the browser's largest process that draws pages, in MiB.
function tab_mib() {
  let most = 0;
  for (const id of readdirSync("/proc").filter((name) => /^\d+$/.test(name))) {
    try {
      if (!readFileSync(`/proc/${id}/cmdline`, "utf8").includes(`--type=renderer`)) continue;
      most = Math.max(most, Number(/VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${id}/status`, "utf8"))[1]) / 1024);
    } catch {
      // It has ended.
    }
  }
  return most;
}

async function tell(minute) {
  await page.call("HeapProfiler.collectGarbage");
  const module_mib = (await page.evaluate("picture.memory")) / 2 ** 20, said = page.evaluate("performance.measureUserAgentSpecificMemory().then((m) => m.bytes)");
  const all = await Promise.race([said, new Promise((done) => setTimeout(done, 90000, NaN))]);
  const page_mib = (await page.call("Runtime.getHeapUsage")).usedSize / 2 ** 20;
  console.log(`${minute.toFixed(1)} min: module ${module_mib.toFixed(0)} MiB, page's script ${page_mib.toFixed(1)} MiB, all scripts ` +
              `${(all / 2 ** 20).toFixed(0)} MiB, tab ${tab_mib().toFixed(0)} MiB, ${await page.evaluate("pictures")} pictures, ${(server.bytes() / 1e6).toFixed(0)} MB sent`);
}

const began = Date.now(), minute = () => (Date.now() - began) / 60000;
let due = 0;
for (let step = 0; minute() < Number(minutes); step++) {
  const x = 640 + 350 * Math.sin(step / 9), y = 400 + 120 * Math.sin(step / 23);
  if (step % 10 === 0) await page.evaluate(`hand("pointerdown", ${x}, ${y})`);
  await page.evaluate(`hand("pointermove", ${x}, ${y})`);
  if (step % 10 === 9) await page.evaluate(`(hand("pointerup", ${x}, ${y}), ${view}.focus(), wheel(${step % 120 < 60 ? 2 : -2}))`);
  if (minute() >= due) {
    await tell(minute());
    due += 5;
  }
  await new Promise((done) => setTimeout(done, 1000));
}
await page.until(`${view}.still`, 120);
await tell(minute());
if (page.complaints.length) console.log(page.complaints.join("\n"));
await browser.close();
server.close();
