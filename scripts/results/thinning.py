"""Runs the thesis's table 6.1 and figures 6.8 to 6.13 and 6.16 with every method that there is, on made-up and on real
innovations, and writes docs/results/thinning.md. Called by scripts/reproduce thinning."""

import csv
import json
import math
import os
import pathlib
import platform
import shutil
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
sys.dont_write_bytecode = True

import evaluation_plots as plots  # noqa: E402 (needs the path above)

THIN = pathlib.Path(os.environ.get("THIN_PROGRAM", ROOT / "build/release/bin/thin"))
WORK = ROOT / "build/results/thinning"
PAGE = ROOT / "docs/results/thinning.md"
PICTURES = ROOT / "docs/results/thinning"
DATA = pathlib.Path(os.environ.get("THIN_SHARED_DATA", ROOT / "../shared/data")).resolve() / "observations"
REAL = DATA / "ioda/amsua_n19.20211211T210000Z.nc4"

QUICK = "--quick" in sys.argv  # a trial of this script: a small set, few numbers, no repetitions
N = 4000 if QUICK else 27367
COUNTS = [200, 300, 500, 800, 2000, 3000] if QUICK else [1000, 2000, 3000, 5000, 15000, 25000]
FEW, MIDDLE, MANY = COUNTS[0], COUNTS[2], COUNTS[3]
LEVEL = 6 if QUICK else 8  # of the common grid
EEA = ["eea", "top_down_eea", "grid_eea", "grid_top_down_eea"]
# Table 6.1 of the thesis: seconds on a 2.8 GHz Pentium 4 or the like, by numbers retained as in COUNTS.
THESIS_SECONDS = {
    "top_down_clustering": [0.29, 0.35, 0.39, 0.44, 0.62, 0.69],
    "eea, full": [120, 120, 110, 98, 93, 25],
    "top_down_eea, full": [13, 24, 36, 58, 140, 180],
    "grid_eea, full": [81, 69, 63, 57, 45, 11],
    "grid_top_down_eea, full": [4.9, 9.6, 14, 23, 55, 68],
    "eea, lazy": [4.6, 4.4, 4.3, 4.0, 2.4, 0.7],
    "top_down_eea, lazy": [3.4, 3.9, 4.1, 4.5, 5.8, 7.1],
    "grid_eea, lazy": [0.87, 0.83, 0.78, 0.74, 0.44, 0.14],
    "grid_top_down_eea, lazy": [0.47, 0.56, 0.62, 0.72, 0.98, 1.2],
}

problems = []
page = []


def check(condition, what):
    if not condition:
        problems.append(what)
        print("FAILED:", what, file=sys.stderr)
    return condition


def say(*lines):
    page.extend(lines)


# ---- running ---------------------------------------------------------------------------------------------------------


class Evaluation:
    """One run of thin evaluate: its JSON, and what it cost."""

    def __init__(self, name, configuration, files=(), words=()):
        began = time.monotonic()
        paths = {kind: WORK / f"{name}.{kind}" for kind in ("toml", "json", "csv", "costs")}
        paths["toml"].write_text(configuration, encoding="utf-8")
        command = [THIN, "evaluate", "-c", paths["toml"], "--json", paths["json"], "--csv", paths["csv"],
                   "--costs", paths["costs"], *words, *files]
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            sys.exit(f"thin evaluate {name}: {done.stderr}")
        self.json_bytes, self.csv_bytes = paths["json"].read_bytes(), paths["csv"].read_bytes()
        self.json = json.loads(self.json_bytes)
        with paths["costs"].open(encoding="utf-8", newline="") as file:
            self.costs = list(csv.DictReader(file))
        print(f"{name}: {time.monotonic() - began:.1f} s", flush=True)

    def rows(self, label):
        return [result for result in self.json["results"] if result["variant"] == label]

    def result(self, label, asked):
        return next((r for r in self.rows(label) if r["asked"] in (asked, None)), None)

    def error(self, label, asked, where="error_on_grid"):
        result = self.result(label, asked)
        return result and result[where]["mean_squared_k2"]

    def cost(self, label, asked):
        for result, cost in zip(self.json["results"], self.costs):
            if result["variant"] == label and result["asked"] in (asked, None):
                return cost
        return None

    def seconds(self, label, asked):
        cost = self.cost(label, asked)
        return cost and float(cost["seconds_median"])

    def labels(self):
        have = {result["variant"] for result in self.json["results"]}
        return [variant["label"] for variant in self.json["variants"] if variant["label"] in have]


def methods():
    done = subprocess.run([str(THIN), "methods", "--json"], capture_output=True, text=True, check=True)
    return {method["name"]: {option["name"] for option in method["options"]} for method in json.loads(done.stdout)}


METHODS = {}


def toml(value):
    return json.dumps(value)


def section(name, **options):
    """[name], or [[name]] where the name comes in brackets."""
    return f"[{name}]\n" + "".join(f"{key} = {toml(value)}\n" for key, value in options.items())


