"""Measures emap against the thesis and today's coders, and writes docs/results/compression.md with its pictures. Called by
scripts/reproduce compression [PART...]; parts: partition, fit, distribution, points-MODEL, meshes-MODEL, curves-MODEL, no-floor,
pictures, rival, speed (all of them unless named).
Each part's section is kept under build/results/compression with the commit that it measured; the page is put together once
all of them are there."""

import csv
import functools
import json
import os
import pathlib
import platform
import re
import shutil
import statistics
import subprocess
import sys
import time

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402 (the backend must be chosen first)
import numpy as np  # noqa: E402
import parts  # noqa: E402
from parts import check  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
BIN = ROOT / "build/release/bin"
BASE = ROOT / "build/results/compression"
WORK = BASE  # of each part a folder of its own
SHARED = pathlib.Path(os.environ.get("THIN_SHARED_DATA", ROOT / "../shared/data")).resolve()
MODELS = SHARED / "models"
TOOL = SHARED.parent / "tools/surfdist.cpp"
PAGE = ROOT / "docs/results/compression.md"
PICTURES = ROOT / "docs/results"

# Bits per point or vertex, and dB, of the thesis's tables 4.2 and 4.3 (Igea at 1.51 by the definition of the PSNR).
THESIS_POINTS = {"igea": [(0.50, 72.6), (1.51, 82.4), (3.01, 87.1)], "dragon": [(0.29, 57.5), (1.55, 79.7), (3.05, 84.2)]}
THESIS_MESH = {"dragon": [(0.35, 68.3), (0.95, 80.8), (2.05, 86.8)]}
CURVE_PSNR = {
    "igea": [65, 70, 75, 80, 85],
    "bunny": [60, 65, 70, 75, 80, 85],
    "dragon": [65, 70, 75, 80, 85],
    "rockerarm": [65, 70, 75, 80, 85],
}
# No floor: 95 dB by surfdist. The encoder's own samples are others, hence the margin; resolutions are named to save trials.
HIGH_PSNR = {"igea": (95.5, 2400), "bunny": (95.7, 2400), "dragon": (95.4, 3400)}
# Bits per vertex, and the thesis's E_rms for Venus: even split, image-based, full distance (table 4.1).
DISTRIBUTION_BITS = {0.33: (10.9, 9.59, 7.95), 0.53: (5.39, 4.92, 4.60), 0.72: (3.37, 3.26, 3.22), 1.02: (2.31, 2.32, 2.30),
                     2.01: (1.15, 1.13, 1.10)}
BASELINE_PSNR = {"igea": [70, 80], "bunny": [70, 80], "dragon": [75]}
PICTURE_BITS = {"igea": [0.1, 0.38], "dragon": [0.15, 0.95]}
RIVAL_PSNR = {"igea": [70, 80], "bunny": [70, 80], "dragon": [75]}
INK = {"contexts": "#0b5394", "baseline": "#6fa8dc", "lt+draco": "#cc4125", "draco": "#999999", "gpcc_octree": "#b4a7d6",
       "gltfpack-cz+xz": "#f1c232", "thesis": "#38761d"}


def run(*words):
    began = time.perf_counter()
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False)
    said = " ".join(pathlib.Path(word).name if isinstance(word, pathlib.Path) else str(word) for word in words)
    check(done.returncode == 0, said + ": " + done.stderr.strip()[-300:])
    return done.stdout, time.perf_counter() - began


def model(name):
    return MODELS / f"{name}.ply"


def vertex_count(name):
    with open(model(name), "rb") as file:
        return int(re.search(rb"element vertex (\d+)", file.read(2000)).group(1))


# ---- distance ----------------------------------------------------------------------------------------------------------


def build_surfdist():
    """The independent tool where it is at hand, else emap's own."""
    if not TOOL.is_file():
        return None
    program = BASE / "surfdist"
    if not program.is_file():
        run("g++", "-O3", "-std=c++17", "-pthread", TOOL, "-o", program)
    return program


def distance(original, decoded):
    """E_rms in 1e-4 of the diagonal, and PSNR."""
    if SURFDIST:
        out, _ = run(SURFDIST, original, decoded)
        found = re.search(r"Erms ([\d.]+) PSNR ([\d.]+)", out)
        return (float(found.group(1)), float(found.group(2))) if found else (float("nan"), float("nan"))
    said = json.loads(run(BIN / "emap", "compare", "--json", original, decoded)[0])
    return said["e_rms_1e4_diagonals"], said["psnr_db"]


