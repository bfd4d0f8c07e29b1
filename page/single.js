// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A page of one file (ewa page): all that the view needs is in it, as text that is no script.
import { EwaView } from "./ewa-view.js";

/// The text of a part, which is not needed twice.
function take_part(element) {
  const text = element?.textContent;
  element?.remove();
  return text;
}

const part = (id) => take_part(document.getElementById(id));
// No module: a page that was opened as a file may not start one.
const worker = URL.createObjectURL(new Blob(["{", part("ewa-worker"), "}"], { type: "text/javascript" }));
EwaView.sources = {
  ...EwaView.sources,
  worker: () => new Worker(worker),
  modules: [
    { text: part("ewa-relaxed"), relaxed: true },
    { text: part("ewa-exact") },
  ].filter((module) => module.text),
};

const view = document.createElement("ewa-view");
view.setAttribute("label", document.title);
view.setAttribute("link", "");
if ("colorBar" in document.body.dataset) view.setAttribute("color-bar", "");
document.querySelector("main").append(view);
view.open([...document.querySelectorAll("script[data-name]")].map((element) => {
  const name = element.dataset.name;
  return { name, text: take_part(element), beside: name !== "scene.json" };
}));