def variant(method, label=None, **options):
    """Nothing where there is no such method."""
    if method not in METHODS:
        return ""
    return section("[evaluate.variant]", method=method, **({"label": label} if label else {}), **options)


ORBITS = section("synthetic", source="orbits", count=N)
ONE_THREAD = section("run", threads=1)
REPETITIONS = 1 if QUICK else 3


def real_preparation():
    # Channels that nearly every location has: eight, as many as the thesis's.
    return section("preparation", channels=[6, 7, 9, 10, 11, 12, 13, 14])


# ---- words and tables ------------------------------------------------------------------------------------------------


def table(head, rows):
    say("| " + " | ".join(head) + " |", "| " + " | ".join("---" for _ in head) + " |")
    for row in rows:
        say("| " + " | ".join("" if cell is None else str(cell) for cell in row) + " |")
    say("")


def significant(number, digits=3):
    if number is None or (isinstance(number, float) and not math.isfinite(number)):
        return "-"
    return f"{number:.{digits}g}" if abs(number) < 1000 else f"{number:,.0f}"


def error_text(number):
    return "-" if number is None else f"{number:.4f}"


def seconds_text(number):
    if number is None:
        return "-"
    return f"{number:.4f}" if number < 0.1 else f"{number:.2f}"


def percent(ratio):
    return f"{100 * ratio:.1f} %"


def listed(numbers):
    numbers = [f"{number:,}" if isinstance(number, int) else str(number) for number in numbers]
    return numbers[0] if len(numbers) == 1 else ", ".join(numbers[:-1]) + " and " + numbers[-1]


def holds_at(counts, condition):
    """'at every number', 'at none', or at which; a number counts where the condition is not None."""
    known = [(count, condition(count)) for count in counts]
    known = [(count, value) for count, value in known if value is not None]
    true = [count for count, value in known if value]
    if not known:
        return "not to be said, for want of numbers that both have"
    if len(true) == len(known):
        return f"at every number ({listed([count for count, _ in known])})"
    return "at none of " + listed([c for c, _ in known]) if not true else \
        f"at {listed(true)}, but not at {listed([c for c, v in known if not v])}"


def less(evaluation, a, b, where):
    """A condition for holds_at: a's error is less than b's."""
    def condition(count):
        first, second = evaluation.error(a, count, where), evaluation.error(b, count, where)
        return None if first is None or second is None else first < second
    return condition


# ---- table 6.1, figures 6.12 and 6.13 --------------------------------------------------------------------------------


def table_6_1():
    variants = "".join(variant(m, f"{m}, {update}", update=update) for update in ("full", "lazy") for m in EEA)
    configuration = ORBITS + ONE_THREAD + section(
        "evaluate", counts=COUNTS, bandwidth_km=100, level=LEVEL, repetitions=REPETITIONS)
    run = Evaluation("table-6.1", configuration + variant("top_down_clustering") + variants)
    counts = COUNTS

    say("## Table 6.1: seconds", "",
        f"{N:,} made-up observations, h = 100 km, level 6, one thread; medians of {REPETITIONS}. In brackets the thesis's seconds, of a",
        "2.8 GHz Pentium 4 or the like; with which h is not said there.", "")
    rows = []
    for label, theirs in THESIS_SECONDS.items():
        if label in run.labels():
            rows.append([label] + [f"{seconds_text(run.seconds(label, count))} ({theirs[place]:g})"
                                   for place, count in enumerate(counts)])
    table(["retained"] + [f"{count:,}" for count in counts], rows)

    spreads = [float(c["seconds_most"]) / float(c["seconds_least"]) for c in run.costs if float(c["seconds_least"]) > 0.01]
    if REPETITIONS > 1:
        say(f"Noise of the machine: the slowest repetition of a cell took {significant(max(spreads))} times its fastest at most "
            f"(cells above 0.01 s), {significant(sorted(spreads)[len(spreads) // 2])} times in the middle.", "")

    goals = [("eea, full", 1.0), ("grid_eea, full", 0.3)] + [(f"{m}, lazy", 0.1) for m in EEA] + [("top_down_clustering", 0.1)]
    rows = []
    for label, goal in goals:
        ours = run.seconds(label, MIDDLE)
        if ours is not None:
            theirs = THESIS_SECONDS[label][2]
            rows.append([label, seconds_text(ours), f"{goal:g}", "yes" if ours < goal else "no", f"{theirs:g}",
                         f"{theirs / ours:,.0f}"])
    say(f"{N:,} to {MIDDLE:,} beside what was asked for:", "")
    table(["", "s", "goal: less than, s", "reached", "thesis, s", "thesis / ours"], rows)

    first, last = counts[0], counts[-1]
    insertion = [label for label in run.labels() if "top_down_eea" in label]
    removal = [label for label in run.labels() if "eea" in label and "top_down" not in label]
    ratio = lambda label: run.seconds(label, last) / run.seconds(label, first)  # noqa: E731
    say("What the thesis reads from its table, and whether ours says it:", "")
    theirs = lambda label: THESIS_SECONDS[label][-1] / THESIS_SECONDS[label][0]  # noqa: E731
    shown = lambda labels: listed([f"{significant(ratio(label))} ({label}; thesis {significant(theirs(label), 2)})" for label in labels])  # noqa: E731
    say(f"- Thesis: insertion takes longer the more is retained. To {last:,} ours takes, in units of the time to {first:,}: {shown(insertion)}.")
    say(f"- Thesis: removal takes less the more is retained. Ours, likewise: {shown(removal)}.")
    speed = lambda m: run.seconds(f"{m}, full", MIDDLE) / run.seconds(f"{m}, lazy", MIDDLE)  # noqa: E731
    said = lambda m: THESIS_SECONDS[f"{m}, full"][2] / THESIS_SECONDS[f"{m}, lazy"][2]  # noqa: E731
    say(f"- Thesis: lazy updating is faster by far. To {MIDDLE:,} our full updating takes, in units of the lazy one: "
        + listed([f"{significant(speed(m))} ({m}; thesis {significant(said(m), 2)})" for m in EEA])
        + ". Full updating follows all increments by differences and puts right in the queue only those that fell, so that lazy updating has less to save.")
    grid = lambda u: run.seconds(f"eea, {u}", MIDDLE) / run.seconds(f"grid_eea, {u}", MIDDLE)  # noqa: E731
    say(f"- Thesis: the grid is faster. Removal to {MIDDLE:,} at the observations takes, in units of that on the grid: "
        f"{significant(grid('full'))} (full; thesis 1.7) and {significant(grid('lazy'))} (lazy; thesis 5.5).", "")

    say("### E of the same sets", "",
        f"K², at the observations (6.11) / on the grid G{LEVEL} (6.12), h = 100 km.", "")
    table(["retained"] + [f"{count:,}" for count in counts],
          [[label] + [f"{error_text(run.error(label, c, 'error_at_observations'))} / {error_text(run.error(label, c))}"
                      for c in counts] for label in run.labels()])
    figure_6_12(run, counts)
    figure_6_13(run, counts)
    return run


