#include "libemap/rendering/camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <vector>

namespace emap {
namespace {

using thin::Error;
using thin::ErrorKind;
using thin::Result;

constexpr double kDegree = std::numbers::pi / 180;

std::optional<std::vector<double>> numbers_of(const std::string& text) {
  std::vector<double> numbers;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    std::size_t read = 0;
    try {
      numbers.push_back(std::stod(word, &read));
    } catch (const std::exception&) {
      return std::nullopt;
    }
    if (read != word.size()) return std::nullopt;
    begin = end + 1;
  }
  return numbers;
}

Error no_camera(const std::string& text) {
  return {ErrorKind::configuration,
          fmt::format("\"{}\" is no camera: write azimuth,elevation,distance (degrees, degrees, diagonals: 30,15,2) or "
                      "a JSON object with azimuth, elevation, distance, field_of_view, target",
                      text)};
}

Result<Camera> camera_of_json(const std::string& text) {
  const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object()) return no_camera(text);
  Camera camera;
  for (const auto& [key, value] : json.items()) {
    if (key == "target" && value.is_array() && value.size() == 3) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!value[axis].is_number()) return no_camera(text);
        camera.target[static_cast<Eigen::Index>(axis)] = value[axis];
      }
      continue;
    }
    double* field = key == "azimuth"         ? &camera.azimuth_degrees
                    : key == "elevation"     ? &camera.elevation_degrees
                    : key == "distance"      ? &camera.distance
                    : key == "field_of_view" ? &camera.field_of_view_degrees
                                             : nullptr;
    if (!field || !value.is_number()) return no_camera(text);
    *field = value;
  }
  return camera;
}

}  // namespace

Result<Camera> parse_camera(const std::string& text) {
  Camera camera;
  if (text.find('{') != std::string::npos) {
    const Result<Camera> parsed = camera_of_json(text);
    if (!parsed) return parsed.error();
    camera = *parsed;
  } else {
    const auto numbers = numbers_of(text);
    if (!numbers || numbers->size() != 3) return no_camera(text);
    camera.azimuth_degrees = (*numbers)[0];
    camera.elevation_degrees = (*numbers)[1];
    camera.distance = (*numbers)[2];
  }
  const bool finite = std::isfinite(camera.azimuth_degrees) && std::isfinite(camera.elevation_degrees) &&
                      std::isfinite(camera.distance) && camera.target.allFinite();
  if (!finite) return no_camera(text);
  if (!(camera.distance > 0) || camera.distance > 1e4)
    return Error{ErrorKind::configuration,
                 fmt::format("a camera at a distance of {} diagonals shows nothing: choose more than 0 and at most 1e4",
                             camera.distance)};
  if (!(camera.field_of_view_degrees >= 0.1 && camera.field_of_view_degrees <= 150))
    return Error{ErrorKind::configuration,
                 fmt::format("a field of view of {} degrees: choose 0.1 to 150", camera.field_of_view_degrees)};
  return camera;
}

Eigen::Isometry3d eye_from_model(const Camera& camera) {
  Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
  place.translate(Eigen::Vector3d(0, 0, -camera.distance));
  place.rotate(Eigen::AngleAxisd(camera.elevation_degrees * kDegree, Eigen::Vector3d::UnitX()));
  place.rotate(Eigen::AngleAxisd(-camera.azimuth_degrees * kDegree, Eigen::Vector3d::UnitY()));
  place.translate(-camera.target);
  return place;
}

DepthRange depth_range(const Camera& camera) {
  const double centre = -(eye_from_model(camera) * Eigen::Vector3d::Zero()).z();
  const double farthest = std::max(centre + 0.52, 1e-3);
  return {std::max(centre - 0.52, farthest * 1e-3), farthest};
}

Eigen::Matrix4d clip_from_eye(const Camera& camera, double aspect) {
  const auto [nearest, farthest] = depth_range(camera);
  const double scale = 1 / std::tan(camera.field_of_view_degrees * kDegree / 2);
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Zero();
  matrix(0, 0) = scale / aspect;
  matrix(1, 1) = scale;
  matrix(2, 2) = -(farthest + nearest) / (farthest - nearest);
  matrix(2, 3) = -2 * farthest * nearest / (farthest - nearest);
  matrix(3, 2) = -1;
  return matrix;
}

}  // namespace emap
