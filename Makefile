# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Short names for what one does here; CMake does the work.
#
#   make demo [FILE=scan.ply]   installs what is missing, builds, renders, says where the picture is
#   make check                  the same set-up, then the tests, the quick ones also under the address and undefined
#                               behaviour sanitizers, those of threads also as clang builds them with the thread sanitizer;
#                               the last line counts them
#   make check-all              every test of all four builds (hours)
#   make                        builds everything into build/release
#   make asan tsan clang fuzz   other builds and their tests
#   make minimal                a program without any library, held to the bytes of the full one
#   make sets                   the bytes of the program by AVX2 and by portable C, under an emulator
#   make arm64                  the same for 64-bit Arm, under an emulator
#   make wasm                   WebAssembly: the bytes of the program under node, and the module that a page loads
#   make windows                Windows on x86-64: the bytes of the program under wine
#   make macos                  macOS on both of its processors: compiled and linked; nothing of it can be run elsewhere
#   make riscv64                a program without any library for RISC-V, under an emulator
#   make musl                   one static file for every x86-64 Linux
#   make mutate                 breaks the library on purpose and says what the tests notice (hours)
#   make bench sweep            figures of docs/performance.md: build/bench.json and tables; docs/sweep.png and slopes;
#                               BENCH_PREFIX="chrt -f 50" keeps other work out of them; Embree is measured
#                               beside, where `make` has found it
#   make interop                compares files with what laspy, laszip, libE57Format and others read and write
#   make measure                programs of the figures in docs/, into build/release/measure
#   make gallery docs           pictures and pages that the program makes
#   make site                   docs as a site of HTML with search, into build/website/site; it asks no other site for anything
#   make papers                 every figure, table and claim of the papers into docs/papers; PAPER=pas ITEM=fig3: one of them
#   make wheel                  the Python package as a wheel, into build/wheels; PYTHONS names interpreters to test it with,
#                               TARGET another system (tools/wheel.sh)
#   make install                to PREFIX (default /usr/local)
#   make dist                   what is committed as an archive that builds by itself, into build
#   make deb                    the same as packages of Debian, into build/deb; lintian looks at them

