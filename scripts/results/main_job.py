"""Shows the main job on real soundings, and writes docs/results/main-job.md. Called by scripts/reproduce main-job."""

import hashlib
import json
import os
import pathlib
import platform
import random
import re
import shutil
import signal
import statistics
import subprocess
import sys
import time

import numpy as np

import soundings

ROOT = pathlib.Path(__file__).resolve().parents[2]
BIN = ROOT / "build/release/bin"
WORK = ROOT / "build/results"
DATA = pathlib.Path(os.environ.get("THIN_SHARED_DATA", ROOT / "../shared/data")).resolve() / "observations"
KILLS = 20
REPETITIONS = 15

problems = []


def check(condition, what):
    if not condition:
        problems.append(what)
        print("FAILED:", what, file=sys.stderr)
    return condition


def run(*words, **options):
    return subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False, **options)


def fresh(name):
    folder = WORK / name
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    return folder


def write_configuration(folder, extra=""):
    path = folder / "thind.toml"
    path.write_text('[thinning]\nmethod = "grid_eea"\nretain_fraction = 0.1\n' + extra, encoding="utf-8")
    return path


# ---- thin info ---------------------------------------------------------------------------------------------------------


def info_row(path):
    """Compares `thin info --json` with ecCodes; returns a row of the table."""
    said = json.loads(run(BIN / "thin", "info", "--json", path).stdout)[0]
    found = soundings.summary(path)
    iso = lambda text: np.datetime64(text.rstrip("Z"), "ms")  # noqa: E731
    same = [
        said["messages"] == found["messages"],
        said["observations"] == found["observations"],
        {s["number"]: s["observations"] for s in said["satellites"]} == found["satellites"],
        iso(said["first_time"]) == found["first"] and iso(said["last_time"]) == found["last"],
        abs(said["south_deg"] - found["south"]) < 1e-9 and abs(said["north_deg"] - found["north"]) < 1e-9,
        all(
            (c["present"], c["minimum_k"], c["maximum_k"]) == found["channels"][c["channel"]] for c in said["channels"]
        ),
    ]
    check(all(same), f"thin info of {path.name} agrees with ecCodes")
    satellites = ", ".join(f"{s['name']} {s['observations']}" for s in said["satellites"])
    return f"| {path.name} | {said['messages']} | {satellites} | {said['first_time']} | {said['last_time']} | {'yes' if all(same) else 'NO'} |"


# ---- thin run ----------------------------------------------------------------------------------------------------------


def run_row(path):
    """Thins one file and compares every key of every retained subset; returns a row of the table."""
    folder = fresh("run")
    done = run(BIN / "thin", "run", "-c", write_configuration(folder), "-o", folder / "out", path)
    check(done.returncode == 0, f"thin run of {path.name}: {done.stderr}")
    report = json.loads((folder / "out/report.json").read_text(encoding="utf-8"))
    originals = [row for message in soundings.messages(path) for row in soundings.rows(message)]
    kept = [row for message in soundings.messages(folder / "out" / path.name) for row in soundings.rows(message)]
    # In order, each retained subset must be found again among the originals, whole.
    remaining = iter(originals)
    equal = all(any(row == original for original in remaining) for row in kept)
    retained = report["observations"]["retained"]
    good = check(equal and len(kept) == retained, f"output of {path.name} holds the retained subsets unchanged")
    keys = len(kept[0]) if kept else 0
    return f"| {path.name} | {len(originals)} | {retained} | {len(kept)} | {keys} | {'yes' if good else 'NO'} |"


# ---- thind -------------------------------------------------------------------------------------------------------------

DAEMON = """
[daemon]
root = "."
settle_seconds = 0.2
rescan_seconds = 1
max_wait_seconds = {max_wait}

[window]
quiet_seconds = 1
"""


def start_daemon(configuration, *arguments):
    with open(configuration.parent / "thind.log", "ab") as log:
        return subprocess.Popen([str(BIN / "thind"), "-c", str(configuration), *arguments], stderr=log)


def status(configuration):
    done = run(BIN / "thind", "-c", configuration, "--status", "--json")
    return json.loads(done.stdout) if done.stdout else {"files": {"pending": -1}}


def wait_until_decided(configuration, daemon, count, limit_s=300):
    deadline = time.monotonic() + limit_s
    while time.monotonic() < deadline:
        files = status(configuration)["files"]
        if files["pending"] == 0 and files.get("seen", 0) >= count:
            return files
        if daemon.poll() is not None:
            break
        time.sleep(0.2)
    check(False, "thind decided every file in time")
    return status(configuration)["files"]


