// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What tests of pages share: the program, a browser, pages whose pixels are held to pictures of `ewa render`, and what is checked of each.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { inflateSync } from "node:zlib";
import { launch } from "./chromium.mjs";

export const [program, scratch, pictures] = process.argv.slice(2).map((path) => resolve(path));
export const WIDTH = 400, HEIGHT = 300;
/// On a screen this narrow the bar is under the picture, and the title, where a page has one, above it.
export const TITLE = 36, SCREEN_HEIGHT = HEIGHT + 53;

function skip(why) {
  console.log(`skipped: ${why}`);
  process.exit(77);
}

export const chromium = ["chromium", "chromium-browser", "google-chrome"].find((name) => {
  try {
    return execFileSync("sh", ["-c", `command -v ${name}`]).length > 0;
  } catch {
    return false;
  }
});
if (!chromium) skip("there is no Chromium (Debian: apt install chromium)");

export const ewa = (...words) => execFileSync(program, words, { cwd: scratch, encoding: "utf8", stdio: ["ignore", "pipe", "pipe"] });

rmSync(scratch, { recursive: true, force: true });
mkdirSync(scratch, { recursive: true });
try {
  ewa("generate", "torus", "-n", "20000", "-o", "torus.ply");
  ewa("page", "torus.ply", "-o", "torus.html", "--title", "A torus");
} catch (error) {
  if (/make wasm/.test(error.stderr)) skip("there is no module for pages (make wasm)");
  throw error;
}

export const browser = await launch(chromium);

const failures = [];
export async function check(what, run) {
  const began = performance.now();
  try {
    await run();
    console.log(`${what}: ${(performance.now() - began).toFixed(0)} ms`);
  } catch (error) {
    failures.push(what);
    console.log(`${what}: ${error.stack}`);
  }
}

/// Ends the test.
export async function finish() {
  await browser.close();
  if (!failures.length) return;
  console.log(`${failures.length} failed`);
  process.exit(1);
}

export async function show(url, options) {
  const page = await browser.page(url, { width: WIDTH, height: SCREEN_HEIGHT + (/drop\.html/.test(url) ? 0 : TITLE), before: HEAR, ...options });
  await shown(page);
  return page;
}

/// Pixels of a PNG of 8-bit RGB or RGBA as RGBA.
export function decode(path) {
  const png = readFileSync(path), parts = [];
  let width, height, channels;
  for (let at = 8; at < png.length; ) {
    const size = png.readUInt32BE(at), kind = png.toString("latin1", at + 4, at + 8), data = png.subarray(at + 8, at + 8 + size);
    if (kind === "IHDR") [width, height, channels] = [data.readUInt32BE(0), data.readUInt32BE(4), data[9] === 6 ? 4 : 3];
    if (kind === "IDAT") parts.push(data);
    at += size + 12;
  }
  const rows = inflateSync(Buffer.concat(parts)), row_bytes = width * channels, out = Buffer.alloc(4 * width * height, 255);
  let above = Buffer.alloc(row_bytes);
  for (let y = 0; y < height; y++) {
    const filter = rows[y * (row_bytes + 1)], row = Buffer.from(rows.subarray(y * (row_bytes + 1) + 1, (y + 1) * (row_bytes + 1)));
    for (let i = 0; i < row_bytes; i++) {
      const a = i >= channels ? row[i - channels] : 0, b = above[i], c = i >= channels ? above[i - channels] : 0;
      const p = a + b - c, near = [a, b, c].sort((m, n) => Math.abs(p - m) - Math.abs(p - n) || [a, b, c].indexOf(m) - [a, b, c].indexOf(n))[0];
      row[i] += [0, a, b, (a + b) >> 1, near][filter];
    }
    for (let x = 0; x < width; x++) row.copy(out, 4 * (y * width + x), channels * x, channels * (x + 1));
    above = row;
  }
  return out;
}

/// Has a page see so many processors.
export const processors = (n) => `Object.defineProperty(navigator, "hardwareConcurrency", { get: () => ${n} });`;

export const view = `document.querySelector("ewa-view")`;
export const part = (selector) => `${view}.shadowRoot.querySelector(${JSON.stringify(selector)})`;
export const PIXELS = `(() => { const c = ${part("canvas")}; const p = c.getContext("2d").getImageData(0, 0, c.width, c.height).data;
  let text = ""; for (let i = 0; i < p.length; i += 8192) text += String.fromCharCode(...p.subarray(i, i + 8192)); return btoa(text); })()`;
