#include "tools/program/terminal/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>
#include <new>
#include <span>
#include <string_view>
#include <utility>

#include "tools/program/terminal/exit_code.h"
#include "tools/program/text/parse.h"
#include "tools/program/text/wrapping.h"

namespace weft::tools {
namespace {

/// "run, scene or hard"
std::string verbs(const CLI::App& app) {
  const auto all = app.get_subcommands([](const CLI::App*) { return true; });
  std::string text;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const char* separator = i == 0 ? "" : i + 1 < all.size() ? ", " : " or ";
    text += separator + all[i]->get_name();
  }
  return text;
}

/// In words that name the cure.
std::string missing_verb(const CLI::App& app, int argc, char** argv) {
  const std::string_view first = argc > 1 ? argv[1] : "";
  if (first.empty() || first.starts_with('-')) return "a verb is missing: " + verbs(app);
  return fmt::format("'{}' is not a verb: {}", first, verbs(app));
}

/// In their order; CLI11's own message has it reversed.
std::string unexpected(const std::vector<std::string>& arguments) {
  return fmt::format("not expected: {}", fmt::join(arguments, " "));
}

template <class Value>
struct Plain {
  using Type = Value;
};
template <class Value>
struct Plain<std::optional<Value>> {
  using Type = Value;
};

/// CLI11 alone takes 010 for 8, and an empty text for a value that was not given.
std::string refusal(const std::string& text, int) {
  return parse_integer(text) ? "" : fmt::format("'{}' is not a whole number", text);
}
std::string refusal(const std::string& text, double) {
  return parse_number(text) ? "" : fmt::format("'{}' is not a number", text);
}
std::string refusal(const std::string& text, const std::string&) {
  return text.empty() ? "'' names nothing" : "";
}

/// In the form that CLI11 reads as what it says.
std::string decimal(const std::string& text, int) { return std::to_string(*parse_integer(text)); }
template <class Other>
std::string decimal(const std::string& text, const Other&) {
  return text;
}

template <class Value>
CLI::Option* checked(CLI::Option* option) {
  const auto check = [](std::string& text) {
    const Value kind{};
    std::string refused = refusal(text, kind);
    if (refused.empty()) text = decimal(text, kind);
    return refused;
  };
  return option->transform(CLI::Validator(check, ""));
}

/// Help that is no wider than a terminal.
class Help : public CLI::Formatter {
 public:
  explicit Help(std::span<const Example> examples) {
    for (const Example& example : examples)
      examples_ +=
          in_columns(fmt::format("  {}", example.command), example.meaning, kExampleColumn);
  }
  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override {
    if (app->get_parent() != nullptr)
      return CLI::detail::find_and_replace(Formatter::make_help(app, name, mode), "\n\n\n", "\n\n");
    return fmt::format(
        "{}\n\nFor example:\n{}\nVerbs (each explains its options: weft VERB --help):\n{}{}",
        app->get_description(), examples_, verbs_of(*app), make_groups(app, mode));
  }
  std::string make_option(const CLI::Option* option, bool is_positional) const override {
    return in_columns("  " + make_option_name(option, is_positional) + make_option_opts(option),
                      make_option_desc(option), kColumn);
  }

 private:
  static constexpr std::size_t kExampleColumn = 50, kColumn = 28;
  static std::string verbs_of(const CLI::App& app) {
    std::string text;
    for (const CLI::App* verb : app.get_subcommands({}))
      text += in_columns("  " + verb->get_name(), verb->get_description(), 14);
    return text;
  }
  std::string examples_;
};

}  // namespace

void Verb::group(const std::string& heading) { verb_.option_defaults()->group(heading); }

template <class Value>
void Verb::option(const std::string& name, Value& value, const std::string& help) {
  checked<typename Plain<Value>::Type>(verb_.add_option(name, value, help));
}
template void Verb::option(const std::string&, int&, const std::string&);
template void Verb::option(const std::string&, double&, const std::string&);
template void Verb::option(const std::string&, std::string&, const std::string&);
template void Verb::option(const std::string&, std::optional<int>&, const std::string&);
template void Verb::option(const std::string&, std::optional<double>&, const std::string&);
template void Verb::option(const std::string&, std::optional<std::string>&, const std::string&);

void Verb::required(const std::string& name, std::string& value, const std::string& help) {
  checked<std::string>(verb_.add_option(name, value, help))->required();
}

void Verb::within(int least, int most, const std::string& name, std::optional<int>& value,
                  const std::string& help) {
  checked<int>(verb_.add_option(name, value, help))->check(CLI::Range(least, most));
}

void Verb::repeated(const std::string& name, std::vector<std::string>& values,
                    const std::string& help) {
  checked<std::string>(verb_.add_option(name, values, help))->allow_extra_args(false);
}

void Verb::several(const std::string& name, std::vector<std::string>& values,
                   const std::string& help) {
  checked<std::string>(verb_.add_option(name, values, help))->required();
}

void Verb::option_or_flag(const std::string& name, std::optional<std::string>& value,
                          const std::string& alone, const std::string& help) {
  const auto take = [&value, alone](const CLI::results_t& given) {
    value = given.empty() || given[0].empty() ? alone : given[0];
    return true;
  };
  verb_.add_option(name, take, help)->expected(0, 1)->type_name("TEXT");
}

void Verb::flag(const std::string& name, bool& value, const std::string& help) {
  verb_.add_flag(name, value, help);
}

CommandLine::CommandLine(const std::string& about, const std::string& version,
                         std::span<const Example> examples)
    : app_(std::make_unique<CLI::App>(about)), exit_code_(kDone) {
  app_->formatter(std::make_shared<Help>(examples));
  app_->require_subcommand(0, 1);  // none is refused below
  app_->set_version_flag("--version", version, "Print the version and exit");
}

CommandLine::~CommandLine() = default;

Verb CommandLine::add_verb(const std::string& name, const std::string& about,
                           std::function<int()> run) {
  CLI::App* verb = app_->add_subcommand(name, about);
  verb->callback([this, run = std::move(run)] { exit_code_ = run(); });
  return Verb(*verb);
}

int CommandLine::run(int argc, char** argv) {
  try {
    app_->parse(argc, argv);
    if (app_->get_subcommands().empty()) return refuse(missing_verb(*app_, argc, argv));
  } catch (const CLI::ExtrasError&) {
    const bool is_verb = argc > 1 && argv[1][0] != '-' && app_->get_subcommands().empty();
    return refuse(is_verb ? missing_verb(*app_, argc, argv) : unexpected(app_->remaining(true)));
  } catch (const CLI::RequiredError& error) {  // it may be there, and misspelt
    const std::vector<std::string> others = app_->remaining(true);
    return refuse(others.empty() ? error.what() : unexpected(others));
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) return refuse(error.what());
    app_->exit(error);  // help, or the version
    return std::cout.flush() ? kDone : refuse("cannot write to stdout");
  } catch (const std::bad_alloc&) {
    return refuse("not enough memory for this scene");
  } catch (const std::exception& error) {
    return refuse(error.what());
  }
  return exit_code_;
}

std::vector<VerbNames> CommandLine::verbs() const {
  std::vector<VerbNames> all;
  for (const CLI::App* verb : std::as_const(*app_).get_subcommands({})) {
    VerbNames& names = all.emplace_back(verb->get_name());
    for (const CLI::Option* option : verb->get_options()) {
      for (const std::string& name : option->get_lnames()) names.options.push_back("--" + name);
    }
  }
  return all;
}

}  // namespace weft::tools
