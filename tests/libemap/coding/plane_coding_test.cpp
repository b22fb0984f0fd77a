#include "libemap/coding/plane_coding.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <numbers>
#include <random>

#include "tests/support/random32.h"

namespace emap {
namespace {

using Eigen::Vector3d;

StreamFrame test_frame() {
  StreamFrame frame;
  frame.box = {Vector3d(-3, 10, 2), Vector3d(1, 12, 9)};
  frame.samples_per_diagonal = 300;
  return frame;
}

std::vector<Vector3d> random_positions(const StreamFrame& frame, test::Random32& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Vector3d> positions;
  for (int i = 0; i < 20; ++i)
    positions.push_back(
        frame.box.minimum +
        (frame.box.maximum - frame.box.minimum).cwiseProduct(Vector3d(unit(random), unit(random), unit(random))));
  return positions;
}

BasePlane random_plane(test::Random32& random) {
  std::normal_distribution<double> normal;
  BasePlane plane;
  plane.normal = Vector3d(normal(random), normal(random), normal(random)).normalized();
  plane.axis_u = plane.normal.cross(Vector3d(normal(random), normal(random), normal(random))).normalized();
  plane.axis_v = plane.normal.cross(plane.axis_u);
  return plane;
}

TEST(PlaneCoding, QuantisedPlanesAreOrthonormalAndNear) {
  test::Random32 random(1);
  const StreamFrame frame = test_frame();
  for (int round = 0; round < 500; ++round) {
    const BasePlane plane = random_plane(random);
    const auto positions = random_positions(frame, random);
    const CodedPlane coded = quantise_plane(plane, positions, frame);
    const BasePlane found = base_plane_of(coded, frame);
    Eigen::Matrix3d axes;
    axes << found.axis_u, found.axis_v, found.normal;
    EXPECT_LT((axes.transpose() * axes - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    EXPECT_NEAR(axes.determinant(), 1, 1e-12);
    EXPECT_GT(found.normal.dot(plane.normal), std::cos(0.3 * std::numbers::pi / 180));
    // Whole quarter turns apart, the axes are the plane's.
    const double along = std::max(std::abs(found.axis_u.dot(plane.axis_u)), std::abs(found.axis_u.dot(plane.axis_v)));
    EXPECT_GT(along, std::cos(1.1 * std::numbers::pi / 180));
    for (const Vector3d& position : positions) {
      EXPECT_GE((position - found.origin).dot(found.axis_u), -1e-9);
      EXPECT_GE((position - found.origin).dot(found.axis_v), -1e-9);
    }
  }
}

TEST(PlaneCoding, ReadsBackWhatWasWritten) {
  test::Random32 random(2);
  const StreamFrame frame = test_frame();
  RangeEncoder encoder;
  std::vector<CodedPlane> written;
  for (int i = 0; i < 100; ++i) {
    CodedPlane plane = quantise_plane(random_plane(random), random_positions(frame, random), frame);
    plane.columns = random() % 302;
    plane.rows = random() % 302;
    written.push_back(plane);
    code_plane(encoder, plane, frame);
  }
  const auto bytes = encoder.finish();
  EXPECT_NEAR(static_cast<double>(bytes.size()), 100.0 * plane_bits(frame) / 8, 2);
  RangeDecoder decoder(bytes);
  for (const CodedPlane& plane : written) {
    CodedPlane read;
    code_plane(decoder, read, frame);
    EXPECT_EQ(read, plane);
  }
}

}  // namespace
}  // namespace emap
