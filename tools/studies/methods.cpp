#include "tools/studies/methods.h"

#include "tools/program/text/enumerators.h"

namespace weft::tools {
namespace {

/// A named solver has a scheme of its own where none is named.
bool has_another_name(const Method& method) {
  if (method.scheme == Scheme::automatic) return method.solver != Solver::automatic;
  return method.solver == Solver::automatic && method.scheme != Scheme::rattle;
}

}  // namespace

Result<void> offered(const Method& method) {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}};
  scene.masses = {1};
  Settings settings;
  settings.solver = method.solver;
  settings.scheme = method.scheme;
  const auto cloth = Cloth::create(build_model(scene).value(), settings);
  return cloth ? Result<void>{} : Result<void>{Error{cloth.error()}};
}

std::vector<Method> all_methods() {
  std::vector<Method> methods;
  for (const Scheme scheme : enumerators<Scheme>()) {
    for (const Solver solver : enumerators<Solver>()) {
      const Method method{solver, scheme};
      if (!has_another_name(method) && offered(method)) methods.push_back(method);
    }
  }
  return methods;
}

}  // namespace weft::tools
