"""Pictures of what `thin evaluate --json` wrote: the thesis's figures 6.8 to 6.13 and 6.16. Used by scripts/plots and by
scripts/results/thinning.py."""

import json
import pathlib

import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402 (the backend must be chosen first)
import matplotlib.ticker as ticker  # noqa: E402

DPI = 100
MOST_BYTES = 200_000  # pictures larger than this are reduced to 128 colours
EARTH_RADIUS_KM = 6371.0

MEASURES = {
    "error_at_observations": ("E at the observations, K²", True),
    "error_on_grid": ("E on the GME grid, K²", True),
    "signal_to_noise_at_observations": ("SNR at the observations, dB", False),
    "signal_to_noise_on_grid": ("SNR on the GME grid, dB", False),
}
# A method has its colour in every picture.
COLOURS = {
    "stepwise": "#7f7f7f",
    "box": "#b08d57",
    "top_down_clustering": "#d1741a",
    "eea": "#1f5fa8",
    "grid_eea": "#2a9d8f",
    "top_down_eea": "#a3262e",
    "grid_top_down_eea": "#c77dba",
}
OTHER_COLOURS = ["#4c4c9d", "#7a9a01", "#00798c", "#8c564b", "#d4b106", "#444444", "#e07a9a", "#5c8d89"]


def read(path):
    return json.loads(pathlib.Path(path).read_text(encoding="utf-8"))


def value_of(result, measure):
    if measure.startswith("signal_to_noise"):
        return result["error_at_observations" if measure.endswith("observations") else "error_on_grid"][
            "signal_to_noise_db"
        ]
    return result[measure]["mean_squared_k2"]


def curve(evaluation, label, measure):
    """Numbers retained, ascending, and the measure at each; numbers that come twice once."""
    points = {
        result["retained"]: value_of(result, measure)
        for result in evaluation["results"]
        if result["variant"] == label and value_of(result, measure) is not None
    }
    numbers = sorted(number for number in points if points[number] > 0 or not measure.startswith("error"))
    return numbers, [points[number] for number in numbers]


def save(figure, output):
    figure.savefig(output, dpi=DPI, metadata={"Software": None})
    plt.close(figure)
    if pathlib.Path(output).stat().st_size > MOST_BYTES:
        from PIL import Image

        with Image.open(output) as image:
            reduced = image.convert("RGB").quantize(128, dither=Image.Dither.NONE)
        reduced.save(output, optimize=True)


# ---- curves: figures 6.9 to 6.13 -------------------------------------------------------------------------------------


def style_of(label, evaluation, place):
    variants = {variant["label"]: variant for variant in evaluation["variants"]}
    method = variants[label]["method"]
    alone = sum(variant["method"] == method for variant in evaluation["variants"]) == 1
    lazy = variants[label].get("options", {}).get("update") == '"lazy"'
    colour = COLOURS.get(method) if alone or label == method or lazy else None
    return {
        "color": colour or OTHER_COLOURS[place % len(OTHER_COLOURS)],
        "linestyle": (0, (4, 2)) if lazy else "-",
        "marker": "os^Dv<>P"[place % 8],
        "markersize": 4.5,
        "linewidth": 1.7,
    }


def thousands(value, _position):
    return f"{value:,.0f}"


