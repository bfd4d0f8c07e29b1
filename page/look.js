// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How an <ewa-view> looks: its parts, their pictures and their style, light or dark as the reader's system is.

/// Strokes on a ground of 24 x 24.
const ICONS = {
  home: "M4 11 12 4l8 7M6 10v10h12V10",
  box: "M12 3 4 7v10l8 4 8-4V7zM4 7l8 4 8-4M12 11v10",
  measure: "M3 16 16 3l5 5L8 21zM7 12l2 2M10 9l3 3M13 6l2 2",
  share: "M8 12a3 3 0 1 1-6 0 3 3 0 0 1 6 0M22 5a3 3 0 1 1-6 0 3 3 0 0 1 6 0M22 19a3 3 0 1 1-6 0 3 3 0 0 1 6 0M8 11l8-5M8 13l8 5",
  shot: "M3 8h4l2-3h6l2 3h4v11H3zM16 13a4 4 0 1 1-8 0 4 4 0 0 1 8 0",
  full: "M4 9V4h5M15 4h5v5M20 15v5h-5M9 20H4v-5",
  help: "M9 9a3 3 0 1 1 4 3c-1 .5-1 1-1 2M12 17v1",
};

const button = (name, label, key) =>
  `<button type="button" part="button" data-do="${name}" aria-label="${label}" title="${label}${key ? ` (${key})` : ""}">` +
  `<svg viewBox="0 0 24 24" aria-hidden="true"><path d="${ICONS[name]}"/></svg></button>`;

export const PARTS = `
<div class="stage" tabindex="0" role="application" aria-roledescription="view in space">
  <canvas width="1" height="1"></canvas>
</div>
<p class="hint"></p>
<div class="bar" role="toolbar" aria-label="View">
  ${button("home", "All of it, as at first", "Enter")}
  <select data-do="view" aria-label="Seen from" title="Seen from">
    <option value="">view</option><option>front</option><option>back</option><option>left</option><option>right</option>
    <option>top</option><option>bottom</option><option>iso</option>
  </select>
  <select data-do="color" aria-label="Colours" title="Colours (S)"><option value="auto">colours</option></select>
  ${button("measure", "Measure from pick to pick", "Shift click")}
  ${button("box", "Clip box", "C")}
  ${button("share", "Link to what is seen")}
  ${button("shot", "Save the picture")}
  ${button("full", "Whole screen")}
  ${button("help", "Keys and gestures", "H")}
</div>
<div class="error" role="alert" hidden><span></span><button type="button" data-do="dismiss" aria-label="Close">×</button></div>
<div class="card" hidden><output></output><button type="button" data-do="close" aria-label="Close">×</button></div>
<div class="status" role="status" hidden><span></span><progress max="1"></progress></div>
<dialog aria-label="Keys and gestures"><form method="dialog"><button>Close</button></form><table></table></dialog>`;

export const STYLE = `
:host { display: block; position: relative; overflow: hidden; min-height: 160px; contain: content;
  --ground: #fffffff0; --ink: #1b1f24; --edge: #1b1f2433; --accent: #0b57d0; --bad: #a1160a;
  color: var(--ink); font: 14px/1.35 system-ui, sans-serif; color-scheme: light dark; background: #fff; }
@media (prefers-color-scheme: dark) {
  :host { --ground: #1b1f24f0; --ink: #f2f4f7; --edge: #ffffff33; --accent: #8ab4f8; --bad: #ffb4ab; }
}
[hidden] { display: none !important; }
.stage { position: absolute; inset: 0; outline: none; touch-action: none; cursor: grab; }
.stage:active { cursor: grabbing; }
.stage:focus-visible { box-shadow: inset 0 0 0 3px var(--accent); }
canvas { width: 100%; height: 100%; display: block; }
.bar, .card, .status, .error, .hint { position: absolute; background: var(--ground); border: 1px solid var(--edge); border-radius: 10px; }
.bar { right: 12px; top: 12px; display: flex; flex-wrap: wrap; justify-content: flex-end; gap: 2px; padding: 4px; }
button, select { font: inherit; color: inherit; background: transparent; border: 1px solid transparent; border-radius: 7px;
  min-width: 36px; height: 36px; padding: 0 6px; cursor: pointer; }
select { max-width: 132px; border-color: var(--edge); }
select option { color: #1b1f24; background: #fff; }
button:hover, select:hover { border-color: var(--edge); }
button:focus-visible, select:focus-visible { outline: 3px solid var(--accent); outline-offset: 1px; }
button[aria-pressed="true"] { background: var(--accent); color: var(--ground); }
svg { width: 22px; height: 22px; display: block; margin: auto; fill: none; stroke: currentColor; stroke-width: 1.7;
  stroke-linecap: round; stroke-linejoin: round; }
.card { left: 12px; bottom: 12px; display: flex; align-items: start; max-width: min(420px, calc(100% - 26px)); max-height: 45%; overflow: auto; }
.card button { position: sticky; top: 0; }
.card output { padding: 9px 4px 9px 12px; white-space: pre-wrap; overflow-wrap: anywhere; font-variant-numeric: tabular-nums; user-select: text; }
.status { left: 50%; top: 50%; transform: translate(-50%, -50%); padding: 12px 16px; display: grid; gap: 8px; min-width: 200px; text-align: center; }
.status progress { width: 100%; accent-color: var(--accent); }
.error { left: 12px; right: 12px; bottom: 12px; display: flex; justify-content: space-between; color: var(--bad); border-color: currentColor; }
.error:not([hidden]) ~ .card { bottom: 64px; }
.error span { padding: 10px 12px; overflow-wrap: anywhere; }
.hint { left: 50%; top: 50%; transform: translate(-50%, -50%); padding: 14px 18px; margin: 0; text-align: center; pointer-events: none; }
.hint:empty { display: none; }
dialog { color: inherit; background: var(--ground); border: 1px solid var(--edge); border-radius: 12px; max-height: 85%; max-width: min(560px, 92%); }
dialog td { padding: 3px 12px 3px 0; vertical-align: top; }
dialog td:first-child { font-weight: 600; white-space: nowrap; }
dialog form { text-align: right; position: sticky; top: 0; }
dialog form button { background: var(--ground); border-color: var(--edge); }
@media (max-width: 600px) {
  .stage { bottom: calc(49px + max(4px, env(safe-area-inset-bottom))); } /* the bar is under the picture, not on it */
  .bar { left: 0; right: 0; top: auto; bottom: 0; border-radius: 12px 12px 0 0; border-width: 1px 0 0;
    flex-wrap: nowrap; justify-content: space-around;
    padding: 4px 4px max(4px, env(safe-area-inset-bottom)); }
  .bar button { min-width: 38px; height: 44px; padding: 0 2px; }
  .bar select { height: 44px; flex: 1 1 62px; max-width: 96px; min-width: 0; padding: 0; }
  .bar [data-do="full"] { display: none; }
  .card, .error { bottom: 64px; }
  .card { max-height: 26%; }
  .error:not([hidden]) ~ .card { bottom: 136px; }
  dialog td:first-child { white-space: normal; }
}
@media (max-width: 350px) { .bar [data-do="help"] { display: none; } }
@media (forced-colors: active) { .bar, .card, .status, .error, .hint { border-color: CanvasText; } }`;
