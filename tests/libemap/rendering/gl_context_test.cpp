#include "libemap/rendering/gl_context.h"

#include <gtest/gtest.h>

#include "libemap/rendering/gl_functions.h"

namespace emap {
namespace {

TEST(GlContextTest, BothBackendsDraw) {
  for (const Backend backend : {Backend::egl, Backend::osmesa}) {
    const auto context = create_context(backend);
    ASSERT_TRUE(context) << context.error().message;
    GLint major = 0;
    glGetIntegerv(GL_MAJOR_VERSION, &major);
    EXPECT_GE(major, 3);
    EXPECT_NE((*context)->renderer().find("OpenGL"), std::string::npos);
  }
}

TEST(GlContextTest, ContextsOfBothKindsTakeTurns) {
  auto egl = *create_context(Backend::egl);
  auto osmesa = *create_context(Backend::osmesa);
  for (int turn = 0; turn < 3; ++turn)
    for (GlContext* context : {egl.get(), osmesa.get()}) {
      ASSERT_TRUE(context->make_current());
      GLuint buffer = 0;
      glGenBuffers(1, &buffer);
      EXPECT_NE(buffer, 0U);
      glDeleteBuffers(1, &buffer);
      EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    }
}

TEST(GlContextTest, WhatIsMissingIsNamedWithItsPackage) {
  const ContextLibraries none = {"libNoEGL.so.1", "libNoOSMesa.so.8:libNoOSMesa.so.6"};
  const auto egl = create_context(Backend::egl, none);
  ASSERT_FALSE(egl);
  EXPECT_EQ(egl.error().kind, thin::ErrorKind::configuration);
  EXPECT_NE(egl.error().message.find("package libegl1"), std::string::npos);
  EXPECT_NE(egl.error().message.find("--backend osmesa"), std::string::npos);
  const auto osmesa = create_context(Backend::osmesa, none);
  ASSERT_FALSE(osmesa);
  EXPECT_NE(osmesa.error().message.find("package libosmesa6"), std::string::npos);
  const auto either = create_context(Backend::automatic, none);
  ASSERT_FALSE(either);
  EXPECT_NE(either.error().message.find("libegl1"), std::string::npos);
  EXPECT_NE(either.error().message.find("libosmesa6"), std::string::npos);
}

TEST(GlContextTest, WithoutEglTheAutomaticChoiceIsOsmesa) {
  const auto context = create_context(Backend::automatic, {.egl = "libNoEGL.so.1"});
  ASSERT_TRUE(context);
  EXPECT_EQ((*context)->backend(), "osmesa");
}

// A library that is there, but is not OSMesa.
TEST(GlContextTest, AStrangersLibraryIsRefused) {
  const auto context = create_osmesa_context("libc.so.6");
  ASSERT_FALSE(context);
  EXPECT_NE(context.error().message.find("too old"), std::string::npos);
}

TEST(GlContextTest, BackendsHaveNames) {
  EXPECT_EQ(find_backend("auto"), Backend::automatic);
  EXPECT_EQ(find_backend("egl"), Backend::egl);
  EXPECT_EQ(find_backend("osmesa"), Backend::osmesa);
  EXPECT_EQ(find_backend("glx"), std::nullopt);
}

}  // namespace
}  // namespace emap
