#include "tools/program/options/solver_options.h"

#include <limits>

#include "tools/program/text/parse.h"

namespace weft::tools {
namespace {

Result<int> parse_substeps(std::string_view option, std::string_view text) {
  if (text == "auto") return kAutomaticSubsteps;
  const auto count = parse_count(text);
  if (!count || *count < 1 || *count > std::numeric_limits<int>::max()) {
    return Error{fmt::format("{}: '{}' is not a whole number above 0", option, text)};
  }
  return static_cast<int>(*count);
}

template <class Value>
using Parse = Result<Value> (*)(std::string_view option, std::string_view text);

struct Anticipate {
  bool any = true, products = false;
};
Result<Anticipate> parse_anticipate(std::string_view option, std::string_view text) {
  if (text == "products") return Anticipate{true, true};
  if (text != "on" && text != "off") {
    return Error{fmt::format("{}: '{}' is not one of on, off, products", option, text)};
  }
  return Anticipate{text == "on", false};
}

/// Sets the field from the text, if there is one.
template <class Value>
Result<void> choose(std::string_view option, const std::optional<std::string>& text,
                    Parse<Value> parse, Value& field) {
  if (!text) return {};
  const auto value = parse(option, *text);
  if (!value) return Error{value.error()};
  field = value.value();
  return {};
}

}  // namespace

void add_solver_options(Verb verb, SolverOptions& options) {
  Settings& settings = options.settings;
  verb.option("--tolerance", options.tolerance,
              "strain that every step must reach, 1% or 0.01 (default 1%)");
  verb.option("--iterations", settings.iterations,
              "exactly this many iterations in each substep, instead of a tolerance");
  verb.option(
      "--max-iterations", settings.max_iterations,
      "most iterations of a step, shared by its substeps (default 1000000); small_steps with "
      "--substeps N: beyond N sweeps, from 0");
  verb.option("--contact-tolerance", settings.contact_tolerance,
              "m of penetration left (default 1e-4)");
  verb.option("--velocity-tolerance", settings.velocity_tolerance,
              "m/s left along a constraint (default 0.01)");
  verb.option("--motion-tolerance", settings.motion_tolerance,
              "m/s by which particles may come to differ from the true motion, held by the number "
              "of substeps, small_steps (default 0: not asked for)");
  verb.option("--impulse-limit", settings.measuring.impulse_limit,
              "--backend reference: N s, largest impulse of one correction (default 0: no limit)");
  verb.option("--solver", options.solver,
              "auto (default), small_steps, gauss_seidel, yarn or direct; gauss_seidel where "
              "--anticipate, --skip or --directions choose among its methods");
  verb.option("--scheme", options.scheme,
              "auto (default): bdf2 with small_steps, else paper. small_steps: implicit, "
              "or bdf2: second order; the other solvers: paper, or rattle: second order, implies "
              "--velocity-correction on");
  verb.option(
      "--anticipate", options.anticipate,
      "on (default) or off: update errors instead of recomputing them; simd: skip by flags, or by "
      "masks (off); products: simd, through stored products of neighbouring directions");
  verb.option("--skip", options.skip, "on (default) or off: pass over satisfied constraints");
  verb.option("--directions", options.directions,
              "frozen (default) until all errors along them are within tolerance, or each: "
              "renewed before each iteration");
  verb.option("--velocity-correction", options.velocity_correction,
              "on or off (default): a second loop, on velocities; --scheme rattle has it always");
  verb.option("--renew-after", settings.measuring.renew_after,
              "frozen directions serve for at most so many iterations (default 32; 0: until all "
              "errors along them are within tolerance)");
  verb.option("--backend", options.backend, "simd (default) or reference");
  verb.option("--isa", options.isa,
              "--backend simd: sse2, avx2, avx512, neon or auto (default: WEFT_ISA, else the best "
              "there is)");
  verb.option(
      "--sleep", options.sleep,
      "on or off (default): steps of a cloth that rests do nothing until something changes");
  verb.option("--threads", settings.threads,
              "most threads of a step (default 0: one for each processor)");
  verb.option("--substeps", options.substeps,
              "steps that a frame is done in, each to the tolerances; auto: as many as the motion "
              "wants (default: auto with --solver auto, else 1)");
}

Result<Settings> settings_of(const SolverOptions& options) {
  Settings settings = options.settings;
  Anticipate anticipate{settings.measuring.anticipate, settings.measuring.anticipate_products};
  const Result<void> checks[] = {
      choose("--tolerance", options.tolerance, parse_tolerance, settings.tolerance),
      choose("--solver", options.solver, parse_choice<Solver>, settings.solver),
      choose("--scheme", options.scheme, parse_choice<Scheme>, settings.scheme),
      choose("--anticipate", options.anticipate, parse_anticipate, anticipate),
      choose("--skip", options.skip, parse_switch, settings.measuring.skip),
      choose("--directions", options.directions, parse_choice<Directions>,
             settings.measuring.directions),
      choose("--velocity-correction", options.velocity_correction, parse_switch,
             settings.velocity_correction),
      choose("--sleep", options.sleep, parse_switch, settings.sleep),
      choose("--backend", options.backend, parse_choice<Backend>, settings.backend),
      choose("--isa", options.isa, parse_choice<Isa>, settings.isa),
      choose("--substeps", options.substeps, parse_substeps, settings.substeps),
  };
  for (const Result<void>& check : checks) {
    if (!check) return Error{check.error()};
  }
  settings.measuring.anticipate = anticipate.any;
  settings.measuring.anticipate_products = anticipate.products;
  const bool methods = options.anticipate || options.skip || options.directions;
  if (methods && !options.solver) settings.solver = Solver::gauss_seidel;
  const bool chooses_substeps =
      settings.solver == Solver::automatic || settings.solver == Solver::small_steps;
  if (!chooses_substeps && !options.substeps) settings.substeps = 1;
  return settings;
}

}  // namespace weft::tools
