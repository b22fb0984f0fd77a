#include "libthin/formats/bufr_tank_tables.h"

#include <array>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "libthin/formats/bufr_data.h"

namespace thin {
namespace {

// The elements that tables are written in. They never change, and are here so that a file's tables can be read without
// any other.
const std::shared_ptr<const BufrTables>& tables_of_tables() {
  static const std::shared_ptr<const BufrTables> tables = [] {
    auto made = std::make_shared<BufrTables>();
    const std::pair<int, unsigned> widths_in_characters[] = {{1, 3},  {2, 32}, {3, 32},  {4, 3},   {5, 2},   {10, 1},
                                                             {11, 2}, {12, 3}, {13, 32}, {14, 32}, {15, 24}, {16, 1},
                                                             {17, 3}, {18, 1}, {19, 10}, {20, 3},  {30, 6}};
    for (const auto& [descriptor, characters] : widths_in_characters)
      made->add_element(descriptor, {BufrElement::Kind::text, 0, 0, 8 * characters});
    made->add_element(31000, {BufrElement::Kind::number, 0, 0, 1});
    made->add_element(31001, {BufrElement::Kind::number, 0, 0, 8});
    made->add_element(31002, {BufrElement::Kind::number, 0, 0, 16});
    made->add_sequence(300003, {10, 11, 12});
    made->add_sequence(300004, {300003, 13, 14, 15, 16, 17, 18, 19, 20});
    return made;
  }();
  return tables;
}

std::string_view trimmed(std::string_view text) {
  const auto is_blank = [](char letter) { return letter == ' ' || letter == '\0'; };
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::optional<std::int64_t> whole_number(std::string_view text) {
  text = trimmed(text);
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

// Reads the entries of one message, text by text in their order.
class Entries {
 public:
  explicit Entries(BufrTables& into) : into_(into) {}

  void take(int element, const std::string& text) {
    if (element >= 10 && element <= 20) parts_[static_cast<std::size_t>(element - 10)] = text;
    if (element == 10) members_.clear();
    if (element == 20) add_element();
    if (element == 30) add_member(text);
  }

 private:
  const std::string& part(int element) const { return parts_[static_cast<std::size_t>(element - 10)]; }

  // F, X and Y, of elements 10 to 12, as FXXYYY.
  std::optional<int> descriptor() const {
    const auto f = whole_number(part(10)), x = whole_number(part(11)), y = whole_number(part(12));
    if (!f || !x || !y || *f < 0 || *f > 3 || *x < 0 || *x > 63 || *y < 0 || *y > 255) return std::nullopt;
    return static_cast<int>(*f * 100'000 + *x * 1000 + *y);
  }

  void add_element() {
    const auto number = descriptor();
    const auto scale = whole_number(part(17)), reference = whole_number(part(19)), width = whole_number(part(20));
    if (!number || *number >= 100'000 || !scale || !reference || !width || *width <= 0) return;
    const std::string_view unit = trimmed(part(15));
    const BufrElement::Kind kind = unit.starts_with("CCITT")                      ? BufrElement::Kind::text
                                   : unit == "CODE TABLE" || unit == "FLAG TABLE" ? BufrElement::Kind::code_or_flags
                                                                                  : BufrElement::Kind::number;
    into_.add_element(*number, {kind, static_cast<int>(trimmed(part(16)) == "-" ? -*scale : *scale),
                                trimmed(part(18)) == "-" ? -*reference : *reference, static_cast<unsigned>(*width)});
  }

  void add_member(const std::string& text) {
    const auto sequence = descriptor();
    const auto member = whole_number(text);
    if (!sequence || *sequence < 300'000 || !member || *member < 0) return;
    // NCEP's own signs for "the next one, as often as the data say", with a count of 16, 8, 8 and 1 bits.
    constexpr int kCounts[] = {31002, 31001, 31001, 31000};
    if (*member >= 360001 && *member <= 360004)
      members_.insert(members_.end(), {101000, kCounts[*member - 360001]});
    else
      members_.push_back(static_cast<int>(*member));
    into_.add_sequence(*sequence, members_);
  }

  BufrTables& into_;
  std::array<std::string, 11> parts_;  // of elements 10 to 20
  std::vector<int> members_;
};

}  // namespace

Result<void> BufrFileTables::take(std::span<const std::uint8_t> message, const BufrHeader& header) {
  std::shared_ptr<BufrTables> own = behind_data_ ? nullptr : std::move(own_);
  own_.reset();
  behind_data_ = false;
  in_force_.reset();
  if (header.subset_count == 0) {
    own_ = std::move(own);
    return {};
  }
  if (header.compressed) return Error{ErrorKind::input, "its tables are compressed, which is not read"};
  const Result<BufrData> data = BufrData::walk(message, header, *tables_of_tables());
  if (!data) return data.error();
  own_ = own ? std::move(own) : std::make_shared<BufrTables>();
  Entries entries(*own_);
  for (const AlikeSubsets& group : data->groups())
    for (std::size_t subset = 0; subset < group.count; ++subset)
      for (const BufrField& field : group.fields)
        if (field.text) entries.take(field.descriptor, data->text(group, field, subset));
  return {};
}

Result<std::shared_ptr<const BufrTables>> BufrFileTables::for_data(const BufrHeader& header) {
  auto installed = installed_tables(header);
  if (!own_) return installed;
  // Where ecCodes lacks WMO's version, the file's own tables may still say all.
  const std::shared_ptr<const BufrTables>& beneath = installed ? *installed : tables_of_tables();
  if (!in_force_ || installed_ != beneath) {
    auto layers = std::make_shared<BufrTables>();
    layers->put_above(own_);
    layers->put_above(beneath);
    in_force_ = std::move(layers);
    installed_ = beneath;
  }
  return in_force_;
}

}  // namespace thin
