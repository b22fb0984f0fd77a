// Pictures by OSMesa and by EGL (Mesa's software renderer where there is no GPU), against each other and against rays.

#include "libemap/rendering/renderer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "libemap/rendering/cube_map.h"
#include "libemap/rendering/gl_context.h"
#include "libemap/rendering/level_of_detail.h"
#include "tests/support/ray_caster.h"
#include "tests/support/sampled_surfaces.h"

namespace emap {
namespace {

constexpr int kSide = 160;

struct Scene {
  Mesh mesh;
  ElevationMaps maps;
  BoundingBox box;
};

const Scene& scene(const std::string& name) {
  static const auto make = [](const Mesh& mesh) {
    return Scene{mesh, test::sampled(mesh, 1).maps, bounding_box(mesh.positions)};
  };
  static const Scene sphere = make(test::sphere(60)), torus = make(test::torus(50));
  return name == "sphere" ? sphere : torus;
}

MapUse use_of(Mode mode) {
  return mode == Mode::mesh                  ? MapUse::filled_mesh
         : mode == Mode::splats_interpolated ? MapUse::interpolated_splats
                                             : MapUse::splats;
}

const Camera kCamera{.azimuth_degrees = 35, .elevation_degrees = 40, .distance = 2.4};

DeepImage normals_of(const Scene& from, const DrawOptions& options, MapUse use, const Camera& camera = kCamera) {
  const auto renderer = *Renderer::create(kSide, kSide, true);
  EXPECT_TRUE(renderer->load(map_geometry(from.maps, from.box, use)));
  DrawOptions normals = options;
  normals.shading = Shading::normals;
  const auto drawn = renderer->draw(camera, normals);
  EXPECT_TRUE(drawn) << drawn.error().message;
  return renderer->deep_image();
}

Eigen::Vector3d normal_at(const std::uint16_t* pixel) {
  return Eigen::Vector3d(pixel[0], pixel[1], pixel[2]) / 32767.5 - Eigen::Vector3d::Ones();
}

struct Agreement {
  int both = 0, within_a_degree = 0, missing_inside = 0, beside = 0;
  double mean_degrees = 0;
};

// Missing inside: nothing drawn where the rays hit, in all eight pixels around, too. Beside: drawn where no ray hits
// within a pixel.
Agreement compared(const DeepImage& image, const std::vector<test::TracedPixel>& rays) {
  Agreement agreement;
  const auto around = [&](int x, int y, auto&& is) {
    for (int v = std::max(y - 1, 0); v <= std::min(y + 1, kSide - 1); ++v)
      for (int u = std::max(x - 1, 0); u <= std::min(x + 1, kSide - 1); ++u)
        if (!is(rays[static_cast<std::size_t>(v * kSide + u)].hit)) return false;
    return true;
  };
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const test::TracedPixel& ray = rays[static_cast<std::size_t>(y * kSide + x)];
      const std::uint16_t* pixel = image.pixel(x, y);
      const bool drawn = pixel[3] != 0;
      agreement.missing_inside += !drawn && around(x, y, [](bool hit) { return hit; });
      agreement.beside += drawn && around(x, y, [](bool hit) { return !hit; });
      if (!drawn || !ray.hit) continue;
      const Eigen::Vector3d normal = normal_at(pixel).normalized();
      const double degrees = std::acos(std::clamp(normal.dot(ray.normal), -1.0, 1.0)) * 180 / std::numbers::pi;
      ++agreement.both;
      agreement.within_a_degree += degrees <= 1;
      agreement.mean_degrees += degrees;
    }
  agreement.mean_degrees /= std::max(agreement.both, 1);
  return agreement;
}

class RendererTest : public testing::TestWithParam<Backend> {
 protected:
  void SetUp() override {
    auto created = create_context(GetParam());
    ASSERT_TRUE(created) << created.error().message;
    context_ = std::move(*created);
  }
  std::unique_ptr<GlContext> context_;
};

INSTANTIATE_TEST_SUITE_P(Backends, RendererTest, testing::Values(Backend::egl, Backend::osmesa),
                         [](const auto& info) { return info.param == Backend::egl ? "egl" : "osmesa"; });

TEST_P(RendererTest, NormalsAreThoseOfTheClosedMesh) {
  for (const char* name : {"sphere", "torus"}) {
    const Scene& from = scene(name);
    const test::RayCaster caster(closed_mesh(from.maps).mesh, from.box);
    const auto rays = caster.trace(View(kCamera, kSide, kSide));
    std::array<double, 4> mean_degrees{};
    for (const Mode mode : {Mode::mesh, Mode::splats, Mode::splats_blended, Mode::splats_interpolated}) {
      SCOPED_TRACE(testing::Message() << name << ", mode " << static_cast<int>(mode));
      const Agreement agreement = compared(normals_of(from, {.mode = mode}, use_of(mode)), rays);
      EXPECT_GT(agreement.both, kSide * kSide / 8);
      EXPECT_EQ(agreement.missing_inside, 0);
      EXPECT_EQ(agreement.beside, 0);
      if (mode == Mode::mesh || mode == Mode::splats_interpolated) {
        EXPECT_GE(agreement.within_a_degree, 0.99 * agreement.both);
      }
      mean_degrees[static_cast<std::size_t>(mode)] = agreement.mean_degrees;
    }
    // Interpolation is as exact as a mesh to within pixels at edges; blending is not; single normals are worst.
    EXPECT_LT(mean_degrees[3], 0.5 * mean_degrees[2]);
    EXPECT_LT(mean_degrees[2], mean_degrees[1]);
  }
}

TEST_P(RendererTest, TheOtherWaysToInterpolateAndToCloseSeams) {
  const Scene& from = scene("torus");
  const test::RayCaster caster(closed_mesh(from.maps).mesh, from.box);
  const auto rays = caster.trace(View(kCamera, kSide, kSide));
  const Agreement one_pass = compared(
      normals_of(from, {.mode = Mode::splats_interpolated, .in_one_pass = true}, MapUse::interpolated_splats), rays);
  EXPECT_GE(one_pass.within_a_degree, 0.99 * one_pass.both);
  const Agreement direct = compared(
      normals_of(from, {.mode = Mode::splats_interpolated, .correction_rounds = 0}, MapUse::interpolated_splats), rays);
  EXPECT_EQ(direct.missing_inside, 0);
  const Agreement corrected =
      compared(normals_of(from, {.mode = Mode::splats_interpolated}, MapUse::interpolated_splats), rays);
  EXPECT_LT(corrected.mean_degrees, direct.mean_degrees);
  for (const auto& [mode, use] : {std::pair(Mode::mesh, MapUse::overlapping_mesh),
                                  std::pair(Mode::splats_interpolated, MapUse::overlapping_interpolated_splats)}) {
    const Agreement overlapping = compared(normals_of(from, {.mode = mode}, use), rays);
    EXPECT_EQ(overlapping.missing_inside, 0);
    EXPECT_GE(overlapping.within_a_degree, 0.9 * overlapping.both);
  }
}

// Samples of a many-faced sphere, moved along their plane's normal to the true one.
ElevationMaps on_true_sphere(ElevationMaps maps) {
  for (ElevationPatch& patch : maps.patches)
    for (std::size_t place = 0; place < patch.mask.size(); ++place) {
      if (!patch.mask[place]) continue;
      patch.elevation[place] = 0;
      const Eigen::Vector3d base =
          sample_position(patch, maps.spacing, static_cast<std::uint32_t>(place / patch.columns),
                          static_cast<std::uint32_t>(place % patch.columns));
      const double along = base.dot(patch.plane.normal);
      patch.elevation[place] = std::sqrt(1 - base.squaredNorm() + along * along) - along;
    }
  return maps;
}

// Lines of the cube map, reflected by a coarse sphere, against what the true sphere reflects there. Where the answer
// changes within a third of a degree either is right: half a line's width.
TEST_P(RendererTest, ReflectionsOfASphereAreThoseOfTheTrueSphere) {
  const Scene& from = scene("sphere");
  Camera camera = kCamera;
  camera.distance = 1;
  const auto renderer = *Renderer::create(kSide, kSide, false);
  ASSERT_TRUE(renderer->load(map_geometry(on_true_sphere(from.maps), from.box, MapUse::interpolated_splats)));
  ASSERT_TRUE(renderer->draw(camera, {.mode = Mode::splats_interpolated, .shading = Shading::reflection}));
  const Image image = renderer->image();
  const View view(camera, kSide, kSide);
  const double radius = 1 / from.box.diagonal();
  const GridCubeMap environment;
  int lines = 0, faces = 0, wrong = 0;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const Eigen::Vector3d ray =
          (view.model_from_eye * Eigen::Vector3d(view.ray_scale.x() * (x + 0.5) + view.ray_offset.x(),
                                                 -view.ray_scale.y() * (y + 0.5) - view.ray_offset.y(), -1))
              .normalized();
      const double along = -ray.dot(view.eye_in_model);
      const double inside = radius * radius - (view.eye_in_model + along * ray).squaredNorm();
      if (inside < 0.3 * radius * radius) continue;
      const Eigen::Vector3d normal = (view.eye_in_model + (along - std::sqrt(inside)) * ray).normalized();
      const Eigen::Vector3d seen = (ray - 2 * ray.dot(normal) * normal).normalized();
      int dark = 0;
      for (int i = 0; i < 9; ++i) {
        const Eigen::Vector3d beside = 0.004 * Eigen::Vector3d(i % 3 - 1, i / 3 - 1, (i * 2) % 3 - 1);
        dark += environment.colour(seen + beside).isZero();
      }
      const int brightest = std::max({image.pixel(x, y)[0], image.pixel(x, y)[1], image.pixel(x, y)[2]});
      lines += dark == 9;
      faces += dark == 0;
      wrong += dark == 9 ? brightest > 128 : dark == 0 ? brightest < 128 : 0;
    }
  EXPECT_GT(lines, 50);
  EXPECT_GT(faces, 2000);
  EXPECT_LT(wrong, 0.01 * (lines + faces));
}

