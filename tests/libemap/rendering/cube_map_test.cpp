#include "libemap/rendering/cube_map.h"

#include <gtest/gtest.h>

#include <set>

namespace emap {
namespace {

TEST(CubeMapTest, FacesArePicturesOfTheDirections) {
  GridCubeMap map;
  map.side_pixels = 64;
  const std::array<Image, 6> faces = map.faces();
  // The centre of a square beside the face's centre, seen along +x: s is -z and t is -y there.
  const Eigen::Vector3d direction(1, 0.125, -0.125);
  const Eigen::Vector3d colour = map.colour(direction);
  const std::uint8_t* pixel = faces[0].pixel(36, 28);
  for (int channel = 0; channel < 3; ++channel) EXPECT_NEAR(pixel[channel], 255 * colour[channel], 1);
}

TEST(CubeMapTest, FacesHaveColoursOfTheirOwnAndBlackLines) {
  const GridCubeMap map;
  std::set<std::array<double, 3>> colours;
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {-1.0, 1.0}) {
      Eigen::Vector3d direction = Eigen::Vector3d::Constant(0.125);
      direction[axis] = sign;
      const Eigen::Vector3d colour = map.colour(direction);
      EXPECT_GT(colour.maxCoeff(), 0.3);
      colours.insert({colour.x(), colour.y(), colour.z()});
      direction[(axis + 1) % 3] = 0.25;  // a whole number of squares from the centre
      EXPECT_EQ(map.colour(direction), Eigen::Vector3d::Zero());
    }
  EXPECT_EQ(colours.size(), 6U);
}

}  // namespace
}  // namespace emap
