// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Pages under conditions of all kinds: one thread and several by both modules, `ewa serve`, servers that are slow, that cut, that change a file or
// have one of 5 GB, tabs with little memory, meshes whose pictures the browser decodes. What cannot be shown is said, and the rest goes on.
//   node tests/page/conditions.mjs build/release/cli/ewa SCRATCH       exit status 77: skipped
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { copyFileSync, readFileSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { join } from "node:path";
import { ISOLATED, launch, serve } from "./chromium.mjs";
import {
  browser, check, check_quiet, chromium, ewa, finish, HEAR, HEIGHT, PIXELS, processors, program, same, scratch, SCREEN_HEIGHT, show, shown, view, WIDTH, write_mesh,
} from "./pages.mjs";

const SIZE = `${WIDTH}x${HEIGHT}`;
const site = join(scratch, "site");

ewa("generate", "terrain", "-n", "30000", "-o", "terrain.laz");
ewa("page", "torus.ply", "terrain.laz", "--folder", "site");
ewa("render", "torus.ply", "terrain.laz", "-o", "both.png", "--size", SIZE, "-q");
for (const [from, to] of [["index.js", "index.js"], ["index.html", "drop.html"]])
  copyFileSync(new URL(`../../page/${from}`, import.meta.url), join(site, to));

await check("one thread and several, by both modules, where the page is isolated", async () => {
  for (const exact of [false, true])
    for (const threads of [1, 2, 3]) {
      const folders = { "/": site };
      if (exact) folders["/page-relaxed.wasm.gz"] = { "": join(site, "page.wasm.gz") };
      const server = await serve(folders, ISOLATED);
      const page = await show(`${server.origin}/index.html`, { before: processors(threads) + HEAR });
      same(await page.evaluate(PIXELS), "both.png", `${threads} threads, ${exact ? "exact" : "relaxed"}`);
      assert.equal(await page.evaluate("picture.threads"), threads);
      check_quiet(page, server.origin);
      await page.close();
      server.close();
    }
});

await check("a thread that fails ends the module, which is said", async () => {
  const server = await serve({ "/": site, "/threads.js": { "": join(scratch, "threads.js") } }, ISOLATED);
  const script = readFileSync(join(site, "threads.js"), "utf8");
  writeFileSync(join(scratch, "threads.js"), script.replace("exports.page_thread_begin(threads, number, stack);", "exports.page_thread_failed(threads);"));
  assert.notEqual(script, readFileSync(join(scratch, "threads.js"), "utf8"));
  const page = await browser.page(`${server.origin}/index.html`, { width: WIDTH, height: SCREEN_HEIGHT, before: processors(2) + HEAR });
  assert.ok(await page.until(`self.heard?.find((e) => e.type === "error" && /unreachable/.test(e.reason))`, 20));
  await page.close();
  server.close();
});

await check("ewa serve", async () => {
  const server = spawn(program, ["serve", site, "--port", "0"], { stdio: ["ignore", "pipe", "pipe"] });
  try {
    const address = await new Promise((found, fail) => {
      let said = "";
      const hear = (text) => {
        said += text;
        const match = /http:\/\/\S+:\d+/.exec(said);
        if (match) found(match[0]);
      };
      server.stdout.on("data", hear);
      server.stderr.on("data", hear);
      server.on("exit", () => fail(new Error(`ewa serve has ended: ${said}`)));
    });
    const page = await show(`${address}/index.html`, { before: processors(2) + HEAR });
    same(await page.evaluate(PIXELS), "both.png", "ewa serve");
    assert.equal(await page.evaluate("crossOriginIsolated"), true);
    check_quiet(page, address);
    await page.close();
  } finally {
    server.removeAllListeners("exit");
    server.kill("SIGINT");
  }
});

await check("pictures of meshes, JPEG and WebP, within, beside and as text", async () => {
  ewa("render", "torus.ply", "-o", "the picture.jpg", "--size", "160x120", "--background", "white");
  const drawing = await browser.page("about:blank"), webp = await drawing.evaluate(`(async () => {
    const canvas = new OffscreenCanvas(96, 64), context = canvas.getContext("2d");
    for (let i = 0; i < 96; i++) (context.fillStyle = \`rgb(\${2 * i} \${255 - 2 * i} \${(7 * i) % 256} / \${(5 + i) / 101})\`), context.fillRect(i, 0, 1, 64);
    const blob = await canvas.convertToBlob({ type: "image/webp", quality: 0.9 });
    return btoa(String.fromCharCode(...new Uint8Array(await blob.arrayBuffer())));
  })()`);
  await drawing.close();
  writeFileSync(join(scratch, "picture.webp"), Buffer.from(webp, "base64"));
  write_mesh("bowl.glb", "picture.webp");
  writeFileSync(join(scratch, "square.obj"), "mtllib square.mtl\nusemtl seen\nv -1 0 -1\nv 1 0 -1\nv 1 0.3 1\nv -1 0 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n");
  writeFileSync(join(scratch, "square.mtl"), "newmtl seen\nmap_Kd the picture.jpg\n");
  // Held on its side, as its camera says, which is no matter of a mesh.
  const jpeg = readFileSync(join(scratch, "the picture.jpg")), exif = Buffer.from("ffe10022457869660000" + "49492a0008000000" + "0100" + "120103000100000006000000" + "00000000", "hex");
  writeFileSync(join(scratch, "the picture.jpg"), Buffer.concat([jpeg.subarray(0, 2), exif, jpeg.subarray(2)]));
  // All within one text.
  write_mesh("text.glb", "the picture.jpg");
  const glb = readFileSync(join(scratch, "text.glb")), text_bytes = glb.readUInt32LE(12), body = glb.subarray(28 + text_bytes);
  const text = JSON.parse(glb.toString("utf8", 20, 20 + text_bytes)), { byteOffset, byteLength } = text.bufferViews[3];
  const data = (kind, bytes) => `data:${kind};base64,${bytes.toString("base64")}`;
  text.buffers[0].uri = data("application/octet-stream", body);
  text.images[0] = { uri: data("image/jpeg", body.subarray(byteOffset, byteOffset + byteLength)) };
  writeFileSync(join(scratch, "text.gltf"), JSON.stringify(text));
  const server = await serve({ "/": site, "/data/": scratch });
  for (const name of ["bowl.glb", "square.obj", "text.gltf"]) {
    ewa("render", name, "-o", "mesh.png", "--size", SIZE, "-q");
    const page = await show(`${server.origin}/drop.html?src=data/${name}`);
    same(await page.evaluate(PIXELS), "mesh.png", name);
    check_quiet(page, server.origin);
    await page.close();
  }
  server.close();
});

// ---- Servers that are as servers are

ewa("lod", "terrain.laz", "-o", "terrain.copc.laz");
const levels = readFileSync(join(scratch, "terrain.copc.laz")), torus = readFileSync(join(scratch, "torus.ply"));
const SLOW_BYTES_S = 1e6 / 8, HUGE_BYTES = 5e9;
let version = 1;
const wild = createServer(async (request, response) => {
  const headers = { "access-control-allow-origin": "*", "access-control-expose-headers": "content-range, etag", "access-control-allow-headers": "range" };
  const range = /^bytes=(\d+)-(\d+)$/.exec(request.headers.range ?? "");
  const send = (bytes, total) => {
    if (!range) return response.writeHead(200, { ...headers, "content-length": total }).end(bytes);
    const from = Number(range[1]), to = Math.min(Number(range[2]), total - 1), part = Buffer.alloc(to + 1 - from);
    bytes.copy(part, 0, from);
    return response.writeHead(206, { ...headers, "content-range": `bytes ${from}-${to}/${total}`, etag: `"${version}"` }).end(part);
  };
  if (request.method === "OPTIONS") return response.writeHead(204, headers).end();
  if (request.url === "/slow.ply") {
    response.writeHead(200, { ...headers, "content-length": 250000 });
    const all = torus.subarray(0, 250000);
    for (let at = 0; at < all.length && !response.destroyed; at += SLOW_BYTES_S / 10) {
      response.write(all.subarray(at, at + SLOW_BYTES_S / 10));
      await new Promise((done) => setTimeout(done, 100));
    }
    return response.end();
  }
  if (request.url === "/cut.ply") {
    response.writeHead(200, { ...headers, "content-length": torus.length });
    response.write(torus.subarray(0, 100000));
    return setTimeout(() => response.destroy(), 100);
  }
  if (request.url === "/huge.ply") return response.writeHead(200, { ...headers, "content-length": HUGE_BYTES }).write(torus);
  const scene = /^\/(\w+)\.json$/.exec(request.url);
  if (scene) {
    const text = Buffer.from(JSON.stringify({ ewa_scene: 1, items: [{ file: `${scene[1]}.copc.laz`, levels: "always" }] }));
    return send(text, text.length);
  }
  if (request.url === "/huge.copc.laz") return send(levels, HUGE_BYTES);
  if (request.url === "/changing.copc.laz") {
    version++; // another file for each that asks
    return send(levels, levels.length);
  }
  return response.writeHead(404, headers).end();
});
await new Promise((done) => wild.listen(0, "127.0.0.1", done));
const wild_origin = `http://127.0.0.1:${wild.address().port}`;

await check("slow, cut, 5 GB, changing", async () => {
  const server = await serve({ "/": site }), page = await show(`${server.origin}/index.html`);
  const before = await page.evaluate(PIXELS);
  const fails = async (name, reason) => {
    await page.evaluate(`(heard.length = 0, ${view}.open("${wild_origin}/${name}"))`);
    assert.match((await page.until(`heard.find((e) => e.type === "error")`, 20)).reason, reason);
    await page.until(`${view}.still`, 20);
    assert.equal(await page.evaluate(PIXELS), before, `${name}: what was there`);
  };
  await fails("cut.ply", /cut after 1\d{5} of \d{6} bytes/);
  await fails("huge.ply", /5\.0 GB.*octree/);
  // 2 s at 1 Mbit/s: how far it is can be seen, and the hand turns what is there.
  await page.evaluate(`(heard.length = 0, ${view}.open("${wild_origin}/slow.ply"))`);
  await page.until(`${view}.shadowRoot.querySelector(".status progress").value > 0.1`, 10);
  const camera = await page.evaluate(`${view}.camera()`);
  await page.evaluate(`${view}.do("view top")`);
  await page.until(`${view}.camera().then((now) => now !== ${JSON.stringify(camera)})`, 5);
  assert.equal(await page.evaluate(`${view}.still`), false);
  assert.ok(await page.until(`heard.find((e) => e.type === "error")`, 20)); // it ends before its points do
  await page.close();
  server.close();
});

await check("octrees of 5 GB, and one that is another file by now", async () => {
  const server = await serve({ "/": site });
  writeFileSync(join(scratch, "levels.json"), JSON.stringify({ ewa_scene: 1, items: [{ file: "terrain.copc.laz", levels: "always" }] }));
  ewa("render", "levels.json", "-o", "levels.png", "--size", SIZE, "-q");
  const page = await show(`${server.origin}/drop.html?src=${wild_origin}/huge.json`);
  same(await page.evaluate(PIXELS), "levels.png", "5 GB");
  assert.deepEqual(page.complaints, []);
  // Its head is of one version, what is read later of another.
  await page.evaluate(`(heard.length = 0, ${view}.open("${wild_origin}/changing.json"))`);
  assert.match((await page.until(`heard.find((e) => e.type === "error")`, 20)).reason, /changing.copc.laz.*changed on the server/s);
  await page.until(`${view}.still`, 20);
  same(await page.evaluate(PIXELS), "levels.png", "what was there");
  await page.close();
  server.close();
});
wild.closeAllConnections();
wild.close();

await check("a tab with little memory", async () => {
  const small = await launch(chromium, ["--js-flags=--wasm-max-mem-pages=400"]);
  try {
    ewa("generate", "torus", "-n", "300000", "-o", "large.ply");
    const server = await serve({ "/": site, "/data/": scratch }), page = await small.page(`${server.origin}/drop.html?src=data/torus.ply`, { width: WIDTH, height: SCREEN_HEIGHT, before: HEAR });
    await shown(page);
    await page.evaluate(`(heard.length = 0, ${view}.open("data/large.ply"))`);
    assert.match((await page.until(`heard.find((e) => e.type === "error")`, 30)).reason, /memory/);
    server.close();
  } finally {
    await small.close();
  }
});

await finish();
