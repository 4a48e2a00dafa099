#include <doctest/doctest.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tests/tools/temporary_folder.h"
#include "tools/scenes/scenes.h"
#include "tools/studies/hard/results.h"
#include "tools/studies/hard/suite.h"

namespace weft::tools::hard {
namespace {

CaseResult made_up(double figure, const std::string& failure) {
  CaseResult result{"a/direct", "max strain", {Solver::direct, Scheme::paper}, 1, {}, 0};
  result.outcome.figure = figure;
  result.outcome.failure = failure;
  result.outcome.detail = "detail";
  return result;
}

TEST_CASE("a figure above its bound fails, and so do a reason and what is no number") {
  CHECK(made_up(1, "").passed());
  CHECK_FALSE(made_up(1.01, "").passed());
  CHECK_FALSE(made_up(0, "reason").passed());
  CHECK_FALSE(made_up(std::numeric_limits<double>::quiet_NaN(), "").passed());
}

TEST_CASE("the JSON has the contract's keys, and counts what failed") {
  const Json json = to_json({made_up(1, ""), made_up(2, ""), made_up(0, "reason")});
  CHECK(json["passed"] == 1);
  CHECK(json["failed"] == 2);
  REQUIRE(json["cases"].size() == 3);
  CHECK(json["cases"][0]["name"] == "a/direct");
  CHECK(json["cases"][0]["result"] == "pass");
  CHECK(json["cases"][1]["result"] == "fail");
  CHECK(json["cases"][1]["figure"] == 2);
  CHECK(json["cases"][1]["bound"] == 1);
  CHECK(json["cases"][2]["detail"] == "reason: detail");
}

TEST_CASE("CSV and text tell figure and bound, and what failed") {
  CaseResult result = made_up(2, "reason");
  result.outcome.ms_per_step = 3;
  result.seconds = 4;
  CHECK(to_csv({result}) ==
        "name,solver,scheme,result,measures,figure,bound,ms_per_step,seconds,detail\n"
        "a/direct,direct,paper,fail,\"max strain\",2,1,3,4,\"reason: detail\"\n");
  CHECK(to_text({result}) ==
        "a/direct  FAIL          2 <= 1         max strain; reason: detail\n0 passed, 1 failed\n");
  CHECK(to_markdown({result}).ends_with("\n| a: max strain | 1 | **fail** 2 / 3 |\n"));
  CHECK(failed({result, made_up(1, "")}) == 1);
}

/// Two particles, 1 m apart; the first is fixed.
SceneDescription bar(double rest_length) {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {1, 0, 0}};
  scene.masses = {1, 1};
  scene.fixed = {0};
  scene.constraints = {{0, 1, rest_length}};
  return scene;
}

/// A particle that lies on a sphere.
SceneDescription on_sphere() {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {0, 0.5, 0}};
  scene.masses = {1, 1};
  scene.fixed = {0};
  scene.spheres = {0};
  scene.radii = {0.5, 0};
  return scene;
}

Trial trial_of(const SceneDescription& scene) {
  return {.scene = scene, .settings = {}, .steps = 5};
}

/// Instead of the trial's own a cloth is asked that knows another scene, or other settings.
Observed observe_instead(Trial trial, const SceneDescription& scene, const Settings& settings) {
  trial.before_step = [&](Cloth& cloth, int step) {
    if (step == 0) cloth = std::move(Cloth::create(build_model(scene).value(), settings).value());
  };
  return observe(trial);
}

TEST_CASE("a cloth that tells the truth is believed") {
  for (const SceneDescription& scene : {bar(1), bar(0.8), on_sphere()}) {
    const Observed seen = observe(trial_of(scene));
    CHECK(seen.steps == 5);
    CHECK(seen.missed == 0);
    CHECK(seen.false_claims == 0);
  }
}

