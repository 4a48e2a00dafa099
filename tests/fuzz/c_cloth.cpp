/// Scenes, cloths and bodies by the C interface: a scene, and then calls, as the input says.
#include <array>
#include <vector>

#include "tests/fuzz/c_calls.h"
#include "tests/fuzz/c_structs.h"

namespace weft::fuzz {
namespace {

class Session {
 public:
  Session(Drawing& drawing, Owned<weft_model> model, Owned<weft_cloth> cloth)
      : drawing_(drawing), model_(std::move(model)) {
    cloths_.push_back(std::move(cloth));
  }

  void run() {
    constexpr int kMostCalls = 40;
    for (int i = 0; i < kMostCalls && !drawing_.is_done(); ++i) call_one();
    for (const auto& cloth : cloths_) step(cloth.get(), 0.01, nullptr);
  }

 private:
  using Do = void (Session::*)();

  weft_cloth* some_cloth() { return cloths_[drawing_.below(256) % cloths_.size()].get(); }
  /// Once in a while another one than there are.
  std::size_t some_count(std::size_t count) {
    return drawing_.rarely(16) ? count + drawing_.below(3) : count;
  }
  std::array<double, 3> vector() {
    return {drawing_.number(), drawing_.number(), drawing_.number()};
  }

  void call_one() {
    constexpr std::array<Do, 21> kCalls{
        &Session::step_one,      &Session::step_one,      &Session::step_by_jobs,
        &Session::step_all,      &Session::create,        &Session::copy,
        &Session::save_and_load, &Session::read,          &Session::read_floats,
        &Session::write,         &Session::set_world,     &Session::move_pins,
        &Session::move_anchors,  &Session::limit_anchors, &Session::carry,
        &Session::change,        &Session::add_body,      &Session::move_body,
        &Session::ask_bodies,    &Session::load_bytes,    &Session::release_seams};
    (this->*kCalls[drawing_.below(kCalls.size())])();
  }

  double dt() { return drawing_.near(0.01); }
  void step_one() { step(some_cloth(), dt(), nullptr); }
  void step_by_jobs() {
    auto jobs = serial_jobs(drawing_.rarely(8) ? drawing_.integer() : 1);
    if (drawing_.rarely()) jobs.run = nullptr;
    step(some_cloth(), dt(), &jobs);
  }
  void step_all() {
    std::vector<weft_batch_step> steps;
    for (const auto& cloth : cloths_) {
      steps.push_back(initial(weft_init_batch_step));
      steps.back().cloth = drawing_.rarely(16) ? some_cloth() : cloth.get();
      steps.back().dt = dt();
    }
    const auto jobs = serial_jobs(1);
    if (!done(weft_step_all(steps.size(), steps.data(), drawing_.flag() ? &jobs : nullptr))) return;
    for (const weft_batch_step& one : steps) {
      if (one.result != WEFT_OK) check_message(one.message);
    }
  }

  void keep(Owned<weft_cloth> cloth) {
    constexpr std::size_t kMostCloths = 3;
    if (!cloth) return;
    if (cloths_.size() == kMostCloths) cloths_.erase(cloths_.begin());
    cloths_.push_back(std::move(cloth));
  }
  void create() {
    const auto settings = draw_settings(drawing_);
    keep(made<weft_cloth>(
        [&](weft_cloth** out) { return weft_create_cloth(model_.get(), &settings, out); }));
  }
  void copy() {
    weft_cloth *to = some_cloth(), *from = some_cloth();
    if (drawing_.flag()) {
      keep(made<weft_cloth>([&](weft_cloth** out) { return weft_clone_cloth(from, out); }));
    } else if (to != from && changed(to, [&] { return weft_copy_state(to, from); })) {
      check(weft_state_hash(to) == weft_state_hash(from), "a copied state is the same");
    }
  }
  void save_and_load() {
    const weft_cloth* from = some_cloth();
    weft_cloth* to = some_cloth();
    const auto state = state_of(from);
    const bool is_loaded =
        changed(to, [&] { return weft_load_state(to, state.data(), state.size()); });
    // Under other settings what the solver knew is forgotten.
    if (is_loaded && to == from)
      check(state_of(to) == state, "a state that is loaded is saved as the same bytes");
    auto model = made<weft_model>([&](weft_model** out) { return weft_model_of(to, out); });
    const auto saved =
        made<weft_bytes>([&](weft_bytes** out) { return weft_save_model(model.get(), out); });
    const void* bytes = weft_bytes_data(saved.get());
    const std::size_t size = weft_bytes_size(saved.get());
    model_ = made<weft_model>([&](weft_model** out) { return weft_load_model(bytes, size, out); });
    check(model_ != nullptr, weft_last_message());
  }
  void load_bytes() {
    const auto bytes = drawing_.bytes(drawing_.below(64));
    weft_cloth* cloth = some_cloth();
    check(!changed(cloth, [&] { return weft_load_state(cloth, bytes.data(), bytes.size()); }),
          "any bytes are no state");
  }

