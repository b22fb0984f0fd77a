#include "libemap/surface/model_file.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>

#include "libemap/surface/model_parsers.h"
#include "tests/support/shared_data.h"
#include "tests/support/surfaces.h"

namespace emap {
namespace {

namespace fs = std::filesystem;

Bytes bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

std::string path_of(const std::string& name) {
  return (fs::path(testing::TempDir()) / name).string();
}

void write_file(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

template <class Value>
std::string big_endian(Value value) {
  std::string bytes(reinterpret_cast<const char*>(&value), sizeof(value));
  return {bytes.rbegin(), bytes.rend()};
}

const std::string kAsciiPly =
    "ply\r\nformat ascii 1.0\r\ncomment made by hand\r\nelement vertex 4\r\nproperty double z\r\nproperty float x\r\n"
    "property float y\r\nproperty uchar red\r\nelement face 1\r\nproperty list uchar int "
    "vertex_indices\r\nend_header\r\n"
    "1 0 0 255\r\n1 1 0 255\r\n2 1 1 255\r\n1.5 0 1 255\r\n4 0 1 2 3\r\n";

TEST(ModelFile, AsciiPlyWithItsPropertiesInAnyOrder) {
  const thin::Result<Model> model = parse_ply(bytes_of(kAsciiPly));
  ASSERT_TRUE(model) << model.error().message;
  ASSERT_EQ(model->positions.size(), 4U);
  EXPECT_EQ(model->positions[2], Eigen::Vector3d(1, 1, 2));
  EXPECT_EQ(model->triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}}));
}

TEST(ModelFile, BigEndianPly) {
  std::string text =
      "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property double z\nelement face 1\nproperty list uchar ushort vertex_index\nend_header\n";
  for (int i = 0; i < 3; ++i) text += big_endian(float(i)) + big_endian(float(i * i)) + big_endian(-0.5);
  text += '\3' + big_endian(std::uint16_t{0}) + big_endian(std::uint16_t{1}) + big_endian(std::uint16_t{2});
  const thin::Result<Model> model = parse_ply(bytes_of(text));
  ASSERT_TRUE(model) << model.error().message;
  EXPECT_EQ(model->positions[2], Eigen::Vector3d(2, 4, -0.5));
  EXPECT_EQ(model->triangles.size(), 1U);
}

TEST(ModelFile, WhatIsWrittenIsRead) {
  const Mesh mesh = test::torus(9);
  ASSERT_TRUE(write_ply(path_of("torus.ply"), mesh,
                        {.precise = true, .triangle_colours = std::vector<Colour>(mesh.triangles.size(), {1, 2, 3})}));
  const Mesh read = *read_mesh(path_of("torus.ply"));
  EXPECT_EQ(read.positions, mesh.positions);
  EXPECT_EQ(read.triangles, mesh.triangles);

  const PointSet points{{{1, 2, 3}, {4, 5, 6}}, {{0, 0, 1}, {0, 1, 0}}};
  ASSERT_TRUE(write_ply(path_of("points.ply"), points));
  const PointSet read_back = *read_points(path_of("points.ply"));
  EXPECT_EQ(read_back.positions, points.positions);
  EXPECT_EQ(read_back.normals, points.normals);
}

TEST(ModelFile, Obj) {
  const auto model =
      parse_obj(bytes_of("# cube side\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1/3 3//2 -1\n"));
  ASSERT_TRUE(model) << model.error().message;
  EXPECT_EQ(model->triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}}));
}

TEST(ModelFile, OffWithItsCountsOnEitherLine) {
  for (const char* text :
       {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "OFF 3 1 0 # counts\n0 0 0\n1 0 0\n\n0 1 0\n3 0 1 2 255 0 0\n"}) {
    const auto model = parse_off(bytes_of(text));
    ASSERT_TRUE(model) << model.error().message;
    EXPECT_EQ(model->positions.size(), 3U);
    EXPECT_EQ(model->triangles.size(), 1U);
  }
}