TEST_CASE("strain, penetration and success that are not true are false claims") {
  SceneDescription torn = bar(1);
  torn.constraints.clear();
  CHECK(observe_instead(trial_of(bar(1)), torn, {}).false_claims == 5);
  SceneDescription hollow = on_sphere();
  hollow.spheres.clear();
  hollow.radii.clear();
  Trial deep = trial_of(on_sphere());
  deep.settings.contact_tolerance = 1;
  CHECK(observe_instead(deep, hollow, {}).false_claims == 5);

  Settings settings = paper_settings();
  settings.tolerance = 0.5;
  const Observed loose = observe_instead(trial_of(bar(0.8)), bar(0.8), settings);
  CHECK(loose.false_claims == 5);
  CHECK(loose.missed == 0);
  CHECK(loose.max_strain > 0.2);
  settings.contact_tolerance = 1;
  const Observed soft = observe_instead(trial_of(on_sphere()), on_sphere(), settings);
  CHECK(soft.false_claims == 5);
  CHECK(soft.max_penetration > 1e-3);
}

TEST_CASE("layers that cross are seen, and to converge so is a false claim") {
  SceneDescription scene;  // one triangle is held, and another one stands on it and falls
  scene.positions = {{-1, 0, -1}, {-1, 0, 2}, {2, 0, -1}, {0, 0.1, 0}, {0.1, 0.1, 0}, {0, 0.3, 0}};
  scene.masses.assign(6, 1);
  scene.fixed = {0, 1, 2};
  scene.constraints = {{3, 4, 0.1}, {3, 5, 0.2}, {4, 5, std::sqrt(0.05)}};
  scene.surface = {{0, 1, 2}, {3, 4, 5}};
  scene.self_contact.on = true;
  SceneDescription blind = scene;
  blind.self_contact.on = false;
  Trial trial = trial_of(scene);
  trial.steps = 20;
  const Observed kept_off = observe(trial), fallen = observe_instead(trial, blind, {});
  CHECK(kept_off.crossings == 0);
  CHECK(fallen.crossings == 1);
  CHECK(fallen.false_claims > 0);
}

TEST_CASE("to miss a tolerance and say so is honest, but fails where strain is judged") {
  Trial trial = trial_of(scenes::make("hang", {.size = 9}).value());
  trial.settings = {.tolerance = 1e-9, .max_iterations = 1, .solver = Solver::gauss_seidel};
  const Observed seen = observe(trial);
  CHECK(seen.missed == 5);
  CHECK(seen.worst == Status::iteration_limit);
  CHECK(seen.worst_step == 0);
  CHECK(strain_outcome(trial, kAnyEnergy).failure == "5 of 5 steps did not converge");
  CHECK(honesty_outcome(trial, kAnyEnergy).failure.empty());
  CHECK(honesty_outcome(trial, kAnyEnergy).figure == 0);
}

TEST_CASE("energy that appears is seen, though it goes again") {
  Trial trial = trial_of(bar(1));
  trial.scene.gravity = {0, 0, 0};
  trial.before_step = [](Cloth& cloth, int step) {
    const Vec3 velocity{0, step == 2 ? 2. : 0., 0};
    REQUIRE(cloth.write_velocities(std::vector<Vec3>{{0, 0, 0}, velocity}));
  };
  const Observed seen = observe(trial);
  CHECK(seen.energy_gain == doctest::Approx(2).epsilon(0.01));
  CHECK(seen.energy_end < 0.01);
  CHECK_FALSE(strain_outcome(trial, 1).failure.empty());
  CHECK(strain_outcome(trial, 3).failure.empty());
}

TEST_CASE("what fails a case is told, whatever its figure") {
  using Judge = Outcome (*)(const Observed&, double);
  for (const Judge outcome_of : {Judge(strain_outcome), Judge(honesty_outcome)}) {
    Observed seen{.steps = 7, .max_strain = 0.25};
    CHECK(outcome_of(seen, 1).failure.empty());
    seen.energy_gain = 2;
    CHECK(outcome_of(seen, 2).failure.empty());
    CHECK(outcome_of(seen, 1).failure == "2 J gained, 1 J allowed");
    seen = {.finite = false};
    CHECK(outcome_of(seen, 1).failure == "a state that is not finite");
    seen = {.refusal = "no"};
    CHECK(outcome_of(seen, 1).failure == "no");
    seen = {.steps = 7, .stopped = true};
    CHECK(outcome_of(seen, 1).failure == "it ended with step 7");
  }
  const Observed liar{.false_claims = 3, .max_strain = 0.25};
  CHECK(strain_outcome(liar, 1).figure == 0.25);
  CHECK(strain_outcome(liar, 1).failure == "a report that is not true");
  CHECK(honesty_outcome(liar, 1).figure == 3);
}

