// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A page on which files are dropped, or which shows what its address names: index.html?src=scan.laz
import "./ewa-view.js";

const source = new URLSearchParams(location.search).get("src");
if (source) document.querySelector("ewa-view").setAttribute("src", source);
