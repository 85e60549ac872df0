/// The fuzzers' corpus without a fuzzer: readers accept any bytes or report invalid input.

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "fuzz/readers.hpp"
#include "support/temporary_folder.hpp"

namespace sandglass::verification::corpus_test {
namespace {

namespace fs = std::filesystem;

class CorpusTest : public ::testing::TestWithParam<Reader> {};

TEST_P(CorpusTest, is_read_or_refused) {
  const TemporaryFolder folder;
  int read = 0, refused = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(SANDGLASS_CORPUS) / GetParam().name)) {
    std::ostringstream stream;
    stream << std::ifstream(entry.path(), std::ios::binary).rdbuf();
    const std::string bytes = stream.str();
    try {
      GetParam().read(std::as_bytes(std::span(bytes)), folder / "input");
      ++read;
    } catch (const InputError& error) {
      EXPECT_STRNE(error.what(), "");
      ++refused;
    } catch (const std::exception& error) {
      ADD_FAILURE() << entry.path() << ": " << error.what();
    }
  }
  EXPECT_GT(read, 0) << "nothing in the corpus is read to its end: it tests the first lines of the reader";
  RecordProperty("read", read);
  RecordProperty("refused", refused);
}

INSTANTIATE_TEST_SUITE_P(EveryReader, CorpusTest, ::testing::ValuesIn(readers),
                         [](const auto& reader) { return std::string(reader.param.name); });

}  // namespace
}  // namespace sandglass::verification::corpus_test
