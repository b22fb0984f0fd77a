// The yardstick for `thin run`: what a bare ecCodes loop needs to unpack the same files, with nothing done to them.
//   bare_unpack FILE...

#include <eccodes.h>

#include <cstdio>

int main(int argc, char** argv) {
  long messages = 0;
  for (int i = 1; i < argc; ++i) {
    FILE* file = std::fopen(argv[i], "rb");
    if (!file) {
      std::perror(argv[i]);
      return 1;
    }
    int error = 0;
    while (codes_handle* message = codes_handle_new_from_file(nullptr, file, PRODUCT_BUFR, &error)) {
      if (codes_set_long(message, "unpack", 1) != CODES_SUCCESS) return 1;
      codes_handle_delete(message);
      ++messages;
    }
    std::fclose(file);
  }
  std::printf("%ld messages\n", messages);
}