# ---- emap --------------------------------------------------------------------------------------------------------------


def encode(name, *options, picture=None):
    """One line of a table: sizes, errors and seconds of one encoding and its decoding; for points, of the closed mesh too."""
    label = "-".join(str(option).strip("-") for option in options)
    packed, unpacked = WORK / f"{name}-{label}.emap", WORK / f"{name}-{label}.ply"
    said, encode_seconds = run(BIN / "emap", "encode", model(name), packed, "--quiet", *options)
    if not packed.is_file():
        return None
    told, _ = run(BIN / "emap", "decode", packed, unpacked, "--times")
    stream, surface = map(float, re.search(r"stream ([\d.]+) s, surface ([\d.]+) s", told).groups())
    open_edges = re.search(r"(\d+) open edges", told)
    info = json.loads(run(BIN / "emap", "info", "--json", packed)[0])
    error, psnr = distance(model(name), unpacked)
    size = packed.stat().st_size
    mesh_psnr, mesh_edges = psnr, int(open_edges.group(1)) if open_edges else None
    if open_edges is None:
        told, _ = run(BIN / "emap", "decode", packed, unpacked, "--mesh")
        mesh_psnr, mesh_edges = distance(model(name), unpacked)[1], int(re.search(r"(\d+) open edges", told).group(1))
    if picture:
        shutil.copyfile(unpacked, picture)
    unpacked.unlink()
    row = {
        "name": name, "bits": 8 * size / vertex_count(name), "bytes": size, "error": error, "psnr": psnr,
        "own_psnr": float(re.search(r"([\d.]+) dB", said).group(1)), "samples": info["samples"],
        "patches": len(info["patches"]), "mask_share": info["bytes"]["masks"] / size,
        "side_bits": 8 * (info["bytes"]["header"] + info["bytes"]["planes"]), "encode_seconds": encode_seconds,
        "decode_seconds": stream + surface, "open_edges": mesh_edges, "mesh_psnr": mesh_psnr,
    }
    print(f"  {name} {label}: {row['bits']:.3f} bits, {psnr:.2f} dB, {encode_seconds:.1f} s")
    return row


# ---- rivals ------------------------------------------------------------------------------------------------------------


def baselines(name):
    """codec -> [(bits per vertex, dB, parameters)] of baselines.csv, where it is at hand."""
    curves = {}
    path = MODELS / "baselines.csv"
    if path.is_file():
        with open(path, encoding="utf-8") as file:
            for row in csv.DictReader(file):
                if row["model"] == name:
                    curves.setdefault(row["codec"], []).append(
                        (float(row["bits_per_vertex"]), float(row["psnr_db"]), row["parameters"]))
    return curves


def bits_at(curve, psnr):
    """Of a rate-distortion curve, its logarithm interpolated; None outside it."""
    points = sorted({(point[1], point[0]) for point in curve})
    if not points or not points[0][0] <= psnr <= points[-1][0]:
        return None
    return float(np.exp(np.interp(psnr, [p for p, _ in points], [np.log(b) for _, b in points])))


def draco(source, packed, bits, *options):
    _, seconds = run("draco_encoder", "-i", source, "-o", packed, "-qp", bits, "-cl", 10, *options)
    unpacked = packed.with_suffix(".ply")
    _, decode_seconds = run("draco_decoder", "-i", packed, "-o", unpacked)
    return packed.stat().st_size, unpacked, seconds, decode_seconds


def rival_row(name, psnr):
    """Simplification by CGAL, then Draco, with the parameters that baselines.csv found best near this PSNR."""
    candidates = [point for point in baselines(name).get("lt+draco", []) if point[1] >= psnr]
    if not candidates:
        return None
    _, _, parameters = min(candidates)
    count, quantisation = map(int, re.fullmatch(r"N=(\d+);qp=(\d+)", parameters).groups())
    simplified = WORK / f"{name}-lt-{count}.ply"
    _, simplify_seconds = run(BIN / "simplify_mesh", model(name), simplified, count)
    size, unpacked, seconds, decode_seconds = draco(simplified, WORK / f"{name}-lt-{count}.drc", quantisation)
    error, found = distance(model(name), unpacked)
    print(f"  {name} lt+draco {parameters}: {8 * size / vertex_count(name):.3f} bits, {found:.2f} dB")
    return {"name": name, "parameters": parameters, "bits": 8 * size / vertex_count(name), "error": error, "psnr": found,
            "encode_seconds": simplify_seconds + seconds, "decode_seconds": decode_seconds}


