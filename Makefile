# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Short names for what one does here; CMake does the work.
#
#   make demo [FILE=scan.ply]   installs what is missing, builds, renders, says where the picture is
#   make check                  the same set-up, then every test; the last line counts them
#   make build asan tsan fuzz   other builds and their tests
#   make bench gallery docs     figures, pictures and pages that are made by the program
#   make install                to PREFIX (default /usr/local)

FILE ?=
OUT ?= out
PREFIX ?= /usr/local
FUZZ_SECONDS ?= 60
JOBS ?= $(shell nproc)
EWA = build/release/cli/ewa

.PHONY: build setup demo check asan tsan fuzz bench gallery docs format install clean

build: setup
	@cmake -S . -B build/release -G Ninja -DCMAKE_BUILD_TYPE=Release >build-log.txt 2>&1 || { cat build-log.txt; exit 1; }
	@cmake --build build/release -j $(JOBS) >build-log.txt 2>&1 || { cat build-log.txt; exit 1; }
	@rm -f build-log.txt

setup:
	@sh tools/setup.sh

demo: build
	@sh tools/demo.sh $(EWA) $(OUT) "$(FILE)"

check: build asan-build
	@sh tools/check.sh build/release build/asan

asan-build: setup
	@cmake -S . -B build/asan -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo -DEWA_SANITIZE=address,undefined -DEWA_BUILD_EXAMPLES=OFF >build-log.txt 2>&1 || { cat build-log.txt; exit 1; }
	@cmake --build build/asan -j $(JOBS) >build-log.txt 2>&1 || { cat build-log.txt; exit 1; }
	@rm -f build-log.txt

asan: asan-build
	@sh tools/check.sh build/asan

tsan: setup
	cmake -S . -B build/tsan -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo -DEWA_SANITIZE=thread
	cmake --build build/tsan -j $(JOBS)
	@sh tools/check.sh build/tsan

fuzz:
	@sh tools/setup.sh clang
	@sh tools/fuzz.sh $(FUZZ_SECONDS)

bench: build
	$(EWA) bench

gallery: build
	@sh tools/gallery.sh $(EWA)

docs: build
	$(EWA) --help-markdown >docs/cli.md

format:
	git ls-files '*.c' '*.h' | xargs clang-format -i

install: build
	cmake --install build/release --prefix $(PREFIX)

clean:
	rm -rf build out
