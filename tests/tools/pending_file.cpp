#include "tools/pending_file.h"

#include <doctest/doctest.h>

#include "temporary_folder.h"

namespace weft::tools {
namespace {

TEST_CASE("a file appears under its name when it is committed") {
  const TemporaryFolder folder;
  folder.write("a.txt", "old");
  auto file = PendingFile::open(folder.file("a.txt"));
  REQUIRE(file);
  file.value().write("new");
  CHECK(folder.read("a.txt") == "old");
  CHECK(file.value().commit());
  CHECK(folder.read("a.txt") == "new");
}

TEST_CASE("a file that is not committed leaves nothing") {
  const TemporaryFolder folder;
  {
    auto file = PendingFile::open(folder.file("a.txt"));
    REQUIRE(file);
    file.value().write("half");
  }
  CHECK(folder.is_empty());
}

TEST_CASE("a place that cannot be written is refused at once") {
  const TemporaryFolder folder;
  const auto file = PendingFile::open(folder.file("missing/a.txt"));
  REQUIRE_FALSE(file);
  CHECK(file.error() ==
        "cannot write '" + folder.file("missing/a.txt") + "': No such file or directory");
  CHECK_FALSE(PendingFile::open(folder.file("")));
}

TEST_CASE("a device is written in place, and a full one is told") {
  auto file = PendingFile::open("/dev/full");
  REQUIRE(file);
  file.value().write("x");
  CHECK_FALSE(file.value().commit());
}

}  // namespace
}  // namespace weft::tools