def picture(name, text):
    say(f"![{text}](thinning/{name})", "")


def figure_6_12(run, counts):
    full = lambda *names: [f"{name}, full" for name in names]  # noqa: E731
    plots.curves([(run.json, "error_at_observations", full("eea", "top_down_eea"), "at the observations"),
                  (run.json, "error_on_grid", full("grid_eea", "grid_top_down_eea"), "on the grid")],
                 PICTURES / "figure-6.12.png", "Insertion (top-down) against removal, h = 100 km", 2)
    say("## Figure 6.12: insertion against removal", "")
    picture("figure-6.12.png", "Insertion against removal")
    gain = lambda a, b, where, count: 1 - run.error(a, count, where) / run.error(b, count, where)  # noqa: E731
    at = counts[0]
    observations = gain("top_down_eea, full", "eea, full", "error_at_observations", at)
    grid = gain("grid_top_down_eea, full", "grid_eea, full", "error_on_grid", at)
    say("- Thesis: at the observations insertion is significantly better. Ours: less E than removal "
        + holds_at(counts, less(run, "top_down_eea, full", "eea, full", "error_at_observations")) + f"; at {at:,} by {percent(observations)}.")
    say("- Thesis: on the grid the gain is smaller, and at small numbers only. Ours: less E than removal "
        + holds_at(counts, less(run, "grid_top_down_eea, full", "grid_eea, full", "error_on_grid")) + f"; at {at:,} by {percent(grid)}, "
        + ("less than at the observations." if grid < observations else "not less than at the observations."), "")


def figure_6_13(run, counts):
    plots.curves([(run.json, "error_on_grid", [f"grid_eea, {u}" for u in ("full", "lazy")], "removal"),
                  (run.json, "error_on_grid", [f"grid_top_down_eea, {u}" for u in ("full", "lazy")], "insertion")],
                 PICTURES / "figure-6.13.png", "Lazy against full updating on the grid, h = 100 km", 2)
    say("## Figure 6.13: lazy against full updating", "")
    picture("figure-6.13.png", "Lazy against full updating")
    loss = lambda m, count: run.error(f"{m}, lazy", count) / run.error(f"{m}, full", count) - 1  # noqa: E731
    worst = {m: max(counts, key=lambda count: loss(m, count)) for m in EEA}
    say("E that lazy updating adds, K² on the grid, as a share of that with full updating:", "")
    table(["retained"] + [f"{count:,}" for count in counts],
          [[m] + [percent(loss(m, count)) for count in counts] for m in EEA])
    many = [count for count in counts if count > 0.15 * N]
    say(f"- Thesis: negligible for removal (Grid EEA). Ours: {percent(loss('grid_eea', worst['grid_eea']))} at worst, "
        f"at {worst['grid_eea']:,}.")
    if many:
        few = [count for count in counts if count <= 0.15 * N]
        say("- Thesis: noticeable for insertion above 15 % retained. Ours (Grid Top-Down EEA): at most "
            f"{percent(max(loss('grid_top_down_eea', c) for c in many))} above, {percent(max(loss('grid_top_down_eea', c) for c in few))} below.")
    say("")


