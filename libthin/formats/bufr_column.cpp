#include "libthin/formats/bufr_column.h"

namespace thin {

Result<BufrColumn> BufrColumn::read(const EccodesMessage& message, const BufrHeader& header, const std::string& key,
                                    int rank) {
  BufrColumn column;
  const auto subsets = static_cast<std::size_t>(header.subset_count);
  // In an uncompressed message ranks run on over the subsets; without rank, all of them come at once.
  const Result<void> read =
      message.numbers(header.compressed ? "#" + std::to_string(rank) + "#" + key : key, column.values_);
  if (!read) return read.error();
  const std::size_t count = column.values_.size();
  if (header.compressed) {
    column.stride_ = count == subsets && subsets > 1 ? 1 : 0;
    if (count == 1 || count == subsets) return column;
  } else if (count > 0 && count % subsets == 0 && count / subsets >= static_cast<std::size_t>(rank)) {
    column.stride_ = count / subsets;
    column.values_.erase(column.values_.begin(), column.values_.begin() + (rank - 1));
    return column;
  }
  return Error{ErrorKind::input, key + " has " + std::to_string(count) + " values for " + std::to_string(subsets) +
                                     " subsets: its subsets are not all built alike"};
}

}  // namespace thin