  void read() {
    const weft_cloth* cloth = some_cloth();
    const std::size_t count = some_count(weft_particle_count(cloth));
    std::vector<double> numbers(3 * count);
    done(weft_read_positions(cloth, count, numbers.data()));
    done(weft_read_velocities(cloth, count, numbers.data()));
    std::array<double, 3> least{}, most{};
    done(weft_bounds(cloth, least.data(), most.data()));
    done(weft_position(cloth, drawing_.index(count), least.data()));
    auto strain = initial(weft_init_strain);
    auto energy = initial(weft_init_energy);
    auto settings = initial(weft_init_settings);
    auto info = initial(weft_init_model_info);
    done(weft_strain_of(cloth, &strain)), done(weft_energy_of(cloth, &energy));
    done(weft_settings_of(cloth, &settings)), done(weft_describe(model_.get(), &info));
    check(weft_cloth_bytes(cloth) > 0, "a cloth holds memory");
    check(weft_max_penetration(cloth) >= 0, "no penetration is below 0");
  }
  void read_floats() {
    const weft_cloth* cloth = some_cloth();
    const std::size_t stride = drawing_.rarely(8) ? drawing_.below(8) : 3 + drawing_.below(3);
    std::vector<float> floats(some_count(stride * weft_particle_count(cloth)));
    const auto origin = vector();
    done(weft_read_float_positions(cloth, {floats.data(), floats.size(), stride},
                                   drawing_.flag() ? origin.data() : nullptr));
    done(weft_read_float_velocities(cloth, {floats.data(), floats.size(), stride}));
  }

  void write() {
    weft_cloth* cloth = some_cloth();
    const std::size_t count = some_count(weft_particle_count(cloth));
    const auto numbers = drawing_.numbers(3 * count, 0.1);
    for (const auto how : {weft_write_positions, weft_write_velocities, weft_write_forces}) {
      if (drawing_.flag()) changed(cloth, [&] { return how(cloth, count, numbers.data()); });
    }
  }
  void set_world() {
    weft_cloth* cloth = some_cloth();
    const auto v = vector();
    changed(cloth, [&] { return weft_set_gravity(cloth, v.data()); });
    changed(cloth, [&] { return weft_set_wind(cloth, v.data()); });
    changed(cloth, [&] { return weft_set_pressure(cloth, v[0]); });
  }
  void move_pins() {
    weft_cloth* cloth = some_cloth();
    const std::size_t count = drawing_.below(3);
    const auto pins = drawing_.indices(count, weft_particle_count(cloth));
    const auto numbers = drawing_.numbers(3 * count, 0.1);
    const auto how = drawing_.flag() ? weft_move_fixed : weft_place_fixed;
    changed(cloth, [&] { return how(cloth, count, pins.data(), numbers.data()); });
  }
  void move_anchors() {
    weft_cloth* cloth = some_cloth();
    const std::size_t count = some_count(anchors());
    const auto points = drawing_.numbers(3 * count, 0.1), normals = drawing_.numbers(3 * count, 1);
    const double* given = drawing_.flag() ? normals.data() : nullptr;
    changed(cloth, [&] { return weft_move_anchors(cloth, count, points.data(), given); });
  }
  std::size_t anchors() {
    auto info = initial(weft_init_model_info);
    check(weft_describe(model_.get(), &info) == WEFT_OK, "a model is described");
    return info.anchors;
  }
  void limit_anchors() {
    weft_cloth* cloth = some_cloth();
    const std::size_t count = some_count(anchors());
    const auto distances = drawing_.numbers(count, 0.1);
    const auto backstops = drawing_.bytes(count);
    const double scale = drawing_.near(0.5);
    changed(cloth,
            [&] { return weft_limit_anchors(cloth, count, distances.data(), backstops.data()); });
    changed(cloth, [&] { return weft_limit_anchor(cloth, drawing_.index(count), scale, 1); });
    changed(cloth, [&] { return weft_scale_anchors(cloth, scale); });
  }
  void release_seams() {
    weft_cloth* cloth = some_cloth();
    const std::size_t count = drawing_.below(3);
    const auto seams = drawing_.indices(count, 2);
    const auto how = drawing_.flag() ? weft_release_seams : weft_close_seams;
    changed(cloth, [&] { return how(cloth, count, seams.data()); });
  }
  void carry() {
    weft_cloth* cloth = some_cloth();
    const auto translation = vector(), rotation = vector(), about = vector();
    const double share = drawing_.near(0.5);
    const bool is_carried = drawing_.flag();
    changed(cloth, [&] {
      return is_carried
                 ? weft_carry(cloth, translation.data(), rotation.data(), about.data(), share)
                 : weft_teleport(cloth, translation.data(), rotation.data(), nullptr);
    });
  }
  void change() {
    weft_cloth* cloth = some_cloth();
    Arrays arrays(drawing_);
    const auto changes = draw_changes(arrays, weft_particle_count(cloth));
    changed(cloth, [&] { return weft_change(cloth, &changes); });
  }