# ---- all methods, refinements, noise ---------------------------------------------------------------------------------

REFINED = [
    ("exchange", {"refine": "exchange"}),
    ("exchange, 4 starts", {"refine": "exchange", "starts": 4}),
    ("annealing", {"refine": "annealing"}),
    ("annealing, effort 4", {"refine": "annealing", "effort": 4}),
]


def refined_variants(method):
    options = METHODS.get(method, set())
    return "".join(variant(method, f"{method} + {label}", **keys) for label, keys in REFINED if set(keys) <= options)


def all_methods_table(run, counts, unit_note):
    say(unit_note, "")
    rows = []
    for label in run.labels():
        for count in counts:
            result, cost = run.result(label, count), run.cost(label, count)
            if result is None:
                continue
            separation = result["separation_km"]
            memory = float(cost["peak_memory_bytes"]) / 2**20 if cost["peak_memory_bytes"] else None
            rows.append([label if count == counts[0] else "", f"{result['retained']:,}",
                         error_text(result["error_at_observations"]["mean_squared_k2"]),
                         error_text(result["error_on_grid"]["mean_squared_k2"]),
                         f"{result['error_on_grid']['signal_to_noise_db']:.1f}" if result["error_on_grid"]["signal_to_noise_db"] is not None else "-",
                         f"{separation['minimum']:.0f} / {separation['median']:.0f}",
                         percent(result["signal_free_share"]), seconds_text(float(cost["seconds_median"])),
                         "-" if memory is None else f"{memory:.0f}"])
    table(["method", "retained", "E at observations, K²", "E on grid, K²", "SNR on grid, dB", "nearest: least / median, km",
           "in signal-free areas", "s", "MiB"], rows)
    for failure in run.json["failures"]:
        say(f"Not fit for this set: {failure['variant']} ({failure['reason']}).", "")


def all_methods():
    counts = [FEW, MIDDLE, MANY]
    plain = "".join(variant(method) for method in METHODS)
    configuration = ORBITS + ONE_THREAD + section("evaluate", counts=counts, bandwidth_km=100, level=LEVEL)
    run = Evaluation("all-methods", configuration + plain + refined_variants("eea") + refined_variants("grid_eea"))
    say("## All methods on the made-up set", "")
    all_methods_table(run, counts, (
        f"{N:,} made-up innovations (AMSU-A channels 5 to 12 of NOAA-15 and NOAA-16 over sea), h = 100 km, one thread. "
        f"E of retaining nothing: {error_text(run.json['observations']['of_retaining_nothing_at_observations']['mean_squared_k2'])} K² at the observations, "
        f"{error_text(run.json['observations']['of_retaining_nothing_on_grid']['mean_squared_k2'])} on the grid. Methods that can't be told a number "
        "have their mesh, spacing, step or tolerance fitted to come as near as they can. Memory is what the method takes above the observations. "
        f"{percent(run.json['observations']['signal_free_share'])} of all observations are in signal-free areas."))
    refinement(run, counts, True)
    noise(run, counts)
    return run


def refinement(run, counts, is_asked_for):
    greedy = [label for label in EEA if label in run.labels()]
    refined = [label for label in run.labels() if " + " in label]
    if not refined:
        return
    say("### Beyond the thesis: refinement", "",
        "E of the best greedy variant of the thesis, and what refined sets have less than it. `eea` lowers E at the observations and is "
        "measured there; `grid_eea` lowers it on its grid of level 6 and is measured on the common one.", "")
    rows = []
    for method, where in (("eea", "error_at_observations"), ("grid_eea", "error_on_grid")):
        best = {count: min(greedy, key=lambda label: run.error(label, count, where)) for count in counts}
        rows.append([f"best greedy ({where.removeprefix('error_').replace('_', ' ')})"]
                    + [f"{error_text(run.error(best[c], c, where))} ({best[c]})" for c in counts] + [""])
        for label in [label for label in refined if label.startswith(method + " + ")]:
            gains = [1 - run.error(label, c, where) / run.error(best[c], c, where) for c in counts]
            cells = [f"{error_text(run.error(label, c, where))} (-{percent(gain)})" if gain >= 0
                     else f"{error_text(run.error(label, c, where))} (+{percent(-gain)})" for c, gain in zip(counts, gains)]
            rows.append([label] + cells + [" / ".join(seconds_text(run.seconds(label, c)) for c in counts)])
    table([""] + [f"to {count:,}" for count in counts] + ["s"], rows)
    where = "error_at_observations"
    best = {count: min(run.error(label, count, where) for label in greedy) for count in counts}
    mine = {count: min(run.error(label, count, where) for label in refined if label.startswith("eea")) for count in counts}
    gains = {count: 1 - mine[count] / best[count] for count in counts}
    say("The best refinement of `eea` is below the best variant of the thesis by "
        + listed([f"{percent(gains[c])} at {c:,}" for c in counts])
        + (f" (asked for: 30 %, reached {holds_at(counts, lambda c: gains[c] >= 0.3)})" if is_asked_for else "")
        + ". A lower E is not yet a better analysis.", "")


