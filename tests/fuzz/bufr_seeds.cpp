// Files to begin with, small ones of every shape, written by the tests' own writers: seeds_bufr FOLDER

#include <cstdio>
#include <string>
#include <vector>

#include "tests/support/bufr_messages.h"
#include "tests/support/tank_writer.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("seeds_bufr FOLDER\n", stderr);
    return 2;
  }
  using namespace thin::test;
  int written = 0;
  const auto write = [&](const ByteVector& bytes) {
    write_bytes(std::string(argv[1]) + "/seed" + std::to_string(++written), bytes);
  };
  const std::vector<MessageShape> shapes = {
      {},
      {.compressed = false},
      {.edition = 3},
      {.edition = 3, .compressed = false},
      {.descriptors = {310008}, .slots_per_subset = 19},
      {.descriptors = {310009, 33007, 12063}, .temperatures_behind = 1},
      {.descriptors = {310009, 101002, 33007}},
      {.ecmwf_section2 = true},
  };
  for (const MessageShape& shape : shapes)
    for (const int count : {1, 3}) write(make_message(test_soundings(count), shape));
  write(bulletin(make_message(test_soundings(2))));

  const std::vector<TankShape> tanks = {{},
                                        {.instrument = 203, .channels = 5, .sequence = 361234},
                                        {.channels = 3, .compressed = false},
                                        {.channels = 3, .counted_channels = true},
                                        {.channels = 3, .compressed = false, .counted_channels = true}};
  for (const TankShape& shape : tanks) {
    const ByteVector data = tank_data_message(tank_soundings(3, shape), shape);
    write(joined({tank_table_message(tank_tables(shape)), {0, 0}, data, data}));
  }
  std::printf("%d seeds\n", written);
}
