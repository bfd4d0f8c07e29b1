// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The worker behind an <ewa-view>: it has the module and the files, takes what happens and posts pictures back, one at a time.
import { Bytes, Dropped } from "./files.js";
import { open_module } from "./module.js";
import { as_readable, FOREIGN_NAME, HAS_PICTURES, names_beside } from "./pictures.js";
import { open_ranges } from "./ranges.js";
import { be_thread, start_threads } from "./threads.js";

/// A function with one relaxed multiply-add: no module where the host has none, so that nothing is fetched in vain.
const RELAXED = new Uint8Array([0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 19, 1, 17, 0, 65, 0, 253, 15, 65,
                                0, 253, 15, 65, 0, 253, 15, 253, 133, 2, 11]);
/// Formats that name other files, which are fetched from beside them when they are asked for.
const NAMES_OTHERS = /\.(json|gltf|obj|mtl|nhdr|mhd)$/i;
/// Files of an octree that its description and hierarchy promise (EPT): where one is missing, that is said.
const OF_OCTREE = /\/ept-(data|hierarchy)\//;
/// A module has no room for more.
const MAX_BYTES = 2 ** 31 - 1;
/// More of them bring little, and each takes memory.
const MAX_THREADS = 8;
/// Progress is told so often, of what takes so long.
const TELL_MS = 50, LONG_MS = 150;

let viewer = null, sent = null, handled = 0; // orders that were sent, where memory is shared, and carried out
let fetching = 0; // opens that wait for their files
let number = -1, shown = true, scheduled = false, timer = 0, told_ms = 0, began_ms = 0, is_ready = false;
let picked = "", opening = [], message = "";
const soon = new MessageChannel(), servers = new Set(); // folders of servers of which a file was opened that names others

const now_s = () => performance.now() / 1000;

/// What a text in base64 stands for.
function decode(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const letters = atob(text), bytes = new Uint8Array(letters.length);
  for (let i = 0; i < letters.length; i++) bytes[i] = letters.charCodeAt(i);
  return bytes;
}

/// Asks a server, and says why where it comes to nothing.
async function ask(url, how) {
  try {
    return await how(url);
  } catch (error) {
    throw new Error(url.startsWith("file:") ? "a page that was opened as a file may read no other file: drop it here, or serve the folder"
                                            : "the server does not answer, or lets no other site read it (CORS)");
  }
}

/// The whole of what a server answers; `told` hears how many bytes came.
async function collect(answer, told) {
  if (!answer.ok) throw new Error(`the server says ${answer.status} ${answer.statusText}`);
  const length = Number(answer.headers.get("content-length")) || 0;
  if (length > MAX_BYTES) {
    answer.body.cancel();
    throw new Error(`${(length / 1e9).toFixed(1)} GB are more than the 2 GB that a page holds; an octree (COPC, made by ewa lod) is read in parts`);
  }
  const into = new Bytes(new Uint8Array(length));
  into.size = 0;
  const reader = answer.body.getReader();
  for (;;) {
    let part;
    try {
      part = await reader.read();
    } catch (error) {
      throw new Error(`the connection was cut after ${into.size} of ${length || "unknown"} bytes`);
    }
    if (part.done) return into.bytes.subarray(0, into.size);
    into.write(into.size, part.value);
    told?.(into.size, length);
  }
}

