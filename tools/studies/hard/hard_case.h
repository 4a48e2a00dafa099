/// What a hard case is: a name, what is measured, the bound it must keep, and who claims to handle
/// it. A case is run once for each method that claims it.
#pragma once

#include <weft/weft.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "tools/studies/hard/trial.h"
#include "tools/studies/methods.h"

namespace weft::tools::hard {

/// "direct", "direct+rattle", "small_steps+bdf2", "auto".
std::string label(const Method& method);

struct Setup {
  Method method;
  bool quick = false;
  /// Steps of the whole case, or of the quick one.
  int steps(int whole, int few) const { return quick ? few : whole; }
  /// Settings of the method, with this tolerance.
  Settings settings(double tolerance) const;
};

struct Outcome {
  double figure = std::numeric_limits<double>::quiet_NaN();
  std::string detail = {};
  std::string failure = {};  ///< a reason to fail whatever the figure is; empty: none
  double ms_per_step = 0;
};

struct Case {
  std::string name = {};
  std::string measures = {};  ///< what the figure is, with its unit
  double bound = 0;           ///< the figure must not be above it
  std::function<Outcome(const Setup&)> run = {};
  std::function<bool(const Method&)> claimed = [](const Method&) { return true; };
};

/// The tolerance that cases ask for where nothing is said: of rigid edges, and of laws of springs.
inline constexpr double kStrain = 0.01, kLaw = 0.01;

/// For methods that bring a tight tolerance in a bounded number of passes.
bool not_by_relaxation(const Method& method);
/// For yarns with scheme paper, and automatic, which chooses them where spheres are heavy.
bool by_yarns(const Method& method);

/// With any figure it fails where weft refused, or ended before the last step, where a state is not
/// finite or a report not true, and where more energy appeared than `energy_allowed`.
Outcome outcome(double figure, const Observed& observed, double energy_allowed);
/// The largest strain is the figure; it also fails where a step did not converge.
Outcome strain_outcome(const Observed& observed, double energy_allowed);
Outcome strain_outcome(const Trial& trial, double energy_allowed);
/// The energy that appeared is the figure; it also fails where a step did not converge.
Outcome gain_outcome(const Trial& trial);
/// The number of steps whose report is not true is the figure: what did not converge must say so.
Outcome honesty_outcome(const Observed& observed, double energy_allowed);
Outcome honesty_outcome(const Trial& trial, double energy_allowed);

/// J that a level sheet of `size` x `size` particles and 1 kg may gain when it is let go: it falls
/// freely until an edge is out of tolerance, and is then caught, the whole error being taken out in
/// one step, as speed.
double energy_of_the_catch(int size, double tolerance, double dt);

/// J, the bound of gain_outcome.
inline constexpr double kMostGained = 1e-3;
inline constexpr double kAnyEnergy = std::numeric_limits<double>::infinity();

}  // namespace weft::tools::hard
