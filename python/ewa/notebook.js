// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The picture of a view in a notebook: turns by drags, shifts by drags with Shift or the right button, goes nearer by the
// wheel. What was asked for while a picture is drawn is summed up and sent when it has come, so that none waits in a line.

/** How long nothing moves before the whole picture is asked for. */
const STILL_MS = 150;

function render({ model, el }) {
  const picture = document.createElement("img");
  const asked = { turn: [0, 0], shift: [0, 0], nearer: 0, again: false };
  let drawing = false, last = null, rest = null, address = null;
  picture.draggable = false;
  picture.style.cssText = "max-width: 100%; touch-action: none; cursor: grab; user-select: none";
  picture.alt = "a view that is dragged to turn it";
  picture.tabIndex = 0;

  function isMoved() {
    return [...asked.turn, ...asked.shift, asked.nearer].some((number) => number !== 0);
  }

  function send(whole) {
    if (drawing) return;
    drawing = true;
    model.send({ ...asked, whole });
    Object.assign(asked, { turn: [0, 0], shift: [0, 0], nearer: 0, again: false });
  }

  /** Asks for a quick picture now, and for the whole one when nothing has moved for a while. */
  function move() {
    clearTimeout(rest);
    rest = setTimeout(() => { asked.again = true; send(true); }, STILL_MS);
    send(false);
  }

  function scale() {
    const shown = picture.clientWidth;
    return shown ? model.get("width_px") / shown : 1;
  }

  picture.addEventListener("pointerdown", (event) => {
    last = [event.clientX, event.clientY, event.shiftKey || event.button === 2];
    picture.setPointerCapture(event.pointerId);
    event.preventDefault();
  });
  picture.addEventListener("pointermove", (event) => {
    if (!last) return;
    const drag = last[2] ? asked.shift : asked.turn;
    drag[0] += (event.clientX - last[0]) * scale();
    drag[1] += (event.clientY - last[1]) * scale();
    last = [event.clientX, event.clientY, last[2]];
    move();
  });
  const end = () => { last = null; };
  picture.addEventListener("pointerup", end);
  picture.addEventListener("pointercancel", end);
  picture.addEventListener("contextmenu", (event) => event.preventDefault());
  picture.addEventListener("wheel", (event) => {
    asked.nearer -= event.deltaY / (event.deltaMode ? 3 : 100);
    event.preventDefault();
    move();
  }, { passive: false });
  picture.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: [-20, 0], ArrowRight: [20, 0], ArrowUp: [0, -20], ArrowDown: [0, 20] }[event.key];
    if (!step) return;
    asked.turn[0] += step[0];
    asked.turn[1] += step[1];
    event.preventDefault();
    move();
  });

  function receive(message, buffers) {
    if (message.kind !== "picture") return;
    const before = address;
    address = URL.createObjectURL(new Blob([buffers[0]], { type: message.type }));
    picture.src = address;
    if (before) URL.revokeObjectURL(before);
    drawing = false;
    if (isMoved() || asked.again) send(!isMoved());
  }

  model.on("msg:custom", receive);
  el.appendChild(picture);
  asked.again = true;
  send(true);
  return () => {
    model.off("msg:custom", receive);
    clearTimeout(rest);
    if (address) URL.revokeObjectURL(address);
  };
}

export default { render };
