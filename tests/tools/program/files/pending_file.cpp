#include "tools/program/files/pending_file.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "tests/tools/temporary_folder.h"

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

TEST_CASE("two that are under way to one place do not meet, and the later one stays") {
  const TemporaryFolder folder;
  auto first = PendingFile::open(folder.file("a.txt"));
  auto second = PendingFile::open(folder.file("a.txt"));
  REQUIRE(first);
  REQUIRE(second);
  first.value().write("a longer text");
  second.value().write("short");
  CHECK(first.value().commit());
  CHECK(folder.read("a.txt") == "a longer text");
  CHECK(second.value().commit());
  CHECK(folder.read("a.txt") == "short");
}

TEST_CASE("what replaces a file has its permissions") {
  using std::filesystem::perms;
  const TemporaryFolder folder;
  folder.write("a.txt", "private");
  const perms own = perms::owner_read | perms::owner_write;
  std::filesystem::permissions(folder.file("a.txt"), own);
  CHECK(write_file(folder.file("a.txt"), "new"));
  CHECK(folder.read("a.txt") == "new");
  CHECK(std::filesystem::status(folder.file("a.txt")).permissions() == own);
}

TEST_CASE("a symbolic link stays, and what it leads to is written") {
  const TemporaryFolder folder;
  folder.write("old.txt", "old");
  std::filesystem::create_directory(folder.file("links"));
  for (const std::string target : {"old.txt", "new.txt"}) {
    CAPTURE(target);
    const std::string link = folder.file("links/" + target);
    std::filesystem::create_symlink("../" + target, link);
    CHECK(write_file(link, "written"));
    CHECK(std::filesystem::is_symlink(link));
    CHECK(folder.read(target) == "written");
  }
}

TEST_CASE("a link to itself is refused, and stays") {
  const TemporaryFolder folder;
  const std::string link = folder.file("link.txt");
  std::filesystem::create_symlink("link.txt", link);
  const auto file = PendingFile::open(link);
  REQUIRE_FALSE(file);
  CHECK(file.error().starts_with("cannot write '" + link + "': "));
  CHECK(std::filesystem::is_symlink(link));
}

TEST_CASE("a pipe behind a link is written in place") {
  int ends[2];
  REQUIRE(pipe(ends) == 0);
  CHECK(write_file("/dev/fd/" + std::to_string(ends[1]), "text"));
  char text[5] = {};
  CHECK(read(ends[0], text, 4) == 4);
  CHECK(std::string(text) == "text");
  close(ends[0]);
  close(ends[1]);
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