# ---- parts of the page -------------------------------------------------------------------------------------------------


def picture_of_partition(name, coloured):
    """The coloured mesh from one side, as points shaded by nothing but their patch's colour."""
    with open(coloured, "rb") as file:
        data = file.read()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    header = data[:end].decode()
    vertices, faces = (int(re.search(rf"element {kind} (\d+)", header).group(1)) for kind in ("vertex", "face"))
    positions = np.frombuffer(data, "<f4", 3 * vertices, end).reshape(-1, 3)
    kind = np.dtype([("n", "u1"), ("i", "<i4", 3), ("c", "u1", 3)])
    triangles = np.frombuffer(data, kind, faces, end + 12 * vertices)
    corners = positions[triangles["i"]]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    towards = normals[:, 2] > 0
    light = normals[towards, 2] / np.maximum(np.linalg.norm(normals[towards], axis=1), 1e-30)
    centres = corners[towards].mean(axis=1)
    order = np.argsort(centres[:, 2])
    colours = triangles["c"][towards] / 255 * (0.45 + 0.55 * light[:, None])
    figure = plt.figure(figsize=(6, 6), dpi=100)
    axes = figure.add_axes([0, 0, 1, 1])
    axes.scatter(centres[order, 0], centres[order, 1], s=max(0.6, 300000 / faces), c=colours[order], linewidths=0)
    axes.set_aspect("equal")
    axes.axis("off")
    target = PICTURES / f"partition-{name}.png"
    figure.savefig(target, metadata={"Software": None})
    plt.close(figure)
    return target.name


def partition_part():
    print("partitions")
    page = ["## Partitions (table 3.2)", "", "Aperture 80 degrees, strict: every patch one sheet over its plane. J is the error of "
            "equation 3.4 over the area; the thesis's numbers are for points.", "",
            "| model | method | patches | J | seconds | thesis: patches, J |", "| --- | --- | --- | --- | --- | --- |"]
    thesis = {("igea", "split-merge"): "14, 0.42", ("igea", "gla"): "7, 0.32", ("dragon", "split-merge"): "367, 0.56",
              ("dragon", "gla"): "150, 0.22"}
    pictures = []
    for name in ("igea", "dragon", "bunny", "rockerarm", "screwdriver"):
        for method in ("split-merge", "gla"):
            coloured = WORK / f"{name}-{method}.ply"
            out, _ = run(BIN / "emap", "partition", model(name), coloured, "--partition", method)
            found = re.search(r"(\d+) patches, J ([\d.]+)", out)
            seconds = re.search(r"([\d.]+) s\s*$", out)
            if found:
                page.append(f"| {name} | {method} | {found.group(1)} | {found.group(2)} | {seconds.group(1)} | "
                            f"{thesis.get((name, method), '')} |")
            if method == "gla" and name in ("igea", "dragon") and coloured.is_file():
                pictures.append(picture_of_partition(name, coloured))
            coloured.unlink(missing_ok=True)
    return page + [""] + [f"![{picture}]({picture})" for picture in pictures] + [""]


def fit_part():
    print("least squares")
    page = ["## Least squares (table 3.1)", "", "E_rms of the resampled, closed mesh, nothing coded; in brackets without the fit. "
            "The thesis: Venus 1.97 (2.35), 0.86 (1.12), 0.56 (0.70).", "", "| model | 1/mu = 0.6 | 1.0 | 1.4 |", "| --- | --- | --- | --- |"]
    for name in ("igea", "bunny", "rockerarm"):
        cells = []
        for resolution in (0.6, 1.0, 1.4):
            errors = []
            for options in (["--fit"], []):
                resampled = WORK / f"{name}-resampled.ply"
                run(BIN / "emap", "resample", model(name), resampled, "--mu", 1 / resolution, *options)
                errors.append(distance(model(name), resampled)[0])
            cells.append(f"{errors[0]:.2f} ({errors[1]:.2f})")
        page.append(f"| {name} | " + " | ".join(cells) + " |")
    return page + [""]


