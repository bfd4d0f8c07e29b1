// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Threads of a module (page/threads.c): workers of the same script, each with an instance of the module on the memory that all share.
import { Files } from "./files.js";

/// How long threads may take to be there; the picture waits for no others.
const LIMIT_MS = 3000;

/// Starts threads of a module; returns those that are there.
export async function start_threads(module, memory, count) {
  const type = self.location.protocol === "blob:" ? "classic" : "module"; // as this script is one
  const started = Array.from({ length: count }, () => {
    const worker = new Worker(self.location.href, { type });
    return new Promise((done) => {
      worker.onmessage = () => done(worker);
      worker.onerror = (event) => (event.preventDefault(), done(null));
      setTimeout(() => done(null), LIMIT_MS);
      worker.postMessage({ thread: { module, memory } });
    }).then((there) => there ?? worker.terminate() ?? null);
  });
  return (await Promise.all(started)).filter((worker) => worker);
}

/// Is a thread, whose first order has the module and the memory; the second one has what it is to work for, without end.
export async function be_thread({ module, memory }) {
  const files = new Files();
  files.memory = memory;
  const ewa = new Proxy({}, { get: () => () => -1 }); // what the page is asked comes on the thread that calls the library
  const { exports } = await WebAssembly.instantiate(module, { env: { memory }, ewa, wasi_snapshot_preview1: files.imports(module) });
  self.onmessage = ({ data: { threads, number, stack } }) => {
    try {
      exports.page_thread_begin(threads, number, stack);
    } catch {
      exports.page_thread_failed(threads);
    }
  };
  postMessage("there");
}
