// Runs every input of the fuzz targets' corpus with the compiler of the package: a regression test
// that needs no libFuzzer.
#include "targets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace wiimote_tracker::fuzz {
namespace {

using Input = std::vector<std::uint8_t>;

struct Target {
  const char* name;
  void (*run)(const std::uint8_t*, std::size_t);
};

class FuzzCorpus : public testing::TestWithParam<Target> {};

std::vector<std::filesystem::path> corpusOf(const std::string& target) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(FUZZ_CORPUS "/" + target))
    files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

Input read(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return Input(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
}

TEST_P(FuzzCorpus, BreaksNothing) {
  const auto files = corpusOf(GetParam().name);
  ASSERT_FALSE(files.empty());
  for (const auto& file : files) {
    const Input input = read(file);
    EXPECT_NO_THROW(GetParam().run(input.data(), input.size())) << file;
  }
}

TEST_P(FuzzCorpus, TruncatedAnywhereBreaksNothing) {
  for (const auto& file : corpusOf(GetParam().name)) {
    const Input input = read(file);
    const std::size_t step = std::max<std::size_t>(1, input.size() / 8);
    for (std::size_t size = 0; size < input.size(); size += step)
      EXPECT_NO_THROW(GetParam().run(input.data(), size)) << file << " cut off at " << size;
  }
}

INSTANTIATE_TEST_SUITE_P(Targets,
                         FuzzCorpus,
                         testing::Values(Target{"eeprom", fuzzEeprom},
                                         Target{"replay", fuzzReplay},
                                         Target{"reports", fuzzReports},
                                         Target{"session", fuzzSession},
                                         Target{"wiimote", fuzzWiimote}),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace wiimote_tracker::fuzz
