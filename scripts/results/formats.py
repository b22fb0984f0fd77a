"""Shows every format and the preparation on real files, and writes docs/results/formats.md. Called by scripts/reproduce
formats. Works with whatever this build can read, so that it says what is missing instead of failing at it."""

import json
import os
import pathlib
import re
import statistics
import subprocess
import sys
import time

from main_job import BIN, DATA, ROOT, check, fresh, problems, run, side_by_side, spread

# The tank's local tables in front of ecCodes' own; ecCodes looks once, when it is loaded, and its Python module may do it
# by another name.
for name in ("ECCODES_DEFINITION_PATH", "ECMWFLIBS_ECCODES_DEFINITION_PATH"):
    os.environ[name] = f"{DATA / 'ncep/definitions'}:/usr/share/eccodes/definitions"

import eccodes  # noqa: E402

import netcdf_text  # noqa: E402
import soundings  # noqa: E402

REPETITIONS = 9
HIRS = next((DATA / "sounders").glob("M02-HIRS-*"), None) if DATA.is_dir() else None


def is_netcdf(path):
    return path.read_bytes()[:4] in (b"\x89HDF", b"CDF\x01", b"CDF\x02", b"CDF\x05")


def said_by_thin(path):
    return json.loads(run(BIN / "thin", "info", "--json", path).stdout)[0]


# ---- counts beside an independent decode -------------------------------------------------------------------------------

COUNT_SUBSETS = """
import sys, eccodes
count = failed = 0
with open(sys.argv[1], "rb") as file:
    while True:
        try:
            message = eccodes.codes_bufr_new_from_file(file)
        except eccodes.CodesInternalError:
            failed += 1
            continue
        if message is None:
            break
        try:
            if eccodes.codes_get(message, "dataCategory") != 11:
                eccodes.codes_set(message, "unpack", 1)
                count += eccodes.codes_get(message, "numberOfSubsets")
        except eccodes.CodesInternalError:
            failed += 1
        eccodes.codes_release(message)
print(count, failed)
"""


def subsets_by_eccodes(path):
    """Subsets that ecCodes' Python module unpacks, in a process of its own: some of the files are made to end it."""
    done = run(sys.executable, "-c", COUNT_SUBSETS, path)
    return int(done.stdout.split()[0]) if done.returncode == 0 and done.stdout else None


def count_by_others(path):
    if not is_netcdf(path):
        return subsets_by_eccodes(path), "ecCodes"
    dimension = netcdf_text.location_dimension(path)
    return (dimension[1] if dimension else 0), "ncdump"


def file_rows(paths):
    usable = []
    for path in paths:
        said = said_by_thin(path)
        name = path.relative_to(DATA)
        found, by_whom = count_by_others(path)
        independent = f"{found} ({by_whom})" if found is not None else "none: it ends the process"
        if not said["usable"]:
            yield f"| {name} | refused | | {independent} | {said['reason'].replace('|', '/')} |", usable
            continue
        usable.append(path)
        good = check(said["observations"] == found, f"{name}: {said['observations']} observations, {by_whom} has {found}")
        what = f"{said['layout']}, {said['instrument']}"
        yield f"| {name} | {what} | {said['observations']} | {independent} | {'equal' if good else 'DIFFERENT'} |", usable


# ---- round trips -------------------------------------------------------------------------------------------------------

# What is left out: nothing but observations without a value in the one channel that is fullest.
RETAIN_ALL = """[thinning]
method = "grid_eea"
retain_fraction = 1.0
[preparation]
remove_duplicates = false
channels = {channels}
minimum_k = -1e9
maximum_k = 1e9
first_guess = "none"
dead_channel_fraction = 1
"""


def fullest_channel(said):
    return min(said["channels"], key=lambda channel: channel["missing"])


def name_of_instrument(instrument):
    return re.sub(r"[^a-z]", "", instrument.lower())


def thin_one(path, text, folder):
    (folder / "c.toml").write_text(text, encoding="utf-8")
    done = run(BIN / "thin", "run", "--json", "-c", folder / "c.toml", "-o", folder / "out", path)
    return (json.loads(done.stdout), None) if done.returncode == 0 else (None, done.stderr.strip())


