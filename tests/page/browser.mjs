// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Pages of `ewa page` in a browser: they show the bytes of `ewa render`, alone as a file and from a server, by both modules; the hand does
// what it does in the window; what is wrong is said; nothing complains and nobody else is asked.
//   node tests/page/browser.mjs build/release/cli/ewa SCRATCH [PICTURES]       exit status 77: skipped
import assert from "node:assert/strict";
import { copyFileSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { Bytes, Files } from "../../page/files.js";
import { Ranges } from "../../page/ranges.js";
import { ISOLATED, serve } from "./chromium.mjs";
import {
  browser, check, check_quiet, decode, ewa, finish, HEAR, HEIGHT, keep, part, PIXELS, same, scratch, SCREEN_HEIGHT, show, shown, TITLE, view, WIDTH, write_ept, write_kinds,
} from "./pages.mjs";

// ---- What is shown

const kinds = write_kinds();

// Two at a time: one is parsed while the other is drawn.
const check_kind = (kind) => check(`${kind} is what ewa render draws`, async () => {
  const name = kind.replace(/\W/g, "_");
  ewa("render", kind, "-o", `${name}.png`, "--size", `${WIDTH}x${HEIGHT}`, "-q");
  ewa("page", kind, "-o", `${name}.html`, "-q");
  const url = pathToFileURL(join(scratch, `${name}.html`)).href, page = await show(url);
  same(await page.evaluate(PIXELS), `${name}.png`, kind);
  check_quiet(page, url);
  await page.close();
});
const half = Math.ceil(kinds.length / 2), in_turn = async (list) => {
  for (const kind of list) await check_kind(kind);
};
await Promise.all([in_turn(kinds.slice(0, half)), in_turn(kinds.slice(half))]);

await check("the exact module, a server, isolated or not", async () => {
  for (const [headers, exact] of [[{}, false], [ISOLATED, true]]) {
    rmSync(join(scratch, "site"), { recursive: true, force: true });
    ewa("page", "torus.ply", "terrain.laz", "--folder", "site");
    ewa("render", "torus.ply", "terrain.laz", "-o", "both.png", "--size", `${WIDTH}x${HEIGHT}`, "-q");
    if (exact) copyFileSync(join(scratch, "site/page.wasm.gz"), join(scratch, "site/page-relaxed.wasm.gz"));
    const server = await serve({ "/": join(scratch, "site") }, headers), page = await show(`${server.origin}/index.html`);
    same(await page.evaluate(PIXELS), "both.png", "site");
    assert.equal(await page.evaluate("crossOriginIsolated"), exact);
    check_quiet(page, server.origin);
    await page.close();
    server.close();
  }
});

await check("parts of an octree, servers that give none, and those of other sites", async () => {
  const levels = join(scratch, "levels");
  mkdirSync(levels);
  ewa("lod", "torus.ply", "-o", "levels/torus.copc.laz");
  writeFileSync(join(levels, "scene.json"), JSON.stringify({ ewa_scene: 1, items: [{ file: "torus.copc.laz", levels: "always" }] }));
  ewa("render", "levels/scene.json", "-o", "levels.png", "--size", `${WIDTH}x${HEIGHT}`, "-q");
  const site = { "/": join(scratch, "site"), "/levels/": levels };
  for (const [from, to] of [["index.js", "index.js"], ["index.html", "drop.html"]])
    copyFileSync(new URL(`../../page/${from}`, import.meta.url), join(scratch, "site", to));
  for (const ranges of [true, false]) {
    const server = await serve(site, {}, ranges), page = await show(`${server.origin}/drop.html?src=levels/scene.json`);
    same(await page.evaluate(PIXELS), "levels.png", ranges ? "parts" : "the whole");
    check_quiet(page, server.origin);
    await page.close();
    server.close();
  }
  const page_server = await serve(site), open = await serve({ "/": levels }, { "access-control-allow-origin": "*" }), closed = await serve({ "/": levels });
  const page = await show(`${page_server.origin}/drop.html?src=${open.origin}/scene.json`);
  same(await page.evaluate(PIXELS), "levels.png", "another site");
  check_quiet({ ...page, requests: [] });
  // A site that lets no other one read it, and a name that leads nowhere, are said; the browser says it, too.
  for (const [address, said] of [[`${closed.origin}/scene.json`, "CORS"], [`${page_server.origin}/levels/none.ply`, "404"]]) {
    await page.evaluate(`(heard.length = 0, ${view}.open(${JSON.stringify(address)}))`);
    assert.match((await page.until(`heard.find((e) => e.type === "error")`, 10)).reason, new RegExp(said));
  }
  await page.close();
  for (const server of [page_server, open, closed]) server.close();
});

await check("an octree in a folder (EPT): what is seen of it", async () => {
  const nodes = write_ept("levels/hill", 8), server = await serve({ "/": join(scratch, "site"), "/levels/": join(scratch, "levels") });
  const is_node = (path) => path.startsWith("/levels/hill/ept-data/");
  // As an address, all of it, and each file once.
  ewa("render", "levels/hill/ept.json", "-o", "hill.png", "--size", `${WIDTH}x${HEIGHT}`, "-q");
  const page = await show(`${server.origin}/drop.html?src=levels/hill/ept.json`);
  assert.deepEqual((await page.evaluate("heard")).filter((e) => e.type === "error"), []);
  same(await page.evaluate(PIXELS), "hill.png", "the whole");
  assert.equal(server.asked.filter(is_node).length, nodes);
  assert.equal(new Set(server.asked.filter(is_node)).size, nodes);
  check_quiet(page, server.origin);
  await page.close();
  // By levels, near one corner: the nodes that are seen, and those of the upper levels, by whose points a camera is placed as long as these are
  // 400,000 (EWA_OCTREE_SAMPLE_POINTS).
  write_ept("levels/fine", 72);
  ewa("render", "levels/fine", "-o", "near.png", "--size", `${WIDTH}x${HEIGHT}`, "-q", "--eye", "0,0,0.9", "--target", "0.1,0.1,0.5", "--save-camera", "near_camera.json");
  const camera = JSON.parse(readFileSync(join(scratch, "near_camera.json"), "utf8"));
  writeFileSync(join(scratch, "levels/near.json"), JSON.stringify({ ewa_scene: 1, items: [{ file: "fine", levels: "always" }], camera }));
  ewa("render", "levels/near.json", "-o", "near.png", "--size", `${WIDTH}x${HEIGHT}`, "-q");
  const before = server.asked.length, near = await show(`${server.origin}/drop.html?src=levels/near.json`);
  assert.deepEqual((await near.evaluate("heard")).filter((e) => e.type === "error"), []);
  same(await near.evaluate(PIXELS), "near.png", "what is seen");
  const seen = server.asked.slice(before).filter((path) => path.startsWith("/levels/fine/ept-data/")).length;
  assert.ok(seen > 0 && seen < nodes, `${seen} of ${nodes} nodes`);
  check_quiet(near, server.origin);
  await near.close();
  // A node that is not there is named.
  rmSync(join(scratch, "levels/hill/ept-data/1-0-0-1.bin"));
  const broken = await browser.page(`${server.origin}/drop.html?src=levels/hill/ept.json`, { width: WIDTH, height: SCREEN_HEIGHT, before: HEAR });
  assert.match((await broken.until(`heard.find((e) => e.type === "error")`, 10)).reason, /1-0-0-1\.bin.*404/s);
  await broken.close();
  server.close();
});

await check("files that are found are kept within a bound, the last ones", async () => {
  const asked = [], files = new Files((path) => (asked.push(path), new Bytes(new Uint8Array(2 ** 20))));
  for (let i = 0; i < 40; i++) files.lookup(`a/${i}`), files.lookup("a/0");
  assert.equal(asked.length, 40);
  assert.ok(files.found_bytes === 2 ** 25 && files.found.size === 32, `${files.found_bytes} bytes`);
  for (const path of ["a/39", "a/0", "a/1"]) files.lookup(path);
  assert.deepEqual(asked.slice(40), ["a/1"]);
});

await check("what overlaps what was read is not asked for again", async () => {
  const file = Uint8Array.from({ length: 1500000 }, (_, i) => (i * 2654435761) >>> 24), asked = [];
  class Local extends Ranges {
    fetch(from, to) {
      asked.push(to - from);
      return file.slice(from, to);
    }
  }
  const ranges = new Local("", file.length, null, file.subarray(0, 4 << 16));
  const read = (at, size) => {
    const into = new Uint8Array(size);
    for (let got = 0; got < size; ) got += ranges.read(at + got, into.subarray(got));
    assert.deepEqual(into, file.subarray(at, at + size));
    return asked.splice(0);
  };
  assert.deepEqual(read(1525, 700000), [1525 + 700000 - (4 << 16)]); // its first bytes are there
  assert.deepEqual(read(900000, 65536), [65536]);
  assert.deepEqual(read(900060, 65476), []);
  assert.deepEqual(read(900060, 156832), [156832 - 65476]);
  assert.deepEqual(read(1200000, 10), [65536]);
  assert.deepEqual(read(1199900, 2000), []);
  assert.deepEqual(read(1499990, 10), [file.length % 65536]);
});

await check("a server is asked for what is shown, and for nothing else", async () => {
  const server = await serve({ "/": join(scratch, "site"), "/levels/": join(scratch, "levels") });
  const page = await show(`${server.origin}/drop.html?src=levels/scene.json`);
  const asked = server.asked.length;
  const camera = await page.evaluate(`${view}.camera()`);
  assert.ok(await page.evaluate(`${view}.set_camera(${JSON.stringify(camera)})`));
  assert.ok(await page.evaluate(`${view}.shot({ width: 40, height: 30 }).then((blob) => blob.size)`));
  await page.evaluate(`${part('[data-do="share"]')}.click()`);
  await page.until(`heard.find((e) => e.type === "share")`);
  assert.deepEqual(server.asked.slice(asked), []);
  // Two files of one name are two.
  for (const [folder, count] of [["a", "300"], ["b", "500"]]) {
    mkdirSync(join(scratch, "levels", folder));
    ewa("generate", "torus", "-n", count, "-o", `levels/${folder}/one.ply`);
  }
  await page.evaluate(`${view}.open("levels/a/one.ply", "levels/b/one.ply")`);
  await page.until(`${view}.items().then((items) => items.length === 3)`);
  const counts = await page.evaluate(`${view}.items().then((items) => items.slice(1).map((item) => item.count))`);
  assert.ok(counts[0] && counts[1] && counts[0] !== counts[1], counts.join());
  // Files that several items share are fetched once, also with what they name themselves.
  writeFileSync(join(scratch, "levels/twice.json"), JSON.stringify({
    ewa_scene: 1, items: [{ file: "b/one.ply" }, { file: "a/one.ply" }, { file: "b/one.ply", to_world: [1, 0, 0, 3, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1] }],
  }));
  const before = server.asked.length;
  await page.evaluate(`(heard.length = 0, ${view}.setAttribute("src", "levels/twice.json"))`);
  await shown(page);
  assert.equal(await page.evaluate(`heard.find((e) => e.type === "error")?.reason`), undefined);
  const of_scene = server.asked.slice(before).filter((path) => path.startsWith("/levels"));
  assert.deepEqual([...of_scene].sort(), ["/levels/a/one.ply", "/levels/b/one.ply", "/levels/twice.json"]);
  // Another file takes the place of what was open; with none, nothing is.
  assert.deepEqual(await page.evaluate(`${view}.items().then((items) => items.map((item) => item.count))`), [counts[1], counts[0], counts[1]]);
  const left = await page.evaluate(`(() => { const asked = ${view}.shot().catch((e) => e.message); ${view}.removeAttribute("src"); return asked; })()`);
  assert.match(left, /another file is opened/);
  assert.match(await page.evaluate(`${view}.items().catch((e) => e.message)`), /nothing is open/);
  assert.match(await page.evaluate(`${part(".hint")}.textContent`), /Drop/);
  // A side to be seen from where nothing is: said, and no complaint.
  await page.evaluate(`(() => { const s = ${part('[data-do="view"]')}; s.value = "front"; s.dispatchEvent(new Event("change")); })()`);
  await page.until(`heard.find((e) => e.type === "error" && e.reason === "nothing is open")`);
  check_quiet(page, server.origin);
  await page.close();
  server.close();
});

await check("the hand while a server is slow, and a module that ends", async () => {
  const waiting = [], slow = createServer((request, response) => waiting.push(response));
  await new Promise((done) => slow.listen(0, "127.0.0.1", done));
  const server = await serve({ "/": join(scratch, "site") }), page = await show(`${server.origin}/drop.html?src=scene.json`);
  const before = await page.evaluate(`${view}.camera()`);
  await page.evaluate(`(heard.length = 0, ${view}.open("http://127.0.0.1:${slow.address().port}/slow.ply"))`);
  for (let i = 0; !waiting.length && i < 200; i++) await new Promise((done) => setTimeout(done, 20));
  await page.evaluate(`${view}.do("view top")`);
  await page.until(`${view}.camera().then((camera) => camera !== ${JSON.stringify(before)})`, 10);
  await new Promise((done) => setTimeout(done, 300));
  assert.equal(await page.evaluate(`${view}.still`), false);
  waiting.forEach((response) => response.writeHead(404, { "access-control-allow-origin": "*" }).end());
  await page.until(`heard.find((e) => e.type === "error" && e.reason.includes("404"))`, 10);
  await page.until(`${view}.still`, 10);
  await page.close();
  slow.closeAllConnections();
  slow.close();
  // A trap while something is asked ends the module, and is no answer.
  const worker = readFileSync(join(scratch, "site/worker.js"), "utf8");
  writeFileSync(join(scratch, "site/worker.js"), worker + "answers.items = () => { throw new WebAssembly.RuntimeError('unreachable'); };\n");
  const trapped = await show(`${server.origin}/drop.html?src=scene.json`);
  assert.match(await trapped.evaluate(`${view}.items().catch((e) => e.message)`), /unreachable/);
  assert.ok(await trapped.until(`heard.find((e) => e.type === "error" && e.reason === "unreachable")`, 10));
  assert.match(await trapped.evaluate(`${view}.camera().catch((e) => e.message)`), /nothing is open/);
  check_quiet(trapped, server.origin);
  writeFileSync(join(scratch, "site/worker.js"), worker);
  await trapped.close();
  server.close();
});

await check("hand and keys", async () => {
  const url = pathToFileURL(join(scratch, "torus.html")).href, page = await show(url);
  const mouse = (type, x, y, more = {}) => page.call("Input.dispatchMouseEvent", { type, x, y: y + TITLE, button: "left", clickCount: 1, ...more });
  await mouse("mousePressed", 120, 150);
  await mouse("mouseReleased", 120, 150);
  const pick = await page.until(`heard.find((e) => e.type === "pick")`);
  // The window says the same of a click there.
  writeFileSync(join(scratch, "click.txt"), "do open torus.ply\npress 120 150 left\nrelease 120 150 left\n");
  const said = ewa("view", "--size", `${WIDTH}x${HEIGHT}`, "--script", "click.txt");
  assert.match(said, /^pick torus.ply point \d+ at /m);
  const [, number, at] = /point (\d+) at (\S+ \S+ \S+)/.exec(said);
  assert.match(pick.text, new RegExp(`^point ${number} of torus.ply\nat ${at.replace(/[.+]/g, "\\$&")}\n`));
  assert.deepEqual(pick.place, at.split(" ").map(Number).map((x, i) => pick.place[i] && Math.abs(pick.place[i] - x) < 1e-6 ? pick.place[i] : x));
  assert.equal(await page.evaluate(`${part(".card")}.hidden`), false);
  await mouse("mousePressed", 280, 150, { modifiers: 8 });
  await mouse("mouseReleased", 280, 150, { modifiers: 8 });
  const measure = await page.until(`heard.find((e) => e.type === "measure")`);
  assert.ok(Math.abs(measure.distance - Math.hypot(...measure.to.map((x, i) => x - pick.place[i]))) < 1e-9);
  await keep(page, "measured.png");
  // A drag, the wheel and keys end in the picture that the camera has.
  await page.evaluate(`${view}.do("clear")`);
  await mouse("mousePressed", 200, 150);
  for (let x = 200; x <= 260; x += 20) await mouse("mouseMoved", x, 140, { buttons: 1 });
  await mouse("mouseReleased", 260, 140);
  await page.call("Input.dispatchMouseEvent", { type: "mouseWheel", x: 150, y: 150, deltaX: 0, deltaY: -200 });
  for (const key of ["ArrowLeft", "+"]) {
    await page.call("Input.dispatchKeyEvent", { type: "keyDown", key, text: key.length === 1 ? key : undefined });
    await page.call("Input.dispatchKeyEvent", { type: "keyUp", key });
  }
  writeFileSync(join(scratch, "camera.json"), await page.evaluate(`${view}.camera()`));
  await page.until(`${view}.still`);
  ewa("render", "torus.ply", "--camera", "camera.json", "-o", "turned.png");
  same(await page.evaluate(PIXELS), "turned.png", "the turned camera");
  // The link leads back to it.
  await page.evaluate(`${part('[data-do="share"]')}.click()`);
  const shared = await page.until(`heard.find((e) => e.type === "share")`);
  const again = await show(shared.url);
  await again.until(`${view}.still`);
  await new Promise((done) => setTimeout(done, 200));
  await again.until(`${view}.still`);
  same(await again.evaluate(PIXELS), "turned.png", "the link");
  check_quiet(page, url);
  check_quiet(again, url);
  await again.close();
  await page.close();
});

await check("fingers on a phone", async () => {
  const url = pathToFileURL(join(scratch, "terrain_laz.html")).href, page = await show(url, { width: 390, height: 844, touch: true });
  const touch = (type, ...points) => page.call("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
  const before = await page.evaluate(`${view}.camera()`);
  await touch("touchStart", [150, 400], [250, 400]);
  for (let i = 1; i <= 5; i++) await touch("touchMove", [150 - 10 * i, 400], [250 + 10 * i, 400 + i]);
  await touch("touchEnd");
  await touch("touchStart", [200, 420]);
  for (let i = 1; i <= 5; i++) await touch("touchMove", [200 + 10 * i, 420]);
  await touch("touchEnd");
  const after = await page.evaluate(`${view}.camera()`);
  assert.notEqual(after, before);
  writeFileSync(join(scratch, "touched.json"), after);
  await page.until(`${view}.still`);
  ewa("render", "terrain.laz", "--camera", "touched.json", "-o", "touched.png");
  same(await page.evaluate(PIXELS), "touched.png", "the touched camera");
  assert.ok(await page.evaluate(`document.documentElement.scrollWidth <= innerWidth`), "wider than the phone");
  const buttons = await page.evaluate(`[...${view}.shadowRoot.querySelectorAll(".bar button, .bar select")].map((e) => {
    const box = e.getBoundingClientRect(); return [e.getAttribute("aria-label"), box.width, box.height, box.right, box.bottom]; })`);
  for (const [label, wide, high, right, bottom] of buttons.filter((b) => b[1])) {
    assert.ok(label && wide >= 24 && high >= 44, `${label}: ${wide} x ${high}`);
    assert.ok(right <= 390 && bottom <= 844, `${label} is outside`);
  }
  const [under, bar] = await page.evaluate(`[${part("canvas")}.getBoundingClientRect().bottom, ${part(".bar")}.getBoundingClientRect().top]`);
  assert.equal(under, bar, "the picture ends where the bar begins");
  const [title, over] = await page.evaluate(`[document.querySelector("h1").getBoundingClientRect().bottom, ${part("canvas")}.getBoundingClientRect().top]`);
  assert.equal(title, over, "the picture begins where the title ends");
  await keep(page, "phone.png");
  check_quiet(page, url);
  await page.close();
});

await check("what is wrong is said, and what was there stays", async () => {
  const url = pathToFileURL(join(scratch, "torus.html")).href, page = await show(url);
  const wrong = { "broken.ply": "ply\nformat ascii 1.0\nelement vertex 3\n", "words.txt": "these are words", "scan.las": "LASF", "gone.json": "{\"ewa_scene\": 1, \"items\": [{\"file\": \"nowhere.ply\"}]}" };
  for (const [name, text] of Object.entries(wrong)) {
    await page.evaluate(`(heard.length = 0, ${view}.open({ name: ${JSON.stringify(name)}, text: ${JSON.stringify(Buffer.from(text).toString("base64"))} }))`);
    const error = await page.until(`heard.find((e) => e.type === "error")`, 10);
    assert.ok(error.reason.length > 8, name);
    assert.match(await page.evaluate(`${part(".error")}.textContent`), new RegExp(name.replace(".", "\\.") + "|nowhere"));
    assert.equal(await page.evaluate(`${part(".error")}.hidden`), false);
  }
  await keep(page, "wrong.png");
  await page.until(`${view}.still`);
  ewa("render", "torus.ply", "-o", "torus.png", "--size", `${WIDTH}x${HEIGHT}`);
  same(await page.evaluate(PIXELS), "torus.png", "what was there");
  check_quiet(page, url);
  await page.close();
});

await check("E57 as it is", async () => {
  copyFileSync(new URL("../fuzz/corpus/e57/scans.e57", import.meta.url), join(scratch, "scans.e57"));
  const server = await serve({ "/": join(scratch, "site"), "/data/": scratch }), page = await show(`${server.origin}/drop.html?src=data/scans.e57`);
  ewa("render", "scans.e57", "-o", "scans.png", "--size", `${WIDTH}x${HEIGHT}`, "-q");
  same(await page.evaluate(PIXELS), "scans.png", "scans.e57");
  check_quiet(page, server.origin);
  await page.close();
  server.close();
});

await check("attributes, the measure button, the whole screen", async () => {
  const server = await serve({ "/": join(scratch, "site"), "/data/": scratch }), page = await show(`${server.origin}/drop.html?src=data/terrain.laz`);
  const camera = await page.evaluate(`${view}.camera()`);
  const shows = async (attributes, ...options) => {
    await page.evaluate(`for (const [name, value] of Object.entries(${JSON.stringify(attributes)})) ${view}.setAttribute(name, value)`);
    await page.evaluate(`${view}.do("set color_bar off")`); // of which the letters are the window's
    await new Promise((done) => setTimeout(done, 100));
    await page.until(`${view}.still`);
    ewa("render", "terrain.laz", ...options, "-o", "shown.png", "--size", `${WIDTH}x${HEIGHT}`, "-q");
    same(await page.evaluate(PIXELS), "shown.png", Object.keys(attributes).join());
    await page.evaluate(`for (const name of ${JSON.stringify(Object.keys(attributes))}) ${view}.removeAttribute(name)`);
  };
  await shows({ "color-by": "position.z" }, "--color-by", "position.z");
  await shows({ background: "#203040" }, "--background", "#203040");
  await shows({ "point-size": "3" }, "--point-size", "3");
  const farther = JSON.parse(camera);
  farther.world_to_camera[11] += 1.5;
  writeFileSync(join(scratch, "given.json"), JSON.stringify(farther));
  await shows({ camera: JSON.stringify(farther) }, "--camera", "given.json");
  await page.until(`${view}.set_camera(${JSON.stringify(camera)})`);
  const click = async (x, y) => {
    for (const type of ["mousePressed", "mouseReleased"]) await page.call("Input.dispatchMouseEvent", { type, x, y, button: "left", clickCount: 1 });
  };
  const press = async (name) => {
    const [x, y] = await page.evaluate(`(() => { const b = ${part(`[data-do="${name}"]`)}.getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2]; })()`);
    await click(x, y);
  };
  await click(200, 170);
  await page.until(`heard.find((e) => e.type === "pick")`, 10);
  await press("measure");
  await click(215, 92); // above what is said of the pick
  assert.ok((await page.until(`heard.find((e) => e.type === "measure")`, 10)).distance > 0);
  await page.call("Emulation.setDeviceMetricsOverride", { width: 800, height: 600, deviceScaleFactor: 1, mobile: false });
  await press("full");
  await page.until(`document.fullscreenElement === ${view}`, 10);
  check_quiet(page, server.origin);
  await page.close();
  server.close();
});

await check("a file that is dropped, and a module that is none", async () => {
  const server = await serve({ "/": join(scratch, "site"), "/data/": scratch });
  const page = await browser.page(`${server.origin}/drop.html`, { width: WIDTH, height: SCREEN_HEIGHT, before: HEAR });
  await page.until(`self.heard && ${part(".hint")}.textContent.includes("Drop")`);
  await page.evaluate(`(async () => {
    const bytes = await (await fetch("data/terrain.copc.laz")).arrayBuffer(), drop = new DataTransfer();
    drop.items.add(new File([bytes], "terrain.copc.laz"));
    ${view}.dispatchEvent(new DragEvent("drop", { dataTransfer: drop, bubbles: true, cancelable: true }));
  })()`);
  await shown(page);
  same(await page.evaluate(PIXELS), "terrain_copc_laz.png", "what was dropped");
  check_quiet(page, server.origin);
  await page.close();
  // As where there is no SIMD: an instruction that is none.
  const broken = Buffer.from([0, 97, 115, 109, 1, 0, 0, 0, 1, 4, 1, 96, 0, 0, 3, 2, 1, 0, 10, 5, 1, 3, 0, 255, 11]);
  for (const name of ["page.wasm.gz", "page-relaxed.wasm.gz"]) writeFileSync(join(scratch, "site", name), broken);
  const old = await browser.page(`${server.origin}/index.html`, { width: WIDTH, height: SCREEN_HEIGHT, before: HEAR });
  assert.match((await old.until(`self.heard?.find((e) => e.type === "error")`, 10)).reason, /no WebAssembly with SIMD/);
  await keep(old, "old.png");
  await old.close();
  server.close();
});

await check("colours, box, pictures", async () => {
  const url = pathToFileURL(join(scratch, "terrain_laz.html")).href, page = await show(url);
  await page.evaluate(`(() => { const s = ${part('[data-do="color"]')}; s.value = "intensity"; s.dispatchEvent(new Event("change")); })()`);
  await page.evaluate(`${part('[data-do="box"]')}.click()`);
  await page.until(`${view}.still`);
  assert.equal((await page.evaluate(`${view}.items()`))[0].color, "intensity");
  await keep(page, "coloured.png");
  await page.evaluate(`${view}.do("box off")`);
  await page.evaluate(`${view}.do("set color_bar off")`);
  const png = await page.evaluate(`${view}.shot({ width: 320, height: 240 }).then((blob) => blob.arrayBuffer()).then((b) => btoa(String.fromCharCode(...new Uint8Array(b))))`);
  writeFileSync(join(scratch, "shot.png"), Buffer.from(png, "base64"));
  ewa("render", "terrain.laz", "--color-by", "intensity", "-o", "intensity.png", "--size", "320x240");
  same(decode(join(scratch, "shot.png")).toString("base64"), "intensity.png", "a saved picture");
  check_quiet(page, url);
  await page.close();
});

await finish();
