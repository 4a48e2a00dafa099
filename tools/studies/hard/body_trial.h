/// What cases with bodies have in common: sheets of cotton, and how bodies move.
#pragma once

#include <functional>
#include <vector>

#include "tools/studies/hard/hard_case.h"

namespace weft::tools::hard {

inline constexpr double kContactTolerance = 1e-4;  // m, that of Settings
inline constexpr double kThickness = 1e-3;         // m, of bodies

/// Small steps, and automatic, which becomes them.
bool takes_bodies(const Method& method);

/// Level squares of cotton, so many particles wide, with their middles at these places.
SceneDescription cottons(int size, double width, const std::vector<Vec3>& middles);
SceneDescription cotton(int size, double width, Vec3 middle);

std::function<Pose(double)> stays(Vec3 at = {});
Rotation turned_about_z(double angle);

/// Frames of 1/60 s.
Trial trial_of(const Setup& setup, SceneDescription scene, std::vector<TrialBody> bodies);

/// J, a thousandth of what moved and of what bodies did.
double energy_allowed(const Observed& o);
/// The figure is how deep particles were after steps; what missed a tolerance fails.
Outcome depth_outcome(const Observed& o);

}  // namespace weft::tools::hard