TEST_P(RendererTest, ShadingsDrawWhatTheySay) {
  const Scene& from = scene("sphere");
  const auto renderer = *Renderer::create(kSide, kSide, false);
  for (const Mode mode : {Mode::mesh, Mode::splats, Mode::splats_blended, Mode::splats_interpolated}) {
    SCOPED_TRACE(static_cast<int>(mode));
    const auto picture = [&](Shading shading) {
      EXPECT_TRUE(renderer->load(map_geometry(
          from.maps, from.box, shading == Shading::patches && mode != Mode::mesh ? MapUse::splats : use_of(mode))));
      EXPECT_TRUE(renderer->draw(kCamera, {.mode = mode, .shading = shading}));
      return renderer->image();
    };
    const Image lit = picture(Shading::lighting);
    // The light is at the eye: the middle of the sphere is lit from straight ahead.
    EXPECT_NEAR(lit.pixel(kSide / 2, kSide / 2)[0], 0.8 * 255, 4);
    EXPECT_EQ(lit.pixel(1, 1)[0], 255);
    const Image split = picture(Shading::split), reflected = picture(Shading::reflection);
    const Image combined = picture(Shading::combined), patches = picture(Shading::patches);
    const Image textured = picture(Shading::texture);
    const int low = kSide / 2 - 20, high = kSide / 2 + 20;
    for (int channel = 0; channel < 3; ++channel) {
      EXPECT_EQ(split.pixel(low, low)[channel], lit.pixel(low, low)[channel]);
      EXPECT_EQ(split.pixel(high, low)[channel], reflected.pixel(high, low)[channel]);
      EXPECT_EQ(split.pixel(high, high)[channel], combined.pixel(high, high)[channel]);
      EXPECT_NEAR(combined.pixel(low, low)[channel],
                  (lit.pixel(low, low)[channel] + reflected.pixel(low, low)[channel]) / 2, 1);
    }
    EXPECT_NE(textured.values, lit.values);
    // Splats at half their radius leave ground between them; meshes do not.
    int ground = 0;
    for (int y = low; y < high; ++y)
      for (int x = low; x < high; ++x) ground += patches.pixel(x, y)[0] == 255 && patches.pixel(x, y)[1] == 255;
    EXPECT_EQ(ground > 0, mode != Mode::mesh);
  }
}