TEST_CASE("no number is finite that is none, in positions or in velocities") {
  const double infinity = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(all_finite({{{1, 2, 3}}, {{4, 5, 6}}}));
  CHECK_FALSE(all_finite({{{1, nan, 3}}, {{4, 5, 6}}}));
  CHECK_FALSE(all_finite({{{1, 2, 3}}, {{4, 5, -infinity}}}));
}

TEST_CASE("ropes strain by their length alone, other constraints both ways") {
  SceneDescription scene = bar(0.8);
  const Snapshot state{scene.positions, {}};
  CHECK(max_strain(scene, state) == doctest::Approx(0.25));
  scene.constraints[0].rest_length = 1.25;
  CHECK(max_strain(scene, state) == doctest::Approx(0.2));
  scene.constraints[0].kind = ConstraintKind::rope;
  CHECK(max_strain(scene, state) == 0);
  scene.constraints[0].rest_length = 0.8;
  CHECK(max_strain(scene, state) == doctest::Approx(0.25));
  scene.fixed = {0, 1};
  CHECK(max_strain(scene, state) == 0);
}

TEST_CASE("only what may touch a sphere is deep in it") {
  SceneDescription scene = on_sphere();
  const Snapshot state{{{0, 0, 0}, {0, 0.25, 0}}, {}};
  CHECK(max_penetration(scene, state) == 0.25);
  scene.radii[1] = 0.125;
  CHECK(max_penetration(scene, state) == 0.375);
  scene.constraints = {{0, 1, 0.25}};
  CHECK(max_penetration(scene, state) == 0);
}

TEST_CASE("energy and momentum are those of the description") {
  SceneDescription scene = bar(1);
  scene.masses = {3, 2};
  scene.gravity = {0, -5, 0};
  const Snapshot state{{{0, 1, 0}, {1, 7, 0}}, {{0, 0, 0}, {0, 4, 0}}};
  CHECK(kinetic_energy(scene, state) == 16);
  CHECK(energy(scene, state) == 16 + 70);
  CHECK(length(momentum(scene, state) - Vec3{0, 8, 0}) == 0);
  CHECK(length(angular_momentum(scene, state, {-1, 0, 0}) - Vec3{0, 0, 16}) == 0);
}

TEST_CASE("what was seen is told in one line") {
  CHECK(text(Observed{.steps = 1, .max_strain = 0.25, .energy_gain = 2, .seconds = 0.003}) ==
        "1 step of 3 ms, max strain 25 %, energy gain 2 J");
  CHECK(text(Observed{.steps = 6,
                      .worst = Status::infeasible,
                      .worst_step = 4,
                      .missed = 3,
                      .false_claims = 2,
                      .finite = false,
                      .max_penetration = 0.5}) ==
        "6 steps of 0 ms, max strain 0 %, 0.5 m deep, energy gain 0 J, 3 steps not converged "
        "(infeasible in step 4), 2 false claims, not finite");
  CHECK(text(Observed{.refusal = "no"}) == "refused: no");
}

TEST_CASE("through a sphere goes what was outside of it on both sides") {
  const SceneDescription scene = on_sphere();
  const auto goes_through = [&](Vec3 from, Vec3 to) {
    return went_through(scene, {{{}, from}, {}}, {{{}, to}, {}}, 0);
  };
  CHECK(goes_through({-2, 0, 0}, {2, 0, 0}));
  CHECK(goes_through({-2, 0.4, 0}, {2, 0.4, 0}));
  CHECK_FALSE(goes_through({-2, 0.6, 0}, {2, 0.6, 0}));
  CHECK_FALSE(goes_through({-2, 0, 0}, {-1, 0, 0}));
  CHECK_FALSE(goes_through({-2, 0, 0}, {0.1, 0, 0}));
  CHECK_FALSE(goes_through({0.1, 0, 0}, {2, 0, 0}));
  CHECK(went_through(scene, {{{-2, 0, 0}, {}}, {}}, {{{2, 0, 0}, {}}, {}}, 0));
}