/// Bytes of a module: base64 in a page of its own, else at an address; packed by gzip or not.
async function take_module(source, told) {
  const bytes = source.text !== undefined ? decode(source.text.trim()) : await collect(await ask(source.url, fetch), told);
  if (bytes[0] !== 0x1f || bytes[1] !== 0x8b) return bytes;
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/// Octrees (COPC, by the first of its own records) are read where they are seen, all else as a whole.
const is_octree = (first) => String.fromCharCode(...first.subarray(0, 4), ...first.subarray(377, 381)) === "LASFcopc";

/// A file that can be read, of bytes, base64, an address, or dropped.
async function take_file(file) {
  if (file.file) return new Dropped(file.file);
  if (file.bytes) return new Bytes(new Uint8Array(file.bytes));
  if (file.text !== undefined) return new Bytes(decode(file.text));
  const since_ms = performance.now(), { source, bytes, answer } = await ask(file.url, (url) => open_ranges(url, is_octree));
  return source ?? new Bytes(bytes ?? (await collect(answer, (got, length) => tell(`fetch ${file.name}`, length ? got / length : 0, since_ms))));
}

function tell(stage, fraction, since_ms = began_ms) {
  const now_ms = performance.now();
  if (now_ms - since_ms < LONG_MS || (now_ms - told_ms < TELL_MS && fraction < 1)) return;
  told_ms = now_ms;
  postMessage({ progress: { stage, fraction } });
}

const hooks = {
  say(is_message, text) {
    if (is_message) postMessage({ message: (message = with_addresses(text)) });
  },
  progress: (stage, fraction) => tell(stage, fraction),
  /// Without memory that is shared, what waits cannot be seen while something is drawn.
  waiting: () => sent !== null && Atomics.load(sent, 0) !== handled,
};

// Files of an address are below a folder of their server: /https/example.org/dir/scan.laz.

const server_of = ({ protocol, host }) => `${protocol.slice(0, -1)}/${host}`;

/// The path of a file of an address, which has a name of its own where the address ends in none.
function path_of(address, name) {
  const url = new URL(address);
  return /^https?:$/.test(url.protocol) ? server_of(url) + decodeURIComponent(url.pathname.replace(/[^/]*$/, "")) + name : name;
}

/// A text with such paths as the addresses that they are.
const with_addresses = (text) => text.replace(/(^|[\s"'(])\/(https?)\//g, "$1$2://");

/// The address of a path from another one on.
const address_of = (path, from) => new URL(path.split("/").map(encodeURIComponent).join("/"), from).href;

/// A file beside one that was opened, by a request that waits: the module asks for it and goes on with it.
function find(path) {
  const server = [...servers].find((folder) => path.startsWith(folder + "/"));
  if (!server) return null;
  const request = new XMLHttpRequest();
  request.open("GET", address_of(path.slice(server.length), server.replace("/", "://")), false);
  request.responseType = "arraybuffer";
  let problem = "the server does not answer any more";
  try {
    request.send();
    if (request.status === 200) return new Bytes(new Uint8Array(request.response));
    problem = `the server says ${request.status} ${request.statusText}`;
  } catch {
    // It is said below.
  }
  if (OF_OCTREE.test(path)) Object.assign(viewer.files, { failure: problem, failed: "/" + path });
  return null;
}

async function start(orders) {
  const relaxed = WebAssembly.validate(RELAXED);
  if (orders.sent) sent = new Int32Array(orders.sent);
  const modules = orders.modules.filter((source) => relaxed || !source.relaxed);
  const fetches = modules.map((source) => () => take_module(source, (got, length) => tell("fetch the program", length ? got / length : 0)));
  const further = sent ? Math.min(orders.threads, MAX_THREADS) - 1 : 0;
  const start_further = further > 0 ? (module, memory) => start_threads(module, memory, further) : null;
  viewer = await open_module(fetches, hooks, orders.width, orders.height, orders.scale, find, start_further);
  for (const command of orders.commands) viewer.do(command);
  postMessage({ started: { help: viewer.help() } });
}

/// Puts files where the module finds them and opens those that are to be, once all are there.
async function open(files) {
  const found = [];
  for (const file of files) {
    try {
      const path = await put(file);
      if (!file.beside) found.push({ name: file.name, path });
    } catch (error) {
      postMessage({ failed: { name: file.name, reason: error.message } });
    }
  }
  if (!viewer) return; // it has ended meanwhile
  for (const { name, path } of found) {
    message = viewer.files.failure = "";
    if (viewer.open("/" + path)) opening.push(name);
    else tell_failed(name);
  }
}

/// Says why a file came to nothing, as the library says it, with what was wrong with reading it.
function tell_failed(name) {
  const { failure } = viewer.files;
  postMessage({ failed: { name, reason: failure ? `${message}: ${failure}` : message } });
}

/// Says what of an octree could not be read while it was drawn.
function tell_unreadable() {
  const { failure, failed } = viewer.files;
  viewer.files.failure = "";
  if (failure) postMessage({ failed: { name: "", reason: `${with_addresses(failed)}: ${failure}` } });
}

/// Puts a file, and those that an address names which have to be there before it; returns its path. `seen` has the paths of what one open takes.
async function put(file, seen = new Set()) {
  const source = await with_pictures(file.name, await take_file(file)), path = file.url ? path_of(file.url, file.name) : file.name;
  viewer?.files.put(path, source);
  if (!file.url || !NAMES_OTHERS.test(file.name) || seen.has(path)) return path;
  seen.add(path);
  servers.add(server_of(new URL(file.url)));
  for (const name of new Set(names_beside(file.name, source.text()))) { // several may share one
    const beside = { name: name.split("/").pop(), url: address_of(name, file.url), beside: true };
    if (/\.json$/i.test(file.name)) await put(beside, seen);
    else await put(beside, seen).catch(() => {}); // a mesh comes without
  }
  return path;
}

/// A file whose pictures the module can read.
async function with_pictures(name, source) {
  if (!FOREIGN_NAME.test(name) && !HAS_PICTURES.test(name)) return source;
  const bytes = source.file ? new Uint8Array(await source.file.arrayBuffer()) : source.bytes.subarray(0, source.size);
  return new Bytes(await as_readable(name, bytes));
}

/// Says what became of the files that were opened, once all is loaded.
function tell_opened() {
  const items = viewer.items(), names = new Set(items.map((item) => item.name));
  for (const name of opening)
    if (/\.json$/i.test(name) && !/(^|\/)ept\.json$/.test(name) ? viewer.files.failure : !names.has(name.split("/").pop())) tell_failed(name);
  opening = [];
  viewer.files.failure = "";
  postMessage({ items });
  if (items.length && !is_ready) postMessage({ ready: (is_ready = true) });
}

function tell_picked() {
  const text = viewer.picked();
  if (text === picked) return;
  picked = text;
  postMessage({ picked: { text, places: viewer.picks() } });
}

function step() {
  scheduled = false;
  if (!viewer || !shown) return;
  clearTimeout(timer);
  const loading = opening.length > 0;
  began_ms = performance.now();
  const report = viewer.frame(now_s()), still = report.still && !fetching;
  if (report.at && report.number !== number) {
    number = report.number;
    shown = false;
    const pixels = viewer.pixels(report), { at, ...facts } = report;
    postMessage({ picture: { ...facts, still, pixels, handled, memory: viewer.memory.buffer.byteLength, threads: viewer.thread_count } }, [pixels.buffer]);
  } else if (still) {
    postMessage({ still: handled });
  }
  if (loading && !report.loading) tell_opened();
  if (!loading) tell_unreadable();
  if (!report.still) timer = setTimeout(guarded_step, report.at && !loading ? 1000 * report.spare_s : 0);
}

/// A step of which a failure ends the module.
function guarded_step() {
  try {
    step();
  } catch (error) {
    stop(error);
  }
}

function wake() {
  if (scheduled) return;
  scheduled = true;
  soon.port2.postMessage(0);
}

const answers = {
  camera: () => viewer.camera(),
  items: () => viewer.items(),
  do: (command) => viewer.do(command),
  set_camera: (text) => viewer.set_camera(text),
  shot(what) {
    const png = viewer.shot(what);
    if (!png) throw new Error(message);
    return png;
  },
};

/// What goes wrong here ends the module: its memory may be anything.
function stop(error) {
  const text = /memory|allocation/i.test(error.message) ? "there is not enough memory in this browser's tab" : error.message;
  viewer = null;
  postMessage({ stopped: text });
}

async function handle(orders) {
  began_ms = performance.now();
  if (orders.shown) shown = true;
  else handled++;
  if (orders.start) await start(orders.start);
  if (!viewer) return;
  if (orders.event) {
    viewer.event(orders.event, now_s());
    if (orders.event.kind === "release" || orders.event.kind === "key") tell_picked();
  }
  if (orders.open) {
    // What the hand does is not kept waiting by a server.
    fetching++;
    opens = opens.then(() => open(orders.open)).catch(stop).finally(() => {
      fetching--;
      wake();
    });
  }
  if (orders.ask) {
    const { id, what, word } = orders.ask;
    try {
      postMessage({ answer: { id, value: answers[what](word) } });
    } catch (error) {
      if (error.constructor !== Error) throw error; // a trap, a full stack: not what was said here
      postMessage({ answer: { id, error: error.message } });
    }
  }
  wake();
}

let queue = Promise.resolve(), opens = Promise.resolve(); // orders are carried out one after another, what is fetched beside them
soon.port1.onmessage = guarded_step;
onmessage = ({ data }) => {
  if (data.thread) be_thread(data.thread);
  else queue = queue.then(() => handle(data)).catch(stop);
};
