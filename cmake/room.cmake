# thin_room(NAME FOLDER SOURCES ... USES ... LIBRARIES ... PRIVATE_LIBRARIES ...)
#
# One folder of the house as one static library. Its headers are reachable only through an include directory of its
# own, which holds nothing but a link to that folder: `#include "libthin/thinning/..."` compiles only where the
# including room names thin_thinning among USES, directly or through a room that does. So an arrow that the drawing in
# docs/architecture.md does not have fails to compile, whatever else is on disk.
function(thin_room name folder)
  cmake_parse_arguments(ROOM "" "" "SOURCES;USES;LIBRARIES;PRIVATE_LIBRARIES" ${ARGN})
  set(gate ${CMAKE_BINARY_DIR}/rooms/${name})
  cmake_path(GET folder PARENT_PATH parent)
  file(MAKE_DIRECTORY ${gate}/${parent})
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/${folder} ${gate}/${folder} SYMBOLIC)
  list(TRANSFORM ROOM_SOURCES PREPEND ${PROJECT_SOURCE_DIR}/${folder}/)
  add_library(${name} STATIC ${ROOM_SOURCES})
  target_include_directories(${name} PUBLIC ${gate})
  target_link_libraries(${name} PUBLIC ${ROOM_USES} ${ROOM_LIBRARIES} PRIVATE ${ROOM_PRIVATE_LIBRARIES})
endfunction()
