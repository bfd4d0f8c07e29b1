// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Debian's Chromium without a window, driven by its debugging protocol over two pipes, and a server of a few folders.
import { spawn } from "node:child_process";
import { createReadStream, mkdtempSync, rmSync, statSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { extname, join, normalize } from "node:path";

const TYPES = { ".html": "text/html", ".js": "text/javascript", ".mjs": "text/javascript", ".css": "text/css", ".json": "application/json" };

/// Headers of a page that is isolated, whose memory threads can share.
export const ISOLATED = { "cross-origin-opener-policy": "same-origin", "cross-origin-embedder-policy": "require-corp" };

/// Serves files of folders by prefix: { "/": folder, ... }. `headers` are sent with each; `ranges`: parts of files are given. Returns
/// { origin, asked, bytes(), close() }; `asked` are the paths of all requests.
export async function serve(folders, headers = {}, ranges = true) {
  let sent = 0;
  const asked = [];
  const server = createServer((request, response) => {
    const path = normalize(decodeURIComponent(new URL(request.url, "http://x").pathname));
    asked.push(path);
    const prefix = Object.keys(folders).filter((p) => path.startsWith(p)).sort((a, b) => b.length - a.length)[0];
    const target = folders[prefix];
    const file = typeof target === "object" ? target[path.slice(prefix.length)] : join(target ?? "/nowhere", path.slice(prefix.length));
    let facts;
    try {
      facts = statSync(file);
    } catch {
      facts = null;
    }
    if (!facts?.isFile()) {
      response.writeHead(404).end();
      return;
    }
    const range = ranges && /^bytes=(\d+)-(\d+)$/.exec(request.headers.range ?? "");
    const start = range ? Number(range[1]) : 0, end = range ? Math.min(Number(range[2]), facts.size - 1) : facts.size - 1;
    if (range && start >= facts.size) {
      response.writeHead(416).end();
      return;
    }
    sent += end + 1 - start;
    if (range) response.setHeader("content-range", `bytes ${start}-${end}/${facts.size}`);
    response.writeHead(range ? 206 : 200, { "content-type": TYPES[extname(file)] ?? "application/octet-stream",
                                            "content-length": end + 1 - start, etag: `"${facts.mtimeMs}"`, ...headers });
    if (request.method === "HEAD" || end < start) response.end();
    else createReadStream(file, { start, end }).pipe(response);
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  return { origin: `http://127.0.0.1:${server.address().port}`, asked, bytes: () => sent, close: () => server.close() };
}

/// Starts a browser. `flags` are its own.
export async function launch(program = "chromium", flags = []) {
  const profile = mkdtempSync(join(tmpdir(), "ewa-chromium-"));
  const child = spawn(program, ["--headless=new", "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-extensions",
                                "--disable-background-networking", "--hide-scrollbars", `--user-data-dir=${profile}`,
                                "--remote-debugging-pipe", ...flags, "about:blank"],
                      { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] });
  const waiting = new Map(), listeners = new Set();
  let id = 0, rest = "";
  child.stdio[4].setEncoding("utf8").on("data", (text) => {
    const parts = (rest + text).split("\0");
    rest = parts.pop();
    for (const part of parts) {
      const told = JSON.parse(part);
      if (!told.id) listeners.forEach((listener) => listener(told));
      else if (told.error) waiting.get(told.id).reject(new Error(told.error.message));
      else waiting.get(told.id).resolve(told.result);
      waiting.delete(told.id);
    }
  });
  child.on("exit", () => waiting.forEach(({ reject }) => reject(new Error("the browser has ended"))));
  const send = (method, params = {}, sessionId) =>
    new Promise((resolve, reject) => {
      waiting.set(++id, { resolve, reject });
      child.stdio[3].write(JSON.stringify({ id, method, params, sessionId }) + "\0");
    });

  /// Opens a page; `complaints` are its console's warnings and errors, `requests` all addresses that it asked for.
  async function page(url, { width = 1280, height = 800, touch = false, before = "" } = {}) {
    const { targetId } = await send("Target.createTarget", { url: "about:blank" });
    const { sessionId } = await send("Target.attachToTarget", { targetId, flatten: true });
    const call = (method, params) => send(method, params, sessionId);
    const complaints = [], requests = [];
    const listener = (told) => {
      if (told.sessionId !== sessionId) return;
      const { method, params } = told;
      if (method === "Runtime.exceptionThrown") complaints.push(params.exceptionDetails.exception?.description ?? params.exceptionDetails.text);
      if (method === "Runtime.consoleAPICalled" && ["error", "warning", "assert"].includes(params.type))
        complaints.push(params.args.map((a) => a.value ?? a.description).join(" "));
      if (method === "Log.entryAdded" && params.entry.level === "error") complaints.push(`${params.entry.text} ${params.entry.url ?? ""}`);
      if (method === "Network.requestWillBeSent") requests.push(params.request.url);
    };
    listeners.add(listener);
    await Promise.all(["Runtime.enable", "Log.enable", "Network.enable", "Page.enable"].map((method) => call(method)));
    await call("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: 1, mobile: touch });
    if (touch) await call("Emulation.setTouchEmulationEnabled", { enabled: true });
    if (before) await call("Page.addScriptToEvaluateOnNewDocument", { source: before });
    await call("Page.navigate", { url });
    const evaluate = async (expression) => {
      const { result, exceptionDetails } = await call("Runtime.evaluate", { expression, awaitPromise: true, returnByValue: true });
      if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
      return result.value;
    };
    /// Waits until an expression is true; the last value is returned.
    const until = async (expression, limit_s = 60) => {
      const end = Date.now() + 1000 * limit_s;
      for (;;) {
        const value = await evaluate(expression).catch((error) => (Date.now() > end ? Promise.reject(error) : false));
        if (value) return value;
        if (Date.now() > end) throw new Error(`${url}: not within ${limit_s} s: ${expression}`);
        await new Promise((resolve) => setTimeout(resolve, 30));
      }
    };
    const picture = async () => Buffer.from((await call("Page.captureScreenshot", { format: "png" })).data, "base64");
    const close = async () => {
      listeners.delete(listener);
      await send("Target.closeTarget", { targetId });
    };
    return { call, evaluate, until, picture, complaints, requests, close };
  }
  async function close() {
    await send("Browser.close").catch(() => {});
    if (child.exitCode === null) await new Promise((resolve) => child.on("exit", resolve));
    rmSync(profile, { recursive: true, force: true, maxRetries: 5, retryDelay: 100 });
  }
  return { page, close };
}
