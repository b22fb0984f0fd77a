#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "libemap/coding/encoder.h"
#include "tests/support/surfaces.h"

namespace emap::test {

// A ring, longer than wide, with a bump on one side: no view of it is another's mirror image.
inline std::vector<std::uint8_t> ring_stream(const std::string& coder) {
  Mesh mesh = torus(40);
  for (Eigen::Vector3d& position : mesh.positions) {
    position.x() *= 1.4;
    position *= 1 + 0.25 * std::exp(-(position - Eigen::Vector3d(2, 2, 0.5)).squaredNorm());
  }
  const auto surface = mesh_to_encode(mesh, {}, 2000);
  EncoderOptions options;
  options.psnr_db = 62;
  options.samples_per_diagonal = 200;
  options.coder = find_elevation_coder(coder);
  return encode_surface(**surface, options).value().stream;
}

}  // namespace emap::test