TEST_P(RendererTest, PlainSurfacesAreDrawnToo) {
  const Scene& from = scene("torus");
  const test::RayCaster caster(from.mesh, from.box);
  const auto rays = caster.trace(View(kCamera, kSide, kSide));
  const auto renderer = *Renderer::create(kSide, kSide, true);
  ASSERT_TRUE(renderer->load(plain_mesh_geometry(from.mesh, from.box)));
  ASSERT_TRUE(renderer->draw(kCamera, {.mode = Mode::mesh, .shading = Shading::normals}));
  Agreement agreement = compared(renderer->deep_image(), rays);
  EXPECT_GE(agreement.within_a_degree, 0.995 * agreement.both);
  EXPECT_EQ(agreement.missing_inside, 0);
  PlainGeometry splats = plain_splat_geometry({from.mesh.positions, smooth_normals(from.mesh)}, from.box);
  splats.closed = true;
  ASSERT_TRUE(renderer->load(splats));
  for (const Mode mode : {Mode::splats, Mode::splats_blended}) {
    ASSERT_TRUE(renderer->draw(kCamera, {.mode = mode, .shading = Shading::normals}));
    agreement = compared(renderer->deep_image(), rays);
    EXPECT_EQ(agreement.missing_inside, 0);
    EXPECT_LT(agreement.mean_degrees, 10);  // discs as wide as the longest edge
  }
}

