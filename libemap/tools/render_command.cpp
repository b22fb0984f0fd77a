// emap render: pictures of an .emap file, or of a model as it is.

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <ctime>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "libemap/rendering/gl_context.h"
#include "libemap/rendering/level_of_detail.h"
#include "libemap/rendering/renderer.h"
#include "libemap/rendering/smooth_normals.h"
#include "libemap/surface/boundary_edges.h"
#include "libemap/surface/model_file.h"
#include "libemap/surface/point_normals.h"
#include "libemap/tools/commands.h"
#include "libemap/tools/emap_file.h"
#include "libemap/tools/failure.h"
#include "libemap/tools/stopwatch.h"

namespace emap {
namespace {

using thin::Error;
using thin::ErrorKind;
using thin::Result;

struct Arguments {
  std::string input, output;
  Mode mode = Mode::mesh;
  Shading shading = Shading::lighting;
  std::string size = "1024x1024", camera = "30,15,2", texture;
  Backend backend = Backend::automatic;
  bool is_direct = false, is_in_one_pass = false, is_overlapping = false, as_json = false;
  int level = -1;  // by the view
  int turntable = 1;
  double bench_seconds = 0, radius_factor = 1;
};

const std::map<std::string, Mode> kModes = {{"mesh", Mode::mesh},
                                            {"splats", Mode::splats},
                                            {"splats-blended", Mode::splats_blended},
                                            {"splats-interpolated", Mode::splats_interpolated}};
const std::map<std::string, Shading> kShadings = {{"lighting", Shading::lighting}, {"reflection", Shading::reflection},
                                                  {"combined", Shading::combined}, {"split", Shading::split},
                                                  {"patches", Shading::patches},   {"texture", Shading::texture},
                                                  {"normals", Shading::normals}};
const std::map<std::string, Backend> kBackends = {
    {"auto", Backend::automatic}, {"egl", Backend::egl}, {"osmesa", Backend::osmesa}};

bool is_emap_file(const std::string& path) {
  return path.size() >= 5 && path.compare(path.size() - 5, 5, ".emap") == 0;
}

struct PictureSize {
  int width, height;
};

Result<PictureSize> parse_size(const std::string& text) {
  PictureSize size{};
  char rest = 0;
  if (std::sscanf(text.c_str(), "%9dx%9d%c", &size.width, &size.height, &rest) != 2)
    return Error{ErrorKind::configuration, fmt::format("\"{}\" is no size: write WIDTHxHEIGHT, in pixels", text)};
  return size;
}

// What came of loading, for reports.
struct Loaded {
  std::size_t bytes = 0, samples = 0, triangles = 0, tiles = 0;
  int level = 0;
};

MapUse use_of(const Arguments& arguments) {
  switch (arguments.mode) {
    case Mode::mesh:
      return arguments.is_overlapping ? MapUse::overlapping_mesh : MapUse::filled_mesh;
    case Mode::splats_interpolated:
      if (arguments.shading == Shading::patches) return MapUse::splats;
      return arguments.is_overlapping ? MapUse::overlapping_interpolated_splats : MapUse::interpolated_splats;
    default:
      return MapUse::splats;
  }
}

Result<Loaded> load_maps(const Arguments& arguments, const Camera& camera, const PictureSize& size,
                         Renderer& renderer) {
  const Result<DecodedStream> decoded = read_emap_file(arguments.input);
  if (!decoded) return decoded.error();
  const BoundingBox& box = decoded->header.frame.box;
  const ElevationMaps& maps = decoded->maps;
  const int level =
      arguments.level >= 0 ? arguments.level : level_for_view(maps.spacing / box.diagonal(), camera, size.height);
  const MapGeometry geometry = map_geometry(coarser_maps(maps, level), box, use_of(arguments), filling_at_level(level));
  if (const Result<void> loaded = renderer.load(geometry); !loaded)
    return Error{loaded.error().kind, arguments.input + ": " + loaded.error().message};
  return Loaded{geometry.bytes(), geometry.samples, geometry.triangles, geometry.tiles.size(), level};
}

Result<PlainGeometry> plain_splats(Model model) {
  const BoundingBox box = bounding_box(model.positions);
  bool closed = false;
  if (model.is_mesh()) {
    Mesh mesh = mesh_of(std::move(model));
    closed = boundary_edges(mesh).size() * 1000 < mesh.triangles.size() * 3 / 2;
    model = {mesh.positions, smooth_normals(mesh), {}};
  }
  PointSet points = points_of(std::move(model));
  ensure_normals(points);
  PlainGeometry geometry = plain_splat_geometry(points, box);
  geometry.closed = closed;
  return geometry;
}

Result<Loaded> load_plain(const Arguments& arguments, Renderer& renderer) {
  if (arguments.mode == Mode::splats_interpolated)
    return Error{
        ErrorKind::configuration,
        fmt::format("{}: splats-interpolated needs elevation maps: `emap encode` it first, or choose splats or "
                    "splats-blended",
                    arguments.input)};
  Result<Model> model = read_model(arguments.input);
  if (!model) return model.error();
  if (model->positions.empty() || !(bounding_box(model->positions).diagonal() > 0))
    return Error{ErrorKind::input, arguments.input + ": the model is empty: it holds nothing that could be drawn"};
  if (arguments.mode == Mode::mesh && !model->is_mesh())
    return Error{ErrorKind::input,
                 fmt::format("{}: points have no triangles to draw: choose --mode splats", arguments.input)};
  PlainGeometry geometry;
  if (arguments.mode == Mode::mesh) {
    const BoundingBox box = bounding_box(model->positions);
    geometry = plain_mesh_geometry(mesh_of(std::move(*model)), box);
  } else {
    Result<PlainGeometry> splats = plain_splats(std::move(*model));
    if (!splats) return splats.error();
    geometry = std::move(*splats);
  }
  if (const Result<void> loaded = renderer.load(geometry); !loaded)
    return Error{loaded.error().kind, arguments.input + ": " + loaded.error().message};
  return Loaded{geometry.bytes(), geometry.vertices.size(), geometry.triangles.size() / 3, 1, 0};
}

Result<void> write_picture(const Renderer& renderer, const Arguments& arguments, const std::string& path) {
  if (arguments.shading == Shading::normals) return write_png(path, renderer.deep_image());
  Image image = renderer.image();
  // Nothing shows through: alpha would only make the file larger.
  std::vector<std::uint8_t> opaque;
  opaque.reserve(image.values.size() / 4 * 3);
  for (std::size_t i = 0; i < image.values.size(); ++i)
    if (i % 4 != 3) opaque.push_back(image.values[i]);
  return write_png(path, Image{image.width, image.height, 3, std::move(opaque)});
}

// "dragon.png" -> "dragon-007.png"
std::string numbered(const std::string& path, int number) {
  const std::size_t dot = path.rfind('.');
  const std::size_t end = dot == std::string::npos || path.find('/', dot) != std::string::npos ? path.size() : dot;
  return fmt::format("{}-{:03}{}", path.substr(0, end), number, path.substr(end));
}

Result<void> draw_pictures(Renderer& renderer, const Arguments& arguments, const Camera& camera,
                           const DrawOptions& options) {
  for (int turn = 0; turn < arguments.turntable; ++turn) {
    Camera turned = camera;
    turned.azimuth_degrees += 360.0 * turn / arguments.turntable;
    if (const Result<void> drawn = renderer.draw(turned, options); !drawn) return drawn;
    const std::string path = arguments.turntable == 1 ? arguments.output : numbered(arguments.output, turn);
    if (arguments.output.empty()) continue;
    if (const Result<void> written = write_picture(renderer, arguments, path); !written) return written;
  }
  return {};
}

struct Bench {
  int frames = 0;
  double seconds = 0;
  double processor_seconds = 0;  // of all threads: what software renderers take, whoever else is at work
};

// The same picture again and again, each finished before the next begins; the first of all, which compiles, was drawn.
Result<Bench> bench(Renderer& renderer, const Arguments& arguments, const Camera& camera, const DrawOptions& options) {
  Bench result;
  Stopwatch watch;
  const std::clock_t began = std::clock();
  while (result.seconds < arguments.bench_seconds) {
    if (const Result<void> drawn = renderer.draw(camera, options); !drawn) return drawn.error();
    ++result.frames;
    result.seconds += watch.lap_seconds();
  }
  result.processor_seconds = static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC;
  return result;
}

std::string report(const Arguments& arguments, const GlContext& context, const Loaded& loaded, const Bench& bench,
                   double load_seconds) {
  const double rate = bench.frames ? bench.frames / bench.seconds : 0;
  if (arguments.as_json) {
    nlohmann::ordered_json json = {{"backend", context.backend()},  {"renderer", context.renderer()},
                                   {"bytes", loaded.bytes},         {"samples", loaded.samples},
                                   {"triangles", loaded.triangles}, {"tiles", loaded.tiles},
                                   {"level", loaded.level},         {"load_seconds", load_seconds}};
    if (bench.frames)
      json["frames"] = bench.frames, json["frames_per_second"] = rate,
      json["processor_seconds_per_frame"] = bench.processor_seconds / bench.frames;
    return json.dump(2) + "\n";
  }
  std::string text = fmt::format("{}: {} samples, {} triangles, {} tiles, level {}, {} bytes on the card; {}, {}\n",
                                 arguments.input, loaded.samples, loaded.triangles, loaded.tiles, loaded.level,
                                 loaded.bytes, context.backend(), context.renderer());
  if (bench.frames)
    text += fmt::format("{:.1f} frames/s ({} in {:.2f} s; {:.4f} s of processors each)\n", rate, bench.frames,
                        bench.seconds, bench.processor_seconds / bench.frames);
  return text;
}

Result<std::string> render(const Arguments& arguments) {
  const Result<Camera> camera = parse_camera(arguments.camera);
  if (!camera) return camera.error();
  const Result<PictureSize> size = parse_size(arguments.size);
  if (!size) return size.error();
  if (arguments.output.empty() && arguments.bench_seconds <= 0)
    return Error{ErrorKind::configuration, "name the picture to write, or measure with --bench SECONDS"};
  const Result<std::unique_ptr<GlContext>> context = create_context(arguments.backend);
  if (!context) return context.error();
  const Result<std::unique_ptr<Renderer>> renderer =
      Renderer::create(size->width, size->height, arguments.shading == Shading::normals);
  if (!renderer) return renderer.error();
  if (!arguments.texture.empty()) {
    const Result<Image> picture = read_png(arguments.texture);
    if (!picture) return picture.error();
    (*renderer)->set_picture(*picture);
  }
  Stopwatch watch;
  const Result<Loaded> loaded = is_emap_file(arguments.input) ? load_maps(arguments, *camera, *size, **renderer)
                                                              : load_plain(arguments, **renderer);
  if (!loaded) return loaded.error();
  const double load_seconds = watch.lap_seconds();
  const DrawOptions options{arguments.mode, arguments.shading, arguments.is_direct ? 0 : 2, arguments.is_in_one_pass,
                            arguments.radius_factor};
  if (const Result<void> drawn = draw_pictures(**renderer, arguments, *camera, options); !drawn) return drawn.error();
  const Result<Bench> measured = bench(**renderer, arguments, *camera, options);
  if (!measured) return measured.error();
  return report(arguments, **context, *loaded, *measured, load_seconds);
}

int run(const Arguments& arguments) {
  const Result<std::string> text = render(arguments);
  if (!text) return fail(text.error());
  std::fputs(text->c_str(), stdout);
  return std::fflush(stdout) == 0 ? 0 : thin::exit_code(ErrorKind::temporary);
}

}  // namespace

void add_render_command(CLI::App& program, Action& action) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = program.add_subcommand("render", "pictures of a compressed file, or of a model as it is");
  command->add_option("input", arguments->input, "Compressed file, or model (PLY, OBJ, OFF, STL, XYZ)")
      ->required()
      ->type_name("IN");
  command->add_option("output", arguments->output, "Picture; may be left out with --bench")->type_name("OUT.png");
  command->add_option("--mode", arguments->mode, "What is drawn")
      ->transform(CLI::CheckedTransformer(kModes))
      ->default_str("mesh");
  command->add_option("--shading", arguments->shading, "How; normals are written with 16 bits and alpha")
      ->transform(CLI::CheckedTransformer(kShadings))
      ->default_str("lighting");
  command->add_option("--size", arguments->size, "Pixels")->type_name("WIDTHxHEIGHT")->capture_default_str();
  command->add_option("--camera", arguments->camera, "Degrees, degrees, diagonals of the bounding box; or JSON")
      ->type_name("AZIMUTH,ELEVATION,DISTANCE")
      ->capture_default_str();
  command->add_option("--backend", arguments->backend, "What draws: a GPU or Mesa by EGL, or OSMesa")
      ->transform(CLI::CheckedTransformer(kBackends))
      ->default_str("auto");
  command->add_flag("--direct", arguments->is_direct, "splats-interpolated without correction of places");
  command->add_flag("--one-pass", arguments->is_in_one_pass,
                    "splats-interpolated for every disc's fragments instead of once for each pixel");
  command->add_flag("--overlap", arguments->is_overlapping,
                    "mesh, splats-interpolated: patches overlap instead of having their gaps filled");
  command->add_option("--level", arguments->level, "Halvings of the maps' resolution; by the view unless given")
      ->check(CLI::Range(0, 12));
  command->add_option("--radius-factor", arguments->radius_factor, "Of splats' radii")
      ->check(CLI::Range(0.05, 20.0))
      ->capture_default_str();
  command->add_option("--texture", arguments->texture, "Picture for --shading texture; chequers unless given")
      ->type_name("PNG");
  command->add_option("--turntable", arguments->turntable, "So many pictures around the model, OUT-000.png and so on")
      ->check(CLI::Range(1, 999))
      ->capture_default_str();
  command->add_option("--bench", arguments->bench_seconds, "Draw for so long and report frames per second")
      ->check(CLI::NonNegativeNumber);
  command->add_flag("--json", arguments->as_json, "One JSON object");
  command->callback([arguments, &action] { action = [arguments] { return run(*arguments); }; });
}

}  // namespace emap