  Owned<weft_shape> draw_shape() {
    const auto a = vector(), b = vector();
    const double r = drawing_.near(0.2);
    const std::size_t points = drawing_.below(9), triangles = drawing_.below(6);
    const std::uint32_t kind = drawing_.below(8);
    const auto places = drawing_.numbers(3 * points, 0.3);
    const auto corners = drawing_.indices(3 * triangles, points);
    const int two_sided = drawing_.integer();
    return made<weft_shape>([&](weft_shape** out) {
      switch (kind) {
        case 0:
          return weft_plane(a.data(), r, out);
        case 1:
          return weft_ball(a.data(), r, out);
        case 2:
          return weft_capsule(a.data(), b.data(), r, drawing_.near(0.1), out);
        case 3:
          return weft_hull(points, places.data(), out);
        case 4:
          return weft_box(a.data(), out);
        case 5:
          return weft_torus(a.data(), b.data(), r, drawing_.near(0.1), out);
        case 6:
          return weft_height_field(3, static_cast<std::uint32_t>(points), r, 0.2, places.data(),
                                   out);
        default:
          return weft_triangle_mesh(points, places.data(), triangles, corners.data(), two_sided,
                                    out);
      }
    });
  }
  void add_body() {
    const auto shape = draw_shape();
    auto body = initial(weft_init_body);
    body.shape = shape.get();
    for (double& component : body.position) component = drawing_.near(0);
    for (double& component : body.rotation) component = drawing_.near(0.5);
    body.thickness = drawing_.near(1e-3), body.friction = drawing_.near(0.3);
    weft_cloth* cloth = some_cloth();
    std::uint32_t id = 0;
    changed(cloth, [&] { return weft_add_body(cloth, &body, &id); });
  }
  void move_body() {
    weft_cloth* cloth = some_cloth();
    const std::uint32_t id = drawing_.index(4);
    const auto position = vector();
    const std::array<double, 4> rotation{drawing_.near(0), drawing_.near(0), drawing_.near(0),
                                         drawing_.near(1)};
    const double* turned = drawing_.flag() ? rotation.data() : nullptr;
    const std::size_t count = drawing_.below(9);
    const auto vertices = drawing_.numbers(3 * count, 0.2);
    switch (drawing_.below(6)) {
      case 0:
        changed(cloth, [&] { return weft_move_body(cloth, id, position.data(), turned); });
        break;
      case 1:
        changed(cloth, [&] { return weft_place_body(cloth, id, position.data(), turned); });
        break;
      case 2:
        changed(cloth, [&] { return weft_move_body_vertices(cloth, id, count, vertices.data()); });
        break;
      case 3:
        changed(cloth, [&] { return weft_place_body_vertices(cloth, id, count, vertices.data()); });
        break;
      case 4:
        changed(cloth, [&] { return weft_switch_body(cloth, id, static_cast<int>(count)); });
        break;
      default:
        changed(cloth, [&] { return weft_remove_body(cloth, id); });
    }
  }
  void ask_bodies() {
    const weft_cloth* cloth = some_cloth();
    auto load = initial(weft_init_body_load);
    done(weft_body_load_of(cloth, drawing_.index(4), &load));
    std::vector<weft_body_contact> contacts(drawing_.below(8), initial(weft_init_body_contact));
    std::size_t count = 0;
    done(weft_body_contacts(cloth, contacts.size(), contacts.data(), &count));
  }

  Drawing& drawing_;
  Owned<weft_model> model_;
  std::vector<Owned<weft_cloth>> cloths_;
};

}  // namespace
}  // namespace weft::fuzz

extern "C" int WEFT_FUZZ_TARGET(c_cloth)(const std::uint8_t* data, std::size_t size) {
  using namespace weft::fuzz;
  Drawing drawing(data, size);
  Arrays arrays(drawing);
  const auto settings = draw_settings(drawing);
  const auto scene = draw_scene(arrays);
  auto model = made<weft_model>([&](weft_model** out) { return weft_build_model(&scene, out); });
  if (!model) return 0;
  auto cloth = made<weft_cloth>(
      [&](weft_cloth** out) { return weft_create_cloth(model.get(), &settings, out); });
  if (!cloth) return 0;
  note_accepted();
  Session(drawing, std::move(model), std::move(cloth)).run();
  return 0;
}