def noise(noisy, counts):
    count = MIDDLE
    plain = "".join(variant(method) for method in METHODS)
    configuration = section("synthetic", source="orbits", count=N, noise=False) + section(
        "evaluate", counts=[count], bandwidth_km=100, level=6)
    clean = Evaluation("without-noise", configuration + plain)
    say("## Noise in flat areas", "",
        "Lazarus et al. (2010): noise in flat areas attracts points. Where the made-up atmosphere has no signal is known: the share of the "
        f"retained that lies there, of {count:,}, with the instrument's noise and without. All observations: "
        f"{percent(noisy.json['observations']['true_signal_free_share'])}.", "")
    rows = []
    for label in clean.labels():
        with_noise, without = noisy.result(label, count), clean.result(label, count)
        if with_noise and without:
            rows.append([label, percent(with_noise["true_signal_free_share"]), percent(without["true_signal_free_share"]),
                         percent(with_noise["signal_free_share"])])
    table(["method", "with noise", "without", "with noise, areas told by `thin evaluate`"], rows)
    shares = {row[0]: float(row[1].split()[0]) for row in rows}
    everywhere = 100 * noisy.json["observations"]["true_signal_free_share"]
    avoiding = [label for label, share in shares.items() if share < everywhere / 2]
    say(("With noise, less than half of what the observations have there is retained by " + listed(avoiding) + ".") if avoiding else
        "With noise, no method retains less than half of what the observations have there.",
        "`thin evaluate` takes an area for signal-free where the full set's estimate varies no more within 3h than 1.5 times what noise alone "
        "would make of it.", "")


# ---- figures 6.8 to 6.11, 6.16 ---------------------------------------------------------------------------------------


