/// The structs behind the handles of C.
#pragma once

#include <weft/batch.h>
#include <weft/surface.h>
#include <weft/weft_c.h>

#include <memory>
#include <utility>
#include <vector>

#include "engine/c_interface/scene_arrays.h"

struct weft_model {
  std::shared_ptr<const weft::Model> model;
};

struct weft_cloth {
  weft::Cloth cloth;
  std::vector<weft::ClothStep> batch{};  // of batches whose first cloth it is
};

struct weft_shape {
  std::shared_ptr<const weft::BodyShape> shape;
};

struct weft_mesh_cloth {
  explicit weft_mesh_cloth(weft::MeshCloth made)
      : cloth(std::move(made)), arrays(weft::c_interface::arrays_of(cloth.scene)) {}
  weft::MeshCloth cloth;
  weft::c_interface::SceneArrays arrays;  // of its scene
};

struct weft_surface {
  weft::Surface surface;
};

struct weft_bytes {
  std::vector<std::byte> bytes;
};
