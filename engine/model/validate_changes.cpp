#include <utility>
#include <vector>

#include "engine/model/model.h"
#include "engine/model/validate.h"
#include "engine/validation.h"

namespace weft {
namespace {

/// Whether each of a list exists and is in it once.
class Listed {
 public:
  Listed(std::string_view noun, std::size_t count) : noun_(noun), seen_(count) {}
  Result<void> take(const std::string& field, std::uint32_t index) {
    if (index >= seen_.size()) {
      return refuse(
          field,
          "no such " + std::string(noun_) + ", the scene has " + std::to_string(seen_.size()),
          std::to_string(index));
    }
    if (seen_[index]) {
      return refuse(field, std::string(noun_) + " is listed twice", std::to_string(index));
    }
    seen_[index] = true;
    return {};
  }

 private:
  std::string_view noun_;
  std::vector<bool> seen_;
};

Result<void> validate_particles(std::string_view field, const std::vector<std::uint32_t>& list,
                                bool are_fixed, const Model& model) {
  if (list.empty()) return {};
  Listed particles("particle", model.particles);
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (auto r = particles.take(element(field, i), list[i]); !r) return r;
    if (model.has_anchor(list[i]))
      return refuse(element(field, i), "has an anchor", std::to_string(list[i]));
    const bool is_fixed = model.inverse_mass[model.ordering.slot_of[list[i]]] == 0;
    if (is_fixed != are_fixed) {
      return refuse(element(field, i), is_fixed ? "is fixed already" : "is not fixed",
                    std::to_string(list[i]));
    }
  }
  return {};
}

template <class Validate>
Result<void> validate_values(std::string_view field, const std::vector<ChangedValue>& list,
                             Listed what, const Validate& validate_value) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (auto r = what.take(element(field, i), list[i].index); !r) return r;
    if (auto r = validate_value(element(field, i), list[i].value); !r) return r;
  }
  return {};
}

Result<void> validate_positive_square(const std::string& field, double value) {
  if (auto r = validate_positive(field, value); !r) return r;
  return validate_square(field, value);
}

Result<void> validate_membrane(const std::vector<ChangedMembrane>& list, const Model& model) {
  Listed what("triangle", model.membrane.size() + model.inert.membrane.size());
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string field = element("membrane", i);
    if (auto r = what.take(field, list[i].index); !r) return r;
    for (const auto& [name, value] :
         {std::pair{".warp", list[i].warp}, std::pair{".weft", list[i].weft},
          std::pair{".shear", list[i].shear}}) {
      if (auto r = validate_not_negative(field + name, value); !r) return r;
    }
  }
  return {};
}

}  // namespace

Result<void> validate(const Changes& changes, const Model& model) {
  if (auto r = validate_particles("fix", changes.fix, false, model); !r) return r;
  if (auto r = validate_particles("release", changes.release, true, model); !r) return r;
  const std::size_t constraints = model.constraints.size() + model.inert.constraints.size();
  if (auto r = validate_values("masses", changes.masses, {"particle", model.particles},
                               validate_positive_square);
      !r)
    return r;
  if (auto r = validate_values("rest_lengths", changes.rest_lengths, {"constraint", constraints},
                               validate_positive_square);
      !r)
    return r;
  if (auto r = validate_values("compliances", changes.compliances, {"constraint", constraints},
                               validate_not_negative);
      !r)
    return r;
  const std::size_t bending = model.bending.size() + model.inert.bending.size();
  if (auto r = validate_values("bending", changes.bending, {"bending element", bending},
                               validate_positive_square);
      !r)
    return r;
  if (auto r = validate_membrane(changes.membrane, model); !r) return r;
  if (changes.damping) {
    if (auto r = validate_damping(*changes.damping); !r) return r;
  }
  return changes.air ? validate_air(*changes.air, !model.air.triangles.empty()) : Result<void>();
}

}  // namespace weft
