// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The files that a module sees: bytes in memory, files that were dropped, and files of a server, read where they lie. What is
// written stays in memory. As WASI has it (preview 1): structs and numbers of errors are those of its document.

const DONE = 0, BAD_DESCRIPTOR = 8, EXISTS = 20, INVALID = 28, READING_FAILED = 29, IS_FOLDER = 31, NO_ENTRY = 44,
  NOT_SUPPORTED = 58, NO_FOLDER = 54;
const CREATE = 1, FOLDER_ONLY = 2, EXCLUSIVE = 4, TRUNCATE = 8;
const TYPE_FOLDER = 3, TYPE_FILE = 4, TYPE_DEVICE = 2;
const FIRST = 4; // descriptors 0 to 2 are the module's streams, 3 is the root
/// Of what `find` brings so much is kept, that which was used last; an octree in a folder of files (EPT) has any number of them.
const KEPT_BYTES = 1 << 25;

/// Bytes in memory, which can grow.
export class Bytes {
  constructor(bytes = new Uint8Array()) {
    this.bytes = bytes;
    this.size = bytes.length;
  }
  read(at, into) {
    const part = this.bytes.subarray(at, Math.min(at + into.length, this.size));
    into.set(part);
    return part.length;
  }
  write(at, from) {
    const end = at + from.length;
    if (end > this.bytes.length) {
      const larger = new Uint8Array(Math.max(end, 2 * this.bytes.length));
      larger.set(this.bytes.subarray(0, this.size));
      this.bytes = larger;
    }
    this.bytes.set(from, at);
    this.size = Math.max(this.size, end);
    return from.length;
  }
  text() {
    return new TextDecoder().decode(this.bytes.subarray(0, this.size));
  }
}

/// A file that was dropped or chosen; in workers only.
export class Dropped {
  constructor(file) {
    this.file = file;
    this.size = file.size;
  }
  read(at, into) {
    const part = this.file.slice(at, at + into.length);
    into.set(new Uint8Array(new FileReaderSync().readAsArrayBuffer(part)));
    return part.size;
  }
}

/// The files of a module, and what it calls to reach them. `find` (may be missing) is asked for a file that is not there yet, and
/// returns it or nothing.
export class Files {
  constructor(find) {
    this.find = find;
    this.named = new Map();
    this.found = new Map();
    this.found_bytes = 0;
    this.open = new Map();
    this.shown = new Map();
    this.memory = null; // of the module, once it is made
    this.said = ""; // what the module wrote to its streams
    this.failure = this.failed = ""; // why the last file could not be read, and its path
  }

  put(path, source) {
    this.named.set(clean(path), source);
  }

  get(path) {
    return this.named.get(clean(path));
  }

  remove(path) {
    return this.named.delete(clean(path));
  }

  /// The imports of a module: what is not here does not work in a page.
  imports(module) {
    const calls = {};
    for (const { module: group, name, kind } of WebAssembly.Module.imports(module))
      if (group === "wasi_snapshot_preview1" && kind === "function")
        calls[name] = this[name] ? (...words) => this[name](...words) : () => NOT_SUPPORTED;
    return calls;
  }

  // ---- What is shown, read where it lies (ewa_file_source)

  open_file(path) {
    const source = this.lookup(clean(path));
    if (!source) return { number: -1, size: 0 };
    let number = 0;
    while (this.shown.has(number)) number++;
    this.shown.set(number, { path, source });
    return { number, size: source.size };
  }

  read_file(number, at, start, size) {
    const { path, source } = this.shown.get(number);
    try {
      return source.read(at, new Uint8Array(this.memory.buffer, start, size));
    } catch (error) {
      this.failure = error.message;
      this.failed = path;
      return -1;
    }
  }

  close_file(number) {
    this.shown.delete(number);
  }

  // ---- Texts and pictures

  view() {
    return new DataView(this.memory.buffer);
  }

  path(at, length) {
    // A copy: memory that threads share cannot be decoded.
    return clean(new TextDecoder().decode(new Uint8Array(this.memory.buffer, at, length).slice()));
  }

  lookup(path) {
    let source = this.named.get(path) ?? this.found.get(path);
    if (this.named.has(path) || !this.find) return source;
    if (source) this.forget(path);
    else if (!this.isFolder(path) && !this.isInFile(path)) source = this.find(path);
    if (source) this.keep(path, source);
    return source;
  }