export const HEAR = `addEventListener("DOMContentLoaded", () => { self.heard = []; for (const type of ["ready", "pick", "measure", "error", "share"])
  document.addEventListener(type, (e) => heard.push({ type, ...e.detail }), true); });
  document.addEventListener("picture", ({ detail }) => { self.picture = detail; }, true);`;
export const shown = (page, limit_s) => page.until(`self.heard?.some((e) => e.type === "ready" || e.type === "error") && ${view}.still`, limit_s);

export function same(pixels, path, what) {
  const wanted = decode(join(scratch, path)), got = Buffer.from(pixels, "base64");
  assert.equal(got.length, wanted.length, `${what}: another size`);
  let differ = 0;
  for (let i = 0; i < wanted.length; i++) differ += wanted[i] !== got[i];
  assert.equal(differ, 0, `${what}: ${differ} of ${wanted.length} bytes differ from those of ewa render`);
}

/// Nothing complains, and nobody but the page itself is asked.
export function check_quiet(page, origin) {
  assert.deepEqual(page.complaints, []);
  for (const url of page.requests) assert.ok(url.startsWith(origin) || url.startsWith("blob:") || url.startsWith("data:"), url);
}

export async function keep(page, name) {
  if (pictures) writeFileSync(join(pictures, name), await page.picture());
}

/// Gaussians as 3DGS writes them.
export function write_gaussians(name, count) {
  const columns = ["x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"];
  const head = `ply\nformat binary_little_endian 1.0\nelement vertex ${count}\n${columns.map((c) => `property float ${c}\n`).join("")}end_header\n`;
  const body = new Float32Array(count * columns.length);
  for (let i = 0; i < count; i++) {
    const t = i / count, a = 40 * t;
    body.set([Math.cos(a) * (1 + t), 2 * t - 1, Math.sin(a) * (1 + t), 2 * t - 1, Math.sin(a), 1 - 2 * t, 1.5, -3, -2.4 - t, -3.3, 1, t, 0.3, 0],
             i * columns.length);
  }
  writeFileSync(join(scratch, name), Buffer.concat([Buffer.from(head), Buffer.from(body.buffer)]));
}

/// A hill as EPT: a folder of binary records, `side` times `side` points at the top and four times as many at each of three levels below, with a
/// hierarchy of two files. Returns how many nodes it has.
export function write_ept(folder, side) {
  const LEVELS = 4, hierarchies = new Map([["0-0-0-0", {}], ["2-0-0-2", {}]]);
  for (const name of ["ept-data", "ept-hierarchy"]) mkdirSync(join(scratch, folder, name), { recursive: true });
  let total = 0, nodes = 0;
  for (let level = 0; level < LEVELS; level++) {
    const cells = 2 ** level, places = new Map(), count = side * cells;
    for (let i = 0; i < count; i++)
      for (let j = 0; j < count; j++) {
        const x = (i + 0.5 + 0.3 * Math.sin(j + level)) / count, y = (j + 0.5) / count, z = 0.5 + 0.2 * Math.sin(7 * x) * Math.cos(5 * y);
        const key = [level, ...[x, y, z].map((at) => Math.floor(at * cells))].join("-");
        if (!places.has(key)) places.set(key, []);
        places.get(key).push(x, y, z);
      }
    for (const [key, numbers] of places) {
      const [, x, y, z] = key.split("-").map(Number), below = level >= 2 && [x, y, z].map((at) => at >> (level - 2)).join("-") === "0-0-2";
      hierarchies.get(below ? "2-0-0-2" : "0-0-0-0")[key] = numbers.length / 3;
      writeFileSync(join(scratch, folder, "ept-data", `${key}.bin`), Buffer.from(new Float64Array(numbers).buffer));
      total += numbers.length / 3;
      nodes++;
    }
  }
  hierarchies.get("0-0-0-0")["2-0-0-2"] = -1;
  for (const [key, entries] of hierarchies) writeFileSync(join(scratch, folder, "ept-hierarchy", `${key}.json`), JSON.stringify(entries));
  writeFileSync(join(scratch, folder, "ept.json"), JSON.stringify({
    version: "1.0.0", dataType: "binary", hierarchyType: "json", bounds: [0, 0, 0, 1, 1, 1], points: total, span: side,
    schema: ["X", "Y", "Z"].map((name) => ({ name, type: "float", size: 8 })),
  }));
  return nodes;
}

