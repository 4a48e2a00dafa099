#include "tools/studies/precision/sweep.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "tools/program/text/enumerators.h"
#include "tools/studies/methods.h"
#include "tools/studies/precision/bullet.h"
#include "tools/studies/precision/meter.h"
#include "tools/studies/precision/motion.h"
#include "tools/studies/precision/order.h"
#include "tools/studies/precision/sizes.h"

namespace weft::tools::precision {
namespace {

Task small_task(int frames = 50) {
  auto task = make_task("hang", 5);
  REQUIRE(task);
  task.value().frames = frames;
  return std::move(task.value());
}

const Effort kOnce{.repeat = 1};

TEST_CASE("solvers and schemes are all that weft.h names") {
  for (const Solver solver : {Solver::gauss_seidel, Solver::direct, Solver::yarn,
                              Solver::small_steps, Solver::automatic}) {
    CHECK(std::ranges::count(enumerators<Solver>(), solver) == 1);
  }
  for (const Scheme scheme :
       {Scheme::paper, Scheme::rattle, Scheme::implicit, Scheme::bdf2, Scheme::automatic}) {
    CHECK(std::ranges::count(enumerators<Scheme>(), scheme) == 1);
  }
  for (const Solver solver : enumerators<Solver>()) CHECK(name(solver) != "unknown");
}

TEST_CASE("the methods: every solver with each scheme that it takes, none twice") {
  std::set<std::string> methods;
  for (const Method& method : all_methods()) {
    methods.insert(std::string(name(method.solver)) + " " + std::string(name(method.scheme)));
  }
  CHECK(methods == std::set<std::string>{"gauss_seidel paper", "gauss_seidel rattle",
                                         "direct paper", "direct rattle", "yarn paper",
                                         "yarn rattle", "small_steps implicit", "small_steps bdf2",
                                         "auto auto", "auto rattle"});
  CHECK(all_methods().size() == methods.size());
  CHECK(offered({Solver::small_steps, Scheme::bdf2}));
  CHECK_FALSE(offered({Solver::small_steps, Scheme::paper}));
  CHECK_FALSE(offered({Solver::yarn, Scheme::implicit}));
}

TEST_CASE("the curves: the original first, each method once, rows of rising cost") {
  const Task task = small_task();
  const auto curves = weft_curves(task, true);
  REQUIRE(curves.size() >= 3);
  CHECK(curves.front().label == "original");
  CHECK(curves.back().label == "auto");
  CHECK(curves.size() == all_methods().size());  // not auto with rattle, but the original
  for (const Curve& curve : curves) {
    CAPTURE(curve.label);
    for (const Row& row : curve.rows) {
      CHECK(std::ranges::is_sorted(row, [](const Settings& a, const Settings& b) {
        return a.tolerance > b.tolerance || a.iterations < b.iterations;
      }));
    }
  }
}

TEST_CASE("a point: its tolerance is reached, its trajectory compared") {
  Task task = small_task();
  REQUIRE(add_reference(task, 4));
  CHECK(task.reference_error > 0);
  const auto point = measure(task, {.tolerance = 1e-4}, {.repeat = 3});
  REQUIRE(point);
  const Outcome& outcome = point.value().outcome;
  CHECK(outcome.status == "converged");
  CHECK(outcome.counts());
  CHECK(outcome.frames == 50);
  CHECK(outcome.ms_per_frame > 0);
  CHECK(outcome.max_strain <= 1e-4);
  CHECK(outcome.mean_max_strain > 0);
  CHECK(outcome.mean_max_strain < outcome.max_strain);
  REQUIRE(outcome.trajectory_error);
  CHECK(*outcome.trajectory_error > 5e-4);
  CHECK(*outcome.trajectory_error < 0.1);
  CHECK(point.value().knobs.tolerance == 1e-4);

  const auto finer = measure(task, {.tolerance = 1e-4, .substeps = 8}, kOnce);
  REQUIRE(finer);
  CHECK(*finer.value().outcome.trajectory_error < *outcome.trajectory_error / 2);
}

TEST_CASE("a scene with ropes is compared with small steps, whose error is told") {
  auto task = make_task("cape", 6);
  REQUIRE(task);
  CHECK(describe(*task.value().model).ropes > 0);
  REQUIRE(add_reference(task.value(), 4));
  CHECK(task.value().reference_by == "small_steps, 256 substeps");
  CHECK(task.value().reference_error > 0);
  CHECK(task.value().reference_error < 0.01);
  const auto point = measure(task.value(), {}, kOnce);
  REQUIRE(point);
  REQUIRE(point.value().outcome.trajectory_error);
  CHECK(*point.value().outcome.trajectory_error > 0);
}

TEST_CASE("cloth of a material is compared with small steps, and swept by them alone") {
  auto task = make_task("cape", 6, "cotton");
  REQUIRE(task);
  CHECK(task.value().has_material());
  REQUIRE(add_reference(task.value(), 2));
  CHECK(task.value().reference_by == "small_steps, 128 substeps");
  for (const Curve& curve : weft_curves(task.value(), true)) {
    CAPTURE(curve.label);
    CHECK(curve.rows.empty() == (!curve.label.starts_with("small_steps") && curve.label != "auto"));
  }
  CHECK(make_task("hang", 6, "cotton"));
  CHECK_FALSE(make_task("cape", 6, "paper"));
}

TEST_CASE("the motion that is asked for is measured from loose to tight") {
  Task task = small_task();
  REQUIRE(add_reference(task, 8));
  const auto points = measure_motion(task, [](const std::string&) {});
  REQUIRE(points);
  REQUIRE(points.value().size() > 4);
  CHECK(points.value().front().asked == 0);
  for (const MotionPoint& point : points.value()) {
    CHECK(point.got > 0);
    CHECK(point.estimated > 0);
    CHECK(point.ms_per_frame > 0);
  }
  CHECK(points.value().back().substeps > points.value().front().substeps);
  CHECK(points.value().back().got < points.value().front().got);
}

TEST_CASE("a fixed number of iterations is no tolerance; without a reference nothing is compared") {
  const auto point = measure(small_task(), {.iterations = 30}, kOnce);
  REQUIRE(point);
  CHECK_FALSE(point.value().knobs.tolerance);
  CHECK(point.value().knobs.iterations == 30);
  CHECK(point.value().outcome.status == "fixed_iterations");
  CHECK_FALSE(point.value().outcome.trajectory_error);
}

TEST_CASE("a run out of time says so, does not count, and ends its row") {
  const Task task = small_task();
  const Effort hasty{.repeat = 1, .seconds_limit = 0};
  const Curve curve{"made up", {{{.tolerance = 0.1}, {.tolerance = 0.01}}}};
  const auto points = sweep(task, curve, hasty, [](const std::string&) {});
  REQUIRE(points);
  REQUIRE(points.value().size() == 1);
  CHECK(points.value().front().outcome.status == "out_of_time");
  CHECK_FALSE(points.value().front().outcome.counts());
}

TEST_CASE("a run that gains energy does not count") {
  Outcome outcome{.status = "converged", .energy_gain = 0.0009};
  CHECK(outcome.counts());
  outcome.energy_gain = 0.0011;
  CHECK_FALSE(outcome.counts());
}

TEST_CASE("the exponent of a power law is found, and refused where there is none") {
  CHECK(*fitted_exponent(std::vector{1., 2., 4.}, std::vector{3., 12., 48.}) == doctest::Approx(2));
  CHECK_FALSE(fitted_exponent(std::vector{1.}, std::vector{1.}));
  CHECK_FALSE(fitted_exponent(std::vector{1., 1.}, std::vector{1., 2.}));
  CHECK_FALSE(fitted_exponent(std::vector{1., 2.}, std::vector{0., 2.}));
}

/// (corners is no smooth motion: its order is for a reader.)
TEST_CASE("the schemes paper and implicit are of first order, rattle and bdf2 of second") {
  auto task = make_task("hang", 6);
  REQUIRE(task);
  task.value().frames = kReferenceFrame;
  REQUIRE(add_reference(task.value(), 64));
  const auto orders = measure_orders(task.value());
  REQUIRE(orders.size() + 1 == enumerators<Scheme>().size());  // automatic is one of them
  for (const Order& order : orders) {
    CAPTURE(order.scheme);
    const bool second = order.scheme == "rattle" || order.scheme == "bdf2";
    const bool small_steps = order.scheme == "implicit" || order.scheme == "bdf2";
    REQUIRE(order.order);
    // What small steps leave to their springs, stiffer in shorter steps, lowers theirs a little.
    const double within = small_steps ? 0.3 : 0.1;
    CHECK(std::abs(*order.order - (second ? 2 : 1)) < within);
    REQUIRE(order.points.size() == 4);
    CHECK(order.points.front().dt == (small_steps ? 0.0025 : 0.01));
    CHECK(order.points.back().dt == order.points.front().dt / 8);
  }
}

TEST_CASE("the exponent of a size curve is that of the number of particles") {
  SizeCurve curve;
  for (const int size : {10, 20, 40}) {
    curve.points.push_back(
        {size, 1, {.status = "converged", .ms_per_frame = 1e-6 * std::pow(size, 3)}});
  }
  CHECK(*exponent(curve) == doctest::Approx(1.5));
  curve.points.resize(1);
  CHECK_FALSE(exponent(curve));
}

TEST_CASE("cost against size: a curve for each solver, which ends where time runs out") {
  SizeStudy study = size_study(true);
  study.sizes = {4, 6, 8};
  study.frames = 20;
  REQUIRE(measure(study, [](const std::string&) {}));
  REQUIRE(study.curves.size() == enumerators<Solver>().size());
  const SizeCurve& curve = study.curves.front();
  REQUIRE(curve.points.size() == 3);
  CHECK(curve.end.empty());
  CHECK(curve.exponent);
  for (const SizePoint& point : curve.points) CHECK(point.outcome.max_strain <= 0.01);

  SizeStudy hasty = size_study(true);
  hasty.sizes = {4};
  hasty.seconds_limit = 0;
  REQUIRE(measure(hasty, [](const std::string&) {}));
  CHECK(hasty.curves.front().points.empty());
  CHECK(hasty.curves.front().end == "4 x 4 did not reach 1 % in 0 s");
}

TEST_CASE("a motion that was computed elsewhere is measured as weft's own") {
  Task task = small_task();
  const std::vector<Vec3> start = task.description.positions;
  const std::vector<Vec3> still(start.size());
  std::vector<Vec3> wider = start, higher = start;
  for (Vec3& position : wider) position.x *= 1.5;
  for (Vec3& position : higher) position.y += 0.25;
  task.reference = start;
  Meter meter(task);
  REQUIRE(meter.add_frame(wider, still, 1));
  while (meter.outcome().frames + 1 < kReferenceFrame) REQUIRE(meter.add_frame(start, still, 0));
  CHECK_FALSE(meter.outcome().trajectory_error);
  REQUIRE(meter.add_frame(higher, still, 1));
  CHECK_FALSE(meter.add_frame({}, {}, 0));

  const Outcome outcome = meter.outcome();
  CHECK(outcome.frames == kReferenceFrame + 1);
  CHECK(outcome.ms_per_frame == doctest::Approx(2000. / 41));
  CHECK(outcome.max_strain == doctest::Approx(0.5));
  CHECK(outcome.mean_max_strain == doctest::Approx(0.5 / 41));
  CHECK(outcome.energy_gain == doctest::Approx(10 * 0.25 * 20 / 25));  // 20 of 25 are free
  CHECK(*outcome.trajectory_error == 0.25);
}

TEST_CASE("Bullet computes the same motion, the better the more it iterates") {
  if (bullet_version().empty()) {
    MESSAGE("Bullet is not built in: not tested");
    return;
  }
  Task task = small_task();
  REQUIRE(add_reference(task, 4));
  const auto points = sweep_bullet(task, kOnce, true, [](const std::string&) {});
  REQUIRE(points.size() > 2);
  const Outcome& best = points.back().outcome;
  CHECK(best.max_strain < 0.001);
  CHECK(best.max_strain < points.front().outcome.max_strain);
  CHECK(*best.trajectory_error < 0.01);
  CHECK(best.frames == 50);
}

}  // namespace
}  // namespace weft::tools::precision