def stop(daemon):
    daemon.send_signal(signal.SIGTERM)
    return daemon.wait(timeout=60)


def deliver(files, inbox):
    for path in files:
        shutil.copyfile(path, inbox / ("." + path.name))
        os.rename(inbox / ("." + path.name), inbox / path.name)


def all_at_once(files):
    folder = fresh("inbox")
    configuration = write_configuration(folder, DAEMON.format(max_wait=5))
    (folder / "inbox").mkdir()
    deliver(files, folder / "inbox")
    daemon = start_daemon(configuration)
    counts = wait_until_decided(configuration, daemon, len(files))
    check(daemon.poll() is None, "thind is alive after all files")
    stop(daemon)
    check(
        counts["seen"] == counts["published"] + counts["quarantined"] + counts["pending"] == len(files),
        f"seen = published + quarantined + pending: {counts}",
    )
    reasons = {}
    for path in sorted((folder / "quarantine").glob("*.reason.json")):
        reasons[path.name.removesuffix(".reason.json")] = json.loads(path.read_text(encoding="utf-8"))["reason"]
    return counts, reasons


def tree_hashes(folder):
    return {
        str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


def disturbed_and_undisturbed(files, seed=1):
    """The outboxes of a run that is left alone and of one that is killed KILLS times; returns (equal, files, kills)."""
    outboxes = []
    chance = random.Random(seed)
    kills = 0
    for name, disturb in (("undisturbed", False), ("killed", True)):
        folder = fresh(name)
        configuration = write_configuration(folder, DAEMON.format(max_wait=60))
        (folder / "inbox").mkdir()
        deliver(files, folder / "inbox")
        daemon = start_daemon(configuration)
        while disturb and kills < KILLS:
            time.sleep(chance.uniform(0.05, 0.9))
            if status(configuration)["files"].get("published", 0) == len(files):
                break
            daemon.kill()
            daemon.wait()
            kills += 1
            daemon = start_daemon(configuration)
        counts = wait_until_decided(configuration, daemon, len(files))
        stop(daemon)
        check(counts["published"] == len(files), f"{name}: all files published: {counts}")
        outboxes.append(tree_hashes(folder / "outbox"))
    check(outboxes[0] == outboxes[1] and outboxes[0], "outputs after kill -9 equal those of an undisturbed run")
    return outboxes[0] == outboxes[1], len(outboxes[0]), kills


# ---- times -------------------------------------------------------------------------------------------------------------


def side_by_side(files, configuration, repetitions):
    """Median seconds of bare_unpack and of thin run, taken in turns."""
    out = fresh("timing")
    bare, whole = [], []
    for _ in range(repetitions):
        began = time.perf_counter()
        check(run(BIN / "bare_unpack", *files).returncode == 0, "bare_unpack")
        bare.append(time.perf_counter() - began)
        began = time.perf_counter()
        check(run(BIN / "thin", "run", "-c", configuration, "-o", out, *files).returncode == 0, "thin run")
        whole.append(time.perf_counter() - began)
    return bare, whole


def spread(seconds):
    return f"{statistics.median(seconds):.3f} ({min(seconds):.3f} to {max(seconds):.3f})"


def bench_rows():
    words = [BIN / "bench_thinning", "--benchmark_format=json", "--benchmark_repetitions=5", "--benchmark_report_aggregates_only=true"]
    results = json.loads(run(*words).stdout)["benchmarks"]
    by_name = {r["name"]: r for r in results}
    for name in sorted({re.sub(r"_(mean|median|stddev|cv)$", "", n) for n in by_name}):
        median, deviation = by_name[name + "_median"], by_name[name + "_stddev"]
        scale = {"ms": 1e-3, "ns": 1e-9}[median["time_unit"]]
        yield f"| {name} | {median['real_time'] * scale:.4f} | {deviation['real_time'] * scale:.4f} |"


# ---- the page ----------------------------------------------------------------------------------------------------------


def main():
    if not DATA.is_dir():
        sys.exit(f"no observations at {DATA}; set THIN_SHARED_DATA")
    amsua = sorted((DATA / "amsua").iterdir())
    others = sorted((DATA / "bad").iterdir()) + sorted((DATA / "other").iterdir())
    generated = fresh("generated")
    run(BIN / "thin", "synth", "-o", generated, "--begin", "2004-07-21T21:00:00Z")
    synthetic = sorted(generated.glob("*.bufr"))

    page = ["# The main job, end to end", ""]
    page += ["Written by `scripts/reproduce main-job`, from a fresh clone. Machine: "
             f"{os.cpu_count()} cores, {platform.machine()}. Times are wall-clock seconds, medians with the range seen.", ""]

    print("thin info against ecCodes")
    page += ["## What is in a file: `thin info` beside ecCodes", "",
             "Counts, satellites, times, latitudes and, per channel, the number present and the range, each compared with a",
             "decode by ecCodes' Python interface.", "",
             "| file | messages | observations | from | to | all equal |", "| --- | --- | --- | --- | --- | --- |"]
    page += [info_row(path) for path in amsua] + [""]

    print("thin run, key by key")
    page += ["## Thinned: `thin run`, `grid_eea` to one in ten", "",
             "The output decoded by ecCodes alone: as many subsets as retained, each equal to its original in every key (all",
             "but the counts of subsets).", "",
             "| file | subsets | retained | in the output | keys compared a subset | all equal |", "| --- | --- | --- | --- | --- | --- |"]
    page += [run_row(path) for path in amsua] + [""]

    print("thind: everything at once")
    counts, reasons = all_at_once(amsua + others)
    page += ["## Everything into `thind`'s inbox at once", "",
             f"{len(amsua)} AMSU-A files and {len(others)} that are bad or of other kinds. The daemon stays alive; seen "
             f"{counts['seen']} = published {counts['published']} + quarantined {counts['quarantined']} + pending {counts['pending']}.", "",
             "| in quarantine | reason given |", "| --- | --- |"]
    page += [f"| {name} | {reason.replace('|', '/')} |" for name, reason in reasons.items()] + [""]
    check(counts["published"] == len(amsua) and counts["quarantined"] == len(others), f"AMSU-A published, the rest quarantined: {counts}")

    print("kill -9")
    equal, outputs, kills = disturbed_and_undisturbed(amsua + synthetic[:12])
    page += ["## `kill -9` of `thind`", "",
             f"{len(amsua) + 12} files; the daemon killed {kills} times at random moments and started again. The {outputs} files of the "
             f"outbox are {'byte for byte' if equal else 'NOT'} those of an undisturbed run.", ""]

    print("times")
    folder = fresh("configuration")
    configuration = write_configuration(folder)
    page += ["## Time beside a bare ecCodes loop", "",
             f"Whole processes in turns, {REPETITIONS} times: `bare_unpack` unpacks every message with ecCodes and does nothing else; "
             "`thin run` reads, prepares, thins (`grid_eea`, full updating, h = 100 km, level 6, all live channels), evaluates and writes.", "",
             "| files | observations | bare unpack, s | thin run, s | ratio of medians |", "| --- | --- | --- | --- | --- |"]
    for name, files in (("AMSUA.bufr, the largest real file", [DATA / "amsua/AMSUA.bufr"]), ("all real AMSU-A files", amsua),
                        ("synthetic, two satellites, 3 h", synthetic)):
        count = sum(soundings.summary(path)["observations"] for path in files)
        bare, whole = side_by_side(files, configuration, REPETITIONS if len(files) < 10 else 5)
        page.append(f"| {name} | {count} | {spread(bare)} | {spread(whole)} | {statistics.median(whole) / statistics.median(bare):.1f} |")
    page += ["", "Seconds per step of the last of these, from the program itself:", ""]
    done = run(BIN / "thin", "run", "-c", configuration, "-o", fresh("timing"), *synthetic)
    page += ["```", done.stdout.strip(), "```", ""]

    page += ["## The methods alone", "",
             "`build/release/bin/bench_thinning`, one thread, eight channels: 27,367 synthetic observations to 3,000 and multiples of "
             "both, h = 100 km, level 6. The thesis needed 63 s for Grid EEA with full updating and 0.78 s with lazy (table 6.1, a "
             "2.8 GHz Pentium 4).", "",
             "| | median, s | standard deviation, s |", "| --- | --- | --- |"]
    page += list(bench_rows()) + [""]

    target = ROOT / "docs/results/main-job.md"
    target.parent.mkdir(exist_ok=True)
    target.write_text("\n".join(page), encoding="utf-8")
    print("written:", target)
    if problems:
        sys.exit(f"{len(problems)} checks failed")


if __name__ == "__main__":
    main()