def figure_6_8(steps_retained):
    configuration = ORBITS + section("evaluate", counts=[steps_retained], bandwidth_km=100, errors=False, list_boxes=True)
    run = Evaluation("figure-6.8", configuration + variant("stepwise", step=3, fit="none")
                     + variant("top_down_clustering") + variant("eea"))
    labels = [label for label in ("top_down_clustering", "eea") if label in run.labels()]
    plots.density(run.json, labels, PICTURES / "figure-6.8.png", "Where more is retained than by every third field of view")
    say("## Figure 6.8: density beside stepwise thinning", "")
    picture("figure-6.8.png", "Density differences per box")
    for label in labels:
        result = run.result(label, steps_retained)
        boxes = result["boxes"]
        crowded = sorted(boxes["observations"])[-len(boxes["observations"]) // 10]
        there = [d for d, n in zip(boxes["difference"], boxes["observations"]) if n >= crowded]
        sparse = sorted(boxes["observations"])[len(boxes["observations"]) // 4]
        edge = [d for d, n in zip(boxes["difference"], boxes["observations"]) if n <= sparse]
        say(f"- {label}: mean absolute difference {significant(result['mean_absolute_density_difference'])} a box; mean difference "
            f"{sum(there) / len(there):+.2f} in the tenth of the boxes with most observations ({crowded} or more: tracks overlap), "
            f"{sum(edge) / len(edge):+.2f} in the quarter with fewest ({sparse} or fewer: track edges).")
    say("", "Thesis: more than stepwise at the far ends of the scan lines, where observations are sparse, and where tracks overlap.", "")


def stepwise_count():
    run = Evaluation("stepwise", ORBITS + section("evaluate", counts=[1], errors=False) + variant("stepwise", step=3, fit="none"))
    return run.json["results"][0]["retained"]


def figures_6_9_and_6_10():
    dense = COUNTS if QUICK else [1000, 2000, 3000, 5000, 7000, 10000, 15000, 20000]
    counts = {50: dense, 100: dense, 200: COUNTS if QUICK else [1000, 2000, 3000, 5000, 10000, 20000]}
    runs = {}
    for bandwidth in (50, 100, 200):
        configuration = ORBITS + section("evaluate", counts=counts[bandwidth], bandwidth_km=bandwidth, level=6)
        runs[bandwidth] = Evaluation(f"figure-6.9-{bandwidth}", configuration + variant("top_down_clustering")
                                     + variant("eea", update="lazy" if bandwidth == 200 else "full") + variant("stepwise"))
    panels = [(runs[h].json, measure, None, f"h = {h} km")
              for measure in ("error_at_observations", "signal_to_noise_at_observations") for h in runs]
    plots.curves(panels, PICTURES / "figures-6.9-6.10.png", "Clustering, estimation error analysis and stepwise thinning", 3)
    say("## Figures 6.9 and 6.10: clustering, EEA and stepwise", "",
        "E at the observations (6.11), and the signal-to-noise ratio 20 log10(mean |f| / √E). At h = 200 km EEA with lazy updating.", "")
    picture("figures-6.9-6.10.png", "Errors of clustering, EEA and stepwise thinning over the number retained")
    where = "error_at_observations"
    for h, run in runs.items():
        lines = []
        if "top_down_clustering" in run.labels():
            lines.append("clustering has less E than stepwise " + beats_stepwise(run, "top_down_clustering", where))
            lines.append("EEA less than clustering " + holds_at(counts[h], less(run, "eea", "top_down_clustering", where)))
        lines.append("EEA less than stepwise " + beats_stepwise(run, "eea", where))
        say(f"- h = {h} km: " + "; ".join(lines) + ".")
    say("", "Thesis: clustering better than stepwise throughout; EEA best down to about 5,000 retained at h = 50 km, at h = 100 km also with fewer. "
        "Stepwise retains what whole steps give; there the other's curve is interpolated.", "")
    return runs


def interpolated(run, label, where, number):
    """E of a variant at a number retained, linear in the logarithms; nothing outside of its curve."""
    points = sorted((r["retained"], r[where]["mean_squared_k2"]) for r in run.rows(label))
    for (n0, e0), (n1, e1) in zip(points, points[1:]):
        if n0 <= number <= n1 and e0 > 0 and e1 > 0 and n0 < n1:
            share = math.log(number / n0) / math.log(n1 / n0)
            return math.exp(math.log(e0) + share * math.log(e1 / e0))
    return None


def beats_stepwise(run, label, where):
    steps = {r["retained"]: r[where]["mean_squared_k2"] for r in run.rows("stepwise")}
    def condition(number):
        error = interpolated(run, label, where, number)
        return None if error is None or steps[number] == 0 else error < steps[number]
    return holds_at(sorted(steps), condition)


def figure_6_11():
    counts = COUNTS[:4] if QUICK else [1000, 3000, 5000, 10000]
    levels = [4, 5, 6] if QUICK else [4, 5, 6, 7, 8]
    configuration = ORBITS + section("evaluate", counts=counts, bandwidth_km=100, level=levels[-1])
    run = Evaluation("figure-6.11", configuration + variant("eea")
                     + "".join(variant("grid_eea", f"grid_eea, level {level}", level=level) for level in levels))
    plots.curves([(run.json, "error_on_grid", None, f"E on G{levels[-1]}")], PICTURES / "figure-6.11.png",
                 "EEA and Grid EEA at several levels, h = 100 km", 1)
    say("## Figure 6.11: resolution of the grid", "")
    picture("figure-6.11.png", "Grid EEA at several levels")
    label = lambda level: f"grid_eea, level {level}"  # noqa: E731
    table(["retained"] + [f"{c:,}" for c in counts],
          [[name] + [error_text(run.error(name, c)) for c in counts] for name in run.labels()])
    top, at = levels[-1], MIDDLE
    over = {level: run.error(label(level), at) / run.error(label(top), at) - 1 for level in levels}
    say(f"- Thesis: level 6 is satisfying already, level 7 marginally better. Ours at {at:,}: above the E of level {top} by "
        + listed([f"{percent(over[level])} (level {level})" for level in levels[:-1]]) + ".")
    say(f"- Every grid from level 6 on has less E on G{top} than EEA at the observations "
        + holds_at(counts, lambda c: all(run.error(label(level), c) < run.error("eea", c) for level in levels if level >= 6)) + ".", "")


def figure_6_16():
    number, retained = (2000, 200) if QUICK else (10000, 1000)
    source = section("synthetic", source="gradient", count=number, noise=False)
    clusters = Evaluation("figure-6.16-clustering", source + section("evaluate", counts=[retained], errors=False, list_retained=True)
                          + "".join(variant("top_down_clustering", f"alpha = {a}", alpha_km_per_k=a) for a in (0, 100, 300)))
    runs = {}
    for h in (50, 100, 200):
        runs[h] = Evaluation(f"figure-6.16-{h}", source + section("evaluate", counts=[retained], bandwidth_km=h, errors=False, list_retained=True)
                             + variant("eea", f"EEA, h = {h} km", update="lazy"))
    panels = [(clusters.json, None, "(a) full data set")]
    panels += [(clusters.json, label, f"({letter}) clustering, {label.replace('alpha', 'α')} km/K")
               for letter, label in zip("bcd", [label for label in clusters.labels() if label.startswith("alpha")])]
    panels += [(runs[h].json, runs[h].labels()[0], f"({letter}) {runs[h].labels()[0]}") for letter, h in zip("efg", runs)]
    plots.places(panels, PICTURES / "figure-6.16.png", f"An artificial gradient: {number:,} random observations, {retained:,} retained")
    say("## Figure 6.16: an artificial gradient", "",
        f"{number:,} random points in a square of 1,000 km; values rise from -1 to 1 K within the 200 km in the middle (the thesis does not say by how "
        "much), without noise. EEA by lazy updating: at h = 200 km nearly all observations see each other.", "")
    picture("figure-6.16.png", "Thinnings near an artificial gradient")
    rows = []
    for run in [clusters, *runs.values()]:
        near = [abs(longitude) * plots.EARTH_RADIUS_KM * math.pi / 180 < 150 for longitude in run.json["observations"]["longitude_deg"]]
        for label in run.labels():
            kept = run.rows(label)[0]["retained_indices"]
            rows.append([f"clustering, {label} km/K" if label.startswith("alpha") else label, percent(sum(near[i] for i in kept) / len(kept))])
    everywhere = sum(near) / len(near)
    table(["", f"retained within 50 km of the ramp (of all observations {percent(everywhere)} are there)"], rows)
    ramp = {name: float(share.split()[0]) for name, share in rows}
    by_alpha = [ramp[name] for name in ramp if name.startswith("clustering")]
    by_eea = [ramp[name] for name in ramp if not name.startswith("clustering")]
    if by_alpha:
        say(f"- Thesis: no increased density at alpha = 0, the more the larger alpha. Ours: {by_alpha[0]:.1f} % at 0, "
            + ("and rising with alpha." if by_alpha == sorted(by_alpha) and by_alpha[0] < by_alpha[-1] else "but not rising with alpha throughout."))
        say("- Thesis: EEA concentrates heavily near the gradient, homogeneous regions are almost empty. Ours: "
            + ("every EEA set has a larger share there than every clustering." if min(by_eea) > max(by_alpha)
               else "not every EEA set has a larger share there than every clustering."), "")


# ---- real innovations ------------------------------------------------------------------------------------------------


def real_innovations():
    counts = [500, 3000] if QUICK else [500, 1000, 2000, 3000, 4000, 5000]
    shown = counts if QUICK else [500, 1000, 3000, 5000]
    head = section("input", platform="NOAA-19") + real_preparation() + ONE_THREAD
    plain = "".join(variant(method) for method in METHODS)
    say("## Real innovations", "")
    runs = {}
    for h in (200,) if QUICK else (150, 200, 300):
        configuration = head + section("evaluate", counts=counts, bandwidth_km=h, level=6 if QUICK or h == 300 else 7, reference="box",
                                       repetitions=1)
        refined = refined_variants("eea") if h == 200 else ""
        runs[h] = Evaluation(f"real-{h}", configuration + plain + refined, [REAL])
    run = runs[200]
    observations = run.json["observations"]
    say(f"AMSU-A on NOAA-19, 11 December 2021 21:00 to 03:00 UTC: ObsValue - GsiHofXBc where GsiEffectiveQC is 0, channels "
        f"{listed([str(c) for c in observations['channels']])} (those that nearly every location has), {observations['count']:,} of 9,238 locations; thinned "
        "to about 110 km before. The file has no scan lines, so that there is no stepwise thinning; `box` is the plain method to beat.", "")
    all_methods_table(run, shown, f"h = 200 km, E on the grid G{6 if QUICK else 7}, one thread, single runs. E of retaining nothing: "
                      f"{error_text(observations['of_retaining_nothing_at_observations']['mean_squared_k2'])} K² at the observations. "
                      f"{percent(observations['signal_free_share'])} of all are in signal-free areas.")
    labels = [label for label in ("box", "top_down_clustering", *EEA) if label in run.labels()]
    plots.curves([(runs[h].json, measure, labels, f"h = {h} km") for measure in ("error_at_observations", "error_on_grid") for h in runs],
                 PICTURES / "real.png", "Real innovations: AMSU-A on NOAA-19", 3)
    picture("real.png", "Errors on real innovations over the number retained")
    where = "error_at_observations"
    for h, each in runs.items():
        lines = [f"EEA has less E than box {holds_at(counts, less(each, 'eea', 'box', where))}",
                 f"insertion less than removal {holds_at(counts, less(each, 'top_down_eea', 'eea', where))}",
                 "on the grid, insertion less than removal " + holds_at(counts, less(each, "grid_top_down_eea", "grid_eea", "error_on_grid"))]
        if "top_down_clustering" in each.labels():
            lines.insert(1, f"clustering less than box {holds_at(counts, less(each, 'top_down_clustering', 'box', where))}")
        say(f"- h = {h} km: " + "; ".join(lines) + ".")
    say("")
    refinement(run, shown, False)
    return runs


# ---- growth, independence --------------------------------------------------------------------------------------------


def growth():
    sizes = [3000, 10000] if QUICK else [27367, 100000, 300000, 1000000]
    say("## Growth", "",
        "Observations on a spiral over the whole Earth, one in ten retained, h such that each has about 45 neighbours within 3h; two threads. `eea`.", "")
    rows, series = [], {"eea, full": ([], []), "eea, lazy": ([], [])}
    largest = None
    for n in sizes:
        bandwidth = round(math.sqrt(45 * 4 / n) * 6371 / 3, 2)
        configuration = section("synthetic", source="spiral", count=n) + section("run", threads=2) + section(
            "evaluate", counts=[round(n / 10)], bandwidth_km=bandwidth, errors=False, repetitions=3 if n < 200000 and not QUICK else 1)
        run = Evaluation(f"growth-{n}", configuration + variant("eea", "eea, full") + variant("eea", "eea, lazy", update="lazy"))
        for label, (numbers, seconds) in series.items():
            cost = run.cost(label, round(n / 10))
            numbers.append(n)
            seconds.append(float(cost["seconds_median"]))
            gibibytes = float(cost["peak_memory_bytes"]) / 2**30 if cost["peak_memory_bytes"] else math.nan
            rows.append([f"{n:,}", f"{bandwidth:g}", label, seconds_text(seconds[-1]), seconds_text(float(cost["cpu_seconds_median"])),
                         significant(gibibytes)])
            if label == "eea, full":
                largest = (n, seconds[-1], gibibytes)
    table(["observations", "h, km", "", "s", "processor s", "GiB"], rows)
    plots.growth(series, PICTURES / "growth.png", "Time over the number of observations, 45 neighbours each")
    picture("growth.png", "Time over the number of observations")
    for label, (numbers, seconds) in series.items():
        exponent = slope([math.log(n) for n in numbers], [math.log(s) for s in seconds])
        say(f"- {label}: the time grows as the number to the power {exponent:.2f} (least squares; asked for: 1.1 at most"
            + (", reached)." if exponent <= 1.1 else ", not reached)."))
    n, seconds, gibibytes = largest
    say(f"- {n:,} to {round(n / 10):,}, full updating: {seconds:.1f} s and {gibibytes:.2f} GiB"
        + ("" if QUICK else f" (asked for: under 30 s, {'reached' if seconds < 30 else 'not reached'}; under 4 GiB, "
           f"{'reached' if gibibytes < 4 else 'not reached'})") + ".", "")


def slope(x, y):
    mean_x, mean_y = sum(x) / len(x), sum(y) / len(y)
    return sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y)) / sum((a - mean_x) ** 2 for a in x)


