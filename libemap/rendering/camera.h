#pragma once

// Where a picture is taken from. The model is thought of as moved and scaled so that its bounding box has its centre at
// the origin and a diagonal of 1: "diagonals" below.

#include <Eigen/Geometry>
#include <string>

#include "libthin/foundation/result.h"

namespace emap {

// Looks at the origin from direction (cos(elevation) sin(azimuth), sin(elevation), cos(elevation) cos(azimuth)); the
// model's y-axis is up.
struct Camera {
  double azimuth_degrees = 30;
  double elevation_degrees = 15;
  double distance = 2;  // of the eye from what it looks at, diagonals
  double field_of_view_degrees = 30;
  // What it looks at instead of the centre, diagonals.
  Eigen::Vector3d target = Eigen::Vector3d::Zero();
};

// "azimuth,elevation,distance", or a JSON object with any of azimuth, elevation, distance, field_of_view and target (a
// list of three). Errors (configuration): no such text, a distance or field of view that shows nothing.
thin::Result<Camera> parse_camera(const std::string& text);

// Model space scaled to diagonals -> eye space: x to the right, y up, looking along -z.
Eigen::Isometry3d eye_from_model(const Camera& camera);

// Distances along the view, diagonals, that hold everything within half a diagonal of the origin and before the eye.
struct DepthRange {
  double nearest, farthest;
};
DepthRange depth_range(const Camera& camera);

// What OpenGL clips by, for pictures of this width over height.
Eigen::Matrix4d clip_from_eye(const Camera& camera, double aspect);

}  // namespace emap
