// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT

/** Three numbers in the coordinates of the files. */
export type Place = [number, number, number];

export interface Item {
  name: string;
  kind: "points" | "points on a mesh" | "Gaussians" | "voxels";
  count: number;
  /** Names that color-by takes. */
  attributes: string[];
  /** The attribute of its colours, where it has one, with the numbers of the first and the last colour. */
  color?: string;
  range?: [number, number];
  classes: { value: number; color: [number, number, number]; name: string }[];
}

/** A file to show: bytes, base64 or an address. `beside`: another one names it. */
export interface Source {
  name: string;
  file?: File;
  bytes?: ArrayBuffer | Uint8Array;
  text?: string;
  url?: string;
  beside?: boolean;
}

export interface Picture {
  width: number;
  height: number;
  /** The whole picture, the bytes of `ewa render`. */
  still: boolean;
  /** What drawing took, in seconds. */
  drawn_s: number;
  splats: number;
  level: number;
  /** What the module holds, in bytes. */
  memory: number;
  /** Threads that draw: one where the page is not isolated (COOP, COEP). */
  threads: number;
}

export interface EwaViewEvents {
  ready: CustomEvent<{ items: Item[] }>;
  pick: CustomEvent<{ place: Place; text: string }>;
  measure: CustomEvent<{ from: Place; to: Place; distance: number; text: string }>;
  error: CustomEvent<{ name: string; reason: string }>;
  message: CustomEvent<{ text: string }>;
  picture: CustomEvent<Picture>;
  share: CustomEvent<{ url: string; camera: string }>;
}

/** Attributes: src, color-by, camera, clip, point-size, background, label, link, drop. */
export class EwaView extends HTMLElement {
  /** Where the worker and the modules are, for pages that bring them along in their own way. */
  static sources: {
    worker: () => Worker;
    modules: { url?: string; text?: string; relaxed?: boolean }[];
    /** How many threads are to draw where the page is isolated; the processors of the machine if nothing is said. */
    threads: number;
  };
  /** The picture is the whole one, and nothing is under way. */
  readonly still: boolean;
  open(...files: (File | string | URL | Source)[]): void;
  do(command: string): Promise<boolean>;
  camera(): Promise<string>;
  set_camera(text: string): Promise<boolean>;
  items(): Promise<Item[]>;
  shot(options?: { width?: number; height?: number; transparent?: boolean }): Promise<Blob>;
  addEventListener<K extends keyof EwaViewEvents>(type: K, listener: (event: EwaViewEvents[K]) => void,
                                                  options?: boolean | AddEventListenerOptions): void;
  addEventListener(type: string, listener: EventListenerOrEventListenerObject, options?: boolean | AddEventListenerOptions): void;
}

declare global {
  interface HTMLElementTagNameMap {
    "ewa-view": EwaView;
  }
}
