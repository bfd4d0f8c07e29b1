// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The module (page/page.c) as an object: a viewer that takes events and commands and gives pictures, where it is called.
import { Bytes, Files } from "./files.js";

/// Kinds of events, as viewer/viewer.h has them.
export const EVENT = { move: 0, press: 1, release: 2, wheel: 3, pinch: 4, key: 5, keyup: 6, resize: 8, leave: 9 };

/// Files that pass between the page and the module are apart from those that are opened.
const CAMERA = "/tmp/camera.json", SHOT = "/tmp/shot.png";

/// Of the binary format of modules.
const IMPORTS = 2, IMPORTED_MEMORY = 2, MEMORY_LIMITED = 1, MEMORY_SHARED = 2;

const REPORT = ["at", "width", "height", "number", "still", "loading", "spare_s", "drawn_s", "level", "splats"];

/// Makes a viewer of the first module that the host takes: one with instructions that the host has not is no module, and one
/// whose multiply-add would round twice makes no view. `modules` are functions that give the bytes of one; `hooks` are say(message,
/// text), progress(stage, fraction) and waiting(). `find` is for Files; `start_threads`, where memory can be shared, starts threads of a
/// module on its memory (page/threads.js).
export async function open_module(modules, hooks, width, height, scale, find, start_threads) {
  for (const fetch_module of modules) {
    const bytes = await fetch_module();
    let module, memory;
    try {
      memory = make_memory(bytes, Boolean(start_threads));
      module = await WebAssembly.compile(bytes);
    } catch (error) {
      if (error instanceof WebAssembly.CompileError) continue;
      throw error;
    }
    const viewer = new Viewer(new Files(find), hooks, memory);
    await viewer.start(module);
    const threads = memory.buffer instanceof ArrayBuffer ? [] : await start_threads(module, memory);
    if (viewer.create(width, height, scale, threads)) return viewer;
    threads.forEach((thread) => thread.terminate());
  }
  throw new Error("this browser has no WebAssembly with SIMD, which is needed to draw");
}

/// The memory that a module imports. One bit of its bytes says whether threads share it, and is set as it is made: where there is not
/// room for all that shared memory may grow to, it is the module's alone.
function make_memory(bytes, shared) {
  const limits = find_memory(bytes);
  if (!limits) throw new WebAssembly.CompileError("it imports no memory");
  const { at, initial, maximum } = limits;
  let memory;
  try {
    memory = new WebAssembly.Memory({ initial, maximum, shared });
  } catch (error) {
    if (!shared) throw error;
    return make_memory(bytes, false);
  }
  bytes[at] = shared ? MEMORY_LIMITED | MEMORY_SHARED : MEMORY_LIMITED;
  return memory;
}

/// The memory among the imports of a module: where its kind is said, and its limits in pages.
function find_memory(bytes) {
  let at = 8;
  const number = () => {
    for (let value = 0, shift = 0; ; shift += 7) {
      const part = bytes[at++];
      value |= (part & 127) << shift;
      if (!(part & 128)) return value >>> 0;
    }
  };
  while (at < bytes.length) {
    const section = bytes[at++], length = number(), end = at + length;
    for (let left = section === IMPORTS ? number() : 0; left > 0; left--) {
      for (let name = 0; name < 2; name++) {
        const length = number();
        at += length;
      }
      if (bytes[at++] === IMPORTED_MEMORY) {
        const found = at++;
        return { at: found, initial: number(), maximum: number() };
      }
      number(); // the type of a function: there is nothing else before
    }
    at = end;
  }
  return null;
}

class Viewer {
  constructor(files, hooks, memory) {
    this.files = files;
    this.hooks = hooks;
    this.memory = files.memory = memory;
  }

  async start(module) {
    const hooks = this.hooks;
    const ewa = {
      say: (message, text) => hooks.say(message !== 0, this.read(text)),
      progress: (stage, fraction) => hooks.progress(this.read(stage), fraction),
      waiting: () => (hooks.waiting() ? 1 : 0),
      open_file: (path, size_at) => {
        const { number, size } = this.files.open_file(this.read(path));
        new DataView(this.memory.buffer).setFloat64(size_at, size, true);
        return number;
      },
      read_file: (number, at, start, size) => this.files.read_file(number, at, start, size),
      close_file: (number) => this.files.close_file(number),
    };
    const imports = { env: { memory: this.memory }, ewa, wasi_snapshot_preview1: this.files.imports(module) };
    this.calls = (await WebAssembly.instantiate(module, imports)).exports;
    this.calls._initialize();
  }

