"""Draws surfaces in every mode and measures them against rays, against each other and against the thesis, and writes
docs/results/rendering.md with its pictures. Called by scripts/reproduce rendering [--quick] [PART...]; parts: maps,
accuracy-MODEL, sphere, rates, levels, figures, page (all of them unless named).
Each part's section is kept under build/results/rendering with the commit that it measured; the page is put together once
all of them are there. Parts but `maps` draw the files that `maps` encoded."""

import functools
import json
import os
import pathlib
import platform
import struct
import subprocess
import sys
import zlib

import numpy as np
import parts
from parts import check
from PIL import Image

ROOT = pathlib.Path(__file__).resolve().parents[2]
BIN = ROOT / "build/release/bin"
WORK = ROOT / "build/results/rendering"
SHARED = pathlib.Path(os.environ.get("THIN_SHARED_DATA", ROOT / "../shared/data")).resolve()
MODELS = SHARED / "models"
PAGE = ROOT / "docs/results/rendering.md"
PICTURES = ROOT / "docs/results/rendering"
# The sphere's reflections show errors of its elevations, so that it is coded finely.
ENCODINGS = {"sphere": ["--psnr", 100, "--resolution", 1149], "bunny": ["--psnr", 75], "igea": ["--psnr", 80],
             "dragon": ["--bpp", 0.95, "--resolution", 715],
             # These, and the Dragon: about as many samples as the model has vertices, to be compared with its plain mesh.
             "bunny-even": ["--psnr", 65, "--resolution", 222], "igea-even": ["--psnr", 76, "--resolution", 406]}
MODELS_DRAWN = ["sphere", "bunny", "igea", "dragon"]
# Level of detail: the sphere at about the thesis's number of splats.
LEVELS = {"sphere": 3}
CAMERA = "30,15,2"
CLOSE_UP = '{"azimuth": 70, "elevation": 10, "distance": 0.8, "field_of_view": 9, "target": [-0.27, 0.2, 0.05]}'
MODES = {
    "mesh": ["--mode", "mesh"],
    "splats": ["--mode", "splats"],
    "splats-blended": ["--mode", "splats-blended"],
    "splats-interpolated": ["--mode", "splats-interpolated"],
}
WAYS = {
    "mesh": MODES["mesh"],
    "mesh, overlapping patches": ["--mode", "mesh", "--overlap"],
    "splats": MODES["splats"],
    "splats-blended": MODES["splats-blended"],
    "splats-interpolated, direct": ["--mode", "splats-interpolated", "--direct"],
    "splats-interpolated, corrected": MODES["splats-interpolated"],
    "the same in one pass": ["--mode", "splats-interpolated", "--one-pass"],
    "the same, overlapping patches": ["--mode", "splats-interpolated", "--overlap"],
}
QUICK = "--quick" in sys.argv[1:]
SECONDS = 1 if QUICK else 2
ROUNDS = 1 if QUICK else 3
SIDE = 512 if QUICK else 1024


def run(*words):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(" ".join(map(str, words)) + ": " + done.stderr.strip())
    return done.stdout


def packed(name):
    return WORK / f"{name}.emap"


def model(name):
    return WORK / "sphere.ply" if name == "sphere" else MODELS / f"{name.removesuffix('-even')}.ply"


def maps_part():
    """Encodes what the others draw."""
    write_sphere(model("sphere"))
    page = ["## Maps", "", "What is drawn; `-even`: about as many samples as the model has vertices.", "",
            "| file | encoded with | bytes | samples | vertices |", "| --- | --- | --- | --- | --- |"]
    for name, options in ENCODINGS.items():
        run(BIN / "emap", "encode", model(name), packed(name), "--quiet", *options)
        info = json.loads(run(BIN / "emap", "info", "--json", packed(name)))
        with open(model(name), "rb") as file:
            vertices = file.read(2000).split(b"element vertex ")[1].split()[0].decode()
        page.append(f"| {name} | {' '.join(map(str, options))} | {packed(name).stat().st_size} | {info['samples']} | {vertices} |")
        print(page[-1])
    return page + [""]