FILE ?=
OUT ?= out
PREFIX ?= /usr/local
FUZZ_SECONDS ?= 60
PAPER ?=
ITEM ?=
TARGET ?=
PYTHONS ?=
BENCH_PREFIX ?=
BENCH_AGAINST ?= $(wildcard build/release/measure/measure_embree)
JOBS ?= $(shell nproc)
EWA = build/release/cli/ewa
VERSION := $(shell sed -n 's/^project.ewa VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)

# $(call quietly,COMMAND): prints what a command said only when it fails.
quietly = @mkdir -p build && { ( $(1) ) >build/log-$@.txt 2>&1 || { cat build/log-$@.txt; exit 1; }; }

# $(call build_by,PRESET,TARGETS): builds these in build/PRESET, and prints what was said only when it fails.
build_by = echo "Building build/$(1)"; { cmake --preset $(1) && cmake --build build/$(1) -j $(JOBS) --target $(2); } >build/log-$(1).txt 2>&1 || { cat build/log-$(1).txt; exit 1; }

# Compiled once, found again in every folder and checkout, where there is ccache.
ifneq ($(shell command -v ccache),)
export CMAKE_C_COMPILER_LAUNCHER ?= ccache
export CMAKE_CXX_COMPILER_LAUNCHER ?= ccache
export CCACHE_BASEDIR ?= $(CURDIR)
export CCACHE_NOHASHDIR ?= 1
endif

.PHONY: minimal sets wasm windows macos riscv64 musl interop build program measure setup demo check check-all asan asan-build tsan tsan-build clang mutate fuzz arm64 bench sweep gallery papers docs site wheel format install dist deb clean

build: setup
	@echo "Building build/release"
	$(call quietly,cmake --preset release -DEWA_BUILD_TESTS=ON -DEWA_BUILD_EXAMPLES=ON)
	$(call quietly,cmake --build build/release -j $(JOBS))

# Of packages what the program needs; its window and the import of rare meshes are built where theirs are there.
program:
	@sh tools/setup.sh --program
	@echo "Building $(EWA)"
	$(call quietly,cmake --preset release $(if $(wildcard build/release/CMakeCache.txt),,-DEWA_BUILD_TESTS=OFF -DEWA_BUILD_EXAMPLES=OFF))
	$(call quietly,cmake --build build/release -j $(JOBS) --target ewa)

measure: build
	$(call quietly,cmake --build build/release -j $(JOBS) --target measure)

setup:
	@sh tools/setup.sh

demo: program
	@sh tools/demo.sh $(EWA) "$(OUT)" "$(FILE)"

# A person's session in a window needs a screen and a hand; completion needs its shells, manual pages and desktop files what checks
# them, the site what makes it.
check: build asan-build tsan-build
	@sh tools/setup.sh xvfb xdotool mandoc zsh fish desktop-file-utils shared-mime-info mkdocs mkdocs-material || echo "Without these it is skipped."
	@sh tools/check.sh build/release:-long build/asan:quick build/clang-tsan:parallel

check-all: asan tsan clang check
	@sh tools/check.sh build/release:long

asan-build: setup
	@echo "Building build/asan"
	$(call quietly,cmake --preset asan)
	$(call quietly,cmake --build build/asan -j $(JOBS))

asan: asan-build
	$(call quietly,cmake --build build/asan -j $(JOBS) --target slow_tests)
	@sh tools/check.sh build/asan

# All of the product by clang, whose warnings are errors, and the tests of what runs in threads; `make tsan` runs every test.
tsan-build: setup
	@sh tools/setup.sh clang libclang-rt-14-dev
	@echo "Building build/clang-tsan"
	$(call quietly,cmake --preset clang-tsan)
	$(call quietly,cmake --build build/clang-tsan -j $(JOBS) --target ewa ewa_shared parallel_tests)

tsan: setup
	@sh tools/setup.sh clang libclang-rt-14-dev
	@echo "Building build/clang-tsan"
	$(call quietly,cmake --preset clang-tsan)
	$(call quietly,cmake --build build/clang-tsan -j $(JOBS) --target all slow_tests)
	@sh tools/check.sh build/clang-tsan

interop: program
	@sh tools/interop.sh $(EWA) "$${EWA_DATA:-../shared/data}"

clang:
	@sh tools/setup.sh clang
	@echo "Building build/clang"
	$(call quietly,cmake --preset clang)
	$(call quietly,cmake --build build/clang -j $(JOBS))
	@sh tools/check.sh build/clang

# Without any library, on one thread: what it writes is what the full program does.
minimal: program
	@echo "Building build/minimal"
	$(call quietly,cmake --preset minimal)
	$(call quietly,cmake --build build/minimal -j $(JOBS) --target ewa)
	@sh tools/hash_jobs.sh --minimal --like $(CURDIR)/$(EWA) $(CURDIR)/build/minimal/cli/ewa

# By each instruction set of x86-64: as processors without AVX-512 run it, and those without AVX2, by an emulator.
sets: program
	@sh tools/setup.sh qemu-user-static
	@sh tools/hash_jobs.sh --like $(CURDIR)/$(EWA) qemu-x86_64-static -cpu max,avx512f=off $(CURDIR)/$(EWA)
	@sh tools/hash_jobs.sh --like $(CURDIR)/$(EWA) qemu-x86_64-static -cpu Nehalem $(CURDIR)/$(EWA)

# Another machine: compiled by the same clang as for the others below, what holds all instruction sets to each other run under an
# emulator, and the bytes of twenty jobs compared with this machine's.
arm64: program
	@sh tools/setup.sh qemu-user-static
	@sh tools/sysroot.sh arm64 build/sysroot/arm64 libc6 python3
	@sh tools/zig.sh aarch64-linux-gnu.2.28
	@sh tools/dependencies.sh aarch64-linux-gnu.2.28
	@$(call build_by,arm64,ewa quick_tests)
	@sh tools/check.sh build/arm64:quick
	@sh tools/hash_jobs.sh --like $(CURDIR)/$(EWA) qemu-aarch64-static -L $(CURDIR)/build/sysroot/arm64 $(CURDIR)/build/arm64/cli/ewa

# WebAssembly, exact on every host and for hosts that round a relaxed multiply-add once: the program's bytes under node, and what a
# page loads.
wasm: program
	@command -v node >/dev/null || { echo "make wasm runs what it builds by node, which is missing (apt-get install nodejs)" >&2; exit 1; }
	@sh tools/zig.sh wasm32-wasi
	@sh tools/dependencies.sh wasm32-wasi -mcpu=generic+simd128+bulk_memory+nontrapping_fptoint+sign_ext+mutable_globals+multivalue+atomics
	@for build in wasm wasm-relaxed; do \
	  relaxed=$$(node --v8-options | grep -o -e --experimental-wasm-relaxed-simd | head -n 1); \
	  $(call build_by,$$build,ewa page); \
	  sh tools/hash_jobs.sh --without x --like $(CURDIR)/$(EWA) node --no-warnings $$relaxed $(CURDIR)/tools/wasi.mjs $(CURDIR)/build/$$build/cli/ewa.wasm || exit 1; \
	done
	@$(EWA) generate torus -n 1000000 -o build/torus.ply
	@node --no-warnings $$(node --v8-options | grep -o -e --experimental-wasm-relaxed-simd | head -n 1) page/measure.mjs build/torus.ply 1920 1080 5 build/wasm-relaxed/page/page.wasm build/wasm/page/page.wasm
	@node --no-warnings page/measure.mjs build/torus.ply 1920 1080 5 build/wasm/page/page.wasm

# Windows: the program's bytes and what it makes of names and files there, under wine.
windows: program
	@sh tools/setup.sh wine wine64
	@sh tools/zig.sh x86_64-windows-gnu
	@sh tools/dependencies.sh x86_64-windows-gnu
	@$(call build_by,windows,ewa quick_tests)
	@sh tools/check.sh build/windows:quick
	@sh tools/hash_jobs.sh --like $(CURDIR)/$(EWA) sh $(CURDIR)/tools/wine.sh $(CURDIR)/build/windows/cli/ewa.exe
	@sh tools/windows_files.sh $(CURDIR)/$(EWA) $(CURDIR)/build/windows/cli/ewa.exe

# macOS: what can be had of it without one, programs and libraries that link.
macos: setup
	@sh tools/zig.sh aarch64-macos x86_64-macos
	@for target in aarch64-macos x86_64-macos; do \
	  sh tools/dependencies.sh $$target || exit 1; \
	  $(call build_by,$$target,ewa ewa_shared); \
	done
	@echo "build/aarch64-macos/cli/ewa and build/x86_64-macos/cli/ewa: not run here"

# RISC-V, without any library, under an emulator.
riscv64: program
	@sh tools/setup.sh qemu-user-static
	@sh tools/zig.sh riscv64-linux-musl
	@$(call build_by,riscv64,ewa)
	@sh tools/hash_jobs.sh --minimal --like $(CURDIR)/$(EWA) qemu-riscv64-static $(CURDIR)/build/riscv64/cli/ewa

# One static file for every Linux on x86-64.
musl: program
	@sh tools/zig.sh x86_64-linux-musl
	@sh tools/dependencies.sh x86_64-linux-musl
	@$(call build_by,musl,ewa)
	@sh tools/hash_jobs.sh --like $(CURDIR)/$(EWA) $(CURDIR)/build/musl/cli/ewa

mutate:
	@sh tools/setup.sh python3
	python3 tools/mutate.py run --jobs $(JOBS)

fuzz:
	@sh tools/setup.sh clang libclang-rt-14-dev
	@sh tools/fuzz.sh $(FUZZ_SECONDS)

bench: program
	@sh tools/setup.sh python3
	python3 tools/bench.py $(EWA) build/bench.json --prefix "$(BENCH_PREFIX)" --against "$(BENCH_AGAINST)"
	python3 tools/bench_tables.py build/bench.json

sweep: program
	@sh tools/setup.sh python3 gnuplot-nox
	python3 tools/bench_sweep.py $(EWA) build/sweep.csv --page docs/performance.md --prefix "$(BENCH_PREFIX)"
	gnuplot -e "csv='build/sweep.csv'; png='docs/sweep.png'" tools/bench_sweep.gnuplot

gallery: measure
	@sh tools/gallery.sh $(EWA)

papers: measure
	@sh tools/setup.sh python3 python3-matplotlib ffmpeg glslang-tools spirv-tools
	python3 tools/papers.py make $(EWA) $(PAPER) $(ITEM)

docs: program
	@sh tools/setup.sh python3
	$(EWA) --help-markdown >docs/cli.md
	$(EWA) --help-json >docs/options.json
	python3 tools/dump_python.py
	@sh tools/page_gallery.sh $(EWA) build/page_gallery

site: setup
	@sh tools/setup.sh mkdocs mkdocs-material
	$(call quietly,cmake --preset release)
	$(call quietly,cmake --build build/release -j $(JOBS) --target ewa_shared)
	@python3 tools/website.py build/website build/release/libewa.so

wheel: setup
	@sh tools/wheel.sh $(TARGET) $(PYTHONS)

format:
	git ls-files '*.c' '*.h' '*.cpp' | xargs clang-format -i

install: build
	cmake --install build/release --prefix "$(PREFIX)"

dist:
	@mkdir -p build
	git archive --prefix=ewa-$(VERSION)/ -o build/ewa-$(VERSION).tar.gz HEAD

deb: dist
	@sh tools/setup.sh debhelper dh-python lintian
	@rm -rf build/deb && mkdir -p build/deb && tar -xf build/ewa-$(VERSION).tar.gz -C build/deb
	@echo "Building build/deb"
	$(call quietly,cd build/deb/ewa-$(VERSION) && DEB_BUILD_OPTIONS=parallel=$(JOBS) dpkg-buildpackage -b -us -uc)
	lintian --fail-on error,warning --suppress-tags bogus-mail-host,bogus-mail-host-in-debian-changelog build/deb/*.changes # nobody has an address

clean:
	rm -rf build out
