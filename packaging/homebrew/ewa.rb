# frozen_string_literal: true

# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# The program and the library for Homebrew, of the archive that `make dist` makes: put its address in `url` and its sum in `sha256`,
# or install it from a local tap (docs/install.md). What Homebrew may not have is left out: meshoptimizer, the window's Dear ImGui.
class Ewa < Formula
  desc "Draws point clouds as continuous, antialiased surfaces"
  url "file://#{File.expand_path("../../build/ewa-0.1.0.tar.gz", __dir__)}"
  license "MIT"

  depends_on "cmake" => :build
  depends_on "ninja" => :build
  depends_on "pkgconf" => :build
  depends_on "cjson"
  depends_on "civetweb"
  depends_on "draco"
  depends_on "jpeg-turbo"
  depends_on "libdeflate"
  depends_on "libspng"
  depends_on "libtiff"
  depends_on "openexr"
  depends_on "webp"
  depends_on "xz"
  depends_on "zstd"

  uses_from_macos "bzip2"
  uses_from_macos "curl"
  uses_from_macos "expat"
  uses_from_macos "zlib"

  def install
    left_out = %w[ASSIMP CHOLMOD GL MESHOPT WINDOW].map { |part| "-DEWA_WITH_#{part}=OFF" }
    system "cmake", "-S", ".", "-B", "build", "-G", "Ninja", *std_cmake_args, *left_out,
           "-DEWA_BUILD_TESTS=OFF", "-DEWA_BUILD_EXAMPLES=OFF"
    system "cmake", "--build", "build"
    system "cmake", "--install", "build"
  end

  test do
    system bin/"ewa", "generate", "torus", "-n", "2000", "-o", "torus.ply"
    system bin/"ewa", "render", "torus.ply", "-o", "torus.png"
    assert_path_exists testpath/"torus.png"
  end
end
