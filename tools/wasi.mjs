// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Runs a program in WebAssembly under node, with the files below this folder, and those below the first folder of every absolute
// path among its words:
//   node tools/wasi.mjs build/wasm/cli/ewa.wasm render scan.ply -o scan.png
import { readFileSync } from "node:fs";
import { WASI } from "node:wasi";

const [file, ...words] = process.argv.slice(2);
const preopens = { "/": process.cwd() }; // where relative names begin in the module
for (const word of words) {
  const top = /^\/[^/]+(?=\/)/.exec(word);
  if (top) preopens[top[0]] = top[0];
}
const wasi = new WASI({ version: "preview1", args: [file, ...words], env: process.env, preopens, returnOnExit: true });
const imports = wasi.getImportObject();
// Called without a function between, some of these abort node 20 once the module's memory has grown.
for (const group of Object.values(imports))
  for (const [name, call] of Object.entries(group)) group[name] = (...values) => call(...values);
const module = new WebAssembly.Module(readFileSync(file));
process.exit(wasi.start(new WebAssembly.Instance(module, imports)));