TEST(ModelFile, StlTextAndBinaryAreWelded) {
  const auto text = parse_stl(bytes_of(
      "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
      "facet normal 0 0 1\nouter loop\nvertex 1 0 -0\nvertex 1 1 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid s\n"));
  ASSERT_TRUE(text) << text.error().message;
  EXPECT_EQ(text->positions.size(), 4U);
  std::string binary(80, 's');
  const std::uint32_t count = 1;
  binary.append(reinterpret_cast<const char*>(&count), 4);
  const std::array<float, 12> facet = {0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0};
  binary.append(reinterpret_cast<const char*>(facet.data()), sizeof(facet)).append(2, '\0');
  const auto model = parse_stl(bytes_of(binary));
  ASSERT_TRUE(model) << model.error().message;
  EXPECT_EQ(model->positions.size(), 2U);
  EXPECT_EQ(model->triangles.front(), (std::array<std::uint32_t, 3>{0, 1, 1}));
}

TEST(ModelFile, XyzWithAndWithoutNormals) {
  EXPECT_EQ(parse_xyz(bytes_of("0 0 0 0 0 1\n1,2,3,0,0,1\n"))->normals.size(), 2U);
  EXPECT_TRUE(parse_xyz(bytes_of("0 0 0 0 0 1\n1 2 3\n"))->normals.empty());
}

TEST(ModelFile, ErrorsNameFileElementValueAndRemedy) {
  const std::string nan_vertex =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 "
      "0\n0 nan 0\n";
  const std::string far_index = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n";
  const struct {
    const char* name;
    std::string text;
    std::vector<std::string> wanted;
  } cases[] = {
      {"nan.ply", nan_vertex, {"nan.ply", "vertex 1", "nan", "remove"}},
      {"far.off", far_index, {"far.off", "line 6", "vertex 7", "3 vertices"}},
      {"word.xyz", "0 0 0\n1 2 x\n", {"word.xyz", "line 2", "three numbers"}},
      {"cut.ply", kAsciiPly.substr(0, kAsciiPly.size() - 6), {"cut.ply", "face 0", "cut off"}},
      {"promise.ply",
       "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\nproperty float y\nproperty "
       "float z\nend_header\n",
       {"4000000000", "cut off"}},
      {"head.ply", "ply\nformat ascii 1.0\nelement vertex\nend_header\n", {"line 3", "element vertex"}},
      {"face.obj", "v 0 0 0\nf 1 1 2\n", {"line 2", "vertex 1"}},
      {"what.step", "", {"what.step", ".step", "convert"}},
  };
  for (const auto& wrong : cases) {
    write_file(path_of(wrong.name), wrong.text);
    const thin::Result<Model> model = read_model(path_of(wrong.name));
    ASSERT_FALSE(model) << wrong.name;
    for (const std::string& part : wrong.wanted)
      EXPECT_NE(model.error().message.find(part), std::string::npos) << model.error().message << "\nlacks " << part;
  }
  EXPECT_FALSE(read_model(path_of("absent.ply")));
  write_file(path_of("empty.ply"), "ply\nformat ascii 1.0\nend_header\n");
  EXPECT_FALSE(read_mesh(path_of("empty.ply")));
  EXPECT_FALSE(read_points(path_of("empty.ply")));
}

TEST(ModelFile, EveryCutOfAFileIsAnErrorOrAModel) {
  const Mesh mesh = test::waves(3);
  ASSERT_TRUE(write_ply(path_of("whole.ply"), mesh));
  std::ifstream file(path_of("whole.ply"), std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(file), {}};
  for (const std::string& text : {whole, kAsciiPly})
    for (std::size_t size = 0; size + 1 < text.size(); ++size) {
      const thin::Result<Model> model = parse_ply(bytes_of(text.substr(0, size)));
      if (model) {
        EXPECT_GE(size + 4, text.size());
      }
    }
}

TEST(ModelFile, TheDragonIsReadInAboutASecond) {
  THIN_REQUIRE_SHARED_DATA();
  const std::clock_t start = std::clock();
  const thin::Result<Mesh> dragon = read_mesh((thin::test::shared_data() / "models" / "dragon.ply").string());
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  ASSERT_TRUE(dragon);
  EXPECT_EQ(dragon->positions.size(), 437645U);
  EXPECT_EQ(dragon->triangles.size(), 871414U);
#ifdef NDEBUG
  EXPECT_LT(seconds, 1.5);
#else
  EXPECT_LT(seconds, 20);  // sanitizers
#endif
}

}  // namespace
}  // namespace emap
