#include "libemap/rendering/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "libemap/rendering/view.h"

namespace emap {
namespace {

TEST(CameraTest, LooksFromTheDirectionThatItsAnglesName) {
  const Camera camera = *parse_camera("40,25,3");
  const double azimuth = 40 * std::numbers::pi / 180, elevation = 25 * std::numbers::pi / 180;
  const Eigen::Vector3d expected(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                                 std::cos(elevation) * std::cos(azimuth));
  const View view(camera, 200, 100);
  EXPECT_LT((view.eye_in_model - 3 * expected).norm(), 1e-12);
  EXPECT_LT((eye_from_model(camera) * Eigen::Vector3d::Zero() - Eigen::Vector3d(0, 0, -3)).norm(), 1e-12);
  // Up in the model is up in the picture.
  EXPECT_GT((eye_from_model(camera).rotation() * Eigen::Vector3d::UnitY()).y(), 0.5);
}

TEST(CameraTest, ReadsJson) {
  const Camera camera =
      *parse_camera(R"({"azimuth": 10, "distance": 4, "target": [0.1, 0, -0.2], "field_of_view": 20})");
  EXPECT_EQ(camera.azimuth_degrees, 10);
  EXPECT_EQ(camera.elevation_degrees, Camera().elevation_degrees);
  EXPECT_EQ(camera.distance, 4);
  EXPECT_EQ(camera.field_of_view_degrees, 20);
  EXPECT_EQ(camera.target, Eigen::Vector3d(0.1, 0, -0.2));
}

TEST(CameraTest, RefusesWhatIsNone) {
  for (const char* text :
       {"", "1,2", "1,2,3,4", "1,2,x", "1,2,3m", "1,2,0", "1,2,-1", "1,2,nan", "{", "{\"height\": 1}",
        "{\"azimuth\": \"left\"}", "{\"target\": [1, 2]}", "{\"field_of_view\": 180}"}) {
    const auto camera = parse_camera(text);
    ASSERT_FALSE(camera) << text;
    EXPECT_EQ(camera.error().kind, thin::ErrorKind::configuration);
  }
  EXPECT_NE(parse_camera("nan,2,2").error().message.find("is no camera"), std::string::npos);
}

TEST(CameraTest, RaysAndDepthsAreThoseOfTheClipMatrix) {
  const Camera camera = *parse_camera("-70,50,1.3");
  const View view(camera, 300, 200);
  const Eigen::Vector3d point(0.12, -0.2, 0.3);  // model, diagonals
  const Eigen::Vector4d eye = view.eye_from_model * point.homogeneous();
  const Eigen::Vector3d clipped = (view.clip_from_eye * eye).hnormalized();
  const Eigen::Vector2d pixel((clipped.x() + 1) * 150, (clipped.y() + 1) * 100);
  EXPECT_NEAR(pixel.x() * view.ray_scale.x() + view.ray_offset.x(), eye.x() / -eye.z(), 1e-12);
  EXPECT_NEAR(pixel.y() * view.ray_scale.y() + view.ray_offset.y(), eye.y() / -eye.z(), 1e-12);
  EXPECT_NEAR(view.depth_line.x() - view.depth_line.y() / -eye.z(), (clipped.z() + 1) / 2, 1e-12);
}

}  // namespace
}  // namespace emap
