// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Pictures of meshes, which the browser decodes: the module reads PNG alone, so JPEG and WebP become PNG before it sees them, on their own and
// within glTF. Also which files beside a mesh or a scene have to be there before it.

/// Names of pictures that the browser is to decode.
export const FOREIGN_NAME = /\.(jpe?g|webp)$/i;

/// A call takes so many words at most.
const CALL_WORDS = 1 << 13;
const RED_GREEN_BLUE_ALPHA = 6, BITS = 8;
const APP1 = 0xe1, START_OF_SCAN = 0xda; // markers of JPEG
const GLB = 0x46546c67, GLB_JSON = 0x4e4f534a, GLB_BYTES = 0x004e4942;

const is_jpeg = (bytes) => bytes[0] === 0xff && bytes[1] === 0xd8 && bytes[2] === 0xff;
const word_at = (bytes, at) => String.fromCharCode(...bytes.subarray(at, at + 4));
const is_webp = (bytes) => word_at(bytes, 0) === "RIFF" && word_at(bytes, 8) === "WEBP";

const is_foreign = (bytes) => is_jpeg(bytes) || is_webp(bytes);

const REMAINDERS = Uint32Array.from({ length: 256 }, (_, n) => {
  for (let i = 0; i < 8; i++) n = n & 1 ? 0xedb88320 ^ (n >>> 1) : n >>> 1;
  return n;
});

/// A piece of a PNG: its length, kind, bytes, and the remainder by which they are checked.
function chunk(kind, bytes) {
  const made = new Uint8Array(bytes.length + 12), view = new DataView(made.buffer);
  view.setUint32(0, bytes.length);
  made.set([...kind].map((letter) => letter.charCodeAt(0)), 4);
  made.set(bytes, 8);
  let sum = ~0;
  for (const byte of made.subarray(4, bytes.length + 8)) sum = REMAINDERS[(sum ^ byte) & 255] ^ (sum >>> 8);
  view.setUint32(bytes.length + 8, ~sum >>> 0);
  return made;
}

/// A JPEG without what a camera says of how it was held (Exif), by which browsers would turn the picture; the program does not.
function without_turn(bytes) {
  if (!is_jpeg(bytes)) return bytes;
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.length), kept = [bytes.subarray(0, 2)];
  let at = 2;
  for (let length; at + 4 <= bytes.length && bytes[at] === 0xff && bytes[at + 1] !== START_OF_SCAN; at += length) {
    length = 2 + view.getUint16(at + 2);
    if (bytes[at + 1] !== APP1 || word_at(bytes, at + 4) !== "Exif") kept.push(bytes.subarray(at, at + length));
  }
  return new Blob([...kept, bytes.subarray(at)]);
}

/// The pixels that the browser sees in a JPEG or WebP, four bytes each, in the colours that are written there. A canvas rounds the colours of
/// what lets light through (by 1 of 255), a decoder of its own, where there is one, does not.
async function decode_picture(bytes) {
  if (is_webp(bytes) && self.ImageDecoder) {
    const decoder = new ImageDecoder({ data: bytes, type: "image/webp", colorSpaceConversion: "none", premultiplyAlpha: "none" });
    const { image } = await decoder.decode();
    try {
      if (/^(RGB|BGR)[AX]$/.test(image.format)) {
        const { codedWidth: width, codedHeight: height, format } = image, pixels = new Uint8Array(4 * width * height);
        await image.copyTo(pixels);
        for (let i = 0; i < pixels.length; i += 4) {
          if (format.startsWith("B")) [pixels[i], pixels[i + 2]] = [pixels[i + 2], pixels[i]];
          if (format.endsWith("X")) pixels[i + 3] = 255;
        }
        return { width, height, pixels };
      }
    } finally {
      image.close();
      decoder.close();
    }
  }
  const bitmap = await createImageBitmap(new Blob([without_turn(bytes)]), { colorSpaceConversion: "none", premultiplyAlpha: "none" });
  const { width, height } = bitmap, context = new OffscreenCanvas(width, height).getContext("2d");
  context.drawImage(bitmap, 0, 0);
  bitmap.close();
  return { width, height, pixels: context.getImageData(0, 0, width, height).data };
}

/// The bytes of a PNG of what the browser sees in a JPEG or WebP.
async function to_png(bytes) {
  const { width, height, pixels } = await decode_picture(bytes), rows = new Uint8Array(height * (4 * width + 1));
  for (let y = 0; y < height; y++) rows.set(pixels.subarray(4 * width * y, 4 * width * (y + 1)), y * (4 * width + 1) + 1);
  const packed = new Blob([rows]).stream().pipeThrough(new CompressionStream("deflate")), head = new DataView(new ArrayBuffer(13));
  head.setUint32(0, width);
  head.setUint32(4, height);
  head.setUint16(8, (BITS << 8) | RED_GREEN_BLUE_ALPHA);
  const parts = [Uint8Array.of(137, 80, 78, 71, 13, 10, 26, 10), chunk("IHDR", new Uint8Array(head.buffer)),
                 chunk("IDAT", new Uint8Array(await new Response(packed).arrayBuffer())), chunk("IEND", new Uint8Array())];
  return new Uint8Array(await new Blob(parts).arrayBuffer());
}