def is_subsequence(part, whole):
    remaining = iter(whole)
    return all(any(row == other for other in remaining) for row in part)


def bufr_rows(path):
    """Of the messages that hold soundings: a tank's tables (category 11) go through as they are."""
    for message in soundings.messages(path):
        if eccodes.codes_get(message, "dataCategory") != 11:
            yield from soundings.rows(message)


def rows_of(path):
    """One number per observation, that of all its values."""
    return [hash(row) for row in (netcdf_text.rows(path) if is_netcdf(path) else bufr_rows(path))]


def bare_header(path):
    """Groups, variables, types, attributes, fill values and storage, in any order; without the lengths of dimensions and
    of chunks along the first one, which are the locations', and without which library wrote the file."""
    lines = []
    for line in netcdf_text.header(path):
        if ":_NCProperties" in line or ":_SuperblockVersion" in line:
            continue
        line = re.sub(r"\(\d+ currently\)", "(# currently)", line)
        line = re.sub(r"(_ChunkSizes = )\d+", r"\1#", line)
        lines.append(line if ":" in line else re.sub(r"= \d+ ;", "= # ;", line))
    return sorted(lines)


def round_trip_row(path):
    said = said_by_thin(path)
    channel = fullest_channel(said)
    cells = []
    for text, name in (
        (RETAIN_ALL.format(channels=json.dumps([channel["channel"]])), "all"),
        ('[thinning]\nmethod = "grid_eea"\nretain_fraction = 0.1\n[preparation]\nremove_duplicates = false\n'
         f"channels = {json.dumps([channel['channel']])}\n", "thinned"),
    ):
        folder = fresh("formats-run")
        report, problem = thin_one(path, text, folder)
        if not report:
            check(False, f"{path.name}, {name}: {problem}")
            cells += ["failed", ""]
            continue
        output = folder / "out" / path.name
        kept, original = rows_of(output), rows_of(path)
        retained = report["observations"]["retained"]
        equal = len(kept) == retained and is_subsequence(kept, original)
        if is_netcdf(path):
            equal = equal and bare_header(path) == bare_header(output)
        elif retained == len(original):
            equal = equal and len(kept) == len(original)
        check(equal, f"{path.name}, {name}: the output's {len(kept)} observations are those retained, unchanged")
        cells += [f"{retained} of {len(original)}", "yes" if equal else "NO"]
    return f"| {path.relative_to(DATA)} | {' | '.join(cells)} |"


# ---- the HIRS orbit ----------------------------------------------------------------------------------------------------

HIRS_WAY = """[thinning]
method = "grid_eea"
retain_fraction = 0.1
[preparation]
channels = [4, 5, 6, 7, 11, 12]
first_guess = "scan_position_mean"
"""


