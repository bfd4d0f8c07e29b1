// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// <ewa-view src="scan.laz">: a view of points, meshes, Gaussians and volumes. The hand's events go to a worker, whose viewer is that
// of the program (viewer/), and its pictures come back. docs/page.md has attributes, methods and events.
import { PARTS, STYLE } from "./look.js";

const SHIFT = 1, CTRL = 2, ALT = 4;
const LEFT = 1, MIDDLE = 2, RIGHT = 3;
/// Keys that have names; letters are themselves, in lower case.
const KEYS = { Enter: 13, Escape: 27, Delete: 127, ArrowLeft: 268, ArrowRight: 269, ArrowUp: 270, ArrowDown: 271 };
/// Rows of the viewer's help that are of windows.
const NOT_IN_PAGES = /^(Ctrl \S+|Tab|F\d+)$/;
const DOUBLE_MS = 350, DOUBLE_PX = 8;
/// Pixels of a wheel that are a notch, and what a pinch on a trackpad does.
const NOTCH_PX = 100, PINCH_PX = 100;
const FRAGMENT = "#camera=";

const encode = (text) => btoa(text).replace(/\+/g, "-").replace(/\//g, "_").replace(/=+$/, "");
const decode = (text) => atob(text.replace(/-/g, "+").replace(/_/g, "/"));

export class EwaView extends HTMLElement {
  static observedAttributes = ["src", "color-by", "point-size", "clip", "background", "color-bar", "camera", "label"];

  /// Where the worker and the modules are; a page of its own brings them along. `threads` draw where the page is isolated.
  static sources = {
    threads: navigator.hardwareConcurrency || 1,
    worker: () => new Worker(new URL("worker.js", import.meta.url), { type: "module" }),
    modules: [
      { url: new URL("page-relaxed.wasm.gz", import.meta.url).href, relaxed: true },
      { url: new URL("page.wasm.gz", import.meta.url).href },
    ],
  };

  #worker = null;
  #questions = new Map();
  #asked = 0;
  #ordered = 0; // orders that were sent
  #sent = null; // the same where the worker sees it, if memory can be shared
  #parts;
  #observer = null;
  #fingers = new Map();
  #pinch = null;
  #click = { at_ms: -1e9, x: 0, y: 0, count: 0 };
  #measuring = false;
  #boxed = false;
  #items = [];
  #still = false;
  #is_ready = false;

  constructor() {
    super();
    const root = this.attachShadow({ mode: "open" }), sheet = new CSSStyleSheet();
    sheet.replaceSync(STYLE);
    root.adoptedStyleSheets = [sheet];
    root.innerHTML = PARTS;
    const part = (selector) => root.querySelector(selector);
    this.#parts = { stage: part(".stage"), canvas: part("canvas"), hint: part(".hint"), card: part(".card"), status: part(".status"),
                    error: part(".error"), color: part('[data-do="color"]'), help: part("dialog") };
    this.#parts.context = this.#parts.canvas.getContext("2d");
    this.#listen(root);
  }

  // ---- What a page calls

  /// Shows files in place of nothing, or beside what is there: File, URL or { name, bytes, text, url, file, beside }.
  open(...files) {
    this.#start();
    const orders = files.flat().map((file) => {
      if (file instanceof File) return { name: file.name, file };
      if (typeof file === "string" || file instanceof URL) {
        const url = new URL(file, document.baseURI);
        return { name: decodeURIComponent(url.pathname.split("/").pop()) || "scene", url: url.href };
      }
      return file;
    });
    this.#say("loading");
    this.#post({ open: orders });
  }

  /// Does what a line of the viewer's language says (docs/viewer.md); the promise says whether it was understood.
  do(command) {
    return this.#ask("do", command);
  }

  /// The camera as the text that `ewa render --camera` reads.
  camera() {
    return this.#ask("camera");
  }

  set_camera(text) {
    return this.#ask("set_camera", text);
  }

  /// What is open: name, kind, count, attributes.
  items() {
    return this.#ask("items");
  }

  /// A picture as a Blob of PNG, drawn for it: { width, height, transparent }.
  async shot({ width, height, transparent } = {}) {
    const size = width && height ? `${width}x${height}` : "";
    return new Blob([await this.#ask("shot", `${size} ${transparent ? "transparent" : ""}`)], { type: "image/png" });
  }

  /// Whether the picture is the whole one and nothing is under way.
  get still() {
    return this.#still;
  }

  // ---- Life

  connectedCallback() {
    this.#observer = new ResizeObserver(() => this.#resize());
    this.#observer.observe(this.#parts.stage);
    if (!this.#worker) this.#list([]);
    if (this.hasAttribute("src")) this.open(this.getAttribute("src"));
  }

  disconnectedCallback() {
    this.#observer.disconnect();
    this.#observer = null;
    this.#end("the view was taken off its page");
  }

  attributeChangedCallback(name, before, now) {
    if (name === "label") this.#label();
    if (before === now) return;
    if (name === "src" && this.#observer) { // before, connectedCallback() opens it
      this.#end("another file is opened");
      Object.assign(this.#parts.canvas, { width: 1, height: 1 });
      if (now) this.open(now);
    }
    if (!this.#worker) return;
    this.#commands(name).forEach((command) => this.#order("do", command));
    if (name === "camera" && now) this.#order("set_camera", now);
  }

  /// What an attribute says in the viewer's language.
  #commands(name) {
    const value = this.getAttribute(name);
    if (name === "point-size") return [`set point_size_px ${value ?? 0}`];
    if (name === "background") return [`set background ${value ?? "white"}`];
    if (name === "color-bar") return [`set color_bar ${value === null ? "off" : "on"}`];
    if (name === "clip" && this.#is_ready) return [`box ${value ?? "off"}`];
    if (name === "color-by" && this.#is_ready) return this.#color_commands(value ?? "auto");
    return [];
  }

  #color_commands(attribute) {
    const shown = this.#items.flatMap((item, i) => (attribute === "auto" || item.attributes.includes(attribute) ? [i] : []));
    return [...shown.map((i) => `color ${i} ${attribute}`), `set color_bar ${attribute === "auto" ? "off" : "on"}`];
  }

  #start() {
    if (this.#worker) return;
    const { width, height, scale } = this.#size(), { worker, modules, threads } = EwaView.sources;
    if (self.crossOriginIsolated) this.#sent = new Int32Array(new SharedArrayBuffer(4));
    const commands = ["background", "point-size", "color-bar"].filter((name) => this.hasAttribute(name)).flatMap((name) => this.#commands(name));
    if (matchMedia("(prefers-reduced-motion: reduce)").matches) commands.push("set animate off");
    let made;
    try {
      this.#worker = made = worker();
    } catch (error) {
      this.#fail({ name: "", reason: `no worker can be started: ${error.message}` });
      return;
    }
    made.onmessage = ({ data }) => made === this.#worker && this.#hear(data); // one that has ended may have posted before
    made.onerror = (event) => made === this.#worker && this.#stop(event.message || "the worker's script cannot be loaded");
    this.#ordered = 0;
    this.#post({ start: { modules, width, height, scale, commands, threads, sent: this.#sent?.buffer } });
  }

  #stop(reason) {
    this.#end(reason);
    this.#fail({ name: "", reason });
  }

  /// Ends the worker, with all that it has open. What was asked is answered by the reason.
  #end(reason) {
    this.#worker?.terminate();
    this.#worker = null;
    this.#is_ready = this.#still = false;
    this.#toggle("box", (this.#boxed = false));
    this.#parts.card.hidden = this.#parts.error.hidden = true;
    this.#list([]);
    const questions = [...this.#questions.values()];
    this.#questions.clear();
    for (const { reject } of questions) reject(new Error(reason));
  }

  #size() {
    const box = this.#parts.stage.getBoundingClientRect();
    return { width: Math.max(1, Math.round(box.width)), height: Math.max(1, Math.round(box.height)), scale: devicePixelRatio || 1 };
  }

  #resize() {
    const { width, height, scale } = this.#size();
    this.#event({ kind: "resize", x: width, y: height, amount: scale });
  }

  #label() {
    const label = this.getAttribute("label") ?? this.#items.map((item) => item.name).join(", ");
    this.#parts.stage.setAttribute("aria-label", (label || "nothing is open") + ". Arrow keys turn, plus and minus zoom, H lists all keys.");
  }

  // ---- To the worker and back

  #post(orders) {
    if (!this.#worker) return;
    this.#ordered++;
    if (this.#sent) Atomics.store(this.#sent, 0, this.#ordered);
    this.#still = false;
    this.#worker.postMessage(orders);
  }

  #event(event) {
    this.#post({ event });
  }

  #ask(what, word) {
    if (!this.#worker) return Promise.reject(new Error("nothing is open"));
    return new Promise((resolve, reject) => {
      const id = ++this.#asked;
      this.#questions.set(id, { resolve, reject });
      this.#post({ ask: { id, what, word } });
    });
  }

  /// Asks for what nobody waits for: what is wrong is shown, unless its worker has ended meanwhile.
  #order(what, word) {
    const worker = this.#worker;
    this.#ask(what, word).catch((problem) => worker === this.#worker && this.#fail({ name: "", reason: problem.message }));
  }

  #hear(told) {
    if (told.picture) this.#show(told.picture);
    if (told.still === this.#ordered) this.#rest();
    if (told.progress) this.#say(told.progress.stage, told.progress.fraction);
    if (told.started) this.#fill_help(told.started.help);
    if (told.message) this.#fire("message", { text: told.message });
    if (told.failed) this.#fail(told.failed);
    if (told.items) this.#list(told.items);
    if (told.ready) this.#ready();
    if (told.picked) this.#picked(told.picked);
    if (told.stopped) this.#stop(told.stopped);
    if (told.answer) {
      const { id, value, error } = told.answer, question = this.#questions.get(id);
      this.#questions.delete(id);
      if (error) question?.reject(new Error(error));
      else question?.resolve(value);
    }
  }

  #show({ pixels, width, height, still, handled, ...facts }) {
    const { canvas, context } = this.#parts;
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    context.putImageData(new ImageData(pixels, width, height), 0, 0);
    if (still && handled === this.#ordered) this.#rest();
    this.#worker.postMessage({ shown: true });
    this.#fire("picture", { width, height, still: this.#still, ...facts });
  }

  /// All is done that was ordered.
  #rest() {
    this.#still = true;
    this.#say(null);
  }

  #ready() {
    this.#is_ready = true;
    for (const name of ["color-by", "clip"])
      if (this.hasAttribute(name)) this.#commands(name).forEach((command) => this.#order("do", command));
    const camera = this.#linked() ?? this.getAttribute("camera");
    if (camera) this.#order("set_camera", camera);
    this.#fire("ready", { items: this.#items });
  }

  #list(items) {
    this.#items = items;
    this.#say(null);
    this.#parts.hint.textContent = items.length || !this.hasAttribute("drop") ? "" : this.getAttribute("drop") || "Drop a file here";
    this.#label();
    const names = [...new Set(items.flatMap((item) => item.attributes))];
    this.#parts.color.replaceChildren(new Option("colours", "auto"), ...names.map((name) => new Option(name)));
    this.#parts.color.value = names.find((name) => items.some(({ color }) => color === name || `position.${color}` === name)) ?? "auto";
    this.#parts.color.hidden = !names.length;
  }

  #picked({ text, places }) {
    this.#parts.card.hidden = !text;
    this.#parts.card.querySelector("output").textContent = text;
    if (!places.length) return;
    const [a, b] = places;
    if (b) this.#fire("measure", { from: a, to: b, distance: Math.hypot(...a.map((x, i) => b[i] - x)), text });
    else this.#fire("pick", { place: a, text });
  }

  #fire(type, detail) {
    this.dispatchEvent(new CustomEvent(type, { detail, bubbles: true, composed: true }));
  }

  // ---- What is said

  #say(stage, fraction) {
    const { status } = this.#parts;
    status.hidden = stage === null;
    if (stage === null) return;
    status.querySelector("span").textContent = stage;
    const bar = status.querySelector("progress");
    if (fraction === undefined) bar.removeAttribute("value");
    else bar.value = fraction;
  }

  #fail({ name, reason }) {
    this.#say(null);
    const text = !reason ? `${name}: cannot be shown` : reason.includes(name) ? reason : `${name}: ${reason}`;
    this.#parts.error.querySelector("span").textContent = text.replace(/^\//, "");
    this.#parts.error.hidden = false;
    this.#fire("error", { name, reason });
  }

  #fill_help(rows) {
    const gestures = [["one finger", "turn; tap to pick"], ["two fingers", "move along, nearer and farther"]];
    const here = rows.filter(([keys]) => !NOT_IN_PAGES.test(keys)).map(([keys, what]) => [keys, what.replace(/; with Ctrl.*/, "")]); // the browser's
    const cells = [...gestures, ...here].map(([keys, what]) => {
      const row = document.createElement("tr");
      for (const text of [keys, what]) row.insertCell().textContent = text;
      return row;
    });
    this.#parts.help.querySelector("table").replaceChildren(...cells);
  }

  // ---- The hand

  #listen(root) {
    const { stage, color } = this.#parts;
    stage.addEventListener("pointerdown", (e) => this.#down(e));
    stage.addEventListener("pointermove", (e) => this.#move(e));
    stage.addEventListener("pointerup", (e) => this.#up(e));
    stage.addEventListener("pointercancel", (e) => this.#up(e, true));
    stage.addEventListener("contextmenu", (e) => e.preventDefault());
    stage.addEventListener("wheel", (e) => this.#wheel(e), { passive: false });
    stage.addEventListener("keydown", (e) => this.#key(e, "key"));
    stage.addEventListener("keyup", (e) => this.#key(e, "keyup"));
    stage.addEventListener("blur", () => this.#event({ kind: "leave" }));
    root.addEventListener("click", (e) => this.#press(e.target.closest("button")?.dataset.do));
    root.querySelector('[data-do="view"]').addEventListener("change", ({ target }) => {
      if (target.value) this.#order("do", `view ${target.value}`);
      target.value = "";
    });
    color.addEventListener("change", () => this.#color_commands(color.value).forEach((command) => this.#order("do", command)));
    this.addEventListener("dragover", (e) => e.preventDefault());
    this.addEventListener("drop", (e) => this.#drop(e));
  }

  #place(e) {
    const box = this.#parts.stage.getBoundingClientRect();
    return { x: e.clientX - box.left, y: e.clientY - box.top };
  }

  #modifiers(e) {
    return (e.shiftKey ? SHIFT : 0) | (e.ctrlKey || e.metaKey ? CTRL : 0) | (e.altKey ? ALT : 0);
  }

  #down(e) {
    const { stage } = this.#parts, place = this.#place(e);
    stage.focus({ preventScroll: true });
    stage.setPointerCapture(e.pointerId);
    this.#fingers.set(e.pointerId, place);
    if (this.#fingers.size === 2) {
      this.#event({ kind: "leave" });
      this.#pinch = this.#two();
      this.#event({ kind: "press", ...this.#pinch.middle, button: MIDDLE, clicks: 1 });
    } else if (this.#fingers.size === 1) {
      const near = Math.hypot(place.x - this.#click.x, place.y - this.#click.y) < DOUBLE_PX;
      const count = near && e.timeStamp - this.#click.at_ms < DOUBLE_MS ? this.#click.count + 1 : 1;
      this.#click = { at_ms: e.timeStamp, ...place, count };
      this.#event({ kind: "press", ...place, button: [LEFT, MIDDLE, RIGHT][e.button] ?? LEFT, clicks: count, modifiers: this.#modifiers(e) });
    }
  }

  /// Where two fingers are: their middle and their distance.
  #two() {
    const [a, b] = this.#fingers.values();
    return { middle: { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 }, distance: Math.max(1, Math.hypot(a.x - b.x, a.y - b.y)) };
  }

  #move(e) {
    const place = this.#place(e);
    if (this.#fingers.has(e.pointerId)) this.#fingers.set(e.pointerId, place);
    if (!this.#pinch) {
      if (this.#fingers.size || e.pointerType === "mouse") this.#event({ kind: "move", ...place, modifiers: this.#modifiers(e) });
      return;
    }
    const now = this.#two();
    this.#event({ kind: "move", ...now.middle });
    this.#event({ kind: "pinch", ...now.middle, amount: now.distance / this.#pinch.distance });
    this.#pinch = now;
  }

  #up(e, given_up = false) {
    if (!this.#fingers.delete(e.pointerId)) return;
    const place = this.#place(e), modifiers = this.#modifiers(e) | (this.#measuring ? SHIFT : 0);
    if (this.#pinch) {
      if (this.#fingers.size < 2) {
        this.#pinch = null;
        this.#fingers.clear(); // the other finger starts anew
        this.#event({ kind: "leave" });
      }
    } else if (given_up) {
      this.#event({ kind: "leave" });
    } else {
      this.#event({ kind: "release", ...place, button: [LEFT, MIDDLE, RIGHT][e.button] ?? LEFT, clicks: this.#click.count, modifiers });
    }
  }

  /// Zooms where the view has the hand; else the page scrolls.
  #wheel(e) {
    const whole = this.clientHeight >= innerHeight - 1;
    if (!whole && !e.ctrlKey && !this.matches(":focus-within")) return;
    e.preventDefault();
    const place = this.#place(e), px = e.deltaY * [1, NOTCH_PX / 3, NOTCH_PX][e.deltaMode];
    if (e.ctrlKey) this.#event({ kind: "pinch", ...place, amount: Math.exp(-px / PINCH_PX) });
    else this.#event({ kind: "wheel", ...place, amount: -px / NOTCH_PX, modifiers: this.#modifiers(e) });
  }

  #key(e, kind) {
    const key = KEYS[e.key] ?? (e.key.length === 1 ? e.key.toLowerCase().charCodeAt(0) : 0);
    if (!key || e.ctrlKey || e.metaKey) return; // the browser's
    e.preventDefault();
    if (e.key.toLowerCase() === "h") {
      if (kind === "key") this.#press("help");
      return;
    }
    this.#event({ kind, key, modifiers: this.#modifiers(e) });
  }

  #drop(e) {
    e.preventDefault();
    const files = [...e.dataTransfer.files], beside = /\.(bin|mtl|png|jpe?g|webp|raw|tfn?)$/i;
    if (!files.length) return;
    const alone = files.length === 1 || files.every((file) => beside.test(file.name));
    this.#parts.error.hidden = true;
    this.open(files.map((file) => ({ name: file.name, file, beside: !alone && beside.test(file.name) })));
  }

  async #press(what) {
    const { card, error, help } = this.#parts;
    const own = {
      home: () => this.#order("do", "view reset"),
      measure: () => this.#toggle("measure", (this.#measuring = !this.#measuring)),
      box: () => (this.#toggle("box", (this.#boxed = !this.#boxed)), this.#order("do", `box ${this.#boxed ? "on" : "off"}`)),
      share: () => this.#share(),
      shot: async () => save(await this.shot(), "ewa.png"),
      full: () => (document.fullscreenElement ? document.exitFullscreen() : this.requestFullscreen()),
      help: () => help.showModal(),
      close: () => ((card.hidden = true), this.#order("do", "clear")),
      dismiss: () => (error.hidden = true),
    };
    try {
      await own[what]?.();
    } catch (problem) {
      this.#fail({ name: "", reason: problem.message });
    }
  }

  #toggle(name, pressed) {
    this.shadowRoot.querySelector(`[data-do="${name}"]`).setAttribute("aria-pressed", pressed);
  }

  // ---- The camera in the address

  /// The camera that the page's address has, where this view is the one that it is about.
  #linked() {
    if (!this.hasAttribute("link") || !location.hash.startsWith(FRAGMENT)) return null;
    try {
      return decode(location.hash.slice(FRAGMENT.length));
    } catch {
      return null;
    }
  }

  async #share() {
    const camera = JSON.stringify(JSON.parse(await this.camera())), url = new URL(location.href);
    url.hash = FRAGMENT + encode(camera);
    if (this.hasAttribute("link")) location.replace(url.hash);
    let text = url.href;
    try {
      await navigator.clipboard.writeText(url.href);
      text = "The link is on the clipboard:\n" + text;
    } catch {
      // It can be copied by hand.
    }
    this.#parts.card.hidden = false;
    this.#parts.card.querySelector("output").textContent = text;
    this.#fire("share", { url: url.href, camera });
  }
}

function save(blob, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

customElements.define("ewa-view", EwaView);
