/// How long work still takes, as a terminal shows it.
#include "tools/program/terminal/progress.h"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <unistd.h>

#include <cstdlib>
#include <string>
#include <thread>

#include "tests/tools/run_program.h"

namespace weft::tools {
namespace {

/// A terminal that keeps what is written to it.
class Terminal {
 public:
  Terminal() : master_(posix_openpt(O_RDWR | O_NOCTTY)) {
    REQUIRE(master_ >= 0);
    REQUIRE(grantpt(master_) == 0);
    REQUIRE(unlockpt(master_) == 0);
    name_ = ptsname(master_);
    slave_ = open(name_.c_str(), O_RDWR | O_NOCTTY);
    REQUIRE(slave_ >= 0);
    reader_ = std::thread([this] {
      char bytes[512];
      for (ssize_t n = 0; (n = read(master_, bytes, sizeof bytes)) > 0;)
        text_.append(bytes, static_cast<std::size_t>(n));
    });
  }
  const std::string& name() const { return name_; }
  /// Once nobody writes any more.
  std::string text() {
    close(slave_);
    reader_.join();
    close(master_);
    return text_;
  }

 private:
  int master_, slave_ = -1;
  std::string name_, text_;
  std::thread reader_;
};

TEST_CASE("times are in whole seconds upwards, in two units at most") {
  CHECK(duration_text(0) == "0 s");
  CHECK(duration_text(0.2) == "1 s");
  CHECK(duration_text(59.5) == "1 min 0 s");
  CHECK(duration_text(200) == "3 min 20 s");
  CHECK(duration_text(2 * 3600 + 5 * 60 + 59) == "2 h 5 min");
}

TEST_CASE("what is left follows the parts that are done, and forgets a slow beginning") {
  TimeLeft left(10);
  left.add(2);
  CHECK(left.seconds() == doctest::Approx(18));
  left.add(1);
  CHECK(left.seconds() == doctest::Approx(1.5 * 8));
  TimeLeft slow_start(1000);
  slow_start.add(100);
  for (int i = 0; i < 399; ++i) slow_start.add(0.1);
  CHECK(slow_start.seconds() == doctest::Approx(60).epsilon(0.01));
  TimeLeft over(1);
  for (int i = 0; i < 3; ++i) over.add(1);
  CHECK(over.seconds() == 0);
}

TEST_CASE("a run on a terminal shows frames and time left in lines of 80 columns") {
  const TemporaryFolder folder;
  Terminal terminal;
  const std::string command = std::string(WEFT_PROGRAM) +
                              " run hang --size 20 --steps 300 --repeat 2 >" +
                              folder.file("stdout") + " 2>" + terminal.name();
  const int status = std::system(command.c_str());
  const std::string shown = terminal.text();
  CHECK(status == 0);
  CHECK(shown.find("frame 1/300, strain ") != std::string::npos);
  CHECK(shown.find(" s left") != std::string::npos);
  CHECK(shown.ends_with("\r\033[K"));
  for (std::size_t at = 0, end = 0; (end = shown.find('\r', at)) != std::string::npos; at = end + 1)
    CHECK(end - at <= 80);
  CHECK(folder.read("stdout").starts_with("scene     hang: "));
}

TEST_CASE("a study on a terminal says which case is at work, elsewhere a line for each") {
  const TemporaryFolder folder;
  Terminal terminal;
  const std::string study = "forms --quick --form decays";
  const std::string command = std::string(WEFT_PROGRAM) + " " + study + " >" +
                              folder.file("stdout") + " 2>" + terminal.name();
  CHECK(std::system(command.c_str()) == 0);
  CHECK(terminal.text().starts_with("\r["));
  const Outcome elsewhere = run_program(folder, study);
  CHECK(elsewhere.err.starts_with("["));
  CHECK(elsewhere.err.find('\r') == std::string::npos);
  CHECK(elsewhere.err.find(" left") == std::string::npos);
}

}  // namespace
}  // namespace weft::tools