def write_sphere(path, rows=160):
    """A sphere of so many rows of triangles around its axis."""
    angles = np.pi * np.arange(1, rows) / rows
    around = np.pi * np.arange(2 * rows) / rows
    rings = np.stack([np.outer(np.sin(angles), np.cos(around)), np.outer(np.sin(angles), np.sin(around)),
                      np.outer(np.cos(angles), np.ones_like(around))], axis=-1).reshape(-1, 3)
    points = np.vstack([[0, 0, 1], rings, [0, 0, -1]])
    index = 1 + np.arange((rows - 1) * 2 * rows).reshape(rows - 1, 2 * rows)
    beside = np.roll(index, -1, axis=1)
    triangles = [np.stack([np.zeros(2 * rows, int), index[0], beside[0]], axis=-1),
                 np.stack([index[:-1], index[1:], beside[1:]], axis=-1).reshape(-1, 3),
                 np.stack([index[:-1], beside[1:], beside[:-1]], axis=-1).reshape(-1, 3),
                 np.stack([np.full(2 * rows, len(points) - 1), beside[-1], index[-1]], axis=-1)]
    triangles = np.vstack(triangles)
    faces = np.zeros(len(triangles), np.dtype([("n", "u1"), ("i", "<i4", 3)]))
    faces["n"], faces["i"] = 3, triangles
    header = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\nproperty float x\nproperty float y\n"
              f"property float z\nelement face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n")
    path.write_bytes(header.encode() + points.astype("<f4").tobytes() + faces.tobytes())


# ---- pictures ----------------------------------------------------------------------------------------------------------


def render(name, target, *options, camera=CAMERA, side=SIDE, backend="auto", level=None):
    level = LEVELS.get(name, 0) if level is None else level
    source = packed(name) if isinstance(name, str) else name
    run(BIN / "emap", "render", source, target, "--size", f"{side}x{side}", "--camera", camera, "--backend", backend,
        "--level", level, *options)
    return target


def read_deep(path):
    """Normals and where there are any, from 16-bit red, green, blue, alpha. Pillow gives 8 bits, so the rows are read here."""
    data = path.read_bytes()
    width, height = struct.unpack(">II", data[16:24])
    packed_rows, at = b"", 8
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IDAT":
            packed_rows += data[at + 8:at + 8 + length]
        at += 12 + length
    lines = np.frombuffer(zlib.decompress(packed_rows), np.uint8).reshape(height, 1 + 8 * width)
    assert (lines[:, 0] == 2).all(), "emap writes 16-bit pictures with differences to the row above"
    rows = np.add.accumulate(lines[:, 1:], axis=0, dtype=np.uint8)
    deep = np.frombuffer(rows.tobytes(), ">u2").reshape(height, width, 4).astype(float) / 65535
    return 2 * deep[..., :3] - 1, deep[..., 3] > 0


def normals(name, *options, **where):
    return read_deep(render(name, WORK / "normals.png", "--shading", "normals", *options, **where))