  create(width, height, scale, threads) {
    this.thread_count = 1 + threads.length;
    this.page = this.calls.page_create(width, height, scale, this.thread_count);
    if (!this.page) return false;
    const of_page = this.calls.page_get_threads(this.page);
    threads.forEach((thread, i) => {
      const stack = this.calls.page_thread_stack(); // 0: there is no memory, and one that never begins is not waited for
      if (stack) thread.postMessage({ threads: of_page, number: i + 1, stack });
    });
    this.text = this.calls.page_text(this.page);
    this.text_bytes = this.calls.page_text_bytes();
    return true;
  }

  /// Text that ends by 0.
  read(at) {
    const bytes = new Uint8Array(this.memory.buffer, at);
    return new TextDecoder().decode(bytes.slice(0, bytes.indexOf(0)));
  }

  write(text) {
    const bytes = new TextEncoder().encode(text);
    if (bytes.length >= this.text_bytes) throw new Error(`${text.slice(0, 60)}...: the text is too long`);
    const room = new Uint8Array(this.memory.buffer, this.text, bytes.length + 1);
    room.set(bytes);
    room[bytes.length] = 0;
  }

  open(path) {
    this.write(path);
    return this.calls.page_open(this.page) !== 0;
  }

  do(command) {
    this.write(command);
    return this.calls.page_do(this.page) !== 0;
  }

  event(e, time_s) {
    this.calls.page_event(this.page, EVENT[e.kind], time_s, e.x ?? 0, e.y ?? 0, e.button ?? 0, e.clicks ?? 0, e.modifiers ?? 0,
                          e.key ?? 0, e.amount ?? 0);
  }

  /// Advances; what is reported has the picture's place in memory as `at`, 0 for none.
  frame(time_s) {
    const at = this.calls.page_frame(this.page, time_s); // which may make memory anew
    const numbers = new Float64Array(this.memory.buffer, at, REPORT.length);
    return Object.fromEntries(REPORT.map((name, i) => [name, numbers[i]]));
  }

  /// A copy of a picture's pixels.
  pixels(report) {
    return new Uint8ClampedArray(this.memory.buffer, report.at, 4 * report.width * report.height).slice();
  }

  /// Places of the last pick, or of both of a measure.
  picks() {
    const places = [];
    for (let i = 0; i < 2; i++) {
      const at = this.calls.page_pick(this.page, i);
      if (at) places.push([...new Float64Array(this.memory.buffer, at, 3)]);
    }
    return places;
  }

  picked() {
    this.calls.page_picked(this.page);
    return this.read(this.text);
  }

  /// What is open, one object each.
  items() {
    const items = [];
    while (this.calls.page_item(this.page, items.length)) {
      const item = { attributes: [], classes: [] };
      for (const line of this.read(this.text).split("\n")) {
        const [name, ...rest] = line.split("\t");
        if (name === "attribute") item.attributes.push(rest[0]);
        else if (name === "class") item.classes.push({ value: +rest[0], color: rest.slice(1, 4).map(Number), name: rest[4] });
        else if (name === "range") item.range = rest.map(Number);
        else if (name) item[name] = name === "count" ? +rest[0] : rest[0];
      }
      items.push(item);
    }
    return items;
  }

  /// Rows of the help: keys, and what they do.
  help() {
    const rows = [];
    while (this.calls.page_help(this.page, rows.length)) rows.push(this.read(this.text).split("\t"));
    return rows;
  }

  /// The camera as the JSON that `ewa render --camera` reads.
  camera() {
    if (!this.do(`camera save ${CAMERA}`)) return null;
    const text = this.files.get(CAMERA).text();
    this.files.remove(CAMERA);
    return text;
  }

  /// A picture of any size as the bytes of a PNG, with the look of the view; `what` as behind "shot PATH". Null: none could be made.
  shot(what) {
    if (!this.do(`shot ${SHOT} ${what}`)) return null;
    const { bytes, size } = this.files.get(SHOT);
    this.files.remove(SHOT);
    return bytes.slice(0, size);
  }

  set_camera(text) {
    this.files.put(CAMERA, new Bytes(new TextEncoder().encode(text)));
    const done = this.do(`camera load ${CAMERA}`);
    this.files.remove(CAMERA);
    return done;
  }
}
