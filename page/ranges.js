// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A file of a server of which only what is needed is fetched, by requests that wait; in workers only.

/// Small reads are of blocks, of which so many are kept, the ones that were used last; larger ones are asked for as they are, but for what is
/// there. Of those a few are kept where they are small, as the hierarchy's, which is read in steps that overlap.
const BLOCK_BYTES = 1 << 16, KEPT_BLOCKS = 512, PIECE_BYTES = 1 << 18, KEPT_PIECES = 8;

export class Ranges {
  /// `tag` is what the server calls this version of the file, or null; `first` are its first bytes.
  constructor(url, size, tag, first) {
    this.url = url;
    this.size = size;
    this.tag = tag;
    this.pieces = []; // { from, bytes }
    this.blocks = new Map();
    for (let at = 0; at + BLOCK_BYTES <= first.length; at += BLOCK_BYTES) this.blocks.set(at / BLOCK_BYTES, first.subarray(at, at + BLOCK_BYTES));
  }

  fetch(from, to) {
    const request = new XMLHttpRequest();
    request.open("GET", this.url, false);
    request.setRequestHeader("Range", `bytes=${from}-${to - 1}`);
    request.responseType = "arraybuffer";
    try {
      request.send();
    } catch {
      throw new Error("the server does not answer any more");
    }
    if (request.status !== 206) throw new Error(`the server says ${request.status} ${request.statusText} to a part of the file`);
    if (this.tag && tag_of((name) => request.getResponseHeader(name)) !== this.tag) throw new Error("the file was changed on the server");
    return new Uint8Array(request.response);
  }

  block(index) {
    let block = this.blocks.get(index);
    this.blocks.delete(index);
    block ??= this.fetch(index * BLOCK_BYTES, Math.min((index + 1) * BLOCK_BYTES, this.size));
    this.blocks.set(index, block); // the last one now
    if (this.blocks.size > KEPT_BLOCKS) this.blocks.delete(this.blocks.keys().next().value);
    return block;
  }

  /// What is kept from a place on, as far as it goes; else nothing.
  kept(at) {
    const piece = this.pieces.find(({ from, bytes }) => at >= from && at < from + bytes.length);
    if (piece) return piece.bytes.subarray(at - piece.from);
    const index = Math.floor(at / BLOCK_BYTES);
    return this.blocks.has(index) ? this.block(index).subarray(at - index * BLOCK_BYTES) : null;
  }

  read(at, into) {
    const size = Math.max(0, Math.min(into.length, this.size - at));
    if (!size) return 0;
    let bytes = this.kept(at); // the rest is asked for again
    if (!bytes && size >= BLOCK_BYTES) {
      bytes = this.fetch(at, at + size);
      if (size <= PIECE_BYTES) this.pieces = [...this.pieces, { from: at, bytes }].slice(-KEPT_PIECES);
    } else if (!bytes) {
      const index = Math.floor(at / BLOCK_BYTES);
      bytes = this.block(index).subarray(at - index * BLOCK_BYTES);
    }
    into.set(bytes.subarray(0, size));
    return Math.min(bytes.length, size);
  }
}

const tag_of = (header) => header("etag") ?? header("last-modified");

/// Opens a file by its first bytes. Returns { source } where the server gives parts and `wanted` says yes to these, else { answer }
/// of the whole file.
export async function open_ranges(url, wanted) {
  const answer = await fetch(url, { headers: { range: `bytes=0-${4 * BLOCK_BYTES - 1}` } });
  if (answer.status === 416) return { answer: await fetch(url) }; // it is empty
  if (answer.status !== 206) return { answer };
  const first = new Uint8Array(await answer.arrayBuffer());
  // Another site may hide how long the file is.
  const said = /\/(\d+)$/.exec(answer.headers.get("content-range") ?? "");
  const size = said ? Number(said[1]) : Number((await fetch(url, { method: "HEAD" })).headers.get("content-length"));
  if (size === first.length) return { bytes: first };
  if (!size || !wanted(first)) return { answer: await fetch(url) };
  return { source: new Ranges(url, size, tag_of((name) => answer.headers.get(name)), first) };
}