/// A binary glTF whose pictures are PNG: those that are not are put behind all others. What is not as the format says stays as it is.
async function with_png(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.length), text_bytes = bytes.length > 28 ? view.getUint32(12, true) : 0;
  if (!text_bytes || view.getUint32(0, true) !== GLB || view.getUint32(16, true) !== GLB_JSON || 28 + text_bytes > bytes.length) return bytes;
  const body_at = 20 + text_bytes, body = bytes.subarray(body_at + 8, body_at + 8 + view.getUint32(body_at, true));
  const parts = [body];
  let size = body.length, text;
  try {
    text = JSON.parse(new TextDecoder().decode(bytes.subarray(20, body_at)));
    for (const image of text.images ?? []) {
      const { byteOffset: from = 0, byteLength: length = 0 } = text.bufferViews?.[image.bufferView] ?? {};
      const picture = body.subarray(from, from + length);
      if (!is_foreign(picture)) continue;
      const png = await to_png(picture), gap = -size & 3;
      image.bufferView = text.bufferViews.push({ buffer: 0, byteOffset: size + gap, byteLength: png.length }) - 1;
      image.mimeType = "image/png";
      parts.push(new Uint8Array(gap), png);
      size += gap + png.length;
    }
  } catch {
    return bytes;
  }
  if (parts.length === 1) return bytes;
  text.buffers[0].byteLength = size;
  const encoded = new TextEncoder().encode(JSON.stringify(text)), padded = new Uint8Array((encoded.length + 3) & ~3).fill(32);
  padded.set(encoded);
  parts.push(new Uint8Array(-size & 3));
  size = (size + 3) & ~3;
  const head = Uint32Array.of(GLB, 2, 28 + padded.length + size, padded.length, GLB_JSON), between = Uint32Array.of(size, GLB_BYTES);
  return new Uint8Array(await new Blob([head, padded, between, ...parts]).arrayBuffer());
}

/// A glTF whose pictures within its text (data:) are PNG.
async function with_png_in_text(bytes) {
  try {
    const text = JSON.parse(new TextDecoder().decode(bytes));
    let found = false;
    for (const image of text.images ?? []) {
      const [, data] = /^data:[^,]*;base64,(.*)$/s.exec(image.uri ?? "") ?? [], picture = data && Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0));
      if (!picture || !is_foreign(picture)) continue;
      const png = await to_png(picture), letters = [];
      for (let i = 0; i < png.length; i += CALL_WORDS) letters.push(String.fromCharCode(...png.subarray(i, i + CALL_WORDS)));
      image.uri = "data:image/png;base64," + btoa(letters.join(""));
      image.mimeType = "image/png";
      found = true;
    }
    return found ? new TextEncoder().encode(JSON.stringify(text)) : bytes;
  } catch {
    return bytes; // it fails where it is opened
  }
}

/// Files that have pictures within.
export const HAS_PICTURES = /\.(glb|gltf)$/i;

/// A file's bytes as the module can read them. A picture that is broken stays as it is, and fails where it is read.
export async function as_readable(name, bytes) {
  if (/\.glb$/i.test(name)) return with_png(bytes);
  if (/\.gltf$/i.test(name)) return with_png_in_text(bytes);
  return is_foreign(bytes) ? to_png(bytes).catch(() => bytes) : bytes;
}

/// Names of files beside a scene or a mesh that are to be there before it is opened: all items of a scene, and of a mesh what leads to
/// pictures that the browser has to decode. What else it needs is fetched when it asks for it.
export function names_beside(name, text) {
  if (/\.obj$/i.test(name)) return [...text.matchAll(/^\s*mtllib\s+(.+?)\s*$/gm)].map((line) => line[1]);
  if (/\.mtl$/i.test(name)) return [...text.matchAll(/^\s*map_Kd\s+(?:-\w+\s+\S+\s+)*(.+?)\s*$/gm)].map((line) => line[1]).filter((one) => FOREIGN_NAME.test(one));
  if (!/\.(json|gltf)$/i.test(name)) return [];
  let said;
  try {
    said = JSON.parse(text);
  } catch {
    return []; // it fails where it is opened
  }
  const items = (said.items ?? []).map(({ file }) => (/(^|\/)[^./]+$/.test(file) ? `${file}/ept.json` : file)), pictures = (said.images ?? []).map((image) => image.uri);
  return [...items, ...pictures.filter((uri) => FOREIGN_NAME.test(uri)).map(decodeURIComponent)]
    .filter((one) => typeof one === "string" && !/^(\/|data:)/.test(one));
}