def distribution_part():
    print("distribution of bits")
    page = ["## Sharing out the bits (table 4.1)", "", "Igea as a mesh, coder `baseline`: E_rms where every map gets as many bits a sample "
            "(even), where the elevations' squared error falls most (image), and where the distance to the surface does, "
            "estimated from the maps' slopes (surface; the thesis measures it), and the bits that whole passes "
            "come to. The thesis's model, Venus, is not at hand.", "",
            "| bits per vertex, at most | even | image | surface | thesis, Venus: even, image, full |", "| --- | --- | --- | --- | --- |"]
    for bits, thesis in DISTRIBUTION_BITS.items():
        rows = [encode("igea", "--bpp", bits, "--coder", "baseline", "--distribution", kind, "--one-partition", "--resolution",
                       round(330 * (bits / 0.33) ** 0.5)) for kind in ("even", "image", "surface")]
        cells = ["cannot" if row is None else f"{row['error']:.2f} at {row['bits']:.3f}" for row in rows]
        page.append(f"| {bits} | " + " | ".join(cells) + " | " + ", ".join(map(str, thesis)) + " |")
    return page + [""]


THESIS_HEAD = ["| model | coder | bits per {} | patches | samples | masks, % | E_rms | dB | dB of the mesh | decoding, s | open edges | "
               "thesis, dB |", "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |"]


def thesis_rows(kind, name, table):
    options = ["--points"] if kind == "points" else []
    for rate, psnr in table[name]:
        for coder in ("contexts", "baseline"):
            row = encode(name, "--bpp", rate, "--coder", coder, *options)
            if row is None:
                yield f"| {name} | {coder} | {rate} | cannot | | | | | | | | {psnr} |"
                continue
            if coder == "contexts":
                check(row["psnr"] >= psnr, f"{name} as {kind} at {rate}: {row['psnr']:.2f} dB, the thesis has {psnr}")
            open_edges = "" if row["open_edges"] is None else row["open_edges"]
            yield (f"| {name} | {coder} | {row['bits']:.3f} | {row['patches']} | {row['samples']} | {100 * row['mask_share']:.1f} | "
                   f"{row['error']:.2f} | **{row['psnr']:.2f}** | {row['mesh_psnr']:.2f} | "
                   f"{row['decode_seconds']:.2f} | {open_edges} | {psnr} |")


def points_part(name):
    print(f"the thesis's rates, {name} as points")
    return [f"## Points (table 4.2): {name}", "", "The vertices alone are encoded, every byte of the file counted; the decoded points are "
            "compared with the original mesh by `surfdist`, which takes them for planes through the nearest ones; then the closed "
            "mesh of the same file, which is the surface that other coders have.", "", THESIS_HEAD[0].format("point"), THESIS_HEAD[1],
            *thesis_rows("points", name, THESIS_POINTS), ""]


def meshes_part(name):
    print(f"the thesis's rates, {name} as a mesh")
    return [f"## Meshes (table 4.3): {name}", "", "Open edges are those of the decoded, closed mesh that have one triangle.", "",
            THESIS_HEAD[0].format("vertex"), THESIS_HEAD[1], *thesis_rows("mesh", name, THESIS_MESH), ""]


def draw_curves(name, curves):
    figure, axes = plt.subplots(figsize=(8, 5.5), dpi=100)
    for codec in ("lt+draco", "gltfpack-cz+xz", "draco", "gpcc_octree"):
        points = sorted((bits, psnr) for bits, psnr, _ in baselines(name).get(codec, []) if psnr >= 55)
        if points:
            axes.plot(*zip(*points), "-", lw=1.3, color=INK[codec], label=codec)
    for codec, points in curves.items():
        if points:
            axes.plot(*zip(*sorted(points)), "o-", ms=4, lw=1.8, color=INK[codec], label=f"emap, {codec}")
    if name in THESIS_MESH:
        axes.plot(*zip(*THESIS_MESH[name]), "s", ms=6, color=INK["thesis"], label="thesis, mesh")
    axes.set(xscale="log", xlabel="bits per vertex", ylabel="PSNR, dB", title=name)
    axes.grid(alpha=0.3, which="both")
    axes.legend(fontsize=9)
    figure.tight_layout()
    target = PICTURES / f"curves-{name}.png"
    figure.savefig(target, metadata={"Software": None})
    plt.close(figure)
    return target.name