def draw_curves(axes, evaluation, measure, labels=None, title=None, names=None):
    """One line for each variant that has results."""
    have = {result["variant"] for result in evaluation["results"]}
    for place, variant in enumerate(evaluation["variants"]):
        label = variant["label"]
        if label in have and (labels is None or label in labels):
            numbers, values = curve(evaluation, label, measure)
            axes.plot(numbers, values, label=(names or {}).get(label, label), **style_of(label, evaluation, place))
    text, logarithmic = MEASURES[measure]
    if logarithmic:
        axes.set_yscale("log")
        axes.yaxis.set_major_locator(ticker.LogLocator(base=10, subs=(1, 2, 5)))
        axes.yaxis.set_major_formatter(ticker.FuncFormatter(lambda value, _position: f"{value:g}"))
        axes.yaxis.set_minor_formatter(ticker.NullFormatter())
    axes.set_xscale("log")
    axes.xaxis.set_major_locator(ticker.LogLocator(base=10, subs=(1, 2, 5)))
    axes.xaxis.set_major_formatter(ticker.FuncFormatter(thousands))
    axes.xaxis.set_minor_formatter(ticker.NullFormatter())
    axes.tick_params(labelsize=8.5)
    axes.set_xlabel("retained observations")
    axes.set_ylabel(text)
    axes.grid(which="both", color="#e3e6e8", linewidth=0.6)
    axes.set_axisbelow(True)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    if title:
        axes.set_title(title, loc="left", fontsize=11)


