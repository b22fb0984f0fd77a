"""Pictures of scripts/results/evidence.py."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402 (the backend must be chosen first)

import evaluation_plots  # noqa: E402
from evaluation_plots import save, thousands  # noqa: E402

evaluation_plots.MOST_BYTES = 120_000

COLOURS = ["#1f5fa8", "#5b8c5a", "#2a9d8f", "#6d4c41", "#c77dba", "#7a9a01", "#4c4c9d", "#8c564b", "#00798c", "#d4b106",
           "#e07a9a", "#5c8d89", "#444444", "#b08d57", "#777777"]


def style(label, place):
    """A set has its look in every picture: black for those to compare with, thick for the product's own method."""
    if label in ("farthest_point", "random", "all"):
        return {"color": "#222222", "linestyle": {"farthest_point": "--", "random": ":", "all": "-."}[label], "linewidth": 1.6}
    if label.startswith("analysis"):
        return {"color": "#d00000" if label == "analysis" else "#ff8c1a", "linewidth": 2.6, "marker": "o", "markersize": 5}
    return {"color": COLOURS[place % len(COLOURS)], "linewidth": 1.3,
            "marker": "os^Dv<>P"[place % 8], "markersize": 4.5}


def tidy(axes):
    axes.grid(color="#e3e6e8", linewidth=0.6)
    axes.set_axisbelow(True)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)


def curves(panels, numbers, across, along, title, output, logarithmic=True):
    """panels: (title, label -> (values, half widths))."""
    figure, slots = plt.subplots(1, len(panels), figsize=(5.2 * len(panels), 5.4), squeeze=False, sharey=True)
    for axes, (name, lines) in zip(slots.flat, panels):
        for place, (label, (values, widths)) in enumerate(lines.items()):
            axes.plot(numbers, values, label=label, **style(label, place))
            axes.fill_between(numbers, [v - w for v, w in zip(values, widths)], [v + w for v, w in zip(values, widths)],
                              color=style(label, place)["color"], alpha=0.08, linewidth=0)
        if logarithmic:
            axes.set_xscale("log")
            axes.set_xticks(numbers, [thousands(n, 0) for n in numbers])
            axes.minorticks_off()
        axes.set_xlabel(across)
        axes.set_title(name, loc="left", fontsize=11)
        tidy(axes)
    slots[0][0].set_ylabel(along)
    handles, labels = slots[0][0].get_legend_handles_labels()
    rows = -(-len(labels) // 3)
    figure.legend(handles, labels, loc="lower center", ncol=3, fontsize=8.5, frameon=False)
    figure.suptitle(title, fontsize=13, x=0.01, ha="left")
    figure.tight_layout(rect=(0, 0.04 * rows + 0.01, 1, 1))
    save(figure, output)


def bars(groups, along, title, output):
    """groups: name -> label -> (value, half width)."""
    labels = list(dict.fromkeys(label for group in groups.values() for label in group))
    figure, axes = plt.subplots(figsize=(11, 4.8))
    width = 0.85 / len(labels)
    for place, label in enumerate(labels):
        have = [(i, group[label]) for i, group in enumerate(groups.values()) if label in group]
        axes.bar([i + (place - (len(labels) - 1) / 2) * width for i, _ in have], [v for _, (v, _) in have], width,
                 yerr=[w for _, (_, w) in have], color=style(label, place)["color"], label=label, error_kw={"elinewidth": 0.8})
    axes.set_xticks(range(len(groups)), list(groups))
    axes.axhline(0, color="#222222", linewidth=0.8)
    axes.set_ylabel(along)
    axes.set_title(title, loc="left", fontsize=12)
    axes.legend(fontsize=8.5, frameon=False, ncol=2)
    tidy(axes)
    figure.tight_layout()
    save(figure, output)
