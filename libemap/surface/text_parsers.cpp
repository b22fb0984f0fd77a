// OBJ, OFF and XYZ: one vertex or face a line.

#include <fmt/format.h>

#include <cmath>

#include "libemap/surface/model_parsers.h"
#include "libemap/surface/text_scanner.h"

namespace emap {
namespace {

using thin::Error;
using thin::ErrorKind;
using thin::Result;

Error line_error(const TextScanner& scanner, const std::string& problem) {
  return {ErrorKind::input, scanner.at_line() + ": " + problem};
}

std::optional<Eigen::Vector3d> take_vector(std::string_view& line) {
  Eigen::Vector3d vector;
  for (double& component : vector) {
    const std::optional<double> number = TextScanner::take_number<double>(line);
    if (!number) return std::nullopt;
    component = *number;
  }
  return vector;
}

Error no_vector(const TextScanner& scanner, std::string_view line) {
  return line_error(scanner, fmt::format("three numbers are wanted, not \"{}\"", line.substr(0, 60)));
}

// "7", "7/2", "7/2/5", "7//5", or from the end: "-1". OBJ counts from 1.
std::optional<std::int64_t> take_obj_index(std::string_view& line, std::size_t vertex_count) {
  std::string_view word = TextScanner::take_word(line);
  word = word.substr(0, std::min(word.find('/'), word.size()));
  const auto index = TextScanner::take_number<std::int64_t>(word);
  if (!index || *index == 0) return std::nullopt;
  return *index > 0 ? *index - 1 : static_cast<std::int64_t>(vertex_count) + *index;
}

Result<void> parse_obj_face(const TextScanner& scanner, std::string_view line, std::vector<std::int64_t>& corners,
                            Model& model) {
  corners.clear();
  for (line = TextScanner::trimmed(line); !line.empty(); line = TextScanner::trimmed(line)) {
    const std::optional<std::int64_t> index = take_obj_index(line, model.positions.size());
    if (!index) return line_error(scanner, "a face names vertices by number, from 1");
    corners.push_back(*index);
  }
  if (const Result<void> done = append_polygon(corners, model.positions.size(), model); !done)
    return line_error(scanner, done.error().message);
  return {};
}

struct OffCounts {
  std::size_t vertices = 0, faces = 0;
  bool with_normals = false;
};

// "OFF", "NOFF", "COFF", ... with the counts behind it or on the next line.
Result<OffCounts> parse_off_counts(TextScanner& scanner) {
  OffCounts counts;
  std::optional<std::string_view> line = scanner.next_line();
  if (line && line->find("OFF") != std::string_view::npos) {
    const std::string_view keyword = TextScanner::take_word(*line);
    counts.with_normals = keyword.find('N') != std::string_view::npos;
    if (TextScanner::trimmed(*line).empty()) line = scanner.next_line();
  }
  const auto vertices = line ? TextScanner::take_number<std::size_t>(*line) : std::nullopt;
  const auto faces = line ? TextScanner::take_number<std::size_t>(*line) : std::nullopt;
  if (!vertices || !faces) return line_error(scanner, "the numbers of vertices, faces and edges are wanted here");
  // A vertex takes six bytes of text at least, a face two.
  if (*vertices > scanner.bytes_left() / 6 + 1 || *faces > scanner.bytes_left() / 2 + 1)
    return Error{ErrorKind::incomplete,
                 fmt::format("it promises {} vertices and {} faces, more than it holds: it is cut "
                             "off",
                             *vertices, *faces)};
  counts.vertices = *vertices;
  counts.faces = *faces;
  return counts;
}

Result<void> parse_off_face(const TextScanner& scanner, std::string_view line, std::vector<std::int64_t>& corners,
                            Model& model) {
  corners.clear();
  const auto count = TextScanner::take_number<std::size_t>(line);
  for (std::size_t i = 0; count && i < *count; ++i) {
    const auto index = TextScanner::take_number<std::int64_t>(line);
    if (!index) break;
    corners.push_back(*index);
  }
  if (!count || corners.size() != *count)
    return line_error(scanner, "a face is its number of vertices and as many indices");
  if (const Result<void> done = append_polygon(corners, model.positions.size(), model); !done)
    return line_error(scanner, done.error().message);
  return {};
}

}  // namespace

Result<Model> parse_obj(Bytes bytes) {
  TextScanner scanner(bytes);
  Model model;
  std::vector<std::int64_t> corners;
  while (std::optional<std::string_view> line = scanner.next_line()) {
    const std::string_view keyword = TextScanner::take_word(*line);
    if (keyword == "v" || keyword == "vn") {
      const std::optional<Eigen::Vector3d> vector = take_vector(*line);
      if (!vector) return no_vector(scanner, *line);
      (keyword == "v" ? model.positions : model.normals).push_back(*vector);
    } else if (keyword == "f") {
      if (const Result<void> done = parse_obj_face(scanner, *line, corners, model); !done) return done.error();
    }
  }
  // OBJ's normals belong to corners; they are the points' own only where there is one for each and no face.
  if (model.is_mesh() || model.normals.size() != model.positions.size()) model.normals.clear();
  return model;
}

Result<Model> parse_off(Bytes bytes) {
  TextScanner scanner(bytes);
  const Result<OffCounts> counts = parse_off_counts(scanner);
  if (!counts) return counts.error();
  Model model;
  std::vector<std::int64_t> corners;
  for (std::size_t i = 0; i < counts->vertices + counts->faces; ++i) {
    std::optional<std::string_view> line = scanner.next_line();
    if (!line)
      return Error{ErrorKind::incomplete, fmt::format("it ends after {} of {} vertices and faces: the file is cut off",
                                                      i, counts->vertices + counts->faces)};
    if (i >= counts->vertices) {
      if (const Result<void> done = parse_off_face(scanner, *line, corners, model); !done) return done.error();
      continue;
    }
    const std::optional<Eigen::Vector3d> position = take_vector(*line);
    const std::optional<Eigen::Vector3d> normal = counts->with_normals ? take_vector(*line) : std::nullopt;
    if (!position || (counts->with_normals && !normal)) return no_vector(scanner, *line);
    model.positions.push_back(*position);
    if (normal) model.normals.push_back(*normal);
  }
  return model;
}

Result<Model> parse_xyz(Bytes bytes) {
  TextScanner scanner(bytes);
  Model model;
  bool every_point_has_a_normal = true;
  while (std::optional<std::string_view> line = scanner.next_line()) {
    const std::optional<Eigen::Vector3d> position = take_vector(*line);
    if (!position) return no_vector(scanner, *line);
    model.positions.push_back(*position);
    const std::optional<Eigen::Vector3d> normal = take_vector(*line);
    every_point_has_a_normal = every_point_has_a_normal && normal;
    if (every_point_has_a_normal) model.normals.push_back(*normal);
  }
  if (!every_point_has_a_normal) model.normals.clear();
  return model;
}

}  // namespace emap
