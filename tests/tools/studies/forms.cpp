/// The closed forms hold; and what they are held against is right itself.
#include <doctest/doctest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/studies/forms/elastica.h"
#include "tools/studies/forms/form.h"
#include "tools/studies/forms/oscillation.h"
#include "tools/studies/forms/results.h"

namespace weft::tools::forms {
namespace {

void check(const std::vector<Form>& forms) {
  for (const Form& form : forms) {
    const FormResult result = measure(form);
    CAPTURE(form.name);
    CAPTURE(result.readings[0].error());
    CAPTURE(result.readings[1].error());
    CAPTURE(result.readings[2].error());
    CHECK(result.holds());
    CHECK(result.readings[2].ms_per_frame > 0);
  }
}

TEST_CASE("what stretches and shears") { check(membrane_forms()); }
TEST_CASE("what bends") { check(bending_forms()); }
TEST_CASE("what is folded at rest") { check(fold_forms()); }
TEST_CASE("what yields and rubs where it bends" * doctest::test_suite("slow")) {
  check(crease_forms());
}
TEST_CASE("what a force or a moment bends by its end") { check(end_forms()); }
TEST_CASE("a slit annular plate" * doctest::test_suite("slow")) { check(annulus_forms()); }
TEST_CASE("strips of named fabrics") { check(fabric_forms()); }
TEST_CASE("soap films" * doctest::test_suite("slow")) { check(film_forms()); }
TEST_CASE("what falls and decays") { check(motion_forms()); }
TEST_CASE("what lies on bodies and slides") { check(body_forms()); }
TEST_CASE("what lies on other layers, slides and stands" * doctest::test_suite("slow")) {
  check(layer_forms());
}
TEST_CASE("what air presses" * doctest::test_suite("slow")) { check(pressure_forms()); }

TEST_CASE("a heavy strip that is short sags by load / 8, a long one hangs down by its length") {
  CHECK(heavy_elastica(0.01).y == doctest::Approx(-0.01 / 8).epsilon(1e-4));
  CHECK(heavy_elastica(0.01).x == doctest::Approx(1).epsilon(1e-5));
  CHECK(heavy_elastica(1000).y < -0.9);
  CHECK(heavy_elastica(1000).y > -1);
}

TEST_CASE("a force at the end of a strip: load / 3 where it is small, 0.670 and 0.329 at 4") {
  CHECK(end_loaded_elastica(0.01).y == doctest::Approx(-0.01 / 3).epsilon(1e-4));
  CHECK(end_loaded_elastica(4).y == doctest::Approx(-0.670).epsilon(1e-3));
  CHECK(1 - end_loaded_elastica(4).x == doctest::Approx(0.329).epsilon(2e-3));
}

TEST_CASE("a strip that is hardly buckled is half a sine wave: height 2 / pi sqrt(nearer)") {
  CHECK(buckled_height(1e-4) == doctest::Approx(2 / M_PI * 1e-2).epsilon(1e-3));
  // Of modulus sin(50 degrees): 2 E / K - 1 = 0.6445..., from tables of both integrals.
  const double p = std::sin(50 * M_PI / 180), k = 1.9355810960, e = 1.3055390943;
  CHECK(buckled_height(2 - 2 * e / k) == doctest::Approx(p / k).epsilon(1e-6));
}

TEST_CASE("frequency and decrement of samples") {
  std::vector<double> samples;
  for (int k = 0; k < 50; ++k) samples.push_back(std::exp(-0.3 * 0.1 * k) * std::cos(0.2 * k + 1));
  const Oscillation seen = oscillation_of(samples, 0.1);
  CHECK(seen.frequency == doctest::Approx(2));
  CHECK(seen.decrement == doctest::Approx(0.3 * M_PI));
}

FormResult made_up(std::vector<double> measured) {
  FormResult result{"a form", "formula", "mm", 0.02, true, {}};
  for (const double m : measured) {
    result.readings.push_back({.size = "1 cell", .expected = 1, .measured = m, .ms_per_frame = 2});
  }
  return result;
}

TEST_CASE("a form holds if its finest error is within the bound, and small or falling") {
  CHECK(made_up({1.1, 1.05, 0.985}).holds());
  CHECK(made_up({1.001, 1.002, 1.004}).holds());
  CHECK_FALSE(made_up({1.1, 1.05, 1.025}).holds());
  CHECK_FALSE(made_up({1.01, 1.01, 1.015}).holds());
  CHECK_FALSE(made_up({1, 1, std::nan("")}).holds());
  CHECK(made_up({1.1, 1.05}).holds());  // the finest was left out
  FormResult same = made_up({1.01, 1.01, 1.015}), off = made_up({1.1, 1.01, 1.01});
  same.converges = off.converges = false;
  CHECK(same.holds());
  CHECK_FALSE(off.holds());
  FormResult missed = made_up({1, 1, 1});
  missed.readings[1].missed = 1;
  CHECK_FALSE(missed.holds());
}

TEST_CASE("text, Markdown and JSON tell error and time, and what does not hold") {
  const std::vector<FormResult> results{made_up({1.02, 1.01, 1.001}), made_up({1, 1, 1.5})};
  const std::string text = to_text(results);
  CHECK(text.find("+2.00, +1.00, +0.10") != std::string::npos);
  CHECK(text.ends_with("FAIL\n1 hold, 1 do not\n"));
  CHECK(to_markdown(results).find("| a form **fails** | formula |") != std::string::npos);
  const Json json = to_json(results);
  CHECK(json["failed"] == 1);
  CHECK(json["forms"][1]["holds"] == false);
  CHECK(json["forms"][0]["readings"][2]["ms_per_frame"] == 2);
}

}  // namespace
}  // namespace weft::tools::forms
