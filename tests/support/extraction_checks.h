#pragma once

// Extractions from one file, each beside the oracle: the retained subsets, all their keys, and nothing else.

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <string>
#include <vector>

#include "libthin/formats/observation_file.h"
#include "tests/support/bufr_messages.h"
#include "tests/support/bufr_oracle.h"

namespace thin::test {

struct Selection {
  std::string name;
  std::vector<SourceReference> retained;
};

// Structured and random subsets of `all`.
inline std::vector<Selection> selections_of(const std::vector<SourceReference>& all, unsigned seed) {
  std::mt19937 random(seed);
  const auto where = [&](const std::string& name, auto condition) {
    Selection selection{name, {}};
    for (std::size_t i = 0; i < all.size(); ++i)
      if (condition(i)) selection.retained.push_back(all[i]);
    return selection;
  };
  return {where("all", [](std::size_t) { return true; }),
          where("all but the first", [](std::size_t i) { return i != 0; }),
          where("the first", [](std::size_t i) { return i == 0; }),
          where("the last", [&](std::size_t i) { return i + 1 == all.size(); }),
          where("every third", [](std::size_t i) { return i % 3 == 0; }),
          where("the first message", [&](std::size_t i) { return all[i].message == 0; }),
          where("half, at random", [&](std::size_t) { return random() % 2 == 0; }),
          where("a tenth, at random", [&](std::size_t i) { return random() % 10 == 0 || i == 5; })};
}

// The header keys that may change: how many subsets there are, ecCodes's own numbering of them, ECMWF's count.
inline bool is_count_key(const std::string& key) {
  return key == "numberOfSubsets" || key == "subsetNumber" || key == "localNumberOfObservations";
}

inline void expect_kept(const OracleMessage& original, const std::vector<std::uint32_t>& subsets,
                        const OracleMessage& extracted) {
  ASSERT_EQ(extracted.subset_count, subsets.size());
  ASSERT_EQ(extracted.header.size(), original.header.size());
  for (const auto& [key, value] : original.header)
    EXPECT_TRUE(is_count_key(key) || extracted.header.at(key) == value) << key;
  ASSERT_EQ(extracted.data.size(), original.data.size());
  for (const auto& [key, values] : original.data) {
    const auto found = extracted.data.find(key);
    ASSERT_NE(found, extracted.data.end()) << key;
    for (std::size_t i = 0; i < subsets.size(); ++i) ASSERT_EQ(found->second[i], values[subsets[i]]) << key << " " << i;
  }
}

// Extracts selections of everything that can be read from `path`, and compares every key of every retained subset.
inline void expect_extractions_keep_everything(const std::string& path, unsigned seed) {
  const Result<ReadObservations> contents = read_observations(path);
  ASSERT_TRUE(contents.ok()) << contents.error().message;
  const std::vector<OracleMessage> originals = decode_file_slowly(path);
  for (const Selection& selection : selections_of(contents->observations.source, seed)) {
    SCOPED_TRACE(path + ", " + selection.name);
    std::map<std::uint32_t, std::vector<std::uint32_t>> by_message;
    for (const SourceReference& reference : selection.retained)
      by_message[reference.message].push_back(reference.subset);
    const ScratchFolder folder;
    const auto summary = extract_observations(path, selection.retained, folder.path("out"), {});
    ASSERT_TRUE(summary.ok()) << summary.error().message;
    EXPECT_EQ(summary->messages, by_message.size());
    EXPECT_EQ(summary->subsets, selection.retained.size());

    const std::vector<OracleMessage> extracted = decode_file_slowly(folder.path("out"));
    ASSERT_EQ(extracted.size(), by_message.size());
    std::size_t place = 0;
    for (const auto& [message, subsets] : by_message) expect_kept(originals[message], subsets, extracted[place++]);

    // Once more: the same bytes.
    ASSERT_TRUE(extract_observations(path, selection.retained, folder.path("again"), {}).ok());
    EXPECT_EQ(read_bytes(folder.path("again")), read_bytes(folder.path("out")));
  }
}

// The same for one selection of a file of compressed messages that are too long to be kept as text. Messages of tables
// stand where they stood.
inline void expect_extraction_keeps_values(const std::string& path, const std::vector<SourceReference>& retained) {
  const ScratchFolder folder;
  const auto summary = extract_observations(path, retained, folder.path("out"), {});
  ASSERT_TRUE(summary.ok()) << summary.error().message;
  EXPECT_EQ(summary->subsets, retained.size());
  std::map<std::uint32_t, std::vector<std::uint32_t>> by_message;
  for (const SourceReference& reference : retained) by_message[reference.message].push_back(reference.subset);

  std::vector<KeyedMessage> extracted;
  for_each_keyed_message(folder.path("out"),
                         [&](std::uint32_t, KeyedMessage message) { extracted.push_back(std::move(message)); });
  ASSERT_EQ(extracted.size(), by_message.size());
  std::size_t place = 0;
  for_each_keyed_message(path, [&](std::uint32_t number, const KeyedMessage& original) {
    const auto found = by_message.find(number);
    if (found == by_message.end()) return;
    const KeyedMessage& kept = extracted[place++];
    const std::vector<std::string> keys = original.data_keys();
    ASSERT_EQ(kept.data_keys(), keys);
    ASSERT_EQ(kept.subset_count, found->second.size());
    const auto value = [](const std::vector<double>& values, std::size_t i) {
      return values.size() == 1 ? values[0] : values.at(i);
    };
    for (const std::string& key : keys)
      for (std::size_t i = 0; i < found->second.size(); ++i)
        ASSERT_EQ(value(kept.values(key), i), value(original.values(key), found->second[i])) << key << " " << number;
  });
}

}  // namespace thin::test