def no_floor_part():
    page = ["## No floor", "", "95 dB by `surfdist`, asked for with a margin, for the encoder's own samples are others.", "", "| model | dB | bits per vertex | patches | open edges | encoding, s |",
            "| --- | --- | --- | --- | --- | --- |"]
    for name, (psnr, resolution) in HIGH_PSNR.items():
        row = encode(name, "--psnr", psnr, "--resolution", resolution, "--one-partition")
        if check(row is not None, f"{name}: {psnr} dB are not reached"):
            check(row["psnr"] >= 95, f"{name}: {row['psnr']:.2f} dB where 95 were to be shown")
            page.append(f"| {name} | **{row['psnr']:.2f}** | {row['bits']:.2f} | {row['patches']} | {row['open_edges']} | "
                        f"{row['encode_seconds']:.0f} |")
    return page + [""]


def shaded(axes, path):
    """A mesh from the front, its triangles as points shaded by their slope."""
    with open(path, "rb") as file:
        data = file.read()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    header = data[:end].decode()
    vertices, faces = (int(re.search(rf"element {kind} (\d+)", header).group(1)) for kind in ("vertex", "face"))
    numbers = len(re.findall(r"property float", header))
    positions = np.frombuffer(data, "<f4", numbers * vertices, end).reshape(vertices, numbers)[:, :3]
    triangles = np.frombuffer(data, np.dtype([("n", "u1"), ("i", "<i4", 3)]), faces, end + 4 * numbers * vertices)["i"]
    corners = positions[triangles].astype(float)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    towards = normals[:, 2] > 0
    light = normals[towards] @ (0.35, 0.35, 0.87) / np.maximum(np.linalg.norm(normals[towards], axis=1), 1e-30)
    centres = corners[towards].mean(axis=1)
    order = np.argsort(centres[:, 2])
    extent = positions.max(axis=0) - positions.min(axis=0)
    side = 230 * np.sqrt(np.linalg.norm(normals[towards], axis=1) / 2) / max(extent[:2])
    axes.scatter(centres[order, 0], centres[order, 1], s=np.maximum(0.3, (1.5 * side[order]) ** 2),
                 c=np.clip(0.25 + 0.7 * light[order], 0, 1), cmap="gray", vmin=0, vmax=1, linewidths=0)
    axes.set_aspect("equal")
    axes.axis("off")


def pictures_part():
    page = ["## What it looks like", ""]
    for name, rates in PICTURE_BITS.items():
        figure, panels = plt.subplots(1, len(rates) + 1, figsize=(3.4 * (len(rates) + 1), 3.6), dpi=90)
        shaded(panels[0], model(name))
        panels[0].set_title("original", fontsize=9)
        for panel, rate in zip(panels[1:], rates):
            decoded = WORK / f"{name}-picture.ply"
            row = encode(name, "--bpp", rate, picture=decoded)
            if row is None:
                continue
            shaded(panel, decoded)
            panel.set_title(f"{row['bits']:.2f} bits per vertex, {row['psnr']:.1f} dB", fontsize=9)
        figure.tight_layout()
        figure.savefig(PICTURES / f"decoded-{name}.png", metadata={"Software": None})
        plt.close(figure)
        page += [f"![{name}](decoded-{name}.png)", ""]
    return page


def curves_part(name):
    print("rate and distortion of", name)
    page = [f"## Rate and distortion: {name}", "", "A mesh; bits per vertex, every byte counted, for the PSNR that was asked for; the rival "
            "(Lindstrom-Turk simplification + Draco, best parameters per rate) interpolated in baselines.csv to the PSNR that was "
            "measured.", "", "| asked, dB | coder | dB | bits per vertex | rival | difference | patches | open edges | encoding, s | decoding, s |",
            "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |"]
    curves = {"contexts": [], "baseline": []}
    jobs = [("contexts", psnr) for psnr in CURVE_PSNR[name]] + [("baseline", psnr) for psnr in BASELINE_PSNR.get(name, [])]
    for coder, psnr in jobs:
        row = encode(name, "--psnr", psnr, "--coder", coder)
        if row is None:
            page.append(f"| {psnr} | {coder} | not reached | | | | | | | |")
            continue
        curves[coder].append((row["bits"], row["psnr"]))
        rival = bits_at(baselines(name).get("lt+draco", []), row["psnr"])
        page.append(f"| {psnr} | {coder} | {row['psnr']:.2f} | {row['bits']:.3f} | " +
                    (f"{rival:.3f} | {100 * (row['bits'] / rival - 1):+.0f} % | " if rival else " | | ") +
                    f"{row['patches']} | {row['open_edges']} | {row['encode_seconds']:.1f} | {row['decode_seconds']:.2f} |")
    return page + ["", f"![{name}]({draw_curves(name, curves)})", ""]


