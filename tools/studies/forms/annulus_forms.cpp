/// A slit annular plate: one side of the slit is clamped, the other is lifted by a line load. Sze,
/// Liu and Lo, "Popular benchmark problems for geometric nonlinear analysis of shells", 2004,
/// section 3.3; their values are those of a converged shell. Loads below a half are left out: the
/// plate is nearly flat there, and takes minutes to come to rest.
#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "tools/studies/forms/form.h"
#include "tools/studies/forms/sheets.h"

namespace weft::tools::forms {
namespace {

constexpr double kInner = 6, kOuter = 10;              // m
constexpr double kThick = 0.03, kYoung = 21e6;         // m, N/m^2
constexpr double kFullLoad = 0.8 * (kOuter - kInner);  // N

struct Lifted {
  double share;         // of the full load
  double outer, inner;  // m
};
constexpr Lifted kTable[] = {{0.5, 13.768, 10.468}, {0.6, 14.674, 11.257}, {0.7, 15.469, 11.970},
                             {0.8, 16.202, 12.642}, {0.9, 16.886, 13.282}, {1.0, 17.528, 13.891}};

/// A plate under one load after the other.
class Annulus {
 public:
  explicit Annulus(int across)
      : across_(across),
        along_(10 * across),
        scene_(scene()),
        run_(scene_, {.tolerance = 1e-3, .substeps = kSubsteps, .scheme = Scheme::implicit}) {}

  void lift(double share) {
    std::vector<Vec3> forces(scene_.positions.size());
    for (int j = 0; j <= across_; ++j) {
      const double part = (j == 0 || j == across_ ? 0.5 : 1) / across_;
      forces[at(along_, j)].y = part * share * kFullLoad;
    }
    run_.pull(forces);
    run_.steps(share_ > 0 ? kFrames : kFirstFrames, kFrame);
    share_ = share;
  }
  double share() const { return share_; }
  Reading reading(bool asks_outer, double expected) const {
    return run_.reading(fmt::format("{} x {} cells", across_, along_), expected,
                        run_.at(at(along_, asks_outer ? across_ : 0)).y);
  }

 private:
  // With fewer substeps stretch is softer than the material is.
  static constexpr int kSubsteps = 256, kFirstFrames = 900, kFrames = 240;

  /// Rows -2 to 0 are fixed: the clamp is half a cell behind the last of them.
  std::uint32_t at(int row, int column) const {
    return static_cast<std::uint32_t>((row + 2) * (across_ + 1) + column);
  }
  SceneDescription scene() const {
    MeshDescription mesh;
    for (int i = -2; i <= along_; ++i) {
      const double angle = 2 * kPi * (i + 0.5) / (along_ + 0.5);
      for (int j = 0; j <= across_; ++j) {
        const double r = kInner + (kOuter - kInner) * j / across_;
        mesh.positions.push_back({r * std::cos(angle), 0, r * std::sin(angle)});
        if (i <= 0) mesh.pins.push_back(at(i, j));
        if (i == along_ || j == across_) continue;
        mesh.corners.insert(mesh.corners.end(),
                            {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
        mesh.face_sizes.push_back(4);
      }
    }
    mesh.material = Material{.density = 0.01,
                             .warp = kYoung * kThick,
                             .weft = kYoung * kThick,
                             .shear = kYoung * kThick / 2,
                             .bending = kYoung * std::pow(kThick, 3) / 12,

                             .damping_motion = 1.2};
    SceneDescription scene = scene_of(mesh);
    scene.gravity = {};
    return scene;
  }

  int across_, along_;
  SceneDescription scene_;
  Run run_;
  double share_ = 0;
};

/// The plates of all forms, each under the load that it was asked for last.
using Plates = std::map<int, std::unique_ptr<Annulus>>;

Reading lifted(Plates& plates, const Lifted& load, bool asks_outer, int refinement) {
  std::unique_ptr<Annulus>& plate = plates[refinement];
  if (!plate || plate->share() > load.share) plate = std::make_unique<Annulus>(4 + 2 * refinement);
  if (plate->share() < load.share) plate->lift(load.share);
  return plate->reading(asks_outer, asks_outer ? load.outer : load.inner);
}

}  // namespace

std::vector<Form> annulus_forms() {
  std::vector<Form> forms;
  const auto plates = std::make_shared<Plates>();
  for (const Lifted& load : kTable) {
    for (const bool asks_outer : {true, false}) {
      forms.push_back({fmt::format("a slit annulus at {:g} of its load, {} tip", load.share,
                                   asks_outer ? "outer" : "inner"),
                       "Sze, Liu and Lo 2004", "m",
                       [=](int r) { return lifted(*plates, load, asks_outer, r); }, 0.03});
    }
  }
  return forms;
}

}  // namespace weft::tools::forms
