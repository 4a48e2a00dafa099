/// One word per choice and per stage, the same in reports, options, benchmarks and tests.
#include <weft/weft.h>

namespace weft {

Settings paper_settings() {
  Settings settings;
  settings.solver = Solver::gauss_seidel;
  settings.scheme = Scheme::paper;
  settings.substeps = 1;
  return settings;
}

std::string_view name(Solver solver) {
  switch (solver) {
    case Solver::gauss_seidel:
      return "gauss_seidel";
    case Solver::direct:
      return "direct";
    case Solver::yarn:
      return "yarn";
    case Solver::small_steps:
      return "small_steps";
    case Solver::automatic:
      return "auto";
  }
  return "unknown";
}

std::string_view name(Scheme scheme) {
  switch (scheme) {
    case Scheme::paper:
      return "paper";
    case Scheme::rattle:
      return "rattle";
    case Scheme::implicit:
      return "implicit";
    case Scheme::bdf2:
      return "bdf2";
    case Scheme::automatic:
      return "auto";
  }
  return "unknown";
}

std::string_view name(Directions directions) {
  switch (directions) {
    case Directions::each:
      return "each";
    case Directions::frozen:
      return "frozen";
  }
  return "unknown";
}

std::string_view name(Backend backend) {
  switch (backend) {
    case Backend::reference:
      return "reference";
    case Backend::simd:
      return "simd";
  }
  return "unknown";
}

std::string_view name(Isa isa) {
  switch (isa) {
    case Isa::automatic:
      return "auto";
    case Isa::sse2:
      return "sse2";
    case Isa::avx2:
      return "avx2";
    case Isa::avx512:
      return "avx512";
    case Isa::neon:
      return "neon";
  }
  return "unknown";
}

std::string_view name(Status status) {
  switch (status) {
    case Status::converged:
      return "converged";
    case Status::fixed_iterations:
      return "fixed_iterations";
    case Status::iteration_limit:
      return "iteration_limit";
    case Status::infeasible:
      return "infeasible";
    case Status::passed_through:
      return "passed_through";
    case Status::non_finite_input:
      return "non_finite_input";
    case Status::non_finite:
      return "non_finite";
  }
  return "unknown";
}

std::string_view name(Stage stage) {
  switch (stage) {
    case Stage::predict:
      return "predict";
    case Stage::find_contacts:
      return "find_contacts";
    case Stage::solve_positions:
      return "solve_positions";
    case Stage::commit:
      return "commit";
    case Stage::correct_velocities:
      return "correct_velocities";
    case Stage::report:
      return "report";
  }
  return "unknown";
}

}  // namespace weft
