#include "tools/program/viewer/motion.h"

#include <weft/report_fields.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <span>
#include <type_traits>

#include "engine/erase_repeated.h"
#include "engine/model/model.h"
#include "engine/saving/sealed.h"
#include "tools/program/viewer/integers.h"
#include "tools/program/viewer/sections.h"
#include "tools/program/viewer/structure.h"
#include "tools/scenes/mesh.h"

namespace weft::tools {
namespace {

/// The version changes with the text, the sections and how they are written.
constexpr Kind kMotion{{'w', 'e', 'f', 't', ' ', 'm', 'o', 'v'}, "motion", 2};
/// Of the longest side of the box around the cloth as it starts.
constexpr double kQuantaPerSide = 65535;
/// A colour of the heat map is far wider.
constexpr double kQuantaPerTolerance = 64;

Bounds box_of(const SceneDescription& scene) {
  std::vector<bool> is_sphere(scene.positions.size());
  for (const std::uint32_t particle : scene.spheres) is_sphere[particle] = true;
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Bounds box{{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
  for (std::size_t i = 0; i < scene.positions.size(); ++i) {
    if (is_sphere[i]) continue;
    for (double Vec3::*axis : {&Vec3::x, &Vec3::y, &Vec3::z}) {
      box.least.*axis = std::min(box.least.*axis, scene.positions[i].*axis);
      box.most.*axis = std::max(box.most.*axis, scene.positions[i].*axis);
    }
  }
  return box.least.x <= box.most.x ? box : Bounds{};
}

Vec3 middle_of(const Bounds& box) {
  return {std::midpoint(box.least.x, box.most.x), std::midpoint(box.least.y, box.most.y),
          std::midpoint(box.least.z, box.most.z)};
}

double quantum_of(const Bounds& box) {
  const double side =
      std::max({box.most.x - box.least.x, box.most.y - box.least.y, box.most.z - box.least.z});
  return side > 0 ? side / kQuantaPerSide : 1e-6;
}

std::vector<std::int32_t> pins_of(const SceneDescription& scene) {
  std::vector<std::int32_t> pins;
  for (const std::uint32_t particle : scene.fixed) {
    if (std::ranges::find(scene.spheres, particle) == scene.spheres.end())
      pins.push_back(static_cast<std::int32_t>(particle));
  }
  std::ranges::sort(pins);
  return pins;
}

std::vector<std::int32_t> ends_of(std::span<const Seam> seams) {
  std::vector<std::int32_t> ends;
  for (const Seam& seam : seams) {
    for (const std::uint32_t end : {seam.a, seam.b}) ends.push_back(static_cast<std::int32_t>(end));
  }
  return ends;
}

/// The ends of each piece of each line.
std::vector<std::int32_t> lines_of(const Mesh& mesh) {
  std::vector<std::int32_t> ends;
  for (const auto& line : mesh.lines) {
    for (std::size_t i = 1; i < line.size(); ++i) {
      for (const std::size_t at : {i - 1, i})
        ends.push_back(static_cast<std::int32_t>(mesh.particle_of_vertex[line[at]]));
    }
  }
  return ends;
}

Json described(const Settings& settings) {
  return {{"solver", name(settings.solver)}, {"scheme", name(settings.scheme)},
          {"isa", name(settings.isa)},       {"tolerance", settings.tolerance},
          {"substeps", settings.substeps},   {"motion_tolerance", settings.motion_tolerance}};
}

/// What it is in JSON: numbers, names and truth.
template <class Value>
Json plain(const Value& value) {
  if constexpr (std::is_same_v<Value, Status>) {
    return name(value);
  } else if constexpr (std::is_arithmetic_v<Value>) {
    return value;
  } else {
    return nullptr;
  }
}

}  // namespace

/// Lists with an entry for each sample; null at the start, which no step led to.
struct MotionRecorder::Figures {
  Json lists = Json::object();
  std::size_t samples = 0;

  void add(const char* key, Json value) {
    Json& list = lists[key];
    if (list.is_null()) list = Json::array();
    while (list.size() < samples) list.push_back(nullptr);
    list.push_back(std::move(value));
  }
  void add(const StepReport& report) {
    for_each_report_field([&](const auto& field) {
      Json value = plain(report.*field.member);
      if (!value.is_null()) add(field.name, std::move(value));
    });
    const auto& stages = report.stage_seconds;
    add("ms", 1e3 * std::accumulate(stages.begin(), stages.end(), 0.0));
  }
  void add(const Energy& energy) {
    add("kinetic", energy.kinetic);
    add("potential", energy.potential);
    add("elastic", energy.elastic);
    add("energy", energy.total());
  }
};

MotionRecorder::MotionRecorder(const SceneSource& source, std::shared_ptr<const Model> model,
                               const Settings& settings, double dt)
    : source_(&source),
      model_(std::move(model)),
      dt_(dt),
      settings_(settings),
      origin_(middle_of(box_of(source.description))),
      quantum_(quantum_of(box_of(source.description))),
      stretch_quantum_(std::max(settings.tolerance / kQuantaPerTolerance, 1e-9)),
      points_(origin_, quantum_),
      bodies_(source.description, source.bodies, quantum_),
      stretch_(source.description, source.mesh.cells),
      last_stretch_(source.description.positions.size()),
      figures_(std::make_unique<Figures>()) {
  add_sample(source.description.positions, 0, nullptr);
  append_integers(contact_bytes_, std::array{0});
  figures_->add("time", 0.0);
  ++figures_->samples;
}

MotionRecorder::MotionRecorder(MotionRecorder&&) noexcept = default;
MotionRecorder::~MotionRecorder() = default;

void MotionRecorder::add_frame(const Cloth& cloth, const StepReport& report, double elapsed) {
  take_splits(cloth);
  add_sample(particle_positions(cloth), elapsed, &cloth);
  add_contacts(cloth);
  figures_->add("time", elapsed);
  figures_->add(report);
  figures_->add(cloth.energy());
  ++figures_->samples;
  settings_ = cloth.settings();
}

void MotionRecorder::add_sample(const std::vector<Vec3>& particles, double elapsed,
                                const Cloth* cloth) {
  const std::size_t described = source_->description.positions.size();
  const std::vector<double> stretch = stretch_(std::span(particles).first(described));
  if (model_->may_tear)
    kept_.push_back({particles, stretch});
  else
    add_particles(particles, stretch);
  bodies_.add_sample(particles, elapsed, cloth);
}

void MotionRecorder::add_particles(const std::vector<Vec3>& particles,
                                   const std::vector<double>& stretch) {
  points_.add_sample(particles);
  add_stretch(stretch);
}

void MotionRecorder::take_splits(const Cloth& cloth) {
  for (const Torn& torn : cloth.torn()) {
    if (torn.kind != Tear::sheet) continue;
    split_from_.push_back(torn.index);
    surface_ = cloth.surface();
  }
}

void MotionRecorder::add_kept() {
  const std::size_t described = source_->description.positions.size();
  last_stretch_.resize(described + split_from_.size());
  for (Sample& sample : kept_) {
    auto& [particles, stretch] = sample;
    for (std::size_t i = stretch.size(); i < last_stretch_.size(); ++i)
      stretch.push_back(stretch[split_from_[i - described]]);
    for (std::size_t i = particles.size(); i < last_stretch_.size(); ++i)
      particles.push_back(particles[split_from_[i - described]]);
    add_particles(particles, stretch);
  }
  kept_.clear();
}

/// The difference from the sample before, from 0 at the start.
void MotionRecorder::add_stretch(const std::vector<double>& stretch) {
  std::vector<std::int32_t> changes(stretch.size());
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const std::int32_t quanta = quanta_of(stretch[i], stretch_quantum_);
    changes[i] = quanta - last_stretch_[i];
    last_stretch_[i] = quanta;
  }
  append_integers(stretch_bytes_, changes);
}

/// The number of particles that touch bodies, then their numbers, in order.
void MotionRecorder::add_contacts(const Cloth& cloth) {
  std::vector<std::int32_t> particles;
  for (const BodyContact& contact : cloth.body_contacts())
    particles.push_back(static_cast<std::int32_t>(contact.particle));
  std::ranges::sort(particles);
  erase_repeated(particles);
  append_integers(contact_bytes_, std::array{static_cast<std::int32_t>(particles.size())});
  append_differences(contact_bytes_, particles);
}

Json MotionRecorder::header(Sections& sections) const {
  const SceneDescription& scene = source_->description;
  const auto triangles = surface_.empty() ? triangles_of(particle_faces(source_->mesh)) : surface_;
  sections.add("places", points_.bytes());
  sections.add("stretch", stretch_bytes_);
  sections.add("contacts", contact_bytes_);
  sections.add_triangles("triangles", triangles);
  sections.add_numbers("lines", lines_of(source_->mesh));
  sections.add_numbers("pins", pins_of(scene));
  sections.add_numbers("seams", ends_of(scene.seams));
  add_structure(sections, scene, *model_, source_->mesh.cells);
  Json header{{"scene", source_->title()},
              {"particles", last_stretch_.size()},
              {"samples", figures_->samples},
              {"dt", dt_},
              {"up", source_->up == &Vec3::z ? "z" : "y"},
              {"origin", {origin_.x, origin_.y, origin_.z}},
              {"quantum", quantum_},
              {"stretch_quantum", stretch_quantum_},
              {"settings", described(settings_)},
              {"figures", figures_->lists}};
  header["bodies"] = bodies_.write(sections);
  header["sections"] = sections.table();
  return header;
}

std::string MotionRecorder::bytes() {
  add_kept();
  Sections sections;
  const std::string text = header(sections).dump(-1, ' ', false, Json::error_handler_t::replace);
  const auto size = static_cast<std::uint32_t>(text.size());
  std::string content(reinterpret_cast<const char*>(&size), sizeof size);
  content += text;
  content += sections.bytes();
  const std::vector<std::byte> sealed = seal(kMotion, std::as_bytes(std::span(content)));
  return {reinterpret_cast<const char*>(sealed.data()), sealed.size()};
}

Result<void> check_motion(std::string_view bytes) {
  const auto content = unseal(kMotion, std::as_bytes(std::span(bytes)));
  if (!content) return Error{content.error()};
  return {};
}

}  // namespace weft::tools
