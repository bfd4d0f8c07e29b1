// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The gallery that `make docs` makes for a browser: each of its pictures leads to a view of the same bytes.
//   node tests/page/gallery.mjs build/release/cli/ewa SCRATCH       exit status 77: skipped
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { join } from "node:path";
import { serve } from "./chromium.mjs";
import { browser, check, check_quiet, finish, PIXELS, program, same, scratch, show, WIDTH } from "./pages.mjs";

await check("the gallery: each picture leads to a view of its bytes", async () => {
  execFileSync("sh", [new URL("../../tools/page_gallery.sh", import.meta.url).pathname, program, join(scratch, "gallery")], { stdio: "pipe" });
  const server = await serve({ "/": join(scratch, "gallery") }), gallery = await browser.page(`${server.origin}/index.html`);
  const entries = await gallery.until(`(() => { const a = [...document.querySelectorAll("main a")]; return a.length && a.every((e) => e.querySelector("img").complete) &&
    a.map((e) => [e.href, new URL(e.querySelector("img").src).pathname, e.querySelector("img").naturalWidth]); })()`);
  check_quiet(gallery, server.origin);
  await gallery.close();
  for (const [address, picture, width] of entries) {
    assert.equal(width, WIDTH);
    const page = await show(address);
    same(await page.evaluate(PIXELS), `gallery${picture}`, picture);
    check_quiet(page, server.origin);
    await page.close();
  }
  server.close();
});
await finish();
