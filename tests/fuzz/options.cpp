/// Values of options: the first letter says of which.
#include <fmt/format.h>

#include <cmath>
#include <string>

#include "tests/fuzz/checks.h"
#include "tools/program/options/solver_options.h"
#include "tools/program/options/world_options.h"
#include "tools/program/text/numbered_name.h"
#include "tools/program/text/parse.h"

namespace weft::fuzz {
namespace {

/// Whether it was accepted; a refusal names the option.
template <class T>
bool accepted(const Result<T>& result) {
  if (result) return note_accepted(), true;
  check_message(result.error());
  return false;
}

void try_numbers(std::string_view text) {
  if (const auto number = tools::parse_number(text)) {
    check(std::isfinite(*number), "a number is finite");
    check(tools::parse_number(fmt::format("{}", *number)) == *number, "a number is read again");
  }
  if (const auto integer = tools::parse_integer(text))
    check(tools::parse_integer(std::to_string(*integer)) == *integer, "an integer is read again");
  if (const auto count = tools::parse_count(text))
    check(*count >= 0 && tools::parse_count(std::to_string(*count)) == *count,
          "a count is read again");
  if (const auto numbers = tools::parse_numbers(text)) {
    for (const double number : *numbers) check(std::isfinite(number), "numbers are finite");
  }
  if (const auto ranges = tools::parse_ranges(text)) {
    for (const tools::NumberRange& range : *ranges) {
      check(range.at(0) == range.first, "a range begins with its first number");
      if (range.last < range.first || range.last - range.first < 1000)
        check(range.count() >= 1, "a range has a number");
    }
  }
}

void try_quantities(std::string_view text) {
  if (const auto seconds = tools::parse_seconds("--dt", text); accepted(seconds))
    check(seconds.value() > 0 && std::isfinite(seconds.value()), "a time is above 0");
  if (const auto tolerance = tools::parse_tolerance("--tolerance", text); accepted(tolerance))
    check(tolerance.value() > 0 && std::isfinite(tolerance.value()), "a tolerance is above 0");
  if (const auto vector = tools::parse_vector("--gravity", text); accepted(vector))
    check(std::isfinite(vector.value().x + 0 * vector.value().y), "a vector is finite");
  accepted(tools::parse_switch("--skip", text));
}

void try_solver(std::string_view text) {
  for (const auto option : {&tools::SolverOptions::tolerance, &tools::SolverOptions::solver,
                            &tools::SolverOptions::scheme, &tools::SolverOptions::directions,
                            &tools::SolverOptions::backend, &tools::SolverOptions::isa,
                            &tools::SolverOptions::substeps}) {
    tools::SolverOptions given;
    given.*option = std::string(text);
    accepted(tools::settings_of(given));
  }
}

void try_name(std::string_view text) {
  const auto name = tools::NumberedName::of(text);
  if (!name) return;
  check(name->with(7) != name->with(8), "files of a series have different names");
  const std::size_t percent = text.rfind('%');
  check(name->with(7).starts_with(text.substr(0, percent)) &&
            name->with(7).ends_with(text.substr(text.find('d', percent) + 1)),
        "a name keeps what is around its number");
  note_accepted();
}

void try_world(std::string_view text) {
  const std::string value(text);
  SceneDescription scene;
  scene.positions = {{0, 0, 0}};
  scene.masses = {1};
  for (const auto& options :
       {tools::WorldOptions{.gravity = value}, tools::WorldOptions{.spheres = {value}},
        tools::WorldOptions{.planes = {value}}, tools::WorldOptions{.body_dt = value}}) {
    SceneDescription surrounded = scene;
    std::vector<tools::SceneBody> bodies;
    if (!accepted(tools::surround(options, surrounded, bodies))) continue;
    const auto model = build_model(surrounded);
    if (!model) check_message(model.error());
  }
}

}  // namespace
}  // namespace weft::fuzz

extern "C" int WEFT_FUZZ_TARGET(options)(const std::uint8_t* data, std::size_t size) {
  using namespace weft::fuzz;
  if (size == 0) return 0;
  const std::string_view text = argument_of(data + 1, size - 1);
  switch (data[0]) {
    case 'n':
      try_numbers(text);
      break;
    case 'q':
      try_quantities(text);
      break;
    case 's':
      try_solver(text);
      break;
    case 'f':
      try_name(text);
      break;
    default:
      try_world(text);
  }
  return 0;
}