TEST_CASE("no two cases have a name, and each is claimed by a method") {
  std::set<std::string> names;
  for (const Case& hard_case : all_cases()) {
    CAPTURE(hard_case.name);
    CHECK(names.insert(hard_case.name).second);
    CHECK_FALSE(hard_case.measures.empty());
    CHECK_FALSE(select(hard_case.name + '/').empty());
  }
  CHECK(names.size() == 221);  // as in tests/README.md
  CHECK(select("").size() == 914);
}

int exit_code(const std::string& arguments) {
  const int status = std::system((std::string(WEFT_PROGRAM) + " hard " + arguments).c_str());
  REQUIRE(WIFEXITED(status));
  return WEXITSTATUS(status);
}

TEST_CASE("the verb runs the cases that are named, and writes the table") {
  const TemporaryFolder folder;
  CHECK(exit_code("--quick --case one_particle --json " + folder.file("hard.json") + " --out " +
                  folder.file("tables") + " >" + folder.file("stdout") + " 2>/dev/null") == 0);
  const Json json = Json::parse(folder.read("hard.json"));
  CHECK(json["failed"] == 0);
  CHECK(json["cases"].size() >= 2);
  CHECK(folder.read("tables/hard.csv").find("one_particle/direct,direct,paper,pass,") !=
        std::string::npos);
  CHECK(folder.read("tables/hard.md").find("\n| one_particle: max strain | 0.01 | 0 / ") !=
        std::string::npos);
  CHECK(folder.read("stdout").find("one_particle/gauss_seidel ") != std::string::npos);
  CHECK(exit_code("--case no_such_case 2>" + folder.file("stderr")) == 2);
  CHECK(folder.read("stderr") == "weft: --case: no case is named 'no_such_case'\n");
}

TEST_CASE("studies refuse what WEFT_ISA names and there is not, before all else") {
  const TemporaryFolder folder;
  for (const std::string verb :
       {"hard --quick", "precision --quick --scene hang", "paper --quick"}) {
    CAPTURE(verb);
    const std::string command = "WEFT_ISA=altivec " WEFT_PROGRAM " " + verb + " >" +
                                folder.file("stdout") + " 2>" + folder.file("stderr");
    const int status = std::system(command.c_str());
    REQUIRE(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 2);
    CHECK(folder.read("stdout").empty());
    CHECK(folder.read("stderr").ends_with(
        "weft: WEFT_ISA: must be auto, sse2, avx2, avx512 or neon (altivec)\n"));
  }
}

TEST_CASE("the JSON may go into the folder that is made for the tables") {
  const TemporaryFolder folder;
  CHECK(exit_code("--quick --case one_particle/direct --json " + folder.file("new/hard.json") +
                  " --out " + folder.file("new") + " >" + folder.file("stdout") + " 2>/dev/null") ==
        0);
  CHECK(Json::parse(folder.read("new/hard.json"))["failed"] == 0);
  CHECK(exit_code("--quick --out /proc 2>" + folder.file("stderr")) == 2);
  CHECK(folder.read("stderr") == "weft: --out /proc: no file can be written there\n");
}

TEST_CASE("no quick case fails" * doctest::test_suite("slow")) {
  const TemporaryFolder folder;
  CHECK(exit_code("--quick --json - 2>/dev/null >" + folder.file("hard.json")) == 0);
  for (const Json& result : Json::parse(folder.read("hard.json"))["cases"]) {
    CAPTURE(result.dump());
    CHECK(result["result"] == "pass");
  }
}

}  // namespace
}  // namespace weft::tools::hard