TEST_P(RendererTest, CoarserLevelsAndWiderDiscsHaveNoHoles) {
  Scene from = scene("torus");
  from.maps = coarser_maps(from.maps, 1);
  const test::RayCaster caster(closed_mesh(from.maps, filling_at_level(1)).mesh, from.box);
  const auto rays = caster.trace(View(kCamera, kSide, kSide));
  for (const Mode mode : {Mode::mesh, Mode::splats_interpolated}) {
    const auto renderer = *Renderer::create(kSide, kSide, true);
    ASSERT_TRUE(renderer->load(map_geometry(from.maps, from.box, use_of(mode), filling_at_level(1))));
    ASSERT_TRUE(renderer->draw(kCamera, {.mode = mode, .shading = Shading::normals}));
    const Agreement agreement = compared(renderer->deep_image(), rays);
    EXPECT_EQ(agreement.missing_inside, 0);
    EXPECT_GE(agreement.within_a_degree, 0.99 * agreement.both);
  }
}

// The normals at a sheer rim say that discs by (5.1) must be very large; they stand upright there.
TEST_P(RendererTest, SheerRimsHaveNoDiscsAboveThem) {
  constexpr std::uint32_t kColumns = 60;
  constexpr double kWall = 11, kFarthest = 5.5;  // samples: the rim's height, and how far a disc may reach beyond
  Scene from = scene("torus");
  ElevationPatch patch;
  patch.columns = patch.rows = kColumns;
  patch.mask.assign(kColumns * kColumns, 1);
  patch.elevation.assign(kColumns * kColumns, 0);
  for (std::size_t place = kColumns - 1; place < patch.elevation.size(); place += kColumns)
    patch.elevation[place] = kWall;
  from.maps.patches = {patch};
  from.maps.spacing = 1;
  from.box = {{0, 0, 0}, {kColumns - 1, kColumns - 1, kWall}};
  const Camera from_the_side{.azimuth_degrees = 90, .elevation_degrees = 0, .distance = 2.4};
  const test::RayCaster caster(closed_mesh(from.maps).mesh, from.box);
  const auto rays = caster.trace(View(from_the_side, kSide, kSide));
  const double pixels = kSide / (2 * 2.4 * std::tan(std::numbers::pi / 12) * from.box.diagonal());  // of a sample
  const int reach = static_cast<int>(std::ceil(kFarthest * pixels));
  for (const Mode mode : {Mode::splats, Mode::splats_blended, Mode::splats_interpolated}) {
    SCOPED_TRACE(static_cast<int>(mode));
    const DeepImage image = normals_of(from, {.mode = mode}, use_of(mode), from_the_side);
    int drawn = 0, far_beside = 0;
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        if (image.pixel(x, y)[3] == 0) continue;
        ++drawn;
        bool is_near = false;
        for (int v = std::max(y - reach, 0); v <= std::min(y + reach, kSide - 1); ++v)
          for (int u = std::max(x - reach, 0); u <= std::min(x + reach, kSide - 1); ++u)
            is_near |= rays[static_cast<std::size_t>(v * kSide + u)].hit;
        far_beside += !is_near;
      }
    EXPECT_GT(drawn, 500);
    EXPECT_EQ(far_beside, 0);
  }
}