def rival_part():
    page = ["## The rival, run here", "", "| model | parameters | dB | bits per vertex | encoding, s | decoding, s |",
            "| --- | --- | --- | --- | --- | --- |"]
    for name, targets in RIVAL_PSNR.items():
        for psnr in targets:
            if row := rival_row(name, psnr):
                page.append(f"| {name} | {row['parameters']} | {row['psnr']:.2f} | {row['bits']:.3f} | {row['encode_seconds']:.1f} | "
                            f"{row['decode_seconds']:.3f} |")
    return page + [""]


def speed_part():
    print("speed")
    page = ["## Speed (table 4.4), side by side with Draco", "", "Dragon, 437,645 vertices; wall-clock seconds of whole processes; decoding "
            "without writing the PLY, best of three. The thesis: encoding about 160 s for the mesh, decoding 12 to 15 s; to points 1.2 s.", ""]
    packed = WORK / "dragon-speed.emap"
    page += ["| what | seconds | |", "| --- | --- | --- |"]
    for coder in ("contexts", "baseline"):
        _, seconds = run(BIN / "emap", "encode", model("dragon"), packed, "--bpp", 0.95, "--quiet", "--coder", coder)
        page.append(f"| emap encode --bpp 0.95, {coder} | {seconds:.1f} | |")
        check(seconds < 20, f"encoding Dragon takes {seconds:.1f} s")
        for kind in ("--points", "--mesh"):
            best, count = float("inf"), 0
            for _ in range(3):
                told, _ = run(BIN / "emap", "decode", packed, WORK / "dragon-speed.ply", kind, "--times")
                best = min(best, sum(map(float, re.search(r"stream ([\d.]+) s, surface ([\d.]+) s", told).groups())))
                count = int(re.search(r"(\d+) (points|vertices)", told).group(1))
            page.append(f"| emap decode {kind}, {coder} | {best:.3f} | {count} samples, {count / best / 1e6:.1f} M/s |")
    times = [draco(model("dragon"), WORK / "dragon-speed.drc", 11)[2:] for _ in range(3)]
    page.append(f"| draco_encoder, 11 bits, whole mesh | {statistics.median(t[0] for t in times):.2f} | |")
    page.append(f"| draco_decoder, with writing the PLY | {statistics.median(t[1] for t in times):.2f} | |")
    return page + [""]


PARTS = {"partition": partition_part, "fit": fit_part, "distribution": distribution_part,
         **{f"points-{name}": functools.partial(points_part, name) for name in THESIS_POINTS},
         **{f"meshes-{name}": functools.partial(meshes_part, name) for name in THESIS_MESH},
         **{f"curves-{name}": functools.partial(curves_part, name) for name in CURVE_PSNR},
         "no-floor": no_floor_part, "pictures": pictures_part, "rival": rival_part, "speed": speed_part}


def main():
    global SURFDIST, WORK
    if not MODELS.is_dir():
        sys.exit(f"no models at {MODELS}; set THIN_SHARED_DATA")
    named = parts.named_parts(sys.argv[1:], PARTS)
    BASE.mkdir(parents=True, exist_ok=True)
    SURFDIST = build_surfdist()
    for name in named:
        WORK = BASE / name
        shutil.rmtree(WORK, ignore_errors=True)
        WORK.mkdir(parents=True)
        parts.measure(name, PARTS[name], BASE, ROOT)
    heading = ["# Compression of scanned surfaces", "",
               f"Written by `scripts/reproduce compression`. Machine: {os.cpu_count()} cores, {platform.machine()}. E_rms in 1e-4 of the bounding "
               "box's diagonal; PSNR = 20 log10(diagonal / E_rms); distances by "
               + ("`surfdist`, an independent tool" if SURFDIST else "`emap compare`") + ", 200,000 samples each way.", ""]
    parts.write_page(PAGE, heading, PARTS, BASE)


SURFDIST = None

if __name__ == "__main__":
    main()