def compose(target, pictures, columns):
    """Panels side by side, as few bytes as palettes take: one for each panel, for greys would take colours of another's."""
    panels = [Image.open(picture).convert("RGB") for picture in pictures]
    width, height = panels[0].size
    for colours in (256, 128, 64, 32):
        whole = Image.new("RGB", (columns * width, -(-len(panels) // columns) * height), "white")
        for i, panel in enumerate(panels):
            reduced = panel.quantize(colours // len(panels), method=Image.Quantize.MEDIANCUT).convert("RGB")
            whole.paste(reduced, ((i % columns) * width, i // columns * height))
        whole.quantize(256).save(PICTURES / target, optimize=True)
        if (PICTURES / target).stat().st_size < 200_000:
            break
    check((PICTURES / target).stat().st_size < 200_000, f"{target} has 200 kB or more")
    return f"![{target}](rendering/{target})"


# ---- measures ----------------------------------------------------------------------------------------------------------


def degrees_between(a, b):
    cosine = (a * b).sum(-1) / np.maximum(np.linalg.norm(a, axis=-1) * np.linalg.norm(b, axis=-1), 1e-9)
    return np.degrees(np.arccos(np.clip(cosine, -1, 1)))


def rays(camera, side):
    """Eye and directions, rows from the top, in the model's axes (diagonals)."""
    azimuth, elevation, distance = (float(word) for word in camera.split(","))
    azimuth, elevation = np.radians(azimuth), np.radians(elevation)
    back = np.array([np.cos(elevation) * np.sin(azimuth), np.sin(elevation), np.cos(elevation) * np.cos(azimuth)])
    right = np.array([np.cos(azimuth), 0, -np.sin(azimuth)])
    up = np.cross(back, right)
    places = (np.arange(side) + 0.5 - side / 2) * 2 * np.tan(np.radians(15)) / side
    directions = places[None, :, None] * right - places[:, None, None] * up - back
    return distance * back, directions / np.linalg.norm(directions, axis=-1, keepdims=True)


def eroded(covered):
    inner = covered.copy()
    for down in (-1, 0, 1):
        for across in (-1, 0, 1):
            inner &= np.roll(covered, (down, across), (0, 1))
    return inner


def detail(directions):
    """How normals differ from the mean of those three pixels away on four sides: what blurring takes away."""
    return directions - sum(np.roll(directions, shift, axis) for shift in (-3, 3) for axis in (0, 1)) / 4


def detail_kept(drawn, truth, where):
    """Of the true detail, in percent: the slope of the drawn detail over it."""
    wanted, found = detail(truth)[where], detail(drawn)[where]
    return 100 * (wanted * found).sum() / (wanted * wanted).sum()


def accuracy_heading():
    return ["## Normals, against rays", "",
            f"{SIDE} x {SIDE} pixels, camera {CAMERA}. The reference casts a ray through every pixel's centre at the closed mesh of the same "
            "maps (CGAL's AABB tree, `trace_normals`) and interpolates its vertices' normals. Pixels that both cover count. Holes: nothing is "
            "drawn though the rays hit the surface's outside, in all eight pixels around, too. Beside: something is drawn where no ray hits. "
            "Detail: how much of the reference's is kept, where detail is the difference of a normal from the mean of those three pixels away: "
            "what blurring takes away. "
            "Backends: pictures with lighting by EGL and by OSMesa, the share of pixels that differ by more than 2 of 255.", "",
            "| model | drawn as | within 1 degree, % | mean, degrees | holes | beside | detail kept, % | backends differ, % |",
            "| --- | --- | --- | --- | --- | --- | --- | --- |"]


def accuracy_part(name):
    """Rows of one table, whose heading is the first model's."""
    page = accuracy_heading() if name == MODELS_DRAWN[0] else []
    level = LEVELS.get(name, 0)
    run(BIN / "trace_normals", packed(name), WORK / "reference.png", f"{SIDE}x{SIDE}", CAMERA, level)
    truth, hit = read_deep(WORK / "reference.png")
    _, directions = rays(CAMERA, SIDE)
    outside = eroded(hit) & ((truth * directions).sum(-1) < 0)
    for way, options in WAYS.items():
        drawn, covered = normals(name, *options)
        both = covered & hit
        away = degrees_between(drawn, truth)[both]
        within, holes = 100 * (away <= 1).mean(), int((outside & ~covered).sum())
        kept = detail_kept(drawn, truth, eroded(eroded(eroded(both))))
        pair = [np.asarray(Image.open(render(name, WORK / f"{backend}.png", *options, backend=backend))).astype(int)
                for backend in ("egl", "osmesa")]
        differ = 100 * (abs(pair[0] - pair[1]).max(-1) > 2).mean()
        page.append(f"| {name} | {way} | {within:.3f} | {away.mean():.3f} | {holes} | {int((covered & ~hit).sum())} | {kept:.0f} | {differ:.4f} |")
        print(page[-1])
        if way in ("mesh", "splats-interpolated, corrected"):
            check(within >= 99, f"{name}, {way}: {within:.2f} % of the normals are within 1 degree, not 99")
        if "one pass" not in way:
            check(holes == 0, f"{name}, {way}: {holes} pixels are holes")
        check(differ < 0.1, f"{name}, {way}: the backends differ in {differ:.3f} % of the pixels")
    return page + ([""] if name == MODELS_DRAWN[-1] else [])


def cube_map(directions):
    """Whether a direction meets a grid line of the cube map (libemap/rendering/cube_map.h)."""
    size = abs(directions).max(-1, keepdims=True)
    squares = 4 * (directions / size + 1)
    lines = abs(squares - np.round(squares)) < 0.03
    lines[np.arange(3) == abs(directions).argmax(-1)[..., None]] = False
    return lines.any(-1)


def sphere_part():
    """Figure 5.11: reflected grid lines on a coarse sphere, against the true one."""
    camera, side = "30,15,1", 640
    said = json.loads(run(BIN / "emap", "render", packed("sphere"), "--bench", 0.01, "--mode", "splats-interpolated", "--level", LEVELS["sphere"],
                          "--json"))
    eye, directions = rays(camera, side)
    radius = 1 / np.sqrt(12)
    along = -(directions @ eye)
    inside = radius**2 - (np.linalg.norm(eye + along[..., None] * directions, axis=-1))**2
    seen = inside > 0.15 * radius**2
    true = eye + (along - np.sqrt(np.maximum(inside, 0)))[..., None] * directions
    true /= np.linalg.norm(true, axis=-1, keepdims=True)
    mirrored = directions - 2 * (directions * true).sum(-1, keepdims=True) * true
    lines = cube_map(mirrored)
    page = ["## Reflections of a sphere (figure 5.11)", "",
            f"{said['samples']} samples (the thesis: 9,858 splats), the cube map with grid lines. Against the analytic sphere, over the pixels up "
            "to 67 degrees from its middle: the normals' error, and the share of pixels on which the reflection shows a line where there is none "
            "or none where there is one.", "", "| drawn as | normals, mean, degrees | 99 % within | lines wrong, % |", "| --- | --- | --- | --- |"]
    pictures = []
    for mode, options in MODES.items():
        drawn, covered = normals("sphere", *options, camera=camera, side=side)
        away = degrees_between(drawn, true)[seen & covered]
        picture = render("sphere", WORK / f"sphere-{mode}.png", "--shading", "reflection", *options, camera=camera, side=side)
        dark = np.asarray(Image.open(picture)).max(-1) < 128
        wrong = 100 * (dark != lines)[seen].mean()
        page.append(f"| {mode} | {away.mean():.4f} | {np.quantile(away, 0.99):.3f} | {wrong:.2f} |")
        print(page[-1])
        if mode == "splats-interpolated":
            check(wrong < 2, f"{wrong:.2f} % of the sphere's reflected lines are wrong")
        if mode != "mesh":
            pictures.append(render("sphere", WORK / f"figure-{mode}.png", "--shading", "reflection", *options, camera=camera, side=400))
    pictures.append(render("sphere", WORK / "figure-split.png", "--shading", "split", *MODES["splats-interpolated"], camera="30,15,1", side=400))
    page += ["", "Splats without blending, blended, interpolated; lighting, reflection, both and single splats in one picture:", "",
             compose("figure-5.11.png", pictures, 4)]
    return page + [""]


def bench(source, *options):
    said = json.loads(run(BIN / "emap", "render", source, "--size", "1024x1024", "--camera", CAMERA, "--bench", SECONDS, "--json", *options))
    return said


def rates_part():
    """Tables 5.1 and 5.2. Rounds over all modes, so that a busy moment does not fall on one of them alone."""
    names = ["bunny", "igea", "dragon"]
    jobs = {}
    for name in names:
        for way, options in WAYS.items():
            jobs[name, way] = (packed(name), *options, "--level", 0)
        for mode in ("mesh", "splats", "splats-blended"):
            jobs[name, "plain " + mode] = (MODELS / f"{name}.ply", "--mode", mode)
    even = ["bunny-even", "igea-even"]
    for name in even:
        jobs[name, "mesh"] = (packed(name), *MODES["mesh"], "--level", 0)
    runs = {job: [] for job in jobs}
    for number in range(ROUNDS):
        for job, words in jobs.items():
            runs[job].append(bench(*words))
        print(f"round {number + 1} of {ROUNDS}")
    renderer = runs["dragon", "mesh"][0]["renderer"]
    page = ["## Frame rates and memory (tables 5.1, 5.2)", "",
            f"1024 x 1024 pixels, camera {CAMERA}, {renderer}; every sample drawn (`--level 0`); {ROUNDS} rounds of {SECONDS} s each over all lines. "
            "Frames/s: the best round. Processor seconds: of all threads, the least of the rounds: what a frame costs, whatever else the machine "
            "does. Bytes: what lies on the card; \"plain\" is the model's own PLY with 16-bit positions and polar normals, and for the mesh a triangle "
            "list. The thesis on a GeForce 6800, Dragon: mesh 71.4 frames/s and 5.04 MB, blended 15.1 and 4.21, interpolated 20.3 and 6.75; plain "
            "mesh 67.2 and 9.23, plain splats 32.1, blended 14.7, 5.8 MB.", "",
            "| model | drawn as | frames/s | processor s a frame | bytes | samples | triangles |", "| --- | --- | --- | --- | --- | --- | --- |"]
    cost = {}
    for job, said in runs.items():
        cost[job] = min(one["processor_seconds_per_frame"] for one in said)
        page.append(f"| {job[0]} | {job[1]} | {max(one['frames_per_second'] for one in said):.1f} | {cost[job]:.4f} | {said[0]['bytes']} | "
                    f"{said[0]['samples']} | {said[0]['triangles'] or ''} |")
    page += ["", "| model | interpolated faster than blended (goal 1.5) | than unblended splats (goal 0.9) | mesh faster than the plain mesh (goal 1) | "
             "mesh's bytes of the plain one's, % (goal 55) | with 2-byte indices, as the thesis counts, % |", "| --- | --- | --- | --- | --- | --- |"]
    for name in names + even:
        base = name.removesuffix("-even")
        plain, mesh = runs[base, "plain mesh"][0], runs[name, "mesh"][0]
        over_plain = cost[base, "plain mesh"] / cost[name, "mesh"]
        share = 100 * mesh["bytes"] / plain["bytes"]
        small = 100 * mesh["bytes"] / (10 * plain["samples"] + 6 * plain["triangles"])
        same = mesh["samples"] / plain["samples"]
        ratios = "| "
        if name in names:
            interpolated = cost[name, "splats-interpolated, corrected"]
            over_blended, over_splats = cost[name, "splats-blended"] / interpolated, cost[name, "splats"] / interpolated
            ratios = f"{over_blended:.2f} | {over_splats:.2f}"
            check(over_blended >= 1.5, f"{name}: interpolated splats are {over_blended:.2f} times as fast as blended ones, not 1.5")
            check(over_splats >= 0.9, f"{name}: interpolated splats have {over_splats:.2f} of the rate of unblended ones, not 0.9")
        page.append(f"| {name} ({same:.2f} samples a vertex) | {ratios} | {over_plain:.2f} | {share:.0f} | {small:.0f} |")
        print(page[-1])
        if abs(same - 1) < 0.1:
            check(over_plain >= 1, f"{name}: the mesh from maps has {over_plain:.2f} of the plain mesh's rate")
            check(small <= 55, f"{name}: the mesh from maps has {small:.0f} % of the bytes of a plain mesh with 2-byte indices, not 55")
    return page + ["", "Ratios are of processor seconds. Maps that hold other than the model's number of vertices (the encoder chooses) are not held "
                   "against its plain mesh; `-even` ones are.", ""]


def levels_part():
    page = ["## Level of detail", "", "Dragon, mesh, 512 x 512 pixels: the level that the view chooses (samples at most a pixel apart) beside all "
            "samples. Frame time follows the pixels and not the samples.", "",
            "| distance, diagonals | level | samples | processor s a frame | all samples | normals within 5 degrees of all samples', % |",
            "| --- | --- | --- | --- | --- | --- |"]
    for distance in (2, 4, 8, 16):
        camera = f"30,15,{distance}"
        options = ["--size", "512x512", "--camera", camera, "--bench", SECONDS / 2, "--json"]
        own = json.loads(run(BIN / "emap", "render", packed("dragon"), *options))
        all_samples = json.loads(run(BIN / "emap", "render", packed("dragon"), *options, "--level", 0))
        coarse, covered = normals("dragon", camera=camera, side=512, level=own["level"])
        fine, hit = normals("dragon", camera=camera, side=512)
        close = 100 * (degrees_between(coarse, fine)[covered & hit] <= 5).mean()
        page.append(f"| {distance} | {own['level']} | {own['samples']} | {own['processor_seconds_per_frame']:.4f} | "
                    f"{all_samples['processor_seconds_per_frame']:.4f} | {close:.1f} |")
        print(page[-1])
    return page + [""]


def figures_part():
    interpolated = MODES["splats-interpolated"]
    whole = [render("dragon", WORK / "58-whole.png", *interpolated, side=480)]
    close = [render("dragon", WORK / f"58-{mode}.png", *MODES[mode], camera=CLOSE_UP, side=480)
             for mode in ("mesh", "splats-blended", "splats-interpolated")]
    page = ["## Figures", "", "Figure 5.8, Dragon: interpolated splats; close up: mesh, blended, interpolated.", "",
            compose("figure-5.8.png", whole + close, 2), ""]
    panels = []
    for level in (0, 2):
        for shading, options in (("patches", MODES["splats"]), ("lighting", interpolated)):
            panels.append(render("igea", WORK / f"510-{level}-{shading}.png", *options, "--shading", shading, side=480, level=level,
                                 camera='{"azimuth": 20, "elevation": 5, "distance": 0.8, "field_of_view": 12}'))
    page += ["Figure 5.10, Igea: all samples and a sixteenth of them; single splats, and interpolated.", "", compose("figure-5.10.png", panels, 2), ""]
    reflected = ["--shading", "reflection"]
    panels = [render("dragon", WORK / "514-light.png", *MODES["splats"], "--shading", "patches", camera=CLOSE_UP, side=400)]
    for label, options in (("interpolated", interpolated), ("blended", MODES["splats-blended"]),
                           ("doubled", [*MODES["splats-blended"], "--radius-factor", 2]), ("mesh", MODES["mesh"])):
        panels.append(render("dragon", WORK / f"514-{label}.png", *options, *reflected, camera=CLOSE_UP, side=400))
    panels.append(render("dragon", WORK / "514-split.png", *interpolated, "--shading", "split", camera=CLOSE_UP, side=400))
    page += ["Figure 5.14, Dragon close up: single splats with reduced radii; reflections by interpolation, by blending, by blending with doubled "
             "radii, by the mesh; all shadings of interpolated splats in quarters.", "", compose("figure-5.14.png", panels, 3), ""]
    return page


def page_part():
    """The web page: what it decodes, and how long that takes."""
    said = run(BIN / "page_times", packed("igea"), packed("bunny"), packed("dragon"))
    for line in said.splitlines()[2:]:
        check("| no |" not in line, f"the page decodes other numbers than the program: {line}")
    return ["## The web page", "", "`emap page`, in headless Chromium, best of three: masks, elevations and the triangles that close gaps against the "
            "program's, bit for bit; seconds from the bytes to decoded maps, to the first picture, and until the gaps are closed; pictures of 800 x 600 "
            "a second.", "", *said.splitlines(), ""]


PARTS = {"maps": maps_part, **{f"accuracy-{name}": functools.partial(accuracy_part, name) for name in MODELS_DRAWN},
         "sphere": sphere_part, "rates": rates_part, "levels": levels_part, "figures": figures_part, "page": page_part}


def measured(name):
    if missing := [encoded for encoded in ENCODINGS if name != "maps" and not packed(encoded).is_file()]:
        sys.exit(f"{', '.join(missing)} are not encoded yet: run the part maps first")
    parts.measure(name, PARTS[name], WORK, ROOT)


def main():
    if not MODELS.is_dir():
        sys.exit(f"no models at {MODELS}; set THIN_SHARED_DATA")
    named = parts.named_parts([word for word in sys.argv[1:] if word != "--quick"], PARTS)
    WORK.mkdir(parents=True, exist_ok=True)
    PICTURES.mkdir(parents=True, exist_ok=True)
    for name in named:
        measured(name)
    heading = ["# Rendering of elevation maps", "",
               f"Written by `scripts/reproduce rendering`. Machine: {os.cpu_count()} cores, {platform.machine()}.", ""]
    parts.write_page(PAGE, heading, PARTS, WORK)


if __name__ == "__main__":
    main()
