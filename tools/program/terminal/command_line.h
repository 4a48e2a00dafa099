/// The command line: verbs, each with options. CLI11 is command_line.cpp's alone: whatever includes
/// its header takes ten seconds more to compile.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
}

namespace weft::tools {

/// Options of one verb. What is not given keeps its value.
class Verb {
 public:
  explicit Verb(CLI::App& verb) : verb_(verb) {}

  /// The heading, in the help, of the options that are added after it.
  void group(const std::string& heading);
  /// Value: std::string, int, double, or an optional one of them.
  template <class Value>
  void option(const std::string& name, Value& value, const std::string& help);
  void required(const std::string& name, std::string& value, const std::string& help);
  void within(int least, int most, const std::string& name, std::optional<int>& value,
              const std::string& help);
  /// May be given several times.
  void repeated(const std::string& name, std::vector<std::string>& values, const std::string& help);
  /// One or more without a name, all of them needed.
  void several(const std::string& name, std::vector<std::string>& values, const std::string& help);
  /// May be given alone, and then has the value `alone`.
  void option_or_flag(const std::string& name, std::optional<std::string>& value,
                      const std::string& alone, const std::string& help);
  void flag(const std::string& name, bool& value, const std::string& help);

 private:
  CLI::App& verb_;
};

struct Example {
  std::string_view command;
  std::string_view meaning;
};

/// A verb and its options, "--size" and so on.
struct VerbNames {
  std::string verb;
  std::vector<std::string> options;
};

class CommandLine {
 public:
  /// The examples begin its help.
  CommandLine(const std::string& about, const std::string& version,
              std::span<const Example> examples);
  ~CommandLine();

  /// run: returns the exit code.
  Verb add_verb(const std::string& name, const std::string& about, std::function<int()> run);
  /// Runs the verb that is named. Returns the exit code: kRefused if there is none, if something
  /// given makes no sense, or if the verb threw.
  int run(int argc, char** argv);
  std::vector<VerbNames> verbs() const;

 private:
  std::unique_ptr<CLI::App> app_;
  int exit_code_;
};

}  // namespace weft::tools
