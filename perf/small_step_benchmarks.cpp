/// A substep of small steps, all in, of a frame of sixteen, and its sweep alone: yarns of a woven
/// sheet, single edges of an irregular mesh, and a braced sheet, which has both. And a visit of
/// bending elements, of three particles along the rows and columns of a sheet, or of four over the
/// pairs of its triangles. And of triangles of fabric, relaxed or judged. And of anchors, of every
/// particle, in woven rows or in quads: with nobody at its limit, or all, or all on a backstop.
#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "engine/isa.h"
#include "engine/model/model.h"
#include "engine/solvers/small_steps/simd_anchors.h"
#include "engine/solvers/small_steps/simd_bending.h"
#include "engine/solvers/small_steps/simd_membrane.h"
#include "engine/solvers/small_steps/small_steps.h"
#include "engine/solvers/small_steps/small_steps_layout.h"
#include "engine/tuning.h"
#include "perf/benchmarks.h"
#include "perf/meshes.h"
#include "tools/scenes/scenes.h"

namespace weft::perf {
namespace {

struct Kind {
  const char* name;
  const char* scene;
  bool diagonals;
};
constexpr Kind kKinds[] = {
    {"yarns", "hang", false}, {"braced", "hang", true}, {"edges", "cape", false}};
constexpr int kSizes[] = {40, 120, 300};

Isa to_public(simd::Isa isa) {
  constexpr Isa kIsas[] = {Isa::sse2, Isa::avx2, Isa::avx512, Isa::neon};
  return kIsas[static_cast<std::size_t>(isa)];
}

constexpr int kSubsteps = 16;

/// A cloth that is let go, in substeps as long as its load allows at 1 %.
struct Falling {
  std::shared_ptr<const Model> model;
  Team team;
  Settings settings;
  std::unique_ptr<SmallSteps> solver;
  SphereContacts contacts;
  kernels::Vectors x, v;