// What lies just outside a close view reaches into it as in a wider one: the middle of the wider is the close one.
TEST_P(RendererTest, ACloseViewsBordersAreThoseOfAWiderView) {
  const Scene& from = scene("sphere");
  const Camera close{.azimuth_degrees = 35, .elevation_degrees = 40, .distance = 1, .field_of_view_degrees = 6};
  Camera wide = close;
  wide.field_of_view_degrees = 360 / std::numbers::pi * std::atan(2 * std::tan(std::numbers::pi / 60));
  for (const Mode mode : {Mode::mesh, Mode::splats, Mode::splats_blended, Mode::splats_interpolated}) {
    SCOPED_TRACE(static_cast<int>(mode));
    const auto picture = [&](const Camera& camera, int side) {
      const auto renderer = *Renderer::create(side, side, false);
      EXPECT_TRUE(renderer->load(map_geometry(from.maps, from.box, use_of(mode))));
      EXPECT_TRUE(renderer->draw(camera, {.mode = mode}));
      return renderer->image();
    };
    const Image inner = picture(close, kSide), outer = picture(wide, 2 * kSide);
    int drawn = 0, border_differs = 0, differs = 0;
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        const int a = inner.pixel(x, y)[0], b = outer.pixel(x + kSide / 2, y + kSide / 2)[0];
        drawn += b < 255;
        differs += std::abs(a - b) > 2;
        border_differs += (x % (kSide - 1) == 0 || y % (kSide - 1) == 0) && std::abs(a - b) > 2;
      }
    EXPECT_GT(drawn, kSide * kSide / 2);
    EXPECT_LE(differs, kSide * kSide / 500);  // edges that rounding moves
    EXPECT_LE(border_differs, 4);
  }
}

TEST_P(RendererTest, WhatCannotBeDrawnIsAnError) {
  const auto renderer = *Renderer::create(8, 8, false);
  EXPECT_EQ(renderer->load(MapGeometry()).error().kind, thin::ErrorKind::input);
  EXPECT_EQ(renderer->load(PlainGeometry()).error().kind, thin::ErrorKind::input);
  for (const auto& [width, height] : {std::pair(0, 8), std::pair(8, -1), std::pair(1 << 20, 8)}) {
    const auto refused = Renderer::create(width, height, false);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, thin::ErrorKind::configuration);
    EXPECT_NE(refused.error().message.find("pixels"), std::string::npos);
  }
}

// The two are the same software renderer here; on a GPU edges may fall to one pixel or the other.
TEST(RendererBackendsTest, BothDrawTheSamePicture) {
  for (const Mode mode : {Mode::mesh, Mode::splats, Mode::splats_blended, Mode::splats_interpolated}) {
    std::vector<Image> images;
    for (const Backend backend : {Backend::egl, Backend::osmesa}) {
      const auto context = *create_context(backend);
      const auto renderer = *Renderer::create(kSide, kSide, false);
      ASSERT_TRUE(renderer->load(map_geometry(scene("torus").maps, scene("torus").box, use_of(mode))));
      ASSERT_TRUE(renderer->draw(kCamera, {.mode = mode}));
      images.push_back(renderer->image());
    }
    std::size_t differing = 0;
    for (std::size_t i = 0; i < images[0].values.size(); ++i)
      differing += std::abs(images[0].values[i] - images[1].values[i]) > 8;
    EXPECT_LT(differing, images[0].values.size() / 500);
  }
}

}  // namespace
}  // namespace emap