def peak_megabytes(words):
    process = subprocess.Popen([str(word) for word in words], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, _, usage = os.wait4(process.pid, 0)
    return usage.ru_maxrss / 1024


def hirs_lines():
    if not HIRS or not said_by_thin(HIRS)["usable"]:
        return ["This build does not read HIRS.", ""]
    folder = fresh("formats-hirs")
    configuration = folder / "hirs.toml"
    configuration.write_text(HIRS_WAY, encoding="utf-8")
    bare, whole = side_by_side([HIRS], configuration, REPETITIONS)
    out = folder / "out"
    words = [BIN / "thin", "run", "--json", "-c", configuration, "-o", out, HIRS]
    report = json.loads(run(*words).stdout)
    ratio = statistics.median(whole) / statistics.median(bare)
    check(ratio <= 4, f"the HIRS orbit takes at most 4 times a bare unpack: {ratio:.1f}")
    steps = "  ".join(f"{step} {seconds:.3f}" for step, seconds in report["seconds"].items())
    return [
        f"`thin run`: {report['satellites'][0]['observations']} fields of view decoded, {report['observations']['screened']} "
        f"screened, {report['observations']['retained']} of {report['observations']['prepared']} retained, extracted; "
        f"{REPETITIONS} times in turns with `bare_unpack`.", "",
        "| | |", "| --- | --- |",
        f"| bare ecCodes unpack, s | {spread(bare)} |",
        f"| whole way, s | {spread(whole)} |",
        f"| ratio of medians (goal: at most 4) | {ratio:.1f} |",
        f"| peak memory of `thin run`, MiB | {peak_megabytes(words):.0f} |",
        f"| peak memory of the bare unpack, MiB | {peak_megabytes([BIN / 'bare_unpack', HIRS]):.0f} |",
        "", f"Seconds by step: {steps}", "",
    ]


# ---- four satellites through thind -------------------------------------------------------------------------------------

FOUR = """[thinning]
method = "grid_eea"
retain_fraction = 0.1

[preparation]
channels = ["amsua 5-10"]
duplicate_file_order = ["amsua_*", "rars_*"]
skip_edge_positions = 2
surface = ["sea"]

[daemon]
root = "."
settle_seconds = 0

[window]
length_minutes = 180
anchor_minutes = -90
quiet_seconds = 0
"""


def synth(folder, satellites, begin, minutes):
    named = [word for satellite in satellites for word in ("--satellite", satellite)]
    run(BIN / "thin", "synth", "-o", folder, "--begin", begin, "--duration-minutes", minutes, "--minutes-per-file", 30, *named)
    return sorted(folder.glob("*.bufr"))


def four_satellites():
    """One window with and one without planted duplicates; what comes out must not differ."""
    files = synth(fresh("formats-four"), ["NOAA-15", "NOAA-16", "NOAA-18", "Metop-A"], "2006-11-21T22:30:00Z", 180)
    beside = synth(fresh("formats-beside"), ["NOAA-15"], "2006-11-21T23:08:01Z", 20)
    at_it = synth(fresh("formats-at-it"), ["Metop-A"], "2006-11-22T00:16:00Z", 20)
    outputs, reports, seconds = [], [], []
    for planted in (False, True):
        folder = fresh("formats-thind")
        (folder / "thind.toml").write_text(FOUR, encoding="utf-8")
        inbox = folder / "inbox"
        inbox.mkdir()
        for path in files:
            (inbox / path.name).write_bytes(path.read_bytes())
        for path in (beside + at_it) if planted else []:
            (inbox / ("rars_" + path.name)).write_bytes(path.read_bytes())
        began = time.perf_counter()
        done = run(BIN / "thind", "-c", folder / "thind.toml", "--once")
        seconds.append(time.perf_counter() - began)
        check(done.returncode == 0, f"thind --once on four satellites: {done.stderr[-500:]}")
        window = next((folder / "outbox").iterdir())
        outputs.append({path.name: path.read_bytes() for path in window.iterdir() if path.suffix == ".bufr"})
        reports.append(json.loads((window / "report.json").read_text(encoding="utf-8")))
    same = check(outputs[0] == outputs[1], "planted duplicates change nothing in the outputs")
    report = reports[1]
    lines = [
        f"{len(files)} files of four satellites, three hours, and {len(beside) + len(at_it)} files of direct readout planted beside "
        f"them: NOAA-15 again one second later (6.5 km beside), Metop-A again at the same scan lines. One configuration "
        f"file, `thind --once`, {seconds[1]:.1f} s. The outputs are {'byte for byte' if same else 'NOT'} those of the same window "
        "without the planted files.", "",
        "| satellite | observations | duplicates | of them exact | at the edge | not over sea | prepared | retained |",
        "| --- | --- | --- | --- | --- | --- | --- | --- |",
    ]
    for one in report["satellites"]:
        twice, screened = one["duplicates"], one["screened"]
        lines.append(f"| {one['name']} {one['instrument']} | {one['observations']} | {sum(twice.values())} | {twice['exact']} | "
                     f"{screened.get('scan position at the edge', 0)} | {screened.get('surface not asked for', 0)} | "
                     f"{one['prepared']} | {one['retained']} |")
    planted = sum(sum(one["duplicates"].values()) for one in report["satellites"])
    expected = report["observations"]["prepared"] == reports[0]["observations"]["prepared"]
    check(expected and planted > 0, "every planted observation is found")
    return lines + ["", "The configuration:", "", "```toml", FOUR.strip(), "```", ""]


# ---- fuzzing, from the logs of runs ------------------------------------------------------------------------------------


LOGS = ROOT / "build/fuzz-logs"


def fuzz_lines():
    """From what libFuzzer printed: `scripts/fuzz bufr 30 2>&1 | tee build/fuzz-logs/bufr.log`."""
    rows = []
    for path in sorted(LOGS.glob("*.log")):
        text = path.read_text(encoding="utf-8", errors="replace")
        if done := re.findall(r"Done (\d+) runs in (\d+) second", text):
            runs, seconds = done[-1]
        elif (counts := re.findall(r"^#(\d+): cov", text, re.M)) and (times := re.findall(r"time: (\d+)s", text)):
            runs, seconds = counts[-1], times[-1]  # with -fork
        else:
            continue
        findings = ROOT / "build/fuzz-findings" / path.stem
        kept = len(list(findings.iterdir())) if findings.is_dir() else 0
        rows.append(f"| {path.stem} | {int(runs):,} | {int(seconds) / 60:.0f} | {kept} |")
    pages = [f"[{page.stem}]({page.name})" for page in sorted((ROOT / "docs/results").glob("fuzzing*.md"))]
    told = [f"What was found: {', '.join(pages)}.", ""] if pages else []
    if not rows:
        return [f"No log of a fuzzing run lies under `{LOGS.relative_to(ROOT)}/`.", "", *told]
    return ["| case | inputs | minutes | inputs kept as findings |", "| --- | --- | --- | --- |", *rows, "", *told]


def bench_rows():
    words = [BIN / "bench_preparation", "--benchmark_format=json", "--benchmark_repetitions=5", "--benchmark_report_aggregates_only=true"]
    for result in json.loads(run(*words).stdout)["benchmarks"]:
        if result["name"].endswith("_median"):
            yield f"| {result['name'].removesuffix('_median')} | {result['real_time']:.1f} | {result['cpu_time']:.1f} |"


def main():
    if not DATA.is_dir():
        sys.exit(f"no observations at {DATA}; set THIN_SHARED_DATA")
    paths = [p for p in sorted(DATA.rglob("*")) if p.is_file() and p.suffix not in {".txt", ".md", ".def", ".table"}]
    page = ["# Formats and preparation", "",
            "Written by `scripts/reproduce formats`. Every file under the shared observations, read or refused; what comes out "
            "beside what went in; the HIRS orbit's time; four satellites through `thind`.", ""]

    print("every file")
    page += ["## Every file", "", "Observations beside an independent decode: subsets that ecCodes' Python module unpacks, or the length of the "
             "location dimension by `ncdump`.", "",
             "| file | read as | observations | independent | |", "| --- | --- | --- | --- | --- |"]
    usable = []
    for row, usable in file_rows(paths):
        page.append(row)
    page.append("")

    print("round trips")
    page += ["## Round trips", "",
             "`thin run` with everything retained (but observations whose fullest channel is missing), and thinned to one in ten by "
             "`grid_eea`. Equal: the output, decoded by ecCodes' Python module or `ncdump` alone, holds as many observations as were "
             "retained, in order, each equal to its original in every value; of netCDF also groups, variables, types, attributes, "
             "fill values and storage.", "",
             "| file | retained of all | equal | thinned | equal |", "| --- | --- | --- | --- | --- |"]
    page += [round_trip_row(path) for path in usable] + [""]

    print("the HIRS orbit")
    page += ["## The full HIRS orbit", ""] + hirs_lines()
    print("four satellites")
    page += ["## Four satellites in one window", ""] + four_satellites()
    print("the preparation alone")
    page += ["## The preparation's steps alone", "", "`build/release/bin/bench_preparation`: 100,000 fields of view of AMSU-A on four satellites.", "",
             "| | median, ms | of the main thread, ms |", "| --- | --- | --- |", *bench_rows(), ""]
    page += ["## Fuzzing", ""] + fuzz_lines()

    target = ROOT / "docs/results/formats.md"
    target.parent.mkdir(exist_ok=True)
    target.write_text("\n".join(page), encoding="utf-8")
    print("written:", target)
    if problems:
        sys.exit(f"{len(problems)} checks failed")


if __name__ == "__main__":
    main()