  Falling(const Kind& kind, simd::Isa isa, int size)
      : model(build_model(
                  scenes::make(kind.scene, {.size = size, .diagonals = kind.diagonals}).value())
                  .value()),
        settings(settings_on(isa)),
        solver(make_small_steps(*model, settings, simd::table(isa))) {
    x = model->initial_position;
    v = model->initial_velocity;
    frame();
  }
  /// From its beginning, each time, to the velocities in its end.
  void frame() {
    const double h = std::min(0.005, substep_length(model->small_steps().load, x.view(),
                                                    {.acceleration = 10}, settings.tolerance));
    solver->begin(x.view(), v.view(), model->gravity, {},
                  {.dt_substep = h, .substeps = kSubsteps, .omega = tuning::kOmega, .placed = true},
                  team);
    for (int k = 0; k < kSubsteps; ++k) {
      solver->advance(team);
      solver->sweep(team);
      solver->repair(contacts, static_cast<std::int64_t>(model->constraints.size()), team);
    }
    solver->settle(team);
  }
  static Settings settings_on(simd::Isa isa) {
    Settings settings;
    settings.solver = Solver::small_steps;
    settings.scheme = Scheme::bdf2;
    settings.isa = to_public(isa);
    settings.threads = 1;
    return settings;
  }
};

void run(benchmark::State& state, const Shared& shared, const Kind& kind, simd::Isa isa, int size,
         bool all) {
  Falling falling(kind, isa, size);
  for (auto _ : state) {
    if (all)
      falling.frame();
    else
      falling.solver->sweep(falling.team);
  }
  const auto edges = static_cast<double>(falling.model->constraints.size()) * (all ? kSubsteps : 1);
  const double footprint = static_cast<double>(falling.solver->bytes());
  const double bytes = footprint * (all ? kSubsteps : 1);  // about: each array once in a substep
  count(state, {.items = edges, .bytes = bytes, .footprint = footprint}, shared.bandwidth);
}

/// Of a grid of size x size particles, each cell in two triangles.
SceneDescription bending_sheet(int size, bool four) {
  SceneDescription scene = scenes::make("hang", {.size = size}).value();
  const auto n = static_cast<std::uint32_t>(size);
  const auto add = [&](std::uint32_t from, std::array<std::uint32_t, 4> by,
                       std::array<double, 4> weights) {
    for (std::size_t k = 0; k < 4; ++k) by[k] = k == 3 && !four ? kNoIndex : from + by[k];
    scene.bending.push_back({by, weights, 0, 1});
  };
  for (std::uint32_t row = 0; row + 2 < n; ++row) {
    for (std::uint32_t column = 0; column + 2 < n; ++column) {
      const std::uint32_t i = row * n + column;
      if (four) {
        add(i, {1, n, 0, n + 1}, {1, 1, -1, -1});
        add(i, {n, n + 1, 1, 2 * n}, {1, 1, -1, -1});
        add(i, {1, n + 1, n, 2}, {1, 1, -1, -1});
      } else {
        add(i, {0, 1, 2, 0}, {1, -2, 1, 0});
        add(i, {0, n, 2 * n, 0}, {1, -2, 1, 0});
      }
    }
  }
  return scene;
}

/// Quads of particles.
kernels::AlignedVector<float> quads_of(const Model& model) {
  kernels::AlignedVector<float> quads(4 * model.slots());
  for (std::size_t i = 0; i < model.slots(); ++i) {
    const kernels::Vector x = model.initial_position[i];
    for (const auto& [axis, place] : {std::pair{0, x.x}, {1, x.y}, {2, x.z}})
      quads[4 * i + static_cast<std::size_t>(axis)] = static_cast<float>(place);
  }
  return quads;
}

/// A grid of size x size particles, each cell of two triangles. How large these are is left to
/// chance: no shape of the grid meets all laws, so visits never come to rest, and no number shrinks
/// until it is denormal.
SceneDescription fabric_sheet(int size) {
  SceneDescription scene = scenes::make("hang", {.size = size}).value();
  Random random(7);
  const double cell = scene.constraints.front().rest_length;
  scene.constraints.clear();
  const auto n = static_cast<std::uint32_t>(size);
  const auto add = [&](std::array<std::uint32_t, 3> particles) {
    MembraneElement element{.particles = particles, .warp = 4000, .weft = 4000, .shear = 60};
    const double side = cell * (1 + 0.04 * (random.unit() - 0.5));
    for (std::size_t k = 0; k < 3; ++k)
      element.rest[k] = {side * (particles[k] % n), side * (particles[k] / n)};
    scene.membrane.push_back(element);
  };
  for (std::uint32_t row = 0; row + 1 < n; ++row) {
    for (std::uint32_t column = 0; column + 1 < n; ++column) {
      const std::uint32_t i = row * n + column;
      add({i, i + 1, i + n + 1});
      add({i, i + n + 1, i + n});
    }
  }
  return scene;
}

void run_membrane(benchmark::State& state, const Shared& shared, simd::Isa isa, int size,
                  bool judges) {
  const auto model = build_model(fabric_sheet(size)).value();
  Team team;
  SimdMembrane membrane(*model, simd::table(isa));
  kernels::AlignedVector<float> base = quads_of(*model), u(base.size());
  membrane.measure_base(base.data(), team);
  const LawStep laws{{.scale = 1e7}};
  for (auto _ : state) {
    if (judges)
      membrane.judge(u.data(), nullptr, laws, 0.01, team);
    else
      membrane.relax(u.data(), nullptr, laws, tuning::kOmega, false, team);
  }
  const double footprint =
      static_cast<double>(membrane.bytes() + model->small_steps().membrane.bytes());
  count(state,
        {.items = static_cast<double>(model->membrane.size()),
         .bytes = footprint,
         .footprint = footprint},
        shared.bandwidth);
}

void run_bending(benchmark::State& state, const Shared& shared, simd::Isa isa, int size,
                 bool four) {
  const auto model = build_model(bending_sheet(size, four)).value();
  Team team;
  SimdBending bending(*model, {}, simd::table(isa));
  kernels::AlignedVector<float> base = quads_of(*model), u(base.size());
  bending.measure_base(base.data(), team);
  // Cloth that is soft in a substep, and too long a substep for a solution to stand for several.
  const FramePlan plan{.dt_substep = 2e-3, .substeps = std::numeric_limits<int>::max()};
  for (std::size_t k = 0; k < u.size(); ++k) u[k] = k % 4 == 1 ? 1e-4f * std::sin(float(k)) : 0;
  const kernels::AlignedVector<float> start = u;
  for (auto _ : state) {
    std::ranges::copy(start, u.begin());
    bending.begin(plan, u.data(), false);  // without a guess
    bending.bend(u.data(), u.data(), plan.dt_substep * plan.dt_substep, team);
  }
  const double footprint =
      static_cast<double>(bending.bytes() + model->small_steps().bending.bytes());
  count(state,
        {.items = static_cast<double>(model->bending.size()),
         .bytes = footprint,
         .footprint = footprint},
        shared.bandwidth);
}

enum class Limits : std::uint8_t { none, all, backstops };

SceneDescription anchored_sheet(int size, bool woven, Limits limits) {
  SceneDescription scene = scenes::make(woven ? "hang" : "cape", {.size = size}).value();
  scene.fixed.clear();
  for (std::uint32_t i = 0; i < scene.positions.size(); ++i) {
    Anchor anchor{.particle = i, .point = scene.positions[i], .normal = {0, 1, 0}};
    if (limits != Limits::all) anchor.max_distance = 1;
    if (limits == Limits::backstops) anchor.backstop_radius = 0.2;
    scene.anchors.push_back(anchor);
  }
  return scene;
}

void run_anchors(benchmark::State& state, const Shared& shared, simd::Isa isa, int size, bool woven,
                 Limits limits) {
  const auto model = build_model(anchored_sheet(size, woven, limits)).value();
  const std::size_t floats = model->small_steps().floats;
  Team team;
  SimdAnchors anchors(*model, {}, simd::table(isa));
  kernels::AlignedVector<float> base(floats), u(floats, -1e-4f), predicted(floats), v(floats);
  std::vector<reference::AnchorPose> poses;
  for (const Anchor& anchor : model->anchors.described) {
    poses.push_back(pose_of(anchor.point, anchor.normal));
  }
  std::vector<double> most;
  for (const reference::AnchorLimits& limit : model->anchors.limits) most.push_back(limit.most);
  const std::vector<std::uint8_t> has_backstop(poses.size(), 1);
  const AnchorTravel standing{poses, poses, most, most, has_backstop};
  anchors.begin(standing, 1e-4, 1, {});
  for (std::size_t i = 0; i < model->anchors.size(); ++i) {
    const std::size_t place = model->small_steps().places().of(model->anchors.slot[i]);
    const std::size_t next = model->small_steps().places().stride;
    base[place] = static_cast<float>(poses[i].point.x);
    base[place + next] = static_cast<float>(poses[i].point.y);
    base[place + 2 * next] = static_cast<float>(poses[i].point.z);
  }
  anchors.measure_base(base.data());
  const simd::Flight flight{
      .u = u.data(), .predicted = predicted.data(), .v = v.data(), .led_to = u.data()};
  for (auto _ : state) {
    std::ranges::fill(u, -1e-4f);  // a fall of a substep
    anchors.hold(flight, 0, team);
  }
  const double footprint = static_cast<double>(anchors.bytes() + 3 * 4 * floats);
  count(state,
        {.items = static_cast<double>(model->anchors.size()),
         .bytes = footprint,
         .footprint = footprint},
        shared.bandwidth);
}

}  // namespace

void register_small_step_benchmarks(Shared& shared) {
  for (const bool all : {true, false}) {
    for (const Kind& kind : kKinds) {
      for (const simd::Isa isa : supported_isas()) {
        for (const int size : kSizes) {
          const std::string name = std::string(all ? "small_step/" : "small_step_sweep/") +
                                   kind.name + '/' + name_of(isa) + '/' + std::to_string(size);
          benchmark::RegisterBenchmark(name.c_str(), [=, &kind, &shared](benchmark::State& state) {
            run(state, shared, kind, isa, size, all);
          });
        }
      }
    }
  }
  for (const bool four : {false, true}) {
    for (const simd::Isa isa : supported_isas()) {
      for (const int size : kSizes) {
        const std::string name = std::string("small_step_bending/") + (four ? "four/" : "three/") +
                                 name_of(isa) + '/' + std::to_string(size);
        benchmark::RegisterBenchmark(name.c_str(), [=, &shared](benchmark::State& state) {
          run_bending(state, shared, isa, size, four);
        });
      }
    }
  }
  for (const bool judges : {false, true}) {
    for (const simd::Isa isa : supported_isas()) {
      for (const int size : kSizes) {
        const std::string name = std::string("small_step_membrane/") +
                                 (judges ? "judge/" : "relax/") + name_of(isa) + '/' +
                                 std::to_string(size);
        benchmark::RegisterBenchmark(name.c_str(), [=, &shared](benchmark::State& state) {
          run_membrane(state, shared, isa, size, judges);
        });
      }
    }
  }
  for (const bool woven : {true, false}) {
    for (const auto& [limits, kind] :
         {std::pair{Limits::none, "none"}, std::pair{Limits::all, "all"},
          std::pair{Limits::backstops, "backstops"}}) {
      for (const simd::Isa isa : supported_isas()) {
        for (const int size : kSizes) {
          const std::string name = std::string("small_step_anchors/") +
                                   (woven ? "rows/" : "quads/") + kind + '/' + name_of(isa) + '/' +
                                   std::to_string(size);
          benchmark::RegisterBenchmark(name.c_str(),
                                       [=, limits = limits, &shared](benchmark::State& state) {
                                         run_anchors(state, shared, isa, size, woven, limits);
                                       });
        }
      }
    }
  }
}

}  // namespace weft::perf
