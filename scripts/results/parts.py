"""Pages of results that are measured part by part: each part's lines are kept in a folder with the commit that was
measured, and the page is put together once all of them are there, so that one part can be measured anew."""

import json
import os
import subprocess
import sys
import time

problems = []  # of the part in hand


def check(condition, what):
    if not condition:
        problems.append(what)
        print("FALLS SHORT:", what, file=sys.stderr)
    return condition


def commit(root):
    """That is checked out; -dirty where anything but results differs from it."""

    def git(*words):
        return subprocess.run(["git", *words], cwd=root, capture_output=True, text=True, check=False).stdout.strip()

    changed = git("status", "--porcelain", "--untracked-files=no", "--", ".", ":!docs/results")
    return git("rev-parse", "--short", "HEAD") + ("-dirty" if changed else "")


def measure(name, part, folder, root):
    """Runs a part, and keeps what it says."""
    problems.clear()
    began = time.perf_counter()
    lines = part()
    told = {"lines": lines, "problems": list(problems), "minutes": (time.perf_counter() - began) / 60, "commit": commit(root),
            "load": os.getloadavg()[0]}
    (folder / f"{name}.json").write_text(json.dumps(told), encoding="utf-8")


def named_parts(words, parts):
    """Those that were asked for, all of them unless some are named."""
    named = words or list(parts)
    if unknown := set(named) - set(parts):
        sys.exit(f"no such part: {', '.join(sorted(unknown))}; there are {', '.join(parts)}")
    return named


def write_page(page, heading, parts, folder):
    """Puts the page together from all parts, or says which it waits for. Exits with an error where something falls short."""
    kept = {name: folder / f"{name}.json" for name in parts}
    if missing := [name for name, path in kept.items() if not path.is_file()]:
        print("The page waits for:", ", ".join(missing))
        return
    told = {name: json.loads(path.read_text(encoding="utf-8")) for name, path in kept.items()}
    lines = list(heading)
    for part in told.values():
        lines += part["lines"]
    if short := [problem for part in told.values() for problem in part["problems"]]:
        lines += ["## What falls short", ""] + [f"- {problem}" for problem in short] + [""]
    lines += ["Minutes, the machine's load at the end, and the commit that was measured: " +
              ", ".join(f"{name} {part['minutes']:.1f} ({part.get('load', float('nan')):.1f}, {part['commit']})" for name, part in told.items()) + ".", ""]
    page.write_text("\n".join(lines), encoding="utf-8")
    print("written:", page)
    if short:
        sys.exit(f"{len(short)} goals are missed; {page.name} lists them")