  /// Keeps what was found, as the last one that is given up.
  keep(path, source) {
    this.found.set(path, source);
    this.found_bytes += source.size;
    for (const other of this.found.keys()) {
      if (this.found_bytes <= KEPT_BYTES || other === path) return;
      this.forget(other);
    }
  }

  forget(path) {
    this.found_bytes -= this.found.get(path).size;
    this.found.delete(path);
  }

  isFolder(path) {
    if (!path || path === "tmp") return true;
    return [this.named, this.found].some((files) => [...files.keys()].some((name) => name.startsWith(path + "/")));
  }

  /// Whether what is a file would have to be a folder: the library looks for octrees (PATH/ept.json).
  isInFile(path) {
    return [...path.matchAll(/\//g)].some(({ index }) => this.named.has(path.slice(0, index)) || this.found.has(path.slice(0, index)));
  }

  fill_stat(at, type, size, number) {
    const view = this.view();
    for (let i = 0; i < 64; i += 8) view.setBigUint64(at + i, 0n, true);
    view.setBigUint64(at + 8, BigInt(number), true);
    view.setUint8(at + 16, type);
    view.setBigUint64(at + 24, 1n, true);
    view.setBigUint64(at + 32, BigInt(size), true);
    return DONE;
  }

  /// Calls `move` for each piece of memory that a call names; returns the bytes that were moved in all, or an error below 0.
  each(list, count, at, move) {
    let total = 0;
    for (let i = 0; i < count; i++) {
      const view = this.view(), start = view.getUint32(list + 8 * i, true), size = view.getUint32(list + 8 * i + 4, true);
      if (!size) continue;
      const got = move(at + total, new Uint8Array(this.memory.buffer, start, size));
      total += got;
      if (got < size) break;
    }
    return total;
  }

  transfer(descriptor, list, count, at, answer, verb) {
    const opened = this.open.get(descriptor);
    if (!opened) return BAD_DESCRIPTOR;
    if (opened.folder) return IS_FOLDER;
    if (!opened.source[verb]) return INVALID;
    const place = at === undefined ? opened.at : Number(at);
    let total;
    try {
      total = this.each(list, count, place, (where, bytes) => opened.source[verb](where, bytes));
    } catch (error) {
      this.failure = error.message;
      return READING_FAILED;
    }
    if (at === undefined) opened.at += total;
    this.view().setUint32(answer, total, true);
    return DONE;
  }

  // ---- What WASI names

  fd_read(descriptor, list, count, answer) {
    return this.transfer(descriptor, list, count, undefined, answer, "read");
  }

  fd_pread(descriptor, list, count, at, answer) {
    return this.transfer(descriptor, list, count, at, answer, "read");
  }

  fd_write(descriptor, list, count, answer) {
    if (descriptor > 2) return this.transfer(descriptor, list, count, undefined, answer, "write");
    const total = this.each(list, count, 0, (at, bytes) => {
      this.said = (this.said + new TextDecoder().decode(bytes.slice())).slice(-4096);
      return bytes.length;
    });
    this.view().setUint32(answer, total, true);
    return DONE;
  }

  fd_pwrite(descriptor, list, count, at, answer) {
    return this.transfer(descriptor, list, count, at, answer, "write");
  }

  fd_seek(descriptor, offset, whence, answer) {
    const opened = this.open.get(descriptor);
    if (!opened || opened.folder) return BAD_DESCRIPTOR;
    const from = whence === 0 ? 0 : whence === 1 ? opened.at : opened.source.size, at = from + Number(offset);
    if (at < 0) return INVALID;
    opened.at = at;
    this.view().setBigUint64(answer, BigInt(at), true);
    return DONE;
  }

  fd_tell(descriptor, answer) {
    return this.fd_seek(descriptor, 0n, 1, answer);
  }

  fd_close(descriptor) {
    return this.open.delete(descriptor) ? DONE : BAD_DESCRIPTOR;
  }

  fd_sync() {
    return DONE;
  }

  fd_fdstat_get(descriptor, at) {
    const opened = this.open.get(descriptor);
    if (descriptor > 3 && !opened) return BAD_DESCRIPTOR;
    const view = this.view();
    for (let i = 0; i < 24; i += 8) view.setBigUint64(at + i, i ? ~0n : 0n, true);
    view.setUint8(at, descriptor < 3 ? TYPE_DEVICE : descriptor === 3 || opened.folder ? TYPE_FOLDER : TYPE_FILE);
    return DONE;
  }

  fd_fdstat_set_flags() {
    return DONE;
  }

  fd_filestat_get(descriptor, at) {
    const opened = this.open.get(descriptor);
    if (descriptor < 4) return this.fill_stat(at, descriptor === 3 ? TYPE_FOLDER : TYPE_DEVICE, 0, descriptor);
    if (!opened) return BAD_DESCRIPTOR;
    return this.fill_stat(at, opened.folder ? TYPE_FOLDER : TYPE_FILE, opened.folder ? 0 : opened.source.size, descriptor);
  }

  fd_prestat_get(descriptor, at) {
    if (descriptor !== 3) return BAD_DESCRIPTOR;
    const view = this.view();
    view.setUint32(at, 0, true);
    view.setUint32(at + 4, 1, true);
    return DONE;
  }

  fd_prestat_dir_name(descriptor, at) {
    if (descriptor !== 3) return BAD_DESCRIPTOR;
    this.view().setUint8(at, "/".charCodeAt(0));
    return DONE;
  }

  path_open(folder, follow, at, length, how, rights, inherited, flags, answer) {
    const path = this.path_below(folder, at, length);
    if (path === undefined) return BAD_DESCRIPTOR;
    let source = this.lookup(path);
    const isFolder = !source && this.isFolder(path);
    if (how & FOLDER_ONLY && !isFolder) return source ? NO_FOLDER : NO_ENTRY;
    if (source && how & CREATE && how & EXCLUSIVE) return EXISTS;
    if (!source && !isFolder) {
      if (!(how & CREATE)) return NO_ENTRY;
      this.put(path, (source = new Bytes()));
    } else if (source && how & TRUNCATE) {
      this.put(path, (source = new Bytes()));
    }
    let descriptor = FIRST;
    while (this.open.has(descriptor)) descriptor++;
    this.open.set(descriptor, { path, source, folder: isFolder, at: 0 });
    this.view().setUint32(answer, descriptor, true);
    return DONE;
  }

  /// A path from the root of one that begins at an open folder.
  path_below(folder, at, length) {
    const path = this.path(at, length);
    if (folder === 3) return path;
    const opened = this.open.get(folder);
    return opened?.folder ? clean(opened.path + "/" + path) : undefined;
  }

  path_filestat_get(folder, follow, at, length, answer) {
    const path = this.path_below(folder, at, length);
    if (path === undefined) return BAD_DESCRIPTOR;
    const source = this.lookup(path);
    if (source) return this.fill_stat(answer, TYPE_FILE, source.size, number_of(path));
    return this.isFolder(path) ? this.fill_stat(answer, TYPE_FOLDER, 0, number_of(path)) : NO_ENTRY;
  }

  path_readlink(folder, at, length) {
    const path = this.path_below(folder, at, length);
    return path !== undefined && (this.named.has(path) || this.isFolder(path)) ? INVALID : NO_ENTRY;
  }

  path_rename(folder, from, from_length, to_folder, to, to_length) {
    const path = this.path_below(folder, from, from_length), source = this.named.get(path);
    if (!source) return NO_ENTRY;
    this.named.delete(path);
    this.named.set(this.path_below(to_folder, to, to_length), source);
    return DONE;
  }

  path_unlink_file(folder, at, length) {
    return this.named.delete(this.path_below(folder, at, length)) ? DONE : NO_ENTRY;
  }

  clock_time_get(clock, precision, at) {
    const now_ms = clock === 0 ? Date.now() : performance.now();
    this.view().setBigUint64(at, BigInt(Math.round(now_ms * 1e6)), true);
    return DONE;
  }

  random_get(at, length) {
    // By bytes of its own: memory that threads share takes none.
    new Uint8Array(this.memory.buffer, at, length).set(crypto.getRandomValues(new Uint8Array(length)));
    return DONE;
  }

  environ_sizes_get(count, bytes) {
    this.view().setUint32(count, 0, true);
    this.view().setUint32(bytes, 0, true);
    return DONE;
  }

  environ_get() {
    return DONE;
  }

  proc_exit(status) {
    throw new WebAssembly.RuntimeError(`the module ended with status ${status}`);
  }
}

/// A path from the root without "." and "..".
function clean(path) {
  const kept = [];
  for (const name of path.split("/"))
    if (name === "..") kept.pop();
    else if (name && name !== ".") kept.push(name);
  return kept.join("/");
}

/// A number that tells paths apart.
function number_of(path) {
  let hash = 0xcbf29ce484222325n;
  for (let i = 0; i < path.length; i++) hash = ((hash ^ BigInt(path.charCodeAt(i))) * 0x100000001b3n) & 0xffffffffffffffffn;
  return hash;
}
