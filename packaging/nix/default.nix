# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# The program and the library for Nix, from this checkout: nix-build packaging/nix
# The window is left out: it takes Dear ImGui 1.86, and nixpkgs has a later one.
{ pkgs ? import <nixpkgs> { } }:

pkgs.stdenv.mkDerivation {
  pname = "ewa";
  version = "0.1.0";
  src = pkgs.lib.cleanSource ../..;

  nativeBuildInputs = with pkgs; [ cmake ninja pkg-config python3 ];
  buildInputs = with pkgs; [
    bzip2
    civetweb
    cjson
    curl
    draco
    expat
    libdeflate
    libepoxy
    libGL
    libjpeg
    libspng
    libtiff
    libwebp
    meshoptimizer
    openexr
    suitesparse
    xz
    zlib
    zstd
  ];
  cmakeFlags = [
    "-DEWA_BUILD_TESTS=OFF"
    "-DEWA_BUILD_EXAMPLES=OFF"
    "-DEWA_WITH_ASSIMP=OFF"
    "-DEWA_WITH_WINDOW=OFF"
  ];

  doInstallCheck = true;
  installCheckPhase = ''
    $out/bin/ewa generate torus -n 2000 -o torus.ply
    $out/bin/ewa render torus.ply -o torus.png
  '';

  meta = {
    description = "Draws point clouds as continuous, antialiased surfaces";
    license = pkgs.lib.licenses.mit;
    mainProgram = "ewa";
    platforms = pkgs.lib.platforms.unix;
  };
}