/// A bowl with a picture as binary glTF.
export function write_mesh(name, picture) {
  const SIDE = 24, positions = [], places = [], corners = [], image = readFileSync(join(scratch, picture));
  for (let y = 0; y <= SIDE; y++)
    for (let x = 0; x <= SIDE; x++) {
      const u = x / SIDE, v = y / SIDE, at = y * (SIDE + 1) + x;
      positions.push(2 * u - 1, 0.6 * ((2 * u - 1) ** 2 + (2 * v - 1) ** 2), 1 - 2 * v);
      places.push(u, v);
      if (x < SIDE && y < SIDE) corners.push(at, at + 1, at + SIDE + 1, at + 1, at + SIDE + 2, at + SIDE + 1);
    }
  const parts = [new Float32Array(positions), new Float32Array(places), new Uint32Array(corners)].map((a) => Buffer.from(a.buffer));
  parts.push(image, Buffer.alloc(-image.length & 3));
  let at = 0;
  const views = parts.slice(0, 4).map((one) => ({ buffer: 0, byteOffset: (at += one.length) - one.length, byteLength: one.length }));
  const count = positions.length / 3, body = Buffer.concat(parts);
  const text = Buffer.from(JSON.stringify({
    asset: { version: "2.0" }, scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0 }], buffers: [{ byteLength: body.length }], bufferViews: views,
    meshes: [{ primitives: [{ attributes: { POSITION: 0, TEXCOORD_0: 1 }, indices: 2, material: 0 }] }],
    accessors: [{ bufferView: 0, componentType: 5126, count, type: "VEC3", min: [-1, 0, -1], max: [1, 1.2, 1] },
                { bufferView: 1, componentType: 5126, count, type: "VEC2" }, { bufferView: 2, componentType: 5125, count: corners.length, type: "SCALAR" }],
    materials: [{ pbrMetallicRoughness: { baseColorTexture: { index: 0 } } }], textures: [{ source: 0 }],
    images: [{ bufferView: 3, mimeType: picture.endsWith("png") ? "image/png" : picture.endsWith("webp") ? "image/webp" : "image/jpeg" }],
  }));
  const padded = Buffer.concat([text, Buffer.alloc(-text.length & 3, " ")]);
  const words = (...numbers) => Buffer.from(Uint32Array.from(numbers).buffer);
  writeFileSync(join(scratch, name), Buffer.concat([words(0x46546c67, 2, 28 + padded.length + body.length, padded.length, 0x4e4f534a), padded,
                                                    words(body.length, 0x004e4942), body]));
}

/// Writes a scene of every kind; returns their files.
export function write_kinds() {
  ewa("generate", "torus", "-n", "6000", "--positions-only", "-o", "bare.ply");
  ewa("generate", "terrain", "-n", "20000", "-o", "terrain.laz");
  ewa("generate", "vessels", "--dims", "32", "-o", "vessels.nrrd");
  ewa("lod", "terrain.laz", "-o", "terrain.copc.laz");
  ewa("convert", "terrain.laz", "-o", "terrain.pcd");
  write_gaussians("spiral.ply", 800);
  ewa("convert", "spiral.ply", "-o", "spiral.spz");
  ewa("render", "torus.ply", "-o", "picture.jpg", "--size", "160x120", "--background", "#e0d0a0");
  write_mesh("bowl.glb", "picture.jpg");
  writeFileSync(join(scratch, "scene.json"), JSON.stringify({
    ewa_scene: 1, options: { render: { opacity: 0.6 } },
    items: [{ file: "torus.ply" }, { file: "terrain.laz", to_world: [0.1, 0, 0, 0, 0, 0.1, 0, 0, 0, 0, 0.1, -1, 0, 0, 0, 1], color_by: "z" }],
  }));
  return ["torus.ply", "bare.ply", "terrain.laz", "terrain.copc.laz", "vessels.nrrd", "spiral.ply", "scene.json", "terrain.pcd", "spiral.spz", "bowl.glb"];
}
