// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What axe-core (npm install axe-core) says of a page: wide and narrow, light and dark, as it opens, with a pick and a mistake shown, with the help open.
// Prints one line each, and what is wrong. Run by hand.
//   node tests/page/axe.mjs build/release/cli/ewa SCRATCH PICTURES axe.min.js
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { check, ewa, finish, keep, part, scratch, show, view } from "./pages.mjs";

const axe = readFileSync(process.argv[5], "utf8");
ewa("generate", "terrain", "-n", "50000", "-o", "terrain.laz");
ewa("page", "terrain.laz", "-o", "terrain.html", "--title", "A terrain", "--color-by", "z");

const states = {
  opened: "0",
  told: `${view}.do("pick 200 400").catch(() => 0); ${view}.open({ name: "broken.ply", text: "cGx5Cg==" }); ${part("[data-do=share]")}.click()`,
  help: `${part("[data-do=help]")}.click()`,
};
for (const [width, height, touch] of [[1280, 800, false], [390, 844, true]])
  for (const scheme of ["light", "dark"])
    await check(`${width}x${height} ${scheme}`, async () => {
      const page = await show(pathToFileURL(join(scratch, "terrain.html")).href, { width, height, touch });
      await page.call("Emulation.setEmulatedMedia", { features: [{ name: "prefers-color-scheme", value: scheme }, { name: "prefers-reduced-motion", value: "reduce" }] });
      await page.call("Runtime.evaluate", { expression: axe });
      const wrong = [];
      for (const [state, expression] of Object.entries(states)) {
        await page.evaluate(`(async () => { ${expression}; })()`);
        await page.until(`${view}.still`);
        await new Promise((done) => setTimeout(done, 300));
        await keep(page, `${width}-${scheme}-${state}.png`);
        const said = JSON.parse(await page.evaluate(`axe.run().then((r) => JSON.stringify({ passes: r.passes.length, violations: r.violations }))`));
        for (const { id, help, nodes } of said.violations) wrong.push(`${state}: ${id}: ${help}: ${nodes.map((n) => n.target.join(" ")).join(", ")}`);
        console.log(`  ${state}: ${said.passes} rules pass, ${said.violations.length} do not`);
      }
      if (wrong.length) throw new Error(wrong.join("\n"));
    });
await finish();