def curves(panels, output, title, columns):
    """panels: (evaluation, measure, labels or None, title); drawn row by row."""
    rows = -(-len(panels) // columns)
    figure, slots = plt.subplots(rows, columns, figsize=(4.9 * columns, 3.7 * rows + 0.5), squeeze=False)
    for slot, (evaluation, measure, labels, name) in zip(slots.flat, panels):
        draw_curves(slot, evaluation, measure, labels, name)
    for slot in slots.flat[len(panels):]:
        slot.set_visible(False)
    # One legend below where all panels show the same lines, else one each.
    handles = [slot.get_legend_handles_labels() for slot in slots.flat[: len(panels)]]
    shared = len({tuple(labels) for _, labels in handles}) == 1
    if shared:
        across = min(len(handles[0][1]), max(2, round(1.9 * columns)))
        below = 0.24 * -(-len(handles[0][1]) // across) / figure.get_figheight()
        figure.legend(*handles[0], loc="lower center", ncol=across, fontsize=9, frameon=False)
    else:
        below = 0
        for slot in slots.flat[: len(panels)]:
            slot.legend(fontsize=8.5, frameon=False)
    figure.suptitle(title, fontsize=13, x=0.01, ha="left")
    figure.tight_layout(rect=(0, below, 1, 1))
    save(figure, output)


# ---- densities: figure 6.8 -------------------------------------------------------------------------------------------


def density(evaluation, labels, output, title):
    """A map for each variant of how many more it retains in a box than the reference does."""
    import cartopy.crs as ccrs

    from coastlines import coastlines

    results = [r for label in labels for r in evaluation["results"] if r["variant"] == label and "boxes" in r]
    if not results:
        raise ValueError("no density differences in it: set list_boxes, and a reference that has results")
    reference = evaluation["configuration"]["evaluate.reference"].strip('"')
    box_km = float(evaluation["configuration"]["evaluate.box_km"])
    figure = plt.figure(figsize=(10, 4.9 * len(results) + 0.9))
    colours = plt.get_cmap("RdBu_r").resampled(9)
    grid = figure.add_gridspec(
        len(results) + 1, 1, height_ratios=[1] * len(results) + [0.035], left=0.02, right=0.98, top=0.94, bottom=0.065,
        hspace=0.12,
    )
    for row, result in enumerate(results):
        axes = figure.add_subplot(grid[row], projection=ccrs.Robinson())
        axes.set_global()
        axes.add_geometries(coastlines(), ccrs.PlateCarree(), facecolor="#eceae4", edgecolor="#8a8a8a", linewidth=0.35)
        boxes = {name: np.array(column) for name, column in result["boxes"].items()}
        order = np.argsort(np.abs(boxes["difference"]))
        points = axes.scatter(
            boxes["longitude_deg"][order], boxes["latitude_deg"][order], c=boxes["difference"][order], cmap=colours,
            vmin=-4.5, vmax=4.5, s=4.6, marker="s", linewidths=0, transform=ccrs.PlateCarree(), zorder=2,
        )
        axes.set_title(f"{result['variant']} less {reference}: {result['retained']:,} retained", loc="left", fontsize=11)
    bar = figure.colorbar(points, cax=figure.add_subplot(grid[-1]), orientation="horizontal", extend="both",
                          ticks=range(-4, 5))
    bar.set_label(f"difference of the numbers retained in a box of {box_km:g} km by {box_km:g} km")
    figure.suptitle(title, fontsize=13, x=0.02, ha="left")
    save(figure, output)


# ---- places: figure 6.16 ---------------------------------------------------------------------------------------------


def places(panels, output, title, columns=4):
    """panels: (evaluation, label or None for the full set, title): where the observations of a small set lie."""
    columns = min(columns, len(panels))
    rows = -(-len(panels) // columns)
    figure, slots = plt.subplots(rows, columns, figsize=(3.35 * columns, 3.45 * rows + 1.0), squeeze=False)
    points = None
    for slot, (evaluation, label, name) in zip(slots.flat, panels):
        observations = evaluation["observations"]
        which = np.arange(observations["count"])
        if label is not None:
            which = np.array(next(r for r in evaluation["results"] if r["variant"] == label)["retained_indices"])
        to_km = EARTH_RADIUS_KM * np.pi / 180
        east, north = (np.array(observations[key])[which] * to_km for key in ("longitude_deg", "latitude_deg"))
        points = slot.scatter(east, north, c=np.array(observations["first_channel_k"])[which], cmap="coolwarm",
                              vmin=-1, vmax=1, s=1.2 if label is None else 5, linewidths=0)
        slot.set_aspect("equal")
        slot.set(xlim=(-510, 510), ylim=(-510, 510), xticks=(-500, 0, 500), yticks=(-500, 0, 500))
        slot.tick_params(labelsize=8)
        slot.set_facecolor("#f4f5f6")
        slot.set_title(name, fontsize=10.5, loc="left")
    for slot in slots.flat[len(panels):]:
        slot.set_visible(False)
    for slot in slots[:, 0]:
        slot.set_ylabel("north, km", fontsize=9)
    for slot in slots[-1]:
        slot.set_xlabel("east, km", fontsize=9)
    figure.suptitle(title, fontsize=13, x=0.01, ha="left")
    height = figure.get_figheight()
    figure.tight_layout(rect=(0, 0.65 / height, 1, 1))
    bar = figure.colorbar(points, cax=figure.add_axes((0.3, 0.5 / height, 0.4, 0.12 / height)), orientation="horizontal")
    bar.set_label("value, K", fontsize=9)
    bar.ax.tick_params(labelsize=8)
    save(figure, output)


# ---- growth ----------------------------------------------------------------------------------------------------------


def growth(series, output, title):
    """series: label -> (numbers of observations, seconds)."""
    figure, axes = plt.subplots(figsize=(6.2, 4.2))
    for place, (label, (numbers, seconds)) in enumerate(series.items()):
        colour = ["#1f5fa8", "#d1741a", "#2a9d8f", "#a3262e"][place % 4]
        axes.loglog(numbers, seconds, "o-", color=colour, label=label, linewidth=1.7, markersize=5)
        linear = [seconds[0] * number / numbers[0] for number in numbers]
        axes.loglog(numbers, linear, ":", color=colour, linewidth=1)
    axes.plot([], [], ":", color="#555555", label="in proportion to the first")
    axes.xaxis.set_major_formatter(ticker.FuncFormatter(thousands))
    axes.xaxis.set_major_locator(ticker.LogLocator(base=10, subs=(1, 3)))
    axes.set_xlabel("observations")
    axes.set_ylabel("seconds")
    axes.grid(which="both", color="#e3e6e8", linewidth=0.6)
    axes.legend(frameon=False, fontsize=9)
    axes.set_title(title, loc="left", fontsize=12)
    figure.tight_layout()
    save(figure, output)
