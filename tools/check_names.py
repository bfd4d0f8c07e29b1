#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Whether what the documentation and the comments name is there.

    check_names.py [ROOT]

Read are README.md, CONTRIBUTING.md, docs/*.md and the comments of C, for links every page beside README.md too. Fails, and
lists what it found, for

- citations "docs/math.md section 6", "sections 3, 4 and 11", "sections 2 to 9": sections and departures that the page
  does not have, departures that no section speaks of, and other ways of citing it;
- kernels (files *_body.h, their parts, references) that do not say which section they compute;
- ewa_... and EWA_..., members as ewa_render_options.layers, functions with parentheses, CAPITAL_NAMES, `small_names` (in
  comments also without those marks): words that no code has;
- paths (src/..., ewa/math.h, pipeline_body.h, docs/...), links, and programs of build/: files that are not there;
- options (--tau), also in the program's messages: those that docs/cli.md, which a test holds to the program, does not
  have, or not for the command that they are given to;
- tests that are named as such (test `layers`): those that no CMakeLists.txt has.
"""
import re
import sys
from pathlib import Path

LAW = "docs/math.md"
CODE = ("src", "include", "cli", "bench", "viewer", "examples", "import", "mpi", "measure", "tests", "scenes")

# Options of other programs, by a word of the same paragraph.
FOREIGN_OPTIONS = {
    "rattler-build": {"recipe"}, "vcpkg": {"overlay-ports"}, "brew": {"build-from-source", "no-git", "repository"},
    "mpirun": {"bind-to"}, "Open MPI": {"allow-run-as-root", "oversubscribe"},
    "cmake": {"preset", "build", "target", "help", "install", "prefix"},
    "ctest": {"test-dir", "output-on-failure"},
    "F3D": {"camera-azimuth-angle", "camera-elevation-angle"},
    "parallel": {"wd", "retries"},
    "sbatch": {"array", "dependency"},
}

# Files and programs of others; what reads like a name in formulas.
FOREIGN_FILES = {"atanf.c", "nifti1.h", "nifti2.h"}
FOREIGN_NAMES = {"surface_splatting", "sum_lights", "AWS_BATCH_JOB_ARRAY_INDEX", "JOB_COMPLETION_INDEX", "PBS_ARRAY_INDEX",
                 "SGE_TASK_ID", "SGE_TASK_LAST"}

TOKEN = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'', re.S)


class Text:
    """A page, or a comment with its marks taken off, and where its lines come from."""

    def __init__(self, path, first_line, text):
        self.path, self.first_line, self.text = path, first_line, text

    def line(self, position):
        return self.first_line + self.text.count("\n", 0, position)


def read_source(path, shown):
    """The comments of a C file, neighbouring ones together, its strings, and its code without comments."""
    text = path.read_text()
    comments, strings, code, at = [], [], [], 0
    for match in TOKEN.finditer(text):
        if not match.group().startswith(("//", "/*")):
            strings.append(Text(shown, text.count("\n", 0, match.start()) + 1, match.group()))
            continue
        between = text[at:match.start()]
        code.append(between)
        at = match.end()
        line = text.count("\n", 0, match.start()) + 1
        words = re.sub(r"(?m)^\s*(?:///?<?|/?\*+/?)", "", match.group())
        last = comments[-1] if comments else None
        if last and not between.strip() and last.first_line + last.text.count("\n") + 1 == line:
            last.text += "\n" + words
        else:
            comments.append(Text(shown, line, words))
    code.append(text[at:])
    return comments, strings, " ".join(code)


class Tree:
    def __init__(self, root):
        self.root = root
        self.texts, self.code = [], []
        pages = [root / "README.md", root / "CONTRIBUTING.md"] + sorted((root / "docs").rglob("*.md"))
        self.pages = {str(p.relative_to(root)): p.read_text() for p in pages if p.exists()}
        for name, text in self.pages.items():
            self.texts.append(Text(name, 1, text))
        self.sources, self.messages = {}, []
        for room in CODE:
            for path in sorted([*(root / room).rglob("*.[ch]"), *(root / room).rglob("*.cpp")]):
                name = str(path.relative_to(root))
                if name.startswith("tests/house/"):
                    continue  # is wrong on purpose
                comments, strings, code = read_source(path, name)
                if room == "cli":
                    self.messages += strings
                self.sources[name] = comments
                self.texts += comments
                self.code.append(code)
        self.files = {str(p.relative_to(root)) for p in root.rglob("*")
                      if p.is_file() and p.relative_to(root).parts[0] not in ("build", ".git")}
        self.folders = {str(parent) for name in self.files for parent in Path(name).parents}
        self.basenames = {Path(name).name for name in self.files}
        built = [(root / name).read_text() for name in sorted(self.files) if
                 name.endswith(("CMakeLists.txt", ".cmake", ".sh", ".yml", ".in", "Makefile")) or
                 (name.startswith(("tools/", "tests/hostile/")) and name.endswith(".py") and name != "tools/check_names.py")]
        self.words = set(re.findall(r"\w+", " ".join(self.code + built)))
        self.words |= {Path(name).stem for name in self.files if name.endswith((".c", ".h"))}  # programs among them
        for path in sorted((root / "python").rglob("*.py")):
            self.words |= set(re.findall(r"(?m)^\s*def (\w+)\(", path.read_text()))
        measuring = {"measure_" + Path(name).stem for name in self.files if re.match(r"measure/\w+\.c", name)}
        self.words |= measuring
        self.build_words = set(re.findall(r"[\w.-]+", " ".join(built))) | measuring
        self.system_headers = set(re.findall(r"# *include +<([^>]+)>", " ".join(self.code)))
        self.structs = {}
        for code in self.code:
            for match in re.finditer(r"struct (\w+) \{", code):
                depth, end = 1, match.end()
                while depth and end < len(code):
                    depth += {"{": 1, "}": -1}.get(code[end], 0)
                    end += 1
                self.structs.setdefault(match.group(1), set()).update(re.findall(r"\w+", code[match.end():end]))


def read_law(tree, found):
    """The numbers of the law's sections and departures."""
    text = tree.pages.get(LAW, "")
    sections = {int(n) for n in re.findall(r"(?m)^## (\d+)\. ", text)}
    departures = {int(n) for n in re.findall(r"(?m)^\| (\d+) \|", text)}
    told = set()
    for match in re.finditer(r"\bdepartures? (\d+(?:(?:, | and | to )\d+(?![\d.]))*)", text):
        told |= numbers(match.group(1))
        for number in numbers(match.group(1)) - departures:
            found.append((LAW, Text(LAW, 1, text).line(match.start()), f"there is no departure {number}"))
    for number in sorted(departures - told):
        found.append((LAW, 1, f"no section speaks of departure {number}"))
    if not sections or not departures:
        found.append((LAW, 1, "no sections or no departures"))
    return sections


def numbers(words):
    """The numbers of "3, 5 and 7" or "3 to 5"."""
    result, parts = set(), re.split(r"(, | and | to )", words)
    for i in range(0, len(parts), 2):
        number = int(parts[i])
        first = int(parts[i - 2]) + 1 if i and parts[i - 1] == " to " else number
        result |= set(range(first, number + 1))
    return result


def check_citations(tree, sections, found):
    for text in tree.texts:
        flat = re.sub(r"\s", " ", text.text)
        spaced = lambda n: re.sub(r" +", " ", n)
        for match in re.finditer(r"[\w./`]*\bmath\.md`?", flat):
            here = match.group().strip("`")
            if flat[match.end():match.end() + 1] == "#":
                continue  # a link; links are looked at below
            if here != LAW:
                found.append((text.path, text.line(match.start()), f"\"{here}\": write {LAW} section N"))
                continue
            after = spaced(flat[match.end():match.end() + 60])
            cited = re.match(r",? sections? +(\d+(?:(?:, | and | to )\d+)*)", after)
            if not cited and re.match(r",? §? ?\d", after):
                found.append((text.path, text.line(match.start()), f"write \"{LAW} section N\""))
            for number in sorted(numbers(cited.group(1)) - sections if cited else ()):
                found.append((text.path, text.line(match.start()), f"{LAW} has no section {number}"))
    for name, comments in tree.sources.items():
        stem = Path(name).stem
        head = comments[0].text if comments else ""
        kernel = stem.endswith(("_body", "_reference")) or (stem == "reference" or stem.startswith("reference_")) and name.endswith(".c") or \
            re.search(r"(?m)^ ?(Part of \w+_body\.h|The part of \w+_body\.h)", head)
        if kernel and name.startswith("src/") and LAW not in head:
            found.append((name, 1, f"does not say which section of {LAW} it computes"))


def check_symbols(tree, found):
    for text in tree.texts:
        for match in re.finditer(r"(?<![\w/.-])(ewa_[a-z0-9_]+|EWA_[A-Z0-9_]+)(\.[a-z_]\w*)?(\*|…)?", text.text):
            name, member, open_end = match.groups()
            line = text.line(match.start())
            if open_end and not member:
                if not any(word.startswith(name) for word in tree.words):
                    found.append((text.path, line, f"{name}...: nothing begins so"))
            elif name not in tree.words:
                found.append((text.path, line, f"{name}: no such name"))
            elif member and name in tree.structs and member[1:] not in tree.structs[name]:
                found.append((text.path, line, f"{name}{member}: no such member"))
        for match in re.finditer(r"(?<![\w.>/-])([a-z]\w*_\w+|[a-z]{4,}\w*)\(\)", text.text):
            if match.group(1) not in tree.words:
                found.append((text.path, text.line(match.start()), f"{match.group()}: no such function"))
        for match in re.finditer(r"`([a-z]+(?:_[a-z0-9]+)+)`|"
                                 r"(?<![\w./%-])(?<!-\w )((?!EWA_)[A-Z][A-Z0-9]*(?:_[A-Z0-9]+)+)(?![\w./*])", text.text):
            name = match.group(1) or match.group(2)
            if name not in tree.words and name not in FOREIGN_NAMES:
                found.append((text.path, text.line(match.start()), f"{name}: no such name"))
        if text.path not in tree.sources:
            continue  # pages name files of data so
        for match in re.finditer(r"(?<![\w./%`-])[a-z]{3,}(?:_[a-z0-9]{3,})+(?![\w./(`])", text.text):
            if match.group() not in tree.words and match.group() not in FOREIGN_NAMES:
                found.append((text.path, text.line(match.start()), f"{match.group()}: no such name"))


def exists(tree, path, beside):
    """Whether a path, with * and {a,b} in it, is that of files or folders, from the root or `beside`."""
    alternatives = re.search(r"\{([^}]*)\}", path)
    if alternatives:
        return all(exists(tree, path[:alternatives.start()] + word + path[alternatives.end():], beside)
                   for word in alternatives.group(1).split(","))
    for folder in ("", beside, "src", "include", "tests"):
        name = str(Path(folder, path)) if folder else path.rstrip("/")
        if name in tree.files or name in tree.folders:
            return True
        if "*" in name and any(Path(file).match(name) for file in tree.files):
            return True
    return False


def check_paths(tree, found):
    tops = "|".join(CODE + ("tools", "docs", "cmake"))
    path = re.compile(rf"(?<![\w/.$<>-])((?:{tops})/[\w./*{{}},-]*[\w*}}/]|[a-z_]+/[a-z0-9_*]+\.[ch]|"
                      r"[a-z][a-z0-9_]*\.(?:c|h|cmake|py|sh|md))(?![\w/(])")
    for text in tree.texts:
        beside = str(Path(text.path).parent)
        for match in path.finditer(text.text):
            name = match.group(1)
            if name in FOREIGN_FILES or name in tree.system_headers or name in tree.basenames or \
                    exists(tree, name, beside) or exists(tree, name + ".c", beside):
                continue
            found.append((text.path, text.line(match.start()), f"{name}: no such file"))
        for match in re.finditer(r"build/\w+/(tests|cli|examples|measure)/([\w/]*?)(\w+)\b(?![./])", text.text):
            if match.group(3) not in tree.build_words and re.sub("^test_", "", match.group(3)) not in tree.build_words:
                found.append((text.path, text.line(match.start()), f"{match.group()}: no such program"))


def slug(heading):
    """What a heading's anchor is called."""
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")


def check_links(tree, found):
    pages = tree.pages | {path.name: path.read_text() for path in tree.root.glob("*.md")}
    anchors = {name: {slug(h) for h in re.findall(r"(?m)^#+ (.*)$", re.sub(r"(?ms)^```.*?^```", "", text))} |
               set(re.findall(r'<a id="([\w-]+)"></a>', text)) for name, text in pages.items()}
    for name, text in pages.items():
        for match in re.finditer(r"\]\(([^)#\s]*)(?:#([^)\s]*))?\)", text):
            target, anchor = match.groups()
            if target.startswith(("http:", "https:")):
                continue
            page = name if not target else str((tree.root / name).parent.joinpath(target).resolve()
                                               .relative_to(tree.root.resolve()))
            if page not in tree.files and page not in tree.folders:
                found.append((name, Text(name, 1, text).line(match.start()), f"{target}: no such file"))
            elif anchor and anchor not in anchors.get(page, ()):
                found.append((name, Text(name, 1, text).line(match.start()), f"{target}#{anchor}: no such heading"))


def read_options(tree):
    """The options of each command by docs/cli.md, under "" those of all."""
    options = {"": {"version", "help-markdown", "help-json", "help-man", "completion", "key", "no-key", "no"}}  # of the program; what rows are told by
    aliases = {}
    for part in re.split(r"(?m)^## ewa ", tree.pages.get("docs/cli.md", ""))[1:]:
        command = options.setdefault(part.split()[0], set())
        for first, rest in re.findall(r"(?m)^\| `([^`]*--[^`]*)` \|(.*)$", part):
            also = re.findall(r"\balso --[a-z][\w-]*(?:, --[a-z][\w-]*)*", rest)
            keys = set(re.findall(r"--([a-z][\w-]*)", first))
            told = re.match(r" as of \[`ewa (\w+)`\]", rest)  # another command tells what else they are called
            aliases |= {(part.split()[0], key): also for key in keys if not told}
            also = [name for key in keys for name in aliases.get((told.group(1), key), [])] if told else also
            command |= keys | set(re.findall(r"--([a-z][\w-]*)", " ".join(also)))
        options[""] |= command
    # ewa-mpi tells of its own options in its usage.
    usage = tree.root / "mpi/main.c"
    if usage.exists():
        options[""] |= set(re.findall(r"--([a-z][\w-]*)", usage.read_text().split("usage[]")[1].split(";")[0]))
    return options


def check_options(tree, found):
    options = read_options(tree)
    commands = "|".join(filter(None, options))
    if not commands:
        found.append(("docs/cli.md", 1, "no command and no option"))
        return
    for text in tree.texts + tree.messages:
        if text.path.startswith("tests/"):
            continue  # says what must be refused
        for match in re.finditer(rf"\bewa ({commands})\b(?!')([^|;&`\n]*)", text.text):
            for name in re.findall(r"(?<![\w-])--([a-z][a-z0-9-]*)", match.group(2)):
                if name in options[""] and name not in options[match.group(1)] | {"help"}:
                    found.append((text.path, text.line(match.start()), f"ewa {match.group(1)} has no option --{name}"))
        for match in re.finditer(r"(?<![\w-])--([a-z][a-z0-9-]*[a-z0-9])", text.text):
            around = text.text[max(0, match.start() - 300):match.end() + 300]
            foreign = any(word in around and match.group(1) in names for word, names in FOREIGN_OPTIONS.items())
            tools = [tree.root / name for name in re.findall(r"(?:tools|examples)/\w+\.(?:py|sh)", around) if name in tree.files]
            if match.group(1) not in options[""] and not foreign and \
                    not any(match.group() in tool.read_text() for tool in tools):
                found.append((text.path, text.line(match.start()), f"{match.group()}: no such option"))


def check_tests(tree, found):
    known = {Path(name).stem[len("test_"):] for name in tree.files if Path(name).stem.startswith("test_")}
    for name in tree.files:
        if name.endswith("CMakeLists.txt"):
            known |= set(re.findall(r"(?:NAME|ewa_test\w*\()\s*([\w-]+)", (tree.root / name).read_text()))
    for text in tree.texts:
        for match in re.finditer(r"\b[Tt]ests? ((?:`[\w-]+`(?:, | and |,\s+)?)+)", text.text):
            for name in re.findall(r"`([\w-]+)`", match.group(1)):
                if re.sub("^test_|_real$", "", name) not in known:
                    found.append((text.path, text.line(match.start()), f"test {name}: no such test"))


def main():
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).resolve().parent.parent).resolve()
    tree, found = Tree(root), []
    sections = read_law(tree, found)
    check_citations(tree, sections, found)
    for check in (check_symbols, check_paths, check_links, check_options, check_tests):
        check(tree, found)
    for path, line, what in sorted(set(found)):
        print(f"{path}:{line}: {what}")
    if found:
        sys.exit(f"{len(set(found))} names of nothing")
    print(f"{len(tree.pages)} pages, {len(tree.sources)} sources, sections {min(sections)} to {max(sections)}")


main()
