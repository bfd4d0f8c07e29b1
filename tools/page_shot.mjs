// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Takes a picture of a page of `ewa page` in Debian's Chromium, after clicks, for the gallery and to look at:
//   node tools/page_shot.mjs scan.html scan.png 1280x800 400,300 shift+600,320
// Below 600 pixels of width it is a phone.
import { writeFileSync } from "node:fs";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { launch } from "../tests/page/chromium.mjs";

const [html, png, size, ...clicks] = process.argv.slice(2), [width, height] = size.split("x").map(Number);
const browser = await launch();
const page = await browser.page(pathToFileURL(resolve(html)).href, { width, height, touch: width < 600 });
const still = `document.querySelector("ewa-view").still`;
await page.until(still);
for (const click of clicks) {
  const [x, y] = click.replace("shift+", "").split(",").map(Number);
  for (const type of ["mousePressed", "mouseReleased"])
    await page.call("Input.dispatchMouseEvent", { type, x, y, button: "left", clickCount: 1, modifiers: click.startsWith("shift+") ? 8 : 0 });
  await new Promise((done) => setTimeout(done, 500));
  await page.until(still);
}
writeFileSync(png, await page.picture());
await browser.close();
