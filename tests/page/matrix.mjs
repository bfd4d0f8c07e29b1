// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Every kind of scene by both modules, on one thread and two, from a server, and as a file: the bytes of `ewa render`. By hand, for it takes minutes.
//   node tests/page/matrix.mjs build/release/cli/ewa SCRATCH
import assert from "node:assert/strict";
import { rmSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { ISOLATED, serve } from "./chromium.mjs";
import { check, check_quiet, ewa, finish, HEAR, HEIGHT, PIXELS, processors, same, scratch, show, WIDTH, write_kinds } from "./pages.mjs";

const site = join(scratch, "site");
for (const kind of write_kinds()) {
  rmSync(site, { recursive: true, force: true });
  ewa("page", kind, "--folder", "site", "-q");
  ewa("page", kind, "-o", "kind.html", "-q");
  ewa("render", kind, "-o", "kind.png", "--size", `${WIDTH}x${HEIGHT}`, "-q");
  await check(`${kind}: as a file, and from a server by both modules, on one thread and two`, async () => {
    const url = pathToFileURL(join(scratch, "kind.html")).href, alone = await show(url);
    same(await alone.evaluate(PIXELS), "kind.png", "as a file");
    check_quiet(alone, url);
    await alone.close();
    for (const module of ["relaxed", "exact"])
      for (const threads of [1, 2]) {
        const folders = { "/": site };
        if (module === "exact") folders["/page-relaxed.wasm.gz"] = { "": join(site, "page.wasm.gz") };
        const server = await serve(folders, ISOLATED), page = await show(`${server.origin}/index.html`, { before: processors(threads) + HEAR });
        same(await page.evaluate(PIXELS), "kind.png", `${module}, ${threads}`);
        assert.equal(await page.evaluate("picture.threads"), threads);
        check_quiet(page, server.origin);
        await page.close();
        server.close();
      }
  });
}
await finish();
