#include <doctest/doctest.h>
#include <weft/weft.h>

#include <set>
#include <string>

namespace weft::test::engine_cpp_interface_names {
namespace {

TEST_CASE("every choice has the name that the command line and reports call it by") {
  CHECK(name(Solver::gauss_seidel) == "gauss_seidel");
  CHECK(name(Solver::yarn) == "yarn");
  CHECK(name(Solver::direct) == "direct");
  CHECK(name(Solver::small_steps) == "small_steps");
  CHECK(name(Solver::automatic) == "auto");
  CHECK(name(Scheme::paper) == "paper");
  CHECK(name(Scheme::rattle) == "rattle");
  CHECK(name(Scheme::implicit) == "implicit");
  CHECK(name(Scheme::bdf2) == "bdf2");
  CHECK(name(Scheme::automatic) == "auto");
  CHECK(name(Directions::each) == "each");
  CHECK(name(Directions::frozen) == "frozen");
  CHECK(name(Backend::reference) == "reference");
  CHECK(name(Backend::simd) == "simd");
  CHECK(name(Isa::sse2) == "sse2");
  CHECK(name(Isa::avx2) == "avx2");
  CHECK(name(Isa::avx512) == "avx512");
  CHECK(name(Isa::neon) == "neon");
  CHECK(name(Isa::automatic) == "auto");
  CHECK(name(Status::converged) == "converged");
  CHECK(name(Status::fixed_iterations) == "fixed_iterations");
  CHECK(name(Status::iteration_limit) == "iteration_limit");
  CHECK(name(Status::infeasible) == "infeasible");
  CHECK(name(Status::passed_through) == "passed_through");
  CHECK(name(Status::non_finite_input) == "non_finite_input");
  CHECK(name(Status::non_finite) == "non_finite");
  CHECK(name(Stage::find_contacts) == "find_contacts");
}

TEST_CASE("all stages have names, and no two the same") {
  std::set<std::string> names;
  for (std::size_t i = 0; i < kStageCount; ++i) {
    names.insert(std::string(name(static_cast<Stage>(i))));
  }
  CHECK(names.size() == kStageCount);
  CHECK(names.count("unknown") == 0);
}

}  // namespace
}  // namespace weft::test::engine_cpp_interface_names