def independence():
    say("## The same whatever the threads and the order", "")
    body = "".join(variant(method) for method in METHODS)
    body += "".join(variant(m, f"{m}, lazy", update="lazy") for m in EEA)
    body += "".join(variant("eea", f"eea + {label}", **keys) for label, keys in REFINED if "effort" not in keys and set(keys) <= METHODS["eea"])
    rows = []
    for name, head, files, count in (("made-up", ORBITS, [], MIDDLE), ("real", real_preparation(), [REAL], 1000)):
        level = 6
        options = section("evaluate", counts=[count], bandwidth_km=100 if name == "made-up" else 200, level=level, list_retained=True)
        one, two, shuffled = (
            Evaluation(f"independence-{name}-{case}", head + section("run", threads=threads) + options + body, files, words)
            for case, threads, words in (("1", 1, []), ("2", 2, []), ("shuffled", 2, ["--shuffle", "7"])))
        same_threads = check(one.json_bytes == two.json_bytes and one.csv_bytes == two.csv_bytes, f"{name}: 1 and 2 threads agree")
        same_order = check(two.json_bytes == shuffled.json_bytes, f"{name}: shuffled input agrees")
        differing = sorted({a["variant"] for a, b, c in zip(one.json["results"], two.json["results"], shuffled.json["results"]) if not a == b == c})
        rows.append([f"{name}, to {count:,}", len(one.labels()), "yes" if same_threads else "NO", "yes" if same_order else "NO", listed(differing) if differing else ""])
    table(["set", "variants", "1 and 2 threads: same bytes", "input shuffled: same bytes", "variants that differ"], rows)
    say("Compared are the JSON files of `thin evaluate`: every retained index, and every measure to its last digit.", "")


