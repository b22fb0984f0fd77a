#include "libemap/tools/emap_file.h"

#include "libthin/foundation/file_bytes.h"

namespace emap {

thin::Result<DecodedStream> read_emap_file(const std::string& path) {
  const thin::Result<std::vector<std::uint8_t>> bytes = thin::read_file_bytes(path);
  if (!bytes) return bytes.error();
  thin::Result<DecodedStream> decoded = read_stream(*bytes);
  if (!decoded) return thin::Error{decoded.error().kind, path + ": " + decoded.error().message};
  return decoded;
}

}  // namespace emap