# ---- the page --------------------------------------------------------------------------------------------------------


def main():
    if not REAL.exists():
        sys.exit(f"no observations at {REAL}; set THIN_SHARED_DATA")
    began = time.monotonic()
    for folder in (WORK, PICTURES):
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
    METHODS.update(methods())
    say("# Thinning methods compared", "",
        f"Written by `scripts/reproduce thinning`{' --quick: a trial, not the figures' if QUICK else ''}. Machine: {os.cpu_count()} cores, "
        f"{platform.machine()}. Seconds are wall-clock.", "",
        "Thesis: chapter 6, 27,367 observations of AMSU-A on NOAA-15 and NOAA-16 over sea, eight channels, innovations within 1 K. Ours of the same "
        "kind are made up on the same orbits (`thin evaluate` with `[synthetic] source = \"orbits\"`); their weather is not the thesis's, so that "
        "values of E can't be compared with its figures: orderings can.", "")
    table_6_1()
    all_methods()
    figure_6_8(stepwise_count())
    figures_6_9_and_6_10()
    figure_6_11()
    figure_6_16()
    real_innovations()
    growth()
    independence()
    for image in PICTURES.glob("*.png"):
        check(image.stat().st_size < 250_000, f"{image.name} is small enough to keep")
    PAGE.write_text("\n".join(page).rstrip() + "\n", encoding="utf-8")
    print(f"written: {PAGE} after {time.monotonic() - began:.0f} s")
    if problems:
        sys.exit(f"{len(problems)} checks failed")


if __name__ == "__main__":
    main()
